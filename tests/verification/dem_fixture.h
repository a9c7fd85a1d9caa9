/* Small systems for the tests of the moving grains. A system keeps a pointer to the inputs of its creation: they must
 * outlive it. */
#pragma once

#include "engine/dem/step/system.h"
#include "engine/dem/step/system_layout.h"
#include "tests/support/check.h"

/* The default scene without breaking, and with a threshold of its own for the angle. */
static inline struct dem_inputs fixture_inputs(void) {
  struct dem_inputs in;
  field_defaults(&dem_inputs, &in);
  in.threshold.breaking = false;
  in.threshold.angle = 0.07;
  return in;
}

/* Fails and prints the values unless |a - b| <= tolerance. */
static inline void fixture_near(double a, double b, double tolerance, const char *what) {
  if (fabs(a - b) <= tolerance)
    return;
  fail_msg("%s: %.17g against %.17g, difference %g, allowed %g", what, a, b, a - b, tolerance);
}

/* Columns x rows squares of side h, m; neighbours bonded if `bonded`; `gap`: distance between columns. Free with
 * fixture_free. */
static inline struct dem_tessellation *fixture_squares(uint32_t columns, uint32_t rows, double h, double gap,
                                                       bool bonded) {
  struct dem_tessellation *t = calloc(1, sizeof *t);
  const size_t n = (size_t)columns * rows, pairs = bonded ? (columns - 1) * rows + columns * (rows - 1) : 0;
  t->cell_count = n;
  t->first_vertex = calloc(n + 1, sizeof *t->first_vertex);
  t->vertex = calloc(4 * n, sizeof *t->vertex);
  t->centroid = calloc(n, sizeof *t->centroid);
  t->area = calloc(n, sizeof *t->area);
  t->polar_moment = calloc(n, sizeof *t->polar_moment);
  t->grid_x = calloc(n, sizeof *t->grid_x);
  t->grid_y = calloc(n, sizeof *t->grid_y);
  t->pair = calloc(pairs + 1, sizeof *t->pair);
  t->side = calloc(pairs + 1, sizeof *t->side);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t a = i % columns, b = i / columns;
    const double x = a * (h + gap), y = b * h;
    t->first_vertex[i + 1] = 4 * (i + 1);
    for (uint32_t v = 0; v < 4; v++)
      t->vertex[4 * i + v] = (struct dem_point){x + (v == 1 || v == 2 ? h : 0.0), y + (v >= 2 ? h : 0.0)};
    t->centroid[i] = (struct dem_point){x + 0.5 * h, y + 0.5 * h};
    t->area[i] = h * h;
    t->polar_moment[i] = h * h * h * h / 6.0;
    t->grid_x[i] = a;
    t->grid_y[i] = b;
    for (int up = 0; up < 2 && bonded; up++) {
      if (up ? b + 1 == rows : a + 1 == columns)
        continue;
      t->pair[t->pair_count][0] = i;
      t->pair[t->pair_count][1] = up ? i + columns : i + 1;
      t->side[t->pair_count++] = h;
    }
  }
  return t;
}

static inline struct dem_tessellation *fixture_disc(double radius, double spacing, double disorder, uint64_t seed) {
  const struct dem_lattice lattice = {.outline = DEM_OUTLINE_DISC,
                                      .spacing = spacing,
                                      .disorder = disorder,
                                      .radius = radius,
                                      .seed = seed};
  struct dem_tessellation *t = NULL;
  OK(dem_tessellation_make(&lattice, &t, &error));
  return t;
}

static inline struct dem_system *fixture_create(const struct dem_tessellation *t, const struct dem_inputs *in) {
  struct dem_system *system = NULL;
  OK(dem_system_create(t, in, 0, &system, &error));
  return system;
}

/* Moves grains to given positions; forces follow at the next evaluation. */
static inline void fixture_place(struct dem_system *s, uint32_t grain, double x, double y, double angle) {
  s->c.x[grain] = x;
  s->c.y[grain] = y;
  s->c.angle[grain] = angle;
  s->now.ready = 0;
}

/* Forces at the current positions, on a system at rest: a step so short that nothing can move. */
static inline void fixture_evaluate(struct dem_system *s) {
  double *const columns[6] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle, s->c.vx, s->c.vy, s->c.spin};
  OWNED double *kept = calloc(6 * s->padded, sizeof *kept);
  for (int k = 0; k < 6; k++) {
    memcpy(kept + (size_t)k * s->padded, columns[k], s->padded * sizeof *kept);
    memset(columns[k], 0, s->padded * sizeof *kept);
  }
  s->now.ready = 0;
  assert_true(dem_system_step(s));
  for (int k = 0; k < 6; k++)
    memcpy(columns[k], kept + (size_t)k * s->padded, s->padded * sizeof *kept);
}

static inline double fixture_potential(struct dem_system *s) {
  const struct dem_ledger l = dem_system_ledger(s);
  return l.beam + l.contact;
}

static inline double fixture_total(struct dem_ledger l) {
  return l.kinetic + l.beam + l.contact + l.broken_beam + l.damping + l.friction - l.external_work;
}

/* Uniform in [-1, 1), for test set-ups only. */
static inline double fixture_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-52 - 1.0;
}
