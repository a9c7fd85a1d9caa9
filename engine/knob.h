/* Knobs: inputs that make a run coarser or finer, or change the physics that it models. knob.c is the only list: the
 * inputs of a knob, its levels, its engine and its meaning. Convergence studies (campaign/converge) vary knobs. */
#ifndef CLAST_ENGINE_KNOB_H
#define CLAST_ENGINE_KNOB_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum { KNOB_INPUTS = 3, KNOB_LEVELS = 12, KNOB_MOST = 64 /* in the list */ };

enum knob_group {
  KNOB_RESOLUTION, /* its finest level is the reference; its bias is part of the resolution error */
  KNOB_PART,       /* the same, but part of another knob, whose error includes it */
  KNOB_MODEL,      /* choice of physics, compared with the scene's own choice */
  KNOB_SETTINGS,   /* named settings of the scene; they set several knobs. No inputs of its own */
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
  struct knob_input inputs[KNOB_INPUTS]; /* the first one names the levels; a NULL path ends the list */
  double factors[KNOB_LEVELS]; /* of numbers: each level divided by the scene's own value, coarse to fine; 0 ends the
                                  list */
  const char *choices[KNOB_LEVELS]; /* of choices and switches: levels, coarse to fine; NULL ends the list. The scene's
                                       own setting is also a level */
  double step_power; /* of numbers: value^step_power is the step size; it is smaller at finer levels. 0: no step size;
                        finer levels have larger values */
  bool pairs;        /* the same seed gives nearly the same run at all levels */
  const char *meaning;
};

size_t knob_count(void);
const struct knob *knob_at(size_t index);
size_t knob_index(const struct knob *knob); /* index of a knob in the list */
/* NULL + STATUS_USAGE with the known names of this engine. */
const struct knob *knob_find(const char *engine, const char *name, struct error *error);

#endif
