/* A campaign whose failed runs are tried again (`clast retry`). */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_RAISE_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_RAISE_H

#include "campaign/document/campaign.h"

/* Limits as a user types them ("30 min", off); NULL: twice the campaign's. Adds this many attempts and removes the
 * limit of failures. STATUS_USAGE. */
status campaign_raise(struct campaign *campaign, const char *time, const char *memory, int64_t attempts,
                      struct error *error);

#endif
