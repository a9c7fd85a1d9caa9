/* Knobs: inputs that make a run coarser or finer, or model more or less. The list in knob.c is the only one: the inputs
 * of a knob, its ladder of levels, the engine, what it means. Studies of convergence (campaign/converge) turn them. */
#ifndef CLAST_ENGINE_KNOB_H
#define CLAST_ENGINE_KNOB_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum { KNOB_INPUTS = 3, KNOB_LEVELS = 12, KNOB_MOST = 64 /* in the list */ };

enum knob_group {
  KNOB_RESOLUTION, /* has a best end, which is the reference: its bias is part of the error of resolution */
  KNOB_PART,       /* the same, but a part of another knob, whose error has it already */
  KNOB_MODEL,      /* what is modelled: compared with the scene's own choice */
  KNOB_SETTINGS,   /* named settings of the scene, which turn several knobs at once; has no inputs of its own */
  KNOB_GROUPS
};
extern const char *const knob_group_names[]; /* "resolution", "part", "model", "settings" */

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
size_t knob_index(const struct knob *knob); /* of a knob of the list */
/* NULL + STATUS_USAGE with the known names of this engine. */
const struct knob *knob_find(const char *engine, const char *name, struct error *error);

#endif
