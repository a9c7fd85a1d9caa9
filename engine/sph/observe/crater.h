/* Crater and ejecta of an impact on a target. A pure function of the target's particles at the
 * start and now; its resolution is the spacing of the particles.
 *
 * The impact moves along -z. Ejecta are the target's particles that move outwards (+z) faster than a given speed; all
 * other particles are retained. A map divides the target's outline into columns of two spacings. The surface in a
 * column is the highest retained particle. The crater is the connected region round the axis where the surface lies at
 * least one spacing deeper than at the start. Two processes make a crater: ejecta leave, and matter is compacted
 * permanently, which the modules that compact it measure. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_CRATER_H
#define CLAST_ENGINE_SPH_OBSERVE_CRATER_H

#include <stdbool.h>

#include "engine/sph/body/particles.h"
#include "engine/sph/observe/results.h"
#include "schemas/status.h"

struct sph_crater_options {
  size_t first, count;   /* particles of the target */
  double mass;           /* kg, of the target */
  double axis[2];        /* m, x and y of the point of impact */
  double spacing;        /* m, of the particles at the point of impact */
  double ejection_speed; /* m/s */
};

bool sph_crater_is_ejected(const struct sph_particles *now, size_t i, const struct sph_crater_options *options);
/* m, of particle i from the axis. */
double sph_crater_off_axis(const struct sph_particles *particles, size_t i, const struct sph_crater_options *options);
/* m, the highest particle less than `spacings` spacings from the axis. */
double sph_crater_top(const struct sph_particles *start, const struct sph_crater_options *options, double spacings);

/* Fills the results ejecta.* and crater.*. STATUS_MEMORY. */
status sph_crater_measure(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *options, struct sph_results *results, struct error *error);

/* One layer of the profile along the axis: means over the retained target particles within 1.5 spacings of the axis. A
 * layer is one spacing thick, by the particles' depth at the start. */
struct sph_crater_layer {
  double depth;  /* m, of the layer's middle, at the start */
  double damage; /* D */
  double
      pressure;   /* Pa, acting; in an impact a mean without broken particles under tension; NaN: there are no others */
  double bearing; /* number of particles in the mean of the pressure */
  double velocity; /* m/s, along +z */
#define PROFILE_COLUMN(member, ...) double member;
#include "engine/sph/modules/declarations.h"
};
/* Fills at most `most` layers and returns how many. Empty layers are left out. */
size_t sph_crater_profile(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *options, struct sph_crater_layer *layers, size_t most);

#endif
