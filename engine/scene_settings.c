/* Reads the named settings of a scene and applies them. */
#include "engine/scene_settings.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

static bool is_name(const char *name) {
  for (const char *c = name; *c; c++)
    if (!islower((unsigned char)*c) && !isdigit((unsigned char)*c) && *c != '-')
      return false;
  return *name && strlen(name) < SCENE_SETTINGS_NAME && strcmp(name, SCENE_SETTINGS_STANDARD) != 0;
}

static void read_item(document_node *node, const char *path, const struct field_table *inputs,
                      struct scene_settings *settings) {
  char place[FIELD_TEXT_SIZE];
  struct error error = {0};
  snprintf(place, sizeof place, "settings.%s.%.128s", settings->name, path ? path : "");
  const struct field *row = path ? field_find(inputs, path, &error) : NULL;
  if (!row)
    document_report(node, place, "%s", path ? error.message : "expected the path of an input");
  else if (settings->count == SCENE_SETTINGS_ITEMS)
    document_report(node, place, "more than %d inputs in one of the settings", SCENE_SETTINGS_ITEMS);
  else if (document_value(node, row, &settings->item[settings->count].value))
    settings->item[settings->count++].row = (size_t)(row - inputs->rows);
}

static void read_one(document_node *node, const char *name, const struct field_table *inputs,
                     struct scene_settings *settings) {
  if (!name || !is_name(name)) {
    document_report(node, "settings",
                    "a name has small letters, digits and '-', at most %d of them; '%s' is the scene "
                    "as written",
                    SCENE_SETTINGS_NAME - 1, SCENE_SETTINGS_STANDARD);
    return;
  }
  if (document_kind(node) != DOCUMENT_MAPPING) {
    document_report(node, "settings", "expected inputs and their values, such as {fidelity.particles: 3000}");
    return;
  }
  snprintf(settings->name, sizeof settings->name, "%s", name);
  for (size_t i = 0; i < document_count(node); i++) {
    const char *path = NULL;
    document_node *item = document_item(node, i, &path);
    read_item(item, path, inputs, settings);
  }
}

void scene_settings_read(document_node *node, struct scene *scene) {
  if (!node)
    return;
  if (document_kind(node) != DOCUMENT_MAPPING || document_count(node) > SCENE_SETTINGS_MOST) {
    document_report(node, "settings", "expected at most %d names with their inputs, such as draft: {...}",
                    SCENE_SETTINGS_MOST);
    return;
  }
  const size_t count = document_count(node);
  scene->settings = calloc(count ? count : 1, sizeof *scene->settings);
  if (!scene->settings) {
    document_report_memory(node, "settings");
    return;
  }
  scene->settings_count = count;
  for (size_t i = 0; i < count; i++) {
    const char *name = NULL;
    document_node *item = document_item(node, i, &name);
    read_one(item, name, scene->kind->inputs, &scene->settings[i]);
  }
}

const struct scene_settings *scene_settings_find(const struct scene *scene, const char *name) {
  for (size_t i = 0; i < scene->settings_count; i++)
    if (strcmp(scene->settings[i].name, name) == 0)
      return &scene->settings[i];
  return NULL;
}

static status unknown(const struct scene *scene, const char *name, struct error *error) {
  char known[512] = SCENE_SETTINGS_STANDARD;
  for (size_t i = 0; i < scene->settings_count; i++)
    text_append(known, sizeof known, ", %s", scene->settings[i].name);
  return status_fail(error, STATUS_MISSING, "%s has no settings '%.64s'; it has %s (`settings` in its document)",
                     scene->name, name, known);
}

status scene_settings_use(struct scene *scene, const char *name, struct error *error) {
  if (strcmp(name, SCENE_SETTINGS_STANDARD) == 0)
    return STATUS_OK;
  const struct scene_settings *settings = scene_settings_find(scene, name);
  if (!settings)
    return unknown(scene, name, error);

  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < settings->count; i++) {
    const size_t row = settings->item[i].row;
    const bool overridden = scene->overridden[row];
    code = scene_set(scene, scene->kind->inputs->rows[row].path, &settings->item[i].value, error);
    scene->overridden[row] = overridden;
  }
  return code;
}
