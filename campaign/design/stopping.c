/* The stopping rule: batches of replicates until the interval is narrow enough. */
#include "campaign/design/stopping.h"

#include "analysis/statistics/sample.h"

enum design_verdict design_stopping_judge(const struct design_stopping *rule, const double *values, int64_t *prefix) {
  if (rule->fixed)
    return DESIGN_FIXED;
  if (sample_may_stop((size_t)*prefix, values, rule->half_width, rule->level, (size_t)rule->minimum))
    return DESIGN_INTERVAL_MET;
  if (*prefix >= rule->maximum)
    return DESIGN_CAP_REACHED;
  int64_t room = rule->maximum - *prefix;
  *prefix += rule->batch < room ? rule->batch : room;
  return DESIGN_GROW;
}
