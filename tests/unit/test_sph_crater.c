/* Craters: holes of known size in a lattice, ejecta, closed pores and their shares. */

#include "engine/sph/observe/observe.h"
#include "engine/vector3.h"
#include "tests/support/check.h"

enum { SIDE = 60, HIGH = 30 };
static const double dx = 1e-3;

static struct sph_particles *slab(void) {
  struct sph_particles *p;
  assert_int_equal(sph_particles_make(SIDE * SIDE * HIGH, SPH_WITH_DISTENTION | SPH_WITH_DAMAGE, &p, NULL), STATUS_OK);
  for (size_t i = 0; i < p->n; i++) {
    p->x[i] = dx * ((double)(i % SIDE) + 0.5 - SIDE / 2);
    p->y[i] = dx * ((double)(i / SIDE % SIDE) + 0.5 - SIDE / 2);
    p->z[i] = dx * ((double)(i / SIDE / SIDE) + 0.5);
    p->mass[i] = 1e-6;
    p->density[i] = 1000;
    p->distention[i] = p->rest_distention[i] = 2;
  }
  return p;
}

static void near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%s: got %.9g, expected %.9g +- %g", what, got, want, relative);
}

static const struct sph_crater_options options = {.count = SIDE * SIDE * HIGH,
                                                  .mass = SIDE * SIDE * HIGH * 1e-6,
                                                  .frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                                  .spacing = 1e-3,
                                                  .ejection_speed = 5};

/* Crater, ejecta and volume of closed pores, in matter of distention `initial` at the start. */
static void measure(const struct sph_particles *start, const struct sph_particles *now,
                    const struct sph_crater_options *o, double initial, struct sph_results *results) {
  assert_int_equal(sph_crater_measure(start, now, o, results, NULL), STATUS_OK);
  sph_crater_compaction(start, now, o, initial, results);
}

TEST(untouched) {
  SPH_PARTICLES *p = slab();
  struct sph_results c = {0};
  measure(p, p, &options, 2, &c);
  assert_true(c.crater.volume == 0 && c.crater.depth == 0 && c.crater.radius == 0 && c.ejecta.mass_fraction == 0 &&
              c.palpha.compaction.volume == 0 && c.palpha.compaction.mass_fraction == 0);
}

/* A bowl of radius 12 mm, ejected at 20 m/s. A pit that is not connected to it does not count. */
TEST(thrown_out) {
  SPH_PARTICLES *start = slab(), *now = slab();
  size_t count = 0;
  for (size_t i = 0; i < now->n; i++) {
    double depth = HIGH * dx - now->z[i];
    if (hypot(hypot(now->x[i], now->y[i]), depth) < 12e-3) {
      now->vz[i] = 20;
      now->z[i] += 1;
      count++;
    }
    if (hypot(now->x[i] - 24e-3, now->y[i] - 24e-3) < 3e-3 && depth < 5e-3)
      now->z[i] -= 10e-3; /* a pit far from the axis */
  }
  struct sph_results c = {0};
  measure(start, now, &options, 2, &c);
  near(c.ejecta.mass_fraction * options.mass, (double)count * 1e-6, 1e-12, "ejected mass");
  near(c.ejecta.momentum, (double)count * 20e-6, 1e-12, "ejected momentum");
  /* columns of two spacings, highest particle of each: the edge is blurred by a column, and shallow rims are not seen
   */
  near(c.crater.volume, (double)count * 1e-9, 0.15, "volume");
  near(c.crater.depth, 12e-3, 0.1, "depth");
  near(c.crater.radius, 12e-3, 0.1, "radius");
  assert_true(c.palpha.compaction.volume == 0);
  assert_true(c.crater.compaction_share == 0);
  now->rest_distention[0] = 1; /* half a cubic millimetre of pores, against the ejecta's volume */
  measure(start, now, &options, 2, &c);
  near(c.crater.compaction_share, 0.5 / (0.5 + (double)count), 1e-12, "share of compaction, with the ejecta's volume");
}

/* 100 particles leave: the i-th with i m/s along x and 10 m/s outwards. Sums of the table are those of the results, and
 * a bin has what its speeds say. With an escape speed of 50 m/s, those of 49 m/s and more along x leave; the hole is
 * the same. */
TEST(thrown_out_at_many_speeds) {
  SPH_PARTICLES *start = slab(), *now = slab();
  for (size_t i = 0; i < 100; i++) {
    const size_t top = now->n - 1 - i;
    now->vx[top] = (double)i;
    now->vz[top] = 10;
    now->z[top] += 1;
  }
  struct sph_crater_options o = options;
  struct sph_results c[2] = {{0}};
  for (int k = 0; k < 2; k++, o.escape_speed = 50) {
    struct ejecta *e = &c[k].ejecta_over_speed;
    const double count = k ? 51 : 100;
    measure(start, now, &o, 2, &c[k]);
    near(c[k].ejecta.mass_fraction * o.mass, count * 1e-6, 1e-12, "ejected mass");
    near(c[k].ejecta.momentum, count * 10e-6, 1e-12, "ejected momentum");
    ejecta_sum(e);
    near(e->bin[0].mass, count * 1e-6, 1e-12, "mass in the table");
    near(e->bin[0].momentum, count * 10e-6, 1e-12, "momentum in the table");
    near(e->bin[19 - EJECTA_FIRST].mass, 21e-6, 1e-12, "mass above 79.4 m/s: from 78.8 along x on");
  }
  assert_true(c[0].crater.volume == c[1].crater.volume && c[0].crater.depth == c[1].crater.depth &&
              c[0].crater.compaction_share == c[1].crater.compaction_share);
}

/* The same bowl where the particles are 2.5 times as coarse as at the point of impact, and all that is left has moved
 * by half a spacing: a narrow column that lost its particle so is no hole. */
TEST(thrown_out_of_coarse_matter) {
  struct sph_particles *start = slab(), *now = slab();
  struct sph_crater_options graded = options;
  graded.spacing = 0.4e-3;
  graded.graded = true;
  size_t count = 0;
  for (size_t i = 0; i < now->n; i++) {
    const bool out = hypot(hypot(now->x[i], now->y[i]), HIGH * dx - now->z[i]) < 12e-3;
    count += out;
    now->vz[i] = out ? 20 : 0;
    now->x[i] += out ? 0 : 0.5 * dx;
    now->y[i] -= out ? 0 : 0.5 * dx;
  }
  struct sph_results c = {0};
  measure(start, now, &graded, 2, &c);
  near(c.crater.volume, (double)count * 1e-9, 0.2, "volume"); /* the edge is blurred by two spacings of 12 */
  near(c.crater.depth, 12e-3, 0.1, "depth");
  near(c.crater.radius, 12e-3, 0.1, "radius");
  struct sph_crater_layer layers[100];
  const size_t found = sph_crater_profile(start, now, &graded, layers, 100);
  assert_true(found >= (size_t)HIGH - 13 &&
              layers[found - 1].depth > 0.9 * HIGH * dx); /* below the bowl, to the bottom */
  sph_particles_free(start);
  sph_particles_free(now);
}

/* A cylinder of radius 10 mm, 20 mm deep, whose pores close: it shrinks to half its height and no matter leaves. */
TEST(compacted) {
  struct sph_particles *start = slab(), *now = slab();
  size_t count = 0;
  for (size_t i = 0; i < now->n; i++)
    if (hypot(now->x[i], now->y[i]) < 10e-3 && now->z[i] > 10e-3) {
      now->z[i] = 10e-3 + (now->z[i] - 10e-3) / 2;
      now->rest_distention[i] = 1; /* closed permanently; `distention` of fractured matter under tension stays larger */
      now->damage_cbrt[i] = 1;
      count++;
    }
  struct sph_results c = {0};
  measure(start, now, &options, 2, &c);
  assert_true(c.ejecta.mass_fraction == 0);
  near(c.palpha.compaction.mass_fraction * options.mass, (double)count * 1e-6, 1e-12, "compacted mass");
  near(c.palpha.compaction.volume, (double)count * 0.5e-9, 1e-12, "closed pores");
  near(c.crater.depth, 10e-3, 0.05, "depth");
  near(c.crater.volume, c.palpha.compaction.volume, 0.2,
       "the crater is what pores left"); /* columns across the rim, 2 mm of 10, are not part of the crater */
  /* from the first compacted layer to the last one */
  near(c.palpha.compaction.depth, 19e-3, 1e-9, "depth of compacted matter");
  near(c.palpha.compaction.reach, hypot(19e-3, 10e-3), 0.05, "reach");
  struct sph_crater_layer layer[40];
  size_t layers = sph_crater_profile(start, now, &options, layer, 40);
  assert_int_equal(layers, HIGH);
  for (size_t k = 0; k < layers; k++) {
    near(layer[k].depth, (double)k * dx, 1e-9, "layer");
    near(layer[k].distention, k < 20 ? 1 : 2, 1e-12, "distention along the axis");
    near(layer[k].damage, k < 20 ? 1 : 0, 1e-12, "damage along the axis");
  }
  sph_particles_free(start);
  sph_particles_free(now);
}

/* A ball that is ejected completely: its crater is the ball, without the space below it. */
TEST(nothing_left) {
  SPH_PARTICLES *start = slab(), *now = slab();
  const double radius = 14e-3;
  size_t n = 0;
  for (size_t i = 0; i < start->n; i++)
    if (hypot(hypot(start->x[i], start->y[i]), start->z[i] - 15e-3) < radius) {
      start->x[n] = now->x[n] = start->x[i], start->y[n] = now->y[n] = start->y[i],
      start->z[n] = now->z[n] = start->z[i];
      now->vz[n++] = 20;
    }
  struct sph_crater_options ball = options;
  struct sph_results c = {0};
  ball.count = n;
  measure(start, now, &ball, 2, &c);
  near(c.crater.volume, (double)n * 1e-9, 0.15,
       "volume"); /* columns as above: their corners are wider than the ball, their ends half a layer shorter */
  near(c.crater.radius, radius, 0.1, "radius");
  near(c.crater.depth, 2 * radius, 0.05, "depth");
}

/* Matter with distention below 1.01 at the start is never counted as compacted. */
TEST(hardly_porous) {
  SPH_PARTICLES *start = slab(), *now = slab();
  for (size_t i = 0; i < now->n; i++)
    start->distention[i] = start->rest_distention[i] = 1.005, now->rest_distention[i] = i ? 1.0049 : 1;
  struct sph_results c = {0};
  measure(start, now, &options, 1.005, &c);
  assert_true(c.palpha.compaction.mass_fraction == 0 && c.palpha.compaction.depth == 0 &&
              c.palpha.compaction.volume > 0);
}

/* x y z along the rows of `frame`, and away by `shift`. */
static void turn(double *x, double *y, double *z, const double frame[3][3], const double shift[3]) {
  const double r[3] = {*x, *y, *z};
  double to[3];
  for (int k = 0; k < 3; k++)
    to[k] = shift[k] + r[0] * frame[0][k] + r[1] * frame[1][k] + r[2] * frame[2][k];
  *x = to[0], *y = to[1], *z = to[2];
}

/* A crater with ejecta and closed pores in a face that is not horizontal is the same as in one that is. No particle
 * lies at the border of a column, where rounding would decide. */
TEST(tilted) {
  enum { LEVEL, TILTED, FACES, LAYERS = 40 };
  const double normal[3] = {2 / 3., -1 / 3., 2 / 3.}, shift[3] = {3e-3, 5e-3, -2e-3}, none[3] = {0, 0, 0};
  struct sph_crater_options o = options;
  struct sph_results c[FACES] = {{0}};
  struct sph_crater_layer layer[FACES][LAYERS] = {{{0}}};
  size_t layers[FACES];
  o.spacing = 1.0001e-3;
  for (int face = LEVEL; face < FACES; face++) {
    SPH_PARTICLES *start = slab(), *now = slab();
    for (size_t i = 0; i < now->n; i++) {
      const double depth = HIGH * dx - now->z[i], r = hypot(hypot(now->x[i], now->y[i]), depth);
      now->vx[i] = 7;
      now->vz[i] = r < 12e-3 ? 20 + r / dx : -depth / dx;
      now->rest_distention[i] = r < 18e-3 ? 1 : 2;
    }
    if (face == TILTED) {
      const double up[3][3] = {{2 / 3., 2 / 3., -1 / 3.}, {-1 / 3., 2 / 3., 2 / 3.}, {normal[0], normal[1], normal[2]}};
      memcpy(o.frame, up, sizeof up);
      for (int k = 0; k < 2; k++)
        o.axis[k] = vector3_dot(up[k], shift);
      for (size_t i = 0; i < now->n; i++) {
        turn(&start->x[i], &start->y[i], &start->z[i], up, shift);
        turn(&now->x[i], &now->y[i], &now->z[i], up, shift);
        turn(&now->vx[i], &now->vy[i], &now->vz[i], up, none);
      }
    }
    measure(start, now, &o, 2, &c[face]);
    layers[face] = sph_crater_profile(start, now, &o, layer[face], LAYERS);
  }
#define SAME(result) near(c[TILTED].result, c[LEVEL].result, 1e-9, #result)
  SAME(ejecta.mass_fraction);
  SAME(ejecta.momentum);
  SAME(crater.depth);
  SAME(crater.radius);
  SAME(crater.volume);
  SAME(crater.compaction_share);
  SAME(palpha.compaction.depth);
  SAME(palpha.compaction.reach);
  assert_true(c[LEVEL].crater.depth > 11e-3 && c[LEVEL].palpha.compaction.depth > 16e-3);
  assert_true(layers[LEVEL] > 10 && layers[TILTED] == layers[LEVEL]);
  for (size_t k = 0; k < layers[LEVEL]; k++) {
    near(layer[TILTED][k].depth, layer[LEVEL][k].depth, 1e-9, "layer");
    near(layer[TILTED][k].velocity, layer[LEVEL][k].velocity, 1e-9, "velocity of the layer");
  }
}
