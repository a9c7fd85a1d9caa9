/* Where the fields files of a store are. table run keeps their paths relative to the store's folder, so that both can
 * move together. For db/ only. */
#ifndef CLAST_DB_STORE_PATHS_H
#define CLAST_DB_STORE_PATHS_H

#include <stdbool.h>

/* The path of a fields file as the process sees it; free() it. NULL: memory ran out. */
char *paths_of_fields(const char *store_path, const char *fields_path);

/* Can this file be read? */
bool paths_readable(const char *store_path, const char *fields_path);

/* What to put before a path that is relative to the folder of the store `source`, so that it is relative to that of
 * `target`: "" when the folders are the same, else "../" and names, with a slash at the end. free() it. NULL: a folder
 * is not there, or memory ran out. */
char *paths_between(const char *target, const char *source);

#endif
