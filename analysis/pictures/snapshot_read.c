/* Reading fields files with HDF5. */
#include "analysis/pictures/snapshot_read.h"

#include <errno.h>
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_COMPRESSED = 1100 }; /* deflate's limit is 1032 : 1 */

struct snapshot_read {
  hid_t file;
  double bytes; /* the most that the file can hold if it is compressed */
  H5E_auto2_t printing;
  void *printing_to;
};

status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error) {
  hsize_t size = 0;
  *out = NULL;
  if (access(path, R_OK))
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "cannot read %s: %s", path,
                       strerror(errno));
  struct snapshot_read *f = calloc(1, sizeof *f);
  if (!f)
    return status_fail(error, STATUS_MEMORY, "no memory to read %s", path);
  H5dont_atexit(); /* its own exit handler prints when a damaged file could not be closed */
  H5Eget_auto2(H5E_DEFAULT, &f->printing, &f->printing_to);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* HDF5 prints nothing: the status tells the error */
  f->file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (f->file < 0 || H5Fget_filesize(f->file, &size) < 0) {
    snapshot_read_close(f);
    return snapshot_read_refuse(path, error);
  }
  f->bytes = (double)size * MOST_COMPRESSED;
  *out = f;
  return STATUS_OK;
}

void snapshot_read_close(struct snapshot_read *f) {
  if (!f)
    return;
  if (f->file >= 0)
    H5Fclose(f->file);
  H5Eset_auto2(H5E_DEFAULT, f->printing, f->printing_to);
  free(f);
}

status snapshot_read_refuse(const char *path, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s is no fields file of clast, or it is damaged; `clast simulate --fields` and "
                     "`clast replay --fields` write such files",
                     path);
}

bool snapshot_read_has(struct snapshot_read *f, const char *name) {
  return H5Lexists(f->file, name, H5P_DEFAULT) > 0;
}

/* Only numbers stored in this very file: no links to other files, no external or virtual storage. */
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

/* Rows of a data set that is plain numbers of the wanted shape; -1: it is not, or it has too many. */
static int64_t count_rows(hid_t set, size_t width) {
  hsize_t size[2] = {0, 0};
  hid_t space = H5Dget_space(set);
  if (space < 0)
    return -1;
  int rank = width ? 2 : 1;
  bool good = plain(set) && H5Sget_simple_extent_ndims(space) == rank &&
              H5Sget_simple_extent_dims(space, size, NULL) == rank && size[0] <= SNAPSHOT_READ_LARGEST &&
              (!width || size[1] == width);
  H5Sclose(space);
  return good ? (int64_t)size[0] : -1;
}

static void *read_rows(const struct snapshot_read *f, hid_t set, enum snapshot_read_kind kind, size_t count) {
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

void *snapshot_read_rows(struct snapshot_read *f, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows) {
  *rows = 0;
  H5L_info_t link;
  if (H5Lget_info(f->file, name, &link, H5P_DEFAULT) < 0 || link.type == H5L_TYPE_EXTERNAL)
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

/* The attribute when it is a scalar of this class and of at most `most` bytes; else -1. */
static hid_t open_attribute(struct snapshot_read *f, const char *at, const char *name, H5T_class_t class, size_t most) {
  if (H5Lexists(f->file, at, H5P_DEFAULT) <= 0)
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

bool snapshot_read_text(struct snapshot_read *f, const char *at, const char *name, char *text, size_t size) {
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

static bool number(struct snapshot_read *f, const char *at, const char *name, H5T_class_t class, hid_t type,
                   void *value) {
  hid_t id = open_attribute(f, at, name, class, 8);
  bool good = id >= 0 && H5Aread(id, type, value) >= 0;
  if (id >= 0)
    H5Aclose(id);
  return good;
}

bool snapshot_read_real(struct snapshot_read *f, const char *at, const char *name, double *value) {
  return number(f, at, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, value);
}

bool snapshot_read_integer(struct snapshot_read *f, const char *at, const char *name, long long *value) {
  return number(f, at, name, H5T_INTEGER, H5T_NATIVE_LLONG, value);
}
