/* True shapes: volumes, places and distances against each other and against plain geometry; gaps, overlaps, misses. */

#include "engine/random.h"
#include "engine/sph/body/bodies.h"
#include "tests/support/check.h"

static const struct sph_shape sphere = {.kind = SPH_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 2};
static const struct sph_shape rod = {.kind = SPH_SHAPE_CYLINDER,
                                     .centre = {1, 2, 3},
                                     .radius = 1.5,
                                     .length = 4,
                                     .axis = {1, 2, -2}};
static const struct sph_shape ring =
    {.kind = SPH_SHAPE_CYLINDER, .centre = {1, 2, 3}, .radius = 2, .inner_radius = 1, .length = 1, .axis = {0, 0, 5}};
static const struct sph_shape box = {.kind = SPH_SHAPE_BOX, .centre = {1, 2, 3}, .side = {1, 2, 3}};
static const struct sph_shape *const shapes[] = {&sphere, &rod, &ring, &box};

static void uniforms(uint64_t item, double u[3]) {
  uint64_t bits[4];
  random_bits(11, RANDOM_FLAW_PLACE, 0, item, bits);
  for (int k = 0; k < 3; k++)
    u[k] = random_uniform(bits[k]);
}

/* The share of a box around the shape that is inside it. 2e5 throws: sd below 0.3 % of the volume; 1.2 % is four of
 * them. */
TEST(volume_is_what_is_inside) {
  for (int s = 0; s < 4; s++) {
    double reach[3], u[3], p[3], around = 1;
    for (int k = 0; k < 3; k++) {
      reach[k] = sph_shape_reach(shapes[s], (double[3]){k == 0, k == 1, k == 2});
      around *= 2 * reach[k];
    }
    int in = 0;
    for (uint64_t i = 0; i < 200000; i++) {
      uniforms(i, u);
      for (int k = 0; k < 3; k++)
        p[k] = shapes[s]->centre[k] + (2 * u[k] - 1) * reach[k];
      in += sph_shape_inside(shapes[s], p);
    }
    assert_true(fabs(in / 200000.0 * around / sph_shape_volume(shapes[s]) - 1) < 0.012);
  }
}

/* Places lie inside, and equally many in each of 20 parts of equal volume. Two ways to divide each shape: by depth (the
 * uniforms' own coordinate is not used: volumes of inner shapes of the same kind), and by the plane through the centre,
 * normal to x. */
static double inner_volume(const struct sph_shape *s, double depth) {
  struct sph_shape inner = *s;
  inner.radius -= depth;
  if (s->inner_radius > 0)
    inner.inner_radius += depth;
  inner.length -= 2 * depth;
  for (int k = 0; k < 3; k++)
    inner.side[k] -= 2 * depth;
  return sph_shape_volume(&inner);
}

TEST(places_are_uniform) {
  enum { PARTS = 20, THROWS = 40000 };
  for (int s = 0; s < 4; s++) {
    int count[PARTS] = {0}, right = 0;
    for (uint64_t i = 0; i < THROWS; i++) {
      double u[3], p[3];
      uniforms(i, u);
      sph_shape_place(shapes[s], u, p);
      const double depth = -sph_shape_distance(shapes[s], p, NULL);
      assert_true(depth > -1e-12);
      const double part = 1 - inner_volume(shapes[s], depth) / sph_shape_volume(shapes[s]);
      count[(int)fmin(PARTS - 1, part * PARTS)]++;
      right += p[0] > shapes[s]->centre[0];
    }
    double chi2 = 0;
    for (int k = 0; k < PARTS; k++)
      chi2 += pow(count[k] - THROWS / PARTS, 2) / (THROWS / PARTS);
    assert_true(chi2 < 50.8); /* 19 degrees of freedom: one in 10 000 is above; the throws are fixed */
    assert_true(abs(right - THROWS / 2) < 400); /* 4 standard deviations of 100 */
  }
}

/* Inside and outside, the distance is that to the nearest of many points of the surface, and going back along the
 * normal by the distance ends on the surface. */
TEST(distance_leads_to_the_surface) {
  for (int s = 0; s < 4; s++)
    for (uint64_t i = 0; i < 2000; i++) {
      double u[3], p[3], q[3], normal[3], again[3];
      uniforms(i, u);
      for (int k = 0; k < 3; k++)
        p[k] = shapes[s]->centre[k] + 8 * (u[k] - 0.5);
      const double d = sph_shape_distance(shapes[s], p, normal);
      assert_int_equal(d < 0, sph_shape_inside(shapes[s], p));
      assert_true(fabs(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] - 1) < 1e-12);
      for (int k = 0; k < 3; k++)
        q[k] = p[k] - d * normal[k];
      assert_true(fabs(sph_shape_distance(shapes[s], q, again)) < 1e-12);
      double depth[SPH_SHAPE_WALLS], normals[SPH_SHAPE_WALLS][3], least = HUGE_VAL;
      const int walls = sph_shape_walls(shapes[s], p, depth, normals);
      for (int k = 0; k < walls; k++)
        least = fmin(least, depth[k]);
      if (d < 0)
        assert_true(fabs(least + d) < 1e-12); /* inside, the nearest wall */
      else
        assert_true(least < 1e-12);
      /* no surface point is nearer: step to places of the shape and see that they are at least |d| away when outside */
      sph_shape_place(shapes[s], u, q);
      const double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
      assert_true(away >= d - 1e-12);
    }
}

static struct sph_shape at(const struct sph_shape *s, double x, double y, double z) {
  struct sph_shape moved = *s;
  moved.centre[0] = x;
  moved.centre[1] = y;
  moved.centre[2] = z;
  return moved;
}

TEST(gaps_and_overlaps) {
  struct sph_shape a = at(&sphere, 0, 0, 0), b = at(&sphere, 3, 4, 0);
  assert_true(fabs(sph_shape_gap(&a, &b) - 1) < 1e-14);
  b = at(&sphere, 0, 3, 0);
  assert_true(fabs(sph_shape_gap(&a, &b) + 1) < 1e-14);
  a = at(&box, 0, 0, 0); /* 1 x 2 x 3 */
  b = at(&box, 1.25, 0, 0);
  assert_true(fabs(sph_shape_gap(&a, &b) - 0.25) < 1e-9);
  b = at(&box, 2, 2 + 1, 3 + 2); /* corner to corner: sides apart by 1, 1, 2 */
  assert_true(fabs(sph_shape_gap(&a, &b) - sqrt(6)) < 1e-9);
  b = at(&box, 0.75, 0.5, 0);
  assert_true(sph_shape_gap(&a, &b) < 0);
  b = at(&sphere, 0.5 + 2.5, 0, 0);
  assert_true(fabs(sph_shape_gap(&a, &b) - 0.5) < 1e-14);
  /* two rings side by side, axes along z; then one above the other; then crossed rods: axes apart by 3.5, radii 1.5 */
  a = at(&ring, 0, 0, 0);
  b = at(&ring, 3, 4, 0.5);
  assert_true(fabs(sph_shape_gap(&a, &b) - 1) < 1e-6);
  b = at(&ring, 0.3, 0.2, 1.25);
  assert_true(fabs(sph_shape_gap(&a, &b) - 0.25) < 1e-9);
  b = at(&ring, 2.4, 3.2 - 0.4, 0);
  assert_true(sph_shape_gap(&a, &b) < 0);
  struct sph_shape x = rod, y = rod;
  x = at(&x, 0, 0, 0);
  y = at(&y, 0, 0, 3.5);
  memcpy(x.axis, (double[3]){1, 0, 0}, sizeof x.axis);
  memcpy(y.axis, (double[3]){0, 1, 0}, sizeof y.axis);
  assert_true(fabs(sph_shape_gap(&x, &y) - 0.5) < 1e-6);
  y.centre[2] = 2.5;
  assert_true(sph_shape_gap(&x, &y) < 0);
}

TEST(flights_hit_or_miss) {
  struct sph_shape target = at(&sphere, 0, 0, 0), shot = at(&sphere, 10, 0, 0);
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){-2, 0, 0}) <= 0);
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){2, 0, 0}) == 6); /* flies off: nearest now */
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){0, 0, 0}) == 6);
  shot.centre[1] = 5; /* passes 5 from the centre at x = 0 */
  assert_true(fabs(sph_shape_gap_ahead(&target, &shot, (double[3]){-2, 0, 0}) - 1) < 1e-9);
  shot.centre[1] = 3.999;
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){-2, 0, 0}) <= 0);
  shot.centre[1] = 4.001;
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){-2, 0, 0}) > 0);
  target = at(&box, 0, 0, 0);
  shot = at(&rod, 0, 0, 9);
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){0, 0, -1}) <= 0);
  assert_true(sph_shape_gap_ahead(&target, &shot, (double[3]){1, 0, -0.2}) > 0);
}
