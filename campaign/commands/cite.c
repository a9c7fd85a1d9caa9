/* `clast cite SCENE`: the papers behind what is switched on, from the sources of the field tables. */
#include <math.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/scene_option.h"
#include "campaign/terminal/table.h"

struct options {
  struct option_list set;
  struct table_options table;
};

static void cite_row(struct table *table, const struct field *row) {
  if (!row->source)
    return;
  table_text(table, row->path);
  table_text(table, row->source);
}

/* A switch that is off, a law `none` or a coefficient of 0 has no effect, so that its paper is not cited. */
static bool absent(const struct field *row, const void *inputs) {
  struct field_value value;
  field_get(row, inputs, &value);
  switch (row->kind) {
  case FIELD_REAL: return isnan(value.number) || value.number == 0;
  case FIELD_BOOLEAN: return value.number == 0;
  case FIELD_CHOICE: return strcmp(value.text, "none") == 0 || strcmp(value.text, "off") == 0;
  case FIELD_INTEGER:
  case FIELD_TEXT: break;
  }
  return false;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
  struct scene *scene = NULL;
  code = scene_option_load(line->arguments[0], &options->set, &scene, error);
  if (code) {
    scene_free(scene);
    return code;
  }

  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"what", "source", NULL});
  table_text(table, scene->kind->name);
  table_text(table, scene->kind->doc);
  for (size_t i = 0; i < scene->kind->inputs->count; i++)
    if (field_is_active(scene->kind->inputs, &scene->kind->inputs->rows[i], scene->inputs) &&
        !absent(&scene->kind->inputs->rows[i], scene->inputs))
      cite_row(table, &scene->kind->inputs->rows[i]);
  for (size_t i = 0; i < scene->kind->results->count; i++)
    cite_row(table, &scene->kind->results->rows[i]);
  scene_free(scene);
  return table_end(table, error);
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
    TABLE_OPTIONS(struct options, table),
};

const struct command cite_command = {
    .name = "cite",
    .group = "scenes and inputs",
    .arguments = "SCENE",
    .summary = "the papers behind what a scene switches on",
    .doc =
        "Prints the sources of a scene (a built-in name or a file): of its engine, of the inputs that have an effect,\n"
        "and of the results. A paper can then cite what it used. `clast explain SCENE` has the sources of the modules\n"
        "that are on.",
    .examples = "clast cite disc-explosion\nclast cite my-disc.yaml --csv",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
