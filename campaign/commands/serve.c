/* `clast serve CAMPAIGN`: the campaign as a model that UQ packages evaluate over HTTP (UM-Bridge). */
#include <sys/stat.h>

#include "campaign/commands/commands.h"
#include "campaign/serve/serve.h"
#include "schemas/file.h"

enum { SHORTEST_TOKEN = 8 };

struct options {
  struct launch_options launch;
  const char *store, *address, *token, *quantity;
  int64_t port, wait;
};

/* The first line of the file, malloc'd. It is a file because command lines are no secret. */
static status read_token(const char *path, char **token, struct error *error) {
  OWNED unsigned char *bytes = NULL;
  size_t size = 0;
  struct stat file;
  *token = NULL;
  if (!path)
    return STATUS_OK;
  TRY(file_read(path, "file of the token", &bytes, &size, error));
  char *text = (char *)bytes;
  text[strcspn(text, "\r\n")] = '\0';
  const bool others = stat(path, &file) == 0 && (file.st_mode & (S_IRWXG | S_IRWXO));
  if (others)
    return status_fail(error, STATUS_USAGE, "%s: others can read the token: `chmod 600 %s`", path, path);
  if (strlen(text) < SHORTEST_TOKEN)
    return status_fail(error, STATUS_CONTENT, "%s: the token in its first line needs %d characters or more", path,
                       SHORTEST_TOKEN);
  *token = text;
  bytes = NULL;
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  CAMPAIGN campaign = NULL;
  __attribute__((cleanup(serve_model_clear))) struct serve_model model = {0};
  OWNED char *token = NULL;
  TRY(read_token(options->token, &token, error));
  TRY(campaign_load(line->arguments[0], &campaign, error));
  TRY(serve_model_make(campaign, options->quantity, &model, error));
  LAUNCH launch = {0};
  TRY(launch_begin(&launch, campaign, &options->launch, line, error));
  const struct serve_options serving = {.store = options->store ? options->store : campaign->store,
                                        .facts = launch.facts,
                                        .address = options->address,
                                        .token = token,
                                        .port = (int)options->port,
                                        .wait_s = (double)options->wait};
  return serve_run(&model, launch.farm, &serving, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("port", 0, "N", struct options, port, 0, 65535, "4242"),
    OPTION_ROW_TEXT("listen", 0, "ADDRESS", struct options, address, "127.0.0.1"),
    OPTION_ROW_TEXT("token", 0, "FILE", struct options, token, NULL),
    OPTION_ROW_TEXT("quantity", 'Q', "NAMES", struct options, quantity, NULL),
    OPTION_ROW_INTEGER("wait", 0, "S", struct options, wait, 0, 1000000, "3600"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, store, NULL),
    OPTION_ROW_INTEGER("slots", 'j', "N", struct options, launch.slots, 0, 4096, "0"),
    OPTION_ROW_FLAG("in-process", 0, struct options, launch.in_process),
};

COMMAND(serve, "running", "CAMPAIGN.yaml", .computes = true, .has_farm = true, COMMAND_OPTIONS(struct options, rows),
        .run = run);
