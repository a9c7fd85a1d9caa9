/* The pair loop in one precision (templates_on.h, vector.h, pairs_kernels_records.h). */

#define pair_along           TYPED(pair_along)
#define sum_pairs            TYPED(sum_pairs)
#define sum_pairs_plain      TYPED(sum_pairs_plain)
#define sum_pairs_artificial TYPED(sum_pairs_artificial)
#define sum_pairs_corrected  TYPED(sum_pairs_corrected)
#define sum_pairs_both       TYPED(sum_pairs_both)

#define GROUP (SINGLE ? PAIR_GROUP_FLOAT : PAIR_GROUP_DOUBLE)

/* From me to it. */
INLINE vec pair_along(REAL mine, vec its, int axis, const struct sph_pair_constants *k) {
#if SINGLE
  union {
    REAL real;
    INT integer;
  } at = {.real = mine};
  typedef uint32_t whole __attribute__((vector_size(LANES * sizeof(REAL))));
  whole difference = (whole)its - (uint32_t)at.integer;
  const vec d = __builtin_convertvector((vec_int)difference, vec);
  return k->wrapped ? d * (REAL)k->quantum[axis] : d;
#else
  vec d = its - mine;
  if (k->wrapped && k->per_period[axis] > 0) {                /* the nearest image */
    vec turns = d * k->per_period[axis] + 6755399441055744.0; /* 1.5 x 2^52: rounds to an integer */
    d -= (turns - 6755399441055744.0) * k->periodic[axis];
  }
  return d;
#endif
}

/* Of those that do not approach, but have neighbours. */
#define LEAST_SIGNAL (SINGLE ? (REAL)0x1p-126 : (REAL)0x1p-1022)

#define EACH                                                                                                           \
  UNROLL                                                                                                               \
  for (int m = 0; m < GROUP; m++)
#define TIMES(factor, value) (SINGLE ? (value) : (factor) * (value)) /* in float the slope has both factors in it */
#define GAIN(column, value)  (g[column] = m ? g[column] + (value) : (value)) /* of a neighbour, from member m */

INLINE double sum_pairs(const struct sph_pair_chunk *chunk, const struct sph_pair_constants *constants, const REAL *in,
                        REAL *out, const bool corrected, const bool artificial) {
  const struct sph_pair_constants k = *constants;
  const size_t middle = SINGLE ? PAIR_MIDDLE_FLOAT : PAIR_MIDDLE_DOUBLE;
  const size_t in_stride = artificial && corrected ? PAIR_WIDE : artificial || corrected ? middle : PAIR_NARROW;
  const size_t out_stride = corrected ? middle : PAIR_NARROW;
  const REAL quarter = (REAL)0.25;
  const vec zero = {0};
  vec within = zero;
  const uint32_t *end = chunk->neighbour + chunk->start[(chunk->own + GROUP - 1) / GROUP];
  for (size_t i = 0; i < chunk->own; i += GROUP) {
    const REAL *mine[GROUP];
    REAL per_mine[GROUP], my_weight[GROUP];
    vec s[GROUP][PAIR_WIDE]; /* my sums, lane by lane */
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
      vec c[PAIR_NARROW], g[PAIR_WIDE];
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        record_fetch(in, in_stride, column, slot, c + column);
      if (SINGLE) { /* 1 to 2 % of a large run; nothing in double */
        const uint32_t *next = slot + LANES < end ? slot + LANES : slot; /* lists follow each other */
        UNROLL
        for (int lane = 0; lane < LANES; lane++)
          __builtin_prefetch(out + next[lane] * out_stride, 1);
      }
      vec dx[GROUP], dy[GROUP], dz[GROUP], h[GROUP], hh[GROUP], square[GROUP], inverse_r[GROUP], inverse_h[GROUP],
          q[GROUP], t[GROUP], slope[GROUP], wx[GROUP], wy[GROUP], wz[GROUP], ux[GROUP], uy[GROUP], uz[GROUP],
          closing[GROUP], mu[GROUP], densities[GROUP], softened[GROUP], per[GROUP], viscous[GROUP], fx[GROUP],
          fy[GROUP], fz[GROUP];
      vec_mask near[GROUP], within_h[GROUP];
      EACH {
        dx[m] = pair_along(mine[m][PAIR_X], c[PAIR_X], 0, &k);
        dy[m] = pair_along(mine[m][PAIR_Y], c[PAIR_Y], 1, &k);
        dz[m] = pair_along(mine[m][PAIR_Z], c[PAIR_Z], 2, &k);
      }
      EACH {
        h[m] = mine[m][PAIR_H] + c[PAIR_H], hh[m] = h[m] * h[m];
        square[m] = dx[m] * dx[m] + dy[m] * dy[m] + dz[m] * dz[m];
        densities[m] = mine[m][PAIR_DENSITY] + c[PAIR_DENSITY];
        softened[m] = densities[m] * (square[m] + (REAL)0.01 * hh[m]);
        near[m] = vec_first_lanes(total - done);
        if (m > 0 && !whole)
          near[m] &= vec_less(zero, zero);
      }
      EACH { /* coincident particles: no force, no division by zero. But m > 0 stands in the list itself, and is not
                near itself */
        if (SINGLE) { /* a quantum apart, or q is not a number; one inverse for two */
          const vec both = vec_inverse(h[m] * softened[m]);
          inverse_r[m] = vec_inverse_root(m ? square[m] : vec_max(square[m], zero + 1));
          inverse_h[m] = both * softened[m], per[m] = both * hh[m];
        } else {
          const vec least = (REAL)1e-12 * hh[m];
          if (m > 0)
            near[m] &= vec_less(zero, square[m]);
          inverse_r[m] = vec_inverse_root(vec_max(square[m], least));
          inverse_h[m] = vec_inverse(h[m]), per[m] = vec_inverse(softened[m]);
        }
        q[m] = square[m] * inverse_r[m] * inverse_h[m], t[m] = 2 - q[m];
        near[m] &= SINGLE ? vec_less(zero, t[m]) : vec_less(square[m], 4 * hh[m]);
      }
      vec per_its = zero, per_densities[GROUP]; /* the inverse of its density and of both */
      if (k.volume_weights) {
        per_its = vec_inverse(c[PAIR_DENSITY]);
        EACH per_densities[m] = per_mine[m] * per_its;
      }
      const vec its_volume = k.volume_weights ? c[PAIR_MASS] * per_its : c[PAIR_MASS];
      EACH {
        const vec inner = (REAL)2.25 * q[m] - 3, outer = (REAL)-0.75 * t[m] * t[m] * (h[m] * inverse_r[m]);
        const vec inverse_hh = inverse_h[m] * inverse_h[m]; /* in float h^-4 alone may be too small a number */
        const vec scale = SINGLE ? my_weight[m] * its_volume * inverse_hh * inverse_hh * inverse_h[m]
                                 : inverse_hh * inverse_hh * inverse_h[m] * (REAL)k.norm;
        within_h[m] = vec_less(q[m], zero + 1);
        slope[m] = vec_keep(near[m], vec_select(within_h[m], inner, outer) * scale); /* W'/r */
        wx[m] = slope[m] * dx[m], wy[m] = slope[m] * dy[m], wz[m] = slope[m] * dz[m];
      }
      EACH {
        ux[m] = mine[m][PAIR_VX] - c[PAIR_VX], uy[m] = mine[m][PAIR_VY] - c[PAIR_VY],
        uz[m] = mine[m][PAIR_VZ] - c[PAIR_VZ];
        closing[m] = ux[m] * dx[m] + uy[m] * dy[m] + uz[m] * dz[m]; /* positive when they approach */
        const vec mu_per = SINGLE ? vec_max(closing[m], zero) * per[m] : h[m] * vec_max(closing[m], zero) * per[m];
        mu[m] = mu_per * densities[m];
        viscous[m] = mu_per * ((REAL)k.twice_beta * mu[m] + (REAL)k.alpha * (mine[m][PAIR_SOUND] + c[PAIR_SOUND]));
        if (SINGLE && k.volume_weights)
          viscous[m] *= mine[m][PAIR_DENSITY] * c[PAIR_DENSITY];
      }
      vec work[GROUP]; /* that the artificial stress takes from the motion */
      EACH work[m] = zero;
      if (k.strength || corrected) {
        const size_t turned = (artificial ? PAIR_TURNED_TOO : PAIR_TURNED) - PAIR_NARROW;
        vec more[PAIR_WIDE - PAIR_NARROW];
        UNROLL
        for (size_t column = 0; column < PAIR_WIDE - PAIR_NARROW; column += LANES)
          if ((artificial && column < 6) || (corrected && column + LANES > turned && column < turned + 3))
            record_fetch(in, in_stride, PAIR_NARROW + column, slot, more + column);
        EACH {
          vec xx = mine[m][PAIR_XX] + c[PAIR_XX], yy = mine[m][PAIR_YY] + c[PAIR_YY],
              zz = mine[m][PAIR_ZZ] + c[PAIR_ZZ], xy = mine[m][PAIR_XY] + c[PAIR_XY],
              xz = mine[m][PAIR_XZ] + c[PAIR_XZ], yz = mine[m][PAIR_YZ] + c[PAIR_YZ];
          vec yx = xy, zx = xz, zy = yz;
          if (corrected) {
            const REAL *own = mine[m] + PAIR_NARROW + turned;
            yx = own[0] + more[turned], zx = own[1] + more[turned + 1], zy = own[2] + more[turned + 2];
          }
          if (artificial) { /* f^4 (R_i + R_j), f = W(r)/W(spacing). Monaghan 2000; Gray, Monaghan & Swift 2001 */
            vec f = vec_select(within_h[m], 1 - q[m] * q[m] * ((REAL)1.5 - (REAL)0.75 * q[m]),
                               quarter * t[m] * t[m] * t[m]);
            if (SINGLE)
              f = vec_keep(near[m], f); /* where q is not a number */
            f *= (REAL)(1 / k.spline_at_spacing);
            f *= f;
            f *= f;
            const REAL *own = mine[m] + PAIR_ARTIFICIAL;
            const vec rxx = f * (own[0] + more[0]), rxy = f * (own[1] + more[1]), rxz = f * (own[2] + more[2]);
            const vec ryy = f * (own[3] + more[3]), ryz = f * (own[4] + more[4]), rzz = f * (own[5] + more[5]);
            xx += rxx, xy += rxy, xz += rxz, yy += ryy, yz += ryz, zz += rzz;
            if (corrected)
              yx += rxy, zx += rxz, zy += ryz;
            work[m] = ux[m] * (rxx * wx[m] + rxy * wy[m] + rxz * wz[m]) +
                      uy[m] * (rxy * wx[m] + ryy * wy[m] + ryz * wz[m]) +
                      uz[m] * (rxz * wx[m] + ryz * wy[m] + rzz * wz[m]);
            if (!SINGLE && k.volume_weights)
              work[m] *= per_densities[m];
          }
          if (!SINGLE && k.volume_weights) { /* T is of sigma, not of sigma/rho^2: forces conjugate to that gradient */
            const vec both = per_densities[m];
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
          vec p = mine[m][PAIR_XX] + c[PAIR_XX];
          if (!SINGLE && k.volume_weights)
            p *= per_densities[m];
          p -= viscous[m];
          fx[m] = p * wx[m], fy[m] = p * wy[m], fz[m] = p * wz[m];
        }
      }
      EACH {
        vec cooling = viscous[m] * slope[m] * closing[m]; /* twice */
        if (artificial)
          cooling -= work[m];
        const vec signal = vec_keep_max(near[m], mu[m], zero + LEAST_SIGNAL);
        s[m][SUM_SIGNAL] = vec_max(s[m][SUM_SIGNAL], signal);
        g[SUM_SIGNAL] = m ? vec_max(g[SUM_SIGNAL], signal) : signal;
        within = vec_add_where(within, near[m], zero + 1);
        const vec mj = c[PAIR_MASS], mi = zero + mine[m][PAIR_MASS],
                  my_volume = k.volume_weights ? mi * per_mine[m] : mi;
        s[m][0] -= TIMES(mj, fx[m]), s[m][1] -= TIMES(mj, fy[m]), s[m][2] -= TIMES(mj, fz[m]);
        s[m][SUM_HEATING] += TIMES(mj, cooling);
        GAIN(0, TIMES(mi, fx[m])), GAIN(1, TIMES(mi, fy[m])), GAIN(2, TIMES(mi, fz[m]));
        GAIN(SUM_HEATING, TIMES(mi, cooling));
        vec ax = TIMES(its_volume, wx[m]), ay = TIMES(its_volume, wy[m]), az = TIMES(its_volume, wz[m]);
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
        record_spread_four(out, out_stride, PAIR_NARROW, slot, g + PAIR_NARROW);
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        record_spread(out, out_stride, column, slot, g + column);
    }
    EACH {
      if (m > 0 && !whole)
        continue;
      UNROLL
      for (size_t column = 0; column < PAIR_NARROW; column += LANES)
        record_collect(out + (i + (size_t)m) * out_stride, column, s[m] + column);
      if (corrected) {
        UNROLL
        for (size_t column = PAIR_NARROW; column < SUM_COLUMNS; column += LANES)
          record_collect(out + (i + (size_t)m) * out_stride, column, s[m] + column);
      }
    }
  }
  double pairs = 0;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pairs += (double)within[lane];
  return pairs;
}

/* As struct sph_record_kernels calls them. */
static double sum_pairs_plain(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                              void *out) {
  return sum_pairs(c, k, in, out, false, false);
}
static double sum_pairs_artificial(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                                   void *out) {
  return sum_pairs(c, k, in, out, false, true);
}
static double sum_pairs_corrected(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                                  void *out) {
  return sum_pairs(c, k, in, out, true, false);
}
static double sum_pairs_both(const struct sph_pair_chunk *c, const struct sph_pair_constants *k, const void *in,
                             void *out) {
  return sum_pairs(c, k, in, out, true, true);
}
