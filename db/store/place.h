/* The location of a store: names that are no files, a file that is moved while it is written, a copy without its -wal
 * file. */
#ifndef CLAST_DB_STORE_PLACE_H
#define CLAST_DB_STORE_PLACE_H

#include <stdbool.h>

#include "schemas/status.h"

struct sqlite3;

/* Returns the reason why a name is refused as a store's; NULL: it is accepted. SQLite takes ":memory:", "file:..." and
 * "" for no file, or for a database in memory, so results would be lost at the end. It deletes and overwrites files
 * whose names end in -journal, -wal or -shm. */
const char *place_refused(const char *path);
/* STATUS_IO when the path leads to something other than a file: a folder, a pipe, a device (opening a pipe would
 * block), or when something else than a file lies at FILE-journal, FILE-wal or FILE-shm. STATUS_CONTENT when
 * FILE-journal would make SQLite delete another file. STATUS_OK for a file or a free path. */
status place_is_file(const char *path, struct error *error);
/* STATUS_IO when the open file is no longer at its path: moved, removed or replaced. Data written then would be
 * lost. */
status place_check(struct sqlite3 *db, const char *path, struct error *error);
/* Is the file in WAL mode, with no or an empty FILE-wal beside it? Call before SQLite opens the file, which may create
 * one. This is the state of a store that was copied without its FILE-wal while it was being written. */
bool place_lacks_wal(const char *path);

#endif
