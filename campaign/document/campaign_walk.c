/* The points of a campaign, one after the other. */
#include "campaign/document/campaign_walk.h"

#include <stdlib.h>

status campaign_walk_begin(struct campaign_walk *walk, const struct campaign *campaign, struct error *error) {
  *walk = (struct campaign_walk){.campaign = campaign};
  walk->values = calloc(campaign->axis_count + 1, sizeof *walk->values);
  if (!walk->values)
    return status_fail(error, STATUS_MEMORY, "no memory for the points of a campaign");
  return design_create((enum design_kind)campaign->design.kind, campaign->axes, campaign->axis_count,
                       (uint64_t)campaign->design.points, (uint64_t)campaign->design.seed, &walk->design, error);
}

void campaign_walk_end(struct campaign_walk *walk) {
  design_free(walk->design);
  free(walk->values);
  walk->design = NULL;
  walk->values = NULL;
}

bool campaign_walk_next(struct campaign_walk *walk) {
  return design_next(walk->design, walk->values);
}

struct scene *campaign_walk_scene(const struct campaign_walk *walk, struct error *error) {
  return campaign_point_scene(walk->campaign, walk->values, error);
}
