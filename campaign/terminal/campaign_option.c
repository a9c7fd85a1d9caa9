/* --set PATH=VALUE and --seeds N: a campaign with other inputs and seeds. */
#include "campaign/terminal/campaign_option.h"

status campaign_option_load(const char *path, const struct campaign_option *option, struct campaign **campaign,
                            struct error *error) {
  const struct campaign_changes changes = {option->set.count, option->set.items, option->seeds};
  return campaign_load_changed(path, &changes, campaign, error);
}
