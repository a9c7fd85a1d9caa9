/* One stored run, how long runs take, and which runs have their fields kept. */
#include "db/ask/run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "db/ask/columns.h"
#include "db/store/internal.h"
#include "db/store/paths.h"
#include "db/store/shapes.h"
#include "db/store/views_statistics.h"

enum { AXES = 64 };

status ask_run_read(struct store *store, int64_t run_id, struct ask_run *run, struct error *error) {
  *run = (struct ask_run){0};
  ANSWER answer = answer_to(
      store, error,
      "SELECT scene, seed, results_version, json_extract(facts, '$.cpu_class'), json_extract(facts, '$.version'), "
      "json_extract(facts, '$.commit') || iif(json_extract(facts, '$.dirty'), ' with local changes', ''), "
      "json_extract(facts, '$.compiler') FROM run JOIN point USING (point_id) LEFT JOIN session USING "
      "(session_id) WHERE run_id = %lld",
      (long long)run_id);
  if (answer_next(&answer)) {
    if (answer_value(&answer, 0).kind != QUERY_TEXT)
      return status_fail(error, STATUS_CONTENT, "the store has no scene for this run");
    run->scene = strdup(answer_text(&answer, 0));
    if (!run->scene)
      return status_fail(error, STATUS_MEMORY, "out of memory");
    run->seed = (uint64_t)answer_integer(&answer, 1);
    run->results_version = answer_integer(&answer, 2);
    snprintf(run->cpu_class, sizeof run->cpu_class, "%s", answer_text(&answer, 3));
    snprintf(run->version, sizeof run->version, "%s", answer_text(&answer, 4));
    snprintf(run->commit, sizeof run->commit, "%s", answer_text(&answer, 5));
    snprintf(run->compiler, sizeof run->compiler, "%s", answer_text(&answer, 6));
  }
  TRY(answer_end(&answer));
  return shapes_load(store, run_id, error);
}

void ask_run_release(struct ask_run *run) {
  free(run->scene);
  run->scene = NULL;
}

struct answer ask_run_results(struct store *store, int64_t run_id, const char *engine, struct error *error) {
  return answer_to(store, error, "SELECT * FROM run JOIN \"result_%w\" USING (run_id) WHERE run_id = %lld", engine,
                   (long long)run_id);
}

status ask_run_column_used(struct store *store, int64_t run_id, const char *engine, const char *column, bool *used,
                           struct error *error) {
  double count = 0;
  const status code = answer_number(
      store, &count, error,
      "SELECT count(\"%w\") FROM run JOIN \"result_%w\" USING (run_id) WHERE session_id IS (SELECT session_id "
      "FROM run WHERE run_id = %lld)",
      column, engine, (long long)run_id);
  *used = count > 0;
  return code;
}

status ask_run_masses(struct store *store, int64_t run_id, double **masses, size_t *count, struct error *error) {
  const void *stored;
  *masses = NULL;
  *count = 0;
  ANSWER answer = answer_to(store, error, "SELECT masses FROM fragment_mass WHERE run_id = %lld", (long long)run_id);
  if (!answer_next(&answer) || !answer_masses(&answer, 0, "this run", &stored, count))
    return answer_end(&answer);
  *masses = malloc((*count + 1) * sizeof **masses);
  if (!*masses)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  if (*count > 0)
    memcpy(*masses, stored, *count * sizeof **masses);
  return STATUS_OK;
}

status ask_run_wall_times(struct store *store, double *mean, double *longest, struct error *error) {
  *longest = NAN;
  TRY(answer_number(store, mean, error, "SELECT avg(wall_time) FROM run"));
  return answer_number(store, longest, error, "SELECT max(wall_time) FROM run");
}

struct answer ask_run_kept(struct store *store, struct error *error) {
  struct ask_column axes[AXES];
  const char *results[VIEWS_STATISTICS_MAIN];
  const size_t result_count = views_statistics_main(results);
  size_t axis_count = 0;
  const status code = ask_columns_axes(store, false, AXES, axes, &axis_count, error);
  if (code)
    return answer_failed(code, error);
  sqlite3_str *columns = sqlite3_str_new(NULL);
  for (size_t i = 0; i < axis_count + result_count; i++)
    sqlite3_str_appendf(columns, ", \"%w\"", i < axis_count ? axes[i].name : results[i - axis_count]);
  return answer_to(
      store, error,
      "SELECT run_id, point_id, seed%z, fields_path AS fields FROM runs WHERE counts AND typeof(fields_path) = "
      "'text' AND results_version = (SELECT max(results_version) FROM run AS newest WHERE newest.point_id = "
      "runs.point_id) ORDER BY point_id, replicate",
      sqlite3_str_finish(columns));
}

char *ask_run_fields(const struct answer *answer, size_t column) {
  return paths_of_fields(answer->store->path, answer_text(answer, column));
}
