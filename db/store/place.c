/* Checks the location of a store. */
#include "db/store/place.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *place_refused(const char *path) {
  if (!*path)
    return "a store needs a file name";
  if (strcmp(path, ":memory:") == 0 || strncmp(path, "file:", 5) == 0)
    return "SQLite takes this name for memory or a URI, and the results would be lost: name a plain file "
           "(./ before the name makes it one)";
  return NULL;
}

status place_is_file(const char *path, struct error *error) {
  struct stat file;
  if (stat(path, &file) != 0 || S_ISREG(file.st_mode))
    return STATUS_OK;
  if (S_ISDIR(file.st_mode))
    return status_fail(error, STATUS_IO, "%s is a folder: name the store's file.", path);
  return status_fail(error, STATUS_IO, "%s is a pipe, socket or device: name the store's file.", path);
}

status place_check(sqlite3 *db, const char *path, struct error *error) {
  int moved = 0;
  if (sqlite3_file_control(db, "main", SQLITE_FCNTL_HAS_MOVED, &moved) != SQLITE_OK || !moved)
    return STATUS_OK;
  return status_fail(error, STATUS_IO,
                     "%s was moved, removed or replaced while clast wrote it: clast stores nothing more. The original "
                     "file has all committed runs. Put it back, and give the same command again.",
                     path);
}

/* Bytes 18 and 19 of a database are its write and read version: 2 is WAL mode (SQLite's file format, 1.3.3). */
static bool in_wal_mode(const char *path) {
  unsigned char head[20] = {0};
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const bool whole = read(file, head, sizeof head) == (ssize_t)sizeof head;
  close(file);
  return whole && memcmp(head, "SQLite format 3", 16) == 0 && head[18] == 2 && head[19] == 2;
}

bool place_lacks_wal(const char *path) {
  struct stat wal;
  char *name = NULL;
  if (!in_wal_mode(path) || asprintf(&name, "%s-wal", path) < 0)
    return false;
  const bool lacks = stat(name, &wal) != 0 || wal.st_size == 0;
  free(name);
  return lacks;
}
