/* The gradient correction (pairs.h; Bonet & Lok 1999), always in double, LANES particles at a time. Symmetric tensors
 * have the columns xx xy xz yy yz zz. */

enum { AT_ONCE = LANES }; /* numbers of double in a register */

/* The deviator times its factor; the stored deviator lacks zz, as its trace is zero. */
INLINE void acting(const double *const stress[5], const double *factor, size_t i, size_t lanes, vec out[6]) {
  const vec f = vec_load_first(factor + i, lanes);
  UNROLL
  for (int k = 0; k < 5; k++)
    out[k] = f * vec_load_first(stress[k] + i, lanes);
  out[5] = -(out[0] + out[3]);
}

/* T = sigma B, which is not symmetric: xx xy xz yy yz zz, then yx zx zy. */
INLINE void turn(const vec s[6], const vec b[6], vec t[9]) {
  static const int place[3][3] = {{0, 1, 2}, {6, 3, 4}, {7, 8, 5}};
  static const int of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  UNROLL
  for (int row = 0; row < 3; row++) {
    UNROLL
    for (int c = 0; c < 3; c++)
      t[place[row][c]] = b[of[c][0]] * s[of[row][0]] + b[of[c][1]] * s[of[row][1]] + b[of[c][2]] * s[of[row][2]];
  }
}

/* Multiplies each row of a gradient by B. */
INLINE void times(const vec b[6], const vec g[9], vec out[9]) {
  UNROLL
  for (int row = 0; row < 9; row += 3) {
    out[row] = b[0] * g[row] + b[1] * g[row + 1] + b[2] * g[row + 2];
    out[row + 1] = b[1] * g[row] + b[3] * g[row + 1] + b[4] * g[row + 2];
    out[row + 2] = b[2] * g[row] + b[4] * g[row + 1] + b[5] * g[row + 2];
  }
}

/* A smooth step: 0 below `low`, 1 above `high`. */
INLINE vec smooth_step(vec x, double low, double high) {
  const vec zero = {0}, part = (x - low) / (high - low);
  const vec t = vec_select(vec_less(x, zero + low), zero, vec_select(vec_less(zero + high, x), zero + 1, part));
  return t * t * (3 - 2 * t);
}

/* B, the inverse of the moment M, where a particle has enough neighbours on all sides; B = 1 where it has not; a smooth
 * mixture in between. Two numbers decide. The mean eigenvalue of M is 1 inside a body and 0.3 in a corner. The
 * determinant over the cube of that mean is at least 0.8 in a body and 0.6 in a sharp point; among debris, with a few
 * neighbours anywhere, it is lower: there a corrected strain is noise, and its forces are stiff. */
INLINE void invert(const vec m[6], vec inverse[6]) {
  const vec zero = {0};
  const vec a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], c = m[1] * m[4] - m[2] * m[3];
  const vec determinant = m[0] * a + m[1] * b + m[2] * c;
  const vec mean = (m[0] + m[3] + m[5]) / 3, cube = mean * mean * mean;
  const double low = 0.1; /* below it B = 1, and nothing is divided by the mean */
  const vec_mask solid = vec_less(zero + low, mean);
  const vec round = vec_select(solid, determinant, zero) / vec_select(solid, cube, zero + 1);
  const vec part = smooth_step(mean, low, 0.2) * smooth_step(round, 0.3, 0.6);
  const vec_mask any = vec_less(zero, part);
  const vec s = vec_keep(any, part) / vec_select(any, determinant, zero + 1);
  inverse[0] = 1 - part + s * a;
  inverse[1] = s * b;
  inverse[2] = s * c;
  inverse[3] = 1 - part + s * (m[0] * m[5] - m[2] * m[2]);
  inverse[4] = s * (m[1] * m[2] - m[0] * m[4]);
  inverse[5] = 1 - part + s * (m[0] * m[3] - m[1] * m[1]);
}

/* Corrects the particles i .. i + lanes - 1. */
INLINE void correct_some(const struct sph_pair_correction *c, size_t i, const size_t lanes) {
  vec b[6], moment[6], g[9], out[9];
  UNROLL
  for (int k = 0; k < 6; k++) {
    b[k] = vec_load_first(c->old[k] + i, lanes);
    moment[k] = vec_load_first(c->correction[k] + i, lanes);
  }
  UNROLL
  for (int k = 0; k < 9; k++)
    g[k] = vec_load_first(c->gradient[k] + i, lanes);

  /* The work of the forces, rho (sigma/rho^2) : gradient, with the B that they were made with. */
  times(b, g, out);
  vec power = vec_load_first(c->pressure_term + i, lanes) * (out[0] + out[4] + out[8]);
  if (c->stress[0]) {
    vec s[6];
    acting(c->stress, c->stress_factor, i, lanes, s);
    power += s[0] * out[0] + s[3] * out[4] + s[5] * out[8] + s[1] * (out[1] + out[3]) + s[2] * (out[2] + out[6]) +
             s[4] * (out[5] + out[7]);
  }
  power *= vec_load_first(c->density + i, lanes);
  vec_store_first(c->power + i, power, lanes);

  invert(moment, b);
  times(b, g, out);
  UNROLL
  for (int k = 0; k < 6; k++)
    vec_store_first(c->correction[k] + i, b[k], lanes);
  UNROLL
  for (int k = 0; k < 9; k++)
    vec_store_first(c->gradient[k] + i, out[k], lanes);
}

static void correct(const struct sph_pair_correction *c, size_t count) {
  size_t i = 0;
  for (; i + LANES <= count; i += LANES)
    correct_some(c, i, LANES);
  if (i < count)
    correct_some(c, i, count - i);
}
