/* What a system must be given: refused with a message that names the body, the particle or the parameter. */
#include <math.h>

#include "engine/sph/step/system_layout.h"

/* Material values that the body's physics needs. */
static status check_body(size_t index, const struct sph_body_physics *b, size_t particles, struct error *error) {
  const struct sph_material *m = &b->material;
  const struct {
    const char *name;
    double value;
    bool needed, may_be_zero;
  } needs[] = {
      {"density", m->density, true, false},
      {"tillotson.A", m->tillotson.A, true, false},
      {"tillotson.B", m->tillotson.B, true, true},
      {"tillotson.a", m->tillotson.a, true, true},
      {"tillotson.b", m->tillotson.b, true, true},
      {"tillotson.alpha", m->tillotson.alpha, true, true},
      {"tillotson.beta", m->tillotson.beta, true, true},
      {"tillotson.E0", m->tillotson.E0, true, false},
      {"tillotson.E_iv", m->tillotson.E_iv, true, false},
      {"tillotson.E_cv", m->tillotson.E_cv, true, false},
      {"shear_modulus", m->shear_modulus, b->strength, true},
  };
  for (size_t k = 0; k < sizeof needs / sizeof *needs; k++) {
    const double v = needs[k].value;
    if (needs[k].needed && !(isfinite(v) && (needs[k].may_be_zero ? v >= 0 : v > 0)))
      return status_fail(error, STATUS_CONTENT, "body %zu: %s is %g; its physics needs a number %s", index,
                         needs[k].name, v, needs[k].may_be_zero ? "not below 0" : "above 0");
  }
  if (b->strength && !(m->yield_stress >= 0)) /* infinite: never yields */
    return status_fail(error, STATUS_CONTENT, "body %zu: yield_stress is %g; a body with strength needs one", index,
                       m->yield_stress);
  if (b->flaws && !(b->strength && m->shear_modulus > 0))
    return status_fail(error, STATUS_CONTENT, "body %zu has flaws but no strength: only a solid cracks", index);
  if (b->flaws && b->flaws->particles != particles)
    return status_fail(error, STATUS_CONTENT, "body %zu has %zu particles, but flaws for %zu", index, particles,
                       b->flaws->particles);
  return STATUS_OK;
}

static status check_parameters(const struct sph_parameters *p, struct error *error) {
  const struct {
    const char *name;
    double value, low, high;
  } range[] = {
      {"viscosity_alpha", p->viscosity_alpha, 0, 1e3},
      {"viscosity_beta", p->viscosity_beta, 0, 1e3},
      {"artificial_stress", p->artificial_stress, 0, 10},
      {"spacing_over_h", p->spacing_over_h, 0.1, 2},
      {"cfl", p->cfl, 1e-6, 1},
      {"damage_step", p->damage_step, 1e-9, INFINITY},
      {"distention_step", p->distention_step, 1e-9, INFINITY},
      {"h_lowest", p->h_lowest, 1e-3, 1},
      {"h_highest", p->h_highest, 1, 1e3},
      {"density_lowest", p->density_lowest, 1e-12, 1},
      {"skin", p->skin, 0, 1},
  };
  for (size_t k = 0; k < sizeof range / sizeof *range; k++)
    if (!(range[k].value >= range[k].low && range[k].value <= range[k].high))
      return status_fail(error, STATUS_CONTENT, "%s is %g; it must lie between %g and %g", range[k].name,
                         range[k].value, range[k].low, range[k].high);
  if (p->largest_time_step <= 0) /* NaN: off */
    return status_fail(error, STATUS_CONTENT, "largest_time_step is %g s; it must be above 0", p->largest_time_step);
  for (int k = 0; k < 3; k++)
    if (p->periodic[k] <= 0 || isinf(p->periodic[k]))
      return status_fail(error, STATUS_CONTENT, "the periodic box is %g m long along %c", p->periodic[k], "xyz"[k]);
  if (p->threads < 1 || p->threads > 4096)
    return status_fail(error, STATUS_CONTENT, "threads is %d; it must lie between 1 and 4096", p->threads);
  if (p->growth < SPH_GROWTH_CUBE_ROOT || p->growth > SPH_GROWTH_LINEAR || p->cap < SPH_CAP_BA95 ||
      p->cap > SPH_CAP_NONE)
    return status_fail(error, STATUS_CONTENT, "there is no growth law %d with cap %d", p->growth, p->cap);
  return STATUS_OK;
}

static status check_particles(const struct sph_particles *p, size_t body_count, const struct sph_body_physics *bodies,
                              struct error *error) {
  if (p->n == 0 || p->n >= UINT32_MAX)
    return status_fail(error, STATUS_CONTENT, "there are %zu particles", p->n);
  for (size_t i = 0; i < p->n; i++) {
    const double motion = fabs(p->x[i]) + fabs(p->y[i]) + fabs(p->z[i]) + fabs(p->vx[i]) + fabs(p->vy[i]) +
                          fabs(p->vz[i]);
    if (!(motion < 1e30) || !(p->mass[i] > 0 && p->density[i] > 0 && p->h[i] > 0 && p->energy[i] >= 0) ||
        !(p->mass[i] + p->density[i] + p->h[i] + p->energy[i] < 1e60))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu is no matter: mass %g, density %g, h %g, energy %g, at %g %g %g m", i,
                         p->mass[i], p->density[i], p->h[i], p->energy[i], p->x[i], p->y[i], p->z[i]);
    if (p->body[i] >= body_count || (i > 0 && p->body[i] < p->body[i - 1]))
      return status_fail(error, STATUS_CONTENT, "particle %zu belongs to body %u of %zu, or out of order", i,
                         (unsigned)p->body[i], body_count);
    const struct sph_palpha *pores = bodies[p->body[i]].porosity;
    if (pores && p->distention && !(p->distention[i] >= 1 && p->distention[i] <= pores->distention))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu has distention %g; it must lie between 1 and its body's %g", i, p->distention[i],
                         pores->distention);
  }
  return STATUS_OK;
}

/* Refused before anything is allocated: what the columns, lists and flaws of n particles take is about this. */
static status check_memory(const struct sph_particles *p, struct error *error) {
  const double bytes = (double)p->n * (SPH_COLUMNS * sizeof(double) + 60.0 * sizeof(uint32_t) + 400);
  const double there = (double)sph_particles_memory();
  if (bytes > there)
    return status_fail(error, STATUS_MEMORY,
                       "%zu particles need about %.3g GB; this machine, or the limit set, has %.3g GB", p->n,
                       bytes / 1e9, there / 1e9);
  return STATUS_OK;
}

status sph_system_check(const struct sph_particles *particles, size_t body_count, const struct sph_body_physics *bodies,
                        const struct sph_parameters *parameters, struct error *error) {
  status done = check_parameters(parameters, error);
  if (done == STATUS_OK)
    done = check_particles(particles, body_count, bodies, error);
  size_t low = 0;
  for (size_t b = 0; b < body_count && done == STATUS_OK; b++) {
    size_t high = low;
    while (high < particles->n && particles->body[high] == b)
      high++;
    done = check_body(b, &bodies[b], high - low, error);
    low = high;
  }
  if (done == STATUS_OK)
    done = check_memory(particles, error);
  return done;
}
