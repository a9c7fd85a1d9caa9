/* Inspecting a store before its runs are taken over. Every page is read through first. The digests of all rows are then
 * compared in a thread with a connection of its own, while the caller copies the rows: reading digests takes about a
 * third of the time of a merge. */
#ifndef CLAST_DB_STORE_INSPECT_H
#define CLAST_DB_STORE_INSPECT_H

#include "schemas/status.h"

struct inspection;

/* Opens the store at `source`, which refuses a missing, foreign, newer or older file and one with unexpected objects.
 * Checks all its pages and starts to compare digests. STATUS_OK: the caller must call inspect_end(). */
status inspect_begin(const char *source, struct inspection **out, struct error *error);
/* Waits for the end of the comparison and frees the inspection. STATUS_CONTENT: a row is damaged, so nothing that was
 * copied may be kept. NULL: nothing to do, STATUS_OK. */
status inspect_end(struct inspection *inspection, struct error *error);

#endif
