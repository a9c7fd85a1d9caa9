/* Results whose runs have two modes at a point, by the rule of `clast scatter`. */
#include <math.h>
#include <stdlib.h>

#include "analysis/statistics/dip.h"
#include "analysis/statistics/scatter.h"
#include "db/ask/page_private.h"

static const char doing[] = "making the page";

status ask_page_modes_begin(struct ask_page *page, struct ask_page_modes *modes, struct error *error) {
  *modes = (struct ask_page_modes){.limit = NAN};
  const status code = sql_execute(page->db,
                                  "CREATE TABLE modes (point_id, quantity, lower_mode, upper_mode, between_modes, "
                                  "upper_share, upper_low, upper_high)",
                                  doing, error);
  return code ? code
              : sql_prepare(page->db, "INSERT INTO modes VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)", &modes->insert,
                            doing, error);
}

static status add(const struct ask_page_modes *modes, int64_t point, const char *quantity, const struct scatter *s,
                  struct error *error) {
  const double numbers[] = {s->lower_mode, s->upper_mode, s->between, s->upper_share, s->upper_low, s->upper_high};
  sqlite3_bind_int64(modes->insert, 1, point);
  sql_bind_text(modes->insert, 2, quantity);
  for (int k = 0; k < 6; k++)
    sqlite3_bind_double(modes->insert, 3 + k, numbers[k]);
  return sql_run(modes->insert, doing, error);
}

status ask_page_modes_add(struct ask_page_modes *modes, int64_t point, const char *quantity, size_t n, double *values,
                          struct error *error) {
  struct scatter scatter = {.n = n, .sorted = values};
  if (n < 4)
    return STATUS_OK;
  qsort(values, n, sizeof *values, sample_ascending);
  if (!(values[n - 1] > values[0]) || scatter_in_steps(n, values))
    return STATUS_OK;
  if (n != modes->n) {
    modes->n = n;
    modes->limit = dip_limit(n);
  }
  if (!(dip_of(n, values) > modes->limit))
    return STATUS_OK;
  scatter_find_modes(&scatter);
  return add(modes, point, quantity, &scatter, error);
}
