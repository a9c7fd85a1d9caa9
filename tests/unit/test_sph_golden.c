/* Pinned hashes of three small runs of engine sph: tests/support/golden.h says what to do when they change. */
#define CHECK_OWN_MAIN
#include "tests/support/golden.h"

enum { RESULTS_VERSION = 15 };
#define GOLDEN_SPHERE "533d3e046e12d935ffeeeaf43f012018"
#define GOLDEN_ROD    "6aae48aab22fee0d5e0a0594652621cc"
#define GOLDEN_RINGS  "afef6015b2971ed38d03ba0a44e3a789"

static int changed(const char *name, const struct sph_inputs *inputs, const char *pinned) {
  struct ran ran = run_case_run(&sph_engine, inputs, 11);
  const double own[] = {ran.results.sph.mean_damage, ran.results.sph.energy.internal, ran.results.sph.energy.kinetic};
  return golden_changed(&sph_engine, name, ran, own, sizeof own / sizeof *own, pinned);
}

TEST(bits_change_only_with_the_version) {
  golden_version(&sph_engine, RESULTS_VERSION);
  struct sph_inputs sphere = SPH_CASE("basalt-sphere", "fidelity.particles=500", "fidelity.projectile_spacing=0.7",
                                      "stop.end_time=30 us", "fracture.draw=poisson");
  struct sph_inputs rod = SPH_CASE("tensile-rod", "fidelity.particles=1200", "stop.end_time=20 us",
                                   "fidelity.flaws=compact", "target.lattice=irregular",
                                   "method.gradient_correction=true");
  struct sph_inputs rings = SPH_CASE("colliding-cylinders", "fidelity.particles=300", "stop.end_time=0.3 ms");
  assert_int_equal(changed("sphere", &sphere, GOLDEN_SPHERE) + changed("rod", &rod, GOLDEN_ROD) +
                       changed("rings", &rings, GOLDEN_RINGS),
                   0);
}

int main(int count, char **arguments) {
  (void)count;
  if (!golden_start(arguments))
    return 71;
  return check_run(NULL, NULL);
}
