/* `clast converge SCENE|CAMPAIGN`: differences between results and those of finer settings, and their cost. */
#include "campaign/commands/commands.h"
#include "campaign/converge/study.h"

struct options {
  struct launch_options launch;
  struct study_request request;
  const char *picture, *frontier;
  bool list;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (options->list)
    return study_print_knobs(line->format, error);
  if (line->count == 0)
    return status_fail(error, STATUS_USAGE, "name a scene or a campaign, or give --list");
  struct study_request request = options->request;
  request.quiet = options->launch.quiet;
  OWNED struct study_subject *subject = memory_small(1, sizeof *subject);
  const struct study_launch launch = {.options = &options->launch,
                                      .line = line,
                                      .format = line->format,
                                      .picture = options->picture,
                                      .frontier = options->frontier};
  status code = study_request_read(&request, line->arguments[0], subject, error);
  if (code == STATUS_OK)
    code = study_rounds_launch(&subject->study, &launch, error);
  study_request_clear(subject);
  return code;
}

static const struct option_row rows[] = {
    OPTION_ROW_LIST("knob", 'k', "NAMES", struct options, request.knobs),
    OPTION_ROW_TEXT("quantity", 'Q', "NAMES", struct options, request.quantity, NULL),
    SCENE_OPTION_SET(struct options, request.set),
    OPTION_ROW_TEXT("within", 0, "WIDTH", struct options, request.within, "5 %"),
    OPTION_ROW_TEXT("seconds", 0, "S", struct options, request.seconds, NULL),
    OPTION_ROW_INTEGER("seeds", 0, "N", struct options, request.first_seeds, 2, 1000000, "4"),
    OPTION_ROW_INTEGER("max-seeds", 0, "N", struct options, request.most_seeds, 2, 1000000, "32"),
    OPTION_ROW_INTEGER("first-seed", 0, "N", struct options, request.first_seed, 0, INT64_MAX, "0"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct options, request.store, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct options, picture),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "frontier", 0, "FILE", struct options, frontier),
    OPTION_ROW_FLAG("list", 0, struct options, list),
    LAUNCH_OPTIONS(struct options, launch),
};

COMMAND(converge, "running", "[SCENE|CAMPAIGN.yaml]", .has_runs = true, .has_farm = true,
        COMMAND_OPTIONS(struct options, rows), .has_table = true, .run = run);
