/* The basalt sphere of Benz & Asphaug 1995 [BA95] section 5.2, and how much is left of it against the energy.
 *
 * The paper: a nearly spherical core of 0.35 of the mass (experiment: 0.31), everything near the point of impact broken to
 * less than what is resolved, the second largest fragment a spall nearly opposite; "very similar" for other draws of flaws
 * and half the particles. Quick: a few seeds of a coarse sphere. CLAST_FULL=1: more of each, for engine/sph/VALIDATION.md;
 * CLAST_SEEDS=n changes the number, CLAST_PARTICLES=n the resolution.
 *
 * Largest fragments jump when a bridge of rock holds or not, and brackets wide enough for that are wide enough for a wrong
 * speed of cracks. Damage on its way through the sphere is smooth: that is pinned first, by this code's own numbers. */
#include "tests/run_case.h"

#include "analysis/sample.h"
#include "engine/sph/run.h"

enum { MOST_RUNS = 1000 };
static const double radius = 0.03;

static const char *particles(const char *quick, const char *full) {
  static char text[64];
  const char *asked = getenv("CLAST_PARTICLES");
  snprintf(text, sizeof text, "fidelity.particles=%s", asked ? asked : run_case_full() ? full : quick);
  return text;
}

struct sphere {
  struct outcome outcome;
  struct sph_results results;
  double near_damage;  /* mean damage of what stood within R/2 of the point of impact */
  double core_offset;  /* m, from the sphere's centre to where the middle of the largest fragment's bare core had been */
};

static struct sphere run_sphere(const struct sph_inputs *inputs, uint64_t seed) {
  struct sphere s = {0};
  struct sph_run *run;
  struct fragment *fragments;
  struct sph_pieces pieces;
  size_t count;
  struct error error = {0};
  if (sph_run_create(inputs, seed, &run, &error)) fail_msg("%s", error.message);
  while (!run->state.finished)
    sph_run_advance(run, 1000);
  assert_int_equal(sph_report_finish(run, &s.outcome, &s.results, &fragments, &count, &error), STATUS_OK);
  free(fragments);
  assert_int_equal(sph_report_pieces(run, inputs->fragments.static_strength, inputs->fragments.veneer, &pieces, &error), STATUS_OK);
  double near = 0, core = 0, middle[3] = {0, 0, 0};
  for (size_t i = 0; i < run->targets; i++) {
    const double at[3] = {run->start->x[i], run->start->y[i], run->start->z[i]};
    double square = 0;
    for (int d = 0; d < 3; d++)
      square += (at[d] - radius * run->impact_direction[d]) * (at[d] - radius * run->impact_direction[d]);
    if (square < radius * radius / 4) {
      near += 1;
      s.near_damage += pow(run->now->damage_cbrt[i], 3);
    }
    if (pieces.label[i] == 0 && pieces.part[i] == SPH_PIECES_CORE) {
      core += 1;
      for (int d = 0; d < 3; d++)
        middle[d] += at[d];
    }
  }
  s.near_damage /= near;
  s.core_offset = sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]) / core;
  sph_pieces_clear(&pieces);
  sph_run_free(run);
  print_message("%6.3f kJ/kg seed %2d: M1/M %.3f bare %.3f dynamic %.3f M2/M %.3f at %3.0f deg, axes %.2f %.2f, core %.2f R off the "
                "centre, near damage %.3f, dust %.3f, ceased %.0f us, energy %.1e, %s\n",
                s.results.specific_energy / 1e3, (int)seed, s.results.largest.veneer_fraction, s.results.largest.bare_fraction,
                s.results.largest.dynamic_fraction, s.outcome.second_fraction, s.results.second.angle * 57.295779513082321,
                s.results.largest.axis_middle, s.results.largest.axis_short, s.core_offset / radius, s.near_damage,
                s.outcome.dust_fraction, 1e6 * s.results.cease_time, s.outcome.energy_error, s.outcome.message);
  return s;
}

/* Bounds of one run. Energy: the 0.5 %, measured 2e-5. */
static void sound(const struct sphere *s) {
  assert_true(s->outcome.state == OUTCOME_COMPLETED || s->outcome.state == OUTCOME_END_TIME);
  assert_true(s->outcome.energy_error < 0.005);
  assert_true(fabs(s->results.clamped_share) <= 0.001);
  assert_true(s->outcome.momentum_error < 1e-12);
}

static void summary(const char *name, size_t n, const double *values) {
  struct sample_summary s = sample_summarise(n, values, 0.95);
  print_message("%-24s %.4f +- %.4f (95 %%), scatter %.4f, from %.4f to %.4f\n", name, s.mean, s.half_width,
                s.standard_deviation, s.minimum, s.maximum);
}

static void pinned(const char *what, double value, double expected, double tolerance) {
  print_message("%-44s %.5f, pinned %.5f within %.0f %%\n", what, value, expected, 100 * tolerance);
  if (!(fabs(value / expected - 1) < tolerance)) fail_msg("%s: %.5f instead of %.5f", what, value, expected);
}

/* How far damage has come, mean of seeds 1 to 3 at 3000 particles: at 3 us, when it has just begun under the point of impact and
 * waits for the growth of cracks, and at 16 us, when the wave has come back from the far side. Not the paper's numbers but this
 * engine's of results_version 2, to be pinned anew when physics changes on purpose.
 * What means the same physics moved them by (cfl 0.2, cfl 0.4, precision float, flaws compact):
 *                      3 us: 0 %, +5 %, 0, +1 %      16 us: +0.7, -0.8, 0, +0.4 %      share reached: +0.4, -0.6, +0.1, 0 %
 * What means another one (cracks twice as fast, half as fast, k halved, damage not applied to shear, not to tension):
 *                      3 us: +15, -32, -4, -4, 0 %   16 us: -3, +3, -5, +16, +18 %     share reached: -4, +6, -4, +11, +14 %
 * The tolerances stand between: each of those five is red. */
static void damage_on_its_way(void **state) {
  (void)state;
  enum { SEEDS = 3 };
  static const double times[] = {3e-6, 16e-6};
  double damage[] = {0, 0}, reached[] = {0, 0}; /* means over particles, all of one mass, and seeds */
  struct sph_inputs inputs = SPH_CASE("basalt-sphere", "fidelity.particles=3000");
  for (uint64_t seed = 1; seed <= SEEDS; seed++) {
    struct sph_run *run;
    struct error error = {0};
    if (sph_run_create(&inputs, seed, &run, &error)) fail_msg("%s", error.message);
    for (int k = 0; k < 2; k++) {
      while (!run->state.finished && sph_system_time(run->system) < times[k])
        sph_run_advance(run, 1);
      const struct sph_particles *now = sph_run_read(run);
      for (size_t i = 0; i < run->targets; i++) {
        damage[k] += pow(now->damage_cbrt[i], 3) / (SEEDS * (double)run->targets);
        reached[k] += (now->damage_cbrt[i] > 0) / (SEEDS * (double)run->targets);
      }
    }
    sph_run_free(run);
  }
  pinned("mean damage at 3 us", damage[0], 0.00526, 0.08);
  pinned("mean damage at 16 us", damage[1], 0.6942, 0.02);
  pinned("share of the sphere with damage at 16 us", reached[1], 0.7527, 0.02);
}

static void core_and_spall(void **state) {
  (void)state;
  struct sph_inputs inputs = SPH_CASE("basalt-sphere", particles("3000", "45000"));
  size_t n = run_case_seeds(3, 10), opposite = 0;
  double largest[MOST_RUNS], bare[MOST_RUNS], second[MOST_RUNS], angle[MOST_RUNS];
  for (size_t r = 0; r < n; r++) {
    struct sphere s = run_sphere(&inputs, r + 1);
    sound(&s);
    assert_int_equal(s.outcome.state, OUTCOME_COMPLETED); /* "fracture had ceased" */
    largest[r] = s.results.largest.veneer_fraction;
    bare[r] = s.results.largest.bare_fraction;
    second[r] = s.outcome.second_fraction;
    angle[r] = s.results.second.angle * 57.295779513082321;
    opposite += angle[r] > 120; /* the quarter of all directions that is farthest from the impact */
    assert_true(s.near_damage > 0.95);        /* "entirely broken into pieces smaller than what we can resolve" */
    assert_true(s.results.largest.axis_middle > 0.7); /* "nearly spherical": of shards it is less */
  }
  summary("M1/M with veneer", n, largest);
  summary("M1/M bare", n, bare);
  summary("M2/M", n, second);
  summary("angle of second, deg", n, angle);
  struct sample_summary m1 = sample_summarise(n, largest, 0.95), without = sample_summarise(n, bare, 0.95);
  /* 0.31 measured, 0.35 in the paper. A bridge of rock that holds or not moves one run by 0.2, and the veneer of a coarse
   * sphere is worth up to that: half of 0.31 to 0.35 + 0.2. */
  assert_true(m1.mean > 0.155 && m1.mean < 0.55);
  assert_true(m1.mean - without.mean > 0.05); /* one layer round half of the radius: 3 dr/r of it, dr/r > 0.03 at 1e5 */
  assert_true(2 * opposite > n);              /* by chance a quarter of them */
}

/* Largest fragment against specific energy Q: a line M1/M = 1/2 - s (Q/Q* - 1) through the means next to one half. */
static void energy_ladder(void **state) {
  (void)state;
  static const char *const quick[] = {"0.5", "2", "6"}, *const all[] = {"0.5", "1", "1.5", "2", "2.5", "3", "4.5", "7"};
  bool full = run_case_full();
  const char *const *ladder = full ? all : quick;
  size_t rungs = full ? sizeof all / sizeof *all : sizeof quick / sizeof *quick, n = run_case_seeds(2, 5);
  double mean[8], q[8], star = NAN, slope = NAN;
  for (size_t k = 0; k < rungs; k++) {
    char energy[64];
    double largest[MOST_RUNS];
    snprintf(energy, sizeof energy, "impact.specific_energy=%s kJ/kg", ladder[k]);
    struct sph_inputs inputs = SPH_CASE("disruption", particles("2500", "5000"), energy);
    for (size_t r = 0; r < n; r++) {
      struct sphere s = run_sphere(&inputs, r + 1);
      sound(&s);
      largest[r] = s.results.largest.veneer_fraction;
      q[k] = s.results.specific_energy;
    }
    summary(energy, n, largest);
    mean[k] = sample_summarise(n, largest, 0.95).mean;
    if (k > 0) assert_true(mean[k] < mean[k - 1]);
    if (k > 0 && mean[k - 1] >= 0.5 && mean[k] < 0.5) {
      double per_q = (mean[k - 1] - mean[k]) / (q[k] - q[k - 1]);
      star = q[k - 1] + (mean[k - 1] - 0.5) / per_q;
      slope = per_q * star;
    }
  }
  print_message("Q* %.2f kJ/kg, s %.2f, between two rungs\n", star / 1e3, slope);
  assert_true(star > 1000 && star < 4000); /* what small basalt targets are known for */
  assert_true(mean[0] > 0.8 && mean[rungs - 1] < 0.35);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(damage_on_its_way), cmocka_unit_test(core_and_spall),
                                     cmocka_unit_test(energy_ladder)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
