/* The two errors of a mean in words. */

#include "campaign/terminal/table.h"
#include "tests/support/check.h"

TEST(seeds) {
  static const struct {
    struct sample_summary mean;
    const char *expected;
  } cases[] = {
      {{.mean = 0.34912, .half_width = 0.0031}, "0.349 ± 0.003 (seeds, 95 %)"},
      {{.mean = 0.34912, .half_width = 0.0031, .weak = true}, "0.349 ± 0.003 (seeds, 95 %, weak)"},
      {{.mean = 0.34912, .half_width = 0.0144}, "0.349 ± 0.014 (seeds, 95 %)"},
      {{.mean = 0.34912, .half_width = 0.02}, "0.35 ± 0.02 (seeds, 95 %)"},
      {{.mean = 4321.6, .half_width = 34}, "4320 ± 30 (seeds, 95 %)"},
      {{.mean = -2.5e-20, .half_width = 3e-22}, "(-2.50 ± 0.03)×10^-20 (seeds, 95 %)"},
      {{.mean = 3.321e-5, .half_width = 1.66e-6}, "(3.32 ± 0.17)×10^-5 (seeds, 95 %)"},
      {{.mean = 9.7e-4, .half_width = 2e-4}, "(1.0 ± 0.2)×10^-3 (seeds, 95 %)"}, /* not (10 ± 2)×10^-4 */
      {{.mean = 4.061e7, .half_width = 1.5e6}, "(4.06 ± 0.15)×10^7 (seeds, 95 %)"},
      {{.mean = 1234567, .half_width = 340}, "1234600 ± 300 (seeds, 95 %)"}, /* five digits are no long row of zeros */
      {{.mean = 999999, .half_width = 4e4}, "1000000 ± 40000 (seeds, 95 %)"},
      {{.n = 4, .mean = 0.001, .half_width = 0.003, .low = 0, .high = 0.004}, "0.0010 (0 to 0.0040; seeds, 95 %)"},
      {{.n = 4, .mean = 3e-6, .half_width = 9e-6, .low = 0, .high = 1.2e-5}, "3×10^-6 (0 to 1.2×10^-5; seeds, 95 %)"},
      {{.n = 4, .mean = 830, .half_width = 2642, .low = 0, .high = 3472}, "800 (0 to 3500; seeds, 95 %)"},
      {{.n = 3, .mean = 3.2e7, .half_width = 5e7, .low = 0, .high = 8.2e7}, "3×10^7 (0 to 8×10^7; seeds, 95 %)"},
      {{.n = 3, .mean = 3.24e7, .half_width = 3.5e7, .low = 0, .high = 6.7e7}, "3×10^7 (0 to 7×10^7; seeds, 95 %)"},
      {{.n = 3, .mean = 1.2e7, .half_width = 1.9e7, .low = 0, .high = 3.1e7}, "1.2×10^7 (0 to 3.1×10^7; seeds, 95 %)"},
      {{.n = 4, .mean = 1, .half_width = 3.2, .low = 0, .high = 4.2}, "1.0 (0 to 4.2; seeds, 95 %)"},
      {{.n = 30, .mean = 1, .half_width = NAN, .low = 0.905, .high = 1}, "1 (all 30 runs; 0.905 to 1)"},
      {{.n = 1, .mean = 0.34912, .half_width = NAN, .low = NAN, .high = NAN}, "0.3491"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[UNCERTAINTY_TEXT];
    uncertainty_seeds(&cases[i].mean, text);
    assert_string_equal(text, cases[i].expected);
  }
}

TEST(intervals) {
  static const struct {
    double value, low, high;
    const char *expected;
  } cases[] = {
      {0.42, 0.161, 0.806, "0.4 (0.2 to 0.8)"},
      {0.42, 0.4, 0.44, "0.42 ± 0.02"},
      {3.4, 2.2, 6.7, "3.4 (2.2 to 6.7)"}, /* the smaller distance needs its digit, too */
      {0.99, 0.5, 1, "0.99 (0.50 to 1)"},
      {-2.5, -2.9, -1.3, "-2.5 (-2.9 to -1.3)"},
      {0.0689, NAN, 0.0791, "0.069 (to 0.079)"},
      {0.115, 0.0678, NAN, "0.12 (0.07 on)"},
      {2e5, 1e5, 4e5, "200000 (100000 to 400000)"},
      {5e33, 2e33, 3e34, "5×10^33 (2×10^33 to 3×10^34)"},
      {0.045314, NAN, NAN, "0.0453"},
      {2e5, NAN, NAN, "200000"},
      {1, 1, 1, "1"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[UNCERTAINTY_TEXT];
    uncertainty_interval(cases[i].value, cases[i].low, cases[i].high, text);
    assert_string_equal(text, cases[i].expected);
  }
}

TEST(resolution) {
  char text[UNCERTAINTY_TEXT];
  struct ask_resolution found;
  assert_int_equal(ask_resolution(NULL, 0, "largest_fraction", &found, NULL), STATUS_OK);
  snprintf(found.command, sizeof found.command, "basalt-sphere");
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "resolution: not studied; `clast converge basalt-sphere` measures it");
  found.verdict = ASK_RESOLUTION_KNOWN;
  found.half_width = 0.0612;
  snprintf(found.knobs, sizeof found.knobs, "particles, time_step");
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "± 0.061 (resolution: particles, time_step)");
  found.verdict = ASK_RESOLUTION_AT_LEAST; /* a part of it is not known */
  uncertainty_resolution(&found, text);
  assert_string_equal(text, ">= 0.061 (resolution: particles, time_step)");
  found.verdict = ASK_RESOLUTION_DIVERGES;
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "resolution: does not converge (`clast converge basalt-sphere`)");
  found.verdict = ASK_RESOLUTION_KNOWN;
  found.points = 9;
  found.studied = 2;
  uncertainty_resolution(&found, text);
  assert_string_equal(text,
                      "up to ± 0.061 (resolution: particles, time_step); studied at 2 of 9 points, `clast converge "
                      "basalt-sphere` studies others");
  /* A table of which some points do not converge says how many; its one number is the largest error that is known. */
  found.studied = 9;
  found.diverging = 2;
  found.verdict = ASK_RESOLUTION_DIVERGES;
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "resolution: does not converge at 2 of 9 points; the largest error of the others is 0.061 "
                            "(particles, time_step)");
  found.at_least = 4;
  uncertainty_resolution(&found, text);
  assert_string_equal(text,
                      "resolution: does not converge at 2 of 9 points, no limit is seen at 4; the largest error of "
                      "the others is at least 0.061 (particles, time_step)");
  found.verdict = ASK_RESOLUTION_AT_LEAST;
  found.at_least = 9;
  uncertainty_resolution(&found, text);
  assert_string_equal(text, "no limit is seen at 9 of 9 points; the largest error is at least 0.061 (resolution: "
                            "particles, time_step)");
}

TEST(cells) {
  static const struct {
    const char *verdict, *expected;
  } cases[] = {{"known", "0.061"},
               {"no-difference", "none seen"},
               {"at-least", ">= 0.061"},
               {"diverges", ">= 0.061"},
               {NULL, "not studied"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[UNCERTAINTY_TEXT];
    uncertainty_resolution_cell(ask_resolution_verdict(cases[i].verdict), 0.0612, text);
    assert_string_equal(text, cases[i].expected);
  }
}
