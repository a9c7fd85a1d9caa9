/* The basalt sphere of Benz & Asphaug 1995 [BA95] section 5.2, and its largest fragment against the energy.
 *
 * The paper: a nearly spherical core of 0.35 of the mass (experiment: 0.31), all matter near the point of impact broken
 * into pieces below the resolution, the second largest fragment a spall nearly opposite; "very similar" for other draws
 * of flaws and half the particles. Quick: a few seeds of a coarse sphere. CLAST_FULL=1: more of each, for
 * tests/validation/sph_sphere*.md; CLAST_SEEDS=n changes the number, CLAST_PARTICLES=n the resolution.
 *
 * The largest fragment jumps when a bridge of rock breaks; a tolerance wide enough for this would also accept a wrong
 * crack speed. The progress of damage through the sphere is smooth, so the test first compares it with pinned numbers
 * of this code. */
#include "tests/support/run_case.h"

#include "analysis/statistics/statistics.h"
#include "engine/sph/run/run.h"

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
  double near_damage; /* mean damage of matter initially within R/2 of the point of impact */
  /* m, from the sphere's centre to the initial position of the middle of the largest fragment's core */
  double core_offset;
};

static struct sphere run_sphere(const struct sph_inputs *inputs, uint64_t seed) {
  struct sphere s = {0};
  struct sph_run *run;
  struct fragment *fragments;
  struct sph_fragments pieces;
  size_t count;
  OK(sph_run_create(inputs, seed, &run, &error));
  while (!run->state.frame.finished)
    frame_advance(&run->frame, 1000);
  OK(sph_report_finish(run, &s.outcome, &s.results, &fragments, &count, &error));
  free(fragments);
  assert_int_equal(sph_report_fragments(run, inputs->fragments.static_strength, inputs->fragments.veneer, &pieces,
                                        &error),
                   STATUS_OK);
  const double top[3] = {0, 0, radius};
  double near = 0, core = 0, middle[3] = {0, 0, 0};
  for (size_t i = 0; i < run->targets; i++) {
    const double at[3] = {run->start->x[i], run->start->y[i], run->start->z[i]};
    double square = 0;
    for (int d = 0; d < 3; d++)
      square += (at[d] - top[d]) * (at[d] - top[d]);
    if (square < radius * radius / 4) {
      near += 1;
      s.near_damage += pow(run->now->damage_cbrt[i], 3);
    }
    if (pieces.label[i] == 0 && pieces.part[i] == SPH_FRAGMENTS_CORE) {
      core += 1;
      for (int d = 0; d < 3; d++)
        middle[d] += at[d];
    }
  }
  s.near_damage /= near;
  s.core_offset = sqrt(middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2]) / core;
  sph_fragments_clear(&pieces);
  sph_run_free(run);
  print_message("%6.3f kJ/kg seed %2d: M1/M %.3f bare %.3f dynamic %.3f M2/M %.3f at %3.0f deg, axes %.2f %.2f, core "
                "%.2f R off the "
                "centre, near damage %.3f, dust %.3f, ceased %.0f us, energy %.1e, %s\n",
                s.results.specific_energy / 1e3, (int)seed, s.results.largest.veneer_fraction,
                s.results.largest.bare_fraction, s.results.largest.dynamic_fraction, s.outcome.second_fraction,
                s.results.second.angle * 57.295779513082321, s.results.largest.axis_middle,
                s.results.largest.axis_short, s.core_offset / radius, s.near_damage, s.outcome.dust_fraction,
                1e6 * s.results.cease_time, s.outcome.energy_error, s.outcome.message);
  return s;
}

/* Bounds of one run. Energy: the criterion is 0.5 %, measured 2e-5. */
static void sound(const struct sphere *s) {
  assert_true(s->outcome.state == OUTCOME_COMPLETED || s->outcome.state == OUTCOME_END_TIME);
  assert_true(s->outcome.energy_error < 0.005);
  assert_true(fabs(s->results.clamped_share) <= 0.001);
  assert_true(s->outcome.momentum_error < 1e-12);
}

static void summary(const char *name, size_t n, const double *values) {
  struct sample_summary s = sample_summarise(n, values, 0.95);
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t i = 0; i < n; i++) {
    least = fmin(least, values[i]);
    most = fmax(most, values[i]);
  }
  print_message("%-24s %.4f +- %.4f (95 %%), scatter %.4f, from %.4f to %.4f\n", name, s.mean, s.half_width,
                s.standard_deviation, least, most);
}

static void pinned(const char *what, double value, double expected, double tolerance) {
  print_message("%-44s %.5f, pinned %.5f within %.0f %%\n", what, value, expected, 100 * tolerance);
  if (!(fabs(value / expected - 1) < tolerance))
    fail_msg("%s: %.5f instead of %.5f", what, value, expected);
}

/* Progress of damage, mean of seeds 1 to 3 at 3000 particles: at 3 us, when it has just begun under the point of impact
 * and waits for the growth of cracks, and at 16 us, when the wave has come back from the far side. Not the paper's
 * numbers but this engine's of results_version 6, to be pinned anew when physics changes on purpose.
 *
 * What means the same physics moved them by (version 6; cfl 0.2, cfl 0.4, damage_step 0.05, float, compact):
 *   3 us: -0.1, +0.1, -0.1, 0, +0.5 %     16 us: +0.1, 0, +0.1, 0, +0.6 %
 * What means another one (version 2; cracks twice as fast, half as fast, k halved, damage not applied to shear, not to
 * tension):
 *   3 us: +15, -32, -4, -4, 0 %     16 us: -3, +3, -5, +16, +18 %     share reached: -4, +6, -4, +11, +14 %
 * The tolerances stand between: each of those five fails. */
TEST(damage_on_its_way) {
  enum { SEEDS = 3 };
  static const double times[] = {3e-6, 16e-6};
  double damage[] = {0, 0}, reached[] = {0, 0}; /* means over particles, all of one mass, and seeds */
  struct sph_inputs inputs = SPH_CASE("basalt-sphere", "fidelity.particles=3000");
  for (uint64_t seed = 1; seed <= SEEDS; seed++) {
    struct sph_run *run;
    OK(sph_run_create(&inputs, seed, &run, &error));
    for (int k = 0; k < 2; k++) {
      while (!run->state.frame.finished && run->system->now.time < times[k])
        frame_advance(&run->frame, 1);
      const struct sph_particles *now = sph_run_read(run);
      for (size_t i = 0; i < run->targets; i++) {
        damage[k] += pow(now->damage_cbrt[i], 3) / (SEEDS * (double)run->targets);
        reached[k] += (now->damage_cbrt[i] > 0) / (SEEDS * (double)run->targets);
      }
    }
    sph_run_free(run);
  }
  pinned("mean damage at 3 us", damage[0], 0.00507, 0.08);
  pinned("mean damage at 16 us", damage[1], 0.7058, 0.02);
  pinned("share of the sphere with damage at 16 us", reached[1], 0.7573, 0.02);
}

TEST(core_and_spall) {
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
    opposite += angle[r] > 120;        /* the quarter of all directions that is farthest from the impact */
    assert_true(s.near_damage > 0.95); /* "entirely broken into pieces smaller than what we can resolve" */
    assert_true(s.results.largest.axis_middle > 0.7); /* "nearly spherical": of shards it is less */
  }
  summary("M1/M with veneer", n, largest);
  summary("M1/M bare", n, bare);
  summary("M2/M", n, second);
  summary("angle of second, deg", n, angle);
  struct sample_summary m1 = sample_summarise(n, largest, 0.95), without = sample_summarise(n, bare, 0.95);
  /* 0.31 measured, 0.35 in the paper. A bridge of rock that holds or not moves one run by 0.2, and the veneer of a
   * coarse sphere is worth up to that: half of 0.31 to 0.35 + 0.2. */
  assert_true(m1.mean > 0.155 && m1.mean < 0.55);
  /* one layer of particles round a body of half the radius: 3 dr/r of its mass, dr/r > 0.03 at 1e5 */
  assert_true(m1.mean - without.mean > 0.05);
  assert_true(2 * opposite > n); /* by chance a quarter of them */
}

struct line {
  double star, slope; /* of M/M_0 = 1/2 - slope (Q/star - 1) */
};

/* The line through the two energies next to one half. */
static struct line between(size_t n, const double *q, const double *fraction) {
  for (size_t k = 1; k < n; k++)
    if (fraction[k - 1] >= 0.5 && fraction[k] < 0.5) {
      const double fall = (fraction[k - 1] - fraction[k]) / (q[k] - q[k - 1]);
      const double star = q[k - 1] + (fraction[k - 1] - 0.5) / fall;
      return (struct line){star, fall * star};
    }
  fail_msg("%s", "no rung on either side of one half");
  return (struct line){NAN, NAN};
}

/* By least squares through all energies up to `most`. */
static struct line through(size_t n, const double *q, const double *fraction, double most) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t k = 0; k < n && q[k] < 1.01 * most; k++)
    w++, x += q[k], y += fraction[k], xx += q[k] * q[k], xy += q[k] * fraction[k];
  const double fall = -(w * xy - x * y) / (w * xx - x * x), star = ((y + fall * x) / w - 0.5) / fall;
  return (struct line){star, fall * star};
}

/* Largest fragment against specific energy Q. One seed is the same body at every energy: Q* and s are computed for each
 * seed. */
TEST(energy_ladder) {
  enum { MOST_RUNGS = 12, MOST_SEEDS = 100, WAYS = 4 };
  static const char *const quick[] = {"0.5", "2", "6"};
  static const char *const all[MOST_RUNGS] = {"0.3", "0.6",  "1", "1.5", "2", "2.25",
                                              "2.5", "2.75", "3", "4",   "6", "10"};
  static const char *const ways[WAYS] = {"M1/M, between two rungs", "M1/M, line up to 4", "M1/M, line up to 6",
                                         "(M1+M2)/M, line up to 6"};
  bool full = run_case_full();
  const char *const *ladder = full ? all : quick;
  size_t rungs = full ? MOST_RUNGS : sizeof quick / sizeof *quick, n = run_case_seeds(2, 6);
  double q[MOST_RUNGS], mean[MOST_RUNGS], star[WAYS][MOST_SEEDS], slope[WAYS][MOST_SEEDS];
  static double largest[MOST_SEEDS][MOST_RUNGS], both[MOST_SEEDS][MOST_RUNGS];
  assert_true(n <= MOST_SEEDS);
  for (size_t k = 0; k < rungs; k++) {
    char energy[64];
    double of_rung[MOST_SEEDS];
    snprintf(energy, sizeof energy, "impact.specific_energy=%s kJ/kg", ladder[k]);
    struct sph_inputs inputs = SPH_CASE("disruption", particles("2500", "10000"), energy);
    for (size_t r = 0; r < n; r++) {
      struct sphere s = run_sphere(&inputs, r + 1);
      sound(&s);
      of_rung[r] = largest[r][k] = s.results.largest.veneer_fraction;
      both[r][k] = largest[r][k] + s.outcome.second_fraction;
      q[k] = s.results.specific_energy;
    }
    summary(energy, n, of_rung);
    mean[k] = sample_summarise(n, of_rung, 0.95).mean;
    if (k > 0)
      assert_true(mean[k] < mean[k - 1]);
  }
  for (size_t r = 0; r < n; r++) {
    const struct line lines[WAYS] = {between(rungs, q, largest[r]), through(rungs, q, largest[r], 4000),
                                     through(rungs, q, largest[r], 6000), through(rungs, q, both[r], 6000)};
    for (int w = 0; w < WAYS; w++)
      star[w][r] = lines[w].star / 1e3, slope[w][r] = lines[w].slope;
  }
  for (int w = 0; w < WAYS; w++) {
    print_message("%s, kJ/kg:\n", ways[w]);
    summary("  Q*", n, star[w]);
    summary("  s", n, slope[w]);
  }
  for (size_t r = 0; r < n; r++) {
    assert_true(star[0][r] > 1 && star[0][r] < 4); /* what small basalt targets are known for */
    /* 0.35 to 0.5 is published; a spall that parts from the core at one energy is worth a quarter of the mass, in any
     * line of a few rungs: half to one and a half of that. */
    assert_true(slope[2][r] > 0.175 && slope[2][r] < 0.75);
  }
  assert_true(mean[0] > 0.8 && mean[rungs - 1] < 0.35);
}
