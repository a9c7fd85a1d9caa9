/* Pooled exponents of a campaign's points, written into the store (table point_estimate, view estimates) when the runs
 * are done, so that any tool finds them there. The store drops a point's estimates as soon as a run is added to the
 * point. */
#ifndef CLAST_CAMPAIGN_DRIVER_POOLING_H
#define CLAST_CAMPAIGN_DRIVER_POOLING_H

#include "db/store/store.h"

/* Estimates the exponents of every point of the campaign (0: of all campaigns) that has runs and no estimates yet.
 * `store` is open for writing; the function commits. */
status pooling_store(struct store *store, int64_t campaign_id, struct error *error);

#endif
