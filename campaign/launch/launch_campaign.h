/* From a campaign to its finished store: shared by `clast run` and `clast retry`. */
#ifndef CLAST_CAMPAIGN_LAUNCH_LAUNCH_CAMPAIGN_H
#define CLAST_CAMPAIGN_LAUNCH_LAUNCH_CAMPAIGN_H

#include "campaign/launch/launch.h"

/* Runs the campaign with a farm, and prints the table of estimates from the store at the end, on rank 0. */
status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error);

#endif
