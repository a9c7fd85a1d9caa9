/* Reading fields files (engine/snapshot_file.h). A file may come from an untrusted source. Before it allocates memory,
 * the reader checks the sizes that a file claims against the size of the file. It opens no other file. HDF5 itself can
 * crash on a damaged file, so each file is read in a separate process. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum {
  SNAPSHOT_READ_LARGEST = 100000000, /* rows: a file with more rows counts as damaged */
  SNAPSHOT_READ_TEXT = 256
};

struct snapshot_read; /* opaque */

/* STATUS_MISSING; STATUS_IO, also for a pipe or device; STATUS_MEMORY; STATUS_CONTENT: the file is no HDF5 file. */
status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error);
/* False: HDF5 crashed on the file, and the data read before must not be used. */
bool snapshot_read_close(struct snapshot_read *file);
/* Sets the error for a file that clast did not write: STATUS_CONTENT. */
status snapshot_read_refuse(const char *path, struct error *error);

bool snapshot_read_has(struct snapshot_read *file, const char *name);
enum snapshot_read_kind {
  SNAPSHOT_READ_REAL,
  SNAPSHOT_READ_INTEGER
}; /* double, int64_t: converted from the stored type */
/* Reads a whole data set of numbers: *rows rows of `width` values; width 0: the data set has one dimension. The caller
 * frees it. NULL when there is no data set of that shape, when it claims more than the file can hold, or when memory
 * ran out. */
void *snapshot_read_rows(struct snapshot_read *file, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows);
/* Reads a text attribute, or a data set of one text, cut to `size` and to SNAPSHOT_READ_TEXT. False, with an empty
 * text, when it is missing, is no UTF-8 or has control characters: a picture cannot show it. */
bool snapshot_read_text(struct snapshot_read *file, const char *at, const char *name, char *text, size_t size);
/* Reads a number attribute. False, with *value unchanged, when it is missing. */
bool snapshot_read_real(struct snapshot_read *file, const char *at, const char *name, double *value);
bool snapshot_read_integer(struct snapshot_read *file, const char *at, const char *name, long long *value);
