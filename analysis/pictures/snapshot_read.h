/* Reading fields files (engine/snapshot_file.h). A file may come from anywhere: the reader checks what a file claims
 * against what it can hold before it allocates anything. HDF5 prints nothing meanwhile. */
#ifndef CLAST_ANALYSIS_PICTURES_SNAPSHOT_READ_H
#define CLAST_ANALYSIS_PICTURES_SNAPSHOT_READ_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum { SNAPSHOT_READ_LARGEST = 100000000 }; /* rows: a file with more is damaged */

struct snapshot_read; /* opaque */

/* STATUS_MISSING, STATUS_IO; STATUS_CONTENT: it is no HDF5 file. */
status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error);
void snapshot_read_close(struct snapshot_read *file); /* NULL is fine */
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
/* A text attribute, cut to `size`. False, with an empty text, when there is none. */
bool snapshot_read_text(struct snapshot_read *file, const char *at, const char *name, char *text, size_t size);
/* A number as attribute. False, and *value as it was, when there is none. */
bool snapshot_read_real(struct snapshot_read *file, const char *at, const char *name, double *value);
bool snapshot_read_integer(struct snapshot_read *file, const char *at, const char *name, long long *value);

#endif
