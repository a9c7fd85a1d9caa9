/* The points of a campaign: axes, which are paths into the scene with values or laws; designs, which make points of
 * axes; and the stopping rule, which says when a point has enough replicates. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/field.h"
#include "schemas/status.h"

/* One axis of a campaign: the path of an input in the scene and its values. No code depends on the name of the path.
 * Every kind of axis is one function of u in [0, 1): its quantile. Grids use the levels of the kinds that have
 * levels. */

enum design_axis_kind {
  DESIGN_AXIS_LEVELS,      /* a list, {from, to, n}, {log: [a, b], n}: `levels` */
  DESIGN_AXIS_UNIFORM,     /* {uniform: [a, b]} */
  DESIGN_AXIS_LOG_UNIFORM, /* {log_uniform: [a, b]} */
  DESIGN_AXIS_NORMAL,      /* {normal: {mean, sd}} */
  DESIGN_AXIS_LOGNORMAL,   /* {lognormal: {median, sigma}}: sigma = standard deviation of the natural logarithm */
  DESIGN_AXIS_LINKED,      /* {linked: path, factor, offset}, or {linked: path, values: [...]} by level of the other */
};

struct design_axis {
  const struct field *row;    /* row of the engine's inputs */
  char unit[32];              /* unit of the values in the campaign; "": SI */
  int kind;                   /* enum design_axis_kind */
  struct field_value *levels; /* owned */
  size_t level_count;
  double a, b;         /* bounds (uniform kinds); mean and sd; median and sigma; factor and offset (linked) */
  double lower, upper; /* truncation, -HUGE_VAL / HUGE_VAL for none */
  size_t linked;       /* index of the axis it follows, which is not itself linked */
};

void design_axis_free_all(struct design_axis *axes, size_t count); /* frees the array too */

/* Value at quantile u in [0, 1), of every kind but linked. Integers are rounded to the nearest whole number within the
 * bounds. */
void design_axis_quantile(const struct design_axis *axis, double u, struct field_value *value);
/* The inverse: the share of the law below a value, in [0, 1]; for an integer the middle of its step. NaN: the axis has
 * no law. */
double design_axis_share(const struct design_axis *axis, const struct field_value *value);
/* Place of a value in a normal or lognormal law: standard deviations from its middle. */
double design_axis_deviations(const struct design_axis *axis, double value);
/* Value of a linked axis when the axis it follows has `value` at `level` (its level for LEVELS, else 0). */
void design_axis_follow(const struct design_axis *axis, const struct field_value *followed, size_t level,
                        struct field_value *value);
/* A value in the campaign's unit ("1e+28 cm^-3"), else as field_show() has it. Returns `text`. */
const char *design_axis_show(const struct design_axis *axis, const struct field_value *value, char *text, size_t size);
/* The exact value for a command: in the unit of the axis (angles without one: degrees) where this reads back as the
 * same number, else SI. Returns text. */
const char *design_axis_print(const struct design_axis *axis, const struct field_value *value, char *text, size_t size);
/* A point as people read it: "strain 3 %, energy 100 J/m", by the last words of the paths. inputs: of its scene. "": no
 * axes. */
const char *design_axis_show_point(size_t count, const struct design_axis *axes, const void *inputs, char *text,
                                   size_t size);
/* axes[index] for people, every number with its unit: "1 %, 3 %", "uniform from 1 GPa to 2 GPa". */
void design_axis_describe(const struct design_axis *axes, size_t index, FILE *out);
/* Level of a LEVELS axis at quantile u. */
size_t design_axis_level(const struct design_axis *axis, double u);

/* Level i of n >= 2 evenly spaced ones between two quantities such as "1 %" and "6 %", linear or (both positive)
 * logarithmic, in the SI unit `si`. The ends are exact. A level between them is the number of 15 digits that a person
 * would write in the unit of the ends, so ranges that share levels share them to the last bit. */
double design_axis_spaced(const char *from, const char *to, const char *si, size_t n, bool logarithmic, size_t i);

/* The points of a campaign, one after the other. A design is a counter, not a table, so that the first run of a million
 * points starts immediately. Point i of a design depends only on kind, seed, i and the number of points. */

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

/* The design for sensitivity indices of Saltelli (2002): blocks of points in the form that sensitivity_sobol() needs. A
 * block is A, B, and A with one input of B for each input; A and B are Sobol numbers, in groups of blocks with
 * independent random shifts. */

struct design_sensitivity; /* opaque */

/* blocks: best a power of two, from 64 on. STATUS_CONTENT: no input, more inputs than Sobol numbers allow (20), or no
 * block. */
status design_sensitivity_create(size_t inputs, size_t blocks, uint64_t seed, struct design_sensitivity **out,
                                 struct error *error);
void design_sensitivity_free(struct design_sensitivity *design); /* NULL is fine */
size_t design_sensitivity_rows(const struct design_sensitivity *design);
/* The group of a block of a design of so many blocks, counted from 0: eight groups, or every block its own if
 * there are fewer than 16. Blocks of one group are spread evenly, so their errors are no independent ones. Different
 * groups are independent, so their scatter tells how far off an index is (Owen 1998, randomised quasi-Monte Carlo). */
uint32_t design_sensitivity_group(size_t blocks, size_t block);
/* Coordinates of a row in (0, 1), one for each input: the arguments of the quantiles. */
void design_sensitivity_row(const struct design_sensitivity *design, size_t row, double *coordinates);

/* When a point has enough replicates. The rule judges complete prefixes 0..n-1 of the replicate numbers only: "the
 * first n that finished" would favour quick runs (measured bias: 2.8 standard errors with 32 workers). */

struct design_stopping {
  bool fixed; /* `minimum` replicates, the rule is not applied */
  int64_t minimum, batch, maximum;
  bool share;               /* of a share: its interval in tables is wider than Student's, and must be as narrow, too */
  bool of_mean;             /* half_width is a share of the mean, else in the quantity's SI unit */
  double half_width, level; /* of the mean's confidence interval */
};

enum design_verdict { DESIGN_GROW, DESIGN_INTERVAL_MET, DESIGN_CAP_REACHED, DESIGN_FIXED };

/* The half width that the rule has reached at a prefix, in the unit of rule->half_width. NaN: a fixed number of runs,
 * or fewer than two values. */
double design_stopping_reached(const struct design_stopping *rule, const double *values, int64_t prefix);

/* All replicates below *prefix have ended; values[r] is NaN for a failed run. DESIGN_GROW: *prefix is set to the next
 * prefix to complete. Otherwise the point is finished at this prefix. */
enum design_verdict design_stopping_judge(const struct design_stopping *rule, const double *values, int64_t *prefix);
