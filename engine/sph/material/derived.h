/* Moduli, speeds and densities that follow from a material's values. */
#ifndef CLAST_ENGINE_SPH_MATERIAL_DERIVED_H
#define CLAST_ENGINE_SPH_MATERIAL_DERIVED_H

#include <stdbool.h>

#include "engine/sph/material/material.h"

double sph_derived_bulk_modulus(const struct sph_material *material);  /* Pa, K; tillotson.A unless it is given */
double sph_derived_young_modulus(const struct sph_material *material); /* Pa, 9 K mu/(3 K + mu) */
double sph_derived_poisson_ratio(const struct sph_material *material);
double sph_derived_crack_speed(const struct sph_material *material);  /* m/s, c_g = 0.4 sqrt((K + 4 mu/3)/rho_0) */
double sph_derived_solid_ratio(const struct sph_material *material);  /* density of the solid over that of the body */
double sph_derived_bulk_density(const struct sph_material *material); /* kg/m^3 of a body at rest */
/* m/s, longitudinal, of a body at rest. */
double sph_derived_longitudinal_speed(const struct sph_material *material, bool strength);

#endif
