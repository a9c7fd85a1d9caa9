#include "campaign/commands/pool.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool grow(struct pool *pool, size_t masses, size_t runs) {
  if (masses > pool->capacity) {
    double *grown = realloc(pool->masses, 2 * masses * sizeof *grown);
    if (!grown)
      return false;
    pool->masses = grown;
    pool->capacity = 2 * masses;
  }
  if (runs + 1 > pool->run_capacity) {
    size_t *grown = realloc(pool->first, 2 * (runs + 1) * sizeof *grown);
    if (!grown)
      return false;
    pool->first = grown;
    pool->run_capacity = 2 * (runs + 1);
  }
  return true;
}

static status take_masses(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct pool *pool = context;
  if (count != 1 || values[0].kind != QUERY_BLOB || values[0].size % 8)
    return status_fail(error, STATUS_CONTENT, "the fragment masses of a run are damaged; `clast check` tells more");
  size_t runs = pool->runs.count, n = values[0].size / 8, have = runs ? pool->first[runs] : 0;
  if (!grow(pool, have + n, runs + 1))
    return status_fail(error, STATUS_MEMORY, "out of memory");
  memcpy(pool->masses + have, values[0].blob, values[0].size); /* blob and machine are both little-endian */
  pool->first[0] = 0;
  pool->first[runs + 1] = have + n;
  pool->runs = (struct pooled_runs){.count = runs + 1, .first = pool->first, .masses = pool->masses};
  return STATUS_OK;
}

static void parameters_of(const struct pool *pool, char text[2][32], struct query_parameter parameters[2]) {
  snprintf(text[0], 32, "%" PRId64, pool->point);
  snprintf(text[1], 32, "%" PRId64, pool->results_version);
  parameters[0] = (struct query_parameter){"point", text[0]};
  parameters[1] = (struct query_parameter){"version", text[1]};
}

status pool_read(struct store *store, int64_t point, int64_t results_version, struct pool *pool, struct error *error) {
  static const char sql[] =
      "select masses from run join fragment_mass using (run_id) where point_id = :point and counts = 1 and results_version"
      " = iif(:version > 0, :version, (select max(results_version) from run where point_id = :point))"
      " order by replicate, seed";
  *pool = (struct pool){.point = point, .results_version = results_version};
  char text[2][32];
  struct query_parameter parameters[2];
  struct query_sink sink = {pool, NULL, take_masses};
  parameters_of(pool, text, parameters);
  status code = query_run(store, sql, 2, parameters, 0, &sink, error);
  if (code)
    pool_clear(pool);
  return code;
}

void pool_clear(struct pool *pool) {
  free(pool->masses);
  free(pool->first);
  *pool = (struct pool){0};
}

status pool_window(struct store *store, const struct pool *pool, enum estimates_window window, double *lower,
                   struct error *error) {
  char text[2][32];
  struct query_parameter parameters[3];
  parameters_of(pool, text, parameters);
  parameters[2] = (struct query_parameter){"window", estimates_window_names[window]};
  return query_number(store,
                      "select avg(lower) from estimate join run using (run_id) where run.point_id = :point and counts = 1"
                      " and run.results_version = iif(:version > 0, :version,"
                      " (select max(results_version) from run where point_id = :point))"
                      " and method = 'masses' and window = :window",
                      3, parameters, lower, error);
}
