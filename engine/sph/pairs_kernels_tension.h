/* The artificial stress of Monaghan 2000 (J. Comput. Phys. 159, 290) in the principal axes of the stress, as in Gray,
 * Monaghan & Swift 2001: R = -epsilon times the tensile part of sigma/rho^2. It repels particles that a tension would pull
 * into clumps. LANES particles at a time, by Jacobi's rotations; always in double (pairs_kernels_sum.h, which comes first,
 * has the vectors). */

/* One rotation: a (xx xy xz yy yz zz) loses what stands in `pq`; the columns p, q of v turn with it. t = tan of the angle. */
INLINE void NAME(rotate)(VECTOR *pp, VECTOR *qq, VECTOR *pq, VECTOR *pr, VECTOR *qr, VECTOR v[3][3], int p, int q) {
  const VECTOR zero = {0}, difference = *qq - *pp, twice = 2 * *pq;
  const VECTOR square = difference * difference + twice * twice + 0x1p-1000;
  const VECTOR length = square * ROOT(square); /* of the difference and twice the element; never zero */
  const VECTOR negative = NAME(select)(NAME(less)(difference, zero), -twice, twice);
  const VECTOR size = NAME(select)(NAME(less)(difference, zero), -difference, difference);
  const VECTOR t = negative * INVERSE(size + length), c = ROOT(1 + t * t), s = t * c;
  const VECTOR r = *pr;
  *pp -= t * *pq, *qq += t * *pq, *pq = zero;
  *pr = c * r - s * *qr, *qr = s * r + c * *qr;
  UNROLL for (int k = 0; k < 3; k++) {
    const VECTOR x = v[k][p];
    v[k][p] = c * x - s * v[k][q], v[k][q] = s * x + c * v[k][q];
  }
}

INLINE bool NAME(any)(NAME(choice) choice) {
#ifdef AVX512
  return choice != 0;
#else
  INT seen = 0;
  UNROLL for (int lane = 0; lane < LANES; lane++)
    seen |= choice[lane];
  return seen != 0;
#endif
}

INLINE VECTOR NAME(size)(VECTOR a) {
  return NAME(select)(NAME(less)(a, (VECTOR){0}), -a, a);
}

/* R of the particles first..last-1, in units of the stress given: stress[] + pressure_term I, xx xy xz yy yz zz. */
static void NAME(oppose)(double epsilon, const double *const stress[6], const double *pressure_term, size_t first, size_t last,
                         double *const out[6]) {
  static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const VECTOR zero = {0}, one = zero + 1;
  for (size_t i = first; i < last; i += LANES) {
    const size_t left = last - i < LANES ? last - i : LANES;
    VECTOR a[6], v[3][3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}, r[6] = {zero, zero, zero, zero, zero, zero};
    double room[7][LANES] __attribute__((aligned(64)));
    for (int k = 0; k < 7; k++)
      for (size_t lane = 0; lane < LANES; lane++)
        room[k][lane] = lane < left ? (k < 6 ? stress[k] : pressure_term)[i + lane] : 0;
    UNROLL for (int k = 0; k < 6; k++)
      a[k] = *(const VECTOR *)(const void *)room[k] + (row[k] == column[k] ? *(const VECTOR *)(const void *)room[6] : zero);
    /* pressed all round by Gershgorin's circles: no tension, exactly */
    const VECTOR xy = NAME(size)(a[1]), xz = NAME(size)(a[2]), yz = NAME(size)(a[4]);
    const NAME(choice) pulled = NAME(less)(zero, a[0] + (xy + xz)) | NAME(less)(zero, a[3] + (xy + yz)) | NAME(less)(zero, a[5] + (xz + yz));
    if (NAME(any)(pulled)) {
      for (int sweep = 0; sweep < 12; sweep++) {
        const VECTOR off = a[1] * a[1] + a[2] * a[2] + a[4] * a[4], on = a[0] * a[0] + a[3] * a[3] + a[5] * a[5];
        if (!NAME(any)(NAME(less)((REAL)1e-32 * on, off) & pulled)) break;
        NAME(rotate)(&a[0], &a[3], &a[1], &a[2], &a[4], v, 0, 1);
        NAME(rotate)(&a[0], &a[5], &a[2], &a[1], &a[4], v, 0, 2);
        NAME(rotate)(&a[3], &a[5], &a[4], &a[1], &a[2], v, 1, 2);
      }
      UNROLL for (int axis = 0; axis < 3; axis++) {
        const VECTOR value = a[axis == 0 ? 0 : axis == 1 ? 3 : 5];
        const VECTOR most = NAME(keep)(NAME(less)(zero, value) & pulled, (REAL)-epsilon * value);
        UNROLL for (int k = 0; k < 6; k++)
          r[k] += most * v[row[k]][axis] * v[column[k]][axis];
      }
    }
    UNROLL for (int k = 0; k < 6; k++) {
      *(VECTOR *)(void *)room[k] = r[k];
      for (size_t lane = 0; lane < left; lane++)
        out[k][i + lane] = room[k][lane];
    }
  }
}
