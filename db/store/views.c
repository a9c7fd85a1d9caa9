/* Makes the views, in the file and for one connection, and their rows of column_doc. */
#include "db/store/views.h"

#include <stdlib.h>

#include "schemas/field.h"
#include "schemas/text.h"

const char *const views_names[VIEWS_COUNT] = {"runs", "points", "spectra", "estimates", "resolution"};

/* Documents axis columns, statistics and the views' own columns first; the others inherit from their table. */
static status document(sqlite3 *db, struct error *error) {
  static const char sql[] =
      "DELETE FROM column_doc WHERE table_name IN ('runs', 'points', 'spectra', 'estimates', 'resolution');"
      "INSERT INTO column_doc (table_name, column_name, unit, meaning) SELECT v.column1, column_name, unit, meaning || "
      "' (input ' || path || ')' FROM axis, "
      "(VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v;"
      "INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning) SELECT v.column1, w.column1, NULL, "
      "w.column2 FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v, (VALUES ('scene', 'name of the "
      "scene the inputs "
      "started from')) w;INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning) VALUES"
      "('points', 'n', '1', 'runs that count: completed, or ended at their time, and not surplus'),"
      "('points', 'failed_attempts', '1', 'attempts that failed: limits, crashes, lost workers'),"
      "('spectra', 'n', '1', 'runs of the point that count'),"
      "('spectra', 'count', '1', 'fragments in the bin, of all runs'),"
      "('spectra', 'mass', 'kg', 'their mass'),"
      "('spectra', 'count_mean', '1', 'fragments in the bin per run'),"
      "('spectra', 'count_sd', '1', 'standard deviation of the count between runs'),"
      "('spectra', 'count_hw95', '1', 'half width of the 95 % confidence interval of count_mean (Student)'),"
      "('spectra', 'density', '1/kg', 'fragment number density F(m): share of all fragments per unit mass; its "
      "integral over mass is 1'),"
      "('resolution', 'point_id', NULL, 'the point: the scene of a study, or one of its levels'),"
      "('resolution', 'results_version', NULL, 'version of the engine''s results that was studied'),"
      "('resolution', 'quantity', NULL, 'the result, as a column of the view runs; beta or beta_METHOD_WINDOW: an "
      "exponent of all runs of a point'),"
      "('resolution', 'half_width', NULL, 'how far finer settings may move the result, in its unit: all "
      "knobs that were studied'),"
      "('resolution', 'verdict', NULL, 'known; at least: no limit is known yet, so that half_width may be too small; "
      "diverges: the result does not converge');"
      "INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning) SELECT 'points', d.column_name || "
      "s.column1, d.unit, s.column2 || d.meaning "
      "FROM column_doc d, (VALUES ('_mean', 'mean over runs: '), ('_sd', 'standard deviation between runs: '), "
      "('_se', 'standard error of the mean: '), ('_hw95', 'half width of the 95 % confidence interval of the mean "
      "(Student): '), ('_resolution', 'how far finer settings may move the mean (view resolution): '), "
      "('_resolution_verdict', 'known, at least, diverges, or not studied: ')) s WHERE d.table_name = 'run' AND EXISTS "
      "(SELECT 1 FROM pragma_table_info('points') c WHERE "
      "c.name = d.column_name || s.column1);"
      "INSERT OR IGNORE INTO column_doc (table_name, column_name, unit, meaning) SELECT v.column1, c.name, d.unit, "
      "d.meaning FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v, pragma_table_info(v.column1) c, "
      "column_doc d "
      "WHERE (d.column_name = c.name OR d.table_name || '_' || d.column_name = c.name) AND (d.table_name IN ('run', "
      "'point', 'point_total', 'point_spectrum', 'bin', 'estimate') OR d.table_name GLOB 'result_*') "
      "ORDER BY CASE WHEN d.table_name IN ('estimate', 'point_total', 'point_spectrum', 'bin') THEN v.column1 IN "
      "('runs') ELSE v.column1 NOT IN ('runs') END;";
  return sql_execute(db, sql, "documenting the views", error);
}

/* The text of the views after their CREATE VIEW and schema. free() each. */
struct views_text {
  char *of[VIEWS_COUNT];
};

static status write_all(sqlite3 *db, struct views_text *text, struct error *error) {
  status result = STATUS_OK;
  *text = (struct views_text){{NULL}};
  for (size_t i = 0; result == STATUS_OK && i < VIEWS_COUNT; i++) {
    size_t size = 0;
    FILE *out = text_open(&text->of[i], &size);
    if (!out)
      return status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
    result = views_text_write(db, i, out, error);
    if (!text_close(out, &text->of[i]))
      return status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
  }
  return result;
}

/* Drops and creates the views in the schema `place`: main or temp. */
static status make(sqlite3 *db, const char *place, const struct views_text *text, struct error *error) {
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && i < VIEWS_COUNT; i++)
    result = sql_executef(db, "making the views", error, "DROP VIEW IF EXISTS %s.%s; CREATE VIEW %s.%s", place,
                          views_names[i], place, text->of[i]);
  return result;
}

static void free_text(struct views_text *text) {
  for (size_t i = 0; i < VIEWS_COUNT; i++)
    free(text->of[i]);
}

/* Makes the views of the connection and, with `stored`, those of the file. */
static status make_all(sqlite3 *db, bool stored, struct error *error) {
  struct views_text text;
  status result = write_all(db, &text, error);
  if (result == STATUS_OK)
    result = make(db, "temp", &text, error);
  if (result == STATUS_OK && stored)
    result = make(db, "main", &text, error);
  free_text(&text);
  return result;
}

status views_make_temporary(sqlite3 *db, struct error *error) {
  return make_all(db, false, error);
}

status views_regenerate(sqlite3 *db, struct error *error) {
  const status result = make_all(db, true, error);
  return result == STATUS_OK ? document(db, error) : result;
}

status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error) {
  char plain[256];
  sqlite3_stmt *statement = NULL;
  field_column_name(path, plain, sizeof plain);
  status result =
      sql_prepare(db,
                  "SELECT 1 FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v, "
                  "pragma_table_info(v.column1) c WHERE c.name = ?1 COLLATE NOCASE UNION ALL SELECT 1 FROM axis WHERE "
                  "column_name = ?1 COLLATE NOCASE UNION ALL SELECT 1 FROM main.sqlite_schema t, "
                  "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name GLOB 'result_*' "
                  "AND c.name = ?1 COLLATE NOCASE",
                  &statement, "making the views", error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_text(statement, 1, plain, -1, SQLITE_STATIC);
  bool taken = sqlite3_step(statement) == SQLITE_ROW;
  snprintf(name, size, "%s%s", taken ? "input_" : "", plain);
  sqlite3_finalize(statement);
  return STATUS_OK;
}
