/* Designs for sensitivity indices: blocks of points in the form that analysis/statistics/sensitivity.h needs. */
#ifndef CLAST_CAMPAIGN_DESIGN_DESIGN_SENSITIVITY_H
#define CLAST_CAMPAIGN_DESIGN_DESIGN_SENSITIVITY_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum design_sensitivity_kind {
  DESIGN_SENSITIVITY_SALTELLI, /* A, B, and A with one input of B for each input; A and B are Sobol numbers */
  DESIGN_SENSITIVITY_MORRIS,   /* trajectories from a random place on four levels, two levels a step */
};
struct design_sensitivity; /* opaque */

/* blocks: best a power of two for Saltelli. STATUS_CONTENT: no input, more inputs than Sobol numbers allow (20), or no
 * block. */
status design_sensitivity_create(enum design_sensitivity_kind kind, size_t inputs, size_t blocks, uint64_t seed,
                                 struct design_sensitivity **out, struct error *error);
void design_sensitivity_free(struct design_sensitivity *design); /* NULL is fine */
size_t design_sensitivity_rows(const struct design_sensitivity *design);
/* Coordinates of a row in (0, 1), one for each input: the arguments of the quantiles. */
void design_sensitivity_row(const struct design_sensitivity *design, size_t row, double *coordinates);
/* Morris: the input that each step of each trajectory changes, and the change of its coordinate. Both arrays: inputs x
 * blocks. */
void design_sensitivity_steps(const struct design_sensitivity *design, size_t *order, double *step);

#endif
