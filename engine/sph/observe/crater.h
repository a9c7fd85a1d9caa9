/* What an impact leaves of a target, told from its particles at the start and now: crater, ejecta, closed pores.
 *
 * The blow comes along -z. Ejecta are the target's particles that move outwards (+z) faster than a given speed; all
 * else is retained. In columns of two spacings the surface is the highest retained particle; the crater is the
 * connected region round the axis where it lies at least one spacing deeper than at the start. Both ways to make it are
 * told apart: volume of the pores that are closed for good, and the volume that ejecta had. A pure function of
 * particles; its resolution is the spacing. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_CRATER_H
#define CLAST_ENGINE_SPH_OBSERVE_CRATER_H

#include "engine/sph/body/particles.h"
#include "schemas/status.h"

struct sph_crater_options {
  size_t first, count;   /* particles of the target */
  double axis[2];        /* m, x and y of the point of impact */
  double spacing;        /* m, of particles where it was hit */
  double ejection_speed; /* m/s */
  double distention;     /* alpha_0; 1: no pores */
};

struct sph_crater {
  double ejected_mass, ejected_momentum; /* kg; kg m/s outwards */
  double depth, radius, volume;          /* m, m^3; 0 without a crater. radius: of a circle of the same area */
  double compacted_mass;    /* kg, of particles with alpha < 1.01 (here and below: at rest) that had 1.01 or more */
  double compaction_volume; /* m^3, of pores closed, of the retained particles */
  double ejecta_volume;     /* m^3, that ejecta had at the start */
  double compaction_depth;  /* m, below the first surface: deepest particle near the axis with alpha < 1.01 */
  double compaction_reach;  /* m, from the point of impact: farthest particle that lost a hundredth of its pores */
};

/* STATUS_MEMORY. Arrays that are NULL count as: alpha 1. */
status sph_crater_find(const struct sph_particles *start, const struct sph_particles *now,
                       const struct sph_crater_options *options, struct sph_crater *out, struct error *error);

/* State along the axis: mean of the retained target particles within 1.5 spacings of it, in layers of one spacing of
 * their depth at the start. */
struct sph_crater_layer {
  double depth, distention, damage, pressure,
      velocity; /* m, 1 (at rest), 1, Pa, m/s; depth: of the middle, at the start */
};
/* At most `most` layers; returns how many. Empty layers are left out. */
size_t sph_crater_profile(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *options, struct sph_crater_layer *layers, size_t most);

#endif
