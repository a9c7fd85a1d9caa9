/* `clast explain [PATH|WORD|SCENE]`: what an input or result means; what a scene models and costs. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/explain_path.h"
#include "campaign/terminal/explain_scene.h"
#include "campaign/terminal/table.h"
#include "engine/file_name.h"

struct options {
  struct option_list set;
};

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (line->count == 0)
    return explain_path_list(line->format, error);

  const char *name = line->arguments[0];
  const bool is_scene = file_name_is_document(name) || strchr(name, '@') || scene_builtin_text(name) ||
                        options->set.count;
  if (!is_scene) {
    TRY(table_text_only(line->format, "the explanation of a path", error));
    return explain_path(name, error);
  }
  struct scene *scene = NULL;
  status code = option_load_scene(name, &options->set, &scene, error);
  if (code == STATUS_OK)
    code = explain_scene(scene, line->format, error);
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
};

const struct command explain_command = {
    .name = "explain",
    .group = "scenes and inputs",
    .arguments = "[PATH|WORD|SCENE]",
    .text = explain_text,
    COMMAND_OPTIONS(struct options, rows),
    .has_table = true,
    .run = run,
};
