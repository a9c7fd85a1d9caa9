/* The documents of engine/<engine>/scenes/ as text, written by engine/embed_scenes.cmake at build time. */
#ifndef CLAST_ENGINE_SCENE_BUILTIN_H
#define CLAST_ENGINE_SCENE_BUILTIN_H

struct scene_builtin {
  const char *name, *text;
};
extern const struct scene_builtin scene_builtin_list[]; /* sorted by name, closed by NULL */

#endif
