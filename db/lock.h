/* The writer's lock: a POSIX record lock on a byte of the store far behind SQLite's own. It dies with the process, is
 * felt by no reader, leaves nothing behind, and tells the process that holds it. */
#ifndef CLAST_DB_LOCK_H
#define CLAST_DB_LOCK_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

/* The file (created when absent), locked: *descriptor to close when done, after SQLite has closed the file, since
 * closing any descriptor of a file drops all of the process's record locks on it. When another process holds it:
 * STATUS_IO with *holder_pid set (0 when it is on another machine, -1 for every other error); the caller adds who that
 * is. */
status lock_take(const char *path, int *descriptor, long *holder_pid, struct error *error);
/* Does it lie on a network file system, where locks and shared memory cannot be trusted? The name of it, or NULL. */
const char *lock_network_file_system(int descriptor);

#endif
