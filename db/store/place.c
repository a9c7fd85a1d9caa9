/* Checks the location of a store. */
#include "db/store/place.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/file.h"

const char *place_refused(const char *path) {
  if (!*path)
    return "a store needs a file name";
  if (strcmp(path, ":memory:") == 0 || strncmp(path, "file:", 5) == 0)
    return "SQLite takes this name for memory or a URI, and the results would be lost: name a plain file "
           "(./ before the name makes it one)";
  if (file_is_companion(path))
    return "SQLite keeps its journals under names with this ending: give the store another name";
  return NULL;
}

/* Does the journal name a super-journal? It ends with the sum and length of that name and these 8 bytes (SQLite's file
 * format, 3.0). clast writes none. SQLite deletes the file of that name when it rolls the journal back. */
static bool names_another_file(const char *journal) {
  static const unsigned char magic[8] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
  unsigned char tail[sizeof magic] = {0};
  const int file = open(journal, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return false;
  const bool whole = lseek(file, -(off_t)sizeof tail, SEEK_END) > 0 &&
                     read(file, tail, sizeof tail) == (ssize_t)sizeof tail;
  close(file);
  return whole && memcmp(tail, magic, sizeof magic) == 0;
}

static status judge_beside(const char *name, struct error *error) {
  struct stat file;
  if (lstat(name, &file) != 0)
    return STATUS_OK;
  if (!S_ISREG(file.st_mode))
    return status_fail(error, STATUS_IO, "%s is a folder, link, pipe, socket or device: remove it.", name);
  if (!names_another_file(name))
    return STATUS_OK;
  return status_fail(error, STATUS_CONTENT,
                     "%s is no journal of clast: it names a file, which SQLite would delete. Remove it, and do not "
                     "trust the store beside it.",
                     name);
}

/* Checks the files that SQLite opens beside the store. */
static status judge_companions(const char *path, struct error *error) {
  char *real = realpath(path, NULL), *name = NULL; /* SQLite follows links to the store */
  status result = STATUS_OK;
  for (size_t i = 0; result == STATUS_OK && file_companions[i]; i++) {
    if (asprintf(&name, "%s%s", real ? real : path, file_companions[i]) < 0)
      break;
    result = judge_beside(name, error);
    free(name);
  }
  free(real);
  return result;
}

status place_is_file(const char *path, struct error *error) {
  struct stat file;
  if (stat(path, &file) != 0 || S_ISREG(file.st_mode))
    return judge_companions(path, error);
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
