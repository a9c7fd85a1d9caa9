/* Quotients without the divider against divisions, bit by bit: lanes.h, class v4. */
#define CHECK_OWN_MAIN

#include "engine/cpu_class.h"

#ifdef __x86_64__
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
#endif
#ifdef __AVX512F__ /* clang leaves the line before out: then a quotient is a division */
#define LANES 8
#include "engine/dem/step/lanes.h"
#include "tests/support/check.h"

enum { RANDOM, RECIPROCAL, MIDDLE, KINDS, BLOCKS = 400000 };

__extension__ typedef unsigned __int128 wide;

static uint64_t next(uint64_t *state) { /* splitmix64 (Steele, Lea and Flood 2014) */
  uint64_t z = *state += 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return z ^ z >> 31;
}

/* In [1, 2) times a power of two between -range and range, either sign. */
static double draw(uint64_t *state, int range) {
  const uint64_t bits = next(state);
  const double value = ldexp(1.0 + (double)(bits >> 12) * 0x1p-52,
                             (int)(next(state) % (2 * (unsigned)range + 1)) - range);
  return bits & 1 ? -value : value;
}

/* a and b of 53 bits whose quotient is as near as can be to m, the middle between two doubles (m has 54 bits and is
 * odd): b m = 2^54 a +- 1, so b is the inverse of m or -m modulo 2^54, by Newton's steps. False: m has no such pair. */
static bool nearest_to_middle(uint64_t m, bool above, double *a, double *b) {
  uint64_t inverse = m;
  for (int step = 0; step < 5; step++)
    inverse *= 2 - m * inverse;
  inverse = (above ? 0 - inverse : inverse) & (((uint64_t)1 << 54) - 1);
  const uint64_t numerator = (uint64_t)(((wide)inverse * m + above) >> 54);
  *a = (double)numerator;
  *b = (double)inverse;
  return inverse >> 53 == 0 && numerator >> 53 == 0;
}

/* Numerators and denominators of a kind: any; denominators just below a power of two, where 1/b is hardest to round;
 * quotients at the middle between two doubles, nearly. */
static void fill(int kind, uint64_t *state, double a[8], double b[8]) {
  for (int lane = 0; lane < 8; lane++) {
    a[lane] = draw(state, kind == RANDOM ? 400 : 3);
    b[lane] = draw(state, kind == RANDOM ? 400 : 3);
    if (kind == RECIPROCAL)
      b[lane] = ldexp(2.0 - (double)(1 + next(state) % 16) * 0x1p-52, (int)(next(state) % 9) - 4);
    while (kind == MIDDLE &&
           !nearest_to_middle(next(state) >> 10 | (uint64_t)1 << 53 | 1, lane & 1, &a[lane], &b[lane]))
      continue;
  }
}

static void quotients_are_rounded_as_divisions_are(void **unused) {
  (void)unused;
  for (int kind = 0; kind < KINDS; kind++) {
    uint64_t state = 17 + (uint64_t)kind;
    for (int block = 0; block < BLOCKS / 8; block++) {
      double a[8], b[8], q[8];
      fill(kind, &state, a, b);
      lanes_store(q, lanes_quotient(lanes_load(a), lanes_load(b)));
      for (int lane = 0; lane < 8; lane++)
        if (q[lane] != a[lane] / b[lane])
          fail_msg("kind %d: %a / %a is %a, not %a", kind, a[lane], b[lane], a[lane] / b[lane], q[lane]);
    }
  }
}

static void quotients_by_nothing_are_infinite(void **unused) {
  (void)unused;
  const double a[8] = {1.0, -1.0, 3e-20, 1.0, 0.0, -0.0, 2.0, -2.0}, b[8] = {0.0, 0.0, -0.0, 1.0, 2.0, -2.0, 4.0, 4.0};
  double q[8];
  lanes_store(q, lanes_quotient(lanes_load(a), lanes_load(b)));
  for (int lane = 0; lane < 3; lane++)
    assert_true(q[lane] == (double)INFINITY);
  for (int lane = 3; lane < 8; lane++)
    assert_true(q[lane] == a[lane] / b[lane]);
}

static int run(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quotients_are_rounded_as_divisions_are),
      cmocka_unit_test(quotients_by_nothing_are_infinite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
#endif
#ifdef __x86_64__
#pragma GCC pop_options
#endif

int main(void) {
#ifdef LANES
  if (cpu_class_choose() == CPU_V4)
    return run();
#endif
  puts("skipped: this CPU or this compiler has no AVX-512 (class v4)");
  return 77;
}
