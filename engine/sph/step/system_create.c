/* Builds a moving system from particles at rest on their lattices: bodies with their constants and hooks, columns. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/sph/material/derived.h"
#include "engine/sph/material/tillotson.h"
#include "engine/sph/modules/ranges.h"
#include "engine/sph/step/system_list.h"
#include "engine/sph/step/system_step.h"

enum need { ALWAYS, STRENGTH, DAMAGE, FRACTURE, DAMPING, DISTENTION, COMPACTION, TENSION, CORRECTION };

#define COLUMN(name) offsetof(struct sph_columns, name)
static const struct {
  size_t offset;
  enum need need;
} rows[] = {
    {COLUMN(x), ALWAYS},
    {COLUMN(y), ALWAYS},
    {COLUMN(z), ALWAYS},
    {COLUMN(vx), ALWAYS},
    {COLUMN(vy), ALWAYS},
    {COLUMN(vz), ALWAYS},
    {COLUMN(mass), ALWAYS},
    {COLUMN(density), ALWAYS},
    {COLUMN(energy), ALWAYS},
    {COLUMN(h), ALWAYS},
    {COLUMN(h_initial), ALWAYS},
    {COLUMN(ax), ALWAYS},
    {COLUMN(ay), ALWAYS},
    {COLUMN(az), ALWAYS},
    {COLUMN(density_rate), ALWAYS},
    {COLUMN(energy_rate), ALWAYS},
    {COLUMN(pressure), ALWAYS},
    {COLUMN(sound_speed), ALWAYS},
    {COLUMN(pressure_term), ALWAYS},
    {COLUMN(stress[0]), STRENGTH},
    {COLUMN(stress[1]), STRENGTH},
    {COLUMN(stress[2]), STRENGTH},
    {COLUMN(stress[3]), STRENGTH},
    {COLUMN(stress[4]), STRENGTH},
    {COLUMN(stress_rate[0]), STRENGTH},
    {COLUMN(stress_rate[1]), STRENGTH},
    {COLUMN(stress_rate[2]), STRENGTH},
    {COLUMN(stress_rate[3]), STRENGTH},
    {COLUMN(stress_rate[4]), STRENGTH},
    {COLUMN(stress_factor), STRENGTH},
    {COLUMN(damage), DAMAGE},
    {COLUMN(damage_rate), FRACTURE},
    {COLUMN(damage_cap), FRACTURE},
    {COLUMN(weakest), FRACTURE},
    {COLUMN(open_from), FRACTURE},
    {COLUMN(open_below), FRACTURE},
    {COLUMN(open_rate), FRACTURE},
    {COLUMN(crack_rate), FRACTURE},
    {COLUMN(damping), DAMPING},
    {COLUMN(distention), DISTENTION},
    {COLUMN(rest_distention), DISTENTION},
    {COLUMN(shear_factor), DISTENTION},
    {COLUMN(compaction), COMPACTION},
    {COLUMN(tension), TENSION},
    {COLUMN(correction[0]), CORRECTION},
    {COLUMN(correction[1]), CORRECTION},
    {COLUMN(correction[2]), CORRECTION},
    {COLUMN(correction[3]), CORRECTION},
    {COLUMN(correction[4]), CORRECTION},
    {COLUMN(correction[5]), CORRECTION},
};
_Static_assert(sizeof rows / sizeof *rows == SPH_COLUMNS, "a row per column");

static bool is_there(enum need need, const struct sph_particles *p, const struct sph_system *s) {
  switch (need) {
  case STRENGTH: return s->strength;
  case FRACTURE: return s->fracture;
  case DAMPING: return p->damping != NULL;
  case DAMAGE: return s->damage;
  case DISTENTION: return s->pores;
  case COMPACTION: return s->pores && s->damage;
  case CORRECTION: return s->in.method.gradient_correction;
  case TENSION: return s->pores && s->fracture;
  case ALWAYS: break;
  }
  return true;
}

static double **slot_of(struct sph_system *s, size_t row) {
  return (double **)((char *)&s->c + rows[row].offset);
}

size_t sph_system_create_columns(struct sph_system *s, double **slot[SPH_COLUMNS]) {
  size_t count = 0;
  for (size_t r = 0; r < SPH_COLUMNS; r++)
    if (*slot_of(s, r))
      slot[count++] = slot_of(s, r);
  return count;
}

/* Dozens of columns are read side by side: with pages of 4 kB that is more than the address cache of a core holds. */
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

static status take_columns(struct sph_system *s, const struct sph_particles *p, struct error *error) {
  size_t count = 0;
  for (size_t r = 0; r < SPH_COLUMNS; r++)
    count += is_there(rows[r].need, p, s);
  s->stride = (s->n + 7) / 8 * 8 +
              8; /* an odd number of cache lines would be better still: columns must not share sets */
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
  for (size_t r = 0; r < SPH_COLUMNS; r++)
    if (is_there(rows[r].need, p, s)) {
      *slot_of(s, r) = next;
      next += s->stride;
    }
  return STATUS_OK;
}

static void choose_hooks(struct sph_system *s, struct sph_solid *b, const struct sph_body_physics *physics) {
  const struct sph_ranges *r = s->ranges;
  const bool damage = sph_palpha_harms(physics) || physics->flaws;
  b->before[b->before_count++] = r->motion_predict;
  for (int stage = SPH_PREDICT; stage <= SPH_RATES; stage++) {
    sph_hook *to = stage == SPH_RATES ? b->after : b->before;
    size_t *count = stage == SPH_RATES ? &b->after_count : &b->before_count;
    if (stage == SPH_RATES) {
      if (s->held || s->c.damping)
        to[(*count)++] = r->hold;
      if (!physics->strength)
        to[(*count)++] = r->fluid_rates;
    }
    for (size_t m = 0; m < sph_modules_count(); m++) {
      const struct sph_module *module = sph_modules_at(m);
      if (module->hook[stage] && module->on(physics, &s->in))
        memcpy(&to[(*count)++], (const char *)r + module->hook[stage], sizeof(sph_hook));
    }
  }
  b->before[b->before_count++] = damage ? r->output_damaged : physics->strength ? r->output_whole : r->output_fluid;
  b->after[b->after_count++] = damage ? r->correct_damaged : physics->strength ? r->correct_whole : r->correct_fluid;
}

static status make_body(struct sph_system *s, size_t index, struct error *error) {
  struct sph_solid *b = &s->solid[index];
  const struct sph_body_physics *physics = &b->physics;
  const struct sph_material *m = &physics->material;
  if (physics->porosity) {
    const status done = sph_palpha_prepare(physics->porosity, m, &b->porosity, error);
    if (done != STATUS_OK)
      return done;
    b->physics.porosity = &b->porosity.given;
  }
  b->density = sph_derived_bulk_density(m, physics->porosity);
  b->lowest_density = s->domain.lowest_density * b->density;
  b->young = sph_derived_young_modulus(m);
  b->crack_speed = sph_derived_crack_speed(m);
  choose_hooks(s, b, physics);
  const struct sph_flaws *flaws = physics->flaws;
  if (!flaws)
    return STATUS_OK;
  b->physics.flaws = NULL; /* the caller's; ours are the lists */
  return sph_weibull_make(flaws, s->in.fidelity.flaws == SPH_FLAWS_COMPACT, &b->weibull, error);
}

/* Distention as given (or alpha_0), at the pressure that goes with it. */
static void fill_pores(struct sph_system *s, const struct sph_particles *p, const struct sph_solid *b, size_t i) {
  if (!s->pores)
    return;
  double alpha = 1, rest = 1;
  if (b->physics.porosity) {
    const struct sph_palpha_law *law = &b->porosity;
    alpha = p->distention ? p->distention[i] : law->given.distention;
    const struct sph_pressure solid = sph_tillotson(&law->solid, law->solid_density, alpha * p->density[i],
                                                    p->energy[i]);
    rest = sph_palpha_rest(law, alpha, solid.pressure / alpha);
    if (s->damage && b->physics.strength)
      s->c.compaction[i] = s->c.damage[i] = sph_palpha_damage_cbrt(law, rest);
  }
  s->c.distention[i] = alpha;
  s->c.rest_distention[i] = rest;
  s->c.shear_factor[i] = 1;
}

static void fill(struct sph_system *s, const struct sph_particles *p) {
  double *const to[] = {s->c.x,    s->c.y,       s->c.z,      s->c.vx, s->c.vy,       s->c.vz,
                        s->c.mass, s->c.density, s->c.energy, s->c.h,  s->c.h_initial};
  const double *const from[] = {p->x, p->y, p->z, p->vx, p->vy, p->vz, p->mass, p->density, p->energy, p->h, p->h};
  for (size_t k = 0; k < sizeof to / sizeof *to; k++)
    memcpy(to[k], from[k], s->n * sizeof(double));
  if (s->held)
    memcpy(s->held, p->held, s->n);
  if (s->c.damping)
    memcpy(s->c.damping, p->damping, s->n * sizeof(double));
  for (size_t i = 0; i < s->n; i++) {
    s->id[i] = (uint32_t)i;
    for (int k = 0; s->in.method.gradient_correction && k < 6; k++)
      s->c.correction[k][i] = k == 0 || k == 3 || k == 5;
    const struct sph_solid *b = &s->solid[p->body[i]];
    if (s->strength && b->physics.strength && p->stress[0]) {
      const double third = (p->stress[0][i] + p->stress[3][i] + p->stress[5][i]) / 3;
      for (int k = 0; k < 5; k++)
        s->c.stress[k][i] = p->stress[k][i] - (k == 0 || k == 3 ? third : 0);
    }
    fill_pores(s, p, b, i);
    if (!s->fracture)
      continue;
    s->c.weakest[i] = INFINITY;
    if (!b->weibull)
      continue;
    const double volume = p->mass[i] / p->density[i];
    const double radius = s->in.fracture.crack_radius == SPH_CRACK_RADIUS_SUPPORT ? 2 * p->h[i]
                                                                                  : cbrt(3 * volume / (4 * M_PI));
    const double damage = p->damage_cbrt ? p->damage_cbrt[i] : 0;
    s->c.damage[i] = damage;
    if (s->c.tension)
      s->c.tension[i] = cbrt(fmax(0, pow(damage, 3) - pow(s->c.compaction[i], 3)));
    s->c.crack_rate[i] = b->crack_speed / radius;
    s->c.weakest[i] = b->young * sph_weibull_lowest(b->weibull, i - b->first);
  }
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
      .fidelity = s->in.fidelity,
      .strength = s->strength,
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

static status build(struct sph_system *s, const struct sph_particles *p, const struct sph_body_physics *bodies,
                    struct error *error) {
  for (size_t i = 0; i < p->n; i++) {
    struct sph_solid *b = &s->solid[p->body[i]];
    if (b->last == 0)
      b->first = i;
    b->last = i + 1;
  }
  for (size_t b = 0; b < s->body_count; b++) {
    struct sph_body_physics *physics = &s->solid[b].physics;
    *physics = bodies[b];
    if (physics->porosity && physics->porosity->distention == 1)
      physics->porosity = NULL; /* no pores: the solid itself */
    s->strength |= physics->strength;
    s->fracture |= physics->flaws != NULL;
    s->pores |= physics->porosity != NULL;
    s->damage |= physics->flaws != NULL || sph_palpha_harms(physics);
  }
  status done = take_columns(s, p, error);
  for (size_t b = 0; b < s->body_count && done == STATUS_OK; b++)
    done = make_body(s, b, error);
  if (done == STATUS_OK)
    done = make_blocks(s, error);
  if (done == STATUS_OK)
    done = make_pairs(s, error);
  if (done != STATUS_OK)
    return done;
  bound_h(s, p);
  fill(s, p);
  if (!sph_system_step_begin(s))
    return status_fail(error, s->fault == SPH_FAULT_MEMORY ? STATUS_MEMORY : STATUS_CONTENT, "at the start: %s",
                       s->failure);
  return STATUS_OK;
}

status sph_system_create(const struct sph_particles *particles, size_t body_count,
                         const struct sph_body_physics *bodies, const struct sph_inputs *inputs,
                         const struct sph_domain *domain, struct sph_system **out, struct error *error) {
  *out = NULL;
  status done = sph_system_check(particles, body_count, bodies, inputs, domain, error);
  if (done != STATUS_OK)
    return done;
  struct sph_system *s = calloc(1, sizeof *s);
  if (!s)
    return status_fail(error, STATUS_MEMORY, "no memory for a system");
  s->in = *inputs;
  s->domain = *domain;
  s->n = particles->n;
  s->body_count = body_count;
  s->ranges = sph_ranges_choose();
  s->solid = calloc(body_count, sizeof *s->solid);
  done = s->solid ? build(s, particles, bodies, error) : status_fail(error, STATUS_MEMORY, "no memory for a system");
  if (done != STATUS_OK) {
    sph_system_free(s);
    return done;
  }
  *out = s;
  return STATUS_OK;
}
