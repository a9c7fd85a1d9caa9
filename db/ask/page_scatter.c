/* Quantiles of the first main result, the mass share of the largest fragment, at every point, as `clast scatter` gives
 * them. Other results and further points are left out to keep the page small. */
#include "analysis/statistics/scatter.h"
#include "db/ask/page_private.h"
#include "db/ask/pool.h"
#include "engine/outcome.h"

static const char doing[] = "making the page";

static status add_quantiles(sqlite3_stmt *insert, int64_t point, const struct scatter *scatter, struct error *error) {
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < SCATTER_QUANTILES; i++) {
    const struct scatter_quantile *quantile = &scatter->quantile[i];
    const double numbers[] = {scatter_shares[i], quantile->value, quantile->low, quantile->high};
    sqlite3_bind_int64(insert, 1, point);
    sql_bind_text(insert, 2, OUTCOME_DEFAULT);
    for (int k = 0; k < 4; k++)
      sqlite3_bind_double(insert, 3 + k, numbers[k]); /* NaN is NULL */
    code = sql_run(insert, doing, error);
  }
  return code;
}

static status add_point(void *context, const struct ask_pool *pool, struct error *error) {
  struct scatter scatter = {0};
  status code = scatter_make(pool->data.runs.count, pool->value, &scatter, error);
  if (code == STATUS_OK && scatter.n > 1)
    code = add_quantiles(context, pool->point[0], &scatter, error);
  scatter_release(&scatter);
  return code;
}

status ask_page_scatter(struct ask_page *page, struct store *store, struct error *error) {
  sqlite3_stmt *insert = NULL;
  double points = 0;
  status code = sql_execute(page->db, "CREATE TABLE quantile (point_id, quantity, share, value, low, high)", doing,
                            error);
  if (code == STATUS_OK)
    code = query_number(store, "SELECT count(*) FROM point", 0, NULL, &points, error);
  if (code || points > ASK_PAGE_QUANTILES)
    return code;
  code = sql_prepare(page->db, "INSERT INTO quantile VALUES (?1, ?2, ?3, ?4, ?5, ?6)", &insert, doing, error);
  if (code == STATUS_OK)
    code = ask_pool_values(store, &(struct ask_pool_choice){0}, OUTCOME_DEFAULT, add_point, insert, error);
  sqlite3_finalize(insert);
  return code;
}
