#ifndef CLAST_CAMPAIGN_COMMANDS_PLAN_H
#define CLAST_CAMPAIGN_COMMANDS_PLAN_H

#include "campaign/plan.h"

/* Loads, plans and prints a campaign; for `clast plan` and `clast run --dry-run`. store NULL: the campaign's;
 * slots 0: one per core. */
status plan_command_print(const char *path, const char *store, int64_t slots, bool no_trial, bool json,
                          struct error *error);

#endif
