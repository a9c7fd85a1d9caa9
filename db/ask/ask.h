/* The questions to a store, with typed results. The basis of all is answer.h: rows that the caller pulls. */
#pragma once

#include "db/ask/answer.h"

/* ---- The runs that all further questions to a store see: those of one point, of one campaign, and that meet an SQL
 * condition on the view runs; and among them, the runs that a person excluded, which no question counts. ---- */

struct ask_choice {
  int64_t point;        /* 0: all */
  const char *campaign; /* number or name (several may have it); NULL: all */
  int64_t session;      /* besides, the campaigns of this session and of later ones; 0: none of these */
  const char *where;    /* NULL: all */
  /* Without the points that only studies and searches (clast converge, find, fit) have: their points share seeds, or
   * lie where the search looked, so they are no sample. Holds without `point` and `campaign`, in a store with others.
   */
  bool campaigns_alone;
  /* Table axis has only the inputs that tell the chosen points apart: those that a person's campaign (or the chosen
   * one) varies, and those that differ between points with runs and do not follow from a varied name, as a density does
   * from its material, nor from all that is varied, as a default does. Any other choice does the same. */
  bool axes;
};
/* For a reader. Points without a chosen run are no points. An empty choice: all. STATUS_USAGE: unknown point or
 * campaign; the condition is no valid SQL. */
status ask_choose(struct store *store, const struct ask_choice *choice, struct error *error);
/* An operand STORE, STORE:POINT or STORE:CAMPAIGN: the path of its store, and a narrower choice, whose campaign is
 * borrowed from the operand. A file of the whole name is a STORE. */
void ask_choose_operand(const char *operand, char *path, size_t size, struct ask_choice *choice);
/* The choice in words: "campaign 2, m > 5"; "": all runs, or all of a point. Borrowed. */
const char *ask_chosen(const struct store *store);
/* Points that campaigns_alone left out. */
int64_t ask_choice_left_out(const struct store *store);
/* Runs at the points of the chosen campaign that others computed: they count. 0: no campaign is chosen. */
status ask_choice_others(struct store *store, int64_t *runs, struct error *error);
/* Fits the exponents of the points whose runs were chosen by a condition: the view estimates has them from then on. */
status ask_choose_estimates(struct store *store, struct error *error);

/* The runs that a person excluded: run_id, point_id, seed, date, reason. */
struct answer ask_run_excluded(struct store *store, struct error *error);
/* Their number. */
status ask_run_excluded_count(struct store *store, int64_t *count, struct error *error);
/* The runs that gave no usable result, because they failed or died (`failed` of the view points), of these and those
 * that count. Of each point's newest results_version. */
status ask_run_missing(struct store *store, int64_t *missing, int64_t *wanted, struct error *error);

/* ---- The campaigns and sessions of a store: their progress, their documents, and which of their runs are safe
 * (usable, `warnings` is empty), warned (usable, with warnings) or refused (another state, which gives the reason).
 * ---- */

/* One row per campaign: campaign, name, state, points, runs, counted, censored, failed, surplus, excluded,
 * failed_attempts, without_result, cpu_time (s), start and end of its last session, warned runs that count, the
 * command of that session, which names its file, and points that ended at seeds.max before seeds.until was met.
 * `writing`: a process is writing the store (store_is_being_written). `earlier`: also campaigns whose points a later
 * one of their name has; without it, the rounds of one search or study are one row, "1 .. 29". */
struct answer ask_campaign_progress(struct store *store, bool writing, bool earlier, struct error *error);
/* Seconds since the store had its last sign of life: a run was stored, or a session began. NaN: none is known. */
double ask_campaign_silence(struct store *store);
/* The earlier forms of campaigns (ask_campaign_progress()), the points that several other campaigns have, not those of
 * one search or study alone, and the runs of all campaigns, each once. 0 where the store does not tell. */
void ask_campaign_overlaps(struct store *store, int64_t *earlier, int64_t *shared, int64_t *runs);
/* Number of chosen points with runs that count that only a study (clast converge) or a search (find, fit) has. */
int64_t ask_campaign_levels(struct store *store);
/* "1, 2": the campaigns that have this name (NULL: the first name that several have) and vary other inputs, or differ
 * in one that they do not vary; "": none. Rounds of a study or search and earlier forms of a campaign do not count. */
enum { ASK_CAMPAIGN_NUMBERS = 64 };
status ask_campaign_namesakes(struct store *store, const char *name, char *numbers, size_t size, struct error *error);

/* Name and YAML text of a campaign (0: the last one); the caller frees both. Both NULL: the store has no campaign. */
status ask_campaign_document(struct store *store, int64_t campaign, char **name, char **document, struct error *error);

/* Attempts of the run that failed most often among those that have no result. 0: every run has a result. */
status ask_campaign_attempts(struct store *store, int64_t *attempts, struct error *error);
/* Runs at the points of all campaigns of this name. */
status ask_campaign_runs(struct store *store, const char *name, int64_t *runs, struct error *error);

/* One row per session (invocation that wrote to the store): session, campaign (number; may be NULL), started, ended
 * (may be NULL), outcome (may be NULL), version, commit, command (words with spaces between them). */
struct answer ask_campaign_sessions(struct store *store, struct error *error);
/* One row per campaign: campaign, name, document. */
struct answer ask_campaign_documents(struct store *store, struct error *error);

/* Inputs that no campaign of the store varies, so that tables do not show them, and that differ between the point and:
 * a point of the same campaign with the same varied inputs (its scene or a file of its was changed); of each other
 * campaign with its name or scene, a point with the same names (of materials), else the first one. A row per input:
 * path, value there (SI; NULL: the input does not apply there; of the same campaign, else of the last), the scene of
 * its point (JSON), and whether it is the same campaign. */
struct answer ask_campaign_hidden_inputs(struct store *store, int64_t campaign, int64_t point, struct error *error);
/* The same of all campaigns of one scene, as after a merge. Values of one name, such as a rock's, are compared with
 * each other only: the others follow from their names. A row per input and point in which it applies, of the first
 * points of campaigns with each set of names, or of the points of one campaign with the same varied inputs: engine,
 * path, scene of the point (JSON). */
struct answer ask_campaign_different_inputs(struct store *store, struct error *error);

/* A row per campaign: runs, safe, warned, refused, runs given up without a result, the largest energy_error of usable
 * runs, and the number of usable runs with an error above 1 % and no warning. */
struct answer ask_campaign_extremes(struct store *store, struct error *error);
/* A row per campaign and reason, the most frequent first: state or warnings, runs, one message. */
struct answer ask_campaign_reasons(struct store *store, struct error *error);

/* ---- The conditions that the runs behind a number break (engine/condition.h). ---- */

/* Runs behind a number. They stay in every mean; a value that is withheld is missing in it. */
struct ask_doubts {
  int64_t runs, doubtful, withheld; /* that count; whose words mark a result; of these, whose result is withheld */
  int64_t excluded;                 /* beside these; by a person */
  const char *chosen;               /* ask_choose() of the store, borrowed from it; NULL, "": all */
  struct ask_absent { /* runs that lack a result though nothing withholds it, such as the time of the first
                         break of a body that did not break; "": no more */
    char name[64];
    int64_t runs, of; /* of: those of engines that have the result */
  } absent[4];
  size_t count;
  struct ask_doubt {
    char word[CONDITION_WORD];
    const struct condition *row; /* NULL: a word of another version */
    int64_t runs, withheld;      /* withheld: of these, whose result is withheld, by this word or another one */
  } word[32];
};

/* Runs that count, of each point's newest results_version with such runs; 0 and NULL: all. */
struct ask_doubts_choice {
  int64_t point, run;
  const char *where; /* an SQL condition on the view runs */
};

/* Adds these runs to *doubts (zeroed before the first call). `results`: the result columns that the number rests on,
 * separated by spaces (ask_doubts_results()). */
status ask_doubts(struct store *store, const struct ask_doubts_choice *choice, const char *results,
                  struct ask_doubts *doubts, struct error *error);

/* How many runs of the store count and are in doubt, and how many only studies and searches have. */
status ask_doubts_count(struct store *store, double *doubtful, double *of_studies, struct error *error);

/* Counts `runs` that lack a result though nothing withholds it, of `of`. */
void ask_doubts_absent(struct ask_doubts *doubts, const char *name, int64_t runs, int64_t of);
/* Adds `runs` runs of these words, and returns what the words say of the results. */
enum condition_mark ask_doubts_run(struct ask_doubts *doubts, const char *engine, const char *words,
                                   const char *results, int64_t runs);
/* Adds other runs. */
void ask_doubts_add(struct ask_doubts *doubts, const struct ask_doubts *others);

/* The columns of comma-separated quantities: results or unique endings of one, "main", or exponents, which rest on what
 * the masses of fragments rest on (NULL). */
enum { ASK_DOUBTS_RESULTS = 1024 };
status ask_doubts_results(struct store *store, const char *quantities, char results[ASK_DOUBTS_RESULTS],
                          struct error *error);

/* The words, as in the result `warnings`. */
void ask_doubts_words(const struct ask_doubts *doubts, char *text, size_t size);

/* ---- Ready queries, by name. ---- */

/* Canned queries: a name, its question in a sentence, its SQL, the names of its parameters. */
struct query_canned {
  const char *name, *doc, *sql;
  const char *parameters; /* comma-separated, "" for none */
};
size_t ask_canned_count(void);
const struct query_canned *ask_canned_at(size_t index);
/* Finds a canned query by name. NULL: *error lists the known names. */
const struct query_canned *ask_canned_find(const char *name, struct error *error);

/* ---- The columns of a store: the inputs that campaigns varied, their units, and whole views. ---- */

/* A column of the views and its unit. */
struct ask_column {
  char name[128];
  char word[128]; /* of a varied input: the shortest end of its path that no other has: "m", "target.radius"; else "" */
  char unit[64];  /* "" when the store does not give it; "1" for a pure number */
  double factor;  /* SI value of one of this unit; values of the store are SI */
  bool of_studies; /* a varied input that only studies and searches vary */
};

/* The columns of the varied inputs, at most `most` (LIMITS_AXES_OF_STORE) of them. `written`: in the units and the
 * order that the campaign uses, those of studies last; else in SI units, in the order of their paths. */
status ask_columns_axes(struct store *store, bool written, size_t most, struct ask_column *axes, size_t *count,
                        struct error *error);
/* One column by name, with the campaign's unit if it is a varied input, else with its unit in the store. */
status ask_columns_written(struct store *store, const char *column, struct ask_column *out, struct error *error);
/* Replaces the column's SI unit by `unit` if both have the same dimension. */
void ask_columns_write_in(struct ask_column *column, const char *unit);
/* A value of the store in the unit of the column: numbers are divided by its factor; other kinds do not change. */
struct query_value ask_columns_value(const struct ask_column *column, const struct query_value *value);
/* The same with the unit, as people write it: "5×10^33 m^-3", "2000 J/m", "basalt", "off". */
void ask_columns_show(const struct ask_column *column, const struct query_value *value, char *text, size_t size);

/* Unit of one column in `unit`; "" for a pure number or an unknown column. */
status ask_columns_unit(struct store *store, const char *column, char *unit, size_t size, struct error *error);

/* All columns with a unit, in *columns (the caller frees it). A column that has different units in different tables is
 * left out. STATUS_MEMORY. */
status ask_columns_units(struct store *store, struct ask_column **columns, size_t *count, struct error *error);

/* All rows of a view: runs, points, spectra, estimates, or of the table column_doc. */
struct answer ask_columns_view(struct store *store, const char *view, struct error *error);

/* ---- The error of a point's result that comes from its resolution: its number of particles or grains, its time step,
 * its precision. More seeds do not reduce it, and the interval over seeds does not include it. ---- */

enum ask_resolution_verdict {
  ASK_RESOLUTION_NOT_STUDIED,   /* the store has no study of the point's scene */
  ASK_RESOLUTION_KNOWN,         /* half_width is a bound */
  ASK_RESOLUTION_NO_DIFFERENCE, /* no run differs between the settings: half_width is 0, and no bound */
  ASK_RESOLUTION_AT_LEAST, /* half_width is the known part; the error may be larger, because no limit is known yet */
  ASK_RESOLUTION_DIVERGES, /* studied: the quantity does not converge. half_width is the known part */
};

struct ask_resolution {
  enum ask_resolution_verdict verdict; /* of several points the worst */
  /* 95 % bound on the change of the quantity with finer resolution, in its unit. Of several points the largest of those
   * that do not diverge, or of all if all do; NaN: none. */
  double half_width;
  int64_t points, studied;     /* requested points with runs, and how many of them were studied */
  int64_t diverging, at_least; /* of these: with that verdict */
  char knobs[128];   /* settings studied: "particles, time_step"; other settings may also change the quantity */
  char command[300]; /* what `clast converge` takes to study these points: "impact.yaml --store other.db -Q broken";
                        "" when several files made them */
};

/* "not-studied", "known", "no-difference", "at-least", "diverges": as in the views. */
extern const char *const ask_resolution_names[];
/* The verdict named in a column of the views or of ask_group; any other text, or NULL: not studied. */
enum ask_resolution_verdict ask_resolution_verdict(const char *verdict);

/* The row of the view resolution for the point's newest results_version: the result of `clast converge`, whether the
 * point is the scene studied or one of its levels. `quantity`: a result column of the view runs, beta, or
 * beta_METHOD_WINDOW. point_id 0: all points of the store, with the worst verdict of those studied. `store` NULL: a run
 * without a store, never studied. */
status ask_resolution(struct store *store, int64_t point_id, const char *quantity, struct ask_resolution *out,
                      struct error *error);

/* Does any point have a study of an exponent? */
status ask_resolution_of_exponents(struct store *store, bool *studied, struct error *error);

/* ---- Results of convergence studies: the rows of table convergence. ---- */

/* The levels of all knobs of the scene that was studied as `base_point`, for one quantity (a column of the view runs),
 * knob by knob, coarse to fine, with `errors` each with its error of the view resolution. No rows for a scene without a
 * study. base_point 0: of all scenes. */
struct answer ask_convergence_levels(struct store *store, int64_t base_point, int results_version, const char *quantity,
                                     bool errors, struct error *error);
/* The next level. False at the end and after an error; then answer_end(). */
bool ask_convergence_next(struct answer *answer, struct convergence_row *row);

/* What one knob leaves of the error of a point. The parts of a point add up to its error, unless a share cannot move so
 * far. */
struct ask_part {
  int64_t point;
  const char *knob; /* until the next one */
  double error;     /* NaN: no run tells it */
  bool open;        /* no bound */
  double beyond; /* if open: what a law of order 0.5 leaves beyond the finest level, a guess; NaN: not known. Else 0 */
  double left_by_seeds; /* of the error: the middle of its interval */
  int64_t coarser;      /* levels with runs that are coarser than the finest one */
  const char *finest;   /* the setting of that one, of the study with the finest level; "": none */
  int64_t seeds;        /* of this study */
};
/* The parts of the scene that was studied as `base_point` and of its levels, by point, largest first. */
struct answer ask_parts(struct store *store, int64_t base_point, int results_version, const char *quantity,
                        struct error *error);
bool ask_parts_next(struct answer *answer, struct ask_part *part);

/* ---- Lists of points: which of them have runs, their inputs and the statistics of their runs. point_read() reads the
 * fragments of one point. ---- */

/* A point's runs of one results_version. */
struct ask_points_row {
  int64_t point_id;
  int64_t results_version; /* 0: the point has no runs */
  int64_t n, failed;       /* runs that count; runs that failed */
  double mean;             /* of the largest fraction */
  double half_width;       /* of the 95 % interval of this mean. NaN: one run, or all runs are equal */
  double low, high;        /* the interval, or what equal runs bound (sample_in_range()). NaN: one run */
  bool weak;               /* the interval often misses the mean (sample_of_share()) */
  double resolution;       /* error that the resolution leaves in it; NaN: not known */
  enum ask_resolution_verdict resolution_verdict;
  struct ask_doubts doubts; /* of the largest fraction; without withheld values in mean and half width */
  size_t input_count;
  struct query_value inputs[LIMITS_AXES_OF_POOL]; /* values of the requested inputs, in their order; texts are borrowed
                                                   until the next row */
};

/* The number of points, with and without runs. */
status ask_points_count(struct store *store, int64_t *points, struct error *error);

/* STATUS_USAGE, with the known numbers, when the store has no point of this number. 0 means every point. */
status ask_points_known(struct store *store, int64_t point, struct error *error);

/* All points with the named input columns (ask_columns_axes; at most LIMITS_AXES_OF_POOL), in the order of their
 * numbers. Each point comes with its newest results_version only (`newest`), or once for every results_version. */
struct answer ask_points_rows(struct store *store, bool newest, size_t input_count, const char *const *inputs,
                              struct error *error);
/* The next row. False at the end and after an error; then answer_end(). */
bool ask_points_next(struct answer *answer, struct ask_points_row *row);

/* The varied inputs of a point by the last words of their paths, last path first: "strain 3 %, angle 4 deg".
 * Inputs that do not fit are left out. "point 7" when nothing was varied. units: in the units of this store, where it
 * varies the input, too. */
status ask_points_label(struct store *store, struct store *units, int64_t point_id, char *label, size_t size,
                        struct error *error);

/* The names of the scenes of all points: "disc-explosion", "a, b". */
status ask_points_scenes(struct store *store, char *names, size_t size, struct error *error);

struct ask_points_version {
  int64_t point_id;
  int results_version;
};
/* The points of a campaign (0: of all) whose runs have no pooled estimates yet, in *list (the caller frees it). */
status ask_points_without_estimates(struct store *store, int64_t campaign, struct ask_points_version **list,
                                    size_t *count, struct error *error);

/* ---- One stored run: its inputs and seed, its results and its fragment masses. Also the wall time of all runs, and
 * the runs whose fields are kept as files. ---- */

struct ask_run {
  char *scene; /* resolved scene as JSON; owned. NULL: the store has no such run */
  uint64_t seed;
  int64_t results_version;
  /* The program and machine that computed the run. "" where the session does not tell. */
  char cpu_class[16];              /* baseline, v3 or v4 */
  char version[64], compiler[128]; /* of the program */
  char commit[96];                 /* followed by " with local changes" if the program had any */
};
status ask_run_read(struct store *store, int64_t run_id, struct ask_run *run, struct error *error);
void ask_run_release(struct ask_run *run); /* a zeroed one is fine */

/* The name of the scene of the stored run that has these fields, by the store beside their folder: NAME.db beside
 * NAME-fields/<identity>.h5. The file has no name of its own: runs of one identity have the same fields. "": not known.
 */
void ask_scene_of_fields(const char *fields, char *name, size_t size);

/* One row: all columns of the tables run and result_<engine>. */
struct answer ask_run_results(struct store *store, int64_t run_id, const char *engine, struct error *error);

/* Did the program that computed this run store a value in a column of run or result_<engine>, for this run or another
 * one of the same session? If not, it may not have had that result. */
status ask_run_column_used(struct store *store, int64_t run_id, const char *engine, const char *column, bool *used,
                           struct error *error);

/* A stored run of a point, for a driver that resumes and for stopping rules. */
struct ask_run_of_point {
  int64_t replicate;
  uint64_t seed;
  uint8_t identity[16];
  bool surplus, excluded;
  int state;            /* enum outcome_state */
  double value;         /* of the quantity; NaN when the store has none */
  bool withheld;        /* the value has no meaning */
  const char *warnings; /* borrowed until the next row */
  double wall_s, cpu_s;
  int64_t peak_memory;
  const char *fields_path; /* NULL when none was kept; borrowed until the next row */
  bool fields_missing;     /* a path is stored, but the file cannot be read */
};
/* The runs of a point and of the engine's results_version, in order of replicate. `row` gives the quantity: a row of
 * outcome_table (of_outcome), or else of the engine's results. */
struct answer ask_run_of_point(struct store *store, int64_t point_id, const struct engine_kind *kind,
                               const struct field *row, bool of_outcome, struct error *error);
/* The next run. False at the end and after an error; then answer_end(). */
bool ask_run_of_point_next(struct answer *answer, struct ask_run_of_point *run);

/* Fragment masses in kg, largest first; the caller frees them. NULL: the store has none. */
status ask_run_masses(struct store *store, int64_t run_id, double **masses, size_t *count, struct error *error);

/* Ejecta of one run. stored: the store has some, which it has not of runs of older programs. */
status ask_run_ejecta(struct store *store, int64_t run_id, struct ejecta *ejecta, bool *stored, struct error *error);

/* Wall time and processor time of a stored run in s. NaN: it is not there. */
status ask_run_wall_time(struct store *store, const uint8_t identity[16], double *seconds, double *cpu_s,
                         struct error *error);
/* Rows of point and mean processor time (s) of its runs. */
struct answer ask_run_costs(struct store *store, int results_version, struct error *error);
/* Wall times of all stored runs of a scene, by its name: number, sum and longest; and the sum of their processor times.
 */
status ask_run_wall_times(struct store *store, const char *scene, uint64_t *count, double *sum, double *most,
                          double *cpu_s, struct error *error);

/* The path of the file that a row names in this column, as this process can open it: the store holds it relative to its
 * own folder. The caller frees it; NULL: no memory. */
char *ask_run_fields(const struct answer *answer, size_t column);

/* ---- One number for every run of a point: a result, an exponent, or the number of fragments heavier than a share of
 * the body. ---- */

enum ask_specimens_kind {
  ASK_SPECIMENS_RESULT,
  ASK_SPECIMENS_EXPONENT,
  ASK_SPECIMENS_COUNT, /* fragments heavier than a share of the body */
  ASK_SPECIMENS_SHARE, /* the share of the mass in such fragments: the part that a sieve retains */
};

struct ask_specimens_quantity {
  enum ask_specimens_kind kind;
  const struct field *row;     /* of a result */
  bool of_outcome;             /* a row of outcome_table, else of the engine's results */
  enum exponent_method method; /* of an exponent */
  enum estimates_window window;
  double share; /* threshold: share of the mass of all fragments together */
};

/* The result that the number rests on. */
const char *ask_specimens_result(const struct ask_specimens_quantity *quantity);
/* A row per run that counts, of the results_version of this program's engine. */
struct answer ask_specimens(struct store *store, int64_t point_id, const struct engine_kind *kind,
                            const struct ask_specimens_quantity *quantity, struct error *error);
/* The next run. *value is NaN if it has no such value, or it is withheld. Adds the run to *doubts. False at the end and
 * after an error; then answer_end(). */
bool ask_specimens_next(struct answer *answer, const struct ask_specimens_quantity *quantity, uint64_t *seed,
                        double *value, struct ask_doubts *doubts);

/* ---- Statistics of runs grouped by varied inputs, and the names of inputs and results that users abbreviate. ---- */

/* points, n, failed, censored, excluded, and of each quantity mean, standard deviation, standard error, 95 % half
 * width, resolution error and its verdict (the worst of all points), of all runs that share the named axes. Last, of
 * each quantity the number of its values in the mean (_n: without withheld ones) and of runs in doubt (_doubtful); and
 * `doubts`, the words of these runs. A group of one point is a sample of runs (seeds). A group of several points pools
 * over other inputs: its points are the units, each with the mean of its runs, and the interval is that of a mean over
 * such points and over seeds, also where points share seeds (sample_crossed()). `pooled` names these inputs.
 *
 * `by`: comma-separated paths of varied inputs or unique suffixes of one ("m,k"); "" pools everything. `quantities`:
 * comma-separated result columns or unique suffixes; NULL = the main ones. Results of different results_version are
 * different rows. Registers the functions of answer.h. STATUS_USAGE names the known axes and quantities. */
enum { ASK_GROUP_POOLED = 512 };
struct ask_group_pooled {
  char inputs[ASK_GROUP_POOLED]; /* "threshold.angle, material.m"; "": every group has one point */
  bool single;                   /* a group has one point: its interval is over seeds, also where others pool */
  bool lacks_seeds;              /* the interval lacks what a seed changes at all points of a group alike */
};
struct answer ask_group(struct store *store, const char *by, const char *quantities, struct ask_group_pooled *pooled,
                        struct error *error);
/* The same of ask_pools(). by NULL: every point is alone. */
status ask_group_pooled(struct store *store, const char *by, struct ask_group_pooled *pooled, struct error *error);

/* The varied inputs that are none of `by` and change from group to group, though in no group ("": none): the rows of
 * ask_group() differ in more than their axes, as those of two campaigns do. */
status ask_group_changing(struct store *store, const char *by, char changing[ASK_GROUP_POOLED], struct error *error);

/* How the points with runs have an input: a column of the views (ask_columns_axes()). */
struct ask_group_values {
  int64_t points;  /* with runs */
  int64_t given;   /* have a value */
  int64_t numbers; /* have a number */
  int64_t kinds;   /* different values; none is one */
};
status ask_group_values(struct store *store, const char *input, struct ask_group_values *values, struct error *error);

/* The full name of one result column of the view runs from a unique ending of it. STATUS_USAGE names the known ones. */
enum { ASK_GROUP_NAME = 128 };
status ask_group_quantity(struct store *store, const char *quantity, char name[ASK_GROUP_NAME], struct error *error);
/* What a command shows where the user named nothing (*quantity NULL): the main quantity of the newest campaign, one
 * that a person wrote if there is any, if runs have it, else OUTCOME_DEFAULT. `name` holds it. Else *quantity stays. */
status ask_quantity_main(struct store *store, char name[ASK_GROUP_NAME], const char **quantity, struct error *error);

/* The columns of comma-separated varied inputs (paths or unique endings), at most `most`. "" names no input. */
status ask_group_columns(struct store *store, const char *by, size_t most, char (*columns)[ASK_GROUP_NAME],
                         size_t *count, struct error *error);

/* The names of all result columns of the view runs, one row each. */
struct answer ask_group_quantities(struct store *store, struct error *error);

/* Pairs of points that share seeds and have no input with different values; each point may have inputs that the other
 * lacks. Such a pair appears when a campaign is computed again by a program with a new input. ask_group counts the runs
 * of both. */
struct ask_group_twins {
  int64_t pairs;    /* number of such pairs; 0: the other members are not set */
  int64_t point[2]; /* one pair */
  char input[256];  /* an input that only one of the two points has */
};
status ask_group_twins(struct store *store, struct ask_group_twins *twins, struct error *error);

/* The varied inputs without effect: runs that differ in one of them alone have the same results, bit for bit. Runs that
 * differ in several say nothing. Their words, "strain, angle"; "": none. */
status ask_group_idle(struct store *store, char idle[ASK_GROUP_POOLED], struct error *error);

/* ---- The pairs of points that `clast compare` compares, and their differences. ---- */

struct ask_pairs_group; /* the runs of one point */

struct ask_pairs_side {
  char path[LIMITS_PATH];               /* of the store */
  int64_t excluded;                     /* runs that a person excluded */
  int64_t missing, wanted;              /* ask_run_missing() */
  int64_t left_out;                     /* ask_choice_left_out() */
  struct ask_choice choice;             /* its texts are borrowed from the operands */
  char namesakes[ASK_CAMPAIGN_NUMBERS]; /* of the chosen campaign */
  /* for pairs.c alone */
  char *axes; /* JSON: paths of what it varies */
  bool one_point;
  struct ask_pairs_group *groups;
  struct difference_value *values;
  size_t group_count, group_room, value_count, value_room;
};

struct ask_pairs {
  const char *quantity;
  struct ask_pairs_side side[2];
  /* for pairs.c alone */
  char main[ASK_GROUP_NAME]; /* holds it where the caller named none */
  size_t at, found;          /* the next group of side 0; number of pairs */
};

struct ask_pairs_row {
  int64_t point[2];     /* number of each point in its store */
  const char *inputs;   /* inputs that a side varies; "" when two points were named */
  const char *label[2]; /* varied inputs of each for people: "strain 3 %, angle 4 deg" */
  struct difference difference;
  const struct ask_doubts *doubts[2];
  size_t runs[2];        /* of an exponent also where difference.n is 0: they have none, or none with an interval */
  const char *untold[2]; /* why tables for people show no exponent (pooled_exponent_untold()); NULL: they show it */
  double exponent[2];    /* also one without an interval, which has no difference.mean; NaN: another quantity */
};

/* Reads the values of both sides: STORE, STORE:POINT or STORE:CAMPAIGN. Of an exponent ("beta", estimates_named()) they
 * are the contributions of the runs: pooled_exponent_of_runs(); where a difference is of pairs, those to the exponents
 * of these runs alone. STATUS_USAGE: unknown name; STATUS_MISSING: no such store. */
/* quantity NULL: the main quantity of the first store (ask_quantity_main()). Else borrowed until ask_pairs_free(). */
status ask_pairs_read(const char *first, const char *second, const char *quantity, const struct ask_choice *choice,
                      struct ask_pairs **out, struct error *error);
/* The next pair, in the order of the points of A; its texts are borrowed from `pairs`. False at the end. */
bool ask_pairs_next(struct ask_pairs *pairs, struct ask_pairs_row *row);
/* The points without a partner: "1 of 3 points of a (strain 4 %), 7 of 9 points of b"; "": none. The caller frees
 * *text, also after an error. */
status ask_pairs_alone(const struct ask_pairs *pairs, char **text, struct error *error);
/* The inputs that no side varies and that differ, with both values: "body.wall (0.03 m, 0.04 m)"; "": none. So do
 * scenes, and the names of campaigns with one number. The caller frees *text, also after an error. */
status ask_pairs_apart(const struct ask_pairs *pairs, char **text, struct error *error);
/* After the last pair. STATUS_USAGE: the sides have no point in common. */
status ask_pairs_end(const struct ask_pairs *pairs, struct error *error);
void ask_pairs_free(struct ask_pairs *pairs); /* NULL is fine */
/* Pairs that free themselves where their block is left: ASK_PAIRS pairs = NULL; */
#define ASK_PAIRS __attribute__((cleanup(ask_pairs_drop))) struct ask_pairs *
void ask_pairs_drop(struct ask_pairs **pairs); /* for ASK_PAIRS */

/* ---- One point of a store: the fragment masses of all its runs that count, and the standard estimates made from them.
 * ---- */

struct point_data {
  int64_t point_id, results_version;
  int dimensions;          /* of the engine: 2, 3, or 0: not known */
  struct pooled_runs runs; /* in order of replicate; all fragments, single elements included */
  double element_mass;     /* mean over the runs, kg; NaN when the store holds no estimates of them */
  double complete_mass;    /* mean over the runs, kg: no window begins below this mass; NaN: not known */
  size_t *first;           /* memory that `runs` points to; owned */
  double *masses;
  int64_t *run_id; /* of every run; owned */
  uint64_t *seed;  /* of every run; owned */
};

/* Only runs that count (completed or ended at their time, not surplus), of one results_version (0: the newest with such
 * runs). runs.count is 0 when the point has no such run. STATUS_CONTENT: the store is damaged. */
status point_read(struct store *store, int64_t point_id, int64_t results_version, struct point_data *out,
                  struct error *error);
/* The same, for runs that meet an SQL condition on the view runs. NULL: all. STATUS_USAGE: the condition is no valid
 * SQL. */
status point_read_where(struct store *store, int64_t point_id, int64_t results_version, const char *where,
                        struct point_data *out, struct error *error);
/* Adds the runs of a point to those that *out has, which is a POINT_EMPTY at first; its masses become the largest ones
 * of all points. */
status point_add(struct store *store, int64_t point_id, const char *where, struct point_data *out, struct error *error);
#define POINT_EMPTY(point_, version_)                                                                                  \
  (struct point_data) {                                                                                                \
    .point_id = point_, .results_version = version_, .dimensions = 3, .element_mass = NAN, .complete_mass = NAN        \
  }
#define POINT_DATA __attribute__((cleanup(point_release))) struct point_data
void point_release(struct point_data *point); /* a zeroed one is fine */

/* Lower end of a standard window for this point, kg. */
double point_window(const struct point_data *point, enum estimates_window window);

struct point_estimate {
  enum estimates_window window;
  struct pooled_exponent exponent;
};
enum { POINT_ESTIMATES = 2 * ESTIMATES_WINDOWS }; /* least_squares and masses in each window, in that order */
/* Pooled estimates with their intervals over runs. The same store gives the same numbers. */
status point_estimates(const struct point_data *point, double level, struct point_estimate rows[POINT_ESTIMATES],
                       struct error *error);

/* The same as rows of table point_estimate. */
void point_estimate_rows(const struct point_estimate fits[POINT_ESTIMATES], struct estimate rows[POINT_ESTIMATES]);

/* pooled_exponent_of_runs() in a standard window. `values` has space for point->runs.count numbers. */
status point_exponent_of_runs(const struct point_data *point, enum exponent_method method, enum estimates_window window,
                              double *values, struct error *error);

/* Reads the point and returns one estimate. beta is NaN without runs or with too few fragments. */
status point_exponent(struct store *store, int64_t point_id, int64_t results_version, enum exponent_method method,
                      enum estimates_window window, double level, struct pooled_exponent *out, struct error *error);

/* ---- Runs that are pooled: those of one point, of all points that share some varied inputs, or single ones; with
 * their fragments, or with one of their results. Spectra and scatters are made from pools, so that a choice of runs
 * means the same in a table, a text plot and a picture. ---- */

struct ask_pool_choice {
  int64_t point;  /* only this point; 0: all */
  const char *by; /* comma-separated varied inputs (see ask_group): points that share them are one pool; NULL: a pool
                     per point */
  bool inputs;    /* without `by`: the pools' columns are all varied inputs */
  int dimensions; /* of a program's model, which only the user knows: 2, 3, or 0: not told */
};

enum { ASK_POOL_TEXT = 64, ASK_POOL_LABEL = 256 };
/* Holds only runs that count, of the newest results_version among the points of the pool. */
struct ask_pool {
  char label[ASK_POOL_LABEL]; /* "strain 3 %, angle 4 deg", or "point 7" */
  size_t points;
  int64_t *point;                  /* numbers of the points */
  size_t *first_run;               /* points + 1: the runs of point p are first_run[p] .. first_run[p + 1] - 1 */
  const struct query_value *input; /* of the axes */
  /* without a quantity: fragments of all runs, point after point; complete_mass and element_mass are those of the point
   * where they are largest; point_id is 0 if there are several. With a quantity: only the run ids, no fragments. */
  struct point_data data;
  double *value;            /* with a quantity: of each run, NaN: off or withheld; else NULL */
  struct ask_doubts doubts; /* of the quantity, or of the masses */
};
/* Pools under way. A variable of type ASK_POOLS frees itself where its block is left. */
struct ask_pools {
  struct store *store;
  struct error *error;
  struct ask_pool_choice choice;
  bool of_values;
  char quantity[ASK_GROUP_NAME]; /* column of the values */
  struct sample_range range;     /* they are within it */
  size_t axes;                   /* of `by` or all, and their columns */
  char column[LIMITS_AXES_OF_POOL][ASK_GROUP_NAME];
  struct ask_pool_member *list;
  size_t count, room, next;
  status code;
  struct ask_pool pool; /* the current one; owns its arrays */
};
#define ASK_POOLS __attribute__((cleanup(ask_pools_end))) struct ask_pools

/* Asks for every pool that has a run, in the order of the inputs of `by` or of the points; one pool at a time is in
 * memory. `quantity` NULL: with the fragments of the runs; else with the values of a result column of the view runs
 * (its name or a unique ending of it), without fragments. STATUS_USAGE, at ask_pools_end(): an input or quantity is
 * unknown, or the condition is no valid SQL. */
struct ask_pools ask_pools(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                           struct error *error);
/* The next pool, borrowed until the next call. NULL at the end and after an error. */
const struct ask_pool *ask_pools_next(struct ask_pools *pools);
/* The last call: frees the pools and returns their status. */
status ask_pools_end(struct ask_pools *pools);

/* Dimensions of the engine of the chosen runs, 2, 3, or 0 (not known): masses of 2 are kg per metre. STATUS_USAGE: some
 * are in the plane, and others not, or the choice tells others than the engine has. */
status ask_pool_dimensions(struct store *store, const struct ask_pool_choice *choice, int *dimensions,
                           struct error *error);
const char *ask_pool_mass_unit(int dimensions);     /* "kg/m", "kg" */
const char *ask_pool_per_mass_unit(int dimensions); /* "m/kg", "1/kg" */
/* The row's unit, masses as above. NULL: none. */
const char *ask_result_unit(const struct field *row, int dimensions);

/* The pool in the form that the pooled spectrum needs. Mean and interval are over the runs of a point, or over the
 * points. */
struct pooled_form ask_pool_form(const struct ask_pool *pool, bool cumulative, double density);

/* ---- Ejecta of the impacts of a pool over their speed ---- */

/* Has the store runs of an engine with ejecta? */
status ask_ejecta_known(struct store *store, bool *known, struct error *error);
/* The pools with the momentum of all ejecta as quantity: what marks it, marks the table. */
struct ask_pools ask_ejecta_pools(struct store *store, const struct ask_pool_choice *choice, struct error *error);

struct ask_ejecta {
  size_t runs, without; /* in the means; with ejecta, but of an older program, which did not store them */
  size_t count;
  struct ask_ejecta_row {
    double speed, upper; /* m/s: of the bin */
    /* Of all target matter that leaves at `speed` or faster: kg, kg m/s. Means over the runs of a point, or over the
     * points, with their 95 % intervals. */
    struct ask_ejecta_mean {
      double mean, half_width;
    } mass, momentum;
  } row[EJECTA_BINS]; /* by ascending speed */
};
/* From the slowest bin to the fastest one in which a run has ejecta. Runs whose value is off or withheld are left out.
 */
status ask_ejecta(struct store *store, const struct ask_pool *pool, struct ask_ejecta *out, struct error *error);

/* ---- The data of a page of `clast report`: a small SQLite file, made in memory, with tables that have the names and
 * columns of the store's views. Queries of the page and of its readers work on both.
 *
 *   runs, points, spectra   of the store's views; `runs` and `spectra` thinned, results rounded to 7 digits
 *   estimates               those of points
 *   means                   n, mean, sd and hw95 of the results that are not in `points`, a row for each point
 *   quantile                of the first main result: value and 95 % interval, of up to 200 points
 *   modes                   of all results, at the points whose runs have two modes
 *   doubt                   of each point the runs that count with words in `warnings`
 *   doubt_mark              the results that these words mark (`marks`: which of the words) or withhold; also beta
 *   doubt_word              what each condition says
 *   resolution              of the store's view: what finer settings may change, where `clast converge` was used
 *   campaign, session, attempt, axis, column_doc   of the store's tables
 *   question                the canned queries that work here
 *   label, fact, picture, difference, fixed_axis   filled in by the caller ---- */

enum { ASK_PAGE_RUNS = 10000 }; /* most single runs of a page */

struct ask_page; /* opaque */

/* Statistics are of all runs. Single runs are limited in number (the first replicates of every point are kept), and so
 * are the results of single runs. Facts record what was left out. */
status ask_page_make(struct store *store, struct ask_page **out, struct error *error);
void ask_page_free(struct ask_page *page); /* NULL is fine */

/* A sentence or a number about the page. */
status ask_page_fact(struct ask_page *page, const char *name, const char *value, struct error *error);
/* The readable name of a column, the unit in which it is shown, and the SI value `factor` of one such unit. */
status ask_page_label(struct ask_page *page, const char *column, const char *label, const char *unit, double factor,
                      struct error *error);
/* Makes the table `fixed_axis`: of these inputs the rows of the store's table axis that the chosen part of it does not
 * have, as it does not vary them. */
status ask_page_fixed(struct ask_page *page, struct store *store, size_t count, const struct ask_column input[],
                      struct error *error);
/* All columns of the page that have no label yet, one row each: inputs that were varied, and results. */
struct answer ask_page_columns(struct ask_page *page, struct error *error);

/* The runs whose fields are kept: the medians of all points first, then the smallest and the largest values, then the
 * others. A row: run, point, quantile of the point's main quantity (0: the smallest value; of the others NULL), and the
 * file (ask_run_fields). */
struct answer ask_page_kept(struct store *store, struct error *error);
/* Adds the picture of the current row of ask_page_kept. */
status ask_page_picture(struct ask_page *page, const struct answer *kept, const void *png, size_t size,
                        struct error *error);

/* The difference of a result: a point of this store minus a point of the page's first store. */
status ask_page_difference(struct ask_page *page, const char *quantity, int64_t first_point, int64_t point,
                           const struct difference *difference, struct error *error);

/* The file's contents; the caller frees *bytes. */
status ask_page_file(struct ask_page *page, unsigned char **bytes, size_t *size, struct error *error);
