/* The two errors of a mean in words. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <math.h>
#include <stdio.h>
#include <cmocka.h>

#include "campaign/terminal/uncertainty.h"

static void seeds(void **state) {
  (void)state;
  static const struct {
    double mean, half_width;
    const char *expected;
  } cases[] = {
      {0.34912, 0.0031, "0.349 +- 0.003 (seeds, 95 %)"},
      {0.34912, 0.0144, "0.349 +- 0.014 (seeds, 95 %)"},
      {0.34912, 0.02, "0.35 +- 0.02 (seeds, 95 %)"},
      {4321.6, 34, "4322 +- 34 (seeds, 95 %)"},
      {1, 0, "1 +- 0 (seeds, 95 %)"},
      {-2.5e-20, 3e-22, "-2.5e-20 +- 3e-22 (seeds, 95 %)"},
      {0.34912, NAN, "0.3491 (one run: no interval)"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[UNCERTAINTY_TEXT];
    uncertainty_seeds(cases[i].mean, cases[i].half_width, text);
    assert_string_equal(text, cases[i].expected);
  }
}

static void resolution(void **state) {
  (void)state;
  char text[UNCERTAINTY_TEXT];
  struct ask_resolution found;
  assert_int_equal(ask_resolution(NULL, 0, "largest_fraction", &found, NULL), STATUS_OK);
  snprintf(found.scene, sizeof found.scene, "basalt-sphere");
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "resolution: not studied; `clast converge basalt-sphere` measures it");
  found.verdict = ASK_RESOLUTION_KNOWN;
  found.half_width = 0.0612;
  snprintf(found.knobs, sizeof found.knobs, "particles, time_step");
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "+- 0.061 (resolution: particles, time_step)");
  found.verdict = ASK_RESOLUTION_AT_LEAST;
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "+- 0.061 or more (resolution: particles, time_step)");
  found.verdict = ASK_RESOLUTION_DIVERGES;
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "resolution: does not converge (`clast converge basalt-sphere`)");
  found.verdict = ASK_RESOLUTION_KNOWN;
  found.points = 9;
  found.studied = 2;
  uncertainty_resolution(&found, text);
  assert_string_equal(text,
                      "up to +- 0.061 (resolution: particles, time_step); studied at 2 of 9 points, `clast converge "
                      "basalt-sphere` studies others");
}

static void cells(void **state) {
  (void)state;
  static const struct {
    const char *verdict, *expected;
  } cases[] = {{"known", "0.061"}, {"at-least", ">= 0.061"}, {"diverges", "diverges"}, {NULL, "not studied"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[UNCERTAINTY_TEXT];
    uncertainty_resolution_cell(ask_resolution_verdict(cases[i].verdict), 0.0612, text);
    assert_string_equal(text, cases[i].expected);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(seeds), cmocka_unit_test(resolution), cmocka_unit_test(cells)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
