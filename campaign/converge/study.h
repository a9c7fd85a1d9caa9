/* A study of convergence: runs the levels of some knobs with the same seeds through farm and store, in rounds with
 * increasing numbers of seeds, until the bias of every level is known to the wanted width or the budget is spent. Its
 * runs are ordinary runs of the store: a stopped study goes on where it ended, and runs of other campaigns are used.
 *
 *     study_launch(&request, line, &error);      // what is asked for, farm, rounds, tables */
#pragma once

#include "analysis/statistics/convergence.h"
#include "analysis/statistics/statistics.h"
#include "campaign/converge/ladder.h"
#include "campaign/document/campaign.h"
#include "campaign/launch/launch.h"
#include "campaign/terminal/table.h"

/* The quantity of a study: a result of every run, or an exponent fitted to all runs of a point. */
struct study_quantity {
  const struct field *row; /* result of a run; NULL: an exponent */
  bool of_outcome;
  enum exponent_method method;
  enum estimates_window window;
  char name[FIELD_TEXT_SIZE];   /* the path of the row, or "beta", "beta_METHOD_WINDOW" */
  char column[FIELD_TEXT_SIZE]; /* its name in the store's table convergence */
};

/* STATUS_CONTENT or STATUS_USAGE, with similar names: there is no such quantity. */
status study_quantity_find(const struct engine_kind *kind, const char *name, struct study_quantity *quantity,
                           struct error *error);

/* One knob of one scene, and the values of its runs. */
struct study_ladder {
  struct ladder levels;
  const struct scene *base; /* borrowed */
  int64_t base_point;       /* in the store; 0 before study_run */
  int64_t point[KNOB_LEVELS];
  bool left_out[KNOB_LEVELS];                           /* left out because of the budget */
  int64_t seeds;                                        /* wanted number for every level that is not left out */
  double *values[LIMITS_STUDY_QUANTITIES][KNOB_LEVELS]; /* by seed; NaN: no usable run. Owned. For an exponent: the
                                                    run's contribution (pooled_exponent_of_runs), first `seeds` only */
  bool *ran[KNOB_LEVELS];                               /* by seed: its run is in the store. Owned */
  double cpu[KNOB_LEVELS], wall[KNOB_LEVELS];           /* means of the runs, s; NaN: none */
  bool narrow;                                          /* every bias of every quantity is known to the wanted width */
  bool waits;                                           /* its first round needs more than its share of the time */
  bool done;
  const char *end; /* why no more seeds are added: a sentence without full stop */
};

struct study_rule {
  double within; /* wanted half width of every bias; NaN: none, only the first round is run */
  bool relative; /* within is a share of the reference's mean */
  int64_t first_seeds, most_seeds;
  double seconds; /* wall time of this invocation; HUGE_VAL: no limit */
};

struct study {
  const struct design_axis *varied; /* by the studied campaign; borrowed */
  size_t varied_count;
  struct campaign limits; /* name, store, first_seed, time and memory limits, attempts, failures; nothing is owned */
  const char *scene_reference;
  struct study_rule rule;
  struct study_quantity quantity[LIMITS_STUDY_QUANTITIES];
  size_t quantity_count;
  struct study_ladder *ladder; /* owned */
  size_t ladder_count;
  bool budget_spent;
};

/* Takes ownership of the ladder (also on errors). STATUS_MEMORY. */
status study_add(struct study *study, const struct scene *base, struct ladder *levels, struct error *error);
void study_clear(struct study *study);

/* The results of a ladder for a quantity: one row per level, NaN where runs are missing. */
struct study_found {
  struct convergence_row rows[KNOB_LEVELS];
  size_t count;
  struct convergence_limit_row limit;
  bool adds; /* its error is one of resolution: a part of the error of every setting */
};
/* Results of one ladder, without the members `error`, `at_least` and `frontier` of its rows. */
void study_find(const struct study *study, const struct study_ladder *ladder, size_t quantity,
                struct study_found *found);
/* The same of all ladders of one scene, beginning with ladder `from`; `found` has LIMITS_STUDY_KNOBS elements. Returns
 * the number of ladders. */
size_t study_of_scene(const struct study *study, size_t from, size_t quantity, struct study_found *found);
/* Fills these members with those of the store, to which all studies of the scene add. */
status study_errors(const struct study *study, size_t from, size_t quantity, struct store *store, size_t count,
                    struct study_found *found, struct error *error);

/* Does the store's study have every level of this one, with more seeds than were asked for now? Then this one would
 * only take runs away, and is not stored. */
status study_is_smaller(const struct study_ladder *ladder, const struct study_found *found, struct store *store,
                        bool *smaller, struct error *error);

/* The limit of a ladder from all its levels with runs. `place` (KNOB_LEVELS numbers): the index of each level in
 * law->distance; LIMIT_LEVELS for a level that was left out. points: as for limit_infer(). */
void study_law(const struct study *study, const struct study_ladder *ladder, size_t quantity, struct limit_law *law,
               size_t *place, size_t count, struct limit_point *points);

/* The first knob whose levels have a step. NULL: there is none. */
const struct study_ladder *study_stepped(const struct study *study);
/* Index of the level that the others are compared with. */
size_t study_reference(const struct study_ladder *ladder);
/* Reads the values of a ladder's runs from the store. */
status study_read(const struct study *study, struct study_ladder *ladder, struct store *store, struct error *error);
/* Computes and stores the rows of all ladders and quantities. */
status study_store(const struct study *study, struct store *store, struct error *error);

/* ---- study_rounds.c ---- */

struct study_request;
/* Reads the request for the first argument, starts the farm, runs all rounds and, on rank 0, stores and prints what was
 * found and draws the pictures. STATUS_OK also when the budget is spent; STATUS_STOPPED after a signal: the same
 * command continues the study. */
status study_launch(const struct study_request *request, const struct command_line *line, struct error *error);
/* Only a campaign's document has the key `scene`. A name without a file is a built-in scene. */
bool study_is_campaign(const char *path);

/* ---- study_print.c ---- */

enum { STUDY_SETTING = 160 };
/* A setting of a knob with the digits and the unit that people need. knob NULL, or not a number: as it is. Returns
 * text. */
char *study_show_setting(const struct engine_kind *kind, const struct knob *knob, const char *setting,
                         char text[STUDY_SETTING]);
/* The error of a setting as on every screen: "0.061", or ">= 0.061" when it is no bound. Returns text. */
const char *study_show_error(double error, bool at_least, char text[UNCERTAINTY_TEXT]);
/* The table of knobs of every engine, or of those that have levels in a scene. */
status study_print_knobs(const struct scene *scene, enum table_format format, struct error *error);
/* For people a table per scene and quantity, with a sentence per knob and, unless `quiet`, a legend on stderr. For
 * programs the rows of convergence_table. */
status study_print(const struct study *study, enum table_format format, bool quiet, struct error *error);
/* Of the first scene, which the title names by its point, and quantity: draws the levels of study_stepped() over their
 * step, with law, limit and band. */
status study_print_picture(const struct study *study, const char *path, struct error *error);

/* ---- study_request.c ---- */

/* A user's request as on the command line (`clast converge --help`); texts may be NULL. */
struct study_request {
  struct launch_options launch;
  struct option_list knobs, set;
  const char *quantity, *store, *within, *seconds;
  int64_t first_seeds, most_seeds, first_seed;
  const char *picture;
  bool list; /* of the knobs, and no study */
};

enum { STUDY_SCENES = 64 };

/* The study of a scene or of every point of a campaign, and the objects that it borrows from. */
struct study_subject {
  struct study study;
  struct campaign *campaign;          /* NULL: a scene was named */
  struct scene *scenes[STUDY_SCENES]; /* owned */
  size_t scene_count;
  char reference[2 * FIELD_TEXT_SIZE]; /* path of the scene from the current folder */
  bool quiet;                          /* prints no remarks on levels that are left out */
  char told[4096];                     /* such remarks so far: each is printed once, for the first point */
};

/* Loads `path`, a file of a campaign or a scene or a built-in scene, and sets up its study: limits, quantities, rule,
 * ladders. Clear *subject also after an error. STATUS_USAGE: unknown words; STATUS_CONTENT: too many points, knobs that
 * do not apply; what the loaders return. */
status study_request_read(const struct study_request *request, const char *path, struct study_subject *subject,
                          struct error *error);
void study_request_clear(struct study_subject *subject);
