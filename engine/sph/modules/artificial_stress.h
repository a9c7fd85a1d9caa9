/* Artificial stress against clumping in tension: a term of the pair loop. It makes R from the stress of each particle,
 * and adds f^n (R_i + R_j) to each pair.
 *
 *   method.artificial_stress   Monaghan's epsilon; 0: none
 *
 * The factor f^n belongs to a pair, so that R is conjugate to no velocity gradient and its power is not sigma : eps.
 * The pair loop sums the power pair by pair, and each of the two particles gets half of it as internal energy. Total
 * energy is then conserved. R grows as two particles come close, and it can take more energy than was stored: the
 * internal energy of a particle is then held at zero, and the ledger counts the difference (energy.clamped).
 *
 * Artificial stress, a term of the pair loop: it adds f^n (R_i + R_j) to the stress of a pair.
 *
 * The artificial stress of Monaghan 2000 (J. Comput. Phys. 159, 290) in the principal axes of the stress, as in Gray,
 * Monaghan & Swift 2001: R = -epsilon times the tensile part of sigma/rho^2. It repels particles that a tension would
 * pull into clumps. */

MODULE(artificial_stress)
MODULE_INPUTS(artificial_stress)

#ifdef SPH_MODULE_STRUCTS
struct sph_artificial_stress_inputs {
  double epsilon; /* 1; 0: off */
};
#endif

PAIR_TERM(artificial_stress, o->artificial_stress.epsilon > 0 && o->strength)
PAIR_MADE(artificial_stress, 6)                                                      /* R, m^5/(kg s^2) */
PAIR_RECORD(artificial_stress, 6)                                                    /* R */
PAIR_CONSTANT(spline_at_spacing, sph_spline(o->spacing_over_h, 1) / SPH_SPLINE_NORM) /* W(spacing)/norm */
PAIR_PACK(artificial_stress)
PAIR_STRESS_ADDED(artificial_stress)

#ifdef SPH_PAIR_TERM

#if !SINGLE /* R is always made in double, LANES particles at a time, by Jacobi's rotations */

/* One rotation of a symmetric matrix: its element `pq` becomes zero, and the columns p and q of v turn with it. t is
 * the tangent of the angle. */
INLINE void rotate(vec *pp, vec *qq, vec *pq, vec *pr, vec *qr, vec v[3][3], int p, int q) {
  const vec zero = {0}, difference = *qq - *pp, twice = 2 * *pq;
  const vec square = difference * difference + twice * twice + 0x1p-1000;
  const vec length = square * vec_inverse_root(square); /* never zero */
  const vec negative = vec_select(vec_less(difference, zero), -twice, twice);
  const vec size = vec_select(vec_less(difference, zero), -difference, difference);
  const vec t = negative * vec_inverse(size + length), c = vec_inverse_root(1 + t * t), s = t * c;
  const vec r = *pr;
  *pp -= t * *pq;
  *qq += t * *pq;
  *pq = zero;
  *pr = c * r - s * *qr;
  *qr = s * r + c * *qr;
  UNROLL
  for (int k = 0; k < 3; k++) {
    const vec x = v[k][p];
    v[k][p] = c * x - s * v[k][q];
    v[k][q] = s * x + c * v[k][q];
  }
}

/* Is any particle under tension (`pulled`) whose matrix is not yet diagonal? */
INLINE bool not_diagonal(const vec a[6], vec_mask pulled) {
  const vec off = a[1] * a[1] + a[2] * a[2] + a[4] * a[4], on = a[0] * a[0] + a[3] * a[3] + a[5] * a[5];
  return vec_any(vec_less((REAL)1e-32 * on, off) & pulled);
}

enum { AXIS_XX = 0, AXIS_YY = 3, AXIS_ZZ = 5 };
static const int tensor_row[6] = {0, 0, 0, 1, 1, 2}, tensor_column[6] = {0, 1, 2, 1, 2, 2};

/* Loads the stress a of the particles at .. at + lanes - 1, and the identity v. Returns which of them may be under
 * tension: where all of Gershgorin's circles are negative there is none. */
INLINE vec_mask tension_load(const struct sph_pair_fields *f, size_t at, size_t lanes, vec a[6], vec v[3][3]) {
  const vec zero = {0}, one = zero + 1, pressure = vec_load_first(f->pressure_term + at, lanes);
  acting(f->stress, f->stress_factor, at, lanes, a);
  UNROLL
  for (int k = 0; k < 6; k++)
    a[k] += tensor_row[k] == tensor_column[k] ? pressure : zero;
  UNROLL
  for (int k = 0; k < 9; k++)
    v[k / 3][k % 3] = k % 4 == 0 ? one : zero;
  const vec xy = vec_abs(a[1]), xz = vec_abs(a[2]), yz = vec_abs(a[4]);
  return vec_less(zero, a[AXIS_XX] + (xy + xz)) | vec_less(zero, a[AXIS_YY] + (xy + yz)) |
         vec_less(zero, a[AXIS_ZZ] + (xz + yz));
}

/* One of the three rotations of a sweep, which makes the element xy, xz or yz zero. */
INLINE void tension_rotate(vec a[6], vec v[3][3], int rotation) {
  static const int of[3][5] = {{0, 3, 1, 2, 4}, {0, 5, 2, 1, 4}, {3, 5, 4, 1, 2}}; /* pp qq pq pr qr */
  static const int axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  const int *at = of[rotation];
  rotate(&a[at[0]], &a[at[1]], &a[at[2]], &a[at[3]], &a[at[4]], v, axes[rotation][0], axes[rotation][1]);
}

/* R out of the eigenvalues on the diagonal of a and the eigenvectors v. */
INLINE void tension_oppose(double epsilon, const vec a[6], const vec v[3][3], vec_mask pulled, vec r[6]) {
  static const int diagonal[3] = {AXIS_XX, AXIS_YY, AXIS_ZZ};
  const vec zero = {0};
  UNROLL
  for (int k = 0; k < 6; k++)
    r[k] = zero;
  UNROLL
  for (int axis = 0; axis < 3; axis++) {
    const vec value = a[diagonal[axis]];
    const vec most = vec_keep(vec_less(zero, value) & pulled, -epsilon * value);
    UNROLL
    for (int k = 0; k < 6; k++)
      r[k] += most * v[tensor_row[k]][axis] * v[tensor_column[k]][axis];
  }
}

/* R of the particles first .. last - 1 (xx xy xz yy yz zz), in the unit of sigma/rho^2. Two registers of particles are
 * rotated in turn: a rotation is a chain of roots and inverses, and the instructions of one register fill the gaps of
 * the other. */
static void artificial_stress_make(const struct sph_pair_options *options, const struct sph_pair_fields *f,
                                   size_t first, size_t last, double *const made[]) {
  enum { BOTH = 2, SWEEPS = 12 };
  for (size_t i = first; i < last; i += BOTH * LANES) {
    vec a[BOTH][6], v[BOTH][3][3], r[6];
    vec_mask pulled[BOTH];
    size_t left[BOTH];
    bool turns[BOTH] = {true, true};
    UNROLL
    for (size_t m = 0; m < BOTH; m++) {
      const size_t at = i + m * LANES < last ? i + m * LANES : last;
      left[m] = last - at < LANES ? last - at : LANES;
      pulled[m] = tension_load(f, at, left[m], a[m], v[m]);
    }

    for (int sweep = 0; sweep < SWEEPS; sweep++) {
      UNROLL
      for (int m = 0; m < BOTH; m++)
        turns[m] = turns[m] && not_diagonal(a[m], pulled[m]);
      if (!turns[0] && !turns[1])
        break;
      UNROLL
      for (int rotation = 0; rotation < 3; rotation++) {
        UNROLL
        for (int m = 0; m < BOTH; m++)
          if (turns[m])
            tension_rotate(a[m], v[m], rotation);
      }
    }

    UNROLL
    for (size_t m = 0; m < BOTH; m++) {
      tension_oppose(options->artificial_stress.epsilon, a[m], v[m], pulled[m], r);
      UNROLL
      for (int k = 0; k < 6; k++)
        vec_store_first(made[k] + i + m * LANES, r[k], left[m]);
    }
  }
}

#endif

INLINE void TYPED(artificial_stress_pack)(const struct sph_pair_source *source, size_t first, const uint32_t *which,
                                          vec_double base[], vec_double own[]) {
  const vec_double density = base[PAIR_DENSITY];
  UNROLL
  for (size_t c = 0; c < PAIR_RECORD_artificial_stress; c++) {
    own[c] = column_load(source->made[MADE_artificial_stress + c], source->unit.per_specific, first, which);
    if (source->volume_weights)
      own[c] *= density * density;
    else if (source->geometric_weights)
      own[c] *= density;
  }
}

/* Adds the artificial stress f^4 (R_i + R_j), f = W(r)/W(spacing) [Monaghan 2000; Gray, Monaghan & Swift 2001] to the
 * stress t. */
INLINE vec TYPED(artificial_stress_stress_added)(const struct sph_pair_constants *k, const struct pair_member *me,
                                                 const REAL *mine, const vec *its, const struct pair_batch *p,
                                                 vec t[3][3]) {
  (void)me;
  vec f = vec_select(p->inner, 1 - p->q * p->q * ((REAL)1.5 - (REAL)0.75 * p->q), (REAL)0.25 * p->t * p->t * p->t);
  if (SINGLE)
    f = vec_keep(p->near, f); /* q may be no number elsewhere */
  f *= (REAL)(1 / k->spline_at_spacing);
  f *= f;
  f *= f;
  vec r[6], pull[3];
  UNROLL
  for (int c = 0; c < 6; c++)
    r[c] = f * (mine[c] + its[c]);
  FOR_AXES(a) {
    FOR_AXES(b)
      t[a][b] += r[SYMMETRIC(a, b)];
    pull[a] = r[SYMMETRIC(a, 0)] * p->w[0] + r[SYMMETRIC(a, 1)] * p->w[1] + r[SYMMETRIC(a, 2)] * p->w[2];
  }
  const vec work = pair_dot(p->u, pull);
  if (!SINGLE && k->volume_weights)
    return work * p->per_densities;
  return work;
}

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool artificial_stress_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->artificial_stress.epsilon > 0;
}

static const struct sph_module artificial_stress_module = {
    .name = "artificial_stress",
    .doc = "Repulsion between particles under tension, against their clumping: for elastic bodies that do not crack.",
    .source = "Monaghan 2000; Gray, Monaghan & Swift 2001",
    .when = "artificial_stress above 0",
    .on = artificial_stress_on,
    .bytes_in_pairs = 6 * sizeof(double), /* R */
    .cost = 70,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_REAL(method.artificial_stress, artificial_stress.epsilon, "1", 0, 0, 1,
           .doc = "Monaghan's epsilon against clumping in tension, for bodies that do not crack. 0: it is absent.",
           .source = "Monaghan 2000; Gray, Monaghan & Swift 2001"),
#endif
