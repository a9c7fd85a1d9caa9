/* Rock under pressure against the exact yield surface: triaxial cells from 0 to 5 GPa, intact, half broken and broken;
 * thermal softening; the effect of damage on the stress, the stress that opens flaws, and pores.
 *
 * A cell is a block of held particles at one density. It is compressed along x and expands along y and z at constant
 * volume to first order. With the gradient correction every particle has the exact velocity gradient, so each is a
 * triaxial test of its own. */
#include "tests/support/sph_case.h"

#include "engine/sph/material/material.h"

static const double spacing = 1e-3, rate = 1e5, time_step = 2e-9;

static struct sph_material rock(void) {
  struct sph_material m = case_basalt;
  m.pressure_strength = (struct sph_pressure_strength_material){SPH_PRESSURE_STRENGTH_LUNDBORG, 90e6, 2, 1.5e9, 0, 0.8};
  m.yield.stress = 1; /* must not be read */
  m.melt_energy = NAN;
  return m;
}

/* The published law, written independently: the bound of sqrt(J2). */
static double bound(const struct sph_material *m, double pressure, double damage, double energy) {
  const struct sph_pressure_strength_material *k = &m->pressure_strength;
  const double p = fmax(pressure, 0), friction = k->intact_friction * p;
  const double intact = k->intact_cohesion + friction / (1 + friction / (k->intact_limit - k->intact_cohesion));
  const double broken = fmin(k->broken_cohesion + k->broken_friction * p, intact);
  const double soft = isnan(m->melt_energy) ? 1 : fmax(1 - energy / m->melt_energy, 0);
  return ((1 - damage) * intact + damage * broken) * soft;
}

static double density_at(const struct sph_material *m, double pressure, double energy) {
  double low = 0.9 * m->density, high = 1.5 * m->density;
  for (int k = 0; k < 100; k++) {
    const double middle = (low + high) / 2;
    if (sph_tillotson(&m->tillotson, m->density, middle, energy).pressure < pressure)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Held particles at this pressure, damage and energy, under axial load; flaws too strong to open unless `volume` (m^3)
 * is that of the body. */
static struct sph_system *cell(const struct sph_material *m, double pressure, double damage, double energy,
                               double volume, struct sph_particles **out) {
  const struct case_block block = {{6, 6, 6}, {-3 * spacing, -3 * spacing, -3 * spacing}, {0, 0, 0}, spacing};
  struct sph_particles *p = case_make(&block, 1, density_at(m, pressure, energy), 1.21,
                                      SPH_WITH_STRESS | SPH_WITH_DAMAGE | SPH_WITH_HELD);
  for (size_t i = 0; i < p->n; i++) {
    p->held[i] = SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z;
    p->vx[i] = -rate * p->x[i];
    p->vy[i] = rate / 2 * p->y[i];
    p->vz[i] = rate / 2 * p->z[i];
    p->energy[i] = energy;
    p->damage_cbrt[i] = cbrt(damage);
  }
  struct sph_flaws *flaws = case_flaws(p->n, volume, 1, 0);
  const struct sph_body_physics body = {.material = *m, .strength = true, .flaws = flaws};
  struct case_parameters parameters = case_parameters_default();
  parameters.in.gradient_correction.on = true;
  parameters.in.viscosity.alpha = parameters.in.viscosity.beta = 0;
  parameters.domain.largest_time_step = time_step;
  struct sph_system *s = case_system(p, 1, &body, &parameters);
  sph_flaws_free(flaws);
  *out = p;
  return s;
}

static double root_of_J2(const struct sph_particles *p, size_t i) {
  double sum = 0;
  for (int k = 0; k < 6; k++)
    sum += (k == 0 || k == 3 || k == 5 ? 0.5 : 1) * p->stress[k][i] * p->stress[k][i];
  return sqrt(sum);
}

/* Loads a cell until it yields everywhere. Returns the largest miss of sqrt(J2), Pa. */
static double load(const struct sph_material *m, double pressure, double damage, double energy, double *bears) {
  SPH_PARTICLES *p = NULL;
  SPH_SYSTEM *s = cell(m, pressure, damage, energy, 1e-30, &p);
  double miss = 0;
  case_run(s, 6e-7); /* 6 %: 1.5 GPa are reached at 1.5 GPa/(sqrt(3) mu) = 3.8 % */
  sph_system_read(s, p);
  for (size_t i = 0; i < p->n; i++) {
    const double want = bound(m, p->pressure[i], damage, p->energy[i]);
    miss = fmax(miss, fabs(root_of_J2(p, i) - want));
    assert_true(fabs(pow(p->damage_cbrt[i], 3) - damage) < 1e-15);
  }
  *bears = root_of_J2(p, p->n / 2);
  return miss;
}

/* The stress that is read has returned to Y and then got half the change of its rate in the step. The rate is 2 mu
 * times the velocity gradient, which grows by its square times dt: mu (rate dt)^2 per component, 3 of them at most. The
 * energy that is read differs by as small a share of a step's heating: 1e-8 of u_melt, and less in Y. */
static double arithmetic(void) {
  return 3 * case_basalt.elastic.shear_modulus * pow(rate * time_step / (1 - 0.06), 2);
}

TEST(triaxial_cell) {
  static const double pressures[] = {0, 20e6, 100e6, 300e6, 1e9, 2e9, 5e9};
  const struct sph_material m = rock();
  double worst = 0;
  for (size_t k = 0; k < sizeof pressures / sizeof *pressures; k++) {
    double bears[3], miss[3];
    for (int d = 0; d < 3; d++) {
      miss[d] = load(&m, pressures[k], 0.5 * d, 0, &bears[d]);
      worst = fmax(worst, miss[d]);
    }
    print_message("%5.0f MPa: sqrt(J2) %7.1f intact, %7.1f half, %7.1f MPa broken; off by at most %.2g kPa\n",
                  pressures[k] / 1e6, bears[0] / 1e6, bears[1] / 1e6, bears[2] / 1e6,
                  fmax(miss[0], fmax(miss[1], miss[2])) / 1e3);
    assert_true(bears[2] <= bears[0] + arithmetic()); /* Y_d <= Y_i: binds from 1.23 GPa on */
    assert_true(bears[0] < 1.5e9 + arithmetic());
  }
  print_message("worst %.3g kPa of %.3g\n", worst / 1e3, arithmetic() / 1e3);
  assert_true(worst < arithmetic());
}

/* P < 0 counts as 0; cohesion of broken rock; friction 0 leaves nothing. */
TEST(without_pressure) {
  struct sph_material m = rock();
  double bears;
  assert_true(load(&m, -2e8, 0, 0, &bears) < arithmetic()); /* 6 % raise P by K 3/4 e^2 = 72 MPa: it stays below 0 */
  assert_true(fabs(bears - 90e6) < arithmetic());
  assert_true(load(&m, -2e8, 1, 0, &bears) < arithmetic());
  assert_true(bears < arithmetic());
  m.pressure_strength.broken_cohesion = 10e6;
  assert_true(load(&m, -2e8, 1, 0, &bears) < arithmetic());
  assert_true(fabs(bears - 10e6) < arithmetic());
  m.pressure_strength.broken_friction = m.pressure_strength.broken_cohesion = 0;
  assert_true(load(&m, 1e9, 1, 0, &bears) < arithmetic());
  assert_true(bears < arithmetic());
}

TEST(softening) {
  struct sph_material m = rock();
  m.melt_energy = 1e5; /* low, so that the heat adds little to the pressure */
  for (int d = 0; d < 3; d++)
    for (int k = 0; k < 5; k++) { /* 0, 1/4, 1/2, 3/4 of u_melt and beyond */
      double bears;
      const double miss = load(&m, 3e8, 0.5 * d, k < 4 ? 0.25 * k * m.melt_energy : 1.2 * m.melt_energy, &bears);
      assert_true(miss < arithmetic());
      assert_true((bears < arithmetic()) == (k == 4));
    }
}

/* Intact rock without friction is von Mises' law with Y0 = sqrt(3) Y_0. */
TEST(von_mises) {
  struct sph_material m = rock(), plain = case_basalt;
  double stress[2][6];
  m.pressure_strength = (struct sph_pressure_strength_material){SPH_PRESSURE_STRENGTH_LUNDBORG, 2e8, 0, 1e9, 0, 0};
  plain.melt_energy = NAN;
  plain.yield.stress = sqrt(3.0) * 2e8;
  for (int k = 0; k < 2; k++) {
    SPH_PARTICLES *p = NULL;
    SPH_SYSTEM *s = cell(k ? &plain : &m, 5e8, 0, 0, 1e-30, &p);
    case_run(s, 6e-7);
    sph_system_read(s, p);
    for (int c = 0; c < 6; c++)
      stress[k][c] = p->stress[c][100];
  }
  for (int c = 0; c < 6; c++)
    assert_true(fabs(stress[0][c] - stress[1][c]) < 1e-12 * 2e8); /* 300 returns of the rounding 1e-16 */
}

/* With the law, damage reduces tension but not the deviator; without the law it reduces both. */
TEST(what_acts) {
  for (int law = 0; law < 2; law++)
    for (int tension = 0; tension < 2; tension++) {
      struct sph_material m = rock();
      m.pressure_strength.law = law;
      m.yield.stress = 1e9;
      SPH_PARTICLES *p = NULL;
      SPH_SYSTEM *s = cell(&m, tension ? -1e8 : 1e8, 0.75, 0, 1e-30, &p);
      case_steps(s, 1);
      for (size_t i = 0; i < s->n; i++) {
        /* one more rounding each for 1-D, 1/rho^2 and their product; the factor is that of the predicted density */
        const double square = pow(s->c.density[i], 2), left = law ? 1 : 0.25, of_pressure = tension ? 0.25 : 1;
        assert_true(fabs(s->c.stress_factor[i] * square / left - 1) < 1e-6);
        assert_true(fabs(-s->c.pressure_term[i] * square / (of_pressure * s->c.pressure[i]) - 1) < 1e-6);
      }
    }
}

/* Shear waves in broken rock are as fast as in whole rock, so the allowed time step is the same. */
TEST(waves_of_broken_rock) {
  double step[2][2];
  for (int law = 0; law < 2; law++)
    for (int broken = 0; broken < 2; broken++) {
      struct sph_material m = rock();
      m.pressure_strength.law = law;
      SPH_PARTICLES *p = NULL;
      SPH_SYSTEM *s = cell(&m, 1e8, broken, 0, 1e-30, &p);
      s->domain.largest_time_step = NAN;
      case_steps(s, 3);
      step[law][broken] = s->now.last_step;
    }
  /* h over c_L; c_L^2 = c^2 + 4/3 mu/rho, c^2 = (K/rho) to some per cent of pressure */
  const double faster = sqrt(1 + 4.0 / 3 * case_basalt.elastic.shear_modulus / case_basalt.tillotson.A);
  assert_true(fabs(step[1][1] / step[1][0] - 1) < 1e-3);
  assert_true(fabs(step[0][1] / step[0][0] / faster - 1) < 0.03);
}

/* E eps = lambda(S) - P with the law, lambda(S) - P/(1-D) without it where P > 0; lambda(S) - P in tension. */
TEST(strain_of_flaws) {
  static const double pressure[2] = {5e8, -1e7}, axial[2] = {6e8, 9e7}, expected[2] = {1e8, 1e8};
  for (int law = 0; law < 2; law++)
    for (int tension = 0; tension < 2; tension++) {
      struct sph_material m = rock();
      m.pressure_strength.law = law;
      m.yield.stress = 1e9;
      SPH_PARTICLES *p = NULL;
      SPH_SYSTEM *s = cell(&m, 1e8, 0.5, 0, 216 * pow(spacing, 3), &p);
      for (size_t i = 0; i < s->n; i++) {
        s->c.pressure[i] = pressure[tension];
        for (int k = 0; k < 5; k++)
          s->c.stress[k][i] = 0;
        s->c.stress[0][i] = axial[tension];
        s->c.stress[3][i] = -axial[tension] / 2;
      }
      CASE_LOOPS(s, true, {SPH_MODULE_fracture, SPH_CRACK});
      for (size_t i = 0; i < s->n; i++) {
        if (!law && !tension) {
          assert_true(s->c.damage_rate[i] == 0); /* 600 - 1000 MPa: closed */
          continue;
        }
        assert_true(s->c.open_from[i] <= expected[tension] * (1 + 1e-7)); /* lambda(S) to 1e-8 of S */
        assert_true(s->c.open_below[i] > expected[tension] * (1 - 1e-7));
        assert_true(s->c.damage_cap[i] > 0);
      }
    }
}

/* With pores the limit is that of the solid at the solid's pressure: sqrt(J2) <= Y(alpha P)/alpha of the body. */
TEST(pores) {
  struct sph_material m = rock();
  m.palpha = (struct sph_palpha_material){.distention = 1.5,
                                          .curve = SPH_CRUSH_QUADRATIC,
                                          .elastic_pressure = 5e6,
                                          .solid_pressure = 3e8,
                                          .sound_speed = 1800};
  const struct case_block block = {.count = {6, 6, 6}, .spacing = spacing};
  SPH_PARTICLES *p = case_make(&block, 1, 2700 / 1.5, 1.21, SPH_WITH_STRESS);
  const struct sph_body_physics body = {.material = m, .strength = true};
  const struct case_parameters parameters = case_parameters_default();
  SPH_SYSTEM *s = case_system(p, 1, &body, &parameters);
  for (size_t i = 0; i < s->n; i++) {
    s->c.distention[i] = 1.4;
    s->c.pressure[i] = 1e6 * (double)i;
    s->c.damage[i] = cbrt((double)(i % 5) / 4);
    s->c.stress[1][i] = 1e10;
  }
  CASE_LOOPS(s, true, {SPH_MODULE_palpha, SPH_PUBLISH}, {SPH_MODULE_pressure_strength, SPH_YIELD},
             {SPH_MODULE_palpha, SPH_YIELD_OF_BODY}, {SPH_MODULE_elastic, SPH_RETURN});
  for (size_t i = 0; i < s->n; i++) {
    const double want = bound(&m, 1.4 * s->c.pressure[i], (double)(i % 5) / 4, 0) / 1.4;
    assert_true(fabs(s->c.stress[1][i] - want) < 1e-13 * 1e9); /* rounding */
  }
}

/* On only where the material has the law, in the place of von Mises; a limit below the cohesion is refused. */
TEST(when_on) {
  struct sph_inputs inputs = case_parameters_default().in;
  struct sph_body_physics body = {.material = case_basalt, .strength = true};
  struct sph_module_set on = sph_modules_of(&body, &inputs);
  const struct sph_column_set columns = sph_modules_columns(&on, &body);
  assert_true(set_has(on.word, SPH_MODULE_yield) && !set_has(on.word, SPH_MODULE_pressure_strength));
  assert_false(set_has(columns.word, SPH_COLUMN(shear_damage)));
  body.material = rock();
  on = sph_modules_of(&body, &inputs);
  assert_true(!set_has(on.word, SPH_MODULE_yield) && set_has(on.word, SPH_MODULE_pressure_strength));
  body.strength = false;
  on = sph_modules_of(&body, &inputs);
  assert_false(set_has(on.word, SPH_MODULE_yield) || set_has(on.word, SPH_MODULE_pressure_strength));
  const struct sph_module *module = sph_modules_at(SPH_MODULE_pressure_strength);
  OK(module->check_material(&body.material, &error));
  body.material.pressure_strength.intact_limit = body.material.pressure_strength.intact_cohesion;
  assert_int_equal(module->check_material(&body.material, &error), STATUS_CONTENT);
}
