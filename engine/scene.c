/* Scenes: built-in documents, reading, overrides, checks, identity. */
#include "engine/scene.h"

#include <stdlib.h>
#include <string.h>

#include "engine/blake2s.h"
#include "engine/builtin.h"
#include "engine/file_name.h"
#include "engine/scene_files.h"
#include "engine/scene_materials.h"
#include "engine/scene_settings.h"
#include "schemas/document.h"
#include "schemas/json_schema.h"
#include "schemas/memory.h"
#include "schemas/text.h"

/* ---- built-in scenes ---- */

size_t scene_builtin_count(void) {
  size_t count = 0;
  while (builtin_scene_list[count].name)
    count++;
  return count;
}

const char *scene_builtin_name(size_t index) {
  return index < scene_builtin_count() ? builtin_scene_list[index].name : NULL;
}

const char *scene_builtin_text(const char *name) {
  for (size_t i = 0; builtin_scene_list[i].name; i++)
    if (strcmp(builtin_scene_list[i].name, name) == 0)
      return builtin_scene_list[i].text;
  return NULL;
}

static status unknown_builtin(const char *name, struct error *error) {
  struct text_guess guess = text_guess(name);
  for (size_t i = 0; builtin_scene_list[i].name; i++)
    text_guess_offer(&guess, builtin_scene_list[i].name);
  if (guess.nearest)
    return status_fail(error, STATUS_MISSING,
                       "there is no built-in scene '%.100s'; did you mean '%s'? A file is named with its folder or "
                       "ending, such as ./%.100s.yaml",
                       name, guess.nearest, name);
  return status_fail(error, STATUS_MISSING,
                     "there is no built-in scene '%.100s'; 'clast scenes' lists them. A file is named with its folder "
                     "or ending, such as ./%.100s.yaml",
                     name, name);
}

/* ---- reading ---- */

static const char *const own_keys[] = {"engine", "name", "source", "settings", NULL};

static const struct field name_row = {.path = "name", .kind = FIELD_TEXT, .doc = "The scene's name"};
static const struct field source_row = {.path = "source",
                                        .kind = FIELD_TEXT,
                                        .doc = "Where it comes from: paper, section, figure"};

static struct scene *create(const struct engine_kind *kind) {
  struct scene *scene = calloc(1, sizeof *scene);
  if (!scene)
    return NULL;
  scene->kind = kind;
  scene->inputs = calloc(1, kind->inputs->size);
  scene->given = calloc(kind->inputs->count + 1, sizeof *scene->given);
  scene->overridden = calloc(kind->inputs->count + 1, sizeof *scene->overridden);
  if (!scene->inputs || !scene->given || !scene->overridden) {
    scene_free(scene);
    return NULL;
  }
  field_defaults(kind->inputs, scene->inputs);
  return scene;
}

/* The engine that a document names; NULL: an error was reported. */
static const struct engine_kind *read_engine(document_node *root) {
  document_node *engine = document_key(root, "engine");
  if (!engine) {
    document_report(root, "engine", "is missing; say which engine runs this scene, such as 'engine: dem'");
    return NULL;
  }
  const char *name = document_scalar(engine);
  if (!name) {
    document_report(engine, "engine", "expected an engine's name, such as 'engine: dem'");
    return NULL;
  }
  struct error unknown;
  const struct engine_kind *kind = engine_find(name, &unknown);
  if (!kind)
    document_report(engine, "engine", "%s", unknown.message);
  return kind;
}

/* The document's `name`, else the fallback. `source` is read, too, as it may be wrong. */
static void read_name(document_node *root, const char *fallback, struct field_value *name) {
  struct field_value source;
  *name = (struct field_value){.kind = FIELD_TEXT};
  document_node *name_node = document_key(root, "name"), *source_node = document_key(root, "source");
  if (name_node)
    document_value(name_node, &name_row, name);
  if (source_node)
    document_value(source_node, &source_row, &source);
  if (!name->text[0])
    field_copy_text(name->text, fallback);
}

/* Reads the scene; errors of its content go into the document's report. */
static status read_scene(document_node *root, const char *folder, const char *fallback, struct scene **out,
                         struct error *error) {
  struct field_value name;
  const struct engine_kind *kind = read_engine(root);
  read_name(root, fallback, &name);
  if (!kind)
    return STATUS_OK;
  struct scene *scene = *out = create(kind);
  if (!scene)
    return status_fail(error, STATUS_MEMORY, "no memory for a scene");
  scene_materials_take(root, kind->inputs, folder);
  scene_files_take(root, kind->inputs, folder);
  document_read_given(root, kind->inputs, own_keys, scene->inputs, scene->given, kind->complete);
  snprintf(scene->name, sizeof scene->name, "%s", name.text);
  scene_settings_read(document_key(root, "settings"), scene);
  return STATUS_OK;
}

/* Frees the document. */
static status read_document(struct document *document, const char *folder, const char *fallback, struct scene **out,
                            struct error *error) {
  const char *report;
  *out = NULL;
  status code = read_scene(document_root(document), folder, fallback, out, error);
  if (!code) {
    code = document_finish(document, &report);
    if (code)
      status_fail(error, code, "%s", report);
  }
  document_free(document);
  if (code) {
    scene_free(*out);
    *out = NULL;
  }
  return code;
}

/* Loads a scene file. File names in it are relative to its folder. A scene without a name gets the name of its file. */
static status load_file(const char *path, struct scene **out, struct error *error) {
  const char *slash = strrchr(path, '/');
  const size_t length = slash ? (size_t)(slash - path) : 0;
  char *folder = strndup(path, slash == path ? 1 : length); /* "/" for "/scene.yaml" */
  char *stem = strdup(slash ? slash + 1 : path);
  struct document *document = NULL;
  status code;
  if (!folder || !stem) {
    code = status_fail(error, STATUS_MEMORY, "no memory for a path");
    goto cleanup;
  }
  char *dot = strrchr(stem, '.');
  if (dot && dot != stem)
    *dot = 0;
  code = document_open(path, &document, error);
  if (!code)
    code = read_document(document, folder, stem, out, error);
cleanup:
  free(folder);
  free(stem);
  return code;
}

static status load_standard(const char *reference, const char *folder, struct scene **out, struct error *error) {
  *out = NULL;
  if (!file_name_is_document(reference)) {
    const char *text = scene_builtin_text(reference);
    return text ? scene_parse(reference, text, out, error) : unknown_builtin(reference, error);
  }
  char *path = file_name_in(folder, reference);
  if (!path)
    return status_fail(error, STATUS_MEMORY, "no memory for a path");
  const status code = load_file(path, out, error);
  free(path);
  return code;
}

status scene_load(const char *reference, const char *folder, struct scene **out, struct error *error) {
  const char *at = strrchr(reference, '@');
  if (!at || strchr(at, '/'))
    return load_standard(reference, folder, out, error);

  char *standard = strndup(reference, (size_t)(at - reference));
  status code = standard ? load_standard(standard, folder, out, error)
                         : status_fail(error, STATUS_MEMORY, "no memory for a path");
  free(standard);
  if (code == STATUS_OK)
    code = scene_settings_use(*out, at + 1, error);
  if (code != STATUS_OK) {
    scene_free(*out);
    *out = NULL;
  }
  return code;
}

status scene_parse(const char *name, const char *text, struct scene **out, struct error *error) {
  *out = NULL;
  struct document *document = NULL;
  status code = document_parse(name, text, strlen(text), &document, error);
  return code ? code : read_document(document, NULL, name, out, error);
}

status scene_parse_json(const char *name, const char *json, struct scene **out, struct error *error) {
  *out = NULL;
  struct document *document = NULL;
  TRY(document_parse(name, json, strlen(json), &document, error));
  document_take_si(document);
  return read_document(document, NULL, name, out, error);
}

struct scene *scene_copy(const struct scene *scene) {
  struct scene *copy = create(scene->kind);
  if (!copy)
    return NULL;
  memcpy(copy->inputs, scene->inputs, scene->kind->inputs->size);
  memcpy(copy->given, scene->given, scene->kind->inputs->count * sizeof *scene->given);
  memcpy(copy->overridden, scene->overridden, scene->kind->inputs->count * sizeof *scene->overridden);
  memcpy(copy->name, scene->name, sizeof copy->name);
  if (scene->settings_count == 0)
    return copy;
  const size_t size = scene->settings_count * sizeof *scene->settings;
  copy->settings = malloc(size);
  if (!copy->settings) {
    scene_free(copy);
    return NULL;
  }
  copy->settings_count = scene->settings_count;
  memcpy(copy->settings, scene->settings, size);
  return copy;
}

void scene_free(struct scene *scene) {
  if (!scene)
    return;
  free(scene->inputs);
  free(scene->given);
  free(scene->overridden);
  free(scene->settings);
  free(scene);
}

/* ---- overrides ---- */

status scene_set(struct scene *scene, const char *path, const struct field_value *value, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  const struct field *row = field_find(table, path, error);
  if (!row)
    return STATUS_CONTENT;
  struct field_value taken = *value;
  TRY(scene_files_set(row, &taken, error));
  TRY(field_set(row, scene->inputs, &taken, error));
  scene->given[row - table->rows] = scene->overridden[row - table->rows] = true;
  if (scene->kind->complete)
    scene->kind->complete(scene->inputs, scene->given);
  return STATUS_OK;
}

status scene_set_text(struct scene *scene, const char *path, const char *text, struct error *error) {
  struct field_value value;
  const struct field *row = field_find(scene->kind->inputs, path, error);
  if (!row)
    return STATUS_CONTENT;
  status code = field_parse(row, text, &value, error);
  return code ? code : scene_set(scene, row->path, &value, error);
}

/* Resets a row to its default when an override makes its line in the document ineffective. */
static status set_back(struct scene *scene, size_t row, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  void *untouched = calloc(1, table->size);
  if (!untouched)
    return status_fail(error, STATUS_MEMORY, "no memory for a scene");
  struct field_value value;
  field_defaults(table, untouched);
  field_get(&table->rows[row], untouched, &value);
  field_set_unchecked(&table->rows[row], scene->inputs, &value);
  scene->given[row] = false;
  free(untouched);
  if (scene->kind->complete)
    scene->kind->complete(scene->inputs, scene->given);
  return STATUS_OK;
}

status scene_check(struct scene *scene, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    if (field_is_active(table, row, scene->inputs)) {
      if (row->flags & FIELD_REQUIRED && !scene->given[i])
        return status_fail(error, STATUS_CONTENT, "%s: is missing and has no default; %s", row->path, row->doc);
    } else if (scene->overridden[i]) {
      char why[600];
      field_describe_inactive(table, row, scene->inputs, why, sizeof why);
      return status_fail(error, STATUS_CONTENT, "%s: has no effect: it is %s; remove one or change the other",
                         row->path, why);
    } else if (scene->given[i]) {
      TRY(set_back(scene, i, error));
    }
  }
  const status code = scene->kind->check ? scene->kind->check(scene->inputs, error) : STATUS_OK;
  if (code || !scene->kind->check_given)
    return code;
  return scene->kind->check_given(scene->inputs, scene->given, error);
}

/* ---- output ---- */

char *scene_json(const struct scene *scene) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return NULL;
  fputs("{\"engine\":", out);
  text_json_string(scene->kind->name, out);
  fputs(",\"name\":", out);
  text_json_string(scene->name, out);
  fputc(',', out);
  field_json_members(scene->kind->inputs, scene->inputs, out);
  fputc('}', out);
  return text_close(out, &text);
}

void scene_schema(const struct engine_kind *kind, FILE *out) {
  char title[128], extra[1024];
  snprintf(title, sizeof title, "A scene of clast's engine %s", kind->name);
  snprintf(extra, sizeof extra,
           "\"engine\": {\"const\": \"%s\", \"description\": \"Which engine runs the scene.\"},\n"
           "    \"name\": {\"type\": [\"string\", \"number\", \"boolean\"], \"maxLength\": %d, \"description\": \"The "
           "scene's name.\"},\n"
           "    \"source\": {\"type\": [\"string\", \"number\", \"boolean\"], \"maxLength\": %d, \"description\": "
           "\"Where it comes from: "
           "paper, section, figure.\"},\n"
           "    \"settings\": {\"type\": \"object\", \"description\": \"Named settings: inputs and their values for "
           "each name, such as draft: {fidelity.particles: 3000}. SCENE@draft runs the scene with them.\", "
           "\"additionalProperties\": {\"type\": \"object\"}}",
           kind->name, FIELD_TEXT_SIZE - 1, FIELD_TEXT_SIZE - 1);
  json_schema_write(kind->inputs, title, extra, "engine", out);
}

void scene_identity(const struct scene *scene, uint64_t seed, uint8_t identity[16]) {
  char *inputs = field_identity(scene->kind->inputs, scene->inputs), *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    memory_refused(); /* a store must not get another identity */
  fprintf(out, "engine=%s\nresults_version=%d\nseed=%llu\n%s", scene->kind->name, scene->kind->results_version,
          (unsigned long long)seed, inputs);
  if (!text_close(out, &text))
    memory_refused();
  blake2s(text, size, identity);
  free(text);
  free(inputs);
}
