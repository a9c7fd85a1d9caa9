/* A quantity over one or two varied inputs, as `clast plot` and `clast map` draw it: the mean of a result over the runs
 * that share the inputs, or an exponent fitted to the runs of each point. */
#ifndef CLAST_CAMPAIGN_CHARTS_QUANTITY_H
#define CLAST_CAMPAIGN_CHARTS_QUANTITY_H

#include "analysis/statistics/exponent.h"
#include "campaign/terminal/option.h"
#include "db/ask/group.h"
#include "engine/outcome.h"

/* Options of both commands: the input on the horizontal axis, and the quantity. */
#define QUANTITY_AXIS_OPTION(type_, member_)                                                                           \
  OPTION_ROW_TEXT("x", 'x', "AXIS", type_, member_, NULL,                                                              \
                  "Varied input on the horizontal axis: a path or its unique ending.")
#define QUANTITY_OPTION(type_, member_)                                                                                \
  OPTION_ROW_TEXT("quantity", 'q', "NAME", type_, member_, OUTCOME_DEFAULT,                                            \
                  "Quantity to draw: a result (a column of the view runs), or an exponent fitted to the runs of a "    \
                  "point: beta, or beta_METHOD_WINDOW (beta_masses_from_2).")

struct quantity_choice {
  const char *axis[2]; /* varied inputs by path or unique ending; the second may be NULL */
  const char *name;    /* a result column, beta, or beta_METHOD_WINDOW */
  bool newest;         /* exponents: only of each point's newest results_version, including points without runs */
  const char *refusal; /* message when these are not one or two different inputs and one quantity */
};

struct quantity {
  bool exponent;
  size_t axes;                   /* 1 or 2 */
  char column[2][256];           /* the axes' columns in the views */
  char name[256];                /* column of the quantity, or the exponent's name */
  char pooled[ASK_GROUP_POOLED]; /* other varied inputs that the means average over, with points as units; "": none */
};

struct quantity_row {
  const struct query_value *input; /* one value for each axis, in the campaign's unit; borrowed for the call */
  int64_t results_version;
  double value, lower, upper; /* bounds of the 95 % interval; NaN: unknown */
  double resolution;          /* possible change of the value by finer settings; NaN: unknown */
};

/* Passes every value to `each`; `quantity` is filled in before the first call. A status of `each` other than STATUS_OK
 * ends the reading and is returned. STATUS_USAGE: unknown names. */
status quantity_read(struct store *store, const struct quantity_choice *choice, struct quantity *quantity,
                     status (*each)(void *context, const struct quantity_row *row, struct error *error), void *context,
                     struct error *error);

/* Prints a line on stderr: the meaning of the intervals, and the error of the resolution. pooled: from ask_group. */
void quantity_tell_resolution(struct store *store, const char *name, const char *pooled);
/* Prints a line for each of several comma-separated names; "main": the default quantity. */
void quantity_tell_resolutions(struct store *store, const char *names, const char *pooled);

#endif
