/* Places of stores, and the relative path from one to another. */
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "db/store/internal.h"
#include "schemas/memory.h"

enum { PATHS_LONGEST = 2 * LIMITS_PATH };

char *paths_of_fields(const char *store_path, const char *fields_path) {
  const char *slash = strrchr(store_path, '/');
  const int folder = slash && fields_path[0] != '/' ? (int)(slash - store_path + 1) : 0;
  char *path = NULL;
  if (asprintf(&path, "%.*s%s", folder, store_path, fields_path) < 0)
    memory_refused();
  return path;
}

bool paths_readable(const char *store_path, const char *fields_path) {
  OWNED char *path = paths_of_fields(store_path, fields_path);
  return access(path, R_OK) == 0;
}

bool paths_whole(const char *path, const char *digest) {
  char now[STORE_DIGEST_SIZE];
  return !digest || (store_digest_fields(path, now, NULL) == STATUS_OK && strcmp(now, digest) == 0);
}

status store_check_fields(struct store *store, const uint8_t identity[16], bool *whole, struct error *error) {
  static const char doing[] = "checking a fields file";
  STATEMENT run = NULL;
  status result = sql_prepare(store->db,
                              "SELECT fields_path, fields_digest FROM run WHERE identity = ?1 AND fields_path IS NOT "
                              "NULL AND fields_digest IS NOT NULL",
                              &run, doing, error);
  *whole = true;
  sqlite3_bind_blob(run, 1, identity, 16, SQLITE_STATIC);
  if (!sql_next(run, &result, doing, error))
    return result;
  OWNED char *path = paths_of_fields(store->path, sql_text(run, 0));
  *whole = paths_whole(path, sql_text(run, 1));
  return STATUS_OK;
}

char *paths_followed(const char *path) {
  struct stat file;
  char *real = lstat(path, &file) == 0 && S_ISLNK(file.st_mode) ? realpath(path, NULL) : NULL;
  return real ? real : memory_small_text(path);
}

/* The folder of a file, with symbolic links resolved and a slash at the end. */
static char *folder_of(const char *file, char resolved[PATHS_LONGEST]) {
  OWNED char *copy = memory_small_text(file);
  OWNED char *folder = realpath(dirname(copy), NULL);
  if (!folder)
    return NULL;
  snprintf(resolved, PATHS_LONGEST, "%s%s", folder, strcmp(folder, "/") == 0 ? "" : "/");
  return resolved;
}

char *paths_between(const char *target, const char *source) {
  char from[PATHS_LONGEST], to[PATHS_LONGEST], *way = NULL;
  size_t shared = 0;
  if (!folder_of(target, from) || !folder_of(source, to))
    return NULL;
  for (size_t i = 0; from[i] && from[i] == to[i]; i++)
    if (from[i] == '/')
      shared = i + 1;
  FILE *out = text_open(&way);
  for (const char *at = from + shared; *at; at++)
    if (*at == '/')
      fputs("../", out);
  fputs(to + shared, out);
  return text_close_small(out, &way);
}
