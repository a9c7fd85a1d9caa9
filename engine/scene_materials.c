/* Finds the sections and replaces them. */
#include "engine/scene_materials.h"

#include <stdlib.h>
#include <string.h>

#include "engine/file_name.h"

enum { PATH_SIZE = 256 };

const char *const scene_materials_words[] = {"material", "source", "sources", NULL};

static bool has_row(const struct field_table *inputs, const char *section, const char *key) {
  char path[PATH_SIZE + 64];
  snprintf(path, sizeof path, "%s.%s", section, key);
  for (size_t i = 0; i < inputs->count; i++)
    if (strcmp(inputs->rows[i].path, path) == 0)
      return inputs->rows[i].kind == FIELD_CHOICE;
  return false;
}

/* `place`: where errors about the file are reported. */
static void include(document_node *section, document_node *place, const char *path, const char *file,
                    const char *folder) {
  struct document *other = NULL;
  struct error error;
  char *whole = file_name_in(folder, file);
  if (!whole) {
    document_report_memory(place, path);
    return;
  }
  if (document_open(whole, &other, &error) != STATUS_OK)
    document_report_error(place, path, &error);
  else if (!document_graft(section, other, scene_materials_words) || !document_graft_word(section, "name", "custom"))
    document_report_memory(place, path);
  (void)document_graft_word(section, "name", "custom"); /* after an error: prevents further errors about the section */
  free(whole);
}

/* `material: {file: ./my-rock.yaml, ...}` */
static void take_section(document_node *section, const char *path, const char *folder) {
  document_node *file = document_key(section, "file");
  if (!file)
    return;
  const char *word = document_scalar(file);
  if (!word || !*word) {
    document_report(file, path, "expected the name of a material's file, such as ./my-rock.yaml");
    return;
  }
  document_graft_drop(section, "file");
  include(section, file, path, word, folder);
}

/* `material: basalt`, or `material: ./my-rock.yaml` */
static void take_word(document_node *node, const char *path, const char *folder) {
  const char *text = document_scalar(node);
  if (!text || !*text)
    return; /* the reader describes the error */
  char word[4096];
  snprintf(word, sizeof word, "%s", text);
  if (file_name_is_document(word))
    include(node, node, path, word, folder);
  else if (!document_graft_word(node, "name", word))
    document_report_memory(node, path);
}

/* `section`: its path, empty at the root. */
static void walk(document_node *mapping, const struct field_table *inputs, const char *section, const char *folder) {
  for (size_t i = 0; i < document_count(mapping); i++) {
    const char *key = NULL;
    document_node *node = document_item(mapping, i, &key);
    char path[PATH_SIZE];
    if (!key || (size_t)snprintf(path, sizeof path, "%s%s%s", section, *section ? "." : "", key) >= sizeof path)
      continue;
    const bool is_material = has_row(inputs, path, "name"), is_section = document_kind(node) == DOCUMENT_MAPPING;
    if (is_material && is_section)
      take_section(node, path, folder);
    else if (is_material)
      take_word(node, path, folder);
    else if (is_section)
      walk(node, inputs, path, folder);
  }
}

void scene_materials_take(document_node *root, const struct field_table *inputs, const char *folder) {
  if (document_kind(root) == DOCUMENT_MAPPING)
    walk(root, inputs, "", folder);
}
