/* Is this file a store of ours, and of this version? Older ones are brought forward, nothing else is touched. */
#ifndef CLAST_DB_STORE_MIGRATE_H
#define CLAST_DB_STORE_MIGRATE_H

#include "db/sql.h"

/* *version: the store's user_version, -1 when the file is new (empty). STATUS_CONTENT: not SQLite, not ours, newer than
 * this program, damaged. */
status migrate_inspect(sqlite3 *db, const char *path, int *version, struct error *error);

/* Create everything in an empty file, or bring an older version forward, after a copy of it as `path`.version<N>
 * (VACUUM INTO); one transaction. For the current version: add columns that the field tables gained, renew the views.
 */
status migrate_bring_forward(sqlite3 *db, const char *path, int version, struct error *error);

#endif
