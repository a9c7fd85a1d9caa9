/* Lattices: numbers, neighbours, density sums, moments; periodic fits; irregular and graded points. */

#include "engine/sph/body/bodies.h"
#include "engine/sph/body/kd_tree.h"
#include "tests/support/check.h"

static const struct sph_shape sphere = {.kind = SPH_SHAPE_SPHERE, .centre = {1, -2, 3}, .radius = 0.5};
static const struct sph_shape rod = {.kind = SPH_SHAPE_CYLINDER,
                                     .centre = {1, -2, 3},
                                     .radius = 0.5,
                                     .length = 2,
                                     .axis = {0.6, 0, 0.8}};
static const struct sph_shape cube = {.kind = SPH_SHAPE_BOX, .centre = {1, -2, 3}, .side = {1, 1, 1}};
static const struct sph_shape brick = {.kind = SPH_SHAPE_BOX, .centre = {0.5, 0.15, 0.1}, .side = {1, 0.3, 0.2}};

static struct sph_points fill(const struct sph_shape *shape, struct sph_lattice lattice) {
  struct sph_points points;
  OK(sph_lattice_fill(&lattice, shape, &points, &error));
  return points;
}

static struct sph_kd_tree *tree_of(const struct sph_points *points) {
  struct sph_kd_tree *tree = NULL;
  assert_int_equal(sph_kd_tree_create(points->n, points->x, points->y, points->z, &tree, NULL), STATUS_OK);
  return tree;
}

static double spline(double r, double h) { /* Monaghan & Lattanzio 1985, three dimensions */
  const double q = r / h, s = 1 / (M_PI * h * h * h);
  return q < 1 ? s * (1 - 1.5 * q * q + 0.75 * q * q * q) : q < 2 ? s * 0.25 * (2 - q) * (2 - q) * (2 - q) : 0;
}

struct around {
  int within;      /* 2h, itself not counted */
  double sum;      /* of m W over the density */
  double nearest;  /* m */
  double steepest; /* largest spacing of a near one over its own */
};

/* The neighbours of point i, with all 27 images where `length` says that a direction repeats. */
static struct around look(const struct sph_points *points, const struct sph_kd_tree *tree, size_t i,
                          const double *length) {
  enum { ROOM = 4096 };
  static uint32_t near[ROOM];
  const double own = points->share ? cbrt(points->share[i]) : 1, h = SPH_BODIES_H * points->spacing;
  struct around around = {.nearest = HUGE_VAL, .steepest = 1};
  for (int image = 0; image < 27; image++) {
    const int shift[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
    if (!length && image != 13)
      continue;
    double p[3] = {points->x[i], points->y[i], points->z[i]};
    int repeats = 1;
    for (int k = 0; k < 3; k++)
      if (length && shift[k]) {
        repeats &= length[k] > 0;
        p[k] += shift[k] * length[k];
      }
    if (!repeats)
      continue;
    const size_t found = sph_kd_tree_within(tree, p, 2.6 * h * own, near, ROOM);
    assert_true(found <= ROOM);
    for (size_t k = 0; k < found; k++) {
      const size_t j = near[k];
      const double r = hypot(hypot(p[0] - points->x[j], p[1] - points->y[j]), p[2] - points->z[j]);
      const double other = points->share ? cbrt(points->share[j]) : 1, both = 0.5 * h * (own + other);
      around.sum += (points->share ? points->share[j] : 1) * pow(points->spacing, 3) * spline(r, both);
      if (r == 0)
        continue;
      around.within += r < 2 * both;
      if (r < around.nearest)
        around.nearest = r;
      if (r < 1.3 * own * points->spacing)
        around.steepest = fmax(around.steepest, other / own);
    }
  }
  return around;
}

static double depth_of(const struct sph_shape *shape, const struct sph_points *points, size_t i) {
  return -sph_shape_distance(shape, (double[3]){points->x[i], points->y[i], points->z[i]}, NULL);
}

/* Cut by a surface: within 0.2 % (the search's own limit), exact where 0.2 % is less than one particle. */
TEST(numbers_come_out) {
  const double wanted[] = {1, 2, 3, 5, 13, 57, 100, 500, 2000, 10000, 95000};
  for (int kind = 0; kind < 2; kind++)
    for (int turned = 0; turned < 2; turned++)
      for (int k = 0; k < 11; k++) {
        struct sph_points p = fill(&sphere, (struct sph_lattice){.kind = kind,
                                                                 .particles = wanted[k],
                                                                 .turned = turned,
                                                                 .seed = 4});
        assert_true(fabs((double)p.n - wanted[k]) <= 0.002 * wanted[k]);
        assert_true(fabs(p.spacing * p.spacing * p.spacing * (double)p.n / sph_shape_volume(&sphere) - 1) < 1e-12);
        sph_lattice_empty(&p);
        if (wanted[k] < 1000 && !turned)
          continue; /* few layers: a cylinder's numbers are coarse */
        p = fill(&rod, (struct sph_lattice){.kind = kind, .particles = wanted[k], .turned = turned, .seed = 4});
        assert_true(fabs((double)p.n - wanted[k]) <= 0.01 * wanted[k]);
        sph_lattice_empty(&p);
      }
  /* Fitted boxes have whole planes. The number is right to 1 % from 12 000 on, where a cube has 22 planes and the three
   * directions of the hexagonal lattice differ; in long bars also with fewer. */
  for (double n = 12000; n < 120000; n *= 1.23) {
    struct sph_points p = fill(&cube, (struct sph_lattice){.particles = n});
    assert_true(fabs((double)p.n / n - 1) < 0.01 && p.stretch < 1.03);
    sph_lattice_empty(&p);
  }
  const struct sph_shape bar = {.kind = SPH_SHAPE_BOX, .side = {10, 1, 1}};
  struct sph_points p = fill(&bar, (struct sph_lattice){.particles = 4321});
  assert_true(fabs((double)p.n / 4321 - 1) < 0.01);
  sph_lattice_empty(&p);
  /* set by spacing */
  p = fill(&sphere, (struct sph_lattice){.particles = NAN, .spacing = 0.05});
  assert_true(fabs(p.spacing / 0.05 - 1) < 0.001);
  sph_lattice_empty(&p);
}

/* Inside: 12 neighbours at 2^(1/6) spacings and 6 at 1, 56 within 2h for both, and the same density sum at each. */
TEST(neighbours_of_regular_lattices) {
  for (int kind = 0; kind < 2; kind++)
    for (int turned = 0; turned < 2; turned++) {
      struct sph_points p = fill(&sphere,
                                 (struct sph_lattice){.kind = kind, .particles = 4000, .turned = turned, .seed = 9});
      struct sph_kd_tree *tree = tree_of(&p);
      double low = HUGE_VAL, high = 0;
      int inner = 0;
      for (size_t i = 0; i < p.n; i++) {
        assert_true(depth_of(&sphere, &p, i) > -0.05 * p.spacing); /* scaled and centred after the cut */
        if (depth_of(&sphere, &p, i) < 2.5 * p.spacing)
          continue;
        const struct around a = look(&p, tree, i, NULL);
        uint32_t near[64];
        const double at[3] = {p.x[i], p.y[i], p.z[i]};
        assert_int_equal(a.within, 56);
        assert_true(fabs(a.nearest / p.nearest - 1) < 1e-9);
        assert_int_equal(sph_kd_tree_within(tree, at, p.nearest * 1.001, near, 64), (kind ? 6 : 12) + 1);
        low = fmin(low, a.sum);
        high = fmax(high, a.sum);
        inner++;
      }
      assert_true(inner > 1000);
      assert_true(fabs(p.nearest / p.spacing - (kind ? 1 : pow(2, 1. / 6))) < 1e-12);
      assert_true(high - low < 1e-9);    /* a lattice is the same everywhere, to the rounding of places */
      assert_true(fabs(low - 1) < 0.01); /* the spline's own error of summing at this h */
      sph_kd_tree_free(tree);
      sph_lattice_empty(&p);
    }
}

/* Centre of mass exactly; moments of inertia tend to the sphere's 2/5 M R^2 and the cylinder's, products to 0. The
 * surface's roughness is what differs, about n^(-2/3): 1 % at 1000 (twice that is allowed), 0.1 % at 50 000 (three
 * times). */
TEST(moments_tend_to_the_shape) {
  const double numbers[] = {1000, 50000}, room[] = {0.02, 0.003};
  for (int k = 0; k < 2; k++)
    for (int kind = 0; kind < 3; kind++)
      for (int s = 0; s < 2; s++) {
        if (kind == SPH_LATTICE_IRREGULAR && k == 1)
          continue; /* its surface is a layer of its own: only roughly */
        const struct sph_shape *shape = s ? &rod : &sphere;
        struct sph_points p = fill(shape, (struct sph_lattice){.kind = kind, .particles = numbers[k], .seed = 2});
        double mean[3] = {0}, second[3][3] = {{0}};
        for (size_t i = 0; i < p.n; i++) {
          const double r[3] = {p.x[i] - 1, p.y[i] + 2, p.z[i] - 3};
          for (int a = 0; a < 3; a++) {
            mean[a] += r[a] / (double)p.n;
            for (int b = 0; b < 3; b++)
              second[a][b] += r[a] * r[b] / (double)p.n;
          }
        }
        double want[3][3] = {{0}};
        for (int a = 0; a < 3; a++)
          for (int b = 0; b < 3; b++) /* R^2/5 each way; along the axis L^2/12, across R^2/4 */
            want[a][b] = !s ? (a == b) * 0.05 : (a == b) * 0.0625 + (1. / 3 - 0.0625) * rod.axis[a] * rod.axis[b];
        const double tolerance = kind == SPH_LATTICE_IRREGULAR ? 0.03 : room[k];
        for (int a = 0; a < 3; a++) {
          assert_true(fabs(mean[a]) < (kind == SPH_LATTICE_IRREGULAR ? 0.01 : s ? 1e-3 : 1e-12));
          for (int b = 0; b < 3; b++)
            assert_true(fabs(second[a][b] - want[a][b]) < tolerance * (s ? 1. / 3 : 0.05));
        }
        sph_lattice_empty(&p);
      }
}

/* A cylinder's ends are half a layer away, all layers equally far apart. */
TEST(cylinders_have_whole_layers) {
  struct sph_points p = fill(&rod, (struct sph_lattice){.particles = 5000});
  double first = HUGE_VAL, last = -HUGE_VAL, second = HUGE_VAL;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < p.n; i++) {
      const double along = 0.6 * (p.x[i] - 1) + 0.8 * (p.z[i] - 3);
      first = fmin(first, along);
      last = fmax(last, along);
      if (along > first + 1e-9)
        second = fmin(second, along);
    }
  assert_true(fabs(first + 1 - (1 - last)) < 1e-12);
  assert_true(fabs((first + 1) - 0.5 * (second - first)) < 1e-12);
  sph_lattice_empty(&p);
}

/* With its images, a periodic body has the same sum everywhere: no seam. */
TEST(periodic_bodies_have_no_seam) {
  for (int kind = 0; kind < 2; kind++) {
    struct sph_points p = fill(&brick,
                               (struct sph_lattice){.kind = kind, .particles = 3000, .periodic = {true, true, true}});
    struct sph_kd_tree *tree = tree_of(&p);
    for (size_t i = 0; i < p.n; i++) {
      const struct around a = look(&p, tree, i, brick.side);
      assert_true(fabs(a.sum - 1) < 0.012); /* the spline's error on a lattice stretched by up to 6 % */
      assert_true(fabs(a.sum - look(&p, tree, 0, brick.side).sum) < 1e-9);
    }
    assert_true(p.stretch < 1.06);
    sph_kd_tree_free(tree);
    sph_lattice_empty(&p);
  }
  const struct sph_shape ring = {.kind = SPH_SHAPE_CYLINDER,
                                 .centre = {0, 0, 0.1},
                                 .radius = 1,
                                 .inner_radius = 0.7,
                                 .length = 0.2,
                                 .axis = {0, 0, 1}};
  const double length[3] = {0, 0, 0.2};
  struct sph_points p = fill(&ring, (struct sph_lattice){.particles = 5000, .periodic = {false, false, true}});
  struct sph_kd_tree *tree = tree_of(&p);
  int inner = 0;
  for (size_t i = 0; i < p.n; i++) {
    const double r = hypot(p.x[i], p.y[i]);
    assert_true(r > 0.7 - 0.15 * p.spacing && r < 1 + 0.15 * p.spacing && p.z[i] > 0 && p.z[i] < 0.2);
    if (r < 0.7 + 2.6 * p.spacing || r > 1 - 2.6 * p.spacing)
      continue;
    assert_true(fabs(look(&p, tree, i, length).sum - 1) < 0.012);
    inner++;
  }
  assert_true(inner > 50);
  sph_kd_tree_free(tree);
  sph_lattice_empty(&p);
  assert_true(fabs(sph_lattice_period(SPH_LATTICE_CUBIC, 0.1, 2, 0.42) - 0.5) < 1e-12);
  const double row = 0.1 * pow(2, 1. / 6), layers = 2 * row * sqrt(2. / 3);
  assert_true(fabs(sph_lattice_period(SPH_LATTICE_HEXAGONAL, 0.1, 0, 0.42) - 4 * row) < 1e-12);
  assert_true(fabs(sph_lattice_period(SPH_LATTICE_HEXAGONAL, 0.1, 1, 0.42) - 3 * sqrt(3) * row) < 1e-12);
  assert_true(fabs(sph_lattice_period(SPH_LATTICE_HEXAGONAL, 0.1, 2, layers) - layers) < 1e-12);
  /* such a length is not stretched */
  struct sph_shape bar = {.kind = SPH_SHAPE_BOX, .side = {20 * row, 3 * sqrt(3) * row, 3 * layers}};
  for (int k = 0; k < 3; k++)
    bar.centre[k] = bar.side[k] / 2;
  p = fill(&bar, (struct sph_lattice){.particles = NAN, .spacing = 0.1, .periodic = {true, true, true}});
  assert_int_equal(p.n, 20 * 6 * 6);
  assert_true(p.stretch < 1 + 1e-9);
  tree = tree_of(&p);
  for (size_t i = 0; i < p.n; i++)
    assert_true(fabs(look(&p, tree, i, bar.side).nearest / row - 1) < 1e-9);
  sph_kd_tree_free(tree);
  sph_lattice_empty(&p);
}

static double sum_scatter(const struct sph_shape *shape, const struct sph_points *p, const double *length,
                          double *mean) {
  struct sph_kd_tree *tree = tree_of(p);
  double sum = 0, squares = 0;
  int inner = 0;
  for (size_t i = 0; i < p->n; i++) {
    if (!length && depth_of(shape, p, i) < 2.5 * p->spacing)
      continue;
    const double one = look(p, tree, i, length).sum - 1;
    sum += one;
    squares += one * one;
    inner++;
  }
  sph_kd_tree_free(tree);
  *mean = sum / inner;
  return sqrt(squares / inner - *mean * *mean);
}

/* Random points scatter by some 6 %; after relaxation at most by 1 to 2 %, about the right density. */
TEST(irregular_points_are_even) {
  double mean;
  const struct sph_shape *const shapes[] = {&sphere, &rod, &cube};
  for (int s = 0; s < 3; s++) {
    struct sph_lattice lattice = {.kind = SPH_LATTICE_IRREGULAR, .particles = 2500, .seed = 5, .body = 1};
    struct sph_points p = fill(shapes[s], lattice), again = fill(shapes[s], lattice), other;
    lattice.seed = 6;
    other = fill(shapes[s], lattice);
    assert_true(sum_scatter(shapes[s], &p, NULL, &mean) < 0.012 && fabs(mean) < 0.02);
    assert_memory_equal(p.x, again.x, p.n * sizeof *p.x);
    assert_memory_equal(p.z, again.z, p.n * sizeof *p.z);
    assert_true(p.x[7] != other.x[7]);
    for (size_t i = 0; i < p.n; i++)
      assert_true(depth_of(shapes[s], &p, i) > 0);
    struct sph_kd_tree *tree = tree_of(&p);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < p.n; i++) {
      const double nearest = look(&p, tree, i, NULL).nearest / p.spacing;
      assert_true(nearest > 0.3); /* no two clump */
      sum += nearest / (double)p.n;
      squares += nearest * nearest / (double)p.n;
    }
    assert_true(fabs(sum * p.spacing / p.nearest - 1) < 1e-9);
    assert_true(sqrt(squares - sum * sum) > 0.04); /* no lattice: there it is 0 */
    sph_kd_tree_free(tree);
    sph_lattice_empty(&p);
    sph_lattice_empty(&again);
    sph_lattice_empty(&other);
  }
  struct sph_points p = fill(&brick, (struct sph_lattice){.kind = SPH_LATTICE_IRREGULAR,
                                                          .particles = 2500,
                                                          .periodic = {true, true, true}});
  assert_true(sum_scatter(&brick, &p, brick.side, &mean) < 0.012 && fabs(mean) < 0.01);
  sph_lattice_empty(&p);
}

/* Largest spacing of a graded body over the uniform one; infinite where so many particles are refused. */
static double coarsest_of(const struct sph_shape *shape, struct sph_grading grading, double particles) {
  struct sph_points p;
  const struct sph_lattice lattice = {.particles = particles, .seed = 3, .grading = grading};
  if (sph_lattice_fill(&lattice, shape, &p, &error))
    return INFINITY;
  double most = 0;
  for (size_t i = 0; i < p.n; i++)
    most = fmax(most, p.share[i]);
  sph_lattice_empty(&p);
  return cbrt(most);
}

/* The finest zone keeps the bound on the coarsest spacing. It meets that bound, or a finer zone cannot be made. */
TEST(finest_zone_keeps_the_coarsest_spacing) {
  const struct sph_shape shapes[] = {{.kind = SPH_SHAPE_SPHERE, .radius = 0.03},
                                     {.kind = SPH_SHAPE_BOX, .side = {0.06, 0.06, 0.06}}};
  const double numbers[] = {400, 1500, 6000}, bounds[] = {1.3, 2, 2.5};
  int bounded = 0;
  for (size_t k = 0; k < 18; k++) {
    const struct sph_shape *shape = &shapes[k % 2];
    const double n = numbers[k / 2 % 3], bound = bounds[k / 6], asked = 6e-4;
    struct sph_grading grading = {.fine = asked, .point = {0, 0, 0.03}, .radius = 4 * asked, .growth = NAN};
    grading.fine = sph_irregular_finest(grading, shape, n, bound);
    assert_true(grading.fine >= asked && grading.fine <= cbrt(sph_shape_volume(shape) / n));
    const double coarsest = coarsest_of(shape, grading, n);
    /* what is told before points exist; the last one lies a spacing before the far side */
    const double told = sph_irregular_coarsest(grading, shape, n) / cbrt(sph_shape_volume(shape) / n);
    if (!(coarsest < 1.02 * told && coarsest > told / 1.12))
      fail_msg("%g particles, bound %g: %g is told, there is %g", n, bound, told, coarsest);
    if (!(coarsest < 1.02 * bound)) /* shells and points find the far side within 1 % */
      fail_msg("%g particles, bound %g: %g", n, bound, coarsest);
    if (grading.fine > 1.1 * asked) {
      grading.fine *= 0.92;
      /* the last particle lies a spacing before the far side, and spacings grow by at most 0.12 of the distance */
      if (!(coarsest > bound / 1.12 || isinf(coarsest_of(shape, grading, n))))
        fail_msg("%g particles, bound %g: %g", n, bound, coarsest);
      bounded++;
    }
  }
  assert_true(bounded >= 8 && bounded < 18);
  /* a body that is finer than asked everywhere becomes nearly uniform */
  struct sph_grading grading = {.fine = 0.02, .point = {0, 0, 0.03}, .radius = 0.08, .growth = NAN};
  grading.fine = sph_irregular_finest(grading, &shapes[0], 3000, 2);
  assert_true(coarsest_of(&shapes[0], grading, 3000) < 1.03);
}

/* 0.5 mm at the impact, growing outwards: the requested number, volumes that add up, the requested spacing, and a
 * density sum that is right in every shell. */
TEST(graded_points_keep_their_grading) {
  const struct sph_shape target = {.kind = SPH_SHAPE_BOX, .side = {0.2, 0.2, 0.2}};
  const struct sph_grading grading = {.fine = 8e-4, .point = {0, 0, 0.1}, .radius = 4e-3, .growth = NAN};
  struct sph_points p = fill(&target, (struct sph_lattice){.particles = 20000, .seed = 3, .grading = grading});
  assert_true(fabs((double)p.n / 20000 - 1) < 0.001);
  struct sph_kd_tree *tree = tree_of(&p);
  enum { SHELLS = 8 };
  double total = 0, sum[SHELLS] = {0}, squares[SHELLS] = {0};
  int count[SHELLS] = {0}, core = 0;
  for (size_t i = 0; i < p.n; i++) {
    const double d = hypot(hypot(p.x[i], p.y[i]), p.z[i] - 0.1), s = p.spacing * cbrt(p.share[i]);
    const struct around a = look(&p, tree, i, NULL);
    assert_true(a.steepest < 1.15);
    total += p.share[i];
    core += d < 4e-3;
    if (d < 4e-3)
      assert_true(fabs(s / 8e-4 - 1) < 0.01);
    if (depth_of(&target, &p, i) < 2.8 * s)
      continue;
    const int shell = (int)fmin(SHELLS - 1, fmax(0, log2(d / 2e-3)));
    sum[shell] += a.sum - 1;
    squares[shell] += (a.sum - 1) * (a.sum - 1);
    count[shell]++;
  }
  assert_true(fabs(total / (double)p.n - 1) < 1e-12);
  assert_true(fabs(core / (2 * M_PI / 3 * 125) - 1) < 0.15); /* half a sphere of 5 spacings, its surfaces rough */
  int shells = 0;
  for (int k = 0; k < SHELLS; k++) {
    if (count[k] < 50)
      continue;
    shells++;
    const double mean = sum[k] / count[k];
    assert_true(fabs(mean) < 0.03 && sqrt(squares[k] / count[k] - mean * mean) < 0.02);
  }
  assert_true(shells >= 4);
  sph_kd_tree_free(tree);
  sph_lattice_empty(&p);
  /* a given growth determines the number */
  struct sph_grading given = grading;
  given.growth = 0.1;
  p = fill(&target, (struct sph_lattice){.particles = NAN, .seed = 3, .grading = given});
  total = 0;
  for (size_t i = 0; i < p.n; i++) {
    const double s = p.spacing * cbrt(p.share[i]), d = fmax(0, hypot(hypot(p.x[i], p.y[i]), p.z[i] - 0.1) - 4e-3);
    total += fabs(s / (8e-4 + 0.1 * d * d / (d + 3.2e-3)) - 1);
  }
  assert_true(total / (double)p.n < 0.01);
  sph_lattice_empty(&p);
  given.growth = 0.5;
  assert_int_equal(sph_lattice_fill(&(struct sph_lattice){.particles = NAN, .grading = given}, &target, &p, &error),
                   STATUS_CONTENT);
  assert_int_equal(sph_lattice_fill(&(struct sph_lattice){.particles = 300, .grading = grading}, &target, &p, &error),
                   STATUS_CONTENT);
  assert_non_null(strstr(error.message, "not 300"));
  assert_null(p.x);
  given.fine = 1e-7;
  given.growth = 0;
  assert_int_equal(sph_lattice_fill(&(struct sph_lattice){.particles = NAN, .grading = given}, &target, &p, &error),
                   STATUS_MEMORY);
}

TEST(absurd_lattices_are_refused) {
  const struct {
    struct sph_lattice lattice;
    const struct sph_shape *shape;
    status code;
    const char *says;
  } cases[] = {
      {{.particles = 1e12}, &sphere, STATUS_MEMORY, "1e+12 particles need"},
      {{.particles = 1e12, .kind = SPH_LATTICE_IRREGULAR}, &cube, STATUS_MEMORY, "1e+12 particles need"},
      {{.particles = HUGE_VAL}, &cube, STATUS_MEMORY, "inf particles"},
      {{.particles = NAN, .spacing = 1e-9}, &rod, STATUS_MEMORY, "particles need"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct sph_points points = {.n = 77};
    assert_int_equal(sph_lattice_fill(&cases[k].lattice, cases[k].shape, &points, &error), cases[k].code);
    if (!strstr(error.message, cases[k].says))
      fail_msg("'%s' does not say '%s'", error.message, cases[k].says);
    assert_true(points.n == 0 && !points.x);
  }
}

/* Threads, sheets and discs, thinner than a million to one: as requested, or refused; quickly, and never an empty body.
 */
TEST(thin_bodies_are_filled_or_refused) {
  for (double thin = 1; thin > 1e-9; thin *= 0.02) {
    const struct sph_shape shapes[] = {
        {.kind = SPH_SHAPE_CYLINDER, .radius = thin, .length = 1, .axis = {1, 2, 3}},
        {.kind = SPH_SHAPE_CYLINDER, .radius = 1, .length = thin, .axis = {1, 2, 3}},
        {.kind = SPH_SHAPE_CYLINDER, .radius = 1, .inner_radius = 1 - 0.5 * thin, .length = 1, .axis = {1, 2, 3}},
        {.kind = SPH_SHAPE_BOX, .side = {thin, 1, 1}},
        {.kind = SPH_SHAPE_BOX, .side = {1, thin, thin}},
    };
    for (int s = 0; s < 5; s++)
      for (int kind = 0; kind < 3; kind++)
        for (int turned = 0; turned < 2; turned++)
          for (double wanted = 3; wanted < (SANITIZED ? 1e2 : 1e4); wanted *= 30) {
            if (kind == SPH_LATTICE_IRREGULAR && wanted > 100)
              continue;
            struct sph_points points;
            const struct sph_lattice lattice = {.kind = kind, .particles = wanted, .turned = turned, .seed = 1};
            const status code = sph_lattice_fill(&lattice, &shapes[s], &points, &error);
            if (code) {
              assert_int_equal(code, STATUS_CONTENT);
              assert_non_null(strstr(error.message, "too thin"));
              assert_non_null(strstr(error.message, "raise fidelity.particles"));
              assert_true(thin < 0.5);
            } else {
              assert_true((double)points.n >= 0.5 * wanted && (double)points.n <= 2 * wanted + 2);
            }
            sph_lattice_empty(&points);
          }
  }
  const struct sph_shape thread = {.kind = SPH_SHAPE_CYLINDER, .radius = 1e-3, .length = 1, .axis = {1, 2, 3}};
  struct sph_points p = fill(&thread, (struct sph_lattice){.particles = 20000, .turned = true, .seed = 7});
  assert_true(fabs((double)p.n / 20000 - 1) < 0.01);
  sph_lattice_empty(&p);
}
