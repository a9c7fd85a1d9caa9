/* Bodies before the first step: masses, ids, placement, overlap, motion, grips, damped sides; refusals. */

#include "engine/sph/body/bodies.h"
#include "tests/support/check.h"

static struct sph_body sphere(double radius, double particles, double density) {
  return (struct sph_body){.shape = {.kind = SPH_SHAPE_SPHERE, .radius = radius},
                           .lattice = {.particles = particles},
                           .density = density,
                           .h_over_spacing = NAN};
}

static const struct sph_body bar = {.shape = {.kind = SPH_SHAPE_BOX, .centre = {0, 0, 0}, .side = {0.1, 0.2, 0.4}},
                                    .lattice = {.kind = SPH_LATTICE_CUBIC, .particles = 1000},
                                    .density = 2000,
                                    .h_over_spacing = 1.3};

/* The sum is density x true volume to rounding: 2000 equal addends lose at most 2000 ulp, some 1e-13 of it. */
TEST(masses_add_up_and_ids_follow_bodies) {
  struct sph_body bodies[3] = {sphere(0.03, 2000, 2700), sphere(0.003, 37, 1185), bar};
  bodies[1].shape.centre[0] = 0.0331;
  bodies[2].shape.centre[1] = 1;
  bodies[1].lattice.turned = true; /* no corner, but a body like others */
  struct sph_range range[3];
  SPH_PARTICLES *p = NULL;
  assert_int_equal(sph_bodies_make(bodies, 3, SPH_WITH_STRESS | SPH_WITH_DAMAGE, &p, range, NULL), STATUS_OK);
  size_t next = 0;
  for (size_t b = 0; b < 3; b++) {
    const double volume = sph_shape_volume(&bodies[b].shape);
    double mass = 0;
    assert_true(range[b].first == next && range[b].n > 0);
    for (size_t i = next; i < next + range[b].n; i++) {
      mass += p->mass[i];
      assert_true(p->mass[i] == p->mass[next] && p->body[i] == b && p->density[i] == bodies[b].density);
      assert_true(p->h[i] == (b == 2 ? 1.3 : SPH_BODIES_H) * range[b].spacing);
      assert_true(p->vx[i] == 0 && p->energy[i] == 0);
    }
    assert_true(fabs(mass / (bodies[b].density * volume) - 1) < 1e-12 && fabs(range[b].mass / mass - 1) < 1e-12);
    next += range[b].n;
  }
  assert_int_equal(next, p->n);
  assert_int_equal(range[1].n, 37);
  assert_true(p->stress[5] && p->damage_cbrt && !p->held && !p->damping && !p->distention);
}

/* h^3 is proportional to the mass where particles differ. */
TEST(graded_bodies_have_graded_h) {
  struct sph_body body = bar;
  body.lattice = (struct sph_lattice){.particles = NAN,
                                      .grading = {.fine = 4e-3, .point = {0, 0, 0.2}, .radius = 0.01, .growth = 0.12}};
  struct sph_range range;
  SPH_PARTICLES *p = NULL;
  assert_int_equal(sph_bodies_make(&body, 1, 0, &p, &range, NULL), STATUS_OK);
  double mass = 0, least = HUGE_VAL, most = 0;
  for (size_t i = 0; i < p->n; i++) {
    mass += p->mass[i];
    least = fmin(least, p->h[i]);
    most = fmax(most, p->h[i]);
    assert_true(fabs(pow(p->h[i] / 1.3, 3) * 2000 / p->mass[i] - 1) < 1e-12);
  }
  assert_true(fabs(mass / (2000 * 0.1 * 0.2 * 0.4) - 1) < 1e-12 && most > 3 * least);
  assert_true(fabs(least / (1.3 * 4e-3) - 1) < 0.02); /* volumes are scaled so that they add up */
}

TEST(one_particle_is_a_body) {
  struct sph_range range;
  struct sph_particles *p = NULL;
  for (int kind = 0; kind < 3; kind++)
    for (int shape = 0; shape < 3; shape++) {
      struct sph_body one = sphere(2, 1, 1000);
      one.lattice.kind = kind;
      one.shape = (struct sph_shape){.kind = shape,
                                     .centre = {1, 2, 3},
                                     .radius = 1,
                                     .length = 2,
                                     .axis = {0, 1, 0},
                                     .side = {1, 1, 1}};
      assert_int_equal(sph_bodies_make(&one, 1, SPH_WITH_HELD | SPH_WITH_DAMPING | SPH_WITH_DISTENTION, &p, &range,
                                       NULL),
                       STATUS_OK);
      assert_true(p->n == 1 && p->distention[0] == 1 && !p->held[0] && p->damping[0] == 0);
      assert_true(fabs(p->mass[0] / (1000 * sph_shape_volume(&one.shape)) - 1) < 1e-14);
      assert_true(sph_shape_inside(&one.shape, (double[3]){p->x[0], p->y[0], p->z[0]}));
      sph_particles_free(p);
    }
}

TEST(the_same_bits_each_time) {
  for (int kind = 0; kind < 3; kind++) {
    struct sph_body body = sphere(1, 700, 1);
    body.lattice = (struct sph_lattice){.kind = kind, .particles = 700, .turned = true, .seed = 12, .body = 1};
    SPH_PARTICLES *p = NULL, *again = NULL, *other = NULL, *next = NULL;
    assert_int_equal(sph_bodies_make(&body, 1, 0, &p, NULL, NULL), STATUS_OK);
    assert_int_equal(sph_bodies_make(&body, 1, 0, &again, NULL, NULL), STATUS_OK);
    body.lattice.seed = 13;
    assert_int_equal(sph_bodies_make(&body, 1, 0, &other, NULL, NULL), STATUS_OK);
    body.lattice.seed = 12;
    body.lattice.body = 2;
    assert_int_equal(sph_bodies_make(&body, 1, 0, &next, NULL, NULL), STATUS_OK);
    assert_memory_equal(p->x, again->x, p->n * sizeof *p->x);
    assert_memory_equal(p->y, again->y, p->n * sizeof *p->y);
    assert_memory_equal(p->z, again->z, p->n * sizeof *p->z);
    assert_true(p->x[3] != other->x[3] && p->x[3] != next->x[3]);
    /* points follow each other along rows: another seed, another direction */
    const double row = p->x[351] - p->x[350], turned = other->x[351] - other->x[350];
    assert_true(fabs(row - turned) > 0.01 * hypot(row, p->y[351] - p->y[350]));
  }
}

/* The projectile touches the target above its centre, and the angle is that between flight direction and inward normal.
 */
TEST(projectiles_are_aimed) {
  const struct sph_shape targets[] = {
      {.kind = SPH_SHAPE_SPHERE, .centre = {1, 2, 3}, .radius = 0.03},
      {.kind = SPH_SHAPE_BOX, .centre = {1, 2, 3}, .side = {0.2, 0.2, 0.2}},
      {.kind = SPH_SHAPE_CYLINDER, .centre = {1, 2, 3}, .radius = 0.1, .length = 0.4, .axis = {0, 0, 1}},
      {.kind = SPH_SHAPE_CYLINDER, .centre = {1, 2, 3}, .radius = 0.1, .length = 0.4, .axis = {0, 0.6, 0.8}},
  };
  const double angles[] = {0, 0.5235987755982988, 1.2};
  for (int t = 0; t < 4; t++)
    for (int a = 0; a < 3; a++) {
      struct sph_shape shot = {.kind = SPH_SHAPE_SPHERE, .radius = 0.003};
      double flight[3], point[3], normal[3];
      OK(sph_bodies_aim(&targets[t], &shot, angles[a], flight, &error));
      assert_true(sph_shape_top(&targets[t], point, normal));
      assert_true(fabs(sph_shape_distance(&targets[t], point, NULL)) < 1e-12 && normal[2] > 0);
      assert_true(point[0] == 1 && point[1] == 2 && point[2] > 3);
      assert_true(fabs(sph_shape_gap(&targets[t], &shot)) < 1e-12);
      double along = 0, length = 0;
      for (int k = 0; k < 3; k++) {
        along -= flight[k] * normal[k];
        length += flight[k] * flight[k];
      }
      assert_true(fabs(length - 1) < 1e-12 && fabs(acos(fmin(1, along)) - angles[a]) < 1e-7);
      if (a) /* turned aside, towards +x */
        assert_true(flight[0] > -along * normal[0]);
      for (int k = 0; k < 3; k++)
        shot.centre[k] -= 1e-4 * flight[k];
      if (a < 2)
        assert_true(sph_shape_gap_ahead(&targets[t], &shot, flight) <= 0);
      for (int k = 0; k < 3; k++)
        flight[k] = -flight[k];
      assert_true(sph_shape_gap_ahead(&targets[t], &shot, flight) > 0); /* flies off: misses */
    }
}

TEST(overlaps_are_refused) {
  struct sph_body bodies[2] = {sphere(0.03, 500, 2700), sphere(0.003, 20, 1185)};
  bodies[1].shape.centre[2] = 0.0325; /* 0.5 mm too near */
  SPH_PARTICLES *p = NULL;
  assert_int_equal(sph_bodies_make(bodies, 2, 0, &p, NULL, &error), STATUS_CONTENT);
  assert_null(p);
  assert_string_equal(error.message, "the target and the projectile overlap by 0.0005 m");
  bodies[1].shape.centre[2] = 0.033; /* they touch */
  OK(sph_bodies_make(bodies, 2, 0, &p, NULL, &error));
}

TEST(bodies_move) {
  struct sph_body bodies[2] = {bar, sphere(0.05, 300, 1000)};
  bodies[1].shape.centre[0] = 3;
  struct sph_range range[2];
  SPH_PARTICLES *p = NULL;
  assert_int_equal(sph_bodies_make(bodies, 2, 0, &p, range, NULL), STATUS_OK);
  const double velocity[3] = {1, -2, 3}, spin[3] = {5, 6, 7};
  sph_bodies_move(p, range[1], velocity);
  sph_bodies_stretch(p, range[0], 60, 0.25);
  for (size_t i = 0; i < p->n; i++) {
    const bool moved = i >= range[1].first;
    assert_true(fabs(p->vx[i] - (moved ? 1 : -15 * p->x[i])) < 1e-12);
    assert_true(fabs(p->vy[i] - (moved ? -2 : -15 * p->y[i])) < 1e-12);
    assert_true(fabs(p->vz[i] - (moved ? 3 : 60 * p->z[i])) < 1e-12);
  }
  sph_bodies_spin(p, range[1], spin); /* adds */
  for (size_t i = range[1].first; i < p->n; i++) {
    const double v[3] = {p->vx[i] - 1, p->vy[i] + 2, p->vz[i] - 3};
    assert_true(fabs(v[0] - (6 * p->z[i] - 7 * p->y[i])) < 1e-12); /* right-handed */
    assert_true(fabs(v[1] - (7 * p->x[i] - 5 * p->z[i])) < 1e-12);
    assert_true(fabs(v[2] - (5 * p->y[i] - 6 * p->x[i])) < 1e-12);
  }
}

TEST(ends_are_held_and_sides_damped) {
  struct sph_range range;
  SPH_PARTICLES *p = NULL;
  assert_int_equal(sph_bodies_make(&bar, 1, SPH_WITH_HELD | SPH_WITH_DAMPING, &p, &range, NULL), STATUS_OK);
  sph_bodies_hold(p, range, 0.15, SPH_HELD_Z | SPH_HELD_X);
  /* all sides except the upper z side, where the impact is */
  sph_bodies_damp(p, range, &bar.shape, 0.04, 1e5);
  size_t count = 0, damped = 0, free_top = 0;
  for (size_t i = 0; i < p->n; i++) {
    const bool end = fabs(p->z[i]) > 0.15;
    count += end;
    assert_int_equal(p->held[i], end ? SPH_HELD_X | SPH_HELD_Z : 0);
    const double from = fmin(fmin(0.05 - fabs(p->x[i]), 0.1 - fabs(p->y[i])), 0.2 + p->z[i]);
    const double want = from < 0.04 ? 1e5 * pow(1 - from / 0.04, 2) : 0;
    assert_true(fabs(p->damping[i] - want) < 1e-6);
    damped += p->damping[i] > 0;
    free_top += p->z[i] > 0.17 && p->damping[i] == 0;
  }
  assert_true(count > 100 && count < p->n);
  assert_true(damped > 100 && damped < p->n && free_top > 0);
}

TEST(absurd_bodies_are_refused) {
  struct sph_particles *p = NULL;
  struct sph_body body = sphere(1, 1e12, 1000);
  assert_int_equal(sph_bodies_make(&body, 1, 0, &p, NULL, &error), STATUS_MEMORY);
  assert_non_null(strstr(error.message, "1e+12 particles"));
  assert_null(p);
  assert_int_equal(sph_particles_make((size_t)1e13, 0, &p, &error), STATUS_MEMORY);
  assert_null(p);
  /* from grains of dust to moons */
  for (double size = 1e-6; size < 1e7; size *= 100) {
    body = sphere(size, 300, 1000);
    struct sph_range range;
    OK(sph_bodies_make(&body, 1, 0, &p, &range, &error));
    assert_int_equal(p->n, 300);
    assert_true(fabs(range.nearest / size - range.nearest / range.spacing * cbrt(4 * M_PI / 900)) < 1e-9);
    sph_particles_free(p);
  }
}
