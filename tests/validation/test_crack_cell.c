/* The strength of a stretched rod (Benz & Asphaug 1995, section 5.1) over the number of particles, when cells of a
 * fixed width crack as one (module crack_cell).
 *
 * Quick: 3000 and 12 000 particles at 60 /s. CLAST_FULL=1: 3000 to 150 000 at 60 and 360 /s. */
#include "tests/support/run_case.h"

enum { MOST = 4 };

/* Peak of the mean stress between the grips, Pa. The end of the run is after the peak. */
static double peak(const char *cell, const char *rate, int particles, const char *end) {
  char options[4][64];
  snprintf(options[0], sizeof options[0], "fidelity.particles=%d", particles);
  snprintf(options[1], sizeof options[1], "stretch.rate=%s", rate);
  snprintf(options[2], sizeof options[2], "stop.end_time=%s", end);
  snprintf(options[3], sizeof options[3], "fracture.cell=%s", cell);
  const struct sph_inputs inputs = SPH_CASE("tensile-rod", options[0], options[1], options[2], options[3]);
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  free(ran.fragments);
  assert_true(ran.results.sph.peak.time < 0.99 * inputs.stop.end_time);
  return ran.results.sph.peak.stress;
}

/* Largest over smallest peak stress, less 1. */
static double spread(const char *cell, const char *rate, const char *end) {
  static const int particles[MOST] = {3000, 12000, 50000, 150000};
  double least = INFINITY, most = 0;
  for (int k = 0; k < (run_case_full() ? MOST : 2); k++) {
    const double stress = peak(cell, rate, particles[k], end);
    print_message("fracture.cell: %-4s %s, %6d particles: peak %.1f MPa\n", cell, rate, particles[k], stress / 1e6);
    least = fmin(least, stress);
    most = fmax(most, stress);
  }
  return most / least - 1;
}

static void strength_depends_on_the_cell(void **state) {
  (void)state;
  assert_true(spread("2 mm", "60 1/s", "18 us") < 0.05);
  assert_true(spread("0 m", "60 1/s", "18 us") > 0.1); /* N^(1/m), as printed */
  if (run_case_full())
    assert_true(spread("2 mm", "360 1/s", "4 us") < 0.05);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(strength_depends_on_the_cell)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
