#include "engine/sph/ranges.h"

#include <math.h>

static bool on(const struct sph_body_physics *body, const struct sph_parameters *p) {
  (void)body, (void)p;
  return p->artificial_stress > 0;
}

const struct sph_module sph_artificial_stress_module = {
    .name = "artificial_stress",
    .doc = "Repulsion between particles under tension, against their clumping: for elastic bodies that do not crack.",
    .source = "Monaghan 2000; Gray, Monaghan & Swift 2001",
    .when = "artificial_stress above 0",
    .on = on,
    .bytes = 0,
    .hook = {0},
};
