#include "campaign/pooling.h"

#include <stdio.h>
#include <stdlib.h>

#include "db/ask/point.h"
#include "db/ask/query.h"

struct missing {
  size_t count, capacity;
  struct missing_point {
    int64_t point_id;
    int results_version;
  } * points;
};

static status collect(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct missing *missing = context;
  (void)count;
  if (missing->count == missing->capacity) {
    size_t capacity = missing->capacity ? 2 * missing->capacity : 64;
    struct missing_point *points = realloc(missing->points, capacity * sizeof *points);
    if (!points)
      return status_fail(error, STATUS_MEMORY, "no memory for the list of points");
    missing->points = points;
    missing->capacity = capacity;
  }
  missing->points[missing->count++] = (struct missing_point){values[0].integer, (int)values[1].integer};
  return STATUS_OK;
}

static status pool(struct store *store, const struct missing_point *which, struct error *error) {
  struct point_data point = {0};
  struct point_estimate fits[POINT_ESTIMATES];
  struct estimate rows[POINT_ESTIMATES];
  status code = point_read(store, which->point_id, which->results_version, &point, error);
  if (!code)
    code = point_estimates(&point, POOLING_RESAMPLES, 0.95, fits, error);
  for (int i = 0; i < POINT_ESTIMATES && !code; i++) {
    rows[i] = (struct estimate){.window = fits[i].window, .fit = fits[i].exponent.fit};
    rows[i].fit.standard_error = fits[i].exponent.interval.standard_error;
    rows[i].headline = rows[i].window == ESTIMATES_HEADLINE_WINDOW && rows[i].fit.method == ESTIMATES_HEADLINE_METHOD;
  }
  if (!code)
    code = store_set_estimates(store, which->point_id, 0, which->results_version, POINT_ESTIMATES, rows, error);
  point_release(&point);
  return code;
}

status pooling_store(struct store *store, int64_t campaign_id, struct error *error) {
  static const char sql[] =
      "SELECT point_id, results_version FROM point_total AS t WHERE runs > 0 AND (:campaign = 0 OR point_id IN (SELECT "
      "point_id FROM campaign_point WHERE campaign_id = :campaign)) AND NOT EXISTS (SELECT 1 FROM point_estimate AS e "
      "WHERE "
      "e.point_id = "
      "t.point_id AND e.results_version = t.results_version) ORDER BY point_id, results_version";
  char number[32];
  snprintf(number, sizeof number, "%lld", (long long)campaign_id);
  const struct query_parameter parameter = {"campaign", number};
  struct missing missing = {0};
  const struct query_sink sink = {&missing, NULL, collect};
  status code = store_flush(store, error); /* the sums of the open batch */
  if (!code)
    code = query_run(store, sql, 1, &parameter, 0, &sink, error);
  for (size_t i = 0; i < missing.count && !code; i++)
    code = pool(store, &missing.points[i], error);
  if (!code)
    code = store_flush(store, error);
  free(missing.points);
  return code;
}
