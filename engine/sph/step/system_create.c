/* Builds a moving system from particles at rest on their lattices: bodies with their modules and hooks, columns,
 * blocks. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/modules/ranges.h"

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
  status code = sph_system_check(particles, body_count, bodies, inputs, domain, error);
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
