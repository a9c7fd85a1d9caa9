/* When a point has enough replicates. The rule judges complete prefixes 0..n-1 of the replicate numbers only: "the
 * first n that finished" would favour quick runs (measured bias: 2.8 standard errors with 32 workers). */
#ifndef CLAST_CAMPAIGN_DESIGN_STOPPING_H
#define CLAST_CAMPAIGN_DESIGN_STOPPING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct design_stopping {
  bool fixed; /* `minimum` replicates, the rule is not applied */
  int64_t minimum, batch, maximum;
  double half_width, level; /* half width of the mean's confidence interval, in the quantity's SI unit */
};

enum design_verdict { DESIGN_GROW, DESIGN_INTERVAL_MET, DESIGN_CAP_REACHED, DESIGN_FIXED };

/* All replicates below *prefix have ended; values[r] is NaN for a failed run. DESIGN_GROW: *prefix is set to the next
 * prefix to complete. Otherwise the point is finished at this prefix. */
enum design_verdict design_stopping_judge(const struct design_stopping *rule, const double *values, int64_t *prefix);

#endif
