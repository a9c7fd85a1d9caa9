/* A scene: which engine, and its typed inputs. Built-in scenes are documents with their sources, kept in
 * engine/<engine>/scene/builtin/ and compiled into the program. `clast scenes NAME` prints one, as a start for a new
 * scene. */
#pragma once

#include "engine/engine.h"
#include "engine/mesh/mesh.h"

/* Named settings of a scene: numerical choices that belong together, such as those of a quick draft. A document gives
 * them under `settings`:
 *     settings:
 *       draft: {fidelity.particles: 3000, fidelity.precision: float}
 *       reference: {fidelity.particles: 90000}
 * `NAME@draft` is the scene NAME with the settings draft. The scene as written is called standard. */
#define SCENE_SETTINGS_STANDARD "standard"
enum { SCENE_SETTINGS_ITEMS = 12, SCENE_SETTINGS_MOST = 8, SCENE_SETTINGS_NAME = 32 };

struct scene_settings {
  char name[SCENE_SETTINGS_NAME];
  size_t count;
  struct {
    size_t row; /* index into the engine's inputs */
    struct field_value value;
  } item[SCENE_SETTINGS_ITEMS];
};

struct scene {
  const struct engine_kind *kind;
  void *inputs;               /* kind->inputs->size bytes, SI, defaults filled */
  bool *given;                /* per input row: set by the document or an override */
  bool *overridden;           /* per input row: set by an override */
  const char **replaced;      /* per input row: the document's material, where an override changed its name (static;
                                 "": no built-in one). NULL: unchanged */
  char name[FIELD_TEXT_SIZE]; /* built-in name, or the document's own `name:` */
  struct scene_settings *settings; /* owned; NULL: none */
  size_t settings_count;
};

size_t scene_builtin_count(void);
const char *scene_builtin_name(size_t index);
const char *scene_builtin_text(const char *name); /* the document, or NULL */

/* `reference` is a built-in name or a path (a path when it holds '/' or ends in .yaml/.yml/.json), relative to `folder`
 * (NULL: the current one). `@NAME` after it chooses named settings: basalt-sphere@draft.
 * *error lists all errors of the document.
 * STATUS_MISSING (with nearest built-in name), STATUS_CONTENT, STATUS_IO. */
status scene_load(const char *reference, const char *folder, struct scene **out, struct error *error);
status scene_parse(const char *name, const char *text, struct scene **out, struct error *error);
/* Reads JSON that scene_json wrote, as kept in stores. Its numbers are in SI units. */
status scene_parse_json(const char *name, const char *json, struct scene **out, struct error *error);
struct scene *scene_copy(const struct scene *scene);
void scene_free(struct scene *scene);
/* A scene that frees itself where its block is left: SCENE scene = NULL; */
#define SCENE __attribute__((cleanup(scene_drop))) struct scene *
void scene_drop(struct scene **scene); /* for SCENE */

/* Overrides one input by path or unique suffix, from text ("5 km/s") or as a value. Inputs that follow from it and were
 * not given are completed again. The name of a material, or of its file (relative to the current folder), replaces the
 * document's own material with all its values.
 * Conditions across fields are not checked. */
status scene_set_text(struct scene *scene, const char *path, const char *text, struct error *error);
status scene_set(struct scene *scene, const char *path, const struct field_value *value, struct error *error);
/* Adds to the document of a material what the key `like` names: a built-in material. False: an error is reported in the
 * document, also for a key of materials->not_values. */
bool scene_material_complete(document_node *root, const struct engine_materials *materials);
/* The settings of this name, or NULL. */
const struct scene_settings *scene_settings_find(const struct scene *scene, const char *name);
/* Applies settings, as if the document gave their inputs. "standard" changes nothing. STATUS_MISSING: unknown name; the
 * message lists the known ones. STATUS_CONTENT: the scene refuses a value. */
status scene_settings_use(struct scene *scene, const char *name, struct error *error);
/* Checks a scene after its last override. A line of the document that has no effect because of an override counts as
 * not given; an override without effect is refused; conditions across fields are checked. */
status scene_check(struct scene *scene, struct error *error);

/* Does the row's value follow from the other inputs (FIELD_DERIVED)? True when the scene completes to the same value
 * without it, whether or not it was given. */
bool scene_follows(const struct scene *scene, const struct field *row);

/* An input whose number the document gives for its own material, while an override names another one. */
struct scene_kept {
  const struct field *row, *name;      /* the input, and the name of the material */
  struct field_value number, material; /* of both */
  struct field_value without;          /* what the input would be without the document's number */
};
/* The next one behind kept->row (NULL: the first). Numbers that the new material would give, too, are left out. */
bool scene_next_kept(const struct scene *scene, struct scene_kept *kept);

/* Lists the shape files that active inputs name (FIELD_FILE) and returns their number. The inputs hold the SHA-256 of a
 * file's content, so a run's identity depends on the content. Files that were not read are left out. */
enum { SCENE_FILES_MOST = 4 }; /* inputs of one engine with FIELD_FILE */
size_t scene_files_of(const struct field_table *inputs, const void *object,
                      const struct mesh_file *files[SCENE_FILES_MOST]);

/* Path of the result that the scene is made for: M_1/M where bodies break. */
const char *scene_headline(const struct scene *scene);

/* JSON Schema of this engine's scene documents: what schemas/scene-<engine>.schema.json holds. */
void scene_schema(const struct engine_kind *kind, FILE *out);

char *scene_json(const struct scene *scene); /* resolved: engine, name and every active input; malloc'd */
/* 128-bit identity of a run: hash of engine, results_version, seed and sorted active inputs as %a, without those at
 * their value of absence (field.h, .absent). */
void scene_identity(const struct scene *scene, uint64_t seed, uint8_t identity[16]);
