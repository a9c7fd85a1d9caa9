/* Answers as tables: what a store or a run has, for people and for programs. */
#pragma once

#include "campaign/charts/charts.h"
#include "campaign/scheduler/run.h"
#include "campaign/terminal/table.h"
#include "db/ask/ask.h"

/* ---- results of one run: for people one quantity per line with unit and meaning, for programs one row ---- */

/* Path, value (off and NaN are missing), unit and first sentence of a row of the object: four cells. */
void print_results_row(struct table *table, const struct field *row, const void *object);

/* reference: the scene as the user named it. */
status print_results(const struct scene *scene, const char *reference, int64_t seed, const struct run_result *result,
                     enum table_format format, struct error *error);

/* ---- estimates: the table that `clast run` prints at its end, and `clast estimates` prints again ---- */

/* One row per point and window: the point's varied inputs, its runs, M_1/M and the exponents by each method, all with
 * the half widths of their 95 % intervals. Only runs that count, of the point's newest results_version. legend: people
 * see on stderr what the columns and signs mean that occur, and the known errors of the resolution. */
status print_estimates(struct store *store, enum table_format format, bool legend, struct error *error);

/* ---- pools: the columns and cells that tell them apart, which are the inputs of --by and the number of points, or the
 * point ---- */

void print_pool_columns(struct table *table, const struct ask_pools *pools);
void print_pool_cells(struct table *table, const struct ask_pools *pools, const struct ask_pool *pool);

/* ---- spectra as rows, and their distances from a measured spectrum ---- */

/* Prints one row per bin of each pool (or of each run). */
status print_spectrum(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                      struct error *error);
/* Prints one row per pool: its distance from the measured spectrum. */
status print_spectrum_match(struct store *store, const struct spectrum_choice *choice, enum table_format format,
                            struct error *error);

/* ---- ejecta of impacts over their speed ---- */

/* Prints one row per bin of speed of each pool: mass and momentum of what leaves at that speed or faster. page: also
 * draws the mass of the first eight pools; NULL: no picture. STATUS_USAGE: no run has ejecta. */
status print_ejecta(struct store *store, const struct ask_pool_choice *choice, const struct picture_page *page,
                    enum table_format format, struct error *error);

/* ---- how the runs of pools scatter, as rows and a picture, and which input matters ---- */

struct scatter_choice {
  struct ask_pool_choice pool;
  const char *quantity;
  double half_width; /* wanted for the interval of the mean, in the quantity's unit; NaN: none */
  bool relative;     /* half_width is a share of the mean */
};

/* Prints a row per statistic of each pool. */
status print_scatter_rows(struct store *store, const struct scatter_choice *choice, enum table_format format,
                          struct error *error);
/* Draws histograms and distribution functions of the first eight pools. */
status print_scatter_picture(struct store *store, const struct scatter_choice *choice, const struct picture_page *page,
                             struct error *error);

/* Prints a sentence that answers, and a row for each input: first-order indices from the points of the store, of any
 * design. STATUS_USAGE: no input varies, or no run has the result. */
status print_sensitivity_points(struct store *store, const struct scatter_choice *choice, enum table_format format,
                                struct error *error);

/* campaign: path of the campaign whose runs are in the store. Prints a row for each input and one for the seed. Blocks
 * of the design that lack a point are left out and reported. STATUS_USAGE: the campaign's points are not such a design,
 * or the store lacks them. */
status print_sensitivity(struct store *store, const char *campaign, const char *quantity, enum table_format format,
                         struct error *error);

/* ---- finite-size scaling (analysis/inference/scaling.h) ---- */

struct scaling_choice {
  const char *size, *control; /* varied inputs; NULL: the one that sets the number of elements, and the other one */
  const char *quantity;       /* order parameter */
  int64_t dimensions;         /* of the model of a program; 0: the engine knows them */
};

/* Prints a sentence that answers, and a row for each exponent; page NULL: no picture. STATUS_USAGE: no input sets the
 * number of elements, several inputs vary beside it, or the model is not known to be plane. */
status print_scaling(struct store *store, const struct scaling_choice *choice, enum table_format format,
                     const struct picture_page *page, struct error *error);
