/* The key `vary` of a campaign: paths into the scene and what values they take. For campaign.c only. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_VARY_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_VARY_H

#include "campaign/document/campaign.h"
#include "schemas/document.h"

/* Fills campaign->axes from the mapping (NULL: nothing varied). False when anything was reported. */
bool campaign_vary_read(document_node *vary, struct campaign *campaign);

#endif
