/* The pair loop: lists against brute force, conservation, and fields whose gradient is known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "engine/sph/neighbours.h"
#include "engine/sph/order.h"
#include "engine/sph/pairs.h"

enum { SIDE = 9, MOST = SIDE * SIDE * SIDE };

struct cloud {
  double a[12][MOST], stress[6][MOST];
  size_t n;
};

static double noise(uint64_t *state) { /* splitmix64, -1/2..1/2 */
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return (double)((z ^ z >> 31) >> 11) * 0x1p-53 - 0.5;
}

/* A jittered cubic lattice of spacing 1 with all fields drawn; every tenth particle is up to 3 times larger when `mixed`. */
static struct cloud *cloud_make(bool mixed, uint64_t seed) {
  struct cloud *c = calloc(1, sizeof *c);
  assert_non_null(c);
  for (int i = 0; i < MOST; i++, c->n++) {
    c->a[0][i] = i % SIDE + 0.2 * noise(&seed), c->a[1][i] = i / SIDE % SIDE + 0.2 * noise(&seed);
    c->a[2][i] = i / SIDE / SIDE + 0.2 * noise(&seed);
    c->a[3][i] = 1.2 * (mixed && i % 10 == 0 ? 2 + noise(&seed) : 1);
    for (int k = 4; k < 7; k++)
      c->a[k][i] = noise(&seed);
    c->a[7][i] = 1 + noise(&seed), c->a[8][i] = 1 + 0.1 * noise(&seed), c->a[9][i] = 1 + 0.2 * noise(&seed);
    c->a[10][i] = noise(&seed);
    for (int k = 0; k < 6; k++)
      c->stress[k][i] = noise(&seed);
  }
  return c;
}

struct summed {
  double ax[MOST], ay[MOST], az[MOST], gradient[9][MOST], heating[MOST], signal[MOST];
};

static void sum(struct cloud *c, const struct sph_pair_options *options, struct summed *out) {
  struct sph_pairs *pairs;
  struct error error = {0};
  assert_int_equal(sph_pairs_create(c->n, options, &pairs, &error), STATUS_OK);
  assert_true(sph_pairs_stale(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3]));
  assert_int_equal(sph_pairs_list(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3], &error), STATUS_OK);
  assert_false(sph_pairs_stale(pairs, c->n, c->a[0], c->a[1], c->a[2], c->a[3]));
  struct sph_pair_fields f = {c->a[0], c->a[1], c->a[2], c->a[3], c->a[4], c->a[5], c->a[6], c->a[7], c->a[8], c->a[9], c->a[10], {0}};
  struct sph_pair_sums s = {.ax = out->ax, .ay = out->ay, .az = out->az, .heating = out->heating, .signal = out->signal};
  for (int k = 0; k < 6; k++)
    f.stress[k] = c->stress[k];
  for (int k = 0; k < 9; k++)
    s.gradient[k] = out->gradient[k];
  sph_pairs_sum(pairs, c->n, &f, &s);
  sph_pairs_free(pairs);
}

static const struct sph_pair_options usual = {
    .viscosity_alpha = 1.5, .viscosity_beta = 3, .strength = true, .periodic = {NAN, NAN, NAN}, .skin = 0.1, .threads = 1};

static void momentum_is_conserved(void **state) {
  (void)state;
  struct cloud *c = cloud_make(true, 1);
  struct summed *s = calloc(1, sizeof *s);
  sum(c, &usual, s);
  double total[3] = {0}, scale = 0;
  for (size_t i = 0; i < c->n; i++) {
    total[0] += c->a[7][i] * s->ax[i], total[1] += c->a[7][i] * s->ay[i], total[2] += c->a[7][i] * s->az[i];
    scale += c->a[7][i] * fabs(s->ax[i]);
  }
  for (int k = 0; k < 3; k++)
    assert_true(fabs(total[k]) < 1e-13 * scale);
  free(s), free(c);
}

/* With eq. 18 over rho_i the gradient is the conjugate of eq. 17: sum m v.a + sum m (sigma/rho^2 rho : grad v) = -viscous heat. */
static void work_equals_strain_energy(void **state) {
  (void)state;
  struct cloud *c = cloud_make(true, 2);
  struct summed *s = calloc(1, sizeof *s);
  sum(c, &usual, s);
  double work = 0, strain = 0, heat = 0, scale = 0;
  for (size_t i = 0; i < c->n; i++) {
    double m = c->a[7][i];
    work += m * (c->a[4][i] * s->ax[i] + c->a[5][i] * s->ay[i] + c->a[6][i] * s->az[i]);
    static const int at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    for (int k = 0; k < 9; k++) {
      double sigma = c->stress[at[k]][i] + (k % 4 == 0 ? c->a[10][i] : 0);
      strain += m * c->a[8][i] * sigma * s->gradient[k][i];
    }
    heat += m * s->heating[i];
    scale += m * fabs(c->a[4][i] * s->ax[i]);
    assert_true(s->heating[i] >= 0);
  }
  assert_true(heat > 0.01 * scale);
  assert_true(fabs(work + strain + heat) < 1e-12 * scale);
  free(s), free(c);
}

/* A linear velocity field comes back exactly with the correction, and a rigid rotation without any strain. */
static void corrected_gradient_is_linear(void **state) {
  (void)state;
  struct cloud *c = cloud_make(false, 3);
  struct summed *s = calloc(1, sizeof *s);
  static const double g[9] = {0.3, -1, 0.2, 1, 0.1, 0.5, -0.2, 0.7, -0.4};
  for (size_t i = 0; i < c->n; i++)
    for (int a = 0; a < 3; a++)
      c->a[4 + a][i] = 5 + g[3 * a] * c->a[0][i] + g[3 * a + 1] * c->a[1][i] + g[3 * a + 2] * c->a[2][i];
  struct sph_pair_options options = usual;
  options.gradient_correction = true;
  sum(c, &options, s);
  for (size_t i = 0; i < c->n; i++)
    for (int k = 0; k < 9; k++)
      assert_true(fabs(s->gradient[k][i] - g[k]) < 1e-11);
  free(s), free(c);
}

static void lists_equal_brute_force(void **state) {
  (void)state;
  for (int periodic = 0; periodic < 2; periodic++) {
    struct cloud *c = cloud_make(true, 4);
    c->a[0][17] = 1e9, c->a[1][20] = -1e15; /* fragments far off cost nothing */
    double length[3] = {periodic ? 9 : (double)NAN, NAN, periodic ? 12 : (double)NAN}, skin = 0.05;
    if (periodic)
      for (size_t i = 0; i < c->n; i++)
        c->a[3][i] = fmin(c->a[3][i], 2);
    struct sph_neighbours lists = {0};
    struct error error = {0};
    assert_int_equal(sph_neighbours_find(c->n, c->a[0], c->a[1], c->a[2], c->a[3], skin, length, &lists, &error), STATUS_OK);
    assert_true(lists.capacity < 200 * c->n);
    size_t at = 0;
    for (size_t i = 0; i < c->n; i++) {
      assert_int_equal(lists.first[i], at);
      for (size_t j = i + 1; j < c->n; j++) {
        double square = 0, reach = (c->a[3][i] + c->a[3][j]) * (1 + skin);
        for (int d = 0; d < 3; d++) {
          double along = c->a[d][i] - c->a[d][j];
          if (!isnan(length[d])) along -= length[d] * nearbyint(along / length[d]);
          square += along * along;
        }
        if (square < reach * reach) assert_int_equal(lists.j[at++], j);
      }
    }
    assert_int_equal(lists.count, at);
    sph_neighbours_clear(&lists);
    free(c);
  }
}

static void order_is_a_permutation_that_keeps_neighbours_near(void **state) {
  (void)state;
  struct cloud *c = cloud_make(false, 5);
  uint32_t order[MOST];
  struct error error = {0};
  c->a[2][3] = 1e9; /* the rest must not fall into one cell */
  assert_int_equal(sph_order_find(c->n, c->a[0], c->a[1], c->a[2], order, &error), STATUS_OK);
  char seen[MOST] = {0};
  double step = 0;
  for (size_t k = 0; k < c->n; k++) {
    assert_false(seen[order[k]]);
    seen[order[k]] = 1;
    if (k && order[k] != 3 && order[k - 1] != 3)
      step += sqrt(pow(c->a[0][order[k]] - c->a[0][order[k - 1]], 2) + pow(c->a[1][order[k]] - c->a[1][order[k - 1]], 2) +
                   pow(c->a[2][order[k]] - c->a[2][order[k - 1]], 2));
  }
  assert_true(step / (double)c->n < 2.5); /* spacing 1; drawn at random it would be about 5 */
  free(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momentum_is_conserved), cmocka_unit_test(work_equals_strain_energy),
      cmocka_unit_test(corrected_gradient_is_linear), cmocka_unit_test(lists_equal_brute_force),
      cmocka_unit_test(order_is_a_permutation_that_keeps_neighbours_near)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
