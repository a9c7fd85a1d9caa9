/* Values of a solid that the equation of state, strength and fracture need. The modules that are on decide which of
 * them a scene needs; a value that is not given is NaN, and the module that needs it refuses it.
 *
 * A value or a choice that one module needs is a member of its struct and a row of its table (modules/declarations.h);
 * values that several modules read are here, and their rows in material.c. The documents of
 * engine/sph/material/builtin/ are read through the rows, and each body of a scene has them as inputs
 * (scene/inputs.c), there with the named material's values as defaults.
 *
 * The default of a number is NAN: a material gives it (FIELD_REQUIRED), or it is off unless given (FIELD_MAY_BE_OFF).
 * `.when` says which bodies use it: "../strength=true", "../fracture=auto|on", or a choice of the material. The first
 * word of a choice is the default, and no value counts with it; its label is what messages call it. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "engine/engine.h"
#include "engine/sph/modules/structs.h"

struct sph_material {
  double density;     /* kg/m^3 at rest */
  double melt_energy; /* J/kg, NaN: yield does not depend on u */
#define MODULE_MATERIAL(name) struct sph_##name##_material name;
#include "engine/sph/modules/declarations.h"
};

/* Rows; the including file defines MATERIAL, the name of the struct (schemas/rows.h). */
#define MATERIAL_REAL(path_, member_, ...) REAL_OF(MATERIAL, path_, member_, __VA_ARGS__)
#define MATERIAL_CHOICE(path_, member_, choices_, ...)                                                                 \
  ROW_OF(MATERIAL, path_, member_, FIELD_CHOICE, NULL, .choices = choices_, __VA_ARGS__)

/* Moduli, speeds and densities that follow from a material's values. */

double sph_material_bulk_modulus(const struct sph_material *material);  /* Pa, K; tillotson.A unless it is given */
double sph_material_young_modulus(const struct sph_material *material); /* Pa, 9 K mu/(3 K + mu) */
double sph_material_poisson_ratio(const struct sph_material *material);
double sph_material_crack_speed(const struct sph_material *material);  /* m/s, c_g = 0.4 sqrt((K + 4 mu/3)/rho_0) */
double sph_material_solid_ratio(const struct sph_material *material);  /* density of the solid over that of the body */
double sph_material_bulk_density(const struct sph_material *material); /* kg/m^3 of a body at rest */
/* m/s, longitudinal, of a body at rest. */
double sph_material_longitudinal_speed(const struct sph_material *material, bool strength);

/* Growth of damage from active flaws. Grady & Kipp 1980; Benz & Asphaug 1994, 1995 sections 3 and 4.3 [BA95].
 *
 * The state is D^(1/3): while the number of active flaws n stays, it grows at the constant rate n^p c_g / R_s, which is
 * integrated exactly. D never heals: when the cap drops below D, D stays. n is that of the strain of this step (not
 * latched). */

/* p = 1 as printed in BA95 section 4.3, or 1/3 as SPH codes do today: that one gives Grady & Kipp's rate law. */
enum sph_fracture_growth { SPH_GROWTH_CUBE_ROOT, SPH_GROWTH_LINEAR, SPH_GROWTHS };
/* D_max: (n/n_tot)^(1/3) as printed in BA95 eq. 22, n/n_tot, or 1. */
enum sph_fracture_cap { SPH_CAP_BA95, SPH_CAP_COUNT, SPH_CAP_NONE, SPH_CAPS };

/* Largest principal value of a symmetric tensor. */
double sph_material_largest_tension(double xx, double xy, double xz, double yy, double yz, double zz);

/* Rate of D^(1/3) in units of c_g/R_s, and the cube root of D_max, while `active` of `total` flaws are open. */
double sph_material_damage_rate(size_t active, int growth);
double sph_material_damage_cap(size_t active, size_t total, int cap);

/* Tillotson equation of state, pressure and sound speed. Melosh 1989; Benz & Asphaug 1994.
 *
 * eta = rho/rho0, mu = eta - 1, w = u/(E0 eta^2) + 1:
 *   compressed or cold (rho >= rho0 or u <= E_iv):  P_c = (a + b/w) rho u + A mu + B mu^2, with B = 0 for eta < 1
 *     (with B, dP/drho < 0 below eta = 1 - A/(2B));
 *   hot, expanded (rho < rho0, u >= E_cv):
 *     P_e = a rho u + (b rho u/w + A mu exp(-beta (1/eta-1))) exp(-alpha (1/eta-1)^2);
 *   between: both at the actual u, with weights linear in u, so that P is continuous.
 * c^2 = dP/drho + (P/rho^2) dP/du, at least A/(4 rho0). c jumps at E_iv and E_cv, as the model says. */

struct sph_pressure {
  double pressure;    /* Pa */
  double by_density;  /* dP/drho at constant u, m^2/s^2 */
  double by_energy;   /* dP/du at constant rho, kg/m^3 */
  double sound_speed; /* m/s, bulk */
};

/* u < 0 is evaluated at u = 0 (the pole is at -E0 eta^2). The step holds u at 0, too, and the ledger counts that. */
struct sph_pressure sph_tillotson(const struct sph_tillotson_material *t, double density0, double density, double u);

/* Named materials: documents with their sources, kept in engine/sph/material/builtin/ and compiled into the program. A
 * scene selects one by name (target.material.name), and its values become the defaults of that body's material inputs.
 */

extern const struct field_table sph_materials_nested; /* describes struct sph_material; a body of a scene contains it */
extern struct field_table sph_materials_table;        /* the same, flat; constant once main() begins */
extern const struct engine_materials sph_materials;   /* the functions below, for `clast materials` */

/* The row of a member of struct sph_material, by its offset. */
size_t sph_materials_row(size_t offset);
const char *sph_materials_name(size_t index);     /* sorted; NULL behind the last one */
const char *sph_materials_text(const char *name); /* the document, or NULL */
/* STATUS_MISSING with the nearest name; STATUS_CONTENT with the report when the document has a fault. */
status sph_materials_load(const char *name, void *out, struct error *error);
/* The same from the text of a document. */
status sph_materials_parse(const char *name, const char *text, struct sph_material *out, struct error *error);

/* Values that may be off and must be given all the same, at least as off: without a yield stress a body is elastic at
 * any stress. */
bool sph_materials_must_give(const char *path);
/* Where a value of a named material comes from, by the document's `sources` (the value's or its section's), else its
 * `source`. STATUS_MISSING: the document does not say. */
status sph_materials_source(const char *name, const char *path, char source[FIELD_TEXT_SIZE]);
