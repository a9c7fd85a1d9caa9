/* A fitted rate of work, corrected by each point's own runs. */
#include "campaign/driver/cost.h"

void cost_learn(struct cost_model *model, struct cost_point *point, double wall_s) {
  if (!(wall_s >= 0))
    return;
  model->seconds += wall_s;
  model->work += point->work;
  model->runs++;
  point->seconds += wall_s;
  point->runs++;
}

double cost_predict(const struct cost_model *model, const struct cost_point *point) {
  if (model->runs == 0 || !(model->work > 0))
    return point->work;
  /* The model's guess weighs as much as one finished run of the point. */
  double guess = model->seconds / model->work * point->work;
  return (guess + point->seconds) / (double)(1 + point->runs);
}

double cost_time_left(const struct cost_left *left) {
  const double slots = left->slots > 0 ? left->slots : 1;
  double busy = (left->finished_s + left->under_way_s) / (left->elapsed_s * slots);
  if (!(left->finished_s > 0) || !(busy > 0) || busy > 1)
    busy = 1;
  const double seconds = (left->missing_s - left->under_way_s) / (slots * busy);
  return seconds > left->longest_s ? seconds : left->longest_s;
}
