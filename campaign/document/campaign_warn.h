/* Doubts about a campaign before it runs: what its engine says of the inputs of its points. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WARN_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WARN_H

#include "campaign/document/campaign.h"

/* Writes a line per kind of doubt (engine/warnings.h): `before`, how many points have it, and the engine's words for
 * the first of them. Looks at the first 1000 points. */
void campaign_warn(const struct campaign *campaign, const char *before, FILE *out);
/* The same of one scene, without a number of points. */
void campaign_warn_scene(const struct scene *scene, const char *before, FILE *out);

#endif
