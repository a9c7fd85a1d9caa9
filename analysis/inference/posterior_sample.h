/* A sample of the posterior by walkers that move along lines through each other. For posterior.c only. */
#ifndef CLAST_ANALYSIS_INFERENCE_POSTERIOR_SAMPLE_H
#define CLAST_ANALYSIS_INFERENCE_POSTERIOR_SAMPLE_H

#include "analysis/inference/posterior.h"

enum { POSTERIOR_SAMPLE_NODES = 4000 };

/* Fills z, POSTERIOR_SAMPLE_NODES x inputs: the stretch move of Goodman & Weare (2010, doi 10.2140/camcos.2010.5.65),
 * whose cost does not depend on how stretched the posterior is. The first half of the moves is discarded. The same seed
 * gives the same sample. False: no memory. */
bool posterior_sample_fill(const struct posterior_model *model, uint64_t seed, double *z);

#endif
