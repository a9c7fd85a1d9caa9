/* `clast converge SCENE|CAMPAIGN`: differences between results and those of finer settings, and their cost. */
#include "campaign/commands/commands.h"
#include "campaign/converge/study.h"

/* The knobs of all engines, or those of a scene or a campaign. */
static status list_knobs(const struct study_request *request, const struct command_line *line, struct error *error) {
  SCENE scene = NULL;
  CAMPAIGN campaign = NULL;
  const char *path = line->count ? line->arguments[0] : NULL;
  if (path)
    TRY(study_is_campaign(path) ? campaign_load(path, &campaign, error)
                                : option_load_scene(path, &request->set, &scene, error));
  return study_print_knobs(campaign ? campaign->scene : scene, line->format, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct study_request *request = line->options;
  if (request->list)
    return list_knobs(request, line, error);
  if (line->count == 0)
    return status_fail(error, STATUS_USAGE, "name a scene or a campaign, or give --list");
  return study_launch(request, line, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_LIST("knob", 'k', "NAMES", struct study_request, knobs),
    OPTION_ROW_TEXT("quantity", 'Q', "NAMES", struct study_request, quantity, NULL),
    SCENE_OPTION_SET(struct study_request, set),
    OPTION_ROW_TEXT("within", 0, "WIDTH", struct study_request, within, "5 %"),
    OPTION_ROW_TEXT("seconds", 0, "S", struct study_request, seconds, NULL),
    OPTION_ROW_INTEGER("seeds", 0, "N", struct study_request, first_seeds, 2, 1000000, "4"),
    OPTION_ROW_INTEGER("max-seeds", 0, "N", struct study_request, most_seeds, 2, 1000000, "32"),
    OPTION_ROW_INTEGER("first-seed", 0, "N", struct study_request, first_seed, 0, INT64_MAX, "0"),
    OPTION_ROW_TEXT("store", 0, "FILE", struct study_request, store, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE", struct study_request, picture),
    OPTION_ROW_FLAG("list", 0, struct study_request, list),
    LAUNCH_OPTIONS(struct study_request, launch),
};

COMMAND(converge, "running", "[SCENE|CAMPAIGN.yaml]", .has_runs = true, .computes = true, .has_farm = true,
        COMMAND_OPTIONS(struct study_request, rows), .has_table = true, .run = run);
