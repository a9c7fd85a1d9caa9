/* What the data tell of the inputs, and what they leave open: directions in the space of inputs along which they say
 * more than the prior does, and ridges, along which several inputs change together and nothing that was measured
 * changes. */
#ifndef CLAST_ANALYSIS_INFERENCE_IDENTIFY_H
#define CLAST_ANALYSIS_INFERENCE_IDENTIFY_H

#include "analysis/inference/posterior.h"

/* A direction in normal coordinates. */
struct identify_direction {
  double along[POSTERIOR_INPUTS]; /* unit vector; its largest component is positive */
  double information;             /* of the data over the prior's: 1, as much; 0, nothing. Median over the posterior */
  double deviation;               /* of the posterior along it; the prior has 1 */
};

struct identify {
  size_t inputs;
  double centre[POSTERIOR_INPUTS];                       /* mean of the posterior */
  double kept[POSTERIOR_INPUTS];                         /* width of the 90 % interval over that of the prior */
  struct identify_direction direction[POSTERIOR_INPUTS]; /* by information, most first */
  size_t determined;                                     /* directions of which the data tell more than the prior */
};

/* The information is J^T C^-1 J with J the slopes of the surfaces and C the covariance of the data about them, at nodes
 * of the posterior: local, so that a bent ridge is seen, too. */
void identify_find(const struct posterior_model *model, const struct posterior *posterior, struct identify *out);

/* Is this input part of a direction that the data leave open? */
bool identify_mixed(const struct identify *found, size_t direction, size_t input);

#endif
