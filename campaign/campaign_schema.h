/* JSON Schema (draft-07) of a campaign document: the plain keys from their tables, the unions (vary, set, design, keep,
 * seeds) from the fragments that stand beside their reader. */
#ifndef CLAST_CAMPAIGN_CAMPAIGN_SCHEMA_H
#define CLAST_CAMPAIGN_CAMPAIGN_SCHEMA_H

#include <stdio.h>

void campaign_schema_write(FILE *out);

#endif
