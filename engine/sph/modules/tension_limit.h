/* A spall strength for matter without flaws, and torn matter.
 *
 *   material.tension_limit   Pa; off: no limit
 *
 * It reads the density of the solid matter that the equation of state publishes; it bounds the pressure and lowers the
 * yield limit.
 *
 * The bound of tension in bodies without flaws. It falls with the expansion of the solid matter, and the yield limit
 * with it. */

MODULE(tension_limit)
MODULE_HOOKS(tension_limit)
MODULE_MATERIAL(tension_limit)

#ifdef SPH_MODULE_STRUCTS
struct sph_tension_limit_material {
  double pressure; /* Pa; NaN: off */
};
#endif

#ifdef SPH_MODULE_LOOPS

/* 1 at the density at rest, 0 from 0.9 of it down: torn matter neither pulls nor shears. */
RANGE_INLINE double tension_limit_whole(double relative_density) {
  return range_smaller(range_larger(10 * (relative_density - 0.9), 0), 1);
}

/* P >= -tension_limit. */
RANGE_HOOK void tension_limit_pressure(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double lowest = -body->physics.material.tension_limit.pressure,
               per_density = 1 / body->physics.material.density;
  const double *density = b->terms->solid_density;
  double *pressure = s->c.pressure;
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    pressure[low + k] = range_larger(pressure[low + k], lowest * tension_limit_whole(density[k] * per_density));
}

RANGE_HOOK void tension_limit_yield(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)s;
  const double per_density = 1 / body->physics.material.density, *density = b->terms->solid_density;
  double *limit = b->terms->yield_limit;
  const size_t n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    limit[k] *= tension_limit_whole(density[k] * per_density);
}

static const sph_hook tension_limit_hooks[SPH_STAGES] =
    {[SPH_LIMIT] = tension_limit_pressure, [SPH_YIELD] = tension_limit_yield};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool tension_limit_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return !body->flaws && body->material.tension_limit.pressure >= 0 && isfinite(body->material.tension_limit.pressure);
}

static const struct sph_module tension_limit_module = {
    .name = "tension_limit",
    .doc = "Pressure is not below -tension_limit: a spall strength for matter without flaws. It falls with expansion "
           "and is gone at 0.9 of the density: torn matter does not pull (nor shear), or P/rho^2 of thin debris would "
           "grow without bound. It is that of the body as it is, whatever the density of its solid matter: so tensile "
           "and spall strengths are measured.",
    .source = "Asphaug & Melosh 1993; the fall with expansion, and that it is the strength of the body as it is, are "
              "our choices",
    .when = "a material with a tension_limit in a body without flaws",
    .on = tension_limit_on,
};

#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
MATERIAL_REAL(tension_limit, tension_limit.pressure, "Pa", NAN, 0, 1e15, .flags = FIELD_MAY_BE_OFF,
              .doc = "Largest tension of a body without flaws (its lowest pressure is minus this). It falls with "
                     "expansion, to none at 0.9 of the density, so that cold matter reaches 1/(1 + 10 tension_limit/A) "
                     "of it. off: no limit, down to -A and beyond."),
#endif
