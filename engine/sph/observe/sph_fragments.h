/* Fragments of cracked solids before they have flown apart. Benz & Asphaug 1995 section 4.4 [BA95]:
 *
 *   1. a particle whose largest tension (principal value of the damaged stress, pressure in it) exceeds the static
 * strength of its body breaks: the end state is anticipated, where the last cracks open slowly;
 *   2. friends of friends over whole particles (damage below a threshold): two are friends within link_length (h_i +
 * h_j)/2;
 *   3. a veneer: each broken particle within a link of a fragment joins it, the nearest whole particle deciding (of two
 * at the same distance the one of the heavier fragment, then of the one with the lower first particle). SPH's forces
 * reach two layers deep, so that a crack is two broken layers wide. Nobody is searched from the veneer;
 *   4. all other broken particles are dust: each on its own, below what is resolved.
 *
 * A pure function of what a system reads back (design: fragments are found by public pure functions). Fragments depend
 * on positions and states, not on the numbering of particles, but for ties: fragments of the very same mass are
 * numbered by their first particle. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_SPH_FRAGMENTS_H
#define CLAST_ENGINE_SPH_OBSERVE_SPH_FRAGMENTS_H

#include <stdbool.h>

#include "engine/fragments.h"
#include "engine/sph/body/particles.h"

struct sph_fragments_body {
  bool left_out;          /* its particles belong to nothing and count in no mass (a projectile) */
  double static_strength; /* Pa; NaN: nothing breaks that was whole */
};

struct sph_fragments_options {
  double damage;      /* 0..1: a particle with D below it is whole; those without damage are */
  double link_length; /* over the mean h of the two: 1 in BA95 */
  bool veneer;
  bool across_bodies; /* may particles of two bodies be friends? Not by default: nothing cements them */
  const double *h; /* m, by particle: the initial smoothing lengths, so that loose matter that swells links no farther.
                    * NULL: the current ones. Borrowed */
  double periodic[3]; /* m, length of the periodic box per direction; NaN = open */
  const struct sph_fragments_body
      *bodies; /* by sph_particles.body; NULL: none left out, no static strength. Borrowed */
  size_t body_count;
};
struct sph_fragments_options sph_fragments_default(void); /* D < 1, one mean h, veneer, open, current h */

enum sph_fragments_part { SPH_FRAGMENTS_CORE, SPH_FRAGMENTS_VENEER, SPH_FRAGMENTS_DUST, SPH_FRAGMENTS_LEFT_OUT };

struct sph_fragments {
  size_t n;        /* particles */
  uint32_t *label; /* by particle: number of its fragment, 0 the heaviest; UINT32_MAX when left out */
  uint8_t *part;   /* by particle: enum sph_fragments_part. Without the veneer: label where the part is core */
  struct fragment *fragments; /* by descending mass, dust particles each as one of count 1; may be taken (set NULL) */
  size_t count;               /* of all of them */
  size_t resolved;            /* fragments with a core of two particles or more */
  size_t broken;              /* particles that the static strength broke */
  double mass;                /* kg, of all that is not left out */
  double dust_mass;           /* kg */
  double bare_largest, bare_second; /* kg, of the heaviest cores without their veneer */
  double axis_ratio[2];  /* shape of fragment 0, from the inertia tensor: middle and shortest over longest axis of the
                          * ellipsoid of the same tensor; NaN for less than four particles or flat ones */
  double ejected_energy; /* J, kinetic energy of all that is finite outside fragment 0, in the frame of its centre of
                            mass */
};

/* Particles whose position, velocity or h is not finite are dust, in no fragment's way. In periodic directions
 * fragments are measured from the images nearest to their first particle; one that spans the box turns about that axis
 * alone, if at all, and its centre along it has no meaning. STATUS_MEMORY; STATUS_CONTENT for options out of range or a
 * body without an entry. On failure *pieces is empty. */
status sph_fragments_find(const struct sph_particles *particles, const struct sph_fragments_options *options,
                          struct sph_fragments *pieces, struct error *error);
void sph_fragments_clear(struct sph_fragments *pieces);

#endif
