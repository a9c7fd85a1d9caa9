/* Fits the exponents of every point that has runs and no estimates yet. */
#include "campaign/driver/pooling.h"

#include <stdlib.h>

#include "db/ask/point.h"
#include "db/ask/points.h"

static status pool(struct store *store, const struct ask_points_version *which, struct error *error) {
  struct point_data point = {0};
  struct point_estimate fits[POINT_ESTIMATES];
  struct estimate rows[POINT_ESTIMATES];
  status code = point_read(store, which->point_id, which->results_version, &point, error);
  if (!code)
    code = point_estimates(&point, 0.95, fits, error);
  for (int i = 0; i < POINT_ESTIMATES && !code; i++) {
    rows[i] = (struct estimate){.window = fits[i].window, .fit = fits[i].exponent.fit};
    rows[i].fit.standard_error = fits[i].exponent.interval.standard_error;
    rows[i].half_width = fits[i].exponent.interval.half_width;
    rows[i].headline = rows[i].window == ESTIMATES_HEADLINE_WINDOW && rows[i].fit.method == ESTIMATES_HEADLINE_METHOD;
  }
  if (!code)
    code = store_set_estimates(store, which->point_id, 0, which->results_version, POINT_ESTIMATES, rows, error);
  point_release(&point);
  return code;
}

status pooling_store(struct store *store, int64_t campaign_id, struct error *error) {
  struct ask_points_version *points = NULL;
  size_t count = 0;
  status code = store_flush(store, error); /* the sums of the open batch */
  if (code)
    return code;

  code = ask_points_without_estimates(store, campaign_id, &points, &count, error);
  for (size_t i = 0; i < count && !code; i++)
    code = pool(store, &points[i], error);
  free(points);
  return code ? code : store_flush(store, error);
}
