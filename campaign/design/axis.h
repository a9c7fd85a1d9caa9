/* One axis of a campaign: the path of an input in the scene and its values. No code depends on the name of the path.
 * Every kind of axis is one function of u in [0, 1): its quantile. Grids use the levels of the kinds that have
 * levels. */
#ifndef CLAST_CAMPAIGN_DESIGN_AXIS_H
#define CLAST_CAMPAIGN_DESIGN_AXIS_H

#include "schemas/field.h"

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
/* Value of a linked axis when the axis it follows has `value` at `level` (its level for LEVELS, else 0). */
void design_axis_follow(const struct design_axis *axis, const struct field_value *followed, size_t level,
                        struct field_value *value);
/* axes[index] for people, every number with its unit: "1 %, 3 %", "uniform from 1 GPa to 2 GPa". */
void design_axis_describe(const struct design_axis *axes, size_t index, FILE *out);
/* Level of a LEVELS axis at quantile u. */
size_t design_axis_level(const struct design_axis *axis, double u);

/* Level i of n >= 2 evenly spaced ones between two quantities such as "1 %" and "6 %", linear or (both positive)
 * logarithmic, in the SI unit `si`. The ends are exact. A level between them is the number of 15 digits that a person
 * would write in the unit of the ends, so ranges that share levels share them to the last bit. */
double design_axis_spaced(const char *from, const char *to, const char *si, size_t n, bool logarithmic, size_t i);

#endif
