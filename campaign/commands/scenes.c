/* `clast scenes [NAME]`: the built-in scenes, or one as a document to start from. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "engine/scene.h"

static status print_document(const char *name, struct error *error) {
  const char *text = scene_builtin_text(name);
  if (text) {
    fputs(text, stdout);
    return STATUS_OK;
  }
  struct scene *scene = NULL;
  const status code = scene_load(name, NULL, &scene, error); /* names the nearest scene */
  scene_free(scene);
  return code ? code : status_fail(error, STATUS_USAGE, "%s is a file, not a built-in scene", name);
}

static status add_row(struct table *table, const char *name, struct error *error) {
  struct scene *scene = NULL;
  char what[256];
  TRY(scene_load(name, NULL, &scene, error));
  commands_headline(scene_builtin_text(name), what, sizeof what);
  table_text(table, name);
  table_text(table, scene->kind->name);
  table_text(table, what);
  scene_free(scene);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  if (line->count == 1) {
    TRY(table_text_only(line->format, "a scene's document", error));
    return print_document(line->arguments[0], error);
  }
  struct table *table = table_new(line->format, stdout);
  table_columns(table, (const char *const[]){"name", "engine", "what", NULL});
  status code = STATUS_OK;
  for (size_t i = 0; !code && i < scene_builtin_count(); i++)
    code = add_row(table, scene_builtin_name(i), error);
  return table_finish(table, code, error);
}

COMMAND(scenes, "scenes and inputs", "[NAME]", .has_table = true, .run = run);
