/* Reads the fragments of one point and estimates its exponents. */
#include "db/ask/point.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/query.h"
#include "engine/engine.h"
#include "engine/grow.h"
#include "schemas/text.h"

struct growing {
  struct point_data *point;
  size_t mass_capacity, run_capacity;
};

static status make_room(struct growing *growing, size_t masses) {
  struct point_data *point = growing->point;
  if (masses > growing->mass_capacity) {
    if (!grow_block(&point->masses, 2 * masses * sizeof *point->masses))
      return STATUS_MEMORY;
    growing->mass_capacity = 2 * masses;
  }
  if (point->runs.count + 2 <= growing->run_capacity)
    return STATUS_OK;
  const size_t capacity = growing->run_capacity ? 2 * growing->run_capacity : 32;
  if (!grow_block(&point->first, capacity * sizeof *point->first) ||
      !grow_block(&point->run_id, capacity * sizeof *point->run_id) ||
      !grow_block(&point->seed, capacity * sizeof *point->seed))
    return STATUS_MEMORY;
  growing->run_capacity = capacity;
  return STATUS_OK;
}

/* Blobs are little-endian float64, which is the native format of every supported machine. */
static status take_run(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct growing *growing = context;
  struct point_data *point = growing->point;
  if (count != 3 || values[0].kind != QUERY_BLOB || values[0].size % sizeof(double) != 0)
    return status_fail(error, STATUS_CONTENT,
                       "the fragment masses of a run of point %lld are damaged; `clast check` tells more",
                       (long long)point->point_id);
  const size_t n = values[0].size / sizeof(double), have = point->first[point->runs.count];
  if (make_room(growing, have + n))
    return status_fail(error, STATUS_MEMORY, "no memory for the runs of point %lld", (long long)point->point_id);
  if (n > 0)
    memcpy(point->masses + have, values[0].blob, n * sizeof(double));
  point->run_id[point->runs.count] = values[1].integer;
  point->seed[point->runs.count] = (uint64_t)values[2].integer;
  point->first[++point->runs.count] = have + n;
  return STATUS_OK;
}

/* A read-only store from before this column was added lacks it. */
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

/* A row of results_version and engine; the engine becomes its dimensions. */
static status take_version(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)count, (void)error;
  struct query_value *row = context;
  row[0].integer = values[0].integer;
  const struct engine_kind *kind = values[1].kind == QUERY_TEXT ? engine_find(values[1].text, NULL) : NULL;
  row[1].integer = kind && kind->dimensions == 2 ? 2 : 3;
  return STATUS_OK;
}

/* The newest version with runs that count (0: none), and the dimensions of the engine. */
static status read_version(struct store *store, const struct query_parameter *id, struct point_data *out,
                           struct error *error) {
  struct query_value row[2] = {{0}};
  const struct query_sink sink = {row, NULL, take_version};
  const status code = query_run(store,
                                "SELECT (SELECT max(results_version) FROM run WHERE point_id = p.point_id AND "
                                "counts = 1), engine FROM point AS p WHERE point_id = :point",
                                1, id, 0, &sink, error);
  if (out->results_version == 0)
    out->results_version = row[0].integer;
  out->dimensions = (int)row[1].integer;
  return code;
}

static status read_runs(struct store *store, const struct query_parameter parameters[2], const char *where,
                        struct point_data *out, struct error *error) {
  struct growing growing = {.point = out};
  const struct query_sink sink = {.context = &growing, .row = take_run};
  char *sql = NULL;
  size_t size = 0;
  FILE *text = open_memstream(&sql, &size);
  if (!text || make_room(&growing, 0)) {
    if (text)
      fclose(text);
    free(sql);
    return status_fail(error, STATUS_MEMORY, "no memory for the runs of point %lld", (long long)out->point_id);
  }
  out->first[0] = 0;
  fputs("SELECT masses, run_id, seed FROM run JOIN fragment_mass USING (run_id) WHERE point_id = :point AND "
        "results_version = :version AND counts = 1",
        text);
  if (where)
    fprintf(text, " AND run_id IN (SELECT run_id FROM runs WHERE point_id = :point AND (%s\n))", where);
  fputs(" ORDER BY replicate, seed", text);
  if (!text_close(text, &sql))
    return status_fail(error, STATUS_MEMORY, "no memory for a question to the store");
  const status code = query_run(store, sql, 2, parameters, 0, &sink, error);
  free(sql);
  return code;
}

status point_read_where(struct store *store, int64_t point_id, int64_t results_version, const char *where,
                        struct point_data *out, struct error *error) {
  *out = (struct point_data){.point_id = point_id,
                             .results_version = results_version,
                             .element_mass = NAN,
                             .complete_mass = NAN};
  char id[32], version[32];
  snprintf(id, sizeof id, "%lld", (long long)point_id);
  struct query_parameter parameters[2] = {{"point", id}, {"version", version}};
  status code = read_version(store, parameters, out, error);
  if (code)
    return code;
  snprintf(version, sizeof version, "%lld", (long long)out->results_version);
  code = read_runs(store, parameters, where, out, error);
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
