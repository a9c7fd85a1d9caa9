/* How the first main result, the mass share of the largest fragment, scatters over the seeds of every point, as `clast
 * scatter` tells it. Only this one: to tell two modes costs up to a tenth of a second for a point of 1000 runs. */
#include <math.h>

#include "analysis/statistics/scatter.h"
#include "db/ask/page_private.h"
#include "db/ask/pool.h"
#include "engine/outcome.h"

static const char doing[] = "making the page";

/* Below this the dip of a sample says that it has two modes at least (analysis/statistics/scatter.h). */
static const double MODES_SHARE = 0.05;

struct scattering {
  struct ask_page *page;
  sqlite3_stmt *quantiles, *modes;
  const char *quantity;
  bool few; /* so few points that there is room for all quantiles */
};

static status add_quantiles(const struct scattering *to, int64_t point, const struct scatter *scatter,
                            struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < SCATTER_QUANTILES; i++) {
    const struct scatter_quantile *quantile = &scatter->quantile[i];
    const double numbers[] = {scatter_shares[i], quantile->value, quantile->low, quantile->high};
    sqlite3_bind_int64(to->quantiles, 1, point);
    sql_bind_text(to->quantiles, 2, to->quantity);
    for (int k = 0; k < 4; k++)
      sqlite3_bind_double(to->quantiles, 3 + k, numbers[k]); /* NaN is NULL */
    code = sql_run(to->quantiles, doing, error);
  }
  return code;
}

static status add_modes(const struct scattering *to, int64_t point, const struct scatter *scatter,
                        struct error *error) {
  const double numbers[] = {scatter->dip_share,   scatter->lower_mode, scatter->upper_mode, scatter->between,
                            scatter->upper_share, scatter->upper_low,  scatter->upper_high};
  sqlite3_bind_int64(to->modes, 1, point);
  sql_bind_text(to->modes, 2, to->quantity);
  for (int k = 0; k < 7; k++)
    sqlite3_bind_double(to->modes, 3 + k, numbers[k]);
  return sql_run(to->modes, doing, error);
}

static status add_point(void *context, const struct ask_pool *pool, struct error *error) {
  const struct scattering *to = context;
  struct scatter scatter = {0};
  status code = scatter_make(pool->data.runs.count, pool->value, &scatter, error);
  if (code)
    return code;
  if (scatter.n > 1 && to->few)
    code = add_quantiles(to, pool->point[0], &scatter, error);
  if (code == STATUS_OK && scatter.dip_share < MODES_SHARE && isfinite(scatter.upper_share))
    code = add_modes(to, pool->point[0], &scatter, error);
  scatter_release(&scatter);
  return code;
}

status ask_page_scatter(struct ask_page *page, struct store *store, struct error *error) {
  struct scattering to = {.page = page, .quantity = OUTCOME_DEFAULT};
  double points = 0;
  status code = sql_execute(page->db,
                            "CREATE TABLE quantile (point_id, quantity, share, value, low, high);"
                            "CREATE TABLE modes (point_id, quantity, p, lower_mode, upper_mode, between_modes, "
                            "upper_share, upper_low, upper_high)",
                            doing, error);
  if (code == STATUS_OK)
    code = query_number(store, "SELECT count(*) FROM point", 0, NULL, &points, error);
  if (code == STATUS_OK)
    code = sql_prepare(page->db, "INSERT INTO quantile VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &to.quantiles, doing, error);
  if (code == STATUS_OK)
    code = sql_prepare(page->db, "INSERT INTO modes VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)", &to.modes, doing,
                       error);
  to.few = points <= ASK_PAGE_QUANTILES;
  if (code == STATUS_OK)
    code = ask_pool_values(store, &(struct ask_pool_choice){0}, to.quantity, add_point, &to, error);
  sqlite3_finalize(to.quantiles);
  sqlite3_finalize(to.modes);
  return code;
}
