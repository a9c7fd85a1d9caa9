/* Tillotson's equation of state (material/tillotson.h, modules/tillotson.h). Every body has it, directly or behind a
 * module that sets the pressure of the body from that of its solid matter.
 *
 *   material.density, material.tillotson.*   all needed */
#include <math.h>

#include "engine/sph/modules/ranges.h"

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return true;
}

static status check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                    size_t last, struct error *error) {
  const struct sph_material *m = &body->material;
  const struct {
    const char *name;
    double value;
    bool may_be_zero;
  } needs[] = {
      {"density", m->density, false},
      {"tillotson.A", m->tillotson.A, false},
      {"tillotson.B", m->tillotson.B, true},
      {"tillotson.a", m->tillotson.a, true},
      {"tillotson.b", m->tillotson.b, true},
      {"tillotson.alpha", m->tillotson.alpha, true},
      {"tillotson.beta", m->tillotson.beta, true},
      {"tillotson.E0", m->tillotson.E0, false},
      {"tillotson.E_iv", m->tillotson.E_iv, false},
      {"tillotson.E_cv", m->tillotson.E_cv, false},
  };
  (void)particles, (void)first, (void)last;
  for (size_t k = 0; k < sizeof needs / sizeof *needs; k++) {
    const double v = needs[k].value;
    if (!(isfinite(v) && (v > 0 || (needs[k].may_be_zero && v == 0))))
      return status_fail(error, STATUS_CONTENT, "%s is %g; its physics needs a number %s", needs[k].name, v,
                         needs[k].may_be_zero ? "not below 0" : "above 0");
  }
  return STATUS_OK;
}

const struct sph_module sph_tillotson_module = {
    .name = "tillotson",
    .doc = "Pressure and sound speed of rock, ice or metal from the cold solid to its vapour; no pressure-squared term "
           "in tension.",
    .source = "Tillotson 1962; Melosh 1989, appendix II",
    .when = "every body but those whose pressure another module makes from that of the solid",
    .on = on,
    .sets = SPH_SETS_PRESSURE,
    .check = check,
};
