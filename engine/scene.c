/* Scenes: built-in documents, reading, materials, files, settings, overrides, checks, identity. */
#include "engine/scene.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/blake2s.h"
#include "engine/builtin.h"
#include "schemas/file.h"
#include "schemas/json_schema.h"
#include "schemas/memory.h"

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
  return builtin_text(builtin_scene_list, name);
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

/* ---- materials by name or file ----
 *
 * Sections of a scene may come from a named document, by their input `name`. A scene gives such a section as a word, as
 * the name of a file, or by its values; all forms become one. `material: basalt` becomes {name: basalt}. `material:
 * ./my-rock.yaml`, or the key `file` in the section, becomes the content of the file, with the name my-rock.yaml; the
 * scene's own values take precedence. The key `like` of a file names the built-in document that gives what the file
 * lacks. */

enum { PATH_SIZE = 256 };

/* Keys of a material's document that are not values; and those of them that another document does not take over. */
static const char *const material_words[] = {"sources", "material", "source", "like", NULL};
static const char *const *const own_words = material_words + 1;

/* Does the input name a document? */
static bool is_open(const struct field *row) {
  return row->kind == FIELD_TEXT && row->choices;
}

static bool is_named(const struct field_table *inputs, const char *section, const char *key) {
  char path[PATH_SIZE + 64];
  snprintf(path, sizeof path, "%s.%s", section, key);
  for (size_t i = 0; i < inputs->count; i++)
    if (strcmp(inputs->rows[i].path, path) == 0)
      return is_open(&inputs->rows[i]);
  return false;
}

/* Where a section gives one of two names of a value, `base` does not add the other. */
static void drop_other_name(document_node *section, document_node *base, const struct engine_materials *materials) {
  for (int k = 0; k < 2 && materials->either[k]; k++) {
    const char *own = materials->either[k], *other = materials->either[1 - k];
    char head[PATH_SIZE];
    snprintf(head, sizeof head, "%.*s", (int)strcspn(own, "."), own);
    document_node *part = document_key(section, head), *of_base = document_key(base, head);
    if (part && of_base && document_key(part, strchr(own, '.') + 1))
      document_graft_drop(of_base, strchr(other, '.') + 1);
  }
}

static status take_like(document_node *root, document_node *node, const struct engine_materials *materials,
                        struct error *error) {
  const char *word = document_scalar(node), *text = word && *word ? materials->text(word) : NULL;
  OWNED void *unused = memory_small(1, materials->values->size);
  struct document *base = NULL;
  if (word && file_name_is_document(word))
    return status_fail(error, STATUS_CONTENT,
                       "only built-in materials can be named here, no files: `clast materials` lists them");
  if (!text)
    return word ? materials->load(word, unused, error)
                : status_fail(error, STATUS_CONTENT, "expected the name of a material, such as like: granite");
  TRY(document_parse(word, text, strlen(text), &base, error));
  (void)scene_material_complete(document_root(base), materials); /* it may be like another one */
  drop_other_name(root, document_root(base), materials);
  return document_graft(root, base, own_words) ? STATUS_OK
                                               : status_fail(error, STATUS_MEMORY, "no memory for a material");
}

/* Is it a value, or a section of values? */
static bool is_value(const struct engine_materials *materials, const char *path) {
  const size_t length = strlen(path);
  for (size_t i = 0; i < materials->values->count; i++) {
    const char *known = materials->values->rows[i].path;
    if (strncmp(known, path, length) == 0 && (known[length] == '.' || known[length] == '\0'))
      return true;
  }
  return false;
}

/* `sources`: a text for each value or section. */
static bool check_sources(document_node *sources, const struct engine_materials *materials) {
  bool good = !sources || document_kind(sources) == DOCUMENT_MAPPING;
  if (!good)
    document_report(sources, "sources",
                    "expected a source for each value, e.g. {density: weighed, weibull: our tests}");
  for (size_t i = 0; sources && i < document_count(sources); i++) {
    const char *key = NULL;
    document_node *node = document_item(sources, i, &key);
    const bool known = key && is_value(materials, key);
    good = good && known && document_scalar(node);
    if (!known)
      document_report(node, "sources", "'%.60s' is no value of a material; `clast explain target.material` lists them",
                      key ? key : "");
    else if (!document_scalar(node))
      document_report(node, "sources", "expected a text that says where the value comes from");
  }
  return good;
}

bool scene_material_complete(document_node *root, const struct engine_materials *materials) {
  document_node *like = document_key(root, "like");
  struct error error;
  const bool good = !like || take_like(root, like, materials, &error) == STATUS_OK;
  if (!good)
    document_report_error(like, "like", &error);
  for (const char *const *word = materials->not_values; word && *word; word++)
    if (document_key(root, *word)) {
      document_report(document_key(root, *word), NULL, "'%s' is no value of a material: %s", *word, materials->instead);
      return false;
    }
  return check_sources(document_key(root, "sources"), materials) && good;
}

/* What the input `name` gets: the file's own name, after the rock's, "weak sandstone - rock.yaml", if that is another
 * one and not that of a built-in material. The ending says that it is a document's. */
static void own_name(const char *file, struct document *document, const struct engine_materials *materials,
                     char name[FIELD_TEXT_SIZE]) {
  enum { LONGEST = 40 };
  const char *slash = strrchr(file, '/'), *base = slash ? slash + 1 : file;
  const size_t stem = strcspn(base, ".");
  document_node *node = document ? document_key(document_root(document), "material") : NULL;
  const char *rock = node ? document_scalar(node) : NULL;
  bool plain = rock && *rock && strlen(rock) <= LONGEST && !materials->text(rock) &&
               !(strlen(rock) == stem && strncmp(rock, base, stem) == 0);
  for (const char *c = rock; plain && *c; c++)
    plain = *c != '/' && (unsigned char)*c >= ' ' && *c != 127;
  snprintf(name, FIELD_TEXT_SIZE, "%s%s%s%s", plain ? rock : "", plain ? " - " : "", base,
           file_name_ends(base) ? "" : ".yaml"); /* that file is refused */
}

/* Has the file the keys of a material alone? Else reports all that is wrong with it. */
static bool check_keys(document_node *root, const struct engine_materials *materials) {
  OWNED void *unused = memory_small(1, materials->values->size);
  for (size_t i = 0; i < document_count(root); i++) {
    const char *key = NULL;
    document_item(root, i, &key);
    if (!key || (is_value(materials, key) && !strchr(key, '.')) || text_is_one_of(key, material_words))
      continue;
    field_defaults(materials->values, unused);
    return document_read(root, materials->values, material_words, unused);
  }
  return true;
}

/* Opens a material's file. On failure *out is NULL. */
static status open_material(const char *path, const struct engine_materials *materials, struct document **out,
                            struct error *error) {
  status code = document_open(path, out, error);
  if (code == STATUS_MISSING && strstr(path, " - ")) /* as own_name() writes it */
    text_append(error->message, sizeof error->message,
                ". Tables show a rock as its name - its file's name: give the file alone, with its folder");
  if (code == STATUS_OK && !file_name_ends(path)) { /* tables and stores know a rock of a file by the ending */
    document_free(*out);
    *out = NULL;
    return status_fail(error, STATUS_CONTENT,
                       "the name of a material's file ends in .yaml, .yml or .json: call it %s.yaml", path);
  }
  if (code != STATUS_OK ||
      (scene_material_complete(document_root(*out), materials) && check_keys(document_root(*out), materials)))
    return code;
  code = document_verdict(*out, error);
  document_free(*out);
  *out = NULL;
  return code;
}

/* `place`: where errors about the file are reported. */
static void include_material(document_node *section, document_node *place, const char *path, const char *file,
                             const struct engine_kind *kind, const char *folder) {
  struct document *other = NULL;
  struct error error;
  OWNED char *whole = file_name_in(folder, file);
  status code = whole ? open_material(whole, kind->materials, &other, &error)
                      : status_fail(&error, STATUS_MEMORY, "no memory for a path");
  char name[FIELD_TEXT_SIZE];
  own_name(file, other, kind->materials, name);
  if (code == STATUS_OK)
    drop_other_name(section, document_root(other), kind->materials);
  if (code == STATUS_OK && !document_graft(section, other, material_words))
    code = status_fail(&error, STATUS_MEMORY, "no memory for a material");
  document_graft_drop(section, "name");
  if (code != STATUS_OK)
    document_report_error(place, path, &error);
  if (!document_graft_word(section, "name", name))
    document_report_memory(place, path);
}

/* `material: {file: ./my-rock.yaml, ...}`; also under `name`, where a store keeps the file's own name without folder.
 */
static void take_section(document_node *section, const char *path, const struct engine_kind *kind, const char *folder) {
  document_node *file = document_key(section, "file"), *name = document_key(section, "name");
  document_node *from = file ? file : name;
  const char *word = from ? document_scalar(from) : NULL;
  if (!file && (!word || !strchr(word, '/')))
    return;
  if (!word || !*word) {
    document_report(file, path, "expected the name of a material's file, such as ./my-rock.yaml");
    return;
  }
  document_graft_drop(section, "file");
  include_material(section, from, path, word, kind, folder);
}

/* `material: basalt`, or `material: ./my-rock.yaml` */
static void take_word(document_node *node, const char *path, const struct engine_kind *kind, const char *folder) {
  const char *text = document_scalar(node);
  if (!text || !*text)
    return; /* the reader describes the error */
  char word[LIMITS_PATH];
  snprintf(word, sizeof word, "%s", text);
  if (file_name_is_document(word))
    include_material(node, node, path, word, kind, folder);
  else if (!document_graft_word(node, "name", word))
    document_report_memory(node, path);
}

/* `section`: its path, empty at the root. Files are relative to `folder` (NULL: the current one). */
static void take_materials(document_node *mapping, const struct engine_kind *kind, const char *section,
                           const char *folder) {
  for (size_t i = 0; i < document_count(mapping); i++) {
    const char *key = NULL;
    document_node *node = document_item(mapping, i, &key);
    char path[PATH_SIZE];
    if (!key || (size_t)snprintf(path, sizeof path, "%s%s%s", section, *section ? "." : "", key) >= sizeof path)
      continue;
    const bool is_material = is_named(kind->inputs, path, "name"), is_section = document_kind(node) == DOCUMENT_MAPPING;
    if (is_material && is_section)
      take_section(node, path, kind, folder);
    else if (is_material)
      take_word(node, path, kind, folder);
    else if (is_section)
      take_materials(node, kind, path, folder);
  }
}

/* ---- inputs that name shape files ---- */

static bool is_hash(const char *text) {
  return strlen(text) == MESH_HASH_SIZE - 1 && strspn(text, "0123456789abcdef") == MESH_HASH_SIZE - 1;
}

static status find_file(const char *text, const char *folder, const struct mesh_file **file, struct error *error) {
  *file = mesh_files_find(text);
  if (*file)
    return STATUS_OK;
  const status code = mesh_files_open(text, folder, file, error);
  if (code == STATUS_MISSING && is_hash(text))
    return status_fail(error, STATUS_MISSING,
                       "this is the SHA-256 of a shape file that is not here: give the name of the file");
  return code;
}

static void take_file(document_node *section, document_node *node, const char *key, const char *path,
                      const char *folder) {
  const char *text = document_scalar(node);
  const struct mesh_file *file = NULL;
  struct error error;
  if (!text || !*text) {
    document_report(node, path, "expected the name of a shape file, such as ./bennu.obj");
    return;
  }
  if (find_file(text, folder, &file, &error)) {
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

/* Puts the SHA-256 of the files that a document names in place of the names. A value that is already the SHA-256 of a
 * file read before does not change (scenes of a store). */
static void take_files(document_node *root, const struct field_table *inputs, const char *folder) {
  for (size_t i = 0; i < inputs->count && document_kind(root) == DOCUMENT_MAPPING; i++) {
    const char *key = NULL, *path = inputs->rows[i].path;
    document_node *section = inputs->rows[i].flags & FIELD_FILE ? section_of(root, path, &key) : NULL;
    document_node *node = section ? document_key(section, key) : NULL;
    if (node)
      take_file(section, node, key, path, folder);
  }
}

/* The same for one value, of --set. STATUS_MISSING, STATUS_IO, STATUS_CONTENT. */
static status set_file(const struct field *row, struct field_value *value, struct error *error) {
  const struct mesh_file *file = NULL;
  struct error why;
  if (!(row->flags & FIELD_FILE))
    return STATUS_OK;
  const status code = find_file(value->text, NULL, &file, &why);
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

/* ---- named settings ---- */

static bool is_settings_name(const char *name) {
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

static void read_setting(document_node *node, const char *name, const struct field_table *inputs,
                         struct scene_settings *settings) {
  if (!name || !is_settings_name(name)) {
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

/* Reads the mapping `node` (NULL: there is none) into scene->settings. Errors are reported to the document. */
static void read_settings(document_node *node, struct scene *scene) {
  if (!node)
    return;
  if (document_kind(node) != DOCUMENT_MAPPING || document_count(node) > SCENE_SETTINGS_MOST) {
    document_report(node, "settings", "expected at most %d names with their inputs, such as draft: {...}",
                    SCENE_SETTINGS_MOST);
    return;
  }
  scene->settings_count = document_count(node);
  scene->settings = memory_small(scene->settings_count, sizeof *scene->settings);
  for (size_t i = 0; i < scene->settings_count; i++) {
    const char *name = NULL;
    document_node *item = document_item(node, i, &name);
    read_setting(item, name, scene->kind->inputs, &scene->settings[i]);
  }
}

/* ---- reading ---- */

static const char *const own_keys[] = {"engine", "name", "source", "settings", NULL};
static const char *const own_keys_defined[] = {"engine", "name", "source", "settings", "command", NULL};

static const struct field name_row = {.path = "name", .kind = FIELD_TEXT, .doc = "The scene's name"};
static const struct field source_row = {.path = "source",
                                        .kind = FIELD_TEXT,
                                        .doc = "Where it comes from: paper, section, figure"};

static struct scene *create(const struct engine_kind *kind) {
  struct scene *scene = memory_small(1, sizeof *scene);
  scene->kind = kind;
  scene->inputs = memory_small(1, kind->inputs->size);
  scene->given = memory_small(kind->inputs->count, sizeof *scene->given);
  scene->overridden = memory_small(kind->inputs->count, sizeof *scene->overridden);
  scene->replaced = memory_small(kind->inputs->count, sizeof *scene->replaced);
  field_defaults(kind->inputs, scene->inputs);
  return scene;
}

/* The engine that a document names; NULL: an error was reported. */
static const struct engine_kind *read_engine(document_node *root) {
  document_node *engine = document_key(root, "engine");
  if (!engine) {
    document_node *scene = document_key(root, "scene");
    char word[TEXT_WORD];
    if (scene && document_scalar(scene))
      document_report(
          root, "engine",
          "is missing: this looks like a campaign of the scene %.60s. `clast explain %.80s` explains the scene, "
          "`clast plan FILE` tells what the campaign runs",
          document_scalar(scene), text_word(document_scalar(scene), word));
    else
      document_report(root, "engine",
                      document_key(root, "material") || document_key(root, "like")
                          ? "is missing: this looks like the file of a material; `clast materials FILE` "
                            "checks it, and a scene names it, such as target.material: ./FILE"
                          : "is missing; say which engine runs this scene, such as 'engine: dem'");
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
static void read_scene(document_node *root, const char *folder, const char *fallback, struct scene **out) {
  struct field_value name;
  const struct engine_kind *kind = read_engine(root);
  read_name(root, fallback, &name);
  const bool defined = kind && kind->of_scene;
  if (defined)
    kind = kind->of_scene(root, folder);
  if (!kind)
    return;
  struct scene *scene = *out = create(kind);
  take_materials(root, kind, "", folder);
  take_files(root, kind->inputs, folder);
  document_read_given(root, kind->inputs, defined ? own_keys_defined : own_keys, scene->inputs, scene->given,
                      kind->complete);
  snprintf(scene->name, sizeof scene->name, "%s", name.text);
  read_settings(document_key(root, "settings"), scene);
}

static status read_document(struct document *document, const char *folder, const char *fallback, struct scene **out,
                            struct error *error) {
  read_scene(document_root(document), folder, fallback, out);
  const status code = document_verdict(document, error);
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
  OWNED char *folder = strndup(path, slash == path ? 1 : length); /* "/" for "/scene.yaml" */
  OWNED char *stem = strdup(slash ? slash + 1 : path);
  DOCUMENT document = NULL;
  if (!folder || !stem)
    return status_fail(error, STATUS_MEMORY, "no memory for a path");
  char *dot = strrchr(stem, '.');
  if (dot && dot != stem)
    *dot = 0;
  TRY(document_open(path, &document, error));
  return read_document(document, folder, stem, out, error);
}

static status load_standard(const char *reference, const char *folder, struct scene **out, struct error *error) {
  *out = NULL;
  if (!file_name_is_document(reference)) {
    const char *text = scene_builtin_text(reference);
    return text ? scene_parse(reference, text, out, error) : unknown_builtin(reference, error);
  }
  OWNED char *path = file_name_in(folder, reference);
  return path ? load_file(path, out, error) : status_fail(error, STATUS_MEMORY, "no memory for a path");
}

status scene_load(const char *reference, const char *folder, struct scene **out, struct error *error) {
  const char *at = strrchr(reference, '@');
  if (!at || strchr(at, '/'))
    return load_standard(reference, folder, out, error);

  OWNED char *standard = strndup(reference, (size_t)(at - reference));
  if (!standard)
    return status_fail(error, STATUS_MEMORY, "no memory for a path");
  TRY(load_standard(standard, folder, out, error));
  const status code = scene_settings_use(*out, at + 1, error);
  if (code != STATUS_OK) {
    scene_free(*out);
    *out = NULL;
  }
  return code;
}

status scene_parse(const char *name, const char *text, struct scene **out, struct error *error) {
  *out = NULL;
  DOCUMENT document = NULL;
  TRY(document_parse(name, text, strlen(text), &document, error));
  return read_document(document, NULL, name, out, error);
}

status scene_parse_json(const char *name, const char *json, struct scene **out, struct error *error) {
  *out = NULL;
  DOCUMENT document = NULL;
  TRY(document_parse(name, json, strlen(json), &document, error));
  document_take_si(document);
  return read_document(document, NULL, name, out, error);
}

struct scene *scene_copy(const struct scene *scene) {
  struct scene *copy = create(scene->kind);
  memcpy(copy->inputs, scene->inputs, scene->kind->inputs->size);
  memcpy(copy->given, scene->given, scene->kind->inputs->count * sizeof *scene->given);
  memcpy(copy->overridden, scene->overridden, scene->kind->inputs->count * sizeof *scene->overridden);
  memcpy(copy->replaced, scene->replaced, scene->kind->inputs->count * sizeof *scene->replaced);
  memcpy(copy->name, scene->name, sizeof copy->name);
  if (scene->settings_count == 0)
    return copy;
  copy->settings_count = scene->settings_count;
  copy->settings = memory_small(copy->settings_count, sizeof *copy->settings);
  memcpy(copy->settings, scene->settings, copy->settings_count * sizeof *copy->settings);
  return copy;
}

void scene_free(struct scene *scene) {
  if (!scene)
    return;
  free(scene->inputs);
  free(scene->given);
  free(scene->overridden);
  free(scene->replaced);
  free(scene->settings);
  free(scene);
}

void scene_drop(struct scene **scene) {
  scene_free(*scene);
}

/* ---- overrides ---- */

/* The document of a scene that has only this section, by its file: {"target": {"material": "./my-rock.yaml"}}. NULL: no
 * memory. */
static char *section_document(const char *path, const char *file) {
  char *text = NULL;
  size_t depth = 1;
  FILE *out = text_open(&text);
  fputs("{\"", out);
  for (const char *last = strrchr(path, '.'); path < last; path++) {
    depth += *path == '.';
    *path == '.' ? fputs("\": {\"", out) : fputc(*path, out);
  }
  fputs("\": ", out);
  text_json_string(file, out);
  while (depth-- > 0)
    fputc('}', out);
  return text_close(out, &text);
}

/* The row of the other name of a material's value; NULL: it has one name. */
static const struct field *other_name(const struct engine_kind *kind, const struct field *row) {
  for (int k = 0; k < 2 && kind->materials && kind->materials->either[k]; k++) {
    const size_t length = strlen(row->path), tail = strlen(kind->materials->either[k]);
    char path[FIELD_TEXT_SIZE];
    if (length <= tail || strcmp(row->path + length - tail, kind->materials->either[k]) != 0)
      continue;
    snprintf(path, sizeof path, "%.*s%s", (int)(length - tail), row->path, kind->materials->either[1 - k]);
    return field_find(kind->inputs, path, NULL);
  }
  return NULL;
}

/* Takes the values of a user's material, except those that overrides gave. */
static status take_own(struct scene *scene, const struct field *row, const char *file, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  OWNED char *text = section_document(row->path, file);
  SCENE own = NULL;
  DOCUMENT alone = NULL;
  DOCUMENT document = NULL;
  TRY(open_material(file, scene->kind->materials, &alone, error)); /* a message about the file alone */
  if (!text)
    return status_fail(error, STATUS_MEMORY, "no memory for a material");
  own = create(scene->kind);
  TRY(document_parse(row->path, text, strlen(text), &document, error));
  take_materials(document_root(document), scene->kind, "", NULL);
  document_read_given(document_root(document), table, NULL, own->inputs, own->given, scene->kind->complete);
  TRY(document_verdict(document, error));
  for (size_t i = 0; i < table->count; i++) {
    struct field_value value;
    const struct field *other = other_name(scene->kind, &table->rows[i]);
    if (!own->given[i] || (scene->overridden[i] && &table->rows[i] != row) ||
        (other && scene->overridden[other - table->rows]))
      continue;
    field_get(&table->rows[i], own->inputs, &value);
    field_set_unchecked(&table->rows[i], scene->inputs, &value);
    scene->given[i] = true;
  }
  return STATUS_OK;
}

/* Another material in place of the user's own one: all values of that one go, also those from its file. Values that
 * overrides gave stay. `before`: the value of `row` before it was set. */
static status change_material(struct scene *scene, const struct field *row, const struct field_value *before,
                              const char *now, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  const size_t section = (size_t)(strrchr(row->path, '.') + 1 - row->path);
  const bool own = !field_is_choice(row, before->text) || strcmp(before->text, "custom") == 0;
  for (size_t i = 0; own && i < table->count; i++)
    if (!scene->overridden[i] && strncmp(table->rows[i].path, row->path, section) == 0)
      scene->given[i] = false;
  return field_is_choice(row, now) ? STATUS_OK : take_own(scene, row, now, error);
}

/* The row's own text of a choice; "": it is none. */
static const char *built_in(const struct field *row, const char *text) {
  const char *const *choice = row->choices;
  while (*choice && strcmp(*choice, text) != 0)
    choice++;
  return *choice ? *choice : "";
}

status scene_set(struct scene *scene, const char *path, const struct field_value *value, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  const struct field *row = field_find_in(table, path, scene->inputs, error);
  if (!row)
    return STATUS_CONTENT;
  struct field_value taken = *value, before;
  TRY(set_file(row, &taken, error));
  field_get(row, scene->inputs, &before);
  struct document *refused; /* the file is missing, or its name has no ending */
  if (is_open(row) && strchr(value->text, '/') && !file_name_ends(value->text))
    return open_material(value->text, scene->kind->materials, &refused, error);
  if (is_open(row))
    field_copy_text(taken.text, strrchr(value->text, '/') ? strrchr(value->text, '/') + 1 : value->text);
  TRY(field_set(row, scene->inputs, &taken, error));
  scene->overridden[row - table->rows] = true;
  if (is_open(row) && strcmp(before.text, value->text) != 0) {
    if (!scene->replaced[row - table->rows])
      scene->replaced[row - table->rows] = built_in(row, before.text);
    TRY(change_material(scene, row, &before, value->text, error));
  }
  scene->given[row - table->rows] = true;
  const struct field *other = other_name(scene->kind, row);
  if (other && !scene->overridden[other - table->rows])
    scene->given[other - table->rows] = false;
  if (scene->kind->complete)
    scene->kind->complete(scene->inputs, scene->given);
  return STATUS_OK;
}

status scene_set_text(struct scene *scene, const char *path, const char *text, struct error *error) {
  struct field_value value;
  const struct field *row = field_find_in(scene->kind->inputs, path, scene->inputs, error);
  if (!row)
    return STATUS_CONTENT;
  TRY(field_parse(row, text, &value, error));
  return scene_set(scene, row->path, &value, error);
}

/* Resets a row to its default when an override makes its line in the document ineffective. */
static void set_back(struct scene *scene, size_t row) {
  const struct field_table *table = scene->kind->inputs;
  OWNED void *untouched = memory_small(1, table->size);
  struct field_value value;
  field_defaults(table, untouched);
  field_get(&table->rows[row], untouched, &value);
  field_set_unchecked(&table->rows[row], scene->inputs, &value);
  scene->given[row] = false;
  if (scene->kind->complete)
    scene->kind->complete(scene->inputs, scene->given);
}

bool scene_follows(const struct scene *scene, const struct field *row) {
  if (!(row->flags & FIELD_DERIVED))
    return false;
  struct field_value value, completed;
  SCENE without = scene_copy(scene);
  set_back(without, (size_t)(row - scene->kind->inputs->rows));
  field_get(row, scene->inputs, &value);
  field_get(row, without->inputs, &completed);
  return field_same_value(row, &value, &completed);
}

/* With which lines an inactive input would have an effect, where its condition is a choice that needs more: the choice,
 * and the numbers that are then missing. Else empty. */
static void tell_needed(const struct scene *scene, const struct field *row, char *text, size_t size) {
  const struct field_table *table = scene->kind->inputs;
  const struct field *other = NULL, *link = field_unmet(table, row, scene->inputs, &other);
  struct field_value choice;
  struct error refused;
  char missing[400] = "";
  *text = 0;
  if (!link || !other || other->kind != FIELD_CHOICE)
    return;
  SCENE with = scene_copy(scene);
  snprintf(choice.text, sizeof choice.text, "%.*s", (int)strcspn(strchr(link->when, '=') + 1, "|"),
           strchr(link->when, '=') + 1);
  if (scene_set_text(with, other->path, choice.text, &refused))
    return;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *needed = &table->rows[i];
    struct field_value value;
    field_get(needed, with->inputs, &value);
    if (needed->kind == FIELD_REAL && isnan(value.number) && !(needed->flags & FIELD_MAY_BE_OFF) &&
        field_is_active(table, needed, with->inputs) && !field_is_active(table, needed, scene->inputs))
      text_append(missing, sizeof missing, "%s%s (%s)", *missing ? ", " : "", needed->path, needed->unit);
  }
  if (*missing)
    text_append(text, size, "remove it, or set %s: %s and give %s (clast explain %s)", other->path, choice.text,
                missing, other->path);
}

/* The name of the material that an override replaced and of which the row is a property; NULL: none. The file of a
 * material gives all of its own. */
static const struct field *replaced_name(const struct scene *scene, const struct field *row) {
  const struct field_table *table = scene->kind->inputs;
  const struct engine_materials *materials = scene->kind->materials;
  for (size_t i = 0; materials && i < table->count; i++) {
    const struct field *name = &table->rows[i];
    struct field_value value;
    if (!scene->replaced[i])
      continue;
    field_get(name, scene->inputs, &value);
    if (strcmp(scene->replaced[i], value.text) == 0)
      continue; /* back to that of the document */
    const size_t section = (size_t)(strrchr(name->path, '.') + 1 - name->path);
    if (strncmp(row->path, name->path, section) == 0 && field_is_choice(name, value.text))
      return name;
    for (size_t k = 0; materials->beside && materials->beside[k][0]; k++)
      if (strcmp(row->path, materials->beside[k][0]) == 0 && strcmp(name->path, materials->beside[k][1]) == 0)
        return name;
  }
  return NULL;
}

bool scene_next_kept(const struct scene *scene, struct scene_kept *kept) {
  const struct field_table *table = scene->kind->inputs;
  for (size_t i = kept->row ? (size_t)(kept->row - table->rows) + 1 : 0; i < table->count; i++) {
    const struct field *row = kept->row = &table->rows[i];
    kept->name = row->kind == FIELD_REAL && scene->given[i] && !scene->overridden[i] ? replaced_name(scene, row) : NULL;
    if (!kept->name || !field_is_active(table, row, scene->inputs))
      continue;
    SCENE without = scene_copy(scene);
    set_back(without, i);
    field_get(row, scene->inputs, &kept->number);
    field_get(row, without->inputs, &kept->without);
    field_get(kept->name, scene->inputs, &kept->material);
    if (!isnan(kept->number.number) && !field_same_value(row, &kept->number, &kept->without))
      return true;
  }
  return false;
}

status scene_check(struct scene *scene, struct error *error) {
  const struct field_table *table = scene->kind->inputs;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    if (field_is_active(table, row, scene->inputs)) {
      if (row->flags & FIELD_REQUIRED && !scene->given[i])
        return status_fail(error, STATUS_CONTENT, "%s: is missing and has no default; %s", row->path, row->doc);
    } else if (scene->overridden[i]) {
      char why[600], needed[600];
      field_describe_inactive(table, row, scene->inputs, why, sizeof why);
      tell_needed(scene, row, needed, sizeof needed);
      return status_fail(error, STATUS_CONTENT, "%s: has no effect: it is %s; %s", row->path, why,
                         *needed ? needed : "remove one or change the other");
    } else if (scene->given[i]) {
      set_back(scene, i);
    }
  }
  if (scene->kind->check_given)
    TRY(scene->kind->check_given(scene->inputs, scene->given, error));
  return scene->kind->check ? scene->kind->check(scene->inputs, error) : STATUS_OK;
}

/* ---- using named settings ---- */

const struct scene_settings *scene_settings_find(const struct scene *scene, const char *name) {
  for (size_t i = 0; i < scene->settings_count; i++)
    if (strcmp(scene->settings[i].name, name) == 0)
      return &scene->settings[i];
  return NULL;
}

status scene_settings_use(struct scene *scene, const char *name, struct error *error) {
  if (strcmp(name, SCENE_SETTINGS_STANDARD) == 0)
    return STATUS_OK;
  const struct scene_settings *settings = scene_settings_find(scene, name);
  if (!settings) {
    char known[512] = SCENE_SETTINGS_STANDARD;
    for (size_t i = 0; i < scene->settings_count; i++)
      text_append(known, sizeof known, ", %s", scene->settings[i].name);
    return status_fail(error, STATUS_MISSING, "%s has no settings '%.64s'; it has %s (`settings` in its document)",
                       scene->name, name, known);
  }
  status code = STATUS_OK;
  for (size_t i = 0; code == STATUS_OK && i < settings->count; i++) {
    const size_t row = settings->item[i].row;
    const bool overridden = scene->overridden[row];
    code = scene_set(scene, scene->kind->inputs->rows[row].path, &settings->item[i].value, error);
    scene->overridden[row] = overridden;
  }
  return code;
}

/* ---- output ---- */

char *scene_json(const struct scene *scene) {
  char *text = NULL;
  FILE *out = text_open(&text);
  fputs("{\"engine\":", out);
  text_json_string(scene->kind->name, out);
  fputs(",\"name\":", out);
  text_json_string(scene->name, out);
  if (scene->kind->definition)
    fprintf(out, ",%s", scene->kind->definition);
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
  if (kind->of_scene) /* the other keys are the inputs that its section names */
    fprintf(out,
            "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": \"%s\",\n  \"type\": "
            "\"object\",\n  \"required\": [\"engine\", \"command\"],\n  \"properties\": {\n    %s,\n    \"command\": "
            "{\"type\": \"object\", \"required\": [\"program\", \"version\"]}\n  }\n}\n",
            title, extra);
  else
    json_schema_write(kind->inputs, title, extra, "engine", out);
}

void scene_identity(const struct scene *scene, uint64_t seed, uint8_t identity[16]) {
  char *inputs = field_identity(scene->kind->inputs, scene->inputs), *text = NULL;
  size_t size = 0;
  FILE *out = text_open_sized(&text, &size); /* small: a store must not get another identity where memory is refused */
  fprintf(out, "engine=%s\nresults_version=%d\nseed=%llu\n%s", scene->kind->name, scene->kind->results_version,
          (unsigned long long)seed, inputs);
  text_close_small(out, &text);
  blake2s(text, size, identity);
  free(text);
  free(inputs);
}

const char *scene_headline(const struct scene *scene) {
  const char *path = scene->kind->headline ? scene->kind->headline(scene->inputs) : NULL;
  return path ? path : OUTCOME_DEFAULT;
}
