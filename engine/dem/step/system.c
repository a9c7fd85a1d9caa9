/* The moving grains: their arrays, set-up, holds, the step, reading and saving their state, the longest time step. */
#include "engine/dem/step/system.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/step/system_layout.h"
#include "engine/grow.h"
#include "schemas/memory.h"

struct array {
  size_t offset; /* of the pointer in struct dem_system */
  size_t size;   /* bytes of an element */
  size_t allocated, saved;
};

#define ONE(type, name, allocated, saved) +1
#define ROW(type, name, allocated, saved) {offsetof(struct dem_system, name), sizeof(type), allocated, saved},

enum { ARRAYS = DEM_ARRAYS(ONE), SAVED = ARRAYS + 2 };

static void list(const struct dem_system *s, struct array out[ARRAYS]) {
  const struct array all[ARRAYS] = {DEM_ARRAYS(ROW)};
  memcpy(out, all, sizeof all);
}

static void **pointer(struct dem_system *s, const struct array *array) {
  return (void **)((char *)s + array->offset);
}

static void *zeroed(size_t count, size_t size) {
  const size_t bytes = ((count ? count : 1) * size + 63) / 64 * 64;
  void *block = aligned_alloc(64, bytes);
  if (block)
    memset(block, 0, bytes);
  return block;
}

/* Gives each column its part of the arena. */
static void place_columns(struct dem_system *s) {
  double *next = s->arena;
#define PLACE(name)                                                                                                    \
  s->c.name = next;                                                                                                    \
  next += s->padded;
  DEM_COLUMNS(PLACE)
#undef PLACE
  if (s->in->fidelity.integrator != DEM_GEAR)
    return;
  for (int k = 0; k < 3; k++)
    for (int order = 2; order < 6; order++) {
      s->c.gear[k][order] = next;
      next += s->padded;
    }
}

bool dem_system_arrays_allocate(struct dem_system *s) {
  const size_t n = s->count;
#define COUNT_COLUMN(name) +1
  const size_t columns = DEM_COLUMNS(COUNT_COLUMN) + (s->in->fidelity.integrator == DEM_GEAR ? 3 * 4 : 0);
#undef COUNT_COLUMN
  s->arena_doubles = columns * s->padded;
  s->bond_capacity = (s->pair_count + DEM_BLOCK - 1) / DEM_BLOCK;
  s->near_capacity = (4 * n + DEM_BLOCK) / DEM_BLOCK * DEM_BLOCK;
  s->cell_capacity = 8 * n + 64;
  for (s->cell_buckets = 64; s->cell_buckets < 2 * n;)
    s->cell_buckets *= 2;

  struct array all[ARRAYS];
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++) {
    void *block = zeroed(all[k].allocated, all[k].size);
    if (!block)
      return false;
    *pointer(s, &all[k]) = block;
  }
  place_columns(s);
  return true;
}

size_t dem_system_arrays_bytes(const struct dem_system *s) {
  struct array all[ARRAYS];
  list(s, all);
  size_t bytes = sizeof *s;
  for (size_t k = 0; k < ARRAYS; k++)
    bytes += all[k].allocated * all[k].size;
  return bytes;
}

bool dem_system_arrays_grow_near(struct dem_system *s, size_t pairs) {
  const size_t before = s->near_capacity / DEM_BLOCK, blocks = (pairs + DEM_BLOCK - 1) / DEM_BLOCK;
  const size_t capacity = blocks * DEM_BLOCK, general = s->bond_capacity * DEM_BLOCK + capacity;
  size_t room = before;
  if (pairs <= s->near_capacity)
    return true;
  if (!grow_aligned(&s->near, &room, blocks, sizeof *s->near, before) ||
      !grow_block(&s->near_pair, capacity * sizeof *s->near_pair) ||
      !grow_block(&s->general, general * sizeof *s->general))
    return false;
  s->near_capacity = capacity;
  return true;
}

/* Lists the memory blocks on which the next step depends, and returns their number. */
static size_t saved_blocks(struct dem_system *s, struct restart_block blocks[SAVED]) {
  struct array all[ARRAYS];
  size_t count = 0;
  blocks[count++] = (struct restart_block){&s->now, sizeof s->now}; /* first: the others' sizes follow from it */
  blocks[count++] = (struct restart_block){&s->held_count, sizeof s->held_count};
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++)
    if (all[k].saved > 0)
      blocks[count++] = (struct restart_block){*pointer(s, &all[k]), all[k].saved * all[k].size};
  return count;
}

void dem_system_arrays_ring(const struct dem_system *s, uint32_t grain, double dx, double dy, struct dem_ring *ring) {
  const uint32_t first = s->first_vertex[grain];
  const double c = s->c.cosine[grain], sn = s->c.sine[grain];
  ring->count = s->first_vertex[grain + 1] - first;
  for (size_t v = 0; v < ring->count; v++) {
    const double x = s->outline_x[first + v], y = s->outline_y[first + v];
    ring->x[v] = c * x - sn * y + dx;
    ring->y[v] = sn * x + c * y + dy;
  }
  for (size_t v = ring->count; v <= dem_overlap_last(ring); v++) {
    ring->x[v] = ring->x[0];
    ring->y[v] = ring->y[0];
  }
}

/* ---- set-up, holds and the step ---- */

/* Computes forces at the present positions with the present lists. Books the dissipated powers over `dt` (s). */
static void evaluate(struct dem_system *s, double dt) {
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
  evaluate(s, 0.0);
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
  if (!code) {
    s->kernels->rest(s);
    if (!make_ready(s))
      code = status_fail(error, STATUS_MEMORY, "not enough memory for %zu grains.", s->count);
  }
  if (code)
    dem_system_free(s);
  else
    *out = s;
  return code;
}

void dem_system_free(struct dem_system *s) {
  if (!s)
    return;
  struct array all[ARRAYS];
  list(s, all);
  for (size_t k = 0; k < ARRAYS; k++)
    free(*pointer(s, &all[k]));
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
    if (!dem_system_start_gear(s))
      return false;
    s->now.gear_started = 1;
  }
  book_holds(s, 0.5 * dt);
  const bool finite = s->in->fidelity.integrator == DEM_GEAR ? s->kernels->gear_predict(s, &moved)
                                                             : s->kernels->verlet_drift(s, &moved);
  s->now.time = (double)++s->now.steps * dt;
  if (!finite || (moved && !dem_neighbours_make(s)))
    return false;
  evaluate(s, dt);
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

const struct dem_progress *dem_system_now(const struct dem_system *s) {
  return &s->now;
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

double dem_system_threshold_energy(const struct dem_system *s) {
  double sum = 0;
  for (size_t k = 0; k < s->pair_count; k++) {
    const int32_t slot = s->pair_lane[k];
    const struct dem_bond_block *block = &s->bond[slot / DEM_BLOCK];
    if (s->alive[k]) /* the weight is 1/(l t_eps)^2 */
      sum += 0.5 * block->axial[slot % DEM_BLOCK] / block->weight_strain[slot % DEM_BLOCK];
  }
  return s->in->threshold.breaking ? sum : (double)NAN;
}

size_t dem_system_breaks(const struct dem_system *s, const struct dem_break **log) {
  *log = s->log;
  return s->now.break_count;
}

size_t dem_system_outline(const struct dem_system *s, uint32_t grain, size_t capacity, struct dem_point *vertices) {
  struct dem_ring ring;
  dem_system_arrays_ring(s, grain, s->c.x[grain], s->c.y[grain], &ring);
  for (size_t v = 0; v < ring.count && v < capacity; v++)
    vertices[v] = (struct dem_point){ring.x[v], ring.y[v]};
  return ring.count;
}

/* ---- higher derivatives for the start of the Gear integrator, which needs five; a scene gives one ---- */

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
    evaluate(s, 0.0);
  }
  return true;
}

bool dem_system_start_gear(struct dem_system *s) {
  const size_t n = s->padded, arrays = 3 * (4 + TRIAL_STEPS + 1);
  size_t size;
  const double dt = s->in->fidelity.time_step;
  OWNED double *memory = malloc(arrays * n * sizeof *memory);
  OWNED void *state = dem_system_state_copy(s, &size);
  struct trial t;
  bool done = memory && state;
  s->no_memory = !done;
  if (!done)
    return false;
  double *next = memory;
  for (int k = 0; k < 3; k++) {
    double **const columns[] = {&t.x0[k],   &t.v0[k],   &t.dx[k],   &t.dv[k],  &t.a[0][k],
                                &t.a[1][k], &t.a[2][k], &t.a[3][k], &t.a[4][k]};
    for (size_t c = 0; c < sizeof columns / sizeof *columns; ++c, next += n)
      *columns[c] = next;
  }
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
  return done;
}

/* ---- the longest time step ---- */

static void add(double *f, uint32_t grain, double x, double y, double torque) {
  f[3 * grain] += x;
  f[3 * grain + 1] += y;
  f[3 * grain + 2] += torque;
}

/* Adds K u of one beam (and its contact) to f: linearised forces at rest, u = (x, y, angle) of every grain. */
static void add_bond(const struct dem_system *s, size_t slot, const double *u, double *f) {
  const struct dem_bond_block *b = &s->bond[slot / DEM_BLOCK];
  const size_t lane = slot % DEM_BLOCK;
  const uint32_t i = b->first[lane], j = b->second[lane];
  const double ex = b->reference_x[lane], ey = b->reference_y[lane], l = b->length[lane];
  const double dx = u[3 * j] - u[3 * i], dy = u[3 * j + 1] - u[3 * i + 1];
  const double stretch = dx * ex + dy * ey, phi = (dy * ex - dx * ey) / l;
  const double t1 = u[3 * i + 2] - phi, t2 = u[3 * j + 2] - phi;
  const double m1 = b->diagonal[lane] * (t1 - t2) + b->cross[lane] * t2;
  const double m2 = b->diagonal[lane] * (t2 - t1) + b->cross[lane] * t1;
  const double tension = b->axial[lane] * stretch, shear = -(m1 + m2) / l;
  const double fx = tension * ex - shear * ey, fy = tension * ey + shear * ex;
  add(f, i, -fx, -fy, m1);
  add(f, j, fx, fy, m2);
  if (!(b->stiffness[lane] > 0.0))
    return;
  const double hx = b->half_x[0][lane], hy = b->half_y[0][lane], side = 2.0 * sqrt(hx * hx + hy * hy);
  const double k = dem_laws_spring(s->in->contact.law, b->stiffness[lane], side);
  const double nx = 2.0 * hy / side, ny = -2.0 * hx / side; /* from i to j */
  const double r1x = b->middle_x[0][lane], r1y = b->middle_y[0][lane], r2x = b->middle_x[1][lane],
               r2y = b->middle_y[1][lane];
  const double gap = (dx - u[3 * j + 2] * r2y + u[3 * i + 2] * r1y) * nx +
                     (dy + u[3 * j + 2] * r2x - u[3 * i + 2] * r1x) * ny;
  const double push = k * gap;
  add(f, i, -push * nx, -push * ny, -push * (r1x * ny - r1y * nx));
  add(f, j, push * nx, push * ny, push * (r2x * ny - r2y * nx));
}

/* Largest h omega. Velocity Verlet is stable below 2. Gear's corrector of this order has no such edge: a mode without
 * damping grows as a high power of h omega. At 0.54 it gains 1 % of its energy in a period, at 0.3 it gains 0.02 %
 * (tests/verification/test_dem_motion.c). */
static const double largest_angle[] = {[DEM_VERLET] = 2.0, [DEM_GEAR] = 0.54};

/* Any start vector that contains all modes. The two grains beyond the last one stay at rest. */
static void start(const struct dem_system *s, double *u) {
  const size_t n = s->count;
  for (size_t k = 0; k < 3 * n; k++)
    u[k] = ((double)(k * 2654435761u >> 7 & 1023u) / 511.5 - 1.0) * (k % 3 == 2 ? 1.0 / s->mean_diameter : 1.0);
  memset(u + 3 * n, 0, 6 * sizeof *u);
}

/* f = K u */
static void apply_stiffness(const struct dem_system *s, const double *u, double *f) {
  memset(f, 0, 3 * (s->count + 2) * sizeof *f);
  for (size_t slot = 0; slot < s->now.bond_blocks * DEM_BLOCK; slot++)
    if (s->lane_pair[slot] != DEM_NO_PAIR)
      add_bond(s, slot, u, f);
}

/* Returns the Rayleigh quotient u.K u / u.M u from f = K u. Then f = M^-1 K u and *largest its largest component. */
static double quotient(const struct dem_system *s, const double *u, double *f, double *largest) {
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  double top = 0.0, bottom = 0.0, most = 0.0;
  for (size_t i = 0; i < s->count; i++)
    for (size_t k = 0; k < 3; k++) {
      const double per_mass = mobility[k][i], v = u[3 * i + k];
      if (!(per_mass > 0.0))
        continue;
      top += v * f[3 * i + k];
      bottom += v * v / per_mass;
      f[3 * i + k] *= per_mass;
      most = fmax(most, fabs(f[3 * i + k]));
    }
  *largest = most;
  return bottom > 0.0 ? top / bottom : 0.0;
}

/* u = f, scaled; held degrees of freedom stay at rest. */
static void take_next(const struct dem_system *s, const double *f, double largest, double *u) {
  const double *const mobility[3] = {s->c.mobility_x, s->c.mobility_y, s->c.mobility_angle};
  for (size_t i = 0; i < s->count; i++)
    for (size_t k = 0; k < 3; k++)
      u[3 * i + k] = mobility[k][i] > 0.0 ? f[3 * i + k] / largest : 0.0;
}

double dem_system_stable_time_step(const struct dem_system *s) {
  const size_t size = 3 * (s->count + 2);
  OWNED double *u = malloc(2 * size * sizeof *u);
  if (!u)
    return NAN;
  double *f = u + size, squared = 0.0;
  start(s, u);
  for (int iteration = 0; iteration < 1000; iteration++) {
    double largest;
    const double before = squared;
    apply_stiffness(s, u, f);
    squared = quotient(s, u, f, &largest);
    const bool settled = iteration > 20 && fabs(squared - before) < 1e-7 * squared;
    if (!(largest > 0.0) || settled)
      break;
    take_next(s, f, largest, u);
  }
  return squared > 0.0 ? largest_angle[s->in->fidelity.integrator] / sqrt(squared) : (double)INFINITY;
}

/* ---- saving the state, for restart files and trial steps ---- */

void *dem_system_state_copy(const struct dem_system *system, size_t *size) {
  struct dem_system view = *system; /* blocks need a writable system; here they are only read */
  struct restart_block blocks[SAVED];
  return restart_blocks_copy(blocks, saved_blocks(&view, blocks), size);
}

bool dem_system_state_load(struct dem_system *s, const void *bytes, size_t size) {
  struct dem_progress saved;
  if (size < sizeof saved)
    return false;
  memcpy(&saved, bytes, sizeof saved);
  if (saved.bond_blocks > s->bond_capacity || saved.break_count > s->pair_count)
    return false;
  if (saved.near_count > size / sizeof *s->near_pair || !dem_system_arrays_grow_near(s, (size_t)saved.near_count))
    return false;

  const struct dem_progress before = s->now;
  s->now = saved;
  struct restart_block blocks[SAVED];
  if (restart_blocks_load(blocks, saved_blocks(s, blocks), bytes, size))
    return true;
  s->now = before;
  return false;
}
