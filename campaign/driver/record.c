/* Rows of runs and of failed attempts. */
#include "campaign/driver/record.h"

#include <string.h>

int64_t record_replicate(const struct campaign *campaign, const struct scene *scene,
                         const struct store_point_run *run) {
  const int64_t r = campaign->independent ? run->replicate : (int64_t)(run->seed - (uint64_t)campaign->first_seed);
  if (r < 0 || campaign_seed(campaign, scene, r) != run->seed)
    return -1;
  uint8_t identity[16];
  scene_identity(scene, run->seed, identity);
  return memcmp(identity, run->identity, sizeof identity) == 0 ? r : -1;
}

status record_run(struct store *store, const struct record *record, const struct engine_kind *kind,
                  const struct farm_report *report, const struct run_result *result, struct error *error) {
  struct store_run run = {
      .point_id = record->point_id,
      .session_id = record->session_id,
      .replicate = record->replicate,
      .seed = record->seed,
      .surplus = record->surplus,
      .kind = kind,
      .outcome = &result->outcome,
      .result = result->result,
      .fragments = result->fragments,
      .fragment_count = result->fragment_count,
      .estimates = result->estimate_count ? result->estimates : NULL,
      .estimate_count = result->estimate_count,
      .wall_s = report->wall_s,
      .cpu_s = report->cpu_s,
      .peak_memory = report->peak_memory,
      .attempt = record->attempt,
      .host = report->host,
      .rank = report->rank,
      .fields_path = record->fields_path,
  };
  memcpy(run.identity, record->identity, sizeof run.identity);
  return store_add_run(store, &run, error);
}

status record_attempt(struct store *store, const struct record *record, const struct farm_report *report,
                      double time_limit, double memory_limit, struct error *error) {
  static const char *const reasons[] = {[FARM_DONE] = "exit",
                                        [FARM_FAILED] = "exit",
                                        [FARM_TIME_LIMIT] = "time_limit",
                                        [FARM_MEMORY_LIMIT] = "memory_limit",
                                        [FARM_CRASHED] = "crash",
                                        [FARM_LOST] = "lost"};
  const double limits[] = {[FARM_LOST] = 0, [FARM_TIME_LIMIT] = time_limit, [FARM_MEMORY_LIMIT] = memory_limit};
  struct store_attempt attempt = {
      .point_id = record->point_id,
      .replicate = record->replicate,
      .session_id = record->session_id,
      .seed = record->seed,
      .attempt = record->attempt,
      .reason = reasons[report->ending],
      .exit_code = report->exit_code,
      .signal = report->signal,
      .wall_s = report->wall_s,
      .peak_memory = report->peak_memory,
      .limit = limits[report->ending],
      .message = report->message,
      .host = report->host,
      .rank = report->rank,
  };
  memcpy(attempt.identity, record->identity, sizeof attempt.identity);
  return store_add_attempt(store, &attempt, error);
}
