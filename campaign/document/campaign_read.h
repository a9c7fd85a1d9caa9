/* The reader of a campaign's document. For campaign/document/campaign.c. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_READ_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_READ_H

#include "campaign/document/campaign.h"
#include "schemas/document.h"

/* Fills the whole struct, text excepted. Errors are reported to the document: see document_finish(). The paths of scene
 * and design.file are relative to `folder` (NULL: the current one). `stored`: the document is
 * that of a store, which may set an input twice. */
void campaign_read(document_node *root, const char *folder, bool stored, struct campaign *campaign);

#endif
