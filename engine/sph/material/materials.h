/* Named materials: documents with their sources, kept in engine/sph/material/builtin/ and compiled into the program. A
 * scene selects one by name (target.material.name), and its values become the defaults of that body's material inputs.
 */
#ifndef CLAST_ENGINE_SPH_MATERIAL_MATERIALS_H
#define CLAST_ENGINE_SPH_MATERIAL_MATERIALS_H

#include "engine/engine.h"
#include "engine/sph/material/material.h"

extern const struct field_table sph_materials_nested; /* describes struct sph_material; a body of a scene contains it */
extern struct field_table sph_materials_table;        /* the same, flat; constant once main() begins */
extern const struct engine_materials sph_materials;   /* the functions below, for `clast materials` */

/* The row of a member of struct sph_material, by its offset. */
size_t sph_materials_row(size_t offset);
size_t sph_materials_count(void);
const char *sph_materials_name(size_t index);     /* sorted; NULL beyond the last */
const char *sph_materials_text(const char *name); /* the document, or NULL */
/* STATUS_MISSING with the nearest name; STATUS_CONTENT with the report when the document has a fault. */
status sph_materials_load(const char *name, struct sph_material *out, struct error *error);
/* The same from the text of a document. */
status sph_materials_parse(const char *name, const char *text, struct sph_material *out, struct error *error);

/* The same from a file. *text is its content (malloc'd, owned by the caller). Also returns the errors of document_open.
 */
status sph_materials_open(const char *path, struct sph_material *out, char **text, struct error *error);
/* Where a value of a named material comes from, by the document's `sources` (the value's or its section's), else its
 * `source`. STATUS_MISSING: the document does not say. */
status sph_materials_source(const char *name, const char *path, char source[FIELD_TEXT_SIZE]);

#endif
