/* Makes the views from the columns that a database has, in the file and for one connection, and their rows of
 * column_doc. Plain SQL of the statistics of points, for the views and for questions. */
#include "db/store/views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/statistics.h"
#include "engine/engine.h"
#include "engine/outcome.h"
#include "schemas/memory.h"

static const char doing[] = "making the views";

/* Documents that the build embeds: db/store/views_columns.sql, db/store/views_resolution.sql. */
extern const char views_columns_sql[], views_resolution_sql[];

const char *const views_names[VIEWS_COUNT] = {"runs", "points", "spectra", "estimates", "resolution"};

/* ---- statistics ---- */

/* A column that two engines have begins with the name of its table. */
static const struct field *row_of(const struct field_table *table, const char *engine, const char *column) {
  char prefix[64];
  snprintf(prefix, sizeof prefix, "result_%s_", engine);
  const size_t length = strlen(prefix);
  return field_of_column(table, strncmp(column, prefix, length) == 0 ? column + length : column);
}

bool views_has_result(const struct engine_kind *kind, const char *column) {
  return !kind || kind->results->count == 0 || row_of(&outcome_table, "", column) ||
         row_of(kind->results, kind->name, column);
}

struct sample_range views_range(const char *column) {
  const struct field *row = row_of(&outcome_table, "", column);
  struct sample_range all = sample_range(row);
  bool found = row != NULL;
  for (size_t i = 0; i < engine_count(); i++) {
    row = row_of(engine_at(i)->results, engine_at(i)->name, column);
    if (!row)
      continue;
    const struct sample_range range = sample_range(row);
    all.least = found ? fmin(all.least, range.least) : range.least;
    all.most = found ? fmax(all.most, range.most) : range.most;
    all.share |= range.share;
    found = true;
  }
  return all;
}

size_t views_statistics_main(const char *names[VIEWS_STATISTICS_MAIN]) {
  size_t count = 0;
  for (const struct field *row; count < VIEWS_STATISTICS_MAIN && (row = outcome_main(count)); count++)
    names[count] = row->path;
  return count;
}

/* Exact for few degrees of freedom, then Cornish & Fisher's expansion (Abramowitz & Stegun 26.7.5), within 5e-6. */
void views_statistics_student(const char *degrees, FILE *out) {
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

void views_statistics_half_width(size_t i, const char *n, const char *t, const struct sample_range *range, FILE *out) {
  fprintf(out, "iif(d%1$zu > %2$g * abs(m%1$zu), %4$s * d%1$zu / sqrt(%3$s)", i, SAMPLE_ROUNDING, n, t);
  if (range->share)
    fprintf(out,
            " * (1 + %2$g * min(sqrt(%3$s), d%1$zu / max(min(m%1$zu, 1 - m%1$zu), 1e-300)) * min(1, sqrt(%4$d.0 / "
            "%3$s)))",
            i, SAMPLE_SKEW, n, SAMPLE_SKEW_RUNS);
  fprintf(out, ", NULL) AS h%zu", i);
}

void views_statistics_columns(size_t i, const char *name, const char *sd, const char *n,
                              const struct sample_range *range, FILE *out) {
  fprintf(out,
          ",\n  m%1$zu AS \"%2$s_mean\", %4$s%1$zu AS \"%2$s_sd\", d%1$zu / sqrt(%3$s) AS \"%2$s_se\", h%1$zu AS "
          "\"%2$s_hw95\",\n  ",
          i, name, n, sd);
  if (range->share) { /* in parts: fprintf() of 14 values and more asks for memory, and says nothing without it */
    fprintf(out,
            "iif(h%1$zu IS NULL, iif(%3$s > 1, m%1$zu * pow(0.05, 1.0 / %3$s), NULL), max(m%1$zu - h%1$zu, 0.0)) AS "
            "\"%2$s_low95\",\n  ",
            i, name, n);
    fprintf(out,
            "iif(h%1$zu IS NULL, iif(%3$s > 1, 1 - (1 - m%1$zu) * pow(0.05, 1.0 / %3$s), NULL), min(m%1$zu + h%1$zu, "
            "1.0)) AS \"%2$s_high95\",\n  ",
            i, name, n);
    fprintf(out, "iif(h%1$zu IS NULL, NULL, (%2$s < %3$d AND d%1$zu < %4$g * max(m%1$zu, 1 - m%1$zu)) OR ", i, n,
            SAMPLE_NARROW_RUNS, SAMPLE_NARROW);
    fprintf(out,
            "(%3$s < %4$d AND d%1$zu < %5$g * max(m%1$zu, 1 - m%1$zu) AND d%1$zu > %6$g * min(m%1$zu, 1 - m%1$zu))) "
            "AS \"%2$s_weak\"",
            i, name, n, SAMPLE_EDGE_RUNS, SAMPLE_EDGE, SAMPLE_EDGE_SKEW);
  } else {
    if (isfinite(range->least)) /* a real number, also where it is whole */
      fprintf(out, "max(m%zu - h%zu, %.17g + 0.0)", i, i, range->least);
    else
      fprintf(out, "m%zu - h%zu", i, i);
    fprintf(out, " AS \"%s_low95\", ", name);
    if (isfinite(range->most))
      fprintf(out, "min(m%zu + h%zu, %.17g + 0.0)", i, i, range->most);
    else
      fprintf(out, "m%zu + h%zu", i, i);
    fprintf(out, " AS \"%1$s_high95\", NULL AS \"%1$s_weak\"", name);
  }
  fprintf(out, ",\n  e%1$zu AS \"%2$s_resolution\", ifnull(v%1$zu, 'not-studied') AS \"%2$s_resolution_verdict\"", i,
          name);
}

/* Writes SQL that is true where the words of run r, of point p, withhold a result of an engine (NULL: of any engine);
 * nothing when no condition withholds it. Returns whether one does. */
static bool write_withheld(const char *engine, const char *column, FILE *out) {
  bool any = false;
  for (size_t i = 0; i < engine_count(); i++) {
    const struct engine_kind *kind = engine_at(i);
    const struct condition *before = NULL;
    for (const struct condition *c = kind->conditions; c && c->word; c++) {
      if ((engine && strcmp(kind->name, engine) != 0) || (before && strcmp(before->word, c->word) == 0) ||
          condition_mark(kind->conditions, c->word, column) != CONDITION_WITHHELD)
        continue;
      if (!before)
        fprintf(out, "%sp.engine = '%s' AND (", any ? " OR " : "r.warnings <> '' AND (", kind->name);
      fprintf(out, "%sinstr(', ' || r.warnings || ',', ', %s,')", before ? " OR " : "", c->word);
      before = c;
      any = true;
    }
    if (before)
      fputc(')', out);
  }
  if (any)
    fputc(')', out);
  return any;
}

/* SQL that is true for words that put a result in doubt: not those of rows with .absent (engine/condition.h), of which
 * a run has one at most. */
static void write_doubtful(FILE *out) {
  fputs("r.warnings NOT IN (''", out);
  for (size_t i = 0; i < engine_count(); i++)
    for (const struct condition *c = engine_at(i)->conditions; c && c->word; c++)
      if (c->absent)
        fprintf(out, ", '%s'", c->word);
  fputc(')', out);
}

/* Deviations are from the value of the point's first run (kN), so that nothing cancels; they are summed in the order of
 * replicates, so that the bits do not depend on which run finished first. No main result of a run that counts is NULL
 * (a CHECK of table run). */
void views_statistics_write(size_t count, const char *const *names, FILE *out) {
  char degrees[32], n[32], t[32];
  fputs("WITH first AS (\n  SELECT ", out);
  for (size_t i = 0; i < count; i++)
    fprintf(out, "k.%s AS k%zu, ", names[i], i);
  fputs(
      "t.point_id, t.results_version\n  FROM point_total t JOIN run k ON k.run_id = (SELECT f.run_id FROM run f WHERE "
      "f.point_id =\n    t.point_id AND f.results_version = t.results_version AND f.counts = 1 ORDER BY f.replicate, "
      "f.seed LIMIT 1)\n"
      "), away AS (\n  SELECT f.point_id, f.results_version",
      out);
  for (size_t i = 0; i < count; i++) {
    fputs(",\n    iif(", out);
    if (!write_withheld(NULL, names[i], out))
      fputs("0", out);
    fprintf(out, ", NULL, r.%1$s - k%2$zu) AS a%2$zu, k%2$zu", names[i], i);
  }
  fputs("\n  FROM first f CROSS JOIN run r ON r.point_id = f.point_id AND r.results_version = f.results_version AND\n"
        "    r.counts = 1 CROSS JOIN point p ON p.point_id = f.point_id\n"
        "), moment AS (\n  SELECT point_id, results_version",
        out);
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n    k%1$zu, count(a%1$zu) AS n%1$zu, total(a%1$zu) AS s%1$zu, total(a%1$zu * a%1$zu) AS q%1$zu, "
            "max(abs(a%1$zu)) AS x%1$zu",
            i);
  fputs("\n  FROM away GROUP BY point_id, results_version\n), scatter AS (\n  SELECT *", out);
  for (size_t i = 0; i < count; i++) {
    fprintf(out,
            ",\n    k%1$zu + s%1$zu / n%1$zu AS m%1$zu, iif(x%1$zu > 1e150 OR (x%1$zu < 1e-130 AND x%1$zu > 0), NULL, "
            "sqrt(max(0, (q%1$zu - s%1$zu * s%1$zu / n%1$zu) / (n%1$zu - 1)))) AS d%1$zu,\n    ",
            i);
    snprintf(degrees, sizeof degrees, "(n%zu - 1)", i);
    views_statistics_student(degrees, out);
    fprintf(out, " AS t%zu", i);
  }
  fputs("\n  FROM moment\n), width AS (\n  SELECT *", out);
  for (size_t i = 0; i < count; i++) {
    snprintf(n, sizeof n, "n%zu", i);
    snprintf(t, sizeof t, "t%zu", i);
    fputs(",\n    ", out);
    const struct sample_range range = views_range(names[i]);
    views_statistics_half_width(i, n, t, &range, out);
  }
  fputs("\n  FROM scatter\n)\n", out);
}

/* A study names a quantity without its engine; the view runs may have the engine's table as a prefix. */
static void write_is_quantity(const char *name, FILE *out) {
  SQL_TEXT sql = sql_format("%Q IN (quantity, 'result_' || engine || '_' || quantity)", name);
  fputs(sql, out);
}

void views_statistics_resolution(size_t count, const char *const *names, FILE *out) {
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

/* ---- the text of the views ---- */

/* The view that is being written. After the first error the database is not queried again, and the text is not
 * valid. */
struct view {
  sqlite3 *db;
  bool stored; /* in the file, not of the connection */
  FILE *out;
  status result;
  struct error *error;
};

/* Runs SQL that returns one text per row, and writes these texts. */
static void write_rows(struct view *view, const char *sql) {
  STATEMENT statement = NULL;
  if (view->result == STATUS_OK)
    view->result = sql_prepare(view->db, sql, &statement, doing, view->error);
  while (view->result == STATUS_OK && sql_next(statement, &view->result, doing, view->error))
    fputs(sql_text(statement, 0), view->out);
}

/* The same for SQL of sql_format(); frees it. */
static void write_rows_of(struct view *view, char *sql) {
  write_rows(view, sql);
  sqlite3_free(sql);
}

/* What all views of points begin with: is the point one of a study, and the varied inputs. */
static void write_axes(struct view *view) {
  fprintf(view->out, "  (%s) AS study,\n", view->stored ? POINT_IS_OF_STUDY("") : POINT_IS_OF_STUDY("main."));
  write_rows(view,
             "SELECT format('  (SELECT value FROM point_input i WHERE i.point_id = p.point_id AND i.path = %Q) AS "
             "\"%w\",' || char(10), path, column_name) FROM axis ORDER BY path");
}

/* The result tables of the engines that have runs, as the inside of IN (...); of all engines while there are no runs.
 * Free with sqlite3_free(). */
static char *result_tables(struct view *view) {
  STATEMENT names = NULL;
  char *filled = NULL, *all = NULL;
  view->result = sql_prepare(
      view->db, "SELECT name FROM main.sqlite_schema WHERE type = 'table' AND name GLOB 'result_*' ORDER BY 1", &names,
      doing, view->error);
  while (view->result == STATUS_OK && sql_next(names, &view->result, doing, view->error)) {
    const char *name = sql_text(names, 0);
    int64_t rows = 0;
    all = sql_format("%z%s%Q", all, all ? ", " : "", name);
    view->result = sql_integerf(view->db, &rows, view->error, "SELECT EXISTS (SELECT 1 FROM main.\"%w\")", name);
    if (rows)
      filled = sql_format("%z%s%Q", filled, filled ? ", " : "", name);
  }
  sqlite3_free(filled ? all : NULL);
  return filled ? filled : all ? all : sql_format("''");
}

/* Writes columns of results from SQL that returns table, column and name in the view; frees it. A value that its run's
 * words withhold is NULL; the tables have it. */
static void write_results(struct view *view, char *sql) {
  STATEMENT row = NULL;
  if (view->result == STATUS_OK)
    view->result = sql_prepare(view->db, sql, &row, doing, view->error);
  while (view->result == STATUS_OK && sql_next(row, &view->result, doing, view->error)) {
    OWNED char *test = NULL;
    const char *table = sql_text(row, 0);
    FILE *out = text_open(&test);
    const bool can_be = write_withheld(strcmp(table, "r") == 0 ? NULL : table + strlen("result_"), sql_text(row, 1),
                                       out);
    text_close_small(out, &test);
    SQL_TEXT column = sql_format("\"%w\".\"%w\"", table, sql_text(row, 1));
    /* In this form the column of the view keeps its type. */
    SQL_TEXT value = can_be ? sql_format("(SELECT %s WHERE (%s) IS NOT TRUE)", column, test) : sql_format("%s", column);
    SQL_TEXT named = sql_format("  %s AS \"%w\",\n", value, sql_text(row, 2));
    fputs(named, view->out);
  }
  sqlite3_free(sql);
}

/* Writes the columns of run, then of the engines' result tables. An engine's column with the name of another column
 * gets its table's name as a prefix; this happens in a store with runs of two engines. */
static void write_result_columns(struct view *view, const char *tables) {
  write_results(view, sql_format("SELECT 'r', name, name FROM pragma_table_xinfo('run') WHERE name NOT IN ('run_id', "
                                 "'point_id', 'replicate', 'seed', 'identity', 'fields_digest', 'digest')"));
  write_results(
      view,
      sql_format(
          "WITH mine AS MATERIALIZED (SELECT t.name AS place, c.name AS name, c.cid AS cid FROM main.sqlite_schema t, "
          "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name IN (%s) AND c.name <> 'run_id'), "
          "shared AS MATERIALIZED (SELECT name FROM pragma_table_xinfo('run', 'main') UNION ALL SELECT name FROM mine "
          "GROUP BY name HAVING count(*) > 1) SELECT place, name, iif(name IN shared, place || '_' || name, name) FROM "
          "mine ORDER BY place, cid",
          tables));
}

static void write_runs(struct view *view) {
  SQL_TEXT tables = result_tables(view);
  fputs("runs AS -- every run with its varied inputs and all results of its engine\n"
        "SELECT r.run_id, r.point_id, p.engine, p.scene_name AS scene, r.replicate, r.seed,\n",
        view->out);
  write_axes(view);
  write_result_columns(view, tables);
  fputs("  ", view->out);
  write_doubtful(view->out);
  fputs(" AS doubtful,\n  lower(hex(r.identity)) AS identity\nFROM run r JOIN point p ON p.point_id = r.point_id",
        view->out);
  write_rows_of(view,
                sql_format("SELECT format(char(10) || '  LEFT JOIN \"%%w\" ON \"%%w\".run_id = r.run_id', name, name) "
                           "FROM main.sqlite_schema WHERE type = 'table' AND name IN (%s) ORDER BY name",
                           tables));
  fputs(";\n", view->out);
}

/* Names of the columns that are shares, as rows of VALUES. */
static void write_shares(const struct field_table *table, const char *before, FILE *out) {
  for (size_t i = 0; i < table->count; i++) {
    char name[FIELD_TEXT_SIZE];
    if (!field_is_share(&table->rows[i]))
      continue;
    field_column_name(table->rows[i].path, name, sizeof name);
    SQL_TEXT sql = sql_format("%s(%Q)", before, name);
    fputs(sql, out);
    before = ", ";
  }
}

/* Means of the shares that every run has, as in the view points: they bound the errors of these. */
static void write_means(FILE *out) {
  const char *before = "";
  for (size_t i = 0; i < outcome_table.count; i++) {
    const char *name = outcome_table.rows[i].path; /* as its column */
    if (!field_is_share(&outcome_table.rows[i]))
      continue;
    fprintf(out, "%sSELECT point_id, r.results_version, '%s' AS quantity, avg(iif(", before, name);
    if (!write_withheld(NULL, name, out))
      fputs("0", out);
    fprintf(
        out,
        ", NULL, r.%1$s)) AS mean\n    FROM run r JOIN point p USING (point_id) WHERE r.counts = 1 AND point_id IN\n"
        "      (SELECT point_id FROM convergence WHERE quantity = '%1$s') GROUP BY point_id, r.results_version",
        name);
    before = "\n  UNION ALL ";
  }
}

/* The one place that knows the error of a setting; every screen asks it. For every point and quantity with a study the
 * parts of all knobs of its studies: the error that each knob leaves at the setting that the point has. Named settings:
 * the error of their reference, which takes the knobs at its own values, and how far they are from it. */
void views_resolution_parts(FILE *out) {
  fputs("WITH share (quantity) AS (VALUES ", out);
  write_shares(&outcome_table, "", out);
  for (size_t i = 0; i < engine_count(); i++)
    write_shares(engine_at(i)->results, ", ", out);
  fputs("),\nof_runs AS MATERIALIZED (", out);
  write_means(out);
  fprintf(out, "),\n%s", views_resolution_sql);
}

static void write_resolution(struct view *view) {
  fputs("resolution AS -- what finer settings may change in a result, for every point that was studied\n", view->out);
  views_resolution_parts(view->out);
  fputs("SELECT * FROM told;\n", view->out);
}

static void write_points(struct view *view) {
  const char *names[VIEWS_STATISTICS_MAIN] = {NULL};
  const size_t count = views_statistics_main(names);
  FILE *out = view->out;
  fputs("points AS -- statistics of every point, one row per results_version\n", out);
  views_statistics_write(count, names, out);
  fputs(", unresolved AS MATERIALIZED ", out);
  views_statistics_resolution(count, names, out);
  fputs("\nSELECT p.point_id, p.engine, p.scene_name AS scene,\n", out);
  write_axes(view);
  fprintf(out,
          "  t.results_version, ifnull(t.runs, 0) AS n, ifnull(t.censored, 0) AS censored,\n  ifnull(t.failed, 0) + "
          "iif(t.results_version < (SELECT max(v.results_version) FROM point_total v WHERE v.point_id = p.point_id), "
          "0, %s) AS failed,\n",
          view->stored ? POINT_DIED("1") : POINT_DIED(POINT_RUNS_ARE_ALL));
  fputs("  ifnull(t.surplus, 0) AS surplus, (SELECT count(*) FROM run r WHERE r.point_id = t.point_id AND "
        "r.results_version = t.results_version AND r.counts = 0 AND r.surplus > 1) AS excluded, (SELECT count(*) FROM "
        "attempt a WHERE a.point_id = p.point_id) AS failed_attempts,\n  (",
        out);
  static const char of_point[] = " FROM run r WHERE r.point_id = t.point_id AND r.results_version = t.results_version "
                                 "AND r.counts AND ";
  fprintf(out, "SELECT count(*)%s", of_point);
  write_doubtful(out);
  fprintf(out, ") AS doubtful,\n  ifnull((SELECT group_concat(words, '; ') FROM (SELECT DISTINCT r.warnings AS words%s",
          of_point);
  write_doubtful(out);
  fputs(" ORDER BY words)), '') AS doubts", out);
  for (size_t i = 0; i < count; i++) {
    char n[32];
    snprintf(n, sizeof n, "n%zu", i);
    const struct sample_range range = views_range(names[i]);
    views_statistics_columns(i, names[i], "d", n, &range, out);
  }
  fputs("\nFROM point p NOT INDEXED LEFT JOIN point_total t ON t.point_id = p.point_id\n"
        "  LEFT JOIN width s ON s.point_id = t.point_id AND s.results_version = t.results_version\n"
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
  fputs(") * sqrt(nullif(max(0, (s.count_squared - 1.0 * s.count * s.count / t.runs) / (t.runs - 1) / t.runs), 0)) AS "
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

/* Why tables show no exponent of this point, as pooled_exponent_untold() says. */
static const char *untold(int64_t n, double beta, double half_width, enum exponent_method method) {
  return pooled_exponent_untold(
      &(struct pooled_exponent){.fit = {.method = method, .n = n, .beta = beta, .standard_error = NAN},
                                .interval = {.half_width = half_width}});
}

static void write_untold(FILE *out) {
  const enum exponent_method bins = EXPONENT_LEAST_SQUARES, masses = EXPONENT_MASSES;
  const int n = EXPONENT_LEAST_FRAGMENTS;
  fprintf(out,
          "  CASE WHEN e.run_id IS NOT NULL THEN NULL WHEN e.n < %d THEN '%s'\n"
          "    WHEN e.beta IS NULL THEN iif(e.method = '%s', '%s', '%s')\n"
          "    WHEN e.hw95 IS NULL THEN iif(e.standard_error < 1, NULL, '%s')\n"
          "    WHEN e.hw95 >= 2 THEN '%s' END AS untold,\n",
          n, untold(0, NAN, NAN, masses), exponent_method_names[bins], untold(n, NAN, NAN, bins),
          untold(n, NAN, NAN, masses), untold(n, 2, NAN, masses), untold(n, 2, 2, masses));
}

static void write_estimates(struct view *view) {
  fputs("estimates AS -- estimates of runs (run_id) and of whole points (run_id NULL)\n"
        "SELECT e.point_id, e.run_id, e.replicate, e.seed, e.counts, p.engine, p.scene_name AS scene,\n",
        view->out);
  write_axes(view);
  fputs("  ", view->out);
  write_estimate_columns(view);
  fputs("\n", view->out);
  write_untold(view->out);
  fputs("  e.results_version\nFROM (\n  SELECT r.point_id, r.run_id, r.replicate, r.seed, r.counts, ", view->out);
  write_estimate_columns(view);
  fputs("r.results_version\n  FROM estimate JOIN run r USING (run_id)\n  UNION ALL\n"
        "  SELECT point_id, NULL, NULL, NULL, NULL, ",
        view->out);
  write_estimate_columns(view);
  fputs("results_version FROM point_estimate\n) e JOIN point p ON p.point_id = e.point_id;\n", view->out);
}

/* ---- making them ---- */

/* A mass of a run in the plane is per metre of thickness. Tables for all engines have the unit of this store's points;
 * only `sph` has ejecta. */
static status document_masses(sqlite3 *db, struct error *error) {
  char plane[300] = "''";
  for (size_t i = 0; i < engine_count(); i++)
    if (engine_at(i)->dimensions == 2)
      text_append(plane, sizeof plane, ", '%s'", engine_at(i)->name);
  return sql_executef(db, "documenting masses", error,
                      "UPDATE column_doc SET unit = (SELECT CASE min(engine IN (%s)) + max(engine IN (%s)) WHEN 2 THEN "
                      "'kg/m' WHEN 1 THEN 'kg or kg/m' ELSE 'kg' END FROM point) "
                      "WHERE table_name NOT GLOB 'result_*' AND table_name <> 'ejecta' AND unit IN ('kg', 'kg/m', 'kg "
                      "or kg/m')",
                      plane, plane);
}

status views_document(sqlite3 *db, struct error *error) {
  TRY(document_masses(db, error));
  return sql_execute(db, views_columns_sql, "documenting the views", error);
}

/* Drops and creates the views of the connection, or those of the file. */
static status make(sqlite3 *db, bool stored, struct error *error) {
  static void (*const writers[VIEWS_COUNT])(struct view *) = {write_runs, write_points, write_spectra, write_estimates,
                                                              write_resolution};
  const char *place = stored ? "main" : "temp";
  for (size_t i = 0; i < VIEWS_COUNT; i++) {
    OWNED char *text = NULL; /* after its CREATE VIEW and schema: "runs AS SELECT ...;" */
    struct view view = {.db = db, .stored = stored, .out = text_open(&text), .error = error};
    writers[i](&view);
    text_close_small(view.out, &text);
    TRY(view.result);
    TRY(sql_executef(db, doing, error, "DROP VIEW IF EXISTS %s.%s; CREATE VIEW %s.%s", place, views_names[i], place,
                     text));
  }
  return STATUS_OK;
}

status views_make_temporary(sqlite3 *db, struct error *error) {
  return make(db, false, error);
}

status views_regenerate(sqlite3 *db, struct error *error) {
  TRY(make(db, false, error));
  TRY(make(db, true, error));
  return views_document(db, error);
}

status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error) {
  char plain[256];
  STATEMENT statement = NULL;
  field_column_name(path, plain, sizeof plain);
  TRY(sql_prepare(db,
                  "SELECT 1 FROM (VALUES ('runs'), ('points'), ('spectra'), ('estimates')) v, "
                  "pragma_table_info(v.column1) c WHERE c.name = ?1 COLLATE NOCASE UNION ALL SELECT 1 FROM axis WHERE "
                  "column_name = ?1 COLLATE NOCASE UNION ALL SELECT 1 FROM main.sqlite_schema t, "
                  "pragma_table_xinfo(t.name, 'main') c WHERE t.type = 'table' AND t.name GLOB 'result_*' "
                  "AND c.name = ?1 COLLATE NOCASE",
                  &statement, doing, error));
  sql_bind_text(statement, 1, plain);
  bool taken = sqlite3_step(statement) == SQLITE_ROW;
  snprintf(name, size, "%s%s", taken ? "input_" : "", plain);
  return STATUS_OK;
}
