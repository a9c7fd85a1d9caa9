/* Whole runs as bench_sph times them. */
#include "tests/bench/sph_whole_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "engine/scene.h"
#include "engine/sph/run/run.h"
#include "engine/sph/step/system.h"
#include "tests/support/allocated.h"

static _Noreturn void fail(const char *what, const struct error *error) {
  fprintf(stderr, "bench_sph: %s %s\n", what, error ? error->message : "");
  exit(70);
}

static double clock_of(clockid_t id) {
  struct timespec t;
  clock_gettime(id, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct setting {
  const char *path, *text; /* NULL path: the end */
};

static struct sph_run *prepare(const char *particles, const struct setting *set, struct scene **scene) {
  struct error error = {0};
  void *run = NULL;
  if (scene_load("basalt-sphere", NULL, scene, &error) != STATUS_OK ||
      scene_set_text(*scene, "fidelity.particles", particles, &error) != STATUS_OK)
    fail("scene:", &error);
  for (; set && set->path; set++)
    if (scene_set_text(*scene, set->path, set->text, &error) != STATUS_OK)
      fail("scene:", &error);
  if (scene_check(*scene, &error) != STATUS_OK ||
      (*scene)->kind->prepare((*scene)->inputs, 1, &run, &error) != STATUS_OK)
    fail("prepare:", &error);
  return run;
}

static void leave(void *context, size_t first, size_t count, const struct sph_pair_sums *sums) {
  (void)context, (void)first, (void)count, (void)sums;
}

/* Seconds of a pass of the pair loop, of a test of the lists and of making new lists, on the current state. None of the
 * three changes it. */
struct phases {
  double pairs, stale, listing;
};

static struct phases measure(struct sph_system *s) {
  const struct sph_pair_fields f = sph_system_step_fields(s);
  const double start = clock_of(CLOCK_PROCESS_CPUTIME_ID);
  sph_pairs_sum(s->pairs, s->n, &f, leave, NULL);
  const double summed = clock_of(CLOCK_PROCESS_CPUTIME_ID);
  volatile bool stale = sph_pairs_slack(s->pairs, 0, s->n, f.x, f.y, f.z, f.h) < 0;
  (void)stale;
  const double tested = clock_of(CLOCK_PROCESS_CPUTIME_ID);
  if (!sph_system_step_relist(s))
    fail(s->failure, NULL);
  return (struct phases){summed - start, tested - summed, clock_of(CLOCK_PROCESS_CPUTIME_ID) - tested};
}

struct figures {
  double speed, largest, energy, undamaged; /* particle-steps/s, shares */
};

static struct figures whole(const char *name, const char *particles, const char *precision) {
  enum { LOOK = 64 };
  const struct setting set[] = {{"fidelity.precision", precision}, {NULL, NULL}};
  struct scene *scene;
  struct error error = {0};
  const size_t before = allocated();
  struct sph_run *run = prepare(particles, set, &scene);
  struct phases sum = {0, 0, 0};
  double spent = 0, looks = 0;
  bool finished = false;
  while (!finished) {
    const double start = clock_of(CLOCK_PROCESS_CPUTIME_ID);
    if (scene->kind->step(run, LOOK, &finished, &error) != STATUS_OK)
      fail("step:", &error);
    spent += clock_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    const struct phases p = measure(run->system);
    sum.pairs += p.pairs, sum.stale += p.stale, sum.listing += p.listing, looks++;
  }
  struct outcome outcome;
  struct sph_results results;
  struct fragment *fragments = NULL;
  size_t count;
  if (scene->kind->finish(run, &outcome, &results, &fragments, &count, &error) != STATUS_OK)
    fail("finish:", &error);
  if (outcome.state != OUTCOME_COMPLETED)
    fprintf(stderr, "bench_sph: %s %s did not complete: %s\n", name, precision, outcome.message);
  const double n = (double)run->system->n, steps = (double)outcome.steps;
  const struct figures f = {n * steps / spent, results.largest.veneer_fraction, outcome.energy_error,
                            results.undamaged_fraction};
  printf("sph_particle_steps_per_s_%s %.4g particle-steps/s\n", name, f.speed);
  printf("sph_particles_%s %.0f 1\n", name, n);
  printf("sph_steps_%s %.0f 1\n", name, steps);
  printf("sph_neighbours_%s %.1f 1\n", name, run->system->now.neighbours);
  printf("sph_listings_per_step_%s %.3f 1\n", name, (double)run->system->now.listings / steps);
  const double one = spent / steps, pairs = sum.pairs / looks / one, stale = sum.stale / looks / one;
  const double listing = sum.listing / looks / one * (double)run->system->now.listings / steps;
  printf("sph_share_pairs_%s %.3f 1\n", name, pairs);
  printf("sph_share_lists_%s %.3f 1\n", name, listing + stale);
  printf("sph_share_ranges_and_sorting_%s %.3f 1\n", name, 1 - pairs - listing - stale);
  printf("sph_run_bytes_per_particle_%s %.0f B\n", name, (double)(allocated() - before) / n);
  printf("sph_largest_fraction_%s %.4f 1\n", name, f.largest);
  printf("sph_energy_error_%s %.2e 1\n", name, f.energy);
  printf("sph_undamaged_fraction_%s %.4f 1\n", name, f.undamaged);
  fflush(stdout);
  free(fragments);
  scene->kind->free(run);
  scene_free(scene);
  return f;
}

void sph_whole_runs_figures(const char *name, const char *particles) {
  char short_name[64];
  snprintf(short_name, sizeof short_name, "%s_float", name);
  const struct figures d = whole(name, particles, "double"), f = whole(short_name, particles, "float");
  printf("sph_ratio_float_%s %.3g 1\n", name, f.speed / d.speed);
  printf("sph_float_error_of_largest_fraction_%s %.2e 1\n", name, f.largest - d.largest);
  printf("sph_float_error_of_energy_%s %.2e 1\n", name, f.energy - d.energy);
  printf("sph_float_error_of_undamaged_fraction_%s %.2e 1\n", name, f.undamaged - d.undamaged);
}

/* Runs to the end of the step that makes new lists for the `count`-th time from now on. */
static void to_listing(struct scene *scene, struct sph_run *run, uint64_t count) {
  struct error error = {0};
  bool finished = false;
  const uint64_t last = run->system->now.listings + count;
  while (!finished && run->system->now.listings < last)
    if (scene->kind->step(run, 1, &finished, &error) != STATUS_OK)
      fail("step:", &error);
  if (finished)
    fail("a run ended early:", &error);
}

enum { LISTINGS = 8 }; /* particles are sorted once in this many list rebuilds: system_step.c */

/* Seconds per particle-step near the start, best of `tries`. The run covers enough list rebuilds that every size
 * includes its share of rebuilding and sorting. The first rebuild is left out because it allocates. */
static double steps_of(const char *particles, const struct setting *set, clockid_t clock, int tries, double *bytes) {
  double best = INFINITY;
  for (int k = 0; k < tries; k++) {
    struct scene *scene;
    const size_t before = allocated();
    struct sph_run *run = prepare(particles, set, &scene);
    const double n = (double)run->system->n;
    to_listing(scene, run, 2);
    const uint64_t first = run->system->now.steps;
    const double start = clock_of(clock);
    to_listing(scene, run, LISTINGS);
    best = fmin(best, (clock_of(clock) - start) / (n * (double)(run->system->now.steps - first)));
    if (bytes)
      *bytes = (double)(allocated() - before) / n;
    scene->kind->free(run);
    scene_free(scene);
  }
  return best;
}

void sph_whole_runs_sizes(void) {
  static const struct {
    const char *particles;
    int tries;
  } size[] = {{"10000", 5}, {"30000", 5}, {"100000", 3}, {"300000", 2}, {"1000000", 2}};
  double least = INFINITY, most = 0;
  for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
    double bytes = 0;
    const double cost = steps_of(size[k].particles, NULL, CLOCK_PROCESS_CPUTIME_ID, size[k].tries, &bytes);
    least = fmin(least, cost), most = fmax(most, cost);
    printf("sph_ns_per_particle_step_first_steps_%s %.1f ns\n", size[k].particles, 1e9 * cost);
    printf("sph_run_bytes_per_particle_first_steps_%s %.0f B\n", size[k].particles, bytes);
    fflush(stdout);
  }
  printf("sph_cost_most_over_least_by_size %.3f 1\n", most / least);
}

void sph_whole_runs_modules(void) {
  static const struct setting none[] = {{NULL, NULL}}, compact[] = {{"fidelity.flaws", "compact"}, {NULL, NULL}},
                              whole_body[] = {{"target.fracture", "off"}, {NULL, NULL}},
                              fluid[] = {{"target.strength", "false"}, {"projectile.strength", "false"}, {NULL, NULL}},
                              corrected[] = {{"method.gradient_correction", "true"}, {NULL, NULL}},
                              volumes[] = {{"method.volume_weights", "true"}, {NULL, NULL}},
                              opposed[] = {{"target.fracture", "off"},
                                           {"method.artificial_stress", "0.3"},
                                           {NULL, NULL}},
                              shorter[] = {{"fidelity.precision", "float"}, {NULL, NULL}};
  static const struct {
    const char *name;
    const struct setting *with, *without;
  } module[] = {{"strength", whole_body, fluid},   {"fracture", none, whole_body},
                {"exact_flaws", none, compact},    {"gradient_correction", corrected, none},
                {"volume_weights", volumes, none}, {"artificial_stress", opposed, whole_body},
                {"float", shorter, none}};
  for (size_t k = 0; k < sizeof module / sizeof *module; k++) {
    double with_bytes, without_bytes, with = INFINITY, without = INFINITY;
    for (int round = 0; round < 4; round++) { /* alternately, so that other load on the machine affects both alike */
      with = fmin(with, steps_of("10000", module[k].with, CLOCK_PROCESS_CPUTIME_ID, 1, &with_bytes));
      without = fmin(without, steps_of("10000", module[k].without, CLOCK_PROCESS_CPUTIME_ID, 1, &without_bytes));
    }
    printf("sph_module_%s %+.1f ns/particle-step\n", module[k].name, 1e9 * (with - without));
    printf("sph_module_%s_memory %+.0f B/particle\n", module[k].name, with_bytes - without_bytes);
    fflush(stdout);
  }
}

void sph_whole_runs_threads(void) {
  static const struct setting one[] = {{NULL, NULL}}, two[] = {{"fidelity.threads", "2"}, {NULL, NULL}};
  const double alone = steps_of("100000", one, CLOCK_MONOTONIC, 2, NULL);
  printf("sph_threads_2_ratio_100000 %.3g 1\n", alone / steps_of("100000", two, CLOCK_MONOTONIC, 2, NULL));
}
