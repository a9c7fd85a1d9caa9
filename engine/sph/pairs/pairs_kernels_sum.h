/* One precision of the pair loop. The including file has set REAL, INT (signed, of REAL's size), LANES, NAME(x) and
 * FIXED (positions are integers), and the class's ROOT, INVERSE. */

typedef REAL NAME(vector) __attribute__((vector_size(LANES * sizeof(REAL))));
typedef INT NAME(mask) __attribute__((vector_size(LANES * sizeof(REAL))));
#define VECTOR NAME(vector)
#define MASK   NAME(mask)

#define UNROLL _Pragma("GCC unroll 32")
#if LANES == 2 && !FIXED
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 2)
#define SECOND(a, b) __builtin_shufflevector(a, b, 1, 3)
#elif LANES == 4 && !FIXED
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define SECOND(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define EVEN(a, b)   __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define ODD(a, b)    __builtin_shufflevector(a, b, 2, 3, 6, 7)
#elif LANES == 8 && !FIXED
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)
#define SECOND(a, b) __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)
#define EVEN(a, b)   __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13)
#define ODD(a, b)    __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15)
#define LEFT(a, b)   __builtin_shufflevector(a, b, 0, 1, 8, 9, 2, 3, 10, 11)
#define RIGHT(a, b)  __builtin_shufflevector(a, b, 4, 5, 12, 13, 6, 7, 14, 15)
#elif LANES == 4
#define LOW(a, b)    __builtin_shufflevector(a, b, 0, 4, 1, 5)
#define HIGH(a, b)   __builtin_shufflevector(a, b, 2, 6, 3, 7)
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define SECOND(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#elif LANES == 8
#define LOW(a, b)    __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13)
#define HIGH(a, b)   __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15)
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define SECOND(a, b) __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#define EVEN(a, b)   __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)
#define ODD(a, b)    __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15)
#else
#define LOW(a, b)    __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define HIGH(a, b)   __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define FIRST(a, b)  __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define SECOND(a, b) __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
#define EVEN(a, b)   __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
#define ODD(a, b)    __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)
#endif

enum {
  NAME(PART) = 16 / sizeof(REAL),
  NAME(PARTS) = LANES / NAME(PART)
}; /* numbers in a quarter of 16 bytes, quarters */
#define PART  NAME(PART)
#define PARTS NAME(PARTS)

/* Rows become columns within the quarters of PART registers. All shuffles have two sources and another destination. */
INLINE void NAME(turn_quarters)(const VECTOR r[PART], VECTOR u[PART]) {
#if FIXED
  const VECTOR a = LOW(r[0], r[1]), b = HIGH(r[0], r[1]), c = LOW(r[2], r[3]), d = HIGH(r[2], r[3]);
  u[0] = FIRST(a, c), u[1] = SECOND(a, c), u[2] = FIRST(b, d), u[3] = SECOND(b, d);
#else
  u[0] = FIRST(r[0], r[1]), u[1] = SECOND(r[0], r[1]);
#endif
}

/* Rows become columns: first within the quarters, then the quarters among registers. */
INLINE void NAME(transpose)(VECTOR r[LANES]) {
  VECTOR u[LANES];
  UNROLL
  for (int g = 0; g < LANES; g += PART)
    NAME(turn_quarters)(r + g, u + g);
#ifdef EVEN
  UNROLL
  for (int c = 0; c < PART; c++) {
    if (PARTS == 2) {
      r[c] = EVEN(u[c], u[PART + c]), r[PART + c] = ODD(u[c], u[PART + c]);
    } else {
      const VECTOR a = EVEN(u[c], u[PART + c]), b = EVEN(u[2 * PART + c], u[3 * PART + c]);
      const VECTOR d = ODD(u[c], u[PART + c]), e = ODD(u[2 * PART + c], u[3 * PART + c]);
      r[c] = EVEN(a, b), r[2 * PART + c] = ODD(a, b), r[PART + c] = EVEN(d, e), r[3 * PART + c] = ODD(d, e);
    }
  }
#else
  UNROLL
  for (int k = 0; k < LANES; k++)
    r[k] = u[k];
#endif
}

/* Choices between vectors: GCC's vector extension has none in C that become single instructions of the masks of
 * AVX-512. */
#ifdef AVX512
typedef AVX512_MASK NAME(choice);
INLINE NAME(choice) NAME(less)(VECTOR a, VECTOR b) {
  return AVX512(cmp_, _mask)(a, b, _CMP_LT_OQ);
}
INLINE NAME(choice) NAME(first_lanes)(INT count) {
  return (AVX512_MASK)(count < LANES ? (1U << count) - 1 : (1U << LANES) - 1);
}
INLINE VECTOR NAME(select)(NAME(choice) choice, VECTOR yes, VECTOR no) {
  return (VECTOR)AVX512(mask_blend_, )(choice, no, yes);
}
INLINE VECTOR NAME(keep)(NAME(choice) choice, VECTOR yes) {
  return (VECTOR)AVX512(maskz_mov_, )(choice, yes);
}
INLINE VECTOR NAME(larger)(VECTOR a, VECTOR b) {
  return (VECTOR)AVX512(max_, )(a, b);
}
INLINE VECTOR NAME(keep_larger)(NAME(choice) choice, VECTOR a, VECTOR b) {
  return (VECTOR)AVX512(maskz_max_, )(choice, a, b);
}
INLINE VECTOR NAME(add_chosen)(VECTOR a, NAME(choice) choice, VECTOR b) {
  return (VECTOR)AVX512(mask_add_, )(a, choice, a, b);
}
INLINE VECTOR NAME(larger_at)(unsigned lanes, VECTOR a, VECTOR b, VECTOR elsewhere) {
  return (VECTOR)AVX512(mask_max_, )(elsewhere, (AVX512_MASK)lanes, a, b);
}
#else
typedef MASK NAME(choice);
INLINE MASK NAME(less)(VECTOR a, VECTOR b) {
  return a < b;
}
INLINE MASK NAME(first_lanes)(INT count) {
  MASK lanes;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    lanes[lane] = lane;
  return lanes < count;
}
INLINE VECTOR NAME(select)(MASK choice, VECTOR yes, VECTOR no) {
  return (VECTOR)((choice & (MASK)yes) | (~choice & (MASK)no));
}
INLINE VECTOR NAME(keep)(MASK choice, VECTOR yes) {
  return (VECTOR)(choice & (MASK)yes);
}
INLINE VECTOR NAME(larger)(VECTOR a, VECTOR b) {
  return NAME(select)(a > b, a, b);
}
INLINE VECTOR NAME(keep_larger)(MASK choice, VECTOR a, VECTOR b) {
  return NAME(keep)(choice, NAME(larger)(a, b));
}
INLINE VECTOR NAME(add_chosen)(VECTOR a, MASK choice, VECTOR b) {
  return a + NAME(keep)(choice, b);
}
INLINE VECTOR NAME(larger_at)(unsigned lanes, VECTOR a, VECTOR b, VECTOR elsewhere) {
  MASK pick = {0};
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pick[lane] = lanes >> lane & 1 ? -1 : 0;
  return NAME(select)(pick, NAME(larger)(a, b), elsewhere);
}
#endif

/* The block of LANES columns from `column` on, of LANES records: r[k] is column + k. */
INLINE void NAME(fetch)(const REAL *in, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
#ifdef AVX512
  /* halves of two records are loaded into a register, which leaves less to the one unit that shuffles */
  UNROLL
  for (int first = 0; first < LANES; first += LANES / 2) {
    VECTOR rows[LANES / 2], u[LANES / 2];
    UNROLL
    for (int m = 0; m < LANES / 2; m++) {
      const uint32_t *pair = slot + m % PART + m / PART * 2 * PART;
      const __m256d low = _mm256_load_pd((const void *)(in + pair[0] * stride + column + first));
      rows[m] = (VECTOR)_mm512_insertf64x4(_mm512_castpd256_pd512(low),
                                           _mm256_load_pd((const void *)(in + pair[PART] * stride + column + first)),
                                           1);
    }
    NAME(turn_quarters)(rows, u);
    NAME(turn_quarters)(rows + PART, u + PART);
    UNROLL
    for (int c = 0; c < PART; c++)
      r[first + c] = EVEN(u[c], u[PART + c]), r[first + PART + c] = ODD(u[c], u[PART + c]);
  }
#else
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    r[lane] = *(const VECTOR *)(const void *)(in + slot[lane] * stride + column);
  NAME(transpose)(r);
#endif
}

/* a + b, but the larger of both in the given lanes. */
INLINE VECTOR NAME(add)(VECTOR a, VECTOR b, unsigned largest) {
  return largest ? NAME(larger_at)(largest, a, b, a + b) : a + b;
}

/* The lane of LANES columns from `column` on where the largest value is wanted and not the sum. */
INLINE unsigned NAME(largest)(size_t column) {
  return column <= SUM_SIGNAL && SUM_SIGNAL < column + LANES ? 1U << (SUM_SIGNAL - column) : 0;
}

/* r[k] is column + k of what LANES records get. */
INLINE void NAME(spread)(REAL *out, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
  NAME(transpose)(r);
  UNROLL
  for (int lane = 0; lane < LANES; lane++) {
    VECTOR *to = (VECTOR *)(void *)(out + slot[lane] * stride + column);
    *to = NAME(add)(*to, r[lane], NAME(largest)(column));
  }
}

/* Likewise of four columns only, among which the signal is not. */
INLINE void NAME(spread_four)(REAL *out, size_t stride, size_t column, const uint32_t *slot, VECTOR r[4]) {
#if LANES <= 4
  UNROLL
  for (size_t done = 0; done < 4; done += LANES)
    NAME(spread)(out, stride, column + done, slot, r + done);
#else
  VECTOR u[4], row[4];
  UNROLL
  for (int g = 0; g < 4; g += PART)
    NAME(turn_quarters)(r + g, u + g);
#if FIXED /* quarter q of u[c] is record q PART + c */
  UNROLL
  for (int k = 0; k < 4; k++)
    row[k] = u[k];
#else     /* half of a record in a quarter */
  row[0] = LEFT(u[0], u[2]), row[1] = LEFT(u[1], u[3]), row[2] = RIGHT(u[0], u[2]), row[3] = RIGHT(u[1], u[3]);
#endif
  typedef REAL four __attribute__((vector_size(4 * sizeof(REAL))));
  UNROLL
  for (int part = 0; part < LANES / 4; part++) {
    UNROLL
    for (int c = 0; c < 4; c++) {
      const int lane = FIXED ? part * PART + c : c / 2 * 4 + part * 2 + c % 2;
      union {
        VECTOR all;
        four of[LANES / 4];
      } its = {row[c]};
      four *to = (four *)(void *)(out + slot[lane] * stride + column);
      *to += its.of[part];
    }
  }
#endif
}

/* r[k] is column + k of what one record gets, lane by lane: the transposition's tree, but two registers become one at
 * each of its nodes. The signal is the odd one of a pair. */
INLINE void NAME(collect)(REAL *out, size_t column, VECTOR r[LANES]) {
  enum { SIGNAL_PART = SUM_SIGNAL % LANES / PART, PLACE = SUM_SIGNAL % PART };
  const bool has = NAME(largest)(column) != 0;
  VECTOR *to = (VECTOR *)(void *)(out + column), u[PARTS];
  UNROLL
  for (int g = 0; g < PARTS; g++) {
    const bool here = has && g == SIGNAL_PART;
    VECTOR *p = r + g * PART;
#if FIXED
    const VECTOR a = NAME(add)(LOW(p[0], p[1]), HIGH(p[0], p[1]), here ? 0xaaaaU : 0),
                 b = LOW(p[2], p[3]) + HIGH(p[2], p[3]);
    u[g] = NAME(add)(FIRST(a, b), SECOND(a, b), here ? 0x1111U << PLACE : 0);
#else
    u[g] = NAME(add)(FIRST(p[0], p[1]), SECOND(p[0], p[1]), here ? 0xaaU : 0);
#endif
  }
#ifdef EVEN
  if (PARTS == 4) { /* of u[0], u[1] and of u[2], u[3]; the signal's quarters lie next to each other then */
    const unsigned lanes = ((1U << PLACE) + (1U << (PART + PLACE))) << SIGNAL_PART % 2 * LANES / 2;
    u[0] = NAME(add)(EVEN(u[0], u[1]), ODD(u[0], u[1]), has && SIGNAL_PART < 2 ? lanes : 0);
    u[1] = NAME(add)(EVEN(u[2], u[3]), ODD(u[2], u[3]), has && SIGNAL_PART >= 2 ? lanes : 0);
  }
  u[0] = NAME(add)(EVEN(u[0], u[1]), ODD(u[0], u[1]), NAME(largest)(column));
#endif
  *to = NAME(add)(*to, u[0], NAME(largest)(column));
}

/* From me to it. */
INLINE VECTOR NAME(along)(REAL mine, VECTOR its, int axis, const struct sph_pair_constants *k) {
#if FIXED
  union {
    REAL real;
    INT integer;
  } at = {.real = mine};
  typedef uint32_t whole __attribute__((vector_size(LANES * sizeof(REAL))));
  whole difference = (whole)its - (uint32_t)at.integer;
  const VECTOR d = __builtin_convertvector((MASK)difference, VECTOR);
  return k->wrapped ? d * (REAL)k->quantum[axis] : d;
#else
  VECTOR d = its - mine;
  if (k->wrapped && k->per_period[axis] > 0) {                   /* the nearest image */
    VECTOR turns = d * k->per_period[axis] + 6755399441055744.0; /* 1.5 x 2^52: rounds to an integer */
    d -= (turns - 6755399441055744.0) * k->periodic[axis];
  }
  return d;
#endif
}

/* Of those that do not approach, but have neighbours. */
#define LEAST_SIGNAL (FIXED ? (REAL)0x1p-126 : (REAL)0x1p-1022)

#define EACH                                                                                                           \
  UNROLL                                                                                                               \
  for (int m = 0; m < GROUP; m++)
#define TIMES(factor, value) (FIXED ? (value) : (factor) * (value)) /* in float the slope has both factors in it */
#define GAIN(column, value)  (g[column] = m ? g[column] + (value) : (value)) /* of a neighbour, from member m */

INLINE double NAME(sum)(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *constants, const REAL *in,
                        REAL *out, const bool corrected, const bool artificial) {
  const struct sph_pair_constants k = *constants;
  const size_t middle = FIXED ? PAIR_MIDDLE_FLOAT : PAIR_MIDDLE_DOUBLE;
  const size_t in_stride = artificial && corrected ? PAIR_WIDE : artificial || corrected ? middle : PAIR_NARROW;
  const size_t out_stride = corrected ? middle : PAIR_NARROW;
  const REAL quarter = (REAL)0.25;
  const VECTOR zero = {0};
  VECTOR within = zero;
  const uint32_t *end = chunk->neighbour + chunk->start[(chunk->own + GROUP - 1) / GROUP];
  for (size_t i = 0; i < chunk->own; i += GROUP) {
    const REAL *mine[GROUP];
    REAL per_mine[GROUP], my_weight[GROUP];
    VECTOR s[GROUP][PAIR_WIDE]; /* my sums, lane by lane */
    EACH {
      mine[m] = in + (i + (size_t)m < chunk->own ? i + (size_t)m : i) * in_stride;
      per_mine[m] = k.volume_weights ? 1 / mine[m][PAIR_DENSITY] : 0;
      my_weight[m] = (REAL)k.norm * mine[m][PAIR_MASS] * (k.volume_weights ? per_mine[m] : 1);
      UNROLL
      for (int column = 0; column < PAIR_WIDE; column++)
        s[m][column] = zero;
    }
    const uint32_t *slot = chunk->neighbour + chunk->start[i / GROUP];
    const INT total = (INT)chunk->count[i / GROUP];
    const bool whole = i + GROUP <= chunk->own;
    for (INT done = 0; done < total; done += LANES, slot += LANES) {
      VECTOR c[PAIR_NARROW], g[PAIR_WIDE];
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(fetch)(in, in_stride, column, slot, c + column);
      if (FIXED) { /* 1 to 2 % of a large run; nothing in double */
        const uint32_t *next = slot + LANES < end ? slot + LANES : slot; /* lists follow each other */
        UNROLL
        for (int lane = 0; lane < LANES; lane++)
          __builtin_prefetch(out + next[lane] * out_stride, 1);
      }
      VECTOR dx[GROUP], dy[GROUP], dz[GROUP], h[GROUP], hh[GROUP], square[GROUP], inverse_r[GROUP], inverse_h[GROUP],
          q[GROUP], t[GROUP], slope[GROUP], wx[GROUP], wy[GROUP], wz[GROUP], ux[GROUP], uy[GROUP], uz[GROUP],
          closing[GROUP], mu[GROUP], densities[GROUP], softened[GROUP], per[GROUP], viscous[GROUP], fx[GROUP],
          fy[GROUP], fz[GROUP];
      NAME(choice) near[GROUP], within_h[GROUP];
      EACH {
        dx[m] = NAME(along)(mine[m][PAIR_X], c[PAIR_X], 0, &k);
        dy[m] = NAME(along)(mine[m][PAIR_Y], c[PAIR_Y], 1, &k);
        dz[m] = NAME(along)(mine[m][PAIR_Z], c[PAIR_Z], 2, &k);
      }
      EACH {
        h[m] = mine[m][PAIR_H] + c[PAIR_H], hh[m] = h[m] * h[m];
        square[m] = dx[m] * dx[m] + dy[m] * dy[m] + dz[m] * dz[m];
        densities[m] = mine[m][PAIR_DENSITY] + c[PAIR_DENSITY];
        softened[m] = densities[m] * (square[m] + (REAL)0.01 * hh[m]);
        near[m] = NAME(first_lanes)(total - done);
        if (m > 0 && !whole)
          near[m] &= NAME(less)(zero, zero);
      }
      EACH { /* coincident particles: no force, no division by zero. But m > 0 stands in the list itself, and is not
                near itself */
        if (FIXED) { /* a quantum apart, or q is not a number; one inverse for two */
          const VECTOR both = INVERSE(h[m] * softened[m]);
          inverse_r[m] = ROOT(m ? square[m] : NAME(larger)(square[m], zero + 1));
          inverse_h[m] = both * softened[m], per[m] = both * hh[m];
        } else {
          const VECTOR least = (REAL)1e-12 * hh[m];
          if (m > 0)
            near[m] &= NAME(less)(zero, square[m]);
          inverse_r[m] = ROOT(NAME(larger)(square[m], least));
          inverse_h[m] = INVERSE(h[m]), per[m] = INVERSE(softened[m]);
        }
        q[m] = square[m] * inverse_r[m] * inverse_h[m], t[m] = 2 - q[m];
        near[m] &= FIXED ? NAME(less)(zero, t[m]) : NAME(less)(square[m], 4 * hh[m]);
      }
      VECTOR per_its = zero, per_densities[GROUP]; /* the inverse of its density and of both */
      if (k.volume_weights) {
        per_its = INVERSE(c[PAIR_DENSITY]);
        EACH per_densities[m] = per_mine[m] * per_its;
      }
      const VECTOR its_volume = k.volume_weights ? c[PAIR_MASS] * per_its : c[PAIR_MASS];
      EACH {
        const VECTOR inner = (REAL)2.25 * q[m] - 3, outer = (REAL)-0.75 * t[m] * t[m] * (h[m] * inverse_r[m]);
        const VECTOR inverse_hh = inverse_h[m] * inverse_h[m]; /* in float h^-4 alone may be too small a number */
        const VECTOR scale = FIXED ? my_weight[m] * its_volume * inverse_hh * inverse_hh * inverse_h[m]
                                   : inverse_hh * inverse_hh * inverse_h[m] * (REAL)k.norm;
        within_h[m] = NAME(less)(q[m], zero + 1);
        slope[m] = NAME(keep)(near[m], NAME(select)(within_h[m], inner, outer) * scale); /* W'/r */
        wx[m] = slope[m] * dx[m], wy[m] = slope[m] * dy[m], wz[m] = slope[m] * dz[m];
      }
      EACH {
        ux[m] = mine[m][PAIR_VX] - c[PAIR_VX], uy[m] = mine[m][PAIR_VY] - c[PAIR_VY],
        uz[m] = mine[m][PAIR_VZ] - c[PAIR_VZ];
        closing[m] = ux[m] * dx[m] + uy[m] * dy[m] + uz[m] * dz[m]; /* positive when they approach */
        const VECTOR mu_per = FIXED ? NAME(larger)(closing[m], zero) * per[m]
                                    : h[m] * NAME(larger)(closing[m], zero) * per[m];
        mu[m] = mu_per * densities[m];
        viscous[m] = mu_per * ((REAL)k.twice_beta * mu[m] + (REAL)k.alpha * (mine[m][PAIR_SOUND] + c[PAIR_SOUND]));
        if (FIXED && k.volume_weights)
          viscous[m] *= mine[m][PAIR_DENSITY] * c[PAIR_DENSITY];
      }
      VECTOR work[GROUP]; /* that the artificial stress takes from the motion */
      EACH work[m] = zero;
      if (k.strength || corrected) {
        const size_t turned = (artificial ? PAIR_TURNED_TOO : PAIR_TURNED) - PAIR_NARROW;
        VECTOR more[PAIR_WIDE - PAIR_NARROW];
        UNROLL
        for (size_t column = 0; column < PAIR_WIDE - PAIR_NARROW; column += LANES)
          if ((artificial && column < 6) || (corrected && column + LANES > turned && column < turned + 3))
            NAME(fetch)(in, in_stride, PAIR_NARROW + column, slot, more + column);
        EACH {
          VECTOR xx = mine[m][PAIR_XX] + c[PAIR_XX], yy = mine[m][PAIR_YY] + c[PAIR_YY],
                 zz = mine[m][PAIR_ZZ] + c[PAIR_ZZ], xy = mine[m][PAIR_XY] + c[PAIR_XY],
                 xz = mine[m][PAIR_XZ] + c[PAIR_XZ], yz = mine[m][PAIR_YZ] + c[PAIR_YZ];
          VECTOR yx = xy, zx = xz, zy = yz;
          if (corrected) {
            const REAL *own = mine[m] + PAIR_NARROW + turned;
            yx = own[0] + more[turned], zx = own[1] + more[turned + 1], zy = own[2] + more[turned + 2];
          }
          if (artificial) { /* f^4 (R_i + R_j), f = W(r)/W(spacing). Monaghan 2000; Gray, Monaghan & Swift 2001 */
            VECTOR f = NAME(select)(within_h[m], 1 - q[m] * q[m] * ((REAL)1.5 - (REAL)0.75 * q[m]),
                                    quarter * t[m] * t[m] * t[m]);
            if (FIXED)
              f = NAME(keep)(near[m], f); /* where q is not a number */
            f *= (REAL)(1 / k.spline_at_spacing);
            f *= f;
            f *= f;
            const REAL *own = mine[m] + PAIR_ARTIFICIAL;
            const VECTOR rxx = f * (own[0] + more[0]), rxy = f * (own[1] + more[1]), rxz = f * (own[2] + more[2]);
            const VECTOR ryy = f * (own[3] + more[3]), ryz = f * (own[4] + more[4]), rzz = f * (own[5] + more[5]);
            xx += rxx, xy += rxy, xz += rxz, yy += ryy, yz += ryz, zz += rzz;
            if (corrected)
              yx += rxy, zx += rxz, zy += ryz;
            work[m] = ux[m] * (rxx * wx[m] + rxy * wy[m] + rxz * wz[m]) +
                      uy[m] * (rxy * wx[m] + ryy * wy[m] + ryz * wz[m]) +
                      uz[m] * (rxz * wx[m] + ryz * wy[m] + rzz * wz[m]);
            if (!FIXED && k.volume_weights)
              work[m] *= per_densities[m];
          }
          if (!FIXED && k.volume_weights) { /* T is of sigma, not of sigma/rho^2: forces conjugate to that gradient */
            const VECTOR both = per_densities[m];
            xx *= both, xy *= both, xz *= both, yy *= both, yz *= both, zz *= both;
            if (corrected)
              yx *= both, zx *= both, zy *= both;
          }
          if (!corrected)
            yx = xy, zx = xz, zy = yz;
          xx -= viscous[m], yy -= viscous[m], zz -= viscous[m];
          fx[m] = xx * wx[m] + xy * wy[m] + xz * wz[m];
          fy[m] = yx * wx[m] + yy * wy[m] + yz * wz[m];
          fz[m] = zx * wx[m] + zy * wy[m] + zz * wz[m];
        }
      } else {
        EACH {
          VECTOR p = mine[m][PAIR_XX] + c[PAIR_XX];
          if (!FIXED && k.volume_weights)
            p *= per_densities[m];
          p -= viscous[m];
          fx[m] = p * wx[m], fy[m] = p * wy[m], fz[m] = p * wz[m];
        }
      }
      EACH {
        VECTOR cooling = viscous[m] * slope[m] * closing[m]; /* twice */
        if (artificial)
          cooling -= work[m];
        const VECTOR signal = NAME(keep_larger)(near[m], mu[m], zero + LEAST_SIGNAL);
        s[m][SUM_SIGNAL] = NAME(larger)(s[m][SUM_SIGNAL], signal);
        g[SUM_SIGNAL] = m ? NAME(larger)(g[SUM_SIGNAL], signal) : signal;
        within = NAME(add_chosen)(within, near[m], zero + 1);
        const VECTOR mj = c[PAIR_MASS], mi = zero + mine[m][PAIR_MASS],
                     my_volume = k.volume_weights ? mi * per_mine[m] : mi;
        s[m][0] -= TIMES(mj, fx[m]), s[m][1] -= TIMES(mj, fy[m]), s[m][2] -= TIMES(mj, fz[m]);
        s[m][SUM_HEATING] += TIMES(mj, cooling);
        GAIN(0, TIMES(mi, fx[m])), GAIN(1, TIMES(mi, fy[m])), GAIN(2, TIMES(mi, fz[m]));
        GAIN(SUM_HEATING, TIMES(mi, cooling));
        VECTOR ax = TIMES(its_volume, wx[m]), ay = TIMES(its_volume, wy[m]), az = TIMES(its_volume, wz[m]);
        s[m][3] += ux[m] * ax, s[m][4] += ux[m] * ay, s[m][5] += ux[m] * az;
        s[m][6] += uy[m] * ax, s[m][7] += uy[m] * ay, s[m][8] += uy[m] * az;
        s[m][9] += uz[m] * ax, s[m][10] += uz[m] * ay, s[m][11] += uz[m] * az;
        if (corrected) {
          s[m][14] += dx[m] * ax, s[m][15] += dx[m] * ay, s[m][16] += dx[m] * az;
          s[m][17] += dy[m] * ay, s[m][18] += dy[m] * az, s[m][19] += dz[m] * az;
        }
        ax = TIMES(my_volume, wx[m]), ay = TIMES(my_volume, wy[m]), az = TIMES(my_volume, wz[m]);
        GAIN(3, ux[m] * ax), GAIN(4, ux[m] * ay), GAIN(5, ux[m] * az);
        GAIN(6, uy[m] * ax), GAIN(7, uy[m] * ay), GAIN(8, uy[m] * az);
        GAIN(9, uz[m] * ax), GAIN(10, uz[m] * ay), GAIN(11, uz[m] * az);
        if (corrected) {
          GAIN(14, dx[m] * ax), GAIN(15, dx[m] * ay), GAIN(16, dx[m] * az);
          GAIN(17, dy[m] * ay), GAIN(18, dy[m] * az), GAIN(19, dz[m] * az);
        }
      }
      if (!corrected)
        g[14] = g[15] = zero;
      if (corrected)
        NAME(spread_four)(out, out_stride, PAIR_NARROW, slot, g + PAIR_NARROW);
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(spread)(out, out_stride, column, slot, g + column);
    }
    EACH {
      if (m > 0 && !whole)
        continue;
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(collect)(out + (i + (size_t)m) * out_stride, column, s[m] + column);
      if (corrected) {
        UNROLL
        for (size_t column = PAIR_NARROW; column < SUM_COLUMNS; column += LANES)
          NAME(collect)(out + (i + (size_t)m) * out_stride, column, s[m] + column);
      }
    }
  }
  double pairs = 0;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pairs += (double)within[lane];
  return pairs;
}

static double NAME(sum_plain)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in,
                              REAL *out) {
  return NAME(sum)(c, k, in, out, false, false);
}
static double NAME(sum_artificial)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in,
                                   REAL *out) {
  return NAME(sum)(c, k, in, out, false, true);
}
static double NAME(sum_corrected)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in,
                                  REAL *out) {
  return NAME(sum)(c, k, in, out, true, false);
}
static double NAME(sum_both)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in,
                             REAL *out) {
  return NAME(sum)(c, k, in, out, true, true);
}
