/* Is this file a store of clast, and of which version? Older stores are upgraded; other files do not change. */
#ifndef CLAST_DB_STORE_MIGRATE_H
#define CLAST_DB_STORE_MIGRATE_H

#include "db/sql.h"

/* version: the store's user_version, -1 when the file is new (empty). STATUS_CONTENT: not SQLite, not a store, newer
 * than this program, damaged, or with unexpected objects (db/store/guard.h). */
status migrate_inspect(sqlite3 *db, const char *path, int *version, struct error *error);

/* Creates everything in an empty file, or upgrades an older version in one transaction, after copying it to
 * `path`.version<N> (VACUUM INTO). For the current version: adds columns that the field tables gained, and makes the
 * views again. */
status migrate_bring_forward(sqlite3 *db, const char *path, int version, struct error *error);

#endif
