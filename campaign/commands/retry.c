/* `clast retry STORE`: tries again the runs that were given up, with raised limits. */
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/converge/accuracy.h"
#include "campaign/document/campaign.h"
#include "campaign/launch/launch.h"
#include "db/ask/ask.h"

struct options {
  struct launch_options launch;
  const char *status, *time, *memory, *folder;
  int64_t campaign;
};

/* Reads name and document of the campaign, and the largest number of attempts of a failed run. */
static status read_store(const char *path, int64_t campaign, char **name, char **document, int64_t *attempts,
                         struct error *error) {
  struct store *store = NULL;
  TRY(store_open_reader(path, &store, error));
  status code = ask_campaign_document(store, campaign, name, document, error);
  if (code == STATUS_OK && !*document)
    code = status_fail(error, STATUS_USAGE, "%s has no such campaign; `clast status %s` lists them", path, path);
  if (code == STATUS_OK)
    code = ask_campaign_attempts(store, attempts, error);
  store_close(store, NULL);
  return code;
}

static status retry(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *path = line->arguments[0];
  char *name = NULL, *document = NULL;
  struct campaign *campaign = NULL;
  int64_t attempts = 0;
  status code = read_store(path, options->campaign, &name, &document, &attempts, error);
  if (code)
    goto cleanup;
  if (attempts == 0) {
    fprintf(stderr, "%s: no run was given up; nothing to try again\n", path);
    goto cleanup;
  }
  code = campaign_parse_stored(name, document, options->folder, &campaign, error);
  if (code == STATUS_OK)
    code = campaign_raise(campaign, options->time, options->memory, attempts, error);
  if (code == STATUS_OK && !launch_other_rank())
    code = accuracy_settle(campaign, "CAMPAIGN.yaml", path, ACCURACY_SILENT, NULL, error);
  if (code == STATUS_OK)
    code = launch_campaign(campaign, path, &options->launch, line->format, line, error);
cleanup:
  campaign_free(campaign);
  free(name);
  free(document);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  status code = STATUS_OK;
  if (strcmp(options->status, "failed") != 0)
    code = status_fail(error, STATUS_USAGE,
                       "--status knows \"failed\" only: a run that ended with a verdict of its own "
                       "(NaN, time step, energy) would end the same way again");
  return launch_quiet_ranks(code ? code : retry(line, error), error);
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("status", 0, "failed", struct options, status, "failed"),
    OPTION_ROW_TEXT("time", 0, "TIME", struct options, time, NULL),
    OPTION_ROW_TEXT("memory", 0, "SIZE", struct options, memory, NULL),
    OPTION_ROW_INTEGER("campaign", 0, "N", struct options, campaign, 0, INT32_MAX, "0"),
    OPTION_ROW_TEXT("folder", 0, "DIR", struct options, folder, NULL),
    LAUNCH_OPTIONS(struct options, launch),
};

COMMAND(retry, "running", "STORE", .has_runs = true, COMMAND_OPTIONS(struct options, rows), .has_table = true,
        .run = run);
