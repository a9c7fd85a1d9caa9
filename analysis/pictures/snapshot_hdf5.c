/* Reading fields files with HDF5, in the process that snapshot_read.c starts. */
#include "analysis/pictures/snapshot_hdf5.h"

#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COMPRESSED = 1100 }; /* deflate's limit is 1032 : 1 */

struct snapshot_hdf5 {
  hid_t file;
  double bytes; /* largest size of the file's data if it is compressed */
};

struct snapshot_hdf5 *snapshot_hdf5_open(const char *path) {
  hsize_t size = 0;
  struct snapshot_hdf5 *f = calloc(1, sizeof *f);
  if (!f)
    return NULL;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* HDF5 prints nothing: the return values report errors */
  H5PLset_loading_state(0);              /* a file must not choose libraries to load: its unknown filters are errors */
  f->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (f->file >= 0 && H5Fget_filesize(f->file, &size) >= 0) {
    f->bytes = (double)size * MOST_COMPRESSED;
    return f;
  }
  free(f);
  return NULL;
}

/* Each part of the path must be a hard link: external links lead to other files, and clast writes no soft links. */
bool snapshot_hdf5_has(struct snapshot_hdf5 *f, const char *name) {
  enum { LONGEST = 256 };
  char way[LONGEST];
  H5L_info_t link;
  size_t length = strlen(name);
  if (length >= LONGEST)
    return false;
  for (size_t end = 1; end <= length; end++) {
    if (name[end] != '/' && name[end] != 0)
      continue;
    memcpy(way, name, end);
    way[end] = 0;
    if (H5Lget_info(f->file, way, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)
      return false;
  }
  return length > 0;
}

/* Are the numbers stored in this file, without external or virtual storage? */
static bool plain(hid_t set) {
  hid_t type = H5Dget_type(set), layout = H5Dget_create_plist(set);
  H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  bool good = (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(type) <= 8 && layout >= 0 &&
              H5Pget_external_count(layout) == 0 && H5Pget_layout(layout) != H5D_VIRTUAL;
  if (layout >= 0)
    H5Pclose(layout);
  if (type >= 0)
    H5Tclose(type);
  return good;
}

/* Number of rows of a data set of plain numbers with the wanted shape; -1: another kind of data set, or too many
 * rows. */
static int64_t count_rows(hid_t set, size_t width) {
  hsize_t size[2] = {0, 0};
  if (!plain(set)) /* first: the shape of virtual storage can lie in other files */
    return -1;
  hid_t space = H5Dget_space(set);
  if (space < 0)
    return -1;
  int rank = width ? 2 : 1;
  bool good = H5Sget_simple_extent_ndims(space) == rank && H5Sget_simple_extent_dims(space, size, NULL) == rank &&
              size[0] <= SNAPSHOT_READ_LARGEST && (!width || size[1] == width);
  H5Sclose(space);
  return good ? (int64_t)size[0] : -1;
}

static void *read_rows(const struct snapshot_hdf5 *f, hid_t set, enum snapshot_read_kind kind, size_t count) {
  if ((double)count > f->bytes)
    return NULL;
  void *values = malloc((count ? count : 1) * 8);
  if (!values || count == 0)
    return values;
  hid_t type = kind == SNAPSHOT_READ_REAL ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0)
    return values;
  free(values);
  return NULL;
}

void *snapshot_hdf5_rows(struct snapshot_hdf5 *f, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows) {
  *rows = 0;
  if (!snapshot_hdf5_has(f, name))
    return NULL;
  hid_t set = H5Dopen2(f->file, name, H5P_DEFAULT);
  if (set < 0)
    return NULL;
  int64_t count = count_rows(set, width);
  void *values = count < 0 ? NULL : read_rows(f, set, kind, (size_t)count * (width ? width : 1));
  if (values)
    *rows = (size_t)count;
  H5Dclose(set);
  return values;
}

/* Opens the attribute if it is a scalar of this class and has at most `most` bytes; else -1. */
static hid_t open_attribute(struct snapshot_hdf5 *f, const char *at, const char *name, H5T_class_t class, size_t most) {
  if (!snapshot_hdf5_has(f, at))
    return -1;
  hid_t id = H5Aopen_by_name(f->file, at, name, H5P_DEFAULT, H5P_DEFAULT);
  if (id < 0)
    return -1;
  hid_t type = H5Aget_type(id), space = H5Aget_space(id);
  bool good = type >= 0 && space >= 0 && H5Tget_class(type) == class && H5Tget_size(type) <= most &&
              H5Sget_simple_extent_npoints(space) == 1 && (class != H5T_STRING || H5Tis_variable_str(type) == 0);
  if (space >= 0)
    H5Sclose(space);
  if (type >= 0)
    H5Tclose(type);
  if (good)
    return id;
  H5Aclose(id);
  return -1;
}

bool snapshot_hdf5_text(struct snapshot_hdf5 *f, const char *at, const char *name, char *text, size_t size) {
  enum { LONGEST = 65536 };
  text[0] = 0;
  hid_t id = open_attribute(f, at, name, H5T_STRING, LONGEST);
  if (id < 0)
    return false;
  hid_t type = H5Aget_type(id);
  size_t length = H5Tget_size(type);
  char *whole = calloc(length + 1, 1);
  bool good = whole && H5Aread(id, type, whole) >= 0;
  if (good) {
    size_t kept = strlen(whole) < size ? strlen(whole) : size - 1;
    memcpy(text, whole, kept);
    text[kept] = 0;
  }
  free(whole);
  H5Tclose(type);
  H5Aclose(id);
  return good;
}

static bool number(struct snapshot_hdf5 *f, const char *at, const char *name, H5T_class_t class, hid_t type,
                   void *value) {
  hid_t id = open_attribute(f, at, name, class, 8);
  bool good = id >= 0 && H5Aread(id, type, value) >= 0;
  if (id >= 0)
    H5Aclose(id);
  return good;
}

bool snapshot_hdf5_real(struct snapshot_hdf5 *f, const char *at, const char *name, double *value) {
  return number(f, at, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, value);
}

bool snapshot_hdf5_integer(struct snapshot_hdf5 *f, const char *at, const char *name, long long *value) {
  return number(f, at, name, H5T_INTEGER, H5T_NATIVE_LLONG, value);
}
