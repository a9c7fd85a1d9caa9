/* The descriptors of all modules; which modules a body has, and what they need. */
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/sph/body/kd_tree.h"
#include "engine/sph/material/palpha.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/step/system.h"
#include "schemas/memory.h"

#define SPH_MODULE_DESCRIPTORS
#include "engine/sph/modules/declarations.h"

static const struct sph_module *const list[SPH_MODULES] = {
#define MODULE(name) &name##_module,
#include "engine/sph/modules/declarations.h"
};

const struct sph_module *sph_modules_at(size_t index) {
  return list[index];
}

struct sph_module_set sph_modules_of(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  struct sph_module_set on = {0};
  unsigned taken = 0;
  for (size_t m = SPH_MODULES; m-- > 0;) { /* the last module that sets a quantity is the one that acts */
    const unsigned quantity = list[m]->sets ? 1U << list[m]->sets : 0;
    if (quantity & taken || !list[m]->on(body, inputs))
      continue;
    taken |= quantity;
    set_add(on.word, m, 1);
  }
  return on;
}

struct sph_column_set sph_modules_columns(const struct sph_module_set *modules, const struct sph_body_physics *body) {
  struct sph_column_set columns = {0};
  FOR_MODULES(m, *modules)
    for (const struct sph_column_need *c = list[m]->columns; c && c->count; c++)
      if (!c->needed || c->needed(body))
        set_add(columns.word, c->first, c->count);
  return columns;
}

void sph_modules_set_up(const struct sph_body_physics *body, const struct sph_inputs *inputs,
                        struct sph_particles *particles, size_t first, size_t last) {
  const struct sph_module_set modules = sph_modules_of(body, inputs);
  FOR_MODULES(m, modules)
    if (list[m]->set_up)
      list[m]->set_up(body, particles, first, last);
}

bool sph_modules_damage_scales_shear(const struct sph_body_inputs *body, const struct sph_inputs *inputs) {
  const struct sph_body_physics physics = sph_derived_physics(body, NULL);
  const struct sph_module_set modules = sph_modules_of(&physics, inputs);
  const struct sph_column_set columns = sph_modules_columns(&modules, &physics);
  return !set_has(columns.word, SPH_COLUMN(shear_damage));
}

void sph_modules_complete_material(struct sph_material *material, const bool *given) {
  for (size_t m = 0; m < SPH_MODULES; m++)
    if (list[m]->complete_material)
      list[m]->complete_material(material, given);
}
