/* The gradient correction (pairs.h; Bonet & Lok 1999), LANES particles at a time; always in double
 * (pairs_kernels_sum.h, which comes first, has the vectors). Symmetric: xx xy xz yy yz zz. */

enum { AT_ONCE = LANES }; /* numbers of double in a register */

/* The stress that acts, xx xy xz yy yz zz, out of the deviator and its factor. */
INLINE void acting(const double *const stress[5], const double *factor, size_t i, size_t lanes, vec out[6]) {
  const vec f = vec_load_first(factor + i, lanes);
  UNROLL
  for (int k = 0; k < 5; k++)
    out[k] = f * vec_load_first(stress[k] + i, lanes);
  out[5] = -(out[0] + out[3]);
}

/* T = sigma B, of which the first six are xx xy xz yy yz zz, the others yx zx zy: it is not symmetric. */
INLINE void turn(const vec s[6], const vec b[6], vec t[9]) {
  static const int place[3][3] = {{0, 1, 2}, {6, 3, 4}, {7, 8, 5}}, of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  UNROLL
  for (int row = 0; row < 3; row++) {
    UNROLL
    for (int c = 0; c < 3; c++)
      t[place[row][c]] = b[of[c][0]] * s[of[row][0]] + b[of[c][1]] * s[of[row][1]] + b[of[c][2]] * s[of[row][2]];
  }
}

/* Each row of a gradient times B. */
INLINE void times(const vec b[6], const vec g[9], vec out[9]) {
  UNROLL
  for (int row = 0; row < 9; row += 3) {
    out[row] = b[0] * g[row] + b[1] * g[row + 1] + b[2] * g[row + 2];
    out[row + 1] = b[1] * g[row] + b[3] * g[row + 1] + b[4] * g[row + 2];
    out[row + 2] = b[2] * g[row] + b[4] * g[row + 1] + b[5] * g[row + 2];
  }
}

INLINE vec between(vec x, double low, double high) {
  const vec zero = {0}, part = (x - low) / (high - low);
  const vec t = vec_select(vec_less(x, zero + low), zero, vec_select(vec_less(zero + high, x), zero + 1, part));
  return t * t * (3 - 2 * t);
}

/* B, the inverse of the moment, as far as there are enough neighbours all round; else 1, and what lies between for what
 * is between. In a body the mean eigenvalue is 1, 0.3 in a corner, and the determinant over its cube at least 0.8, in a
 * sharp point 0.6; among debris, a few neighbours anywhere, it is anything below: a strain made of those would be
 * noise, and its forces stiff. */
INLINE void invert(const vec m[6], vec inverse[6]) {
  const vec a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], c = m[1] * m[4] - m[2] * m[3], zero = {0};
  const vec determinant = m[0] * a + m[1] * b + m[2] * c, mean = (m[0] + m[3] + m[5]) / 3, cube = mean * mean * mean;
  const double low = 0.1; /* no inverse of what is not above: no division by it, either */
  const vec_mask solid = vec_less(zero + low, mean);
  const vec round = vec_select(solid, determinant, zero) / vec_select(solid, cube, zero + 1);
  const vec share = between(mean, low, 0.2) * between(round, 0.3, 0.6);
  const vec_mask any = vec_less(zero, share);
  const vec s = vec_keep(any, share) / vec_select(any, determinant, zero + 1);
  inverse[0] = 1 - share + s * a, inverse[1] = s * b, inverse[2] = s * c;
  inverse[3] = 1 - share + s * (m[0] * m[5] - m[2] * m[2]);
  inverse[4] = s * (m[1] * m[2] - m[0] * m[4]);
  inverse[5] = 1 - share + s * (m[0] * m[3] - m[1] * m[1]);
}

/* Of `lanes` particles from the i-th on. */
INLINE void correct_some(const struct sph_pair_correction *c, size_t i, const size_t lanes) {
  vec b[6], moment[6], g[9], out[9];
  UNROLL
  for (int k = 0; k < 6; k++)
    b[k] = vec_load_first(c->old[k] + i, lanes), moment[k] = vec_load_first(c->correction[k] + i, lanes);
  UNROLL
  for (int k = 0; k < 9; k++)
    g[k] = vec_load_first(c->gradient[k] + i, lanes);
  times(b, g, out);
  vec power = vec_load_first(c->pressure_term + i, lanes) *
              (out[0] + out[4] + out[8]); /* rho (sigma/rho^2) : gradient */
  if (c->stress[0]) {
    vec s[6];
    acting(c->stress, c->stress_factor, i, lanes, s);
    power += s[0] * out[0] + s[3] * out[4] + s[5] * out[8] + s[1] * (out[1] + out[3]) + s[2] * (out[2] + out[6]) +
             s[4] * (out[5] + out[7]);
  }
  power *= vec_load_first(c->density + i, lanes);
  memcpy(c->power + i, &power, lanes * sizeof(double));
  invert(moment, b);
  times(b, g, out);
  UNROLL
  for (int k = 0; k < 6; k++)
    memcpy(c->correction[k] + i, &b[k], lanes * sizeof(double));
  UNROLL
  for (int k = 0; k < 9; k++)
    memcpy(c->gradient[k] + i, &out[k], lanes * sizeof(double));
}

static void correct(const struct sph_pair_correction *c, size_t count) {
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    correct_some(c, i, LANES);
  if (i < count)
    correct_some(c, i, count - i);
}
