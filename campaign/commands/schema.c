/* `clast schema scene|campaign`: JSON Schemas, for editors that complete and check YAML. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/document/campaign_schema.h"
#include "engine/scene.h"

struct options {
  const char *engine;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (strcmp(line->arguments[0], "campaign") == 0) {
    campaign_schema_write(stdout);
    return STATUS_OK;
  }
  if (strcmp(line->arguments[0], "scene") != 0)
    return status_fail(error, STATUS_USAGE, "there are schemas of \"scene\" and \"campaign\", not of \"%.64s\"",
                       line->arguments[0]);
  const struct engine_kind *kind = engine_find(options->engine, error);
  if (!kind)
    return STATUS_USAGE;
  scene_schema(kind, stdout);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("engine", 0, "NAME", struct options, engine, "dem", "Engine whose scenes the schema describes."),
};

const struct command schema_command = {
    .name = "schema",
    .group = "scenes and inputs",
    .arguments = "scene|campaign",
    .summary = "JSON Schema of scene or campaign files, for completion in editors",
    .doc =
        "Prints the JSON Schema (draft-07) of scene or campaign documents. An editor with yaml-language-server then\n"
        "completes names, shows meanings and units, and marks mistakes: put its file's name into the first line,\n"
        "  # yaml-language-server: $schema=campaign.schema.json",
    .examples = "clast schema campaign > campaign.schema.json\nclast schema scene --engine dem > scene.schema.json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
