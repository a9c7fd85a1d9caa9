/* Reads the fragments of one point and makes its exponents and its curve. */
#include "db/ask/point.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/query.h"

struct growing {
  struct point_data *point;
  size_t mass_capacity, run_capacity;
};

/* Blobs are little-endian float64, the machine's own order on everything that this program is built for. */
static status take_run(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct growing *growing = context;
  struct point_data *point = growing->point;
  if (count != 1 || values[0].kind != QUERY_BLOB || values[0].size % sizeof(double) != 0)
    return status_fail(error, STATUS_CONTENT,
                       "the fragment masses of a run of point %lld are damaged; `clast check` tells more",
                       (long long)point->point_id);
  size_t n = values[0].size / sizeof(double), have = point->first[point->runs.count];
  if (have + n > growing->mass_capacity) {
    size_t capacity = 2 * (have + n);
    double *grown = realloc(point->masses, capacity * sizeof *grown);
    if (!grown)
      return status_fail(error, STATUS_MEMORY, "no memory for the masses of point %lld", (long long)point->point_id);
    point->masses = grown;
    growing->mass_capacity = capacity;
  }
  if (point->runs.count + 2 > growing->run_capacity) {
    size_t capacity = 2 * growing->run_capacity;
    size_t *grown = realloc(point->first, capacity * sizeof *grown);
    if (!grown)
      return status_fail(error, STATUS_MEMORY, "no memory for the runs of point %lld", (long long)point->point_id);
    point->first = grown;
    growing->run_capacity = capacity;
  }
  if (n > 0)
    memcpy(point->masses + have, values[0].blob, n * sizeof(double));
  point->first[++point->runs.count] = have + n;
  return STATUS_OK;
}

/* A store that was made before runs said it, and is only read, has no such column. */
static status read_complete_mass(struct store *store, struct query_parameter parameters[2], double *mass,
                                 struct error *error) {
  const struct query_parameter column = {"column", OUTCOME_NAME(complete_mass)};
  char text[256];
  double there = 0;
  *mass = NAN;
  status code = query_number(store, "SELECT count(*) FROM pragma_table_info('run') WHERE name = :column", 1, &column,
                             &there, error);
  if (code || !(there > 0))
    return code;
  snprintf(text, sizeof text,
           "SELECT avg(%s) FROM run WHERE point_id = :point AND results_version = :version AND counts = 1",
           OUTCOME_NAME(complete_mass));
  return query_number(store, text, 2, parameters, mass, error);
}

status point_read(struct store *store, int64_t point_id, int64_t results_version, struct point_data *out,
                  struct error *error) {
  *out = (struct point_data){.point_id = point_id,
                             .results_version = results_version,
                             .element_mass = NAN,
                             .complete_mass = NAN};
  char id[32], version[32];
  snprintf(id, sizeof id, "%lld", (long long)point_id);
  struct query_parameter parameters[2] = {{"point", id}, {"version", version}};
  status code = STATUS_OK;
  if (results_version == 0) {
    double newest = NAN;
    code = query_number(store, "SELECT max(results_version) FROM run WHERE point_id = :point AND counts = 1", 1,
                        parameters, &newest, error);
    if (code)
      return code;
    out->results_version = isnan(newest) ? 0 : (int64_t)newest;
  }
  snprintf(version, sizeof version, "%lld", (long long)out->results_version);
  struct growing growing = {.point = out, .run_capacity = 32};
  out->first = calloc(growing.run_capacity, sizeof *out->first);
  if (!out->first)
    return status_fail(error, STATUS_MEMORY, "no memory for the runs of point %lld", (long long)point_id);
  struct query_sink sink = {.context = &growing, .row = take_run};
  code = query_run(store,
                   "SELECT masses FROM run JOIN fragment_mass USING (run_id) WHERE point_id = :point AND "
                   "results_version = :version AND counts = 1 ORDER BY replicate, seed",
                   2, parameters, 0, &sink, error);
  /* The window from_10 of a run begins at a known number of its mean element masses: complete_mass is never above. */
  if (!code)
    code = query_number(
        store,
        "SELECT avg(lower) FROM estimate e JOIN run r ON r.run_id = e.run_id WHERE r.point_id = :point "
        "AND r.results_version = :version AND r.counts = 1 AND e.method = 'masses' AND e.window = 'from_10'",
        2, parameters, &out->element_mass, error);
  if (!code)
    code = read_complete_mass(store, parameters, &out->complete_mass, error);
  out->element_mass /= estimates_window_elements(ESTIMATES_FROM_10);
  if (code) {
    point_release(out);
    return code;
  }
  out->runs.first = out->first;
  out->runs.masses = out->masses;
  return STATUS_OK;
}

void point_release(struct point_data *point) {
  free(point->first);
  free(point->masses);
  point->first = NULL;
  point->masses = NULL;
  point->runs = (struct pooled_runs){0};
}

double point_window(const struct point_data *point, enum estimates_window window) {
  return estimates_window_lower(window, point->element_mass, point->complete_mass);
}

static status estimate(const struct point_data *point, enum exponent_method method, enum estimates_window window,
                       double level, struct pooled_exponent *out, struct error *error) {
  const double lower = point_window(point, window);
  if (lower > 0)
    return pooled_exponent(&point->runs, method, lower, level, out, error);
  /* no runs, or none with estimates */
  *out = (struct pooled_exponent){.fit = exponent_unknown(method, (struct exponent_window){NAN, NAN}),
                                  .interval = {NAN, NAN, NAN}};
  return STATUS_OK;
}

status point_exponent(struct store *store, int64_t point_id, int64_t results_version, enum exponent_method method,
                      enum estimates_window window, double level, struct pooled_exponent *out, struct error *error) {
  struct point_data point;
  status code = point_read(store, point_id, results_version, &point, error);
  if (code)
    return code;
  code = estimate(&point, method, window, level, out, error);
  point_release(&point);
  return code;
}

status point_estimates(const struct point_data *point, double level, struct point_estimate rows[POINT_ESTIMATES],
                       struct error *error) {
  static const enum exponent_method methods[] = {EXPONENT_LEAST_SQUARES, EXPONENT_BINNED, EXPONENT_MASSES};
  status code = STATUS_OK;
  for (int i = 0; i < POINT_ESTIMATES && !code; i++) {
    rows[i] = (struct point_estimate){.window = (enum estimates_window)(i % ESTIMATES_WINDOWS)};
    code = estimate(point, methods[i / ESTIMATES_WINDOWS], rows[i].window, level, &rows[i].exponent, error);
  }
  return code;
}

status point_curve_make(const struct point_data *point, const char *label, struct point_curve *out,
                        struct error *error) {
  *out = (struct point_curve){.runs = point->runs.count, .complete_mass = point->complete_mass, .fit = {.beta = NAN}};
  if (label)
    snprintf(out->label, sizeof out->label, "%s", label);
  else
    snprintf(out->label, sizeof out->label, "point %lld, %zu runs", (long long)point->point_id, out->runs);
  status code = pooled_spectrum(&point->runs, true, 1, &out->bins, &out->count, error);
  double lower = point_window(point, (enum estimates_window)ESTIMATES_HEADLINE_WINDOW);
  if (code || !(lower > 0))
    return code;
  struct pooled_exponent headline;
  code = pooled_exponent(&point->runs, (enum exponent_method)ESTIMATES_HEADLINE_METHOD, lower, 0.95, &headline, error);
  if (code) {
    point_curve_release(out);
    return code;
  }
  if (!isfinite(headline.fit.beta))
    return STATUS_OK;
  const double half_width = headline.interval.half_width;
  if (isfinite(half_width))
    snprintf(out->fit_label, sizeof out->fit_label, "\xce\xb2 = %.2f \xc2\xb1 %.2f (seeds, 95 %%)", headline.fit.beta,
             half_width);
  else
    snprintf(out->fit_label, sizeof out->fit_label, "\xce\xb2 = %.2f (no interval)", headline.fit.beta);
  out->fit = (struct picture_fit){NULL, headline.fit.beta, headline.fit.lower, headline.fit.upper,
                                  (double)headline.fit.n / (double)out->runs};
  return STATUS_OK;
}

void point_curve_release(struct point_curve *curve) {
  free(curve->bins);
  curve->bins = NULL;
  curve->count = 0;
}

struct picture_series point_curve_series(struct point_curve *curve) {
  curve->fit.label = curve->fit_label;
  return (struct picture_series){.label = curve->label,
                                 .complete_mass = curve->complete_mass,
                                 .count = curve->count,
                                 .bins = curve->bins,
                                 .fits = isfinite(curve->fit.beta) ? 1u : 0u,
                                 .fit = &curve->fit};
}
