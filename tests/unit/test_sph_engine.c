/* Engine sph through its public functions: tables, built-in scenes, how protocols start, stop rules; chunk length and
 * restarts have no effect. The bodies are small because physics is not tested here. */
#include "tests/support/run_case.h"

#include <unistd.h>

#include "engine/restart.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "tests/support/allocated.h"

static const char *const scenes[] = {"basalt-sphere",       "tensile-rod", "gabbro-crater", "elastic-bar",
                                     "colliding-cylinders", "disruption",  "porous-ice",    "porous-plate"};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

/* A small sphere whose run ends soon. */
#define SMALL(...) SPH_CASE("basalt-sphere", "fidelity.particles=400", "fidelity.projectile_spacing=0.7", __VA_ARGS__)

TEST(results_table_is_whole) {
  for (size_t i = 0; i < sph_results.count; i++) {
    const struct field *row = &sph_results.rows[i];
    assert_true(strlen(row->doc) > 10);
    assert_true(row->offset < sph_results.size);
    for (size_t j = 0; j < i; j++) {
      assert_string_not_equal(row->path, sph_results.rows[j].path);
      assert_true(row->offset != sph_results.rows[j].offset);
    }
  }
}

/* Every scene can be prepared at a small size, says what it models, and needs no more memory than predicted. */
TEST(builtin_scenes_say_what_they_model) {
  for (size_t k = 0; k < SCENES; k++) {
    struct sph_inputs inputs = SPH_CASE(scenes[k], NULL);
    OWNED char *text = sph_engine.describe(&inputs, true);
    assert_non_null(strstr(text, "c_p "));
    assert_non_null(strstr(text, "bytes per particle"));
    if (strstr(text, "cannot be run"))
      fail_msg("%s: %s", scenes[k], text);
    inputs.fidelity.particles = 1500;
    inputs.fidelity.points = 60;
    inputs.fidelity.graded = false;
    inputs.fidelity.projectile_spacing = fmin(inputs.fidelity.projectile_spacing, 0.1);
    inputs.impact.gap = sph_derived_spacing(&inputs);
    inputs.stretch.grip = 3e-3;
    inputs.stretch.flaw_free = 8e-3;
    inputs.collision.gap = 2 * sph_derived_spacing(&inputs);
    void *made;
    const size_t before = allocated();
    if (sph_engine.prepare(&inputs, 1, &made, &error))
      fail_msg("%s: %s", scenes[k], error.message);
    struct sph_run *run = made;
    size_t beside = run->start->n * 20 * 8; /* particles as read back: 20 columns at most */
    size_t needed = allocated() - before + beside, said = sph_engine.memory(&inputs);
    if (!(needed <= said && said < 2 * needed + (5 << 20))) /* small runs: 4 MB of it are for what every process has */
      fail_msg("%s: %zu bytes, said %zu", scenes[k], needed, said);
    assert_true(sph_engine.work(&inputs) > 0);
    sph_engine.free(made);
  }
}

/* The number behind `words`, as text_people() writes it: 1.28×10^7, 3 800 000. */
static double number_behind(const char *text, const char *words) {
  const char *at = strstr(text, words);
  assert_non_null(at);
  char plain[64] = "";
  size_t length = 0;
  for (at += strlen(words); length < sizeof plain - 1; at++) {
    const bool power = strncmp(at, "\u00d710^", strlen("\u00d710^")) == 0;
    if (*at == ' ' && at[1] >= '0' && at[1] <= '9')
      continue;
    if (!power && !strchr("0123456789.-", *at))
      break;
    plain[length++] = power ? 'e' : *at;
    at += power ? strlen("\u00d710^") - 1 : 0;
  }
  return strtod(plain, NULL);
}

/* The text of a projectile of one particle. */
TEST(one_particle_is_no_plural) {
  struct sph_inputs inputs = SPH_CASE("basalt-sphere", "fidelity.projectile_spacing=5");
  OWNED char *text = sph_engine.describe(&inputs, true);
  assert_non_null(strstr(text, "about 1 particle, "));
}

/* The flaw strengths that explain prints are the real ones: (kV)^(-1/m), V the solid volume. */
TEST(flaws_are_described) {
  struct sph_inputs inputs = SPH_CASE("porous-ice", "target.material.porosity.distention=3");
  const double V = sph_derived_target_mass(&inputs) / inputs.target.material.density;
  const double want = pow(inputs.target.material.weibull.k * V, -1 / inputs.target.material.weibull.m);
  OWNED char *text = sph_engine.describe(&inputs, true);
  const double strain = number_behind(text, "the weakest opens at strain ");
  const double pascal = number_behind(strstr(text, "the weakest opens"), "(");
  assert_true(fabs(strain / want - 1) < 0.005 &&
              fabs(pascal / (want * sph_material_young_modulus(&inputs.target.material)) - 1) < 0.005); /* 3 digits */
}

/* Numbers that explain and plan tell before a run, and those of the run: flaws of a rod with ends that have none; mass
 * and particles of slabs that are longer than asked, to repeat. */
TEST(bodies_are_described_as_they_run) {
  const struct sph_inputs rod = SPH_CASE("tensile-rod", "fidelity.particles=3000", "stop.end_time=0.1 us"),
                          rings = SPH_CASE("colliding-cylinders", "fidelity.particles=300", "collision.gap=5 mm",
                                           "stop.end_time=51 us");
  struct ran ran = run_case_run(&sph_engine, &rod, 1);
  free(ran.fragments);
  OWNED char *text = sph_engine.describe(&rod, true);
  const double flaws = number_behind(text, "flaws: about ");
  print_message("flaws of a rod: %.5g described, %.5g in the run\n", flaws, (double)ran.results.sph.flaws);
  assert_true(fabs(flaws / (double)ran.results.sph.flaws - 1) < 0.05); /* a layer of particles: 4 % of the length */
  ran = run_case_run(&sph_engine, &rings, 1);
  free(ran.fragments);
  assert_true(fabs(sph_derived_particles(&rings) / (double)ran.results.sph.particles - 1) < 0.01);
  assert_true(fabs(2 * sph_derived_target_mass(&rings) / ran.outcome.total_mass - 1) < 0.001);
}

static double described_speed(const struct sph_inputs *inputs) {
  OWNED char *text = sph_engine.describe(inputs, true);
  const double speed = number_behind(text, "of a core that does ");
  return speed;
}

/* The order of what options cost, and its size within the factor of two by which today's cores differ (bench_sph
 * measures it). */
TEST(cost_follows_the_options) {
  struct sph_inputs plain = SPH_CASE("basalt-sphere", NULL),
                    single = SPH_CASE("basalt-sphere", "fidelity.precision=float");
  struct sph_inputs corrected = SPH_CASE("basalt-sphere", "method.gradient_correction=true");
  const double speed = described_speed(&plain);
  assert_true(speed > 2e6 && speed < 8e6);
  assert_true(described_speed(&single) > 1.3 * speed && described_speed(&corrected) < 0.9 * speed);
  assert_true(sph_engine.memory(&corrected) > sph_engine.memory(&plain));
}

/* Steps that a run makes, over those that its cost was estimated with. */
static double steps_over_estimate(const struct sph_inputs *in) {
  const struct ran ran = run_case_run(&sph_engine, in, 1);
  free(ran.fragments);
  return (double)ran.outcome.steps * in->stop.end_time / ran.outcome.time * sph_derived_particles(in) /
         sph_engine.work(in);
}

/* At rest the Courant limit is exact. Closed pores and a fast projectile count; the largest distention step does not.
 */
TEST(steps_are_as_estimated) {
  const struct sph_inputs bar = SPH_CASE("elastic-bar", "fidelity.particles=300"),
                          steel = SMALL("fidelity.particles=2000", "fidelity.projectile_spacing=0.4",
                                        "projectile.material.name=steel", "impact.speed=1 km/s", "stop.end_time=20 us"),
                          porous = SPH_CASE("porous-target", "fidelity.particles=1000",
                                            "fidelity.projectile_spacing=0.5", "stop.end_time=0.1 ms");
  const double of_bar = steps_over_estimate(&bar), of_steel = steps_over_estimate(&steel),
               of_porous = steps_over_estimate(&porous);
  if (!(fabs(of_bar - 1) < 0.01 && of_steel > 0.8 && of_steel < 1.2 && of_porous > 0.8 && of_porous < 1.2))
    fail_msg("%g %g %g", of_bar, of_steel, of_porous);
}

TEST(impact_starts_as_described) {
  struct sph_inputs inputs = SMALL(NULL);
  struct sph_run *run;
  assert_int_equal(sph_run_create(&inputs, 3, &run, NULL), STATUS_OK);
  const struct sph_particles *p = run->start;
  assert_true(fabs(run->range[1].mass / 2e-4 - 1) < 1e-12);
  /* at first contact the normal is z for any gap: from there the projectile was moved back along its flight */
  double r = run->shape[1].radius, way = inputs.impact.gap / cos(30 * M_PI / 180);
  assert_true(fabs(run->shape[1].centre[0] + 0.5 * way) < 1e-12);
  assert_true(fabs(run->shape[1].centre[2] - (0.03 + r + inputs.impact.gap)) < 1e-12);
  double least = HUGE_VAL, top = 0, v[3] = {0, 0, 0};
  for (size_t i = run->targets; i < p->n; i++) {
    least = fmin(least, sqrt(p->x[i] * p->x[i] + p->y[i] * p->y[i] + p->z[i] * p->z[i]));
    v[0] = p->vx[i], v[1] = p->vy[i], v[2] = p->vz[i];
  }
  for (size_t i = 0; i < run->targets; i++) {
    top = fmax(top, sqrt(p->x[i] * p->x[i] + p->y[i] * p->y[i] + p->z[i] * p->z[i]));
    assert_true(p->vx[i] == 0 && p->vy[i] == 0 && p->vz[i] == 0);
  }
  if (!(top <= 0.03 + 0.1 * run->range[0].spacing)) /* particles are in the middle of their matter */
    fail_msg("%g", top);
  assert_true(least >= 0.03 + 0.5 * inputs.impact.gap);
  assert_true(fabs(sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 3200 - 1) < 1e-12);
  assert_true(fabs(-v[2] / 3200 - cos(30 * M_PI / 180)) < 1e-12); /* downwards, 30 degrees off */
  struct sph_ledger ledger = sph_system_ledger(run->system);
  assert_true(fabs(ledger.kinetic / (0.5 * 2e-4 * 3200 * 3200) - 1) < 1e-9);
  sph_run_free(run);
}

TEST(stretch_and_vibration_start) {
  struct sph_inputs rod = SPH_CASE("tensile-rod", "fidelity.particles=1500");
  struct sph_run *run;
  assert_int_equal(sph_run_create(&rod, 3, &run, NULL), STATUS_OK);
  size_t held = 0;
  for (size_t i = 0; i < run->start->n; i++) {
    double z = run->start->z[i];
    assert_true(fabs(run->start->vz[i] - 60 * z) < 1e-12);
    assert_true(fabs(run->start->vx[i] + sph_material_poisson_ratio(&rod.target.material) * 60 * run->start->x[i]) <
                1e-12);
    assert_true((run->start->held[i] != 0) == (fabs(z) > 0.02 - rod.stretch.grip));
    held += run->start->held[i] != 0;
  }
  assert_true(held > 20 && held < run->start->n / 2);
  sph_run_free(run);

  struct sph_inputs bar = SPH_CASE("elastic-bar", "fidelity.particles=1500");
  assert_int_equal(sph_run_create(&bar, 3, &run, NULL), STATUS_OK);
  for (size_t i = 0; i < run->start->n; i++) { /* the mode, and its sides' share: div v = (1 - 2 nu) dv_z/dz */
    double k = M_PI / 0.04,
           aside = -sph_material_poisson_ratio(&bar.target.material) * k * 0.1 * cos(k * run->start->z[i]);
    assert_true(fabs(run->start->vz[i] - 0.1 * sin(k * run->start->z[i])) < 1e-12);
    assert_true(fabs(run->start->vy[i] - aside * run->start->y[i]) < 1e-12);
  }
  sph_run_free(run);
}

TEST(chunks_and_restarts_do_not_matter) {
  char path[100];
  snprintf(path, sizeof path, "/tmp/clast_sph_engine_%d.restart", (int)getpid());
  struct sph_inputs cases[] = {
      SMALL("stop.end_time=40 us"),
      SMALL("stop.end_time=40 us",
            "method.gradient_correction=true"), /* begins with two passes: blocks know their slack by then */
      SPH_CASE("tensile-rod", "fidelity.particles=1500", "stop.end_time=20 us"),
      SPH_CASE("elastic-bar", "fidelity.particles=600", "stop.end_time=20 us"),
      SPH_CASE("colliding-cylinders", "fidelity.particles=300", "stop.end_time=0.3 ms"),
      SPH_CASE("porous-plate", "fidelity.points=40"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    struct ran whole = run_case_run(&sph_engine, &cases[c], 3);
    void *run;
    bool finished = false;
    assert_int_equal(sph_engine.prepare(&cases[c], 3, &run, NULL), STATUS_OK);
    assert_int_equal(sph_engine.step(run, (uint64_t)whole.outcome.steps / 2 + 1, &finished, NULL), STATUS_OK);
    assert_false(finished);
    OK(restart_save(&sph_engine, run, path, &error));
    run_case_same(&sph_engine, &whole, run_case_end(&sph_engine, run, 0));
    sph_engine.free(run);
    OK(restart_load(&sph_engine, &cases[c], path, &run, &error));
    run_case_same(&sph_engine, &whole, run_case_end(&sph_engine, run, 0));
    if (restart_save(&sph_engine, run, path, &error)) /* at the end, too: no step is left to find anything again */
      fail_msg("%s", error.message);
    sph_engine.free(run);
    OK(restart_load(&sph_engine, &cases[c], path, &run, &error));
    run_case_same(&sph_engine, &whole, run_case_end(&sph_engine, run, 0));
    sph_engine.free(run);
    cases[c].viscosity.alpha += 0.1;
    assert_int_equal(restart_load(&sph_engine, &cases[c], path, &run, &error), STATUS_CONTENT);
    assert_null(run);
    unlink(path);
    free(whole.fragments);
  }
}

TEST(stop_rules) {
  struct sph_inputs inputs = SMALL(NULL);
  struct ran ran = run_case_run(&sph_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_int_equal(ran.results.sph.stop_reason, SPH_STOP_QUIET);
  assert_true(ran.results.sph.fracture_ceased && ran.results.sph.first_damage > 0);
  /* looks come every 8 steps, each of less than the Courant limit of matter at rest */
  double step = inputs.fidelity.cfl * inputs.fidelity.smoothing * sph_derived_smallest_spacing(&inputs) / 0.7 /
                sph_derived_wave_speed(&inputs.target);
  assert_true(ran.outcome.time - ran.results.sph.cease_time >= inputs.stop.quiet_time);
  assert_true(ran.outcome.time - ran.results.sph.cease_time < inputs.stop.quiet_time + 9 * step);
  assert_true(ran.outcome.energy_error < 5e-3);    /* the bound for this scene, clamps not credited */
  assert_true(ran.outcome.momentum_error < 1e-12); /* pair forces cancel to rounding */
  assert_true(ran.results.sph.largest.bare_fraction <= ran.results.sph.largest.veneer_fraction);
  assert_true(ran.results.sph.largest.veneer_fraction <= ran.results.sph.largest.dynamic_fraction + 0.05);
  assert_true(ran.results.sph.mean_damage > 0.2 && ran.results.sph.mean_damage < 1);
  double mass = 0, parts = 0;
  uint64_t count = 0;
  for (size_t k = 0; k < ran.count; k++) {
    mass += ran.fragments[k].mass;
    count += ran.fragments[k].count;
    assert_true(k == 0 || ran.fragments[k].mass <= ran.fragments[k - 1].mass);
  }
  assert_int_equal(count, ran.results.sph.particles); /* the projectile is in no fragment */
  assert_true(fabs(mass / sph_derived_target_mass(&inputs) - 1) < 1e-12);
  const double shares[] = {ran.results.sph.limited.courant, ran.results.sph.limited.force,
                           ran.results.sph.limited.damage, ran.results.sph.limited.energy,
                           ran.results.sph.limited.density};
  for (size_t k = 0; k < 5; k++)
    parts += shares[k];
  assert_true(parts > 0.99 && parts <= 1 + 1e-12);
  free(ran.fragments);

  inputs.stop.quiet_time = 1; /* never quiet: the run ends at the hard end and reports it */
  inputs.stop.end_time = 2e-5;
  ran = run_case_run(&sph_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_END_TIME);
  assert_false(ran.results.sph.fracture_ceased);
  assert_true(isnan(ran.results.sph.cease_time));
  assert_non_null(strstr(ran.outcome.message, "stop.end_time"));
  assert_true(ran.outcome.time == 2e-5);
  free(ran.fragments);

  inputs = SMALL("impact.speed=20 m/s", "stop.end_time=0.7 ms"); /* nothing breaks: one piece */
  ran = run_case_run(&sph_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_true(ran.results.sph.fracture_ceased && isnan(ran.results.sph.first_damage));
  assert_int_equal(ran.count, 1);
  free(ran.fragments);

  /* a boulder of 15 kg goes on breaking a pebble of 11 g when the mean damage of both no longer grows */
  inputs = SPH_CASE("basalt-sphere", "target.radius=1 cm", "projectile.material.name=basalt", "impact.projectile=size",
                    "projectile.radius=11 cm", "impact.speed=60 m/s", "impact.angle=0", "fidelity.particles=300",
                    "fidelity.projectile_spacing=7", "stop.end_time=0.2 ms");
  ran = run_case_run(&sph_engine, &inputs, 1);
  print_message("pebble: damage %.3f, cease time %.3g s\n", ran.results.sph.mean_damage, ran.results.sph.cease_time);
  assert_true(ran.results.sph.mean_damage > 0.9);
  free(ran.fragments);

  inputs = SMALL("fidelity.energy_bound=1e-7 %");
  ran = run_case_run(&sph_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  assert_non_null(strstr(ran.outcome.message, "fidelity.energy_bound"));
  assert_null(strstr(ran.outcome.message, "energy.clamped"));
  free(ran.fragments);

  inputs = SPH_CASE("colliding-cylinders", "fidelity.particles=300", "fidelity.energy_bound=0.1 %",
                    "method.negative_energy=false"); /* cold rubber */
  ran = run_case_run(&sph_engine, &inputs, 1);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  assert_non_null(strstr(ran.outcome.message, "energy.clamped"));
  free(ran.fragments);
}

/* Errors of energy count relative to mu v^2/2, whichever body moves: that of a boulder in flight would hide them. */
TEST(energy_of_the_common_motion_does_not_count) {
  const struct sph_inputs in = SPH_CASE("basalt-sphere", "target.radius=1 cm", "projectile.material.name=basalt",
                                        "impact.projectile=size", "projectile.radius=5 cm", "impact.speed=60 m/s",
                                        "fidelity.particles=300", "fidelity.projectile_spacing=4");
  struct sph_run *run = NULL;
  OK(sph_run_create(&in, 1, &run, &error));
  const struct sph_ledger ledger = sph_system_ledger(run->system);
  const double m = run->range[0].mass, other = run->range[1].mass, speed = in.impact.speed;
  assert_true(other > 100 * m);
  assert_true(fabs(sph_run_energy_available(run, &ledger) / (m * other / (m + other) * speed * speed / 2) - 1) < 1e-9);
  sph_run_free(run);
}

/* A slender bar that is hit and can bend gets half a period of the first mode of a free bar, with the root 4.73004 of
 * cos(x) cosh(x) = 1; up to L/h = 4 waves through the bar are slower. */
TEST(bars_have_time_to_bend) {
  const char *const box[] = {"target.shape=box", "target.depth=1 cm", "target.height=1 cm", "fidelity.particles=500"};
  for (int slender = 0; slender < 2; slender++) {
    const struct sph_inputs in = SPH_CASE("disruption", box[0], box[1], box[2], box[3],
                                          slender ? "target.width=20 cm" : "target.width=4 cm");
    const double h = 0.01, L = in.target.width, c = sph_derived_wave_speed(&in.target);
    const double want = slender ? M_PI * sqrt(12) / (4.73004 * 4.73004) * L * L / (h * c) : 2 * L / c;
    assert_true(fabs(in.stop.quiet_time / want - 1) < (slender ? 0.005 : 1e-12));
  }
}

/* The largest stress of a stretch is taken from every step, not only from the samples, which are a share of the end
 * time apart. */
TEST(the_peak_does_not_hang_on_the_end_time) {
  double peak[2];
  static const char *const ends[] = {"stop.end_time=20 us", "stop.end_time=300 us"};
  for (int k = 0; k < 2; k++) {
    const struct sph_inputs rod = SPH_CASE("tensile-rod", "fidelity.particles=1000", "stretch.rate=360 1/s", ends[k]);
    const struct ran ran = run_case_run(&sph_engine, &rod, 3);
    free(ran.fragments);
    peak[k] = ran.results.sph.peak.stress;
  }
  print_message("peak stress %.10g and %.10g Pa\n", peak[0], peak[1]);
  assert_true(peak[0] > 1e7);
  assert_true(peak[0] == peak[1]);
}
