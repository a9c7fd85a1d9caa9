/* The gradient correction between body and debris: what the kernels make of moments that are neither. By hand: with
 * s(t) = t^2 (3 - 2t), t from 0 at a mean eigenvalue of 0.1 (a determinant over its cube of 0.3) to 1 at 0.2 (at 0.6),
 * and both multiplied, B is s times the inverse plus 1 - s times 1. s(1/4) = 5/32, s(1/2) = 1/2, s(3/4) = 27/32.
 * Where the target spins, rotations are whole for any B. */

#include "engine/sph/pairs/pairs.h"
#include "tests/support/check.h"

/* Moments are diagonal in axes turned relative to the coordinates; so is B. Eigenvalues size (1, 1 + d, 1 - d): the
 * mean is `size`, the determinant over its cube 1 - d^2. */
static const struct {
  double size, d_squared, share;
} cases[] = {
    {1, 0, 1},             /* inside a body */
    {0.2, 0, 1},           /* B = 5 */
    {0.175, 0, 27.0 / 32}, /* 5/32 + 27/32 / 0.175 = 4.9777 */
    {0.15, 0, 0.5},        /* 1/2 + 1/2 / 0.15 = 3.8333 */
    {0.125, 0, 5.0 / 32},  /* 27/32 + 5/32 * 8 = 2.09375 */
    {0.1, 0, 0},
    {0.05, 0, 0},
    {0, 0, 0}, /* alone: no division by zero */
    {-1, 0, 0},
    {1, 0.4, 1},
    {1, 0.475, 27.0 / 32}, /* 0.525 = 0.3 + 3/4 0.3 */
    {1, 0.55, 0.5},        /* 0.45 */
    {1, 0.625, 5.0 / 32},  /* 0.375 */
    {1, 0.7, 0},
    {1, 1, 0},          /* flat */
    {1, 2, 0},          /* a negative determinant */
    {0.15, 0.55, 0.25}, /* between in both */
    {0.175, 0.625, 27.0 / 32 * 5 / 32},
    {0.125, 0.475, 5.0 / 32 * 27 / 32},
};
enum { CASES = sizeof cases / sizeof cases[0] }; /* more than two registers of eight, with a remainder */

static const double axis[3][3] = {{2.0 / 3, -1.0 / 3, 2.0 / 3},
                                  {2.0 / 3, 2.0 / 3, -1.0 / 3},
                                  {-1.0 / 3, 2.0 / 3, 2.0 / 3}};
static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2},
                 at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

static void tensor(const double value[3], double out[6]) {
  for (int k = 0; k < 6; k++) {
    out[k] = 0;
    for (int a = 0; a < 3; a++)
      out[k] += value[a] * axis[a][row[k]] * axis[a][column[k]];
  }
}

/* Tolerances: some ten roundings, of the determinant relative to the cube (at least 0.3 of it where it is divided by),
 * of a share whose slope is 15 over the mean's range: below 1e-14 of the largest, which is 5. */
TEST(shares_between_body_and_debris) {
  static const char *const classes[] = {"baseline", "v3", "v4"};
  for (int which = 0; which < 3; which++) {
    static double moment[6][CASES], old[6][CASES], gradient[9][CASES], expected[CASES][6], power[CASES], zero[CASES],
        found[CASES];
    const struct sph_pair_options options = {.gradient_correction.on = true};
    struct sph_pair_fields fields = {.density = zero, .pressure_term = zero};
    struct sph_pair_sums sums = {.power = power, .correction_share[0] = found};
    for (int i = 0; i < CASES; i++) {
      const double d = sqrt(cases[i].d_squared), share = cases[i].share;
      const double value[3] = {cases[i].size, cases[i].size * (1 + d), cases[i].size * (1 - d)};
      double m[6], b[3];
      tensor(value, m);
      for (int k = 0; k < 3; k++)
        b[k] = share > 0 ? 1 - share + share / value[k] : 1;
      tensor(b, expected[i]);
      for (int k = 0; k < 6; k++)
        moment[k][i] = m[k];
      for (int k = 0; k < 9; k++)
        gradient[k][i] = k - 3.5;
    }
    for (int k = 0; k < 6; k++)
      fields.correction[k] = old[k], sums.correction[k] = moment[k];
    for (int k = 0; k < 9; k++)
      sums.gradient[k] = gradient[k];
    assert_int_equal(setenv("CLAST_CPU", classes[which], 1), 0);
    sph_pairs_kernels_choose()->finish_gradient_correction(&options, &fields, 0, CASES, &sums);
    for (int i = 0; i < CASES; i++) {
      assert_true(fabs(found[i] - cases[i].share) < 5e-14);
      for (int k = 0; k < 6; k++)
        if (!(fabs(moment[k][i] - expected[i][k]) < 5e-14))
          fail_msg("class %s, case %d: B[%d] = %.17g, not %.17g", classes[which], i, k, moment[k][i], expected[i][k]);
      for (int a = 0; a < 3; a++) /* rows of the gradient times B, whatever B is */
        for (int b = 0; b < 3; b++) {
          double product = 0;
          for (int k = 0; k < 3; k++)
            product += (3 * a + k - 3.5) * expected[i][at[k][b]];
          assert_true(fabs(gradient[3 * a + b][i] - product) < 1e-12);
        }
    }
  }
  unsetenv("CLAST_CPU");
}

/* What the kernels make of the gradient `first` times M. */
static void finish(bool turns, const double first[9], double gradient[9][CASES]) {
  static double moment[6][CASES], old[6][CASES], power[CASES], zero[CASES];
  const struct sph_pair_options options = {.gradient_correction.on = true, .turns = turns};
  struct sph_pair_fields fields = {.density = zero, .pressure_term = zero};
  struct sph_pair_sums sums = {.power = power};
  for (int i = 0; i < CASES; i++) {
    const double d = sqrt(cases[i].d_squared),
                 value[3] = {cases[i].size, cases[i].size * (1 + d), cases[i].size * (1 - d)};
    double m[6];
    tensor(value, m);
    for (int k = 0; k < 6; k++)
      moment[k][i] = m[k];
    for (int k = 0; k < 9; k++)
      gradient[k][i] = first[k / 3 * 3] * m[at[0][k % 3]] + first[k / 3 * 3 + 1] * m[at[1][k % 3]] +
                       first[k / 3 * 3 + 2] * m[at[2][k % 3]];
  }
  for (int k = 0; k < 6; k++)
    fields.correction[k] = old[k], sums.correction[k] = moment[k];
  for (int k = 0; k < 9; k++)
    sums.gradient[k] = gradient[k];
  sph_pairs_kernels_choose()->finish_gradient_correction(&options, &fields, 0, CASES, &sums);
}

/* Where the target spins, the gradient of a rigid rotation is that rotation, whatever the share; a particle alone keeps
 * its bits, and any gradient its trace. Tolerance: neighbours in line add 1e-9 of the trace to the moment of inertia,
 * which is at least 0.19 of it here. */
TEST(rotations_stay_whole) {
  static const double turning[9] = {0, -3, 2, 3, 0, -1, -2, 1, 0}, any[9] = {4, 1, -2, 5, -3, 7, 1, -8, 2};
  static double whole[9][CASES], plain[9][CASES];
  finish(true, turning, whole);
  finish(false, turning, plain);
  for (int i = 0; i < CASES; i++)
    for (int k = 0; k < 9; k++)
      if (cases[i].size < 0.05)
        assert_true(whole[k][i] == plain[k][i]);
      else if (!(fabs(whole[k][i] - turning[k]) < 1e-7))
        fail_msg("case %d: gradient[%d] = %.17g, not %g", i, k, whole[k][i], turning[k]);
  finish(true, any, whole);
  finish(false, any, plain);
  for (int i = 0; i < CASES; i++)
    assert_true(fabs(whole[0][i] + whole[4][i] + whole[8][i] - plain[0][i] - plain[4][i] - plain[8][i]) < 1e-12);
}
