/* Warnings about the inputs of a campaign before it runs, from its engine. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WARN_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WARN_H

#include "campaign/document/campaign.h"

/* Writes a line per kind of warning (engine/outcome.h): `before`, the number of points that have it, and the engine's
 * text for the first of them. Looks at the first 1000 points. */
void campaign_warn(const struct campaign *campaign, const char *before, FILE *out);
/* The same for one scene, without a number of points. */
void campaign_warn_scene(const struct scene *scene, const char *before, FILE *out);

#endif
