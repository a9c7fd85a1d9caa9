#include "engine/whole_file.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

status whole_file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error) {
  size_t length = strlen(path) + 32;
  char *temporary = malloc(length);
  if (!temporary)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  snprintf(temporary, length, "%s.%ld.tmp", path, (long)getpid());
  status code = STATUS_OK;
  FILE *file = fopen(temporary, "wb");
  bool good = file && fwrite(bytes, 1, size, file) == size && fflush(file) == 0 && fsync(fileno(file)) == 0;
  int why = errno;
  if (file && fclose(file) != 0 && good) {
    good = false;
    why = errno;
  }
  if (good && rename(temporary, path) != 0) {
    good = false;
    why = errno;
  }
  if (!good) {
    if (file)
      unlink(temporary);
    code = status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, strerror(why));
  }
  free(temporary);
  return code;
}

status whole_file_try(const char *path, const char *what, struct error *error) {
  size_t length = strlen(path) + 32;
  char *temporary = malloc(length);
  if (!temporary)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  snprintf(temporary, length, "%s.%ld.tmp", path, (long)getpid());
  struct stat there;
  int why = stat(path, &there) == 0 && S_ISDIR(there.st_mode) ? EISDIR : 0;
  FILE *file = why ? NULL : fopen(temporary, "wb");
  if (!file && !why)
    why = errno;
  if (file) {
    fclose(file);
    unlink(temporary);
  }
  free(temporary);
  return why ? status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, strerror(why)) : STATUS_OK;
}

status whole_file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error) {
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
    if (used == capacity) {
      capacity = capacity ? 2 * capacity : 1 << 16;
      unsigned char *larger = realloc(buffer, capacity);
      if (!larger) {
        code = status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
        goto cleanup;
      }
      buffer = larger;
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
