/* One number for every run of a point: a result, an exponent, or the number of fragments heavier than a share of the
 * body. */
#ifndef CLAST_DB_ASK_SPECIMENS_H
#define CLAST_DB_ASK_SPECIMENS_H

#include "analysis/statistics/estimates.h"
#include "db/store/store.h"

enum ask_specimens_kind {
  ASK_SPECIMENS_RESULT,
  ASK_SPECIMENS_EXPONENT,
  ASK_SPECIMENS_COUNT, /* fragments heavier than a share of the body */
  ASK_SPECIMENS_SHARE, /* the share of the mass in such fragments: the part that a sieve retains */
};

struct ask_specimens_quantity {
  enum ask_specimens_kind kind;
  const struct field *row;     /* of a result */
  bool of_outcome;             /* a row of outcome_table, else of the engine's results */
  enum exponent_method method; /* of an exponent */
  enum estimates_window window;
  double share; /* threshold: share of the mass of all fragments together */
};

typedef void (*ask_specimens_each)(void *context, uint64_t seed, double value);

/* Runs that count, of the results_version of this program's engine. NaN: the run has no such value. */
status ask_specimens(struct store *store, int64_t point_id, const struct engine_kind *kind,
                     const struct ask_specimens_quantity *quantity, ask_specimens_each each, void *context,
                     struct error *error);

#endif
