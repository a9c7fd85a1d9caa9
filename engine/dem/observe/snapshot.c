/* The big fields as one self-describing HDF5 file, which VTK or ParaView opens as it is (VTKHDF 1.0, unstructured grid
 * of polygons; name it .hdf for older ParaViews). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/dem.h"
#include "engine/dem/run/run.h"
#include "engine/snapshot_file.h"

enum { OUTLINE_CORNERS = 64, VTK_POLYGON = 7 };

/* What a column's reader looks at. */
struct view {
  const struct dem_run *run;
  const void *rows;
};

static const struct snapshot_file_column grain_columns[] = {
    {"position", "m", "centre of mass", 2},
    {"angle", "rad", "rotation since the start, counter-clockwise", 0},
    {"velocity", "m s-1", "velocity of the centre of mass", 2},
    {"spin", "rad s-1", "angular velocity, counter-clockwise", 0},
    {"mass", "kg m-1", "mass per metre of thickness", 0},
    {"moment_of_inertia", "kg m", "about the centre of mass, per metre of thickness", 0},
    {"present", "1", "0: the explosive grain, burnt", 0},
    {"fragment", "1", "number of its fragment by descending mass; -1: none", 0},
};
static double grain_value(const void *context, size_t row, size_t column, size_t k) {
  const struct view *view = context;
  const uint32_t *label = view->rows;
  struct dem_grain g = dem_system_grain(view->run->system, (uint32_t)row);
  const double values[] = {k ? g.y : g.x,   g.angle,
                           k ? g.vy : g.vx, g.spin,
                           g.mass,          g.moment_of_inertia,
                           g.present,       label[row] == UINT32_MAX ? -1.0 : (double)label[row]};
  return values[column];
}

static const struct snapshot_file_column beam_columns[] = {
    {"grains", "1", "indices of the two grains that it joins", 2},
    {"side", "m", "length of their common side at the start: the beam's section", 0},
    {"length", "m", "distance of the two centres of mass at the start", 0},
    {"alive", "1", "1: it holds, 0: broken", 0},
    {"strain", "1", "strain now", 0},
};
static double beam_value(const void *context, size_t row, size_t column, size_t k) {
  const struct dem_run *run = ((const struct view *)context)->run;
  const struct dem_tessellation *t = run->tessellation;
  struct dem_point a = t->centroid[t->pair[row][0]], b = t->centroid[t->pair[row][1]];
  const double values[] = {t->pair[row][k], t->side[row], hypot(b.x - a.x, b.y - a.y),
                           dem_system_beam_alive(run->system, row), dem_system_beam_strain(run->system, row)};
  return values[column];
}

static const struct snapshot_file_column break_columns[] = {
    {"time", "s", "when the beam broke", 0},
    {"beam", "1", "index into /beams", 0},
    {"strain", "1", "its strain when it broke", 0},
    {"angle", "rad", "rotations of its two ends when it broke", 2},
    {"bending", "1", "1: the bending term of the breaking rule was the larger one", 0},
};
static double break_value(const void *context, size_t row, size_t column, size_t k) {
  const struct dem_break *b = (const struct dem_break *)((const struct view *)context)->rows + row;
  const double values[] = {b->time, b->beam, b->strain, k ? b->angle_second : b->angle_first, b->bending};
  return values[column];
}

static const struct snapshot_file_column curve_columns[] = {
    {"time", "s", "end of the steps averaged", 0},
    {"strain", "1", "axial strain, extension positive", 0},
    {"stress", "Pa", "force on the sides over the first width, extension positive", 0},
    {"lateral_strain", "1", "change of the width at half height over its first value", 0},
    {"broken", "1", "beams broken so far", 0},
};
static double curve_value(const void *context, size_t row, size_t column, size_t k) {
  (void)k;
  const struct dem_sample *s = &((const struct view *)context)->run->sample[row];
  const double values[] = {s->time, s->strain, s->stress, s->lateral_strain, (double)s->broken};
  return values[column];
}

static const struct snapshot_file_column fragment_columns[] = {
    {"mass", "kg m-1", "mass per metre of thickness, descending", 0},
    {"position", "m", "centre of mass", 2},
    {"velocity", "m s-1", "velocity of the centre of mass", 2},
    {"spin", "rad s-1", "angular momentum over moment of inertia", 0},
    {"moment_of_inertia", "kg m", "about the centre of mass", 0},
    {"kinetic_energy", "J m-1", "translation, rotation and inner motion", 0},
    {"count", "1", "grains in it", 0},
    {"first", "1", "its lowest grain", 0},
};
static double fragment_value(const void *context, size_t row, size_t column, size_t k) {
  const struct fragment *f = (const struct fragment *)((const struct view *)context)->rows + row;
  const double values[] = {f->mass,           f->position[k], f->velocity[k], f->spin[2], f->moment_of_inertia,
                           f->kinetic_energy, f->count,       f->first};
  return values[column];
}

/* Outlines of the grains that are left, as VTK reads them. */
static void outlines(struct snapshot_file *file, const struct dem_run *run, const uint32_t *label) {
  size_t n = run->tessellation->cell_count, points = 0, cells = 0;
  size_t capacity = run->tessellation->first_vertex[n];
  double *point = malloc(capacity * 3 * sizeof *point), *mass = malloc(n * sizeof *mass);
  double *velocity = malloc(n * 3 * sizeof *velocity), *spin = malloc(n * sizeof *spin);
  int64_t *offset = malloc((n + 1) * sizeof *offset), *connectivity = malloc(capacity * sizeof *connectivity);
  int64_t *fragment = malloc(n * sizeof *fragment), *grain = malloc(n * sizeof *grain);
  unsigned char *type = malloc(n);
  if (!point || !mass || !velocity || !spin || !offset || !connectivity || !fragment || !grain || !type) {
    snapshot_file_fail(file);
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
  snapshot_file_vtk(file, points, cells, points);
  snapshot_file_data(file, "VTKHDF/Points", SNAPSHOT_FILE_REAL, points, 3, point, "m",
                     "corners of the grains' outlines");
  snapshot_file_data(file, "VTKHDF/Connectivity", SNAPSHOT_FILE_INTEGER, points, 0, connectivity, NULL, NULL);
  snapshot_file_data(file, "VTKHDF/Offsets", SNAPSHOT_FILE_INTEGER, cells + 1, 0, offset, NULL, NULL);
  snapshot_file_data(file, "VTKHDF/Types", SNAPSHOT_FILE_BYTE, cells, 0, type, NULL, NULL);
  snapshot_file_data(file, "VTKHDF/CellData/fragment", SNAPSHOT_FILE_INTEGER, cells, 0, fragment, "1",
                     "number of its fragment by descending mass");
  snapshot_file_data(file, "VTKHDF/CellData/grain", SNAPSHOT_FILE_INTEGER, cells, 0, grain, "1", "index into /grains");
  snapshot_file_data(file, "VTKHDF/CellData/mass", SNAPSHOT_FILE_REAL, cells, 0, mass, "kg m-1",
                     "mass per metre of thickness");
  snapshot_file_data(file, "VTKHDF/CellData/velocity", SNAPSHOT_FILE_REAL, cells, 3, velocity, "m s-1",
                     "velocity of the centre of mass");
  snapshot_file_data(file, "VTKHDF/CellData/spin", SNAPSHOT_FILE_REAL, cells, 0, spin, "rad s-1", "angular velocity");
cleanup:
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

static void content(struct snapshot_file *file, const struct dem_run *run, const uint32_t *label,
                    const struct outcome *outcome, const struct dem_results *results, const struct fragment *fragments,
                    size_t fragment_count) {
  const struct dem_tessellation *t = run->tessellation;
  const struct dem_break *log = NULL;
  size_t breaks = dem_system_breaks(run->system, &log);
  snapshot_file_table(file, "inputs", &dem_inputs, &run->inputs);
  snapshot_file_table(file, "outcome", &outcome_table, outcome);
  snapshot_file_table(file, "results", &dem_results, results);
#define COLUMNS(group, context, count, list, read)                                                                     \
  snapshot_file_columns(file, group, count, sizeof list / sizeof list[0], list, read, &(struct view){run, context})
  COLUMNS("grains", label, t->cell_count, grain_columns, grain_value);
  COLUMNS("beams", NULL, t->pair_count, beam_columns, beam_value);
  COLUMNS("breaks", log, breaks, break_columns, break_value);
  COLUMNS("fragments", fragments, fragment_count, fragment_columns, fragment_value);
  if (run->sample)
    COLUMNS("curve", NULL, run->state.samples, curve_columns, curve_value);
#undef COLUMNS
  outlines(file, run, label);
}

status dem_snapshot_write(struct dem_run *run, const char *path, struct error *error) {
  struct outcome outcome;
  struct dem_results results;
  struct fragment *fragments = NULL;
  struct snapshot_file *file = NULL;
  size_t count = 0;
  status code = STATUS_OK;
  uint32_t *label = malloc(run->tessellation->cell_count * sizeof *label);
  if (!label)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  if ((code = dem_report_finish(run, &outcome, &results, &fragments, &count, error)))
    goto cleanup;
  free(fragments); /* once more, for the labels */
  if ((code = dem_report_fragments(run, label, &fragments, &count, error)) ||
      (code = snapshot_file_open(dem_engine.name, dem_engine.doc, dem_engine.results_version, run->seed, &dem_inputs,
                                 &run->inputs, &file, error)))
    goto cleanup;
  snapshot_file_real(file, "run", "time", outcome.time);
  content(file, run, label, &outcome, &results, fragments, count);
  code = snapshot_file_save(file, path, error);
cleanup:
  snapshot_file_close(file);
  free(fragments);
  free(label);
  return code;
}
