/* Physics modules of the solid, as descriptors. Off means absent: a body that does not have a module is never called
 * for it, and columns that no body needs are not allocated. The scene decides; nobody flips switches.
 *
 * A hook works on a whole range of particles of one body; it is compiled once per CPU class (ranges.h). A step runs,
 * block by block: every `predict` hook in the order of the list, every `respond` hook in the same order, then the pair
 * loop, then every `rates` hook. */
#ifndef CLAST_ENGINE_SPH_MODULES_MODULES_H
#define CLAST_ENGINE_SPH_MODULES_MODULES_H

#include "engine/sph/step/system.h"

enum sph_stage {              /* when in a step a hook runs */
                 SPH_PREDICT, /* carry the module's own variables to the new time, by the rates of the old one */
                 SPH_RESPOND, /* from the predicted state to what the pair loop needs: pressure, sound speed, damaged
                                 stress */
                 SPH_RATES,   /* after the pair loop: new rates from the velocity gradient, and half the change of rates
                                 added */
                 SPH_STAGES
};

struct sph_module {
  const char *name;   /* "yield" */
  const char *doc;    /* what it models, for a person */
  const char *source; /* paper and equation */
  const char *when;   /* the condition that turns it on, for a person */
  bool (*on)(const struct sph_body_physics *body, const struct sph_inputs *inputs);
  int bytes;               /* it adds per particle, to the moving system */
  size_t hook[SPH_STAGES]; /* offset of its loop in struct sph_ranges (ranges.h); 0 = none */
};

extern const struct sph_module sph_elastic_module, sph_tillotson_module, sph_palpha_module, sph_tension_limit_module,
    sph_yield_module, sph_weibull_module, sph_fracture_module, sph_viscosity_module, sph_artificial_stress_module,
    sph_gradient_correction_module;

/* Do pores that close damage this body? Every body with pores and strength. */
bool sph_palpha_harms(const struct sph_body_physics *body);

/* In the order in which they act; modules.c says why. */
size_t sph_modules_count(void);
const struct sph_module *sph_modules_at(size_t index);

#endif
