/* Parameters of a moving solid in a test, beside its bodies: inputs at the defaults of their rows, in open space. */
#pragma once

#include "engine/sph/step/system.h"

struct case_parameters {
  struct sph_inputs in;
  struct sph_domain domain;
};

static inline struct case_parameters case_parameters_default(void) {
  struct case_parameters p = {.domain = SPH_DOMAIN_OPEN};
  field_defaults(&sph_inputs, &p.in);
  return p;
}
