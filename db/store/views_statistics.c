/* Plain SQL of the statistics of points, for the views and for questions. */
#include "db/store/views_statistics.h"

#include "db/sql.h"
#include "engine/outcome.h"

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

/* One pass over the index run_statistics. Deviations are from the value of the point's first run (kN), so that nothing
 * cancels; they are summed in the order of replicates, so that the bits do not depend on which run finished first. No
 * main result of a run that counts is NULL (a CHECK of table run). */
void views_statistics_write(size_t count, const char *const *names, FILE *out) {
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
  views_statistics_student("(n - 1)", out);
  fprintf(out, " AS t");
  for (size_t i = 0; i < count; i++)
    fprintf(out,
            ",\n    k%1$zu + s%1$zu / n AS m%1$zu, sqrt(max(0, (q%1$zu - s%1$zu * s%1$zu / n) / (n - 1))) AS d%1$zu",
            i);
  fprintf(out, "\n  FROM moment\n)\n");
}

/* A study names a quantity without its engine; the view runs may have the engine's table as a prefix. */
static void write_is_quantity(const char *name, FILE *out) {
  char *sql = sqlite3_mprintf("%Q IN (quantity, 'result_' || engine || '_' || quantity)", name);
  fputs(sql ? sql : "NULL", out); /* without memory the next query fails too */
  sqlite3_free(sql);
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
