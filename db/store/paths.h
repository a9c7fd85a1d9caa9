/* Locations of a store's fields files. Table run keeps their paths relative to the store's folder, so that both can
 * move together. For db/ only. */
#ifndef CLAST_DB_STORE_PATHS_H
#define CLAST_DB_STORE_PATHS_H

#include <stdbool.h>

/* The path of a fields file as this process can open it; the caller frees it. NULL: memory ran out. */
char *paths_of_fields(const char *store_path, const char *fields_path);

/* Can this file be read? */
bool paths_readable(const char *store_path, const char *fields_path);

/* The prefix that turns a path relative to the folder of the store `source` into one relative to the folder of
 * `target`: "" when the folders are the same, else "../" and names, with a slash at the end. The caller frees it. NULL:
 * a folder does not exist, or memory ran out. */
char *paths_between(const char *target, const char *source);

#endif
