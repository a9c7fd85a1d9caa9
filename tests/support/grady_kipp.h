/* The law of damage of one particle in plain C, from the flaws as they were drawn. The engine's loops (fracture.h) must
 * give the same. */
#pragma once

#include "engine/sph/body/flaws.h"
#include "engine/sph/material/material.h"

/* Number of particle i's flaws that are open at this ln(strain). */
static inline size_t grady_kipp_open(const struct sph_flaws *flaws, size_t i, double log_strain) {
  size_t low = flaws->first[i], high = flaws->first[i + 1];
  while (low < high) { /* first flaw stronger than the strain */
    size_t middle = low + (high - low) / 2;
    if (flaws->log_strain[middle] <= log_strain)
      low = middle + 1;
    else
      high = middle;
  }
  return low - flaws->first[i];
}

/* D^(1/3) after dt with `open` of `total` flaws open. rate = c_g/R_s, 1/s. */
static inline double grady_kipp_grow(double damage_cbrt, size_t open, size_t total, int growth, int cap, double rate,
                                     double dt) {
  if (!open)
    return damage_cbrt;
  double grown = damage_cbrt + sph_material_damage_rate(open, growth) * rate * dt;
  const double limit = sph_material_damage_cap(open, total, cap);
  if (grown > limit)
    grown = limit;
  return grown > damage_cbrt ? grown : damage_cbrt;
}
