/* A campaign: many runs of one scene. The document (`clast run campaign.yaml`) is read here into a plain struct; the
 * plain keys are rows of campaign_table, the few keys that are unions (vary, set, design, keep) are read by hand and
 * their part of the JSON Schema is campaign.schema.in.json.
 *
 *     name: thresholds
 *     scene: disc-explosion             # built-in name, or a file relative to the campaign's folder
 *     vary:
 *       threshold.strain: [1 %, 3 %, 6 %]
 *       threshold.angle: {from: 1 deg, to: 7 deg, n: 4}
 *     set: {contact.friction: 0.2}
 *     seeds: {first: 1, per_point: 30}  # or {until: {quantity: largest_fraction, half_width: 0.01}, max: 200}
 *     design: grid                      # or list, or {kind: random | latin_hypercube | sobol, points: 64, seed: 1}
 *                                       # or, instead of vary, {file: points.csv}
 *     accuracy: {within: 0.02}          # instead of seeds: settings and number of seeds from a study
 *     keep: {fields: none}              # none | all | extremes | first N
 *     limits: {time: 10 min, memory: 2 GiB, attempts: 2, failures: 20}
 *     store: thresholds.db              # relative to the current folder */
#pragma once

#include "campaign/design/design.h"
#include "engine/scene.h"
#include "schemas/document.h"

enum campaign_design {
  CAMPAIGN_GRID,
  CAMPAIGN_LIST,
  CAMPAIGN_RANDOM,
  CAMPAIGN_LATIN_HYPERCUBE,
  CAMPAIGN_SOBOL,
  CAMPAIGN_DESIGNS
};
enum campaign_keep { CAMPAIGN_KEEP_NONE, CAMPAIGN_KEEP_ALL, CAMPAIGN_KEEP_EXTREMES, CAMPAIGN_KEEP_FIRST };

struct campaign_design_keys { /* the mapping form of `design`, table campaign_design_table */
  int kind;                   /* enum campaign_design; CAMPAIGN_LIST with a file */
  int64_t points; /* number of points of a sampling design or a file; 0 for grid and list, whose axes give it */
  int64_t seed;   /* seed of a sampling design: for shift, permutations and draws */
  char file[FIELD_TEXT_SIZE]; /* CSV file of the points, "" for none */
};

struct campaign {
  char name[FIELD_TEXT_SIZE];
  char scene_reference[FIELD_TEXT_SIZE];
  char quantity[FIELD_TEXT_SIZE]; /* the main quantity: shown while running; selects the runs of keep `extremes` */
  char store[FIELD_TEXT_SIZE];    /* path, relative to the current folder */
  int64_t first_seed;
  bool independent;       /* seeds derive from point and replicate instead of first_seed + r */
  bool independent_given; /* the document says so, or that they do not */
  int64_t per_point;      /* replicates of every point; 0 when `until` decides */
  int64_t maximum;        /* most replicates of a point when `until` decides */
  char until_quantity[FIELD_TEXT_SIZE];
  double until_half_width; /* half width of the mean's confidence interval, in the quantity's SI unit */
  bool until_of_value;     /* until_half_width is a share of the mean: given in per cent */
  double until_scale;      /* the half width as written, over until_half_width */
  char until_unit[24];     /* behind it: " MPa", " %"; "": none */
  double until_level;      /* 0.95 */
  int64_t until_minimum, until_batch;
  char accuracy_quantity[FIELD_TEXT_SIZE];
  bool accuracy_of_value; /* accuracy_within is a share of the mean: given in per cent */
  double accuracy_within; /* limit of |error| plus half width of the mean's interval, in the quantity's SI unit; NaN:
                             not given */
  double accuracy_time;   /* processor time of the campaign in which that sum shall be least, s; NaN: not given */
  double time_limit;      /* s per attempt, NaN = off */
  double memory_limit;    /* bytes per attempt, NaN = off */
  int64_t attempts;       /* most attempts of one run */
  int64_t failures;       /* failures among the first CAMPAIGN_FIRST_RUNS runs that end the campaign; 0 = never */
  struct campaign_design_keys design;
  int keep;           /* enum campaign_keep */
  int64_t keep_first; /* number N of CAMPAIGN_KEEP_FIRST */

  struct design_axis *axes; /* owned */
  size_t axis_count;
  int64_t *point_lines;   /* owned: line of each point in design.file; NULL without a file */
  char points_sha256[65]; /* checksum of design.file; "" without */
  struct scene *scene;    /* owned: the scene with `set` applied; axes are applied to copies of it */
  char *text; /* owned: the document as read, for the store; its last line has the checksum of design.file */
};
enum { CAMPAIGN_FIRST_RUNS = 50 };

/* Changes of a campaign from the command line. They become part of its document, so that the store keeps them and
 * `clast retry` runs the same campaign. */

struct campaign_changes {
  size_t input_count;
  const char *const *inputs; /* "PATH=VALUE": as if under `set` */
  int64_t seeds;             /* seeds.per_point; 0: as written */
  double processor_time; /* accuracy.processor_time in s, in the place of seeds and accuracy.within; 0: as written */
};

/* Splits PATH=VALUE of --set. *value points into the text. STATUS_USAGE: the text has another form. */
status campaign_change_split(const char *text, char path[FIELD_TEXT_SIZE], const char **value, struct error *error);

extern const struct field_table campaign_table;        /* the plain keys */
extern const struct field_table campaign_design_table; /* the keys of `design` as a mapping */

/* Reports all errors of the document together in *error, each with its place. STATUS_MISSING, STATUS_IO,
 * STATUS_CONTENT. May be called before farm_start: opens no HDF5 file, starts no thread. */
status campaign_load(const char *path, struct campaign **out, struct error *error);
/* The same with changes from the command line (NULL: none). STATUS_USAGE when only the changes are wrong. */
status campaign_load_changed(const char *path, const struct campaign_changes *changes, struct campaign **out,
                             struct error *error);
/* The path `scene` is relative to `folder` (NULL: the current one). */
status campaign_parse(const char *name, const char *text, size_t size, const char *folder, struct campaign **out,
                      struct error *error);
/* Parses the document of a store. Numbers without a unit are SI, because old documents have no units. */
status campaign_parse_stored(const char *name, const char *text, const char *folder, struct campaign **out,
                             struct error *error);
void campaign_free(struct campaign *campaign); /* NULL is fine */
/* A campaign that frees itself where its block is left: CAMPAIGN campaign = NULL; */
#define CAMPAIGN __attribute__((cleanup(campaign_drop))) struct campaign *
void campaign_drop(struct campaign **campaign); /* for CAMPAIGN */

/* The axis of an input; NULL: it does not vary. */
const struct design_axis *campaign_axis(const struct campaign *campaign, const char *path);

/* With `until`: the first prefix that can end a point, were there no maximum. */
int64_t campaign_replicates_of_rule(const struct campaign *campaign);
/* Least and greatest number of replicates of a point. Equal for per_point. */
int64_t campaign_replicates_least(const struct campaign *campaign);
int64_t campaign_replicates_most(const struct campaign *campaign);

/* The scene of a design point from its row of axis values (design_next). NULL with *error when the values cannot be run
 * together (cross-field check). Owned by the caller. */
struct scene *campaign_point_scene(const struct campaign *campaign, const struct field_value *values,
                                   struct error *error);
/* The same from another scene of the campaign's engine (a level of a knob). */
struct scene *campaign_point_scene_from(const struct scene *base, const struct campaign *campaign,
                                        const struct field_value *values, struct error *error);
/* Seed of replicate r: first_seed + r, the same for every point; with independent seeds derived from the point's
 * inputs. */
uint64_t campaign_seed(const struct campaign *campaign, const struct scene *point, int64_t replicate);

/* A quantity of a run by its path or unique suffix: a row of outcome_table or of the engine's results. NULL + *error.
 */
const struct field *campaign_quantity(const struct engine_kind *kind, const char *path, bool *of_outcome,
                                      struct error *error);
/* The unit that users see after numbers of a quantity, with a blank before it; "" for plain numbers. Returns text. */
enum { CAMPAIGN_UNIT = 32 };
const char *campaign_unit(const struct campaign *campaign, const char *quantity, char text[CAMPAIGN_UNIT]);
/* Value of a quantity in a finished run; NaN when the run failed (outcome states other than completed and end_time). */
double campaign_value(const struct field *row, bool of_outcome, const struct outcome *outcome, const void *result);

/* The keys of a campaign that have several forms (vary, set, design, keep), for `clast explain`. The plain keys are
 * rows of campaign_table. */

struct campaign_key {
  const char *name;
  const char *words;               /* words that may occur in its value, separated by spaces */
  const char *doc;                 /* one sentence */
  const char *forms;               /* lines of examples and their meaning */
  const struct field_table *table; /* the rows of its mapping; NULL: none */
};

extern const struct campaign_key campaign_keys[];
extern const size_t campaign_keys_count;

/* Finds the key that is named `path`, contains it ("keep.fields"), or has it among its words. NULL: none. */
const struct campaign_key *campaign_keys_find(const char *path);

/* ---- A walk over the points of a campaign, in the order of its design ---- */

struct campaign_walk {
  const struct campaign *campaign;
  struct design *design;
  struct field_value *values; /* values of the current point, one for each axis */
};

/* A walk that ends where its block is left: CAMPAIGN_WALK walk = {0}; */
#define CAMPAIGN_WALK __attribute__((cleanup(campaign_walk_end))) struct campaign_walk
/* Begins a walk before the first point. STATUS_MEMORY; STATUS_CONTENT: no such design. End it also after an error. */
status campaign_walk_begin(struct campaign_walk *walk, const struct campaign *campaign, struct error *error);
void campaign_walk_end(struct campaign_walk *walk); /* twice is fine */
/* Goes to the next point. False after the last one. */
bool campaign_walk_next(struct campaign_walk *walk);
/* The scene of the current point, owned by the caller. NULL with *error when its values cannot be run together. */
struct scene *campaign_walk_scene(const struct campaign_walk *walk, struct error *error);

/* ---- Warnings about the inputs of a campaign before it runs, from its engine ---- */

/* Writes a line per kind of warning (engine/outcome.h): `before`, the number of points that have it, and the engine's
 * text for the first of them; and the inputs of a sample that move together. Looks at the first 1000 points. */
void campaign_warn(const struct campaign *campaign, const char *before, FILE *out);
/* The same for one scene, without a number of points. */
void campaign_warn_scene(const struct scene *scene, const char *before, FILE *out);
/* Only the numbers that a scene gives for its own material and that another one keeps (scene_next_kept()). */
void campaign_tell_kept(const struct scene *scene, const char *before, FILE *out);

/* Writes a list of points as a campaign's document, which `clast run` could compute: for the store of a study or a
 * fit. */

/* The overridden inputs of campaign->scene become `set`, the levels of its axes `vary` with the design `list`. comment:
 * one line. scene_reference: value of `scene`. malloc'd; NULL when memory is out. */
char *campaign_write_list(const struct campaign *campaign, const char *scene_reference, const char *comment);

/* ---- A campaign whose failed runs are tried again (`clast retry`) ---- */

/* Limits as a user types them ("30 min", off); NULL: twice the campaign's. Adds this many attempts and removes the
 * limit of failures. STATUS_USAGE. */
status campaign_raise(struct campaign *campaign, const char *time, const char *memory, int64_t attempts,
                      struct error *error);

/* The design for sensitivity indices, written as a campaign with a file of points, and found again in such a campaign.
 */

/* Writes NEW.yaml, the campaign of `path` with another design, and NEW.csv, its points. Neither may exist. */
status sensitivity_design_write(const char *path, const char *output, size_t blocks, uint64_t seed,
                                struct error *error);

/* The number of blocks that the points of a campaign form. STATUS_USAGE: they are not this design. */
status sensitivity_design_find(const struct campaign *campaign, size_t *blocks, struct error *error);
