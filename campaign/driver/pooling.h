/* Pooled exponents of a campaign's points, written into the store (table point_estimate, view estimates) when the runs
 * are done, so that any tool finds them there. The store drops those of a point as soon as a run is added to it. */
#ifndef CLAST_CAMPAIGN_DRIVER_POOLING_H
#define CLAST_CAMPAIGN_DRIVER_POOLING_H

#include "db/store/store.h"

/* Estimates of every point of the campaign (0: of all) that has runs and none yet. `store` is open for writing;
 * commits. */
status pooling_store(struct store *store, int64_t campaign_id, struct error *error);

#endif
