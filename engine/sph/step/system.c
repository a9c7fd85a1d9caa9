/* A moving system: its memory, its state between steps, and saving and loading that state. */
#include "engine/sph/step/system.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/cpu_class.h"
#include "engine/restart.h"
#include "engine/threads.h"
#include "schemas/memory.h"

/* The columns of a system: which exist, their memory, and copying particles into them and back. The arrays of the
 * state, of a restart file and of the estimate of memory are all made from the set sph_system.columns. */

/* Columns that particles are set up with or read back into. */
static const struct {
  size_t column, member; /* SPH_COLUMN, and the place in struct sph_particles */
  bool filled, read;
  double absent; /* value read when no body has the column; NaN: nothing is written */
} carried[] = {
#define CARRIED(name, member_, filled_, read_, absent_)                                                                \
  { SPH_COLUMN(name), offsetof(struct sph_particles, member_), filled_, read_, absent_ }
    CARRIED(x, x, true, true, NAN), /* the positions first: they are wrapped */
    CARRIED(y, y, true, true, NAN),
    CARRIED(z, z, true, true, NAN),
    CARRIED(vx, vx, true, true, NAN),
    CARRIED(vy, vy, true, true, NAN),
    CARRIED(vz, vz, true, true, NAN),
    CARRIED(mass, mass, true, true, NAN),
    CARRIED(density, density, true, true, NAN),
    CARRIED(energy, energy, true, true, NAN),
    CARRIED(h, h, true, true, NAN),
    CARRIED(h_initial, h, true, false, NAN),
    CARRIED(pressure, pressure, false, true, NAN),
    CARRIED(damping, damping, true, true, NAN),
    CARRIED(damage, damage_cbrt, false, true, NAN),
#define PARTICLE_COLUMN(FLAG, member, absent, ...) CARRIED(member, member, false, true, absent),
#include "engine/sph/modules/declarations.h"
};

static double **slot_of(struct sph_columns *columns, size_t column) {
  return (double **)(void *)columns + column;
}

static double *member_of(const struct sph_particles *p, size_t member) {
  double *array;
  memcpy(&array, (const char *)p + member, sizeof array);
  return array;
}

struct sph_column_set sph_system_columns_of_all(bool damped) {
  struct sph_column_set columns = {0};
  set_add(columns.word, SPH_COLUMN(x), SPH_COLUMN(pressure_term) + 1 - SPH_COLUMN(x));
  if (damped)
    set_add(columns.word, SPH_COLUMN(damping), 1);
  return columns;
}

int sph_system_columns_arrays(const struct sph_column_set *columns) {
  int arrays = 0;
  if (set_has(columns->word, SPH_COLUMN(stress)))
    arrays |= SPH_WITH_STRESS;
  if (set_has(columns->word, SPH_COLUMN(damage)))
    arrays |= SPH_WITH_DAMAGE;
#define PARTICLE_ARRAYS(FLAG, column) arrays |= set_has(columns->word, SPH_COLUMN(column)) ? SPH_WITH_##FLAG : 0;
#include "engine/sph/modules/declarations.h"
  return arrays;
}

size_t sph_system_columns_list(const struct sph_system *s, double *column[SPH_COLUMNS]) {
  struct sph_columns columns = s->c;
  size_t count = 0;
  FOR_SET(k, s->columns.word, SPH_COLUMNS)
  column[count++] = *slot_of(&columns, k);
  return count;
}

/* Dozens of columns are read side by side: pages of 4 kB would overflow the address cache (TLB) of a core. */
static double *huge_pages(size_t bytes) {
  const size_t page = (size_t)1 << 21;
  if (bytes < 2 * page)
    return aligned_alloc(64, (bytes + 63) / 64 * 64);
  double *memory = aligned_alloc(page, (bytes + page - 1) / page * page);
#ifdef MADV_HUGEPAGE
  if (memory)
    madvise(memory, (bytes + page - 1) / page * page, MADV_HUGEPAGE); /* a hint: it may fail */
#endif
  return memory;
}

static bool has(const struct sph_system *s, size_t column) {
  return set_has(s->columns.word, column);
}

static void set_initial(struct sph_system *s, size_t module) {
  for (const struct sph_column_need *need = sph_modules_at(module)->columns; need && need->count; need++)
    for (size_t k = need->first; need->initial != 0 && k < need->first + need->count; k++)
      for (size_t i = 0; has(s, k) && i < s->n; i++)
        (*slot_of(&s->c, k))[i] = need->initial;
}

static status take_columns(struct sph_system *s, const struct sph_particles *p, struct error *error) {
  const size_t count = set_size(s->columns.word, SPH_COLUMNS);
  s->stride = (s->n + 7) / 8 * 8 + 8; /* columns must not share sets of the cache */
  s->arena_doubles = count * s->stride;
  s->arena = huge_pages(s->arena_doubles * sizeof(double));
  s->id = malloc(s->n * sizeof *s->id);
  s->order = malloc(s->n * sizeof *s->order);
  if (p->held)
    s->held = malloc(s->n * sizeof *s->held);
  if (!s->arena || !s->id || !s->order || (p->held && !s->held))
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles of %zu columns (%.3g GB)", s->n, count,
                       (double)(s->arena_doubles * sizeof(double)) / 1e9);
  memset(s->arena, 0, s->arena_doubles * sizeof(double));
  double *next = s->arena;
  FOR_SET(k, s->columns.word, SPH_COLUMNS) {
    *slot_of(&s->c, k) = next;
    next += s->stride;
  }
  for (size_t m = 0; m < SPH_MODULES; m++)
    set_initial(s, m);
  return STATUS_OK;
}

static void fill_columns(struct sph_system *s, const struct sph_particles *p) {
  for (size_t k = 0; k < sizeof carried / sizeof *carried; k++)
    if (carried[k].filled && has(s, carried[k].column))
      memcpy(*slot_of(&s->c, carried[k].column), member_of(p, carried[k].member), s->n * sizeof(double));
  if (s->held)
    memcpy(s->held, p->held, s->n);
  for (size_t i = 0; i < s->n; i++)
    s->id[i] = (uint32_t)i;
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->fill)
        sph_modules_at(m)->fill(s, &s->solid[b], p);
}

double sph_system_columns_bytes(const struct sph_column_set *columns, size_t pairs,
                                const struct sph_fidelity *fidelity) {
  enum { RECORDS = 378, LISTS = 108 }; /* of the pair loop at the usual h, without options; measured */
  const double reach = fidelity->smoothing / SPH_BODIES_H * (1 + fidelity->skin);
  return (double)(set_size(columns->word, SPH_COLUMNS) * sizeof(double) + 2 * sizeof(uint32_t) + pairs + RECORDS) +
         LISTS * reach * reach * reach;
}

double sph_system_columns_wrapped(double x, double length) {
  if (!(length > 0))
    return x;
  x -= length * floor(x / length);
  return x < length ? x : 0;
}

/* The sixth component follows: the deviator has no trace. */
static void read_stress(const struct sph_system *s, double *const out[6]) {
  for (size_t i = 0; i < s->n; i++) {
    for (int k = 0; k < 5; k++)
      out[k][s->id[i]] = s->c.stress[k][i];
    out[5][s->id[i]] = -(s->c.stress[0][i] + s->c.stress[3][i]);
  }
}

void sph_system_read(const struct sph_system *s, struct sph_particles *out) {
  struct sph_columns columns = s->c;
  for (size_t k = 0; k < sizeof carried / sizeof *carried; k++) {
    double *to = member_of(out, carried[k].member);
    if (!carried[k].read || !to)
      continue;
    const double *from = *slot_of(&columns, carried[k].column), absent = carried[k].absent;
    for (size_t i = 0; (from || !isnan(absent)) && i < s->n; i++)
      to[s->id[i]] = from ? from[i] : absent;
    for (size_t i = 0; k < 3 && i < s->n; i++)
      to[i] = sph_system_columns_wrapped(to[i], s->domain.periodic[k]);
  }
  if (out->stress[0] && s->c.stress[0])
    read_stress(s, out->stress);
  for (size_t i = 0; out->held && s->held && i < s->n; i++)
    out->held[s->id[i]] = s->held[i];
  for (size_t b = 0; b < s->body_count; b++)
    memset(out->body + s->solid[b].first, (int)b, s->solid[b].last - s->solid[b].first);
}

/* Builds a moving system from particles at rest on their lattices: bodies with their modules and hooks, columns,
 * blocks. Bodies that a system cannot compute are refused first, with a message that names the body or the particle.
 */

/* ---- checks ---- */

/* The checks of a body's modules; its particles are first .. last - 1. */
static status check_body(size_t index, const struct sph_body_physics *b, const struct sph_particles *particles,
                         size_t first, size_t last, const struct sph_inputs *inputs, struct error *error) {
  for (size_t m = 0; m < SPH_MODULES; m++) {
    const struct sph_module *module = sph_modules_at(m);
    struct error why = {0};
    if (!module->check || !module->on(b, inputs))
      continue;
    const status code = module->check(b, particles, first, last, &why);
    if (code)
      return status_fail(error, code, "body %zu: %.3000s", index, why.message);
  }
  return STATUS_OK;
}

/* Are position and velocity within bounds, mass, density and h positive, and energy not negative? */
static bool is_matter(const struct sph_particles *p, size_t i) {
  const double motion = fabs(p->x[i]) + fabs(p->y[i]) + fabs(p->z[i]) + fabs(p->vx[i]) + fabs(p->vy[i]) +
                        fabs(p->vz[i]);
  const double amount = p->mass[i] + p->density[i] + p->h[i] + p->energy[i];
  const double least = fmin(p->mass[i], fmin(p->density[i], p->h[i]));
  return motion < 1e30 && amount < 1e60 && least > 0 && p->energy[i] >= 0;
}

static status check_particles(const struct sph_particles *p, size_t body_count, struct error *error) {
  if (p->n == 0 || p->n >= UINT32_MAX)
    return status_fail(error, STATUS_CONTENT, "there are %zu particles", p->n);
  for (size_t i = 0; i < p->n; i++) {
    if (!is_matter(p, i))
      return status_fail(error, STATUS_CONTENT,
                         "particle %zu is no matter: mass %g, density %g, h %g, energy %g, at %g %g %g m", i,
                         p->mass[i], p->density[i], p->h[i], p->energy[i], p->x[i], p->y[i], p->z[i]);
    const bool in_order = i == 0 || p->body[i] >= p->body[i - 1];
    if (p->body[i] >= body_count || !in_order)
      return status_fail(error, STATUS_CONTENT, "particle %zu belongs to body %u of %zu, or out of order", i,
                         (unsigned)p->body[i], body_count);
  }
  return STATUS_OK;
}

/* Everything that is refused. */
static status check_all(const struct sph_particles *particles, size_t body_count, const struct sph_body_physics *bodies,
                        const struct sph_inputs *inputs, struct error *error) {
  TRY(check_particles(particles, body_count, error));

  size_t first = 0;
  for (size_t b = 0; b < body_count; b++) {
    size_t last = first;
    while (last < particles->n && particles->body[last] == b)
      last++;
    TRY(check_body(b, &bodies[b], particles, first, last, inputs, error));
    first = last;
  }
  return STATUS_OK;
}

/* ---- bodies ---- */

static void add_stage(const struct sph_system *s, const struct sph_solid *b, int stage, sph_hook *hooks,
                      size_t *count) {
  FOR_MODULES(m, b->modules) {
    const sph_hook *of_module = s->ranges->module[m];
    if (of_module && of_module[stage])
      hooks[(*count)++] = of_module[stage];
  }
}

static void choose_hooks(const struct sph_system *s, struct sph_solid *b) {
  const bool strength = sph_solid_has(b, SPH_COLUMN(stress)), damage = sph_solid_has(b, SPH_COLUMN(damage));
  const struct sph_ranges *r = s->ranges;
  bool yields = false;
  FOR_MODULES(m, b->modules) {
    yields |= sph_modules_at(m)->sets == SPH_SETS_YIELD_LIMIT;
    if (sph_modules_at(m)->meet)
      b->meet = sph_modules_at(m)->meet;
  }
  b->before[b->before_count++] = r->predict;
  for (int stage = SPH_PREDICT; stage < SPH_FORCES; stage++) {
    if (stage == SPH_CRACK)
      b->first_count = b->before_count;
    if (yields || stage < SPH_YIELD || stage > SPH_RETURN)
      add_stage(s, b, stage, b->before, &b->before_count);
  }
  b->before[b->before_count++] = damage ? r->output_damaged : strength ? r->output_whole : r->output_fluid;

  add_stage(s, b, SPH_FORCES, b->after, &b->after_count);
  if (s->held || s->c.damping)
    b->after[b->after_count++] = r->hold;
  if (!strength)
    b->after[b->after_count++] = r->fluid_rates;
  add_stage(s, b, SPH_RATES, b->after, &b->after_count);
  b->after[b->after_count++] = damage ? r->correct_damaged : strength ? r->correct_whole : r->correct_fluid;
}

static status make_body(struct sph_system *s, const struct sph_particles *p, struct sph_solid *b, struct error *error) {
  FOR_MODULES(m, b->modules) {
    const struct sph_module *module = sph_modules_at(m);
    if (module->prepare)
      TRY(module->prepare(&s->in, p, b, error));
  }
  b->density = sph_material_bulk_density(&b->physics.material);
  b->lowest_density = s->domain.lowest_density * b->density;
  b->lowest_energy = s->in.method.negative_energy ? -HUGE_VAL : 0;
  b->physics.flaws = NULL; /* owned by the caller; the modules have their own data from them */
  choose_hooks(s, b);
  return STATUS_OK;
}

static size_t end_of_block(const struct sph_solid *body, size_t low) {
  const size_t end = (low / SPH_BLOCK + 1) * SPH_BLOCK;
  return end < body->last ? end : body->last;
}

static status make_blocks(struct sph_system *s, struct error *error) {
  for (size_t b = 0; b < s->body_count; b++)
    for (size_t low = s->solid[b].first; low < s->solid[b].last; low = end_of_block(&s->solid[b], low))
      s->block_count++;
  s->block = calloc(s->block_count ? s->block_count : 1, sizeof *s->block);
  if (!s->block)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu blocks", s->block_count);
  size_t k = 0;
  for (size_t b = 0; b < s->body_count; b++)
    for (size_t low = s->solid[b].first; low < s->solid[b].last; low = end_of_block(&s->solid[b], low))
      s->block[k++] = (struct sph_block){.low = low, .high = end_of_block(&s->solid[b], low), .body = (uint32_t)b};
  return STATUS_OK;
}

static status make_pairs(struct sph_system *s, struct error *error) {
  struct sph_pair_options o = {
      .method = s->in.method,
      .fidelity = s->in.fidelity,
      .strength = s->c.stress[0] != NULL,
      .turns = s->in.target.spin != 0,
      .spacing_over_h = s->domain.spacing_over_h,
      .body = s->body,
#define MODULE_INPUTS(name) .name = s->in.name,
#include "engine/sph/modules/declarations.h"
  };
  memcpy(o.periodic, s->domain.periodic, sizeof o.periodic);
  return sph_pairs_create(s->n, &o, &s->pairs, error);
}

/* However far matter expands, h stays within what a thin periodic box allows. */
static void bound_h(struct sph_system *s, const struct sph_particles *p) {
  const double most = sph_system_step_reach(&s->domain);
  s->highest_h = SPH_HIGHEST_H;
  for (size_t i = 0; i < p->n; i++)
    s->highest_h = fmax(1, fmin(s->highest_h, most / (p->h[i] * (1 + s->in.fidelity.skin))));
}

/* The frame in which a particle is fast or slow: without it the time step would depend on the observer. */
static void find_drift(struct sph_system *s, const struct sph_particles *p) {
  const double *const v[3] = {p->vx, p->vy, p->vz};
  double mass = 0;
  for (size_t i = 0; i < p->n; i++)
    mass += p->mass[i];
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; i < p->n; i++)
      s->drift[k] += p->mass[i] / mass * v[k][i];
}

static void find_bodies(struct sph_system *s, const struct sph_particles *p, const struct sph_body_physics *bodies) {
  for (size_t i = 0; i < p->n; i++) {
    struct sph_solid *b = &s->solid[p->body[i]];
    if (b->last == 0)
      b->first = i;
    b->last = i + 1;
  }
  s->columns = sph_system_columns_of_all(p->damping != NULL);
  for (size_t b = 0; b < s->body_count; b++) {
    struct sph_solid *solid = &s->solid[b];
    solid->physics = bodies[b];
    solid->modules = sph_modules_of(&bodies[b], &s->in);
    solid->columns = sph_modules_columns(&solid->modules, &bodies[b]);
    set_unite(s->columns.word, solid->columns.word, SPH_COLUMNS);
  }
}

/* Does a module compute what the bodies do to each other? Then it needs to know whose a particle is. */
static status tell_bodies_apart(struct sph_system *s, const struct sph_particles *p, struct error *error) {
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->touch)
        s->meet_others = sph_modules_at(m)->touch;
  if (!s->meet_others)
    return STATUS_OK;
  s->body = malloc(s->n);
  if (!s->body)
    return status_fail(error, STATUS_MEMORY, "no memory for %zu particles", s->n);
  memcpy(s->body, p->body, s->n);
  return STATUS_OK;
}

static status build(struct sph_system *s, const struct sph_particles *p, const struct sph_body_physics *bodies,
                    struct error *error) {
  find_bodies(s, p, bodies);
  TRY(take_columns(s, p, error));
  for (size_t b = 0; b < s->body_count; b++)
    TRY(make_body(s, p, &s->solid[b], error));
  TRY(make_blocks(s, error));
  TRY(tell_bodies_apart(s, p, error));
  TRY(make_pairs(s, error));

  bound_h(s, p);
  find_drift(s, p);
  fill_columns(s, p);
  if (!sph_system_step_begin(s))
    return status_fail(error, s->fault == SPH_FAULT_MEMORY ? STATUS_MEMORY : STATUS_CONTENT, "at the start: %s",
                       s->failure);
  return STATUS_OK;
}

/* The loops of the CPU class that this process runs. */
status sph_system_create(const struct sph_particles *particles, size_t body_count,
                         const struct sph_body_physics *bodies, const struct sph_inputs *inputs,
                         const struct sph_domain *domain, struct sph_system **out, struct error *error) {
  *out = NULL;
  TRY(check_all(particles, body_count, bodies, inputs, error));
  struct sph_solid *solid = calloc(body_count, sizeof *solid);
  if (!solid)
    return status_fail(error, STATUS_MEMORY, "no memory for a system");
  struct sph_system *s = memory_small(1, sizeof *s);
  s->in = *inputs;
  s->in.fidelity.threads = threads_granted(inputs->fidelity.threads);
  s->domain = *domain;
  s->n = particles->n;
  s->body_count = body_count;
  s->ranges = CPU_CLASS_OF(sph_ranges);
  s->solid = solid;
  status code = build(s, particles, bodies, error);
  if (code) {
    sph_system_free(s);
    return code;
  }
  *out = s;
  return STATUS_OK;
}

void sph_system_free(struct sph_system *s) {
  if (!s)
    return;
  for (size_t b = 0; s->solid && b < s->body_count; b++)
    for (size_t m = 0; m < SPH_MODULES; m++)
      if (s->solid[b].prepared[m])
        sph_modules_at(m)->free_prepared(s->solid[b].prepared[m]);
  sph_pairs_free(s->pairs);
  free(s->body);
  free(s->touch);
  free(s->arena);
  free(s->id);
  free(s->held);
  free(s->order);
  free(s->solid);
  free(s->block);
  free(s);
}

static const struct sph_flaws_lists *flaws_of(const struct sph_solid *body) {
  return body->prepared[SPH_MODULE_weibull];
}

bool sph_system_flaws(const struct sph_system *s, uint32_t *count) {
  bool any = false;
  for (size_t b = 0; b < s->body_count; b++)
    any |= flaws_of(&s->solid[b]) != NULL;
  for (size_t b = 0; any && b < s->body_count; b++) {
    const struct sph_solid *body = &s->solid[b];
    for (size_t i = body->first; i < body->last; i++) /* bodies stand in the order of their ids */
      count[i] = flaws_of(body) ? sph_flaws_total(flaws_of(body), i - body->first) : 0;
  }
  return any;
}

double sph_system_damage(const struct sph_system *s, size_t first, size_t last) {
  double volume = 0, damage = 0;
  for (size_t b = first; b < last; b++) {
    const struct sph_solid *body = &s->solid[b];
    if (!flaws_of(body))
      continue;
    for (size_t i = body->first; i < body->last; i++) {
      const double v = s->c.mass[i], d = s->c.damage[i];
      volume += v;
      damage += v * d * d * d;
    }
  }
  return volume > 0 ? damage / volume : 0;
}

/* Sums go block by block and are then added up, so that their rounding grows with the number of blocks, not particles.
 */
static void add_block(const struct sph_system *s, const struct sph_block *b, struct sph_ledger *sum) {
  struct sph_ledger part = {0};
  for (size_t i = b->low; i < b->high; i++) {
    const double m = s->c.mass[i], r[3] = {s->c.x[i], s->c.y[i], s->c.z[i]};
    const double p[3] = {m * s->c.vx[i], m * s->c.vy[i], m * s->c.vz[i]};
    part.kinetic += 0.5 * (p[0] * s->c.vx[i] + p[1] * s->c.vy[i] + p[2] * s->c.vz[i]);
    part.internal += m * s->c.energy[i];
    part.momentum_scale += sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; k++) {
      part.momentum[k] += p[k];
      part.angular_momentum[k] += r[(k + 1) % 3] * p[(k + 2) % 3] - r[(k + 2) % 3] * p[(k + 1) % 3];
    }
  }
  sum->kinetic += part.kinetic;
  sum->internal += part.internal;
  sum->momentum_scale += part.momentum_scale;
  for (int k = 0; k < 3; k++) {
    sum->momentum[k] += part.momentum[k];
    sum->angular_momentum[k] += part.angular_momentum[k];
  }
}

struct sph_ledger sph_system_ledger(const struct sph_system *s) {
  struct sph_ledger sum = {0};
  for (size_t k = 0; k < s->block_count; k++)
    add_block(s, &s->block[k], &sum);
  sum.contact = s->now.contact;
  sum.work_of_held = s->now.work_of_held;
  sum.damped = s->now.damped;
  sum.clamped = s->now.clamped;
  sum.density_held = s->now.density_held;
  return sum;
}

/* ---- saving and loading ----
 *
 * All data on which the next step depends are saved. Lists are not saved: they are made again from the positions at
 * which they were made, in the same order, and the pair loop sums in that order. */

enum { BLOCKS = SPH_COLUMNS + 10 };

static size_t saved(struct sph_system *s, struct restart_block out[BLOCKS]) {
  double *column[SPH_COLUMNS];
  size_t count = 0;
  const size_t columns = sph_system_columns_list(s, column);
  out[count++] = (struct restart_block){&s->n, sizeof s->n};
  out[count++] = (struct restart_block){&s->now, sizeof s->now};
  for (size_t k = 0; k < columns; k++)
    out[count++] = (struct restart_block){column[k], s->n * sizeof(double)};
  for (int k = 0; k < 5; k++)
    out[count++] = (struct restart_block){sph_pairs_listed(s->pairs)[k], s->n * sizeof(double)};
  out[count++] = (struct restart_block){s->id, s->n * sizeof *s->id};
  if (s->held)
    out[count++] = (struct restart_block){s->held, s->n};
  return count;
}

void *sph_system_state_copy(const struct sph_system *system, size_t *size) {
  struct sph_system view = *system; /* blocks need a writable system; here they are only read */
  struct restart_block blocks[BLOCKS];
  return restart_blocks_copy(blocks, saved(&view, blocks), size);
}

bool sph_system_state_load(struct sph_system *s, const void *bytes, size_t size) {
  struct restart_block blocks[BLOCKS];
  const size_t n = s->n;
  if (size < sizeof n || memcmp(&n, bytes, sizeof n) != 0 ||
      !restart_blocks_load(blocks, saved(s, blocks), bytes, size))
    return false;
  for (size_t i = 0; i < n; i++)
    if (s->id[i] >= n) {
      s->fault = SPH_FAULT_NOT_FINITE;
      snprintf(s->failure, sizeof s->failure, "the state read back is no state of this system");
      return false;
    }
  for (size_t b = 0; b < s->body_count; b++)
    FOR_MODULES(m, s->solid[b].modules)
      if (sph_modules_at(m)->restored)
        sph_modules_at(m)->restored(s, &s->solid[b]);
  s->fault = SPH_FAULT_NONE;
  s->failure[0] = '\0';
  return sph_system_step_relist(s);
}
