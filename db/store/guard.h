/* A store may come from an untrusted source, so its contents are treated as data. This file defines what a store may
 * contain: the tables, indexes and views of db/store/schema.h, and result tables of engines that this program lacks.
 * Anything else is refused with its name. db/README.md says the same to users. */
#ifndef CLAST_DB_STORE_GUARD_H
#define CLAST_DB_STORE_GUARD_H

#include "db/sql.h"

/* Call on every new connection, before the first read. It turns off the file's views and triggers. Expressions in the
 * file may call harmless functions only. No statement can change the schema's text, attach a file or load an
 * extension. */
void guard_connection(sqlite3 *db);

/* Attaches another store as `other`, for reading only. */
status guard_attach(sqlite3 *db, const char *source, const char *doing, struct error *error);
/* Writes a compact copy of a store whose schema guard_schema() has passed. */
status guard_vacuum_into(sqlite3 *db, const char *path, const char *doing, struct error *error);

/* Compares the schema with ours. `version`: the store's; older ones may lack columns. STATUS_CONTENT: the message names
 * every object that no version of clast creates. */
status guard_schema(sqlite3 *db, const char *path, int version, struct error *error);

#endif
