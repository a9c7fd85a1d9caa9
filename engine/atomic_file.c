/* Writes and reads whole files. */
#include "engine/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/grow.h"

enum { BLOCK = 1 << 16 }; /* bytes read at a time, at least */

/* Is it a pipe or a device, such as /dev/stdout? These are written directly and never replaced. */
static bool is_special(const char *path) {
  struct stat there;
  return stat(path, &there) == 0 && !S_ISREG(there.st_mode) && !S_ISDIR(there.st_mode);
}

static bool write_whole(FILE *file, const void *bytes, size_t size) {
  return fwrite(bytes, 1, size, file) == size && fflush(file) == 0;
}

static status write_special(const char *path, const char *what, const void *bytes, size_t size, struct error *error) {
  FILE *file = fopen(path, "wb");
  const bool good = file && write_whole(file, bytes, size);
  const int why = errno;
  if (file)
    fclose(file);
  return good ? STATUS_OK : status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, strerror(why));
}

/* Does the open file still have this name? Its writer may have renamed it. */
static bool is_at(int file, const char *name) {
  struct stat mine, there;
  return fstat(file, &mine) == 0 && stat(name, &there) == 0 && mine.st_dev == there.st_dev &&
         mine.st_ino == there.st_ino;
}

static bool is_folder(const char *path) {
  struct stat there;
  return stat(path, &there) == 0 && S_ISDIR(there.st_mode);
}

/* Opens a new file beside `path`: FILE.tmp, which its writer locks. A lock dies with its process, so the next writer
 * takes over the file that a killed writer left behind. Where another writer holds the lock, or the file system has no
 * locks, the name is FILE.PID.tmp. `size` is that of the buffer `temporary`. NULL: errno says why. */
static FILE *begin(const char *path, char *temporary, size_t size) {
  snprintf(temporary, size, "%s.tmp", path);
  const int file = open(temporary, O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0 && is_at(file, temporary) && ftruncate(file, 0) == 0)
    return fdopen(file, "wb");
  if (file >= 0)
    close(file);
  snprintf(temporary, size, "%s.%ld.tmp", path, (long)getpid());
  return fopen(temporary, "wb");
}

status atomic_file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error) {
  if (is_special(path))
    return write_special(path, what, bytes, size, error);
  size_t length = strlen(path) + 32;
  char *temporary = malloc(length);
  if (!temporary)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  status code = STATUS_OK;
  FILE *file = begin(path, temporary, length);
  const bool good = file && write_whole(file, bytes, size) && fsync(fileno(file)) == 0 && rename(temporary, path) == 0;
  if (!good)
    code = status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, strerror(errno));
  if (!good && file)
    unlink(temporary);
  if (file)
    fclose(file); /* releases the lock, after all is on the disk */
  free(temporary);
  return code;
}

status atomic_file_try(const char *path, const char *what, struct error *error) {
  if (is_special(path) && access(path, W_OK) == 0)
    return STATUS_OK;
  size_t length = strlen(path) + 32;
  char *temporary = malloc(length);
  if (!temporary)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  const bool folder = is_folder(path);
  FILE *file = folder ? NULL : begin(path, temporary, length);
  const int why = folder ? EISDIR : errno;
  if (file) {
    unlink(temporary);
    fclose(file);
  }
  free(temporary);
  return file ? STATUS_OK : status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, strerror(why));
}

status atomic_file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error) {
  *bytes = NULL;
  *size = 0;
  FILE *file = fopen(path, "rb");
  if (!file)
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "cannot read the %s '%s': %s", what, path,
                       strerror(errno));
  status code = STATUS_OK;
  size_t capacity = 0, used = 0, got = 1;
  unsigned char *buffer = NULL;
  while (got > 0) {
    if (!grow_room(&buffer, &capacity, used + BLOCK, 1)) {
      code = status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
      goto cleanup;
    }
    got = fread(buffer + used, 1, capacity - used, file);
    used += got;
  }
  if (ferror(file)) {
    code = status_fail(error, STATUS_IO, "cannot read the %s '%s': %s", what, path, strerror(errno));
    goto cleanup;
  }
  *bytes = buffer;
  *size = used;
  buffer = NULL;
cleanup:
  free(buffer);
  fclose(file);
  return code;
}
