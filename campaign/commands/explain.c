/* `clast explain [PATH|WORD|SCENE]`: what an input or result means; what a scene models and costs. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/explain_path.h"
#include "campaign/terminal/explain_scene.h"
#include "campaign/terminal/scene_option.h"
#include "campaign/terminal/table.h"
#include "engine/file_name.h"

struct options {
  struct option_list set;
  struct table_options table;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
  if (line->count == 0)
    return explain_path_list(format, error);

  const char *name = line->arguments[0];
  const bool is_scene = file_name_is_document(name) || strchr(name, '@') || scene_builtin_text(name) ||
                        options->set.count;
  if (!is_scene) {
    code = table_text_only(&options->table, "the explanation of a path", error);
    return code ? code : explain_path(name, error);
  }
  struct scene *scene = NULL;
  code = scene_option_load(name, &options->set, &scene, error);
  if (code == STATUS_OK)
    code = explain_scene(scene, format, error);
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
    TABLE_OPTIONS(struct options, table),
};

const struct command explain_command = {
    .name = "explain",
    .group = "scenes and inputs",
    .arguments = "[PATH|WORD|SCENE]",
    .summary = "what an input or result means; what a scene models and costs",
    .doc =
        "With a PATH (threshold.strain, or strain if that is unique, or contact for a section, or a key of a "
        "campaign):\n"
        "meaning, unit, range, default and source. A result may have any of its names (with dots or underscores, or\n"
        "with _mean at the end). With a WORD (campaign, results, sph, censored, interval, a column of the store): its\n"
        "meaning. With a SCENE (a built-in name or a file): the modules that are on and why, the expected cost, and\n"
        "every input with its value; with --json or --csv the inputs only. Without argument: a table of all inputs,\n"
        "results and keys.",
    .examples = "clast explain threshold.strain\nclast explain disc-explosion --set threshold.strain=5%",
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
