/* Inspecting a store whose runs are taken over: all pages, then the digests of all rows. A thread does this with a
 * connection of its own while the caller copies the rows. It takes about a third of the time of a merge. */
#ifndef CLAST_DB_STORE_INSPECT_H
#define CLAST_DB_STORE_INSPECT_H

#include "schemas/status.h"

struct inspection;

/* Opens the store at `source`, which refuses a missing, foreign, newer or older file and one with unexpected objects.
 * Starts the thread. STATUS_OK: the caller must call inspect_end(). */
status inspect_begin(const char *source, struct inspection **out, struct error *error);
/* A progress handler of SQLite for the caller's connection: it ends a statement once the thread has found damage.
 * Damaged pages can make a statement endless. */
int inspect_failed(void *inspection);
/* Waits for the end of the thread and frees the inspection. STATUS_CONTENT: the source is damaged, so nothing
 * that was copied may be kept. NULL: nothing to do, STATUS_OK. */
status inspect_end(struct inspection *inspection, struct error *error);

#endif
