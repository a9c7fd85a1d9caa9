/* Reads the fragments of one point and estimates its exponents. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/sql.h"
#include "engine/grow.h"

/* The newest version with runs that count (0: none), unless one is given, and the dimensions of the engine. */
static status read_version(struct store *store, int64_t point_id, struct point_data *out, struct error *error) {
  ANSWER
  answer = answer_to(store, error,
                     "SELECT (SELECT max(results_version) FROM run WHERE point_id = p.point_id AND counts = 1), engine "
                     "FROM point AS p WHERE point_id = %lld",
                     (long long)point_id);
  if (answer_next(&answer)) {
    if (out->results_version == 0)
      out->results_version = answer_integer(&answer, 0);
    const struct engine_kind *kind = engine_find(answer_text(&answer, 1), NULL);
    out->dimensions = kind ? kind->dimensions : 3;
  }
  return answer_end(&answer);
}

/* Adds the runs behind those that *out has. condition: SQL that chooses them. */
static status read_runs(struct store *store, int64_t point_id, const char *condition, struct point_data *out,
                        struct error *error) {
  static const char what[] = "the runs of a point";
  const long long point = point_id, version = out->results_version;
  size_t have = out->runs.count, ids = have, seeds = have, firsts = out->first ? have + 1 : 0;
  size_t masses_have = out->first ? out->first[have] : 0, room = masses_have;
  char of[64];
  snprintf(of, sizeof of, "a run of point %lld", point);
  TRY(grow_or_fail(&out->first, &firsts, have + 1, sizeof *out->first, what, error));
  out->first[have] = masses_have;
  ANSWER answer = answer_to(store, error,
                            "SELECT masses, run_id, seed FROM run JOIN fragment_mass USING (run_id) WHERE point_id = "
                            "%lld AND results_version = %lld AND counts = 1%s ORDER BY replicate, seed",
                            point, version, condition);
  const void *masses;
  size_t n;
  while (answer_next(&answer) && answer_masses(&answer, 0, of, &masses, &n)) {
    TRY(grow_or_fail(&out->masses, &room, masses_have + n, sizeof *out->masses, what, error));
    TRY(grow_or_fail(&out->first, &firsts, have + 2, sizeof *out->first, what, error));
    TRY(grow_or_fail(&out->run_id, &ids, have + 1, sizeof *out->run_id, what, error));
    TRY(grow_or_fail(&out->seed, &seeds, have + 1, sizeof *out->seed, what, error));
    if (n > 0)
      memcpy(out->masses + masses_have, masses, n * sizeof(double));
    out->run_id[have] = answer_integer(&answer, 1);
    out->seed[have] = (uint64_t)answer_integer(&answer, 2);
    out->first[++have] = masses_have += n;
  }
  out->runs = (struct pooled_runs){have, out->first, out->masses};
  return answer_end(&answer);
}

status point_add(struct store *store, int64_t point_id, const char *where, struct point_data *out,
                 struct error *error) {
  double element_mass, complete_mass;
  TRY(read_version(store, point_id, out, error));
  SQL_TEXT condition = where
                           ? sql_format(" AND run.run_id IN (SELECT run_id FROM runs WHERE point_id = %lld AND (%s\n))",
                                        (long long)point_id, where)
                           : sql_format("");
  TRY(read_runs(store, point_id, condition, out, error));
  /* The window from_10 of a run begins at a known number of its mean element masses, or at complete_mass where that is
   * above (graded bodies of sph): then all windows begin there, also with an element as heavy. */
  TRY(answer_number(store, &element_mass, error,
                    "SELECT avg(lower) FROM estimate e JOIN run ON run.run_id = e.run_id WHERE point_id = %lld AND "
                    "results_version = %lld AND counts = 1 AND e.method = 'masses' AND e.window = 'from_10'%s",
                    (long long)point_id, (long long)out->results_version, condition));
  TRY(answer_number(store, &complete_mass, error,
                    "SELECT avg(%s) FROM run WHERE point_id = %lld AND results_version = %lld AND counts = 1%s",
                    OUTCOME_NAME(complete_mass), (long long)point_id, (long long)out->results_version, condition));
  /* fmax ignores a NaN */
  out->element_mass = fmax(out->element_mass, element_mass / estimates_window_elements(ESTIMATES_FROM_10));
  out->complete_mass = fmax(out->complete_mass, complete_mass);
  return STATUS_OK;
}

status point_read_where(struct store *store, int64_t point_id, int64_t results_version, const char *where,
                        struct point_data *out, struct error *error) {
  *out = POINT_EMPTY(point_id, results_version);
  const status code = point_add(store, point_id, where, out, error);
  if (code)
    point_release(out);
  return code;
}

status point_read(struct store *store, int64_t point_id, int64_t results_version, struct point_data *out,
                  struct error *error) {
  return point_read_where(store, point_id, results_version, NULL, out, error);
}

void point_release(struct point_data *point) {
  free(point->first);
  free(point->masses);
  free(point->run_id);
  free(point->seed);
  point->first = NULL;
  point->run_id = NULL;
  point->seed = NULL;
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

status point_exponent_of_runs(const struct point_data *point, enum exponent_method method, enum estimates_window window,
                              double *values, struct error *error) {
  const double lower = point_window(point, window);
  for (size_t r = 0; r < point->runs.count; r++)
    values[r] = NAN;
  return lower > 0 ? pooled_exponent_of_runs(&point->runs, method, lower, values, error) : STATUS_OK;
}

void point_estimate_rows(const struct point_estimate fits[POINT_ESTIMATES], struct estimate rows[POINT_ESTIMATES]) {
  for (int i = 0; i < POINT_ESTIMATES; i++) {
    const struct point_estimate *made = &fits[i];
    rows[i] = (struct estimate){.window = (int)made->window, .fit = made->exponent.fit};
    if (isfinite(made->exponent.interval.half_width))
      rows[i].fit.standard_error = made->exponent.interval.standard_error;
    rows[i].half_width = made->exponent.interval.half_width;
    rows[i].headline = rows[i].window == ESTIMATES_HEADLINE_WINDOW && rows[i].fit.method == ESTIMATES_HEADLINE_METHOD;
  }
}

status point_exponent(struct store *store, int64_t point_id, int64_t results_version, enum exponent_method method,
                      enum estimates_window window, double level, struct pooled_exponent *out, struct error *error) {
  POINT_DATA point = {0};
  TRY(point_read(store, point_id, results_version, &point, error));
  return estimate(&point, method, window, level, out, error);
}

status point_estimates(const struct point_data *point, double level, struct point_estimate rows[POINT_ESTIMATES],
                       struct error *error) {
  static const enum exponent_method methods[] = {EXPONENT_LEAST_SQUARES, EXPONENT_MASSES};
  status code = STATUS_OK;
  for (int i = 0; i < POINT_ESTIMATES && !code; i++) {
    rows[i] = (struct point_estimate){.window = (enum estimates_window)(i % ESTIMATES_WINDOWS)};
    code = estimate(point, methods[i / ESTIMATES_WINDOWS], rows[i].window, level, &rows[i].exponent, error);
  }
  return code;
}
