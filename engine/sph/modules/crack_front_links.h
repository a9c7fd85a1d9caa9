/* Data of crack fronts beside the columns: the neighbours of every particle at the start, and the progress of cracks.
 * Particles are named by their number within their body, which sorting does not change. */
#ifndef CLAST_ENGINE_SPH_MODULES_CRACK_FRONT_LINKS_H
#define CLAST_ENGINE_SPH_MODULES_CRACK_FRONT_LINKS_H

#include <stddef.h>
#include <stdint.h>

/* The columns front_* of a particle, where its neighbours can read them. */
struct sph_crack_front_tip {
  double time;   /* s, when the front was here; infinite: not yet */
  double offset; /* m, of the particle from the crack's plane, along the normal */
  double stress; /* Pa: the front goes on where the tension across the plane is at least this */
  double normal[3];
};

/* Hooks before the pair loop read `tip` and `near`; hooks after it write them. So no block sees what another has found
 * in the same step, and the bits do not depend on the number of threads. */
struct sph_crack_front_links {
  size_t particles;
  double speed;                    /* m/s, c_g */
  double *place;                   /* m, three coordinates of each particle at the start */
  size_t *first;                   /* particle q has the neighbours other[first[q]] ... other[first[q + 1] - 1] */
  uint32_t *other;                 /* within 2h at the start */
  struct sph_crack_front_tip *tip; /* a particle is reached once at most */
  unsigned char *near;             /* 1: a front has been at a neighbour */
};

struct sph_system;
struct sph_solid;

/* Copies the columns front_* of the particles low .. high - 1 to `tip`, where their neighbours read them. */
void sph_crack_front_publish(struct sph_system *system, const struct sph_solid *body, size_t low, size_t high);

#endif
