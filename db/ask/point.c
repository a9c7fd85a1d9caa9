/* Reads the fragments of one point and estimates its exponents. */
#include "db/ask/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/sql.h"
#include "engine/engine.h"
#include "engine/grow.h"

struct growing {
  struct point_data *point;
  size_t masses, firsts, runs, seeds; /* room in its arrays */
};

/* Room for so many masses, and one more run. */
static status make_room(struct growing *growing, size_t masses, struct error *error) {
  static const char what[] = "the runs of a point";
  struct point_data *point = growing->point;
  const size_t runs = point->runs.count + 2;
  TRY(grow_or_fail(&point->masses, &growing->masses, masses, sizeof *point->masses, what, error));
  TRY(grow_or_fail(&point->first, &growing->firsts, runs, sizeof *point->first, what, error));
  TRY(grow_or_fail(&point->run_id, &growing->runs, runs, sizeof *point->run_id, what, error));
  return grow_or_fail(&point->seed, &growing->seeds, runs, sizeof *point->seed, what, error);
}

/* The newest version with runs that count (0: none), unless one is given, and the dimensions of the engine. */
static status read_version(struct store *store, struct point_data *out, struct error *error) {
  ANSWER
  answer = answer_to(store, error,
                     "SELECT (SELECT max(results_version) FROM run WHERE point_id = p.point_id AND counts = 1), engine "
                     "FROM point AS p WHERE point_id = %lld",
                     (long long)out->point_id);
  if (answer_next(&answer)) {
    if (out->results_version == 0)
      out->results_version = answer_integer(&answer, 0);
    const struct engine_kind *kind = engine_find(answer_text(&answer, 1), NULL);
    out->dimensions = kind && kind->dimensions == 2 ? 2 : 3;
  }
  return answer_end(&answer);
}

static status read_runs(struct store *store, const char *where, struct point_data *out, struct error *error) {
  const long long point = out->point_id, version = out->results_version;
  struct growing growing = {.point = out};
  SQL_TEXT condition = where ? sql_format(" AND run_id IN (SELECT run_id FROM runs WHERE point_id = %lld AND (%s\n))",
                                          point, where)
                             : sql_format("");
  char of[64];
  snprintf(of, sizeof of, "a run of point %lld", point);
  TRY(make_room(&growing, 0, error));
  out->first[0] = 0;
  ANSWER answer = answer_to(store, error,
                            "SELECT masses, run_id, seed FROM run JOIN fragment_mass USING (run_id) WHERE point_id = "
                            "%lld AND results_version = %lld AND counts = 1%s ORDER BY replicate, seed",
                            point, version, condition);
  const void *masses;
  size_t n;
  while (answer_next(&answer) && answer_masses(&answer, 0, of, &masses, &n)) {
    const size_t run = out->runs.count, have = out->first[run];
    TRY(make_room(&growing, have + n, error));
    if (n > 0)
      memcpy(out->masses + have, masses, n * sizeof(double));
    out->run_id[run] = answer_integer(&answer, 1);
    out->seed[run] = (uint64_t)answer_integer(&answer, 2);
    out->first[++out->runs.count] = have + n;
  }
  return answer_end(&answer);
}

static status read_point(struct store *store, const char *where, struct point_data *out, struct error *error) {
  TRY(read_version(store, out, error));
  TRY(read_runs(store, where, out, error));
  /* The window from_10 of a run begins at a known number of its mean element masses: complete_mass is never above. */
  TRY(answer_number(store, &out->element_mass, error,
                    "SELECT avg(lower) FROM estimate e JOIN run r ON r.run_id = e.run_id WHERE r.point_id = %lld "
                    "AND r.results_version = %lld AND r.counts = 1 AND e.method = 'masses' AND e.window = 'from_10'",
                    (long long)out->point_id, (long long)out->results_version));
  out->element_mass /= estimates_window_elements(ESTIMATES_FROM_10);
  return answer_number(store, &out->complete_mass, error,
                       "SELECT avg(%s) FROM run WHERE point_id = %lld AND results_version = %lld AND counts = 1",
                       OUTCOME_NAME(complete_mass), (long long)out->point_id, (long long)out->results_version);
}

status point_read_where(struct store *store, int64_t point_id, int64_t results_version, const char *where,
                        struct point_data *out, struct error *error) {
  *out = (struct point_data){.point_id = point_id,
                             .results_version = results_version,
                             .element_mass = NAN,
                             .complete_mass = NAN,
                             .dimensions = 3};
  const status code = read_point(store, where, out, error);
  if (code)
    point_release(out);
  else
    out->runs = (struct pooled_runs){out->runs.count, out->first, out->masses};
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
