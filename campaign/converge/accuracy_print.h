/* How a campaign reaches the accuracy that it asks for, as `clast plan` prints it. */
#ifndef CLAST_CAMPAIGN_CONVERGE_ACCURACY_PRINT_H
#define CLAST_CAMPAIGN_CONVERGE_ACCURACY_PRINT_H

#include "campaign/document/campaign.h"

/* Finds the alternatives (accuracy_find), prints them, and sets the chosen one in the campaign. json not NULL: as JSON
 * text, malloc'd, instead of printing. A campaign that asks for no accuracy stays as it is. */
status accuracy_print_settle(struct campaign *campaign, const char *path, const char *store, char **json,
                             struct error *error);

#endif
