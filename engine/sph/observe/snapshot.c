/* The fields file of a run: one self-describing HDF5 file, which VTK and ParaView open directly. It has particles,
 * fragments, results, the curve that a protocol records, and the profile of an impact or a plate. */
#include <stdlib.h>

#include "engine/sph/run/run.h"
#include "engine/sph/sph.h"
#include "schemas/memory.h"

enum { VTK_VERTEX = 1, MOST_LAYERS = 4096 };

#define AT(name) "VTKHDF/PointData/" name
#define COLUMNS(file, group, count, rows, list)                                                                        \
  snapshot_file_columns(file, group, count, rows, sizeof *(rows), sizeof list / sizeof list[0], list)

#define COLUMN(member, width, ...) SNAPSHOT_FILE_COLUMN(fragment, member, width, __VA_ARGS__)
static const struct snapshot_file_column fragment_columns[] = {
    COLUMN(mass, 0, "kg", "mass, descending; every single particle is a fragment of its own"),
    COLUMN(position, 3, "m", "centre of mass"),
    COLUMN(velocity, 3, "m s-1", "velocity of the centre of mass"),
    COLUMN(spin, 3, "rad s-1",
           "angular velocity: inverse inertia tensor times angular momentum about the centre of mass; nan below 100 "
           "particles"),
    COLUMN(length, 3, "m",
           "axes of the solid ellipsoid with its moments of inertia, longest first; nan below 60 particles"),
    COLUMN(moment_of_inertia, 0, "kg m2", "a third of the inertia tensor's trace, about the centre of mass"),
    COLUMN(kinetic_energy, 0, "J", "translation, rotation and internal motion"),
    COLUMN(count, 0, "1", "number of its particles"),
    COLUMN(first, 0, "1", "its particle of the lowest number"),
};
#undef COLUMN

#define COLUMN(member, ...) SNAPSHOT_FILE_COLUMN(sph_sample, member, 0, __VA_ARGS__)
static const struct snapshot_file_column curve_columns[] = {
    COLUMN(time, "s", "simulated time"),
    COLUMN(strain, "1", "stretch: strain rate times time"),
    COLUMN(stress, "Pa", "stretch: mean axial stress between the grips"),
    COLUMN(mode, "1", "vibration: amplitude of the first mode over its amplitude at the start"),
    COLUMN(damage, "1", "mean damage D of bodies with flaws"),
    COLUMN(front, "m", "piston: place of the shock"),
    COLUMN(precursor, "m", "piston: place of the elastic precursor"),
};
#undef COLUMN

/* Along the axis of an impact, from the surface down, or along a plate: how matter and damage change with depth. */
#define COLUMN(member, ...) SNAPSHOT_FILE_COLUMN(sph_crater_layer, member, 0, __VA_ARGS__)
static const struct snapshot_file_column axis_columns[] = {
    COLUMN(depth, "m", "depth of the layer below the surface at the start"),
    COLUMN(damage, "1",
           "mean damage D of the retained particles within 1.5 spacings of the axis; of a plate, of the layer"),
    COLUMN(pressure, "Pa",
           "mean pressure of these particles, without broken ones under tension; nan: there are no others"),
    COLUMN(velocity, "m/s", "mean velocity of these particles: outwards; in a plate along x"),
#undef COLUMN
#define PROFILE_COLUMN(member, of_impact, of_plate, absent, ...)                                                       \
  SNAPSHOT_FILE_COLUMN(sph_crater_layer, member, 0, __VA_ARGS__),
#include "engine/sph/modules/declarations.h"
};

static void three(struct snapshot_file *file, const char *name, size_t n, const double *x, const double *y,
                  const double *z, double *values, const char *units, const char *long_name) {
  for (size_t i = 0; i < n; i++) {
    values[3 * i] = x[i];
    values[3 * i + 1] = y[i];
    values[3 * i + 2] = z[i];
  }
  snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 3, values, units, long_name);
}

/* VTK's tensors have nine components, row by row. */
static void tensor(struct snapshot_file *file, const char *name, size_t n, double *const component[6], double *values,
                   const char *units, const char *long_name) {
  static const int which[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 9; k++)
      values[9 * i + (size_t)k] = component[which[k]][i];
  snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 9, values, units, long_name);
}

/* Counts or labels: UINT32_MAX (none) is written as -1. */
static void unsigned_column(struct snapshot_file *file, const char *name, size_t n, const uint32_t *values,
                            int64_t *integers, const char *long_name) {
  for (size_t i = 0; i < n; i++)
    integers[i] = values[i] == UINT32_MAX ? -1 : (int64_t)values[i];
  snapshot_file_data(file, name, SNAPSHOT_FILE_INTEGER, n, 0, integers, "1", long_name);
}

static void grid(struct snapshot_file *file, size_t n, int64_t *integers) {
  for (size_t i = 0; i <= n; i++)
    integers[i] = (int64_t)i;
  snapshot_file_data(file, "VTKHDF/Connectivity", SNAPSHOT_FILE_INTEGER, n, 0, integers, NULL, NULL);
  snapshot_file_data(file, "VTKHDF/Offsets", SNAPSHOT_FILE_INTEGER, n + 1, 0, integers, NULL, NULL);
  unsigned char *type = (unsigned char *)integers;
  for (size_t i = 0; i < n; i++)
    type[i] = VTK_VERTEX;
  snapshot_file_data(file, "VTKHDF/Types", SNAPSHOT_FILE_BYTE, n, 0, type, NULL, NULL);
}

static void scalar(struct snapshot_file *file, const char *name, size_t n, const double *values, const char *units,
                   const char *long_name) {
  if (values)
    snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 0, values, units, long_name);
}

void sph_snapshot_particles(struct snapshot_file *file, const struct sph_particles *p,
                            const struct sph_fragments *fragments, const uint32_t *flaws) {
  size_t n = p->n;
  OWNED double *values = malloc((9 * n + 1) * sizeof *values);
  OWNED int64_t *integers = malloc((n + 1) * sizeof *integers);
  if (!values || !integers) {
    snapshot_file_fail(file);
    return;
  }
  snapshot_file_vtk(file, n, n, n);
  three(file, "VTKHDF/Points", n, p->x, p->y, p->z, values, "m", "positions of the particles");
  grid(file, n, integers);
  three(file, AT("velocity"), n, p->vx, p->vy, p->vz, values, "m s-1", "velocity");
  scalar(file, AT("mass"), n, p->mass, "kg", "mass");
  scalar(file, AT("density"), n, p->density, "kg m-3", "density of the body");
  scalar(file, AT("energy"), n, p->energy, "J kg-1", "specific internal energy");
  for (size_t i = 0; i < n; i++)
    values[i] = sph_particles_acting_pressure(p, i);
  scalar(
      file, AT("pressure"), n, values, "Pa",
      "pressure that acts: of tension, (1 - damage); nan where broken matter is under tension, which it cannot bear");
  scalar(file, AT("smoothing_length"), n, p->h, "m", "smoothing length h; a particle's reach is 2h");
#define PARTICLE_COLUMN(FLAG, member, absent, ...) scalar(file, AT(#member), n, p->member, __VA_ARGS__);
#include "engine/sph/modules/declarations.h"
  if (p->damage_cbrt) {
    for (size_t i = 0; i < n; i++)
      values[i] = sph_particles_damage(p, i);
    scalar(file, AT("damage"), n, values, "1", "damage D: 0 unbroken, 1 bears neither tension nor shear");
  }
  if (p->stress[0])
    tensor(file, AT("deviator"), n, p->stress, values, "Pa",
           "deviatoric stress, undamaged: (1 - damage) of it acts, or all of it where the yield law has the damage");
  for (size_t i = 0; i < n; i++)
    integers[i] = p->body[i];
  snapshot_file_data(file, AT("body"), SNAPSHOT_FILE_INTEGER, n, 0, integers, "1",
                     "body: 0 the target, 1 the projectile");
  unsigned_column(file, AT("fragment"), n, fragments->label, integers,
                  "number of its fragment by descending mass; -1: none");
  snapshot_file_data(file, AT("part"), SNAPSHOT_FILE_BYTE, n, 0, fragments->part, "1",
                     "0 core of a fragment, 1 its damaged layer, 2 single particle, 3 of a body without fragments");
  if (flaws)
    unsigned_column(file, AT("flaws"), n, flaws, integers, "number of flaws");
  COLUMNS(file, "fragments", fragments->count, fragments->fragments, fragment_columns);
}

/* The profile of an impact or of a plate. */
static void add_profile(struct snapshot_file *file, const struct sph_run *run) {
  OWNED struct sph_crater_layer *layers = malloc(MOST_LAYERS * sizeof *layers);
  if (!layers) {
    snapshot_file_fail(file);
    return;
  }
  struct sph_crater_options options = sph_report_crater_options(run);
  size_t count = run->inputs.kind == SPH_PISTON
                     ? sph_plate_profile(run, layers, MOST_LAYERS)
                     : sph_crater_profile(run->start, run->now, &options, layers, MOST_LAYERS);
  COLUMNS(file, "axis", count, layers, axis_columns);
}

status sph_snapshot_write(void *of, const char *path, struct error *error) {
  struct sph_run *run = of;
  const struct sph_inputs *in = &run->inputs;
  struct outcome outcome;
  struct sph_results results;
  OWNED struct fragment *unlabelled = NULL; /* the report finds them without the labels */
  SPH_FRAGMENTS found = {0};
  struct snapshot_file *file = NULL;
  size_t count = 0;
  TRY(sph_report_finish(run, &outcome, &results, &unlabelled, &count, error));
  OWNED uint32_t *flaws = malloc((run->now->n + 1) * sizeof *flaws);
  if (!flaws)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  TRY(sph_report_fragments(run, in->fragments.static_strength, in->fragments.veneer, &found, error));
  for (size_t k = 0; k < found.count; k++) /* the spin of few particles is that of their lattice */
    for (int d = 0; d < 3; d++) {
      struct fragment *f = &found.fragments[k];
      f->spin[d] = f->count < SPH_FRAGMENTS_MEASURED ? (double)NAN : f->spin[d];
      f->length[d] = f->length[d] > 0 ? f->length[d] : (double)NAN;
    }
  TRY(snapshot_file_open(&sph_engine, run->seed, in, &outcome, &results, &file, error));
  sph_snapshot_particles(file, run->now, &found, sph_system_flaws(run->system, flaws) ? flaws : NULL);
  if (run->sample)
    COLUMNS(file, "curve", run->state.frame.samples, run->sample, curve_columns);
  if (in->kind == SPH_IMPACT || in->kind == SPH_PISTON)
    add_profile(file, run);
  const status code = snapshot_file_save(file, path, error);
  snapshot_file_close(file);
  return code;
}
