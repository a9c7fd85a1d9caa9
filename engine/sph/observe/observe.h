/* Crater and ejecta of an impact on a target. A pure function of the target's particles at the
 * start and now; its resolution is the spacing of the particles.
 *
 * Outwards is along the outward normal at the point of impact. Ejecta are the target's particles that move outwards
 * faster than a given speed, in the frame where the target was at rest; all other particles are retained. A map divides
 * the target's outline, seen along the normal, into columns of two spacings. The surface in a column is the highest
 * retained particle. The crater is the connected region
 * round the axis where the surface lies at least one spacing deeper than at the start. Two processes make a crater:
 * ejecta leave, and matter is compacted permanently, which the modules that compact it measure. */
#pragma once

#include <stdbool.h>

#include "engine/fragments.h"
#include "engine/sph/body/particles.h"
#include "engine/sph/observe/results.h"

struct sph_crater_options {
  size_t first, count;   /* particles of the target */
  double mass;           /* kg, of the target */
  double frame[3][3];    /* unit vectors at the point of impact: two in the face, and the outward normal */
  double axis[2];        /* m, along the first two: the point of impact */
  double spacing;        /* m, of the particles at the point of impact */
  bool graded;           /* particles elsewhere are coarser */
  double ejection_speed; /* m/s, outwards */
  double escape_speed;   /* m/s, in any direction: slower matter falls back; 0: there is no gravity */
};

/* m/s, of particle i, in the frame where the target was at rest. */
double sph_crater_speed(const struct sph_particles *particles, size_t i);
/* m/s, along the outward normal. */
double sph_crater_outwards(const struct sph_particles *particles, size_t i, const struct sph_crater_options *options);

/* Fills the results ejecta.* and crater.*, and the ejecta over their speed. STATUS_MEMORY. */
status sph_crater_measure(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *options, struct sph_results *results, struct error *error);

/* Fills the results compaction.* and crater.compaction_share. `initial`: alpha_0. Both sets of particles have their
 * distentions. A pure function. */
void sph_crater_compaction(const struct sph_particles *start, const struct sph_particles *now,
                           const struct sph_crater_options *options, double initial, struct sph_results *results);

/* One layer of the profile along the axis: means over the retained target particles within 1.5 of their spacings of the
 * axis. A layer is one spacing thick, by the particles' depth at the start. */
struct sph_crater_layer {
  double depth;  /* m, of the layer's middle, at the start */
  double damage; /* D */
  double
      pressure;   /* Pa, acting; in an impact a mean without broken particles under tension; NaN: there are no others */
  double bearing; /* number of particles in the mean of the pressure */
  double velocity; /* m/s, outwards */
#define PROFILE_COLUMN(member, ...) double member;
#include "engine/sph/modules/declarations.h"
};
/* Fills at most `most` layers and returns how many. Empty layers are left out. */
size_t sph_crater_profile(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *options, struct sph_crater_layer *layers, size_t most);

/* Fragments of a cracked body of SPH particles, before the fragments have flown apart. Benz & Asphaug 1995 section 4.4
 * [BA95]:
 *
 *   1. Static strength: a damaged particle breaks if its largest tension (principal value of the damaged stress,
 *      pressure included) exceeds the static strength of its body. This anticipates the end state, in which the last
 *      cracks open slowly. Undamaged matter (D = 0) has no crack and does not break; BA95 does not require damage.
 *   2. Cores: friends of friends over unbroken particles (damage below a threshold). Two are friends within link_length
 *      (h_i + h_j)/2.
 *   3. Damaged layer: a broken particle within a link, or a given length, of a core joins the fragment of its nearest
 *      unbroken particle. At equal distance the heavier core decides, then the core with the lower first particle.
 *      SPH forces reach two layers deep, so a crack is two layers of broken particles wide. The damaged layer itself
 *      links nothing.
 *   4. Single particles: every other broken particle is a fragment of its own, below the resolution.
 *
 * A core is thus a fragment without its damaged layer. The input fragments.veneer switches step 3 on.
 *
 * A pure function of the particles as a system reads them back. The fragments depend on positions and states, not on
 * the numbering of particles, except that fragments of exactly the same mass are numbered by their first particle. */

struct sph_fragments_body {
  bool left_out;          /* its particles belong to no fragment and count in no mass (a projectile) */
  double static_strength; /* Pa; NaN: no particle breaks by it */
};

struct sph_fragments_options {
  double damage;      /* 0..1: a particle is unbroken when its D is below; without damage all are */
  double link_length; /* over the mean h of the two: 1 in BA95 */
  bool layer;         /* step 3 */
  double layer_width; /* m: the damaged layer is as deep as this; 0: a link */
  bool whole_shear;   /* damage does not scale the deviator (sph_modules_damage_scales_shear): of the static strength */
  const double *h;    /* m, by particle: the initial smoothing lengths, so that expanding matter does not link farther.
                       * NULL: the current ones. Borrowed */
  double periodic[3]; /* m, length of the periodic box per direction; NaN = open */
  const struct sph_fragments_body
      *bodies; /* by sph_particles.body; NULL: no body is left out, none has a static strength. Borrowed */
  size_t body_count;
};
struct sph_fragments_options sph_fragments_default(void); /* D < 1, one mean h, layer, open, current h */

/* A fragment has a spin and a speed of its own, and the largest one axes, from this number of particles on. The ratio
 * of shortest to longest axis of a sphere cut from the lattice is 0.93 at 100 particles, 0.69 at 10. */
enum { SPH_FRAGMENTS_MEASURED = 100 };

/* A fragment has three lengths from this number of particles on: our choice. 60 are about four across. */
enum { SPH_FRAGMENTS_SHAPED = 60 };

/* A spectrum is complete from this number of particles on. A core of one particle with its damaged layer has the mass
 * of 5 to 13. In the scene `disruption` 10 000 and 40 000 particles give 9.7 and 9.3 fragments above the mass of 10 of
 * the coarser particles, 19.3 and 16.0 above that of 5 (means of 3 seeds). */
enum { SPH_FRAGMENTS_COMPLETE = 10 };

enum sph_fragments_part { SPH_FRAGMENTS_CORE, SPH_FRAGMENTS_LAYER, SPH_FRAGMENTS_SINGLE, SPH_FRAGMENTS_LEFT_OUT };

struct sph_fragments {
  size_t n;        /* particles */
  uint32_t *label; /* by particle: number of its fragment, 0 the heaviest; UINT32_MAX when left out */
  uint8_t *part;   /* by particle: enum sph_fragments_part */
  struct fragment
      *fragments; /* by descending mass; each single particle is one of count 1. The caller may take it (set it NULL) */
  size_t count;   /* number of fragments, single particles included */
  size_t resolved;                  /* number of fragments with a core of two particles or more */
  size_t broken;                    /* number of particles that the static strength broke */
  double mass;                      /* kg, of all particles that are not left out */
  double single_mass;               /* kg, of broken particles that are fragments of their own */
  double core_largest, core_second; /* kg, the two heaviest cores */
  double axis_ratio[2]; /* shape of fragment 0, from the inertia tensor: middle and shortest over longest axis of the
                         * ellipsoid of the same tensor; NaN for less than SPH_FRAGMENTS_MEASURED particles, or flat */
};

/* A particle whose position, velocity or h is not finite is a fragment of its own. In periodic directions a fragment is
 * measured from the images nearest to its first particle. A fragment that spans the box has no spin but about that
 * axis, and its centre along the axis has no meaning. STATUS_MEMORY. On failure *out is empty. */
status sph_fragments_find(const struct sph_particles *particles, const struct sph_fragments_options *options,
                          struct sph_fragments *out, struct error *error);
void sph_fragments_clear(struct sph_fragments *fragments);
/* Of a local variable, cleared where its block is left: SPH_FRAGMENTS found = {0}; */
#define SPH_FRAGMENTS __attribute__((cleanup(sph_fragments_clear))) struct sph_fragments
