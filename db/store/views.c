/* Writes the views, and the plain SQL of their statistics. */
#include "db/store/views.h"

#include <stdlib.h>
#include <string.h>

#include "db/store/schema.h"
#include "engine/outcome.h"
#include "schemas/text.h"

const char *const views_names[VIEWS_COUNT] = {"runs", "points", "spectra", "estimates", "resolution"};

size_t views_main_results(const char *names[VIEWS_MAIN_MAXIMUM]) {
  size_t count = 0;
  for (const struct field *row; count < VIEWS_MAIN_MAXIMUM && (row = outcome_main(count)); count++)
    names[count] = row->path;
  return count;
}

/* Exact for few degrees of freedom, then Cornish & Fisher's expansion (Abramowitz & Stegun 26.7.5), within 5e-6. */
void views_write_student(const char *degrees, FILE *out) {
  static const char *const exact[] = {"12.706204736174", "4.302652729749", "3.182446305284", "2.776445105198",
                                      "2.570581835636",  "2.446911851145", "2.364624251593", "2.306004135204",
                                      "2.262157162798",  "2.228138851986"};
  fprintf(out, "CASE");
  for (size_t i = 0; i < sizeof exact / sizeof exact[0]; i++)
    fprintf(out, " WHEN %s = %zu THEN %s", degrees, i + 1, exact[i]);
  fprintf(out,
          "\n      WHEN %1$s > 10 THEN 1.959963984540 + (2.372271230299 + (2.822498615740 + (2.555849679508 "
          "+ 1.589534053394 / %1$s) / %1$s) / %1$s) / %1$s END",
          degrees);
}

/* Studies name a quantity as its engine does; the view runs may have put the engine's table in front. */
static void write_is_quantity(const char *name, FILE *out) {
  char *sql = sqlite3_mprintf("%Q IN (quantity, 'result_' || engine || '_' || quantity)", name);
  fputs(sql ? sql : "NULL", out); /* without memory the next query fails, too */
  sqlite3_free(sql);
}

static status each_row(sqlite3 *db, const char *sql, void (*write)(FILE *out, sqlite3_stmt *row), FILE *out,
                       struct error *error) {
  sqlite3_stmt *statement = NULL;
  status result = sql_prepare(db, sql, &statement, "making the views", error);
  int code = SQLITE_DONE;
  while (result == STATUS_OK && (code = sqlite3_step(statement)) == SQLITE_ROW)
    write(out, statement);
  if (result == STATUS_OK && code != SQLITE_DONE)
    result = sql_fail(db, code, "making the views", error);
  sqlite3_finalize(statement);
  return result;
}

static void write_text(FILE *out, sqlite3_stmt *row) {
  fputs(sql_text(row, 0), out);
}

static status write_axes(sqlite3 *db, FILE *out, struct error *error) {
  return each_row(db,
                  "SELECT format('  (SELECT value FROM point_input i WHERE i.point_id = p.point_id AND i.path = %Q) AS "
                  "\"%w\",' || char(10), path, column_name) FROM axis ORDER BY path",
                  write_text, out, error);
}

/* Does the result table of an engine hold a row? */
static bool is_filled(sqlite3 *db, const char *table) {
  int64_t filled = 0;
  char *sql = sqlite3_mprintf("SELECT EXISTS (SELECT 1 FROM main.\"%w\")", table);
  const bool is = sql && sql_integer(db, sql, 0, &filled, NULL) == STATUS_OK && filled;
  sqlite3_free(sql);
  return is;
}

/* The result tables of the engines that have runs, as the inside of IN (...); all of them while there are no runs.
 * sqlite3_free() it. NULL: *error. */
static char *result_tables(sqlite3 *db, struct error *error) {
  static const char
      sql[] = "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name GLOB 'result_*' ORDER BY 1";
  char *list = NULL;
  for (int all = 0; all < 2 && !list; all++) {
    sqlite3_stmt *names = NULL;
    status result = sql_prepare(db, sql, &names, "making the views", error);
    if (result != STATUS_OK)
      return NULL;
    while (sql_next(names, &result, "making the views", error)) {
      if (!all && !is_filled(db, sql_text(names, 0)))
        continue;
      char *longer = sqlite3_mprintf("%z%s%Q", list, list ? ", " : "", sql_text(names, 0));
      list = longer;
    }
    sqlite3_finalize(names);
    if (result != STATUS_OK) {
      sqlite3_free(list);
      return NULL;
    }
  }
  if (!list)
    list = sqlite3_mprintf("''");
  if (!list)
    status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
  return list;
}

/* each_row of an SQL text in which %s is the list of result tables. */
static status each_of_tables(sqlite3 *db, const char *format, const char *tables, FILE *out, struct error *error) {
  char *sql = NULL;
  size_t size = 0;
  FILE *text = open_memstream(&sql, &size);
  const char *place = strstr(format, "%s");
  if (!text)
    return status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
  fprintf(text, "%.*s%s%s", (int)(place - format), format, tables, place + 2);
  if (!text_close(text, &sql))
    return status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
  const status result = each_row(db, sql, write_text, out, error);
  free(sql);
  return result;
}

/* Columns of run, then of the engines' result tables. An engine's column with the name of another column gets its
 * table's name in front: so in a store with runs of two engines. */
static status write_result_columns(sqlite3 *db, const char *tables, FILE *out, struct error *error) {
  status
      result = each_row(db,
                        "SELECT format('  r.\"%w\",' || char(10), name) FROM pragma_table_xinfo('run') WHERE name NOT "
                        "IN ('run_id', 'point_id', 'replicate', 'seed', 'identity', 'digest')",
                        write_text, out, error);
  if (result != STATUS_OK)
    return result;
  return each_of_tables(
      db,
      "WITH mine AS MATERIALIZED (SELECT t.name AS place, c.name AS name, c.cid AS cid FROM main.sqlite_schema t, "
      "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name IN (%s) AND c.name <> 'run_id'), "
      "shared AS MATERIALIZED (SELECT name FROM pragma_table_xinfo('run', 'main') UNION ALL SELECT name FROM mine "
      "GROUP BY name HAVING count(*) > 1) SELECT format('  \"%w\".\"%w\"%s,' || char(10), place, name, iif(name IN "
      "shared, format(' AS \"%w_%w\"', place, name), '')) FROM mine ORDER BY place, cid",
      tables, out, error);
}

static status write_runs_of(sqlite3 *db, const char *tables, FILE *out, struct error *error) {
  fprintf(out, "runs AS -- every run with its varied inputs and all results of its engine\n"
               "SELECT r.run_id, r.point_id, p.engine, p.scene_name AS scene, r.replicate, r.seed,\n");
  status result = write_axes(db, out, error);
  if (result != STATUS_OK)
    return result;
  result = write_result_columns(db, tables, out, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "  lower(hex(r.identity)) AS identity\nFROM run r JOIN point p ON p.point_id = r.point_id");
  result = each_of_tables(db,
                          "SELECT format(char(10) || '  LEFT JOIN \"%w\" ON \"%w\".run_id = r.run_id', name, name) "
                          "FROM main.sqlite_schema WHERE type = 'table' AND name IN (%s) ORDER BY name",
                          tables, out, error);
  fprintf(out, ";\n");
  return result;
}

static status write_runs(sqlite3 *db, FILE *out, struct error *error) {
  char *tables = result_tables(db, error);
  if (!tables)
    return error ? error->status : STATUS_MEMORY;
  const status result = write_runs_of(db, tables, out, error);
  sqlite3_free(tables);
  return result;
}

/* One pass over the index run_statistics. Deviations are from the value of the point's first run (kN), so that nothing
 * cancels; they are summed in the order of replicates, so that the bits do not depend on which run finished first. No
 * main result of a run that counts is NULL (a CHECK of table run). */
void views_write_statistics(size_t count, const char *const *names, FILE *out) {
  fprintf(out, "WITH first AS (\n  SELECT ");
  for (size_t i = 0; i < count; i++)
    fprintf(out, "k.%s AS k%zu, ", names[i], i);
  fprintf(
      out,
      "t.point_id, t.results_version\n  FROM point_total t JOIN run k ON k.run_id = (SELECT f.run_id FROM run f WHERE "
      "f.point_id =\n    t.point_id AND f.results_version = t.results_version AND f.counts = 1 ORDER BY f.replicate, "
      "f.seed LIMIT 1)\n"
      "), moment AS (\n  SELECT f.point_id, f.results_version, count(*) AS n");
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n    k%2$zu, total(r.%1$s - k%2$zu) AS s%2$zu, total((r.%1$s - k%2$zu) * (r.%1$s - k%2$zu)) AS q%2$zu",
            names[i], i);
  fprintf(out,
          "\n  FROM first f CROSS JOIN run r ON r.point_id = f.point_id AND r.results_version = f.results_version AND\n"
          "    r.counts = 1\n  GROUP BY f.point_id, f.results_version\n"
          "), scatter AS (\n  SELECT point_id, results_version, n,\n    ");
  views_write_student("(n - 1)", out);
  fprintf(out, " AS t");
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n    k%1$zu + s%1$zu / n AS m%1$zu, sqrt(max(0, (q%1$zu - s%1$zu * s%1$zu / n) / (n - 1))) AS d%1$zu",
            i);
  fprintf(out, "\n  FROM moment\n)\n");
}

/* The main results that the store has: an older one that is only read may lack some. */
static status stored_main_results(sqlite3 *db, size_t *count, const char *names[VIEWS_MAIN_MAXIMUM],
                                  struct error *error) {
  const char *all[VIEWS_MAIN_MAXIMUM];
  const size_t most = views_main_results(all);
  status result = STATUS_OK;
  *count = 0;
  for (size_t i = 0; result == STATUS_OK && i < most; i++) {
    bool has = false;
    result = schema_has_column(db, "run", all[i], &has, error);
    if (has)
      names[(*count)++] = all[i];
  }
  return result;
}

/* For every point and quantity that a study has: the sum over the knobs of resolution of what each leaves unknown at
 * the point, or, when the point is no level of the knob, at the scene's own setting. Of several studies counts the one
 * that knows least. */
static status write_resolution(sqlite3 *db, FILE *out, struct error *error) {
  bool studies = false; /* a store of an earlier program has no table for them */
  status result = schema_has_column(db, "convergence", "resolution", &studies, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "resolution AS -- what finer settings may change in a result, for every point that was studied\n");
  if (!studies)
    fprintf(out, "SELECT NULL AS point_id, NULL AS results_version, NULL AS quantity, NULL AS half_width, NULL AS "
                 "verdict WHERE false;\n");
  else
    fprintf(
        out,
        "WITH level AS (SELECT * FROM convergence WHERE resolution IS NOT NULL),\n"
        "of_knob AS (SELECT base_point_id, results_version, quantity, knob,\n"
        "    max(iif(base, resolution, NULL)) AS at_base, max(open) AS open, max(verdict = 'no-order') AS diverges\n"
        "  FROM level LEFT JOIN convergence_limit USING (base_point_id, results_version, knob, quantity)\n"
        "  GROUP BY base_point_id, results_version, quantity, knob),\n"
        "studied AS (SELECT DISTINCT base_point_id, results_version, quantity, point_id FROM level),\n"
        "of_study AS (SELECT s.point_id, s.results_version, s.quantity,\n"
        "    sum(coalesce(l.resolution, k.at_base)) AS half_width, max(k.diverges) AS diverges,\n"
        "    max(k.open OR coalesce(l.resolution, k.at_base) IS NULL) AS open\n"
        "  FROM studied s JOIN of_knob k USING (base_point_id, results_version, quantity)\n"
        "    LEFT JOIN level l ON l.base_point_id = s.base_point_id AND l.results_version = s.results_version\n"
        "    AND l.quantity = s.quantity AND l.knob = k.knob AND l.point_id = s.point_id\n"
        "  GROUP BY s.base_point_id, s.point_id, s.results_version, s.quantity\n"
        "  UNION ALL SELECT s.point_id, s.results_version, s.quantity, s.error, (SELECT max(k.diverges) FROM of_knob "
        "k\n"
        "    WHERE k.base_point_id = s.base_point_id AND k.results_version = s.results_version AND\n"
        "    k.quantity = s.quantity), s.open\n"
        "  FROM convergence s WHERE s.knob = 'settings' AND NOT s.base AND s.error IS NOT NULL)\n"
        "SELECT point_id, results_version, quantity, max(half_width) AS half_width,\n"
        "  CASE WHEN max(diverges) THEN 'diverges' WHEN max(open) THEN 'at-least' ELSE 'known' END AS verdict\n"
        "FROM of_study GROUP BY point_id, results_version, quantity;\n");
  return STATUS_OK;
}

void views_write_resolution(size_t count, const char *const *names, FILE *out) {
  fprintf(out, "(SELECT point_id, results_version");
  for (size_t i = 0; i < count; i++) {
    fputs(",\n    max(iif(", out);
    write_is_quantity(names[i], out);
    fprintf(out, ", half_width, NULL)) AS e%zu, max(iif(", i);
    write_is_quantity(names[i], out);
    fprintf(out, ", verdict, NULL)) AS v%zu", i);
  }
  fprintf(out, "\n  FROM resolution JOIN point USING (point_id) GROUP BY point_id, results_version)");
}

static status write_points(sqlite3 *db, FILE *out, struct error *error) {
  const char *names[VIEWS_MAIN_MAXIMUM] = {NULL};
  size_t count = 0;
  status result = stored_main_results(db, &count, names, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "points AS -- statistics of every point, one row per results_version\n");
  views_write_statistics(count, names, out);
  fprintf(out, ", unresolved AS MATERIALIZED ");
  views_write_resolution(count, names, out);
  fprintf(out, "\nSELECT p.point_id, p.engine, p.scene_name AS scene,\n");
  result = write_axes(db, out, error);
  fprintf(
      out,
      "  t.results_version, ifnull(t.runs, 0) AS n, ifnull(t.censored, 0) AS censored, ifnull(t.failed, 0) AS "
      "failed,\n  ifnull(t.surplus, 0) AS surplus, (SELECT count(*) FROM attempt a WHERE a.point_id = p.point_id) AS "
      "failed_attempts");
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n  m%2$zu AS %1$s_mean, d%2$zu AS %1$s_sd, d%2$zu / sqrt(n) AS %1$s_se, s.t * d%2$zu / sqrt(n) AS "
            "%1$s_hw95,\n  e%2$zu AS %1$s_resolution, ifnull(v%2$zu, 'not-studied') AS %1$s_resolution_verdict",
            names[i], i);
  fprintf(out, "\nFROM point p NOT INDEXED LEFT JOIN point_total t ON t.point_id = p.point_id\n"
               "  LEFT JOIN scatter s ON s.point_id = t.point_id AND s.results_version = t.results_version\n"
               "  LEFT JOIN unresolved u ON u.point_id = t.point_id AND u.results_version = t.results_version;\n");
  return result;
}

static status write_spectra(sqlite3 *db, FILE *out, struct error *error) {
  fprintf(out, "spectra AS -- pooled fragment mass spectrum of every point\n"
               "SELECT p.point_id, p.engine, p.scene_name AS scene,\n");
  status result = write_axes(db, out, error);
  fprintf(out, "  s.results_version, t.runs AS n, s.bin, b.lower, b.upper, s.runs, s.count, s.mass,\n"
               "  1.0 * s.count / t.runs AS count_mean,\n"
               "  sqrt(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1))) AS count_sd,\n  (");
  views_write_student("(t.runs - 1)", out);
  fprintf(out, ") * sqrt(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1) / t.runs)) AS "
               "count_hw95,\n"
               "  s.count / (t.fragments * (b.upper - b.lower)) AS density\n"
               "FROM point p JOIN point_total t ON t.point_id = p.point_id\n"
               "  JOIN point_spectrum s ON s.point_id = t.point_id AND s.results_version = t.results_version\n"
               "  JOIN bin b ON b.bin = s.bin;\n");
  return result;
}

static status write_estimate_columns(sqlite3 *db, FILE *out, struct error *error) {
  return each_row(db, "SELECT format('\"%w\", ', name) FROM pragma_table_xinfo('estimate') WHERE name <> 'run_id'",
                  write_text, out, error);
}

static status write_estimates(sqlite3 *db, FILE *out, struct error *error) {
  fprintf(out, "estimates AS -- estimates of runs (run_id) and of whole points (run_id NULL)\n"
               "SELECT e.point_id, e.run_id, e.replicate, e.seed, e.counts, p.engine, p.scene_name AS scene,\n");
  status result = write_axes(db, out, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "  ");
  result = write_estimate_columns(db, out, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "e.results_version\nFROM (\n  SELECT r.point_id, r.run_id, r.replicate, r.seed, r.counts, ");
  result = write_estimate_columns(db, out, error);
  if (result != STATUS_OK)
    return result;
  fprintf(out, "r.results_version\n  FROM estimate JOIN run r USING (run_id)\n  UNION ALL\n"
               "  SELECT point_id, NULL, NULL, NULL, NULL, ");
  result = write_estimate_columns(db, out, error);
  fprintf(out, "results_version FROM point_estimate\n) e JOIN point p ON p.point_id = e.point_id;\n");
  return result;
}

/* Axis columns, statistics and the views' own columns first; the others inherit from the table they come from. */
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
  static status (*const writers[VIEWS_COUNT])(sqlite3 *, FILE *, struct error *) = {write_runs, write_points,
                                                                                    write_spectra, write_estimates,
                                                                                    write_resolution};
  status result = STATUS_OK;
  *text = (struct views_text){{NULL}};
  for (size_t i = 0; result == STATUS_OK && i < VIEWS_COUNT; i++) {
    size_t size = 0;
    FILE *out = open_memstream(&text->of[i], &size);
    if (!out)
      return status_fail(error, STATUS_MEMORY, "making the views: memory ran out");
    result = writers[i](db, out, error);
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

status views_make_temporary(sqlite3 *db, struct error *error) {
  struct views_text text;
  status result = write_all(db, &text, error);
  if (result == STATUS_OK)
    result = make(db, "temp", &text, error);
  free_text(&text);
  return result;
}

status views_regenerate(sqlite3 *db, struct error *error) {
  struct views_text text;
  status result = write_all(db, &text, error);
  if (result == STATUS_OK)
    result = make(db, "temp", &text, error);
  if (result == STATUS_OK)
    result = make(db, "main", &text, error);
  free_text(&text);
  return result == STATUS_OK ? document(db, error) : result;
}

status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error) {
  char plain[256];
  sqlite3_stmt *statement = NULL;
  field_column_name(path, plain, sizeof plain);
  status result = sql_prepare(db,
                              "SELECT 1 FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v, "
                              "pragma_table_info(v.column1) c WHERE c.name = ?1 UNION ALL SELECT 1 FROM axis WHERE "
                              "column_name = ?1 UNION ALL SELECT 1 FROM main.sqlite_schema t, "
                              "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name GLOB 'result_*' "
                              "AND c.name = ?1",
                              &statement, "making the views", error);
  if (result != STATUS_OK)
    return result;
  sqlite3_bind_text(statement, 1, plain, -1, SQLITE_STATIC);
  bool taken = sqlite3_step(statement) == SQLITE_ROW;
  snprintf(name, size, "%s%s", taken ? "input_" : "", plain);
  sqlite3_finalize(statement);
  return STATUS_OK;
}
