/* The states of a point's replicates and which of them is next. What a run costs: a fitted rate of work, corrected by
 * each point's own runs. */
#include "campaign/scheduler/point.h"

#include <math.h>
#include <stdlib.h>

#include "engine/grow.h"
#include "schemas/memory.h"

struct point *point_create(const struct campaign *campaign, struct scene *scene) {
  struct point *point = memory_small(1, sizeof *point);
  point->scene = scene;
  point->rule = (struct design_stopping){.minimum = campaign->per_point ? campaign->per_point : campaign->until_minimum,
                                         .maximum = campaign_replicates_most(campaign),
                                         .batch = campaign->until_batch,
                                         .of_mean = campaign->until_of_value,
                                         .half_width = campaign->until_half_width,
                                         .level = campaign->until_level};
  point->rule.fixed = campaign->per_point > 0;
  struct error ignored;
  bool of_outcome;
  const struct field *row = campaign_quantity(scene->kind, campaign->until_quantity, &of_outcome, &ignored);
  point->rule.share = row && field_is_share(row);
  point->prefix = point->rule.minimum;
  point->reached = NAN;
  point->cost.work = scene->kind->work ? scene->kind->work(scene->inputs) : 1;
  if (!point_reserve(point, 0))
    memory_refused();
  return point;
}

double point_value(const struct point *point, const struct field *row, const struct ask_run_of_point *run) {
  const bool usable = outcome_is_usable(run->state) && !run->excluded;
  const enum condition_mark mark = condition_mark(point->scene->kind->conditions, run->warnings, row->path);
  return usable && mark != CONDITION_WITHHELD ? run->value : (double)NAN;
}

void point_free(struct point *point) {
  if (!point)
    return;
  scene_free(point->scene);
  free(point->replicates);
  free(point->values);
  free(point);
}

bool point_reserve(struct point *point, int64_t replicate) {
  if (replicate < point->capacity)
    return true;
  int64_t capacity = point->capacity ? point->capacity : 16;
  while (capacity <= replicate)
    capacity *= 2;
  if (!grow_block(&point->replicates, (size_t)capacity * sizeof *point->replicates) ||
      !grow_block(&point->values, (size_t)capacity * sizeof *point->values))
    return false;
  for (int64_t r = point->capacity; r < capacity; r++) {
    point->replicates[r] = (struct point_replicate){.state = POINT_WANTED};
    point->values[r] = NAN;
  }
  point->capacity = capacity;
  return true;
}

void point_finish_replicate(struct point *point, int64_t replicate, enum point_state state, double value) {
  point->replicates[replicate].state = (unsigned char)state;
  point->values[replicate] = value;
}

void point_want_again(struct point *point, int64_t replicate) {
  point->replicates[replicate].state = POINT_WANTED;
  if (replicate < point->wanted_from)
    point->wanted_from = replicate;
}

static bool is_complete(const struct point *point, int64_t r) {
  return r < point->capacity &&
         (point->replicates[r].state == POINT_DONE || point->replicates[r].state == POINT_FAILED);
}

bool point_judge(struct point *point) {
  bool changed = false;
  while (!point->decided) {
    while (point->complete < point->prefix && is_complete(point, point->complete))
      point->complete++;
    if (point->complete < point->prefix)
      break;
    point->reached = design_stopping_reached(&point->rule, point->values, point->prefix);
    point->verdict = design_stopping_judge(&point->rule, point->values, &point->prefix);
    point->decided = point->verdict != DESIGN_GROW;
    changed = true;
  }
  return changed;
}

int64_t point_next(struct point *point, bool ahead) {
  if (point->decided)
    return -1;
  int64_t end = point->prefix;
  if (ahead)
    end = point->rule.batch < point->rule.maximum - end ? end + point->rule.batch : point->rule.maximum;
  for (; point->wanted_from < end; point->wanted_from++) {
    if (!point_reserve(point, point->wanted_from))
      return -1;
    if (point->replicates[point->wanted_from].state == POINT_WANTED)
      return point->wanted_from;
  }
  return -1;
}

static void want(struct point *point, int64_t r) {
  struct point_replicate *replicate = &point->replicates[r];
  if (replicate->state == POINT_DONE && !replicate->fields && !replicate->replay && !replicate->replaying) {
    replicate->replay = true;
    point->replays++;
  }
}

/* Marks the runs with the least and the greatest value. Of equal values the lowest replicate is taken, so that the
 * choice depends on the results alone. */
static void want_extremes(struct point *point) {
  int64_t least = -1, most = -1;
  for (int64_t r = 0; r < point->prefix; r++) {
    const double value = point->values[r];
    if (isnan(value))
      continue;
    if (least < 0 || value < point->values[least])
      least = r;
    if (most < 0 || value > point->values[most])
      most = r;
  }
  if (least < 0)
    return;
  want(point, least);
  want(point, most);
}

void point_want_fields(struct point *point, const struct campaign *campaign) {
  const int64_t first = campaign->keep == CAMPAIGN_KEEP_ALL     ? INT64_MAX
                        : campaign->keep == CAMPAIGN_KEEP_FIRST ? campaign->keep_first
                                                                : 0;
  for (int64_t r = 0; r < point->prefix && r < first; r++)
    want(point, r);
  if (campaign->keep == CAMPAIGN_KEEP_EXTREMES)
    want_extremes(point);
}

void point_leave(struct point *point, int64_t replicate) {
  point->replicates[replicate].state = POINT_LEFT;
  point->left++;
}

bool point_over(struct point *point) {
  if (point->out > 0 || point->replays > 0)
    return false;
  return point->decided || (point->left > 0 && point_next(point, false) < 0);
}

int64_t point_missing(const struct point *point) {
  int64_t missing = 0;
  for (int64_t r = point->complete; r < point->prefix; r++)
    missing += !is_complete(point, r);
  return missing;
}

/* ---- cost ---- */

void point_cost_learn(struct point_cost_model *model, struct point_cost *point, double wall_s) {
  if (!(wall_s >= 0))
    return;
  model->seconds += wall_s;
  model->work += point->work;
  model->runs++;
  point->seconds += wall_s;
  point->runs++;
}

double point_cost_predict(const struct point_cost_model *model, const struct point_cost *point) {
  if (model->runs == 0 || !(model->work > 0))
    return point->work;
  /* The model's guess weighs as much as one finished run of the point. */
  double guess = model->seconds / model->work * point->work;
  return (guess + point->seconds) / (double)(1 + point->runs);
}

double point_cost_time_left(const struct point_cost_left *left) {
  const double slots = left->slots > 0 ? left->slots : 1;
  double busy = (left->finished_s + left->under_way_s) / (left->elapsed_s * slots);
  if (!(left->finished_s > 0) || !(busy > 0) || busy > 1)
    busy = 1;
  const double seconds = (left->missing_s - left->under_way_s) / (slots * busy);
  return seconds > left->longest_s ? seconds : left->longest_s;
}
