/* Flaws as points in a body: uniform, owned by the nearest particle, the same at every resolution; ends without flaws;
 * graded bodies; the law's scatter and its extremes. */

#include "analysis/statistics/statistics.h"
#include "engine/random.h"
#include "engine/sph/body/flaws.h"
#include "engine/sph/body/kd_tree.h"
#include "tests/support/check.h"

static struct sph_body sphere(double particles) {
  return (struct sph_body){.shape = {.kind = SPH_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 0.03},
                           .lattice = {.particles = particles},
                           .density = 2700,
                           .h_over_spacing = NAN};
}

static struct sph_particles *make(const struct sph_body *body, int arrays, struct sph_range *range) {
  struct sph_particles *p = NULL;
  assert_int_equal(sph_bodies_make(body, 1, arrays, &p, range, NULL), STATUS_OK);
  return p;
}

static struct sph_flaws *place(const struct sph_flaw_law *law, const struct sph_body *body,
                               const struct sph_particles *p, struct sph_range range, double half) {
  struct sph_flaws *flaws = NULL;
  OK(sph_flaws_place(law, &body->shape, p, range, half, &flaws, &error));
  return flaws;
}

static struct sph_flaws *flaws_of(const struct sph_body *body, const struct sph_particles *p, struct sph_range range,
                                  int draw, uint64_t seed, double half) {
  const struct sph_flaw_law law = {.weibull = {8.5, 5e34}, .draw = draw, .seed = seed};
  return place(&law, body, p, range, half);
}

static size_t brute(size_t n, const double *x, const double *y, const double *z, const double q[3], size_t self) {
  size_t best = SIZE_MAX;
  double least = HUGE_VAL;
  for (size_t i = 0; i < n; i++) {
    const double dx = q[0] - x[i], dy = q[1] - y[i], dz = q[2] - z[i], squares = dx * dx + dy * dy + dz * dz;
    if (i != self && squares < least) {
      least = squares;
      best = i;
    }
  }
  return best;
}

/* On random points, on a lattice searched at its own points and half-way between them (ties), on points in a line and
 * all at one place. */
TEST(nearest_is_the_nearest) {
  enum { MOST = 700 };
  double x[MOST], y[MOST], z[MOST];
  uint32_t within[MOST];
  for (int kind = 0; kind < 4; kind++)
    for (size_t n = 1; n <= MOST; n = n * 3 + 1) {
      for (size_t i = 0; i < n; i++) {
        x[i] = kind == 0 ? random_draw(1, 1, 1, i) : kind == 1 ? (double)(i % 9) : kind == 2 ? (double)i : 5;
        y[i] = kind == 0 ? random_draw(1, 1, 2, i) : kind == 1 ? (double)(i / 9 % 9) : 3;
        z[i] = kind == 0 ? pow(random_draw(1, 1, 3, i), 4) : kind == 1 ? (double)(i / 81) : 2;
      }
      struct sph_kd_tree *tree = NULL;
      assert_int_equal(sph_kd_tree_create(n, x, y, z, &tree, NULL), STATUS_OK);
      for (uint64_t k = 0; k < 300; k++) {
        double q[3] = {random_draw(2, 1, 1, k), random_draw(2, 1, 2, k), random_draw(2, 1, 3, k)};
        for (int d = 0; d < 3 && kind; d++)
          q[d] = floor(q[d] * 20) / 2 - 0.5;
        assert_int_equal(sph_kd_tree_find(tree, q), brute(n, x, y, z, q, SIZE_MAX));
        assert_int_equal(sph_kd_tree_other(tree, q, k % n), brute(n, x, y, z, q, k % n));
        const double radius = kind ? 2 : 0.2;
        size_t count = 0;
        for (size_t i = 0; i < n; i++)
          count += pow(q[0] - x[i], 2) + pow(q[1] - y[i], 2) + pow(q[2] - z[i], 2) <= radius * radius;
        assert_int_equal(sph_kd_tree_within(tree, q, radius, within, MOST), count);
        assert_int_equal(sph_kd_tree_within(tree, q, radius, within, 1), count);
      }
      sph_kd_tree_free(tree);
    }
}

/* Number of flaws drawn at places of n particles; later entries were given to particles without one. */
static size_t drawn(size_t n) {
  return (size_t)ceil((double)n * (log((double)n) + 0.5772156649015329));
}

/* Each flaw belongs to the particle nearest to its place. It is found by its strength, which is unique for ranked
 * flaws. */
TEST(owners_are_nearest) {
  const struct sph_body body = sphere(300);
  struct sph_range range;
  struct sph_particles *p = make(&body, 0, &range);
  SPH_FLAWS *flaws = flaws_of(&body, p, range, SPH_FLAWS_RANKED, 5, INFINITY);
  const double log_kv = log(5e34) + log(sph_shape_volume(&body.shape));
  OWNED unsigned char *seen = calloc(flaws->count, 1);
  for (size_t i = 0; i < p->n; i++) {
    assert_true(flaws->first[i + 1] > flaws->first[i]); /* each has one */
    for (size_t f = flaws->first[i]; f < flaws->first[i + 1]; f++) {
      const double rank = exp(8.5 * flaws->log_strain[f] + log_kv);
      const uint64_t j = (uint64_t)llround(rank) - 1;
      double q[3];
      if (rank > (double)drawn(p->n) + 0.5) { /* given to a particle that got none */
        assert_int_equal(flaws->first[i + 1] - flaws->first[i], 1);
        continue;
      }
      assert_true(fabs(rank - (double)(j + 1)) < 1e-6 && j < flaws->count && !seen[j]);
      seen[j] = 1;
      sph_flaws_point(5, 0, j, &body.shape, q);
      assert_int_equal(brute(p->n, p->x, p->y, p->z, q, SIZE_MAX), i);
    }
  }
  sph_particles_free(p);
}

/* Coarse or fine, a seed means the same flaws: the same strengths at the same places. A flaw of a fine particle belongs
 * to the coarse particle nearest to its place; so both lie within a coarse particle's reach of the place, and of each
 * other. */
TEST(a_seed_means_the_same_flaws) {
  const struct sph_body coarse = sphere(400), fine = sphere(3000);
  struct sph_range a, b;
  SPH_PARTICLES *p = make(&coarse, 0, &a), *q = make(&fine, 0, &b);
  for (int draw = 0; draw < 2; draw++) {
    SPH_FLAWS *few = flaws_of(&coarse, p, a, draw, 9, INFINITY), *many = flaws_of(&fine, q, b, draw, 9, INFINITY);
    assert_true(many->count > few->count);
    OWNED size_t *owner = malloc(many->count * sizeof *owner);
    OWNED double *sorted = malloc(many->count * sizeof *sorted), *all = malloc(few->count * sizeof *all);
    memcpy(sorted, many->log_strain, many->count * sizeof *sorted);
    memcpy(all, few->log_strain, few->count * sizeof *all);
    qsort(sorted, many->count, sizeof *sorted, sample_ascending);
    qsort(all, few->count, sizeof *all, sample_ascending);
    const size_t same = drawn(p->n);
    assert_true(same <= few->count && few->count < same + same / 100);
    assert_memory_equal(sorted, all, same * sizeof *all); /* the weakest are the same ones */
    for (size_t i = 0; i < q->n; i++)
      for (size_t f = many->first[i]; f < many->first[i + 1]; f++) {
        const double *at = bsearch(&many->log_strain[f], sorted, many->count, sizeof *sorted, sample_ascending);
        owner[at - sorted] = i;
      }
    for (size_t i = 0; i < p->n; i++)
      for (size_t f = few->first[i]; f < few->first[i + 1]; f++) {
        if (few->log_strain[f] > all[same - 1])
          continue;
        const double *at = bsearch(&few->log_strain[f], sorted, many->count, sizeof *sorted, sample_ascending);
        assert_non_null(at);
        const uint64_t flaw = (uint64_t)(at - sorted);
        const size_t j = owner[flaw];
        double place[3];
        sph_flaws_point(9, 0, flaw, &coarse.shape, place);
        assert_int_equal(brute(p->n, p->x, p->y, p->z, place, SIZE_MAX), i);
        const double apart = hypot(hypot(p->x[i] - q->x[j], p->y[i] - q->y[j]), p->z[i] - q->z[j]);
        assert_true(apart <
                    1.2 * (a.spacing + b.spacing)); /* each within some 0.8 spacings, at corners of the cut more */
      }
  }
}

/* About n (ln n + 0.58) flaws, as for random particles, plus one for each particle that got none: 0.56 with equal
 * cells, some more with those that the surface cuts: below 0.5 % of n. */
TEST(particles_have_ln_n_flaws) {
  const struct sph_body body = sphere(2000);
  struct sph_range range;
  SPH_PARTICLES *p = make(&body, 0, &range);
  double sum = 0;
  for (uint64_t seed = 0; seed < 12; seed++) {
    SPH_FLAWS *flaws = flaws_of(&body, p, range, SPH_FLAWS_POISSON, seed, INFINITY);
    for (size_t i = 0; i < p->n; i++) {
      assert_true(flaws->first[i + 1] > flaws->first[i]);
      for (size_t f = flaws->first[i] + 1; f < flaws->first[i + 1]; f++)
        assert_true(flaws->log_strain[f] >= flaws->log_strain[f - 1]);
    }
    sum += (double)flaws->count / 12;
  }
  const double n = (double)p->n, want = n * (log(n) + 0.5772156649);
  assert_true(sum >= want && sum < want + 0.005 * n);
}

/* The weakest of the body: mean and CV (0.140 at m = 8.5) of (E/kV)^(1/m). 3000 seeds: the CV's standard error is about
 * 1.5 % of it (its distribution is skew), the mean's 0.14/sqrt(3000) = 0.26 %; four of each. V is the solid volume. */
TEST(the_weakest_scatters_by_the_law) {
  const struct sph_body body = sphere(8);
  struct sph_range range;
  SPH_PARTICLES *p = make(&body, 0, &range);
  const int seeds = 3000;
  double sum = 0, squares = 0;
  for (int seed = 0; seed < seeds; seed++) {
    const struct sph_flaw_law law = {.weibull = {8.5, 5e34},
                                     .solid_ratio = 2,
                                     .draw = SPH_FLAWS_POISSON,
                                     .seed = (uint64_t)seed};
    SPH_FLAWS *flaws = place(&law, &body, p, range, INFINITY);
    double least = HUGE_VAL;
    for (size_t f = 0; f < flaws->count; f++)
      least = fmin(least, flaws->log_strain[f]);
    const double strain = exp(least + (log(5e34) + log(sph_shape_volume(&body.shape) / 2)) / 8.5);
    sum += strain;
    squares += strain * strain;
  }
  const double mean = sum / seeds, cv = sqrt(squares / seeds - mean * mean) / mean;
  assert_true(fabs(mean / tgamma(1 + 1 / 8.5) - 1) < 0.0105);
  assert_true(fabs(cv / 0.1402 - 1) < 0.06);
}

/* Ends have no flaws; the middle has its own, as dense as without ends: the strengths of those places are unchanged. */
TEST(ends_have_none) {
  const struct sph_body rod = {.shape = {.kind = SPH_SHAPE_CYLINDER, .radius = 0.01, .length = 0.04, .axis = {0, 0, 1}},
                               .lattice = {.particles = 1500},
                               .density = 2700,
                               .h_over_spacing = NAN};
  struct sph_range range;
  struct sph_particles *p = make(&rod, 0, &range);
  struct sph_flaws *with = flaws_of(&rod, p, range, SPH_FLAWS_RANKED, 1, 0.012);
  struct sph_flaws *without = flaws_of(&rod, p, range, SPH_FLAWS_RANKED, 1, INFINITY);
  const double log_kv = log(5e34) + log(sph_shape_volume(&rod.shape));
  size_t ends = 0, common = 0;
  for (size_t i = 0; i < p->n; i++) {
    const size_t n = with->first[i + 1] - with->first[i], all = without->first[i + 1] - without->first[i];
    if (fabs(p->z[i]) > 0.012) {
      assert_int_equal(n, 0);
      ends++;
    } else {
      assert_true(n > 0);
      for (size_t f = with->first[i]; f < with->first[i + 1]; f++) { /* and its place is in the middle */
        const double rank = exp(8.5 * with->log_strain[f] + log_kv);
        double place[3];
        if (rank > (double)drawn(p->n) + 0.5)
          continue;
        sph_flaws_point(1, 0, (uint64_t)llround(rank) - 1, &rod.shape, place);
        assert_true(fabs(place[2]) <= 0.012);
      }
      /* far from the border: the same flaws, up to where the shorter draw ended */
      for (size_t f = 0; f < n && f < all && fabs(p->z[i]) < 0.012 - 1.5 * range.spacing; f++, common++)
        assert_true(with->log_strain[with->first[i] + f] == without->log_strain[without->first[i] + f]);
    }
  }
  assert_true(ends > 400 && ends < 800 && common > 2000); /* 40 % of 1500 */
  sph_flaws_free(with);
  sph_flaws_free(without);
  const struct sph_flaw_law law = {.weibull = {8.5, 5e34}, .seed = 1};
  assert_int_equal(sph_flaws_place(&law, &rod.shape, p, range, -1, &with, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "flaw-free ends"));
  assert_null(with);
  sph_particles_free(p);
}

/* Small particles of a graded body are as strong as their size says: with kV_i the expected number below strain 1, k
 * V_i eps_min^m is a unit exponential for each particle, whether its flaw was drawn or given to it. Means over classes
 * of size, against 1 within 4 standard errors 1/sqrt(n); nearest-particle cells differ from V_i by some per cent (5 %
 * room). */
TEST(graded_particles_have_their_weakest) {
  const struct sph_body body =
      {.shape = {.kind = SPH_SHAPE_BOX, .side = {0.2, 0.2, 0.2}},
       .lattice = {.particles = NAN, .grading = {.fine = 2e-3, .point = {0, 0, 0.1}, .radius = 8e-3, .growth = 0.12}},
       .density = 2940,
       .h_over_spacing = NAN};
  struct sph_range range;
  SPH_PARTICLES *p = make(&body, 0, &range);
  double most = 0, sum[4] = {0};
  int count[4] = {0}, waited = 0;
  for (size_t i = 0; i < p->n; i++)
    most = fmax(most, p->mass[i]);
  for (uint64_t seed = 0; seed < 8; seed++)
    for (int draw = 0; draw < 2; draw++) {
      const struct sph_flaw_law law = {.weibull = {3, 1.39e18}, .draw = draw, .seed = seed};
      SPH_FLAWS *flaws = NULL;
      assert_int_equal(sph_flaws_place(&law, &body.shape, p, range, INFINITY, &flaws, NULL), STATUS_OK);
      const double n = (double)p->n, common = ceil(n * (log(n) + 0.5772156649015329));
      assert_true((double)flaws->count >= common && (double)flaws->count < common + n);
      waited += (int)((double)flaws->count - common);
      for (size_t i = 0; i < p->n; i++) {
        assert_true(flaws->first[i + 1] > flaws->first[i]);
        const double volume = p->mass[i] / 2940;
        const int size = (int)fmin(3, floor(log10(most / p->mass[i]) * 1.5));
        sum[size] += exp(3 * flaws->log_strain[flaws->first[i]] + log(1.39e18) + log(volume));
        count[size]++;
      }
    }
  assert_true(waited > 1000); /* particles of the second kind exist */
  for (int k = 0; k < 4; k++) {
    assert_true(count[k] > 1000);
    assert_true(fabs(sum[k] / count[k] - 1) < 0.05 + 4 / sqrt(count[k]));
  }
}

TEST(extremes_of_the_law) {
  const struct sph_body body = sphere(60);
  struct sph_range range;
  struct sph_particles *p = make(&body, 0, &range);
  const double ms[] = {1, 8.5, 200}, ks[] = {1, 1e34, 1e200, 1e300};
  struct sph_flaws *flaws = NULL;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      for (int draw = 0; draw < 2; draw++) {
        const struct sph_flaw_law law = {.weibull = {ms[i], ks[j]}, .draw = draw, .seed = 2};
        assert_int_equal(sph_flaws_place(&law, &body.shape, p, range, INFINITY, &flaws, NULL), STATUS_OK);
        for (size_t f = 0; f < flaws->count; f++)
          assert_true(isfinite(flaws->log_strain[f]));
        sph_flaws_free(flaws);
      }
  const double bad[] = {0, -1, NAN, HUGE_VAL};
  for (int k = 0; k < 4; k++)
    for (int which = 0; which < 2; which++) {
      const struct sph_flaw_law law = {.weibull = {which ? 9 : bad[k], which ? bad[k] : 1e30}, .seed = 2};
      assert_int_equal(sph_flaws_place(&law, &body.shape, p, range, INFINITY, &flaws, &error), STATUS_CONTENT);
      assert_null(flaws);
    }
  sph_particles_free(p);
  const struct sph_body one = sphere(1);
  p = make(&one, 0, &range);
  flaws = flaws_of(&one, p, range, SPH_FLAWS_POISSON, 3, INFINITY);
  assert_int_equal(flaws->count, 1);
  sph_flaws_free(flaws);
  sph_particles_free(p);
}
