/* Which modules a body has, and what they need. */
#include "engine/sph/modules/modules.h"

#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/step/system_layout.h"

static const struct sph_module *const list[SPH_MODULES] = {
#define ADDRESS(name) &sph_##name##_module,
    SPH_MODULE_LIST(ADDRESS, ADDRESS)};

const struct sph_module *sph_modules_at(size_t index) {
  return list[index];
}

uint64_t sph_modules_of(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  uint64_t on = 0, taken = 0;
  for (size_t m = SPH_MODULES; m-- > 0;) { /* the last module that sets a quantity is the one that acts */
    const uint64_t quantity = list[m]->sets ? UINT64_C(1) << list[m]->sets : 0;
    if (quantity & taken || !list[m]->on(body, inputs))
      continue;
    taken |= quantity;
    on |= UINT64_C(1) << m;
  }
  return on;
}

uint64_t sph_modules_columns(uint64_t modules, const struct sph_body_physics *body) {
  uint64_t columns = 0;
  FOR_MODULES(m, modules)
    for (const struct sph_column_need *c = list[m]->columns; c && c->count; c++)
      if (!c->needed || c->needed(body))
        columns |= ((UINT64_C(1) << c->count) - 1) << c->first;
  return columns;
}

void sph_modules_set_up(const struct sph_body_physics *body, const struct sph_inputs *inputs,
                        struct sph_particles *particles, size_t first, size_t last) {
  const uint64_t modules = sph_modules_of(body, inputs);
  FOR_MODULES(m, modules)
    if (list[m]->set_up)
      list[m]->set_up(body, particles, first, last);
}

bool sph_modules_damage_scales_shear(const struct sph_body_inputs *body, const struct sph_inputs *inputs) {
  const struct sph_body_physics physics = sph_derived_physics(body, NULL);
  return !(sph_modules_columns(sph_modules_of(&physics, inputs), &physics) >> SPH_COLUMN(shear_damage) & 1);
}

void sph_modules_complete_material(struct sph_material *material, const bool *given) {
  for (size_t m = 0; m < SPH_MODULES; m++)
    if (list[m]->complete_material)
      list[m]->complete_material(material, given);
}

void sph_modules_report(const struct sph_run *run, struct sph_results *results) {
  uint64_t modules = 0;
  for (size_t b = 0; b < run->system->body_count; b++)
    modules |= run->system->solid[b].modules;
  FOR_MODULES(m, modules)
    if (list[m]->report)
      list[m]->report(run, results);
}

size_t sph_modules_bytes_in_pairs(uint64_t modules) {
  size_t bytes = 0;
  FOR_MODULES(m, modules)
    bytes += (size_t)list[m]->bytes_in_pairs;
  return bytes;
}

size_t sph_modules_bytes_linked(uint64_t modules) {
  size_t bytes = 0;
  FOR_MODULES(m, modules)
    bytes += (size_t)list[m]->bytes_linked;
  return bytes;
}
