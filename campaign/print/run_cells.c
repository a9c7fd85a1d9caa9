/* Collects the runs of cells and keeps the seeds that all cells have. */
#include "campaign/print/run_cells.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"

static int by_seed(const void *a, const void *b) {
  const int64_t p = ((const struct run_cells_run *)a)->seed, q = ((const struct run_cells_run *)b)->seed;
  return p < q ? -1 : p > q;
}

static status no_memory(struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory for the runs of the points");
}

static status add_cell(struct run_cells *cells, const struct ask_pool *pool, struct error *error) {
  if (!grow_room(&cells->cell, &cells->room, cells->count + 1, sizeof *cells->cell))
    return no_memory(error);
  struct run_cell *cell = &cells->cell[cells->count++];
  *cell = (struct run_cell){.run = malloc((pool->data.runs.count + 1) * sizeof *cell->run)};
  cells->axes = pool->axes;
  memcpy(cells->column, pool->column, sizeof cells->column);
  for (size_t a = 0; a < pool->axes; a++) {
    char text[ASK_POOL_TEXT] = "off";
    if (pool->input[a].kind == QUERY_TEXT)
      snprintf(text, sizeof text, "%s", pool->input[a].text);
    else if (pool->input[a].kind != QUERY_NULL)
      snprintf(text, sizeof text, "%.17g", pool->input[a].real);
    cell->input[a] = strdup(text);
    if (!cell->input[a])
      return no_memory(error);
  }
  if (!cell->run)
    return no_memory(error);
  for (size_t r = 0; r < pool->data.runs.count; r++)
    if (isfinite(pool->value[r]))
      cell->run[cell->runs++] = (struct run_cells_run){pool->seed[r], pool->value[r]};
  qsort(cell->run, cell->runs, sizeof *cell->run, by_seed);
  return STATUS_OK;
}

status run_cells_read(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                      struct run_cells *cells, struct error *error) {
  ASK_POOLS pools = ask_pools(store, choice, quantity, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)
    TRY(add_cell(cells, pool, error));
  return ask_pools_end(&pools);
}

void run_cells_release(struct run_cells *cells) {
  for (size_t c = 0; c < cells->count; c++) {
    free(cells->cell[c].run);
    for (size_t a = 0; a < cells->axes; a++)
      free(cells->cell[c].input[a]);
  }
  free(cells->cell);
  *cells = (struct run_cells){0};
}

/* Runs of the first cell whose seed every cell has; *shared has room for them. */
static size_t find_shared(size_t count, struct run_cell *const *cell, struct run_cells_run *shared) {
  size_t common = 0;
  for (size_t r = 0; r < cell[0]->runs; r++) {
    size_t c = 1;
    while (c < count && bsearch(&cell[0]->run[r], cell[c]->run, cell[c]->runs, sizeof *shared, by_seed))
      c++;
    if (c >= count)
      shared[common++] = cell[0]->run[r];
  }
  return common;
}

/* Keeps the runs of a cell with these seeds. The cell has all of them; both lists are ascending. */
static void keep_shared(struct run_cell *cell, const struct run_cells_run *shared, size_t common) {
  size_t from = 0;
  for (size_t r = 0; r < common; r++, from++) {
    while (cell->run[from].seed != shared[r].seed)
      from++;
    cell->run[r] = cell->run[from];
  }
  cell->runs = common;
}

size_t run_cells_balance(size_t count, struct run_cell *const *cell, bool *same_seeds) {
  size_t least = SIZE_MAX;
  *same_seeds = false;
  for (size_t c = 0; c < count; c++)
    least = cell[c]->runs < least ? cell[c]->runs : least;
  if (count == 0 || least == 0)
    return 0;
  struct run_cells_run *shared = malloc(cell[0]->runs * sizeof *shared);
  const size_t common = shared ? find_shared(count, cell, shared) : 0;
  *same_seeds = common >= 2 || (common == 1 && least == 1);
  for (size_t c = 0; *same_seeds && c < count; c++)
    keep_shared(cell[c], shared, common);
  free(shared);
  return *same_seeds ? common : least;
}
