/* The artificial stress of one particle: against its definition, and in every CPU class against plain C. */

#include "engine/sph/pairs/pairs.h"
#include "tests/bench/reference_sph.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"

static const char *const classes[] = {"baseline", "v3", "v4"};

/* R is minus epsilon times the tensile part: along the axes of a turned tensor of known principal values. */
TEST(artificial_stress_opposes_tension_only) {
  const double principal[3] = {3, -2, 0.5}, c = cos(0.7), s = sin(0.7),
               axis[3][3] = {{c, s, 0}, {-s * 0.6, c * 0.6, 0.8}, {s * 0.8, -c * 0.8, 0.6}};
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  double stress[6] = {0}, expected[6] = {0}, r[6];
  for (int k = 0; k < 6; k++)
    for (int a = 0; a < 3; a++) {
      stress[k] += principal[a] * axis[a][row[k]] * axis[a][column[k]];
      expected[k] -= 0.3 * fmax(principal[a], 0) * axis[a][row[k]] * axis[a][column[k]];
    }
  reference_sph_opposed(0.3, stress, r);
  for (int k = 0; k < 6; k++)
    assert_true(fabs(r[k] - expected[k]) < 1e-14);
}

/* The fast form, in every class: any stress, isotropic and axisymmetric ones, none, and compression along all axes, for
 * which R is exactly zero. A dozen rotations with inverses within 2 ulp leave some 1e-15 of the largest; stresses here
 * are below 10. */
TEST(opposed_stress_equals_plain_c) {
  enum { COUNT = 203, FIRST = 3 };
  static double stress[5][COUNT], factor[COUNT], pressure[COUNT], r[6][COUNT];
  double *out[6];
  const double *in[5];
  uint64_t seed = 77;
  for (int i = 0; i < COUNT; i++) {
    pressure[i] = i % 3 == 0 ? 0 : i % 3 == 1 ? -8 : 4 * noise(&seed);
    factor[i] = 0.5 + 0.25 * (i % 4);
    for (int k = 0; k < 5; k++)
      stress[k][i] = i % 7 == 0 || (i % 5 == 0 && (k == 1 || k == 2 || k == 4)) || (i % 11 == 0 && k != 1)
                         ? 0
                         : 3 * noise(&seed);
    if (i % 13 == 0)
      stress[0][i] = stress[3][i] = 1;
  }
  for (int k = 0; k < 6; k++)
    out[k] = r[k];
  for (int k = 0; k < 5; k++)
    in[k] = stress[k];
  for (int which = 0; which < 3; which++) {
    assert_int_equal(setenv("CLAST_CPU", classes[which], 1), 0);
    int opposed = 0, none = 0;
    r[0][FIRST - 1] = r[0][COUNT - 1] = 99;
    const struct sph_pair_options options = {.artificial_stress.epsilon = 0.3, .strength = true};
    struct sph_pair_fields fields = {.stress_factor = factor, .pressure_term = pressure};
    memcpy(fields.stress, in, sizeof fields.stress);
    sph_pairs_kernels_choose()->make_artificial_stress(&options, &fields, FIRST, COUNT - 1, out);
    for (int i = FIRST; i < COUNT - 1; i++) {
      double sigma[6], exact[6];
      for (int k = 0; k < 6; k++)
        sigma[k] = factor[i] * (k < 5 ? stress[k][i] : -(stress[0][i] + stress[3][i])) +
                   (k == 0 || k == 3 || k == 5 ? pressure[i] : 0);
      reference_sph_opposed(0.3, sigma, exact);
      for (int k = 0; k < 6; k++)
        if (!(fabs(r[k][i] - exact[k]) < 1e-14))
          fail_msg("class %s, particle %d: %g, %g", classes[which], i, r[k][i], exact[k]);
      const bool pressed = i % 3 == 1;
      if (pressed)
        for (int k = 0; k < 6; k++)
          assert_true(r[k][i] == 0);
      none += pressed, opposed += exact[0] < 0;
    }
    assert_true(r[0][FIRST - 1] == 99 && r[0][COUNT - 1] == 99);
    assert_true(opposed > 50 && none > 50);
  }
  unsetenv("CLAST_CPU");
}
