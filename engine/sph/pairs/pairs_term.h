/* What a term of the pair loop is made of and may use, in one precision (templates_on.h).
 *
 * A term is a part of the pair loop that a module adds to it: columns of a particle's record, sums, and what happens in
 * a pair. The module declares it in its NAME.h (modules/declarations.h: PAIR_TERM and the kinds below it), and defines
 * the functions that it declares behind `#ifdef SPH_PAIR_TERM`. All are inlined into the pair loop, which is compiled
 * for each combination of terms of SPH_PAIR_COMBINATIONS (modules/declarations.h). Off means absent.
 *
 *   PAIR_MADE     void NAME_make(options, fields, first, last, made[])             in double only
 *                 before the pass: arrays of the particles first .. last - 1 that follow from the fields
 *   PAIR_PACK     void TYPED(NAME_pack)(source, first, which, base[], own[])
 *                 columns of the record: `own` are the term's, `base` those of every record, which it may change
 *   PAIR_BEFORE   void TYPED(NAME_before)(k, me, base, mine, its, p)
 *                 changes what the force is made of: p->share, p->viscous
 *   PAIR_STRESS   void TYPED(NAME_stress)(k, me, mine, its, p, t)
 *                 sets elements of t, the sum of both partners' stress over density squared
 *   PAIR_STRESS_ADDED   vec TYPED(NAME_stress_added)(k, me, mine, its, p, t)
 *                 adds to t, only where a body has strength; returns the power that its force takes from the motion
 *   PAIR_FORCE    vec TYPED(NAME_force)(k, me, base, mine, its, p)
 *                 adds to p->force; returns the power that this takes from the motion, u times it
 *   PAIR_SUMMED   void TYPED(NAME_sum)(p, w, first, sum)
 *                 adds to the term's sums of one partner
 *   PAIR_FINISH   void NAME_finish(options, fields, first, count, sums)            in double only
 *                 after the pass, when the sums of some particles are complete: place 0 of `sums` is particle `first`
 *
 * `mine` are the term's columns in the member's record, `its` those of the neighbours, `base` the columns that every
 * record has. Units, which are all 1 in double (struct sph_pair_units): h and d in unit.distance, u in unit.velocity,
 * densities in unit.density, w in unit.length^-4, stress over density squared in unit.specific. A force is the latter
 * times w. A PAIR_CONSTANT is in SI: a number with a unit comes in by PAIR_PACK, which can convert it (source->unit).
 *
 * p->force is what the neighbour gets, and the member gets its opposite: a force that slows the member adds along +u.
 * In double the loop multiplies it by the mass of the partner. In float slope and w have the factor m_i m_j already, or
 * V_i V_j with volume weights. With the gradient correction and without volume weights both have a further factor
 * (rho_i rho_j)^(-1/2) in PAIR_STRESS_ADDED and PAIR_FORCE, not in PAIR_BEFORE: a force with densities of its own takes
 * it out. In float q, t and inverse_r may be no numbers outside `near`: end with vec_keep(p->near, ...). A force that
 * does not act along d changes the angular momentum. */

#define vec_part        TYPED(vec_part)
#define column_load     TYPED(column_load)
#define column_position TYPED(column_position)
#define column_store    TYPED(column_store)
#define pair_member     TYPED(pair_member)
#define pair_batch      TYPED(pair_batch)
#define pair_dot        TYPED(pair_dot)

#define GROUP                   (SINGLE ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE)
#define WEIGHTED(weight, value) (SINGLE ? (value) : (weight) * (value))
/* The signal of particles that have neighbours, none of which approaches. */
#define LEAST_SIGNAL (SINGLE ? (REAL)0x1p-126 : (REAL)0x1p-1022)
#define FOR_MEMBERS(m)                                                                                                 \
  UNROLL                                                                                                               \
  for (int m = 0; m < GROUP; m++)
#define FOR_AXES(a)                                                                                                    \
  UNROLL                                                                                                               \
  for (int a = 0; a < 3; a++)

/* The column of element a, b of a symmetric tensor, xx xy xz yy yz zz. */
#define SYMMETRIC(a, b) ((a) < (b) ? (a) * (5 - (a)) / 2 + (b) : (b) * (5 - (b)) / 2 + (a))

#if !SINGLE
enum { AT_ONCE = LANES }; /* numbers of double in a register */

/* The deviator times its factor; the stored deviator lacks zz, as its trace is zero. */
INLINE void acting(const double *const stress[5], const double *factor, size_t i, size_t lanes, vec out[6]) {
  const vec f = vec_load_first(factor + i, lanes);
  UNROLL
  for (int k = 0; k < 5; k++)
    out[k] = f * vec_load_first(stress[k] + i, lanes);
  out[5] = -(out[0] + out[3]);
}
#endif

/* ---- columns ---- */

typedef REAL vec_part __attribute__((vector_size(WIDTH / sizeof(double) * sizeof(REAL))));

/* A column times `scale`, for the AT_ONCE particles from `first` on or, with `which`, for those that it names. A column
 * that is NULL counts as zero. */
INLINE vec_double column_load(const double *from, double scale, size_t first, const uint32_t *which) {
  vec_double v = {0};
  if (!from)
    return v;
  if (!which) {
    memcpy(&v, from + first, sizeof v);
  } else {
#ifdef __AVX512F__
    v = (vec_double)_mm512_i32gather_pd(_mm256_loadu_si256((const void *)which), from, sizeof *from);
#else
    for (size_t lane = 0; lane < AT_ONCE; lane++)
      v[lane] = from[which[lane]];
#endif
  }
  return v * scale;
}

/* ---- a pair ---- */

/* A member of the group whose list is summed. */
struct pair_member {
  const REAL *record;
  REAL per_density; /* with volume weights; else not used */
  REAL weight;      /* mass or volume, times the norm of the spline's slope */
  vec sum[SUM_MOST];
};

/* A member and a batch of neighbours, lane by lane. */
struct pair_batch {
  vec d[3], u[3];           /* from the member to the neighbour; the member's velocity less the neighbour's */
  vec h, inverse_h;         /* mean smoothing length */
  vec inverse_r, q, t;      /* 1/r, r/h, 2 - q */
  vec densities;            /* rho_i + rho_j */
  vec per_densities;        /* 1/(rho_i rho_j), with volume weights */
  vec per_softened;         /* 1/((rho_i + rho_j)(r^2 + 0.01 h^2)); in float times h */
  vec slope, w[3];          /* W'/r, grad W; zero beyond the support */
  vec closing, mu, viscous; /* -r.v, positive when they approach; |mu_ij|; Pi_ij */
  vec share[2];             /* of the pair in the member's sums and by its stress; in the neighbour's; 1 */
  vec force[3];
  vec work[PAIR_TERMS]; /* power that terms take from the motion */
  vec_mask near, inner; /* within the support; within h */
};

INLINE vec pair_dot(const vec a[3], const vec b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
