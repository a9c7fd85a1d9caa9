/* Reading fields files (snapshot_file.h) that may come from anywhere: what a file claims is checked against what it can
 * hold before anything is allocated. HDF5 prints nothing meanwhile. */
#ifndef CLAST_ENGINE_SNAPSHOT_READ_H
#define CLAST_ENGINE_SNAPSHOT_READ_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum { FIELDS_READ_LARGEST = 100000000 }; /* rows: more is a damaged file */

struct snapshot_read; /* opaque */

/* STATUS_MISSING, STATUS_IO; STATUS_CONTENT: no HDF5 file. */
status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error);
void snapshot_read_close(struct snapshot_read *file); /* NULL is fine */

bool snapshot_read_has(struct snapshot_read *file, const char *name);
enum snapshot_read_kind { FIELDS_READ_REAL, FIELDS_READ_INTEGER }; /* double, int64_t: converted from what is stored */
/* A whole data set of numbers, `width` a row (0: one dimension); malloc'd. NULL when there is none of that shape, when
 * it claims more than the file can hold, or memory is out. */
void *snapshot_read_rows(struct snapshot_read *file, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows);
/* A text attribute, cut to `size`; empty and false when there is none. Scalar numbers likewise. */
bool snapshot_read_text(struct snapshot_read *file, const char *at, const char *name, char *text, size_t size);
bool snapshot_read_real(struct snapshot_read *file, const char *at, const char *name, double *value);
bool snapshot_read_integer(struct snapshot_read *file, const char *at, const char *name, long long *value);

#endif
