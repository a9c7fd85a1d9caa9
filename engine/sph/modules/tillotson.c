/* Tillotson's equation of state (material/tillotson.h, modules/tillotson.h). Every body has it, directly or behind a
 * module that sets the pressure of the body from that of its solid matter.
 *
 *   material.density, material.tillotson.*   all needed */
#include <math.h>

#include "engine/sph/modules/ranges.h"

#define MATERIAL sph_tillotson_material
#define REQUIRED(member, unit, low, high, doc_, source_)                                                               \
  MATERIAL_REAL(tillotson.member, member, unit, NAN, low, high, .flags = FIELD_REQUIRED, .doc = doc_,                  \
                .source = source_ "Melosh 1989, appendix II")

static const struct field material_rows[] = {
    REQUIRED(A, "Pa", 1, 1e15, "Tillotson's A: bulk modulus at rest.", "Tillotson 1962; "),
    REQUIRED(B, "Pa", 0, 1e15, "Tillotson's B: quadratic term in compression.", ""),
    REQUIRED(a, "1", 0, 100,
             "Tillotson's a: Grueneisen coefficient of hot matter. 0, with b 0: pressure does not depend on energy.",
             ""),
    REQUIRED(b, "1", 0, 100, "Tillotson's b: a + b is the Grueneisen coefficient at rest.", ""),
    REQUIRED(alpha, "1", 0, 1e3, "Tillotson's alpha: decay in hot expansion.", ""),
    REQUIRED(beta, "1", 0, 1e3, "Tillotson's beta: decay in hot expansion.", ""),
    REQUIRED(E0, "J/kg", 1e-3, 1e15, "Tillotson's reference energy.", ""),
    REQUIRED(E_iv, "J/kg", 1e-3, 1e15, "Energy of incipient vaporisation.", ""),
    REQUIRED(E_cv, "J/kg", 1e-3, 1e15, "Energy of complete vaporisation, above E_iv.", ""),
};
const struct field_table sph_tillotson_material = SPH_MODULE_TABLE(sph_tillotson_material, material_rows);

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
