/* The pair loop of one CPU class: the including file sets WIDTH (bytes of a register), KERNELS_TABLE, KERNELS_NAME. */
#include <math.h>
#include <string.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "engine/sph/pairs/pairs_kernels.h"
#include "engine/sph/pairs/spline.h"

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
/* The sum's file declares what the others use. */
/* clang-format off */
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/pairs_kernels_correct.h"
#include "engine/sph/pairs/pairs_kernels_pack.h"
#include "engine/sph/pairs/pairs_kernels_tension.h"
/* clang-format on */
#undef VECTOR
#undef MASK
#undef UNROLL
#undef PART
#undef PARTS
#undef LEAST_SIGNAL
#undef EACH
#undef GAIN
#undef LEFT
#undef RIGHT
#undef LOW
#undef HIGH
#undef FIRST
#undef SECOND
#undef EVEN
#undef ODD
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
/* clang-format off */
#include "engine/sph/pairs/pairs_kernels_sum.h"
#include "engine/sph/pairs/pairs_kernels_pack.h"
/* clang-format on */
#undef VECTOR
#undef MASK
#undef UNROLL
#undef PART
#undef PARTS
#undef LEAST_SIGNAL
#undef EACH
#undef GAIN
#undef LEFT
#undef RIGHT
#undef LOW
#undef HIGH
#undef FIRST
#undef SECOND
#undef EVEN
#undef ODD

#include "engine/sph/pairs/pairs_kernels_near.h"

const struct sph_pair_kernels KERNELS_TABLE = {
    .name = KERNELS_NAME,
    .sum_double = {{double_sum_plain, double_sum_artificial}, {double_sum_corrected, double_sum_both}},
    .sum_float = {{float_sum_plain, float_sum_artificial}, {float_sum_corrected, float_sum_both}},
    .near_boxes = near_boxes,
    .near_particles = near_particles,
    .near_pairs = near_pairs,
    .pack_double = double_pack,
    .pack_float = float_pack,
    .unpack_double = double_unpack,
    .unpack_float = float_unpack,
    .correct = double_correct,
    .oppose = double_oppose,
};
