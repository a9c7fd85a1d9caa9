/* Strength of the scene tensile-rod against the number of particles, for the tests of two methods that keep it
 * constant. */
#pragma once

#include "tests/support/run_case.h"

/* Peak of the mean stress between the grips, Pa, seed 1. `option`: "fracture.front=plane". The run ends after the peak;
 * its end time also sets how often the stress is recorded. */
static double rod_strength_peak(const char *option, const char *rate, int particles, const char *end) {
  char options[3][64];
  snprintf(options[0], sizeof options[0], "fidelity.particles=%d", particles);
  snprintf(options[1], sizeof options[1], "stretch.rate=%s", rate);
  snprintf(options[2], sizeof options[2], "stop.end_time=%s", end);
  const struct sph_inputs inputs = SPH_CASE("tensile-rod", options[0], options[1], options[2], option);
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  free(ran.fragments);
  assert_true(ran.results.sph.peak.time < 0.99 * inputs.stop.end_time);
  return ran.results.sph.peak.stress;
}

/* Largest over smallest peak stress, less 1. */
static double rod_strength_spread(const char *option, const char *rate, const char *end, int count,
                                  const int *particles) {
  double least = INFINITY, most = 0;
  for (int k = 0; k < count; k++) {
    const double stress = rod_strength_peak(option, rate, particles[k], end);
    print_message("%s, %s, %d particles: peak %.1f MPa\n", option, rate, particles[k], stress / 1e6);
    least = fmin(least, stress);
    most = fmax(most, stress);
  }
  return most / least - 1;
}
