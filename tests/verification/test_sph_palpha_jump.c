/* The jump-condition solver gives the known plateaus (sph_palpha_jump.md), and the engine's (alpha, P) lies on them. */
#include "engine/sph/material/palpha.h"
#include "palpha_exact.h"
#include "tests/support/check.h"

static void near(double got, double want, double tolerance, const char *what) {
  if (!(fabs(got - want) <= tolerance))
    fail_msg("%s: got %.9g, expected %.9g +- %g", what, got, want, tolerance);
}

/* To the digits printed there. */
TEST(plateaus) {
  struct exact_front precursor, shock;
  exact_piston(&exact_porous_aluminium, 458, &precursor, &shock);
  near(precursor.speed, 4117, 0.5, "precursor");
  near(precursor.pressure, 80e6, 1, "precursor's pressure");
  near(shock.speed, 1982.9, 0.05, "Us at 458 m/s");
  near(shock.density, 2747.1, 0.05, "density");
  near(shock.pressure, 1960e6, 0.5e6, "pressure");
  near(shock.alpha, 1, 0, "alpha");
  exact_piston(&exact_porous_aluminium, 200, &precursor, &shock);
  near(shock.speed, 1005.7, 0.05, "Us at 200 m/s");
  near(shock.density, 2625.0, 0.05, "density");
  near(shock.pressure, 483.6e6, 0.05e6, "pressure");
  near(shock.alpha, 1.0334, 5e-5, "alpha");
  struct exact_matter solid = exact_porous_aluminium, basalt = {2700, 2.67e10, 2.67e10, 0.5, 1.5, 4.87e8, 1, 0, 0, 0};
  solid.alpha0 = 1, solid.P_e = solid.P_s = 0;
  exact_piston(&solid, 1000, &precursor, &shock);
  near(shock.speed, 6753.5, 0.05, "Us of solid aluminium");
  near(shock.pressure, 18.234e9, 0.5e6, "P of solid aluminium");
  exact_piston(&basalt, 1000, &precursor, &shock);
  near(shock.speed, 4683.9, 0.05, "Us of solid basalt");
  near(shock.pressure, 12.646e9, 0.5e6, "P of solid basalt");
}

/* The state behind a piston, over speeds: the engine finds the same alpha and P from (rho, u) in one step, or by
 * following the compression. The oracle's alpha comes from 2000 midpoint steps: 1e-9. */
TEST(engine_agrees) {
  const struct exact_matter *m = &exact_porous_aluminium;
  struct sph_material solid = {.density = 2700, .tillotson = {7.52e10, 6.5e10, 0.5, 1.63, 5, 5, 5e6, 3e6, 1.39e7}};
  struct sph_palpha_material given = {.distention = 1.275,
                                      .curve = SPH_CRUSH_QUADRATIC,
                                      .elastic_pressure = 80e6,
                                      .solid_pressure = 700e6,
                                      .sound_speed = 4110};
  struct sph_palpha_law law;
  assert_int_equal(sph_palpha_prepare(&given, &solid, &law, NULL), STATUS_OK);
  for (double piston = 20; piston < 1500; piston *= 1.2) {
    struct exact_front precursor, shock;
    exact_piston(m, piston, &precursor, &shock);
    struct sph_palpha_state s = sph_palpha_update(&law, 1.275, 1.275, precursor.density, precursor.energy);
    near(s.pressure, 80e6, 1e3, "P of the precursor");
    s = sph_palpha_update(&law, 1.275, 1.275, shock.density, shock.energy);
    near(s.pressure, shock.pressure, 1e-6 * shock.pressure, "P of the shock");
    near(s.distention, shock.alpha, 1e-7, "alpha of the shock");
    double rest = 1.275, alpha = 1.275;
    for (int i = 1; i <= 100; i++) {
      s = sph_palpha_update(&law, rest, alpha, 2700 / 1.275 + (shock.density - 2700 / 1.275) * i / 100,
                            shock.energy * i / 100);
      rest = s.rest, alpha = s.distention;
    }
    near(s.pressure, shock.pressure, 1e-6 * shock.pressure, "P of the shock, followed");
    near(s.distention, shock.alpha, 1e-7, "alpha of the shock, followed");
  }
}
