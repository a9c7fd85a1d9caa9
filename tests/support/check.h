/* cmocka, and what most tests need beside it. A test is `TEST(name) { ... }`; a program runs the tests of its file in
 * the order in which they stand there. A file whose tests need something before or after them defines CHECK_OWN_MAIN
 * first and a main() that calls check_run(). */
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "analysis/analysis.h"
#include "tests/support/owned.h"

__attribute__((unused)) static struct error error; /* of the last call that failed */

/* A call that must succeed; what it says of a failure is in `error`. */
#define OK(call)                                                                                                       \
  do {                                                                                                                 \
    error.message[0] = 0;                                                                                              \
    if ((call) != STATUS_OK)                                                                                           \
      fail_msg("%s: %s", #call, error.message);                                                                        \
  } while (0)

static struct CMUnitTest check_tests[100];
static size_t check_count;

__attribute__((unused)) static void check_add(const char *name, CMUnitTestFunction run) {
  if (check_count == sizeof check_tests / sizeof *check_tests)
    abort();
  check_tests[check_count++] = (struct CMUnitTest){.name = name, .test_func = run};
}

#define TEST(name)                                                                                                     \
  static void name(void **);                                                                                           \
  __attribute__((constructor)) static void name##_is_a_test(void) {                                                    \
    check_add(#name, name);                                                                                            \
  }                                                                                                                    \
  static void name(__attribute__((unused)) void **state)

/* Returns how many tests failed. `before` and `after` run once around all of them; NULL: nothing. */
__attribute__((unused)) static int check_run(CMFixtureFunction before, CMFixtureFunction after) {
  analysis_init();
  return _cmocka_run_group_tests("tests", check_tests, check_count, before, after);
}

#ifndef CHECK_OWN_MAIN
int main(void) {
  return check_run(NULL, NULL);
}
#endif
