/* K99's disc and its charge, for the bench: the cells round the central one leave it with v = c S/m and energy E_o. */
#pragma once

#include <math.h>

#include "engine/dem/step/system.h"

/* The default scene without breaking. */
static inline struct dem_inputs dem_disc_inputs(void) {
  struct dem_inputs in;
  field_defaults(&dem_inputs, &in);
  in.threshold.breaking = false;
  return in;
}

static inline bool dem_disc_tessellation(double radius, double spacing, uint64_t seed, struct dem_tessellation **out,
                                         struct error *e) {
  const struct dem_lattice lattice = {.outline = DEM_OUTLINE_DISC,
                                      .spacing = spacing,
                                      .disorder = 1.0,
                                      .radius = radius,
                                      .seed = seed};
  return dem_tessellation_make(&lattice, out, e) == STATUS_OK;
}

static inline uint32_t dem_disc_centre(const struct dem_tessellation *t) {
  uint32_t centre = 0;
  for (uint32_t i = 1; i < t->cell_count; i++)
    if (hypot(t->centroid[i].x, t->centroid[i].y) < hypot(t->centroid[centre].x, t->centroid[centre].y))
      centre = i;
  return centre;
}

/* Velocity of a charge neighbour, per unit of impulse per length: outward normal of the common side times S / m. */
static inline struct dem_point dem_disc_push(const struct dem_tessellation *t, uint32_t centre, size_t pair,
                                             double density) {
  const uint32_t other = t->pair[pair][0] == centre ? t->pair[pair][1] : t->pair[pair][0];
  const uint32_t fi = t->first_vertex[centre], ni = t->first_vertex[centre + 1] - fi;
  const uint32_t fj = t->first_vertex[other], nj = t->first_vertex[other + 1] - fj;
  for (uint32_t a = 0; a < ni; a++)
    for (uint32_t b = 0; b < nj; b++) {
      const struct dem_point p = t->vertex[fi + a], q = t->vertex[fi + (a + 1) % ni];
      const struct dem_point r = t->vertex[fj + b], u = t->vertex[fj + (b + 1) % nj];
      if (hypot(p.x - u.x, p.y - u.y) + hypot(q.x - r.x, q.y - r.y) < 1e-9 * t->side[pair] + 1e-14) {
        const double mass = density * t->area[other];
        return (struct dem_point){(q.y - p.y) / mass, -(q.x - p.x) / mass};
      }
    }
  return (struct dem_point){0.0, 0.0};
}

static inline void dem_disc_charge(struct dem_system *system, const struct dem_tessellation *t, double density,
                                   double energy) {
  const uint32_t centre = dem_disc_centre(t);
  double unit = 0.0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t k = 0; k < t->pair_count; k++) {
      if (t->pair[k][0] != centre && t->pair[k][1] != centre)
        continue;
      const uint32_t other = t->pair[k][0] == centre ? t->pair[k][1] : t->pair[k][0];
      const struct dem_point v = dem_disc_push(t, centre, k, density);
      if (pass == 0)
        unit += 0.5 * density * t->area[other] * (v.x * v.x + v.y * v.y);
      else
        dem_system_set_velocity(system, other, v.x * sqrt(energy / unit), v.y * sqrt(energy / unit), 0.0);
    }
  dem_system_remove(system, centre);
}
