/* Cost of driving a campaign without the computing: no-op runs pass through design, driver, encodings and store,
 * without a farm. The rate is therefore an upper bound for a farm. Also the time until a design of a million points
 * gives its first run. Prints `name value unit`. */
#include <time.h>

#include "analysis/analysis.h"
#include "schemas/clock.h"
#include "tests/support/campaign_play.h"

static double drive(const struct campaign *campaign, const char *path) {
  struct play play = {.slots = 8};
  struct driver_summary summary;
  double begin = clock_s();
  if (play_once(&play, campaign, path, &summary) != STATUS_OK)
    exit(STATUS_INTERNAL);
  free(play.says);
  return clock_s() - begin;
}

int main(void) {
  const char *path = "bench-campaign.db";
  analysis_init();
  struct campaign *campaign = play_campaign(10, 10, 100);
  double best = 1e9, resume = 1e9;
  campaign->failures = 0;
  for (int i = 0; i < 3; i++) {
    play_remove(path);
    best = fmin(best, drive(campaign, path));
    resume = fmin(resume, drive(campaign, path));
  }
  printf("campaign_drive_runs_per_s %.0f 1/s\n", 1e4 / best);
  printf("campaign_resume_runs_per_s %.0f 1/s\n", 1e4 / resume);
  campaign_free(campaign);

  campaign = play_campaign(1, 1, 20);
  for (int a = 0; a < 2; a++) {
    campaign->axes[a].kind = DESIGN_AXIS_UNIFORM;
    campaign->axes[a].a = 0.01;
    campaign->axes[a].b = 0.06;
  }
  campaign->design = (struct campaign_design_keys){.kind = CAMPAIGN_SOBOL, .points = 1000000, .seed = 1};
  play_remove(path);
  struct play play = {.slots = 2, .stop_after = 1};
  struct driver_summary summary;
  double begin = clock_s();
  play_once(&play, campaign, path, &summary);
  printf("campaign_first_run_ms_1e6 %.1f ms\n", 1e3 * (clock_s() - begin));
  free(play.says);
  campaign_free(campaign);
  play_remove(path);
  return 0;
}
