/* Free surfaces at cracks: matter that holds together does not feel loose matter beside it.
 *
 *   method.crack_surfaces   turns the term on; it needs the gradient correction
 *
 * A broken particle is loose where nothing presses on it: debris. Without this term a particle that is not loose sees
 * the flight of loose neighbours as its own strain, and its stress pulls at them, so that damage eats into a body. With
 * it a loose neighbour has no share
 *   - in the velocity gradient and the moments of the particle, so that B_i makes the gradient exact over the others;
 *   - in the part of the pair's force that the particle's own stress makes, on both partners,
 * so that forces stay conjugate to the gradient: momentum and energy are kept. The force by the stress of the loose
 * partner, the viscosity and all sums of the loose partner stay: debris that is pressed against a body acts on it. */

MODULE(crack_surfaces)
MODULE_INPUTS(crack_surfaces)

#ifdef SPH_MODULE_STRUCTS
struct sph_crack_surfaces_inputs {
  bool on;
};
#endif

COLUMN(correction_share) /* p, the share of the inverse of M in B (gradient_correction.h) */

PAIR_TERM(crack_surfaces, o->crack_surfaces.on && o->gradient_correction.on && o->strength)
PAIR_FIELDS(damage, 1)
PAIR_FIELDS(correction_share, 1)
PAIR_FOUND(crack_surfaces, correction_share, 1) /* the gradient correction fills it */
PAIR_RECORD(crack_surfaces, 1)                  /* how loose the particle is, 0 to 1 */
PAIR_PACK(crack_surfaces)
PAIR_BEFORE(crack_surfaces)

#ifdef SPH_PAIR_TERM

#if !SINGLE
/* From this D on a particle without pressure is loose, more and more up to D = 1; and the compression P/(rho c^2) at
 * which it is so no longer. Smooth, so that forces do not jump; from 1e-6 to 0.01, and with 0.9, results of disruption
 * differ by less than seeds do. */
static const double loose_damage = 0.8, pressed_strain = 0.003;
#endif

INLINE void TYPED(crack_surfaces_pack)(const struct sph_pair_source *source, size_t first, const uint32_t *which,
                                       vec_double base[], vec_double own[]) {
  const vec_double zero = {0}, d = column_load(source->fields.damage[0], 1, first, which);
  const vec_double pressure = column_load(source->pressure, -source->unit.per_specific, first, which); /* P/rho^2 */
  vec_double broken = (d * d * d - loose_damage) * (1 / (1 - loose_damage));
  broken = vec_select_double(vec_less_double(broken, zero), zero, broken);
  vec_double slack = 1 - pressure * base[PAIR_DENSITY] / (base[PAIR_SOUND] * base[PAIR_SOUND]) * (1 / pressed_strain);
  slack = vec_select_double(vec_less_double(slack, zero), zero, slack);
  slack = vec_select_double(vec_less_double(zero + 1, slack), zero + 1, slack);
  own[0] = broken * broken * (3 - 2 * broken) * slack * slack * (3 - 2 * slack);
}

INLINE void TYPED(crack_surfaces_before)(const struct sph_pair_constants *k, const struct pair_member *me,
                                         const vec *base, const REAL *mine, const vec *its, struct pair_batch *p) {
  (void)k, (void)me, (void)base;
  const vec zero = {0}, loose = zero + mine[0];
  p->share[0] = 1 - its[0] * (1 - loose);
  p->share[1] = 1 - loose * (1 - its[0]);
}

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool crack_surfaces_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  return inputs->crack_surfaces.on && inputs->gradient_correction.on && body->strength;
}

static const struct sph_column_need crack_surfaces_columns[] = {{SPH_COLUMNS_OF(correction_share), 1, NULL}, {0}};

static const struct sph_module crack_surfaces_module = {
    .name = "crack_surfaces",
    .doc = "Matter that holds together has free surfaces where its neighbours are broken and loose: it feels neither "
           "their flight as strain nor pulls at them.",
    .source = "our choice; near to the virtual links of Islam & Peng 2019 (arXiv:1901.08342)",
    .when = "crack_surfaces: true",
    .on = crack_surfaces_on,
    .columns = crack_surfaces_columns,
    .bytes_in_pairs = 8,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_SWITCH(method.crack_surfaces, crack_surfaces.on, 0, .absent = "false",
             .doc =
                 "Matter that holds together has a free surface where its neighbours are broken and loose. Without it "
                 "it feels their flight as strain and pulls at them, so that damage eats into a body. Flaws that were "
                 "fitted without it are then too strong. Needs method.gradient_correction.",
             .source = "our choice; near to Islam & Peng 2019 (arXiv:1901.08342)"),
#endif
