/* Explains the model of a scene and its active inputs. */
#include "campaign/terminal/explain_scene.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/terminal/results.h"
#include "engine/scene_settings.h"
#include "schemas/text.h"

static void explain_inputs(const struct scene *scene, FILE *out) {
  const struct field_table *inputs = scene->kind->inputs;
  int widest = 0;
  for (size_t i = 0; i < inputs->count; i++) {
    const int length = (int)strlen(inputs->rows[i].path);
    if (length > widest && field_is_active(inputs, &inputs->rows[i], scene->inputs))
      widest = length;
  }
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    if (!field_is_active(inputs, row, scene->inputs))
      continue;
    struct field_value value;
    char text[FIELD_TEXT_SIZE], doc[FIELD_TEXT_SIZE];
    field_get(row, scene->inputs, &value);
    if (row->kind == FIELD_REAL && !field_is_off(value.number)) /* six digits are enough for people */
      snprintf(text, sizeof text, "%.6g%s%s", value.number, strcmp(row->unit, "1") == 0 ? "" : " ",
               strcmp(row->unit, "1") == 0 ? "" : row->unit);
    else
      field_print(row, &value, text, sizeof text);
    text_sentence(row->doc, doc, sizeof doc);
    fprintf(out, "  %-*s  %-20s %s\n", widest, row->path, text, doc);
  }
}

/* The same for programs. */
static status list_inputs(const struct scene *scene, enum table_format format, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"path", "value", "unit", "meaning", NULL});
  for (size_t i = 0; i < inputs->count; i++)
    if (field_is_active(inputs, &inputs->rows[i], scene->inputs))
      results_row(table, &inputs->rows[i], scene->inputs);
  return table_end(table, error);
}

/* "basalt-sphere@draft: particles 10000, precision float" */
static void list_settings(const struct scene *scene) {
  for (size_t i = 0; i < scene->settings_count; i++) {
    const struct scene_settings *settings = &scene->settings[i];
    printf("  %s@%s:", scene->name, settings->name);
    for (size_t j = 0; j < settings->count; j++) {
      const struct field *row = &scene->kind->inputs->rows[settings->item[j].row];
      printf("%s %s ", j ? "," : "", row->path);
      field_json_value(row, &settings->item[j].value, stdout);
      if (row->unit && strcmp(row->unit, "1") != 0)
        printf(" %s", row->unit);
    }
    putchar('\n');
  }
}

status explain_scene(const struct scene *scene, enum table_format format, struct error *error) {
  if (format != TABLE_TEXT)
    return list_inputs(scene, format, error);
  char *description = scene->kind->describe(scene->inputs);
  if (!description)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  printf("%s, engine %s\n\n%s%s\ninputs:\n", scene->name, scene->kind->name, description,
         *description && description[strlen(description) - 1] == '\n' ? "" : "\n");
  free(description);
  explain_inputs(scene, stdout);
  if (scene->settings_count > 0)
    puts("\nnamed settings (campaign/accuracy.md):");
  list_settings(scene);
  return STATUS_OK;
}
