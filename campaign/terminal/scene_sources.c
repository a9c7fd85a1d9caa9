/* Sources of engine, inputs, materials and results. */
#include "campaign/terminal/scene_sources.h"

#include <math.h>
#include <string.h>

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

/* Sources of the values of a named material; one for a section whose values have the same source. */
static void cite_materials(const struct scene *scene, scene_sources_each each, void *context) {
  const struct field_table *inputs = scene->kind->inputs;
  char name[FIELD_TEXT_SIZE] = "", before[FIELD_TEXT_SIZE] = "";
  size_t section = 0; /* length of "target.material." */
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    const char *ending = strstr(row->path, ".material.");
    struct field_value value;
    if (!ending || !scene->kind->materials || !field_is_active(inputs, row, scene->inputs))
      continue;
    if (strcmp(ending, ".material.name") == 0) {
      field_get(row, scene->inputs, &value);
      snprintf(name, sizeof name, "%s", value.text);
      section = (size_t)(ending - row->path) + strlen(".material.");
      before[0] = '\0';
      continue;
    }
    char source[FIELD_TEXT_SIZE], what[2 * FIELD_TEXT_SIZE];
    if (scene->given[i] || absent(row, scene->inputs) ||
        scene->kind->materials->source(name, row->path + section, source) != STATUS_OK || strcmp(source, before) == 0)
      continue;
    snprintf(before, sizeof before, "%s", source);
    snprintf(what, sizeof what, "%s of %s", row->path, name);
    each(context, what, source);
  }
}

void scene_sources(const struct scene *scene, scene_sources_each each, void *context) {
  const struct field_table *inputs = scene->kind->inputs, *results = scene->kind->results;
  each(context, scene->kind->name, scene->kind->doc);
  for (size_t i = 0; i < inputs->count; i++)
    if (inputs->rows[i].source && field_is_active(inputs, &inputs->rows[i], scene->inputs) &&
        !absent(&inputs->rows[i], scene->inputs))
      each(context, inputs->rows[i].path, inputs->rows[i].source);
  cite_materials(scene, each, context);
  for (size_t i = 0; i < results->count; i++)
    if (results->rows[i].source)
      each(context, results->rows[i].path, results->rows[i].source);
}
