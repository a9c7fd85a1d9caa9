/* `clast run CAMPAIGN`: runs or resumes a campaign, alone or under mpirun and srun. */

#include "campaign/commands/commands.h"
#include "campaign/converge/accuracy.h"
#include "campaign/document/campaign_warn.h"
#include "campaign/launch/launch_campaign.h"
#include "campaign/terminal/campaign_option.h"
#include "campaign/terminal/table.h"

struct options {
  struct launch_options launch;
  struct campaign_option campaign;
  const char *store;
  bool dry_run;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *path = line->arguments[0];
  enum table_format format = TABLE_TEXT;
  TRY(table_choose(&options->launch.table, &format, error));
  if (options->dry_run)
    return commands_plan(path, &options->campaign, options->store, options->launch.slots, false,
                         options->launch.table.json, error);
  struct campaign *campaign = NULL;
  status code = campaign_option_load(path, &options->campaign, &campaign, error);
  const char *store = options->store || code ? options->store : campaign->store;
  if (!code && !launch_other_rank()) /* only the manager takes runs from the campaign */
    code = accuracy_settle(campaign, path, store, error);
  if (!code && !options->launch.quiet && !launch_other_rank())
    campaign_warn(campaign, "clast: warning: ", stderr);
  if (!code)
    code = launch_campaign(campaign, store, &options->launch, format, line, error);
  campaign_free(campaign);
  return launch_quiet_ranks(code, error);
}

static const struct option_row rows[] = {
    CAMPAIGN_OPTION(struct options, campaign),
    LAUNCH_OPTIONS(struct options, launch),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, store, NULL, "Write this store instead of the campaign's."),
    OPTION_ROW_FLAG("dry-run", 'n', struct options, dry_run, "Print what would be done, like `clast plan`, and stop."),
    TABLE_OPTIONS(struct options, launch.table),
};

const struct command run_command = {
    .name = "run",
    .group = "running",
    .arguments = "CAMPAIGN.yaml",
    .summary = "run a campaign, or go on with it; only missing runs are computed",
    .doc =
        "Computes every run that the campaign needs and the store lacks, on all cores of this machine or on the ranks\n"
        "of mpirun or srun. At the end it prints the estimates of every point. Ctrl-C stops it (exit 75), and the "
        "same\n"
        "command continues later. Finished runs are written to the disk every second. A kill or a\n"
        "power cut loses only those since the last write.",
    .examples = "clast run campaign.yaml -j 4\nclast run campaign.yaml --set contact.friction=0.3 --seeds 50 --store "
                "other.db\nmpirun -n 3 --oversubscribe clast run campaign.yaml",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .has_runs = true,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
