/* Does a power law fit the fragments of a point? The same test as in `clast exponents`. */
#include <math.h>

#include "db/ask/page_private.h"
#include "db/ask/pool.h"

static const char doing[] = "making the page";

struct judging {
  sqlite3_stmt *insert;
  int64_t fragments; /* tested so far */
};

static status judge(void *context, const struct ask_pool *pool, struct error *error) {
  struct judging *judging = context;
  const double lower = point_window(&pool->data, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  const struct pooled_runs *runs = &pool->data.runs;
  struct pooled_exponent fit;
  struct pooled_goodness goodness;
  if (!(lower > 0))
    return STATUS_OK; /* the store has no estimates of its runs */
  status code = pooled_exponent(runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 0.95, &fit, error);
  if (code || !isfinite(fit.fit.beta))
    return code;
  if (judging->fragments + fit.fit.n > ASK_PAGE_JUDGED)
    return STATUS_STOPPED;
  judging->fragments += fit.fit.n;
  code = pooled_goodness(runs, lower, ASK_PAGE_DRAWS, &goodness, error);
  if (code)
    return code;
  sqlite3_bind_int64(judging->insert, 1, pool->data.point_id);
  sqlite3_bind_int64(judging->insert, 2, fit.fit.n);
  sqlite3_bind_double(judging->insert, 3, goodness.p); /* NaN is NULL */
  return sql_run(judging->insert, doing, error);
}

status ask_page_goodness(struct ask_page *page, struct store *store, struct error *error) {
  struct judging judging = {.fragments = 0};
  status code = sql_execute(page->db, "CREATE TABLE goodness (point_id, n, p)", doing, error);
  if (code == STATUS_OK)
    code = sql_prepare(page->db, "INSERT INTO goodness VALUES (?1, ?2, ?3)", &judging.insert, doing, error);
  if (code == STATUS_OK)
    code = ask_pools(store, &(struct ask_pool_choice){0}, judge, &judging, error);
  sqlite3_finalize(judging.insert);
  return code == STATUS_STOPPED ? STATUS_OK : code;
}
