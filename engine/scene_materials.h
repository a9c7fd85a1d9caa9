/* Sections of a scene that may come from a named document, such as a material. Their input `name` is the name of a
 * document or `custom`. A scene gives such a section as a word, as the name of a file, or by its values. */
#ifndef CLAST_ENGINE_SCENE_MATERIALS_H
#define CLAST_ENGINE_SCENE_MATERIALS_H

#include "schemas/document.h"

/* Converts all forms into one. `material: basalt` becomes {name: basalt}. `material: ./my-rock.yaml`, or the key `file`
 * in the section, becomes the content of the file, with name custom; the scene's own values take precedence. Files are
 * relative to `folder` (NULL: the current one). Call it before the document is read; errors go into its report. */
void scene_materials_take(document_node *root, const struct field_table *inputs, const char *folder);

/* Keys of a material's document that are not values: material, source, sources. Ended by NULL. */
extern const char *const scene_materials_words[];

#endif
