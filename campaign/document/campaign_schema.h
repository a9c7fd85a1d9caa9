/* JSON Schema (draft-07) of a campaign document: campaign.schema.in.json with the plain keys filled in from their
 * tables. The template holds the keys that have several forms (vary, set, design, keep, seeds). A value stands there as
 * number, string or boolean: its unit and range are checked by the input's own row when the document is read. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_SCHEMA_H
#define CLAST_CAMPAIGN_DOCUMENT_CAMPAIGN_SCHEMA_H

#include <stdio.h>

void campaign_schema_write(FILE *out);

#endif
