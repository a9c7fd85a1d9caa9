/* Writing fields files: self-describing HDF5, `h5dump -A` alone explains one. Every data set says its unit and meaning.
 * Inputs and results are scalars with their documentation. Particles or cells are also a VTKHDF 1.0 grid, which VTK and
 * ParaView open as it is.
 *
 * The file is made in memory and written whole: a full disk or a forbidden folder is one clean error. Calls between
 * open and save return nothing: save reports errors of HDF5. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "engine/engine.h"

struct snapshot_file; /* opaque */

/* The file's head. Group /run: engine (name), doc, results_version, seed, scene (resolved JSON of `inputs`), time.
 * Groups /inputs, /outcome and /results: the rows of their tables. STATUS_MEMORY or STATUS_INTERNAL. HDF5's own
 * printing is off until the file is closed. */
status snapshot_file_open(const struct engine_kind *engine, uint64_t seed, const void *inputs,
                          const struct outcome *outcome, const void *results, struct snapshot_file **out,
                          struct error *error);
void snapshot_file_close(struct snapshot_file *file); /* NULL is fine */
/* STATUS_IO with the system's reason: no file is left behind. STATUS_INTERNAL, STATUS_MEMORY. */
status snapshot_file_save(struct snapshot_file *file, const char *path, struct error *error);
/* Records that the caller had no memory for its data: save then returns STATUS_MEMORY. */
void snapshot_file_fail(struct snapshot_file *file);

/* double, int64_t, unsigned char */
enum snapshot_file_kind { SNAPSHOT_FILE_REAL, SNAPSHOT_FILE_INTEGER, SNAPSHOT_FILE_BYTE };
/* rows x width values; width 0: rows values in one dimension. Integers and bytes of many rows are compressed. Missing
 * groups of the path are created. units and long_name may be NULL (VTK's own bookkeeping). */
void snapshot_file_data(struct snapshot_file *file, const char *name, enum snapshot_file_kind kind, size_t rows,
                        size_t width, const void *values, const char *units, const char *long_name);
/* One column of a table whose rows are structs: a member (a number, or `width` numbers in a row), written as double. */
struct snapshot_file_column {
  const char *name, *units, *long_name;
  size_t width;  /* 0: one number, in one dimension */
  size_t offset; /* of the member, or of its first number */
  enum snapshot_file_member {
    SNAPSHOT_FILE_DOUBLE,
    SNAPSHOT_FILE_UINT32,
    SNAPSHOT_FILE_UINT64,
    SNAPSHOT_FILE_BOOL
  } member;
};
/* The initialiser of a column: its struct and member, the width, the unit and the meaning. The second form gives a name
 * that is not the member's. */
#define SNAPSHOT_FILE_COLUMN(struct_, member_, width_, units_, long_name_)                                             \
  SNAPSHOT_FILE_COLUMN_NAMED(#member_, struct_, member_, width_, units_, long_name_)
/* clang-format off */
#define SNAPSHOT_FILE_COLUMN_NAMED(name_, struct_, member_, width_, units_, long_name_)                                \
  {                                                                                                                    \
    name_, units_, long_name_, width_, offsetof(struct struct_, member_),                                              \
    _Generic(((struct struct_ *)0)->member_, double : SNAPSHOT_FILE_DOUBLE, double * : SNAPSHOT_FILE_DOUBLE,           \
             uint32_t : SNAPSHOT_FILE_UINT32, uint32_t * : SNAPSHOT_FILE_UINT32, uint64_t : SNAPSHOT_FILE_UINT64,      \
             bool : SNAPSHOT_FILE_BOOL)                                                                                \
  }
/* clang-format on */

/* Writes `count` columns of `rows` structs, `size` bytes each. */
void snapshot_file_columns(struct snapshot_file *file, const char *group, size_t rows, const void *structs, size_t size,
                           size_t count, const struct snapshot_file_column *column);

/* The head of a VTKHDF 1.0 unstructured grid: version, type, counts. The other data sets are written under VTKHDF/. */
void snapshot_file_vtk(struct snapshot_file *file, size_t points, size_t cells, size_t connectivity);
