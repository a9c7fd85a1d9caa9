/* The values of a result in cells, one for each set of varied inputs, with the seeds that the cells share: the input of
 * variance splits and sensitivity indices. */
#ifndef CLAST_CAMPAIGN_PRINT_RUN_CELLS_H
#define CLAST_CAMPAIGN_PRINT_RUN_CELLS_H

#include <stdbool.h>

#include "db/ask/pool.h"

struct run_cells_run {
  int64_t seed;
  double value;
};
struct run_cell {
  size_t runs;
  struct run_cells_run *run;  /* by seed */
  char *input[ASK_POOL_AXES]; /* as text: a number with 17 digits, a choice, "off" */
};
struct run_cells {
  size_t axes, count, room;
  char column[ASK_POOL_AXES][ASK_GROUP_NAME];
  struct run_cell *cell;
};

/* Adds a cell per pool of ask_pools to `cells`, which is zeroed before the first call. */
status run_cells_read(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                      struct run_cells *cells, struct error *error);
void run_cells_release(struct run_cells *cells);

/* Puts runs with the same seeds first in all cells: the seeds that all cells have, if there are at least two (or one,
 * and some cell has only one run). Otherwise takes as many runs as every cell has, with any seeds. Returns the number
 * of runs per cell. */
size_t run_cells_balance(size_t count, struct run_cell *const *cell, bool *same_seeds);

#endif
