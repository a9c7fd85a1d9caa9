/* The open page. For db/ask/page*.c only. */
#ifndef CLAST_DB_ASK_PAGE_PRIVATE_H
#define CLAST_DB_ASK_PAGE_PRIVATE_H

#include "db/ask/page.h"
#include "db/sql.h"

/* Upper limits of a page, so that it stays below 3 MB with 10 000 runs. */
enum {
  ASK_PAGE_RUNS = 10000,         /* single runs */
  ASK_PAGE_VALUES = 120000,      /* results of single runs */
  ASK_PAGE_MEANS = 40000,        /* rows of the table means */
  ASK_PAGE_SPECTRUM = 12000,     /* rows of the table spectra */
  ASK_PAGE_QUANTILES = 200,      /* points with quantiles */
  ASK_PAGE_JUDGED_RUNS = 100000, /* runs of a point in the test for two modes: the first ones */
  ASK_PAGE_JUDGED = 20000,       /* fragments of points whose fit is tested: some 5 s of CPU time */
  ASK_PAGE_DRAWS = 1000,         /* samples per test; they give p within 0.016 */
  ASK_PAGE_ATTEMPTS = 500,       /* failed attempts, and failed runs */
};

struct ask_page {
  sqlite3 *db; /* in memory */
};

/* Makes a table of the rows that a query of the store returns. Real numbers from column `rounded` (counted from 0) on
 * are rounded to single precision: 7 digits, and they compress well. */
enum { ASK_PAGE_EXACT = 1000 }; /* no column is rounded */
status ask_page_copy(struct ask_page *page, struct store *store, const char *table, const char *sql, size_t rounded,
                     struct error *error);

/* Fills in `runs` and `means`. */
status ask_page_runs(struct ask_page *page, struct store *store, struct error *error);

/* Makes and fills in `modes`, point by point. */
struct ask_page_modes {
  sqlite3_stmt *insert;
  size_t n;     /* values of the previous sample */
  double limit; /* dip above which a sample of that size has two modes */
};
status ask_page_modes_begin(struct ask_page *page, struct ask_page_modes *modes, struct error *error);
/* One result of the counted runs of a point; sorts the values. */
status ask_page_modes_add(struct ask_page_modes *modes, int64_t point, const char *quantity, size_t n, double *values,
                          struct error *error);

/* Fills in `quantile`. */
status ask_page_scatter(struct ask_page *page, struct store *store, struct error *error);

/* Fills in `goodness`. */
status ask_page_goodness(struct ask_page *page, struct store *store, struct error *error);

#endif
