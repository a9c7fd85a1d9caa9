/* Damage that grows from open flaws (material/fracture.h has the law, modules/fracture.h the loops, weibull.c the
 * flaws).
 *
 *   fracture.growth, fracture.cap   rate and largest damage with n open flaws
 *   fracture.crack_radius           R_s of the rate c_g/R_s
 *   fidelity.damage_step            largest change of D^(1/3) in a step */
#include <math.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/modules/ranges.h"
#include "engine/sph/modules/weibull_lists.h"

#define INPUTS sph_fracture_inputs

static const struct field input_rows[] = {
    INPUT_CHOICE(fracture.growth, growth,
                 FIELD_WORDS_HERE(SPH_GROWTHS, [SPH_GROWTH_CUBE_ROOT] = "cube-root", [SPH_GROWTH_LINEAR] = "linear"),
                 .when = "target.fracture=auto|on",
                 .choice_docs = "n^(1/3) c_g/R_s, which gives Grady and Kipp's rate law\nn c_g/R_s, as printed",
                 .doc = "Rate of D^(1/3) of a particle with n open flaws.", .source = "BA95 section 4.3 for `linear`"),
    INPUT_CHOICE(
        fracture.cap, cap,
        FIELD_WORDS_HERE(SPH_CAPS, [SPH_CAP_BA95] = "ba95", [SPH_CAP_COUNT] = "count", [SPH_CAP_NONE] = "none"),
        .when = "target.fracture=auto|on", .choice_docs = "(n/n_tot)^(1/3), as printed\nn/n_tot\n1",
        .doc = "Largest damage of a particle with n of its n_tot flaws open.", .source = "BA95 eq. 22 for `ba95`"),
    INPUT_CHOICE(
        fracture.crack_radius, crack_radius,
        FIELD_WORDS_HERE(SPH_CRACK_RADII, [SPH_CRACK_RADIUS_VOLUME] = "volume", [SPH_CRACK_RADIUS_SUPPORT] = "support"),
        .when = "target.fracture=auto|on",
        .choice_docs = "radius of the sphere of the particle's volume\n"
                       "2h: strength falls with R_s, and most of a body is destroyed where `volume` leaves a core",
        .doc = "R_s: length that a crack has to grow until its particle is broken.",
        .source = "BA95 eq. 15; the paper gives no value"),
    INPUT_REAL(fidelity.damage_step, damage_step, "1", 0.2, 1e-6, 1, .when = "target.fracture=auto|on",
               .doc = "Largest change of D^(1/3) in a time step."),
};
const struct field_table sph_fracture_inputs = SPH_MODULE_TABLE(sph_fracture_inputs, input_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->flaws != NULL;
}

static status check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                    size_t last, struct error *error) {
  (void)particles;
  if (!(body->strength && body->material.elastic.shear_modulus > 0))
    return status_fail(error, STATUS_CONTENT,
                       "flaws but no strength: only a solid cracks; set strength: true or fracture: off");
  if (body->flaws->particles != last - first)
    return status_fail(error, STATUS_CONTENT, "%zu particles, but flaws for %zu", last - first, body->flaws->particles);
  return STATUS_OK;
}

static void fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  const struct sph_weibull_lists *flaws = body->prepared[SPH_MODULE_weibull];
  const double young = sph_derived_young_modulus(&body->physics.material),
               crack_speed = sph_derived_crack_speed(&body->physics.material);
  for (size_t i = body->first; i < body->last; i++) {
    const double volume = p->mass[i] / p->density[i];
    const double radius = s->in.fracture.crack_radius == SPH_CRACK_RADIUS_SUPPORT ? 2 * p->h[i]
                                                                                  : cbrt(3 * volume / (4 * M_PI));
    s->c.damage[i] = p->damage_cbrt ? p->damage_cbrt[i] : 0;
    s->c.crack_rate[i] = crack_speed / radius;
    s->c.weakest[i] = young * sph_weibull_lowest(flaws, i - body->first);
  }
}

static const struct sph_column_need columns[] = {{SPH_COLUMNS_OF(damage), 0, NULL},
                                                 {SPH_COLUMNS_OF(damage_rate), 0, NULL},
                                                 {SPH_COLUMNS_OF(damage_cap), 0, NULL},
                                                 {SPH_COLUMNS_OF(weakest), INFINITY, NULL},
                                                 {SPH_COLUMNS_OF(open_from), 0, NULL},
                                                 {SPH_COLUMNS_OF(open_below), 0, NULL},
                                                 {SPH_COLUMNS_OF(open_rate), 0, NULL},
                                                 {SPH_COLUMNS_OF(crack_rate), 0, NULL},
                                                 {0}};

const struct sph_module sph_fracture_module = {
    .name = "fracture",
    .doc = "Damage grows from open flaws, D^(1/3) at n^p c_g/R_s up to its cap, and takes tension and shear away: "
           "(1-D) S (unless damage acts through the yield stress), and (1-D) P where P < 0. It never heals.",
    .source = "Grady & Kipp 1980; Benz & Asphaug 1995, sections 3 and 4.3",
    .when = "a body whose material has Weibull parameters",
    .on = on,
    .columns = columns,
    .check = check,
    .fill = fill,
};
