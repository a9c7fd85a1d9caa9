/* Refuses bodies and inputs that a system cannot compute, with a message that names the body, the particle or the
 * input. */
#include <math.h>

#include "engine/sph/step/system_layout.h"

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

status sph_system_check(const struct sph_particles *particles, size_t body_count, const struct sph_body_physics *bodies,
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
