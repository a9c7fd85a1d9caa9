/* The pair loop in one precision: all sums of the particles of a chunk, among each other and with the foreign particles
 * in their lists (pairs.h has the equations). Particles are summed in groups of GROUP that share a list, the neighbours
 * in batches of LANES. A pair is visited once: the member's sums stay in registers until its list ends, the neighbours'
 * sums are added to their records batch by batch.
 *
 * A batch goes through these phases, each for all members of the group before the next one, so that the members' chains
 * of dependent instructions overlap: distance, slope, viscosity, stress or pressure, sums. Every
 * phase is inlined into sum_pairs, which is compiled for each combination of its flags.
 *
 * In float a pair's weights (mass times mass, or volume times volume) are factors of the kernel's slope, so that both
 * partners get the same number; unpack_records divides by the particle's own mass. In double each partner's sums are
 * multiplied by the other's weight here: WEIGHTED. */

#define pair_member          TYPED(pair_member)
#define pair_batch           TYPED(pair_batch)
#define pair_dot             TYPED(pair_dot)
#define pair_along           TYPED(pair_along)
#define pair_begin           TYPED(pair_begin)
#define pair_distance        TYPED(pair_distance)
#define pair_slope           TYPED(pair_slope)
#define pair_viscosity       TYPED(pair_viscosity)
#define pair_repulsion       TYPED(pair_repulsion)
#define pair_stress          TYPED(pair_stress)
#define pair_pressure        TYPED(pair_pressure)
#define pair_add             TYPED(pair_add)
#define pair_end             TYPED(pair_end)
#define pair_forces          TYPED(pair_forces)
#define pair_sum_batch       TYPED(pair_sum_batch)
#define sum_pairs            TYPED(sum_pairs)
#define sum_pairs_plain      TYPED(sum_pairs_plain)
#define sum_pairs_artificial TYPED(sum_pairs_artificial)
#define sum_pairs_corrected  TYPED(sum_pairs_corrected)
#define sum_pairs_both       TYPED(sum_pairs_both)

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

/* A member of the group whose list is summed. */
struct pair_member {
  const REAL *record;
  REAL per_density; /* with volume weights; else not used */
  REAL weight;      /* mass or volume, times the norm of the spline's slope */
  vec sum[PAIR_WIDE];
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
  vec force[3];
  vec work;             /* power that the artificial stress takes from the motion */
  vec_mask near, inner; /* within the support; within h */
};

INLINE vec pair_dot(const vec a[3], const vec b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* One component of the vector from the member to its neighbours. */
INLINE vec pair_along(REAL mine, vec its, int axis, const struct sph_pair_constants *k) {
#if SINGLE
  union {
    REAL real;
    INT integer;
  } at = {.real = mine};
  typedef uint32_t whole __attribute__((vector_size(WIDTH)));
  whole difference = (whole)its - (uint32_t)at.integer;
  const vec d = __builtin_convertvector((vec_int)difference, vec);
  return k->wrapped ? d * (REAL)k->unit[axis] : d;
#else
  vec d = its - mine;
  if (k->wrapped && k->per_period[axis] > 0) {                /* the nearest image */
    vec turns = d * k->per_period[axis] + 6755399441055744.0; /* 1.5 x 2^52: rounds to an integer */
    d -= (turns - 6755399441055744.0) * k->periodic[axis];
  }
  return d;
#endif
}

INLINE void pair_begin(const struct sph_pair_constants *k, const REAL *record, struct pair_member *me) {
  me->record = record;
  me->per_density = k->volume_weights ? 1 / record[PAIR_DENSITY] : 0;
  me->weight = (REAL)k->norm * record[PAIR_MASS] * (k->volume_weights ? me->per_density : 1);
  UNROLL
  for (int column = 0; column < PAIR_WIDE; column++)
    me->sum[column] = (vec){0};
}

/* How far apart the partners are, and whether they are within the support. `left`: neighbours left in the list.
 *
 * Coincident particles exert no force on each other, and nothing is divided by their distance of zero. All members but
 * the first are also in the list themselves (`listed`); no particle is its own neighbour. */
INLINE void pair_distance(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its, INT left,
                          const bool listed, bool exists, struct pair_batch *p) {
  const vec zero = {0};
  FOR_AXES(a)
    p->d[a] = pair_along(me->record[PAIR_X + a], its[PAIR_X + a], a, k);
  const vec h = me->record[PAIR_H] + its[PAIR_H], hh = h * h, square = pair_dot(p->d, p->d);
  p->h = h;
  p->densities = me->record[PAIR_DENSITY] + its[PAIR_DENSITY];
  const vec softened = p->densities * (square + (REAL)0.01 * hh);
  p->near = vec_first_lanes(left);
  if (!exists)
    p->near &= vec_less(zero, zero);
  if (SINGLE) { /* one inverse serves for two; coincident ones count as one unit of the positions apart */
    const vec both = vec_inverse(h * softened);
    p->inverse_r = vec_inverse_root(listed ? square : vec_max(square, zero + 1));
    p->inverse_h = both * softened;
    p->per_softened = both * hh;
  } else {
    if (listed)
      p->near &= vec_less(zero, square);
    p->inverse_r = vec_inverse_root(vec_max(square, (REAL)1e-12 * hh));
    p->inverse_h = vec_inverse(h);
    p->per_softened = vec_inverse(softened);
  }
  p->q = square * p->inverse_r * p->inverse_h;
  p->t = 2 - p->q;
  p->near &= SINGLE ? vec_less(zero, p->t) : vec_less(square, 4 * hh); /* not near where q is not a number */
}

/* The spline's slope (spline.h) over r, and its gradient. */
INLINE void pair_slope(const struct sph_pair_constants *k, const struct pair_member *me, vec its_volume,
                       struct pair_batch *p) {
  const vec zero = {0};
  const vec inner = (REAL)2.25 * p->q - 3, outer = (REAL)-0.75 * p->t * p->t * (p->h * p->inverse_r);
  const vec inverse_hh = p->inverse_h * p->inverse_h; /* in float h^-4 alone may be too small a number */
  const vec scale = SINGLE ? me->weight * its_volume * inverse_hh * inverse_hh * p->inverse_h
                           : inverse_hh * inverse_hh * p->inverse_h * (REAL)k->norm;
  p->inner = vec_less(p->q, zero + 1);
  p->slope = vec_keep(p->near, vec_select(p->inner, inner, outer) * scale);
  FOR_AXES(a)
    p->w[a] = p->slope * p->d[a];
}

INLINE void pair_viscosity(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                           struct pair_batch *p) {
  const vec zero = {0};
  FOR_AXES(a)
    p->u[a] = me->record[PAIR_VX + a] - its[PAIR_VX + a];
  p->closing = pair_dot(p->u, p->d);
  const vec approach = vec_max(p->closing, zero);
  const vec mu_per = SINGLE ? approach * p->per_softened : p->h * approach * p->per_softened;
  const vec sound = me->record[PAIR_SOUND] + its[PAIR_SOUND];
  p->mu = mu_per * p->densities;
  p->viscous = mu_per * ((REAL)k->twice_beta * p->mu + (REAL)k->alpha * sound);
  if (SINGLE && k->volume_weights)
    p->viscous *= me->record[PAIR_DENSITY] * its[PAIR_DENSITY];
}

/* The column of element a, b of a symmetric tensor, xx xy xz yy yz zz. */
#define SYMMETRIC(a, b) ((a) < (b) ? (a) * (5 - (a)) / 2 + (b) : (b) * (5 - (b)) / 2 + (a))

/* Adds the artificial stress f^4 (R_i + R_j), f = W(r)/W(spacing) [Monaghan 2000; Gray, Monaghan & Swift 2001] to the
 * stress t. `more`: the neighbours' columns from PAIR_ARTIFICIAL on. */
INLINE void pair_repulsion(const struct sph_pair_constants *k, const struct pair_member *me, const vec *more,
                           struct pair_batch *p, vec t[3][3]) {
  vec f = vec_select(p->inner, 1 - p->q * p->q * ((REAL)1.5 - (REAL)0.75 * p->q), (REAL)0.25 * p->t * p->t * p->t);
  if (SINGLE)
    f = vec_keep(p->near, f); /* q may be no number elsewhere */
  f *= (REAL)(1 / k->spline_at_spacing);
  f *= f;
  f *= f;
  vec r[6], pull[3];
  UNROLL
  for (int c = 0; c < 6; c++)
    r[c] = f * (me->record[PAIR_ARTIFICIAL + c] + more[c]);
  FOR_AXES(a) {
    FOR_AXES(b)
      t[a][b] += r[SYMMETRIC(a, b)];
    pull[a] = r[SYMMETRIC(a, 0)] * p->w[0] + r[SYMMETRIC(a, 1)] * p->w[1] + r[SYMMETRIC(a, 2)] * p->w[2];
  }
  p->work = pair_dot(p->u, pull);
  if (!SINGLE && k->volume_weights)
    p->work *= p->per_densities;
}

/* The force of the whole stress. `more`: the neighbours' columns from PAIR_NARROW on. */
INLINE void pair_stress(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                        const vec *more, const bool corrected, const bool artificial, struct pair_batch *p) {
  vec t[3][3];
  FOR_AXES(a) {
    FOR_AXES(b)
      t[a][b] = me->record[PAIR_XX + SYMMETRIC(a, b)] + its[PAIR_XX + SYMMETRIC(a, b)];
  }
  if (corrected) { /* t is not symmetric: yx zx zy */
    const int turned = artificial ? PAIR_TURNED_TOO : PAIR_TURNED;
    const REAL *mine = me->record + turned;
    const vec *others = more + (turned - PAIR_NARROW);
    t[1][0] = mine[0] + others[0];
    t[2][0] = mine[1] + others[1];
    t[2][1] = mine[2] + others[2];
  }
  if (artificial)
    pair_repulsion(k, me, more, p, t);
  if (!SINGLE && k->volume_weights) { /* the records hold sigma B, not sigma B/rho^2 */
    FOR_AXES(a) {
      FOR_AXES(b)
        t[a][b] *= p->per_densities;
    }
  }
  FOR_AXES(a)
    t[a][a] -= p->viscous;
  FOR_AXES(a)
    p->force[a] = pair_dot(t[a], p->w);
}

/* The force when all particles are fluids. */
INLINE void pair_pressure(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                          struct pair_batch *p) {
  vec pressure = me->record[PAIR_XX] + its[PAIR_XX];
  if (!SINGLE && k->volume_weights)
    pressure *= p->per_densities;
  pressure -= p->viscous;
  FOR_AXES(a)
    p->force[a] = pressure * p->w[a];
  p->work = (vec){0};
}

/* Adds what one partner gets from the other, whose mass and volume (mass, without volume weights) are given, to `sum`:
 * the member's (`own`) or the neighbours', which begin with the first member's part (`first`). */
INLINE void pair_add(const struct pair_batch *p, vec mass, vec volume, vec cooling, vec signal, const bool own,
                     const bool first, const bool corrected, vec *sum) {
#define ADD(column, value) (sum[column] = first ? (value) : sum[column] + (value))
  vec w[3];
  sum[SUM_SIGNAL] = first ? signal : vec_max(sum[SUM_SIGNAL], signal);
  FOR_AXES(a) {
    if (own)
      sum[SUM_ACCELERATION + a] -= WEIGHTED(mass, p->force[a]);
    else
      ADD(SUM_ACCELERATION + a, WEIGHTED(mass, p->force[a]));
  }
  ADD(SUM_HEATING, WEIGHTED(mass, cooling));
  FOR_AXES(a)
    w[a] = WEIGHTED(volume, p->w[a]);
  FOR_AXES(a) {
    FOR_AXES(b)
      ADD(SUM_GRADIENT + 3 * a + b, p->u[a] * w[b]);
  }
  if (!corrected)
    return;
  FOR_AXES(a) {
    FOR_AXES(b) {
      if (a <= b)
        ADD(SUM_MOMENT + SYMMETRIC(a, b), p->d[a] * w[b]);
    }
  }
#undef ADD
}

/* Adds the lanes of the member's sums to its record. */
INLINE void pair_end(struct pair_member *me, const bool corrected, REAL *record) {
  UNROLL
  for (size_t column = 0; column < PAIR_NARROW; column += LANES)
    record_collect(record, column, me->sum + column);
  if (!corrected)
    return;
  UNROLL
  for (size_t column = PAIR_NARROW; column < SUM_COLUMNS; column += LANES)
    record_collect(record, column, me->sum + column);
}

/* The forces of a batch: of the whole stress, or of the pressure alone. */
INLINE void pair_forces(const struct sph_pair_constants *k, const struct pair_member me[GROUP], const vec *its,
                        const REAL *in, size_t stride, const uint32_t *slot, const bool corrected,
                        const bool artificial, struct pair_batch p[GROUP]) {
  if (!k->strength && !corrected) {
    FOR_MEMBERS(m)
      pair_pressure(k, &me[m], its, &p[m]);
    return;
  }
  const size_t turned = (artificial ? PAIR_TURNED_TOO : PAIR_TURNED) - PAIR_NARROW;
  vec more[PAIR_WIDE - PAIR_NARROW];
  UNROLL
  for (size_t column = 0; column < PAIR_WIDE - PAIR_NARROW; column += LANES)
    if ((artificial && column < 6) || (corrected && column + LANES > turned && column < turned + 3))
      record_fetch(in, stride, PAIR_NARROW + column, slot, more + column);
  FOR_MEMBERS(m)
    pair_stress(k, &me[m], its, more, corrected, artificial, &p[m]);
}

/* Sums one batch; `left` neighbours are left in the list. Returns the pairs within the support so far, by lane. */
INLINE vec pair_sum_batch(const struct sph_pair_constants *k, const REAL *in, size_t in_stride, REAL *out,
                          size_t out_stride, const uint32_t *slot, INT left, const bool whole, vec within,
                          const bool corrected, const bool artificial, struct pair_member me[GROUP]) {
  const vec zero = {0};
  struct pair_batch p[GROUP];
  vec its[PAIR_NARROW], gain[PAIR_WIDE];
  UNROLL
  for (size_t column = 0; column < PAIR_NARROW; column += LANES)
    record_fetch(in, in_stride, column, slot, its + column);

  FOR_MEMBERS(m)
    pair_distance(k, &me[m], its, left, m > 0, m == 0 || whole, &p[m]);
  vec its_volume = its[PAIR_MASS];
  if (k->volume_weights) {
    const vec per_its = vec_inverse(its[PAIR_DENSITY]);
    FOR_MEMBERS(m)
      p[m].per_densities = me[m].per_density * per_its;
    its_volume = its[PAIR_MASS] * per_its;
  }
  FOR_MEMBERS(m)
    pair_slope(k, &me[m], its_volume, &p[m]);
  FOR_MEMBERS(m)
    pair_viscosity(k, &me[m], its, &p[m]);
  pair_forces(k, me, its, in, in_stride, slot, corrected, artificial, p);

  FOR_MEMBERS(m) {
    const vec mass = zero + me[m].record[PAIR_MASS], volume = k->volume_weights ? mass * me[m].per_density : mass;
    const vec signal = vec_keep_max(p[m].near, p[m].mu, zero + LEAST_SIGNAL);
    vec cooling = p[m].viscous * p[m].slope * p[m].closing; /* twice */
    if (artificial)
      cooling -= p[m].work;
    within = vec_add_where(within, p[m].near, zero + 1);
    pair_add(&p[m], its[PAIR_MASS], its_volume, cooling, signal, true, false, corrected, me[m].sum);
    pair_add(&p[m], mass, volume, cooling, signal, false, m == 0, corrected, gain);
  }
  if (corrected)
    record_spread_four(out, out_stride, PAIR_NARROW, slot, gain + PAIR_NARROW);
  else
    gain[SUM_MOMENT] = gain[SUM_MOMENT + 1] = zero;
  UNROLL
  for (size_t column = 0; column < PAIR_NARROW; column += LANES)
    record_spread(out, out_stride, column, slot, gain + column);
  return within;
}

/* Sums a chunk. Returns the number of pairs within the support. */
INLINE double sum_pairs(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *constants, const REAL *in,
                        REAL *out, const bool corrected, const bool artificial) {
  const struct sph_pair_constants k = *constants;
  const size_t in_stride = sph_pair_columns(SINGLE, artificial, corrected);
  const size_t out_stride = sph_pair_columns(SINGLE, false, corrected);
  const uint32_t *end = chunk->neighbour + chunk->start[(chunk->own + GROUP - 1) / GROUP];
  vec within = {0};
  for (size_t i = 0; i < chunk->own; i += GROUP) {
    const bool whole = i + GROUP <= chunk->own;
    const uint32_t *slot = chunk->neighbour + chunk->start[i / GROUP];
    const INT total = (INT)chunk->count[i / GROUP];
    struct pair_member me[GROUP];
    FOR_MEMBERS(m)
      pair_begin(&k, in + (i + (size_t)m < chunk->own ? i + (size_t)m : i) * in_stride, &me[m]);
    for (INT done = 0; done < total; done += LANES, slot += LANES) {
      if (SINGLE) { /* 1 to 2 % of a large run; nothing in double */
        const uint32_t *next = slot + LANES < end ? slot + LANES : slot; /* lists follow each other */
        UNROLL
        for (int lane = 0; lane < LANES; lane++)
          __builtin_prefetch(out + next[lane] * out_stride, 1);
      }
      within = pair_sum_batch(&k, in, in_stride, out, out_stride, slot, total - done, whole, within, corrected,
                              artificial, me);
    }
    FOR_MEMBERS(m) {
      if (m == 0 || whole)
        pair_end(&me[m], corrected, out + (i + (size_t)m) * out_stride);
    }
  }
  double pairs = 0;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pairs += (double)within[lane];
  return pairs;
}

/* As struct sph_record_kernels calls them. */
static double sum_pairs_plain(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                              void *out) {
  return sum_pairs(c, k, in, out, false, false);
}
static double sum_pairs_artificial(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                                   void *out) {
  return sum_pairs(c, k, in, out, false, true);
}
static double sum_pairs_corrected(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                                  void *out) {
  return sum_pairs(c, k, in, out, true, false);
}
static double sum_pairs_both(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                             void *out) {
  return sum_pairs(c, k, in, out, true, true);
}
