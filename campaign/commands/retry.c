/* `clast retry STORE`: tries again the runs that were given up, with raised limits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/commands/launch.h"
#include "db/ask/query.h"

struct options {
  struct launch_options launch;
  const char *status, *time, *memory, *folder;
  int64_t campaign;
};

struct origin {
  char *name, *document;
};

static status take_document(void *context, size_t count, const struct query_value *values, struct error *error) {
  struct origin *origin = context;
  if (count != 2 || values[0].kind != QUERY_TEXT || values[1].kind != QUERY_TEXT)
    return status_fail(error, STATUS_CONTENT, "the store keeps no campaign document");
  origin->name = strdup(values[0].text);
  origin->document = strdup(values[1].text);
  return origin->name && origin->document ? STATUS_OK : status_fail(error, STATUS_MEMORY, "out of memory");
}

/* A limit given on the command line, or twice the campaign's. */
static status raise_limit(const char *path, const char *text, double *limit, struct error *error) {
  if (!text) {
    *limit *= 2;
    return STATUS_OK;
  }
  const struct field *row = field_find(&campaign_table, path, error);
  struct field_value value;
  if (!row)
    return STATUS_INTERNAL;
  status code = field_parse(row, text, &value, error);
  if (code)
    return STATUS_USAGE;
  *limit = value.number;
  return STATUS_OK;
}

/* From the store: the campaign, and how often its unlucky runs have been tried. */
static status read_store(const char *path, const struct options *options, struct origin *origin, double *tried,
                         struct error *error) {
  struct store *store = NULL;
  struct query_sink sink = {origin, NULL, take_document};
  char number[32] = "";
  struct query_parameter parameter = {"campaign", number};
  if (options->campaign)
    snprintf(number, sizeof number, "%lld", (long long)options->campaign);
  status code = store_open_reader(path, &store, error);
  if (!code)
    code = query_run(store,
                     options->campaign ? "select name, document from campaign where campaign_id = :campaign"
                                       : "select name, document from campaign order by campaign_id desc limit 1",
                     options->campaign ? 1 : 0, &parameter, 0, &sink, error);
  if (!code && !origin->document)
    code = status_fail(error, STATUS_USAGE, "%s has no such campaign; `clast status %s` lists them", path, path);
  if (!code)
    code = query_number(store,
                        "select max(n) from (select count(*) as n from attempt where not exists"
                        " (select 1 from run where run.identity = attempt.identity) group by identity)",
                        0, NULL, tried, error);
  store_close(store, NULL);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *path = line->arguments[0];
  enum table_format format = TABLE_TEXT;
  struct origin origin = {0};
  struct campaign *campaign = NULL;
  double tried = NAN;
  status code = table_choose(&options->launch.table, &format, error);
  if (!code && strcmp(options->status, "failed") != 0)
    code = status_fail(error, STATUS_USAGE,
                       "--status knows \"failed\" only: a run that ended with a verdict of its own "
                       "(NaN, time step, energy) would end the same way again");
  if (!code)
    code = read_store(path, options, &origin, &tried, error);
  if (!code && isnan(tried)) {
    fprintf(stderr, "%s: no run was given up; nothing to try again\n", path);
  } else if (!code) {
    code = campaign_parse(origin.name, origin.document, strlen(origin.document), options->folder, &campaign, error);
    if (!code)
      code = raise_limit("limits.time", options->time, &campaign->time_limit, error);
    if (!code)
      code = raise_limit("limits.memory", options->memory, &campaign->memory_limit, error);
    if (!code) {
      campaign->attempts += (int64_t)tried;
      campaign->failures = 0; /* someone looks at these failures already */
      code = launch_campaign(campaign, path, &options->launch, format, line, error);
    }
  }
  campaign_free(campaign);
  free(origin.name);
  free(origin.document);
  return launch_quiet_ranks(code, error);
}

static const struct option_row rows[] = {
    {"status", 0, OPTION_TEXT, "failed", offsetof(struct options, status), 0, 0, "failed",
     "Which runs: those whose every attempt failed by a limit, a crash or a lost worker."},
    {"time", 0, OPTION_TEXT, "TIME", offsetof(struct options, time), 0, 0, NULL,
     "Time limit of an attempt (\"30 min\", off); without it twice the campaign's."},
    {"memory", 0, OPTION_TEXT, "SIZE", offsetof(struct options, memory), 0, 0, NULL,
     "Memory limit of an attempt (\"4 GiB\", off); without it twice the campaign's."},
    {"campaign", 0, OPTION_INTEGER, "N", offsetof(struct options, campaign), 0, INT32_MAX, "0",
     "Campaign of the store (`clast status`); 0 is the last one."},
    {"folder", 0, OPTION_TEXT, "DIR", offsetof(struct options, folder), 0, 0, NULL,
     "Folder that the campaign's scene file is relative to; the current one without it."},
    LAUNCH_OPTIONS(struct options, launch),
    TABLE_OPTIONS(struct options, launch.table),
};

const struct command retry_command = {
    .name = "retry",
    .group = "running",
    .arguments = "STORE",
    .summary = "try failed runs of a store again, with raised limits",
    .doc = "Takes the campaign from the store and computes what it lacks, runs whose attempts were used up included, "
           "with\n"
           "as many attempts more as the campaign allows and raised limits. Limits are no part of a run's identity.",
    .examples = "clast retry out.db --status failed --time '1 h'\nclast retry out.db --memory off -j 2",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .has_runs = true,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
