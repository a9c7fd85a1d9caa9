/* The writer's lock: an open-file-description lock (fcntl(2), F_OFD_SETLK) on a byte of the store far beyond those that
 * SQLite locks. It ends with the process, leaves no file, and does not affect readers. A traditional record lock would
 * not work: when SQLite unlocks the file, all record locks of the process on it are dropped. */
#ifndef CLAST_DB_STORE_LOCK_H
#define CLAST_DB_STORE_LOCK_H

#include <stdbool.h>

#include "schemas/status.h"

/* Opens the file (created when absent) and locks it. Close *descriptor after SQLite has closed the file: closing any
 * descriptor of a file drops SQLite's record locks on it. STATUS_IO on failure; *held: true if the cause is that
 * another process holds the lock. A child that is forked later shares the lock until it ends or executes another
 * program. */
status lock_take(const char *path, int *descriptor, bool *held, struct error *error);
/* Is another process writing the store? Call it only for a file that this process has not opened: closing any
 * descriptor of a file drops SQLite's record locks on it. */
bool lock_is_held(const char *path);
/* The name of the file's network file system, on which locks and shared memory are not reliable; NULL: none. */
const char *lock_network_file_system(int descriptor);

#endif
