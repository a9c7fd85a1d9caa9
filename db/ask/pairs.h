/* The pairs of points that `clast compare` compares, and their differences. */
#ifndef CLAST_DB_ASK_PAIRS_H
#define CLAST_DB_ASK_PAIRS_H

#include "analysis/statistics/difference.h"
#include "engine/outcome.h"
#include "schemas/status.h"

struct ask_pairs; /* opaque */

struct ask_pairs_row {
  int64_t point[2];   /* number of each point in its store */
  const char *inputs; /* varied inputs that both have; "" when two points were named */
  struct difference difference;
};

/* Reads the values of both sides: STORE, STORE:POINT or STORE:CAMPAIGN. STATUS_USAGE: unknown name; STATUS_MISSING: no
 * such store. */
status ask_pairs_read(const char *first, const char *second, const char *quantity, struct ask_pairs **out,
                      struct error *error);
/* STATUS_USAGE: the sides have no point in common. */
status ask_pairs_each(const struct ask_pairs *pairs,
                      status (*each)(void *context, const struct ask_pairs_row *row, struct error *error),
                      void *context, struct error *error);
void ask_pairs_free(struct ask_pairs *pairs); /* NULL is fine */

#endif
