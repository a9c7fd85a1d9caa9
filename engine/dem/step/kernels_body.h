/* Instantiates the range loops for one CPU class: the including file sets LANES and KERNELS_TABLE, KERNELS_NAME. */
#include "engine/dem/beams/bond_range.h"
#include "engine/dem/contacts/contact_range.h"
#include "engine/dem/step/lanes.h"
#include "engine/dem/step/system_layout.h"

/* ---- time integration over all grains ----
 *
 * Velocity Verlet: kick by half a step, drift, new forces, kick by half a step. Forces that depend on velocities see
 * v + dt a of the step's start (the velocity of the first kick carried on by another half step).
 *
 * Gear's predictor-corrector of fifth order in Nordsieck form: r_k = dt^k/k! d^k x/dt^k, k = 0..5; prediction by
 * Pascal's triangle, correction r_k += g_k (dt^2/2 a - r_2). g = {3/20, 251/360, 1, 11/18, 1/6, 1/60} for forces of
 * positions alone, 3/16 in the first place with velocity-dependent forces (Gear 1971, table 9.1; Allen & Tildesley
 * 1987, appendix E, table E.1). Without velocities 3/20 gives order 6, 3/16 order 5. Damping sees predicted velocities,
 * as in K99. */

LANES_INLINE void motion_turn(struct dem_columns *c, size_t g) {
  lanes_d sine, cosine;
  lanes_sincos(lanes_load(c->angle + g), &sine, &cosine);
  lanes_store(c->sine + g, sine);
  lanes_store(c->cosine + g, cosine);
}

/* Tests whether a grain has left its skin, and whether its state is still finite. A turn moves the farthest vertex by
 * at most radius x angle. */
LANES_INLINE void motion_check(const struct dem_system *s, size_t g, lanes_i *moved, lanes_i *lost) {
  const struct dem_columns *c = &s->c;
  const lanes_d x = lanes_load(c->x + g), y = lanes_load(c->y + g), angle = lanes_load(c->angle + g);
  const lanes_d dx = x - lanes_load(c->list_x + g), dy = y - lanes_load(c->list_y + g);
  const lanes_d swing = lanes_load(c->radius + g) * lanes_abs(angle - lanes_load(c->list_angle + g));
  const lanes_d left = lanes_load(c->skin + g) - swing;
  *moved |= (dx * dx + dy * dy > left * left) | (left < 0.0);
  const lanes_d speed = lanes_abs(lanes_load(c->vx + g)) + lanes_abs(lanes_load(c->vy + g)) +
                        lanes_abs(lanes_load(c->spin + g));
  *lost |= ~((lanes_abs(x) + lanes_abs(y) + speed < 1e30) & (lanes_abs(angle) < 1e8));
}

static bool motion_verlet_drift(struct dem_system *s, bool *moved_out) {
  struct dem_columns *c = &s->c;
  const double dt = s->in->fidelity.time_step, half = 0.5 * dt;
  double *const velocity[3] = {c->vx, c->vy, c->spin}, *const force[3] = {c->fx, c->fy, c->torque};
  double *const mobility[3] = {c->mobility_x, c->mobility_y, c->mobility_angle};
  double *const position[3] = {c->x, c->y, c->angle};
  double *const guess[3] = {c->guess_vx, c->guess_vy, c->guess_spin};
  lanes_i moved = {0}, lost = {0};
  for (size_t g = 0; g < s->padded; g += LANES) {
    for (int k = 0; k < 3; k++) {
      const lanes_d kick = half * (lanes_load(force[k] + g) * lanes_load(mobility[k] + g));
      const lanes_d v = lanes_load(velocity[k] + g) + kick;
      lanes_store(velocity[k] + g, v);
      if (s->velocities)
        lanes_store(guess[k] + g, v + kick);
      lanes_store(position[k] + g, lanes_load(position[k] + g) + dt * v);
    }
    motion_turn(c, g);
    motion_check(s, g, &moved, &lost);
  }
  *moved_out = lanes_any(moved);
  return !lanes_any(lost);
}

static void motion_verlet_kick(struct dem_system *s) {
  struct dem_columns *c = &s->c;
  const double half = 0.5 * s->in->fidelity.time_step;
  double *const velocity[3] = {c->vx, c->vy, c->spin}, *const force[3] = {c->fx, c->fy, c->torque};
  double *const mobility[3] = {c->mobility_x, c->mobility_y, c->mobility_angle};
  for (int k = 0; k < 3; k++)
    for (size_t g = 0; g < s->padded; g += LANES)
      lanes_store(velocity[k] + g,
                  lanes_load(velocity[k] + g) + half * (lanes_load(force[k] + g) * lanes_load(mobility[k] + g)));
}

static bool motion_gear_predict(struct dem_system *s, bool *moved_out) {
  struct dem_columns *c = &s->c;
  const double dt = s->in->fidelity.time_step;
  double *const velocity[3] = {c->vx, c->vy, c->spin}, *const position[3] = {c->x, c->y, c->angle};
  double *const guess[3] = {c->guess_vx, c->guess_vy, c->guess_spin};
  lanes_i moved = {0}, lost = {0};
  for (size_t g = 0; g < s->padded; g += LANES) {
    for (int k = 0; k < 3; k++) {
      double *const *r = c->gear[k];
      const lanes_d r1 = dt * lanes_load(velocity[k] + g), r2 = lanes_load(r[2] + g), r3 = lanes_load(r[3] + g);
      const lanes_d r4 = lanes_load(r[4] + g), r5 = lanes_load(r[5] + g);
      lanes_store(position[k] + g, lanes_load(position[k] + g) + r1 + (r2 + (r3 + (r4 + r5))));
      const lanes_d v = (r1 + 2.0 * r2 + 3.0 * r3 + 4.0 * r4 + 5.0 * r5) / dt;
      lanes_store(velocity[k] + g, v);
      lanes_store(guess[k] + g, v);
      lanes_store(r[2] + g, r2 + 3.0 * r3 + 6.0 * r4 + 10.0 * r5);
      lanes_store(r[3] + g, r3 + 4.0 * r4 + 10.0 * r5);
      lanes_store(r[4] + g, r4 + 5.0 * r5);
    }
    motion_turn(c, g);
    motion_check(s, g, &moved, &lost);
  }
  *moved_out = lanes_any(moved);
  return !lanes_any(lost);
}

static void motion_gear_correct(struct dem_system *s) {
  struct dem_columns *c = &s->c;
  const double dt = s->in->fidelity.time_step, position_share = s->velocities ? 3.0 / 16.0 : 3.0 / 20.0;
  double *const velocity[3] = {c->vx, c->vy, c->spin}, *const position[3] = {c->x, c->y, c->angle};
  double *const force[3] = {c->fx, c->fy, c->torque};
  double *const mobility[3] = {c->mobility_x, c->mobility_y, c->mobility_angle};
  for (size_t g = 0; g < s->padded; g += LANES) {
    for (int k = 0; k < 3; k++) {
      double *const *r = c->gear[k];
      const lanes_d error = 0.5 * dt * dt * (lanes_load(force[k] + g) * lanes_load(mobility[k] + g)) -
                            lanes_load(r[2] + g);
      lanes_store(position[k] + g, lanes_load(position[k] + g) + position_share * error);
      lanes_store(velocity[k] + g, lanes_load(velocity[k] + g) + (251.0 / 360.0) / dt * error);
      lanes_store(r[2] + g, lanes_load(r[2] + g) + error);
      lanes_store(r[3] + g, lanes_load(r[3] + g) + 11.0 / 18.0 * error);
      lanes_store(r[4] + g, lanes_load(r[4] + g) + 1.0 / 6.0 * error);
      lanes_store(r[5] + g, lanes_load(r[5] + g) + 1.0 / 60.0 * error);
    }
    motion_turn(c, g);
  }
}

/* ---- the table of this CPU class ---- */

/* The loops of each law, with velocities and without. */
#define KERNELS_OF_LAW(number, name, doc)                                                                              \
  static void kernels_bonds_##number(struct dem_system *s) {                                                           \
    bond_range(s, BOND_FORCES, DEM_CONTACT_##number, true);                                                            \
  }                                                                                                                    \
  static void kernels_general_##number(struct dem_system *s) {                                                         \
    near_general(s, false, DEM_CONTACT_##number, true);                                                                \
  }                                                                                                                    \
  static void kernels_still_bonds_##number(struct dem_system *s) {                                                     \
    if (!dem_laws[DEM_CONTACT_##number].needs_velocities)                                                              \
      bond_range(s, BOND_FORCES, DEM_CONTACT_##number, false);                                                         \
  }                                                                                                                    \
  static void kernels_still_general_##number(struct dem_system *s) {                                                   \
    if (!dem_laws[DEM_CONTACT_##number].needs_velocities)                                                              \
      near_general(s, false, DEM_CONTACT_##number, false);                                                             \
  }
DEM_LAWS(KERNELS_OF_LAW, )
#undef KERNELS_OF_LAW

typedef void kernels_loop(struct dem_system *s);
#define KERNELS_BONDS(number, name, doc)                                                                               \
  { kernels_still_bonds_##number, kernels_bonds_##number }
#define KERNELS_GENERAL(number, name, doc)                                                                             \
  { kernels_still_general_##number, kernels_general_##number }
static kernels_loop *const kernels_bonds[][2] = {DEM_LAWS(KERNELS_BONDS, DEM_LAWS_COMMA)}; /* [1]: velocities */
static kernels_loop *const kernels_general[][2] = {DEM_LAWS(KERNELS_GENERAL, DEM_LAWS_COMMA)};
#undef KERNELS_BONDS
#undef KERNELS_GENERAL

static void kernels_forces(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF) {
    bond_range(s, BOND_FORCES, DEM_CONTACT_OFF, false);
    return;
  }
  kernels_bonds[s->in->contact.law][s->velocities](s);
  near_range(s);
  kernels_general[s->in->contact.law][s->velocities](s);
}

/* Overlaps and their energy are the same for all laws. */
static void kernels_measure(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF) {
    bond_range(s, BOND_MEASURE, DEM_CONTACT_OFF, false);
    return;
  }
  bond_range(s, BOND_MEASURE, DEM_CONTACT_CONSERVATIVE, false);
  near_range(s);
  near_general(s, true, DEM_CONTACT_CONSERVATIVE, false);
}

static void kernels_turn(struct dem_system *s) {
  for (size_t g = 0; g < s->padded; g += LANES)
    motion_turn(&s->c, g);
}
const struct dem_kernels KERNELS_TABLE = {
    .name = KERNELS_NAME,
    .rest = bond_rest,
    .forces = kernels_forces,
    .measure = kernels_measure,
    .verlet_drift = motion_verlet_drift,
    .verlet_kick = motion_verlet_kick,
    .gear_predict = motion_gear_predict,
    .gear_correct = motion_gear_correct,
    .turn = kernels_turn,
    .best_side = overlap_best_side,
    .overlap = overlap_rings,
};
