/* The vocabulary of the SIMD kernels, in one precision and for registers of WIDTH bytes (templates_on.h): each
 * operation has one name here and one definition per instruction set. GCC's vector extension does the arithmetic (a +
 * b, a * b); operations that it lacks, or compiles to more than one instruction, have a function.
 *
 * A register is seen as quarters of 16 bytes, each of them QUARTER numbers: shuffles within quarters are cheap. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#define INLINE static inline __attribute__((always_inline, unused))
#define UNROLL _Pragma("GCC unroll 32")

#define LANES    (WIDTH / REAL_BYTES) /* numbers in a register */
#define QUARTER  (16 / REAL_BYTES)    /* numbers in a quarter of 16 bytes */
#define QUARTERS (WIDTH / 16)         /* in a register: one, two or four */

#define vec              TYPED(vec)
#define vec_int          TYPED(vec_int)
#define vec_mask         TYPED(vec_mask)
#define vec_load         TYPED(vec_load)
#define vec_store        TYPED(vec_store)
#define vec_load_first   TYPED(vec_load_first)
#define vec_store_first  TYPED(vec_store_first)
#define vec_inverse      TYPED(vec_inverse)
#define vec_inverse_root TYPED(vec_inverse_root)
#define vec_less         TYPED(vec_less)
#define vec_first_lanes  TYPED(vec_first_lanes)
#define vec_any          TYPED(vec_any)
#define vec_select       TYPED(vec_select)
#define vec_keep         TYPED(vec_keep)
#define vec_max          TYPED(vec_max)
#define vec_keep_max     TYPED(vec_keep_max)
#define vec_max_in       TYPED(vec_max_in)
#define vec_add_where    TYPED(vec_add_where)
#define vec_abs          TYPED(vec_abs)
#define vec_low_numbers  TYPED(vec_low_numbers)
#define vec_high_numbers TYPED(vec_high_numbers)
#define vec_low_halves   TYPED(vec_low_halves)
#define vec_high_halves  TYPED(vec_high_halves)
#define vec_even_parts   TYPED(vec_even_parts)
#define vec_odd_parts    TYPED(vec_odd_parts)
#define vec_low_parts    TYPED(vec_low_parts)
#define vec_high_parts   TYPED(vec_high_parts)
#define vec_turn         TYPED(vec_turn)
#define vec_transpose    TYPED(vec_transpose)

typedef REAL vec __attribute__((vector_size(WIDTH)));
typedef INT vec_int __attribute__((vector_size(WIDTH)));

/* ---- memory ---- */

INLINE vec vec_load(const REAL *from) { /* aligned to WIDTH */
  return *(const vec *)(const void *)from;
}
INLINE void vec_store(REAL *to, vec v) { /* aligned to WIDTH */
  *(vec *)(void *)to = v;
}
INLINE vec vec_load_first(const REAL *from, size_t count) { /* the other lanes are zero; any alignment */
  vec v = {0};
  memcpy(&v, from, count * sizeof *from);
  return v;
}
INLINE void vec_store_first(REAL *to, vec v, size_t count) { /* any alignment */
  memcpy(to, &v, count * sizeof *to);
}

/* ---- inverses ---- */

/* 1/a and 1/sqrt(a). AVX-512 has approximations to 14 bits. Newton's iteration refines them, twice for double (within
 * 2 ulp), once for float: half the time of the division unit. */
#ifdef __AVX512F__
INLINE vec vec_inverse(vec a) {
  vec y = (vec)MM512(rcp14_, )(a);
  if (!SINGLE)
    y *= 2 - a * y;
  return y * (2 - a * y);
}
INLINE vec vec_inverse_root(vec a) {
  vec y = (vec)MM512(rsqrt14_, )(a);
  const vec half = (REAL)0.5 * a;
  if (!SINGLE)
    y *= (REAL)1.5 - half * y * y;
  return y * ((REAL)1.5 - half * y * y);
}
#else
INLINE vec vec_inverse(vec a) {
  return 1 / a;
}
INLINE vec vec_inverse_root(vec a) {
  for (size_t lane = 0; lane < LANES; lane++)
    a[lane] = SINGLE ? (REAL)__builtin_sqrtf((float)a[lane]) : (REAL)__builtin_sqrt((double)a[lane]);
  return 1 / a;
}
#endif

/* ---- choices between lanes ---- */

/* A mask is true or false for each lane: a bit with AVX-512, else all bits of the lane. */
#ifdef __AVX512F__
#if SINGLE
typedef __mmask16 vec_mask;
#else
typedef __mmask8 vec_mask;
#endif
INLINE vec_mask vec_less(vec a, vec b) {
  return MM512(cmp_, _mask)(a, b, _CMP_LT_OQ);
}
INLINE vec_mask vec_first_lanes(INT count) {
  return (vec_mask)(count < LANES ? (1U << count) - 1 : (1U << LANES) - 1);
}
INLINE bool vec_any(vec_mask mask) {
  return mask != 0;
}
INLINE vec vec_select(vec_mask mask, vec yes, vec no) {
  return (vec)MM512(mask_blend_, )(mask, no, yes);
}
INLINE vec vec_keep(vec_mask mask, vec yes) { /* elsewhere zero */
  return (vec)MM512(maskz_mov_, )(mask, yes);
}
INLINE vec vec_max(vec a, vec b) {
  return (vec)MM512(max_, )(a, b);
}
INLINE vec vec_keep_max(vec_mask mask, vec a, vec b) { /* elsewhere zero */
  return (vec)MM512(maskz_max_, )(mask, a, b);
}
INLINE vec vec_add_where(vec a, vec_mask mask, vec b) { /* elsewhere a */
  return (vec)MM512(mask_add_, )(a, mask, a, b);
}
INLINE vec vec_max_in(unsigned lanes, vec a, vec b, vec elsewhere) { /* in the lanes whose bits are set */
  return (vec)MM512(mask_max_, )(elsewhere, (vec_mask)lanes, a, b);
}
#else
typedef INT vec_mask __attribute__((vector_size(WIDTH)));
INLINE vec_mask vec_less(vec a, vec b) {
  return a < b;
}
INLINE vec_mask vec_first_lanes(INT count) {
  vec_mask lanes;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    lanes[lane] = lane;
  return lanes < count;
}
INLINE bool vec_any(vec_mask mask) {
  INT seen = 0;
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    seen |= mask[lane];
  return seen != 0;
}
INLINE vec vec_select(vec_mask mask, vec yes, vec no) {
  return (vec)((mask & (vec_mask)yes) | (~mask & (vec_mask)no));
}
INLINE vec vec_keep(vec_mask mask, vec yes) {
  return (vec)(mask & (vec_mask)yes);
}
INLINE vec vec_max(vec a, vec b) {
  return vec_select(a > b, a, b);
}
INLINE vec vec_keep_max(vec_mask mask, vec a, vec b) {
  return vec_keep(mask, vec_max(a, b));
}
INLINE vec vec_add_where(vec a, vec_mask mask, vec b) {
  return a + vec_keep(mask, b);
}
INLINE vec vec_max_in(unsigned lanes, vec a, vec b, vec elsewhere) {
  vec_mask pick = {0};
  UNROLL
  for (int lane = 0; lane < LANES; lane++)
    pick[lane] = lanes >> lane & 1 ? -1 : 0;
  return vec_select(pick, vec_max(a, b), elsewhere);
}
#endif

INLINE vec vec_abs(vec a) {
  return vec_select(vec_less(a, (vec){0}), -a, a);
}

/* ---- shuffles of two registers ---- */

/* low_numbers, high_numbers: of each quarter's lower (higher) two numbers those of a and b in turn (float only).
 * low_halves, high_halves: of each quarter the lower (higher) 8 bytes of a, then those of b.
 * even_parts, odd_parts: the even (odd) quarters of a, then those of b.
 * low_parts, high_parts: the lower (higher) two of four quarters, of a and b in turn (8 doubles only). */
#define SHUFFLE(name, ...)                                                                                             \
  INLINE vec name(vec a, vec b) {                                                                                      \
    return __builtin_shufflevector(a, b, __VA_ARGS__);                                                                 \
  }
#if !SINGLE && WIDTH == 16
SHUFFLE(vec_low_halves, 0, 2)
SHUFFLE(vec_high_halves, 1, 3)
#elif !SINGLE && WIDTH == 32
SHUFFLE(vec_low_halves, 0, 4, 2, 6)
SHUFFLE(vec_high_halves, 1, 5, 3, 7)
SHUFFLE(vec_even_parts, 0, 1, 4, 5)
SHUFFLE(vec_odd_parts, 2, 3, 6, 7)
#elif !SINGLE
SHUFFLE(vec_low_halves, 0, 8, 2, 10, 4, 12, 6, 14)
SHUFFLE(vec_high_halves, 1, 9, 3, 11, 5, 13, 7, 15)
SHUFFLE(vec_even_parts, 0, 1, 4, 5, 8, 9, 12, 13)
SHUFFLE(vec_odd_parts, 2, 3, 6, 7, 10, 11, 14, 15)
SHUFFLE(vec_low_parts, 0, 1, 8, 9, 2, 3, 10, 11)
SHUFFLE(vec_high_parts, 4, 5, 12, 13, 6, 7, 14, 15)
#elif WIDTH == 16
SHUFFLE(vec_low_numbers, 0, 4, 1, 5)
SHUFFLE(vec_high_numbers, 2, 6, 3, 7)
SHUFFLE(vec_low_halves, 0, 1, 4, 5)
SHUFFLE(vec_high_halves, 2, 3, 6, 7)
#elif WIDTH == 32
SHUFFLE(vec_low_numbers, 0, 8, 1, 9, 4, 12, 5, 13)
SHUFFLE(vec_high_numbers, 2, 10, 3, 11, 6, 14, 7, 15)
SHUFFLE(vec_low_halves, 0, 1, 8, 9, 4, 5, 12, 13)
SHUFFLE(vec_high_halves, 2, 3, 10, 11, 6, 7, 14, 15)
SHUFFLE(vec_even_parts, 0, 1, 2, 3, 8, 9, 10, 11)
SHUFFLE(vec_odd_parts, 4, 5, 6, 7, 12, 13, 14, 15)
#else
SHUFFLE(vec_low_numbers, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
SHUFFLE(vec_high_numbers, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
SHUFFLE(vec_low_halves, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
SHUFFLE(vec_high_halves, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
SHUFFLE(vec_even_parts, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
SHUFFLE(vec_odd_parts, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)
#endif

/* Within the quarters of QUARTER registers rows become columns. */
INLINE void vec_turn(const vec r[QUARTER], vec u[QUARTER]) {
#if SINGLE
  const vec a = vec_low_numbers(r[0], r[1]), b = vec_high_numbers(r[0], r[1]);
  const vec c = vec_low_numbers(r[2], r[3]), d = vec_high_numbers(r[2], r[3]);
  u[0] = vec_low_halves(a, c);
  u[1] = vec_high_halves(a, c);
  u[2] = vec_low_halves(b, d);
  u[3] = vec_high_halves(b, d);
#else
  u[0] = vec_low_halves(r[0], r[1]);
  u[1] = vec_high_halves(r[0], r[1]);
#endif
}

/* Rows become columns: first within the quarters, then the quarters among registers. */
INLINE void vec_transpose(vec r[LANES]) {
  vec u[LANES];
  UNROLL
  for (int g = 0; g < LANES; g += QUARTER)
    vec_turn(r + g, u + g);
  UNROLL
  for (int c = 0; c < QUARTER; c++) {
#if QUARTERS == 1
    r[c] = u[c];
#elif QUARTERS == 2
    r[c] = vec_even_parts(u[c], u[QUARTER + c]);
    r[QUARTER + c] = vec_odd_parts(u[c], u[QUARTER + c]);
#else
    const vec a = vec_even_parts(u[c], u[QUARTER + c]), b = vec_even_parts(u[2 * QUARTER + c], u[3 * QUARTER + c]);
    const vec d = vec_odd_parts(u[c], u[QUARTER + c]), e = vec_odd_parts(u[2 * QUARTER + c], u[3 * QUARTER + c]);
    r[c] = vec_even_parts(a, b);
    r[QUARTER + c] = vec_even_parts(d, e);
    r[2 * QUARTER + c] = vec_odd_parts(a, b);
    r[3 * QUARTER + c] = vec_odd_parts(d, e);
#endif
  }
}
