/* Reads the runs of a design block by block, and prints its indices. */
#include "campaign/print/sensitivity_print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/sensitivity.h"
#include "campaign/document/sensitivity_design.h"
#include "campaign/print/run_cells.h"
#include "schemas/text.h"

struct reading {
  const struct campaign *campaign;
  enum design_sensitivity_kind kind;
  size_t blocks, points; /* points of a block */
  struct run_cells cells;
  struct run_cell **place; /* cell of each row of the design; NULL: the store has no run of it */
  size_t *block;           /* the complete blocks, in their order */
  size_t whole;
  double *value;
  struct sensitivity_table table;
};

/* Writes an input in the same form as run_cells. */
static void write_input(const struct campaign *campaign, size_t a, size_t i, char text[ASK_POOL_TEXT]) {
  const struct design_axis *axis = &campaign->axes[a];
  const struct field_value *value = &axis->levels[i];
  if (axis->row->kind == FIELD_REAL && field_is_off(value->number))
    snprintf(text, ASK_POOL_TEXT, "off");
  else if (axis->row->kind == FIELD_REAL || axis->row->kind == FIELD_BOOLEAN)
    snprintf(text, ASK_POOL_TEXT, "%.17g", value->number);
  else if (axis->row->kind == FIELD_INTEGER)
    snprintf(text, ASK_POOL_TEXT, "%.17g", (double)value->integer);
  else
    snprintf(text, ASK_POOL_TEXT, "%.63s", value->text);
}

static int by_inputs(const void *a, const void *b) {
  const struct run_cell *p = a, *q = b;
  for (size_t i = 0; i < ASK_POOL_AXES && p->input[i] && q->input[i]; i++) {
    const int order = strcmp(p->input[i], q->input[i]);
    if (order)
      return order;
  }
  return 0;
}

/* Finds the cell of every row, and the blocks of which all cells exist. */
static void find_places(struct reading *r) {
  const size_t n = r->campaign->axis_count;
  char text[ASK_POOL_AXES][ASK_POOL_TEXT];
  if (r->cells.count > 0)
    qsort(r->cells.cell, r->cells.count, sizeof *r->cells.cell, by_inputs);
  for (size_t b = 0; b < r->blocks; b++) {
    bool whole = true;
    for (size_t i = b * r->points; i < (b + 1) * r->points; i++) {
      struct run_cell wanted = {.input = {NULL}};
      for (size_t a = 0; a < n; a++) {
        write_input(r->campaign, a, i, text[a]);
        wanted.input[a] = text[a];
      }
      r->place[i] = r->cells.count ? bsearch(&wanted, r->cells.cell, r->cells.count, sizeof *r->cells.cell, by_inputs)
                                   : NULL;
      whole = whole && r->place[i] && r->place[i]->runs > 0;
    }
    if (whole)
      r->block[r->whole++] = b;
  }
}

/* Two rows may be the same point, which run_cells_balance may get only once. */
static int by_address(const void *a, const void *b) {
  const struct run_cell *p = *(struct run_cell *const *)a, *q = *(struct run_cell *const *)b;
  return p < q ? -1 : p > q;
}

static status fill_table(struct reading *r, struct error *error) {
  const size_t rows = r->whole * r->points;
  struct run_cell **used = malloc((rows + 1) * sizeof *used);
  size_t count = 0;
  if (!used)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu points", rows);
  for (size_t i = 0; i < rows; i++)
    used[i] = r->place[r->block[i / r->points] * r->points + i % r->points];
  qsort(used, rows, sizeof *used, by_address);
  for (size_t i = 0; i < rows; i++)
    if (i == 0 || used[i] != used[i - 1])
      used[count++] = used[i];
  r->table = (struct sensitivity_table){.inputs = r->campaign->axis_count, .blocks = r->whole};
  r->table.seeds = run_cells_balance(count, used, &r->table.same_seeds);
  free(used);
  r->value = malloc((rows * r->table.seeds + 1) * sizeof *r->value);
  if (!r->value)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu points", rows);
  for (size_t i = 0; i < rows; i++)
    for (size_t s = 0; s < r->table.seeds; s++)
      r->value[i * r->table.seeds + s] = r->place[r->block[i / r->points] * r->points + i % r->points]->run[s].value;
  r->table.value = r->value;
  return STATUS_OK;
}

static status read_runs(struct store *store, const char *quantity, struct reading *r, struct error *error) {
  const struct campaign *campaign = r->campaign;
  const size_t n = campaign->axis_count;
  char by[ASK_POOL_AXES * ASK_GROUP_NAME] = "";
  if (n > ASK_POOL_AXES)
    return status_fail(error, STATUS_USAGE, "at most %d inputs, not %zu", ASK_POOL_AXES, n);
  for (size_t a = 0; a < n; a++)
    text_append(by, sizeof by, "%s%s", a ? "," : "", campaign->axes[a].row->path);
  const struct ask_pool_choice choice = {.by = by};
  TRY(run_cells_read(store, &choice, quantity, &r->cells, error));
  r->place = calloc(r->blocks * r->points + 1, sizeof *r->place);
  r->block = calloc(r->blocks + 1, sizeof *r->block);
  if (!r->place || !r->block)
    return status_fail(error, STATUS_MEMORY, "no memory for a design");
  find_places(r);
  if (r->whole < 2)
    return status_fail(error, STATUS_USAGE,
                       "the store has finished runs of %zu of the %zu blocks of this design, and the indices need two: "
                       "compute it with `clast run` into this store",
                       r->whole, r->blocks);
  return fill_table(r, error);
}

static void interval(struct table *table, const struct sample_interval *i) {
  table_real(table, i->estimate);
  table_real(table, i->half_width);
}

static status print_sobol(const struct reading *r, enum table_format format, struct error *error) {
  struct sensitivity_index index[ASK_POOL_AXES + 1];
  const size_t n = r->table.inputs;
  const status code = sensitivity_sobol(&r->table, index, error);
  if (code)
    return code;
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"input", "first", "first_hw95", "total", "total_hw95", NULL});
  for (size_t i = 0; i <= n; i++) {
    table_text(table, i < n ? r->campaign->axes[i].row->path : "seed");
    interval(table, &index[i].first);
    interval(table, &index[i].total);
  }
  if (format == TABLE_TEXT)
    fprintf(
        stderr,
        "clast: Sobol indices, shares of the variance, of %zu blocks with %zu %s. first: of the input alone; total: "
        "with what it does together with others\n",
        r->whole, r->table.seeds,
        r->table.seeds == 1   ? "seed, of which nothing is known: give the campaign several"
        : r->table.same_seeds ? "seeds, the same at all points"
                              : "seeds, different ones at each point");
  return table_end(table, error);
}

static status print_morris(const struct reading *r, enum table_format format, struct error *error) {
  const size_t n = r->table.inputs;
  struct sensitivity_effect effect[ASK_POOL_AXES];
  size_t *all = malloc(n * r->blocks * sizeof *all), *order = malloc(n * r->blocks * sizeof *order);
  double *steps = malloc(n * r->blocks * sizeof *steps), *step = malloc(n * r->blocks * sizeof *step);
  status code = all && order && steps && step ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a design");
  if (code == STATUS_OK) {
    sensitivity_design_steps(r->campaign, r->blocks, all, steps);
    for (size_t b = 0; b < r->whole; b++) {
      memcpy(order + b * n, all + r->block[b] * n, n * sizeof *order);
      memcpy(step + b * n, steps + r->block[b] * n, n * sizeof *step);
    }
    code = sensitivity_morris(&r->table, order, step, effect, error);
  }
  struct table *table = code == STATUS_OK ? table_new(format, stdout) : NULL;
  if (table) {
    table_columns(table, (const char *const[]){"input", "mean_absolute", "mean_absolute_hw95", "mean", "deviation",
                                               "noise", NULL});
    for (size_t i = 0; i < n; i++) {
      table_text(table, r->campaign->axes[i].row->path);
      interval(table, &effect[i].mean_absolute);
      table_real(table, effect[i].mean);
      table_real(table, effect[i].deviation);
      table_real(table, effect[i].noise);
    }
    if (format == TABLE_TEXT)
      fprintf(stderr,
              "clast: elementary effects of %zu trajectories, for the whole range of an input. deviation: large beside "
              "mean_absolute if the input is curved or acts with others; noise: what seeds alone would make\n",
              r->whole);
    code = table_end(table, error);
  }
  free(all);
  free(order);
  free(steps);
  free(step);
  return code;
}

status sensitivity_print(struct store *store, const char *path, const char *quantity, enum table_format format,
                         struct error *error) {
  struct campaign *campaign = NULL;
  struct reading r = {0};
  status code = campaign_load(path, &campaign, error);
  if (code)
    return code;
  r.campaign = campaign;
  code = sensitivity_design_find(campaign, &r.kind, &r.blocks, error);
  r.points = campaign->axis_count + (r.kind == DESIGN_SENSITIVITY_SALTELLI ? 2 : 1);
  if (code == STATUS_OK)
    code = read_runs(store, quantity, &r, error);
  if (code == STATUS_OK && r.whole < r.blocks)
    fprintf(stderr, "clast: %zu of %zu blocks lack a finished run and are left out\n", r.blocks - r.whole, r.blocks);
  if (code == STATUS_OK)
    code = r.kind == DESIGN_SENSITIVITY_SALTELLI ? print_sobol(&r, format, error) : print_morris(&r, format, error);
  run_cells_release(&r.cells);
  free(r.place);
  free(r.block);
  free(r.value);
  campaign_free(campaign);
  return code;
}
