/* The moving grains: set-up, holds, the step, and reading their state. */
#include "engine/dem/step/system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/beams/breaking.h"
#include "engine/dem/contacts/neighbours.h"
#include "engine/dem/lattice/assemble.h"
#include "engine/dem/step/kernels.h"

void dem_system_evaluate(struct dem_system *s, double dt) {
  memset(s->c.fx, 0, s->padded * sizeof(double));
  memset(s->c.fy, 0, s->padded * sizeof(double));
  memset(s->c.torque, 0, s->padded * sizeof(double));
  memset(&s->sums, 0, sizeof s->sums);
  s->general_count = 0;
  s->kernels->forces(s);
  if (!s->velocities)
    return;
  for (int lane = 0; lane < DEM_BLOCK; lane++) {
    s->now.contact += dt * s->sums.contact[lane];
    s->now.damping += dt * s->sums.damping[lane];
    s->now.friction += dt * s->sums.friction[lane];
  }
}

static bool make_ready(struct dem_system *s) {
  s->kernels->turn(s);
  memcpy(s->c.guess_vx, s->c.vx, s->padded * sizeof(double));
  memcpy(s->c.guess_vy, s->c.vy, s->padded * sizeof(double));
  memcpy(s->c.guess_spin, s->c.spin, s->padded * sizeof(double));
  if (!dem_neighbours_make(s))
    return false;
  dem_system_evaluate(s, 0.0);
  s->now.ready = 1;
  return true;
}

/* Do contact forces need velocities? They do for damping and friction, and for some laws. */
static bool needs_velocities(const struct dem_contact_inputs *contact) {
  const struct dem_law *law = dem_laws_at(contact->law);
  if (!law)
    return false;
  if (law->needs_velocities || contact->normal_damping > 0.0)
    return true;
  return contact->tangential_damping > 0.0 && contact->friction > 0.0;
}

status dem_system_create(const struct dem_tessellation *tessellation, const struct dem_inputs *inputs, uint64_t seed,
                         struct dem_system **out, struct error *error) {
  *out = NULL;
  struct dem_system *s = aligned_alloc(64, (sizeof *s + 63) / 64 * 64);
  if (!s)
    return status_fail(error, STATUS_MEMORY, "not enough memory for a system.");
  memset(s, 0, sizeof *s);
  s->in = inputs;
  s->kernels = dem_kernels_choose();
  s->velocities = needs_velocities(&inputs->contact);

  status code = dem_assemble(s, tessellation, seed, error);
  if (code)
    goto cleanup;
  s->kernels->rest(s);
  if (!make_ready(s)) {
    code = status_fail(error, STATUS_MEMORY, "not enough memory for %zu grains.", s->count);
    goto cleanup;
  }
  *out = s;
  s = NULL;
cleanup:
  dem_system_free(s);
  return code;
}

void dem_system_free(struct dem_system *s) {
  if (!s)
    return;
  dem_system_arrays_free(s);
  free(s);
}

void dem_system_set_velocity(struct dem_system *s, uint32_t grain, double vx, double vy, double spin) {
  s->c.vx[grain] = vx;
  s->c.vy[grain] = vy;
  s->c.spin[grain] = spin;
  s->now.ready = 0; /* damping sees the new velocity, and the lists' skins depend on it */
}

void dem_system_remove(struct dem_system *s, uint32_t grain) {
  if (!s->present[grain])
    return;
  s->present[grain] = 0;
  for (uint32_t k = s->first_partner[grain]; k < s->first_partner[grain + 1]; k++) {
    const int32_t pair = (int32_t)s->partner_pair[k];
    dem_breaking_cut(s, pair);
  }
  s->c.vx[grain] = s->c.vy[grain] = s->c.spin[grain] = 0.0;
  s->c.mobility_x[grain] = s->c.mobility_y[grain] = s->c.mobility_angle[grain] = 0.0;
  s->now.ready = 0; /* the next evaluation makes a new list, without the bonds and contacts of this grain */
}

static double kinetic_of(const struct dem_system *s, uint32_t i) {
  return 0.5 * s->mass[i] * (s->c.vx[i] * s->c.vx[i] + s->c.vy[i] * s->c.vy[i]) +
         0.5 * s->inertia[i] * s->c.spin[i] * s->c.spin[i];
}

static void prescribe(struct dem_system *s, uint32_t grain) {
  const double before = kinetic_of(s, grain);
  if (s->freedoms[grain] & 1)
    s->c.vx[grain] = s->held_vx[grain];
  if (s->freedoms[grain] & 2)
    s->c.vy[grain] = s->held_vy[grain];
  if (s->freedoms[grain] & 4)
    s->c.spin[grain] = s->held_spin[grain];
  s->now.external_work += kinetic_of(s, grain) - before; /* a sudden change of velocity is work, too */
}

void dem_system_hold(struct dem_system *s, uint32_t grain, unsigned freedoms) {
  if (!s->freedoms[grain] && freedoms)
    s->held[s->held_count++] = grain;
  s->freedoms[grain] |= (unsigned char)(freedoms & 7u);
  double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  for (int k = 0; k < 3; k++)
    if (freedoms & 1u << k) {
      mobility[k][grain] = 0.0;
      for (int order = 2; order < 6 && s->c.gear[k][2]; order++)
        s->c.gear[k][order][grain] = 0.0;
    }
  prescribe(s, grain);
}

void dem_system_drive(struct dem_system *s, uint32_t grain, double vx, double vy, double spin) {
  s->held_vx[grain] = vx;
  s->held_vy[grain] = vy;
  s->held_spin[grain] = spin;
  prescribe(s, grain);
}

/* Books the work of the holds over `dt`: the reaction that keeps a held freedom at its velocity balances the force. */
static void book_holds(struct dem_system *s, double dt) {
  for (size_t k = 0; k < s->held_count; k++) {
    const uint32_t i = s->held[k];
    if (!s->present[i])
      continue;
    const unsigned f = s->freedoms[i];
    const double x = f & 1 ? s->c.fx[i] * s->c.vx[i] : 0.0;
    const double y = f & 2 ? s->c.fy[i] * s->c.vy[i] : 0.0;
    const double turn = f & 4 ? s->c.torque[i] * s->c.spin[i] : 0.0;
    s->now.external_work -= dt * (x + y + turn);
  }
}

bool dem_system_step(struct dem_system *s) {
  const double dt = s->in->fidelity.time_step;
  bool moved = false;
  if (!s->now.ready && !make_ready(s))
    return false;
  if (s->in->fidelity.integrator == DEM_GEAR && !s->now.gear_started) {
    if (!dem_gear_start(s))
      return false;
    s->now.gear_started = 1;
  }
  book_holds(s, 0.5 * dt);
  const bool finite = s->in->fidelity.integrator == DEM_GEAR ? s->kernels->gear_predict(s, &moved)
                                                             : s->kernels->verlet_drift(s, &moved);
  s->now.time = (double)++s->now.steps * dt;
  if (!finite || (moved && !dem_neighbours_make(s)))
    return false;
  dem_system_evaluate(s, dt);
  if (s->in->fidelity.integrator == DEM_GEAR)
    s->kernels->gear_correct(s);
  else
    s->kernels->verlet_kick(s);
  book_holds(s, 0.5 * dt);
  return true;
}

bool dem_system_lacks_memory(const struct dem_system *s) {
  return s->no_memory;
}

double dem_system_time(const struct dem_system *s) {
  return s->now.time;
}
uint64_t dem_system_steps(const struct dem_system *s) {
  return s->now.steps;
}

static void measure(struct dem_system *s) {
  memset(&s->sums, 0, sizeof s->sums);
  s->general_count = 0;
  s->kernels->measure(s);
}

struct dem_ledger dem_system_ledger(struct dem_system *s) {
  struct dem_ledger ledger = {.contact = s->now.contact,
                              .damping = s->now.damping,
                              .friction = s->now.friction,
                              .broken_beam = s->now.broken_beam,
                              .begun = s->now.begun,
                              .external_work = s->now.external_work};
  const struct dem_law *law = dem_laws_at(s->in->contact.law);
  const bool stores_energy = law && law->stores_energy;
  if (stores_energy)
    ledger.contact = 0.0;
  measure(s);
  for (int lane = 0; lane < DEM_BLOCK; lane++) {
    ledger.beam += s->sums.beam[lane];
    if (stores_energy)
      ledger.contact += s->sums.contact[lane];
  }
  for (uint32_t i = 0; i < s->count; i++)
    if (s->present[i])
      ledger.kinetic += kinetic_of(s, i);
  return ledger;
}

double dem_system_overlap_share(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF || s->pair_count == 0)
    return 0.0;
  measure(s);
  return (double)s->sums.overlaps / (double)s->pair_count;
}

struct dem_grain dem_system_grain(const struct dem_system *s, uint32_t i) {
  return (struct dem_grain){.x = s->c.x[i],
                            .y = s->c.y[i],
                            .angle = s->c.angle[i],
                            .vx = s->c.vx[i],
                            .vy = s->c.vy[i],
                            .spin = s->c.spin[i],
                            .mass = s->mass[i],
                            .moment_of_inertia = s->inertia[i],
                            .present = s->present[i] != 0};
}

void dem_system_force(const struct dem_system *s, uint32_t grain, double *fx, double *fy, double *torque) {
  *fx = s->c.fx[grain];
  *fy = s->c.fy[grain];
  *torque = s->c.torque[grain];
}

bool dem_system_beam_alive(const struct dem_system *s, size_t beam) {
  return s->alive[beam] != 0;
}

double dem_system_beam_strain(const struct dem_system *s, size_t beam) {
  const int32_t slot = s->pair_lane[beam];
  if (!s->alive[beam] || slot == DEM_NO_PAIR)
    return NAN;
  const uint32_t i = s->pair[beam][0], j = s->pair[beam][1];
  const double dx = s->c.x[j] - s->c.x[i], dy = s->c.y[j] - s->c.y[i];
  return sqrt(dx * dx + dy * dy) / s->bond[slot / DEM_BLOCK].length[slot % DEM_BLOCK] - 1.0;
}

size_t dem_system_breaks(const struct dem_system *s, const struct dem_break **log) {
  *log = s->log;
  return s->now.break_count;
}

double dem_system_last_break(const struct dem_system *s) {
  return s->now.last_break;
}

double dem_system_fastest_approach(const struct dem_system *s) {
  return s->now.fastest_approach;
}

size_t dem_system_outline(const struct dem_system *s, uint32_t grain, size_t capacity, struct dem_point *vertices) {
  struct dem_ring ring;
  dem_system_arrays_ring(s, grain, s->c.x[grain], s->c.y[grain], &ring);
  for (size_t v = 0; v < ring.count && v < capacity; v++)
    vertices[v] = (struct dem_point){ring.x[v], ring.y[v]};
  return ring.count;
}
