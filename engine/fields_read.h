/* Reading fields files (fields_file.h) that may come from anywhere: what a file claims is checked against what it can hold
 * before anything is allocated. HDF5 prints nothing meanwhile. */
#ifndef CLAST_ENGINE_FIELDS_READ_H
#define CLAST_ENGINE_FIELDS_READ_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

enum { FIELDS_READ_LARGEST = 100000000 }; /* rows: more is a damaged file */

struct fields_read; /* opaque */

/* STATUS_MISSING, STATUS_IO; STATUS_CONTENT: no HDF5 file. */
status fields_read_open(const char *path, struct fields_read **out, struct error *error);
void fields_read_close(struct fields_read *file); /* NULL is fine */

bool fields_read_has(struct fields_read *file, const char *name);
enum fields_read_kind { FIELDS_READ_REAL, FIELDS_READ_INTEGER }; /* double, int64_t: converted from what is stored */
/* A whole data set of numbers, `width` a row (0: one dimension); malloc'd. NULL when there is none of that shape, when it
 * claims more than the file can hold, or memory is out. */
void *fields_read_rows(struct fields_read *file, const char *name, size_t width, enum fields_read_kind kind, size_t *rows);
/* A text attribute, cut to `size`; empty and false when there is none. Scalar numbers likewise. */
bool fields_read_text(struct fields_read *file, const char *at, const char *name, char *text, size_t size);
bool fields_read_real(struct fields_read *file, const char *at, const char *name, double *value);
bool fields_read_integer(struct fields_read *file, const char *at, const char *name, long long *value);

#endif
