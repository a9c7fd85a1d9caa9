/* `clast scenes [NAME]`: the built-in scenes, or one as a document to start from. */
#include "campaign/commands/commands.h"
#include "schemas/file.h"

static status print_document(const char *name, struct error *error) {
  const char *text = scene_builtin_text(name);
  if (text) {
    fputs(text, stdout);
    return STATUS_OK;
  }
  SCENE scene = NULL;
  TRY(scene_load(name, NULL, &scene, error)); /* names the nearest scene */
  if (file_name_is_document(name))
    return status_fail(error, STATUS_USAGE, "%s is a file, not a built-in scene", name);
  return status_fail(error, STATUS_USAGE,
                     "%s is a scene with named settings, which stand in its document: `clast scenes %.*s`, `clast "
                     "explain %s`",
                     name, (int)strcspn(name, "@"), name, name);
}

static status run(const struct command_line *line, struct error *error) {
  if (line->count == 1) {
    TRY(table_text_only(line->format, "a scene's document", error));
    return print_document(line->arguments[0], error);
  }
  TABLE table = table_new(line->format, stdout);
  table_columns(table, (const char *const[]){"name", "engine", "what", NULL});
  for (size_t i = 0; i < scene_builtin_count(); i++) {
    const char *name = scene_builtin_name(i);
    char what[256];
    SCENE scene = NULL;
    TRY(scene_load(name, NULL, &scene, error));
    commands_headline(scene_builtin_text(name), what, sizeof what);
    table_text(table, name);
    table_text(table, scene->kind->name);
    table_text(table, what);
  }
  return table_end(table, error);
}

COMMAND(scenes, "scenes and inputs", "[NAME]", .has_table = true, .run = run);
