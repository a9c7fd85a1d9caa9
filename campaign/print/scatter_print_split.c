/* The variance of a result over the points and seeds of a store, split into inputs and seeds. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/print/run_cells.h"
#include "campaign/print/scatter_print.h"
#include "db/ask/columns.h"
#include "schemas/text.h"

/* Numbers the values of each axis in the order of their first points. */
static void number_levels(const struct run_cells *cells, uint32_t *level) {
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

static status split(struct run_cells *cells, struct scatter_part *parts, size_t *runs, struct error *error) {
  struct run_cell **all = malloc((cells->count + 1) * sizeof *all);
  bool same_seeds;
  if (!all)
    return status_fail(error, STATUS_MEMORY, "no memory to split a variance");
  for (size_t c = 0; c < cells->count; c++)
    all[c] = &cells->cell[c];
  *runs = run_cells_balance(cells->count, all, &same_seeds);
  free(all);
  if (cells->count < 2 || *runs < 2)
    return status_fail(error, STATUS_USAGE, "splitting a variance needs at least two points with two runs each");
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

static status print(const struct run_cells *cells, const struct scatter_part *parts, enum table_format format,
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
  struct run_cells cells = {0};
  struct scatter_part parts[ASK_POOL_AXES + SCATTER_PARTS];
  char by[ASK_POOL_AXES * (sizeof axis[0].name + 1)] = "";
  size_t axes = 0, runs = 0;
  struct ask_pool_choice pool = choice->pool;
  status code = ask_columns_axes(store, false, ASK_POOL_AXES, axis, &axes, error);
  for (size_t a = 0; a < axes; a++)
    text_append(by, sizeof by, "%s%s", a ? "," : "", axis[a].name);
  if (!pool.by)
    pool.by = by;
  if (code == STATUS_OK)
    code = run_cells_read(store, &pool, choice->quantity, &cells, error);
  if (code == STATUS_OK)
    code = split(&cells, parts, &runs, error);
  if (code == STATUS_OK)
    code = print(&cells, parts, format, error);
  if (code == STATUS_OK && format == TABLE_TEXT)
    fprintf(stderr,
            "clast: %zu points with %zu seeds each, which count alike. An input: variance of its means over the other "
            "inputs (in a full grid; else ask `clast sensitivity`); what the inputs together have beyond their sum is "
            "their interplay. Low, high: 95 %% interval over seeds\n",
            cells.count, runs);
  run_cells_release(&cells);
  return code;
}
