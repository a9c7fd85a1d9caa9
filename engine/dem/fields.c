/* The big fields as one self-describing HDF5 file: `h5dump -A` alone explains it, and VTK or ParaView opens it as it is
 * (VTKHDF 1.0, unstructured grid of polygons; name it .hdf for older ParaViews).
 *
 * The file is made in memory and written whole: a full disk or a forbidden folder is one clean error. */
#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/dem.h"
#include "engine/dem/run.h"
#include "engine/whole_file.h"

enum { OUTLINE_CORNERS = 64, VTK_POLYGON = 7 };

struct writer {
  hid_t file;
  bool failed; /* any call that HDF5 refused: judged once, at the end */
};

static hid_t checked(struct writer *w, hid_t id) {
  w->failed |= id < 0;
  return id;
}

static void text_attribute(struct writer *w, hid_t at, const char *name, const char *text) {
  hid_t type = checked(w, H5Tcopy(H5T_C_S1));
  size_t length = strlen(text);
  w->failed |= H5Tset_size(type, length ? length : 1) < 0; /* fixed length ASCII: VTK asks for it */
  w->failed |= H5Tset_strpad(type, H5T_STR_NULLPAD) < 0;
  hid_t space = checked(w, H5Screate(H5S_SCALAR));
  hid_t attribute = checked(w, H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  w->failed |= H5Awrite(attribute, type, text) < 0;
  H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
}

static void integer_attribute(struct writer *w, hid_t at, const char *name, hsize_t count, const int64_t *values) {
  hid_t space = checked(w, count > 1 ? H5Screate_simple(1, &count, NULL) : H5Screate(H5S_SCALAR));
  hid_t attribute = checked(w, H5Acreate2(at, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT));
  w->failed |= H5Awrite(attribute, H5T_NATIVE_INT64, values) < 0;
  H5Aclose(attribute);
  H5Sclose(space);
}

/* rows x width values of one memory type; width 0: rows values. */
static void dataset(struct writer *w, hid_t at, const char *name, hid_t type, size_t rows, size_t width,
                    const void *values, const char *units, const char *long_name) {
  hsize_t size[2] = {rows, width};
  hid_t space = checked(w, H5Screate_simple(width ? 2 : 1, size, NULL));
  hid_t links = checked(w, H5Pcreate(H5P_LINK_CREATE));
  w->failed |= H5Pset_create_intermediate_group(links, 1) < 0;
  hid_t set = checked(w, H5Dcreate2(at, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  if (rows > 0)
    w->failed |= H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0;
  if (units)
    text_attribute(w, set, "units", units);
  if (long_name)
    text_attribute(w, set, "long_name", long_name);
  H5Dclose(set);
  H5Pclose(links);
  H5Sclose(space);
}

/* Every active row of a table as a scalar dataset under `group`, with its unit, range and documentation. */
static void table(struct writer *w, const char *group, const struct field_table *rows, const void *object) {
  for (size_t r = 0; r < rows->count; r++) {
    const struct field *row = &rows->rows[r];
    if (!field_is_active(rows, row, object))
      continue;
    struct field_value value;
    char name[300];
    field_get(row, object, &value);
    snprintf(name, sizeof name, "%s/%s", group, row->path);
    if (row->kind == FIELD_REAL)
      dataset(w, w->file, name, H5T_NATIVE_DOUBLE, 1, 0, &value.number, row->unit, row->doc);
    else if (row->kind == FIELD_INTEGER)
      dataset(w, w->file, name, H5T_NATIVE_INT64, 1, 0, &value.integer, row->unit, row->doc);
    else {
      const char *text = row->kind == FIELD_BOOLEAN ? (value.number != 0 ? "true" : "false") : value.text;
      hid_t type = checked(w, H5Tcopy(H5T_C_S1));
      w->failed |= H5Tset_size(type, strlen(text) + 1) < 0;
      dataset(w, w->file, name, type, 1, 0, text, NULL, row->doc);
      H5Tclose(type);
    }
  }
}

struct column {
  const char *name, *units, *long_name;
  size_t width; /* 0: one value a row */
};

/* One column after the other out of a reader of (row, column, component). */
typedef double (*reader)(const struct dem_run *run, const void *context, size_t row, size_t column, size_t component);

static void columns(struct writer *w, const char *group, const struct dem_run *run, const void *context, size_t rows,
                    size_t count, const struct column *column, reader read) {
  for (size_t c = 0; c < count; c++) {
    size_t width = column[c].width ? column[c].width : 1;
    double *values = malloc((rows ? rows : 1) * width * sizeof *values);
    char name[100];
    if (!values) {
      w->failed = true;
      return;
    }
    for (size_t r = 0; r < rows; r++)
      for (size_t k = 0; k < width; k++)
        values[r * width + k] = read(run, context, r, c, k);
    snprintf(name, sizeof name, "%s/%s", group, column[c].name);
    dataset(w, w->file, name, H5T_NATIVE_DOUBLE, rows, column[c].width, values, column[c].units, column[c].long_name);
    free(values);
  }
}

static const struct column grain_columns[] = {
    {"position", "m", "centre of mass", 2},
    {"angle", "rad", "rotation since the start, counter-clockwise", 0},
    {"velocity", "m s-1", "velocity of the centre of mass", 2},
    {"spin", "rad s-1", "angular velocity, counter-clockwise", 0},
    {"mass", "kg m-1", "mass per metre of thickness", 0},
    {"moment_of_inertia", "kg m", "about the centre of mass, per metre of thickness", 0},
    {"present", "1", "0: the explosive grain, burnt", 0},
    {"fragment", "1", "number of its fragment by descending mass; -1: none", 0},
};
static double grain_value(const struct dem_run *run, const void *context, size_t row, size_t column, size_t k) {
  const uint32_t *label = context;
  struct dem_grain g = dem_system_grain(run->system, (uint32_t)row);
  const double values[] = {k ? g.y : g.x, g.angle, k ? g.vy : g.vx, g.spin, g.mass, g.moment_of_inertia, g.present,
                           label[row] == UINT32_MAX ? -1.0 : (double)label[row]};
  return values[column];
}

static const struct column beam_columns[] = {
    {"grains", "1", "indices of the two grains that it joins", 2},
    {"side", "m", "length of their common side at the start: the beam's section", 0},
    {"length", "m", "distance of the two centres of mass at the start", 0},
    {"alive", "1", "1: it holds, 0: broken", 0},
    {"strain", "1", "strain now", 0},
};
static double beam_value(const struct dem_run *run, const void *context, size_t row, size_t column, size_t k) {
  (void)context;
  const struct dem_tessellation *t = run->tessellation;
  struct dem_point a = t->centroid[t->pair[row][0]], b = t->centroid[t->pair[row][1]];
  const double values[] = {t->pair[row][k], t->side[row], hypot(b.x - a.x, b.y - a.y),
                           dem_system_beam_alive(run->system, row), dem_system_beam_strain(run->system, row)};
  return values[column];
}

static const struct column break_columns[] = {
    {"time", "s", "when the beam broke", 0},
    {"beam", "1", "index into /beams", 0},
    {"strain", "1", "its strain when it broke", 0},
    {"angle", "rad", "rotations of its two ends when it broke", 2},
    {"bending", "1", "1: the bending term of the breaking rule was the larger one", 0},
};
static double break_value(const struct dem_run *run, const void *context, size_t row, size_t column, size_t k) {
  (void)run;
  const struct dem_break *b = (const struct dem_break *)context + row;
  const double values[] = {b->time, b->beam, b->strain, k ? b->angle_second : b->angle_first, b->bending};
  return values[column];
}

static const struct column curve_columns[] = {
    {"time", "s", "end of the steps averaged", 0},
    {"strain", "1", "axial strain, extension positive", 0},
    {"stress", "Pa", "force on the sides over the first width, extension positive", 0},
    {"lateral_strain", "1", "change of the width at half height over its first value", 0},
    {"broken", "1", "beams broken so far", 0},
};
static double curve_value(const struct dem_run *run, const void *context, size_t row, size_t column, size_t k) {
  (void)context;
  (void)k;
  const struct dem_sample *s = &run->sample[row];
  const double values[] = {s->time, s->strain, s->stress, s->lateral_strain, (double)s->broken};
  return values[column];
}

static const struct column fragment_columns[] = {
    {"mass", "kg m-1", "mass per metre of thickness, descending", 0},
    {"position", "m", "centre of mass", 2},
    {"velocity", "m s-1", "velocity of the centre of mass", 2},
    {"spin", "rad s-1", "angular momentum over moment of inertia", 0},
    {"moment_of_inertia", "kg m", "about the centre of mass", 0},
    {"kinetic_energy", "J m-1", "translation, rotation and inner motion", 0},
    {"count", "1", "grains in it", 0},
    {"first", "1", "its lowest grain", 0},
};
static double fragment_value(const struct dem_run *run, const void *context, size_t row, size_t column, size_t k) {
  (void)run;
  const struct fragment *f = (const struct fragment *)context + row;
  const double values[] = {f->mass, f->position[k], f->velocity[k], f->spin[2], f->moment_of_inertia, f->kinetic_energy,
                           f->count, f->first};
  return values[column];
}

/* Outlines of the grains that are left, as VTK reads them. */
static void outlines(struct writer *w, const struct dem_run *run, const uint32_t *label) {
  size_t n = run->tessellation->cell_count, points = 0, cells = 0;
  size_t capacity = run->tessellation->first_vertex[n];
  double *point = malloc(capacity * 3 * sizeof *point), *mass = malloc(n * sizeof *mass);
  double *velocity = malloc(n * 3 * sizeof *velocity), *spin = malloc(n * sizeof *spin);
  int64_t *offset = malloc((n + 1) * sizeof *offset), *connectivity = malloc(capacity * sizeof *connectivity);
  int64_t *fragment = malloc(n * sizeof *fragment), *grain = malloc(n * sizeof *grain);
  unsigned char *type = malloc(n);
  hid_t group = -1;
  if (!point || !mass || !velocity || !spin || !offset || !connectivity || !fragment || !grain || !type) {
    w->failed = true;
    goto cleanup;
  }
  offset[0] = 0;
  for (uint32_t i = 0; i < n; i++) {
    struct dem_grain g = dem_system_grain(run->system, i);
    struct dem_point corner[OUTLINE_CORNERS];
    if (!g.present)
      continue;
    size_t corners = dem_system_outline(run->system, i, OUTLINE_CORNERS, corner);
    for (size_t k = 0; k < corners && k < OUTLINE_CORNERS && points < capacity; k++) {
      point[3 * points] = corner[k].x;
      point[3 * points + 1] = corner[k].y;
      point[3 * points + 2] = 0;
      connectivity[points] = (int64_t)points;
      points++;
    }
    offset[cells + 1] = (int64_t)points;
    type[cells] = VTK_POLYGON;
    mass[cells] = g.mass;
    spin[cells] = g.spin;
    velocity[3 * cells] = g.vx;
    velocity[3 * cells + 1] = g.vy;
    velocity[3 * cells + 2] = 0;
    grain[cells] = i;
    fragment[cells++] = (int64_t)label[i];
  }
  group = checked(w, H5Gcreate2(w->file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  const int64_t version[2] = {1, 0}, counts[3] = {(int64_t)points, (int64_t)cells, (int64_t)points};
  integer_attribute(w, group, "Version", 2, version);
  text_attribute(w, group, "Type", "UnstructuredGrid");
  dataset(w, group, "NumberOfPoints", H5T_NATIVE_INT64, 1, 0, &counts[0], NULL, NULL);
  dataset(w, group, "NumberOfCells", H5T_NATIVE_INT64, 1, 0, &counts[1], NULL, NULL);
  dataset(w, group, "NumberOfConnectivityIds", H5T_NATIVE_INT64, 1, 0, &counts[2], NULL, NULL);
  dataset(w, group, "Points", H5T_NATIVE_DOUBLE, points, 3, point, "m", "corners of the grains' outlines");
  dataset(w, group, "Connectivity", H5T_NATIVE_INT64, points, 0, connectivity, NULL, NULL);
  dataset(w, group, "Offsets", H5T_NATIVE_INT64, cells + 1, 0, offset, NULL, NULL);
  dataset(w, group, "Types", H5T_NATIVE_UCHAR, cells, 0, type, NULL, NULL);
  dataset(w, group, "CellData/fragment", H5T_NATIVE_INT64, cells, 0, fragment, "1", "number of its fragment by descending mass");
  dataset(w, group, "CellData/grain", H5T_NATIVE_INT64, cells, 0, grain, "1", "index into /grains");
  dataset(w, group, "CellData/mass", H5T_NATIVE_DOUBLE, cells, 0, mass, "kg m-1", "mass per metre of thickness");
  dataset(w, group, "CellData/velocity", H5T_NATIVE_DOUBLE, cells, 3, velocity, "m s-1", "velocity of the centre of mass");
  dataset(w, group, "CellData/spin", H5T_NATIVE_DOUBLE, cells, 0, spin, "rad s-1", "angular velocity");
cleanup:
  if (group >= 0)
    H5Gclose(group);
  free(point);
  free(mass);
  free(velocity);
  free(spin);
  free(offset);
  free(connectivity);
  free(fragment);
  free(grain);
  free(type);
}

static void head(struct writer *w, const struct dem_run *run) {
  hid_t group = checked(w, H5Gcreate2(w->file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  char *scene = field_json(&dem_inputs, &run->inputs);
  const int64_t format = 1, results_version = dem_engine.results_version, seed = (int64_t)run->seed;
  integer_attribute(w, group, "format", 1, &format);
  text_attribute(w, group, "engine", dem_engine.name);
  text_attribute(w, group, "doc", dem_engine.doc);
  integer_attribute(w, group, "results_version", 1, &results_version);
  integer_attribute(w, group, "seed", 1, &seed);
  if (scene)
    text_attribute(w, group, "scene", scene);
  w->failed |= !scene;
  free(scene);
  H5Gclose(group);
}

static void content(struct writer *w, const struct dem_run *run, const uint32_t *label, const struct outcome *outcome,
                    const struct dem_results *results, const struct fragment *fragments, size_t fragment_count) {
  const struct dem_tessellation *t = run->tessellation;
  const struct dem_break *log = NULL;
  size_t breaks = dem_system_breaks(run->system, &log);
  head(w, run);
  table(w, "inputs", &dem_inputs, &run->inputs);
  table(w, "outcome", &outcome_table, outcome);
  table(w, "results", &dem_results, results);
#define COLUMNS(group, context, rows, list, read)                                                                      \
  columns(w, group, run, context, rows, sizeof list / sizeof list[0], list, read)
  COLUMNS("grains", label, t->cell_count, grain_columns, grain_value);
  COLUMNS("beams", NULL, t->pair_count, beam_columns, beam_value);
  COLUMNS("breaks", log, breaks, break_columns, break_value);
  COLUMNS("fragments", fragments, fragment_count, fragment_columns, fragment_value);
  if (run->sample)
    COLUMNS("curve", NULL, run->state.samples, curve_columns, curve_value);
#undef COLUMNS
  outlines(w, run, label);
}

status dem_fields_write(struct dem_run *run, const char *path, struct error *error) {
  struct outcome outcome;
  struct dem_results results;
  struct fragment *fragments = NULL;
  size_t count = 0;
  struct writer w = {.file = -1};
  void *image = NULL;
  ssize_t size = 0;
  hid_t access = -1;
  H5E_auto2_t printing = NULL;
  void *printing_to = NULL;
  status code = STATUS_OK;
  uint32_t *label = malloc(run->tessellation->cell_count * sizeof *label);
  if (!label)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  H5Eget_auto2(H5E_DEFAULT, &printing, &printing_to);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  if ((code = dem_report_finish(run, &outcome, &results, &fragments, &count, error)))
    goto cleanup;
  free(fragments); /* once more, for the labels */
  if ((code = dem_report_fragments(run, label, &fragments, &count, error)))
    goto cleanup;
  access = checked(&w, H5Pcreate(H5P_FILE_ACCESS));
  w.failed |= H5Pset_fapl_core(access, 1 << 20, 0) < 0; /* in memory, never written by HDF5 itself */
  w.file = checked(&w, H5Fcreate("fields", H5F_ACC_TRUNC, H5P_DEFAULT, access));
  if (!w.failed)
    content(&w, run, label, &outcome, &results, fragments, count);
  w.failed |= w.file >= 0 && H5Fflush(w.file, H5F_SCOPE_GLOBAL) < 0;
  size = w.failed ? -1 : H5Fget_file_image(w.file, NULL, 0);
  image = size > 0 ? malloc((size_t)size) : NULL;
  if (!image || H5Fget_file_image(w.file, image, (size_t)size) != size) {
    code = status_fail(error, w.failed ? STATUS_INTERNAL : STATUS_MEMORY, "cannot make the fields for '%s'", path);
    goto cleanup;
  }
  code = whole_file_write(path, "fields file", image, (size_t)size, error);
cleanup:
  if (w.file >= 0)
    H5Fclose(w.file);
  if (access >= 0)
    H5Pclose(access);
  H5Eset_auto2(H5E_DEFAULT, printing, printing_to);
  free(image);
  free(fragments);
  free(label);
  return code;
}
