/* Tillotson: derivatives against finite differences over all branches, continuity across them, known traps. */
#include "tests/support/sph_case.h"

#include "engine/sph/material/material.h"

static const double basalt_density = 2700;
static const struct sph_tillotson_material basalt = {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7};

static void expect_near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want) + 1e-300))
    fail_msg("%s: got %.17g, expected %.17g", what, got, want);
}

/* Materials of the papers, each for a place of its own in the space of parameters: rock, metal, ice, a plastic. */
static const struct {
  const char *name;
  double density;
  struct sph_tillotson_material t;
} materials[] = {
    {"basalt", 2700, {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7}},
    {"nylon", 1185, {1.01e10, 3.38e10, 0.6, 2.0, 10, 5, 7e6, 2e6, 2.4e6}},
    {"ice", 917, {9.47e9, 9.47e9, 0.3, 0.1, 10, 5, 1e7, 7.73e5, 3.04e6}},
    {"gabbro", 2940, {7.1e10, 7.5e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7}},
    {"iron", 7800, {1.28e11, 1.05e11, 0.5, 1.5, 5, 5, 9.5e6, 2.4e6, 8.67e6}},
    {"aluminium", 2700, {7.52e10, 6.5e10, 0.5, 1.63, 5, 5, 5e6, 3e6, 1.39e7}},
    {"polycarbonate", 1194, {9.2e9, 6.9e9, 0.5, 1.0, 5, 5, 2e6, 2.8e5, 1.3e6}},
    {"granite", 2680, {1.8e10, 1.8e10, 0.5, 1.3, 5, 5, 1.6e7, 3.5e6, 1.8e7}},
};
enum { MATERIALS = sizeof materials / sizeof *materials };

/* The equation of state written again from the papers, in long double, for differences that cost no digits. */
static long double pressure_again(const struct sph_tillotson_material *t, long double rho0, long double rho,
                                  long double u) {
  long double eta = rho / rho0, mu = eta - 1, z = 1 / eta - 1;
  long double squeezed = (t->a + t->b / (u / (t->E0 * eta * eta) + 1)) * rho * u + t->A * mu +
                         (mu > 0 ? t->B * mu * mu : 0);
  long double hot = t->a * rho * u + (t->b * rho * u / (u / (t->E0 * eta * eta) + 1) + t->A * mu * expl(-t->beta * z)) *
                                         expl(-t->alpha * z * z);
  if (rho >= rho0 || u <= t->E_iv)
    return squeezed;
  if (u >= t->E_cv)
    return hot;
  return (squeezed * (t->E_cv - u) + hot * (u - t->E_iv)) / (t->E_cv - t->E_iv);
}

/* Derivatives against central differences of the formula written again in long double. A relative step of 1e-6 loses
 * about (step * exponent)^2 = 1e-9 to truncation (the steepest term is exp(-alpha z^2) with alpha z^2 up to 80 here)
 * and 1e-13 to rounding; 1e-7 of the size of the terms covers that and is far below any wrong term. No step straddles
 * E_iv, E_cv or rho0, where the derivatives jump: that each case stays on one branch is checked. */
TEST(derivatives) {
  const double densities[] = {0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.95, 0.999, 1.001, 1.05, 1.2, 2, 4, 10, 100};
  int branch_seen[4] = {0}; /* compressed, cold, mixed, hot */
  for (int k = 0; k < MATERIALS; k++) {
    const struct sph_tillotson_material *t = &materials[k].t;
    double rho0 = materials[k].density;
    const double energies[] = {0.01 * t->E_iv,
                               0.5 * t->E_iv,
                               0.99 * t->E_iv,
                               0.9 * t->E_iv + 0.1 * t->E_cv,
                               0.5 * t->E_iv + 0.5 * t->E_cv,
                               0.01 * t->E_iv + 0.99 * t->E_cv,
                               1.01 * t->E_cv,
                               3 * t->E_cv,
                               1e3 * t->E_cv};
    for (size_t r = 0; r < sizeof densities / sizeof *densities; r++)
      for (size_t e = 0; e < sizeof energies / sizeof *energies; e++) {
        double rho = densities[r] * rho0, u = energies[e];
        long double dr = rho * 1e-6L, du = u * 1e-6L;
        assert_true((rho - (double)dr - rho0) * (rho + (double)dr - rho0) > 0);
        assert_true((u - (double)du - t->E_iv) * (u + (double)du - t->E_iv) > 0);
        assert_true((u - (double)du - t->E_cv) * (u + (double)du - t->E_cv) > 0);
        branch_seen[rho > rho0 ? 0 : u < t->E_iv ? 1 : u < t->E_cv ? 2 : 3]++;
        struct sph_pressure p = sph_tillotson(t, rho0, rho, u);
        long double by_rho = (pressure_again(t, rho0, rho + dr, u) - pressure_again(t, rho0, rho - dr, u)) / (2 * dr);
        long double by_u = (pressure_again(t, rho0, rho, u + du) - pressure_again(t, rho0, rho, u - du)) / (2 * du);
        double scale = t->A / rho0 + u; /* where terms cancel, compare with the size of the terms */
        if (fabs(p.pressure - (double)pressure_again(t, rho0, rho, u)) >
            1e-13 * (rho * u + t->A * (1 + densities[r] * densities[r])))
          fail_msg("%s: P at eta %g, u %g: %.15g", materials[k].name, densities[r], u, p.pressure);
        if (fabs(p.by_density - (double)by_rho) > 1e-7 * (fabs((double)by_rho) + scale))
          fail_msg("%s: dP/drho at eta %g, u %g: %.12g against %.12Lg", materials[k].name, densities[r], u,
                   p.by_density, by_rho);
        if (fabs(p.by_energy - (double)by_u) > 1e-7 * (fabs((double)by_u) + rho))
          fail_msg("%s: dP/du at eta %g, u %g: %.12g against %.12Lg", materials[k].name, densities[r], u, p.by_energy,
                   by_u);
        double c2 = (double)(by_rho + p.pressure / (rho * rho) * by_u), low = t->A / (4 * rho0);
        expect_near(p.sound_speed, sqrt(c2 > low ? c2 : low), 1e-6, "sound speed");
      }
  }
  for (int b = 0; b < 4; b++)
    assert_true(branch_seen[b] >= 60);
}

/* From nearly zero to a hundred times the density, and beyond any energy that 70 km/s can produce: finite, c above its
 * floor, and the loops of all CPU classes give what the formula gives. */
TEST(extremes) {
  enum { SIDE = 8 };
  const double etas[SIDE] = {1e-12, 1e-6, 1e-3, 0.01, 0.1, 1, 10, 100},
               energies[SIDE] = {-1e12, -1, -0.0, 0, 1e-300, 1, 2.45e9, 1e12};
  static const char *const classes[] = {"baseline", "v3", "v4"};
  const struct case_block block = {.count = {SIDE, SIDE, 1}, .spacing = 1e-3};
  const struct case_parameters parameters = case_parameters_default();
  for (int k = 0; k < MATERIALS; k++) {
    const struct sph_tillotson_material *t = &materials[k].t;
    double rho0 = materials[k].density;
    for (size_t r = 0; r < SIDE; r++)
      for (size_t e = 0; e < SIDE; e++) {
        double rho = etas[r] * rho0;
        struct sph_pressure p = sph_tillotson(t, rho0, rho, energies[e]);
        if (!isfinite(p.pressure) || !isfinite(p.by_density) || !isfinite(p.by_energy) || !isfinite(p.sound_speed))
          fail_msg("%s: not finite at eta %g, u %g", materials[k].name, etas[r], energies[e]);
        assert_true(p.sound_speed >= sqrt(t->A / (4 * rho0)) * (1 - 1e-15));
      }
    struct sph_body_physics body = {.material = case_basalt};
    body.material.tillotson = *t;
    body.material.density = rho0;
    SPH_PARTICLES *particles = case_make(&block, 1, rho0, 1.2, 0);
    for (int which = 0; which < 3; which++) {
      assert_int_equal(setenv("CLAST_CPU", classes[which], 1), 0);
      SPH_SYSTEM *s = case_system(particles, 1, &body, &parameters);
      for (size_t i = 0; i < s->n; i++)
        s->c.density[i] = etas[i / SIDE] * rho0, s->c.energy[i] = energies[i % SIDE];
      CASE_LOOPS(s, true, {SPH_MODULE_tillotson, SPH_RESPOND});
      for (size_t i = 0; i < s->n; i++) {
        const double rho = s->c.density[i], u = fmax(s->c.energy[i], 0), eta = rho / rho0;
        const struct sph_pressure p = sph_tillotson(t, rho0, rho, s->c.energy[i]);
        const double terms = (t->a + t->b) * rho * u + t->A * (1 + eta) +
                             t->B * (1 + eta * eta); /* mu is rounded as eta is */
        /* products in another order, some of them fused: a few roundings of the terms */
        if (!(fabs(s->c.pressure[i] - p.pressure) <= 4e-15 * terms) ||
            !(fabs(s->c.sound_speed[i] / p.sound_speed - 1) < 1e-14))
          fail_msg("%s, %s: eta %g, u %g: P %.17g, not %.17g; c %.17g, not %.17g", classes[which], materials[k].name,
                   eta, u, s->c.pressure[i], p.pressure, s->c.sound_speed[i], p.sound_speed);
      }
    }
  }
  unsetenv("CLAST_CPU");
}

/* P is continuous in u at E_iv and E_cv and in rho at rho0, at any energy. The jump over a relative step of 2e-12 is
 * bounded by the slope: |dP/dlnu| and |dP/dlnrho| stay below 10 (A + rho u), hence 1e-10 of that; a wrong weight jumps
 * by parts of it. */
TEST(continuous) {
  const double step = 1e-12;
  for (int k = 0; k < MATERIALS; k++) {
    const struct sph_tillotson_material *t = &materials[k].t;
    double rho0 = materials[k].density;
    for (double eta = 0.1; eta < 1; eta += 0.0899)
      for (int e = 0; e < 2; e++) {
        double u = e ? t->E_cv : t->E_iv, rho = eta * rho0;
        double below = sph_tillotson(t, rho0, rho, u * (1 - step)).pressure;
        double above = sph_tillotson(t, rho0, rho, u * (1 + step)).pressure;
        assert_true(fabs(above - below) < 1e-10 * (t->A + rho * u));
      }
    for (double u = 0; u < 3 * t->E_cv; u += 0.0371 * t->E_cv) {
      double below = sph_tillotson(t, rho0, rho0 * (1 - step), u).pressure;
      double above = sph_tillotson(t, rho0, rho0 * (1 + step), u).pressure;
      assert_true(fabs(above - below) < 1e-10 * (t->A + rho0 * u));
    }
  }
}

TEST(known_values) {
  /* at rest: no pressure, c = sqrt(A/rho0) */
  struct sph_pressure rest = sph_tillotson(&basalt, basalt_density, basalt_density, 0);
  expect_near(rest.sound_speed, sqrt(2.67e10 / 2700), 1e-14, "sound speed at rest");
  assert_true(rest.pressure == 0);
  /* by hand: eta = 1.1, u = 1e6: e = 4.87e8*1.21, (0.5 + 1.5/(1e6/e + 1))*2970*1e6 + 2.67e10*0.1 + 2.67e10*0.01 */
  double e = 4.87e8 * 1.21;
  expect_near(sph_tillotson(&basalt, basalt_density, 2970, 1e6).pressure,
              (0.5 + 1.5 / (1e6 / e + 1)) * 2970 * 1e6 + 2.67e9 + 2.67e8, 1e-14, "compressed");
  /* cold tension is linear: no B below rho0, so dP/drho never turns negative */
  for (double eta = 0.05; eta < 1; eta += 0.05)
    assert_true(sph_tillotson(&basalt, basalt_density, eta * basalt_density, 0).by_density > 0);
  /* negative energy is treated as zero: the pole at -E0 eta^2 cannot be reached */
  struct sph_pressure cold = sph_tillotson(&basalt, basalt_density, 2000, -basalt.E0 * 4 / 7.29);
  assert_true(cold.pressure == sph_tillotson(&basalt, basalt_density, 2000, 0).pressure);
  assert_true(isfinite(cold.sound_speed) && cold.sound_speed > 0);
}
