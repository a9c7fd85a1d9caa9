/* `clast retry STORE`: tries again the runs that were given up, with raised limits. */
#include "campaign/commands/commands.h"
#include "campaign/converge/accuracy.h"

struct options {
  struct launch_options launch;
  const char *status, *time, *memory, *folder;
  int64_t campaign;
};

/* Reads name and document of the campaign, and the largest number of attempts of a failed run. */
static status read_store(const char *path, int64_t campaign, char **name, char **document, int64_t *attempts,
                         struct error *error) {
  STORE store = NULL;
  TRY(store_open_reader(path, &store, error));
  TRY(ask_campaign_document(store, campaign, name, document, error));
  char word[TEXT_WORD];
  if (!*document)
    return status_fail(error, STATUS_USAGE, "%s has no such campaign; `clast status %s` lists them", path,
                       text_word(path, word));
  return ask_campaign_attempts(store, attempts, error);
}

static status check(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (strcmp(options->status, "failed") != 0)
    return status_fail(error, STATUS_USAGE,
                       "--status knows \"failed\" only: a run that ended with a verdict of its own "
                       "(NaN, time step, energy) would end the same way again");
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *path = line->arguments[0];
  OWNED char *name = NULL, *document = NULL;
  CAMPAIGN campaign = NULL;
  int64_t attempts = 0;
  TRY(read_store(path, options->campaign, &name, &document, &attempts, error));
  if (attempts == 0) {
    fprintf(stderr, "%s: no run was given up; nothing to try again\n", path);
    return STATUS_OK;
  }
  TRY(campaign_parse_stored(name, document, options->folder, &campaign, error));
  TRY(campaign_raise(campaign, options->time, options->memory, attempts, error));
  char words[1000];
  option_words("CAMPAIGN.yaml", &(struct option_list){0}, path, words, sizeof words);
  if (!launch_other_rank())
    TRY(accuracy_settle(campaign, words, path, ACCURACY_SILENT, NULL, error));
  return launch_campaign(campaign, path, &options->launch, line->format, line, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("status", 0, "failed", struct options, status, "failed"),
    OPTION_ROW_TEXT("time", 0, "TIME", struct options, time, NULL),
    OPTION_ROW_TEXT("memory", 0, "SIZE", struct options, memory, NULL),
    OPTION_ROW_INTEGER("campaign", 0, "N", struct options, campaign, 0, INT32_MAX, "0"),
    OPTION_ROW_TEXT("folder", 0, "DIR", struct options, folder, NULL),
    LAUNCH_OPTIONS(struct options, launch),
};

COMMAND(retry, "running", "STORE", .has_runs = true, .computes = true, .has_farm = true,
        COMMAND_OPTIONS(struct options, rows), .has_table = true, .check = check, .run = run);
