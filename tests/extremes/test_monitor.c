/* The monitor of a run: faults put into the moving system end the run at most 100 steps later. The message names the
 * quantity, the grain or particle, the time and the remedy. Also the cost of the monitor. */
#include "engine/condition.h"
#include "engine/dem/run/run.h"
#include "engine/dem/step/system_layout.h"
#include "engine/sph/run/run.h"
#include "engine/sph/step/system.h"
#include "schemas/clock.h"
#include "tests/support/run_case.h"

enum { LATE = 100, BEFORE = 300, VICTIM = 7 };

static void names(const char *message, const char *const *words) {
  for (; *words; words++)
    if (!strstr(message, *words))
      fail_msg("'%s' is not in '%s'", *words, message);
}

/* ---- dem ---- */

static struct dem_run *disc(const char *extra) {
  const struct dem_inputs inputs = DEM_CASE("disc-explosion", "body.diameter=8 cm", "charge.energy=2 kJ/m",
                                            "stop.end_time=5 ms", extra);
  struct dem_run *run = NULL;
  OK(dem_run_create(&inputs, 3, &run, &error));
  frame_advance(&run->frame, BEFORE);
  assert_false(run->state.frame.finished);
  return run;
}

static void dem_ends(struct dem_run *run, int state, const char *const *words) {
  uint64_t before = dem_system_now(run->system)->steps;
  frame_advance(&run->frame, 10000);
  assert_true(run->state.frame.finished);
  assert_true(dem_system_now(run->system)->steps - before <= LATE);
  assert_int_equal(run->state.frame.outcome_state, state);
  names(run->state.frame.message, words);
  dem_run_free(run);
}

TEST(energy_from_nowhere_ends_a_run_of_grains) {
  struct dem_run *run = disc("threshold.breaking=true");
  run->system->c.vx[VICTIM] += 400; /* a grain gets a velocity without any impact */
  dem_ends(run, OUTCOME_ENERGY,
           (const char *const[]){"sum of all energies has drifted", "is the fastest", " s ", "fidelity.time_step",
                                 NULL});
}

TEST(grains_that_are_lost_end_a_run) {
  struct dem_run *run = disc("threshold.breaking=true");
  run->system->c.vx[VICTIM] = (double)NAN;
  dem_ends(run, OUTCOME_NOT_FINITE,
           (const char *const[]){"position or velocity", "grain 7", " s", "fidelity.time_step", NULL});
}

TEST(grains_too_fast_for_the_step_end_a_run) {
  struct dem_run *run = disc("fidelity.energy_bound=off");
  run->system->c.vx[VICTIM] = 2e4; /* 2 cm in a step */
  dem_ends(run, OUTCOME_TIME_STEP, (const char *const[]){"grain 7 moves by", "grain diameters", " s ", "below", NULL});
}

/* The run was checked for another time step: the step may become unstable after the start. */
TEST(a_step_beyond_stability_ends_a_run) {
  for (int gear = 0; gear < 2; gear++) {
    struct dem_run *run = disc(gear ? "fidelity.integrator=gear" : "fidelity.integrator=verlet");
    run->inputs.fidelity.time_step = 4 * run->stable_time_step;
    const uint64_t before = dem_system_now(run->system)->steps;
    frame_advance(&run->frame, 1000);
    assert_true(run->state.frame.finished && run->state.frame.outcome_state != OUTCOME_COMPLETED);
    assert_true(dem_system_now(run->system)->steps - before <= 1000 && *run->state.frame.message);
    dem_run_free(run);
  }
}

/* ---- sph ---- */

static struct sph_run *sphere(const char *extra) {
  const struct sph_inputs inputs = SPH_CASE("basalt-sphere", "fidelity.particles=300",
                                            "fidelity.projectile_spacing=0.6", "stop.end_time=1 ms",
                                            "stop.quiet_time=1 ms", extra);
  struct sph_run *run = NULL;
  OK(sph_run_create(&inputs, 3, &run, &error));
  assert_int_equal(frame_advance(&run->frame, BEFORE), STATUS_OK);
  assert_false(run->state.frame.finished);
  return run;
}

static void sph_ends(struct sph_run *run, int state, const char *const *words) {
  uint64_t before = run->system->now.steps;
  assert_int_equal(frame_advance(&run->frame, 10000), STATUS_OK);
  assert_true(run->state.frame.finished);
  assert_true(run->system->now.steps - before <= LATE);
  assert_int_equal(run->state.frame.outcome_state, state);
  names(run->state.frame.message, words);
  sph_run_free(run);
}

TEST(energy_from_nowhere_ends_a_run_of_particles) {
  struct sph_run *run = sphere("fidelity.precision=double");
  run->system->c.vx[VICTIM] += 5000;
  sph_ends(run, OUTCOME_ENERGY,
           (const char *const[]){"sum of all energies has drifted", "particle ", "is the fastest", " s ",
                                 "fidelity.cfl", NULL});
}

TEST(particles_that_are_lost_end_a_run) {
  struct sph_run *run = sphere("fidelity.precision=double");
  char particle[40];
  run->system->c.energy[VICTIM] = (double)NAN;
  snprintf(particle, sizeof particle, "particle %u of body", (unsigned)run->system->id[VICTIM]);
  sph_ends(run, OUTCOME_NOT_FINITE, (const char *const[]){particle, "energy nan J/kg", " s,", "fidelity.cfl", NULL});
}

TEST(steps_that_collapse_end_a_run) {
  struct sph_run *run = sphere("fidelity.energy_bound=off");
  char particle[60];
  run->system->c.energy[VICTIM] = 1e28; /* far above any real energy: the resulting sound speed allows no step */
  snprintf(particle, sizeof particle, "Particle %u is the hottest", (unsigned)run->system->id[VICTIM]);
  sph_ends(run, OUTCOME_TIME_STEP, (const char *const[]){"time step fell to", particle, " s", "fidelity.cfl", NULL});
}

/* ---- warnings ---- */

/* The words that the inputs alone give, "coarse dust ". */
static const char *known(const struct engine_kind *kind, const void *inputs) {
  static char words[200];
  const condition_set set = condition_before(kind->conditions, inputs, NULL);
  *words = 0;
  for (size_t k = 0; kind->conditions[k].word; k++)
    if (set >> k & 1)
      snprintf(words + strlen(words), sizeof words - strlen(words), "%s ", kind->conditions[k].word);
  return words;
}

static struct ran finished(const struct engine_kind *kind, const void *inputs) {
  struct ran ran = run_case_run(kind, inputs, 3);
  free(ran.fragments);
  return ran;
}

TEST(doubts_are_in_the_result) {
#define SMALL_DISC(...)  DEM_CASE("disc-explosion", "body.diameter=8 cm", "stop.end_time=0.2 ms", __VA_ARGS__)
#define SMALL_PLATE(...) SPH_CASE("porous-plate", "fidelity.points=40", __VA_ARGS__)
  struct dem_inputs in = SMALL_DISC("charge.energy=2 MJ/m", "fidelity.time_step=0.1 us");
  assert_string_equal(finished(&dem_engine, &in).outcome.warnings, "passing, cut");
  assert_string_equal(known(&dem_engine, &in), "passing ");
  in = SMALL_DISC("charge.energy=200 J/m", "stop.end_time=2 ms", "stop.least_time=0 s");
  assert_string_equal(finished(&dem_engine, &in).outcome.warnings, "");
  in = SMALL_DISC("charge.energy=200 J/m", "fidelity.time_step=3 us", "fidelity.integrator=gear");
  assert_string_equal(finished(&dem_engine, &in).outcome.warnings, "step, cut");
  in = SMALL_DISC("charge.energy=200 J/m", "contact.normal_damping=1e6 1/s");
  assert_non_null(strstr(finished(&dem_engine, &in).outcome.warnings, "damping"));

  struct sph_inputs plate = SMALL_PLATE("piston.speed=458 m/s"); /* 40 points are too few for its precursor */
  assert_string_equal(finished(&sph_engine, &plate).outcome.warnings, "precursor");
  plate = SMALL_PLATE("piston.speed=20 km/s", "target.material.porosity.distention=2");
  assert_non_null(strstr(finished(&sph_engine, &plate).outcome.warnings, "piston"));
  assert_string_equal(known(&sph_engine, &plate), "piston ");
}

/* A drift of 1.2 % within a bound of 2 % is accepted, and reported. */
TEST(drift_within_a_wide_bound_is_flagged) {
  struct dem_run *run = disc("fidelity.energy_bound=50 %");
  struct outcome outcome;
  struct dem_results results;
  OWNED struct fragment *fragments = NULL;
  size_t count;
  run->state.frame.closed_start *= 1.05;
  frame_advance(&run->frame, LATE);
  OK(dem_report_finish(run, &outcome, &results, &fragments, &count, &error));
  assert_string_equal(outcome.warnings, "drift"); /* the run goes on: it is not cut */
  dem_run_free(run);
}

/* The closed ledger books what contacts give as work, so a drift does not show it: the printed law is no gradient, and
 * contacts that wait for a break begin at full force. */
TEST(energy_that_contacts_give_is_flagged) {
  const struct {
    const char *law, *bonded, *words;
  } cases[] = {
      {"contact.law=conservative", "contact.bonded=true", ""},
      {"contact.law=conservative", "contact.bonded=false", "gain"},
      {"contact.law=printed", "contact.bonded=true", "gain"},
      {"contact.law=off", NULL, "passing"},
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    const struct dem_inputs in = DEM_CASE("disc-explosion", "body.diameter=8 cm", "stop.end_time=2 ms",
                                          "charge.energy=2 kJ/m", cases[c].law, cases[c].bonded);
    const struct ran ran = finished(&dem_engine, &in);
    assert_string_equal(ran.outcome.warnings, cases[c].words);
    assert_true(ran.outcome.energy_error < CONDITION_LARGEST_DRIFT);
    assert_true(ran.results.dem.broken > 20);
  }
}

/* Particles at rest that stand farther apart than the search for fragments looks: a whole body would count as dust. */
TEST(links_too_short_for_the_lattice_are_flagged) {
#define AT_REST(...)                                                                                                   \
  SPH_CASE("basalt-sphere", "fidelity.particles=60", "fidelity.projectile_spacing=1", "impact.speed=0 m/s",            \
           "impact.mass=20 g", "stop.end_time=1 us", "fragments.static_strength=off", __VA_ARGS__)
  const struct sph_inputs cases[] = {
      AT_REST("fragments.link_length=1"),  AT_REST("fragments.link_length=0.99"),
      AT_REST("fidelity.smoothing=0.92"),  AT_REST("fidelity.smoothing=0.95"),
      AT_REST("target.lattice=cubic"),     AT_REST("target.lattice=cubic", "fragments.link_length=0.88"),
      AT_REST("target.lattice=irregular"), AT_REST("target.lattice=irregular", "fragments.link_length=0.9"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    const struct ran ran = finished(&sph_engine, &cases[c]);
    const bool whole = ran.outcome.fragment_count == 1;
    assert_int_equal(strstr(known(&sph_engine, &cases[c]), "links") != NULL, !whole);
    assert_int_equal(strstr(ran.outcome.warnings, "links") != NULL, !whole);
  }
}

/* A tube whose wall is thinner than the particles are apart: its particles have gaps, whatever the lattice. */
TEST(bodies_thinner_than_their_particles_are_flagged) {
#define TUBE(...)                                                                                                      \
  SPH_CASE("elastic-bar", "fidelity.particles=190", "target.radius=0.89 mm", "target.length=8 mm",                     \
           "vibration.speed=1 mm/s", "stop.end_time=1 us", __VA_ARGS__)
  const struct sph_inputs thin = TUBE("target.inner_radius=0.74 mm"), full = TUBE("target.inner_radius=0 m");
  struct ran ran = finished(&sph_engine, &thin);
  assert_true(ran.outcome.fragment_count > 1);
  assert_string_equal(ran.outcome.warnings, "thin, links");
  ran = finished(&sph_engine, &full);
  assert_true(ran.outcome.fragment_count == 1 && !*ran.outcome.warnings);
}

/* A short smoothing length without the gradient correction: sums on a lattice are too small, and the shock too weak. */
TEST(short_smoothing_lengths_are_flagged) {
  const struct {
    const char *smoothing, *correction, *words;
    double least, most; /* error of the shock's pressure; measured 0.2 to 2 % where it is safe */
  } cases[] = {
      {"fidelity.smoothing=0.86", "method.gradient_correction=false", "kernel, plateau, precursor", 0.03, 0.1},
      {"fidelity.smoothing=0.86", "method.gradient_correction=true", "precursor", 0, 0.02},
      {"fidelity.smoothing=1", "method.gradient_correction=false", "precursor", 0, 0.02},
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    const struct sph_inputs in = SMALL_PLATE(cases[c].smoothing, cases[c].correction);
    const struct ran ran = finished(&sph_engine, &in);
    const double deviation = fabs(ran.results.sph.shock.pressure / ran.results.sph.shock.pressure_exact - 1);
    print_message("%s, %s: pressure off by %.3f\n", cases[c].smoothing, cases[c].correction, deviation);
    assert_string_equal(ran.outcome.warnings, cases[c].words);
    assert_int_equal(strstr(known(&sph_engine, &in), "kernel") != NULL, strstr(cases[c].words, "kernel") != NULL);
    assert_true(deviation >= cases[c].least && deviation <= cases[c].most);
  }
}

/* A wave that has left the plate has no place, and the speed of a front through its last places means nothing. */
TEST(waves_at_the_far_side_are_flagged) {
  const struct sph_inputs early = SMALL_PLATE("stop.end_time=3 us"), late = SMALL_PLATE("stop.end_time=9 us");
  const struct ran good = finished(&sph_engine, &early), bad = finished(&sph_engine, &late);
  assert_null(strstr(good.outcome.warnings, "arrival"));
  assert_non_null(strstr(bad.outcome.warnings, "arrival"));
  assert_string_equal(known(&sph_engine, &early), "");
  assert_string_equal(known(&sph_engine, &late), "arrival ");
  const double exact = good.results.sph.precursor.speed_exact;
  print_message("precursor at %g, %g of its exact speed\n", good.results.sph.precursor.speed / exact,
                bad.results.sph.precursor.speed / exact);
  assert_true(fabs(good.results.sph.precursor.speed / exact - 1) < 0.1);
  assert_false(fabs(bad.results.sph.precursor.speed / exact - 1) < 0.1); /* wrong, or off */
}

/* The longest message of a run fits with its remedy. */
TEST(long_messages_keep_their_remedy) {
  const struct sph_inputs in = SPH_CASE("basalt-sphere", "fidelity.particles=100", "fidelity.projectile_spacing=0.5",
                                        "impact.mass=2 g", "fidelity.energy_bound=1.23456e-5 %");
  struct sph_run *run = NULL;
  assert_int_equal(sph_run_create(&in, 3, &run, NULL), STATUS_OK);
  assert_int_equal(frame_advance(&run->frame, 1), STATUS_OK);
  run->system->now.clamped = 1e300; /* cold matter got most of the drift */
  run->state.frame.closed_start *= 1.123456789e10;
  assert_int_equal(frame_advance(&run->frame, LATE), STATUS_OK);
  assert_int_equal(run->state.frame.outcome_state, OUTCOME_ENERGY);
  names(run->state.frame.message, (const char *const[]){"energy.clamped", "or take more particles", NULL});
  sph_run_free(run);
}

/* Bodies of very different density: the heavy particles' forces are too strong for the time step of the light ones;
 * volume weights remove the problem. */
TEST(bodies_of_unlike_density_need_volume_weights) {
#define LIGHT(...)                                                                                                     \
  SPH_CASE("basalt-sphere", "fidelity.particles=200", "fidelity.projectile_spacing=0.8", "stop.end_time=20 us",        \
           "target.material.density=20 kg/m^3", "projectile.material.name=basalt", "impact.projectile=size",           \
           "projectile.radius=2 cm", "impact.angle=0 deg", "impact.gap=0 m", __VA_ARGS__)
  struct sph_inputs in = LIGHT("impact.speed=1 km/s");
  struct ran ran = finished(&sph_engine, &in);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  assert_non_null(strstr(ran.outcome.message, "method.volume_weights: true"));
  assert_non_null(strstr(known(&sph_engine, &in), "contrast"));
  in = LIGHT("impact.speed=1 km/s", "method.volume_weights=true");
  ran = finished(&sph_engine, &in);
  assert_true(ran.outcome.state <= OUTCOME_END_TIME && ran.outcome.energy_error < 1e-3);
  assert_null(strstr(known(&sph_engine, &in), "contrast"));
}

/* ---- cost ---- */

/* Processor time of the checks of the energy balance, over that of the steps. */
TEST(the_monitor_is_cheap) {
  const int steps = run_case_full() ? 3000 : 1000;
  struct dem_run *run = disc(run_case_full() ? "body.diameter=40 cm" : "stop.end_time=1 s");
  double begin = clock_cpu_s();
  frame_advance(&run->frame, (uint64_t)steps);
  const double all = clock_cpu_s() - begin;
  begin = clock_cpu_s();
  for (int k = 0; k < steps / LATE; k++)
    frame_look(&run->frame);
  const double dem = (clock_cpu_s() - begin) / all;
  dem_run_free(run);

  struct sph_run *solid = sphere("fidelity.precision=double");
  begin = clock_cpu_s();
  const uint64_t from = solid->system->now.steps;
  assert_int_equal(frame_advance(&solid->frame, (uint64_t)steps), STATUS_OK);
  const double whole = clock_cpu_s() - begin;
  const uint64_t looks = (solid->system->now.steps - from) / solid->frame.kind->looks;
  begin = clock_cpu_s();
  for (uint64_t k = 0; k < looks; k++)
    (void)sph_system_ledger(solid->system);
  const double sph = (clock_cpu_s() - begin) / whole;
  sph_run_free(solid);
  print_message("monitor: %.2f %% of a run of dem, %.2f %% of sph\n", 100 * dem, 100 * sph);
  const double most = run_case_full() ? 0.02 : 0.05; /* short times are noisy on a busy machine */
  assert_true(dem < most && sph < most);
}
