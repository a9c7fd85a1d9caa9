/* The data of a page of `clast report`: a small SQLite file, made in memory, with tables that have the names and
 * columns of the store's views. Queries of the page and of its readers work on both.
 *
 *   runs, points, spectra   of the store's views; `runs` and `spectra` thinned, results rounded to 7 digits
 *   estimates               those of points
 *   means                   n, mean, sd and hw95 of the results that are not in `points`, a row for each point
 *   quantile                of the first main result: value and 95 % interval, of up to 200 points
 *   modes                   of all results, at the points whose runs have two modes
 *   goodness                p of the power law at each point, of the first points until it would take too long
 *   resolution              of the store's view: what finer settings may change, where `clast converge` was used
 *   campaign, session, attempt, axis, column_doc   of the store's tables
 *   question                the canned queries that work here
 *   label, fact, picture, difference   filled in by the caller */
#ifndef CLAST_DB_ASK_PAGE_H
#define CLAST_DB_ASK_PAGE_H

#include "analysis/statistics/sample.h"
#include "db/ask/answer.h"

enum { ASK_PAGE_RUNS = 10000 }; /* most single runs of a page */

struct ask_page; /* opaque */

/* Statistics are of all runs. Single runs are limited in number (the first replicates of every point are kept), and so
 * are the results of single runs. Facts record what was left out. */
status ask_page_make(struct store *store, struct ask_page **out, struct error *error);
void ask_page_free(struct ask_page *page); /* NULL is fine */

/* A sentence or a number about the page. */
status ask_page_fact(struct ask_page *page, const char *name, const char *value, struct error *error);
/* The readable name of a column, the unit in which it is shown, and the SI value `factor` of one such unit. */
status ask_page_label(struct ask_page *page, const char *column, const char *label, const char *unit, double factor,
                      struct error *error);
/* All columns of the page that have no label yet: inputs that were varied, and results. */
status ask_page_columns(struct ask_page *page, status (*each)(void *context, const char *column, struct error *error),
                        void *context, struct error *error);

/* The runs nearest to the quantiles 0, 0.5 and 1 of every point by the main quantity (0: the smallest value), if their
 * fields are kept; at most `most` runs, the medians of all points first. A row: run, point, quantile, and the file
 * (ask_run_fields). */
struct answer ask_page_kept(struct store *store, size_t most, struct error *error);
/* Adds the picture of the current row of ask_page_kept. */
status ask_page_picture(struct ask_page *page, const struct answer *kept, const void *png, size_t size,
                        struct error *error);

/* The difference of a result: a point of this store minus a point of the page's first store. */
status ask_page_difference(struct ask_page *page, const char *quantity, int64_t first_point, int64_t point,
                           const struct difference *difference, struct error *error);

/* The file's contents; the caller frees *bytes. */
status ask_page_file(struct ask_page *page, unsigned char **bytes, size_t *size, struct error *error);

#endif
