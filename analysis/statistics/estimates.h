/* The standard set of exponent estimates that every run stores: methods x windows, so that no later comparison of
 * methods or windows needs a re-run. Pooled estimates of a point have rows of the same table (pooled.h). */
#ifndef CLAST_ANALYSIS_STATISTICS_ESTIMATES_H
#define CLAST_ANALYSIS_STATISTICS_ESTIMATES_H

#include "analysis/statistics/exponent.h"
#include "engine/fragments.h"

/* An element is a grain or a particle. Windows begin midway between N - 1 and N mean element masses, N = 2, 5, 10, and
 * end below the run's largest fragment M_1. Grains of nearly equal mass make small fragments nearly discrete: fitted as
 * continuous from one grain up, a true 2.0 reads 2.76. Equal grains from N - 1/2 give 1.96, 2.00, 2.00 (from N
 * itself 2.32, 2.11, 2.05); grains whose masses scatter by 30 % 1.92, 2.01, 2.00. From 2 is the paper's own choice (all
 * but single grains); 5 lies between and shows the trend. */
enum estimates_window { ESTIMATES_FROM_2, ESTIMATES_FROM_5, ESTIMATES_FROM_10, ESTIMATES_WINDOWS };
extern const char *const estimates_window_names[];              /* "from_2"..., NULL-terminated */
double estimates_window_elements(enum estimates_window window); /* lower end in mean element masses: 1.5, 4.5, 9.5 */

struct estimate {
  int window;          /* enum estimates_window */
  bool headline;       /* the one that is called `beta` */
  struct exponent fit; /* fit.cutoff_mass NaN also where no cut-off was needed */
};
extern const struct field_table estimates_table;

/* The headline is maximum likelihood on masses of 5 elements and more up to M_1, itself left out: free of the bias of
 * least squares, of a giant remnant that belongs to no power law, and (the lowest window of which that is true) of
 * discreteness whatever the scatter of their masses. One run of 1100 grains has some 30 such fragments: expect a
 * standard error of 0.2 and, as for any ratio of small numbers, a bias of about (beta-1)/n; pool runs. */
enum {
  ESTIMATES_HEADLINE_METHOD = EXPONENT_MASSES,
  ESTIMATES_HEADLINE_WINDOW = ESTIMATES_FROM_5,
  ESTIMATES_COUNT = 3 * ESTIMATES_WINDOWS + 2, /* least_squares, binned, masses in each; ks from 2; cutoff from 5 */
};

/* Fragments by descending mass, dust included (the mean element mass is total mass over total count; fragments of one
 * element are then left out). Always fills all rows; a run without enough fragments has beta = NaN there. */
status estimates_make(size_t n, const struct fragment *fragments, struct estimate rows[ESTIMATES_COUNT],
                      struct error *error);

/* An exponent pooled over a point's runs, by name: "beta" is the headline, "beta_METHOD_WINDOW" ("beta_masses_from_2")
 * another of those that points have. *is = false for other names; STATUS_USAGE for one that only begins like them. */
status estimates_named(const char *name, bool *is, enum exponent_method *method, enum estimates_window *window,
                       struct error *error);

#endif
