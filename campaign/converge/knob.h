/* Knobs: what a study of convergence makes coarser and finer. The list in knob.c is the only one: the inputs of a knob,
 * its ladder of levels, the engine, what it means. */
#ifndef CLAST_CAMPAIGN_CONVERGE_KNOB_H
#define CLAST_CAMPAIGN_CONVERGE_KNOB_H

#include "engine/scene.h"

enum { KNOB_INPUTS = 3, KNOB_LEVELS = 12 };

enum knob_group {
  KNOB_RESOLUTION, /* has a best end, which is the reference: its bias is part of the error of resolution */
  KNOB_PART,       /* the same, but a part of another knob, whose error has it already */
  KNOB_MODEL,      /* what is modelled: compared with the scene's own choice */
};
extern const char *const knob_group_names[]; /* "resolution", "part", "model" */

struct knob_input {
  const char *path;
  double power; /* a level of f times the scene's first input sets this one to f^power times its own value */
};

struct knob {
  const char *name, *engine;
  enum knob_group group;
  struct knob_input inputs[KNOB_INPUTS]; /* the first one names the levels; path NULL: no more */
  double factors[KNOB_LEVELS];           /* of numbers: levels over the scene's own value, coarse to fine; 0: no more */
  const char *choices[KNOB_LEVELS]; /* of choices and switches: levels, coarse to fine; NULL: no more. The scene's own
                                       setting is a level, too */
  double step_power; /* of numbers: value^step_power is the step, which falls as the level gets finer. 0: no step;
                        finer is larger */
  bool pairs;        /* the same seed gives nearly the same run at all levels */
  const char *meaning;
};

size_t knob_count(void);
const struct knob *knob_at(size_t index);
/* NULL + STATUS_USAGE with the known names of this engine. */
const struct knob *knob_find(const char *engine, const char *name, struct error *error);

struct knob_level {
  char setting[64];    /* value of the first input, in SI or by name */
  struct scene *scene; /* owned: the base scene with this level, checked */
  double step;         /* NaN: none */
  bool base, reference;
};
struct knob_ladder {
  const struct knob *knob;
  struct knob_level level[KNOB_LEVELS]; /* coarse to fine */
  size_t count;
};

/* The levels of a knob in a scene. settings: NULL, or a comma-separated list of values of the knob's first input, which
 * replaces the ladder; the scene's own setting is then a level only if it is among them. Levels that the scene refuses
 * are left out and said in *notes (malloc'd lines, may become NULL). STATUS_CONTENT: the knob does not apply to this
 * scene, or fewer than two levels are left; *ladder is empty then. STATUS_USAGE: a setting is no value of the input. */
status knob_ladder_make(const struct knob *knob, const struct scene *base, const char *settings,
                        struct knob_ladder *ladder, char **notes, struct error *error);
void knob_ladder_clear(struct knob_ladder *ladder);

#endif
