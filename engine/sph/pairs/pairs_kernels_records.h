/* Records in memory and registers (vector.h), and columns to records and back, in one precision. Going to registers,
 * LANES records of a few columns become that many registers, one per column, with one record in each lane; going back,
 * the sums in the lanes of a register are added to LANES records, or to one. */

#define record_fetch       TYPED(record_fetch)
#define record_add         TYPED(record_add)
#define record_largest     TYPED(record_largest)
#define record_spread      TYPED(record_spread)
#define record_spread_four TYPED(record_spread_four)
#define record_collect     TYPED(record_collect)
#define pack_columns       TYPED(pack_columns)
#define unpack_columns     TYPED(unpack_columns)
#define pack_records       TYPED(pack_records)
#define unpack_records     TYPED(unpack_records)

/* r[k] = column `column` + k of the LANES records at `slot`. */
INLINE void record_fetch(const REAL *in, size_t stride, size_t column, const uint32_t *slot, vec r[LANES]) {
#ifdef __AVX512F__
  /* A register is loaded with halves of two records: this leaves less work to the one unit that shuffles. */
  UNROLL
  for (int first = 0; first < LANES; first += LANES / 2) {
    vec rows[LANES / 2], u[LANES / 2];
    UNROLL
    for (int m = 0; m < LANES / 2; m++) {
      const uint32_t *pair = slot + m % QUARTER + m / QUARTER * 2 * QUARTER;
      const __m256d low = _mm256_load_pd((const void *)(in + pair[0] * stride + column + first));
      const __m256d high = _mm256_load_pd((const void *)(in + pair[QUARTER] * stride + column + first));
      rows[m] = (vec)_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
    }
    vec_turn(rows, u);
    vec_turn(rows + QUARTER, u + QUARTER);
    UNROLL
    for (int c = 0; c < QUARTER; c++) {
      r[first + c] = vec_even_parts(u[c], u[QUARTER + c]);
      r[first + QUARTER + c] = vec_odd_parts(u[c], u[QUARTER + c]);
    }
  }
#else
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    r[lane] = vec_load(in + slot[lane] * stride + column);
  vec_transpose(r);
#endif
}

/* a + b, but the larger of the two in the lanes whose bits are set in `largest`. */
INLINE vec record_add(vec a, vec b, unsigned largest) {
  return largest ? vec_max_in(largest, a, b, a + b) : a + b;
}

/* The bit of SUM_SIGNAL among LANES columns from `column` on: records keep the largest signal, not the sum. */
INLINE unsigned record_largest(size_t column) {
  return column <= SUM_SIGNAL && SUM_SIGNAL < column + LANES ? 1U << (SUM_SIGNAL - column) : 0;
}

/* Adds to the LANES records at `slot`: r[k] goes to column `column` + k. */
INLINE void record_spread(REAL *out, size_t stride, size_t column, const uint32_t *slot, vec r[LANES]) {
  vec_transpose(r);
  UNROLL
  for (int lane = 0; lane < LANES; lane++) {
    REAL *to = out + slot[lane] * stride + column;
    vec_store(to, record_add(vec_load(to), r[lane], record_largest(column)));
  }
}

/* The same for four columns, none of them the signal. */
INLINE void record_spread_four(REAL *out, size_t stride, size_t column, const uint32_t *slot, vec r[4]) {
#if WIDTH / REAL_BYTES <= 4
  UNROLL
  for (size_t done = 0; done < 4; done += LANES)
    record_spread(out, stride, column + done, slot, r + done);
#else
  vec u[4], row[4];
  UNROLL
  for (int g = 0; g < 4; g += QUARTER)
    vec_turn(r + g, u + g);
#if SINGLE /* quarter q of u[c] holds record q QUARTER + c */
  UNROLL
  for (int k = 0; k < 4; k++)
    row[k] = u[k];
#else      /* a quarter holds half of a record */
  row[0] = vec_low_parts(u[0], u[2]);
  row[1] = vec_low_parts(u[1], u[3]);
  row[2] = vec_high_parts(u[0], u[2]);
  row[3] = vec_high_parts(u[1], u[3]);
#endif
  typedef REAL four __attribute__((vector_size(4 * sizeof(REAL))));
  UNROLL
  for (int part = 0; part < LANES / 4; part++) {
    UNROLL
    for (int c = 0; c < 4; c++) {
      const int lane = SINGLE ? part * QUARTER + c : c / 2 * 4 + part * 2 + c % 2;
      union {
        vec all;
        four of[LANES / 4];
      } its = {row[c]};
      four *to = (four *)(void *)(out + slot[lane] * stride + column);
      *to += its.of[part];
    }
  }
#endif
}

/* Adds to one record: all lanes of r[k] go to column `column` + k. This is the transposition's tree, but at each of its
 * nodes two registers are added to one. The signal, of which the largest is kept, stands in an odd column. */
INLINE void record_collect(REAL *out, size_t column, vec r[LANES]) {
  enum { SIGNAL_PART = SUM_SIGNAL % LANES / QUARTER, PLACE = SUM_SIGNAL % QUARTER };
  const bool has = record_largest(column) != 0;
  vec u[QUARTERS];
  UNROLL
  for (int g = 0; g < QUARTERS; g++) {
    const bool here = has && g == SIGNAL_PART;
    vec *p = r + g * QUARTER;
#if SINGLE
    const vec low = vec_low_numbers(p[0], p[1]), high = vec_high_numbers(p[0], p[1]);
    const vec a = record_add(low, high, here ? 0xaaaaU : 0);
    const vec b = vec_low_numbers(p[2], p[3]) + vec_high_numbers(p[2], p[3]);
    u[g] = record_add(vec_low_halves(a, b), vec_high_halves(a, b), here ? 0x1111U << PLACE : 0);
#else
    u[g] = record_add(vec_low_halves(p[0], p[1]), vec_high_halves(p[0], p[1]), here ? 0xaaU : 0);
#endif
  }
#if QUARTERS == 4 /* u[0] and u[1], u[2] and u[3]: the signal's quarters then lie side by side */
  const unsigned lanes = ((1U << PLACE) + (1U << (QUARTER + PLACE))) << SIGNAL_PART % 2 * LANES / 2;
  u[0] = record_add(vec_even_parts(u[0], u[1]), vec_odd_parts(u[0], u[1]), has && SIGNAL_PART < 2 ? lanes : 0);
  u[1] = record_add(vec_even_parts(u[2], u[3]), vec_odd_parts(u[2], u[3]), has && SIGNAL_PART >= 2 ? lanes : 0);
#endif
#if QUARTERS > 1
  u[0] = record_add(vec_even_parts(u[0], u[1]), vec_odd_parts(u[0], u[1]), record_largest(column));
#endif
  vec_store(out + column, record_add(vec_load(out + column), u[0], record_largest(column)));
}

/* ---- columns ----
 *
 * Columns become records before a chunk is summed, and records of sums become columns after it. LANES particles at a
 * time are transposed in a block; columns are of double, so the block is filled by AT_ONCE particles, as many as a
 * register of doubles holds. */

/* Positions as float records hold them: in units of 1/per_unit, rounded towards zero, modulo 2^32. */
INLINE vec_part column_position(vec_double x, double per_unit) {
  vec_part to = {0};
#if SINGLE
  int32_t at[AT_ONCE];
  for (size_t lane = 0; lane < AT_ONCE; lane++) {
    const double t = x[lane] * per_unit;
    const int64_t whole = t > -9e18 && t < 9e18 ? (int64_t)t : 0; /* any value does for NaN: the step fails elsewhere */
    at[lane] = (int32_t)(uint32_t)(uint64_t)whole;
  }
  memcpy(&to, at, sizeof at);
#else
  (void)x, (void)per_unit;
#endif
  return to;
}

INLINE void column_store(REAL block[PAIR_MOST][LANES], size_t column, size_t part, vec_double v) {
  *(vec_part *)(void *)(block[column] + part) = __builtin_convertvector(v, vec_part);
}

/* Fills the rows of a block (one per column of the records) with AT_ONCE particles, from lane `part` on. */
INLINE void pack_columns(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t part,
                         REAL block[PAIR_MOST][LANES]) {
  vec_double its[PAIR_BASE];
  UNROLL
  for (size_t c = 0; c < PAIR_BASE; c++)
    its[c] = column_load(source->column[c], source->scale[c], first, which);

  const vec_double pressure = column_load(source->pressure, source->scale[PAIR_XX], first, which);
  const vec_double factor = column_load(source->stress_factor, 1, first, which);
  const vec_double square = its[PAIR_DENSITY] * its[PAIR_DENSITY];
  UNROLL
  for (size_t c = PAIR_XX; c < PAIR_ZZ; c++)
    its[c] *= factor;
  its[PAIR_ZZ] = -(its[PAIR_XX] + its[PAIR_YY]);
  its[PAIR_XX] += pressure;
  its[PAIR_YY] += pressure;
  its[PAIR_ZZ] += pressure;
  UNROLL
  for (size_t c = 0; c < 6; c++)
    if (source->volume_weights)
      its[PAIR_XX + c] *= square; /* sigma, not sigma/rho^2 */

#define PAIR_PACK(term)                                                                                                \
  if (source->shape.term) {                                                                                            \
    vec_double own[PAIR_RECORD_##term];                                                                                \
    const size_t at = sph_pair_shape_first(source->shape, PAIR_TERM_##term);                                           \
    TYPED(term##_pack)(source, first, which, its, own);                                                                \
    UNROLL                                                                                                             \
    for (size_t c = 0; c < PAIR_RECORD_##term; c++)                                                                    \
      column_store(block, at + c, part, own[c]);                                                                       \
  }
#include "engine/sph/modules/declarations.h"

  UNROLL
  for (size_t c = 0; c < PAIR_BASE; c++) {
    if (SINGLE && c <= PAIR_Z)
      *(vec_part *)(void *)(block[c] + part) = column_position(its[c], source->per_unit[c]);
    else
      column_store(block, c, part, its[c]);
  }
}

static void pack_records(const struct sph_pair_source *source, size_t first, const uint32_t *which, size_t count,
                         size_t stride, void *records) {
  REAL block[PAIR_MOST][LANES] __attribute__((aligned(64)));
  memset(block, 0, sizeof block); /* not all columns are used */
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    const uint32_t *at = which ? which + k : NULL;
    uint32_t last[LANES];
    if (left < LANES) { /* fill up with the last particle */
      for (size_t lane = 0; lane < LANES; lane++) {
        const size_t m = lane < left ? k + lane : count - 1;
        last[lane] = which ? which[m] : (uint32_t)(first + m);
      }
      at = last;
    }
    for (size_t part = 0; part < LANES; part += AT_ONCE)
      pack_columns(source, first + k + part, at ? at + part : NULL, part, block);

    REAL *to = (REAL *)records + k * stride;
    for (size_t c = 0; c < stride; c += LANES) {
      vec r[LANES];
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        r[m] = vec_load(block[c + m]);
      vec_transpose(r);
      for (size_t lane = 0; lane < left; lane++)
        vec_store(to + lane * stride + c, r[lane]);
    }
  }
}

/* The sums of AT_ONCE particles, of which the first `lanes` exist, out of the block's lanes from `part` on. A column is
 * written in whole cache lines, so that few stores wait for memory. */
INLINE void unpack_columns(const struct sph_pair_sink *sink, size_t first, const size_t lanes,
                           REAL block[SUM_MOST][LANES], size_t part) {
  const vec_double zero = {0}, one = zero + 1;
  vec_double weight = one, per_mass = one;
  if (SINGLE || !sink->volume_weights) {
    vec_double density = one;
    memcpy(&density, sink->density + first, lanes * sizeof(double));
    weight = sink->volume_weights ? density / sink->density_unit : sink->density_unit / density;
  }
  if (sink->geometric_weights)
    weight = one;
  if (SINGLE) {
    memcpy(&per_mass, sink->mass + first, lanes * sizeof(double));
    per_mass = sink->mass_unit / per_mass;
    weight *= per_mass;
  }
  UNROLL
  for (size_t c = 0; c < SUM_ALL; c++) {
    if (c >= SUM_BASE && c >= sink->columns)
      break;
    vec_double v = __builtin_convertvector(*(const vec_part *)(const void *)(block[c] + part), vec_double);
    const vec_double own = v;
    if ((c >= SUM_GRADIENT && c < SUM_HEATING) || c >= SUM_BASE)
      v *= weight;
    else if (SINGLE && c != SUM_SIGNAL)
      v *= per_mass;
    v *= sink->scale[c];
    if (c == SUM_SIGNAL)
      v = vec_select_double(vec_less_double(zero, own),
                            vec_keep_double(vec_less_double(zero + (double)LEAST_SIGNAL, own), v), -one);
    memcpy(sink->column[c] + first, &v, lanes * sizeof(double));
  }
}

static void unpack_records(const struct sph_pair_sink *sink, size_t first, size_t count, size_t stride,
                           const void *in) {
  const REAL *records = in;
  const size_t columns = sink->columns;
  for (size_t k = 0; k < count; k += LANES) {
    const size_t left = count - k < LANES ? count - k : LANES;
    REAL block[SUM_MOST][LANES] __attribute__((aligned(64)));
    for (size_t c = 0; c < columns; c += LANES) {
      vec r[LANES];
      UNROLL
      for (size_t lane = 0; lane < LANES; lane++)
        r[lane] = vec_load(records + (k + (lane < left ? lane : 0)) * stride + c);
      vec_transpose(r);
      UNROLL
      for (size_t m = 0; m < LANES; m++)
        vec_store(block[c + m], r[m]);
    }
    for (size_t part = 0; part < left; part += AT_ONCE) {
      if (left - part >= AT_ONCE)
        unpack_columns(sink, first + k + part, AT_ONCE, block, part);
      else
        unpack_columns(sink, first + k + part, left - part, block, part);
    }
  }
}
