/* A scene: which engine, and its typed inputs. Built-in scenes are documents with their sources, kept in
 * engine/<engine>/scene/builtin/ and compiled into the program. `clast scenes NAME` prints one, as a start for a new
 * scene. */
#ifndef CLAST_ENGINE_SCENE_H
#define CLAST_ENGINE_SCENE_H

#include "engine/engine.h"

struct scene_settings;

struct scene {
  const struct engine_kind *kind;
  void *inputs;                    /* kind->inputs->size bytes, SI, defaults filled */
  bool *given;                     /* per input row: set by the document or an override */
  bool *overridden;                /* per input row: set by an override */
  char name[FIELD_TEXT_SIZE];      /* built-in name, or the document's own `name:` */
  struct scene_settings *settings; /* named settings (engine/scene_settings.h), owned; NULL: none */
  size_t settings_count;
};

size_t scene_builtin_count(void);
const char *scene_builtin_name(size_t index);
const char *scene_builtin_text(const char *name); /* the document, or NULL */

/* `reference` is a built-in name or a path (a path when it holds '/' or ends in .yaml/.yml/.json), relative to `folder`
 * (NULL: the current one). `@NAME` after it chooses named settings (engine/scene_settings.h): basalt-sphere@draft.
 * *error lists all errors of the document.
 * STATUS_MISSING (with nearest built-in name), STATUS_CONTENT, STATUS_IO. */
status scene_load(const char *reference, const char *folder, struct scene **out, struct error *error);
status scene_parse(const char *name, const char *text, struct scene **out, struct error *error);
/* Reads JSON that scene_json wrote, as kept in stores. Its numbers are in SI units. */
status scene_parse_json(const char *name, const char *json, struct scene **out, struct error *error);
struct scene *scene_copy(const struct scene *scene);
void scene_free(struct scene *scene);

/* Overrides one input by path or unique suffix, from text ("5 km/s") or as a value. Inputs that follow from it and were
 * not given are completed again. Conditions across fields are not checked. */
status scene_set_text(struct scene *scene, const char *path, const char *text, struct error *error);
status scene_set(struct scene *scene, const char *path, const struct field_value *value, struct error *error);
/* Checks a scene after its last override. A line of the document that has no effect because of an override counts as
 * not given; an override without effect is refused; conditions across fields are checked. */
status scene_check(struct scene *scene, struct error *error);

/* JSON Schema of this engine's scene documents: what schemas/scene-<engine>.schema.json holds. */
void scene_schema(const struct engine_kind *kind, FILE *out);

char *scene_json(const struct scene *scene); /* resolved: engine, name and every active input; malloc'd */
/* 128-bit identity of a run: hash of engine, results_version, sorted active inputs as %a, and seed. */
void scene_identity(const struct scene *scene, uint64_t seed, uint8_t identity[16]);

#endif
