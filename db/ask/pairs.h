/* The pairs of points that `clast compare` compares, and their differences. */
#ifndef CLAST_DB_ASK_PAIRS_H
#define CLAST_DB_ASK_PAIRS_H

#include <stdbool.h>

#include "analysis/statistics/sample.h"
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
/* The next pair; its texts are borrowed from `pairs`. False at the end. */
bool ask_pairs_next(struct ask_pairs *pairs, struct ask_pairs_row *row);
/* After the last pair. STATUS_USAGE: the sides have no point in common. */
status ask_pairs_end(const struct ask_pairs *pairs, struct error *error);
void ask_pairs_free(struct ask_pairs *pairs); /* NULL is fine */

#endif
