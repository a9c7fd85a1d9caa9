/* The variance of a result over the points and seeds of a store, split into inputs and seeds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/scatter_print.h"
#include "db/ask/columns.h"

struct cell { /* the runs of one point, in the order of their seeds */
  size_t runs;
  struct seeded {
    int64_t seed;
    double value;
  } * run;
  char *input[ASK_POOL_AXES];
};
struct cells {
  size_t axes, count, room;
  char column[ASK_POOL_AXES][ASK_GROUP_NAME];
  struct cell *cell;
};

static int by_seed(const void *a, const void *b) {
  const int64_t p = ((const struct seeded *)a)->seed, q = ((const struct seeded *)b)->seed;
  return p < q ? -1 : p > q;
}

static status take_cell(void *context, const struct ask_pool *pool, struct error *error) {
  struct cells *cells = context;
  if (cells->count == cells->room) {
    const size_t room = cells->room ? 2 * cells->room : 64;
    struct cell *grown = realloc(cells->cell, room * sizeof *grown);
    if (!grown)
      return status_fail(error, STATUS_MEMORY, "no memory for the points");
    cells->cell = grown;
    cells->room = room;
  }
  struct cell *cell = &cells->cell[cells->count++];
  *cell = (struct cell){.run = malloc((pool->data.runs.count + 1) * sizeof *cell->run)};
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
      return status_fail(error, STATUS_MEMORY, "no memory for the points");
  }
  if (!cell->run)
    return status_fail(error, STATUS_MEMORY, "no memory for the runs");
  for (size_t r = 0; r < pool->data.runs.count; r++)
    if (isfinite(pool->value[r]))
      cell->run[cell->runs++] = (struct seeded){pool->seed[r], pool->value[r]};
  qsort(cell->run, cell->runs, sizeof *cell->run, by_seed);
  return STATUS_OK;
}

/* Leaves the seeds that all points have, if there are two at least; else as many runs as every point has. */
static size_t balance(struct cells *cells) {
  size_t least = SIZE_MAX, common = 0;
  for (size_t c = 0; c < cells->count; c++)
    least = cells->cell[c].runs < least ? cells->cell[c].runs : least;
  if (cells->count == 0 || least < 2)
    return least;
  struct seeded *first = malloc(cells->cell[0].runs * sizeof *first);
  for (size_t r = 0; first && r < cells->cell[0].runs; r++) {
    bool everywhere = true;
    for (size_t c = 1; everywhere && c < cells->count; c++)
      everywhere = bsearch(&cells->cell[0].run[r], cells->cell[c].run, cells->cell[c].runs, sizeof *first, by_seed);
    if (everywhere)
      first[common++] = cells->cell[0].run[r];
  }
  for (size_t c = 0; common >= 2 && c < cells->count; c++)
    for (size_t r = 0; r < common; r++) {
      const struct seeded *found = bsearch(&first[r], cells->cell[c].run, cells->cell[c].runs, sizeof *first, by_seed);
      cells->cell[c].run[r] = *found; /* common seeds ascend: place r is not needed any more */
    }
  free(first);
  return common >= 2 ? common : least;
}

/* Numbers the values of each axis in the order of their first points. */
static void number_levels(const struct cells *cells, uint32_t *level) {
  for (size_t a = 0; a < cells->axes; a++) {
    uint32_t next = 0;
    for (size_t c = 0; c < cells->count; c++) {
      size_t same = 0;
      while (strcmp(cells->cell[same].input[a], cells->cell[c].input[a]) != 0)
        same++;
      level[c * cells->axes + a] = same < c ? level[same * cells->axes + a] : next++;
    }
  }
}

static status split(struct cells *cells, struct scatter_part *parts, size_t *runs, struct error *error) {
  *runs = balance(cells);
  if (cells->count < 2 || *runs < 2)
    return status_fail(error, STATUS_USAGE, "a variance is split over two points at least with two runs each");
  uint32_t *level = malloc((cells->count * cells->axes + 1) * sizeof *level);
  double *value = malloc(cells->count * *runs * sizeof *value);
  status code = level && value ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory to split a variance");
  for (size_t c = 0; code == STATUS_OK && c < cells->count; c++)
    for (size_t r = 0; r < *runs; r++)
      value[c * *runs + r] = cells->cell[c].run[r].value;
  if (code == STATUS_OK) {
    number_levels(cells, level);
    const struct scatter_table table = {cells->count, *runs, cells->axes, level, value};
    code = scatter_split(&table, parts, error);
  }
  free(level);
  free(value);
  return code;
}

static status print(const struct cells *cells, const struct scatter_part *parts, enum table_format format,
                    struct error *error) {
  static const char *const names[SCATTER_PARTS] = {"all inputs together", "seeds", "seeds, in all points alike",
                                                   "whole"};
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"part", "variance", "share", "low", "high", NULL});
  for (size_t i = 0; i < cells->axes + SCATTER_PARTS; i++) {
    table_text(table, i < cells->axes ? cells->column[i] : names[i - cells->axes]);
    table_real(table, parts[i].variance);
    table_real(table, parts[i].share);
    table_real(table, parts[i].share - parts[i].half_width);
    table_real(table, parts[i].share + parts[i].half_width);
  }
  return table_end(table, error);
}

status scatter_print_split(struct store *store, const struct scatter_choice *choice, enum table_format format,
                           struct error *error) {
  struct ask_column axis[ASK_POOL_AXES];
  struct cells cells = {0};
  struct scatter_part parts[ASK_POOL_AXES + SCATTER_PARTS];
  char by[ASK_POOL_AXES * (sizeof axis[0].name + 1)] = "";
  size_t axes = 0, runs = 0;
  struct ask_pool_choice pool = choice->pool;
  status code = ask_columns_axes(store, ASK_POOL_AXES, axis, &axes, error);
  for (size_t a = 0, used = 0; a < axes; a++)
    used += (size_t)snprintf(by + used, sizeof by - used, "%s%.127s", a ? "," : "", axis[a].name);
  if (!pool.by)
    pool.by = by;
  if (code == STATUS_OK)
    code = ask_pool_values(store, &pool, choice->quantity, take_cell, &cells, error);
  if (code == STATUS_OK)
    code = split(&cells, parts, &runs, error);
  if (code == STATUS_OK)
    code = print(&cells, parts, format, error);
  if (code == STATUS_OK && format == TABLE_TEXT)
    fprintf(stderr,
            "clast: %zu points with %zu seeds each, which count alike. An input: variance of its means over the other "
            "inputs; what the inputs together have beyond their sum is their interplay. Low, high: 95 %% interval over "
            "seeds\n",
            cells.count, runs);
  for (size_t c = 0; c < cells.count; c++) {
    free(cells.cell[c].run);
    for (size_t a = 0; a < ASK_POOL_AXES; a++)
      free(cells.cell[c].input[a]);
  }
  free(cells.cell);
  return code;
}
