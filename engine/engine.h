/* An engine is a descriptor: scene in, result out, no MPI, no SQLite, no printing, no exit().
 *
 * A run is a pure function of (typed inputs, seed, results_version): the same bits on any rank, in any order. */
#pragma once

#include "engine/condition.h"
#include "engine/ejecta.h"
#include "schemas/document.h"

/* Knobs: inputs that make a run coarser or finer, or change the physics that it models. Each engine lists its own
 * (engine_kind.knobs): inputs, levels and meaning. Convergence studies (campaign/converge) vary knobs. */
enum { KNOB_INPUTS = 4, KNOB_LEVELS = 12 };

enum knob_group {
  KNOB_RESOLUTION, /* its finest level is the reference; its bias is part of the resolution error */
  KNOB_PART,       /* the same, but part of another knob, whose error includes it */
  KNOB_MODEL,      /* choice of physics, compared with the scene's own choice */
  KNOB_SETTINGS,   /* named settings of the scene; they set several knobs. No inputs of its own */
  KNOB_GROUPS
};
extern const char *const engine_knob_groups[]; /* "resolution", "part", "model", "settings" */

struct knob_input {
  const char *path;
  double power; /* a level of f times the scene's first input sets this one to f^power times its own value; 0 keeps it
                   where it would follow from others */
  bool given;   /* only where the scene gives it; unless given, it follows from others */
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
  bool pairs; /* levels are compared seed by seed: the same seed gives nearly the same run at all of them, or may do
                 so. A pair of independent runs costs degrees of freedom only */
  /* Prints why a scene does not have the spacing that a level stands for; nothing: it has. NULL: all have. */
  void (*tell_unkept)(const void *inputs, FILE *out);
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

/* Named materials: documents, with a source for each value. */
struct engine_materials {
  const struct field_table *values; /* of one material */
  const char *const (*overview)[2]; /* columns of `clast materials`: heading, path of a value; NULL ends the list */
  const char *const *not_values;    /* NULL-terminated: keys that a reader may expect */
  const char *instead;              /* what to give in place of these */
  const char *either[2];            /* paths of two names of one value: the one that is given later counts */
  /* Inputs of a scene outside of its materials that are properties of one: path of the input, path of the material's
   * name; ended by NULL. */
  const char *const (*beside)[2];
  const char *(*name)(size_t index);     /* sorted; NULL right behind the last; no index beyond that */
  const char *(*text)(const char *name); /* the document, or NULL */
  /* Into an object of `values`. STATUS_MISSING with the nearest name; STATUS_CONTENT: the document has a fault. */
  status (*load)(const char *name, void *material, struct error *error);
  /* A scene that judges a material's file: its document, the material's section, and an input with the value that lets
   * the scene need fewer values; and what such a scene is ("a body without strength"). */
  struct engine_trial {
    const char *scene, *section, *input, *value, *what;
  } trial;
  const char *together[2]; /* paths of two values that one measurement gives, and that mean little alone */
  /* Where a value of a named material comes from. STATUS_MISSING: the document does not say. */
  status (*source)(const char *name, const char *path, char source[FIELD_TEXT_SIZE]);
};

struct engine_kind {
  const char *name;                  /* "dem" */
  const char *doc;                   /* its model, with sources */
  int dimensions;                    /* 2: masses are kg per metre of thickness; 3; 0: a scene's program knows */
  int results_version;               /* part of a run's identity: raised by hand when result bits change on purpose */
  const struct field_table *inputs;  /* the typed scene; includes a `fidelity.` section */
  const struct field_table *results; /* what this engine reports beyond struct outcome; table result_<engine> */
  const struct knob *knobs;          /* what a convergence study varies; NULL: nothing */
  const struct engine_materials *materials; /* NULL: the engine has no named materials */

  /* An engine whose scenes tell their own rows, knobs and program (engine/command): makes the engine of one scene from
   * its document; files are relative to `folder`. It lives as long as the process and has the same name. NULL: errors
   * were reported. The member is NULL where all scenes have the rows above. */
  const struct engine_kind *(*of_scene)(document_node *root, const char *folder);
  /* The same from `task` of such an engine, in another process. NULL: *error says why. */
  const struct engine_kind *(*of_task)(const char *text, size_t size, struct error *error);
  const char *definition, *task; /* such an engine: members of the scene's JSON in a store and in a task; else NULL */
  const struct field_table *const *sections; /* of the scenes of such an engine: keys for `clast explain`; NULL-ended */
  bool same_bits; /* such an engine: the same inputs and seed give the same bits, which all others promise */
  /* May and can such a scene run here? STATUS_USAGE: not without the user's word; STATUS_MISSING: no program. NULL:
   * always. */
  status (*ready)(const void *inputs, struct error *error);

  /* Fills inputs that were not given (one flag per input row) and follow from others, such as the values of a named
   * material. The result depends only on the given inputs. Called again after every change. NULL: no such inputs. */
  void (*complete)(void *inputs, const bool *given);
  /* STATUS_CONTENT when an input is missing (one flag per input row) that must be given although it has a default or
   * may be off. NULL: no such input. */
  status (*check_given)(const void *inputs, const bool *given, struct error *error);
  /* A sentence for the user about inputs of which only a part was given, without a full stop; "": none. NULL: never. */
  void (*remark)(const void *inputs, const bool *given, char *text, size_t size);
  /* Checks conditions across fields (a charge energy needs a disc...). STATUS_CONTENT with a remedy. */
  status (*check)(const void *inputs, struct error *error);
  const struct condition *conditions; /* under which results are valid (engine/condition.h); NULL: none are known */
  /* Path of the result that such a scene is made for ("strength"). NULL, also as a function: OUTCOME_DEFAULT. */
  const char *(*headline)(const void *inputs);
  const char *single; /* what a fragment of count 1 is called ("of one element"); NULL: "of one grain or particle" */
  /* Text for `clast explain scene` and `plan`: the scene and its expected cost; below an empty line what is modelled,
   * with its numbers. `all`: also why, with sources. malloc'd. */
  char *(*describe)(const void *inputs, bool all);
  const size_t
      *also; /* offsets of results that `simulate` shows beside the headline, of those that are 0 one of a section */
  size_t also_count;
  size_t ejecta;     /* offset of a struct ejecta in the results, for table ejecta; 0: the engine has none */
  size_t ejecta_sum; /* offset of the result that sums its momentum */
  size_t (*memory)(const void *inputs); /* bytes a run will need, before anything is allocated */
  double (*steps)(const void *inputs);  /* about the steps to the hard end. NULL: not known */
  double (*work)(const void *inputs); /* a-priori cost in arbitrary units (grain- or particle-steps), for scheduling */
  int64_t *(*threads)(void *inputs);  /* the input that says how many threads one run takes. NULL: always one */

  /* Builds the initial state; inputs are copied. The run begins with a struct frame (engine/frame.h). On failure *run
   * is NULL. STATUS_MEMORY or STATUS_CONTENT. */
  status (*prepare)(const void *inputs, uint64_t seed, void **run, struct error *error);
  /* Advances by at most max_steps; Sets *finished after the scene's stop rule, its end or a failure. A numerical
   * failure (NaN, collapse) is not an error status: the run is finished, and its outcome names the failure.
   * STATUS_MEMORY is an error status, because the machine failed and not the run; then there is no result. */
  status (*step)(void *run, uint64_t max_steps, bool *finished, struct error *error);
  double (*progress)(const void *run); /* 0..1, simulated time over the hard end */
  double (*time)(const void *run);     /* s simulated so far; the label of snapshots */
  /* Results: *outcome, the engine's own *result (results->size bytes), and the fragments by descending mass (malloc'd,
   * owned by the caller from then on). May be called before the run is finished (a snapshot of results). */
  status (*finish)(void *run, struct outcome *outcome, void *result, struct fragment **fragments,
                   size_t *fragment_count, struct error *error);
  /* Big fields (grains, beams, break log, curves; particles) as one self-describing HDF5 file, written to a temporary
   * name and renamed. Pictures are drawn from it, too. NULL: the engine has none, and no restart files. */
  status (*write_snapshot)(void *run, const char *path, struct error *error);
  /* The moving system as bytes, which the caller frees, for restart files (engine/restart.h). NULL: no memory.
   * load_system: STATUS_CONTENT when the bytes fit no system of this run, STATUS_MEMORY. */
  void *(*copy_system)(const void *run, size_t *size);
  status (*load_system)(void *run, const void *bytes, size_t size, struct error *error);
  void (*free)(void *run); /* NULL is fine */
};

extern const struct engine_kind *const engines_list[]; /* ended by NULL: engines.c */
size_t engine_count(void);
const struct engine_kind *engine_at(size_t index);
/* The user's word that scenes may run programs of their own in this process and those forked from it (option
 * --allow-commands). */
void engine_allow_commands(void);
bool engine_commands_allowed(void);
/* STATUS_OK, or what kind->ready says. */
status engine_ready(const struct engine_kind *kind, const void *inputs, struct error *error);
/* STATUS_USAGE when the engine writes no `what`, such as fields files. */
status engine_has_fields(const struct engine_kind *kind, const char *what, struct error *error);
/* In a result of the engine; NULL: it has none. */
struct ejecta *engine_ejecta(const struct engine_kind *kind, void *result);
/* The row of the result that sums the momentum of ejecta. */
const struct field *engine_ejecta_sum(void);
/* NULL when there is none of that name; *error lists the known ones. */
const struct engine_kind *engine_find(const char *name, struct error *error);
/* NULL + STATUS_USAGE with the known names of this engine. */
const struct knob *engine_knob(const struct engine_kind *kind, const char *name, struct error *error);
