/* How near a mistyped name is to a known one: what every "did you mean" goes by. */
#ifndef CLAST_SCHEMAS_EDIT_DISTANCE_H
#define CLAST_SCHEMAS_EDIT_DISTANCE_H

#include <stddef.h>

enum { EDIT_DISTANCE_LENGTH = 128 };

/* Optimal string alignment: insertions, deletions, changed letters and swapped neighbours each cost 1. `a` is `length`
 * bytes. SIZE_MAX when a name is longer than EDIT_DISTANCE_LENGTH. */
size_t edit_distance(const char *a, size_t length, const char *b);
/* The largest distance at which a name of this length is worth a guess: about a third of it, and nothing for one
 * letter. */
size_t edit_distance_limit(size_t length);

#endif
