/* The views `runs`, `points`, `spectra`, `estimates`, `resolution`: flat tables for any tool, one column per varied
 * input. Plain SQL only, so that a database browser or pandas can open them. clast itself never runs the views of a
 * file (db/store/guard.h): every connection makes temporary ones of the same names, which take precedence. */
#pragma once

#include <stdio.h>

#include "analysis/statistics/statistics.h"
#include "db/sql.h"

/* SQL: did clast write the document of this campaign, a round of a study or a search (converge, find, fit)? */
#define CAMPAIGN_IS_ROUND "ifnull(document LIKE '# Written by clast %', 0)"
/* SQL that is true of row p, of a table with point_id: no campaign that a person wrote has the point. in_: "main.",
 * beside temporary views of the same names (db/ask/choose.c); "" in the file, which another program may attach. */
#define POINT_IS_OF_NO_CAMPAIGN(in_)                                                                                   \
  "p.point_id NOT IN (SELECT point_id FROM " in_ "campaign_point JOIN " in_                                            \
  "campaign USING (campaign_id) WHERE NOT " CAMPAIGN_IS_ROUND ")"
/* The same, of a store with such campaigns: only studies and searches asked for it. Also of a point without a campaign
 * and without runs, which a study that was stopped had planned. */
#define POINT_IS_OF_STUDY(in_)                                                                                         \
  "EXISTS (SELECT 1 FROM " in_ "campaign WHERE NOT " CAMPAIGN_IS_ROUND                                                 \
  ") AND " POINT_IS_OF_NO_CAMPAIGN(in_) " AND (p.point_id IN (SELECT point_id FROM " in_                               \
                                        "campaign_point) OR NOT EXISTS (SELECT 1 FROM " in_                            \
                                        "run AS x WHERE x.point_id = p.point_id))"

/* SQL: how many runs of point p were tried, died (program, crash, limit) and have no result. An attempt that is `lost`
 * says nothing about its run. Not counted: runs after the last one that a stopping rule decided on. all: SQL that is
 * false when a condition has chosen runs: nobody knows whether those that died would meet it. */
#define POINT_DIED(all)                                                                                                \
  "iif(" all " AND p.point_id IN (SELECT point_id FROM attempt), (SELECT count(*) FROM (SELECT a.seed FROM (SELECT "   \
  "max(iif(x.surplus & 1, NULL, x.replicate)) AS last, max(x.surplus & 1) AS ruled FROM run x WHERE x.point_id = "     \
  "p.point_id) CROSS JOIN attempt a WHERE a.point_id = p.point_id AND a.reason <> 'lost' AND (ruled IS NOT 1 OR "      \
  "a.replicate <= last) EXCEPT SELECT x.seed FROM run x WHERE x.point_id = p.point_id)), 0)"
/* For POINT_DIED(), of this connection's choice of runs (db/ask/choose.c). */
#define POINT_RUNS_ARE_ALL "NOT EXISTS (SELECT 1 FROM temp.sqlite_schema WHERE name = 'chosen_run')"

enum { VIEWS_COUNT = 5 };
extern const char *const views_names[VIEWS_COUNT];

/* Makes all views again, in the file and for this connection, and their rows in column_doc. Within the caller's
 * transaction. */
status views_regenerate(sqlite3 *db, struct error *error);
/* Makes the views of this connection only. Changes no file: for readers. */
status views_make_temporary(sqlite3 *db, struct error *error);

/* Writes the rows of the views in column_doc (temp.column_doc, if there is one) from those of their tables. */
status views_document(sqlite3 *db, struct error *error);

/* The column of a new axis: its path with underscores. "input_" goes in front when a view has such a column already:
 * SQL takes A and a for one name. */
status views_axis_column(sqlite3 *db, const char *path, char *name, size_t size, struct error *error);

/* The main results (engine/outcome.h), by rank: the columns of table run whose statistics the view `points` shows.
 * Returns how many. */
enum { VIEWS_STATISTICS_MAIN = 16 };
size_t views_statistics_main(const char *names[VIEWS_STATISTICS_MAIN]);

/* SQL that begins a query on the statistics of columns of table run, for every point and results_version: the table
 * expression `width` with point_id, results_version and, for the N-th name from 0, the number nN of values that are not
 * withheld, their mean mN, standard deviation dN and half width hN. In C this is sample_summarise(); a test compares
 * the two. */
void views_statistics_write(size_t count, const char *const *names, FILE *out);

/* SQL of "... AS hN", the half width of the 95 % interval of mean mN with the deviation dN. n, t: SQL of the number of
 * values and of Student's quantile. range: sample_in_range(). NULL: the values are equal. */
void views_statistics_half_width(size_t i, const char *n, const char *t, const struct sample_range *range, FILE *out);
/* SQL of the columns NAME_mean, _sd, _se, _hw95, _low95, _high95, _weak, _resolution and _resolution_verdict, with a
 * comma before each, from mN, dN, hN, eN and vN. sd: "d", or another letter whose column is _sd. */
void views_statistics_columns(size_t i, const char *name, const char *sd, const char *n,
                              const struct sample_range *range, FILE *out);

struct engine_kind;
/* Has an engine a value for a column of the view runs? An engine that this program lacks (NULL), or whose
 * scenes declare their results: true. */
bool views_has_result(const struct engine_kind *kind, const char *column);

/* The values that a column of the view runs can have; of a name that results of several engines have, those of all. */
struct sample_range views_range(const char *column);

/* SQL of a table expression with point_id, results_version and, for the N-th name from 0 (a column of the view runs),
 * the half width eN and the verdict vN of the view resolution; NULL if not studied. */
void views_statistics_resolution(size_t count, const char *const *names, FILE *out);

/* SQL of "WITH ...", whose table `part` has what each knob leaves at each point, and `told` is the view resolution. */
void views_resolution_parts(FILE *out);

/* SQL for the two-sided 95 % quantile of Student's t with `degrees` (an SQL expression) of freedom: sample_student()
 * for tools without our functions, within 5e-6. */
void views_statistics_student(const char *degrees, FILE *out);
