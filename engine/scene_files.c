/* Finds the inputs that name files, and reads the files. */
#include "engine/scene_files.h"

#include <string.h>

static bool is_hash(const char *text) {
  return strlen(text) == MESH_HASH_SIZE - 1 && strspn(text, "0123456789abcdef") == MESH_HASH_SIZE - 1;
}

static status find(const char *text, const char *folder, const struct mesh_file **file, struct error *error) {
  *file = mesh_files_find(text);
  if (*file)
    return STATUS_OK;
  const status code = mesh_files_open(text, folder, file, error);
  if (code == STATUS_MISSING && is_hash(text))
    return status_fail(error, STATUS_MISSING,
                       "this is the SHA-256 of a shape file that is not here: give the name of the file");
  return code;
}

static void take(document_node *section, document_node *node, const char *key, const char *path, const char *folder) {
  const char *text = document_scalar(node);
  const struct mesh_file *file = NULL;
  struct error error;
  if (!text || !*text) {
    document_report(node, path, "expected the name of a shape file, such as ./bennu.obj");
    return;
  }
  if (find(text, folder, &file, &error)) {
    document_report_error(node, path, &error);
    document_graft_drop(section, key);
    (void)document_graft_word(section, key, "none"); /* prevents further errors about it */
    return;
  }
  document_graft_drop(section, key);
  if (!document_graft_word(section, key, file->hash))
    document_report_memory(node, path);
}

/* The section of a dotted path, and the last word of the path. */
static document_node *section_of(document_node *root, const char *path, const char **key) {
  document_node *section = root;
  for (const char *dot; section && (dot = strchr(path, '.')); path = dot + 1) {
    char word[64];
    if (document_kind(section) != DOCUMENT_MAPPING || (size_t)(dot - path) >= sizeof word)
      return NULL;
    memcpy(word, path, (size_t)(dot - path));
    word[dot - path] = 0;
    section = document_key(section, word);
  }
  *key = path;
  return section && document_kind(section) == DOCUMENT_MAPPING ? section : NULL;
}

void scene_files_take(document_node *root, const struct field_table *inputs, const char *folder) {
  for (size_t i = 0; i < inputs->count && document_kind(root) == DOCUMENT_MAPPING; i++) {
    const char *key = NULL, *path = inputs->rows[i].path;
    document_node *section = inputs->rows[i].flags & FIELD_FILE ? section_of(root, path, &key) : NULL;
    document_node *node = section ? document_key(section, key) : NULL;
    if (node)
      take(section, node, key, path, folder);
  }
}

status scene_files_set(const struct field *row, struct field_value *value, struct error *error) {
  const struct mesh_file *file = NULL;
  struct error why;
  if (!(row->flags & FIELD_FILE))
    return STATUS_OK;
  const status code = find(value->text, NULL, &file, &why);
  if (code)
    return status_fail(error, code, "%s: %s", row->path, why.message);
  field_copy_text(value->text, file->hash);
  return STATUS_OK;
}

size_t scene_files_of(const struct field_table *inputs, const void *object,
                      const struct mesh_file *files[SCENE_FILES_MOST]) {
  size_t count = 0;
  for (size_t i = 0; i < inputs->count && count < SCENE_FILES_MOST; i++) {
    const struct field *row = &inputs->rows[i];
    struct field_value value;
    if (!(row->flags & FIELD_FILE) || !field_is_active(inputs, row, object))
      continue;
    field_get(row, object, &value);
    files[count] = mesh_files_find(value.text);
    count += files[count] != NULL;
  }
  return count;
}
