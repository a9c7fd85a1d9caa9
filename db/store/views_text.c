/* Writes the text of the views from the columns that a database has. */
#include "db/store/views_text.h"

#include "db/store/schema.h"
#include "db/store/views_statistics.h"

static const char doing[] = "making the views";

/* The view that is being written. After the first error the database is not queried again, and the text is not
 * valid. */
struct view {
  sqlite3 *db;
  FILE *out;
  status result;
  struct error *error;
};

/* Runs SQL that returns one text per row, and writes these texts. */
static void write_rows(struct view *view, const char *sql) {
  sqlite3_stmt *statement = NULL;
  if (view->result == STATUS_OK)
    view->result = sql_prepare(view->db, sql, &statement, doing, view->error);
  while (view->result == STATUS_OK && sql_next(statement, &view->result, doing, view->error))
    fputs(sql_text(statement, 0), view->out);
  sqlite3_finalize(statement);
}

/* The same for SQL that sqlite3_mprintf made; frees it. */
static void write_rows_of(struct view *view, char *sql) {
  if (sql)
    write_rows(view, sql);
  else if (view->result == STATUS_OK)
    view->result = status_fail(view->error, STATUS_MEMORY, "%s: memory ran out", doing);
  sqlite3_free(sql);
}

static void write_axes(struct view *view) {
  write_rows(view,
             "SELECT format('  (SELECT value FROM point_input i WHERE i.point_id = p.point_id AND i.path = %Q) AS "
             "\"%w\",' || char(10), path, column_name) FROM axis ORDER BY path");
}

/* Does the result table of an engine hold a row? */
static bool is_filled(sqlite3 *db, const char *table) {
  int64_t filled = 0;
  return sql_integerf(db, &filled, NULL, "SELECT EXISTS (SELECT 1 FROM main.\"%w\")", table) == STATUS_OK && filled;
}

/* The names of the result tables, or of those that hold a row, as the inside of IN (...). NULL: there is none. Free
 * with sqlite3_free(). */
static char *list_tables(struct view *view, bool filled_only) {
  sqlite3_stmt *names = NULL;
  char *list = NULL;
  view->result = sql_prepare(
      view->db, "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name GLOB 'result_*' ORDER BY 1", &names,
      doing, view->error);
  while (view->result == STATUS_OK && sql_next(names, &view->result, doing, view->error))
    if (!filled_only || is_filled(view->db, sql_text(names, 0)))
      list = sqlite3_mprintf("%z%s%Q", list, list ? ", " : "", sql_text(names, 0));
  sqlite3_finalize(names);
  return list;
}

/* The result tables of the engines that have runs; of all engines while there are no runs. */
static char *result_tables(struct view *view) {
  char *list = list_tables(view, true);
  if (!list && view->result == STATUS_OK)
    list = list_tables(view, false);
  return list ? list : sqlite3_mprintf("''");
}

/* Writes the columns of run, then of the engines' result tables. An engine's column with the name of another column
 * gets its table's name as a prefix; this happens in a store with runs of two engines. */
static void write_result_columns(struct view *view, const char *tables) {
  write_rows(view, "SELECT format('  r.\"%w\",' || char(10), name) FROM pragma_table_xinfo('run') WHERE name NOT "
                   "IN ('run_id', 'point_id', 'replicate', 'seed', 'identity', 'digest')");
  write_rows_of(
      view,
      sqlite3_mprintf(
          "WITH mine AS MATERIALIZED (SELECT t.name AS place, c.name AS name, c.cid AS cid FROM main.sqlite_schema t, "
          "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name IN (%s) AND c.name <> 'run_id'), "
          "shared AS MATERIALIZED (SELECT name FROM pragma_table_xinfo('run', 'main') UNION ALL SELECT name FROM mine "
          "GROUP BY name HAVING count(*) > 1) SELECT format('  \"%%w\".\"%%w\"%%s,' || char(10), place, name, iif(name "
          "IN shared, format(' AS \"%%w_%%w\"', place, name), '')) FROM mine ORDER BY place, cid",
          tables));
}

static void write_runs(struct view *view) {
  char *tables = result_tables(view);
  fputs("runs AS -- every run with its varied inputs and all results of its engine\n"
        "SELECT r.run_id, r.point_id, p.engine, p.scene_name AS scene, r.replicate, r.seed,\n",
        view->out);
  write_axes(view);
  write_result_columns(view, tables);
  fputs("  lower(hex(r.identity)) AS identity\nFROM run r JOIN point p ON p.point_id = r.point_id", view->out);
  write_rows_of(
      view, sqlite3_mprintf("SELECT format(char(10) || '  LEFT JOIN \"%%w\" ON \"%%w\".run_id = r.run_id', name, name) "
                            "FROM main.sqlite_schema WHERE type = 'table' AND name IN (%s) ORDER BY name",
                            tables));
  fputs(";\n", view->out);
  sqlite3_free(tables);
}

static bool has_column(struct view *view, const char *table, const char *column) {
  bool has = false;
  if (view->result == STATUS_OK)
    view->result = schema_has_column(view->db, table, column, &has, view->error);
  return has;
}

/* For every point and quantity with a study: the sum over the knobs of the error that each knob leaves, taken at the
 * point or, when the point is no level of the knob, at the scene's own setting. Among several studies, the one with the
 * largest error counts. */
static const char resolution_sql[] =
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
    "FROM of_study GROUP BY point_id, results_version, quantity;\n";

static void write_resolution(struct view *view) {
  fputs("resolution AS -- what finer settings may change in a result, for every point that was studied\n", view->out);
  if (has_column(view, "convergence", "resolution"))
    fputs(resolution_sql, view->out);
  else /* a store of an earlier program has no table for them */
    fputs("SELECT NULL AS point_id, NULL AS results_version, NULL AS quantity, NULL AS half_width, NULL AS "
          "verdict WHERE false;\n",
          view->out);
}

/* The main results that the store has: a read-only older store may lack some. */
static size_t stored_main_results(struct view *view, const char *names[VIEWS_STATISTICS_MAIN]) {
  const char *all[VIEWS_STATISTICS_MAIN];
  const size_t most = views_statistics_main(all);
  size_t count = 0;
  for (size_t i = 0; i < most; i++)
    if (has_column(view, "run", all[i]))
      names[count++] = all[i];
  return count;
}

static void write_points(struct view *view) {
  const char *names[VIEWS_STATISTICS_MAIN] = {NULL};
  const size_t count = stored_main_results(view, names);
  FILE *out = view->out;
  fputs("points AS -- statistics of every point, one row per results_version\n", out);
  views_statistics_write(count, names, out);
  fputs(", unresolved AS MATERIALIZED ", out);
  views_statistics_resolution(count, names, out);
  fputs("\nSELECT p.point_id, p.engine, p.scene_name AS scene,\n", out);
  write_axes(view);
  fputs("  t.results_version, ifnull(t.runs, 0) AS n, ifnull(t.censored, 0) AS censored, ifnull(t.failed, 0) AS "
        "failed,\n  ifnull(t.surplus, 0) AS surplus, (SELECT count(*) FROM attempt a WHERE a.point_id = p.point_id) AS "
        "failed_attempts",
        out);
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n  m%2$zu AS %1$s_mean, d%2$zu AS %1$s_sd, d%2$zu / sqrt(n) AS %1$s_se, s.t * d%2$zu / sqrt(n) AS "
            "%1$s_hw95,\n  e%2$zu AS %1$s_resolution, ifnull(v%2$zu, 'not-studied') AS %1$s_resolution_verdict",
            names[i], i);
  fputs("\nFROM point p NOT INDEXED LEFT JOIN point_total t ON t.point_id = p.point_id\n"
        "  LEFT JOIN scatter s ON s.point_id = t.point_id AND s.results_version = t.results_version\n"
        "  LEFT JOIN unresolved u ON u.point_id = t.point_id AND u.results_version = t.results_version;\n",
        out);
}

static void write_spectra(struct view *view) {
  FILE *out = view->out;
  fputs("spectra AS -- pooled fragment mass spectrum of every point\n"
        "SELECT p.point_id, p.engine, p.scene_name AS scene,\n",
        out);
  write_axes(view);
  fputs("  s.results_version, t.runs AS n, s.bin, b.lower, b.upper, s.runs, s.count, s.mass,\n"
        "  1.0 * s.count / t.runs AS count_mean,\n"
        "  sqrt(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1))) AS count_sd,\n  (",
        out);
  views_statistics_student("(t.runs - 1)", out);
  fputs(") * sqrt(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1) / t.runs)) AS "
        "count_hw95,\n"
        "  s.count / (t.fragments * (b.upper - b.lower)) AS density\n"
        "FROM point p JOIN point_total t ON t.point_id = p.point_id\n"
        "  JOIN point_spectrum s ON s.point_id = t.point_id AND s.results_version = t.results_version\n"
        "  JOIN bin b ON b.bin = s.bin;\n",
        out);
}

static void write_estimate_columns(struct view *view) {
  write_rows(view, "SELECT format('\"%w\", ', name) FROM pragma_table_xinfo('estimate') WHERE name <> 'run_id'");
}

static void write_estimates(struct view *view) {
  fputs("estimates AS -- estimates of runs (run_id) and of whole points (run_id NULL)\n"
        "SELECT e.point_id, e.run_id, e.replicate, e.seed, e.counts, p.engine, p.scene_name AS scene,\n",
        view->out);
  write_axes(view);
  fputs("  ", view->out);
  write_estimate_columns(view);
  fputs("e.results_version\nFROM (\n  SELECT r.point_id, r.run_id, r.replicate, r.seed, r.counts, ", view->out);
  write_estimate_columns(view);
  fputs("r.results_version\n  FROM estimate JOIN run r USING (run_id)\n  UNION ALL\n"
        "  SELECT point_id, NULL, NULL, NULL, NULL, ",
        view->out);
  write_estimate_columns(view);
  fputs("results_version FROM point_estimate\n) e JOIN point p ON p.point_id = e.point_id;\n", view->out);
}

status views_text_write(sqlite3 *db, size_t index, FILE *out, struct error *error) {
  static void (*const writers[VIEWS_COUNT])(struct view *) = {write_runs, write_points, write_spectra, write_estimates,
                                                              write_resolution};
  struct view view = {.db = db, .out = out, .error = error};
  writers[index](&view);
  return view.result;
}
