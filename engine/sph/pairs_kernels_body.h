/* The pair loop of one CPU class: the including file sets WIDTH (bytes of a register), KERNELS_TABLE, KERNELS_NAME. */
#include <math.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "engine/sph/pairs_kernels.h"
#include "engine/sph/spline.h"

#define INLINE static inline __attribute__((always_inline, unused))

/* 1/sqrt(a) and 1/a. With AVX-512 from the approximations to 14 bits and Newton's iteration (twice for double: within
 * 2 ulp; once for float), which takes half the time of the division unit. */
#ifdef __AVX512F__
typedef double inverse_d __attribute__((vector_size(64)));
typedef float inverse_f __attribute__((vector_size(64)));
INLINE inverse_d root_d(inverse_d a) {
  inverse_d y = (inverse_d)_mm512_rsqrt14_pd((__m512d)a), half = 0.5 * a;
  y *= 1.5 - half * y * y;
  return y * (1.5 - half * y * y);
}
INLINE inverse_d inverse_of_d(inverse_d a) {
  inverse_d y = (inverse_d)_mm512_rcp14_pd((__m512d)a);
  y *= 2 - a * y;
  return y * (2 - a * y);
}
INLINE inverse_f root_f(inverse_f a) {
  inverse_f y = (inverse_f)_mm512_rsqrt14_ps((__m512)a);
  return y * (1.5F - 0.5F * a * y * y);
}
INLINE inverse_f inverse_of_f(inverse_f a) {
  inverse_f y = (inverse_f)_mm512_rcp14_ps((__m512)a);
  return y * (2 - a * y);
}
#else
typedef double inverse_d __attribute__((vector_size(WIDTH)));
typedef float inverse_f __attribute__((vector_size(WIDTH)));
INLINE inverse_d root_d(inverse_d a) {
  for (size_t lane = 0; lane < WIDTH / sizeof(double); lane++)
    a[lane] = __builtin_sqrt(a[lane]);
  return 1 / a;
}
INLINE inverse_d inverse_of_d(inverse_d a) {
  return 1 / a;
}
INLINE inverse_f root_f(inverse_f a) {
  for (size_t lane = 0; lane < WIDTH / sizeof(float); lane++)
    a[lane] = __builtin_sqrtf(a[lane]);
  return 1 / a;
}
INLINE inverse_f inverse_of_f(inverse_f a) {
  return 1 / a;
}
#endif

#define REAL    double
#define INT     int64_t
#define LANES   (WIDTH / 8)
#define GROUP   PAIR_GROUP_DOUBLE
#define NAME(x) double_##x
#define FIXED   0
#define ROOT    root_d
#define INVERSE inverse_of_d
#ifdef __AVX512F__
#define AVX512(before, after) _mm512_##before##pd##after
#define AVX512_MASK           __mmask8
#endif
#include "engine/sph/pairs_kernels_sum.h"
#undef REAL
#undef INT
#undef LANES
#undef GROUP
#undef NAME
#undef FIXED
#undef ROOT
#undef INVERSE
#ifdef AVX512
#undef AVX512
#undef AVX512_MASK
#endif
#define REAL    float
#define INT     int32_t
#define LANES   (WIDTH / 4)
#define GROUP   PAIR_GROUP_FLOAT
#define NAME(x) float_##x
#define FIXED   1
#define ROOT    root_f
#define INVERSE inverse_of_f
#ifdef __AVX512F__
#define AVX512(before, after) _mm512_##before##ps##after
#define AVX512_MASK           __mmask16
#endif
#include "engine/sph/pairs_kernels_sum.h"

static double nearest_image(double along, double length) {
  return isnan(length) ? along : along - length * nearbyint(along / length);
}

static size_t within(size_t count, const double *x, const double *y, const double *z, const double *reach, const uint32_t *id,
                     const double at[3], double own_reach, const double periodic[3], uint32_t lowest, uint32_t *found) {
  size_t n = 0;
  if (!isnan(periodic[0]) || !isnan(periodic[1]) || !isnan(periodic[2])) {
    for (size_t k = 0; k < count; k++) {
      double dx = nearest_image(at[0] - x[k], periodic[0]), dy = nearest_image(at[1] - y[k], periodic[1]),
             dz = nearest_image(at[2] - z[k], periodic[2]), r = own_reach + reach[k];
      found[n] = id[k];
      n += (dx * dx + dy * dy + dz * dz < r * r) & (id[k] >= lowest);
    }
    return n;
  }
#ifdef __AVX512F__
  const __m512d ax = _mm512_set1_pd(at[0]), ay = _mm512_set1_pd(at[1]), az = _mm512_set1_pd(at[2]), own = _mm512_set1_pd(own_reach);
  for (size_t k = 0; k < count; k += 8) {
    __m512d dx = _mm512_sub_pd(ax, _mm512_loadu_pd(x + k)), dy = _mm512_sub_pd(ay, _mm512_loadu_pd(y + k)),
            dz = _mm512_sub_pd(az, _mm512_loadu_pd(z + k)), r = _mm512_add_pd(own, _mm512_loadu_pd(reach + k));
    __m512d square = _mm512_fmadd_pd(dx, dx, _mm512_fmadd_pd(dy, dy, _mm512_mul_pd(dz, dz)));
    __mmask8 near = _mm512_cmp_pd_mask(square, _mm512_mul_pd(r, r), _CMP_LT_OQ);
    const __m256i its = _mm256_loadu_si256((const __m256i *)(const void *)(id + k));
    near &= _mm256_cmpge_epu32_mask(its, _mm256_set1_epi32((int)lowest));
    if (count - k < 8) near &= (__mmask8)((1U << (count - k)) - 1);
    if (!near) continue;
    _mm256_storeu_si256((__m256i *)(void *)(found + n), _mm256_maskz_compress_epi32(near, its));
    n += (size_t)__builtin_popcount(near);
  }
#else
  for (size_t k = 0; k < count; k++) {
    double dx = at[0] - x[k], dy = at[1] - y[k], dz = at[2] - z[k], r = own_reach + reach[k];
    found[n] = id[k];
    n += (dx * dx + dy * dy + dz * dz < r * r) & (id[k] >= lowest);
  }
#endif
  return n;
}

const struct sph_pair_kernels KERNELS_TABLE = {
    .name = KERNELS_NAME,
    .sum_double = {{double_sum_plain, double_sum_artificial}, {double_sum_corrected, double_sum_both}},
    .sum_float = {{float_sum_plain, float_sum_artificial}, {float_sum_corrected, float_sum_both}},
    .within = within,
};
