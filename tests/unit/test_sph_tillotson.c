/* Tillotson: derivatives against finite differences over all branches, continuity across them, known traps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "engine/sph/tillotson.h"

static const double basalt_density = 2700;
static const struct sph_tillotson basalt = {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6, 1.82e7};

static void expect_near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want) + 1e-300))
    fail_msg("%s: got %.17g, expected %.17g", what, got, want);
}

/* Central differences with step 1e-5 lose 1e-11 to truncation and about 1e-16/1e-5 to rounding: 1e-6 is ample, and far below
 * what a wrong term would change. The steps never straddle E_iv, E_cv or rho0, where the derivatives jump. */
static void derivatives(void **state) {
  (void)state;
  const double densities[] = {0.1, 0.5, 0.8, 0.95, 0.999, 1.001, 1.2, 2, 4};
  const double energies[] = {1e3, 1e5, 3e6, 4.6e6, 4.9e6, 1e7, 1.8e7, 1.9e7, 1e8, 1e10};
  int seen = 0;
  for (size_t r = 0; r < sizeof densities / sizeof *densities; r++)
    for (size_t e = 0; e < sizeof energies / sizeof *energies; e++) {
      double rho = densities[r] * basalt_density, u = energies[e], dr = rho * 1e-5, du = u * 1e-5;
      struct sph_pressure p = sph_tillotson(&basalt, basalt_density, rho, u);
      double by_rho = (sph_tillotson(&basalt, basalt_density, rho + dr, u).pressure -
                       sph_tillotson(&basalt, basalt_density, rho - dr, u).pressure) / (2 * dr);
      double by_u = (sph_tillotson(&basalt, basalt_density, rho, u + du).pressure -
                     sph_tillotson(&basalt, basalt_density, rho, u - du).pressure) / (2 * du);
      double scale = basalt.A / basalt_density; /* where terms cancel, compare with the size of the terms */
      if (fabs(p.by_density - by_rho) > 1e-6 * (fabs(by_rho) + scale))
        fail_msg("dP/drho at eta %g, u %g: %.12g against %.12g", densities[r], u, p.by_density, by_rho);
      if (fabs(p.by_energy - by_u) > 1e-6 * (fabs(by_u) + rho))
        fail_msg("dP/du at eta %g, u %g: %.12g against %.12g", densities[r], u, p.by_energy, by_u);
      double c2 = by_rho + p.pressure / (rho * rho) * by_u, low = basalt.A / (4 * basalt_density);
      expect_near(p.sound_speed, sqrt(c2 > low ? c2 : low), 1e-5, "sound speed");
      seen++;
    }
  assert_int_equal(seen, 90);
}

static void continuous(void **state) {
  (void)state;
  const double densities[] = {0.3, 0.7, 0.99};
  const double energies[] = {basalt.E_iv, basalt.E_cv};
  for (size_t r = 0; r < 3; r++)
    for (size_t e = 0; e < 2; e++) {
      double rho = densities[r] * basalt_density;
      double below = sph_tillotson(&basalt, basalt_density, rho, energies[e] * (1 - 1e-12)).pressure;
      double above = sph_tillotson(&basalt, basalt_density, rho, energies[e] * (1 + 1e-12)).pressure;
      assert_true(fabs(above - below) < 1e-9 * (fabs(below) + basalt.A * 1e-3));
    }
  for (double u = 0; u < 4.7e6; u += 1e5) { /* across rho0 on the cold side */
    double below = sph_tillotson(&basalt, basalt_density, basalt_density * (1 - 1e-13), u).pressure;
    double above = sph_tillotson(&basalt, basalt_density, basalt_density * (1 + 1e-13), u).pressure;
    assert_true(fabs(above - below) < 1e-6 * basalt.A * 1e-3);
  }
}

static void known_values(void **state) {
  (void)state;
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
  /* negative energy is taken as none: the pole at -E0 eta^2 is out of reach */
  struct sph_pressure cold = sph_tillotson(&basalt, basalt_density, 2000, -basalt.E0 * 4 / 7.29);
  assert_true(cold.pressure == sph_tillotson(&basalt, basalt_density, 2000, 0).pressure);
  assert_true(isfinite(cold.sound_speed) && cold.sound_speed > 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(derivatives), cmocka_unit_test(continuous),
                                     cmocka_unit_test(known_values)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
