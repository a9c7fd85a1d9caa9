/* Compressive strength test (K99 section 3.2, figures 8 and 9): linear, then abrupt failure; cracks along the load;
 * triangles on the confined ends intact. Quick: one body of 25 x 40, at twice the rate. CLAST_FULL=1: five, and again
 * at half the rate. */
#include "tests/support/run_case.h"

#include "engine/dem/run/run.h"

struct figures {
  double modulus, strength, strain, residue, drop, upright, triangle, broken;
};

/* Cracks within 30 degrees of the load, counted from the outlines: the crack joins the two vertices that both grains
 * have. */
static double upright_by_outlines(const struct dem_run *run) {
  const struct dem_tessellation *t = run->tessellation;
  const struct dem_break *log;
  const size_t breaks = dem_system_breaks(run->system, &log);
  double upright = 0, all = 0;
  for (size_t k = 0; k < breaks; k++) {
    if (log[k].time > run->state.time_peak)
      continue;
    const uint32_t *pair = t->pair[log[k].beam];
    struct dem_point end[2] = {{0, 0}, {0, 0}};
    size_t shared = 0;
    for (uint32_t v = t->first_vertex[pair[0]]; v < t->first_vertex[pair[0] + 1]; v++)
      for (uint32_t w = t->first_vertex[pair[1]]; w < t->first_vertex[pair[1] + 1]; w++)
        if (hypot(t->vertex[v].x - t->vertex[w].x, t->vertex[v].y - t->vertex[w].y) < 1e-9 * run->inputs.grain.spacing)
          end[shared++ % 2] = t->vertex[v];
    assert_int_equal(shared, 2);
    all += 1;
    upright += atan2(fabs(end[1].x - end[0].x), fabs(end[1].y - end[0].y)) < M_PI / 6;
  }
  return upright / all;
}

static struct figures press(const struct dem_inputs *inputs, uint64_t seed) {
  struct dem_run *run;
  OK(dem_run_create(inputs, seed, &run, &error));
  while (!run->state.frame.finished)
    frame_advance(&run->frame, 10000);
  assert_int_equal(run->state.frame.outcome_state, OUTCOME_COMPLETED);
  struct outcome outcome;
  struct dem_results r;
  OWNED struct fragment *fragments = NULL;
  size_t count;
  assert_int_equal(dem_report_finish(run, &outcome, &r, &fragments, &count, NULL), STATUS_OK);
  struct figures f = {.modulus = r.young_modulus,
                      .strength = r.strength,
                      .strain = r.failure_strain,
                      .upright = r.upright_share,
                      .triangle = r.end_triangle_share,
                      .broken = r.broken_share};
  assert_true(fabs(f.upright - upright_by_outlines(run)) < 1e-12);
  /* Linear: largest departure from the fitted line up to 70 % of the failure strain, over the strength. The line's
   * intercept is what the samples between 10 and 50 % leave. */
  double n = 0, shift = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t k = 0; k < run->state.frame.samples; k++) {
      double strain = -run->sample[k].strain, stress = -run->sample[k].stress;
      if (pass == 0 && strain > 0.1 * f.strain && strain < 0.5 * f.strain) {
        shift += stress - f.modulus * strain;
        n += 1;
      }
      if (pass == 1 && strain > 0.1 * f.strain && strain < 0.7 * f.strain)
        f.residue = fmax(f.residue, fabs(stress - f.modulus * strain - shift / n) / f.strength);
    }
  /* Abrupt: time from the maximum to half of it, in wave passages along the block (height over sqrt(E/rho)): a crack
   * cannot end the load before a wave arrives, however slow the load. */
  double passage = (double)inputs->body.rows * inputs->grain.spacing / r.sound_speed_extension;
  f.drop = NAN;
  for (size_t k = 0; k < run->state.frame.samples; k++)
    if (run->sample[k].time > run->state.time_peak && -run->sample[k].stress < 0.5 * f.strength) {
      f.drop = (run->sample[k].time - run->state.time_peak) / passage;
      break;
    }
  print_message("%4d %9.4g %9.4g %8.4f %8.4f %8.4f %8.3f %8.3f %8.3f %10.2e %10.2e\n", (int)seed, f.modulus, f.strength,
                f.strain, f.residue, f.drop, f.upright, f.triangle, f.broken, outcome.energy_error,
                outcome.momentum_error);
  assert_true(outcome.energy_error < 1e-3); /* at most 1.1e-4 of eight bodies */
  dem_run_free(run);
  return f;
}

static struct figures press_all(const struct dem_inputs *inputs, uint64_t bodies) {
  struct figures sum = {0};
  double *to = &sum.modulus;
  print_message("%4s %9s %9s %8s %8s %8s %8s %8s %8s %10s %10s\n", "seed", "K, Pa", "strength", "strain", "bend",
                "drop", "upright", "triangle", "broken", "energy", "momentum");
  for (uint64_t seed = 1; seed <= bodies; seed++) {
    struct figures f = press(inputs, seed);
    const double *from = &f.modulus;
    for (size_t k = 0; k < sizeof f / sizeof(double); k++)
      to[k] += from[k] / (double)bodies;
  }
  print_message("mean %9.4g %9.4g %8.4f %8.4f %8.4f %8.3f %8.3f %8.3f\n", sum.modulus, sum.strength, sum.strain,
                sum.residue, sum.drop, sum.upright, sum.triangle, sum.broken);
  return sum;
}

TEST(failure_is_abrupt_and_cracks_are_upright) {
  struct dem_inputs inputs = DEM_CASE("compression", NULL);
  if (!run_case_full())
    inputs.loading.rate *= 2;
  struct figures f = press_all(&inputs, run_case_seeds(1, 5));
  assert_true(f.residue < 0.1);  /* "linear until it fails": within a tenth of the strength up to 70 % of the strain */
  assert_true(f.drop < 3);       /* "abruptly": half of the stress is gone within a few wave passages */
  assert_true(f.upright > 0.5);  /* isotropic cracks: 1/3 */
  assert_true(f.triangle < 0.2); /* "practically intact": 0.02 to 0.1 here; sides free to slide give 0.48 */
  if (run_case_full()) {
    inputs.loading.rate /= 2;
    struct figures slow = press_all(&inputs, run_case_seeds(1, 5));
    /* quasi-static: the strength does not depend on the rate */
    assert_true(fabs(slow.strength / f.strength - 1) < 0.1);
  }
}
