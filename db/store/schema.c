/* The tables, and their CREATE statements and rows of column_doc. Adds tables and columns that an older store lacks. */
#include "db/store/schema.h"

#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/convergence.h"
#include "analysis/statistics/statistics.h"
#include "schemas/memory.h"

static const struct schema_column campaign[] = {
    {"campaign_id", "INTEGER PRIMARY KEY", NULL, "number of the campaign in this store"},
    {"name", "TEXT NOT NULL", NULL, "its name"},
    {"document", "TEXT NOT NULL", NULL, "the campaign file as it was read"},
    {"plan", "TEXT", NULL, "the resolved plan, JSON"},
    {"added_at", "TEXT NOT NULL", NULL, "when it was first run, UTC, ISO 8601"},
};

static const struct schema_column session[] = {
    {"session_id", "INTEGER PRIMARY KEY", NULL, "number of the invocation that computed"},
    {"campaign_id", "INTEGER", NULL,
     "the campaign it computed; NULL in sessions of older programs that computed nothing"},
    {"started_at", "TEXT NOT NULL", NULL, "UTC, ISO 8601, to the millisecond"},
    {"ended_at", "TEXT", NULL, "UTC, ISO 8601; NULL while running or when it was killed"},
    {"outcome", "TEXT", NULL, "how it ended: a status name; NULL while running or when it was killed"},
    {"host", "TEXT NOT NULL", NULL, "machine of the manager"},
    {"pid", "INTEGER NOT NULL", NULL, "process of the manager"},
    {"facts", "TEXT NOT NULL CHECK (json_valid(facts))", NULL,
     "provenance, JSON: version, commit, compiler, flags, processor class, libraries, ranks, slots, command line"},
};

static const struct schema_column point[] = {
    {"point_id", "INTEGER PRIMARY KEY", NULL, "number of the point: one set of input values"},
    {"hash", "BLOB NOT NULL UNIQUE CHECK (length(hash) = 16)", NULL,
     "128-bit hash of engine and active inputs, without seed and results_version"},
    {"digest", "BLOB CHECK (length(digest) = 16)", NULL, "changes when any bit of the point or its inputs changes"},
    {"engine", "TEXT NOT NULL", NULL, "name of the engine"},
    {"scene_name", "TEXT NOT NULL", NULL, "name of the scene the inputs started from"},
    {"scene", "TEXT NOT NULL CHECK (json_valid(scene))", NULL,
     "the resolved scene, JSON, SI units: every active input, defaults too"},
};

static const struct schema_column campaign_point[] = {
    {"campaign_id", "INTEGER NOT NULL REFERENCES campaign (campaign_id)", NULL, "a campaign with this point"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "a point of it; campaigns may share points"},
};

static const struct schema_column point_input[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"path", "TEXT NOT NULL", NULL, "path of an active input in the scene"},
    {"value", "ANY NOT NULL", NULL, "its value in SI units; choices by name, booleans 0 or 1, the keyword off as text"},
};

static const struct schema_column shape_file[] = {
    {"hash", "TEXT NOT NULL UNIQUE", NULL, "SHA-256 of the file, the value of inputs that name one (target.mesh.file)"},
    {"bytes", "BLOB NOT NULL", NULL, "the file as it was read, STL or OBJ"},
};

static const struct schema_column axis[] = {
    {"path", "TEXT NOT NULL PRIMARY KEY", NULL, "path of an input that some campaign varied"},
    {"column_name", "TEXT NOT NULL UNIQUE", NULL, "its column in the views"},
    {"unit", "TEXT", NULL, "SI unit of the input"},
    {"written_unit", "TEXT", NULL, "unit of its values in the campaign: that of tables for people; NULL: SI"},
    {"meaning", "TEXT NOT NULL", NULL, "what the input means"},
};

static const struct schema_column run[] = {
    {"run_id", "INTEGER PRIMARY KEY", NULL, "number of the run in this store"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point it belongs to"},
    {"session_id", "INTEGER REFERENCES session (session_id)", NULL, "the session that computed it"},
    {"identity", "BLOB NOT NULL UNIQUE CHECK (length(identity) = 16)", NULL,
     "128-bit hash of engine, results_version, active inputs and seed: the same run is never stored twice"},
    {"replicate", "INTEGER NOT NULL", NULL, "which seed of the point, from 0"},
    {"seed", "INTEGER NOT NULL", NULL, "the seed (64 bits, shown as a signed number)"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results; statistics never mix two"},
    {"surplus", "INTEGER NOT NULL", NULL,
     "above 0: left out of statistics. 1: beyond the prefix a stopping rule decided on; 2: excluded; 3: both"},
    {"attempt", "INTEGER NOT NULL", NULL, "which attempt succeeded, from 1"},
    {"wall_time", "REAL NOT NULL", "s", "elapsed time of the successful attempt"},
    {"cpu_time", "REAL NOT NULL", "s", "processor time of the successful attempt"},
    {"peak_memory", "INTEGER NOT NULL", "B", "largest resident memory of the successful attempt"},
    {"host", "TEXT", NULL, "machine that computed it"},
    {"rank", "INTEGER NOT NULL", NULL, "MPI rank that computed it"},
    {"finished_at", "REAL NOT NULL", "s", "when it was stored, seconds since 1970-01-01 UTC"},
    {"fields_path", "TEXT", NULL, "HDF5 file with its fields, relative to the store's folder; NULL when none was kept"},
    {"fields_digest", "TEXT", NULL, "changes when any bit of that file changes; NULL in older rows"},
    {"excluded", "TEXT", NULL, "why a person excluded the run (clast exclude); NULL: it is not excluded"},
    {"excluded_at", "TEXT", NULL, "when, UTC, ISO 8601"},
    {"counts", "INTEGER NOT NULL", NULL,
     "1: part of the statistics (not surplus or excluded, completed or ended at its time, the main results are "
     "numbers)"},
    {"digest", "BLOB CHECK (length(digest) = 16)", NULL,
     "changes when any bit changes of what the run determined: results, masses, estimates, seed, identity"},
};

static const struct schema_column fragment_mass[] = {
    {"run_id", "INTEGER PRIMARY KEY REFERENCES run (run_id)", NULL, "the run"},
    {"masses", "BLOB NOT NULL", "kg", "mass of every fragment, descending: little-endian float64, 8 bytes each"},
    {"lengths", "BLOB", "m",
     "three lengths of each fragment, longest first, in the order of the masses up to the last that was measured, 0 "
     "for "
     "others: little-endian float64; NULL: none was measured"},
};

static const struct schema_column bin[] = {
    {"bin", "INTEGER PRIMARY KEY", NULL, "number of a mass bin: ten per decade, bin 0 starts at 1 kg"},
    {"lower", "REAL NOT NULL", "kg", "lower edge, inside the bin"},
    {"upper", "REAL NOT NULL", "kg", "upper edge, outside the bin"},
};

static const struct schema_column spectrum[] = {
    {"run_id", "INTEGER NOT NULL REFERENCES run (run_id)", NULL, "the run"},
    {"bin", "INTEGER NOT NULL", NULL, "mass bin (table bin); only bins that hold something"},
    {"count", "INTEGER NOT NULL", "1", "fragments in the bin"},
    {"mass", "REAL NOT NULL", "kg", "their mass"},
};

static const struct schema_column ejecta[] = {
    {"run_id", "INTEGER NOT NULL REFERENCES run (run_id)", NULL, "the run"},
    {"bin", "INTEGER NOT NULL", NULL, "number of a bin of speed: ten per decade, bin 0 starts at 1 m/s"},
    {"speed", "REAL NOT NULL", "m/s", "lower edge of the bin, inside it; only bins that hold something"},
    {"mass", "REAL NOT NULL", "kg",
     "mass of the target's matter that leaves at such a speed (result ejecta.mass_fraction)"},
    {"momentum", "REAL NOT NULL", "kg m/s", "its momentum along the outward normal (result ejecta.momentum)"},
};

static const struct schema_column point_total[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"runs", "INTEGER NOT NULL", "1", "runs that count: completed, or ended at their time, not surplus, not excluded"},
    {"censored", "INTEGER NOT NULL", "1",
     "runs that count and ended at their time: fragments may still have been breaking"},
    {"failed", "INTEGER NOT NULL", "1", "runs that gave no usable result (NaN, time step, energy, invalid)"},
    {"surplus", "INTEGER NOT NULL", "1", "runs left out because a stopping rule decided without them"},
    {"fragments", "INTEGER NOT NULL", "1", "fragments of the runs that count"},
    {"mass", "REAL NOT NULL", "kg", "mass of these fragments"},
};

static const struct schema_column point_spectrum[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"bin", "INTEGER NOT NULL", NULL, "mass bin (table bin)"},
    {"runs", "INTEGER NOT NULL", "1", "runs that count and have a fragment in the bin"},
    {"count", "INTEGER NOT NULL", "1", "sum of their counts"},
    {"count_squared", "INTEGER NOT NULL", "1", "sum of the squares of their counts, for the scatter between runs"},
    {"mass", "REAL NOT NULL", "kg", "sum of their masses"},
};

static const struct schema_column estimate[] = {
    {"run_id", "INTEGER NOT NULL REFERENCES run (run_id)", NULL, "the run"},
    {"ordinal", "INTEGER NOT NULL", NULL, "number among the estimates of the run"},
};

static const struct schema_column point_estimate[] = {
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results it was made from"},
    {"ordinal", "INTEGER NOT NULL", NULL, "number among the estimates of the point"},
};

static const struct schema_column attempt[] = {
    {"attempt_id", "INTEGER PRIMARY KEY", NULL, "number of the failed attempt"},
    {"identity", "BLOB NOT NULL CHECK (length(identity) = 16)", NULL, "identity of the run that was tried"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "its point"},
    {"replicate", "INTEGER NOT NULL", NULL, "which seed of the point, from 0"},
    {"seed", "INTEGER NOT NULL", NULL, "the seed (64 bits, shown as a signed number)"},
    {"session_id", "INTEGER REFERENCES session (session_id)", NULL, "the session that tried"},
    {"number", "INTEGER NOT NULL", NULL, "which attempt, from 1"},
    {"reason", "TEXT NOT NULL", NULL, "time_limit, memory_limit, crash, lost or exit"},
    {"exit_code", "INTEGER NOT NULL", NULL, "exit code of the process"},
    {"signal", "INTEGER NOT NULL", NULL, "signal that ended it, 0 for none"},
    {"wall_time", "REAL NOT NULL", "s", "elapsed time"},
    {"peak_memory", "INTEGER NOT NULL", "B", "largest resident memory"},
    {"limited_to", "REAL NOT NULL", NULL, "the limit that ended it: seconds or bytes, 0 for the other reasons"},
    {"message", "TEXT NOT NULL", NULL, "its message"},
    {"host", "TEXT", NULL, "machine"},
    {"rank", "INTEGER NOT NULL", NULL, "MPI rank"},
    {"failed_at", "REAL NOT NULL", "s", "when, seconds since 1970-01-01 UTC"},
};

static const struct schema_column convergence[] = {
    {"base_point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the scene studied, as a point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
    {"level", "INTEGER NOT NULL", NULL, "number of the level, from 0, coarse to fine"},
    {"point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the level, as a point: its runs are in run"},
};

static const struct schema_column convergence_limit[] = {
    {"base_point_id", "INTEGER NOT NULL REFERENCES point (point_id)", NULL, "the scene studied, as a point"},
    {"results_version", "INTEGER NOT NULL", NULL, "version of the engine's results"},
};

static const struct schema_column table_digest[] = {
    {"table_name", "TEXT NOT NULL PRIMARY KEY", NULL, "a table whose rows no other digest protects from loss"},
    {"row_count", "INTEGER NOT NULL", NULL, "its rows, counted in the transaction that changed them"},
    {"digest", "BLOB NOT NULL CHECK (length(digest) = 16)", NULL, "changes when any bit of any of its rows changes"},
};

static const struct schema_column holder[] = {
    {"holder_id", "INTEGER PRIMARY KEY CHECK (holder_id = 1)", NULL, "always 1"},
    {"host", "TEXT NOT NULL", NULL, "machine of the process that last opened the store for writing"},
    {"pid", "INTEGER NOT NULL", NULL,
     "its process number; the row only names the holder, the store is held by an OS lock"},
    {"since", "TEXT NOT NULL", NULL, "when it did, UTC, ISO 8601"},
};

static const struct schema_column column_doc[] = {
    {"table_name", "TEXT NOT NULL", NULL, "table or view"},
    {"column_name", "TEXT NOT NULL", NULL, "column of it"},
    {"unit", "TEXT", NULL, "SI unit; NULL where there is none"},
    {"meaning", "TEXT NOT NULL", NULL, "what the column holds"},
    {"deterministic", "INTEGER NOT NULL DEFAULT 0", NULL,
     "1: a result that depends on inputs, seed and results_version alone (not a time, a host...)"},
};

#define TABLE(table_, meaning_, ...)                                                                                   \
  { .name = #table_, .meaning = meaning_, .columns = table_, .count = sizeof table_ / sizeof table_[0], __VA_ARGS__ }
#define ROWID           .options = "STRICT"
#define DIGEST          .has_digest = true
#define CLUSTERED(key_) .options = "STRICT, WITHOUT ROWID", .tail = "PRIMARY KEY (" key_ ")"

const struct schema_table schema_tables[] = {
    TABLE(column_doc, "Meaning and unit of every column.", CLUSTERED("table_name, column_name")),
    TABLE(campaign, "Campaigns, as their files were read.", ROWID, DIGEST),
    TABLE(session, "Provenance: one row per invocation that wrote to the store.", ROWID, DIGEST),
    TABLE(point, "Points: sets of input values. The resolved scene is the truth.", ROWID),
    TABLE(campaign_point, "Which campaign has which point.", CLUSTERED("campaign_id, point_id"), DIGEST),
    TABLE(point_input, "Every active input of every point.", CLUSTERED("point_id, path")),
    TABLE(shape_file, "Shape files of bodies, each once.", ROWID),
    TABLE(axis, "Inputs that some campaign varied: columns of the views.", .options = "STRICT, WITHOUT ROWID", DIGEST),
    TABLE(run, "Runs: one simulation of a point with a seed, and what every engine reports of it.", ROWID,
          .fields = &outcome_table, DIGEST),
    TABLE(fragment_mass, "Fragment masses: any spectrum can be made from them without a new run.", ROWID),
    TABLE(bin, "Edges of the mass bins in use.", ROWID),
    TABLE(spectrum, "Fragment mass spectrum of each run.", CLUSTERED("run_id, bin")),
    TABLE(ejecta, "Ejecta of each impact over their speed.", CLUSTERED("run_id, bin")),
    TABLE(point_total, "Running totals of each point, kept in the transaction that adds the runs.",
          CLUSTERED("point_id, results_version")),
    TABLE(point_spectrum, "Running pooled spectrum of each point, kept in the transaction that adds the runs.",
          CLUSTERED("point_id, results_version, bin")),
    TABLE(estimate, "Estimates made from the fragments of one run; they can be made again at any time.",
          CLUSTERED("run_id, ordinal"), .fields = &estimates_table),
    TABLE(point_estimate, "Estimates pooled over the runs of a point that count.",
          CLUSTERED("point_id, results_version, ordinal"), .fields = &estimates_table, DIGEST),
    TABLE(attempt, "Attempts that failed: limits, crashes, lost workers.", ROWID, DIGEST),
    TABLE(convergence, "Studies of convergence (clast converge): the levels of each knob, for each quantity.",
          CLUSTERED("base_point_id, results_version, knob, quantity, level"), .fields = &convergence_table, DIGEST),
    TABLE(convergence_limit, "Limit of each knob of a study, for each quantity.",
          CLUSTERED("base_point_id, results_version, knob, quantity"), .fields = &convergence_limit_table, DIGEST),
    TABLE(table_digest, "Number and digest of all rows of a table, for `clast check`.",
          .options = "STRICT, WITHOUT ROWID"),
    TABLE(holder, "The process that holds the store for writing, for the message of a refusal.", ROWID),
};
const size_t schema_tables_count = sizeof schema_tables / sizeof schema_tables[0];

/* run_statistics covers the means and scatters of the view `points`. Its order does not depend on which run finished
 * first, so the sums have the same bits for any number of workers. */
const struct schema_index schema_indexes[] = {
    {"run", "run_statistics", "point_id, results_version, counts, replicate, seed, state", true},
    {"attempt", "attempt_identity", "identity", false},
    {"attempt", "attempt_point", "point_id", false},
};
const size_t schema_indexes_count = sizeof schema_indexes / sizeof schema_indexes[0];

static const struct schema_column result_columns[] = {
    {"run_id", "INTEGER PRIMARY KEY REFERENCES run (run_id)", NULL, "the run"},
};

struct schema_table schema_result_table(const struct engine_kind *kind) {
  struct schema_table table = {.meaning = "What this engine reports beyond the columns of table run, one to one.",
                               .columns = result_columns,
                               .count = sizeof result_columns / sizeof result_columns[0],
                               .fields = kind->results,
                               .options = "STRICT"};
  snprintf(table.name, sizeof table.name, "result_%s", kind->name);
  return table;
}

/* The next engine from `index` on whose results are the same for all scenes. A table of another one comes with its
 * scenes. */
static size_t next_engine(size_t index) {
  while (index < engine_count() && engine_at(index)->of_scene)
    index++;
  return index;
}

size_t schema_table_count(void) {
  size_t count = schema_tables_count;
  for (size_t i = next_engine(0); i < engine_count(); i = next_engine(i + 1))
    count++;
  return count;
}

struct schema_table schema_table_at(size_t index) {
  if (index < schema_tables_count)
    return schema_tables[index];
  size_t engine = next_engine(0);
  for (size_t left = index - schema_tables_count; left > 0; left--)
    engine = next_engine(engine + 1);
  return schema_result_table(engine_at(engine));
}

void schema_write_counts(const char *not_surplus, FILE *out) {
  const struct field *state = field_find(&outcome_table, "state", NULL), *row;
  const char *before = "";
  fprintf(out, "%s AND state IN (", not_surplus);
  for (int i = 0; state->choices[i]; i++) {
    if (!outcome_is_usable(i))
      continue;
    fprintf(out, "%s'%s'", before, state->choices[i]);
    before = ", ";
  }
  fputs(")", out);
  for (size_t i = 0; (row = outcome_main(i)); i++)
    fprintf(out, " AND %s IS NOT NULL", row->path);
}

void schema_write_index(const struct schema_index *index, FILE *out) {
  const struct field *row;
  fprintf(out, "CREATE INDEX %s ON %s (%s", index->name, index->table, index->columns);
  for (size_t i = 0; index->with_main_results && (row = outcome_main(i)); i++)
    fprintf(out, ", %s", row->path);
  fputs(");\n", out);
}

/* A column of a table: of its own, or one that a field makes. */
struct column {
  char name[SCHEMA_NAME_SIZE];
  const char *source; /* for a developer: the name, or the path of the field row */
  const char *declaration, *unit;
  const char *meaning;     /* of the table's own */
  const struct field *row; /* of a field; else NULL */
};

static size_t column_count(const struct schema_table *table) {
  return table->count + (table->fields ? table->fields->count : 0);
}

/* The table's own columns come first. */
static struct column column_at(const struct schema_table *table, size_t index) {
  struct column column = {.row = NULL};
  if (index < table->count) {
    const struct schema_column *own = &table->columns[index];
    column.source = own->name;
    column.declaration = own->declaration;
    column.unit = own->unit;
    column.meaning = own->meaning;
    snprintf(column.name, sizeof column.name, "%s", own->name);
    return column;
  }
  column.row = &table->fields->rows[index - table->count];
  column.source = column.row->path;
  column.declaration = sql_type(column.row);
  column.unit = column.row->unit;
  field_column_name(column.row->path, column.name, sizeof column.name);
  return column;
}

/* A store is also read without clast, so the meaning of a column names the choices. */
static void write_column_meaning(const struct column *column, FILE *out) {
  const struct field *row = column->row;
  for (const char *c = !row ? column->meaning : row->doc ? row->doc : ""; *c; c++)
    fputc(*c == '\n' ? ' ' : *c, out);
  for (size_t i = 0; row && row->choices && row->choices[i]; i++)
    fprintf(out, "%s%s", i ? ", " : " One of: ", row->choices[i]);
}

static void write_declaration(const struct column *column, FILE *out) {
  fprintf(out, "%s %s", column->name, column->declaration);
  if (strcmp(column->name, "counts") == 0) { /* of table run */
    fprintf(out, " CHECK (%s = (", column->name);
    schema_write_counts("surplus = 0", out);
    fputs("))", out);
  }
}

bool schema_write_column(const struct schema_table *table, const char *name, FILE *out) {
  for (size_t i = 0; i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    if (strcmp(column.name, name) != 0)
      continue;
    write_declaration(&column, out);
    return true;
  }
  return false;
}

void schema_write_table(const struct schema_table *table, FILE *out) {
  const size_t count = column_count(table);
  fprintf(out, "CREATE TABLE %s ( -- %s\n", table->name, table->meaning);
  for (size_t i = 0; i < count; i++) {
    const struct column column = column_at(table, i);
    fputs("  ", out);
    write_declaration(&column, out);
    fputs(i + 1 == count && !table->tail ? " -- " : ", -- ", out);
    if (column.unit)
      fprintf(out, "[%s] ", column.unit);
    write_column_meaning(&column, out);
    fputc('\n', out);
  }
  if (table->tail)
    fprintf(out, "  %s\n", table->tail);
  fprintf(out, ") %s;\n", table->options);
}

status schema_check_names(const struct schema_table *table, struct error *error) {
  for (size_t i = 0; i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    for (size_t j = 0; j < i; j++) {
      const struct column earlier = column_at(table, j);
      if (sqlite3_stricmp(column.name, earlier.name) == 0)
        return status_fail(
            error, STATUS_INTERNAL,
            "'%s' and '%s' would be one column of table %s, %s: give one of them another name in its row",
            earlier.source, column.source, table->name, column.name);
    }
  }
  return STATUS_OK;
}

bool schema_has_column(sqlite3 *db, const char *table, const char *column) {
  return sqlite3_table_column_metadata(db, "main", table, column, NULL, NULL, NULL, NULL, NULL) == SQLITE_OK;
}

bool schema_may_lack(const char *table, const char *column) {
  return strcmp(table, "table_digest") == 0 || strcmp(table, "ejecta") == 0 ||
         (strcmp(table, "fragment_mass") == 0 && strcmp(column, "lengths") == 0) ||
         (strcmp(table, "run") == 0 && (strcmp(column, "fields_digest") == 0 || strncmp(column, "excluded", 8) == 0));
}

bool schema_is_complete(sqlite3 *db) {
  for (size_t i = 0; i < schema_tables_count; i++)
    for (size_t k = 0; k < column_count(&schema_tables[i]); k++) {
      const struct column column = column_at(&schema_tables[i], k);
      if (!schema_may_lack(schema_tables[i].name, column.name) &&
          !schema_has_column(db, schema_tables[i].name, column.name))
        return false;
    }
  return true;
}

/* Results must be deterministic; the table's own columns may differ from machine to machine. */
static status write_doc(sqlite3 *db, const char *table, const struct column *column, struct error *error) {
  OWNED char *meaning = NULL;
  FILE *out = text_open(&meaning);
  write_column_meaning(column, out);
  text_close_small(out, &meaning);
  return sql_executef(db, "documenting columns", error,
                      "INSERT OR REPLACE INTO column_doc (table_name, column_name, unit, meaning, "
                      "deterministic) VALUES (%Q, %Q, %Q, %Q, %d)",
                      table, column->name, column->unit, meaning, column->row != NULL);
}

static status create(sqlite3 *db, const struct schema_table *table, struct error *error) {
  OWNED char *sql = NULL;
  FILE *text = text_open(&sql);
  schema_write_table(table, text);
  for (size_t i = 0; i < schema_indexes_count; i++)
    if (strcmp(schema_indexes[i].table, table->name) == 0)
      schema_write_index(&schema_indexes[i], text);
  return sql_execute(db, text_close_small(text, &sql), "creating tables", error);
}

status schema_complete(sqlite3 *db, const struct schema_table *table, struct error *error) {
  const bool has = schema_has_column(db, table->name, NULL);
  bool grown = !has;
  TRY(schema_check_names(table, error));
  if (!has)
    TRY(create(db, table, error));
  for (size_t i = 0; has && i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    if (schema_has_column(db, table->name, column.name))
      continue;
    grown = true;
    TRY(sql_executef(db, "adding a column", error, "ALTER TABLE \"%w\" ADD COLUMN \"%w\" %s", table->name, column.name,
                     column.declaration));
  }
  for (size_t i = 0; grown && i < column_count(table); i++) {
    const struct column column = column_at(table, i);
    TRY(write_doc(db, table->name, &column, error));
  }
  return STATUS_OK;
}

status schema_document_all(sqlite3 *db, struct error *error) {
  for (size_t i = 0; i < schema_table_count(); i++) {
    const struct schema_table table = schema_table_at(i);
    for (size_t k = 0; k < column_count(&table); k++) {
      const struct column column = column_at(&table, k);
      if (schema_has_column(db, table.name, column.name))
        TRY(write_doc(db, table.name, &column, error));
    }
  }
  return STATUS_OK;
}

status schema_complete_all(sqlite3 *db, struct error *error) {
  for (size_t i = 0; i < schema_table_count(); i++) {
    const struct schema_table table = schema_table_at(i);
    TRY(schema_complete(db, &table, error));
  }
  return STATUS_OK;
}
