/* The ladder of a knob in a scene: its levels, coarse to fine, each as a scene that can be run. */
#pragma once

#include "engine/engine.h"
#include "engine/scene.h"

struct ladder_level {
  char setting[64];    /* value of the first input, in SI or by name */
  struct scene *scene; /* owned: the base scene with this level, checked */
  double step;         /* NaN: none */
  bool base, reference;
  bool unasked; /* the scene's own level of a knob of resolution that is not among the user's levels: it is not run, but
                   the law of the others tells its error */
};
struct ladder {
  const struct knob *knob;
  struct ladder_level level[KNOB_LEVELS]; /* coarse to fine */
  size_t count;
};

/* The levels of a knob in a scene. For the group `settings`: the scene as written and its named settings, sorted by
 * their work; the reference is the one named `reference`, or the last. Named settings that turn a knob of the group
 * `model` are levels only if the list names them. settings: NULL, or a comma-separated list of
 * values of the knob's first input, which replaces the ladder; the scene's own setting is then a level only if
 * it is among them. Levels that the scene refuses are left out and named in *notes (malloc'd lines, may become
 * NULL). STATUS_CONTENT: the knob does not apply to this scene, or fewer than two levels are left; *ladder is empty
 * then. STATUS_USAGE: a setting is no value of the input. */
status ladder_make(const struct knob *knob, const struct scene *base, const char *settings, struct ladder *ladder,
                   char **notes, struct error *error);
/* Adds the scene's own level to a ladder of resolution that lacks it and has room, as one that was not asked for. */
status ladder_add_own(struct ladder *ladder, const struct scene *base, struct error *error);
/* Sets all inputs of a knob in a scene, as the level `setting` of its ladder has them. STATUS_CONTENT when the knob
 * does not apply or the scene refuses the value, STATUS_USAGE when it is no value of the input. */
status ladder_turn(const struct knob *knob, struct scene *scene, const char *setting, struct error *error);
/* Does the scene have the spacing that its setting of the knob stands for, as far as other inputs do not bind it? */
bool ladder_is_kept(const struct knob *knob, const struct scene *scene);

/* The value of the knob's first input in a scene, as a level's setting. */
void ladder_setting(const struct knob *knob, const struct scene *scene, char *text, size_t size);

void ladder_clear(struct ladder *ladder);

/* Takes the next word from a comma-separated list. A longer one is cut. False: there is none. */
bool ladder_next_word(const char **list, char *word, size_t size);
