/* What engine sph refuses, and inputs at the ends of their ranges: a clear error, or a run with an honest status. */
#include "tests/support/run_case.h"

#include <sys/resource.h>
#include <unistd.h>

#include "engine/sph/run/run.h"
#include "engine/sph/step/system.h"

TEST(more_than_memory_is_refused) {
  struct sph_inputs inputs = SPH_CASE("disruption", "fidelity.particles=1900000000");
  void *run = &run;
  assert_int_equal(sph_engine.prepare(&inputs, 1, &run, &error), STATUS_MEMORY);
  assert_null(run);
  assert_non_null(strstr(error.message, "fidelity.particles"));
  assert_non_null(strstr(error.message, " GB"));
}

#ifndef __SANITIZE_ADDRESS__ /* the address sanitizer needs address space of its own */
static size_t address_space(void) {
  unsigned long pages = 0;
  FILE *in = fopen("/proc/self/statm", "r");
  assert_true(in && fscanf(in, "%lu", &pages) == 1);
  fclose(in);
  return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* Lists that exceed the memory in the middle of a run: an attempt that failed, never a stored result. */
TEST(memory_that_runs_out_is_no_result) {
  struct sph_inputs inputs = SPH_CASE("disruption", "fidelity.particles=4000");
  struct rlimit before, tight;
  bool finished = false;
  struct sph_run *run;
  assert_int_equal(sph_run_create(&inputs, 3, &run, NULL), STATUS_OK);
  OK(sph_engine.step(run, 5, &finished, &error));
  run->system->highest_h = 1e3;
  for (size_t i = 0; i < run->system->n; i++)
    run->system->c.h[i] *= 10; /* nearly all pairs: some 30 MB of lists */
  for (size_t k = 0; k < run->system->block_count; k++)
    run->system->block[k].slack = -1; /* changed without the system's knowledge */
  getrlimit(RLIMIT_AS, &before);
  tight = before;
  tight.rlim_cur = address_space() + (1 << 20);
  setrlimit(RLIMIT_AS, &tight);
  const status code = sph_engine.step(run, 5, &finished, &error), again = sph_engine.step(run, 5, &finished, NULL);
  setrlimit(RLIMIT_AS, &before);
  print_message("%s\n", error.message);
  assert_true(code == STATUS_MEMORY && again == STATUS_MEMORY && !finished);
  assert_non_null(strstr(error.message, "no memory"));
  sph_run_free(run);
}
#endif

/* The error of an overlap names the overlap. */
TEST(overlapping_bodies_are_refused) {
  struct sph_inputs inputs = SPH_CASE("colliding-cylinders", "fidelity.particles=300");
  inputs.collision.gap = 1e-6;
  void *run;
  assert_int_equal(sph_engine.prepare(&inputs, 1, &run, &error), STATUS_CONTENT);
  assert_non_null(strstr(error.message, "overlap"));
}

/* Grips and damping layers without any particle are refused: they would have no effect. */
TEST(empty_layers_are_refused) {
  const struct {
    struct sph_inputs inputs;
    const char *word;
  } cases[] = {{SPH_CASE("tensile-rod", "fidelity.particles=1500", "stretch.grip=0.1 mm", "target.turned=false"),
                "stretch.grip"},
               {SPH_CASE("porous-target", "fidelity.particles=1500", "sides.depth=1 mm", "target.turned=false"),
                "sides.depth"}};
  for (int c = 0; c < 2; c++) {
    void *run;
    assert_int_equal(sph_engine.prepare(&cases[c].inputs, 1, &run, &error), STATUS_CONTENT);
    assert_true(strstr(error.message, cases[c].word) && strstr(error.message, "no particle"));
  }
}

/* The h of matter that flies apart grows; in a periodic slab it is limited by the slab's width. */
TEST(vapour_in_a_slab) {
  const struct sph_inputs inputs = SPH_CASE("colliding-cylinders", "fidelity.particles=300", "collision.speed=50 km/s",
                                            "stop.end_time=10 us");
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  if (ran.outcome.state != OUTCOME_COMPLETED)
    fail_msg("%s", ran.outcome.message);
  assert_true(ran.outcome.energy_error < 5e-3);
  free(ran.fragments);
}

/* At the ends of their ranges inputs give a clear error or a run with an honest status and finite numbers. */
static const char *scene; /* a file: 3.4 mm of nylon into 3 cm of basalt */
static void extreme(const char *a, const char *b, const char *c, const char *d) {
  const char *const overrides[] = {"fidelity.particles=150", "fidelity.projectile_spacing=0.5", a, b, c, d, NULL};
  struct sph_inputs inputs = run_case(scene, overrides).sph;
  void *made = NULL;
  bool finished = false;
  if (sph_engine.prepare(&inputs, 1, &made, &error)) {
    assert_true(error.status == STATUS_CONTENT && strlen(error.message) > 20);
    return;
  }
  struct ran ran = {0};
  for (int k = 0; k < (SANITIZED ? 10 : 40) && !finished; k++) /* at most 4000 steps of 170 particles */
    OK(sph_engine.step(made, 100, &finished, &error));
  OK(sph_engine.finish(made, &ran.outcome, &ran.results, &ran.fragments, &ran.count, &error));
  sph_engine.free(made);
  bool fine = ran.outcome.state == OUTCOME_COMPLETED || ran.outcome.state == OUTCOME_END_TIME;
  if (finished && !fine && !strlen(ran.outcome.message))
    fail_msg("%s %s %s %s: state %d without a word", a, b, c, d, ran.outcome.state);
  const struct outcome *o = &ran.outcome; /* no silent NaN */
  assert_true(isfinite(o->time) && isfinite(o->time_step) && isfinite(o->total_mass) && isfinite(o->largest_fraction));
  if (fine)
    for (size_t k = 0; k < ran.count; k++)
      assert_true(isfinite(ran.fragments[k].position[0]) && isfinite(ran.fragments[k].velocity[2]));
  if (strcmp(a, "impact.speed=0") == 0)
    assert_true(fine && ran.results.sph.mean_damage == 0);
  if (strcmp(a, "impact.speed=70 km/s") == 0) /* the fastest impacts on bodies without gravity are ordinary cases */
    assert_true((fine || !finished) && o->energy_error < 5e-3);
  print_message("%s %s %s %s: state %d, %lld steps, M_1/M %.3f, energy %.2g %s\n", a, b, c, d, o->state,
                (long long)o->steps, o->largest_fraction, o->energy_error, o->message);
  free(ran.fragments);
}

TEST(ends_of_the_ranges) {
  char file[100];
  snprintf(file, sizeof file, "/tmp/clast_sph_engine_%d.yaml", (int)getpid());
  FILE *out = fopen(file, "w");
  assert_non_null(out);
  fputs("engine: sph\n", out);
  fclose(out);
  scene = file;
#define NOTHING "impact.angle=0"
  extreme("impact.speed=0", NOTHING, NOTHING, NOTHING);
  extreme("fidelity.precision=float", NOTHING, NOTHING, NOTHING); /* groups that share a list, and have none */
  extreme("impact.speed=1e-3 m/s", NOTHING, NOTHING, NOTHING);
  extreme("impact.speed=70 km/s", NOTHING, NOTHING, NOTHING);
  extreme("impact.speed=1e6 m/s", NOTHING, NOTHING, NOTHING);
  extreme("target.radius=1e-6 m", "projectile.radius=2e-7 m", NOTHING, NOTHING);
  extreme("target.radius=1e6 m", "projectile.radius=2e5 m", NOTHING, NOTHING);
  const char *const m[] = {"target.material.weibull.m=1", "target.material.weibull.m=8.5",
                           "target.material.weibull.m=200"};
  const char *const k[] = {"target.material.weibull.k=1 1/m^3", "target.material.weibull.k=1e100 1/m^3",
                           "target.material.weibull.k=1e200 1/m^3"};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      extreme(m[i], k[j], NOTHING, NOTHING);
  extreme("target.radius=1e6 m", "projectile.radius=2e5 m", m[2], k[2]);
  extreme("target.radius=1e-6 m", "projectile.radius=2e-7 m", m[0], k[0]);
  extreme("fidelity.particles=2", "projectile.radius=3 cm", NOTHING, NOTHING);
  struct sph_inputs alone = run_case(scene,
                                     (const char *const[]){"fidelity.particles=1", "fidelity.projectile_spacing=1",
                                                           "projectile.radius=3 cm", NULL})
                                .sph;
  void *run = NULL;
  if (sph_engine.prepare(&alone, 1, &run, &error))
    fail_msg("one particle against another: %s", error.message);
  sph_engine.free(run);
  extreme("target.material.density=1e-3 kg/m^3", NOTHING, NOTHING, NOTHING);
  extreme("target.material.tillotson.A=1e15 Pa", NOTHING, NOTHING, NOTHING);
  extreme("target.strength=false", "projectile.strength=false", NOTHING, NOTHING);
  extreme("impact.angle=89.9 deg", "projectile.radius=1 cm", "impact.angle=89.9 deg", "impact.speed=3 km/s");
  extreme("target.spin=1e9 rad/s", "method.gradient_correction=true", NOTHING, NOTHING);
  unlink(file);
}
