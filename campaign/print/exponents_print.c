/* The rows of `clast exponents`. */
#include "campaign/print/exponents_print.h"

#include "db/ask/pool.h"
#include "engine/outcome.h"

void exponents_print_headings(struct table *table) {
  table_column(table, "point_id", NULL);
  table_column(table, "from", "kg");
  table_column(table, OUTCOME_NAME(complete_mass), "kg");
  table_columns(table, (const char *const[]){"runs", "fragments", "F(m)", "F(m)_hw95", "N(>m)", "F(L)", "N(>L)",
                                             "N(>L)_hw95", "distance", "p", "cutoff_p", "lognormal_p", NULL});
}

status exponents_print_pool(struct table *table, size_t draws, const struct ask_pool *pool, struct error *error) {
  const double lower = point_window(&pool->data, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  struct pooled_exponent fit;
  struct pooled_goodness goodness;
  struct pooled_rivals rivals;
  if (!(lower > 0))
    return STATUS_OK; /* the store has no estimates of its runs */
  const struct pooled_runs *runs = &pool->data.runs;
  status code = pooled_exponent(runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 0.95, &fit, error);
  if (code == STATUS_OK)
    code = pooled_goodness(runs, lower, draws, &goodness, error);
  if (code == STATUS_OK)
    code = pooled_rivals(runs, lower, &rivals, error);
  if (code)
    return code;
  table_integer(table, pool->data.point_id);
  table_real(table, lower);
  table_real(table, pool->data.complete_mass);
  table_integer(table, (int64_t)runs->count);
  table_integer(table, fit.fit.n);
  const double any = 1; /* a density: the exponents by size do not depend on it */
  for (int form = 0; form < 4; form++) {
    const struct pooled_form named = ask_pool_form(pool, form % 2, form / 2 ? any : 0);
    table_fixed(table, pooled_spectrum_exponent(&named, fit.fit.beta), 2);
    if (form == 0 || form == 3)
      table_fixed(table, pooled_spectrum_half_width(&named, fit.interval.half_width), 2);
  }
  table_real(table, goodness.distance);
  table_real(table, goodness.p);
  table_real(table, rivals.cutoff_p);
  table_real(table, rivals.lognormal_p);
  return STATUS_OK;
}
