/* Knobs: inputs that make a run coarser or finer, or change the physics that it models. Each engine lists its own
 * (engine_kind.knobs): inputs, levels and meaning. Convergence studies (campaign/converge) vary knobs. */
#ifndef CLAST_ENGINE_KNOB_H
#define CLAST_ENGINE_KNOB_H

#include <stdbool.h>

enum { KNOB_INPUTS = 3, KNOB_LEVELS = 12 };

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
  const char *name; /* NULL ends an engine's list */
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

/* Rows of an engine's list. Factors of particles and grains: a third of the number each, so that the spacing of an SPH
 * body changes by 1.44. Time steps: halves. */
#define KNOB(name_, group_, ...)                                                                                       \
  { .name = name_, .group = KNOB_##group_, __VA_ARGS__ }
#define KNOB_THIRDS .factors = {1.0 / 9, 1.0 / 3, 1, 3}
#define KNOB_HALVES .factors = {2, 1, 0.5, 0.25, 0.125}
#define KNOB_ON_OFF .choices = {"false", "true"}
#define KNOB_OF_SETTINGS                                                                                               \
  KNOB("settings", SETTINGS, .meaning = "named settings of the scene (`settings` in its document): draft, reference")

#endif
