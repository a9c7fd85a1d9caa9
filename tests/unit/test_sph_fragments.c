/* Fragments of SPH particles: against brute force over all pairs; each rule of BA95 section 4.4 separately; spin of
 * asymmetric fragments; particles that are far away or not finite; no particles. */

#include "engine/outcome.h"
#include "engine/random.h"
#include "engine/sph/observe/observe.h"
#include "tests/support/check.h"

static double draw(uint64_t seed, size_t i, uint64_t k) {
  return random_draw(seed, 900, i, k);
}

static struct sph_particles *make(size_t n, int arrays) {
  struct sph_particles *p = NULL;
  assert_int_equal(sph_particles_make(n, arrays, &p, NULL), STATUS_OK);
  for (size_t i = 0; i < n; i++) {
    p->mass[i] = 1;
    p->h[i] = 1;
    p->density[i] = 2700;
  }
  return p;
}

static struct sph_fragments find(const struct sph_particles *p, const struct sph_fragments_options *options) {
  struct sph_fragments pieces;
  if (sph_fragments_find(p, options, &pieces, &error))
    fail_msg("%s", error.message);
  return pieces;
}

/* The definition, pair by pair: group[i] = lowest core particle of i's fragment (dust: itself), -1 left out. */
static void brute(const struct sph_particles *p, const struct sph_fragments_options *o, const uint8_t *left_out,
                  long *group, uint8_t *part) {
  size_t n = p->n;
  double *square = malloc(n * n * sizeof *square), *reach = malloc(n * n * sizeof *reach),
         *mass = calloc(n, sizeof *mass);
  const double *h = o->h ? o->h : p->h;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      const double *at[3] = {p->x, p->y, p->z};
      double sum = 0;
      for (int d = 0; d < 3; d++) {
        double best = HUGE_VAL; /* the nearest of the images */
        for (int image = -4; image <= 4; image++)
          if (image == 0 || o->periodic[d] > 0)
            best = fmin(best, fabs(at[d][i] - at[d][j] + (image ? image * o->periodic[d] : 0)));
        sum += best * best;
      }
      square[i * n + j] = sum;
      reach[i * n + j] = p->body[i] == p->body[j] ? o->link_length * (h[i] + h[j]) / 2 : -1;
      if (left_out[i] || left_out[j])
        reach[i * n + j] = -1;
    }
  for (size_t i = 0; i < n; i++) {
    group[i] = left_out[i] ? -1 : (long)i;
    part[i] = left_out[i]                             ? SPH_FRAGMENTS_LEFT_OUT
              : pow(p->damage_cbrt[i], 3) < o->damage ? SPH_FRAGMENTS_CORE
                                                      : SPH_FRAGMENTS_SINGLE;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++)
        if (part[i] == SPH_FRAGMENTS_CORE && part[j] == SPH_FRAGMENTS_CORE &&
            square[i * n + j] <= reach[i * n + j] * fabs(reach[i * n + j]) && group[j] > group[i]) {
          group[j] = group[i];
          changed = true;
        }
  }
  for (size_t i = 0; i < n; i++)
    if (part[i] == SPH_FRAGMENTS_CORE)
      mass[group[i]] += p->mass[i];
  for (size_t i = 0; i < n && o->layer; i++) {
    long best = -1;
    if (part[i] != SPH_FRAGMENTS_SINGLE)
      continue;
    for (size_t j = 0; j < n; j++) {
      const double link = reach[i * n + j], depth = link >= 0 && o->layer_width > 0 ? o->layer_width : link;
      if (part[j] != SPH_FRAGMENTS_CORE || !(square[i * n + j] <= depth * fabs(depth)))
        continue;
      if (best < 0 || square[i * n + j] < square[i * n + (size_t)best] ||
          (square[i * n + j] == square[i * n + (size_t)best] &&
           (mass[group[j]] > mass[group[best]] || (mass[group[j]] == mass[group[best]] && group[j] < group[best]))))
        best = (long)j;
    }
    if (best < 0)
      continue;
    part[i] = SPH_FRAGMENTS_LAYER;
    group[i] = group[best];
  }
  free(square);
  free(reach);
  free(mass);
}

TEST(equals_brute_force) {
  enum { N = 260 };
  SPH_PARTICLES *p = make(N, SPH_WITH_DAMAGE);
  long group[N];
  uint8_t part[N], left_out[N];
  size_t cores = 0, layers = 0, dust = 0, several = 0;
  for (uint64_t seed = 1; seed <= 60; seed++) {
    const struct sph_fragments_body bodies[3] = {{false, NAN}, {false, NAN}, {seed % 3 == 0, NAN}};
    struct sph_fragments_options o = sph_fragments_default();
    double box = 4 + (double)(seed % 5);
    o.bodies = bodies;
    o.body_count = 3;
    o.damage = 0.3 + 0.01 * (double)(seed % 70);
    o.link_length = 0.7 + 0.1 * (double)(seed % 6);
    o.layer = seed % 4 != 0;
    o.layer_width = seed % 3 == 1 ? 0.1 * (double)(seed % 13) : 0;
    for (int d = 0; d < 3; d++)
      if (seed >> d & 1)
        o.periodic[d] = seed % 7 == 3 ? 2.1 : box; /* thin boxes, too */
    for (size_t i = 0; i < N; i++) {
      double *at[3] = {&p->x[i], &p->y[i], &p->z[i]};
      for (uint64_t d = 0; d < 3; d++) {
        *at[d] = box * draw(seed, i, d);
        if (seed % 5 == 0)
          *at[d] = floor(*at[d] * 2) / 2; /* on a lattice: ties, particles in one place */
        if (seed % 5 == 1)
          *at[d] -= box / 2;
      }
      p->h[i] = seed % 2 ? 0.9 : 0.2 * pow(10, draw(seed, i, 4)); /* ten to one */
      p->damage_cbrt[i] = cbrt(draw(seed, i, 5));
      p->mass[i] = 1 + floor(3 * draw(seed, i, 6));
      p->body[i] = i < 200 ? 0 : i < 230 ? 1 : 2;
      left_out[i] = p->body[i] == 2 && bodies[2].left_out;
    }
    OWNED_BY(sph_fragments_clear) struct sph_fragments found = find(p, &o);
    brute(p, &o, left_out, group, part);
    double largest_core = 0, mass = 0;
    for (size_t i = 0; i < N; i++) {
      if (found.part[i] != part[i])
        fail_msg("seed %d i %zu: %d is not %d", (int)seed, i, found.part[i], part[i]);
      assert_int_equal(found.label[i] == UINT32_MAX, left_out[i]);
      cores += part[i] == SPH_FRAGMENTS_CORE;
      layers += part[i] == SPH_FRAGMENTS_LAYER;
      dust += part[i] == SPH_FRAGMENTS_SINGLE;
      if (left_out[i])
        continue;
      mass += p->mass[i];
      double core = 0;
      for (size_t j = 0; j < N; j++) {
        if (left_out[j])
          continue;
        if ((found.label[i] == found.label[j]) != (group[i] == group[j]))
          fail_msg("seed %d i %zu j %zu: %u %u, %ld %ld parts %d %d", (int)seed, i, j, found.label[i], found.label[j],
                   group[i], group[j], part[i], part[j]);
        if (part[j] == SPH_FRAGMENTS_CORE && part[i] == SPH_FRAGMENTS_CORE && group[i] == group[j])
          core += p->mass[j];
      }
      largest_core = fmax(largest_core, core);
    }
    several += found.count > 5;
    assert_true(found.mass == mass); /* sums of small integers */
    assert_true(found.core_largest == largest_core && found.core_second <= largest_core);
    for (size_t f = 1; f < found.count; f++)
      assert_true(found.fragments[f - 1].mass >= found.fragments[f].mass);
  }
  if (!(cores > 1000 && layers > 500 && dust > 500 && several > 30)) /* the draws exercise the rules */
    fail_msg("%zu core, %zu layer, %zu dust, %zu times more than 5 fragments", cores, layers, dust, several);
}

/* Positions and states decide, not the numbering: every permutation gives the same partition (masses distinct). */
TEST(numbering_does_not_matter) {
  enum { N = 500 };
  SPH_PARTICLES *p = make(N, SPH_WITH_DAMAGE), *q = make(N, SPH_WITH_DAMAGE);
  struct sph_fragments_options o = sph_fragments_default();
  for (size_t i = 0; i < N; i++) {
    size_t k = (i * 237 + 11) % N; /* 237 has no factor in common with 500 */
    double at[3] = {8 * draw(3, i, 0), 8 * draw(3, i, 1), 8 * draw(3, i, 2)};
    p->x[i] = q->x[k] = at[0];
    p->y[i] = q->y[k] = at[1];
    p->z[i] = q->z[k] = at[2];
    p->damage_cbrt[i] = q->damage_cbrt[k] = draw(3, i, 3) < 0.5;
    p->mass[i] = q->mass[k] = 1 + draw(3, i, 4);
  }
  OWNED_BY(sph_fragments_clear) struct sph_fragments a = find(p, &o), b = find(q, &o);
  assert_int_equal(a.count, b.count);
  for (size_t i = 0; i < N; i++) {
    assert_int_equal(a.label[i], b.label[(i * 237 + 11) % N]);
    assert_int_equal(a.part[i], b.part[(i * 237 + 11) % N]);
  }
}

/* A row of particles 0.9 apart, h = 1: unbroken 0-3, broken 4-6, unbroken 7-8. */
static struct sph_particles *row(void) {
  struct sph_particles *p = make(9, SPH_WITH_DAMAGE | SPH_WITH_STRESS);
  for (size_t i = 0; i < 9; i++) {
    p->x[i] = 0.9 * (double)i;
    p->damage_cbrt[i] = i >= 4 && i <= 6;
  }
  return p;
}

TEST(only_one_layer_joins_and_nearest_decides) {
  SPH_PARTICLES *p = row();
  struct sph_fragments_options o = sph_fragments_default();
  struct sph_fragments with = find(p, &o);
  const uint32_t label[9] = {0, 0, 0, 0, 0, 2, 1, 1, 1};
  assert_int_equal(with.count, 3);
  for (int i = 0; i < 9; i++)
    assert_int_equal(with.label[i], label[i]);
  assert_int_equal(with.part[4], SPH_FRAGMENTS_LAYER);
  assert_int_equal(with.part[5], SPH_FRAGMENTS_SINGLE);
  assert_true(with.fragments[0].mass == 5 && with.core_largest == 4 && with.core_second == 2 && with.single_mass == 1);
  assert_int_equal(with.resolved, 2);
  assert_int_equal(with.fragments[2].first, 5);
  sph_fragments_clear(&with);
  o.layer = false;
  struct sph_fragments bare = find(p, &o);
  assert_true(bare.fragments[0].mass == 4 && bare.fragments[1].mass == 2 && bare.single_mass == 3);
  assert_int_equal(bare.count, 5);
  sph_fragments_clear(&bare);
  o.layer = true; /* one broken particle between the two: at the same distance, the heavier has it; nearer, the lighter
                   */
  p->damage_cbrt[4] = p->damage_cbrt[6] = 0;
  p->x[5] = 4.5;
  p->x[4] = 3.5;
  p->x[6] = 5.5;
  struct sph_fragments tie = find(p, &o);
  assert_int_equal(tie.label[5], tie.label[4]);
  sph_fragments_clear(&tie);
  p->mass[6] = 10;
  tie = find(p, &o);
  assert_int_equal(tie.label[5], tie.label[6]);
  assert_int_equal(tie.label[5], 0);
  sph_fragments_clear(&tie);
  p->x[5] = 4.4999;
  tie = find(p, &o);
  assert_int_equal(tie.label[5], tie.label[4]);
  sph_fragments_clear(&tie);
}

TEST(static_strength_breaks) {
  SPH_PARTICLES *p = row();
  const struct sph_fragments_body body = {.static_strength = 17e6};
  struct sph_fragments_options o = sph_fragments_default();
  o.bodies = &body;
  o.body_count = 1;
  for (size_t i = 0; i < 9; i++)
    p->damage_cbrt[i] = 1e-3; /* cracks have entered all of them */
  struct sph_fragments f = find(p, &o);
  assert_int_equal(f.broken, 0);
  assert_int_equal(f.count, 1);
  sph_fragments_clear(&f);
  /* shear in xy alone: principal values +-s; tension enters with the pressure */
  p->stress[1][2] = 17.1e6;
  p->stress[1][3] = 16.9e6;
  p->stress[1][4] = 17.1e6;
  p->pressure[4] = 1e6; /* compressed: 16.1 */
  p->stress[1][5] = 16.9e6;
  p->pressure[5] = -1e6; /* pulled: 17.9 */
  p->pressure[6] = -18e6;
  p->damage_cbrt[6] = cbrt(0.1); /* the damaged stress: 16.2 */
  p->stress[1][7] = 18e6;
  p->damage_cbrt[7] = cbrt(0.02); /* 17.64 */
  p->stress[1][1] = 18e6;
  p->damage_cbrt[1] = cbrt(0.1); /* 16.2: damage takes shear, too */
  f = find(p, &o);
  const uint8_t broken[9] = {0, 0, 1, 0, 0, 1, 0, 1, 0};
  for (int i = 0; i < 9; i++)
    assert_int_equal(f.part[i] != SPH_FRAGMENTS_CORE, broken[i]);
  assert_int_equal(f.broken, 3);
  sph_fragments_clear(&f);
  p->damage_cbrt[2] = 0; /* undamaged matter stays whole under the same tension */
  f = find(p, &o);
  assert_int_equal(f.part[2], SPH_FRAGMENTS_CORE);
  assert_int_equal(f.broken, 2);
  sph_fragments_clear(&f);
}

/* Two blocks in contact are two fragments; a body that is left out is never counted. */
TEST(bodies_touch_or_are_left_out) {
  SPH_PARTICLES *p = make(10, 0);
  struct sph_fragments_options o = sph_fragments_default();
  struct sph_fragments_body bodies[2] = {{false, NAN}, {false, NAN}};
  for (size_t i = 0; i < 10; i++) {
    p->x[i] = 0.9 * (double)i;
    p->body[i] = i >= 6;
  }
  o.bodies = bodies;
  o.body_count = 2;
  struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 2);
  assert_true(f.fragments[0].mass == 6 && f.fragments[1].mass == 4 && f.mass == 10);
  assert_int_equal(f.fragments[1].first, 6);
  sph_fragments_clear(&f);
  bodies[0].left_out = true;
  f = find(p, &o);
  assert_int_equal(f.count, 1);
  assert_true(f.mass == 4 && f.fragments[0].mass == 4);
  assert_int_equal(f.fragments[0].first, 6);
  assert_int_equal(f.label[0], UINT32_MAX);
  assert_int_equal(f.part[0], SPH_FRAGMENTS_LEFT_OUT);
  sph_fragments_clear(&f);
}

static void near(double a, double b, double scale) {
  if (!(fabs(a - b) <= 2e-13 * scale)) /* sums of 400 terms, an inertia tensor of condition 10 */
    fail_msg("%.17g is not %.17g", a, b);
}

TEST(turning_pieces) {
  enum { N = 400 };
  struct sph_particles *p = make(N, 0);
  struct sph_fragments_options o = sph_fragments_default();
  const double spin[3] = {300, -200, 500}, velocity[3] = {10, -20, 5};
  double angular[3] = {0}, trace = 0;
  for (size_t i = 0; i < N; i++) {
    /* an asymmetric brick, 4 x 2 x 1 and heavier at one end, none of its axes along x, y, z */
    double a = 4 * draw(7, i, 0) - 2, b = 2 * draw(7, i, 1) - 1, c = draw(7, i, 2) - 0.5;
    double r[3] = {0.8 * a - 0.36 * b + 0.48 * c + 100, 0.6 * a + 0.48 * b - 0.64 * c - 50, 0.8 * b + 0.6 * c + 20};
    p->x[i] = r[0], p->y[i] = r[1], p->z[i] = r[2];
    p->mass[i] = 1 + (a > 0) + 0.5 * draw(7, i, 3);
    p->vx[i] = velocity[0] + spin[1] * r[2] - spin[2] * r[1];
    p->vy[i] = velocity[1] + spin[2] * r[0] - spin[0] * r[2];
    p->vz[i] = velocity[2] + spin[0] * r[1] - spin[1] * r[0];
  }
  struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 1);
  double energy = 0;
  const struct fragment *whole = f.fragments;
  for (size_t i = 0; i < N; i++) {
    double r[3] = {p->x[i] - whole->position[0], p->y[i] - whole->position[1], p->z[i] - whole->position[2]};
    double v[3] = {p->vx[i], p->vy[i], p->vz[i]};
    energy += 0.5 * p->mass[i] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    trace += 2 * p->mass[i] * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int d = 0; d < 3; d++)
      angular[d] += p->mass[i] * (r[(d + 1) % 3] * v[(d + 2) % 3] - r[(d + 2) % 3] * v[(d + 1) % 3]);
  }
  double apart = 0;
  for (int d = 0; d < 3; d++) {
    near(whole->spin[d], spin[d], 1000);
    apart = fmax(apart, fabs(3 * angular[d] / trace - spin[d]));
  }
  assert_true(apart > 50); /* a scalar moment of inertia would be far off here */
  near(whole->moment_of_inertia, trace / 3, trace);
  near(whole->kinetic_energy, energy, energy);
  near(whole->velocity[0], velocity[0] + spin[1] * whole->position[2] - spin[2] * whole->position[1], 1e5);
  sph_fragments_clear(&f);
  sph_particles_free(p);

  p = make(3, 0); /* three in a line along (1,2,2)/3: the spin about the line is unknown and reported as 0 */
  const double across[3] = {2, -2, 1}; /* of length 3, at right angles to the line */
  for (size_t i = 0; i < 3; i++) {
    double s = 0.5 * ((double)i - 1);
    p->x[i] = s / 3, p->y[i] = 2 * s / 3, p->z[i] = 2 * s / 3;
    p->vx[i] = across[1] * p->z[i] - across[2] * p->y[i];
    p->vy[i] = across[2] * p->x[i] - across[0] * p->z[i];
    p->vz[i] = across[0] * p->y[i] - across[1] * p->x[i];
  }
  f = find(p, &o);
  assert_int_equal(f.count, 1);
  for (int d = 0; d < 3; d++)
    near(f.fragments[0].spin[d], across[d], 10);
  sph_fragments_clear(&f);
  sph_particles_free(p);
}

/* An ellipsoid of axes 3:2:1.5 cut from a fine lattice has these ratios; ejecta carry their energy relative to it. */
TEST(shape_and_ejecta) {
  size_t n = 0;
  SPH_PARTICLES *p = make(60000, 0);
  for (int a = -30; a <= 30; a++)
    for (int b = -20; b <= 20; b++)
      for (int c = -15; c <= 15; c++) {
        double x = a / 30.0, y = b / 20.0, z = c / 15.0;
        if (x * x + y * y + z * z > 1)
          continue;
        p->x[n] = 0.6 * a - 0.8 * b, p->y[n] = 0.8 * a + 0.6 * b, p->z[n] = c;
        p->vx[n++] = 7;
      }
  for (size_t k = 0; k < 2; k++) { /* two particles move at 3 m/s and -4 m/s relative to it */
    p->x[n] = 100 + 10 * (double)k;
    p->vx[n] = 7;
    p->vy[n++] = k ? -4 : 3;
  }
  p->n = n;
  struct sph_fragments_options o = sph_fragments_default();
  o.link_length = 1.1;
  OWNED_BY(sph_fragments_clear) struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 3);
  assert_true(fabs(f.axis_ratio[0] - 2.0 / 3) < 0.005 &&
              fabs(f.axis_ratio[1] - 0.5) < 0.005); /* a lattice's outline: 1/15^2 */
  assert_int_equal(f.resolved, 1);
}

/* A particle of the lattice at integer places, turned by the angles of 3-4-5 triangles about two axes. */
static void put_turned(struct sph_particles *p, double a, double b, double c) {
  const size_t i = p->n++;
  const double x = 0.6 * a - 0.8 * b, y = 0.8 * a + 0.6 * b;
  p->density[i] = 1;
  p->x[i] = x;
  p->y[i] = 0.28 * y - 0.96 * c;
  p->z[i] = 0.96 * y + 0.28 * c;
}

static void expect_lengths(struct sph_particles *p, const double length[3], double tolerance) {
  struct sph_fragments_options o = sph_fragments_default();
  o.link_length = 1.1;
  OWNED_BY(sph_fragments_clear) struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 1);
  for (int a = 0; a < 3; a++)
    if (!(fabs(f.fragments[0].length[a] - length[a]) <= tolerance))
      fail_msg("length %d: %g, expected %g +- %g", a, f.fragments[0].length[a], length[a], tolerance);
  sph_particles_free(p);
}

/* The axis of the solid ellipsoid with the moments of n particles in a row, one apart. */
static double axis_of(int n) {
  return sqrt(5 * (n * n - 1) / 3.0);
}

/* A lattice box whose moments are known; fewer than 60 particles and a line have no lengths; a sphere has its diameter.
 */
TEST(lengths) {
  struct sph_particles *p = make(12 * 7 * 4, 0);
  p->n = 0;
  for (int a = 0; a < 12; a++)
    for (int b = 0; b < 7; b++)
      for (int c = 0; c < 4; c++)
        put_turned(p, a, b, c);
  expect_lengths(p, (const double[]){axis_of(12), axis_of(7), axis_of(4)}, 1e-9);
  p = make(60, 0);
  p->n = 0;
  for (int a = 0; a < 60; a++)
    put_turned(p, a, 0, 0);
  expect_lengths(p, (const double[]){0, 0, 0}, 0);
  p = make(59, 0);
  p->n = 0;
  for (int a = 0; a < 59; a++)
    put_turned(p, a % 4, a / 4 % 4, a / 16);
  expect_lengths(p, (const double[]){0, 0, 0}, 0);
  for (int radius = 3; radius < 12; radius += 8) {
    p = make(10000, 0);
    p->n = 0;
    for (int a = -radius; a <= radius; a++)
      for (int b = -radius; b <= radius; b++)
        for (int c = -radius; c <= radius; c++)
          if (a * a + b * b + c * c <= radius * radius)
            put_turned(p, a, b, c);
    const double diameter = 2 * cbrt((double)p->n / (4 * M_PI / 3)); /* of the sphere of as many particles */
    expect_lengths(p, (const double[]){diameter, diameter, diameter}, 0.02 * diameter);
  }
}

/* Boxes 12:8:5 of about 74 particles, cut from a lattice in 40 directions: mean ratios within 0.02 of the box's.
 * Lengths between plates gave 0.50 for 0.42. */
TEST(ratios_of_coarse_boxes) {
  enum { BOXES = 40 };
  const double side[3] = {12 / 1.85, 8 / 1.85, 5 / 1.85};
  double middle = 0, shortest = 0;
  for (uint64_t box = 0; box < BOXES; box++) {
    double axis[3][3] = {0}, shift[3];
    for (int d = 0; d < 3; d++) {
      shift[d] = draw(box, 0, (uint64_t)d);
      axis[0][d] = draw(box, 1, (uint64_t)d) - 0.5;
      axis[1][d] = draw(box, 2, (uint64_t)d) - 0.5;
    }
    for (int a = 0; a < 2; a++) { /* Gram and Schmidt */
      double along = 0, square = 0;
      for (int d = 0; d < 3; d++)
        along += a ? axis[0][d] * axis[1][d] : 0;
      for (int d = 0; d < 3; d++) {
        axis[a][d] -= along * axis[0][d];
        square += axis[a][d] * axis[a][d];
      }
      for (int d = 0; d < 3; d++)
        axis[a][d] /= sqrt(square);
    }
    for (int d = 0; d < 3; d++)
      axis[2][d] = axis[0][(d + 1) % 3] * axis[1][(d + 2) % 3] - axis[0][(d + 2) % 3] * axis[1][(d + 1) % 3];
    SPH_PARTICLES *p = make(200, 0);
    p->n = 0;
    for (int i = -6; i <= 6; i++)
      for (int j = -6; j <= 6; j++)
        for (int k = -6; k <= 6; k++) {
          const double at[3] = {i + shift[0], j + shift[1], k + shift[2]};
          bool inside = true;
          for (int a = 0; a < 3; a++)
            inside &= fabs(at[0] * axis[a][0] + at[1] * axis[a][1] + at[2] * axis[a][2]) <= side[a] / 2;
          if (inside)
            put_turned(p, at[0], at[1], at[2]);
        }
    struct sph_fragments_options o = sph_fragments_default();
    o.link_length = 2; /* corners hang together */
    OWNED_BY(sph_fragments_clear) struct sph_fragments f = find(p, &o);
    const double *length = f.fragments[0].length;
    middle += length[1] / length[0] / BOXES;
    shortest += length[2] / length[0] / BOXES;
  }
  if (!(fabs(middle - 8 / 12.0) <= 0.02 && fabs(shortest - 5 / 12.0) <= 0.02))
    fail_msg("boxes 12:8:5: mean b/a %g and c/a %g", middle, shortest);
}

TEST(periodic_box) {
  /* a rod across the boundary x = 0 that turns about z, and a bar that spans the box along y */
  SPH_PARTICLES *p = make(24, 0);
  struct sph_fragments_options o = sph_fragments_default();
  o.periodic[0] = 20;
  o.periodic[1] = 9;
  for (size_t i = 0; i < 4; i++) {
    p->x[i] = fmod(18.8 + 0.9 * (double)i, 20);
    p->vy[i] = 0.5 * (18.8 + 0.9 * (double)i - 20.15);
  }
  for (size_t i = 4; i < 24; i++) {
    p->x[i] = 10 + 0.5 * (double)(i % 2);
    p->y[i] = 0.9 * (double)(i / 2 - 2);
    p->vz[i] = 2 * (p->x[i] - 10.25); /* -2 about y */
    p->vx[i] = 0.01 * p->y[i];        /* a shear, no turning */
  }
  OWNED_BY(sph_fragments_clear) struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 2);
  assert_true(f.fragments[0].count == 20 && f.fragments[1].count == 4);
  near(f.fragments[1].position[0], 20.15, 100);
  near(f.fragments[1].spin[2], 0.5, 10);
  near(f.fragments[0].spin[1], -2, 10);
  assert_true(f.fragments[0].spin[0] == 0 && f.fragments[0].spin[2] == 0);
}

/* A grid over the extent would need more than 1e27 cells; a particle that is not finite has no neighbours. */
TEST(far_flung_and_not_finite) {
  SPH_PARTICLES *p = row();
  struct sph_fragments_options o = sph_fragments_default();
  p->x[8] = 1e9;
  p->y[7] = -1e300;
  p->x[0] = NAN;
  p->vx[1] = INFINITY;
  OWNED_BY(sph_fragments_clear) struct sph_fragments f = find(p, &o);
  assert_int_equal(f.label[2], f.label[4]);
  assert_int_equal(f.fragments[0].count, 3); /* 2, 3 and their layer 4 */
  assert_int_equal(f.count, 7);
  assert_int_equal(f.part[0], SPH_FRAGMENTS_SINGLE);
  assert_int_equal(f.part[1], SPH_FRAGMENTS_SINGLE);
  assert_int_equal(f.part[8], SPH_FRAGMENTS_CORE);
}

TEST(nothing_all_dust_all_one) {
  struct sph_particles *p = make(0, 0);
  struct sph_fragments_options o = sph_fragments_default();
  struct sph_fragments f = find(p, &o);
  assert_true(f.count == 0 && f.fragments == NULL && f.mass == 0 && isnan(f.axis_ratio[0]));
  sph_fragments_clear(&f);
  sph_particles_free(p);
  p = row();
  for (int i = 0; i < 9; i++)
    p->damage_cbrt[i] = 1;
  f = find(p, &o);
  struct outcome outcome = {0};
  outcome_fragments(&outcome, f.count, f.fragments, &(struct outcome_small){.dust = 2});
  assert_int_equal(f.count, 9);
  assert_int_equal(f.resolved, 0);
  assert_true(f.single_mass == 9 && f.core_largest == 0 && outcome.dust_fraction == 1 && outcome.single_count == 9);
  sph_fragments_clear(&f);
  for (int i = 0; i < 9; i++)
    p->damage_cbrt[i] = 0.99;
  f = find(p, &o);
  assert_int_equal(f.count, 1);
  assert_true(f.fragments[0].mass == 9 && f.single_mass == 0 && f.core_largest == 9 && f.core_second == 0);
  sph_fragments_clear(&f);
  sph_particles_free(p);
}

/* With the initial smoothing lengths, expanding matter is not linked over larger distances. */
TEST(h_may_be_the_initial_one) {
  SPH_PARTICLES *p = row();
  double h[9];
  struct sph_fragments_options o = sph_fragments_default();
  for (int i = 0; i < 9; i++) {
    h[i] = 1;
    p->h[i] = 4;
  }
  struct sph_fragments f = find(p, &o);
  assert_int_equal(f.count, 1);
  sph_fragments_clear(&f);
  o.h = h;
  f = find(p, &o);
  assert_int_equal(f.count, 3);
  sph_fragments_clear(&f);
}
