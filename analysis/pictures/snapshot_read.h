/* Reading fields files (engine/snapshot_file.h). A file may come from anywhere: the reader checks what a file claims
 * against what it can hold before it allocates anything, and opens no other file. HDF5 itself can crash on a damaged
 * file, so that a process of its own reads each file (snapshot_hdf5.h). */
#ifndef CLAST_ANALYSIS_PICTURES_SNAPSHOT_READ_H
#define CLAST_ANALYSIS_PICTURES_SNAPSHOT_READ_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum {
  SNAPSHOT_READ_LARGEST = 100000000, /* rows: a file with more is damaged */
  SNAPSHOT_READ_TEXT = 256
};

struct snapshot_read; /* opaque */

/* STATUS_MISSING, STATUS_IO, STATUS_MEMORY; STATUS_CONTENT: it is no HDF5 file. */
status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error);
/* False: HDF5 crashed on the file, and what was read is not to be used. */
bool snapshot_read_close(struct snapshot_read *file);
/* The error for a file whose content is not what clast writes: STATUS_CONTENT. */
status snapshot_read_refuse(const char *path, struct error *error);

bool snapshot_read_has(struct snapshot_read *file, const char *name);
enum snapshot_read_kind {
  SNAPSHOT_READ_REAL,
  SNAPSHOT_READ_INTEGER
}; /* double, int64_t: converted from what is stored */
/* A whole data set of numbers, malloc'd: *rows rows of `width` values; width 0: the data set has one dimension. NULL
 * when there is no data set of that shape, when it claims more than the file can hold, or when memory is out. */
void *snapshot_read_rows(struct snapshot_read *file, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows);
/* A text attribute, cut to `size` and to SNAPSHOT_READ_TEXT. False, with an empty text, when there is none. */
bool snapshot_read_text(struct snapshot_read *file, const char *at, const char *name, char *text, size_t size);
/* A number as attribute. False, and *value as it was, when there is none. */
bool snapshot_read_real(struct snapshot_read *file, const char *at, const char *name, double *value);
bool snapshot_read_integer(struct snapshot_read *file, const char *at, const char *name, long long *value);

#endif
