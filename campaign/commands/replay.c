/* `clast replay STORE RUN`: computes a stored run again and compares every bit. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/run.h"
#include "campaign/terminal/rows.h"
#include "engine/atomic_file.h"
#include "engine/cpu_class.h"

struct options {
  const char *fields;
  struct table_options table;
};

struct origin { /* what the store says of the run */
  char *scene;
  int64_t seed, results_version;
  char cpu_class[16]; /* whose bits they are; empty when the session does not say */
  bool found;
};

static status take_origin(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct origin *origin = context;
  if (count != 4 || values[0].kind != QUERY_TEXT)
    return status_fail(error, STATUS_CONTENT, "the store has no scene for this run");
  origin->scene = strdup(values[0].text);
  origin->seed = values[1].integer;
  origin->results_version = values[2].integer;
  if (values[3].kind == QUERY_TEXT)
    snprintf(origin->cpu_class, sizeof origin->cpu_class, "%s", values[3].text);
  origin->found = true;
  return origin->scene ? STATUS_OK : status_fail(error, STATUS_MEMORY, "out of memory");
}

struct comparison {
  const struct run_result *result;
  const struct engine_kind *kind;
  char (*names)[128]; /* of the columns */
  size_t columns;
  size_t compared, different;
  struct table *table;
};

static status take_names(void *context, size_t count, const char *const *names, struct error *error) {
  struct comparison *comparison = context;
  comparison->names = calloc(count, sizeof *comparison->names);
  if (!comparison->names)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  for (size_t i = 0; i < count; i++)
    snprintf(comparison->names[i], sizeof comparison->names[i], "%s", names[i]);
  comparison->columns = count;
  return STATUS_OK;
}

static bool same_value(const struct field *row, const struct field_value *computed, const struct query_value *stored) {
  switch (row->kind) {
  case FIELD_REAL:
    if (isnan(computed->number))
      return stored->kind == QUERY_NULL || isnan(stored->real);
    return stored->kind != QUERY_NULL && computed->number == stored->real &&
           signbit(computed->number) == signbit(stored->real);
  case FIELD_INTEGER: return stored->kind == QUERY_INTEGER && computed->integer == stored->integer;
  case FIELD_BOOLEAN: return stored->kind == QUERY_INTEGER && (computed->number != 0) == (stored->integer != 0);
  case FIELD_CHOICE:
  case FIELD_TEXT:
    return stored->kind == QUERY_NULL ? !*computed->text : stored->text && strcmp(computed->text, stored->text) == 0;
  }
  return false;
}

static void difference(struct comparison *comparison, const char *what, const char *stored, const char *computed) {
  comparison->different++;
  table_text(comparison->table, what);
  table_text(comparison->table, stored);
  table_text(comparison->table, computed);
}

static void compare_value(struct comparison *comparison, const struct field *row, const void *object,
                          const struct query_value *stored) {
  struct field_value computed;
  field_get(row, object, &computed);
  comparison->compared++;
  if (same_value(row, &computed, stored))
    return;
  char text[FIELD_TEXT_SIZE], kept[FIELD_TEXT_SIZE];
  field_print(row, &computed, text, sizeof text);
  if (stored->kind == QUERY_TEXT)
    snprintf(kept, sizeof kept, "%s", stored->text);
  else
    snprintf(kept, sizeof kept, "%.17g", stored->real);
  difference(comparison, row->path, kept, text);
}

static status compare_row(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct comparison *comparison = context;
  const struct field_table *tables[] = {&outcome_table, comparison->kind->results};
  const void *objects[] = {&comparison->result->outcome, comparison->result->result};
  for (size_t t = 0; t < 2; t++)
    for (size_t i = 0; i < tables[t]->count; i++) {
      const struct field *row = &tables[t]->rows[i];
      char column[sizeof *comparison->names];
      field_column_name(row->path, column, sizeof column);
      for (size_t c = 0; c < count; c++)
        if (strcmp(comparison->names[c], column) == 0) {
          compare_value(comparison, row, objects[t], &values[c]);
          break;
        }
    }
  return STATUS_OK;
}

static status compare_masses(void *context, size_t count, const struct query_value *values, struct error *error) {
  (void)error;
  struct comparison *comparison = context;
  const struct run_result *result = comparison->result;
  bool same = count == 1 && values[0].kind == QUERY_BLOB && values[0].size == 8 * result->fragment_count;
  for (size_t i = 0; same && i < result->fragment_count; i++) /* blob and machine are both little-endian */
    same = memcmp((const char *)values[0].blob + 8 * i, &result->fragments[i].mass, 8) == 0;
  comparison->compared++;
  if (!same)
    difference(comparison, "fragment masses", "other", "masses");
  return STATUS_OK;
}

static status compare(struct store *store, const struct query_parameter *run, struct comparison *comparison,
                      struct error *error) {
  char sql[256];
  snprintf(sql, sizeof sql, "select * from run join result_%s using (run_id) where run_id = :run",
           comparison->kind->name);
  struct query_sink values = {comparison, take_names, compare_row}, masses = {comparison, NULL, compare_masses};
  status code = query_run(store, sql, 1, run, 0, &values, error);
  if (!code)
    code = query_run(store, "select masses from fragment_mass where run_id = :run", 1, run, 0, &masses, error);
  if (!code && comparison->compared < 3)
    code = status_fail(error, STATUS_CONTENT, "the store keeps no results of run %s", run->value);
  return code;
}

static status replay(struct store *store, const char *run_id, const struct options *options, enum table_format format,
                     struct error *error) {
  struct query_parameter run = {"run", run_id};
  struct origin origin = {0};
  struct query_sink sink = {&origin, NULL, take_origin};
  struct scene *scene = NULL;
  struct run_result result = {0};
  struct comparison comparison = {.result = &result};
  status code = query_run(
      store,
      "select scene, seed, results_version, json_extract(facts, '$.cpu_class') from run join point using (point_id)"
      " left join session using (session_id) where run_id = :run",
      1, &run, 0, &sink, error);
  if (!code && !origin.found)
    code = status_fail(error, STATUS_USAGE,
                       "there is no run %s; `clast query STORE \"select run_id from run\"` lists them", run_id);
  if (!code)
    code = scene_parse("scene of the run", origin.scene, &scene, error);
  if (!code && scene->kind->results_version != origin.results_version)
    code =
        status_fail(error, STATUS_CONTENT,
                    "run %s was made by results version %" PRId64 " of engine %s, this program makes version %d: its "
                    "bits differ on purpose; replay it with the program of that version (table session has its commit)",
                    run_id, origin.results_version, scene->kind->name, scene->kind->results_version);
  if (!code && options->fields)
    code = atomic_file_try(options->fields, "fields file", error);
  if (!code) {
    struct run_request request = {.kind = scene->kind,
                                  .inputs = scene->inputs,
                                  .seed = (uint64_t)origin.seed,
                                  .fields_path = options->fields};
    code = run_simulate(&request, NULL, NULL, 0, &result, error);
  }
  if (!code) {
    comparison.kind = scene->kind;
    comparison.table = table_new(format, stdout);
    table_column(comparison.table, "result", NULL);
    table_column(comparison.table, "stored", NULL);
    table_column(comparison.table, "recomputed", NULL);
    code = compare(store, &run, &comparison, error);
    status ended = STATUS_OK;
    if (format != TABLE_TEXT || comparison.different)
      ended = table_end(comparison.table, code ? NULL : error);
    else
      table_drop(comparison.table);
    code = code ? code : ended;
  }
  char class[160] = "";
  const char *here = cpu_class_name(cpu_class_choose());
  if (*origin.cpu_class && strcmp(origin.cpu_class, here) != 0)
    snprintf(
        class, sizeof class,
        "; they are of CPU class %s and these of %s, and bits are promised within a class: replay with CLAST_CPU=%s",
        origin.cpu_class, here, origin.cpu_class);
  if (!code && comparison.different)
    code = status_fail(error, STATUS_CONTENT, "run %s: %zu of %zu results differ%s", run_id, comparison.different,
                       comparison.compared, class);
  else if (!code)
    fprintf(stderr, "run %s: %zu results and %zu fragment masses agree to the last bit\n", run_id,
            comparison.compared - 1, result.fragment_count);
  if (!code && options->fields && result.outcome.state == OUTCOME_INVALID)
    fprintf(stderr, "clast: the run is invalid and has no fields: %s is not written\n", options->fields);
  free(comparison.names);
  free(origin.scene);
  run_result_clear(&result);
  scene_free(scene);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  status code = table_choose(&options->table, &format, error);
  if (!code && strspn(line->arguments[1], "0123456789") != strlen(line->arguments[1]))
    code = status_fail(error, STATUS_USAGE, "RUN is a number (run_id in the store), got \"%.64s\"", line->arguments[1]);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = replay(store, line->arguments[1], options, format, error);
  store_close(store, NULL);
  return code;
}

static const struct option_row rows[] = {
    {"fields", 0, OPTION_TEXT, "FILE.h5", offsetof(struct options, fields), 0, 0, NULL,
     "Write the fields of the run, to look at it or draw it with `clast picture`."},
    TABLE_OPTIONS(struct options, table),
};

const struct command replay_command = {
    .name = "replay",
    .group = "the store",
    .arguments = "STORE RUN",
    .summary = "compute a stored run again and compare every bit",
    .doc = "Takes the scene and seed of run number RUN (run_id) from the store, computes it again and compares all "
           "results\n"
           "and fragment masses. Differences are printed as a table; exit 65 when there are any. The store is not "
           "changed.",
    .examples = "clast replay out.db 17\nclast replay out.db 17 --fields run17.h5",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
