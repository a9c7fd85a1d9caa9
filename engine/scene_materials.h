/* Sections of a scene that are named things, such as materials: a section with an input `name` among named documents,
 * `custom` the last of them. A scene may give such a section as a word, as the name of a file, or in place. */
#ifndef CLAST_ENGINE_SCENE_MATERIALS_H
#define CLAST_ENGINE_SCENE_MATERIALS_H

#include "schemas/document.h"

/* Brings all forms into one: `material: basalt` becomes {name: basalt}; `material: ./my-rock.yaml`, or the key `file`
 * in the section, becomes what the file holds, with name custom; what the scene gives itself counts more. Files are
 * relative to `folder` (NULL: the current one). Call it before the document is read; errors go into its report. */
void scene_materials_take(document_node *root, const struct field_table *inputs, const char *folder);

/* Keys of a material's document that are no values: material, source, sources. NULL ends them. */
extern const char *const scene_materials_words[];

#endif
