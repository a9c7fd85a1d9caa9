/* Named settings of a scene: numerical choices that belong together, such as those of a quick draft. A document gives
 * them under `settings`:
 *     settings:
 *       draft: {fidelity.particles: 3000, fidelity.precision: float}
 *       reference: {fidelity.particles: 90000}
 * `NAME@draft` is the scene NAME with the settings draft. The scene as written is called standard. */
#ifndef CLAST_ENGINE_SCENE_SETTINGS_H
#define CLAST_ENGINE_SCENE_SETTINGS_H

#include "engine/scene.h"
#include "schemas/document.h"

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

/* Reads the mapping `node` (NULL: there is none) into scene->settings. Errors are reported to the document. */
void scene_settings_read(document_node *node, struct scene *scene);

/* The settings of this name, or NULL. */
const struct scene_settings *scene_settings_find(const struct scene *scene, const char *name);

/* Applies settings, as if the document gave their inputs. "standard" changes nothing. STATUS_MISSING: unknown name; the
 * message lists the known ones. STATUS_CONTENT: the scene refuses a value. */
status scene_settings_use(struct scene *scene, const char *name, struct error *error);

#endif
