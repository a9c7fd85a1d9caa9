/* One point of a store: the fragment masses of all its runs that count, and the standard estimates made from them. */
#ifndef CLAST_DB_ASK_POINT_H
#define CLAST_DB_ASK_POINT_H

#include "analysis/pictures/picture.h"
#include "analysis/statistics/estimates.h"
#include "db/store/store.h"

struct point_data {
  int64_t point_id, results_version;
  struct pooled_runs runs; /* in order of replicate; all fragments, single elements included */
  double element_mass;     /* mean over the runs, kg; NaN when the store holds no estimates of them */
  double complete_mass;    /* mean over the runs, kg: no window begins below; NaN: not known */
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
/* Pooled estimates with their intervals over runs. Same store, same numbers. */
status point_estimates(const struct point_data *point, double level, struct point_estimate rows[POINT_ESTIMATES],
                       struct error *error);

/* One of them, of a point that is read for it. No run, or too few fragments: its beta is NaN. */
status point_exponent(struct store *store, int64_t point_id, int64_t results_version, enum exponent_method method,
                      enum estimates_window window, double level, struct pooled_exponent *out, struct error *error);

/* A point's pooled spectrum with its headline fit, ready to be drawn (picture_spectrum, text_plot_spectrum). */
struct point_curve {
  char label[128], fit_label[96];
  struct pooled_bin *bins; /* owned */
  size_t count, runs;
  double complete_mass;   /* kg; NaN: not known */
  struct picture_fit fit; /* its label is filled in by point_curve_series; beta = NaN: no fit */
};
/* label: NULL for "point 3, 40 runs". */
status point_curve_make(const struct point_data *point, const char *label, struct point_curve *out,
                        struct error *error);
void point_curve_release(struct point_curve *curve);                 /* a zeroed one is fine */
struct picture_series point_curve_series(struct point_curve *curve); /* borrows the curve, which must not move */

#endif
