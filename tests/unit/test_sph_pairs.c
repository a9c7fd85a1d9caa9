/* The sums of the pair loop: kernels of every CPU class and precision against plain C, conservation, and fields whose
 * gradient is known. */

#include "engine/sph/pairs/pairs.h"
#include "tests/bench/reference_sph.h"
#include "tests/support/check.h"
#include "tests/support/pair_cloud.h"
#include "tests/support/pair_sums.h"

enum { SUMS = 14 };

struct summed {
  double a[SUMS][MOST]; /* ax ay az, gradient, heating, signal */
  double power[MOST], correction[6][MOST], share[MOST];
  double neighbours;
};

static struct sph_pair_fields fields_of(const struct cloud *c) {
  struct sph_pair_fields f = {.x = c->a[0],
                              .y = c->a[1],
                              .z = c->a[2],
                              .h = c->a[3],
                              .vx = c->a[4],
                              .vy = c->a[5],
                              .vz = c->a[6],
                              .mass = c->a[7],
                              .density = c->a[8],
                              .sound_speed = c->a[9],
                              .pressure_term = c->a[10],
                              .stress_factor = c->factor,
                              .damage[0] = c->damage};
  for (int k = 0; k < 5; k++)
    f.stress[k] = c->stress[k];
  return f;
}

/* Component xx xy xz yy yz zz of the acting deviator, over rho^2. */
static double acting(const struct cloud *c, int k, size_t i) {
  return c->factor[i] * (k < 5 ? c->stress[k][i] : -(c->stress[0][i] + c->stress[3][i]));
}

static struct sph_pair_sums sums_of(struct summed *s) {
  struct sph_pair_sums out =
      {.ax = s->a[0], .ay = s->a[1], .az = s->a[2], .heating = s->a[12], .signal = s->a[13], .power = s->power};
  for (int k = 0; k < 6; k++)
    out.correction[k] = s->correction[k];
  out.correction_share[0] = s->share;
  for (int k = 0; k < 9; k++)
    out.gradient[k] = s->a[3 + k];
  return out;
}

static struct summed *sum(const struct cloud *c, const struct sph_pair_options *options) {
  struct sph_pairs *pairs;
  struct summed *s = calloc(1, sizeof *s);
  OK(sph_pairs_create(c->n, options, &pairs, &error));
  assert_true(slack_of(c, pairs) < 0);
  OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
  assert_true(slack_of(c, pairs) >= 0);
  struct sph_pair_fields f = fields_of(c);
  struct sph_pair_sums sums = sums_of(s);
  for (int k = 0; k < 6; k++) {
    f.correction[k] = s->correction[k];
    for (size_t i = 0; i < c->n; i++)
      s->correction[k][i] = k == 0 || k == 3 || k == 5;
  }
  f.correction_share[0] = options->crack_surfaces.on ? s->share : NULL;
  for (size_t i = 0; i < c->n; i++)
    s->share[i] = 1;
  if (options->gradient_correction.on)
    sph_pairs_sum(pairs, c->n, &f, pair_sums_keep, &sums); /* the forces' correction is that of the pass before */
  sph_pairs_sum(pairs, c->n, &f, pair_sums_keep, &sums);
  s->neighbours = sph_pairs_neighbours(pairs);
  sph_pairs_free(pairs);
  return s;
}

/* Largest difference over the largest value of each kind: acceleration, gradient, heating, signal. */
static void compare(const struct cloud *c, const struct summed *s, const struct summed *t, double worst[4]) {
  static const int kind[SUMS] = {0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 3};
  double scale[4] = {0}, difference[4] = {0};
  for (int k = 0; k < SUMS; k++)
    for (size_t i = 0; i < c->n; i++) {
      scale[kind[k]] = fmax(scale[kind[k]], fabs(t->a[k][i]));
      difference[kind[k]] = fmax(difference[kind[k]], fabs(s->a[k][i] - t->a[k][i]));
    }
  for (int k = 0; k < 4; k++)
    worst[k] = difference[k] / scale[k];
}

static struct summed *reference(const struct cloud *c, const struct sph_pair_options *options) {
  struct summed *s = calloc(1, sizeof *s);
  struct reference_sph_lists lists;
  const double *const place[3] = {c->a[0], c->a[1], c->a[2]};
  double *artificial[6], *stress[6];
  for (int k = 0; k < 6; k++)
    artificial[k] = calloc(MOST, sizeof(double)), stress[k] = calloc(MOST, sizeof(double));
  for (size_t i = 0; i < c->n; i++) {
    double sigma[6], r[6];
    for (int k = 0; k < 6; k++)
      stress[k][i] = acting(c, k, i), sigma[k] = stress[k][i] + (k == 0 || k == 3 || k == 5 ? c->a[10][i] : 0);
    reference_sph_opposed(options->artificial_stress.epsilon, sigma, r);
    for (int k = 0; k < 6; k++)
      artificial[k][i] = r[k];
  }
  OK(reference_sph_lists_make(c->n, c->n, place, c->a[3], options->periodic, 1, &lists, &error));
  struct sph_pair_fields f = fields_of(c);
  struct sph_pair_sums sums = sums_of(s);
  reference_sph_sum(c->n, lists.start, lists.count, lists.j, options, &f, (const double *const *)stress,
                    options->artificial_stress.epsilon > 0 ? (const double *const *)artificial : NULL, &sums);
  reference_sph_lists_free(&lists);
  for (int k = 0; k < 6; k++)
    free(artificial[k]), free(stress[k]);
  return s;
}

/* All variants without the correction, in every class this machine has, to rounding: sums of 60 terms of either sign in
 * another order, and approximations within 2 ulp, stay within 1e-13 of the largest. Float: 60 terms of relative error
 * 2^-24 and positions in units of h/2^20 give some 1e-5. */
TEST(kernels_equal_plain_c) {
  static const double scales[] = {1, 1e-7, 1e6};
  for (int variant = 0; variant < 16; variant++) {
    const double spacing = scales[variant % 3], length = 18 * spacing;
    OWNED struct cloud *c = cloud_make(18, spacing, variant % 4 == 3, (uint64_t)variant + 1);
    struct sph_pair_options options = usual;
    options.strength = variant & 1;
    options.method.volume_weights = variant & 2;
    if (variant & 4 && variant % 4 != 3)
      options.periodic[0] = options.periodic[2] = length;
    if (variant & 8 && options.strength)
      options.artificial_stress.epsilon = 0.3;
    OWNED struct summed *exact = reference(c, &options);
    for (int k = 0; k < 3; k++)
      for (int precision = SPH_DOUBLE; precision <= SPH_FLOAT; precision++) {
        double worst[4];
        assert_int_equal(setenv("CLAST_CPU", classes[k], 1), 0);
        options.fidelity.precision = precision;
        OWNED struct summed *s = sum(c, &options);
        compare(c, s, exact, worst);
        for (int q = 0; q < 4; q++)
          if (!(worst[q] < (precision == SPH_FLOAT ? 3e-5 : 1e-13)))
            fail_msg("variant %d, class %s, %s, kind %d: %g", variant, classes[k], precision ? "float" : "double", q,
                     worst[q]);
      }
  }
  unsetenv("CLAST_CPU");
}

TEST(momentum_is_conserved) {
  OWNED struct cloud *c = cloud_make(SIDE, 1, true, 1);
  OWNED struct summed *s = sum(c, &usual);
  double total[3] = {0}, scale = 0;
  for (size_t i = 0; i < c->n; i++) {
    for (int k = 0; k < 3; k++)
      total[k] += c->a[7][i] * s->a[k][i];
    scale += c->a[7][i] * fabs(s->a[0][i]);
  }
  for (int k = 0; k < 3; k++)
    assert_true(fabs(total[k]) < 1e-13 * scale);
}

/* The gradient is the conjugate of the forces, with volumes and with the correction too: sum m v.a + sum m sigma/rho :
 * grad v = -heat, viscous and of the artificial stress. In every CPU class. */
TEST(work_equals_strain_energy) {
  for (int variant = SANITIZED ? 32 : 0; variant < 3 * 16; variant++) {
    assert_int_equal(setenv("CLAST_CPU", classes[variant / 16], 1), 0);
    OWNED struct cloud *c = cloud_make(SIDE, 1, true, 2);
    struct sph_pair_options options = usual;
    options.method.volume_weights = variant & 1;
    options.gradient_correction.on = variant & 2;
    options.fidelity.precision = variant & 4 ? SPH_FLOAT : SPH_DOUBLE;
    options.artificial_stress.epsilon = variant & 8 ? 0.3 : 0; /* its work is in the heating, of either sign */
    OWNED struct summed *s = sum(c, &options);
    double work = 0, strain = 0, heat = 0, scale = 0;
    for (size_t i = 0; i < c->n; i++) {
      double m = c->a[7][i];
      work += m * (c->a[4][i] * s->a[0][i] + c->a[5][i] * s->a[1][i] + c->a[6][i] * s->a[2][i]);
      static const int at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
      for (int k = 0; k < 9; k++) {
        double sigma = acting(c, at[k], i) + (k % 4 == 0 ? c->a[10][i] : 0);
        strain += m * c->a[8][i] * sigma * s->a[3 + k][i];
      }
      heat += m * s->a[12][i];
      scale += m * fabs(c->a[4][i] * s->a[0][i]);
      assert_true(s->a[12][i] >= 0 || options.artificial_stress.epsilon > 0);
    }
    assert_true(heat > 0.01 * scale);
    assert_true(fabs(work + strain + heat) < (variant & 4 ? 1e-6 : 1e-12) * scale);
    if (options.gradient_correction.on) { /* the same at the state at hand; in a run B has changed since */
      double given = 0;
      for (size_t i = 0; i < c->n; i++)
        given += c->a[7][i] * s->power[i];
      assert_true(fabs(given - strain) < (variant & 4 ? 1e-6 : 1e-12) * scale);
    }
  }
  unsetenv("CLAST_CPU");
}

/* A linear velocity field comes back exactly with the correction, corners and edges included, in every CPU class. */
TEST(corrected_gradient_is_linear) {
  static const double g[9] = {0.3, -1, 0.2, 1, 0.1, 0.5, -0.2, 0.7, -0.4};
  for (int variant = SANITIZED ? 16 : 0; variant < 3 * 8; variant++) {
    assert_int_equal(setenv("CLAST_CPU", classes[variant / 8], 1), 0);
    OWNED struct cloud *c = cloud_make(12, 1, false, 3);
    for (size_t i = 0; i < c->n; i++)
      for (int a = 0; a < 3; a++)
        c->a[4 + a][i] = 5 + g[3 * a] * c->a[0][i] + g[3 * a + 1] * c->a[1][i] + g[3 * a + 2] * c->a[2][i];
    struct sph_pair_options options = usual;
    options.gradient_correction.on = true;
    options.method.volume_weights = variant & 1;
    options.artificial_stress.epsilon = variant & 2 ? 0.3 : 0;
    options.fidelity.precision = variant & 4 ? SPH_FLOAT : SPH_DOUBLE;
    OWNED struct summed *s = sum(c, &options);
    for (size_t i = 0; i < c->n; i++)
      for (int k = 0; k < 9; k++)
        assert_true(fabs(s->a[3 + k][i] - g[k]) < (variant & 4 ? 1e-4 : 1e-11));
  }
  unsetenv("CLAST_CPU");
}

/* Each pair once, however lists are cut into chunks: equal masses, no stress and unit volume weights, so that each
 * particle's sum is the number of others within the mean of both supports. */
TEST(each_pair_is_summed_once) {
  OWNED struct cloud *c = cloud_make(SIDE, 1, true, 9);
  size_t pairs = 0;
  for (size_t i = 0; i < c->n; i++)
    for (size_t j = i + 1; j < c->n; j++) {
      const double x = c->a[0][i] - c->a[0][j], y = c->a[1][i] - c->a[1][j], z = c->a[2][i] - c->a[2][j],
                   r = c->a[3][i] + c->a[3][j];
      pairs += x * x + y * y + z * z < r * r;
    }
  for (int precision = SPH_DOUBLE; precision <= SPH_FLOAT; precision++) {
    struct sph_pair_options options = usual;
    options.fidelity.precision = precision;
    OWNED struct summed *s = sum(c, &options);
    /* float may decide otherwise for a pair within 1e-6 of the edge: a handful of 3e5 */
    assert_true(fabs(s->neighbours * (double)c->n - 2.0 * (double)pairs) <= (precision == SPH_FLOAT ? 20 : 0.01));
  }
}

/* Without deviators forces are along the line between two particles: sum m x cross a = 0. Viscosity included. With the
 * correction also with deviators, whatever the stress. */
TEST(angular_momentum_is_conserved) {
  for (int corrected = 0; corrected < 2; corrected++) {
    OWNED struct cloud *c = cloud_make(SIDE, 1, !corrected, 10);
    struct sph_pair_options options = usual;
    options.strength = corrected;
    options.gradient_correction.on = corrected;
    OWNED struct summed *s = sum(c, &options);
    double total[3] = {0}, scale = 0;
    for (size_t i = 0; i < c->n; i++)
      for (int k = 0; k < 3; k++) {
        const double part = c->a[7][i] * c->a[(k + 1) % 3][i] * s->a[(k + 2) % 3][i];
        total[k] += part - c->a[7][i] * c->a[(k + 2) % 3][i] * s->a[(k + 1) % 3][i];
        scale += fabs(part);
      }
    for (int k = 0; k < 3; k++)
      assert_true(fabs(total[k]) < 1e-12 * scale); /* 1e4 roundings of either sign */
  }
}

/* Whole matter is in flakes of a few particles. The rest is broken; some of these are loose, others pressed, others
 * between the two. */
static void cloud_break(struct cloud *c) {
  for (size_t i = 0; i < c->n; i++) {
    if (i / 4 % 7 == 0)
      continue;
    c->damage[i] = i % 2 ? 1 : 0.95;                                               /* D = 1, 0.857 */
    c->a[10][i] = fabs(c->a[10][i]) * (i % 5 == 0 ? -1e-3 : i % 11 == 0 ? -1 : 1); /* -1e-3: hardly pressed */
  }
}

/* With surfaces at cracks, with reconstructed velocities, with both: energy and both momenta, also of particles with so
 * few neighbours that their gradient is not, or not wholly, corrected. In every CPU class. */
TEST(surfaces_keep_energy_and_momenta) {
  for (int variant = SANITIZED ? 16 : 0; variant < 3 * 8; variant++) {
    assert_int_equal(setenv("CLAST_CPU", classes[variant / 8], 1), 0);
    OWNED struct cloud *c = cloud_make(SIDE, 1, false, 5);
    cloud_break(c);
    struct sph_pair_options options = usual;
    options.gradient_correction.on = true;
    options.crack_surfaces.on = variant & 1;
    options.reconstruction.on = variant & 2;
    options.fidelity.precision = variant & 4 ? SPH_FLOAT : SPH_DOUBLE;
    OWNED struct summed *s = sum(c, &options);
    double sums[7] = {0}, scale[7] = {0}, between = 0; /* momentum, its moment, energy */
    for (size_t i = 0; i < c->n; i++) {
      const double m = c->a[7][i];
      between += s->share[i] < 1;
      for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        sums[k] += m * s->a[k][i];
        sums[3 + k] += m * (c->a[a][i] * s->a[b][i] - c->a[b][i] * s->a[a][i]);
        sums[6] += m * c->a[4 + k][i] * s->a[k][i];
        scale[k] += m * fabs(s->a[k][i]);
        scale[3 + k] += m * fabs(c->a[a][i] * s->a[b][i]);
        scale[6] += m * fabs(c->a[4 + k][i] * s->a[k][i]);
      }
      sums[6] += m * (s->power[i] + s->a[12][i]);
    }
    assert_true(between > (variant & 1 ? 100 : -1));
    for (int k = 0; k < 7; k++)
      if (!(fabs(sums[k]) < (variant & 4 ? 1e-6 : 1e-12) * scale[k]))
        fail_msg("variant %d, sum %d: %g of %g", variant, k, sums[k], scale[k]);
  }
  unsetenv("CLAST_CPU");
}

/* A whole particle does not see how loose ones fly: its gradient is that of the whole ones, whose field is linear. Nor
 * does its stress act on them: loose particles without stress have no force from it. Pressed ones it sees. */
TEST(loose_neighbours_are_not_felt) {
  static const double g[9] = {0.3, -1, 0.2, 1, 0.1, 0.5, -0.2, 0.7, -0.4};
  for (int variant = 0; variant < 3 * 4; variant++) {
    assert_int_equal(setenv("CLAST_CPU", classes[variant / 4], 1), 0);
    const bool surfaces = variant & 1;
    OWNED struct cloud *c = cloud_make(12, 1, false, 3);
    for (size_t i = 0; i < c->n; i++) {
      const bool loose = i % 7 == 0;
      c->damage[i] = loose, c->factor[i] = loose ? 0 : c->factor[i], c->a[10][i] = loose ? 0 : c->a[10][i];
      for (int a = 0; a < 3 && !loose; a++)
        c->a[4 + a][i] = 5 + g[3 * a] * c->a[0][i] + g[3 * a + 1] * c->a[1][i] + g[3 * a + 2] * c->a[2][i];
    }
    struct sph_pair_options options = usual;
    options.viscosity.alpha = options.viscosity.beta = 0;
    options.gradient_correction.on = true;
    options.crack_surfaces.on = surfaces;
    options.fidelity.precision = variant & 2 ? SPH_FLOAT : SPH_DOUBLE;
    OWNED struct summed *s = sum(c, &options);
    double off = 0, pulled = 0, usual_pull = 0, partly = 0;
    for (size_t i = 0; i < c->n; i++)
      for (int k = 0; k < 9; k++)
        if (i % 7 && s->share[i] < 1)
          partly++;
        else if (i % 7)
          off = fmax(off, fabs(s->a[3 + k][i] - g[k])), usual_pull = fmax(usual_pull, fabs(s->a[k % 3][i]));
        else
          pulled = fmax(pulled, fabs(s->a[k % 3][i]));
    const double rounding = variant & 2 ? 1e-4 : 1e-11;
    assert_true(surfaces ? off < rounding : off > 0.01);
    assert_true(partly < 9 * 10); /* corners */
    assert_true(surfaces ? pulled == 0 : pulled > 0.01 * usual_pull);
  }
  unsetenv("CLAST_CPU");
}

/* Without a body around a particle there is no correction, because its inverse would be noise: in a layer, and in
 * debris of five. A corner of a body is corrected in full. */
TEST(debris_is_not_corrected) {
  struct sph_pair_options options = usual;
  options.gradient_correction.on = true;
  for (int layer = 0; layer < 2; layer++) {
    OWNED struct cloud *c = cloud_make(8, 1, false, 31);
    c->n = layer ? 64 : 5;
    for (size_t i = 0; i < c->n; i++) {
      c->a[0][i] = (double)(i % 8), c->a[1][i] = layer ? (double)(i / 8) : 0.3 * (double)(i % 2),
      c->a[2][i] = layer ? 0 : 0.1 * (double)(i % 3);
    }
    OWNED struct summed *s = sum(c, &options);
    for (size_t i = 0; i < c->n; i++)
      for (int k = 0; k < 6; k++)
        assert_true(s->correction[k][i] == (k == 0 || k == 3 || k == 5));
  }
  OWNED struct cloud *c = cloud_make(8, 1, false, 31);
  for (size_t i = 0; i < c->n; i++) {
    c->a[4][i] = c->a[1][i], c->a[5][i] = -c->a[0][i], c->a[6][i] = 0;
  }
  OWNED struct summed *s = sum(c, &options);
  for (size_t i = 0; i < c->n; i++)
    assert_true(fabs(s->a[4][i] - 1) < 1e-11 && fabs(s->a[6][i] + 1) < 1e-11);
}

/* A body under one stress throughout feels forces at its surface only, and over a cut through it they add up to that
 * stress times the area, to its edge: sum of the forces that one half exerts on the other. Uncorrected they miss some
 * 0.2 h along the rim. */
TEST(one_stress_over_a_cut) {
  enum { ACROSS = 12 };
  const double density = 2, spacing = 1, sigma[6] = {3, 0.5, -0.25, 1, 0.75, 2}, mean = (3 + 1 + 2) / 3.0;
  double off[2];
  for (int corrected = 0; corrected < 2; corrected++) {
    OWNED struct cloud *c = cloud_make(ACROSS, spacing, false, 21);
    for (size_t i = 0; i < c->n; i++) {
      for (int d = 0; d < 3; d++)
        c->a[d][i] = floor(c->a[d][i]) + 0.5;
      c->a[4][i] = c->a[5][i] = c->a[6][i] = 0;
      c->a[7][i] = density * pow(spacing, 3), c->a[8][i] = density;
      c->factor[i] = 1 / (density * density), c->a[10][i] = mean / (density * density);
      for (int k = 0; k < 5; k++)
        c->stress[k][i] = sigma[k] - (k == 0 || k == 3 ? mean : 0);
    }
    struct sph_pair_options options = usual;
    options.gradient_correction.on = corrected;
    OWNED struct summed *s = sum(c, &options);
    double force[3] = {0};
    for (size_t i = 0; i < c->n; i++)
      if (c->a[0][i] < ACROSS / 2.0)
        for (int k = 0; k < 3; k++)
          force[k] += c->a[7][i] * s->a[k][i];
    const double area = pow(ACROSS * spacing, 2);
    off[corrected] = 0;
    for (int k = 0; k < 3; k++)
      off[corrected] = fmax(off[corrected], fabs(force[k] / area - sigma[k]));
  }
  print_message("force over a cut off by %.3g without, %.3g with the correction\n", off[0], off[1]);
  assert_true(off[1] < 1e-12);
  assert_true(off[0] > 0.01);
}

/* Particles that fly apart uniformly feel no viscosity, those that approach do, and it slows them: the sign of eq. 4's
 * missing term. Two particles, by hand: r = h, v.r < 0. */
TEST(viscosity_of_two_by_hand) {
  OWNED struct cloud *c = cloud_make(2, 1, false, 11);
  c->n = 2;
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 11; k++)
      c->a[k][i] = 0;
    for (int k = 0; k < 5; k++)
      c->stress[k][i] = 0;
    c->a[0][i] = i, c->a[3][i] = 1, c->a[7][i] = 2, c->a[8][i] = 4, c->a[9][i] = 3;
    c->a[4][i] = i ? -0.5 : 0.5; /* approach at 1 */
  }
  OWNED struct summed *s = sum(c, &usual);
  const double mu = -1 / 1.01, viscous = (3 * mu * mu - 1.5 * 3 * mu) / 4, slope = -0.75 / M_PI; /* W'(1), h = 1 */
  assert_true(fabs(s->a[0][0] - 2 * viscous * slope) < 1e-14); /* a_0 = -m Pi W' (x_0 - x_1)/r: pushed back */
  assert_true(s->a[0][0] < 0 && fabs(s->a[0][0] + s->a[0][1]) < 1e-15);
  assert_true(fabs(s->a[12][0] - 0.5 * 2 * viscous * -slope) < 1e-14);
  assert_true(fabs(s->a[13][0] + mu) < 1e-15);
  assert_true(fabs(s->a[3][0] - 2.0 / 4 * slope) <
              1e-15); /* dv_x/dx = m/rho (v_1 - v_0) W' (x_0 - x_1)/r: compression */
  for (int i = 0; i < 2; i++)
    c->a[4][i] *= -1;
  OWNED struct summed *apart = sum(c, &usual);
  assert_true(apart->a[0][0] == 0 && apart->a[12][0] == 0 && apart->a[13][0] == 0);
}

/* What is not finite neither crashes nor hangs a search or a sum, and lists are stale at once. */
TEST(not_finite_does_no_harm) {
  OWNED struct cloud *c = cloud_make(10, 1, true, 13);
  static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300};
  struct sph_pairs *pairs;
  for (int precision = SPH_DOUBLE; precision <= SPH_FLOAT; precision++) {
    struct sph_pair_options options = usual;
    OWNED struct summed *s = calloc(1, sizeof *s);
    options.fidelity.precision = precision;
    OK(sph_pairs_create(c->n, &options, &pairs, &error));
    struct sph_pair_fields f = fields_of(c);
    struct sph_pair_sums sums = sums_of(s);
    OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
    for (int k = 0; k < 4; k++) {
      const double x = c->a[k][5 + k];
      c->a[k][5 + k] = bad[k];
      assert_true(slack_of(c, pairs) < 0);
      OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
      sph_pairs_sum(pairs, c->n, &f, pair_sums_keep, &sums);
      c->a[k][5 + k] = x;
    }
    sph_pairs_free(pairs);
  }
}

/* Sums restore the caller's floating-point mode: subnormal numbers are not flushed there. */
TEST(tiny_numbers_stay_the_callers) {
  OWNED struct cloud *c = cloud_make(4, 1, false, 14);
  volatile double least = 0x1p-1022;
  free(sum(c, &usual));
  assert_true(least / 2 > 0);
}

TEST(coincident_particles_do_no_harm) {
  OWNED struct cloud *c = cloud_make(10, 1, false, 6);
  for (int k = 0; k < 3; k++)
    c->a[k][11] = c->a[k][10];
  for (int precision = SPH_DOUBLE; precision <= SPH_FLOAT; precision++) {
    struct sph_pair_options options = usual;
    options.fidelity.precision = precision;
    OWNED struct summed *s = sum(c, &options);
    for (int k = 0; k < SUMS; k++)
      for (size_t i = 0; i < c->n; i++)
        assert_true(isfinite(s->a[k][i]));
  }
}

/* The sums in float are near those in double; frees the cloud. */
static void check_float(struct cloud *c) {
  struct sph_pair_options options = usual;
  OWNED struct summed *exact = reference(c, &options);
  double worst[4];
  options.fidelity.precision = SPH_FLOAT;
  OWNED struct summed *s = sum(c, &options);
  compare(c, s, exact, worst);
  for (int q = 0; q < 4; q++)
    assert_true(worst[q] < 3e-5);
  free(c);
}

/* The same scene 1000 km from the origin: double keeps the precision of its positions, float loses no more than that.
 */
TEST(float_is_as_good_far_away) {
  struct cloud *c = cloud_make(12, 1, false, 7);
  for (size_t i = 0; i < c->n; i++)
    c->a[1][i] += 1e6;
  check_float(c);
}

/* Particles some thousand times larger than the smallest: a pair's distance still fits the integers of float records.
 */
TEST(float_holds_sizes_far_apart) {
  for (double ratio = 10; ratio < 1e5; ratio *= 5) {
    struct cloud *c = cloud_make(8, 1, false, 9);
    const size_t tiny = c->n / 2 + 4; /* one, inside */
    c->a[3][tiny] /= ratio;
    c->slack[tiny] /= ratio;
    check_float(c);
  }
}

/* So many chunks that some are unpacked while others are summed; with the correction and artificial stress on, too. */
TEST(bits_do_not_depend_on_threads) {
  OWNED struct cloud *c = cloud_make(LARGE, 1, true, 8);
  for (int variant = 0; variant < 3; variant++) {
    struct sph_pair_options options = usual;
    options.fidelity.precision = variant == 1 ? SPH_FLOAT : SPH_DOUBLE;
    options.gradient_correction.on = variant == 2;
    options.artificial_stress.epsilon = variant ? 0.3 : 0;
    OWNED struct summed *one = sum(c, &options);
    for (int threads = 2; threads <= 3; threads++) {
      options.fidelity.threads = threads;
      OWNED struct summed *s = sum(c, &options);
      assert_memory_equal(s, one, sizeof *s);
    }
  }
}
/* The particles first .. last - 1 of a cloud. */
static struct cloud *part_of(const struct cloud *c, size_t first, size_t last) {
  struct cloud *part = calloc(1, sizeof *part);
  assert_non_null(part);
  part->n = last - first;
  for (int k = 0; k < COLUMNS; k++)
    memcpy(part->a[k], c->a[k] + first, part->n * sizeof(double));
  for (int k = 0; k < 5; k++)
    memcpy(part->stress[k], c->stress[k] + first, part->n * sizeof(double));
  memcpy(part->factor, c->factor + first, part->n * sizeof(double));
  memcpy(part->slack, c->slack + first, part->n * sizeof(double));
  return part;
}

static double distance2(const struct cloud *c, size_t i, size_t j) {
  const double d[3] = {c->a[0][j] - c->a[0][i], c->a[1][j] - c->a[1][i], c->a[2][j] - c->a[2][i]};
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/* Every pair of different bodies within the support is in the rows of both, once. */
static void check_foreign(const struct cloud *c, const struct sph_pair_options *options) {
  struct sph_pairs *pairs;
  OK(sph_pairs_create(c->n, options, &pairs, &error));
  OK(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], c->slack, &error));
  const struct sph_foreign *f = sph_pairs_foreign(pairs);
  size_t row = 0;
  for (size_t i = 0; i < c->n; i++) {
    size_t expected = 0, found = 0;
    for (size_t j = 0; j < c->n; j++) {
      const double reach = c->a[3][i] + c->a[3][j];
      expected += options->body[i] != options->body[j] && distance2(c, i, j) < reach * reach;
    }
    if (row < f->count && f->row[row].particle == i) {
      for (size_t k = f->row[row].first; k < f->row[row + 1].first; k++) {
        const size_t j = f->row[f->other[k]].particle;
        const double reach = c->a[3][i] + c->a[3][j];
        assert_int_not_equal(options->body[i], options->body[j]);
        found += distance2(c, i, j) < reach * reach;
      }
      row++;
    }
    assert_int_equal(found, expected);
  }
  assert_int_equal(row, f->count);
  sph_pairs_free(pairs);
}

/* Bodies that are told apart have the sums of bodies that are alone, in a group of particles that share a list, too;
 * and their pairs are in the rows. Tolerances as for kernels_equal_plain_c. */
TEST(bodies_apart_are_alone) {
  static const size_t end[] = {0, 1001, 1778}; /* odd, so that two bodies share a list */
  OWNED struct cloud *c = cloud_make(15, 1, true, 11);
  OWNED uint8_t *body = malloc(c->n);
  assert_non_null(body);
  for (size_t i = 0; i < c->n; i++)
    body[i] = (uint8_t)((i >= end[1]) + (i >= end[2]));
  for (int variant = 0; variant < 4; variant++) {
    struct sph_pair_options options = usual, alone = usual;
    options.fidelity.precision = alone.fidelity.precision = variant & 1 ? SPH_FLOAT : SPH_DOUBLE;
    options.gradient_correction.on = alone.gradient_correction.on = variant & 2;
    options.body = body;
    OWNED struct summed *all = sum(c, &options);
    for (int b = 0; b < 3; b++) {
      const size_t last = b < 2 ? end[b + 1] : c->n;
      OWNED struct cloud *part = part_of(c, end[b], last);
      OWNED struct summed *own = sum(part, &alone);
      for (int k = 0; k < SUMS; k++) {
        double scale = 0;
        for (size_t i = 0; i < part->n; i++)
          scale = fmax(scale, fabs(own->a[k][i]));
        for (size_t i = 0; i < part->n; i++)
          assert_true(fabs(all->a[k][end[b] + i] - own->a[k][i]) <= (variant & 1 ? 1e-4 : 1e-12) * scale);
      }
    }
    check_foreign(c, &options);
  }
}
