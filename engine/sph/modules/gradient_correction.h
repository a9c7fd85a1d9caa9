/* Velocity gradients exact for linear fields: a term of the pair loop (pairs/pairs.h has the equations).
 *
 *   method.gradient_correction
 *
 * The gradient correction, a term of the pair loop (pairs/pairs.h; Bonet & Lok 1999). The stress T = sigma B of a
 * record is not symmetric; the moments M are summed, and B is their inverse. Symmetric tensors have the columns xx xy
 * xz yy yz zz.
 *
 * The weight of a neighbour is m_j/sqrt(rho_i rho_j), unless method.volume_weights. The corrected gradient is a mean of
 * the slopes (v_j - v_i)/(x_j - x_i), and each slope is the rate of the logarithm of that distance. With weights m_j
 * the neighbours behind a front, which are more, count more: they close up before the particle is in the front, and
 * those ahead of it after that. So the carried density ends too low where a thin front compresses much; with weights
 * m_j/rho_j too high, and with the mean of both nearly right.
 *
 * Where B is not wholly the inverse of M, a deviator makes a torque: sum_j (x_j - x_i) x (S B grad W) vanishes only if
 * M B = 1. Among debris this is next to nothing, as its deviator is. With method.crack_surfaces whole particles have
 * few neighbours that count, and there the deviator acts with the share p of the inverse. */

MODULE(gradient_correction)
MODULE_INPUTS(gradient_correction)

#ifdef SPH_MODULE_STRUCTS
struct sph_gradient_correction_inputs {
  bool on;
};
#endif

COLUMN(correction[6]) /* B, at the last pair loop */

PAIR_TERM(gradient_correction, o->gradient_correction.on)
PAIR_FIELDS(correction, 6)
PAIR_RECORD(gradient_correction, 4)                                     /* yx zx zy of T, rho^(-1/2) */
PAIR_SUMS(gradient_correction, correction, 6, -u->distance / u->length) /* the moments times -1, then B */
PAIR_POWER(gradient_correction)
PAIR_PACK(gradient_correction)
PAIR_STRESS(gradient_correction)
PAIR_SUMMED(gradient_correction)
PAIR_FINISH(gradient_correction)

#ifdef SPH_PAIR_TERM

#if !SINGLE /* always in double, LANES particles at a time */

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
INLINE vec invert(const vec m[6], vec inverse[6]) {
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
  return part;
}

/* Where the target spins. Edges and corners have a share p of the inverse below 1. There a rigid rotation W has the
 * gradient W M B, with shear of the order of W, and would break them. So they get g B + (1 - p) W (1 - M); as M B = p +
 * (1 - p) M, this is W again, and the trace stays. W is the rotation of the neighbours about the particle: their
 * angular momentum over their moment of inertia, with the weights in M as masses. Neighbours in line have no rotation
 * about that line. W fades where the mean eigenvalue of M is that of less than one neighbour. Fills in what is to be
 * added. Not inline: the compiler shall contract correct_some as it did, so that bits without spin stay. */
static __attribute__((noinline)) void missing_rotation(const struct sph_pair_sums *sums, size_t k, size_t lanes,
                                                       vec added[9]) {
  const vec zero = {0};
  vec m[6], g[9], unused[6];
  for (int c = 0; c < 6; c++)
    m[c] = vec_load_first(sums->correction[c] + k, lanes);
  for (int c = 0; c < 9; c++)
    g[c] = vec_load_first(sums->gradient[c] + k, lanes);
  const double in_line = 1e-9, neighbour = 0.05;
  const vec trace = m[0] + m[3] + m[5], most = trace * (1 + in_line);
  const vec xx = most - m[0], yy = most - m[3], zz = most - m[5]; /* of the inertia; xy is -m[1] */
  const vec a = yy * zz - m[4] * m[4], b = m[2] * m[4] + m[1] * zz, c = m[1] * m[4] + m[2] * yy;
  const vec d = xx * zz - m[2] * m[2], e = m[1] * m[2] + m[4] * xx, f = xx * yy - m[1] * m[1];
  const vec determinant = xx * a - m[1] * b - m[2] * c;
  const vec_mask any = vec_less(zero, determinant);
  const vec rest = (1 - invert(m, unused)) * smooth_step(trace / 3, 0, neighbour);
  const vec s = vec_keep(any, rest) / vec_select(any, determinant, zero + 1);
  const vec along[3] = {g[7] - g[5], g[2] - g[6], g[3] - g[1]}; /* the angular momentum */
  const vec x = s * (a * along[0] + b * along[1] + c * along[2]);
  const vec y = s * (b * along[0] + d * along[1] + e * along[2]);
  const vec z = s * (c * along[0] + e * along[1] + f * along[2]);
  const vec turning[9] = {zero, -z, y, z, zero, -x, -y, x, zero};
  const vec missing[6] = {1 - m[0], -m[1], -m[2], 1 - m[3], -m[4], 1 - m[5]};
  times(missing, turning, added);
}

/* Corrects `lanes` particles: those from place `k` of the sums on, which are those from i on of the fields. */
INLINE void correct_some(const struct sph_pair_options *options, const struct sph_pair_fields *f, size_t i,
                         const struct sph_pair_sums *sums, size_t k, const size_t lanes) {
  vec b[6], moment[6], g[9], out[9];
  UNROLL
  for (int c = 0; c < 6; c++) {
    b[c] = vec_load_first(f->correction[c] + i, lanes);
    moment[c] = vec_load_first(sums->correction[c] + k, lanes);
  }
  UNROLL
  for (int c = 0; c < 9; c++)
    g[c] = vec_load_first(sums->gradient[c] + k, lanes);

  /* The work of the forces, rho (sigma/rho^2) : gradient, with the B that they were made with. */
  times(b, g, out);
  vec power = vec_load_first(f->pressure_term + i, lanes) * (out[0] + out[4] + out[8]);
  if (options->strength) {
    vec s[6];
    acting(f->stress, f->stress_factor, i, lanes, s);
    if (f->correction_share[0]) { /* with crack_surfaces: the deviator has the share p in the forces */
      const vec rest = 1 - vec_load_first(f->correction_share[0] + i, lanes);
      UNROLL
      for (int c = 0; c < 9; c++)
        out[c] -= rest * g[c];
    }
    power += s[0] * out[0] + s[3] * out[4] + s[5] * out[8] + s[1] * (out[1] + out[3]) + s[2] * (out[2] + out[6]) +
             s[4] * (out[5] + out[7]);
  }
  power *= vec_load_first(f->density + i, lanes);
  vec_store_first(sums->power + k, power, lanes);

  const vec share = invert(moment, b);
  if (sums->correction_share[0])
    vec_store_first(sums->correction_share[0] + k, share, lanes);
  times(b, g, out);
  UNROLL
  for (int c = 0; c < 6; c++)
    vec_store_first(sums->correction[c] + k, b[c], lanes);
  UNROLL
  for (int c = 0; c < 9; c++)
    vec_store_first(sums->gradient[c] + k, out[c], lanes);
}

INLINE void correct(const struct sph_pair_options *options, const struct sph_pair_fields *f, size_t i,
                    const struct sph_pair_sums *sums, size_t k, const size_t lanes) {
  vec added[9];
  if (options->turns)
    missing_rotation(sums, k, lanes, added);
  correct_some(options, f, i, sums, k, lanes);
  for (int c = 0; c < 9 && options->turns; c++)
    vec_store_first(sums->gradient[c] + k, vec_load_first(sums->gradient[c] + k, lanes) + added[c], lanes);
}

static void gradient_correction_finish(const struct sph_pair_options *options, const struct sph_pair_fields *f,
                                       size_t first, size_t count, const struct sph_pair_sums *sums) {
  size_t k = 0;
  for (; k + LANES <= count; k += LANES)
    correct(options, f, first + k, sums, k, LANES);
  if (k < count)
    correct(options, f, first + k, sums, k, count - k);
}

#endif

INLINE void TYPED(gradient_correction_pack)(const struct sph_pair_source *source, size_t first, const uint32_t *which,
                                            vec_double base[], vec_double own[]) {
  vec_double b[6], t[9];
  UNROLL
  for (size_t c = 0; c < 6; c++)
    b[c] = column_load(source->fields.correction[c], 1, first, which);
  turn(base + PAIR_XX, b, t);
  if (source->shape.crack_surfaces) { /* of the deviator the share p alone */
    const vec_double rest = 1 - column_load(source->fields.correction_share[0], 1, first, which);
    const vec_double mean = (base[PAIR_XX] + base[PAIR_YY] + base[PAIR_ZZ]) / 3;
    t[0] -= rest * (base[PAIR_XX] - mean);
    t[3] -= rest * (base[PAIR_YY] - mean);
    t[5] -= rest * (base[PAIR_ZZ] - mean);
    t[1] -= rest * base[PAIR_XY], t[6] -= rest * base[PAIR_XY];
    t[2] -= rest * base[PAIR_XZ], t[7] -= rest * base[PAIR_XZ];
    t[4] -= rest * base[PAIR_YZ], t[8] -= rest * base[PAIR_YZ];
  }
  if (source->geometric_weights) { /* the records hold sigma B/rho */
    UNROLL
    for (size_t c = 0; c < 9; c++)
      t[c] *= base[PAIR_DENSITY];
  }
  UNROLL
  for (size_t c = 0; c < 6; c++)
    base[PAIR_XX + c] = t[c];
  UNROLL
  for (size_t c = 0; c < 3; c++)
    own[c] = t[6 + c];
  own[3] = vec_inverse_root_double(base[PAIR_DENSITY]);
}

INLINE void TYPED(gradient_correction_stress)(const struct sph_pair_constants *k, const struct pair_member *me,
                                              const REAL *mine, const vec *its, struct pair_batch *p, vec t[3][3]) {
  if (!k->volume_weights) {
    const vec zero = {0}, weight = mine[3] * its[3], density = zero + me->record[PAIR_DENSITY];
    p->slope *= weight;
    FOR_AXES(a)
      p->w[a] *= weight;
    p->viscous *= weight * density * (p->densities - density); /* as it was, with the slope */
  }
  t[1][0] = p->share[0] * mine[0] + p->share[1] * its[0];
  t[2][0] = p->share[0] * mine[1] + p->share[1] * its[1];
  t[2][1] = p->share[0] * mine[2] + p->share[1] * its[2];
}

INLINE void TYPED(gradient_correction_sum)(const struct pair_batch *p, const vec w[3], const bool first, vec *sum) {
  FOR_AXES(a) {
    FOR_AXES(b) {
      if (a <= b)
        sum[SYMMETRIC(a, b)] = first ? p->d[a] * w[b] : sum[SYMMETRIC(a, b)] + p->d[a] * w[b];
    }
  }
}

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool gradient_correction_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->gradient_correction.on;
}

/* B = 1 at first: xx xy xz yy yz zz. */
static const struct sph_column_need gradient_correction_columns[] = {{SPH_COLUMN(correction[0]), 1, 1, NULL},
                                                                     {SPH_COLUMN(correction[1]), 2, 0, NULL},
                                                                     {SPH_COLUMN(correction[3]), 1, 1, NULL},
                                                                     {SPH_COLUMN(correction[4]), 1, 0, NULL},
                                                                     {SPH_COLUMN(correction[5]), 1, 1, NULL},
                                                                     {0}};

static const struct sph_module gradient_correction_module = {
    .name = "gradient_correction",
    .doc = "Velocity gradients are exact for linear fields, also at surfaces, and forces are conjugate to them: a "
           "rigid rotation strains nothing (sharp edges: with a target.spin only), energy and angular momentum keep, "
           "free sides are as stiff as the inside.",
    .source = "Randles & Libersky 1996; Bonet & Lok 1999 (Comput. Methods Appl. Mech. Eng. 180, 97)",
    .when = "gradient_correction: true",
    .on = gradient_correction_on,
    .columns = gradient_correction_columns,
    .bytes_in_pairs = 92, /* wider records; measured */
    .cost = 65,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_SWITCH(method.gradient_correction, gradient_correction.on, 0, .flags = FIELD_DERIVED,
             .doc = "Velocity gradients exact for linear fields, and forces conjugate to them: a body turns without "
                    "strain and keeps its angular momentum, and its free sides are as stiff as its inside. Costs a "
                    "quarter more time. Unless given it is on where a target with strength can turn: with a "
                    "target.spin, in a collision, and in an impact without damped sides.",
             .source = "Randles & Libersky 1996; Bonet & Lok 1999; off in BA95"),
#endif
