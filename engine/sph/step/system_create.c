/* Builds a moving system from particles at rest on their lattices: bodies with their modules and hooks, columns,
 * blocks. Bodies and inputs that a system cannot compute are refused first, with a message that names the body, the
 * particle or the input. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/modules/ranges.h"

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

/* Does the row describe a member of one of the sections that a system reads? */
static bool is_read(const struct field *row) {
  const struct {
    size_t offset, size;
  } section[] = {
#define SECTION(member_) {offsetof(struct sph_inputs, member_), sizeof(((struct sph_inputs *)0)->member_)}
      SECTION(viscosity), SECTION(method), SECTION(fracture), SECTION(fidelity)};
  for (size_t k = 0; k < sizeof section / sizeof *section; k++)
    if (row->offset >= section[k].offset && row->offset - section[k].offset < section[k].size)
      return true;
  return false;
}

/* Inputs lie within the ranges of their rows. Derived inputs may still be missing; the system reads none of them. */
static status check_inputs(const struct sph_inputs *inputs, struct error *error) {
  for (size_t k = 0; k < sph_inputs.count; k++) {
    const struct field *row = &sph_inputs.rows[k];
    struct field_value value, unused;
    if (!is_read(row) || row->flags & FIELD_DERIVED)
      continue;
    field_get(row, inputs, &value);
    const status code = field_set_value(row, &value, &unused, error);
    if (code)
      return code;
  }
  return STATUS_OK;
}

static status check_domain(const struct sph_domain *domain, struct error *error) {
  for (int k = 0; k < 3; k++)
    if (domain->periodic[k] <= 0 || isinf(domain->periodic[k]))
      return status_fail(error, STATUS_CONTENT, "the periodic box is %g m long along %c; give a positive length",
                         domain->periodic[k], "xyz"[k]);
  if (!(domain->spacing_over_h > 0) || isinf(domain->spacing_over_h))
    return status_fail(error, STATUS_CONTENT, "the spacing over h is %g; it must be above 0", domain->spacing_over_h);
  if (domain->largest_time_step <= 0) /* NaN: off */
    return status_fail(error, STATUS_CONTENT, "the largest time step is %g s; it must be above 0",
                       domain->largest_time_step);
  if (!(domain->lowest_density > 0 && domain->lowest_density <= 1))
    return status_fail(error, STATUS_CONTENT, "the lowest density is %g of the first; it must be above 0, at most 1",
                       domain->lowest_density);
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

/* Refused before anything is allocated. */
static status check_memory(const struct sph_particles *p, size_t body_count, const struct sph_body_physics *bodies,
                           const struct sph_inputs *inputs, struct error *error) {
  struct sph_column_set columns = sph_system_columns_of_all(p->damping != NULL);
  size_t pairs = 0;
  for (size_t b = 0; b < body_count; b++) {
    const struct sph_module_set modules = sph_modules_of(&bodies[b], inputs);
    const struct sph_column_set own = sph_modules_columns(&modules, &bodies[b]);
    set_unite(columns.word, own.word, SPH_COLUMNS);
    pairs = sph_modules_bytes_in_pairs(&modules); /* options of the pair loop: the same for all bodies */
  }
  const double bytes = (double)p->n * sph_system_columns_bytes(&columns, pairs, &inputs->fidelity);
  const double there = (double)sph_particles_memory();
  if (bytes > there)
    return status_fail(error, STATUS_MEMORY,
                       "%zu particles need about %.3g GB; this machine, or the limit set, has %.3g GB", p->n,
                       bytes / 1e9, there / 1e9);
  return STATUS_OK;
}

/* Everything that is refused: STATUS_CONTENT, or STATUS_MEMORY before anything is allocated. */
static status check_all(const struct sph_particles *particles, size_t body_count, const struct sph_body_physics *bodies,
                        const struct sph_inputs *inputs, const struct sph_domain *domain, struct error *error) {
  status code = check_inputs(inputs, error);
  if (code)
    return code;
  code = check_domain(domain, error);
  if (code)
    return code;
  code = check_particles(particles, body_count, error);
  if (code)
    return code;

  size_t first = 0;
  for (size_t b = 0; b < body_count; b++) {
    size_t last = first;
    while (last < particles->n && particles->body[last] == b)
      last++;
    code = check_body(b, &bodies[b], particles, first, last, inputs, error);
    if (code)
      return code;
    first = last;
  }
  return check_memory(particles, body_count, bodies, inputs, error);
}

/* ---- bodies ---- */

static void add(sph_hook *hooks, size_t *count, sph_hook hook) {
  hooks[(*count)++] = hook;
}

static void add_stage(const struct sph_system *s, const struct sph_solid *b, int stage, sph_hook *hooks,
                      size_t *count) {
  FOR_MODULES(m, b->modules) {
    const sph_hook *of_module = s->ranges->module[m];
    if (of_module && of_module[stage])
      add(hooks, count, of_module[stage]);
  }
}

static bool has_yield_law(const struct sph_solid *b) {
  FOR_MODULES(m, b->modules)
    if (sph_modules_at(m)->sets == SPH_SETS_YIELD_LIMIT)
      return true;
  return false;
}

/* Hooks before the sum over pairs. */
static void choose_before(const struct sph_system *s, struct sph_solid *b, bool strength, bool damage) {
  const bool yields = has_yield_law(b);
  add(b->before, &b->before_count, s->ranges->predict);
  for (int stage = SPH_PREDICT; stage < SPH_RATES; stage++) {
    const bool of_yielding = stage >= SPH_YIELD && stage <= SPH_RETURN;
    if (stage == SPH_CRACK)
      b->first_count = b->before_count;
    if (yields || !of_yielding)
      add_stage(s, b, stage, b->before, &b->before_count);
  }
  const sph_hook output = strength ? s->ranges->output_whole : s->ranges->output_fluid;
  add(b->before, &b->before_count, damage ? s->ranges->output_damaged : output);
}

/* Hooks after it. */
static void choose_after(const struct sph_system *s, struct sph_solid *b, bool strength, bool damage) {
  if (s->held || s->c.damping)
    add(b->after, &b->after_count, s->ranges->hold);
  if (!strength)
    add(b->after, &b->after_count, s->ranges->fluid_rates);
  add_stage(s, b, SPH_RATES, b->after, &b->after_count);
  const sph_hook correct = strength ? s->ranges->correct_whole : s->ranges->correct_fluid;
  add(b->after, &b->after_count, damage ? s->ranges->correct_damaged : correct);
}

static void choose_hooks(const struct sph_system *s, struct sph_solid *b) {
  const bool strength = sph_solid_has(b, SPH_COLUMN(stress)), damage = sph_solid_has(b, SPH_COLUMN(damage));
  choose_before(s, b, strength, damage);
  FOR_MODULES(m, b->modules)
    if (sph_modules_at(m)->meet)
      b->meet = sph_modules_at(m)->meet;
  choose_after(s, b, strength, damage);
}

static status make_body(struct sph_system *s, const struct sph_particles *p, struct sph_solid *b, struct error *error) {
  FOR_MODULES(m, b->modules) {
    const struct sph_module *module = sph_modules_at(m);
    const status code = module->prepare ? module->prepare(&s->in, p, b, error) : STATUS_OK;
    if (code)
      return code;
  }
  b->density = sph_derived_bulk_density(&b->physics.material);
  b->lowest_density = s->domain.lowest_density * b->density;
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
      .viscosity = s->in.viscosity,
      .method = s->in.method,
      .artificial_stress = s->in.artificial_stress,
      .gradient_correction = s->in.gradient_correction,
      .fidelity = s->in.fidelity,
      .strength = s->c.stress[0] != NULL,
      .spacing_over_h = s->domain.spacing_over_h,
  };
  memcpy(o.periodic, s->domain.periodic, sizeof o.periodic);
  return sph_pairs_create(s->n, &o, &s->pairs, error);
}

/* However far matter expands, h stays within what a thin periodic box allows. */
static void bound_h(struct sph_system *s, const struct sph_particles *p) {
  const double most = sph_system_list_reach(&s->domain);
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

static status build(struct sph_system *s, const struct sph_particles *p, const struct sph_body_physics *bodies,
                    struct error *error) {
  find_bodies(s, p, bodies);
  status code = sph_system_columns_take(s, p, error);
  if (code)
    return code;
  for (size_t b = 0; b < s->body_count; b++) {
    code = make_body(s, p, &s->solid[b], error);
    if (code)
      return code;
  }
  code = make_blocks(s, error);
  if (code)
    return code;
  code = make_pairs(s, error);
  if (code)
    return code;

  bound_h(s, p);
  find_drift(s, p);
  sph_system_columns_fill(s, p);
  if (!sph_system_step_begin(s))
    return status_fail(error, s->fault == SPH_FAULT_MEMORY ? STATUS_MEMORY : STATUS_CONTENT, "at the start: %s",
                       s->failure);
  return STATUS_OK;
}

status sph_system_create(const struct sph_particles *particles, size_t body_count,
                         const struct sph_body_physics *bodies, const struct sph_inputs *inputs,
                         const struct sph_domain *domain, struct sph_system **out, struct error *error) {
  *out = NULL;
  status code = check_all(particles, body_count, bodies, inputs, domain, error);
  if (code)
    return code;
  struct sph_system *s = calloc(1, sizeof *s);
  struct sph_solid *solid = calloc(body_count, sizeof *solid);
  if (!s || !solid) {
    free(s);
    free(solid);
    return status_fail(error, STATUS_MEMORY, "no memory for a system");
  }
  s->in = *inputs;
  s->domain = *domain;
  s->n = particles->n;
  s->body_count = body_count;
  s->ranges = sph_ranges_choose();
  s->solid = solid;
  code = build(s, particles, bodies, error);
  if (code) {
    sph_system_free(s);
    return code;
  }
  *out = s;
  return STATUS_OK;
}
