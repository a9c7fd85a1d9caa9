/* Which inputs the data determine. In some directions of the space of inputs the data contain more information than the
 * prior. Along ridges, several inputs change together and the measured quantities do not change. */
#ifndef CLAST_ANALYSIS_INFERENCE_IDENTIFY_H
#define CLAST_ANALYSIS_INFERENCE_IDENTIFY_H

#include "analysis/inference/posterior.h"

/* A direction in normal coordinates. */
struct identify_direction {
  double along[POSTERIOR_INPUTS]; /* unit vector; its largest component is positive */
  double
      information;  /* information of the data relative to the prior's: 1: equal; 0: none. Median over the posterior */
  double deviation; /* standard deviation of the posterior along it; that of the prior is 1 */
};

struct identify {
  size_t inputs;
  double centre[POSTERIOR_INPUTS];                       /* mean of the posterior */
  double kept[POSTERIOR_INPUTS];                         /* width of the 90 % interval over that of the prior */
  struct identify_direction direction[POSTERIOR_INPUTS]; /* in descending order of information */
  size_t determined; /* number of directions with more information from the data than from the prior */
};

/* The information is J^T C^-1 J, with J the slopes of the surfaces and C the covariance of the data about them. It is
 * evaluated at nodes of the posterior, so a bent ridge is found, too. */
void identify_find(const struct posterior_model *model, const struct posterior *posterior, struct identify *out);

/* Is this input part of a direction that the data do not determine? */
bool identify_mixed(const struct identify *found, size_t direction, size_t input);

#endif
