/* One point of a store: the fragment masses of all its runs that count, and the standard estimates made from them. */
#ifndef CLAST_ANALYSIS_POINT_H
#define CLAST_ANALYSIS_POINT_H

#include "analysis/estimates.h"
#include "analysis/pooled.h"
#include "db/store.h"

struct point_data {
  int64_t point_id, results_version;
  struct pooled_runs runs; /* in order of replicate; all fragments, single grains included */
  double grain_mass;       /* mean over the runs, kg; NaN when the store holds no estimates of them */
  size_t *first;           /* what `runs` borrows; owned */
  double *masses;
};

/* Only runs that count (completed or ended at their time, not surplus), of one results_version (0: the newest with such
 * runs). A point without any has runs.count = 0. STATUS_CONTENT: the store is damaged. */
status point_read(struct store *store, int64_t point_id, int64_t results_version, struct point_data *out,
                  struct error *error);
void point_release(struct point_data *point); /* a zeroed one is fine */

/* Lower end of a standard window for this point, kg. */
double point_window(const struct point_data *point, enum estimates_window window);

struct point_estimate {
  enum estimates_window window;
  struct pooled_exponent exponent;
};
enum { POINT_ESTIMATES = 3 * ESTIMATES_WINDOWS }; /* least_squares, binned, masses in each window, in that order */
/* Pooled estimates, intervals from `resamples` resamples of runs (1000 for final numbers: some 50 ms for 200 runs). Same
 * store, same numbers. */
status point_estimates(const struct point_data *point, size_t resamples, double level,
                       struct point_estimate rows[POINT_ESTIMATES], struct error *error);

/* The pooled spectra of some points as a picture (.png or .svg), each with its headline fit. labels[i] may be NULL. */
status point_picture(const char *path, double width, const char *title, const char *mass_unit, size_t count,
                     const struct point_data *points, const char *const *labels, struct error *error);

#endif
