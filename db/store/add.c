/* Adding rows: campaigns, points with their inputs and shape files, axes, runs with everything that follows from them,
 * and attempts. Statements are prepared once; adding a run needs no further SQL text or JSON. */
#include <string.h>

#include "db/store/internal.h"
#include "db/store/schema.h"
#include "db/store/views.h"
#include "engine/grow.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

static const char adding_point[] = "adding a point";
static const char adding_campaign[] = "adding a campaign";
static const char adding_run[] = "adding a run";

/* ---- engines ---- */

/* Results that a scene names itself: scenes that give one name to results of different units need different stores. */
static status check_defined(struct store *store, const struct engine_kind *kind, const char *table,
                            struct error *error) {
  for (size_t i = 0; kind->definition && i < kind->results->count; i++) {
    const struct field *row = &kind->results->rows[i];
    SQL_TEXT unit = NULL;
    if (sqlite3_keyword_check(row->path, (int)strlen(row->path)))
      return status_fail(error, STATUS_CONTENT, "result '%s' of the scene is a word of SQL: give it another name",
                         row->path);
    TRY(sql_textf(
        store->db, &unit, adding_run, error,
        "SELECT ifnull((SELECT ifnull(unit, '1') FROM column_doc WHERE table_name = %Q AND column_name = %Q), '')",
        table, row->path));
    if (unit && *unit && strcmp(unit, row->unit) != 0)
      return status_fail(
          error, STATUS_CONTENT,
          "the store has a result '%s' of another scene with the unit %s, here it is %s: give it another "
          "name, or name another store",
          row->path, unit, row->unit);
  }
  return STATUS_OK;
}

/* Prepares all tables that the store keeps for an engine: creates its result table, or adds missing columns. */
static status open_kind(struct store *store, const struct engine_kind *kind, struct store_kind *entry, bool *grown,
                        struct error *error) {
  static const char version[] = "PRAGMA schema_version";
  const struct schema_table table = schema_result_table(kind);
  int64_t before = 0, after = 0, filled = 0;
  entry->kind = kind;
  TRY(check_defined(store, kind, table.name, error));
  TRY(sql_integer(store->db, version, 0, &before, error));
  TRY(schema_complete(store->db, &table, error));
  TRY(sql_integer(store->db, version, 0, &after, error));
  *grown = *grown || before != after;
  TRY(sql_prepare_insert(store->db, &entry->insert, table.name, "run_id", kind->results, 1, adding_run, error));
  TRY(sql_integerf(store->db, &filled, error, "SELECT EXISTS (SELECT 1 FROM \"%w\")", table.name));
  entry->first = filled == 0;
  TRY(sql_integerf(store->db, &entry->pointed, error, "SELECT EXISTS (SELECT 1 FROM point WHERE engine = %Q)",
                   kind->name));
  digest_names_make(&store->outcome_names, "run", &outcome_table);
  digest_names_make(&store->estimate_names, "estimate", &estimates_table);
  digest_names_make(&entry->names, table.name, kind->results);
  return STATUS_OK;
}

/* Gives the store's entry for the engine in *found. *grown becomes true when the views need another column. */
static status find_kind(struct store *store, const struct engine_kind *kind, struct store_kind **found, bool *grown,
                        struct error *error) {
  for (size_t i = 0; i < store->kind_count; i++)
    if (store->kinds[i].kind == kind) {
      *found = &store->kinds[i];
      return STATUS_OK;
    }
  if (store->kind_count == LIMITS_ENGINES)
    return status_fail(error, STATUS_INTERNAL, "more than %d engines in one store", LIMITS_ENGINES);
  *found = &store->kinds[store->kind_count];
  const status result = open_kind(store, kind, *found, grown, error);
  store->kind_count += result == STATUS_OK;
  return result;
}

/* ---- campaigns ---- */

static status find_or_add_campaign(struct store *store, const char *name, const char *document_text,
                                   const char *plan_json, int64_t *campaign_id, struct error *error) {
  STATEMENT found = NULL;
  STATEMENT statement = NULL;
  TRY(sql_prepare(store->db, "SELECT campaign_id FROM campaign WHERE name = ?1 AND document = ?2", &found,
                  adding_campaign, error));
  SQL_BIND(found, sql_of_text(name), sql_of_text(document_text));
  *campaign_id = sqlite3_step(found) == SQLITE_ROW ? sqlite3_column_int64(found, 0) : 0;
  if (*campaign_id != 0)
    return STATUS_OK;
  TRY(sql_prepare(store->db,
                  "INSERT INTO campaign (name, document, plan, added_at) VALUES (?1, ?2, ?3, "
                  "strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))",
                  &statement, adding_campaign, error));
  SQL_BIND(statement, sql_of_text(name), sql_of_text(document_text), sql_of_text(plan_json));
  const status result = sql_run(statement, adding_campaign, error);
  *campaign_id = sqlite3_last_insert_rowid(store->db);
  return result;
}

status store_add_campaign(struct store *store, const char *name, const char *document_text, const char *plan_json,
                          int64_t *campaign_id, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, find_or_add_campaign(store, name, document_text, plan_json, campaign_id, error), 1, error);
}

/* ---- points ---- */

/* A point's hash is a run's identity without seed and results_version: a point stays the same when results_version
 * changes. */
void store_point_hash(const struct scene *scene, uint8_t hash[16]) {
  struct engine_kind kind = *scene->kind;
  struct scene unversioned = *scene;
  kind.results_version = 0;
  unversioned.kind = &kind;
  scene_identity(&unversioned, 0, hash);
}

status store_point_find(struct store *store, const struct scene *scene, int64_t *point_id, struct error *error) {
  static const char doing[] = "looking for a point";
  uint8_t hash[16];
  TRY(sql_prepare_once(store->db, &store->point_find, "SELECT point_id FROM point WHERE hash = ?1", doing, error));
  store_point_hash(scene, hash);
  sqlite3_bind_blob(store->point_find, 1, hash, 16, SQLITE_STATIC);
  int code = sqlite3_step(store->point_find);
  *point_id = code == SQLITE_ROW ? sqlite3_column_int64(store->point_find, 0) : 0;
  sqlite3_reset(store->point_find);
  return code == SQLITE_ROW || code == SQLITE_DONE ? STATUS_OK : sql_fail(store->db, code, doing, error);
}

status store_point_shapes(struct store *store, int64_t run_id, struct error *error) {
  static const char doing[] = "reading shape files";
  STATEMENT files = NULL;
  TRY(sql_prepare(store->db,
                  "SELECT hash, bytes FROM shape_file WHERE ?1 = 0 OR hash IN (SELECT value FROM point_input JOIN "
                  "run USING (point_id) WHERE run_id = ?1)",
                  &files, doing, error));
  status result = STATUS_OK;
  sqlite3_bind_int64(files, 1, run_id);
  while (sql_next(files, &result, doing, error)) {
    const char *hash = sql_text(files, 0);
    const void *bytes = sqlite3_column_blob(files, 1);
    const struct mesh_file *file = NULL;
    char name[128];
    snprintf(name, sizeof name, "shape file %.12s of the store", hash);
    TRY(mesh_files_add(name, bytes ? bytes : "", (size_t)sqlite3_column_bytes(files, 1), &file, error));
    if (strcmp(file->hash, hash) != 0)
      return status_fail(error, STATUS_CONTENT, "%s: its bytes have changed since it was stored; restore a copy", name);
  }
  return result;
}

static status add_inputs(struct store *store, int64_t point_id, const struct scene *scene, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  TRY(sql_prepare_once(store->db, &store->point_input,
                       "INSERT INTO point_input (point_id, path, value) VALUES (?1, ?2, ?3)", adding_point, error));
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    if (!field_is_active(inputs, row, scene->inputs))
      continue;
    SQL_BIND(store->point_input, sql_of_integer(point_id), sql_of_text(row->path),
             sql_of_field(row, scene->inputs, true));
    TRY(sql_run(store->point_input, adding_point, error));
  }
  return STATUS_OK;
}

/* Adds the files of a scene that the store lacks. */
static status add_shapes(struct store *store, const struct scene *scene, struct error *error) {
  static const char doing[] = "adding a shape file";
  const struct mesh_file *files[SCENE_FILES_MOST];
  const size_t count = scene_files_of(scene->kind->inputs, scene->inputs, files);
  for (size_t i = 0; i < count; i++) {
    STATEMENT statement = NULL;
    TRY(sql_prepare(store->db, "INSERT OR IGNORE INTO shape_file (hash, bytes) VALUES (?1, ?2)", &statement, doing,
                    error));
    SQL_BIND(statement, sql_of_text(files[i]->hash), sql_of_bytes(files[i]->bytes, files[i]->size));
    TRY(sql_run(statement, doing, error));
  }
  return STATUS_OK;
}

/* The digest of the rows of a point that is about to be stored. */
static void digest_point(const struct scene *scene, const uint8_t hash[16], const char *json, uint8_t digest[16]) {
  const struct field_table *inputs = scene->kind->inputs;
  const struct digest value = digest_name("point_input", "value");
  struct digest sum = {0};
  digest_add(&sum, digest_name("point", "hash"), 0, sql_of_bytes(hash, 16));
  digest_add(&sum, digest_name("point", "engine"), 0, sql_of_text(scene->kind->name));
  digest_add(&sum, digest_name("point", "scene_name"), 0, sql_of_text(scene->name));
  digest_add(&sum, digest_name("point", "scene"), 0, sql_of_text(json));
  for (size_t i = 0; i < inputs->count; i++)
    if (field_is_active(inputs, &inputs->rows[i], scene->inputs))
      digest_add(&sum, value, digest_row(inputs->rows[i].path, strlen(inputs->rows[i].path)),
                 sql_of_field(&inputs->rows[i], scene->inputs, true));
  digest_write(sum, digest);
}

static status find_or_add_point(struct store *store, const struct scene *scene, int64_t *point_id,
                                struct error *error) {
  uint8_t hash[16], digest[16];
  TRY(store_point_find(store, scene, point_id, error));
  if (*point_id != 0)
    return STATUS_OK;
  OWNED char *json = scene_json(scene);
  if (!json)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_point);
  TRY(sql_prepare_once(store->db, &store->point,
                       "INSERT INTO point (hash, engine, scene_name, scene, digest) VALUES (?1, ?2, ?3, ?4, ?5)",
                       adding_point, error));
  store_point_hash(scene, hash);
  digest_point(scene, hash, json, digest);
  SQL_BIND(store->point, sql_of_bytes(hash, sizeof hash), sql_of_text(scene->kind->name), sql_of_text(scene->name),
           sql_of_text(json), sql_of_bytes(digest, sizeof digest));
  TRY(sql_run(store->point, adding_point, error));
  *point_id = sqlite3_last_insert_rowid(store->db);
  TRY(add_inputs(store, *point_id, scene, error));
  return add_shapes(store, scene, error);
}

/* *grown: the views need another column. */
static status add_axis(struct store *store, const struct field *row, bool *grown, struct error *error) {
  char name[SCHEMA_NAME_SIZE];
  TRY(sql_prepare_once(store->db, &store->axis_find,
                       "SELECT ifnull(unit, '') <> ifnull(?2, '') FROM axis WHERE path = ?1", adding_point, error));
  sql_bind_text(store->axis_find, 1, row->path);
  sql_bind_text(store->axis_find, 2, row->unit);
  const bool known = sqlite3_step(store->axis_find) == SQLITE_ROW;
  const bool other = known && sqlite3_column_int(store->axis_find, 0); /* of another scene that names its own inputs */
  sqlite3_reset(store->axis_find);
  if (other)
    return status_fail(error, STATUS_CONTENT,
                       "the store has an input '%s' of another scene with another unit: name "
                       "another store",
                       row->path);
  if (known)
    return STATUS_OK;
  *grown = true;
  TRY(views_axis_column(store->db, row->path, name, sizeof name, error));
  return sql_executef(store->db, adding_point, error,
                      "INSERT INTO axis (path, column_name, unit, meaning) VALUES (%Q, %Q, %Q, %Q)", row->path, name,
                      row->unit, row->doc ? row->doc : "");
}

static status add_axis_with_unit(struct store *store, const struct field *row, const char *unit, struct error *error) {
  bool grown = false;
  TRY(add_axis(store, row, &grown, error));
  TRY(sql_executef(store->db, adding_point, error, "UPDATE axis SET written_unit = %Q WHERE path = %Q AND %Q <> ''",
                   unit, row->path, unit)); /* rounds of a study are written in SI: the campaign's unit stays */
  return grown ? views_regenerate(store->db, error) : STATUS_OK;
}

status store_add_axis(struct store *store, const struct field *row, const char *unit, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, add_axis_with_unit(store, row, unit, error), 1, error);
}

static status add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                        const char *const *varied_paths, int64_t *point_id, struct error *error) {
  bool grown = false;
  struct store_kind *kind = NULL;
  TRY(find_kind(store, scene->kind, &kind, &grown, error));
  TRY(find_or_add_point(store, scene, point_id, error));
  grown |= !kind->pointed;
  kind->pointed = 1;
  if (campaign_id > 0) {
    TRY(sql_prepare_once(store->db, &store->campaign_point,
                         "INSERT OR IGNORE INTO campaign_point (campaign_id, point_id) VALUES (?1, ?2)", adding_point,
                         error));
    SQL_BIND(store->campaign_point, sql_of_integer(campaign_id), sql_of_integer(*point_id));
    TRY(sql_run(store->campaign_point, adding_point, error));
  }
  for (size_t i = 0; i < varied_count; i++) {
    const struct field *row = field_find(scene->kind->inputs, varied_paths[i], error);
    TRY(row ? add_axis(store, row, &grown, error) : STATUS_CONTENT);
  }
  return grown ? views_regenerate(store->db, error) : STATUS_OK;
}

status store_add_point(struct store *store, int64_t campaign_id, const struct scene *scene, size_t varied_count,
                       const char *const *varied_paths, int64_t *point_id, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, add_point(store, campaign_id, scene, varied_count, varied_paths, point_id, error), 1, error);
}

/* ---- what follows from a run's fragments: masses, spectrum, and their part of the point's running sums ---- */

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "masses are stored as little-endian float64");

/* Makes room in store->masses. */
static status make_room(struct store *store, size_t count, struct error *error) {
  return grow_or_fail(&store->masses, &store->mass_capacity, count + 1, sizeof *store->masses, adding_run, error);
}

status store_take_masses(struct store *store, sqlite3_stmt *row, int column, size_t *count, struct error *error) {
  const void *bytes = sqlite3_column_blob(row, column);
  *count = (size_t)sqlite3_column_bytes(row, column) / sizeof *store->masses;
  TRY(make_room(store, *count, error));
  if (*count)
    memcpy(store->masses, bytes, *count * sizeof *store->masses);
  return STATUS_OK;
}

/* store->masses as the value of a row. */
static struct sql_value masses_of(const struct store *store, const struct store_run *run) {
  return sql_of_bytes(store->masses, run->fragment_count * sizeof *store->masses);
}

status store_make_bins(struct store *store, size_t n, size_t *count, struct error *error) {
  *count = spectrum_fill(n, store->masses, store->bins, store->bin_capacity);
  if (*count <= store->bin_capacity)
    return STATUS_OK;
  TRY(grow_or_fail(&store->bins, &store->bin_capacity, *count, sizeof *store->bins, adding_run, error));
  *count = spectrum_fill(n, store->masses, store->bins, store->bin_capacity);
  return STATUS_OK;
}

/* Table bin covers the `count` bins of a run, in ascending order, from now on. */
static status cover_bins(struct store *store, size_t count, struct error *error) {
  int64_t lowest = count ? store->bins[0].bin : INT64_MAX, highest = count ? store->bins[count - 1].bin : INT64_MIN;
  const bool none = store->lowest_bin > store->highest_bin;
  if (count == 0 || (!none && lowest >= store->lowest_bin && highest <= store->highest_bin))
    return STATUS_OK;
  if (!none && store->lowest_bin < lowest)
    lowest = store->lowest_bin;
  if (!none && store->highest_bin > highest)
    highest = store->highest_bin;
  const status result = sums_cover_bins(store->db, lowest, highest, error);
  store->lowest_bin = lowest;
  store->highest_bin = highest;
  return result;
}

enum { TOGETHER = 10 }; /* rows per INSERT: starting a statement costs as much as inserting three rows */

static status insert_bins(struct store *store, int64_t run_id, size_t count, struct error *error) {
#define INSERT_SPECTRUM "INSERT INTO main.spectrum (run_id, bin, count, mass) VALUES (?, ?, ?, ?)"
#define TWO_MORE        ", (?, ?, ?, ?), (?, ?, ?, ?)"
  TRY(sql_prepare_once(store->db, &store->spectrum, INSERT_SPECTRUM, adding_run, error));
  TRY(sql_prepare_once(store->db, &store->spectrum_together,
                       INSERT_SPECTRUM TWO_MORE TWO_MORE TWO_MORE TWO_MORE ", (?, ?, ?, ?)", adding_run, error));
  for (size_t i = 0, together; i < count; i += together) {
    together = i + TOGETHER <= count ? TOGETHER : 1;
    sqlite3_stmt *statement = together > 1 ? store->spectrum_together : store->spectrum;
    for (size_t k = 0; k < together; k++) {
      const struct spectrum_bin_row *bin = &store->bins[i + k];
      const int first = 1 + 4 * (int)k;
      sqlite3_bind_int64(statement, first, run_id);
      sqlite3_bind_int(statement, first + 1, bin->bin);
      sqlite3_bind_int64(statement, first + 2, bin->count);
      sqlite3_bind_double(statement, first + 3, bin->mass);
    }
    TRY(sql_run(statement, adding_run, error));
  }
  return STATUS_OK;
}

status store_add_spectrum(struct store *store, int64_t run_id, const struct sums_run *run, size_t count,
                          struct error *error) {
  TRY(cover_bins(store, count, error));
  TRY(insert_bins(store, run_id, count, error));
  return sums_add(&store->sums, run, count, store->bins)
             ? STATUS_OK
             : status_fail(error, STATUS_MEMORY, "%s: memory ran out", adding_run);
}

/* ---- runs ---- */

/* NULL: the run has no result, or its engine no ejecta. */
static const struct ejecta *ejecta_of(const struct store_run *run) {
  return run->result ? engine_ejecta(run->kind, (void *)run->result) : NULL;
}

static status add_ejecta(struct store *store, int64_t run_id, const struct store_run *run, struct error *error) {
  const struct ejecta *ejecta = ejecta_of(run);
  for (int i = 0; ejecta && i < EJECTA_BINS; i++) {
    if (!(ejecta->bin[i].mass > 0))
      continue;
    const int bin = EJECTA_FIRST + i;
    TRY(sql_prepare_once(store->db, &store->ejecta,
                         "INSERT INTO ejecta (run_id, bin, speed, mass, momentum) VALUES (?1, ?2, ?3, ?4, ?5)",
                         adding_run, error));
    SQL_BIND(store->ejecta, sql_of_integer(run_id), sql_of_integer(bin), sql_of_real(bins_edge(bin)),
             sql_of_real(ejecta->bin[i].mass), sql_of_real(ejecta->bin[i].momentum));
    TRY(sql_run(store->ejecta, adding_run, error));
  }
  return STATUS_OK;
}

/* Lengths of fragments as the value of a row: NULL if none was measured. `list` is the value's memory: owned by the
 * caller. STATUS_MEMORY. */
static status find_lengths(const struct store_run *run, double **list, struct sql_value *value, struct error *error) {
  size_t count = run->fragment_count;
  while (count > 0 && !(run->fragments[count - 1].length[0] > 0))
    count--;
  *value = (struct sql_value){.type = SQLITE_NULL};
  if (count == 0)
    return STATUS_OK;
  const size_t size = sizeof run->fragments->length;
  TRY(memory_array(list, count, size, "the lengths of fragments", error));
  for (size_t i = 0; i < count; i++)
    memcpy(*list + 3 * i, run->fragments[i].length, size);
  *value = sql_of_bytes(*list, count * size);
  return STATUS_OK;
}

/* The digest of the rows of a run that is about to be stored. digest_rows() computes the same from the
 * rows. */
static void digest_run(const struct store *store, const struct store_kind *kind, const struct store_run *run,
                       struct sql_value lengths, uint8_t digest[16]) {
  struct digest sum = {0};
  digest_add(&sum, digest_name("run", "identity"), 0, sql_of_bytes(run->identity, sizeof run->identity));
  digest_add(&sum, digest_name("run", "replicate"), 0, sql_of_integer(run->replicate));
  digest_add(&sum, digest_name("run", "seed"), 0, sql_of_integer((int64_t)run->seed));
  digest_add(&sum, digest_name("run", "results_version"), 0, sql_of_integer(run->kind->results_version));
  if (run->fields_digest)
    digest_add(&sum, digest_name("run", "fields_digest"), 0, sql_of_text(run->fields_digest));
  digest_add_fields(&sum, store->outcome_names, &outcome_table, 0, run->outcome);
  if (run->result)
    digest_add_fields(&sum, kind->names, run->kind->results, 0, run->result);
  digest_add(&sum, digest_name("fragment_mass", "masses"), 0, masses_of(store, run));
  digest_add(&sum, digest_name("fragment_mass", "lengths"), 0, lengths);
  for (size_t i = 0; i < run->estimate_count; i++)
    digest_add_fields(&sum, store->estimate_names, &estimates_table, i, &run->estimates[i]);
  const struct ejecta *ejecta = ejecta_of(run);
  for (int i = 0; ejecta && i < EJECTA_BINS; i++)
    if (ejecta->bin[i].mass > 0) {
      const uint64_t bin = (uint64_t)(int64_t)(EJECTA_FIRST + i);
      digest_add(&sum, digest_name("ejecta", "speed"), bin, sql_of_real(bins_edge(EJECTA_FIRST + i)));
      digest_add(&sum, digest_name("ejecta", "mass"), bin, sql_of_real(ejecta->bin[i].mass));
      digest_add(&sum, digest_name("ejecta", "momentum"), bin, sql_of_real(ejecta->bin[i].momentum));
    }
  digest_write(sum, digest);
}

static status add_row(struct store *store, const struct store_kind *kind, const struct store_run *run,
                      struct sql_value lengths, int64_t *run_id, struct error *error) {
  uint8_t digest[16];
  TRY(sql_prepare_insert(
      store->db, &store->run, "run",
      "point_id, session_id, identity, replicate, seed, results_version, surplus, counts, attempt, "
      "wall_time, cpu_time, peak_memory, host, rank, finished_at, fields_path, fields_digest, digest",
      &outcome_table, 1, adding_run, error));
  digest_run(store, kind, run, lengths, digest);
  const int behind = SQL_BIND(store->run, sql_of_integer(run->point_id), sql_of_key(run->session_id),
                              sql_of_bytes(run->identity, sizeof run->identity), sql_of_integer(run->replicate),
                              sql_of_integer((int64_t)run->seed), sql_of_integer(run->kind->results_version),
                              sql_of_integer(run->surplus), sql_of_integer(store_run_counts(run)),
                              sql_of_integer(run->attempt), sql_of_real(run->wall_s), sql_of_real(run->cpu_s),
                              sql_of_integer(run->peak_memory), sql_of_text(run->host), sql_of_integer(run->rank),
                              sql_of_real(clock_read_s(CLOCK_REALTIME)), sql_of_text(run->fields_path),
                              sql_of_text(run->fields_digest), sql_of_bytes(digest, sizeof digest));
  sql_bind_fields(store->run, behind, &outcome_table, run->outcome);
  const status result = sql_run(store->run, adding_run, error);
  *run_id = sqlite3_last_insert_rowid(store->db);
  return result;
}

static status add_run(struct store *store, const struct store_run *run, struct error *error) {
  bool grown = false;
  int64_t run_id = 0;
  size_t bins = 0;
  struct store_kind *kind = NULL;
  TRY(find_kind(store, run->kind, &kind, &grown, error));
  if (grown)
    TRY(views_regenerate(store->db, error));
  TRY(make_room(store, run->fragment_count, error));
  for (size_t i = 0; i < run->fragment_count; i++)
    store->masses[i] = run->fragments[i].mass;
  OWNED double *list = NULL;
  struct sql_value lengths;
  TRY(find_lengths(run, &list, &lengths, error));
  TRY(add_row(store, kind, run, lengths, &run_id, error));
  if (run->result) {
    sql_bind_fields(kind->insert, SQL_BIND(kind->insert, sql_of_integer(run_id)), run->kind->results, run->result);
    TRY(sql_run(kind->insert, adding_run, error));
    if (kind->first) /* with the first run of an engine, the views get columns for its results */
      TRY(views_regenerate(store->db, error));
    kind->first = false;
  }
  TRY(sql_prepare_once(store->db, &store->mass_row,
                       "INSERT INTO fragment_mass (run_id, masses, lengths) VALUES (?1, ?2, ?3)", adding_run, error));
  SQL_BIND(store->mass_row, sql_of_integer(run_id), masses_of(store, run), lengths);
  TRY(sql_run(store->mass_row, adding_run, error));
  const struct sums_run sums = {run->point_id, run->kind->results_version, store_run_counts(run),
                                run->outcome->state == OUTCOME_END_TIME, run->surplus};
  TRY(store_make_bins(store, run->fragment_count, &bins, error));
  TRY(store_add_spectrum(store, run_id, &sums, bins, error));
  TRY(add_ejecta(store, run_id, run, error));
  if (run->estimate_count > 0)
    TRY(store_set_estimates_rows(store, run_id, run->estimate_count, run->estimates, error));

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
  TRY(store_begin(store, error));
  return store_end(store, add_run(store, run, error), 1, error);
}

/* ---- attempts ---- */

static status add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error) {
  static const char doing[] = "adding an attempt";
  TRY(sql_prepare_insert(store->db, &store->attempt, "attempt",
                         "identity, point_id, replicate, seed, session_id, number, reason, exit_code, signal, "
                         "wall_time, peak_memory, limited_to, message, host, rank, failed_at",
                         NULL, 1, doing, error));
  struct identities_state *state = identities_add(&store->identities, attempt->identity);
  if (!state)
    return status_fail(error, STATUS_MEMORY, "%s: memory ran out", doing);
  SQL_BIND(store->attempt, sql_of_bytes(attempt->identity, sizeof attempt->identity), sql_of_integer(attempt->point_id),
           sql_of_integer(attempt->replicate), sql_of_integer((int64_t)attempt->seed), sql_of_key(attempt->session_id),
           sql_of_integer(attempt->attempt), sql_of_text(attempt->reason ? attempt->reason : "exit"),
           sql_of_integer(attempt->exit_code), sql_of_integer(attempt->signal), sql_of_real(attempt->wall_s),
           sql_of_integer(attempt->peak_memory), sql_of_real(attempt->limit),
           sql_of_text(attempt->message ? attempt->message : ""), sql_of_text(attempt->host),
           sql_of_integer(attempt->rank), sql_of_real(clock_read_s(CLOCK_REALTIME)));
  TRY(sql_run(store->attempt, doing, error));
  state->attempts++;
  return STATUS_OK;
}

status store_add_attempt(struct store *store, const struct store_attempt *attempt, struct error *error) {
  TRY(store_begin(store, error));
  return store_end(store, add_attempt(store, attempt, error), 1, error);
}
