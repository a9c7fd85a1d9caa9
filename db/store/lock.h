/* The writer's lock: an open-file-description lock (fcntl(2), F_OFD_SETLK) on a byte of the store far behind SQLite's
 * own. It goes when the process does, however that ends; no reader feels it; it leaves nothing behind. A traditional
 * record lock would not do: SQLite's own unlocking of the file drops all of the process's record locks on it. */
#ifndef CLAST_DB_STORE_LOCK_H
#define CLAST_DB_STORE_LOCK_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

/* The file (created when absent), locked: *descriptor to close when done, after SQLite has closed the file, since
 * closing any descriptor of a file drops SQLite's record locks on it. STATUS_IO; *held says that it is because another
 * holds it: the caller adds who that is. A child forked from here on shares the lock until it ends or executes another
 * program. */
status lock_take(const char *path, int *descriptor, bool *held, struct error *error);
/* Does it lie on a network file system, where locks and shared memory cannot be trusted? The name of it, or NULL. */
const char *lock_network_file_system(int descriptor);

#endif
