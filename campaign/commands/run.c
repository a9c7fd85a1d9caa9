/* `clast run CAMPAIGN`: runs or resumes a campaign, alone or under mpirun and srun. */
#include "campaign/commands/commands.h"
#include "campaign/converge/accuracy.h"

struct options {
  struct launch_options launch;
  struct campaign_option campaign;
  const char *store;
  bool dry_run;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *path = line->arguments[0];
  if (options->dry_run)
    return plan_campaign(path, &options->campaign, options->store, options->launch.slots, false,
                         line->format == TABLE_JSON  ? ACCURACY_JSON
                         : line->format == TABLE_ALL ? ACCURACY_ALL
                                                     : ACCURACY_TEXT,
                         error);
  CAMPAIGN campaign = NULL;
  TRY(option_load_campaign(path, &options->campaign, launch_slots(options->launch.slots), &campaign, error));
  const char *store = options->store ? options->store : campaign->store;
  char words[1000];
  option_words(path, &options->campaign.set, options->store, words, sizeof words);
  if (!launch_other_rank()) { /* only the manager takes runs from the campaign */
    TRY(accuracy_settle(campaign, words, store, options->launch.quiet ? ACCURACY_SILENT : ACCURACY_NOTE, NULL, error));
    campaign_warn(campaign, "clast: warning: ", stderr);
  }
  return launch_campaign(campaign, store, &options->launch, line->format, line, error);
}

static const struct option_row rows[] = {
    CAMPAIGN_OPTION(struct options, campaign),
    LAUNCH_OPTIONS(struct options, launch),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, store, NULL),
    OPTION_ROW_FLAG("dry-run", 0, struct options, dry_run),
};

COMMAND(run, "running", "CAMPAIGN.yaml", .has_runs = true, .computes = true, .has_farm = true,
        COMMAND_OPTIONS(struct options, rows), .has_table = true, .run = run);
