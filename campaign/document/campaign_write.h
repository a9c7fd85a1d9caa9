/* Writes a list of points as a campaign's document, which `clast run` could compute: for the store of a study or a
 * fit. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WRITE_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_WRITE_H

#include "campaign/document/campaign.h"

/* The overridden inputs of campaign->scene become `set`, the levels of its axes `vary` with the design `list`. comment:
 * one line. scene_reference: value of `scene`. malloc'd; NULL when memory is out. */
char *campaign_write_list(const struct campaign *campaign, const char *scene_reference, const char *comment);

#endif
