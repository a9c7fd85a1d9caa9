/* Allocation of the particles' columns. */
#include "engine/sph/body/particles.h"

#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "schemas/memory.h"

size_t sph_particles_memory(void) {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  size_t most = pages > 0 && page > 0 ? (size_t)pages * (size_t)page : SIZE_MAX;
  struct rlimit limit;
  if (!getrlimit(RLIMIT_AS, &limit) && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < most)
    most = (size_t)limit.rlim_cur;
  return most;
}

/* The columns of doubles, and the flag of enum sph_particle_arrays that turns each on (0: always on). */
static const struct {
  size_t offset;
  int array;
  double initial;
} columns[] = {
#define ARRAY(member, array)                                                                                           \
  { offsetof(struct sph_particles, member), array, 0 }
    ARRAY(x, 0),
    ARRAY(y, 0),
    ARRAY(z, 0),
    ARRAY(vx, 0),
    ARRAY(vy, 0),
    ARRAY(vz, 0),
    ARRAY(mass, 0),
    ARRAY(density, 0),
    ARRAY(energy, 0),
    ARRAY(h, 0),
    ARRAY(pressure, 0),
    ARRAY(stress[0], SPH_WITH_STRESS),
    ARRAY(stress[1], SPH_WITH_STRESS),
    ARRAY(stress[2], SPH_WITH_STRESS),
    ARRAY(stress[3], SPH_WITH_STRESS),
    ARRAY(stress[4], SPH_WITH_STRESS),
    ARRAY(stress[5], SPH_WITH_STRESS),
    ARRAY(damage_cbrt, SPH_WITH_DAMAGE),
    ARRAY(damping, SPH_WITH_DAMPING),
#define PARTICLE_COLUMN(FLAG, member, absent, ...) {offsetof(struct sph_particles, member), SPH_WITH_##FLAG, absent},
#include "engine/sph/modules/declarations.h"
};
enum { COLUMNS = sizeof columns / sizeof *columns };

static double **column_of(struct sph_particles *p, size_t k) {
  return (double **)(void *)((char *)p + columns[k].offset);
}

static bool is_wanted(size_t k, int arrays) {
  return columns[k].array == 0 || arrays & columns[k].array;
}

static bool allocate(struct sph_particles *p, int arrays) {
  const size_t n = p->n ? p->n : 1;
  bool enough = true;
  for (size_t k = 0; k < COLUMNS && enough; k++) {
    if (!is_wanted(k, arrays))
      continue;
    double *column = *column_of(p, k) = calloc(n, sizeof *column);
    enough = column != NULL;
    for (size_t i = 0; enough && columns[k].initial != 0 && i < n; i++)
      column[i] = columns[k].initial;
  }
  p->body = calloc(n, 1);
  if (!(arrays & SPH_WITH_HELD))
    return enough && p->body;
  p->held = calloc(n, 1);
  return enough && p->body && p->held;
}

status sph_particles_make(size_t n, int arrays, struct sph_particles **out, struct error *error) {
  *out = NULL;
  size_t bytes = sizeof(double) + 1 + (arrays & SPH_WITH_HELD ? 1 : 0); /* a double to sort by, body, held */
  for (size_t k = 0; k < COLUMNS; k++)
    bytes += is_wanted(k, arrays) ? sizeof(double) : 0;
  if (n > sph_particles_memory() / bytes)
    return status_fail(error, STATUS_MEMORY, "%zu particles need %.3g GB; this machine, or the limit set, has %.3g GB.",
                       n, (double)n * (double)bytes / 1e9, (double)sph_particles_memory() / 1e9);

  struct sph_particles *p = memory_small(1, sizeof *p);
  p->n = n;
  if (!allocate(p, arrays)) {
    sph_particles_free(p);
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles", n);
  }
  *out = p;
  return STATUS_OK;
}

void sph_particles_free(struct sph_particles *p) {
  if (!p)
    return;
  for (size_t k = 0; k < COLUMNS; k++)
    free(*column_of(p, k));
  free(p->body);
  free(p->held);
  free(p);
}
