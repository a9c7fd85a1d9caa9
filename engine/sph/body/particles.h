/* Particles as they are set up and read back: plain arrays in the order of their ids, bodies one after the other. (The
 * moving system sorts them in space.) Arrays that a scene does not need are NULL. */
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "schemas/status.h"

enum sph_freedom { /* bits of `held` */
                   SPH_HELD_X = 1,
                   SPH_HELD_Y = 2,
                   SPH_HELD_Z = 4, /* keeps its velocity under any forces (grips, pistons) */
};

enum sph_array { /* the flags of arrays that modules declare follow these four */
                 SPH_ARRAYS_OF_ALL = 3,
#define PARTICLE_ARRAYS(FLAG, column) SPH_ARRAY_##FLAG,
#include "engine/sph/modules/declarations.h"
};

enum sph_particle_arrays { /* which of the optional arrays exist */
                           SPH_WITH_STRESS = 1,
                           SPH_WITH_DAMAGE = 2,
                           SPH_WITH_HELD = 4,
                           SPH_WITH_DAMPING = 8,
#define PARTICLE_ARRAYS(FLAG, column) SPH_WITH_##FLAG = 1 << SPH_ARRAY_##FLAG,
#include "engine/sph/modules/declarations.h"
};

struct sph_particles {
  size_t n;
  double *x, *y, *z;    /* m */
  double *vx, *vy, *vz; /* m/s */
  double *mass;         /* kg */
  double *density;      /* kg/m^3, bulk */
  double *energy;       /* J/kg, specific internal */
  double *h;            /* m, smoothing length; support is 2h */
  double *pressure;     /* Pa, undamaged, bulk; filled when read back */
  uint8_t *body;        /* 0 target, 1 projectile, ...: index into the bodies given to sph_system_create; ascending */
  /* optional */
  double *stress[6];   /* Pa, deviatoric xx xy xz yy yz zz, undamaged, bulk */
  double *damage_cbrt; /* D^(1/3), tension and compaction together */
  uint8_t *held;       /* enum sph_freedom bits */
  double *damping;     /* 1/s: dv/dt = -damping v, for far sides that waves leave by */
#define PARTICLE_COLUMN(FLAG, member, ...) double *member;
#include "engine/sph/modules/declarations.h"
};

/* D of particle i; 0 without damage. */
static inline double sph_particles_damage(const struct sph_particles *p, size_t i) {
  double cbrt = p->damage_cbrt ? p->damage_cbrt[i] : 0;
  return cbrt * cbrt * cbrt;
}

/* The acting pressure, for files and pictures: tension is multiplied by 1 - D. NaN in broken matter under tension: it
 * bears none, but the equation of state gives many GPa of tension in rubble that flies apart. */
#define SPH_PARTICLES_BROKEN 0.99 /* D from which matter counts as broken there */
static inline double sph_particles_acting_pressure(const struct sph_particles *p, size_t i) {
  const double damage = sph_particles_damage(p, i), pressure = p->pressure[i];
  if (!(pressure < 0))
    return pressure;
  return damage > SPH_PARTICLES_BROKEN ? (double)NAN : (1 - damage) * pressure;
}

/* Allocates the arrays for n particles; `arrays` are the flags of enum sph_particle_arrays. All are zero, but
 * columns of modules have their `absent` value. STATUS_MEMORY. */
status sph_particles_make(size_t n, int arrays, struct sph_particles **out, struct error *error);
void sph_particles_free(struct sph_particles *particles); /* NULL is fine */

/* The largest number of bytes for this process: the machine's memory or the limit of its address space. A larger
 * request is refused, with the number, before anything is allocated. */
size_t sph_particles_memory(void);
