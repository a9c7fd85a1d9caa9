#include "engine/sph/observe/particle_columns.h"

#include <stdlib.h>

enum { VTK_VERTEX = 1 };

#define AT(name) "VTKHDF/PointData/" name

static void three(struct snapshot_file *file, const char *name, size_t n, const double *x, const double *y,
                  const double *z, double *room, const char *units, const char *long_name) {
  for (size_t i = 0; i < n; i++) {
    room[3 * i] = x[i];
    room[3 * i + 1] = y[i];
    room[3 * i + 2] = z[i];
  }
  snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 3, room, units, long_name);
}

/* VTK's tensors have nine components, row by row. */
static void tensor(struct snapshot_file *file, const char *name, size_t n, double *const component[6], double *room,
                   const char *units, const char *long_name) {
  static const int which[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 9; k++)
      room[9 * i + (size_t)k] = component[which[k]][i];
  snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 9, room, units, long_name);
}

static void whole_numbers(struct snapshot_file *file, const char *name, size_t n, const uint32_t *values, int64_t *room,
                          const char *long_name) {
  for (size_t i = 0; i < n; i++)
    room[i] = values[i] == UINT32_MAX ? -1 : (int64_t)values[i];
  snapshot_file_data(file, name, SNAPSHOT_FILE_INTEGER, n, 0, room, "1", long_name);
}

static void grid(struct snapshot_file *file, size_t n, int64_t *room) {
  for (size_t i = 0; i <= n; i++)
    room[i] = (int64_t)i;
  snapshot_file_data(file, "VTKHDF/Connectivity", SNAPSHOT_FILE_INTEGER, n, 0, room, NULL, NULL);
  snapshot_file_data(file, "VTKHDF/Offsets", SNAPSHOT_FILE_INTEGER, n + 1, 0, room, NULL, NULL);
  unsigned char *type = (unsigned char *)room;
  for (size_t i = 0; i < n; i++)
    type[i] = VTK_VERTEX;
  snapshot_file_data(file, "VTKHDF/Types", SNAPSHOT_FILE_BYTE, n, 0, type, NULL, NULL);
}

static void scalar(struct snapshot_file *file, const char *name, size_t n, const double *values, const char *units,
                   const char *long_name) {
  if (values)
    snapshot_file_data(file, name, SNAPSHOT_FILE_REAL, n, 0, values, units, long_name);
}

static const struct snapshot_file_column fragment_columns[] = {
    {"mass", "kg", "mass, descending; dust particles each by themselves", 0},
    {"position", "m", "centre of mass", 3},
    {"velocity", "m s-1", "velocity of the centre of mass", 3},
    {"spin", "rad s-1", "angular velocity: inverse inertia tensor times angular momentum about the centre of mass", 3},
    {"moment_of_inertia", "kg m2", "a third of the inertia tensor's trace, about the centre of mass", 0},
    {"kinetic_energy", "J", "translation, rotation and inner motion", 0},
    {"count", "1", "particles in it", 0},
    {"first", "1", "its lowest particle", 0},
};
static double fragment_value(const void *context, size_t row, size_t column, size_t k) {
  const struct fragment *f = (const struct fragment *)context + row;
  const double values[] = {f->mass,           f->position[k], f->velocity[k], f->spin[k], f->moment_of_inertia,
                           f->kinetic_energy, f->count,       f->first};
  return values[column];
}

void sph_particle_columns_add(struct snapshot_file *file, const struct sph_particles *p,
                              const struct sph_fragments *pieces, const uint32_t *flaws) {
  size_t n = p->n;
  double *room = malloc((9 * n + 1) * sizeof *room);
  int64_t *whole = malloc((n + 1) * sizeof *whole);
  if (!room || !whole) {
    snapshot_file_fail(file);
    goto cleanup;
  }
  snapshot_file_vtk(file, n, n, n);
  three(file, "VTKHDF/Points", n, p->x, p->y, p->z, room, "m", "positions of the particles");
  grid(file, n, whole);
  three(file, AT("velocity"), n, p->vx, p->vy, p->vz, room, "m s-1", "velocity");
  scalar(file, AT("mass"), n, p->mass, "kg", "mass");
  scalar(file, AT("density"), n, p->density, "kg m-3", "density, pores included");
  scalar(file, AT("energy"), n, p->energy, "J kg-1", "specific internal energy");
  scalar(file, AT("pressure"), n, p->pressure, "Pa",
         "pressure, undamaged: where it is negative, (1 - damage) of it acts");
  scalar(file, AT("smoothing_length"), n, p->h, "m", "smoothing length h; a particle's reach is 2h");
  scalar(file, AT("distention"), n, p->distention, "1", "distention: density of the matrix over density");
  scalar(file, AT("rest_distention"), n, p->rest_distention, "1",
         "what it would be without pressure: below the first, pores are closed for good");
  if (p->damage_cbrt) {
    for (size_t i = 0; i < n; i++)
      room[i] = p->damage_cbrt[i] * p->damage_cbrt[i] * p->damage_cbrt[i];
    scalar(file, AT("damage"), n, room, "1", "damage D: 0 whole, 1 without tension and shear");
  }
  if (p->stress[0])
    tensor(file, AT("deviator"), n, p->stress, room, "Pa", "deviatoric stress, undamaged: (1 - damage) of it acts");
  for (size_t i = 0; i < n; i++)
    whole[i] = p->body[i];
  snapshot_file_data(file, AT("body"), SNAPSHOT_FILE_INTEGER, n, 0, whole, "1", "body: 0 the target, 1 the projectile");
  whole_numbers(file, AT("fragment"), n, pieces->label, whole, "number of its fragment by descending mass; -1: none");
  snapshot_file_data(file, AT("part"), SNAPSHOT_FILE_BYTE, n, 0, pieces->part, "1",
                     "0 core of a fragment, 1 its veneer of broken particles, 2 dust, 3 not searched for fragments");
  if (flaws)
    whole_numbers(file, AT("flaws"), n, flaws, whole, "flaws that it was given");
  snapshot_file_columns(file, "fragments", pieces->count, sizeof fragment_columns / sizeof *fragment_columns,
                        fragment_columns, fragment_value, pieces->fragments);
cleanup:
  free(room);
  free(whole);
}
