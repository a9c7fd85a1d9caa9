/* How runs scatter, as rows and a picture; and the shares of inputs and seeds in the variance of a result, as
 * sensitivity indices of any points and of a design. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/print/print.h"
#include "campaign/terminal/words.h"
#include "engine/grow.h"
#include "schemas/memory.h"

enum { COLUMNS = 100 };

struct printing {
  bool people;
  const struct scatter_choice *choice;
  struct table *table;
  const struct ask_pools *pools;
  const struct ask_pool *pool;
};

static void row(const struct printing *printing, const char *name, double value, double low, double high) {
  print_pool_cells(printing->table, printing->pools, printing->pool);
  table_text(printing->table, name);
  if (strcmp(name, "runs") != 0)
    table_rests_on(printing->table, &printing->pool->doubts);
  table_interval(printing->table, value, low, high);
  table_doubt_cells(printing->table, &printing->pool->doubts);
}

/* Runs that the mean needs for the wanted interval, in a table and by the rule of a campaign, from the standard
 * deviation. Runs without a value tell nothing: as many are needed beside the others. The rule counts withheld values,
 * too. */
static void print_runs_needed(const struct printing *printing, const struct sample_summary *mean) {
  const struct scatter_choice *choice = printing->choice;
  const double wanted = choice->half_width * (choice->relative ? fabs(mean->mean) : 1);
  const bool share = printing->pools->range.share;
  const size_t runs = share ? scatter_runs_of_share(mean->mean, mean->standard_deviation, wanted)
                            : scatter_runs_needed(mean->standard_deviation, wanted);
  const size_t by_rule = scatter_runs_of_rule(mean->mean, mean->standard_deviation, wanted, share);
  const double all = (double)printing->pool->data.runs.count, values = (double)mean->n;
  const double raw = values + (double)printing->pool->doubts.withheld;
  row(printing, "runs needed", runs ? ceil((double)runs * all / values) : (double)NAN, NAN, NAN);
  row(printing, "runs needed, seeds.until",
      by_rule ? SAMPLE_BATCH * ceil((double)by_rule * all / raw / SAMPLE_BATCH) : (double)NAN, NAN, NAN);
}

static void print_scatter(const struct printing *printing, struct scatter *s) {
  static const char *const names[SCATTER_QUANTILES] = {"q05", "q25", "median", "q75", "q95"};
  const double deviation = s->mean.standard_deviation;
  sample_in_range(&s->mean, &printing->pools->range, 0.95);
  row(printing, "runs", (double)s->n, NAN, NAN);
  row(printing, printing->people && s->mean.weak ? "mean (weak: few runs)" : "mean", s->mean.mean, s->mean.low,
      s->mean.high);
  if (s->mean.weak && !printing->people)
    row(printing, "mean is weak", 1, NAN, NAN);
  row(printing, "standard deviation", deviation, NAN, NAN);
  row(printing, "skewness", s->skewness, NAN, NAN);
  for (int q = 0; q < SCATTER_QUANTILES; q++)
    row(printing, names[q], s->quantile[q].value, s->quantile[q].low, s->quantile[q].high);
  if (!printing->people || isfinite(s->dip_share)) {
    row(printing, printing->people ? "distance from one peak" : "dip", s->dip, NAN, NAN);
    row(printing, printing->people ? "p of one peak" : "dip p", s->dip_share, NAN, NAN);
  }
  if (isfinite(s->between)) {
    row(printing, "lower mode", s->lower_mode, s->sorted[0], s->between);
    row(printing, "upper mode", s->upper_mode, s->between, s->sorted[s->n - 1]);
    row(printing, "share of upper mode", s->upper_share, s->upper_low, s->upper_high);
  }
  if (isfinite(printing->choice->half_width))
    print_runs_needed(printing, &s->mean);
}

status print_scatter_rows(struct store *store, const struct scatter_choice *choice, enum table_format format,
                          struct error *error) {
  struct ask_pool_choice pool_choice = choice->pool;
  pool_choice.inputs = table_for_people(format);
  ASK_POOLS pools = ask_pools(store, &pool_choice, choice->quantity, error);
  TRY(pools.code);
  TABLE table = table_new(format, stdout);
  struct printing printing = {.people = table_for_people(format), .choice = choice, .table = table, .pools = &pools};
  print_pool_columns(table, &pools);
  table_column(table, "statistic", NULL);
  table_interval_columns(table, "value", "low", "high");
  table_doubt_columns(table);
  struct ask_doubts doubts = {0};
  bool several = false; /* a pool has more than one point */
  while (!table_broken(table) && (printing.pool = ask_pools_next(&pools))) {
    SCATTER scatter = {0};
    several |= printing.pool->points > 1;
    ask_doubts_add(&doubts, &printing.pool->doubts);
    TRY(scatter_make(printing.pool->data.runs.count, printing.pool->value, &scatter, error));
    print_scatter(&printing, &scatter);
  }
  TRY(ask_pools_end(&pools));
  TRY(table_end(table, error));
  if (table_for_people(format)) {
    uncertainty_doubts(&doubts, stderr);
    words_print(
        stderr, "",
        "clast: values of %s. \xc2\xb1 and (a to b): 95 %% intervals over runs; of a mode, the values that belong to "
        "it. Modes "
        "are peaks; p of one peak below 0.05: the runs have two. Fewer than %d runs tell neither modes nor skewness",
        pools.quantity, SCATTER_SHAPE_RUNS);
  }
  if (table_for_people(format) && isfinite(choice->half_width))
    words_print(
        stderr, "",
        "clast: runs needed: for this half width in a table, and until seeds.until ends, if the scatter stays "
        "as it is. The rule looks in steps of %d runs from %d on. It takes Student's interval, made wider so "
        "that values which are alike by chance do not end it: about 58 runs where Student's needs 30, 105 for 90 "
        "and 227 for 220. In a table a share has a wider interval than Student's",
        SAMPLE_BATCH, SAMPLE_FIRST);
  if (several)
    fputs("clast: pooled over points: the scatter holds that of the inputs; the intervals take the runs as "
          "independent\n",
          stderr);
  return STATUS_OK;
}

struct samples {
  size_t count;
  struct scatter scatter[PICTURE_SERIES];
  char label[PICTURE_SERIES][ASK_POOL_LABEL + 64];
};

static void release_samples(struct samples *samples) {
  for (size_t i = 0; i < samples->count; i++)
    scatter_release(&samples->scatter[i]);
}

status print_scatter_picture(struct store *store, const struct scatter_choice *choice, const struct picture_page *page,
                             struct error *error) {
  char column[ASK_GROUP_NAME], axis[CHARTS_LABEL] = "", caption[CHARTS_LABEL] = "";
  char scene[CHARTS_LABEL], title[CHARTS_LABEL + 32] = "";
  struct picture_sample sample[PICTURE_SERIES];
  __attribute__((cleanup(release_samples))) struct samples samples = {0};
  struct ask_doubts doubts = {0};
  bool more = false; /* pools than are drawn */
  TRY(ask_group_quantity(store, choice->quantity, column, error));
  TRY(charts_axis(store, column, axis, error));
  ASK_POOLS pools = ask_pools(store, &choice->pool, choice->quantity, error);
  for (const struct ask_pool *pool; !more && (pool = ask_pools_next(&pools));) {
    more = samples.count == PICTURE_SERIES;
    if (more)
      break;
    const size_t i = samples.count;
    struct scatter *scatter = &samples.scatter[i];
    TRY(scatter_make(pool->data.runs.count, pool->value, scatter, error));
    ask_doubts_add(&doubts, &pool->doubts);
    if (scatter->n == 0) {
      scatter_release(scatter);
      continue;
    }
    snprintf(samples.label[samples.count++], sizeof samples.label[0], "%s, %zu runs%s%s", pool->label, scatter->n,
             isfinite(scatter->between) ? ", two modes" : "", pool->doubts.doubtful ? " !" : "");
    sample[i] = (struct picture_sample){samples.label[i], scatter->n, scatter->sorted, {0}};
  }
  TRY(ask_pools_end(&pools));
  if (samples.count == 0)
    return quantity_no_values(store, choice->quantity, error);
  const double width = scatter_width_of_all(samples.count, samples.scatter); /* or heights could not be compared */
  for (size_t i = 0; i < samples.count; i++)
    sample[i].histogram = scatter_histogram_of(&samples.scatter[i], width);
  charts_doubts(store, &doubts, caption, sizeof caption);
  TRY(charts_scene(store, scene, error));
  text_append(title, sizeof title, "Scatter of the runs%s", scene);
  const struct picture_words words = {title, *caption ? caption : NULL, axis, NULL};
  TRY(picture_scatter(page, &words, samples.count, sample, error));
  if (more)
    fprintf(stderr, "clast: only the first %d are drawn; --point, --where and --by choose others\n", PICTURE_SERIES);
  return STATUS_OK;
}

/* ---- runs in cells, one for each set of varied inputs, with the seeds that the cells share ---- */

struct run_cells_run {
  int64_t seed;
  double value;
};
struct run_cell {
  int64_t run_id; /* of one of the runs */
  size_t runs;
  struct run_cells_run *run;        /* by seed */
  char *input[LIMITS_AXES_OF_POOL]; /* as text: a number with 17 digits, a choice, "off" */
  bool left_out;                    /* not compared: part of no complete block of a design */
};
struct run_cells {
  size_t axes, count, room;
  struct ask_doubts doubts; /* of all runs */
  char column[LIMITS_AXES_OF_POOL][ASK_GROUP_NAME];
  struct run_cell *cell;
};

static int by_seed(const void *a, const void *b) {
  const int64_t p = ((const struct run_cells_run *)a)->seed, q = ((const struct run_cells_run *)b)->seed;
  return p < q ? -1 : p > q;
}

static void release_cell(struct run_cells *cells, size_t c) {
  free(cells->cell[c].run);
  for (size_t a = 0; a < cells->axes; a++)
    free(cells->cell[c].input[a]);
}

static status add_cell(struct run_cells *cells, const struct ask_pools *pools, const struct ask_pool *pool,
                       struct error *error) {
  if (!grow_room(&cells->cell, &cells->room, cells->count + 1, sizeof *cells->cell))
    return status_fail(error, STATUS_MEMORY, "no memory for the runs of the points");
  struct run_cell *cell = &cells->cell[cells->count++];
  *cell = (struct run_cell){.run_id = pool->data.run_id[0]};
  TRY(memory_array(&cell->run, pool->data.runs.count, sizeof *cell->run, "the runs of the points", error));
  cells->axes = pools->axes;
  ask_doubts_add(&cells->doubts, &pool->doubts);
  memcpy(cells->column, pools->column, sizeof cells->column);
  for (size_t a = 0; a < pools->axes; a++) {
    char text[ASK_POOL_TEXT] = "off";
    if (pool->input[a].kind == QUERY_TEXT)
      snprintf(text, sizeof text, "%s", pool->input[a].text);
    else if (pool->input[a].kind != QUERY_NULL)
      snprintf(text, sizeof text, "%.17g", pool->input[a].real);
    cell->input[a] = memory_small_text(text);
  }
  for (size_t r = 0; r < pool->data.runs.count; r++)
    if (isfinite(pool->value[r]))
      cell->run[cell->runs++] = (struct run_cells_run){(int64_t)pool->data.seed[r], pool->value[r]};
  if (cell->runs == 0) { /* a point whose runs lack the result is none */
    release_cell(cells, --cells->count);
    return STATUS_OK;
  }
  qsort(cell->run, cell->runs, sizeof *cell->run, by_seed);
  return STATUS_OK;
}

/* Adds a cell per pool of ask_pools to `cells`, which is zeroed before the first call. */
static status run_cells_read(struct store *store, const struct ask_pool_choice *choice, const char *quantity,
                             struct run_cells *cells, struct error *error) {
  ASK_POOLS pools = ask_pools(store, choice, quantity, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)
    TRY(add_cell(cells, &pools, pool, error));
  return ask_pools_end(&pools);
}

static void run_cells_release(struct run_cells *cells) {
  for (size_t c = 0; c < cells->count; c++)
    release_cell(cells, c);
  free(cells->cell);
}
#define RUN_CELLS __attribute__((cleanup(run_cells_release))) struct run_cells

/* Runs of the first compared cell whose seed every such cell has; *shared has room for them. */
static size_t find_shared(const struct run_cells *cells, const struct run_cell *first, struct run_cells_run *shared) {
  size_t common = 0;
  for (size_t r = 0; r < first->runs; r++) {
    size_t c = 0;
    while (c < cells->count && (cells->cell[c].left_out || bsearch(&first->run[r], cells->cell[c].run,
                                                                   cells->cell[c].runs, sizeof *shared, by_seed)))
      c++;
    if (c == cells->count)
      shared[common++] = first->run[r];
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

/* Puts runs with the same seeds first in all cells: the seeds that all cells have, if there are at least two (or one,
 * and some cell has only one run). Otherwise takes as many runs as every cell has, with any seeds. Returns the number
 * of runs per cell. */
static size_t run_cells_balance(struct run_cells *cells, bool *same_seeds) {
  const struct run_cell *first = NULL;
  size_t least = SIZE_MAX;
  *same_seeds = false;
  for (size_t c = cells->count; c-- > 0;)
    if (!cells->cell[c].left_out) {
      first = &cells->cell[c];
      least = first->runs < least ? first->runs : least;
    }
  if (!first)
    return 0;
  OWNED struct run_cells_run *shared = malloc(first->runs * sizeof *shared);
  const size_t common = shared ? find_shared(cells, first, shared) : 0;
  *same_seeds = common >= 2 || (common == 1 && least == 1);
  for (size_t c = 0; *same_seeds && c < cells->count; c++)
    if (!cells->cell[c].left_out)
      keep_shared(&cells->cell[c], shared, common);
  return *same_seeds ? common : least;
}

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

/* People see the short names of inputs. */
static void shorten(struct store *store, enum table_format format, struct run_cells *cells) {
  struct ask_column axes[LIMITS_AXES_OF_TABLE];
  size_t count = 0;
  if (table_for_people(format))
    (void)ask_columns_axes(store, true, LIMITS_AXES_OF_TABLE, axes, &count, NULL);
  for (size_t a = 0; a < cells->axes; a++)
    for (size_t k = 0; k < count; k++)
      if (*axes[k].word && strcmp(axes[k].name, cells->column[a]) == 0) {
        snprintf(cells->column[a], sizeof cells->column[a], "%s", axes[k].word);
        break;
      }
}

/* Reads a cell for each set of the varied inputs, or of those that the choice names. */
static status read_points(struct store *store, const struct scatter_choice *choice, struct run_cells *cells,
                          struct error *error) {
  struct ask_column axis[LIMITS_AXES_OF_POOL];
  char by[LIMITS_AXES_OF_POOL * (sizeof axis[0].name + 1)] = "";
  size_t axes = 0;
  struct ask_pool_choice pool = choice->pool;
  TRY(ask_columns_axes(store, false, LIMITS_AXES_OF_POOL, axis, &axes, error));
  for (size_t a = 0; a < axes; a++)
    text_append(by, sizeof by, "%s%s", a ? "," : "", axis[a].name);
  if (!pool.by)
    pool.by = by;
  return run_cells_read(store, &pool, choice->quantity, cells, error);
}

/* ---- first-order indices from any points ---- */

struct from_points {
  struct run_cells cells;
  struct sensitivity_points data;
  double *x, *value;
  size_t *runs, needed;
  bool named[LIMITS_AXES_OF_POOL];
  struct sensitivity_point index[LIMITS_AXES_OF_POOL + 1];
  size_t order[LIMITS_AXES_OF_POOL]; /* inputs by their shares, the largest first */
  char column[ASK_GROUP_NAME];       /* of the result */
};

static void release_points(struct from_points *p) {
  run_cells_release(&p->cells);
  free(p->x);
  free(p->value);
  free(p->runs);
}

/* Does a condition `effect` of the scene say so of the input? */
static bool has_no_effect(const struct scene *scene, const char *column) {
  const struct condition *list = scene->kind->conditions;
  const condition_set broken = condition_before(list, scene->inputs, NULL);
  const struct field *row = field_of_column(scene->kind->inputs, column);
  for (size_t k = 0; row && list && list[k].word; k++)
    if (broken >> k & 1 && list[k].inputs && condition_has(list[k].inputs, row->path))
      return true;
  return false;
}

/* Leaves out the inputs that have no effect at any point, and names them. */
static status leave_idle_out(struct store *store, struct run_cells *cells, char *names, size_t size,
                             struct error *error) {
  size_t idle[LIMITS_AXES_OF_POOL] = {0};
  for (size_t c = 0, left = 1; c < cells->count && left; c++) {
    SCENE scene = NULL;
    struct ask_run run = {0};
    TRY(ask_run_read(store, cells->cell[c].run_id, &run, error));
    const status code = scene_parse_json("scene of a run", run.scene, &scene, error);
    ask_run_release(&run);
    TRY(code);
    left = 0;
    for (size_t a = 0; a < cells->axes; a++)
      left += (idle[a] += idle[a] == c && has_no_effect(scene, cells->column[a])) == c + 1;
  }
  for (size_t a = cells->axes; a-- > 0;) {
    if (idle[a] < cells->count || cells->count == 0) /* without runs nothing is known */
      continue;
    text_append(names, size, "%s%s", *names ? ", " : "", cells->column[a]);
    cells->axes--;
    memmove(cells->column[a], cells->column[a + 1], (cells->axes - a) * sizeof cells->column[a]);
    for (size_t c = 0; c < cells->count; c++) {
      free(cells->cell[c].input[a]);
      memmove(&cells->cell[c].input[a], &cells->cell[c].input[a + 1], (cells->axes - a) * sizeof(char *));
    }
  }
  return STATUS_OK;
}

/* Values that are no numbers, such as names of materials and "off", have no order. */
static status fill_inputs(struct from_points *p, struct error *error) {
  const struct run_cells *cells = &p->cells;
  OWNED uint32_t *level = NULL;
  TRY(memory_array(&level, cells->count * cells->axes, sizeof *level, "the points", error));
  TRY(memory_array(&p->x, cells->count * cells->axes, sizeof *p->x, "the points", error));
  number_levels(cells, level);
  for (size_t a = 0; a < cells->axes; a++) {
    for (size_t c = 0; c < cells->count; c++) {
      char *end;
      p->x[c * cells->axes + a] = strtod(cells->cell[c].input[a], &end);
      p->named[a] |= *end != '\0';
    }
    for (size_t c = 0; p->named[a] && c < cells->count; c++)
      p->x[c * cells->axes + a] = level[c * cells->axes + a];
  }
  return STATUS_OK;
}

static status fill_runs(struct from_points *p, struct error *error) {
  struct run_cells *cells = &p->cells;
  const size_t count = cells->count;
  size_t most = 0;
  TRY(memory_array(&p->runs, count, sizeof *p->runs, "the points", error));
  p->data = (struct sensitivity_points){.inputs = cells->axes, .points = count, .runs = p->runs, .named = p->named};
  run_cells_balance(cells, &p->data.same_seeds);
  for (size_t c = 0; c < count; c++)
    most = cells->cell[c].runs > most ? cells->cell[c].runs : most;
  TRY(memory_array(&p->value, count * most, sizeof *p->value, "the points", error));
  for (size_t c = 0; c < count; c++) {
    p->runs[c] = cells->cell[c].runs;
    for (size_t r = 0; r < p->runs[c]; r++)
      p->value[c * most + r] = cells->cell[c].run[r].value;
  }
  p->data.most = most;
  p->data.value = p->value;
  TRY(fill_inputs(p, error));
  p->data.x = p->x;
  return STATUS_OK;
}

static const struct sensitivity_share *share_of(const struct from_points *p, size_t input) {
  const struct sensitivity_point *index = &p->index[input];
  return isfinite(index->of_means.estimate) ? &index->of_means : &index->of_runs;
}

static void sort_inputs(struct from_points *p) {
  for (size_t a = 0; a < p->cells.axes; a++) {
    size_t at = a;
    const double own = share_of(p, a)->estimate;
    for (; at > 0 && (isnan(share_of(p, p->order[at - 1])->estimate) || own > share_of(p, p->order[at - 1])->estimate);
         at--)
      p->order[at] = p->order[at - 1];
    p->order[at] = a;
  }
}

static bool is_told(const struct from_points *p, size_t input) {
  return isfinite(share_of(p, input)->estimate);
}

/* An input, and those that move with it like one. */
static void append_input(const struct from_points *p, size_t a, char *text, size_t size) {
  text_append(text, size, "%s", p->cells.column[a]);
  for (size_t b = 0; b < p->cells.axes; b++)
    if (p->index[b].verdict == SENSITIVITY_SAME && p->index[b].with == a)
      text_append(text, size, " (with %s)", p->cells.column[b]);
}

/* Appends the inputs of one kind: "a, b and c". Returns their number. */
enum listed { DO_NOTHING, AS_MUCH, ONE_VALUE, MOVING };
static size_t list_inputs(const struct from_points *p, enum listed kind, char *text, size_t size) {
  size_t member[LIMITS_AXES_OF_POOL], count = 0;
  for (size_t i = 0; i < p->cells.axes; i++) {
    const size_t a = p->order[i];
    const enum listed own = p->index[a].verdict == SENSITIVITY_ONE_VALUE ? ONE_VALUE
                            : p->index[a].verdict == SENSITIVITY_MOVES   ? MOVING
                            : share_of(p, a)->low > 0                    ? AS_MUCH
                                                                         : DO_NOTHING;
    if (p->index[a].verdict != SENSITIVITY_SAME && own == kind &&
        (kind != AS_MUCH || (i > 0 && p->index[a].first_rank == 1)) && (own > AS_MUCH || is_told(p, a)))
      member[count++] = a;
  }
  for (size_t i = 0; i < count; i++) {
    text_append(text, size, "%s", i == 0 ? "" : i + 1 < count ? ", " : " and ");
    append_input(p, member[i], text, size);
  }
  return count;
}

/* All points have one run of one seed: nothing is known of the scatter over seeds. */
static bool at_one_seed(const struct from_points *p) {
  return p->data.same_seeds && p->data.most == 1;
}

/* The answer: what matters most, what may matter as much, and what cannot be told. */
static void write_answer(const struct from_points *p) {
  const size_t first = p->order[0];
  const struct sensitivity_share *share = share_of(p, first);
  char text[2048] = "";
  if (p->index[0].verdict == SENSITIVITY_STEPS) {
    puts("These points do not tell it: pairs of them differ in one input alone, as in a design of Saltelli. Give\n"
         "its campaign, too: clast sensitivity STORE CAMPAIGN.yaml. Another design needs points that differ in all "
         "inputs");
    return;
  }
  if (p->data.points < p->needed) {
    printf("%zu points are too few to tell which of %zu inputs matters: %zu would do.\n", p->data.points, p->cells.axes,
           p->needed);
    return;
  }
  char moving[1024] = "";
  if (list_inputs(p, MOVING, moving, sizeof moving))
    text_append(
        text, sizeof text,
        "%s move together in these points: their effects cannot be told apart, and together may be the largest.%s",
        moving, is_told(p, first) ? " Of the other inputs: " : "");
  if (is_told(p, first)) {
    char others[1024] = "";
    const bool certain = share->low > 0, alone = certain && p->index[first].last_rank == 1;
    if (!alone)
      text_append(text, sizeof text, "%s: ",
                  certain   ? *moving ? "which one matters most is not sure" : "Which input matters most is not sure"
                  : *moving ? "none can be told from one that does nothing"
                            : "No input can be told from one that does nothing");
    append_input(p, first, text, sizeof text);
    text_append(text, sizeof text, "%s explains %.0f %% (%.0f to %.0f %%) of the variance of %s %s",
                alone ? " matters most: alone it" : " alone", 100 * fmax(share->estimate, 0), 100 * share->low,
                100 * share->high, p->column,
                at_one_seed(p)                       ? "at this one seed"
                : share == &p->index[first].of_means ? "between points"
                                                     : "of single runs");
    if (certain && list_inputs(p, AS_MUCH, others, sizeof others))
      text_append(text, sizeof text, "; %s may matter as much", others);
    *others = '\0';
    if (certain && list_inputs(p, DO_NOTHING, others, sizeof others))
      text_append(text, sizeof text, "; %s cannot be told from 0", others);
    text_append(text, sizeof text, ".");
  }
  char fixed[1024] = "";
  const size_t count = list_inputs(p, ONE_VALUE, fixed, sizeof fixed);
  if (count)
    text_append(text, sizeof text, "%s%s %s", *text ? " " : "", fixed,
                count > 1 ? "have one value each: nothing is known of them."
                          : "has one value: nothing is known of it.");
  text_wrap(text, 0, 0, COLUMNS, stdout);
}

/* Are shares of the variance of the means told? The scatter over seeds may be all of it. */
static bool tells_means(const struct from_points *p) {
  bool tells = false;
  for (size_t a = 0; a < p->cells.axes; a++)
    tells |= isfinite(p->index[a].of_means.estimate);
  return tells;
}

static void print_index(const struct from_points *p, size_t a, struct table *table) {
  const struct sensitivity_point *index = &p->index[a];
  const bool seeds = a == p->cells.axes;
  const struct sensitivity_share *const share[] = {&index->of_means, &index->of_runs};
  char text[ASK_GROUP_NAME + 64] = "";
  table_text(table, seeds ? "seed" : p->cells.column[a]);
  for (int s = 0; s < 2; s++) {
    table_rests_on(table, &p->cells.doubts);
    table_interval(table, share[s]->estimate, share[s]->low, share[s]->high);
  }
  if (is_told(p, a) && index->first_rank < index->last_rank)
    text_append(text, sizeof text, "%zu to %zu", index->first_rank, index->last_rank);
  else if (is_told(p, a) && !seeds)
    text_append(text, sizeof text, "%zu", index->first_rank);
  table_text(table, *text ? text : NULL);
  *text = '\0';
  if (index->verdict == SENSITIVITY_MOVES || index->verdict == SENSITIVITY_SAME)
    text_append(text, sizeof text, index->verdict == SENSITIVITY_SAME ? "as %s" : "moves with %s",
                p->cells.column[index->with]);
  else if (index->verdict != SENSITIVITY_TOLD)
    text_append(text, sizeof text, index->verdict == SENSITIVITY_STEPS ? "steps of one input" : "one value");
  else if (!seeds && p->data.points < p->needed)
    text_append(text, sizeof text, "too few points");
  table_text(table, *text ? text : NULL);
  table_doubt_cells(table, &p->cells.doubts);
}

static status print_indices(struct from_points *p, enum table_format format, struct error *error) {
  TABLE table = table_new(format, stdout);
  const bool means = p->data.most > 1 && tells_means(p), people = table_for_people(format);
  table_column(table, "input", NULL);
  table_interval_columns(table, "of_means", "means_low", "means_high");
  if (!means)
    table_rare(table);
  table_interval_columns(table, people && at_one_seed(p) ? "share at this seed" : "of_runs", "runs_low", "runs_high");
  table_columns(table, (const char *const[]){"rank", "not_told", NULL});
  table_doubt_columns(table);
  for (size_t i = 0; i < p->cells.axes; i++)
    print_index(p, p->order[i], table);
  if (isfinite(p->index[p->cells.axes].of_runs.estimate))
    print_index(p, p->cells.axes, table);
  return table_end(table, error);
}

status print_sensitivity_points(struct store *store, const struct scatter_choice *choice, enum table_format format,
                                struct error *error) {
  __attribute__((cleanup(release_points))) struct from_points p = {0};
  TRY(ask_group_quantity(store, choice->quantity, p.column, error));
  TRY(read_points(store, choice, &p.cells, error));
  char idle[1024] = "";
  TRY(leave_idle_out(store, &p.cells, idle, sizeof idle, error));
  if (*idle)
    fprintf(stderr, "clast: no effect at any of these points, and left out: %s (clast explain effect)\n", idle);
  if (p.cells.count == 0)
    return quantity_no_values(store, choice->quantity, error);
  if (p.cells.axes == 0)
    return status_fail(error, STATUS_USAGE, "no input varies between the points");
  TRY(fill_runs(&p, error));
  TRY(sensitivity_points(&p.data, p.index, &p.needed, error));
  if (p.data.points < p.needed || p.index[0].verdict == SENSITIVITY_STEPS) /* no numbers */
    for (size_t a = 0; a <= p.cells.axes; a++)
      p.index[a].of_means = p.index[a].of_runs = (struct sensitivity_share){NAN, NAN, NAN};
  sort_inputs(&p);
  shorten(store, format, &p.cells);
  if (table_for_people(format))
    write_answer(&p);
  TRY(print_indices(&p, format, error));
  if (at_one_seed(&p))
    words_print(stderr, "",
                "clast: all points share one seed: these are shares at this seed, and the scatter over seeds is not in "
                "them. Two seeds (per_point: 2), or a seed of its own for each point (independent: true), tell the "
                "shares of single runs");
  if (!table_for_people(format))
    return STATUS_OK;
  words_print(
      stderr, "",
      "clast: share: the part of the variance that an input alone explains, with its 95 %% interval, from %zu "
      "points%s. It is an estimate for all points drawn like these. "
      "What the shares leave is the effect of inputs together%s. rank: inputs with overlapping intervals share it. "
      "Four times the points halve the intervals",
      p.data.points,
      p.data.most > 1
          ? ". Share of means: of the variance of the means over seeds; share of runs: of single runs, with "
            "their scatter over seeds"
          : " with one seed each",
      p.data.most > 1 || at_one_seed(&p) ? "" : " and of the scatter over seeds");
  if (p.data.most > 1 && is_told(&p, p.order[0]) && !tells_means(&p))
    words_print(stderr, "",
                "clast: shares of means are not told: the variance between the means cannot be told from the scatter "
                "over seeds. More points or more seeds may tell them");
  uncertainty_doubts(&p.cells.doubts, stderr);
  return STATUS_OK;
}

/* ---- sensitivity indices ---- */

struct reading {
  struct campaign *campaign;
  size_t blocks, points; /* points of a block */
  struct run_cells cells;
  struct run_cell **place; /* cell of each row of the design; NULL: the store has no run of it */
  size_t *block;           /* the complete blocks, in their order */
  uint32_t *group;         /* of each of these */
  size_t whole;
  double *value;
  struct sensitivity_table table;
};

static void release_reading(struct reading *r) {
  run_cells_release(&r->cells);
  free(r->place);
  free(r->block);
  free(r->group);
  free(r->value);
  campaign_free(r->campaign);
}

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
  for (size_t i = 0; i < LIMITS_AXES_OF_POOL && p->input[i] && q->input[i]; i++) {
    const int order = strcmp(p->input[i], q->input[i]);
    if (order)
      return order;
  }
  return 0;
}

/* Finds the cell of every row, and the blocks of which all cells exist. */
static void find_places(struct reading *r) {
  const size_t n = r->campaign->axis_count;
  char text[LIMITS_AXES_OF_POOL][ASK_POOL_TEXT];
  if (r->cells.count > 0)
    qsort(r->cells.cell, r->cells.count, sizeof *r->cells.cell, by_inputs);
  for (size_t c = 0; c < r->cells.count; c++)
    r->cells.cell[c].left_out = true;
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
      whole = whole && r->place[i];
    }
    if (!whole)
      continue;
    for (size_t i = b * r->points; i < (b + 1) * r->points; i++)
      r->place[i]->left_out = false;
    r->group[r->whole] = design_sensitivity_group(r->blocks, b);
    r->block[r->whole++] = b;
  }
}

static status fill_table(struct reading *r, struct error *error) {
  const size_t rows = r->whole * r->points;
  r->table = (struct sensitivity_table){.inputs = r->campaign->axis_count, .blocks = r->whole, .group = r->group};
  r->table.seeds = run_cells_balance(&r->cells, &r->table.same_seeds);
  TRY(memory_array(&r->value, rows * r->table.seeds, sizeof *r->value, "the points of a design", error));
  for (size_t i = 0; i < rows; i++)
    for (size_t s = 0; s < r->table.seeds; s++)
      r->value[i * r->table.seeds + s] = r->place[r->block[i / r->points] * r->points + i % r->points]->run[s].value;
  r->table.value = r->value;
  return STATUS_OK;
}

static status read_runs(struct store *store, const char *quantity, struct reading *r, struct error *error) {
  const struct campaign *campaign = r->campaign;
  const size_t n = campaign->axis_count;
  char by[LIMITS_AXES_OF_POOL * ASK_GROUP_NAME] = "";
  if (n > LIMITS_AXES_OF_POOL)
    return status_fail(error, STATUS_USAGE, "at most %d inputs, not %zu", LIMITS_AXES_OF_POOL, n);
  for (size_t a = 0; a < n; a++)
    text_append(by, sizeof by, "%s%s", a ? "," : "", campaign->axes[a].row->path);
  const struct ask_pool_choice choice = {.by = by};
  TRY(run_cells_read(store, &choice, quantity, &r->cells, error));
  TRY(memory_array(&r->place, r->blocks * r->points, sizeof *r->place, "the points of a design", error));
  TRY(memory_array(&r->block, r->blocks, sizeof *r->block, "the points of a design", error));
  TRY(memory_array(&r->group, r->blocks, sizeof *r->group, "the points of a design", error));
  find_places(r);
  if (r->whole < 2)
    return status_fail(error, STATUS_USAGE,
                       "the store has finished runs of %zu of the %zu blocks of this design, and the indices need two: "
                       "compute it with `clast run` into this store",
                       r->whole, r->blocks);
  return fill_table(r, error);
}

static void interval(struct table *table, const struct sample_interval *i, const struct ask_doubts *doubts) {
  table_rests_on(table, doubts);
  table_reals(table, 2, (const double[]){i->estimate, i->half_width});
}

static const char *name_of(const struct reading *r, size_t axis, enum table_format format) {
  return table_for_people(format) ? r->cells.column[axis] : r->campaign->axes[axis].row->path;
}

static status print_sobol(const struct reading *r, enum table_format format, struct error *error) {
  struct sensitivity_index index[LIMITS_AXES_OF_POOL + 1];
  const size_t n = r->table.inputs;
  TRY(sensitivity_sobol(&r->table, index, error));
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"input", "first", "first_hw95", "total", "total_hw95", NULL});
  table_doubt_columns(table);
  for (size_t i = 0; i <= n; i++) {
    table_text(table, i < n ? name_of(r, i, format) : "seed");
    struct sample_interval first = index[i].first;
    if (table_for_people(format) && i == n && isnan(first.half_width))
      first.estimate = NAN; /* noise of two seeds, often below 0 */
    interval(table, &first, &r->cells.doubts);
    interval(table, &index[i].total, &r->cells.doubts);
    table_doubt_cells(table, &r->cells.doubts);
  }
  if (table_for_people(format))
    words_print(
        stderr, "",
        "clast: Sobol indices, shares of the variance, of %zu blocks with %zu %s. first: of the input alone; total: "
        "with what it does together with others%s",
        r->whole, r->table.seeds,
        r->table.seeds > 1
            ? r->table.same_seeds ? "seeds, the same at all points" : "seeds, different ones at each point"
        : r->table.same_seeds ? "seed, which all points share: the scatter over seeds is not in the shares; give the "
                                "campaign several seeds"
                              : "seed: a total would hold all the scatter of the runs; give the campaign several seeds",
        r->table.seeds == 2 && r->table.same_seeds
            ? ". Two seeds are two values of one more input: they make wide intervals, and tell no first order of the "
              "seed"
            : "");
  enum { ENOUGH = 64 }; /* measured: unit/test_sensitivity.c, coverage */
  if (r->whole < ENOUGH)
    words_print(stderr, "",
                "clast: %zu blocks are few: 95 %% intervals held 0.80 to 0.96 of the true indices with 16 blocks, "
                "0.88 to 0.96 with 32, 0.91 to 0.96 with %d (0.88 of a total near 0)",
                r->whole, ENOUGH);
  return table_end(table, error);
}

status print_sensitivity(struct store *store, const char *path, const char *quantity, enum table_format format,
                         struct error *error) {
  __attribute__((cleanup(release_reading))) struct reading r = {0};
  TRY(campaign_load(path, &r.campaign, error));
  TRY(sensitivity_design_find(r.campaign, &r.blocks, error));
  r.points = r.campaign->axis_count + 2;
  TRY(read_runs(store, quantity, &r, error));
  shorten(store, format, &r.cells);
  if (r.whole < r.blocks)
    fprintf(stderr, "clast: %zu of %zu blocks lack a finished run and are left out\n", r.blocks - r.whole, r.blocks);
  TRY(print_sobol(&r, format, error));
  if (table_for_people(format))
    uncertainty_doubts(&r.cells.doubts, stderr);
  return STATUS_OK;
}
