/* Approximate Bayesian computation by a sequence of populations: inputs whose runs come near to what was measured, with
 * no formula for the likelihood. It is the check where the law over seeds is not normal, such as a largest fragment
 * with two modes.
 *
 * Adaptive population Monte Carlo (Lenormand, Jabot & Deffuant 2013, doi 10.1007/s00180-013-0428-3): of N particles the
 * nearest half are kept; each round proposes N / 2 new ones around them, weighted by prior over proposal. It ends when
 * fewer than a given share of the proposals is nearer than what was kept. Each particle is one run with a seed of its
 * own. */
#ifndef CLAST_ANALYSIS_INFERENCE_APPROXIMATE_H
#define CLAST_ANALYSIS_INFERENCE_APPROXIMATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum { APPROXIMATE_INPUTS = 16 };

struct approximate {
  size_t particles, inputs;      /* N */
  double *z, *distance, *weight; /* N x inputs, N, N: kept ones first. Owned */
  size_t kept;                   /* 0 before the first round */
  double tolerance;              /* the largest distance that is kept */
  double accepted;               /* share of the last round's proposals that came nearer; 1 before */
  uint64_t seed, round;
};

/* STATUS_MEMORY. The first proposals are draws from the prior. */
status approximate_begin(struct approximate *a, size_t particles, size_t inputs, uint64_t seed, struct error *error);
void approximate_clear(struct approximate *a);

/* Puts new particles into z from `kept` on; returns their number. */
size_t approximate_propose(struct approximate *a);
/* Takes the distances of the proposals (NaN: the run failed), keeps the nearest half of all. */
void approximate_take(struct approximate *a, const double *distance);
/* Quantile of z of an input over the kept particles with their weights. */
double approximate_quantile(const struct approximate *a, size_t input, double p);

#endif
