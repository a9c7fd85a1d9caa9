#include "engine/sph/body/particles.h"

#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

size_t sph_particles_memory(void) {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  size_t most = pages > 0 && page > 0 ? (size_t)pages * (size_t)page : SIZE_MAX;
  struct rlimit limit;
  if (!getrlimit(RLIMIT_AS, &limit) && limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur < most)
    most = (size_t)limit.rlim_cur;
  return most;
}

static double *column(size_t n) {
  return calloc(n ? n : 1, sizeof(double));
}

status sph_particles_make(size_t n, int arrays, struct sph_particles **out, struct error *error) {
  *out = NULL;
  const int doubles = 12 + (arrays & SPH_WITH_STRESS ? 6 : 0) + (arrays & SPH_WITH_DAMAGE ? 1 : 0) +
                      (arrays & SPH_WITH_DAMPING ? 1 : 0) + (arrays & SPH_WITH_DISTENTION ? 2 : 0);
  const size_t bytes = (size_t)(8 * doubles + 1 + (arrays & SPH_WITH_HELD ? 1 : 0));
  if (n > sph_particles_memory() / bytes)
    return status_fail(error, STATUS_MEMORY, "%zu particles need %.3g GB; this machine, or the limit set, has %.3g GB.",
                       n, (double)n * (double)bytes / 1e9, (double)sph_particles_memory() / 1e9);
  struct sph_particles *p = calloc(1, sizeof *p);
  if (!p)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles", n);
  p->n = n;
  double **const always[] = {&p->x,    &p->y,       &p->z,      &p->vx, &p->vy,      &p->vz,
                             &p->mass, &p->density, &p->energy, &p->h,  &p->pressure};
  int complete = 1;
  for (size_t k = 0; k < sizeof always / sizeof *always; k++)
    complete &= (*always[k] = column(n)) != NULL;
  complete &= (p->body = calloc(n ? n : 1, 1)) != NULL;
  if (arrays & SPH_WITH_STRESS)
    for (int k = 0; k < 6; k++)
      complete &= (p->stress[k] = column(n)) != NULL;
  if (arrays & SPH_WITH_DAMAGE)
    complete &= (p->damage_cbrt = column(n)) != NULL;
  if (arrays & SPH_WITH_HELD)
    complete &= (p->held = calloc(n ? n : 1, 1)) != NULL;
  if (arrays & SPH_WITH_DAMPING)
    complete &= (p->damping = column(n)) != NULL;
  if (arrays & SPH_WITH_DISTENTION)
    complete &= (p->distention = column(n)) != NULL && (p->rest_distention = column(n)) != NULL;
  if (!complete) {
    sph_particles_free(p);
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles", n);
  }
  if (p->distention)
    for (size_t i = 0; i < n; i++)
      p->distention[i] = p->rest_distention[i] = 1;
  *out = p;
  return STATUS_OK;
}

void sph_particles_free(struct sph_particles *p) {
  if (!p)
    return;
  double *const all[] = {p->x,         p->y,          p->z,
                         p->vx,        p->vy,         p->vz,
                         p->mass,      p->density,    p->energy,
                         p->h,         p->pressure,   p->stress[0],
                         p->stress[1], p->stress[2],  p->stress[3],
                         p->stress[4], p->stress[5],  p->damage_cbrt,
                         p->damping,   p->distention, p->rest_distention};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++)
    free(all[k]);
  free(p->body);
  free(p->held);
  free(p);
}
