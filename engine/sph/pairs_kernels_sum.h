/* One precision of the pair loop. The including file has set REAL, INT (signed, of REAL's size), LANES, NAME(x) and FIXED
 * (positions are integers), and the class's ROOT, INVERSE. */

typedef REAL NAME(vector) __attribute__((vector_size(LANES * sizeof(REAL))));
typedef INT NAME(mask) __attribute__((vector_size(LANES * sizeof(REAL))));
#define VECTOR NAME(vector)
#define MASK   NAME(mask)

#if LANES == 2
#define LOW(a, b)  __builtin_shufflevector(a, b, 0, 2)
#define HIGH(a, b) __builtin_shufflevector(a, b, 1, 3)
#elif LANES == 4
#define LOW(a, b)  __builtin_shufflevector(a, b, 0, 4, 1, 5)
#define HIGH(a, b) __builtin_shufflevector(a, b, 2, 6, 3, 7)
#elif LANES == 8
#define LOW(a, b)  __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11)
#define HIGH(a, b) __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15)
#else
#define LOW(a, b)  __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23)
#define HIGH(a, b) __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31)
#endif

/* Rows become columns: perfect shuffles, log2(LANES) times. */
INLINE void NAME(transpose)(VECTOR r[LANES]) {
  for (int stage = 1; stage < LANES; stage *= 2) {
    VECTOR t[LANES];
    for (int i = 0; i < LANES / 2; i++) {
      t[2 * i] = LOW(r[i], r[i + LANES / 2]);
      t[2 * i + 1] = HIGH(r[i], r[i + LANES / 2]);
    }
    for (int i = 0; i < LANES; i++)
      r[i] = t[i];
  }
}

INLINE VECTOR NAME(select)(MASK mask, VECTOR yes, VECTOR no) {
  return (VECTOR)((mask & (MASK)yes) | (~mask & (MASK)no));
}

INLINE VECTOR NAME(minimum)(VECTOR a, VECTOR b) {
  return NAME(select)(a < b, a, b);
}

/* The block of LANES columns from `column` on, of LANES records: r[k] is column + k. */
INLINE void NAME(fetch)(const REAL *in, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
  for (int lane = 0; lane < LANES; lane++)
    r[lane] = *(const VECTOR *)(const void *)(in + slot[lane] * stride + column);
  NAME(transpose)(r);
}

/* r[k] is column + k of what LANES records get. */
INLINE void NAME(spread)(REAL *out, size_t stride, size_t column, const uint32_t *slot, VECTOR r[LANES]) {
  NAME(transpose)(r);
  for (int lane = 0; lane < LANES; lane++) {
    VECTOR *to = (VECTOR *)(void *)(out + slot[lane] * stride + column);
    VECTOR was = *to, now = was + r[lane];
    if (column <= SUM_SIGNAL && SUM_SIGNAL < column + LANES) { /* a largest value, not a sum */
      MASK pick = {0};
      pick[SUM_SIGNAL - column] = -1;
      now = NAME(select)(pick, NAME(select)(was > r[lane], was, r[lane]), now);
    }
    *to = now;
  }
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
  const size_t in_stride = artificial ? PAIR_WIDE : PAIR_NARROW, out_stride = corrected ? PAIR_WIDE : PAIR_NARROW;
  const REAL norm = (REAL)SPH_SPLINE_NORM, quarter = (REAL)0.25, half = (REAL)0.5;
  MASK lanes;
  for (int lane = 0; lane < LANES; lane++)
    lanes[lane] = lane;
  for (size_t i = 0; i < chunk->own; i++) {
    const REAL *mine = in + i * in_stride;
    VECTOR s[PAIR_WIDE] = {{0}}; /* my sums, lane by lane */
    const uint32_t *slot = chunk->neighbour + chunk->start[i];
    const INT total = (INT)chunk->count[i];
    for (INT done = 0; done < total; done += LANES, slot += LANES) {
      VECTOR c[PAIR_NARROW];
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(fetch)(in, in_stride, column, slot, c + column);
      const VECTOR dx = NAME(along)(mine[PAIR_X], c[PAIR_X], 0, &k), dy = NAME(along)(mine[PAIR_Y], c[PAIR_Y], 1, &k),
                   dz = NAME(along)(mine[PAIR_Z], c[PAIR_Z], 2, &k);
      const VECTOR h = half * (mine[PAIR_H] + c[PAIR_H]), hh = h * h, square = dx * dx + dy * dy + dz * dz;
      const MASK near = (square < 4 * hh) & (lanes < total - done);
      const VECTOR floor_square = (REAL)1e-12 * hh; /* coincident particles: no force, no division by zero */
      const VECTOR inverse_r = ROOT(NAME(select)(square > floor_square, square, floor_square));
      const VECTOR inverse_h = INVERSE(h), q = square * inverse_r * inverse_h, t = 2 - q;
      const VECTOR inner = (REAL)2.25 * q - 3, outer = (REAL)-0.75 * t * t * (h * inverse_r);
      const VECTOR inverse_hh = inverse_h * inverse_h;
      VECTOR slope = NAME(select)(q < 1, inner, outer) * (inverse_hh * inverse_hh * inverse_h * norm); /* W'/r */
      slope = (VECTOR)((MASK)slope & near);
      const VECTOR wx = slope * dx, wy = slope * dy, wz = slope * dz;
      const VECTOR ux = mine[PAIR_VX] - c[PAIR_VX], uy = mine[PAIR_VY] - c[PAIR_VY], uz = mine[PAIR_VZ] - c[PAIR_VZ];
      const VECTOR closing = ux * dx + uy * dy + uz * dz, zero = {0};
      const VECTOR densities = mine[PAIR_DENSITY] + c[PAIR_DENSITY];
      const VECTOR per = INVERSE(densities * (square + (REAL)0.01 * hh));
      const VECTOR mu_per = h * NAME(minimum)(closing, zero) * per, mu = mu_per * densities;
      const VECTOR viscous = mu_per * ((REAL)k.twice_beta * mu - (REAL)k.alpha * (mine[PAIR_SOUND] + c[PAIR_SOUND]));
      VECTOR fx, fy, fz;
      if (k.strength) {
        VECTOR xx = mine[PAIR_XX] + c[PAIR_XX] - viscous, yy = mine[PAIR_YY] + c[PAIR_YY] - viscous,
               zz = mine[PAIR_ZZ] + c[PAIR_ZZ] - viscous, xy = mine[PAIR_XY] + c[PAIR_XY], xz = mine[PAIR_XZ] + c[PAIR_XZ],
               yz = mine[PAIR_YZ] + c[PAIR_YZ];
        if (artificial) { /* f^4 (R_i + R_j), f = W(r)/W(spacing). Monaghan 2000; Gray, Monaghan & Swift 2001 */
          VECTOR more[PAIR_WIDE - PAIR_NARROW];
          for (size_t column = 0; column < 6; column += LANES)
            NAME(fetch)(in, in_stride, PAIR_ARTIFICIAL + column, slot, more + column);
          VECTOR f = NAME(select)(q < 1, 1 - q * q * ((REAL)1.5 - (REAL)0.75 * q), quarter * t * t * t);
          f *= (REAL)(1 / k.spline_at_spacing);
          f *= f;
          f *= f;
          const REAL *own = mine + PAIR_ARTIFICIAL;
          xx += f * (own[0] + more[0]), xy += f * (own[1] + more[1]), xz += f * (own[2] + more[2]);
          yy += f * (own[3] + more[3]), yz += f * (own[4] + more[4]), zz += f * (own[5] + more[5]);
        }
        fx = xx * wx + xy * wy + xz * wz;
        fy = xy * wx + yy * wy + yz * wz;
        fz = xz * wx + yz * wy + zz * wz;
      } else {
        const VECTOR p = mine[PAIR_XX] + c[PAIR_XX] - viscous;
        fx = p * wx, fy = p * wy, fz = p * wz;
      }
      const VECTOR heat = half * viscous * slope * closing, signal = (VECTOR)((MASK)-mu & near);
      const VECTOR one = (VECTOR)((MASK)(zero + 1) & near);
      VECTOR mi = zero + mine[PAIR_MASS], mj = c[PAIR_MASS];
      s[0] += mj * fx, s[1] += mj * fy, s[2] += mj * fz;
      s[SUM_HEATING] += mj * heat;
      s[SUM_SIGNAL] = NAME(select)(signal > s[SUM_SIGNAL], signal, s[SUM_SIGNAL]);
      s[SUM_COUNT] += one;
      VECTOR g[PAIR_WIDE];
      g[0] = -mi * fx, g[1] = -mi * fy, g[2] = -mi * fz;
      g[SUM_HEATING] = mi * heat;
      g[SUM_SIGNAL] = signal;
      g[SUM_COUNT] = one;
      g[SUM_COUNT + 1] = zero;
      if (k.volume_weights) { /* volumes; else the sum is divided by rho_i afterwards */
        mi *= 1 / mine[PAIR_DENSITY];
        mj *= INVERSE(c[PAIR_DENSITY]);
      }
      VECTOR ax = mj * wx, ay = mj * wy, az = mj * wz;
      s[3] -= ux * ax, s[4] -= ux * ay, s[5] -= ux * az;
      s[6] -= uy * ax, s[7] -= uy * ay, s[8] -= uy * az;
      s[9] -= uz * ax, s[10] -= uz * ay, s[11] -= uz * az;
      if (corrected) {
        s[16] -= dx * ax, s[17] -= dx * ay, s[18] -= dx * az;
        s[19] -= dy * ay, s[20] -= dy * az, s[21] -= dz * az;
      }
      ax = mi * wx, ay = mi * wy, az = mi * wz;
      g[3] = -ux * ax, g[4] = -ux * ay, g[5] = -ux * az;
      g[6] = -uy * ax, g[7] = -uy * ay, g[8] = -uy * az;
      g[9] = -uz * ax, g[10] = -uz * ay, g[11] = -uz * az;
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        NAME(spread)(out, out_stride, column, slot, g + column);
      if (corrected) {
        g[16] = -dx * ax, g[17] = -dx * ay, g[18] = -dx * az;
        g[19] = -dy * ay, g[20] = -dy * az, g[21] = -dz * az;
        for (int column = 22; column < PAIR_WIDE; column++)
          g[column] = zero;
        for (size_t column = SUM_MOMENT; column < SUM_MOMENT + 6; column += LANES)
          NAME(spread)(out, out_stride, column, slot, g + column);
      }
    }
    REAL *to = out + i * out_stride;
    for (int column = 0; column < (corrected ? SUM_MOMENT + 6 : SUM_COUNT + 1); column++) {
      REAL total_of = 0;
      if (column == SUM_SIGNAL)
        for (int lane = 0; lane < LANES; lane++)
          total_of = s[column][lane] > total_of ? s[column][lane] : total_of;
      else
        for (int lane = 0; lane < LANES; lane++)
          total_of += s[column][lane];
      to[column] = column == SUM_SIGNAL ? (to[column] > total_of ? to[column] : total_of) : to[column] + total_of;
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
#undef LOW
#undef HIGH
