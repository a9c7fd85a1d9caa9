/* What a slot reported of a run, as rows of the store: for the driver of campaigns and for `clast serve`. */
#ifndef CLAST_CAMPAIGN_DRIVER_RECORD_H
#define CLAST_CAMPAIGN_DRIVER_RECORD_H

#include "campaign/document/campaign.h"
#include "campaign/driver/run.h"
#include "campaign/farm/farm.h"
#include "db/store/store.h"

struct record { /* which run */
  int64_t point_id, session_id, replicate;
  uint64_t seed;
  uint8_t identity[16];
  int attempt; /* 1.. */
  bool surplus;
  const char *fields_path; /* of the HDF5 file that was kept; NULL: none */
};

/* Which replicate of the point with this scene a run of the store is: the one whose identity it has. -1: none, as it is
 * of an older results_version, or of other seeds. */
int64_t record_replicate(const struct campaign *campaign, const struct scene *scene, const struct store_point_run *run);

/* A run with its results. */
status record_run(struct store *store, const struct record *record, const struct engine_kind *kind,
                  const struct farm_report *report, const struct run_result *result, struct error *error);

/* An attempt without a result. Limits: s and bytes of an attempt, 0 for none. */
status record_attempt(struct store *store, const struct record *record, const struct farm_report *report,
                      double time_limit, double memory_limit, struct error *error);

#endif
