/* Damage from explicit flaws against Grady & Kipp 1980, without any hydrodynamics: every particle at strain rate x t.
 *
 * Basalt of Benz & Asphaug 1994 (m 8.5, k 5e34 m^-3, E 53.06 GPa, c_g 1837 m/s), 50 000 particles in 1.257e-5 m^3, peak
 * of the mean stress. The numbers were computed once by an independent program (means over 24 seeds); one seed scatters
 * by the range given there, well under the 1 % allowed here (4 % for `count` at 360/s, whose range is +-2 %). The
 * isolated law is met only where 0.7 < c_g t_f / R_s < 5, and the particle form differs from it by construction: that
 * is why the table, not the law, is the target. */

#include "tests/support/check.h"
#include "tests/support/flaw_row.h"
#include "tests/support/grady_kipp.h"

enum { PARTICLES = 50000, STEPS = 400 };
static const double m = 8.5, k = 5e34, volume = 1.257e-5, young = 53.06e9, crack_speed = 1837;

static double fracture_time(double rate) { /* t_f = alpha_GK^(-1/(m+3)) rate^(-m/(m+3)) */
  double alpha = 8 * M_PI * pow(crack_speed, 3) * k / ((m + 1) * (m + 2) * (m + 3));
  return pow(alpha, -1 / (m + 3)) * pow(rate, -m / (m + 3));
}

static double peak_stress(const struct sph_flaws *flaws, double rate, int growth, int cap) {
  double radius = cbrt(3 * volume / PARTICLES / (4 * M_PI));
  double dt = 3 * fracture_time(rate) / STEPS, peak = 0;
  OWNED double *state = calloc(PARTICLES, sizeof *state);
  for (int step = 0; step < STEPS; step++) {
    double sum = 0, log_strain = log(rate * (step + 0.5) * dt);
    for (size_t i = 0; i < PARTICLES; i++) {
      size_t total = flaws->first[i + 1] - flaws->first[i];
      state[i] = grady_kipp_grow(state[i], grady_kipp_open(flaws, i, log_strain), total, growth, cap,
                                 crack_speed / radius, dt);
      sum += state[i] * state[i] * state[i];
    }
    double stress = young * rate * (step + 1) * dt * (1 - sum / PARTICLES);
    if (stress > peak)
      peak = stress;
  }
  return peak / 1e6;
}

TEST(particle_table) {
  static const struct {
    double rate;
    int growth, cap;
    double peak, tolerance;
  } rows[] = {
      {360, SPH_GROWTH_CUBE_ROOT, SPH_CAP_NONE, 43.55, 0.01},  {360, SPH_GROWTH_CUBE_ROOT, SPH_CAP_BA95, 47.14, 0.01},
      {360, SPH_GROWTH_CUBE_ROOT, SPH_CAP_COUNT, 54.7, 0.04},  {360, SPH_GROWTH_LINEAR, SPH_CAP_BA95, 47.09, 0.01},
      {3600, SPH_GROWTH_CUBE_ROOT, SPH_CAP_NONE, 61.20, 0.01}, {3600, SPH_GROWTH_CUBE_ROOT, SPH_CAP_BA95, 61.36, 0.01},
      {3600, SPH_GROWTH_CUBE_ROOT, SPH_CAP_COUNT, 62.4, 0.01}, {3600, SPH_GROWTH_LINEAR, SPH_CAP_BA95, 57.81, 0.01},
      {1e4, SPH_GROWTH_CUBE_ROOT, SPH_CAP_NONE, 77.39, 0.01},  {1e4, SPH_GROWTH_CUBE_ROOT, SPH_CAP_BA95, 77.39, 0.01},
      {1e4, SPH_GROWTH_CUBE_ROOT, SPH_CAP_COUNT, 77.39, 0.01}, {1e4, SPH_GROWTH_LINEAR, SPH_CAP_BA95, 66.47, 0.01},
  };
  const struct sph_flaw_law law = {.weibull = {m, k}, .draw = SPH_FLAWS_RANKED, .seed = 1};
  SPH_FLAWS *flaws = flaw_row(&law, PARTICLES, volume);
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    double peak = peak_stress(flaws, rows[r].rate, rows[r].growth, rows[r].cap);
    print_message("rate %6g /s growth %d cap %d: peak %.2f MPa, table %.2f\n", rows[r].rate, rows[r].growth,
                  rows[r].cap, peak, rows[r].peak);
    assert_true(fabs(peak / rows[r].peak - 1) < rows[r].tolerance);
  }
}

/* The isolated law itself, by its closed form and by integrating D = integral n'(t') (c_g (t - t'))^3 4pi/3 as it is
 * defined: the table's first column and fragment sizes. The closed form is exact; the last printed digit is the
 * tolerance. */
TEST(isolated_law) {
  static const struct {
    double rate, peak, size; /* 1/s, MPa, mm */
  } rows[] = {{60, 21.50, 9.60}, {1e3, 44.80, 1.20}, {1e4, 81.68, 0.219}};
  for (size_t r = 0; r < 3; r++) {
    double rate = rows[r].rate, tf = fracture_time(rate);
    double alpha = pow(tf, -(m + 3)) * pow(rate, -m);
    double peak = young * (m + 3) * pow(m + 4, -(m + 4) / (m + 3)) * pow(alpha, -1 / (m + 3)) * pow(rate, 3 / (m + 3));
    assert_true(fabs(peak / 1e6 - rows[r].peak) < 0.0051);
    assert_true(fabs(6 * crack_speed * tf / (m + 2) * 1e3 / rows[r].size - 1) < 0.003);
    double highest = 0; /* by quadrature, of the flaws' birth rate k m rate^m t'^(m-1) */
    for (int a = 1; a <= 400; a++) {
      double t = tf * a / 400, sum = 0;
      for (int b = 0; b < 400; b++) {
        double born = t * (b + 0.5) / 400;
        sum += k * m * pow(rate, m) * pow(born, m - 1) * 4 * M_PI / 3 * pow(crack_speed * (t - born), 3) * t / 400;
      }
      double stress = young * rate * t * (1 - sum);
      highest = stress > highest ? stress : highest;
    }
    assert_true(fabs(highest / peak - 1) < 1e-3);
  }
}

TEST(pieces) {
  /* one flaw: D^(1/3) = c_g t / R_s exactly, whatever the steps, until the cap */
  double d = 0;
  for (int s = 0; s < 7; s++)
    d = grady_kipp_grow(d, 1, 1, SPH_GROWTH_CUBE_ROOT, SPH_CAP_NONE, 0.1, 1);
  assert_true(fabs(d - 0.7) < 1e-15);
  assert_true(grady_kipp_grow(0.7, 8, 8, SPH_GROWTH_CUBE_ROOT, SPH_CAP_NONE, 0.1, 1) - 0.9 < 1e-15); /* 8^(1/3) = 2 */
  assert_true(grady_kipp_grow(0.95, 8, 8, SPH_GROWTH_LINEAR, SPH_CAP_BA95, 1, 1) == 1);
  /* caps: 1 of 8 flaws: D <= 1/2 (printed), 1/8 (count); D never decreases under a lower cap */
  assert_true(fabs(pow(grady_kipp_grow(0, 1, 8, 0, SPH_CAP_BA95, 9, 9), 3) - 0.5) < 1e-15);
  assert_true(fabs(pow(grady_kipp_grow(0, 1, 8, 0, SPH_CAP_COUNT, 9, 9), 3) - 0.125) < 1e-15);
  assert_true(grady_kipp_grow(0.9, 1, 8, 0, SPH_CAP_COUNT, 9, 9) == 0.9);
  assert_true(grady_kipp_grow(0.3, 0, 8, 0, SPH_CAP_NONE, 9, 9) == 0.3);
  /* principal values: diagonal, pure shear, and a rotated uniaxial tension */
  assert_true(sph_material_largest_tension(3, 0, 0, -5, 0, 1) == 3 ||
              fabs(sph_material_largest_tension(3, 0, 0, -5, 0, 1) - 3) < 1e-14);
  assert_true(fabs(sph_material_largest_tension(0, 2, 0, 0, 0, 0) - 2) < 1e-14);
  assert_true(sph_material_largest_tension(-4, 0, 0, -4, 0, -4) == -4);
  double n[3] = {2.0 / 7, 3.0 / 7, 6.0 / 7};
  assert_true(
      fabs(sph_material_largest_tension(n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]) -
           1) < 1e-14);
}
