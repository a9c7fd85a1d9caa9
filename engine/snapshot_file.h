/* Self-describing HDF5 files: `h5dump -A` alone explains one. Every data set says its unit and meaning; tables of
 * inputs and results go in as scalars with their documentation; what VTK reads (VTKHDF 1.0) stands beside it.
 *
 * The file is made in memory and written whole: a full disk or a forbidden folder is one clean error. Calls between
 * open and save do not fail by themselves; what HDF5 refused on the way is told by save. */
#ifndef CLAST_ENGINE_SNAPSHOT_FILE_H
#define CLAST_ENGINE_SNAPSHOT_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "schemas/field.h"

struct snapshot_file; /* opaque */

/* The file's head, group /run: `engine` (name), `doc`, results_version, seed, scene (resolved JSON of `inputs`).
 * STATUS_MEMORY or STATUS_INTERNAL. HDF5's own printing is off until the file is closed. */
status snapshot_file_open(const char *engine, const char *doc, int results_version, uint64_t seed,
                          const struct field_table *table, const void *inputs, struct snapshot_file **out,
                          struct error *error);
void snapshot_file_close(struct snapshot_file *file); /* NULL is fine */
/* STATUS_IO with the system's reason; nothing is left behind then. STATUS_INTERNAL, STATUS_MEMORY. */
status snapshot_file_save(struct snapshot_file *file, const char *path, struct error *error);
/* Memory that the writer needed could not be had: save will say so. */
void snapshot_file_fail(struct snapshot_file *file);

/* An attribute of a group or data set that is there. */
void snapshot_file_real(struct snapshot_file *file, const char *at, const char *name, double value);

enum snapshot_file_kind {
  SNAPSHOT_FILE_REAL,
  SNAPSHOT_FILE_INTEGER,
  SNAPSHOT_FILE_BYTE
}; /* double, int64_t, unsigned char */
/* rows x width values; width 0: rows values in one dimension. Integers and bytes of many rows are compressed. Groups on
 * the way are made; units and long_name may be NULL (VTK's own bookkeeping). */
void snapshot_file_data(struct snapshot_file *file, const char *name, enum snapshot_file_kind kind, size_t rows,
                        size_t width, const void *values, const char *units, const char *long_name);
/* Every active row of a table as a scalar under `group`, with its unit and documentation. */
void snapshot_file_table(struct snapshot_file *file, const char *group, const struct field_table *table,
                         const void *object);

/* Columns of doubles out of a reader of (row, column, component). */
struct snapshot_file_column {
  const char *name, *units, *long_name;
  size_t width; /* 0: one value a row */
};
typedef double (*snapshot_file_reader)(const void *context, size_t row, size_t column, size_t component);
void snapshot_file_columns(struct snapshot_file *file, const char *group, size_t rows, size_t count,
                           const struct snapshot_file_column *column, snapshot_file_reader read, const void *context);

/* The head of a VTKHDF 1.0 unstructured grid: version, type, counts. The rest are data sets under VTKHDF/. */
void snapshot_file_vtk(struct snapshot_file *file, size_t points, size_t cells, size_t connectivity);

#endif
