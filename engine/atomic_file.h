/* Atomic file writing: a file is written under a temporary name beside the target, flushed to the disk and renamed. A
 * process that is killed during a write leaves FILE.tmp; the next write of FILE takes it over. A pipe or a device is
 * written directly. */
#ifndef CLAST_ENGINE_ATOMIC_FILE_H
#define CLAST_ENGINE_ATOMIC_FILE_H

#include <stddef.h>

#include "schemas/status.h"

/* Writes a file. STATUS_IO with the system's reason (full disk, no permission, no such folder): no file is left behind.
 * `what` names the file's purpose in the message ("restart file"). */
status atomic_file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error);
/* Tests whether `path` can be written now, so that a long run does not fail at its end. STATUS_IO with the system's
 * reason. An existing file does not change. */
status atomic_file_try(const char *path, const char *what, struct error *error);
/* Reads a whole file. *bytes is malloc'd and owned by the caller. STATUS_MISSING, STATUS_IO, STATUS_MEMORY. */
status atomic_file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error);

#endif
