/* Results of a study: values from the store, rows of levels, errors over knobs. study_rounds.c computes the runs. */
#include "campaign/converge/study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "schemas/memory.h"

#define CONFIDENCE 0.95
#define NOTHING    ((double)NAN)

status study_quantity_find(const struct engine_kind *kind, const char *name, struct study_quantity *quantity,
                           struct error *error) {
  *quantity = (struct study_quantity){0};
  bool exponent;
  TRY(estimates_named(name, &exponent, &quantity->method, &quantity->window, error));

  if (exponent) {
    snprintf(quantity->name, sizeof quantity->name, "%s", estimates_short_name(name));
    snprintf(quantity->column, sizeof quantity->column, "%s", quantity->name);
    return STATUS_OK;
  }
  quantity->row = campaign_quantity(kind, name, &quantity->of_outcome, error);
  if (!quantity->row)
    return STATUS_CONTENT;
  snprintf(quantity->name, sizeof quantity->name, "%s", quantity->row->path);
  field_column_name(quantity->row->path, quantity->column, sizeof quantity->column);
  return STATUS_OK;
}

status study_add(struct study *study, const struct scene *base, struct ladder *levels, struct error *error) {
  const size_t room = (size_t)study->rule.most_seeds;
  if (!grow_block(&study->ladder, (study->ladder_count + 1) * sizeof *study->ladder)) {
    ladder_clear(levels);
    return status_fail(error, STATUS_MEMORY, "no memory for a study");
  }
  struct study_ladder *ladder = &study->ladder[study->ladder_count++];
  *ladder = (struct study_ladder){.levels = *levels, .base = base, .end = "not begun"};
  *levels = (struct ladder){0};
  for (size_t l = 0; l < ladder->levels.count; l++) {
    ladder->cpu[l] = ladder->wall[l] = NAN;
    ladder->left_out[l] = ladder->levels.level[l].unasked;
    TRY(memory_array(&ladder->ran[l], room, sizeof *ladder->ran[l], "a study", error));
    for (size_t q = 0; q < study->quantity_count; q++) {
      TRY(memory_array(&ladder->values[q][l], room, sizeof(double), "a study", error));
      for (size_t s = 0; s < room; s++)
        ladder->values[q][l][s] = NAN;
    }
  }
  return STATUS_OK;
}

void study_clear(struct study *study) {
  for (size_t i = 0; i < study->ladder_count; i++) {
    struct study_ladder *ladder = &study->ladder[i];
    for (size_t q = 0; q < LIMITS_STUDY_QUANTITIES; q++)
      for (size_t l = 0; l < KNOB_LEVELS; l++)
        free(ladder->values[q][l]);
    for (size_t l = 0; l < KNOB_LEVELS; l++)
      free(ladder->ran[l]);
    ladder_clear(&ladder->levels);
  }
  free(study->ladder);
  study->ladder = NULL;
  study->ladder_count = 0;
}

/* ---- what was found ---- */

size_t study_reference(const struct study_ladder *ladder) {
  size_t finest = 0; /* the finest level that was not left out, for a ladder whose reference was left out */
  for (size_t l = 0; l < ladder->levels.count; l++) {
    if (ladder->left_out[l])
      continue;
    if (ladder->levels.level[l].reference)
      return l;
    finest = l;
  }
  return finest;
}

const struct study_ladder *study_stepped(const struct study *study) {
  for (size_t i = 0; i < study->ladder_count; i++)
    if (!isnan(study->ladder[i].levels.level[0].step))
      return &study->ladder[i];
  return NULL;
}

static void find_level(const struct study_ladder *ladder, size_t quantity, bool share, size_t l, size_t n,
                       struct convergence_row *row) {
  const struct ladder_level *level = &ladder->levels.level[l];
  const size_t reference = study_reference(ladder);
  size_t finer = l + 1; /* the next finer level that was run */
  while (finer < ladder->levels.count && ladder->left_out[finer])
    finer++;
  double *const *values = ladder->values[quantity];
  struct sample_summary summary = sample_summarise(n, values[l], CONFIDENCE);
  if (share)
    sample_of_share(&summary, CONFIDENCE);
  row->base = level->base;
  row->reference = l == reference;
  row->step = level->step;
  row->n = (int64_t)summary.n;
  row->mean = summary.mean;
  row->half_width = summary.half_width;
  row->deviation = summary.standard_deviation;
  row->cpu = ladder->cpu[l];
  row->paired = ladder->levels.knob->pairs;
  const struct convergence_difference bias = convergence_bias(n, values[l], values[reference], row->paired, CONFIDENCE);
  const bool zero = row->reference && row->n > 0;
  row->bias = zero ? 0 : bias.value;
  row->bias_half_width = zero ? 0 : bias.half_width;
  if (finer == ladder->levels.count)
    return;

  const struct convergence_correlation r = convergence_correlate(n, values[l], values[finer], CONFIDENCE);
  row->correlation = r.value;
  row->correlation_low = r.low;
  row->correlation_high = r.high;
  row->cost_ratio = ladder->cpu[l] / ladder->cpu[finer];
  row->break_even = convergence_break_even(row->cost_ratio);
  row->gain = convergence_gain(r.value, row->cost_ratio);
}

void study_law(const struct study *study, const struct study_ladder *ladder, size_t quantity, struct limit_law *law,
               size_t *place, size_t count, struct limit_point *points) {
  const struct field *row = study->quantity[quantity].row;
  struct limit_ladder levels = {.seeds = (size_t)ladder->seeds, .least = -HUGE_VAL, .most = HUGE_VAL};
  if (row && row->kind == FIELD_REAL) {
    levels.least = row->minimum;
    levels.most = row->maximum;
  }
  for (size_t l = 0; l < ladder->levels.count; l++) {
    place[l] = LIMIT_LEVELS;
    if (ladder->left_out[l] || sample_summarise(levels.seeds, ladder->values[quantity][l], CONFIDENCE).n == 0)
      continue;
    place[l] = levels.levels;
    levels.step[levels.levels] = ladder->levels.level[l].step;
    levels.values[levels.levels++] = ladder->values[quantity][l];
  }
  if (!limit_infer(&levels, CONFIDENCE, law, count, points))
    law->verdict = LIMIT_TOO_FEW;
}

void study_find(const struct study *study, const struct study_ladder *ladder, size_t quantity,
                struct study_found *found) {
  const struct field *result = study->quantity[quantity].row;
  const char *column = study->quantity[quantity].column;
  const size_t n = (size_t)ladder->seeds;
  const bool share = result && field_is_share(result);
  struct limit_law law;
  size_t place[KNOB_LEVELS];
  struct limit_point own = {.step = NAN};
  *found = (struct study_found){.count = ladder->levels.count, .adds = ladder->levels.knob->group == KNOB_RESOLUTION};
  for (size_t l = 0; l < found->count; l++)
    if (ladder->levels.level[l].base)
      own.step = ladder->levels.level[l].step;
  for (size_t l = 0; l < found->count; l++) {
    struct convergence_row *row = &found->rows[l];
    field_defaults(&convergence_table, row);
    snprintf(row->knob, sizeof row->knob, "%s", ladder->levels.knob->name);
    snprintf(row->quantity, sizeof row->quantity, "%s", column);
    snprintf(row->setting, sizeof row->setting, "%s", ladder->levels.level[l].setting);
    const bool no_level = ladder->levels.level[l].unasked && ladder->left_out[l]; /* though it may have some runs */
    find_level(ladder, quantity, share, l, no_level ? 0 : n, row);
  }
  field_defaults(&convergence_limit_table, &found->limit);
  snprintf(found->limit.knob, sizeof found->limit.knob, "%s", ladder->levels.knob->name);
  snprintf(found->limit.quantity, sizeof found->limit.quantity, "%s", column);
  study_law(study, ladder, quantity, &law, place, own.step > 0, &own);
  convergence_limit_fill(&law, &found->limit);
  convergence_resolve(found->count, found->rows, &law, place, ladder->levels.knob->choices[0]);
  convergence_resolve_own(found->count, found->rows, &law, place, &own);
  for (size_t l = 0; l < found->count && !found->adds; l++) {
    struct convergence_row *row = &found->rows[l];
    row->resolution = row->distance = row->distance_half_width = NOTHING;
    row->open = false;
  }
}

/* Skewness, and the two modes of a level that has two. */
static void find_shapes(const struct study_ladder *ladder, size_t quantity, struct study_found *found) {
  for (size_t l = 0; l < found->count; l++) {
    SCATTER scatter = {0};
    if (found->rows[l].n < 4 ||
        scatter_make((size_t)ladder->seeds, ladder->values[quantity][l], &scatter, NULL) != STATUS_OK)
      continue;
    found->rows[l].skew = scatter.skewness;
    found->rows[l].upper_mode = scatter.upper_share;
  }
}

size_t study_of_scene(const struct study *study, size_t from, size_t quantity, struct study_found *found) {
  size_t count = 0;
  for (size_t i = from; i < study->ladder_count && study->ladder[i].base == study->ladder[from].base; i++)
    if (count < LIMITS_STUDY_KNOBS) {
      study_find(study, &study->ladder[i], quantity, &found[count]);
      find_shapes(&study->ladder[i], quantity, &found[count++]);
    }
  return count;
}

status study_errors(const struct study *study, size_t from, size_t quantity, struct store *store, size_t count,
                    struct study_found *found, struct error *error) {
  const struct study_ladder *first = &study->ladder[from];
  ANSWER levels = ask_convergence_levels(store, first->base_point, first->base->kind->results_version,
                                         study->quantity[quantity].column, true, error);
  for (struct convergence_row stored; ask_convergence_next(&levels, &stored);)
    for (size_t i = 0; i < count; i++)
      for (size_t l = 0; l < found[i].count; l++) {
        struct convergence_row *row = &found[i].rows[l];
        if (strcmp(row->knob, stored.knob) != 0 || strcmp(row->setting, stored.setting) != 0)
          continue;
        row->error = stored.error;
        row->at_least = stored.at_least;
        row->frontier = stored.frontier;
      }
  return answer_end(&levels);
}

enum { FINER = 3 }; /* levels beyond the finest one */

/* Settings 2, 4 and 8 times finer than the finest level, whose errors follow from the law: its distance to the limit
 * shrinks at least as the least order. They have no runs; one may be a level that the study had no time for. */
static status add_finer(const struct study_ladder *ladder, const struct study_found *found, struct store *store,
                        size_t *count, struct convergence_row *rows, int64_t *points, struct error *error) {
  const struct knob *knob = ladder->levels.knob;
  const struct convergence_row *finest = &found->rows[study_reference(ladder)];
  if (!found->adds || found->limit.verdict != LIMIT_SEEN || finest->n == 0 || !(finest->step > 0))
    return STATUS_OK;
  for (int i = 1; i <= FINER; i++) {
    const double share = pow(pow(2, -i * fabs(knob->step_power)), LIMIT_ORDER_LEAST);
    struct error refused;
    SCENE scene = scene_copy(ladder->base);
    char setting[FIELD_TEXT_SIZE];
    snprintf(setting, sizeof setting, "%.6g", strtod(finest->setting, NULL) * pow(2, knob->step_power < 0 ? i : -i));
    if (ladder_turn(knob, scene, setting, &refused) != STATUS_OK || !ladder_is_kept(knob, scene))
      continue;
    ladder_setting(knob, scene, setting, sizeof setting); /* as levels spell it */
    size_t place = 0;
    while (place < found->count && strcmp(rows[place].setting, setting) != 0)
      place++;
    if (place < found->count) {
      if (isnan(rows[place].resolution))
        rows[place].resolution = finest->resolution * share;
      continue;
    }
    struct convergence_row *row = &rows[*count];
    field_defaults(&convergence_table, row);
    memcpy(row->setting, setting, sizeof row->setting);
    memcpy(row->knob, finest->knob, sizeof row->knob);
    memcpy(row->quantity, finest->quantity, sizeof row->quantity);
    row->step = finest->step * pow(2, -i * fabs(knob->step_power));
    row->resolution = finest->resolution * share;
    TRY(store_add_point(store, 0, scene, 0, NULL, &points[(*count)++], error));
  }
  return STATUS_OK;
}

status study_is_smaller(const struct study_ladder *ladder, const struct study_found *found, struct store *store,
                        bool *smaller, struct error *error) {
  ANSWER levels = ask_convergence_levels(store, ladder->base_point, ladder->base->kind->results_version,
                                         found->rows[0].quantity, false, error);
  size_t asked = 0, there = 0;
  for (size_t l = 0; l < found->count; l++)
    asked += found->rows[l].n > 0;
  for (struct convergence_row stored; ask_convergence_next(&levels, &stored);)
    for (size_t l = 0; l < found->count; l++)
      there += found->rows[l].n > 0 && stored.n > ladder->seeds && strcmp(stored.knob, found->rows[l].knob) == 0 &&
               strcmp(stored.setting, found->rows[l].setting) == 0;
  *smaller = there == asked;
  return answer_end(&levels);
}

/* Writes the rows of a scene for a quantity. A smaller study does not replace a larger one. */
static status store_rows(const struct study *study, size_t from, size_t count, const struct study_found *found,
                         struct store *store, struct error *error) {
  OWNED struct convergence_row *levels = memory_small(KNOB_LEVELS + FINER, sizeof *levels);
  for (size_t i = 0; i < count; i++) {
    const struct study_ladder *ladder = &study->ladder[from + i];
    int64_t points[KNOB_LEVELS + FINER];
    struct store_convergence rows = {.base_point_id = ladder->base_point,
                                     .results_version = ladder->base->kind->results_version,
                                     .count = found[i].count,
                                     .point_ids = points,
                                     .rows = levels,
                                     .limit = &found[i].limit};
    bool smaller = false;
    TRY(study_is_smaller(ladder, &found[i], store, &smaller, error));
    if (smaller)
      continue;
    memcpy(levels, found[i].rows, found[i].count * sizeof *levels);
    memcpy(points, ladder->point, found[i].count * sizeof *points);
    TRY(add_finer(ladder, &found[i], store, &rows.count, levels, points, error));
    TRY(store_set_convergence(store, &rows, error));
  }
  return STATUS_OK;
}

status study_store(const struct study *study, struct store *store, struct error *error) {
  OWNED struct study_found *found = NULL;
  TRY(memory_array(&found, LIMITS_STUDY_KNOBS, sizeof *found, "the rows of a study", error));
  for (size_t from = 0, count = 0; from < study->ladder_count; from += count)
    for (size_t q = 0; q < study->quantity_count; q++) {
      count = study_of_scene(study, from, q, found);
      TRY(store_rows(study, from, count, found, store, error));
    }
  return store_rank_convergence(store, error); /* the store tells the errors */
}

/* ---- values from the store ---- */

/* Reads the values of a result from the runs; for an exponent only the runs' cost. */
static status read_runs(const struct study *study, struct study_ladder *ladder, size_t l, size_t q, struct store *store,
                        struct error *error) {
  bool of_outcome = study->quantity[q].of_outcome;
  const struct engine_kind *kind = ladder->base->kind;
  const struct field *row = study->quantity[q].row;
  double *values = row ? ladder->values[q][l] : NULL, cpu = 0, wall = 0;
  size_t runs = 0;
  if (!row)
    row = campaign_quantity(kind, OUTCOME_DEFAULT, &of_outcome, error);
  ANSWER answer = ask_run_of_point(store, ladder->point[l], kind, row, of_outcome, error);
  for (struct ask_run_of_point run; ask_run_of_point_next(&answer, &run);) {
    const int64_t s = (int64_t)(run.seed - (uint64_t)study->limits.first_seed);
    if (s < 0 || s >= study->rule.most_seeds)
      continue;
    if (values)
      values[s] = outcome_is_usable(run.state) && !run.withheld ? run.value : NOTHING;
    ladder->ran[l][s] = true;
    cpu += run.cpu_s;
    wall += run.wall_s;
    runs++;
  }
  ladder->cpu[l] = runs ? cpu / (double)runs : NOTHING;
  ladder->wall[l] = runs ? wall / (double)runs : NOTHING;
  return answer_end(&answer);
}

/* Reads what each run adds to an exponent of the first seeds. All values depend on the number of seeds. */
static status read_exponent(const struct study *study, struct study_ladder *ladder, size_t l, size_t q,
                            struct store *store, struct error *error) {
  const struct study_quantity *quantity = &study->quantity[q];
  const int64_t first = study->limits.first_seed;
  double *values = ladder->values[q][l];
  char where[80];
  for (int64_t s = 0; s < study->rule.most_seeds; s++)
    values[s] = NAN;
  snprintf(where, sizeof where, "seed BETWEEN %lld AND %lld", (long long)first, (long long)(first + ladder->seeds - 1));
  __attribute__((cleanup(point_release))) struct point_data point = {0};
  OWNED double *of_runs = NULL;
  TRY(point_read_where(store, ladder->point[l], ladder->base->kind->results_version, where, &point, error));
  TRY(memory_array(&of_runs, point.runs.count, sizeof *of_runs, "an exponent", error));
  TRY(point_exponent_of_runs(&point, quantity->method, quantity->window, of_runs, error));
  for (size_t r = 0; r < point.runs.count; r++)
    values[(int64_t)point.seed[r] - first] = of_runs[r];
  return STATUS_OK;
}

status study_read(const struct study *study, struct study_ladder *ladder, struct store *store, struct error *error) {
  TRY(store_add_point(store, 0, ladder->base, 0, NULL, &ladder->base_point, error));
  for (size_t l = 0; l < ladder->levels.count; l++) {
    TRY(store_add_point(store, 0, ladder->levels.level[l].scene, 0, NULL, &ladder->point[l], error));
    for (size_t q = 0; q < study->quantity_count; q++) {
      TRY(read_runs(study, ladder, l, q, store, error));
      if (!study->quantity[q].row)
        TRY(read_exponent(study, ladder, l, q, store, error));
    }
  }
  return STATUS_OK;
}
