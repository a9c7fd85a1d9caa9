/* The part of snapshot_read.h that calls HDF5. Only the process that snapshot_read.c starts calls it: HDF5 can crash on
 * a damaged file. The functions match those of snapshot_read.h; a file stays open until the process ends. */
#ifndef CLAST_ANALYSIS_PICTURES_SNAPSHOT_HDF5_H
#define CLAST_ANALYSIS_PICTURES_SNAPSHOT_HDF5_H

#include "analysis/pictures/snapshot_read.h"

struct snapshot_hdf5; /* opaque */

struct snapshot_hdf5 *snapshot_hdf5_open(const char *path); /* NULL: the file is no HDF5 file */
bool snapshot_hdf5_has(struct snapshot_hdf5 *file, const char *name);
void *snapshot_hdf5_rows(struct snapshot_hdf5 *file, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows);
bool snapshot_hdf5_text(struct snapshot_hdf5 *file, const char *at, const char *name, char *text, size_t size);
bool snapshot_hdf5_real(struct snapshot_hdf5 *file, const char *at, const char *name, double *value);
bool snapshot_hdf5_integer(struct snapshot_hdf5 *file, const char *at, const char *name, long long *value);

#endif
