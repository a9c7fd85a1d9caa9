/* Seeds of engine sph: the effect of a seed, and the number of flaws of a specimen. */
#include "tests/support/run_case.h"

#include "engine/sph/run/run.h"
#include "engine/sph/step/system.h"

/* A small sphere whose run ends soon. */
#define SMALL(...) SPH_CASE("basalt-sphere", "fidelity.particles=400", "fidelity.projectile_spacing=0.7", __VA_ARGS__)

/* The number of flaws is the one that explain prints and that the memory estimate uses; small cells at the surface do
 * not add to it. */
TEST(flaws_are_as_many_as_told) {
  static const char *const cracked[] = {"disruption", "solid-ice", "basalt-sphere"};
  for (size_t k = 0; k < sizeof cracked / sizeof *cracked; k++) {
    const struct sph_inputs inputs = SPH_CASE(cracked[k], "fidelity.particles=4000", "projectile.fracture=off",
                                              "fidelity.graded=false", "fidelity.projectile_spacing=0.3");
    struct sph_run *run;
    assert_int_equal(sph_run_create(&inputs, 2, &run, NULL), STATUS_OK);
    const double n = (double)run->targets, told = n * (log(n) + 0.5772);
    print_message("%s: %llu flaws, told %.0f\n", cracked[k], (unsigned long long)run->flaw_count, told);
    assert_true(fabs((double)run->flaw_count / told - 1) < 0.005); /* and the few particles that received one */
    sph_run_free(run);
  }
}

TEST(seeds_move_flaws) {
  struct sph_inputs inputs = SMALL("stop.end_time=30 us"),
                    poisson = SMALL("stop.end_time=30 us", "fracture.draw=poisson");
  struct ran a = run_case_run(&sph_engine, &inputs, 1), b = run_case_run(&sph_engine, &inputs, 2),
             c = run_case_run(&sph_engine, &poisson, 1);
  assert_true(a.results.sph.mean_damage != b.results.sph.mean_damage &&
              a.results.sph.mean_damage != c.results.sph.mean_damage);
  assert_true(fabs(a.results.sph.mean_damage - b.results.sph.mean_damage) < 0.3); /* the same body by and large */
  free(a.fragments);
  free(b.fragments);
  free(c.fragments);
}

/* Each seed is its own specimen unless a scene says otherwise: another lattice, other strengths of the flaws. */
TEST(seeds_are_specimens) {
  static const char *const torn[] = {"disruption", "solid-ice", "pumice-sphere"};
  for (size_t k = 0; k < sizeof torn / sizeof *torn; k++) {
    const struct sph_inputs inputs = SPH_CASE(torn[k], "fidelity.particles=1500", "fidelity.projectile_spacing=0.2");
    struct sph_run *run[2];
    double place[2] = {0, 0}, weakest[2] = {HUGE_VAL, HUGE_VAL};
    for (int r = 0; r < 2; r++) {
      assert_int_equal(sph_run_create(&inputs, (uint64_t)r + 1, &run[r], NULL), STATUS_OK);
      for (size_t i = 0; i < run[r]->targets; i++) {
        place[r] += fabs(run[r]->start->x[i]);
        weakest[r] = fmin(weakest[r], run[r]->system->c.weakest[i]);
      }
    }
    assert_true(fabs(place[0] / place[1] - 1) > 1e-9);
    assert_true(fabs(weakest[0] / weakest[1] - 1) > 1e-6);
    for (size_t body = 0; body < 2; body++) /* the projectile, too */
      assert_true(run[0]->start->x[run[0]->range[body].first] != run[1]->start->x[run[1]->range[body].first]);
    sph_run_free(run[0]);
    sph_run_free(run[1]);
  }
  /* a periodic slab has its lattice along its axes; the papers' choices are in their scenes */
  assert_false(SPH_CASE("colliding-cylinders", NULL).target.turned);
  assert_int_equal(SPH_CASE("basalt-sphere", NULL).weibull.draw, SPH_FLAWS_RANKED);
  assert_int_equal(SPH_CASE("tensile-rod", NULL).weibull.draw, SPH_FLAWS_RANKED);
}
