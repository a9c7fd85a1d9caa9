/* Documents that are compiled into the program, written by engine/embed_documents.cmake at build time: the scenes of
 * engine/<engine>/scene/builtin/ and the materials of engine/<engine>/material/builtin/. */
#pragma once

#include <string.h>

struct builtin_document {
  const char *name, *text;
};
/* Sorted by name, ended by NULL. The names of materials are also a list of their own (choices of a field table), with
 * `custom` last. */
extern const struct builtin_document builtin_scene_list[], builtin_material_list[];
extern const char *const builtin_material_names[];

/* The text of a document of a list; NULL: it has none of this name. */
static inline const char *builtin_text(const struct builtin_document *list, const char *name) {
  while (list->name && strcmp(list->name, name) != 0)
    list++;
  return list->text;
}
