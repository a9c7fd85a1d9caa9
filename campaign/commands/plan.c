/* `clast plan CAMPAIGN`: predicts the runs and the cost of a campaign. */
#include "campaign/commands/commands.h"

struct options {
  struct campaign_option campaign;
  const char *store;
  int64_t slots;
  bool no_trial, all, json;
};

status plan_campaign(const char *path, const struct campaign_option *changes, const char *store, int64_t slots,
                     bool no_trial, enum accuracy_print print, struct error *error) {
  const bool json = print == ACCURACY_JSON;
  CAMPAIGN campaign = NULL;
  OWNED char *alternatives = NULL;
  const int at_a_time = launch_slots(slots);
  char words[1000];
  option_words(path, &changes->set, store, words, sizeof words);
  TRY(option_load_campaign(path, changes, at_a_time, &campaign, error));
  struct plan plan;
  struct plan_options options = {.store_path = store, .no_trial = no_trial, .slots = at_a_time, .all = json};
  TRY(accuracy_settle(campaign, words, store ? store : campaign->store, print, &alternatives, error));
  TRY(plan_make(campaign, &options, &plan, error));
  plan.alternatives = alternatives;
  alternatives = NULL;
  const status code = plan_show(campaign, &plan, options.slots, json, error);
  plan_clear(&plan);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return plan_campaign(line->arguments[0], &options->campaign, options->store, options->slots, options->no_trial,
                       options->json  ? ACCURACY_JSON
                       : options->all ? ACCURACY_ALL
                                      : ACCURACY_TEXT,
                       error);
}

static const struct option_row rows[] = {
    CAMPAIGN_OPTION(struct options, campaign),
    OPTION_ROW_INTEGER("slots", 'j', "N", struct options, slots, 0, 1000000, "0"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, store, NULL),
    OPTION_ROW_FLAG("no-trial", 0, struct options, no_trial),
    OPTION_ROW_FLAG("all", 'a', struct options, all),
    OPTION_ROW_FLAG("json", 0, struct options, json),
};

COMMAND(plan, "running", "CAMPAIGN.yaml", .computes = true, COMMAND_OPTIONS(struct options, rows), .run = run);
