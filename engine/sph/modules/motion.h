/* Positions, velocities, density, energy and h: predictor, corrector and the limits of the time step.
 *
 * One evaluation a step: q* = q + dt q'(t), then, with the rates at the predicted state, q = q* + dt/2 (q'* - q');
 * positions x* = x + dt v + dt^2/2 a are not corrected. The scheme is of second order; if forces depend on positions
 * alone, it is velocity Verlet. h keeps h^3 rho: h <- h (rho_old/rho_new)^(1/3), the integral of dh/dt = -(h/3)
 * (drho/dt)/rho, within bounds. */

TIME_STEP_LIMIT(COURANT, courant, "the speed of sound and viscosity, or by a damped side")
TIME_STEP_LIMIT(FORCE, force, "the acceleration")
TIME_STEP_LIMIT(ENERGY, energy, "the change of internal energy")
TIME_STEP_LIMIT(DENSITY, density, "the change of density")

#ifdef SPH_MODULE_LOOPS

/* (1 + e)^(1/3) for the small change e of density in a step. The error is below e^4/24; |e| stays below 0.1. */
RANGE_INLINE double motion_cube_root(double e) {
  return 1 + e * (1.0 / 3 - e * (1.0 / 9 - e * (5.0 / 81)));
}

/* Holds internal energy at or above zero, unless method.negative_energy, and density at or above the body's bound. The
 * ledger counts the energy that this adds. */
RANGE_INLINE void motion_clamp(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  double *energy = s->c.energy, *density = s->c.density;
  const double lowest = body->lowest_density, coldest = body->lowest_energy;
  int64_t below = 0;
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++)
    below |= -(int64_t)(energy[i] < coldest) | -(int64_t)(density[i] < lowest);
  if (!below)
    return;
  for (size_t i = b->low; i < b->high; i++) {
    if (energy[i] < coldest) {
      b->clamped -= s->c.mass[i] * energy[i];
      energy[i] = 0;
    }
    if (density[i] < lowest) {
      b->density_held++;
      density[i] = lowest;
    }
  }
}

RANGE_HOOK void motion_predict(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double dt = s->dt, half = 0.5 * dt;
  double *const position[3] = {s->c.x, s->c.y, s->c.z}, *const velocity[3] = {s->c.vx, s->c.vy, s->c.vz};
  double *const acceleration[3] = {s->c.ax, s->c.ay, s->c.az};
  const size_t low = b->low, n = b->high - low;
  double way2[SPH_BLOCK] = {0}, growth[SPH_BLOCK];
  for (int k = 0; k < 3; k++) {
    double *x = position[k], *v = velocity[k];
    const double *a = acceleration[k];
    RANGE_LOOP
    for (size_t m = 0; m < n; m++) {
      const double way = dt * (v[low + m] + half * a[low + m]);
      x[low + m] += way;
      v[low + m] += dt * a[low + m];
      way2[m] += way * way;
    }
  }
  double *density = s->c.density, *energy = s->c.energy, *h = s->c.h;
  const double *density_rate = s->c.density_rate, *energy_rate = s->c.energy_rate;
  const double *h0 = s->c.h_initial, h_low = SPH_LOWEST_H, h_high = s->highest_h;
  RANGE_LOOP
  for (size_t m = 0; m < n; m++) {
    const size_t i = low + m;
    const double change = dt * density_rate[i], now = density[i] + change;
    density[i] = now;
    energy[i] += dt * energy_rate[i];
    const double grown = h[i] * motion_cube_root(-change / now);
    const double size = range_smaller(range_larger(grown, h_low * h0[i]), h_high * h0[i]);
    growth[m] = range_larger(size - h[i], 0);
    h[i] = size;
  }
  b->slack -= sqrt(range_largest(way2, n)) + range_largest(growth, n);
  motion_clamp(s, body, b);
}

RANGE_HOOK void motion_output_fluid(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const double *pressure = s->c.pressure, *density = s->c.density;
  double *term = s->c.pressure_term;
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++)
    term[i] = -pressure[i] / (density[i] * density[i]);
}

/* The acting stress is (1-D) S, and (1-D) P where P < 0. `published`: another D scales the deviator. */
RANGE_INLINE void motion_output(struct sph_system *s, struct sph_block *b, bool damaged, bool published) {
  const double *pressure = s->c.pressure, *density = s->c.density, *d = s->c.damage, *of_shear = s->c.shear_damage;
  double *term = s->c.pressure_term, *factor = s->c.stress_factor;
  RANGE_LOOP
  for (size_t i = b->low; i < b->high; i++) {
    const double inverse = 1 / (density[i] * density[i]);
    const double left = damaged ? range_larger(1 - d[i] * d[i] * d[i], 0) : 1;
    const double share = damaged ? left * inverse : inverse, p = pressure[i];
    term[i] = -p * (p < 0 ? share : inverse);
    factor[i] = published ? range_larger(1 - of_shear[i] * of_shear[i] * of_shear[i], 0) * inverse : share;
  }
}

RANGE_HOOK void motion_output_whole(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  motion_output(s, b, false, false);
}
RANGE_HOOK void motion_output_damaged(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  if (sph_solid_has(body, SPH_COLUMN(shear_damage)))
    motion_output(s, b, true, true);
  else
    motion_output(s, b, true, false);
}

/* Largest rate times dt of damping. Above 1 the velocity would grow from step to step (v' = v - rate dt v*: the roots
 * of the two time levels leave the unit circle). */
static const double MOTION_DAMPING_SHARE = 0.9;

/* Held freedoms keep their velocity. The ledger counts the power of the force that holds them, half with the old and
 * half with the new acceleration, as the step uses them. The power of damping is counted in the same way. */
RANGE_HOOK void motion_hold(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  double *const a[3] = {b->sums->ax, b->sums->ay, b->sums->az};
  const double *const v[3] = {s->c.vx, s->c.vy, s->c.vz};
  double fastest = 0;
  for (size_t i = b->low; s->c.damping && i < b->high; i++) {
    const double rate = s->c.damping[i];
    if (!(rate > 0))
      continue;
    fastest = range_larger(rate, fastest);
    double square = 0;
    for (int k = 0; k < 3; k++) {
      square += v[k][i] * v[k][i];
      a[k][i - b->low] -= rate * v[k][i];
    }
    b->damped += s->c.mass[i] * rate * square;
  }
  b->worst[SPH_LIMIT_COURANT] = fastest / MOTION_DAMPING_SHARE;
  for (size_t i = b->low; s->held && i < b->high; i++) {
    if (!s->held[i])
      continue;
    for (int k = 0; k < 3; k++)
      if (s->held[i] & 1u << k) {
        b->work_of_held -= s->c.mass[i] * a[k][i - b->low] * v[k][i];
        a[k][i - b->low] = 0;
      }
  }
}

/* BA95 eq. 4 without the deviator, and viscous heating. */
RANGE_HOOK void motion_fluid_rates(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const double half = 0.5 * s->dt;
  const struct sph_pair_sums *sums = b->sums;
  const double *xx = sums->gradient[0], *yy = sums->gradient[4], *zz = sums->gradient[8], *heating = sums->heating,
               *power = sums->power;
  const double *density = s->c.density, *term = s->c.pressure_term;
  double *energy = s->c.energy, *rate = s->c.energy_rate;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double now = (power ? power[k] : density[i] * term[i] * (xx[k] + yy[k] + zz[k])) + heating[k];
    energy[i] += half * (now - rate[i]);
    rate[i] = now;
  }
}

enum { MOTION_ENERGY_SHARE_INVERSE = 5, MOTION_DENSITY_SHARE_INVERSE = 10 };

/* Adds half the change of the acceleration to v. */
RANGE_INLINE void motion_correct_velocity(struct sph_system *s, struct sph_block *b) {
  const double half = 0.5 * s->dt;
  const size_t low = b->low, n = b->high - b->low;
  double *const velocity[3] = {s->c.vx, s->c.vy, s->c.vz};
  double *const old[3] = {s->c.ax, s->c.ay, s->c.az};
  const double *const new[3] = {b->sums->ax, b->sums->ay, b->sums->az};
  for (int k = 0; k < 3; k++) {
    double *v = velocity[k], *was = old[k];
    const double *a = new[k];
    RANGE_LOOP
    for (size_t m = 0; m < n; m++) {
      v[low + m] += half * (a[m] - was[low + m]);
      was[low + m] = a[m];
    }
  }
}

/* Finds the first particle that is no longer finite, or beyond 1e30. */
RANGE_INLINE void motion_find_lost(const struct sph_system *s, struct sph_block *b, const double *courant) {
  for (size_t i = b->high; i-- > b->low;) {
    const double all = fabs(s->c.x[i]) + fabs(s->c.y[i]) + fabs(s->c.z[i]) + fabs(s->c.ax[i]) + fabs(s->c.ay[i]) +
                       fabs(s->c.az[i]) + fabs(s->c.density[i]) + fabs(s->c.energy[i]) + courant[i - b->low];
    if (!(all < 1e30))
      b->lost = i;
  }
}

/* Corrects v, rho and h by half the change of rates, clamps, and finds the limits of the next step:
 *   Courant   cfl h / (c_L + 0.6 (alpha c + beta max mu))    Monaghan 1992; c_L^2 = c^2 + 4/3 mu (1-D)/rho
 *             (D scales S); h / (2 |w|), w: velocity in the frame of the centre of mass at the start, so that no
 *             particle jumps into another body; 0.9 over the rate of a damped side (motion_hold)
 *   force     cfl sqrt(h/|a|)
 *   energy    a fifth of (u + c^2/100)/|du/dt|
 *   density   a tenth of 1/|div v|
 *   damage    damage_step over the rate of D^(1/3) */
RANGE_INLINE void motion_correct(struct sph_system *s, const struct sph_solid *body, struct sph_block *b, bool strength,
                                 bool damaged) {
  const double half = 0.5 * s->dt;
  const size_t low = b->low, n = b->high - b->low;
  motion_correct_velocity(s, b);
  const double *xx = b->sums->gradient[0], *yy = b->sums->gradient[4], *zz = b->sums->gradient[8],
               *signal = b->sums->signal;
  const double *c = s->c.sound_speed, *d = range_shear_damage(s, body), *ax = s->c.ax, *ay = s->c.ay, *az = s->c.az;
  const double *energy_rate = s->c.energy_rate, *energy = s->c.energy, *h0 = s->c.h_initial;
  const double *x = s->c.x, *y = s->c.y, *z = s->c.z, *vx = s->c.vx, *vy = s->c.vy, *vz = s->c.vz;
  double *density = s->c.density, *density_rate = s->c.density_rate, *h = s->c.h;
  const double h_low = SPH_LOWEST_H, h_high = s->highest_h;
  const double shear = strength ? 4.0 / 3 * body->physics.material.elastic.shear_modulus : 0;
  const double alpha = 0.6 * s->in.viscosity.alpha, beta = 0.6 * s->in.viscosity.beta, step = 2 * s->in.fidelity.cfl;
  const double drift_x = s->drift[0], drift_y = s->drift[1], drift_z = s->drift[2];
  double courant[SPH_BLOCK], force[SPH_BLOCK], heat[SPH_BLOCK], squeeze[SPH_BLOCK], growth[SPH_BLOCK];
  int64_t lost = 0;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double divergence = xx[k] + yy[k] + zz[k], before = density[i];
    const double rate = -before * divergence, change = half * (rate - density_rate[i]), now = before + change;
    density_rate[i] = rate;
    density[i] = now;
    const double grown = h[i] * motion_cube_root(-change / now);
    const double size = range_smaller(range_larger(grown, h_low * h0[i]), h_high * h0[i]);
    growth[k] = range_larger(size - h[i], 0);
    h[i] = size;
    const double left = damaged ? 1 - d[i] * d[i] * d[i] : 1;
    const double c2 = c[i] * c[i], fast = strength ? sqrt(c2 + shear * left / before) : c[i];
    const double inverse = 1 / size;
    /* Debris without neighbours (signal < 0) sends no waves; hot, it would halve the step of all particles. But it must
     * not fly past others. A body much faster than sound must not jump into another one, because it interacts with it
     * only in contact: no particle flies farther than h/2 in a step (this binds above about three times the speed of
     * sound). */
    const double wx = vx[i] - drift_x, wy = vy[i] - drift_y, wz = vz[i] - drift_z;
    const double flight = sqrt(wx * wx + wy * wy + wz * wz);
    courant[k] = (signal[k] < 0 ? flight : range_larger(fast + alpha * c[i] + beta * signal[k], step * flight)) *
                 inverse;
    const double pull2 = ax[i] * ax[i] + ay[i] * ay[i] + az[i] * az[i];
    force[k] = pull2 * inverse * inverse;
    heat[k] = fabs(energy_rate[i]) / (energy[i] + 0.01 * c2);
    squeeze[k] = fabs(divergence);
    lost |= -(int64_t) !(pull2 < 1e60) | -(int64_t) !(fabs(x[i]) + fabs(y[i]) + fabs(z[i]) < 1e30) |
            -(int64_t) !(fabs(now) + fabs(energy[i]) + courant[k] < 1e60);
  }
  motion_clamp(s, body, b);
  b->slack -= range_largest(growth, n);
  b->worst[SPH_LIMIT_COURANT] = range_larger(range_largest(courant, n) / s->in.fidelity.cfl,
                                             b->worst[SPH_LIMIT_COURANT]); /* motion_hold's */
  b->worst[SPH_LIMIT_FORCE] = sqrt(sqrt(range_largest(force, n))) / s->in.fidelity.cfl;
  b->worst[SPH_LIMIT_ENERGY] = MOTION_ENERGY_SHARE_INVERSE * range_largest(heat, n);
  b->worst[SPH_LIMIT_DENSITY] = MOTION_DENSITY_SHARE_INVERSE * range_largest(squeeze, n);
  if (damaged && s->c.damage_rate)
    b->worst[SPH_LIMIT_DAMAGE] = range_largest(s->c.damage_rate + low, n) / s->in.fracture.damage_step;
  if (lost)
    motion_find_lost(s, b, courant);
}

RANGE_HOOK void motion_correct_fluid(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  motion_correct(s, body, b, false, false);
}
RANGE_HOOK void motion_correct_whole(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  motion_correct(s, body, b, true, false);
}
RANGE_HOOK void motion_correct_damaged(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  motion_correct(s, body, b, true, true);
}

#endif
