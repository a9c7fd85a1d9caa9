/* The fields file: self-describing HDF5, which VTK and ParaView open directly (VTKHDF 1.0, unstructured grid
 * of polygons; name it .hdf for older ParaViews). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/dem.h"
#include "engine/dem/run/run.h"
#include "engine/snapshot_file.h"
#include "schemas/memory.h"

enum { OUTLINE_CORNERS = 64, VTK_POLYGON = 7 };

struct grain_row {
  struct dem_grain its;
  double fragment;
};
#define COLUMN(name, member, width, ...) SNAPSHOT_FILE_COLUMN_NAMED(name, grain_row, member, width, __VA_ARGS__)
static const struct snapshot_file_column grain_columns[] = {
    COLUMN("position", its.x, 2, "m", "centre of mass"), /* x and y */
    COLUMN("angle", its.angle, 0, "rad", "rotation since the start, counter-clockwise"),
    COLUMN("velocity", its.vx, 2, "m s-1", "velocity of the centre of mass"),
    COLUMN("spin", its.spin, 0, "rad s-1", "angular velocity, counter-clockwise"),
    COLUMN("mass", its.mass, 0, "kg m-1", "mass per metre of thickness"),
    COLUMN("moment_of_inertia", its.moment_of_inertia, 0, "kg m", "about the centre of mass, per metre of thickness"),
    COLUMN("present", its.present, 0, "1", "0: the explosive grain, burnt"),
    COLUMN("fragment", fragment, 0, "1", "number of its fragment by descending mass; -1: none"),
};
#undef COLUMN

struct beam_row {
  uint32_t grains[2];
  double side, length;
  bool alive;
  double strain;
};
#define COLUMN(member, width, ...) SNAPSHOT_FILE_COLUMN(beam_row, member, width, __VA_ARGS__)
static const struct snapshot_file_column beam_columns[] = {
    COLUMN(grains, 2, "1", "indices of the two grains that it joins"),
    COLUMN(side, 0, "m", "length of their common side at the start: the beam's section"),
    COLUMN(length, 0, "m", "distance of the two centres of mass at the start"),
    COLUMN(alive, 0, "1", "1: it holds, 0: broken"),
    COLUMN(strain, 0, "1", "strain now"),
};
#undef COLUMN

#define COLUMN(member, width, ...) SNAPSHOT_FILE_COLUMN(dem_break, member, width, __VA_ARGS__)
static const struct snapshot_file_column break_columns[] = {
    COLUMN(time, 0, "s", "when the beam broke"),
    COLUMN(beam, 0, "1", "index into /beams"),
    COLUMN(strain, 0, "1", "its strain when it broke"),
    COLUMN(angle, 2, "rad", "rotations of its two ends when it broke"),
    COLUMN(bending, 0, "1", "1: the bending term of the breaking rule was the larger one"),
};
#undef COLUMN

#define COLUMN(member, ...) SNAPSHOT_FILE_COLUMN(dem_sample, member, 0, __VA_ARGS__)
static const struct snapshot_file_column curve_columns[] = {
    COLUMN(time, "s", "end of the steps averaged"),
    COLUMN(strain, "1", "axial strain, extension positive"),
    COLUMN(stress, "Pa", "force on the sides over the first width, extension positive"),
    COLUMN(lateral_strain, "1", "change of the width at half height over its first value"),
    COLUMN(broken, "1", "beams broken so far"),
};
#undef COLUMN

#define COLUMN(member, width, ...) SNAPSHOT_FILE_COLUMN(fragment, member, width, __VA_ARGS__)
static const struct snapshot_file_column fragment_columns[] = {
    COLUMN(mass, 0, "kg m-1", "mass per metre of thickness, descending"),
    COLUMN(position, 2, "m", "centre of mass"),
    COLUMN(velocity, 2, "m s-1", "velocity of the centre of mass"),
    SNAPSHOT_FILE_COLUMN_NAMED("spin", fragment, spin[2], 0, "rad s-1", "angular momentum over moment of inertia"),
    COLUMN(moment_of_inertia, 0, "kg m", "about the centre of mass"),
    COLUMN(kinetic_energy, 0, "J m-1", "translation, rotation and inner motion"),
    COLUMN(count, 0, "1", "grains in it"),
    COLUMN(first, 0, "1", "its lowest grain"),
};
#undef COLUMN

#define COLUMNS(group, count, rows, list)                                                                              \
  snapshot_file_columns(file, group, count, rows, sizeof *(rows), sizeof list / sizeof list[0], list)

static void add_grains(struct snapshot_file *file, const struct dem_run *run, const uint32_t *label) {
  size_t n = run->tessellation->cell_count;
  OWNED struct grain_row *row = malloc(n * sizeof *row);
  if (!row) {
    snapshot_file_fail(file);
    return;
  }
  for (uint32_t i = 0; i < n; i++)
    row[i] = (struct grain_row){dem_system_grain(run->system, i), label[i] == UINT32_MAX ? -1.0 : (double)label[i]};
  COLUMNS("grains", n, row, grain_columns);
}

static void add_beams(struct snapshot_file *file, const struct dem_run *run) {
  const struct dem_tessellation *t = run->tessellation;
  OWNED struct beam_row *row = malloc((t->pair_count + 1) * sizeof *row);
  if (!row) {
    snapshot_file_fail(file);
    return;
  }
  for (size_t i = 0; i < t->pair_count; i++) {
    struct dem_point a = t->centroid[t->pair[i][0]], b = t->centroid[t->pair[i][1]];
    row[i] = (struct beam_row){.grains = {t->pair[i][0], t->pair[i][1]},
                               .side = t->side[i],
                               .length = hypot(b.x - a.x, b.y - a.y),
                               .alive = dem_system_beam_alive(run->system, i),
                               .strain = dem_system_beam_strain(run->system, i)};
  }
  COLUMNS("beams", t->pair_count, row, beam_columns);
}

/* Outlines of the present grains, as VTK reads them: one cell per grain. */
struct cell_row {
  double mass, velocity[3], spin;
};
#define COLUMN(member, width, ...) SNAPSHOT_FILE_COLUMN(cell_row, member, width, __VA_ARGS__)
static const struct snapshot_file_column cell_columns[] = {
    COLUMN(mass, 0, "kg m-1", "mass per metre of thickness"),
    COLUMN(velocity, 3, "m s-1", "velocity of the centre of mass"),
    COLUMN(spin, 0, "rad s-1", "angular velocity"),
};
#undef COLUMN

static void outlines(struct snapshot_file *file, const struct dem_run *run, const uint32_t *label) {
  const struct dem_tessellation *t = run->tessellation;
  const size_t n = t->cell_count, capacity = t->first_vertex[n];
  OWNED double(*point)[3] = malloc(capacity * sizeof *point);
  OWNED struct cell_row *cell = malloc(n * sizeof *cell);
  OWNED int64_t *offset = calloc(n + 1, sizeof *offset);
  OWNED int64_t *connectivity = malloc(capacity * sizeof *connectivity);
  OWNED int64_t *fragment = malloc(n * sizeof *fragment);
  OWNED int64_t *grain = malloc(n * sizeof *grain);
  OWNED unsigned char *type = malloc(n);
  size_t points = 0, cells = 0;
  if (!point || !cell || !offset || !connectivity || !fragment || !grain || !type) {
    snapshot_file_fail(file);
    return;
  }
  for (uint32_t i = 0; i < n; i++) {
    const struct dem_grain g = dem_system_grain(run->system, i);
    struct dem_point corner[OUTLINE_CORNERS];
    if (!g.present)
      continue;
    const size_t corners = dem_system_outline(run->system, i, OUTLINE_CORNERS, corner);
    for (size_t k = 0; k < corners && k < OUTLINE_CORNERS && points < capacity; k++, points++) {
      memcpy(point[points], (const double[3]){corner[k].x, corner[k].y, 0}, sizeof point[points]);
      connectivity[points] = (int64_t)points;
    }
    type[cells] = VTK_POLYGON;
    cell[cells] = (struct cell_row){g.mass, {g.vx, g.vy, 0}, g.spin};
    grain[cells] = i;
    fragment[cells] = (int64_t)label[i];
    offset[++cells] = (int64_t)points;
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
  COLUMNS("VTKHDF/CellData", cells, cell, cell_columns);
}

static void content(struct snapshot_file *file, const struct dem_run *run, const uint32_t *label,
                    const struct fragment *fragments, size_t fragment_count) {
  const struct dem_break *log = NULL;
  size_t breaks = dem_system_breaks(run->system, &log);
  add_grains(file, run, label);
  add_beams(file, run);
  COLUMNS("breaks", breaks, log, break_columns);
  COLUMNS("fragments", fragment_count, fragments, fragment_columns);
  if (run->sample)
    COLUMNS("curve", run->state.frame.samples, run->sample, curve_columns);
  outlines(file, run, label);
}

status dem_snapshot_write(void *of, const char *path, struct error *error) {
  struct dem_run *run = of;
  struct outcome outcome;
  struct dem_results results;
  OWNED struct fragment *unlabelled = NULL; /* the report finds them without the labels */
  OWNED struct fragment *fragments = NULL;
  struct snapshot_file *file = NULL;
  size_t count = 0;
  OWNED uint32_t *label = malloc(run->tessellation->cell_count * sizeof *label);
  if (!label)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  TRY(dem_report_finish(run, &outcome, &results, &unlabelled, &count, error));
  TRY(dem_report_fragments(run, label, &fragments, &count, error));
  TRY(snapshot_file_open(&dem_engine, run->seed, &run->inputs, &outcome, &results, &file, error));
  content(file, run, label, fragments, count);
  const status code = snapshot_file_save(file, path, error);
  snapshot_file_close(file);
  return code;
}
