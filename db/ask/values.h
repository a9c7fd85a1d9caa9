/* One quantity of every run that counts, run by run. */
#ifndef CLAST_DB_ASK_VALUES_H
#define CLAST_DB_ASK_VALUES_H

#include "db/ask/query.h"

struct ask_values_choice {
  const char *campaign; /* only runs of this campaign's points; NULL: all */
  int64_t point;        /* only this point; 0: all */
};
struct ask_values_row {
  const char *inputs; /* the varied inputs of the point, "material.m = 9.0, ..."; borrowed for the call */
  int64_t point_id, replicate, seed;
  double value; /* NaN: off */
};
typedef status (*ask_values_each)(void *context, const struct ask_values_row *row, struct error *error);

/* The values of a column (ask_group_quantity) of the newest results_version, ordered by inputs, point and seed.
 * STATUS_USAGE: the store has no campaign of that name. */
status ask_values(struct store *store, const struct ask_values_choice *choice, const char *column, ask_values_each each,
                  void *context, struct error *error);

#endif
