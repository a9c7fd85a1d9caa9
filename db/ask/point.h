/* One point of a store: the fragment masses of all its runs that count, and the standard estimates made from them. */
#ifndef CLAST_DB_ASK_POINT_H
#define CLAST_DB_ASK_POINT_H

#include "analysis/statistics/estimates.h"
#include "analysis/statistics/pooled.h"
#include "db/store/store.h"

struct point_data {
  int64_t point_id, results_version;
  int dimensions;          /* of the engine: 2 or 3 */
  struct pooled_runs runs; /* in order of replicate; all fragments, single elements included */
  double element_mass;     /* mean over the runs, kg; NaN when the store holds no estimates of them */
  double complete_mass;    /* mean over the runs, kg: no window begins below this mass; NaN: not known */
  size_t *first;           /* memory that `runs` points to; owned */
  double *masses;
  int64_t *run_id; /* of every run; owned */
  uint64_t *seed;  /* of every run; owned */
};

/* Only runs that count (completed or ended at their time, not surplus), of one results_version (0: the newest with such
 * runs). runs.count is 0 when the point has no such run. STATUS_CONTENT: the store is damaged. */
status point_read(struct store *store, int64_t point_id, int64_t results_version, struct point_data *out,
                  struct error *error);
/* The same, for runs that meet an SQL condition on the view runs. NULL: all. STATUS_USAGE: the condition is no valid
 * SQL. */
status point_read_where(struct store *store, int64_t point_id, int64_t results_version, const char *where,
                        struct point_data *out, struct error *error);
void point_release(struct point_data *point); /* a zeroed one is fine */

/* Lower end of a standard window for this point, kg. */
double point_window(const struct point_data *point, enum estimates_window window);

struct point_estimate {
  enum estimates_window window;
  struct pooled_exponent exponent;
};
enum { POINT_ESTIMATES = 2 * ESTIMATES_WINDOWS }; /* least_squares and masses in each window, in that order */
/* Pooled estimates with their intervals over runs. The same store gives the same numbers. */
status point_estimates(const struct point_data *point, double level, struct point_estimate rows[POINT_ESTIMATES],
                       struct error *error);

/* pooled_exponent_of_runs() in a standard window. `values` has space for point->runs.count numbers. */
status point_exponent_of_runs(const struct point_data *point, enum exponent_method method, enum estimates_window window,
                              double *values, struct error *error);

/* Reads the point and returns one estimate. beta is NaN without runs or with too few fragments. */
status point_exponent(struct store *store, int64_t point_id, int64_t results_version, enum exponent_method method,
                      enum estimates_window window, double level, struct pooled_exponent *out, struct error *error);

#endif
