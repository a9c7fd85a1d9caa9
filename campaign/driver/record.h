/* Stores a slot's report about a run as rows: for the driver of campaigns and for `clast serve`. */
#ifndef CLAST_CAMPAIGN_DRIVER_RECORD_H
#define CLAST_CAMPAIGN_DRIVER_RECORD_H

#include "campaign/document/campaign.h"
#include "campaign/driver/run.h"
#include "campaign/farm/farm.h"
#include "db/store/store.h"

struct record { /* identifies the run in the store */
  int64_t point_id, session_id, replicate;
  uint64_t seed;
  uint8_t identity[16];
  int attempt; /* 1.. */
  bool surplus;
  const char *fields_path; /* of the HDF5 file that was kept; NULL: none */
};

/* Finds the replicate of the point with this scene that has the identity of a stored run. -1: none; the run has an
 * older results_version or another seed. */
int64_t record_replicate(const struct campaign *campaign, const struct scene *scene, const struct store_point_run *run);

/* Stores a run with its results. */
status record_run(struct store *store, const struct record *record, const struct engine_kind *kind,
                  const struct farm_report *report, const struct run_result *result, struct error *error);

/* Stores an attempt without a result. Limits of the attempt: s and bytes, 0 for none. */
status record_attempt(struct store *store, const struct record *record, const struct farm_report *report,
                      double time_limit, double memory_limit, struct error *error);

#endif
