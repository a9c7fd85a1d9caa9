/* P-alpha: crush curves by their values, all derivatives against finite differences, the implicit update against the
 * rate form of the papers integrated finely (written here again), paths of loading and unloading, jumps, the solid's
 * limit. */

#include "engine/random.h"
#include "engine/sph/material/material.h"
#include "engine/sph/material/palpha.h"
#include "tests/support/check.h"

static const struct sph_material aluminium = {.density = 2700,
                                              .tillotson = {7.52e10, 6.5e10, 0.5, 1.63, 5, 5, 5e6, 3e6, 1.39e7}};
static const struct sph_palpha_material porous_aluminium = {.distention = 1.275,
                                                            .curve = SPH_CRUSH_QUADRATIC,
                                                            .elastic_pressure = 80e6,
                                                            .solid_pressure = 700e6,
                                                            .sound_speed = 4110};
static const struct sph_material pumice_matrix = {.density = 2327,
                                                  .tillotson = {2.67e10, 2.67e10, 0.5, 1.5, 5, 5, 4.87e8, 4.72e6,
                                                                1.82e7}};
static const struct sph_palpha_material pumice = {.distention = 4.64,
                                                  .curve = SPH_CRUSH_TWO_POWER,
                                                  .elastic_pressure = 1e6,
                                                  .solid_pressure = 213e6,
                                                  .sound_speed = NAN,
                                                  .elastic_distention = 4.64,
                                                  .transition_distention = 1.90,
                                                  .transition_pressure = 68e6,
                                                  .exponent_low = 12,
                                                  .exponent_high = 3};
static const struct sph_material ice = {.density = 917,
                                        .tillotson = {9.47e9, 9.47e9, 0.3, 0.1, 10, 5, 1e7, 7.73e5, 3.04e6}};
static const struct sph_palpha_material porous_ice = {.distention = 1.5,
                                                      .curve = SPH_CRUSH_QUADRATIC,
                                                      .elastic_pressure = 1e6,
                                                      .solid_pressure = 100e6,
                                                      .sound_speed = 1600};

static struct sph_palpha_law law_of(const struct sph_palpha_material *given, const struct sph_material *solid) {
  struct sph_palpha_law law;
  OK(sph_palpha_prepare(given, solid, &law, &error));
  return law;
}

static void near(double got, double want, double tolerance, const char *what) {
  if (!(fabs(got - want) <= tolerance))
    fail_msg("%s: got %.17g, expected %.17g +- %g", what, got, want, tolerance);
}

/* The known values, to the digits given (sph_palpha.md). */
TEST(printed_values) {
  struct sph_palpha_law al = law_of(&porous_aluminium, &aluminium), p = law_of(&pumice, &pumice_matrix);
  near(al.elastic_distention, 1.27388, 5e-6, "alpha_e of porous aluminium");
  near(sph_palpha_crush(&al, 80e6), al.elastic_distention, 1e-12, "start of the curve");
  near(sph_palpha_crush(&al, 390e6), 1 + (al.elastic_distention - 1) / 4, 1e-12, "half way, a quarter of the pores");
  const double mpa[] = {1, 2, 5, 10, 20, 68, 100, 213, 500},
               alpha[] = {4.64, 4.1749, 3.1590, 2.2755, 1.7291, 1.2880, 1.1363, 1, 1};
  for (size_t i = 0; i < sizeof mpa / sizeof *mpa; i++)
    near(sph_palpha_crush(&p, mpa[i] * 1e6), alpha[i], 5e-5, "pumice");
}

/* Slopes against central differences: truncation (1e-5)^2 times curvature over slope (at most n1^2/2 = 72): 1e-8. */
TEST(curve_slopes) {
  struct sph_palpha_law laws[] = {law_of(&porous_aluminium, &aluminium), law_of(&pumice, &pumice_matrix),
                                  law_of(&porous_ice, &ice)};
  for (int l = 0; l < 3; l++)
    for (double p = 1.01e6; p < 8e8; p *= 1.013) {
      const struct sph_palpha_material *g = &laws[l].given;
      if (fabs(p / g->elastic_pressure - 1) < 1e-3 || fabs(p / g->solid_pressure - 1) < 1e-3)
        continue;
      double d = p * 1e-5;
      double got = sph_palpha_crush_slope(&laws[l], p);
      double want = (sph_palpha_crush(&laws[l], p + d) - sph_palpha_crush(&laws[l], p - d)) / (2 * d);
      near(got, want, 1e-6 * fabs(want) + 1e-10 / p, "crush slope");
      assert_true(got <= 0);
    }
}

/* The elastic branch against its own differential equation in 20 000 midpoint steps, and back. */
TEST(elastic_branch) {
  const struct sph_palpha_material *given[] = {&porous_aluminium, &porous_ice};
  const struct sph_material *solid[] = {&aluminium, &ice};
  for (int l = 0; l < 2; l++) {
    struct sph_palpha_law law = law_of(given[l], solid[l]);
    double cs = sqrt(solid[l]->tillotson.A / solid[l]->density), K0 = solid[l]->density * cs * cs;
    for (double share = 0.02; share <= 1; share += 0.07) {
      double rest = 1 + share * (law.given.distention - 1), end = law.given.solid_pressure, dp = end / 20000,
             alpha = rest;
      for (int i = 0; i < 20000; i++) {
        double a = alpha, slope = 0;
        for (int k = 0; k < 2; k++) {
          double h = 1 + (a - 1) * (law.given.sound_speed - cs) / (cs * (law.elastic_distention - 1));
          slope = a * a / K0 * (1 - 1 / (h * h));
          a = alpha + slope * dp / 2;
        }
        alpha += slope * dp;
      }
      /* one fourth-order step over all of 0..P_s */
      near(sph_palpha_elastic(&law, rest, end), alpha, 1e-6, "elastic branch");
      near(sph_palpha_rest(&law, sph_palpha_elastic(&law, rest, end), end), rest, 1e-13, "way back");
      assert_true(alpha < rest);
    }
  }
  struct sph_palpha_law p = law_of(&pumice, &pumice_matrix);
  assert_true(sph_palpha_elastic(&p, 3, 5e7) == 3); /* no sound speed given: pores do not give way elastically */
}

/* dP/drho, dP/du, dalpha/drho, dalpha/du and f on each branch: fresh and elastic, crushing, solid above P_s, tension,
 * hot. */
TEST(derivatives) {
  const struct sph_palpha_material *given[] = {&porous_aluminium, &pumice, &porous_ice};
  const struct sph_material *solid[] = {&aluminium, &pumice_matrix, &ice};
  int seen[4] = {0};
  for (int l = 0; l < 3; l++) {
    struct sph_palpha_law law = law_of(given[l], solid[l]);
    double a0 = law.given.distention, rho0 = solid[l]->density / a0;
    for (double share = 0.1; share <= 1.0001; share += 0.18)
      for (double squeeze = 0.97; squeeze < 1.6 * a0; squeeze *= squeeze < 1.03 ? 1.0007 : 1.009)
        for (double u = 0; u < 4e5; u += 1.3e5) {
          double rest = fmin(a0, 1 + share * (a0 - 1)), rho = rho0 * a0 / rest * squeeze;
          struct sph_palpha_state s = sph_palpha_update(&law, rest, rest, rho, u);
          double dr = rho * 1e-7, du = 1e-1 + u * 1e-6;
          /* Differences on the branch it is on: while crushing, with the old rest; else with the new. A kink between
           * the two ends (P_e, P_t, P_s, alpha_0, rho_s0) is told by second differences and left out. */
          struct sph_palpha_state r1 = sph_palpha_update(&law, rest, rest, rho - dr, u),
                                  r2 = sph_palpha_update(&law, rest, rest, rho + dr, u);
          struct sph_palpha_state u1 = sph_palpha_update(&law, rest, rest, rho, u > 0 ? u - du : 0),
                                  u2 = sph_palpha_update(&law, rest, rest, rho, u + du);
          double span = u > 0 ? 2 * du : du;
          double scale = law.solid.A / solid[l]->density;
          if (s.pressure < -law.given.solid_pressure)
            continue; /* one step of the elastic branch is good for |P| < P_s */
          if (fabs(r2.pressure + r1.pressure - 2 * s.pressure) > 1e-3 * fabs(r2.pressure - r1.pressure) + 1e-2)
            continue;
          int branch = s.rest < rest ? (s.distention == 1 ? 2 : 1) : s.pressure < 0 ? 3 : 0;
          if (s.rest == rest && (r2.rest < rest || u2.rest < rest))
            continue; /* at the curve's edge */
          if (s.rest < rest && (r1.rest == rest || u1.rest == rest))
            continue;
          seen[branch]++;
          /* P comes out of an iteration to about 1e-12 in alpha, that is 1e-12 K/alpha in P; over 2e-7 rho */
          near(s.by_density, (r2.pressure - r1.pressure) / (2 * dr), 1e-4 * fabs(s.by_density) + 2e-5 * scale,
               "dP/drho");
          near(s.distention_by_density * rho, (r2.distention - r1.distention) / (2e-7), 1e-4 * s.distention + 2e-5,
               "dalpha/drho");
          near(s.by_energy / rho, (u2.pressure - u1.pressure) / span / rho, 2e-3 * fabs(s.by_energy / rho) + 1e-3,
               "dP/du");
          near(s.distention_by_energy, (u2.distention - u1.distention) / span,
               2e-3 * fabs(s.distention_by_energy) + 1e-11, "dalpha/du");
          double f = 1 +
                     (s.distention_by_density + s.pressure / (rho * rho) * s.distention_by_energy) * rho / s.distention;
          near(s.shear_factor, f < 0 ? 0 : f, 1e-6, "f"); /* a little below 0 where heat alone crushes: held at 0 */
          assert_true(f > -0.05 && f <= 1);
          assert_true(s.shear_factor >= 0 && s.shear_factor <= 1);
        }
  }
  for (int b = 0; b < 4; b++)
    if (seen[b] < 50)
      fail_msg("branch %d was tried only %d times", b, seen[b]);
}

/* The papers' rate, JBM08 eq. 13, over a path rho(t) by fine Heun steps; branch by branch. */
static double rate(const struct sph_palpha_law *law, double alpha, double rho, double u, double slope_crush,
                   double by_rho, double by_u) {
  struct sph_pressure s = sph_tillotson(&law->solid, law->solid_density, alpha * rho, u);
  double p = s.pressure / alpha;
  double slope = slope_crush < 0 ? sph_palpha_crush_slope(law, p) : sph_palpha_elastic_slope(law, alpha);
  return (by_u * s.by_energy + alpha * by_rho * s.by_density) * slope / (alpha + slope * (p - rho * s.by_density));
}

static double follow(const struct sph_palpha_law *law, double alpha, double rho0, double rho1, double u0, double u1,
                     int crush) {
  const int steps = 20000;
  double dr = (rho1 - rho0) / steps, du = (u1 - u0) / steps;
  for (int i = 0; i < steps; i++) {
    double rho = rho0 + i * dr, u = u0 + i * du, sign = crush ? -1 : 1;
    double k1 = rate(law, alpha, rho, u, sign, dr, du);
    double k2 = rate(law, alpha + k1, rho + dr, u + du, sign, dr, du);
    alpha += (k1 + k2) / 2;
  }
  return alpha;
}

TEST(against_the_rate_form) {
  struct sph_palpha_law law = law_of(&porous_aluminium, &aluminium);
  double rho0 = 2700 / 1.275;
  /* elastic: to 70 MPa or so */
  double rho = rho0 * 1.0019;
  struct sph_palpha_state s = sph_palpha_update(&law, 1.275, 1.275, rho, 0);
  assert_true(s.pressure > 5e7 && s.pressure < 8e7 && s.rest == 1.275);
  near(s.distention, follow(&law, 1.275, rho0, rho, 0, 0, 0), 1e-8, "elastic alpha by rates");
  /* crushing, with heating on the way: from a state on the curve at 150 MPa */
  for (int k = 0; k < 3; k++) {
    const double heat[] = {0, 2e4, -4e3};
    rho = rho0 * 1.06;
    struct sph_palpha_state from = sph_palpha_update(&law, 1.275, 1.275, rho, 1e4);
    near(from.distention, sph_palpha_crush(&law, from.pressure), 1e-10, "on the curve");
    struct sph_palpha_state to = sph_palpha_update(&law, from.rest, from.distention, rho * 1.1, 1e4 + heat[k]);
    assert_true(to.pressure > from.pressure && to.pressure < 700e6);
    near(to.distention, follow(&law, from.distention, rho, rho * 1.1, 1e4, 1e4 + heat[k], 1), 2e-7,
         "crushed alpha by rates");
    near(to.pressure,
         sph_tillotson(&law.solid, 2700, to.distention * rho * 1.1, 1e4 + heat[k]).pressure / to.distention, 1,
         "P of alpha");
    /* and back down the elastic way to a third of the pressure */
    double down = rho * 1.1 * 0.997;
    struct sph_palpha_state back = sph_palpha_update(&law, to.rest, to.distention, down, 1e4 + heat[k]);
    assert_true(back.rest == to.rest && back.pressure < to.pressure && back.distention > to.distention);
    near(back.distention, follow(&law, to.distention, rho * 1.1, down, 1e4 + heat[k], 1e4 + heat[k], 0), 1e-8,
         "unloaded alpha by rates");
  }
}

/* Load, unload, load again to the same density: the same pressure, 312 MPa. A code that takes the crush slope whenever
 * P rises between P_e and P_s crushes the same pores twice, and its pressure is far too low (85 MPa): also computed
 * here. */
TEST(load_unload_reload) {
  struct sph_palpha_law law = law_of(&porous_aluminium, &aluminium);
  double rho0 = 2700 / 1.275, low = rho0, high = rho0 * 1.3;
  for (int i = 0; i < 60; i++) { /* the density of 312 MPa */
    double middle = (low + high) / 2;
    if (sph_palpha_update(&law, 1.275, 1.275, middle, 0).pressure < 312e6)
      low = middle;
    else
      high = middle;
  }
  double top = low, rest = 1.275, alpha = 1.275, loaded = 0;
  double zero = 0;
  for (int leg = 0; leg < 5; leg++) { /* up, down, up, down, up */
    int up = leg % 2 == 0;
    double from = leg == 0 ? rho0 : up ? zero : top, to = up ? top : 2700 / rest;
    for (int i = 0; i <= 400; i++) {
      struct sph_palpha_state s = sph_palpha_update(&law, rest, alpha, from + (to - from) * i / 400, 0);
      assert_true(s.rest <= rest && s.distention <= 1.275 && s.distention >= 1);
      if (leg > 0)
        near(s.rest, rest, 1e-12, "nothing crushes a second time");
      rest = s.rest, alpha = s.distention;
      if (up && i == 400) {
        near(s.pressure, 312e6, 1e3, "pressure at the top");
        if (leg == 0)
          loaded = s.distention;
        near(s.distention, loaded, 1e-11, "alpha at the top");
      }
      if (!up && i == 400) {
        near(s.pressure, 0, 1, "pressure when back at rest");
        near(s.distention, rest, 1e-12, "rest distention at P = 0");
        zero = to;
      }
    }
    if (leg == 0)
      assert_true(rest < 1.2 && rest > alpha);
  }
  /* the trap: reload by rates with the crush slope from P_e on */
  double a = rest, rho = zero, dr = (top - zero) / 20000;
  for (int i = 0; i < 20000; i++, rho += dr) {
    double p = sph_tillotson(&law.solid, 2700, a * rho, 0).pressure / a;
    a += rate(&law, a, rho, 0, p > 80e6 ? -1 : 1, dr, 0);
  }
  double wrong = sph_tillotson(&law.solid, 2700, a * top, 0).pressure / a;
  if (wrong > 150e6)
    fail_msg("the trap is no trap: %g MPa", wrong / 1e6);
}

TEST(jump) {
  struct sph_palpha_law laws[] = {law_of(&porous_aluminium, &aluminium), law_of(&pumice, &pumice_matrix),
                                  law_of(&porous_ice, &ice)};
  for (int l = 0; l < 3; l++)
    for (double squeeze = 1.001; squeeze < 2; squeeze *= 1.05) {
      double a0 = laws[l].given.distention, rho = laws[l].solid_density * squeeze; /* over the solid's own density */
      struct sph_palpha_state s = sph_palpha_update(&laws[l], a0, a0, rho, 1e4);
      struct sph_pressure solid = sph_tillotson(&laws[l].solid, laws[l].solid_density, rho, 1e4);
      if (solid.pressure < laws[l].given.solid_pressure)
        continue;
      assert_true(s.distention == 1 && s.rest == 1); /* at once and permanently */
      assert_true(s.shear_factor == 1);
      near(s.pressure, solid.pressure, 1e-9 * solid.pressure, "solid pressure");
      near(s.by_density, solid.by_density, 1e-9 * solid.by_density, "solid dP/drho");
      struct sph_palpha_state back = sph_palpha_update(&laws[l], s.rest, s.distention, rho * 0.7, 1e4);
      solid = sph_tillotson(&laws[l].solid, laws[l].solid_density, rho * 0.7, 1e4);
      assert_true(back.distention == 1 && back.pressure == solid.pressure && back.sound_speed == solid.sound_speed);
    }
}

/* alpha_0 -> 1: pressure at a given compression tends to the solid's, in proportion to alpha_0 - 1. */
TEST(solid_limit) {
  double last = 0;
  for (int k = 0; k < 3; k++) {
    const double a0[] = {1.01, 1.001, 1.0001};
    struct sph_palpha_material given = porous_aluminium;
    given.distention = a0[k];
    given.sound_speed = 5277.5 * (1 - 1.5 * (a0[k] - 1)); /* few pores change it little */
    given.elastic_pressure = 1e6 * (a0[k] - 1) / 0.01;
    struct sph_palpha_law law = law_of(&given, &aluminium);
    double worst = 0;
    for (double squeeze = 0.95; squeeze < 1.3; squeeze += 0.003) {
      double u = 1e5, rho = 2700 / a0[k] * squeeze;
      struct sph_palpha_state s = sph_palpha_update(&law, a0[k], a0[k], rho, u);
      struct sph_pressure solid = sph_tillotson(&aluminium.tillotson, 2700, 2700 * squeeze, u);
      worst = fmax(worst, fabs(s.pressure - solid.pressure) / 7.52e10);
      /* c_e is one number while the solid's c rises by 2 % up to P_s: that is the interpolation's own error */
      if (squeeze > 1)
        near(s.sound_speed / solid.sound_speed, 1, 0.03 + 2 * (a0[k] - 1), "sound speed");
    }
    /* P differs by about K (alpha_0 - 1) while the pores are there, twice that when closed and stiffened */
    assert_true(worst < 3 * (a0[k] - 1));
    if (k)
      assert_true(worst < 0.2 * last);
    last = worst;
  }
}

/* alpha_0 -> 1: closing ever fewer pores causes ever less damage, without a jump; a body of many pores follows the law.
 */
TEST(few_pores_do_little_harm) {
  double last = 1;
  for (double pores = 0.1; pores > 1e-9; pores /= 1.01) {
    struct sph_palpha_material given = porous_aluminium;
    given.distention = 1 + pores;
    given.sound_speed = NAN;
    struct sph_palpha_law law = law_of(&given, &aluminium);
    const double all = sph_palpha_damage_cbrt(&law, 1);
    near(sph_palpha_damage_cbrt(&law, 1 + pores), 0, 0, "damage of a fresh body");
    assert_true(all <= last && all > 0.97 * last);
    if (pores > 0.0101)
      near(all, 1, 0, "damage of many closed pores");
    last = all;
  }
  assert_true(last < 1e-6);
}

/* Heat at constant bulk density raises P, so it crushes; cooling back does not open the pores again. */
TEST(heat) {
  struct sph_palpha_law law = law_of(&porous_aluminium, &aluminium);
  double rho = 2700 / 1.275 * 1.05, rest = 1.275, alpha = 1.275, last = 2, pressure = 0;
  for (double u = 0; u < 6e5; u += 5e3) {
    struct sph_palpha_state s = sph_palpha_update(&law, rest, alpha, rho, u);
    assert_true(s.distention <= last && s.pressure >= pressure);
    last = alpha = s.distention, rest = s.rest, pressure = s.pressure;
  }
  assert_true(alpha < 1.2); /* rho_s has to grow by 0.03 of what heat adds */
  struct sph_palpha_state cold = sph_palpha_update(&law, rest, alpha, rho, 0);
  assert_true(cold.rest == rest && cold.pressure < 0);
}

/* c_e at alpha_0, the solid's at 1, linear between, the solid's taken at rho_s = alpha rho. */
TEST(sound_speeds) {
  struct sph_palpha_law law = law_of(&porous_aluminium, &aluminium), p = law_of(&pumice, &pumice_matrix);
  near(sph_palpha_update(&law, 1.275, 1.275, 2700 / 1.275, 0).sound_speed, 4110, 1e-9, "c at alpha_0");
  near(sph_palpha_update(&law, 1, 1, 2700, 0).sound_speed, sqrt(7.52e10 / 2700), 1e-9, "c of the solid");
  struct sph_palpha_state s = sph_palpha_update(&law, 1.1375, 1.1375, 2700 / 1.1375, 0);
  near(s.sound_speed, (4110 + sqrt(7.52e10 / 2700)) / 2, 1e-6, "c half way");
  s = sph_palpha_update(&law, 1.275, 1.275, 2700 / 1.275 * 1.15, 3e4);
  struct sph_pressure solid = sph_tillotson(&law.solid, 2700, s.distention * 2700 / 1.275 * 1.15, 3e4);
  near(s.sound_speed, solid.sound_speed + (4110 - solid.sound_speed) * (s.distention - 1) / 0.275, 1e-6,
       "c under pressure");
  near(sph_palpha_update(&p, 4.64, 4.64, 2327 / 4.64, 0).sound_speed, sqrt(2.67e10 / 2327), 1e-9,
       "c_e not given: the solid's");
}

/* While pores close, the wave that acts has the slope of the adiabat, here by a difference of 1e-6; else it is that of
 * sound, also on reloading. */
TEST(wave_speeds) {
  const struct sph_palpha_law laws[] = {law_of(&porous_aluminium, &aluminium), law_of(&pumice, &pumice_matrix)};
  for (int l = 0; l < 2; l++) {
    const double top = laws[l].given.distention, rho = laws[l].solid_density / top * 1.15, step = 1e-6 * rho;
    const struct sph_palpha_state s = sph_palpha_update(&laws[l], top, top, rho, 3e3);
    assert_true(s.rest < top && s.distention > 1); /* it crushes */
    const struct sph_palpha_state next = sph_palpha_update(&laws[l], s.rest, s.distention, rho + step,
                                                           3e3 + s.pressure / (rho * rho) * step);
    near(s.wave_speed / sqrt((next.pressure - s.pressure) / step), 1, 1e-3, "slope of the crush curve");
    assert_true(s.wave_speed < 0.7 * s.sound_speed);
    const struct sph_palpha_state back = sph_palpha_update(&laws[l], s.rest, s.distention, rho - step, 3e3);
    assert_true(back.wave_speed == back.sound_speed);
  }
  const struct sph_palpha_state closed = sph_palpha_update(&laws[0], 1, 1, 2800, 0);
  assert_true(closed.wave_speed == closed.sound_speed);
}

TEST(compaction_damage) {
  struct sph_palpha_law law = law_of(&porous_aluminium, &aluminium);
  assert_true(sph_palpha_damage_cbrt(&law, 1.275) == 0);
  near(sph_palpha_damage_cbrt(&law, 1), 1, 1e-15, "all pores closed");
  /* by hand, half closed: (0.51^(1/3) - 0.01^(1/3)) / (1.01^(1/3) - 0.01^(1/3)) = (0.798957 - 0.215443)/(1.003322 -
   * 0.215443) */
  near(sph_palpha_damage_cbrt(&law, 1.1375), (0.798957 - 0.215443) / (1.003322 - 0.215443), 2e-6, "half closed");
  struct sph_palpha_state s = sph_palpha_update(&law, 1.275, 1.275, 2700 / 1.275 * 1.001, 0);
  assert_true(s.distention < 1.275 && sph_palpha_damage_cbrt(&law, s.rest) == 0); /* elastic: no damage */
}

/* Any path: alpha within [1, alpha_0], rest never rises, all finite, P continuous along small steps (bounded by the
 * largest slope), P_s(alpha rho, u)/alpha is the pressure, and alpha not above the crush curve. */
TEST(random_paths) {
  const struct sph_palpha_material *given[] = {&porous_aluminium, &pumice, &porous_ice};
  const struct sph_material *solid[] = {&aluminium, &pumice_matrix, &ice};
  uint64_t draw = 0;
  for (uint64_t path = 0; path < 300; path++) {
    int l = (int)(path % 3);
    struct sph_palpha_law law = law_of(given[l], solid[l]);
    double a0 = law.given.distention, rest = a0, alpha = a0, rho = solid[l]->density / a0, u = 0, pressure = 0;
    for (int leg = 0; leg < 12; leg++) {
      double to = solid[l]->density / a0 * (0.9 + (1.4 * a0 - 0.9) * random_draw(1, RANDOM_FLAW_PLACE, path, draw++));
      double hot = 4 * log10(1 + 9 * random_draw(2, RANDOM_FLAW_PLACE, path, draw++));
      double heat = pow(10, 2 + hot) - 100;
      int steps = leg % 3 == 2 ? 1 : 60;
      double dr = (to - rho) / steps, du = (heat - u) / steps;
      for (int i = 0; i < steps; i++) {
        rho += dr, u = fmax(0, u + du);
        struct sph_palpha_state s = sph_palpha_update(&law, rest, alpha, rho, u);
        if (!(s.distention >= 1 && s.distention <= a0 && s.rest >= 1 && s.rest <= rest && isfinite(s.pressure) &&
              isfinite(s.by_density) && s.by_density >= 0 && s.sound_speed > 0 && s.shear_factor >= 0 &&
              s.shear_factor <= 1))
          fail_msg("path %llu leg %d: alpha %g rest %g P %g", (unsigned long long)path, leg, s.distention, s.rest,
                   s.pressure);
        double again = sph_tillotson(&law.solid, law.solid_density, s.distention * rho, u).pressure / s.distention;
        near(s.pressure, again, 1e-9 * (fabs(again) + law.solid.A), "P of alpha");
        if (s.pressure > law.given.elastic_pressure * 1.0001)
          near(fmax(s.distention, sph_palpha_crush(&law, s.pressure)), sph_palpha_crush(&law, s.pressure), 1e-7,
               "below the crush curve");
        if (steps > 1 && u < law.solid.E_iv) { /* below E_iv the stiffest slope is the compressed solid's */
          double scale = sph_tillotson(&law.solid, law.solid_density, 1.5 * a0 * rho, u).by_density;
          assert_true(fabs(s.pressure - pressure) <= 1.2 * scale * fabs(dr) * a0 + 4 * rho * a0 * fabs(du) + 1);
        }
        struct sph_palpha_state same = sph_palpha_update(&law, rest, 1, rho, u); /* another guess, the same answer */
        near(same.distention, s.distention, 1e-10, "alpha from another guess");
        rest = s.rest, alpha = s.distention, pressure = s.pressure;
      }
    }
  }
}

/* However soft the pores: an accepted law follows its elastic branch to P_e; others are refused. */
TEST(soft_pores_follow_their_branch) {
  int taken = 0, left = 0;
  for (double speed = 10; speed < 4000; speed *= 1.05)
    for (int k = 0; k < 2; k++) {
      struct sph_palpha_material given = k ? pumice : porous_aluminium;
      struct sph_palpha_law law;
      given.sound_speed = k ? speed / 2 : speed;
      if (sph_palpha_prepare(&given, k ? &pumice_matrix : &aluminium, &law, NULL)) {
        left++;
        continue;
      }
      double alpha = given.distention, step = given.elastic_pressure / 100000;
      for (int i = 0; i < 100000; i++) /* midpoint rule */
        alpha += step * sph_palpha_elastic_slope(&law, alpha + step / 2 * sph_palpha_elastic_slope(&law, alpha));
      const double got = sph_palpha_elastic(&law, given.distention, given.elastic_pressure);
      if (!(fabs(got - alpha) < 0.0101 * (given.distention - 1)))
        fail_msg("c_e %g: alpha %.6g, integrated %.6g", given.sound_speed, got, alpha);
      taken++;
    }
  assert_true(taken > 50 && left > 50);
}

TEST(refused) {
  struct sph_palpha_law law;
  struct sph_palpha_material bad[13];
  for (int i = 0; i < 13; i++)
    bad[i] = i < 6 ? porous_aluminium : pumice;
  bad[0].distention = 1;
  bad[1].distention = NAN;
  bad[2].solid_pressure = 70e6;
  bad[3].elastic_pressure = -1;
  bad[4].sound_speed = 6000;
  bad[5].sound_speed = 40; /* pores collapse before P_e */
  bad[6].transition_pressure = 300e6;
  bad[7].transition_distention = 0.9;
  bad[8].elastic_distention = 1.5;
  bad[9].exponent_low = 0;
  bad[10].distention = 5;
  bad[11].solid_pressure = INFINITY;
  bad[12].sound_speed = 40;
  for (int i = 0; i < 13; i++) {
    error.message[0] = 0;
    if (sph_palpha_prepare(&bad[i], i < 6 ? &aluminium : &pumice_matrix, &law, &error) != STATUS_CONTENT ||
        !error.message[0])
      fail_msg("law %d should be refused", i);
  }
  struct sph_palpha_material low = pumice; /* alpha_0 below the curve's start: stays until the curve is met */
  low.distention = 3;
  law = law_of(&low, &pumice_matrix);
  struct sph_palpha_state s = sph_palpha_update(&law, 3, 3, 2327.0 / 3 * 1.0001, 0);
  assert_true(s.distention == 3 && s.pressure > 0.2e6);
}
