/* Several doubles at a time, with GCC's vector extension: one source for every CPU class.
 *
 * The including file sets LANES to its class's register width (2, 4 or 8). Data lie in blocks of eight for any
 * class, and running sums are kept per block lane, so that their order is the same everywhere. Products and sums may
 * contract to FMA where the class has it; so a run records its class. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#ifndef LANES
#error "set LANES to 2, 4 or 8"
#endif
#define LANES_INLINE static inline __attribute__((always_inline, unused))

typedef double lanes_d __attribute__((vector_size(8 * LANES)));
typedef int64_t lanes_i __attribute__((vector_size(8 * LANES)));

LANES_INLINE lanes_d lanes_all(double value) {
  return (lanes_d){0} + value;
}

LANES_INLINE lanes_d lanes_select(lanes_i mask, lanes_d yes, lanes_d no) {
  return (lanes_d)((mask & (lanes_i)yes) | (~mask & (lanes_i)no));
}

LANES_INLINE lanes_d lanes_mask(lanes_i mask, lanes_d yes) {
  return (lanes_d)(mask & (lanes_i)yes);
}

LANES_INLINE lanes_d lanes_max(lanes_d a, lanes_d b) {
  return lanes_select(a > b, a, b);
}
LANES_INLINE lanes_d lanes_min(lanes_d a, lanes_d b) {
  return lanes_select(a < b, a, b);
}
LANES_INLINE lanes_d lanes_abs(lanes_d a) {
  return (lanes_d)((lanes_i)a & INT64_MAX);
}

/* Is a lane of the mask set? x86 answers in two instructions, which GCC does not find for a loop over lanes. */
LANES_INLINE bool lanes_any(lanes_i mask) {
#if defined __AVX512F__ && LANES == 8
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined __AVX__ && LANES == 4
  return _mm256_movemask_pd((__m256d)mask) != 0;
#else
  int64_t any = 0;
  for (int lane = 0; lane < LANES; lane++)
    any |= mask[lane];
  return any != 0;
#endif
}

LANES_INLINE lanes_d lanes_load(const double *from) {
  lanes_d value;
  memcpy(&value, from, sizeof value);
  return value;
}

LANES_INLINE void lanes_store(double *to, lanes_d value) {
  memcpy(to, &value, sizeof value);
}

LANES_INLINE lanes_d lanes_gather(const double *array, const uint32_t *index) {
#if LANES == 8
  return (lanes_d){array[index[0]], array[index[1]], array[index[2]], array[index[3]],
                   array[index[4]], array[index[5]], array[index[6]], array[index[7]]};
#elif LANES == 4
  return (lanes_d){array[index[0]], array[index[1]], array[index[2]], array[index[3]]};
#else
  return (lanes_d){array[index[0]], array[index[1]]};
#endif
}

/* The same value, hidden from the compiler: it cannot be contracted into the next operation, so that two places with
 * the same formula give the same bits. */
LANES_INLINE lanes_d lanes_rounded(lanes_d value) {
#ifdef __clang__
  __asm__("" : "+m"(value)); /* clang ignores the target of a kernel's file and has no registers of this width */
#elif defined __x86_64__
  __asm__("" : "+v"(value));
#endif
  return value;
}

/* Conditions of lanes, and the largest and least value where one holds. AVX-512 keeps conditions in registers of their
 * own, and does "compare and choose" in one instruction, which GCC does not find. A lane where the condition does not
 * hold keeps its value; the values that are compared are no NaN where it holds. */
#if defined __AVX512F__ && LANES == 8
typedef __mmask8 lanes_condition;
LANES_INLINE lanes_condition lanes_positive(lanes_d a) {
  return _mm512_cmp_pd_mask((__m512d)a, _mm512_setzero_pd(), _CMP_GT_OQ);
}
LANES_INLINE lanes_condition lanes_within(lanes_d a, lanes_d bound) {
  return _mm512_cmp_pd_mask((__m512d)lanes_abs(a), (__m512d)bound, _CMP_LE_OQ);
}
LANES_INLINE lanes_d lanes_raise(lanes_condition where, lanes_d value, lanes_d to) {
  return (lanes_d)_mm512_mask_max_pd((__m512d)value, where, (__m512d)value, (__m512d)to);
}
LANES_INLINE lanes_d lanes_lower(lanes_condition where, lanes_d value, lanes_d to) {
  return (lanes_d)_mm512_mask_min_pd((__m512d)value, where, (__m512d)value, (__m512d)to);
}
#else
typedef lanes_i lanes_condition;
LANES_INLINE lanes_condition lanes_positive(lanes_d a) {
  return a > 0.0;
}
LANES_INLINE lanes_condition lanes_within(lanes_d a, lanes_d bound) {
  return lanes_abs(a) <= bound;
}
LANES_INLINE lanes_d lanes_raise(lanes_condition where, lanes_d value, lanes_d to) {
  return lanes_select(where & (to > value), to, value);
}
LANES_INLINE lanes_d lanes_lower(lanes_condition where, lanes_d value, lanes_d to) {
  return lanes_select(where & (to < value), to, value);
}
#endif

/* a / b, the same bits as the division, without the divider of the CPU: a loop that divides often runs faster when
 * half of its quotients come from here, because both ways then work at the same time. Newton's steps for 1/b, then two
 * corrections of the quotient by its remainder, which the FMA gives exactly (Markstein, IBM J. Res. Dev. 34, 111,
 * 1990). +infinity where b is 0. |a| and |b| are 0 or from 1e-290 to 1e290: beyond, it may be NaN. */
LANES_INLINE lanes_d lanes_quotient(lanes_d a, lanes_d b) {
#if defined __AVX512F__ && LANES == 8
  const __m512d n = (__m512d)a, d = (__m512d)b, one = _mm512_set1_pd(1.0);
  const __m512d y0 = _mm512_rcp14_pd(d), e0 = _mm512_fnmadd_pd(d, y0, one); /* 14 bits of 1/b, and their error */
  const __m512d y1 = _mm512_fmadd_pd(_mm512_fmadd_pd(e0, e0, e0), y0, y0);  /* 42 bits */
  const __m512d y2 = _mm512_fmadd_pd(_mm512_fnmadd_pd(d, y1, one), y1, y1); /* rounded */
  const __m512d q0 = _mm512_mul_pd(n, y1);
  const __m512d q1 = _mm512_fmadd_pd(_mm512_fnmadd_pd(d, q0, n), y1, q0);
  const __m512d q2 = _mm512_fmadd_pd(_mm512_fnmadd_pd(d, q1, n), y2, q1);
  const __m512i infinite_at_zero = _mm512_set1_epi64(5 << 2 * 4); /* entry 2 is "b is 0", answer 5 is infinity */
  return (lanes_d)_mm512_fixupimm_pd(q2, d, infinite_at_zero, 0);
#else
  return lanes_rounded(a / b);
#endif
}

LANES_INLINE lanes_d lanes_sqrt(lanes_d a) {
  lanes_d root;
  for (int lane = 0; lane < LANES; lane++)
    root[lane] = __builtin_sqrt(a[lane]);
  return root;
}

/* Sine and cosine: Cody-Waite reduction by pi/2 in three parts and the polynomials of FreeBSD's msun k_sin.c and
 * k_cos.c (Sun Microsystems 1993); within 1e-15 for |angle| < 1e6, exactly 0 and 1 at 0. */
LANES_INLINE void lanes_sincos(lanes_d angle, lanes_d *sine, lanes_d *cosine) {
  const lanes_d magic = lanes_all(6755399441055744.0); /* 1.5 x 2^52: adding it rounds to an integer in the low bits */
  lanes_d turns = angle * 0.63661977236758134308 + magic;
  const lanes_i quadrant = (lanes_i)turns & 3;
  turns -= magic;
  lanes_d r = angle - turns * 1.57079632673412561417e+00;
  r -= turns * 6.07710050630396597660e-11;
  r -= turns * 2.02226624879595063154e-21;
  const lanes_d z = r * r;
  const lanes_d s = r + r * z *
                            (-1.66666666666666324348e-01 +
                             z * (8.33333333332248946124e-03 +
                                  z * (-1.98412698298579493134e-04 +
                                       z * (2.75573137070700676789e-06 +
                                            z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
  const lanes_d c = 1.0 - 0.5 * z +
                    z * z *
                        (4.16666666666666019037e-02 +
                         z * (-1.38888888888741095749e-03 +
                              z * (2.48015872894767294178e-05 +
                                   z * (-2.75573143513906633035e-07 +
                                        z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const lanes_i odd = -(quadrant & 1);
  const lanes_i sine_negative = (quadrant & 2) << 62, cosine_negative = ((quadrant + 1) & 2) << 62;
  *sine = (lanes_d)((lanes_i)lanes_select(odd, c, s) ^ sine_negative);
  *cosine = (lanes_d)((lanes_i)lanes_select(odd, s, c) ^ cosine_negative);
}
