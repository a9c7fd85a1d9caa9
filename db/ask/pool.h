/* Runs that are pooled: those of one point, of all points that share some varied inputs, or single ones; with their
 * fragments, or with one of their results. Spectra and scatters are made from pools, so that a choice of runs means the
 * same in a table, a text plot and a picture. */
#ifndef CLAST_DB_ASK_POOL_H
#define CLAST_DB_ASK_POOL_H

#include "db/ask/group.h"
#include "db/ask/point.h"

struct ask_pool_choice {
  int64_t point;     /* only this point; 0: all */
  const char *where; /* only runs that meet this SQL condition on the view runs; NULL: all */
  const char *by;    /* comma-separated varied inputs (see ask_group): points that share them are one pool; NULL: a pool
                        per point */
};

enum { ASK_POOL_AXES = 16, ASK_POOL_TEXT = 64, ASK_POOL_LABEL = 256 };
/* Holds only runs that count, of the newest results_version among the points of the pool. */
struct ask_pool {
  char label[ASK_POOL_LABEL]; /* "strain 0.03, angle 0.0698 rad", or "point 7" */
  size_t points;
  const int64_t *point;    /* numbers of the points */
  const size_t *first_run; /* points + 1: the runs of point p are first_run[p] .. first_run[p + 1] - 1 */
  size_t axes;             /* of `by` */
  char column[ASK_POOL_AXES][ASK_GROUP_NAME];
  struct query_value input[ASK_POOL_AXES];
  /* without a quantity: fragments of all runs, point after point; complete_mass and element_mass are those of the point
   * where they are largest; point_id is 0 if there are several. With a quantity: only the run ids, no fragments. */
  struct point_data data;
  const double *value; /* with a quantity: of each run, NaN: off; else NULL */
  const int64_t *seed; /* with a quantity: of each run */
};
/* Pools under way. A variable of type ASK_POOLS frees itself where its block is left. */
struct ask_pools {
  struct store *store;
  struct error *error;
  struct ask_pool_choice choice;
  bool of_values;
  char quantity[ASK_GROUP_NAME]; /* column of the values */
  size_t axes;
  char column[ASK_POOL_AXES][ASK_GROUP_NAME];
  struct ask_pool_member *list;
  size_t count, room, next;
  status code;
  /* memory of the current pool */
  struct ask_pool pool;
  int64_t *point;
  size_t *first_run;
  double *value;
  int64_t *seed;
};
#define ASK_POOLS __attribute__((cleanup(ask_pools_drop))) struct ask_pools

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
void ask_pools_drop(struct ask_pools *pools); /* for ASK_POOLS */

/* Dimensions of the engine of the store's first point, 2 or 3: masses in the plane are kg per metre. */
status ask_pool_dimensions(struct store *store, int *dimensions, struct error *error);

/* The pool in the form that the pooled spectrum needs. Mean and interval are over the runs of a point, or over the
 * points. */
struct pooled_form ask_pool_form(const struct ask_pool *pool, bool cumulative, double density);

#endif
