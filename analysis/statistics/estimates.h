/* The standard set of exponents that every run stores: several methods and windows, so that later comparisons need no
 * new run. Exponents of a point have rows of the same table (pooled.h). */
#ifndef CLAST_ANALYSIS_STATISTICS_ESTIMATES_H
#define CLAST_ANALYSIS_STATISTICS_ESTIMATES_H

#include "analysis/statistics/exponent.h"
#include "engine/fragments.h"

/* An element is a grain or a particle. Windows begin midway between N - 1 and N mean element masses, N = 2, 5, 10, and
 * end below the run's largest fragment M_1. None begins below the mass from which the spectrum is complete (outcome:
 * complete_mass), so in sph, where it is 10 particles, all begin there. FROM_2 is the choice of Kun & Herrmann (1999):
 * all fragments except single grains. FROM_5 is between the others and shows the trend.
 *
 * The masses of small fragments of nearly equal grains are nearly discrete. A continuous fit from one grain reads 2.76
 * for a true 2.0. With equal grains, windows from N - 1/2 read 1.96, 2.00, 2.00 (from N: 2.32, 2.11, 2.05); with grains
 * whose masses scatter by 30 %, 1.92, 2.01, 2.00. */
enum estimates_window { ESTIMATES_FROM_2, ESTIMATES_FROM_5, ESTIMATES_FROM_10, ESTIMATES_WINDOWS };
extern const char *const estimates_window_names[];              /* "from_2"..., NULL-terminated */
double estimates_window_elements(enum estimates_window window); /* lower end in mean element masses: 1.5, 4.5, 9.5 */
/* Lower end, kg: the window's number of mean element masses, but at least complete_mass (NaN: not known). */
double estimates_window_lower(enum estimates_window window, double element_mass, double complete_mass);

struct estimate {
  int window;          /* enum estimates_window */
  bool headline;       /* the estimate that is called `beta` */
  struct exponent fit; /* fit.cutoff_mass is also NaN where no cut-off was needed */
  double half_width;   /* of the 95 % interval of beta over the runs of a point; NaN for one run */
};
extern const struct field_table estimates_table;

/* The headline is maximum likelihood on masses of at least 5 elements, without the largest fragment M_1. It does not
 * have the bias of least squares. A giant remnant, which belongs to no power law, is left out. 5 elements is the lowest
 * window without effects of discrete masses. A run of 1100 grains has some 30 such fragments: its standard error is
 * about 0.2 and its bias, as for any ratio of small numbers, about (beta - 1)/n. Pool runs. */
enum {
  ESTIMATES_HEADLINE_METHOD = EXPONENT_MASSES,
  ESTIMATES_HEADLINE_WINDOW = ESTIMATES_FROM_5,
  ESTIMATES_COUNT = 2 * ESTIMATES_WINDOWS + 1, /* least_squares and masses in each window; cutoff from 5 */
};

/* Fragments in descending order of mass. They include those of one element, which are part of the mean element mass
 * (total mass over total count) but not of the windows. complete_mass: kg, from the outcome: no window begins below it.
 * Fills all rows; too few fragments give beta = NaN. */
status estimates_make(size_t n, const struct fragment *fragments, double complete_mass,
                      struct estimate rows[ESTIMATES_COUNT], struct error *error);

/* Parses the name of an exponent of a point: "beta" is the headline, "beta_METHOD_WINDOW" ("beta_masses_from_2")
 * another one. *is = false for other names; STATUS_USAGE for an unknown name that begins with beta. */
status estimates_named(const char *name, bool *is, enum exponent_method *method, enum estimates_window *window,
                       struct error *error);
/* The name under which studies store it: the headline's long name becomes "beta"; other names do not change. */
const char *estimates_short_name(const char *name);

#endif
