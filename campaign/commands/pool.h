/* The fragments of all runs of a point that count, from the store: what pooled spectra and exponents are made of. */
#ifndef CLAST_CAMPAIGN_COMMANDS_POOL_H
#define CLAST_CAMPAIGN_COMMANDS_POOL_H

#include "analysis/estimates.h"
#include "analysis/pooled.h"
#include "db/query.h"

struct pool {
  struct pooled_runs runs; /* points into masses and first */
  double *masses;
  size_t *first;
  size_t capacity, run_capacity;
  int64_t point, results_version;
};

/* results_version 0: the newest the point has. Runs in the order of their replicates, whoever finished first. On an error
 * *pool is empty. */
status pool_read(struct store *store, int64_t point, int64_t results_version, struct pool *pool, struct error *error);
void pool_clear(struct pool *pool);

/* Lower end of a window for the whole point, kg: the windows of single runs start at so many mean grain masses, the
 * point's at the mean of these. NaN without runs. */
status pool_window(struct store *store, const struct pool *pool, enum estimates_window window, double *lower,
                   struct error *error);

#endif
