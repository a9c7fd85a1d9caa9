/* Higher derivatives for the start of the Gear integrator. It needs five; a scene gives one. */

#include <stdlib.h>

#include "engine/dem/contacts/neighbours.h"
#include "engine/dem/step/kernels.h"
#include "engine/dem/step/system.h"

enum { TRIAL_STEPS = 4 };

/* One array per use and coordinate, each of `padded` doubles. */
struct trial {
  double *x0[3], *v0[3], *dx[3], *dv[3], *a[TRIAL_STEPS + 1][3];
};

static void accelerations(const struct dem_system *s, double *const a[3]) {
  const double *const force[3] = {s->c.fx, s->c.fy, s->c.torque};
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  for (int k = 0; k < 3; k++)
    for (size_t g = 0; g < s->padded; g++)
      a[k][g] = force[k][g] * mobility[k][g];
}

/* Classical fourth-order step from the state now; the accelerations of its start are in `a`. */
static bool runge_kutta(struct dem_system *s, const struct trial *t, double *const a[3]) {
  static const double ahead[4] = {0.5, 0.5, 1.0, 0.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  double *const position[3] = {s->c.x, s->c.y, s->c.angle}, *const velocity[3] = {s->c.vx, s->c.vy, s->c.spin};
  double *const guess[3] = {s->c.guess_vx, s->c.guess_vy, s->c.guess_spin};
  const double *const force[3] = {s->c.fx, s->c.fy, s->c.torque};
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  const double dt = s->in->fidelity.time_step;
  accelerations(s, a);
  for (int k = 0; k < 3; k++)
    for (size_t g = 0; g < s->padded; g++) {
      t->x0[k][g] = position[k][g];
      t->v0[k][g] = velocity[k][g];
      t->dx[k][g] = t->dv[k][g] = 0.0;
    }
  for (int stage = 0; stage < 4; stage++) {
    for (int k = 0; k < 3; k++)
      for (size_t g = 0; g < s->padded; g++) {
        const double v = velocity[k][g], acceleration = force[k][g] * mobility[k][g];
        t->dx[k][g] += weight[stage] * dt * v;
        t->dv[k][g] += weight[stage] * dt * acceleration;
        position[k][g] = t->x0[k][g] + (stage < 3 ? ahead[stage] * dt * v : t->dx[k][g]);
        velocity[k][g] = t->v0[k][g] + (stage < 3 ? ahead[stage] * dt * acceleration : t->dv[k][g]);
        guess[k][g] = velocity[k][g];
        if (!(position[k][g] > -1e30 && position[k][g] < 1e30))
          return false;
      }
    s->kernels->turn(s);
    if (!dem_neighbours_make(s))
      return false;
    dem_system_evaluate(s, 0.0);
  }
  return true;
}

bool dem_gear_start(struct dem_system *s) {
  const size_t n = s->padded, arrays = 3 * (4 + TRIAL_STEPS + 1), size = dem_system_state_size(s);
  const double dt = s->in->fidelity.time_step;
  double *memory = malloc(arrays * n * sizeof *memory);
  void *state = malloc(size);
  struct trial t;
  bool done = memory && state;
  s->no_memory = !done;
  if (!done)
    goto cleanup;
  double *next = memory;
  for (int k = 0; k < 3; k++) {
    double **const columns[] = {&t.x0[k],   &t.v0[k],   &t.dx[k],   &t.dv[k],  &t.a[0][k],
                                &t.a[1][k], &t.a[2][k], &t.a[3][k], &t.a[4][k]};
    for (size_t c = 0; c < sizeof columns / sizeof *columns; ++c, next += n)
      *columns[c] = next;
  }
  dem_system_state_save(s, state);
  for (int step = 0; step < TRIAL_STEPS && done; step++)
    done = runge_kutta(s, &t, t.a[step]);
  accelerations(s, t.a[TRIAL_STEPS]);
  done = dem_system_state_load(s, state, size) && done;
  for (int k = 0; k < 3 && done; k++)
    for (size_t g = 0; g < n; g++) { /* one-sided differences of fourth, third and second order */
      const double a0 = t.a[0][k][g], a1 = t.a[1][k][g], a2 = t.a[2][k][g], a3 = t.a[3][k][g], a4 = t.a[4][k][g];
      const double square = dt * dt;
      s->c.gear[k][2][g] = square / 2.0 * a0;
      s->c.gear[k][3][g] = square / 6.0 * (-25.0 * a0 + 48.0 * a1 - 36.0 * a2 + 16.0 * a3 - 3.0 * a4) / 12.0;
      s->c.gear[k][4][g] = square / 24.0 * (35.0 * a0 - 104.0 * a1 + 114.0 * a2 - 56.0 * a3 + 11.0 * a4) / 12.0;
      s->c.gear[k][5][g] = square / 120.0 * (-5.0 * a0 + 18.0 * a1 - 24.0 * a2 + 14.0 * a3 - 3.0 * a4) / 2.0;
    }
cleanup:
  free(state);
  free(memory);
  return done;
}
