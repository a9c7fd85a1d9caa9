/* One precision of the pair loop. The including file has set REAL, INT (signed, of REAL's size), LANES, NAME(x) and FIXED
 * (positions are integers), and the class's ROOT, INVERSE. */

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

/* Rows become columns: first within the 16-byte quarters of the registers (PART numbers each), then the quarters among
 * registers. All shuffles have two sources and another destination. */
INLINE void NAME(transpose)(VECTOR r[LANES]) {
  enum { PART = 16 / sizeof(REAL), PARTS = LANES / PART };
  VECTOR u[LANES];
#if FIXED
  UNROLL for (int g = 0; g < LANES; g += 4) {
    const VECTOR a = LOW(r[g], r[g + 1]), b = HIGH(r[g], r[g + 1]), c = LOW(r[g + 2], r[g + 3]), d = HIGH(r[g + 2], r[g + 3]);
    u[g] = FIRST(a, c), u[g + 1] = SECOND(a, c), u[g + 2] = FIRST(b, d), u[g + 3] = SECOND(b, d);
  }
#else
  UNROLL for (int g = 0; g < LANES; g += 2)
    u[g] = FIRST(r[g], r[g + 1]), u[g + 1] = SECOND(r[g], r[g + 1]);
#endif
#ifdef EVEN
  UNROLL for (int c = 0; c < PART; c++) {
    if (PARTS == 2) {
      r[c] = EVEN(u[c], u[PART + c]), r[PART + c] = ODD(u[c], u[PART + c]);
    } else {
      const VECTOR a = EVEN(u[c], u[PART + c]), b = EVEN(u[2 * PART + c], u[3 * PART + c]);
      const VECTOR d = ODD(u[c], u[PART + c]), e = ODD(u[2 * PART + c], u[3 * PART + c]);
      r[c] = EVEN(a, b), r[2 * PART + c] = ODD(a, b), r[PART + c] = EVEN(d, e), r[3 * PART + c] = ODD(d, e);
    }
  }
#else
  UNROLL for (int k = 0; k < LANES; k++)
    r[k] = u[k];
#endif
}

/* Choices between vectors: GCC's vector extension has none in C that become single instructions of the masks of AVX-512. */
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
INLINE VECTOR NAME(larger_at)(size_t lane, VECTOR a, VECTOR b, VECTOR elsewhere) {
  return (VECTOR)AVX512(mask_max_, )(elsewhere, (AVX512_MASK)(1U << lane), a, b);
}
#else
typedef MASK NAME(choice);
INLINE MASK NAME(less)(VECTOR a, VECTOR b) {
  return a < b;
}
INLINE MASK NAME(first_lanes)(INT count) {
  MASK lanes;
  UNROLL for (int lane = 0; lane < LANES; lane++)
    lanes[lane] = lane;
  return lanes < count;
}
INLINE VECTOR NAME(select)(MASK choice, VECTOR yes, VECTOR no) {
  return (VECTOR)((choice & (MASK)yes) | (~choice & (MASK)no));
}
INLINE VECTOR NAME(keep)(MASK choice, VECTOR yes) {
  return (VECTOR)(choice & (MASK)yes);
}
INLINE VECTOR NAME(larger_at)(size_t lane, VECTOR a, VECTOR b, VECTOR elsewhere) {
  MASK pick = {0};
  pick[lane] = -1;
  return NAME(select)(pick, NAME(select)(a > b, a, b), elsewhere);
}
#endif

/* The block of LANES columns from `column` on, of LANES records: r[k] is column + k. */
INLINE void NAME(fetch)(const REAL *in, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
  UNROLL for (int lane = 0; lane < LANES; lane++)
    r[lane] = *(const VECTOR *)(const void *)(in + slot[lane] * stride + column);
  NAME(transpose)(r);
}

/* was + is, but where it is a largest value and not a sum. */
INLINE VECTOR NAME(add)(VECTOR was, VECTOR is, size_t column) {
  const VECTOR sum = was + is;
  return column <= SUM_SIGNAL && SUM_SIGNAL < column + LANES ? NAME(larger_at)(SUM_SIGNAL - column, was, is, sum) : sum;
}

/* r[k] is column + k of what LANES records get. */
INLINE void NAME(spread)(REAL *out, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
  NAME(transpose)(r);
  UNROLL for (int lane = 0; lane < LANES; lane++) {
    VECTOR *to = (VECTOR *)(void *)(out + slot[lane] * stride + column);
    *to = NAME(add)(*to, r[lane], column);
  }
}

/* r[k] is column + k of what one record gets, lane by lane. */
INLINE void NAME(collect)(REAL *out, size_t column, VECTOR r[LANES]) {
  VECTOR *to = (VECTOR *)(void *)(out + column), total;
  NAME(transpose)(r);
  total = r[0];
  UNROLL for (int lane = 1; lane < LANES; lane++)
    total = NAME(add)(total, r[lane], column);
  *to = NAME(add)(*to, total, column);
}

INLINE VECTOR NAME(along)(REAL mine, VECTOR its, int axis, const struct sph_pair_constants *k) {
#if FIXED
  union { REAL real; INT integer; } at = {.real = mine};
  typedef uint32_t whole __attribute__((vector_size(LANES * sizeof(REAL))));
  whole difference = (uint32_t)at.integer - (whole)its;
  return __builtin_convertvector((MASK)difference, VECTOR) * (REAL)k->quantum[axis];
#else
  VECTOR d = mine - its;
  if (k->wrapped && k->per_period[axis] > 0) { /* the nearest image */
    VECTOR turns = d * k->per_period[axis] + 6755399441055744.0; /* 1.5 x 2^52: rounds to an integer */
    d -= (turns - 6755399441055744.0) * k->periodic[axis];
  }
  return d;
#endif
}

INLINE void NAME(sum)(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *constants, const REAL *in, REAL *out,
                      const bool corrected, const bool artificial) {
  const struct sph_pair_constants k = *constants;
  const size_t in_stride = artificial || corrected ? PAIR_WIDE : PAIR_NARROW, out_stride = corrected ? PAIR_WIDE : PAIR_NARROW;
  const REAL norm = (REAL)SPH_SPLINE_NORM, quarter = (REAL)0.25, half = (REAL)0.5;
  for (size_t i = 0; i < chunk->own; i++) {
    const REAL *mine = in + i * in_stride;
    const REAL per_mine = k.volume_weights ? 1 / mine[PAIR_DENSITY] : 0;
    VECTOR s[PAIR_WIDE]; /* my sums, lane by lane */
    UNROLL for (int column = 0; column < PAIR_WIDE; column++)
      s[column] = (VECTOR){0};
    const uint32_t *slot = chunk->neighbour + chunk->start[i];
    const INT total = (INT)chunk->count[i];
    for (INT done = 0; done < total; done += LANES, slot += LANES) {
      VECTOR c[PAIR_NARROW];
      UNROLL for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(fetch)(in, in_stride, column, slot, c + column);
      const VECTOR dx = NAME(along)(mine[PAIR_X], c[PAIR_X], 0, &k), dy = NAME(along)(mine[PAIR_Y], c[PAIR_Y], 1, &k),
                   dz = NAME(along)(mine[PAIR_Z], c[PAIR_Z], 2, &k);
      const VECTOR h = half * (mine[PAIR_H] + c[PAIR_H]), hh = h * h, square = dx * dx + dy * dy + dz * dz;
      const NAME(choice) near = NAME(less)(square, 4 * hh) & NAME(first_lanes)(total - done);
      const VECTOR floor_square = (REAL)1e-12 * hh; /* coincident particles: no force, no division by zero */
      const VECTOR inverse_r = ROOT(NAME(select)(NAME(less)(floor_square, square), square, floor_square));
      const VECTOR inverse_h = INVERSE(h), q = square * inverse_r * inverse_h, t = 2 - q;
      const VECTOR inner = (REAL)2.25 * q - 3, outer = (REAL)-0.75 * t * t * (h * inverse_r);
      const VECTOR inverse_hh = inverse_h * inverse_h;
      const NAME(choice) within_h = NAME(less)(q, (VECTOR){0} + 1);
      const VECTOR slope = NAME(keep)(near, NAME(select)(within_h, inner, outer) * (inverse_hh * inverse_hh * inverse_h * norm)); /* W'/r */
      const VECTOR wx = slope * dx, wy = slope * dy, wz = slope * dz;
      const VECTOR ux = mine[PAIR_VX] - c[PAIR_VX], uy = mine[PAIR_VY] - c[PAIR_VY], uz = mine[PAIR_VZ] - c[PAIR_VZ];
      const VECTOR closing = ux * dx + uy * dy + uz * dz, zero = {0};
      const VECTOR densities = mine[PAIR_DENSITY] + c[PAIR_DENSITY];
      const VECTOR per = INVERSE(densities * (square + (REAL)0.01 * hh));
      const VECTOR mu_per = h * NAME(select)(NAME(less)(closing, zero), closing, zero) * per, mu = mu_per * densities;
      VECTOR per_its = zero, per_densities = zero; /* the inverse of its density and of both */
      if (k.volume_weights) {
        per_its = INVERSE(c[PAIR_DENSITY]);
        per_densities = per_mine * per_its;
      }
      const VECTOR viscous = mu_per * ((REAL)k.twice_beta * mu - (REAL)k.alpha * (mine[PAIR_SOUND] + c[PAIR_SOUND]));
      VECTOR fx, fy, fz;
      if (k.strength || corrected) {
        VECTOR more[PAIR_WIDE - PAIR_NARROW];
        UNROLL for (size_t column = 0; column < PAIR_WIDE - PAIR_NARROW; column += LANES)
          if ((artificial && column < 6) || (corrected && column + LANES > 8 && column < 11))
            NAME(fetch)(in, in_stride, PAIR_NARROW + column, slot, more + column);
        VECTOR xx = mine[PAIR_XX] + c[PAIR_XX], yy = mine[PAIR_YY] + c[PAIR_YY], zz = mine[PAIR_ZZ] + c[PAIR_ZZ],
               xy = mine[PAIR_XY] + c[PAIR_XY], xz = mine[PAIR_XZ] + c[PAIR_XZ], yz = mine[PAIR_YZ] + c[PAIR_YZ];
        VECTOR yx = xy, zx = xz, zy = yz;
        if (corrected) {
          yx = mine[PAIR_YX] + more[PAIR_YX - PAIR_NARROW];
          zx = mine[PAIR_ZX] + more[PAIR_ZX - PAIR_NARROW];
          zy = mine[PAIR_ZY] + more[PAIR_ZY - PAIR_NARROW];
        }
        if (artificial) { /* f^4 (R_i + R_j), f = W(r)/W(spacing). Monaghan 2000; Gray, Monaghan & Swift 2001 */
          VECTOR f = NAME(select)(within_h, 1 - q * q * ((REAL)1.5 - (REAL)0.75 * q), quarter * t * t * t);
          f *= (REAL)(1 / k.spline_at_spacing);
          f *= f;
          f *= f;
          const REAL *own = mine + PAIR_ARTIFICIAL;
          xx += f * (own[0] + more[0]), xy += f * (own[1] + more[1]), xz += f * (own[2] + more[2]);
          yy += f * (own[3] + more[3]), yz += f * (own[4] + more[4]), zz += f * (own[5] + more[5]);
          if (corrected) yx += f * (own[1] + more[1]), zx += f * (own[2] + more[2]), zy += f * (own[4] + more[4]);
        }
        if (k.volume_weights) { /* T is of sigma, not of sigma/rho^2: forces conjugate to that gradient */
          xx *= per_densities, xy *= per_densities, xz *= per_densities;
          yy *= per_densities, yz *= per_densities, zz *= per_densities;
          if (corrected) yx *= per_densities, zx *= per_densities, zy *= per_densities;
        }
        if (!corrected) yx = xy, zx = xz, zy = yz;
        xx -= viscous, yy -= viscous, zz -= viscous;
        fx = xx * wx + xy * wy + xz * wz;
        fy = yx * wx + yy * wy + yz * wz;
        fz = zx * wx + zy * wy + zz * wz;
      } else {
        VECTOR p = mine[PAIR_XX] + c[PAIR_XX];
        if (k.volume_weights) p *= per_densities;
        p -= viscous;
        fx = p * wx, fy = p * wy, fz = p * wz;
      }
      const VECTOR heat = half * viscous * slope * closing, signal = NAME(keep)(near, -mu);
      const VECTOR one = NAME(keep)(near, zero + 1), mi = zero + mine[PAIR_MASS];
      VECTOR mj = c[PAIR_MASS], opposite = zero - mine[PAIR_MASS];
      s[0] += mj * fx, s[1] += mj * fy, s[2] += mj * fz;
      s[SUM_HEATING] += mj * heat;
      s[SUM_SIGNAL] = NAME(select)(NAME(less)(s[SUM_SIGNAL], signal), signal, s[SUM_SIGNAL]);
      s[SUM_COUNT] += one;
      VECTOR g[PAIR_WIDE];
      g[0] = opposite * fx, g[1] = opposite * fy, g[2] = opposite * fz;
      g[SUM_HEATING] = mi * heat;
      g[SUM_SIGNAL] = signal;
      g[SUM_COUNT] = one;
      g[SUM_COUNT + 1] = zero;
      if (k.volume_weights) { /* volumes; else the sum is divided by rho_i afterwards */
        opposite *= per_mine;
        mj *= per_its;
      }
      VECTOR ax = mj * wx, ay = mj * wy, az = mj * wz;
      s[3] -= ux * ax, s[4] -= ux * ay, s[5] -= ux * az;
      s[6] -= uy * ax, s[7] -= uy * ay, s[8] -= uy * az;
      s[9] -= uz * ax, s[10] -= uz * ay, s[11] -= uz * az;
      if (corrected) {
        s[16] -= dx * ax, s[17] -= dx * ay, s[18] -= dx * az;
        s[19] -= dy * ay, s[20] -= dy * az, s[21] -= dz * az;
      }
      ax = opposite * wx, ay = opposite * wy, az = opposite * wz;
      g[3] = ux * ax, g[4] = ux * ay, g[5] = ux * az;
      g[6] = uy * ax, g[7] = uy * ay, g[8] = uy * az;
      g[9] = uz * ax, g[10] = uz * ay, g[11] = uz * az;
      UNROLL for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(spread)(out, out_stride, column, slot, g + column);
      if (corrected) {
        g[16] = dx * ax, g[17] = dx * ay, g[18] = dx * az;
        g[19] = dy * ay, g[20] = dy * az, g[21] = dz * az;
        UNROLL for (int column = 22; column < PAIR_WIDE; column++)
          g[column] = zero;
        UNROLL for (size_t column = SUM_MOMENT; column < SUM_MOMENT + 6; column += LANES)
          NAME(spread)(out, out_stride, column, slot, g + column);
      }
    }
    UNROLL for (size_t column = 0; column < PAIR_NARROW; column += LANES)
      NAME(collect)(out + i * out_stride, column, s + column);
    if (corrected) {
      UNROLL for (size_t column = SUM_MOMENT; column < SUM_MOMENT + 6; column += LANES)
        NAME(collect)(out + i * out_stride, column, s + column);
    }
  }
}

static void NAME(sum_plain)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in, REAL *out) {
  NAME(sum)(c, k, in, out, false, false);
}
static void NAME(sum_artificial)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in, REAL *out) {
  NAME(sum)(c, k, in, out, false, true);
}
static void NAME(sum_corrected)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in, REAL *out) {
  NAME(sum)(c, k, in, out, true, false);
}
static void NAME(sum_both)(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const REAL *in, REAL *out) {
  NAME(sum)(c, k, in, out, true, true);
}

#undef VECTOR
#undef MASK
#undef UNROLL
#undef LOW
#undef HIGH
#undef FIRST
#undef SECOND
#undef EVEN
#undef ODD
