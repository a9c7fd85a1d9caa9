/* Shared by the commands that take a campaign: changes for this invocation by --set and --seeds. */
#ifndef CLAST_CAMPAIGN_TERMINAL_CAMPAIGN_OPTION_H
#define CLAST_CAMPAIGN_TERMINAL_CAMPAIGN_OPTION_H

#include "campaign/document/campaign.h"
#include "campaign/terminal/option.h"

struct campaign_option {
  struct option_list set;
  int64_t seeds;
};

#define CAMPAIGN_OPTION(type_, member_)                                                                                \
  OPTION_ROW_LIST("set", 's', "PATH=VALUE", type_, member_.set,                                                        \
                  "Another value of an input, like a line under `set` of the campaign: contact.friction=0.3. May be "  \
                  "given several times."),                                                                             \
      OPTION_ROW_INTEGER("seeds", 0, "N", type_, member_.seeds, 0, 1000000000000, "0",                                 \
                         "Number of seeds for every point, instead of the campaign's; 0: the campaign's.")

/* campaign_load with the changes. STATUS_USAGE when a change is wrong. */
status campaign_option_load(const char *path, const struct campaign_option *option, struct campaign **campaign,
                            struct error *error);

#endif
