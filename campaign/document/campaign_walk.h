/* A walk over the points of a campaign, in the order of its design. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WALK_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WALK_H

#include "campaign/design/design.h"
#include "campaign/document/campaign.h"

struct campaign_walk {
  const struct campaign *campaign;
  struct design *design;
  struct field_value *values; /* values of the current point, one for each axis */
};

/* Begins a walk before the first point. STATUS_MEMORY; STATUS_CONTENT: no such design. End the walk also after an
 * error. */
status campaign_walk_begin(struct campaign_walk *walk, const struct campaign *campaign, struct error *error);
void campaign_walk_end(struct campaign_walk *walk);
/* Goes to the next point. False after the last one. */
bool campaign_walk_next(struct campaign_walk *walk);
/* The scene of the current point, owned by the caller. NULL with *error when its values cannot be run together. */
struct scene *campaign_walk_scene(const struct campaign_walk *walk, struct error *error);

#endif
