/* Documents that are compiled into the program, written by engine/embed_documents.cmake at build time: the scenes of
 * engine/<engine>/scene/builtin/ and the materials of engine/<engine>/material/builtin/. */
#ifndef CLAST_ENGINE_BUILTIN_H
#define CLAST_ENGINE_BUILTIN_H

struct builtin_document {
  const char *name, *text;
};
/* Sorted by name, ended by NULL. The names of materials are also a list of their own (choices of a field table), with
 * `custom` last. */
extern const struct builtin_document builtin_scene_list[], builtin_material_list[];
extern const char *const builtin_material_names[];

#endif
