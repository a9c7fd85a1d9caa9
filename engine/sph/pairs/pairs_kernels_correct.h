/* The gradient correction (pairs.h; Bonet & Lok 1999), LANES particles at a time; always in double
 * (pairs_kernels_sum.h, which comes first, has the vectors). Symmetric: xx xy xz yy yz zz. */

enum { AT_ONCE = LANES }; /* numbers in a register, of double in both precisions */

INLINE VECTOR NAME(load)(const double *from, size_t lanes) { /* zero in those that there are not */
  VECTOR v = {0};
  memcpy(&v, from, lanes * sizeof *from);
  return v;
}

/* The stress that acts, xx xy xz yy yz zz, out of the deviator and its factor. */
INLINE void NAME(acting)(const double *const stress[5], const double *factor, size_t i, size_t lanes, VECTOR out[6]) {
  const VECTOR f = NAME(load)(factor + i, lanes);
  UNROLL
  for (int k = 0; k < 5; k++)
    out[k] = f * NAME(load)(stress[k] + i, lanes);
  out[5] = -(out[0] + out[3]);
}

/* T = sigma B, of which the first six are xx xy xz yy yz zz, the others yx zx zy: it is not symmetric. */
INLINE void NAME(turn)(const VECTOR s[6], const VECTOR b[6], VECTOR t[9]) {
  static const int place[3][3] = {{0, 1, 2}, {6, 3, 4}, {7, 8, 5}}, of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  UNROLL
  for (int row = 0; row < 3; row++) {
    UNROLL
    for (int c = 0; c < 3; c++)
      t[place[row][c]] = b[of[c][0]] * s[of[row][0]] + b[of[c][1]] * s[of[row][1]] + b[of[c][2]] * s[of[row][2]];
  }
}

/* Each row of a gradient times B. */
INLINE void NAME(times)(const VECTOR b[6], const VECTOR g[9], VECTOR out[9]) {
  UNROLL
  for (int row = 0; row < 9; row += 3) {
    out[row] = b[0] * g[row] + b[1] * g[row + 1] + b[2] * g[row + 2];
    out[row + 1] = b[1] * g[row] + b[3] * g[row + 1] + b[4] * g[row + 2];
    out[row + 2] = b[2] * g[row] + b[4] * g[row + 1] + b[5] * g[row + 2];
  }
}

INLINE VECTOR NAME(between)(VECTOR x, double low, double high) {
  const VECTOR zero = {0}, part = (x - low) / (high - low);
  const VECTOR t = NAME(select)(NAME(less)(x, zero + low), zero,
                                NAME(select)(NAME(less)(zero + high, x), zero + 1, part));
  return t * t * (3 - 2 * t);
}

/* B, the inverse of the moment, as far as there are enough neighbours all round; else 1, and what lies between for what
 * is between. In a body the mean eigenvalue is 1, 0.3 in a corner, and the determinant over its cube at least 0.8, in a
 * sharp point 0.6; among debris, a few neighbours anywhere, it is anything below: a strain made of those would be
 * noise, and its forces stiff. */
INLINE void NAME(invert)(const VECTOR m[6], VECTOR inverse[6]) {
  const VECTOR a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], c = m[1] * m[4] - m[2] * m[3], zero = {0};
  const VECTOR determinant = m[0] * a + m[1] * b + m[2] * c, mean = (m[0] + m[3] + m[5]) / 3, cube = mean * mean * mean;
  const double low = 0.1; /* no inverse of what is not above: no division by it, either */
  const NAME(choice) solid = NAME(less)(zero + low, mean);
  const VECTOR round = NAME(select)(solid, determinant, zero) / NAME(select)(solid, cube, zero + 1);
  const VECTOR share = NAME(between)(mean, low, 0.2) * NAME(between)(round, 0.3, 0.6);
  const NAME(choice) any = NAME(less)(zero, share);
  const VECTOR s = NAME(keep)(any, share) / NAME(select)(any, determinant, zero + 1);
  inverse[0] = 1 - share + s * a, inverse[1] = s * b, inverse[2] = s * c;
  inverse[3] = 1 - share + s * (m[0] * m[5] - m[2] * m[2]);
  inverse[4] = s * (m[1] * m[2] - m[0] * m[4]);
  inverse[5] = 1 - share + s * (m[0] * m[3] - m[1] * m[1]);
}

/* Of `lanes` particles from the i-th on. */
INLINE void NAME(correct_some)(const struct sph_pair_correction *c, size_t i, const size_t lanes) {
  VECTOR b[6], moment[6], g[9], out[9];
  UNROLL
  for (int k = 0; k < 6; k++)
    b[k] = NAME(load)(c->old[k] + i, lanes), moment[k] = NAME(load)(c->correction[k] + i, lanes);
  UNROLL
  for (int k = 0; k < 9; k++)
    g[k] = NAME(load)(c->gradient[k] + i, lanes);
  NAME(times)(b, g, out);
  VECTOR power = NAME(load)(c->pressure_term + i, lanes) *
                 (out[0] + out[4] + out[8]); /* rho (sigma/rho^2) : gradient */
  if (c->stress[0]) {
    VECTOR s[6];
    NAME(acting)(c->stress, c->stress_factor, i, lanes, s);
    power += s[0] * out[0] + s[3] * out[4] + s[5] * out[8] + s[1] * (out[1] + out[3]) + s[2] * (out[2] + out[6]) +
             s[4] * (out[5] + out[7]);
  }
  power *= NAME(load)(c->density + i, lanes);
  memcpy(c->power + i, &power, lanes * sizeof(double));
  NAME(invert)(moment, b);
  NAME(times)(b, g, out);
  UNROLL
  for (int k = 0; k < 6; k++)
    memcpy(c->correction[k] + i, &b[k], lanes * sizeof(double));
  UNROLL
  for (int k = 0; k < 9; k++)
    memcpy(c->gradient[k] + i, &out[k], lanes * sizeof(double));
}

static void NAME(correct)(const struct sph_pair_correction *c, size_t count) {
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    NAME(correct_some)(c, i, LANES);
  if (i < count)
    NAME(correct_some)(c, i, count - i);
}
