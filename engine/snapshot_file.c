/* Fields files with HDF5. */
#include "engine/snapshot_file.h"

#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/file.h"
#include "schemas/memory.h"

enum { COMPRESSED_FROM = 4096, CHUNK = 16384 }; /* rows */

struct snapshot_file {
  hid_t file, access;
  bool failed, memory; /* an HDF5 call failed; memory ran out. save() reports both */
  H5E_auto2_t printing;
  void *printing_to;
};

static hid_t checked(struct snapshot_file *f, hid_t id) {
  f->failed |= id < 0;
  return id;
}

void snapshot_file_fail(struct snapshot_file *f) {
  f->failed = f->memory = true;
}

static void make_group(struct snapshot_file *f, const char *group) {
  hid_t id = checked(f, H5Gcreate2(f->file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (id >= 0)
    H5Gclose(id);
}

static void attribute(struct snapshot_file *f, const char *at, const char *name, hid_t stored, hid_t given,
                      size_t count, const void *values) {
  hsize_t size = count;
  hid_t object = checked(f, H5Oopen(f->file, at, H5P_DEFAULT));
  hid_t space = checked(f, count > 1 ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR));
  hid_t id = checked(f, H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT));
  f->failed |= H5Awrite(id, given, values) < 0;
  H5Aclose(id);
  H5Sclose(space);
  H5Oclose(object);
}

/* VTK needs ASCII of fixed length. */
static void text_attribute(struct snapshot_file *f, const char *at, const char *name, const char *text) {
  hid_t type = checked(f, H5Tcopy(H5T_C_S1));
  size_t length = strlen(text);
  f->failed |= H5Tset_size(type, length ? length : 1) < 0;
  f->failed |= H5Tset_strpad(type, H5T_STR_NULLPAD) < 0;
  attribute(f, at, name, type, type, 1, text);
  H5Tclose(type);
}

static void integer_attribute(struct snapshot_file *f, const char *at, const char *name, size_t count,
                              const int64_t *values) {
  attribute(f, at, name, H5T_STD_I64LE, H5T_NATIVE_INT64, count, values);
}

static void data(struct snapshot_file *f, const char *name, hid_t type, bool compress, size_t rows, size_t width,
                 const void *values, const char *units, const char *long_name) {
  hsize_t size[2] = {rows, width}, chunk[2] = {CHUNK, width};
  if (rows < chunk[0])
    chunk[0] = rows;
  hid_t space = checked(f, H5Screate_simple(width ? 2 : 1, size, NULL));
  hid_t links = checked(f, H5Pcreate(H5P_LINK_CREATE)), layout = checked(f, H5Pcreate(H5P_DATASET_CREATE));
  f->failed |= H5Pset_create_intermediate_group(links, 1) < 0;
  f->failed |= H5Pset_obj_track_times(layout, 0) < 0; /* without times, the same run always gives the same file */
  if (compress && rows >= COMPRESSED_FROM)
    f->failed |= H5Pset_chunk(layout, width ? 2 : 1, chunk) < 0 || H5Pset_shuffle(layout) < 0 ||
                 H5Pset_deflate(layout, 1) < 0;
  hid_t set = checked(f, H5Dcreate2(f->file, name, type, space, links, layout, H5P_DEFAULT));
  if (rows > 0)
    f->failed |= H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0;
  H5Dclose(set);
  H5Pclose(layout);
  H5Pclose(links);
  H5Sclose(space);
  if (units)
    text_attribute(f, name, "units", units);
  if (long_name)
    text_attribute(f, name, "long_name", long_name);
}

void snapshot_file_data(struct snapshot_file *f, const char *name, enum snapshot_file_kind kind, size_t rows,
                        size_t width, const void *values, const char *units, const char *long_name) {
  const hid_t types[] = {[SNAPSHOT_FILE_REAL] = H5T_NATIVE_DOUBLE,
                         [SNAPSHOT_FILE_INTEGER] = H5T_NATIVE_INT64,
                         [SNAPSHOT_FILE_BYTE] = H5T_NATIVE_UCHAR};
  data(f, name, types[kind], kind != SNAPSHOT_FILE_REAL, rows, width, values, units, long_name);
}

/* Every active row of a field table as a scalar under `group`, with its unit and documentation. */
static void add_table(struct snapshot_file *f, const char *group, const struct field_table *table, const void *object) {
  for (size_t r = 0; r < table->count; r++) {
    const struct field *row = &table->rows[r];
    if (!field_is_active(table, row, object))
      continue;
    struct field_value value;
    char name[300];
    field_get(row, object, &value);
    snprintf(name, sizeof name, "%s/%s", group, row->path);
    if (row->kind == FIELD_REAL)
      snapshot_file_data(f, name, SNAPSHOT_FILE_REAL, 1, 0, &value.number, row->unit, row->doc);
    else if (row->kind == FIELD_INTEGER)
      snapshot_file_data(f, name, SNAPSHOT_FILE_INTEGER, 1, 0, &value.integer, row->unit, row->doc);
    else {
      const char *text = row->kind == FIELD_BOOLEAN ? (value.number != 0 ? "true" : "false") : value.text;
      hid_t type = checked(f, H5Tcopy(H5T_C_S1));
      f->failed |= H5Tset_size(type, strlen(text) + 1) < 0;
      data(f, name, type, false, 1, 0, text, NULL, row->doc);
      H5Tclose(type);
    }
  }
}

/* Number k of a column's member. */
static double number_of(const struct snapshot_file_column *column, const char *object, size_t k) {
  const char *member = object + column->offset;
  switch (column->member) {
  case SNAPSHOT_FILE_DOUBLE: return ((const double *)member)[k];
  case SNAPSHOT_FILE_UINT32: return ((const uint32_t *)member)[k];
  case SNAPSHOT_FILE_UINT64: return (double)((const uint64_t *)member)[k];
  case SNAPSHOT_FILE_BOOL: return ((const bool *)member)[k];
  }
  return 0;
}

void snapshot_file_columns(struct snapshot_file *f, const char *group, size_t rows, const void *structs, size_t size,
                           size_t count, const struct snapshot_file_column *column) {
  for (size_t c = 0; c < count; c++) {
    size_t width = column[c].width ? column[c].width : 1;
    OWNED double *values = malloc((rows ? rows : 1) * width * sizeof *values);
    char name[100];
    if (!values) {
      snapshot_file_fail(f);
      return;
    }
    for (size_t r = 0; r < rows; r++)
      for (size_t k = 0; k < width; k++)
        values[r * width + k] = number_of(&column[c], (const char *)structs + r * size, k);
    snprintf(name, sizeof name, "%s/%s", group, column[c].name);
    snapshot_file_data(f, name, SNAPSHOT_FILE_REAL, rows, column[c].width, values, column[c].units,
                       column[c].long_name);
  }
}

void snapshot_file_vtk(struct snapshot_file *f, size_t points, size_t cells, size_t connectivity) {
  const int64_t version[2] = {1, 0}, counts[3] = {(int64_t)points, (int64_t)cells, (int64_t)connectivity};
  make_group(f, "VTKHDF");
  integer_attribute(f, "VTKHDF", "Version", 2, version);
  text_attribute(f, "VTKHDF", "Type", "UnstructuredGrid");
  snapshot_file_data(f, "VTKHDF/NumberOfPoints", SNAPSHOT_FILE_INTEGER, 1, 0, &counts[0], NULL, NULL);
  snapshot_file_data(f, "VTKHDF/NumberOfCells", SNAPSHOT_FILE_INTEGER, 1, 0, &counts[1], NULL, NULL);
  snapshot_file_data(f, "VTKHDF/NumberOfConnectivityIds", SNAPSHOT_FILE_INTEGER, 1, 0, &counts[2], NULL, NULL);
}

static void head(struct snapshot_file *f, const struct engine_kind *engine, uint64_t seed, const void *inputs,
                 double time) {
  const int64_t format = 1, version = engine->results_version, number = (int64_t)seed;
  OWNED char *scene = field_json(engine->inputs, inputs);
  make_group(f, "run");
  integer_attribute(f, "run", "format", 1, &format);
  text_attribute(f, "run", "engine", engine->name);
  text_attribute(f, "run", "doc", engine->doc);
  integer_attribute(f, "run", "results_version", 1, &version);
  integer_attribute(f, "run", "seed", 1, &number);
  if (scene)
    text_attribute(f, "run", "scene", scene);
  else
    snapshot_file_fail(f);
  attribute(f, "run", "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &time);
}

static struct snapshot_file *begin(void) {
  struct snapshot_file *f = memory_small(1, sizeof *f);
  H5dont_atexit(); /* HDF5's exit handler prints when a damaged file could not be closed */
  H5Eget_auto2(H5E_DEFAULT, &f->printing, &f->printing_to);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  f->file = -1;
  f->access = checked(f, H5Pcreate(H5P_FILE_ACCESS));
  f->failed |= H5Pset_fapl_core(f->access, 1 << 20, 0) < 0; /* in memory, never written by HDF5 itself */
  f->file = checked(f, H5Fcreate("fields", H5F_ACC_TRUNC, H5P_DEFAULT, f->access));
  return f;
}

status snapshot_file_open(const struct engine_kind *engine, uint64_t seed, const void *inputs,
                          const struct outcome *outcome, const void *results, struct snapshot_file **out,
                          struct error *error) {
  struct snapshot_file *f = begin();
  if (!f->failed)
    head(f, engine, seed, inputs, outcome->time);
  *out = f->failed ? NULL : f;
  if (f->failed) {
    const bool memory = f->memory;
    snapshot_file_close(f);
    return status_fail(error, memory ? STATUS_MEMORY : STATUS_INTERNAL, "cannot begin a fields file%s",
                       memory ? ": no memory" : "");
  }
  add_table(f, "inputs", engine->inputs, inputs);
  add_table(f, "outcome", &outcome_table, outcome);
  add_table(f, "results", engine->results, results);
  return STATUS_OK;
}

status snapshot_file_save(struct snapshot_file *f, const char *path, struct error *error) {
  f->failed |= H5Fflush(f->file, H5F_SCOPE_GLOBAL) < 0;
  ssize_t size = f->failed ? -1 : H5Fget_file_image(f->file, NULL, 0);
  OWNED void *image = size > 0 ? malloc((size_t)size) : NULL;
  if (!image || H5Fget_file_image(f->file, image, (size_t)size) != size)
    return status_fail(error, f->failed && !f->memory ? STATUS_INTERNAL : STATUS_MEMORY,
                       "cannot make the fields for '%s'%s", path, f->failed && !f->memory ? "" : ": no memory");
  return file_write(path, "fields file", image, (size_t)size, error);
}

void snapshot_file_close(struct snapshot_file *f) {
  if (!f)
    return;
  if (f->file >= 0)
    H5Fclose(f->file);
  if (f->access >= 0)
    H5Pclose(f->access);
  H5Eset_auto2(H5E_DEFAULT, f->printing, f->printing_to);
  free(f);
}
