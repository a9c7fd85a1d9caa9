/* Approximate Bayesian computation by a sequence of populations: finds inputs whose runs are close to the measured
 * data, without a formula for the likelihood. It checks cases where the distribution over seeds is not normal, such as
 * a largest fragment with two modes.
 *
 * Adaptive population Monte Carlo (Lenormand, Jabot & Deffuant 2013, doi 10.1007/s00180-013-0428-3): of N particles the
 * nearest half are kept; each round proposes N / 2 new ones around them, weighted by prior over proposal. It ends when
 * fewer than a given share of the proposals is nearer than the kept particles. Each particle is one run with its own
 * seed. */
#ifndef CLAST_ANALYSIS_INFERENCE_APPROXIMATE_H
#define CLAST_ANALYSIS_INFERENCE_APPROXIMATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { APPROXIMATE_INPUTS = 16 };

struct approximate {
  size_t particles, inputs;      /* N */
  double *z, *distance, *weight; /* N x inputs, N, N: kept particles first. Owned */
  size_t kept;                   /* 0 before the first round */
  double tolerance;              /* largest distance of the kept particles */
  double accepted;               /* share of the last round's proposals that were nearer; 1 before the first round */
  uint64_t seed, round;
};

/* STATUS_MEMORY. The first proposals are drawn from the prior. */
status approximate_begin(struct approximate *a, size_t particles, size_t inputs, uint64_t seed, struct error *error);
void approximate_clear(struct approximate *a);

/* Writes new particles into z from index `kept` on; returns their number. */
size_t approximate_propose(struct approximate *a);
/* Takes the distances of the proposals (NaN: the run failed) and keeps the nearest half of all particles. */
void approximate_take(struct approximate *a, const double *distance);
/* Weighted quantile p of an input's z over the kept particles. */
double approximate_quantile(const struct approximate *a, size_t input, double p);

#endif
