/* Adding rows of runs. Every statement is prepared once; adding a run needs no further SQL text or JSON. */
#include <stdlib.h>
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"

static const char adding_run[] = "adding a run";

static const struct sql_column run_id_column = {"run_id", SQL_COLUMN_INTEGER, 0};

/* The column names for digest_run(), made once for a store and an engine. */
static status name_columns(struct store *store, struct store_kind *kind, struct error *error) {
  const struct schema_table results = schema_result_table(kind->kind);
  store->name_of.identity = digest_name("run", "identity");
  store->name_of.replicate = digest_name("run", "replicate");
  store->name_of.seed = digest_name("run", "seed");
  store->name_of.results_version = digest_name("run", "results_version");
  store->name_of.masses = digest_name("fragment_mass", "masses");
  status result = digest_names_make(&store->outcome_names, "run", &outcome_table, error);
  if (result == STATUS_OK)
    result = digest_names_make(&store->estimate_names, "estimate", &estimates_table, error);
  return result == STATUS_OK ? digest_names_make(&kind->names, results.name, kind->kind->results, error) : result;
}

static status has_no_rows(struct store *store, const char *table, bool *none, struct error *error) {
  int64_t filled = 0;
  const status result = sql_integerf(store->db, &filled, error, "SELECT EXISTS (SELECT 1 FROM \"%w\")", table);
  *none = filled == 0;
  return result;
}

/* Creates the engine's result table, or adds its missing columns. */
static status complete_table(struct store *store, const struct schema_table *table, bool *grown, struct error *error) {
  static const char version[] = "PRAGMA schema_version";
  int64_t before = 0, after = 0;
  status result = sql_integer(store->db, version, 0, &before, error);
  if (result == STATUS_OK)
    result = schema_complete(store->db, table, error);
  if (result == STATUS_OK)
    result = sql_integer(store->db, version, 0, &after, error);
  *grown = *grown || before != after;
  return result;
}

/* Prepares all tables that the store keeps for an engine. */
static status open_kind(struct store *store, const struct engine_kind *kind, struct store_kind *entry, bool *grown,
                        struct error *error) {
  const struct schema_table table = schema_result_table(kind);
  entry->kind = kind;
  status result = complete_table(store, &table, grown, error);
  if (result == STATUS_OK)
    result = sql_insert_prepare(store->db, &entry->insert, table.name, 1, &run_id_column, kind->results, 1, adding_run,
                                error);
  if (result == STATUS_OK)
    result = has_no_rows(store, table.name, &entry->first, error);
  return result == STATUS_OK ? name_columns(store, entry, error) : result;
}

status store_add_run_kind(struct store *store, const struct engine_kind *kind, struct store_kind **found, bool *grown,
                          struct error *error) {
  for (size_t i = 0; i < store->kind_count; i++)
    if (store->kinds[i].kind == kind) {
      *found = &store->kinds[i];
      return STATUS_OK;
    }
  if (store->kind_count == STORE_KINDS)
    return status_fail(error, STATUS_INTERNAL, "more than %d engines in one store", STORE_KINDS);
  *found = &store->kinds[store->kind_count];
  const status result = open_kind(store, kind, *found, grown, error);
  store->kind_count += result == STATUS_OK;
  return result;
}

/* The columns of table run that are not results. */
struct run_row {
  struct store_run run;
  int results_version;
  bool counts;
  double finished_at;
  uint8_t digest[16];
};
#define RUN(name_, kind_, member_)                                                                                     \
  { name_, SQL_COLUMN_##kind_, offsetof(struct run_row, member_) }
static const struct sql_column run_columns[] = {
    RUN("point_id", INTEGER, run.point_id),
    RUN("session_id", KEY, run.session_id),
    RUN("identity", IDENTITY, run.identity),
    RUN("replicate", INTEGER, run.replicate),
    RUN("seed", INTEGER, run.seed),
    RUN("results_version", INT, results_version),
    RUN("surplus", BOOLEAN, run.surplus),
    RUN("counts", BOOLEAN, counts),
    RUN("attempt", INT, run.attempt),
    RUN("wall_time", REAL, run.wall_s),
    RUN("cpu_time", REAL, run.cpu_s),
    RUN("peak_memory", INTEGER, run.peak_memory),
    RUN("host", TEXT, run.host),
    RUN("rank", INT, run.rank),
    RUN("finished_at", REAL, finished_at),
    RUN("fields_path", TEXT, run.fields_path),
    RUN("digest", IDENTITY, digest),
};

/* The digest of the rows of a run that is about to be stored. db/store/digest_rows.c computes the same from the
 * rows. */
static void digest_run(const struct store *store, const struct store_kind *kind, const struct store_run *run,
                       uint8_t digest[16]) {
  struct digest sum = {0};
  digest_add_bytes(&sum, store->name_of.identity, run->identity, sizeof run->identity);
  digest_add_integer(&sum, store->name_of.replicate, run->replicate);
  digest_add_integer(&sum, store->name_of.seed, (int64_t)run->seed);
  digest_add_integer(&sum, store->name_of.results_version, run->kind->results_version);
  digest_add_fields(&sum, &store->outcome_names, &outcome_table, 0, run->outcome);
  if (run->result)
    digest_add_fields(&sum, &kind->names, run->kind->results, 0, run->result);
  digest_add_bytes(&sum, store->name_of.masses, store->blob, 8 * run->fragment_count);
  for (size_t i = 0; i < run->estimate_count; i++)
    digest_add_fields(&sum, &store->estimate_names, &estimates_table, i, &run->estimates[i]);
  digest_write(sum, digest);
}

static status add_row(struct store *store, const struct store_kind *kind, const struct store_run *run, int64_t *run_id,
                      struct error *error) {
  status result = sql_insert_prepare(store->db, &store->run, "run", sizeof run_columns / sizeof run_columns[0],
                                     run_columns, &outcome_table, 1, adding_run, error);
  if (result != STATUS_OK)
    return result;
  struct run_row row = {.run = *run,
                        .results_version = run->kind->results_version,
                        .counts = store_run_counts(run),
                        .finished_at = store_wall_clock()};
  digest_run(store, kind, run, row.digest);
  sql_insert_bind(&store->run, 0, &row, run->outcome);
  result = sql_run(store->run.statement, adding_run, error);
  *run_id = sqlite3_last_insert_rowid(store->db);
  return result;
}

/* Adds the engine's results of the run; NULL: none. With the first run of an engine, the views get columns for its
 * results. */
static status add_result(struct store *store, struct store_kind *kind, int64_t run_id, const void *values,
                         struct error *error) {
  if (!values)
    return STATUS_OK;
  sql_insert_bind(&kind->insert, 0, &run_id, values);
  const status result = sql_run(kind->insert.statement, adding_run, error);
  if (result != STATUS_OK || !kind->first)
    return result;
  kind->first = false;
  return views_regenerate(store->db, error);
}

/* The rows of the run in all tables. */
static status add_rows(struct store *store, struct store_kind *kind, const struct store_run *run, struct error *error) {
  int64_t run_id = 0;
  status result = store_fragments_encode(store, run, error);
  if (result == STATUS_OK)
    result = add_row(store, kind, run, &run_id, error);
  if (result == STATUS_OK)
    result = add_result(store, kind, run_id, run->result, error);
  if (result == STATUS_OK)
    result = store_fragments_add(store, run_id, run, error);
  if (result != STATUS_OK || run->estimate_count == 0)
    return result;
  return store_set_estimates_rows(store, run_id, run->estimate_count, run->estimates, error);
}

static status add_run(struct store *store, const struct store_run *run, struct error *error) {
  bool grown = false;
  struct store_kind *kind = NULL;
  status result = store_add_run_kind(store, run->kind, &kind, &grown, error);
  if (result == STATUS_OK && grown)
    result = views_regenerate(store->db, error);
  if (result != STATUS_OK)
    return result;
  result = add_rows(store, kind, run, error);
  if (result != STATUS_OK)
    return result;

  struct identities_state *state = identities_add(&store->identities, run->identity);
  if (!state)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
  state->stored = true;
  memcpy(store->batch_identities[store->batch_identity_count++], run->identity, 16);
  return STATUS_OK;
}

status store_add_run(struct store *store, const struct store_run *run, struct error *error) {
  if (store_has_run(store, run->identity))
    return STATUS_OK;
  status result = store_begin(store, error);
  if (result != STATUS_OK)
    return result;
  return store_end(store, add_run(store, run, error), 1, error);
}
