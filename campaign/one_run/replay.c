/* Computes a stored run again and compares values by their bits, column by column. */
#include "campaign/one_run/one_run.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "engine/cpu_class.h"
#include "schemas/memory.h"

status replay_compute(const struct ask_run *from, int64_t run_id, const char *fields, struct scene **scene,
                      struct run_result *result, struct error *error) {
  if (!from->scene)
    return status_fail(error, STATUS_USAGE,
                       "there is no run %" PRId64 "; `clast query STORE --named runs --with point=1` "
                       "lists those of point 1",
                       run_id);
  TRY(scene_parse_json("scene of the run", from->scene, scene, error));

  const struct engine_kind *kind = (*scene)->kind;
  char build[PROVENANCE_BUILD_SIZE];
  provenance_other_build(from->version, from->commit, from->compiler, build);
  if (kind->results_version != from->results_version)
    return status_fail(error, STATUS_CONTENT,
                       "run %" PRId64 " was made by results version %" PRId64
                       " of engine %s, this program makes version %d: its bits differ on purpose; replay it with the "
                       "program of that version%s%s",
                       run_id, from->results_version, kind->name, kind->results_version, *build ? ": " : "", build);
  if (fields)
    TRY(engine_has_fields(kind, "fields files", error));
  TRY(engine_ready(kind, (*scene)->inputs, error));
  const struct run_request request = {.kind = kind,
                                      .inputs = (*scene)->inputs,
                                      .seed = from->seed,
                                      .fields_path = fields};
  return run_simulate(&request, NULL, NULL, 0, result, error);
}

struct comparison {
  const struct run_result *result;
  const struct engine_kind *kind;
  struct replay_compare *out;
  struct table *table;
  const struct field **doubtful; /* `doubtful_count` rows that have a value now and none in the store */
  size_t doubtful_count;
};

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
  comparison->out->different++;
  table_text(comparison->table, what);
  table_text(comparison->table, stored);
  table_text(comparison->table, computed);
}

static void compare_value(struct comparison *comparison, const struct field *row, const void *object,
                          const struct query_value *stored) {
  struct field_value computed;
  field_get(row, object, &computed);
  const bool same = same_value(row, &computed, stored);
  if (!same && stored->kind == QUERY_NULL) {
    comparison->doubtful[comparison->doubtful_count++] = row;
    return;
  }
  comparison->out->compared++;
  if (same)
    return;

  char text[FIELD_TEXT_SIZE], kept[FIELD_TEXT_SIZE];
  field_print(row, &computed, text, sizeof text);
  if (stored->kind == QUERY_TEXT)
    snprintf(kept, sizeof kept, "%s", stored->text);
  else
    snprintf(kept, sizeof kept, "%.17g", stored->real);
  difference(comparison, row->path, kept, text);
}

static void compare_table(struct comparison *comparison, const struct field_table *table, const void *object,
                          const struct answer *stored) {
  const size_t count = answer_count(stored);
  for (size_t i = 0; i < table->count; i++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(table->rows[i].path, name, sizeof name);
    size_t column = 0;
    while (column < count && strcmp(name, answer_name(stored, column)) != 0)
      column++;
    const struct query_value value = column < count ? answer_value(stored, column) : (struct query_value){0};
    if (column < count)
      compare_value(comparison, &table->rows[i], object, &value);
  }
}

static status compare_results(struct comparison *comparison, struct store *store, int64_t run_id, struct error *error) {
  struct replay_compare *out = comparison->out;
  ANSWER stored = ask_run_results(store, run_id, comparison->kind->name, error);
  if (!answer_next(&stored))
    return answer_end(&stored);
  OWNED const struct field **doubtful = memory_small(answer_count(&stored), sizeof *doubtful);
  comparison->doubtful = doubtful;
  compare_table(comparison, &outcome_table, &comparison->result->outcome, &stored);
  compare_table(comparison, comparison->kind->results, comparison->result->result, &stored);
  TRY(answer_end(&stored));
  for (size_t i = 0; i < comparison->doubtful_count; i++) {
    char name[FIELD_TEXT_SIZE];
    bool used = false;
    field_column_name(doubtful[i]->path, name, sizeof name);
    TRY(ask_run_column_used(store, run_id, comparison->kind->name, name, &used, error));
    if (used) { /* of some stored run: the program knew the result then, and this run differs */
      out->compared++;
      difference(comparison, doubtful[i]->path, NULL, "a value");
      continue;
    }
    text_append(out->absent_names, sizeof out->absent_names, "%s%s", *out->absent_names ? ", " : "", name);
    out->absent++;
  }
  return STATUS_OK;
}

static void compare_masses(struct comparison *comparison, const double *masses, size_t count) {
  const struct run_result *result = comparison->result;
  bool same = count == result->fragment_count;
  for (size_t i = 0; same && i < count; i++)
    same = memcmp(&masses[i], &result->fragments[i].mass, sizeof masses[i]) == 0;
  comparison->out->compared++;
  if (!same)
    difference(comparison, "fragment masses", "other", "masses");
}

static status compare_ejecta(struct comparison *comparison, struct store *store, int64_t run_id, struct error *error) {
  const struct ejecta *here = engine_ejecta(comparison->kind, comparison->result->result);
  struct ejecta ejecta;
  bool stored;
  TRY(ask_run_ejecta(store, run_id, &ejecta, &stored, error));
  if (!here || !stored) /* of an older program */
    return STATUS_OK;
  comparison->out->compared++;
  for (int i = 0; i < EJECTA_BINS; i++)
    if (here->bin[i].mass != ejecta.bin[i].mass || here->bin[i].momentum != ejecta.bin[i].momentum) {
      difference(comparison, "ejecta over speed", "other", "masses");
      break;
    }
  return STATUS_OK;
}

status replay_compare(struct store *store, int64_t run_id, const struct engine_kind *kind,
                      const struct run_result *result, struct table *table, struct replay_compare *out,
                      struct error *error) {
  *out = (struct replay_compare){0};
  struct comparison comparison = {.result = result, .kind = kind, .out = out, .table = table};
  OWNED double *masses = NULL;
  size_t count = 0;
  TRY(compare_results(&comparison, store, run_id, error));
  TRY(ask_run_masses(store, run_id, &masses, &count, error));
  if (masses)
    compare_masses(&comparison, masses, count);
  TRY(compare_ejecta(&comparison, store, run_id, error));
  if (out->compared < 3)
    return status_fail(error, STATUS_CONTENT, "the store keeps no results of run %" PRId64, run_id);
  return STATUS_OK;
}

status replay_verdict(struct store *store, int64_t run_id, const struct ask_run *stored,
                      const struct replay_compare *comparison, bool promised, struct error *error) {
  bool whole = true;
  TRY(store_check_run(store, run_id, &whole, error));
  if (!whole)
    return status_fail(error, STATUS_CONTENT,
                       "run %" PRId64
                       " is damaged in the store: a bit has changed since it was stored; %zu of %zu results "
                       "differ. `clast check` lists all such runs; restore a copy, or compute them in a new store",
                       run_id, comparison->different, comparison->compared);
  if (comparison->different == 0 || !promised)
    return STATUS_OK;

  char class[200] = "";
  const char *here = cpu_class_name(cpu_class_choose());
  if (*stored->cpu_class && strcmp(stored->cpu_class, here) != 0)
    snprintf(class, sizeof class,
             "; the stored ones are of CPU class %s and these of %s, and only runs of one class have the same bits: "
             "replay with CLAST_CPU=%s",
             stored->cpu_class, here, stored->cpu_class);
  return status_fail(error, STATUS_CONTENT, "run %" PRId64 ": %zu of %zu results differ%s", run_id,
                     comparison->different, comparison->compared, class);
}
