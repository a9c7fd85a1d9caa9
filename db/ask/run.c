/* One stored run, and how long runs take. */
#include "db/ask/run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/store/shapes.h"

static void take_fact(const struct query_value *value, char *text, size_t size) {
  snprintf(text, size, "%s", value->kind == QUERY_TEXT ? value->text : "");
}

static status take_run(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct ask_run *run = context;
  if (count != 7 || values[0].kind != QUERY_TEXT)
    return status_fail(error, STATUS_CONTENT, "the store has no scene for this run");
  run->scene = strdup(values[0].text);
  if (!run->scene)
    return status_fail(error, STATUS_MEMORY, "out of memory");

  run->seed = (uint64_t)values[1].integer;
  run->results_version = values[2].integer;
  take_fact(&values[3], run->cpu_class, sizeof run->cpu_class);
  take_fact(&values[4], run->version, sizeof run->version);
  take_fact(&values[5], run->commit, sizeof run->commit);
  take_fact(&values[6], run->compiler, sizeof run->compiler);
  return STATUS_OK;
}

status ask_run_read(struct store *store, int64_t run_id, struct ask_run *run, struct error *error) {
  *run = (struct ask_run){0};
  const struct query_sink sink = {.context = run, .row = take_run};
  char sql[512];
  snprintf(sql, sizeof sql,
           "SELECT scene, seed, results_version, json_extract(facts, '$.cpu_class'), json_extract(facts, '$.version'), "
           "json_extract(facts, '$.commit') || iif(json_extract(facts, '$.dirty'), ' with local changes', ''), "
           "json_extract(facts, '$.compiler') FROM run JOIN point USING (point_id) LEFT JOIN session USING "
           "(session_id) WHERE run_id = %lld",
           (long long)run_id);
  const status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  return code ? code : shapes_load(store, run_id, error);
}

void ask_run_release(struct ask_run *run) {
  free(run->scene);
  run->scene = NULL;
}

status ask_run_results(struct store *store, int64_t run_id, const char *engine, const struct query_sink *sink,
                       struct error *error) {
  char sql[256];
  snprintf(sql, sizeof sql, "SELECT * FROM run JOIN result_%.64s USING (run_id) WHERE run_id = %lld", engine,
           (long long)run_id);
  return query_run(store, sql, 0, NULL, 0, sink, error);
}

status ask_run_column_used(struct store *store, int64_t run_id, const char *engine, const char *column, bool *used,
                           struct error *error) {
  char sql[512];
  double count = 0;
  snprintf(sql, sizeof sql,
           "SELECT count(\"%.128s\") FROM run JOIN result_%.64s USING (run_id) WHERE session_id IS (SELECT session_id "
           "FROM run WHERE run_id = %lld)",
           column, engine, (long long)run_id);
  status code = query_number(store, sql, 0, NULL, &count, error);
  *used = count > 0;
  return code;
}

struct masses {
  double *list;
  size_t count;
};

static status take_masses(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct masses *masses = context;
  if (count != 1 || values[0].kind != QUERY_BLOB || values[0].size % sizeof(double) != 0)
    return status_fail(error, STATUS_CONTENT, "the fragment masses of this run are damaged; `clast check` tells more");
  masses->list = malloc(values[0].size + sizeof(double));
  if (!masses->list)
    return status_fail(error, STATUS_MEMORY, "out of memory");

  masses->count = values[0].size / sizeof(double);
  if (values[0].size > 0) /* the blob is little-endian float64, which is the machine's own format */
    memcpy(masses->list, values[0].blob, values[0].size);
  return STATUS_OK;
}

status ask_run_masses(struct store *store, int64_t run_id, double **masses, size_t *count, struct error *error) {
  struct masses found = {0};
  const struct query_sink sink = {.context = &found, .row = take_masses};
  char sql[128];
  snprintf(sql, sizeof sql, "SELECT masses FROM fragment_mass WHERE run_id = %lld", (long long)run_id);
  status code = query_run(store, sql, 0, NULL, 0, &sink, error);
  *masses = found.list;
  *count = found.count;
  return code;
}

status ask_run_wall_times(struct store *store, double *mean, double *longest, struct error *error) {
  *longest = NAN;
  status code = query_number(store, "SELECT avg(wall_time) FROM run", 0, NULL, mean, error);
  if (code)
    return code;
  return query_number(store, "SELECT max(wall_time) FROM run", 0, NULL, longest, error);
}
