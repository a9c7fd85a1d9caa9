/* The artificial stress of Monaghan 2000 (J. Comput. Phys. 159, 290) in the principal axes of the stress, as in Gray,
 * Monaghan & Swift 2001: R = -epsilon times the tensile part of sigma/rho^2. It repels particles that a tension would
 * pull into clumps. LANES particles at a time, by Jacobi's rotations; always in double (pairs_kernels_sum.h, which
 * comes first, has the vectors). */

/* One rotation: a (xx xy xz yy yz zz) loses what stands in `pq`; the columns p, q of v turn with it. t = tan of the
 * angle. */
INLINE void rotate(vec *pp, vec *qq, vec *pq, vec *pr, vec *qr, vec v[3][3], int p, int q) {
  const vec zero = {0}, difference = *qq - *pp, twice = 2 * *pq;
  const vec square = difference * difference + twice * twice + 0x1p-1000;
  const vec length = square * vec_inverse_root(square); /* of the difference and twice the element; never zero */
  const vec negative = vec_select(vec_less(difference, zero), -twice, twice);
  const vec size = vec_select(vec_less(difference, zero), -difference, difference);
  const vec t = negative * vec_inverse(size + length), c = vec_inverse_root(1 + t * t), s = t * c;
  const vec r = *pr;
  *pp -= t * *pq, *qq += t * *pq, *pq = zero;
  *pr = c * r - s * *qr, *qr = s * r + c * *qr;
  UNROLL
  for (int k = 0; k < 3; k++) {
    const vec x = v[k][p];
    v[k][p] = c * x - s * v[k][q], v[k][q] = s * x + c * v[k][q];
  }
}

/* Still to be turned: a tension, and something beside the diagonal. */
INLINE bool skew(const vec a[6], vec_mask pulled) {
  const vec off = a[1] * a[1] + a[2] * a[2] + a[4] * a[4], on = a[0] * a[0] + a[3] * a[3] + a[5] * a[5];
  return vec_any(vec_less((REAL)1e-32 * on, off) & pulled);
}

/* R of the particles first..last-1, in units of the stress given: stress_factor S + pressure_term I, xx xy xz yy yz zz.
 * Two registers of them in turn: a rotation is a chain of roots and inverses, and the one's fills the gaps of the
 * other's. */
static void oppose(double epsilon, const double *const stress[5], const double *stress_factor,
                   const double *pressure_term, size_t first, size_t last, double *const out[6]) {
  enum { BOTH = 2 };
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const vec zero = {0}, one = zero + 1;
  for (size_t i = first; i < last; i += BOTH * LANES) {
    vec a[BOTH][6], v[BOTH][3][3];
    vec_mask pulled[BOTH];
    size_t left[BOTH];
    UNROLL
    for (size_t m = 0; m < BOTH; m++) {
      const size_t at = i + m * LANES < last ? i + m * LANES : last;
      left[m] = last - at < LANES ? last - at : LANES;
      const vec pressure = vec_load_first(pressure_term + at, left[m]);
      acting(stress, stress_factor, at, left[m], a[m]);
      UNROLL
      for (int k = 0; k < 6; k++)
        a[m][k] += row[k] == column[k] ? pressure : zero;
      UNROLL
      for (int k = 0; k < 9; k++)
        v[m][k / 3][k % 3] = k % 4 == 0 ? one : zero;
      /* pressed all round by Gershgorin's circles: no tension, exactly */
      const vec xy = vec_abs(a[m][1]), xz = vec_abs(a[m][2]), yz = vec_abs(a[m][4]);
      pulled[m] = vec_less(zero, a[m][0] + (xy + xz)) | vec_less(zero, a[m][3] + (xy + yz)) |
                  vec_less(zero, a[m][5] + (xz + yz));
    }
    bool turns[BOTH] = {true, true};
    for (int sweep = 0; sweep < 12; sweep++) {
      UNROLL
      for (int m = 0; m < BOTH; m++)
        turns[m] = turns[m] && skew(a[m], pulled[m]);
      if (!turns[0] && !turns[1])
        break;
      static const int of[3][5] = {{0, 3, 1, 2, 4}, {0, 5, 2, 1, 4}, {3, 5, 4, 1, 2}},
                       axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
      UNROLL
      for (int t = 0; t < 3; t++) {
        UNROLL
        for (int m = 0; m < BOTH; m++)
          if (turns[m])
            rotate(&a[m][of[t][0]], &a[m][of[t][1]], &a[m][of[t][2]], &a[m][of[t][3]], &a[m][of[t][4]], v[m],
                   axes[t][0], axes[t][1]);
      }
    }
    UNROLL
    for (size_t m = 0; m < BOTH; m++) {
      vec r[6] = {zero, zero, zero, zero, zero, zero};
      UNROLL
      for (int axis = 0; axis < 3; axis++) {
        const vec value = a[m][axis == 0 ? 0 : axis == 1 ? 3 : 5];
        const vec most = vec_keep(vec_less(zero, value) & pulled[m], (REAL)-epsilon * value);
        UNROLL
        for (int k = 0; k < 6; k++)
          r[k] += most * v[m][row[k]][axis] * v[m][column[k]][axis];
      }
      UNROLL
      for (int k = 0; k < 6; k++)
        memcpy(out[k] + i + m * LANES, &r[k], left[m] * sizeof(double));
    }
  }
}
