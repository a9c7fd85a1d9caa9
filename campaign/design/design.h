/* The points of a campaign, one after the other. A design is a counter, not a table, so that the first run of a million
 * points starts immediately. Point i of a design depends only on kind, seed, i and the number of points. */
#ifndef CLAST_CAMPAIGN_DESIGN_DESIGN_H
#define CLAST_CAMPAIGN_DESIGN_DESIGN_H

#include "campaign/design/axis.h"

struct design; /* opaque */

enum design_kind { DESIGN_GRID, DESIGN_LIST, DESIGN_RANDOM, DESIGN_LATIN_HYPERCUBE, DESIGN_SOBOL };

/* axes are borrowed. STATUS_CONTENT: a distribution in a grid, lists of unequal length, more axes than Sobol numbers
 * have (40 in GSL, whose own check lets 41 through and gives zeros), no points. */
status design_create(enum design_kind kind, const struct design_axis *axes, size_t axis_count, uint64_t points,
                     uint64_t seed, struct design **out, struct error *error);
void design_free(struct design *design); /* NULL is fine */

uint64_t design_points(const struct design *design);
/* The next point's values, one per axis in axis order; false after the last. */
bool design_next(struct design *design, struct field_value *values);

/* Coordinate in [0, 1) of point i in dimension d, by kind: the argument of the axis' quantile. */
double design_random_coordinate(uint64_t seed, uint64_t i, size_t dimension);
double design_latin_coordinate(uint64_t seed, uint64_t points, uint64_t i, size_t dimension);
/* A permutation of 0..points-1 without a table: a Feistel network keyed by (seed, dimension), walked back into range.
 */
uint64_t design_latin_permute(uint64_t seed, size_t dimension, uint64_t points, uint64_t i);

struct design_sobol; /* GSL's generator, origin included, digitally shifted */
status design_sobol_create(size_t dimensions, uint64_t seed, struct design_sobol **out, struct error *error);
void design_sobol_next(struct design_sobol *sobol, double *coordinates);
void design_sobol_free(struct design_sobol *sobol);
enum { DESIGN_SOBOL_BITS = 30 }; /* GSL's resolution */
uint32_t design_sobol_shift(uint64_t seed,
                            size_t dimension); /* DESIGN_SOBOL_BITS bits, XORed into the integer coordinate */

#endif
