/* A measured spectrum of fragments: a CSV file (schemas/csv.h), and its distance from simulated runs.
 *
 *     # source: Nakamura & Fujiwara (1991)      lines of remarks; three keys are read: source,
 *     # complete from: 0.1 g                    from which mass or size on all fragments were found,
 *     # density: 2.7 g/cm^3                     and the density that turns sizes into masses
 *     mass (g), count
 *     0.1, 214
 *
 * One column is `mass` or `size` (diameter of the sphere of equal volume) with its unit. Without another column, every
 * row is a fragment. A second one says how much a row stands for:
 *
 *     count                 the number of fragments from this mass up to that of the next row
 *     cumulative            N(>= m), the number of fragments of at least this mass
 *     retained (g or %)     the mass of the fragments of this class, which a sieve retains; the pan has size 0
 *     cumulative retained   the mass of all fragments of at least this mass or size
 *     passing (%)           the mass of all smaller fragments
 *
 * measured.c has the other names that laboratories use. `name`, `id`, `note` and the like are not read; a column
 * of any other name is refused. */
#ifndef CLAST_ANALYSIS_STATISTICS_MEASURED_H
#define CLAST_ANALYSIS_STATISTICS_MEASURED_H

#include "analysis/statistics/pooled.h"

struct measured {
  bool single;      /* true: `mass` has every fragment; false: `mass` has thresholds, and `above` their numbers */
  bool weighed;     /* `above` has masses, in any unit: a sieve table */
  size_t n;         /* masses, or thresholds */
  double *mass;     /* kg, ascending; owned */
  double *above;    /* N(>= mass[i]), or the mass of these fragments; owned */
  double complete;  /* kg; 0: the file does not give it */
  char source[200]; /* "" when the file does not give it */
};

/* size: converts a column of sizes into masses if the file gives no density (size->density 0: no conversion).
 * STATUS_MISSING, STATUS_IO, STATUS_CONTENT with line and remedy, STATUS_MEMORY. After an error *out is empty. */
status measured_read(const char *path, const struct spectrum_size *size, struct measured *out, struct error *error);
void measured_release(struct measured *measured); /* a zeroed one is fine */

/* Converts to bins of a spectrum, to be drawn beside others of the same form. Without intervals. The caller frees
 * *bins. STATUS_CONTENT: a sieve table has no numbers. */
status measured_bins(const struct measured *measured, const struct pooled_form *form, struct pooled_bin **bins,
                     size_t *count, struct error *error);

/* Agreement of runs with measured data, for fragments of at least `complete` only. Shapes are compared, each normalised
 * by its own number of fragments; the numbers are given separately. Sieve tables: shares of the mass are compared
 * instead of numbers. */
struct measured_match {
  double from;      /* kg: lower limit of the fragments used; with thresholds, the first threshold from `complete` on */
  double fragments; /* number of measured fragments; NaN for a sieve table */
  struct sample_summary simulated; /* fragments per run */
  double distance;                 /* Kolmogorov's: greatest difference between both shares of fragments above a mass */
  double share; /* of runs that are at least as far from the pool of the other runs: one experiment is one specimen, so
                   a share below 0.05 is evidence against the pool. NaN for fewer than three runs with fragments */
  double log_likelihood; /* of the measured fragments in classes of mass (the store's bins, or the thresholds), if each
                            is drawn from the pool; half a fragment is added to each class. Compare it between pools
                            with the same `complete`. NaN for a sieve table */
};
status measured_compare(const struct measured *measured, const struct pooled_runs *runs, double complete,
                        struct measured_match *out, struct error *error);

#endif
