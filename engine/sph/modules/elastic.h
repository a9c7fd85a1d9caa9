/* Deviatoric stress of a solid: Hooke's law in a turning frame, up to the yield limit.
 *
 *   material.shear_modulus   mu: needed
 *   material.yield_stress    needed, may be off (the body never yields); the laws of yield read it
 *
 * It reads two_mu where a module publishes an effective one, and the terms' yield_limit where a yield law sets one.
 *
 * Hooke's law in a turning frame, and the return of the stress to the yield limit.
 *
 * dS/dt = 2 mu dev(eps) + R S - S R with R_ab = (dv_a/dx_b - dv_b/dx_a)/2: a rigidly turning body keeps its stress in
 * its own frame [BA95 eqs. 5-7, whose sign of the rotation terms is the other one]. S is stored undamaged. */

MODULE(elastic)
MODULE_HOOKS(elastic)
MODULE_MATERIAL(elastic)

#ifdef SPH_MODULE_STRUCTS
struct sph_elastic_material {
  double bulk_modulus, shear_modulus; /* Pa; K for Young's modulus and the speed of cracks, NaN: tillotson.A */
};
#endif

COLUMN(stress[5])      /* Pa, deviator, undamaged: xx xy xz yy yz */
COLUMN(stress_rate[5]) /* Pa/s */
COLUMN(stress_factor)  /* (1-D)/rho^2, where D scales the deviator: the pair loop multiplies the stress by it */
COLUMN(two_mu)         /* Pa, effective 2 mu in bodies whose modules publish it; others have the material's */

#ifdef SPH_MODULE_LOOPS

RANGE_HOOK void elastic_predict(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const double dt = s->dt;
  for (int k = 0; k < 5; k++) {
    double *stress = s->c.stress[k];
    const double *rate = s->c.stress_rate[k];
    RANGE_LOOP
    for (size_t i = b->low; i < b->high; i++)
      stress[i] += dt * rate[i];
  }
}

/* du/dt = (damaged sigma : eps)/rho + viscous heating [BA95 eq. 4, which lacks the heating]. With the gradient
 * correction eps is that of the uncorrected gradient, which is conjugate to the forces (pairs.h). */
RANGE_INLINE void elastic_rates_loop(struct sph_system *s, const struct sph_solid *body, struct sph_block *b,
                                     bool published) {
  const double half = 0.5 * s->dt, material_two_mu = 2 * body->physics.material.elastic.shear_modulus;
  const double *effective = s->c.two_mu, *growing = s->c.shear_factor;
  double *const *g = b->sums->gradient;
  const double *g0 = g[0], *g1 = g[1], *g2 = g[2], *g3 = g[3], *g4 = g[4], *g5 = g[5], *g6 = g[6], *g7 = g[7],
               *g8 = g[8];
  const double *density = s->c.density, *term = s->c.pressure_term, *heating = b->sums->heating,
               *power = b->sums->power;
  const double *factor = s->c.stress_factor;
  double *energy = s->c.energy, *energy_rate = s->c.energy_rate;
  double *sxx = s->c.stress[0], *sxy = s->c.stress[1], *sxz = s->c.stress[2], *syy = s->c.stress[3],
         *syz = s->c.stress[4];
  double *rxx = s->c.stress_rate[0], *rxy = s->c.stress_rate[1], *rxz = s->c.stress_rate[2], *ryy = s->c.stress_rate[3];
  double *ryz = s->c.stress_rate[4];
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double exx = g0[k], eyy = g4[k], ezz = g8[k], divergence = exx + eyy + ezz, third = divergence * (1.0 / 3);
    const double exy = 0.5 * (g1[k] + g3[k]), exz = 0.5 * (g2[k] + g6[k]), eyz = 0.5 * (g5[k] + g7[k]);
    const double wxy = 0.5 * (g1[k] - g3[k]), wxz = 0.5 * (g2[k] - g6[k]), wyz = 0.5 * (g5[k] - g7[k]);
    const double xx = sxx[i], xy = sxy[i], xz = sxz[i], yy = syy[i], yz = syz[i], zz = -(xx + yy);
    const double fed = xx * exx + yy * eyy + zz * ezz + 2 * (xy * exy + xz * exz + yz * eyz);
    const double two_mu = published ? effective[i] * (fed < 0 ? 1 : growing[i]) : material_two_mu;
    const double axx = factor[i] * xx, ayy = factor[i] * yy; /* damaged */
    const double work = term[i] * divergence + axx * exx + ayy * eyy - (axx + ayy) * ezz +
                        2 * (factor[i] * xy * exy + factor[i] * xz * exz + factor[i] * yz * eyz);
    const double heat = (power ? power[k] : density[i] * work) + heating[k];
    energy[i] += half * (heat - energy_rate[i]);
    energy_rate[i] = heat;
    /* (R S - S R)_ab = sum_c R_ac S_cb + R_bc S_ca */
    const double txx = 2 * (wxy * xy + wxz * xz);
    const double tyy = 2 * (-wxy * xy + wyz * yz);
    const double txy = wxy * (yy - xx) + wxz * yz + wyz * xz;
    const double txz = wxz * (zz - xx) + wxy * yz - wyz * xy;
    const double tyz = wyz * (zz - yy) - wxy * xz - wxz * xy;
    const double nxx = two_mu * (exx - third) + txx, nyy = two_mu * (eyy - third) + tyy;
    const double nxy = two_mu * exy + txy, nxz = two_mu * exz + txz, nyz = two_mu * eyz + tyz;
    sxx[i] = xx + half * (nxx - rxx[i]), rxx[i] = nxx;
    sxy[i] = xy + half * (nxy - rxy[i]), rxy[i] = nxy;
    sxz[i] = xz + half * (nxz - rxz[i]), rxz[i] = nxz;
    syy[i] = yy + half * (nyy - ryy[i]), ryy[i] = nyy;
    syz[i] = yz + half * (nyz - ryz[i]), ryz[i] = nyz;
  }
}

RANGE_HOOK void elastic_rates(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  if (sph_solid_has(body, SPH_COLUMN(two_mu)))
    elastic_rates_loop(s, body, b, true);
  else
    elastic_rates_loop(s, body, b, false);
}

/* S -> f S, f = min(1, Y/sqrt(3 J2)), J2 = S:S/2 [BA95 eqs. 8-10; eq. 9 lacks the root: only with it does S land on
 * the yield surface]. Y is the yield limit that the modules have left in the terms. */
RANGE_HOOK void elastic_return(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  (void)body;
  const double *limit = b->terms->yield_limit;
  double *xx = s->c.stress[0], *xy = s->c.stress[1], *xz = s->c.stress[2], *yy = s->c.stress[3], *yz = s->c.stress[4];
  const size_t low = b->low, n = b->high - b->low;
  RANGE_LOOP
  for (size_t k = 0; k < n; k++) {
    const size_t i = low + k;
    const double y = limit[k];
    const double J2 = xx[i] * xx[i] + yy[i] * yy[i] + xx[i] * yy[i] + xy[i] * xy[i] + xz[i] * xz[i] + yz[i] * yz[i];
    const double size2 = 3 * J2;
    const double f = size2 > y * y ? y / sqrt(size2) : 1;
    xx[i] *= f, xy[i] *= f, xz[i] *= f, yy[i] *= f, yz[i] *= f;
  }
}

static const sph_hook elastic_hooks[SPH_STAGES] =
    {[SPH_PREDICT] = elastic_predict, [SPH_RETURN] = elastic_return, [SPH_RATES] = elastic_rates};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool elastic_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)inputs;
  return body->strength;
}

static status elastic_check(const struct sph_body_physics *body, const struct sph_particles *particles, size_t first,
                            size_t last, struct error *error) {
  const struct sph_material *m = &body->material;
  (void)particles, (void)first, (void)last;
  if (!(isfinite(m->elastic.shear_modulus) && m->elastic.shear_modulus >= 0))
    return status_fail(error, STATUS_CONTENT, "shear_modulus is %g; a body with strength needs a number not below 0",
                       m->elastic.shear_modulus);
  if (!(m->yield.stress >= 0)) /* infinite: never yields */
    return status_fail(error, STATUS_CONTENT, "yield_stress is %g; a body with strength needs one", m->yield.stress);
  return STATUS_OK;
}

/* The particles' stress without its trace. */
static void elastic_fill(struct sph_system *s, const struct sph_solid *body, const struct sph_particles *p) {
  for (size_t i = body->first; p->stress[0] && i < body->last; i++) {
    const double third = (p->stress[0][i] + p->stress[3][i] + p->stress[5][i]) / 3;
    for (int k = 0; k < 5; k++)
      s->c.stress[k][i] = p->stress[k][i] - (k == 0 || k == 3 ? third : 0);
  }
}

static const struct sph_column_need elastic_columns[] = {{SPH_COLUMNS_OF(stress), 0, NULL},
                                                         {SPH_COLUMNS_OF(stress_rate), 0, NULL},
                                                         {SPH_COLUMNS_OF(stress_factor), 0, NULL},
                                                         {0}};

static const struct sph_module elastic_module = {
    .name = "elastic",
    .doc = "Deviatoric stress by Hooke's law in the particle's turning frame: dS/dt = 2 mu dev(eps) + R S - S R "
           "(Jaumann).",
    .source =
        "Benz & Asphaug 1995, eqs. 6-7, with the sign of the rotation terms that keeps a rigidly turning body's stress",
    .when = "a body with strength",
    .on = elastic_on,
    .columns = elastic_columns,
    .check = elastic_check,
    .fill = elastic_fill,
};

#endif

#ifdef SPH_MODULE_MATERIAL_ROWS
MATERIAL_REAL(bulk_modulus, elastic.bulk_modulus, "Pa", NAN, 1, 1e15, .flags = FIELD_MAY_BE_OFF,
              .when = "../strength=true",
              .doc = "K for Young's modulus and the speed of cracks; waves follow tillotson.A. off: tillotson.A.",
              .source = "Benz & Asphaug 1995, eq. 21"),
    MATERIAL_REAL(shear_modulus, elastic.shear_modulus, "Pa", NAN, 1, 1e15, .flags = FIELD_MAY_BE_OFF,
                  .when = "../strength=true", .doc = "mu: shear modulus.", .source = "Benz & Asphaug 1995, eq. 6"),
#endif
