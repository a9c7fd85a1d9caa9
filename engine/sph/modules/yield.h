/* Von Mises' yield limit of each particle, Y0 (1 - u/u_melt), zero beyond [BA95 eqs. 8-10]. A yield law only writes the
 * limit. tension_limit lowers it in thin matter, palpha by the distention, and `elastic` brings the stress back to it.
 *
 *   material.yield_stress   Y0; off: the body never yields
 *   material.melt_energy    u_melt; off: the limit does not depend on the energy
 *
 * Another yield law is a module like this one: its loop of the stage SPH_YIELD writes the terms' yield_limit, a bound
 * of sqrt(3 J2) of the solid's stress in Pa, and its descriptor sets SPH_SETS_YIELD_LIMIT. In declarations.h it comes
 * after this one and before tension_limit; where it is on, modules.c turns this one off. It may read pressure (of the
 * body), density, energy and, where sph_solid_has(body, SPH_COLUMN(damage)), the predicted D^(1/3). */

MODULE(yield)
MODULE_HOOKS(yield)
MODULE_MATERIAL(yield)

#ifdef SPH_MODULE_STRUCTS
struct sph_yield_material {
  double stress; /* Pa at u = 0; NaN or INFINITY: never yields */
};
#endif

#ifdef SPH_MODULE_LOOPS

RANGE_HOOK void yield_limit(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const double y0 = body->physics.material.yield.stress, melt = body->physics.material.melt_energy;
  const double softening = melt > 0 ? 1 / melt : 0; /* NaN: none */
  const double *energy = s->c.energy + b->low;
  double *limit = b->terms->yield_limit;
  const size_t n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++)
    limit[k] = range_larger(y0 * (1 - energy[k] * softening), 0);
}

static const sph_hook yield_hooks[SPH_STAGES] = {[SPH_YIELD] = yield_limit};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool yield_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength && isfinite(body->material.yield.stress);
}

static const struct sph_module yield_module = {
    .name = "yield",
    .doc = "Von Mises: the deviator returns radially to sqrt(3 J2) = Y, with Y = Y0 (1 - u/u_melt) and 0 beyond.",
    .source = "Benz & Asphaug 1995, eqs. 8-10, with the square root that eq. 9 lacks",
    .when = "a body with strength whose yield_stress is finite",
    .on = yield_on,
    .sets = SPH_SETS_YIELD_LIMIT,
};

#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
MATERIAL_REAL(yield_stress, yield.stress, "Pa", NAN, 0, 1e15, .flags = FIELD_MAY_BE_OFF | FIELD_ABOVE_MINIMUM,
              .when = "../strength=true",
              .doc = "Y_0: von Mises yield stress of cold solid matter. off: elastic at any stress.",
              .source = "Benz & Asphaug 1995, eq. 9"),
#endif
