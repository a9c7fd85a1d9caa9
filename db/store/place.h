/* Where a store lies: names that are no files, a file that is moved away while it is written, a copy that lacks a part.
 */
#ifndef CLAST_DB_STORE_PLACE_H
#define CLAST_DB_STORE_PLACE_H

#include <stdbool.h>

#include "schemas/status.h"

struct sqlite3;

/* Why the name cannot be a store's: SQLite takes ":memory:", "file:..." and "" for no file, or for one in memory, and
 * the results would be gone at the end. NULL: it can. */
const char *place_refused(const char *path);
/* Does something lie at the path that is no file: a folder, a pipe, a device? To open a pipe waits for good. STATUS_IO
 * then; STATUS_OK for a file, or nothing. */
status place_is_file(const char *path, struct error *error);
/* STATUS_IO when the open file is not at its path any more: moved, removed or replaced. What is written then reaches
 * nobody. */
status place_check(struct sqlite3 *db, const char *path, struct error *error);
/* Is the file in WAL mode, with no or an empty FILE-wal beside it? Ask before SQLite opens it, which may make one. A
 * store that is being written looks like this when FILE alone was copied. */
bool place_lacks_wal(const char *path);

#endif
