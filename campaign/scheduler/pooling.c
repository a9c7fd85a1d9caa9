/* Fits the exponents of every point that has runs and no estimates yet. A thread fits one point while the next one is
 * read: in a large store both take about as long. */
#include "campaign/scheduler/scheduler.h"

#include <pthread.h>

#include "schemas/memory.h"

struct fit {
  const struct ask_points_version *which;
  struct point_data point;
  pthread_t thread;
  bool begun, has_thread; /* without has_thread, no thread could be started: the fit was made at once */
  struct point_estimate fits[POINT_ESTIMATES];
  status result;
  struct error error;
};

static void *make_fit(void *context) {
  struct fit *fit = context;
  fit->result = point_estimates(&fit->point, 0.95, fit->fits, &fit->error);
  return NULL;
}

static status write_fit(struct store *store, const struct fit *fit, struct error *error) {
  struct estimate rows[POINT_ESTIMATES];
  point_estimate_rows(fit->fits, rows);
  return store_set_estimates(store, fit->which->point_id, fit->which->results_version, POINT_ESTIMATES, rows, error);
}

/* Waits for the fit and frees its point. Writes its estimates if `code` is STATUS_OK; else returns `code`. */
static status end(struct store *store, struct fit *fit, status code, struct error *error) {
  if (!fit->begun)
    return code;
  if (fit->has_thread)
    pthread_join(fit->thread, NULL);
  if (code == STATUS_OK)
    code = fit->result ? status_fail(error, fit->result, "%s", fit->error.message) : write_fit(store, fit, error);
  point_release(&fit->point);
  *fit = (struct fit){0};
  return code;
}

status pooling_store(struct store *store, int64_t campaign_id, struct error *error) {
  OWNED struct ask_points_version *points = NULL;
  size_t count = 0;
  struct fit fit = {0};
  TRY(store_flush(store, error)); /* the sums of the open batch */
  status code = ask_points_without_estimates(store, campaign_id, &points, &count, error);
  for (size_t i = 0; i < count && code == STATUS_OK; i++) {
    struct point_data point = {0};
    code = point_read(store, points[i].point_id, points[i].results_version, &point, error);
    code = end(store, &fit, code, error);
    if (code == STATUS_OK) {
      fit.which = &points[i];
      fit.point = point;
      fit.begun = true;
      fit.has_thread = pthread_create(&fit.thread, NULL, make_fit, &fit) == 0;
      if (!fit.has_thread)
        make_fit(&fit);
    } else {
      point_release(&point);
    }
  }
  TRY(end(store, &fit, code, error));
  return store_flush(store, error);
}
