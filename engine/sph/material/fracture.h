/* Growth of damage from active flaws. Grady & Kipp 1980; Benz & Asphaug 1994, 1995 sections 3 and 4.3 [BA95].
 *
 * The state is D^(1/3): while the number of active flaws n stays, it grows at the constant rate n^p c_g / R_s, which is
 * integrated exactly. D never heals: when the cap drops below D, D stays. n is that of the strain of this step (not
 * latched). */
#ifndef CLAST_ENGINE_SPH_MATERIAL_FRACTURE_H
#define CLAST_ENGINE_SPH_MATERIAL_FRACTURE_H

#include <stddef.h>

/* p = 1 as printed in BA95 section 4.3, or 1/3 as SPH codes do today: that one gives Grady & Kipp's rate law. */
enum sph_fracture_growth { SPH_GROWTH_CUBE_ROOT, SPH_GROWTH_LINEAR, SPH_GROWTHS };
/* D_max: (n/n_tot)^(1/3) as printed in BA95 eq. 22, n/n_tot, or 1. */
enum sph_fracture_cap { SPH_CAP_BA95, SPH_CAP_COUNT, SPH_CAP_NONE, SPH_CAPS };

/* Largest principal value of a symmetric tensor. */
double sph_fracture_largest_tension(double xx, double xy, double xz, double yy, double yz, double zz);

/* Rate of D^(1/3) in units of c_g/R_s, and the cube root of D_max, while `active` of `total` flaws are open. */
double sph_fracture_rate(size_t active, int growth);
double sph_fracture_limit(size_t active, size_t total, int cap);

#endif
