/* Records in memory and registers (vector.h), in one precision. Going to registers, LANES records of a few columns
 * become that many registers, one per column, with one record in each lane; going back, the sums in the lanes of a
 * register are added to LANES records, or to one. */

#define record_fetch       TYPED(record_fetch)
#define record_add         TYPED(record_add)
#define record_largest     TYPED(record_largest)
#define record_spread      TYPED(record_spread)
#define record_spread_four TYPED(record_spread_four)
#define record_collect     TYPED(record_collect)

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
