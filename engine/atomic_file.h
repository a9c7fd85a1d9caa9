/* Files that are there whole or not at all: written to a temporary name beside the target, flushed to the disk,
 * renamed. A process that is killed amid a write leaves FILE.tmp, which the next write of FILE takes over. */
#ifndef CLAST_ENGINE_ATOMIC_FILE_H
#define CLAST_ENGINE_ATOMIC_FILE_H

#include <stddef.h>

#include "schemas/status.h"

/* STATUS_IO with the system's reason (full disk, no permission, no such folder); nothing is left behind then. `what`
 * names the file's purpose in the message ("restart file"). */
status atomic_file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error);
/* Whether `path` could be written now, so that a long run does not end with a file that has no place: STATUS_IO with
 * the system's reason. What stands there is left alone. */
status atomic_file_try(const char *path, const char *what, struct error *error);
/* *bytes is malloc'd. STATUS_MISSING, STATUS_IO, STATUS_MEMORY. */
status atomic_file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error);

#endif
