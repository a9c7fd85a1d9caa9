/* Inputs and materials of engine sph: tables, defaults from a named material, refusals and their remedies. */

#include "engine/builtin.h"
#include "engine/scene.h"
#include "engine/sph/material/material.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/scene/inputs.h"
#include "schemas/document.h"
#include "tests/support/check.h"

static void complete(void *inputs, const bool *given) {
  sph_inputs_complete(inputs, given);
}

struct read_scene {
  struct sph_inputs inputs;
  bool given[300];
  char report[2000];
  bool good;
};

static struct read_scene read_text(const char *text) {
  struct read_scene r = {0};
  struct document *document;
  const char *report = NULL;
  field_defaults(&sph_inputs, &r.inputs);
  OK(document_parse("scene", text, strlen(text), &document, &error));
  assert_true(sph_inputs.count < sizeof r.given / sizeof r.given[0]);
  r.good = document_read_given(document_root(document), &sph_inputs, NULL, &r.inputs, r.given, complete);
  document_finish(document, &report);
  snprintf(r.report, sizeof r.report, "%s", report ? report : "");
  document_free(document);
  return r;
}

static struct sph_inputs good(const char *text) {
  struct read_scene r = read_text(text);
  if (!r.good)
    fail_msg("%s", r.report);
  return r.inputs;
}

static void refused(const char *text, const char *word) { /* by the conditions across fields */
  struct sph_inputs inputs = good(text);
  assert_int_equal(sph_inputs_check(&inputs, &error), STATUS_CONTENT);
  if (!strstr(error.message, word))
    fail_msg("no '%s' in: %s", word, error.message);
}

static void accepted(const char *text) {
  struct sph_inputs inputs = good(text);
  if (sph_inputs_check(&inputs, &error))
    fail_msg("%s: %s", text, error.message);
}

TEST(table_is_whole) {
  for (size_t i = 0; i < sph_inputs.count; i++) {
    const struct field *row = &sph_inputs.rows[i];
    assert_non_null(row->doc);
    assert_true(strlen(row->doc) > 10);
    assert_true(row->offset < sph_inputs.size);
    if (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER)
      assert_non_null(row->unit);
    for (size_t j = 0; j < i; j++) { /* no two rows have the same name or the same place */
      assert_string_not_equal(row->path, sph_inputs.rows[j].path);
      assert_true(row->offset != sph_inputs.rows[j].offset);
    }
  }
  struct sph_inputs inputs = good("kind: impact"); /* every default is in its own range once it has followed */
  for (size_t i = 0; i < sph_inputs.count; i++) {
    const struct field *row = &sph_inputs.rows[i];
    struct field_value value;
    field_get(row, &inputs, &value);
    if (field_is_active(&sph_inputs, row, &inputs) && !(row->flags & FIELD_MAY_BE_OFF && field_is_off(value.number)) &&
        field_set(row, &inputs, &value, &error))
      fail_msg("%s", error.message);
  }
  accepted("kind: impact");
}

TEST(every_material_is_sound) {
  for (size_t i = 0; i < 10 || sph_materials_name(i); i++) { /* there are ten or more */
    struct sph_material m;
    const char *name = sph_materials_name(i);
    OK(sph_materials_load(name, &m, &error));
    assert_non_null(strstr(sph_materials_text(name), "source: "));
    char key[100];
    snprintf(key, sizeof key, "\nmaterial: %s\n", name); /* the document says its own name */
    assert_non_null(strstr(sph_materials_text(name), key));
    double nu = sph_material_poisson_ratio(&m);
    assert_true(nu > 0 && nu < 0.5);
    assert_true(isnan(m.weibull.m) == isnan(m.weibull.k));
    /* A limit of tension is necessary, or the cold curve reaches -A: flaws or tension_limit. Rubber is elastic on
     * purpose. */
    assert_true(!isnan(m.weibull.m) || !isnan(m.tension_limit.pressure) || strcmp(name, "rubber") == 0);
    assert_true(m.palpha.curve == SPH_CRUSH_NONE || m.palpha.distention > 1);
  }
  struct sph_material basalt, granite, gabbro;
  assert_int_equal(sph_materials_load("basalt", &basalt, NULL), STATUS_OK);
  assert_int_equal(sph_materials_load("granite", &granite, NULL), STATUS_OK);
  assert_int_equal(sph_materials_load("gabbro", &gabbro, NULL), STATUS_OK);
  assert_true(basalt.density == 2700 && basalt.tillotson.E0 == 4.87e8 && basalt.weibull.m == 8.5 &&
              basalt.weibull.k == 5e34);
  /* Basalt: E 53.06 GPa, c_g 1837 m/s (Benz & Asphaug 1994). Granite has nu 0 without a bulk modulus of its own. */
  assert_true(fabs(sph_material_young_modulus(&basalt) / 53.06e9 - 1) < 1e-4);
  assert_true(fabs(sph_material_crack_speed(&basalt) / 1837 - 1) < 1e-3);
  assert_true(sph_material_poisson_ratio(&granite) > 0.2);
  assert_true(gabbro.weibull.k == 1.39e18); /* the paper's 1.39e12 is per cm^3 */
  struct sph_material m;
  assert_int_equal(sph_materials_load("basalr", &m, &error), STATUS_MISSING);
  assert_non_null(strstr(error.message, "'basalt'"));
  assert_int_equal(sph_materials_parse("mine", "density: 3 g/cm^3\n", &m, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "tillotson.A"));
}

TEST(a_name_gives_the_values) {
  struct sph_inputs in = good("kind: impact"), ice;
  assert_string_equal(in.target.material_name, "basalt");
  assert_string_equal(in.projectile.material_name, "nylon");
  assert_true(in.target.material.density == 2700 && in.projectile.material.density == 1185);
  assert_true(isnan(in.projectile.material.weibull.m) && !sph_derived_cracks(&in.projectile) &&
              sph_derived_cracks(&in.target));

  in = good("target: {material: {name: ice, weibull: {m: 7}}}"); /* given values stay, the others are ice's */
  assert_true(in.target.material.density == 917 && in.target.material.weibull.m == 7 &&
              in.target.material.weibull.k == 1.4e38);

  /* The name set later, as a sweep axis does: all values that were not given follow, times and strengths too. */
  struct read_scene r = read_text("target: {radius: 5 cm, material: {weibull: {m: 7}}}");
  double crossing = sph_derived_crossing(&r.inputs), end = r.inputs.stop.end_time;
  const struct field *row = field_find(&sph_inputs, "target.material.name", NULL);
  struct field_value value = {.kind = FIELD_TEXT};
  strcpy(value.text, "ice");
  assert_int_equal(field_set(row, &r.inputs, &value, NULL), STATUS_OK);
  r.given[row - sph_inputs.rows] = true;
  complete(&r.inputs, r.given);
  ice = good("target: {radius: 5 cm, material: {name: ice, weibull: {m: 7}}}");
  assert_true(sph_derived_crossing(&r.inputs) > crossing && r.inputs.stop.end_time > end);
  OWNED char *a = field_identity(&sph_inputs, &r.inputs), *b = field_identity(&sph_inputs, &ice);
  assert_string_equal(a, b);
  assert_non_null(strstr(a, "target.material.tillotson.E0=0x")); /* the values are in the identity, not only the name */

  in = good("target: {material: {name: custom, density: 1000 kg/m^3}}");
  assert_true(in.target.material.density == 1000 && isnan(in.target.material.tillotson.A));
}

/* Another material in place of a document's own one: none of its values stays, but those that overrides gave. */
TEST(another_material_drops_those_of_the_document) {
  static const char *const rows[] = {"target.material.density", "target.material.shear_modulus", "target.radius"};
  SCENE scene = NULL;
  if (scene_parse(
          "custom",
          "engine: sph\ntarget: {radius: 3 cm, material: {name: custom, density: 3 g/cm^3, shear_modulus: 20 GPa,\n"
          "  tillotson: {A: 20 GPa, B: 20 GPa, a: 0.5, b: 1.5, alpha: 5, beta: 5, E0: 5e8 J/kg, E_iv: 5e6 J/kg,\n"
          "  E_cv: 2e7 J/kg}, weibull: {m: 9, k: 1e35 1/m^3}, yield_stress: 3 GPa, melt_energy: off, tension_limit: "
          "off}}\n",
          &scene, &error))
    fail_msg("%s", error.message);
  OK(scene_set_text(scene, "target.material.shear_modulus", "2 GPa", &error));
  OK(scene_set_text(scene, "target.material.name", "ice", &error));
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    const struct field *row = field_find(scene->kind->inputs, rows[i], &error);
    assert_non_null(row);
    assert_int_equal(scene->given[row - scene->kind->inputs->rows], i > 0);
  }
}

/* The law of yield under pressure is in the identity only where it is on: a run without it keeps its identity. */
TEST(pressure_strength) {
  const struct sph_inputs off = good("kind: impact"),
                          named = good("target: {material: {pressure_strength: {law: none}}}"),
                          on = good("target: {material: {pressure_strength: {law: lundborg, broken_friction: 0}}}");
  char *without = field_identity(&sph_inputs, &off), *none = field_identity(&sph_inputs, &named),
       *with = field_identity(&sph_inputs, &on);
  assert_null(strstr(without, "pressure_strength"));
  assert_string_equal(without, none);
  assert_non_null(strstr(with, "target.material.pressure_strength.law=lundborg\n"));
  assert_non_null(strstr(with, "target.material.pressure_strength.broken_friction=0x0p+0\n"));
  assert_null(strstr(with, "projectile.material.pressure_strength"));
  free(without);
  free(none);
  free(with);
  const struct sph_pressure_strength_material *granite = &on.target.material.pressure_strength;
  assert_true(granite->intact_cohesion == 90e6 && granite->intact_friction == 2 && granite->intact_limit == 1.5e9);
  assert_true(granite->broken_cohesion == 0 && off.target.material.pressure_strength.broken_friction == 0.8);
  refused("target: {material: {pressure_strength: {law: lundborg, intact_limit: 90 MPa}}}",
          "not above intact_cohesion 9e+07 Pa: raise");
  accepted("target: {material: {pressure_strength: {law: lundborg}}}");
}

TEST(missing_values_are_named) {
  refused("target: {material: {name: custom, density: 1000 kg/m^3}}", "target.material.shear_modulus is needed");
  refused("target: {fracture: on, material: {name: aluminium}}",
          "target.material.weibull.m is needed because fracture is on, and the material 'aluminium' has none: give it, "
          "take it from another material (`like: granite` in a file), or set target.fracture: off");
  refused("target: {fracture: on, material: {name: aluminium, weibull: {m: 9}}}", "target.material.weibull.k");
  refused("target: {material: {name: aluminium, weibull: {m: 9}}}", "weibull.m is given without weibull.k");
  refused("target: {material: {shear_modulus: off}}", "target.strength: false");
  accepted("target: {fracture: on, material: {name: aluminium, weibull: {m: 9, k: 1e35 1/m^3}}}");
  accepted("target: {strength: false}\nprojectile: {strength: false}");
  refused("projectile: {material: {name: custom}}", "projectile.material.density");
  refused("target: {material: {tillotson: {E_cv: 1 MJ/kg}}}", "J/kg: raise E_cv");
  /* off means absent: its parameters are refused */
  assert_non_null(strstr(read_text("target: {strength: false, material: {yield_stress: 1 GPa}}").report,
                         "target.strength is true"));
  assert_non_null(
      strstr(read_text("target: {fracture: off}\nfracture: {growth: linear}").report, "target.fracture is auto or on"));
  assert_non_null(strstr(read_text("kind: stretch\nprojectile: {radius: 1 cm}").report, "kind is impact"));
  assert_non_null(strstr(read_text("target: {material: {density: 3 GPa}}").report, "kg/m^3"));
  assert_non_null(strstr(read_text("impact: {speed: 3 cm}").report, "m/s"));
}

TEST(what_cannot_be_run_is_refused) {
  refused("kind: stretch", "target.shape: cylinder");
  refused("target: {shape: cylinder, radius: 1 cm, inner_radius: 2 cm}", "smaller hole");
  refused("target: {shape: cylinder, radius: 2 cm, inner_radius: 1 cm}", "misses");
  refused("kind: piston", "target.shape: box");
  refused("{kind: piston, target: {shape: box}}", "target.strength: false");
  refused("{kind: piston, target: {shape: box, strength: false}, fidelity: {points: 10}}", "20 or more");
  refused("{kind: piston, target: {shape: box, strength: false}, sides: {far: damped}}", "sides.far: free");
  refused("{kind: piston, target: {shape: box, strength: false, turned: true}}", "target.turned: false");
  accepted("{kind: piston, target: {shape: box, strength: false}}");
  refused("{kind: collision, target: {shape: cylinder, radius: 1 cm, turned: true}}", "target.turned: false");
  accepted("{kind: collision, target: {shape: cylinder, radius: 1 cm}}");
  refused("impact: {projectile: mass, mass: 1e-12 kg}", "fidelity.projectile_spacing");
  refused("impact: {projectile: specific-energy, speed: 0}", "impact.speed 0");
  refused("impact: {speed: 1 km/s, gap: 1 m}\nstop: {end_time: 1 us}", "impact.gap");
  refused("impact: {speed: 1e-9 m/s}", "time steps");
  accepted("impact: {angle: 89.9 deg}");
  refused("method: {artificial_stress: 0.3}", "artificial_stress");
  refused("target: {shape: box, width: 2 cm}\nsides: {far: damped, depth: 1 cm}", "undamped");
  refused("target: {shape: box, spin: 300 rad/s}\nsides: {far: damped}\nmethod: {gradient_correction: true}",
          "sides.far: free");
  accepted("target: {shape: box, spin: 300 rad/s}\nsides: {far: free}\nmethod: {gradient_correction: true}");
  refused("kind: stretch\ntarget: {shape: cylinder, radius: 1 cm, length: 1 cm}\nfidelity: {particles: 20}",
          "stretch.grip");
  refused("fidelity: {projectile_spacing: 0.001}", "too many");
  refused("fidelity: {projectile_spacing: 0.001}",
          "raise fidelity.projectile_spacing"); /* a remedy that is valid for this protocol */
  refused("{kind: piston, target: {shape: box, strength: false}, fidelity: {points: 10000}}", "lower fidelity.points");
  refused("{kind: collision, target: {shape: cylinder, radius: 1 cm}, fidelity: {particles: 2e9}}",
          "lower fidelity.particles or target.length");
  refused("fidelity: {graded: true, fine_spacing: 1 cm}", "fine_spacing");
  refused("fidelity: {graded: true, spacings_per_radius: 0.9}", "spacings_per_radius");
  refused("fidelity: {graded: true, spacings_per_radius: 6, particles: 300}", "particles, not 300");
  accepted("fidelity: {graded: true, spacings_per_radius: 6, coarsest: 2.5, particles: 300}");
  accepted("impact: {speed: 0}");
  accepted("impact: {speed: 70 km/s}");
  accepted("target: {radius: 1e-6 m}\nprojectile: {radius: 1e-7 m}");
  accepted("target: {radius: 1e6 m}\nprojectile: {radius: 1e5 m}");
  for (double m = 1; m <= 200; m *= 1.9)
    for (double k = 0; k <= 200; k += 40) {
      char text[200];
      snprintf(text, sizeof text, "target: {material: {weibull: {m: %g, k: 1e%g 1/m^3}}}", m, k);
      accepted(text);
    }
}

TEST(sizes_follow) {
  struct sph_inputs in = good("impact: {projectile: mass, mass: 0.2 g}");
  assert_true(fabs(sph_derived_projectile_mass(&in) / 2e-4 - 1) < 1e-12);
  in = good("impact: {projectile: specific-energy, specific_energy: 3 kJ/kg, speed: 3.2 km/s}");
  double mass = 4.0 / 3 * M_PI * 2.7e-5 * 2700;
  assert_true(fabs(sph_derived_projectile_mass(&in) / (2 * 3000 * mass / (3200.0 * 3200)) - 1) < 1e-12);
  assert_true(fabs(sph_derived_specific_energy(&in) / 3000 - 1) < 1e-12);
  in = good("impact: {projectile: mass, mass: 0.2 g}\nfidelity: {graded: true, spacings_per_radius: 6}");
  assert_true(fabs(6 * in.fidelity.fine_spacing / cbrt(3 * 2e-4 / (4 * M_PI * 1185)) - 1) < 1e-12); /* nylon */
  assert_true(in.fidelity.fine_radius == 4 * in.fidelity.fine_spacing);
  in = good(
      "impact: {projectile: mass, mass: 0.2 g}\nfidelity: {graded: true, spacings_per_radius: 6, fine_spacing: 1 mm}");
  assert_true(in.fidelity.fine_spacing == 1e-3);
  /* weakest flaw of kV = 5e34 x 1.131e-4 at m = 8.5: E Gamma(1 + 1/8.5) (kV)^(-1/8.5) */
  assert_true(fabs(in.fragments.static_strength / (53.06e9 * tgamma(1 + 1 / 8.5) * pow(5e34 * mass / 2700, -1 / 8.5)) -
                   1) < 1e-4);
}

/* Pores: by distention or by fraction, as the material gives them or as the scene does; 1 is the solid. */
TEST(pores) {
  struct sph_inputs in = good("target: {material: {name: porous-ice}}");
  assert_true(in.target.material.palpha.distention == 1.5 && sph_material_solid_ratio(&in.target.material) == 1.5);
  assert_true(fabs(in.target.material.palpha.fraction - 1.0 / 3) < 1e-15);
  assert_true(fabs(sph_derived_density(&in.target) - 917 / 1.5) < 1e-12);
  assert_true(fabs(sph_derived_target_mass(&in) / (4.0 / 3 * M_PI * 2.7e-5 * 917 / 1.5) - 1) < 1e-12);
  accepted("target: {material: {name: porous-ice}}");
  in = good("target: {material: {name: porous-ice, porosity: {fraction: 0.6}}}");
  assert_true(fabs(in.target.material.palpha.distention - 2.5) < 1e-12);
  in = good("target: {material: {name: porous-ice, porosity: {distention: 2.5}}}");
  assert_true(fabs(in.target.material.palpha.fraction - 0.6) < 1e-12);
  accepted("target: {material: {name: porous-ice, porosity: {distention: 2.5}}}");
  refused("target: {material: {name: porous-ice, porosity: {distention: 2.5, fraction: 0.5}}}", "give one of the two");
  /* flaws are of the solid: at the same radius 2.5 times as many pores as matter change kV, and with it the static
   * strength */
  struct sph_inputs thin = good("target: {material: {name: porous-ice, porosity: {distention: 2.5}}}"),
                    whole = good("target: {material: {name: porous-ice, porosity: {distention: 1}}}");
  double kv = 1.4e38 * 4.0 / 3 * M_PI * 2.7e-5; /* ice's m is 9.6; E of the input's own moduli */
  double young = sph_material_young_modulus(&whole.target.material);
  assert_true(whole.target.material.weibull.k == 1.4e38 && whole.target.material.weibull.m == 9.6);
  assert_true(fabs(whole.fragments.static_strength / (young * tgamma(1 + 1 / 9.6) * pow(kv, -1 / 9.6)) - 1) <
              1e-12); /* logs of 90 */
  assert_true(fabs(thin.fragments.static_strength / (young * tgamma(1 + 1 / 9.6) * pow(kv / 2.5, -1 / 9.6)) - 1) <
              1e-12);
  in = good("target: {material: {name: porous-ice, porosity: {distention: 1}}}");
  assert_true(sph_material_solid_ratio(&in.target.material) == 1 && sph_derived_density(&in.target) == 917);
  accepted("target: {material: {name: porous-ice, porosity: {distention: 1}}}");
  in = good("projectile: {material: {name: pumice, porosity: {distention: 3}}}\nimpact: {projectile: mass, mass: 1 g}");
  assert_true(fabs(sph_derived_projectile_mass(&in) / 1e-3 - 1) < 1e-12 &&
              in.projectile.material.palpha.curve == SPH_CRUSH_TWO_POWER);
  refused("target: {material: {porosity: {curve: quadratic, distention: 1.5}}}",
          "target.material.porosity.elastic_pressure is needed by the crush curve, and the material 'basalt' has none: "
          "give it, take it from another material (`like: pumice` in a file), or set "
          "target.material.porosity.curve: none");
  refused("target: {material: {porosity: {curve: quadratic}}}",
          "target.material.porosity.distention (or porosity.fraction) is needed by the crush curve");
  accepted("target: {material: {porosity: {curve: quadratic, distention: 1.5, elastic_pressure: 1 MPa, solid_pressure: "
           "1 GPa}}}");
  refused("target: {material: {porosity: {curve: quadratic, distention: 1.5, elastic_pressure: 1 GPa, solid_pressure: "
          "1 MPa}}}",
          "target.material.porosity.solid_pressure is 1000000: it must be above elastic_pressure");
  refused("target: {material: {name: pumice, porosity: {distention: 5}}}", "elastic_distention");
  refused("target: {material: {name: porous-ice, porosity: {sound_speed: 5 km/s}}}", "porosity.sound_speed");
  /* off means absent */
  assert_non_null(strstr(read_text("target: {material: {porosity: {distention: 2}}}").report,
                         "porosity.curve is quadratic or two-power"));
  assert_non_null(
      strstr(read_text("target: {material: {name: porous-ice, porosity: {exponent_low: 2}}}").report, "two-power"));
  assert_non_null(
      strstr(read_text("target: {material: {name: porous-ice, porosity: {distention: 0.9}}}").report, "at least 1"));
  OWNED char *identity = field_identity(&sph_inputs, &in);
  assert_null(strstr(identity, "target.material.porosity.distention"));
}
