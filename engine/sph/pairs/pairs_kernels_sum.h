/* The pair loop in one precision: all sums of the particles of a chunk, among each other and with the foreign particles
 * in their lists (pairs.h has the equations). Particles are summed in groups of GROUP that share a list, the neighbours
 * in batches of LANES. A pair is visited once: the member's sums stay in registers until its list ends, the neighbours'
 * sums are added to their records batch by batch.
 *
 * A batch goes through these phases, each for all members of the group before the next one, so that the members' chains
 * of dependent instructions overlap: distance, slope, viscosity, stress or pressure, sums. Every
 * phase is inlined into sum_pairs, which is compiled for each combination of terms.
 *
 * In float a pair's weights (mass times mass, or volume times volume) are factors of the kernel's slope, so that both
 * partners get the same number; unpack_records divides by the particle's own mass. In double each partner's sums are
 * multiplied by the other's weight here: WEIGHTED. */

#define pair_along             TYPED(pair_along)
#define pair_begin             TYPED(pair_begin)
#define pair_distance          TYPED(pair_distance)
#define pair_slope             TYPED(pair_slope)
#define pair_motion            TYPED(pair_motion)
#define pair_stress            TYPED(pair_stress)
#define pair_pressure          TYPED(pair_pressure)
#define pair_add               TYPED(pair_add)
#define pair_end               TYPED(pair_end)
#define pair_columns_used      TYPED(pair_columns_used)
#define pair_sums_in_registers TYPED(pair_sums_in_registers)
#define pair_forces            TYPED(pair_forces)
#define pair_sum_batch         TYPED(pair_sum_batch)
#define sum_pairs              TYPED(sum_pairs)
#define record_kernels         TYPED(record_kernels)

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

/* The number of sums of a member, in whole registers. */
INLINE size_t pair_sums_in_registers(const struct sph_pair_shape shape) {
  const size_t sums = sph_pair_shape_sums(shape, PAIR_TERMS);
  return sums < SUM_SPREAD ? SUM_SPREAD : (sums + LANES - 1) / LANES * LANES;
}

INLINE void pair_begin(const struct sph_pair_constants *k, const REAL *record, const size_t sums,
                       struct pair_member *me) {
  me->record = record;
  me->per_density = k->volume_weights ? 1 / record[PAIR_DENSITY] : 0;
  me->weight = (REAL)k->norm * record[PAIR_MASS] * (k->volume_weights ? me->per_density : 1);
  UNROLL
  for (size_t column = 0; column < sums; column++)
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

/* The spline's slope (pairs.h) over r, and its gradient. */
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

/* How fast the partners approach, and Pi. */
INLINE void pair_motion(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                        struct pair_batch *p) {
  const vec zero = {0};
  FOR_AXES(a)
    p->u[a] = me->record[PAIR_VX + a] - its[PAIR_VX + a];
  p->closing = pair_dot(p->u, p->d);
  const vec approach = vec_max(p->closing, zero);
  const vec mu_per = SINGLE ? approach * p->per_softened : p->h * approach * p->per_softened;
  p->mu = mu_per * p->densities;
  TYPED(viscosity_pair)(k, me, its, mu_per, p->mu, p);
  p->share[0] = p->share[1] = zero + 1;
}

/* The force of the whole stress. `more`: the neighbours' columns of terms. */
INLINE void pair_stress(const struct sph_pair_constants *k, const struct pair_member *me, const vec *its,
                        const vec *more, const struct sph_pair_shape shape, struct pair_batch *p) {
  vec t[3][3];
  FOR_AXES(a) {
    FOR_AXES(b)
      t[a][b] = p->share[0] * me->record[PAIR_XX + SYMMETRIC(a, b)] + p->share[1] * its[PAIR_XX + SYMMETRIC(a, b)];
  }
#define PART(term) const size_t at = sph_pair_shape_first(shape, PAIR_TERM_##term)
#define PAIR_STRESS(term)                                                                                              \
  if (shape.term) {                                                                                                    \
    PART(term);                                                                                                        \
    TYPED(term##_stress)(k, me, me->record + at, more + (at - PAIR_BASE), p, t);                                       \
  }
#include "engine/sph/modules/declarations.h"
#define PAIR_STRESS_ADDED(term)                                                                                        \
  if (shape.term) {                                                                                                    \
    PART(term);                                                                                                        \
    p->work[PAIR_TERM_##term] = TYPED(term##_stress_added)(k, me, me->record + at, more + (at - PAIR_BASE), p, t);     \
  }
#include "engine/sph/modules/declarations.h"
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
#define PAIR_STRESS_ADDED(term) p->work[PAIR_TERM_##term] = (vec){0};
#include "engine/sph/modules/declarations.h"
}

/* Adds what one partner gets from the other, whose mass and volume (mass, without volume weights) are given, to `sum`:
 * the member's (`own`) or the neighbours', which begin with the first member's part (`first`). */
INLINE void pair_add(const struct pair_batch *p, vec mass, vec volume, vec cooling, vec signal, const bool own,
                     const bool first, const struct sph_pair_shape shape, vec *sum) {
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
    w[a] = WEIGHTED(volume, p->w[a]) * p->share[own ? 0 : 1];
  FOR_AXES(a) {
    FOR_AXES(b)
      ADD(SUM_GRADIENT + 3 * a + b, p->u[a] * w[b]);
  }
#define PAIR_SUMMED(term)                                                                                              \
  if (shape.term)                                                                                                      \
    TYPED(term##_sum)(p, w, first, sum + sph_pair_shape_sums(shape, PAIR_TERM_##term));
#include "engine/sph/modules/declarations.h"
#undef ADD
}

/* Adds the lanes of the member's sums to its record. */
INLINE void pair_end(struct pair_member *me, const struct sph_pair_shape shape, REAL *record) {
  UNROLL
  for (size_t column = 0; column < pair_sums_in_registers(shape); column += LANES)
    record_collect(record, column, me->sum + column);
}

/* Do these columns of a record, LANES from `column` on, belong to terms that are on? */
INLINE bool pair_columns_used(const struct sph_pair_shape shape, size_t column) {
  bool used = false;
#define PAIR_RECORD(term, count)                                                                                       \
  if (shape.term) {                                                                                                    \
    PART(term);                                                                                                        \
    used = used || (at < column + LANES && at + (count) > column);                                                     \
  }
#include "engine/sph/modules/declarations.h"
  return used;
}

/* The forces of a batch: of the whole stress, or of the pressure alone; then those of terms. */
INLINE void pair_forces(const struct sph_pair_constants *k, const struct pair_member me[GROUP], const vec *its,
                        const REAL *in, size_t stride, const uint32_t *slot, const struct sph_pair_shape shape,
                        struct pair_batch p[GROUP]) {
  vec more[PAIR_MOST - PAIR_BASE];
  bool whole = k->strength;
#define PAIR_STRESS(term) whole = whole || shape.term;
#include "engine/sph/modules/declarations.h"
  UNROLL
  for (size_t column = PAIR_BASE; column < PAIR_MOST; column += LANES)
    if (pair_columns_used(shape, column))
      record_fetch(in, stride, column, slot, more + (column - PAIR_BASE));
#define PAIR_BEFORE(term)                                                                                              \
  if (shape.term) {                                                                                                    \
    PART(term);                                                                                                        \
    FOR_MEMBERS(m)                                                                                                     \
      TYPED(term##_before)(k, &me[m], its, me[m].record + at, more + (at - PAIR_BASE), &p[m]);                         \
  }
#include "engine/sph/modules/declarations.h"
  if (whole) {
    FOR_MEMBERS(m)
      pair_stress(k, &me[m], its, more, shape, &p[m]);
  } else {
    FOR_MEMBERS(m)
      pair_pressure(k, &me[m], its, &p[m]);
  }
#define PAIR_FORCE(term)                                                                                               \
  if (shape.term) {                                                                                                    \
    PART(term);                                                                                                        \
    FOR_MEMBERS(m)                                                                                                     \
      p[m].work[PAIR_TERM_##term] = TYPED(term##_force)(k, &me[m], its, me[m].record + at, more + (at - PAIR_BASE),    \
                                                        &p[m]);                                                        \
  }
#include "engine/sph/modules/declarations.h"
}

/* Sums one batch; `left` neighbours are left in the list. Returns the pairs within the support so far, by lane. */
INLINE vec pair_sum_batch(const struct sph_pair_constants *k, const REAL *in, size_t in_stride, REAL *out,
                          size_t out_stride, const uint32_t *slot, INT left, const bool whole, vec within,
                          const struct sph_pair_shape shape, struct pair_member me[GROUP]) {
  const vec zero = {0};
  const size_t sums = sph_pair_shape_sums(shape, PAIR_TERMS),
               spread = sums < SUM_SPREAD ? SUM_SPREAD : PAIR_ALIGNED(sums);
  struct pair_batch p[GROUP];
  vec its[PAIR_BASE], gain[SUM_MOST];
  UNROLL
  for (size_t column = 0; column < PAIR_BASE; column += LANES)
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
    pair_motion(k, &me[m], its, &p[m]);
  pair_forces(k, me, its, in, in_stride, slot, shape, p);

  FOR_MEMBERS(m) {
    const vec mass = zero + me[m].record[PAIR_MASS], volume = k->volume_weights ? mass * me[m].per_density : mass;
    const vec signal = vec_keep_max(p[m].near, p[m].mu, zero + LEAST_SIGNAL);
    vec cooling = p[m].viscous * p[m].slope * p[m].closing; /* twice */
#define PAIR_STRESS_ADDED(term)                                                                                        \
  if (shape.term)                                                                                                      \
    cooling -= p[m].work[PAIR_TERM_##term];
#define PAIR_FORCE(term) PAIR_STRESS_ADDED(term)
#include "engine/sph/modules/declarations.h"
    within = vec_add_where(within, p[m].near, zero + 1);
    pair_add(&p[m], its[PAIR_MASS], its_volume, cooling, signal, true, false, shape, me[m].sum);
    pair_add(&p[m], mass, volume, cooling, signal, false, m == 0, shape, gain);
  }
  UNROLL
  for (size_t column = sums; column < spread; column++)
    gain[column] = zero;
  UNROLL
  for (size_t column = SUM_SPREAD; column < spread; column += 4)
    record_spread_four(out, out_stride, column, slot, gain + column);
  UNROLL
  for (size_t column = 0; column < SUM_SPREAD; column += LANES)
    record_spread(out, out_stride, column, slot, gain + column);
  return within;
}

/* Sums a chunk. Returns the number of pairs within the support. */
INLINE double sum_pairs(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *constants, const REAL *in,
                        REAL *out, const struct sph_pair_shape shape) {
  const struct sph_pair_constants k = *constants;
  const size_t in_stride = sph_pair_shape_stride(sph_pair_shape_columns(shape, PAIR_TERMS), REAL_BYTES);
  const size_t out_stride = sph_pair_shape_stride(sph_pair_shape_sums(shape, PAIR_TERMS), REAL_BYTES);
  const uint32_t *end = chunk->neighbour + chunk->start[(chunk->own + GROUP - 1) / GROUP];
  vec within = {0};
  for (size_t i = 0; i < chunk->own; i += GROUP) {
    const bool whole = i + GROUP <= chunk->own;
    const uint32_t *slot = chunk->neighbour + chunk->start[i / GROUP];
    const INT total = (INT)chunk->count[i / GROUP];
    struct pair_member me[GROUP];
    FOR_MEMBERS(m)
      pair_begin(&k, in + (i + (size_t)m < chunk->own ? i + (size_t)m : i) * in_stride, pair_sums_in_registers(shape),
                 &me[m]);
    for (INT done = 0; done < total; done += LANES, slot += LANES) {
      if (SINGLE) { /* 1 to 2 % of a large run; nothing in double */
        const uint32_t *next = slot + LANES < end ? slot + LANES : slot; /* lists follow each other */
        UNROLL
        for (int lane = 0; lane < LANES; lane++)
          __builtin_prefetch(out + next[lane] * out_stride, 1);
      }
      within = pair_sum_batch(&k, in, in_stride, out, out_stride, slot, total - done, whole, within, shape, me);
    }
    FOR_MEMBERS(m) {
      if (m == 0 || whole)
        pair_end(&me[m], shape, out + (i + (size_t)m) * out_stride);
    }
  }
  double pairs = 0;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pairs += (double)within[lane];
  return pairs;
}

/* One for each combination of terms, as struct sph_record_kernels calls them. */
#define COMBINATION(name, ...)                                                                                         \
  static double TYPED(sum_pairs_##name)(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *k,        \
                                        const void *in, void *out) {                                                   \
    return sum_pairs(chunk, k, in, out, (struct sph_pair_shape){__VA_ARGS__});                                         \
  }
SPH_PAIR_COMBINATIONS(COMBINATION)
#undef COMBINATION
#undef PART

static const struct sph_record_kernels record_kernels = {
    .bytes = sizeof(REAL),
#define COMBINATION(name, ...) [PAIR_SHAPE_##name] = TYPED(sum_pairs_##name),
    .sum = {SPH_PAIR_COMBINATIONS(COMBINATION)},
#undef COMBINATION
    .pack = pack_records,
    .unpack = unpack_records,
};
