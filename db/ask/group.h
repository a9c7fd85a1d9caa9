/* Statistics of runs grouped by varied inputs, and the names of inputs and results that users abbreviate. */
#ifndef CLAST_DB_ASK_GROUP_H
#define CLAST_DB_ASK_GROUP_H

#include "db/ask/answer.h"

/* points, n, failed, censored, and of each quantity mean, standard deviation, standard error, 95 % half width,
 * resolution error and its verdict (the worst of all points, db/ask/resolution.h), of all runs that share the named
 * axes. A group of one point is a sample of runs (seeds). A group of several points pools over other inputs: its points
 * are the units, each with the mean of its runs, and the interval is that of a mean over such points; the scatter
 * between points includes that of the seeds. `pooled` names these inputs ("threshold.angle, material.m"; "": every
 * group has one point).
 *
 * `by`: comma-separated paths of varied inputs or unique suffixes of one ("m,k"); "" pools everything. `quantities`:
 * comma-separated result columns or unique suffixes; NULL = the main ones. Results of different results_version are
 * different rows. Registers the functions of answer.h. STATUS_USAGE names the known axes and quantities. */
enum { ASK_GROUP_POOLED = 512 };
struct answer ask_group(struct store *store, const char *by, const char *quantities, char pooled[ASK_GROUP_POOLED],
                        struct error *error);

/* The full name of one result column of the view runs from a unique ending of it. STATUS_USAGE names the known ones. */
enum { ASK_GROUP_NAME = 128 };
status ask_group_quantity(struct store *store, const char *quantity, char name[ASK_GROUP_NAME], struct error *error);

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

#endif
