/* Pinned hashes of two small runs of engine dem; tests/support/golden.h says what to do when they change. */
#define CHECK_OWN_MAIN
#include "tests/support/golden.h"

enum { RESULTS_VERSION = 6 };
#define GOLDEN_DISC  "0e38e047ed1ddd66cbca46b75860a7be"
#define GOLDEN_BLOCK "d54d3c9f0c78168ccf172e282cd7478e"

static int changed(const char *name, const struct dem_inputs *inputs, const char *pinned) {
  struct ran ran = run_case_run(&dem_engine, inputs, 11);
  const double own[] = {ran.outcome.mean_fragment_mass, (double)ran.results.dem.broken};
  return golden_changed(&dem_engine, name, ran, own, sizeof own / sizeof *own, pinned);
}

TEST(bits_change_only_with_the_version) {
  golden_version(&dem_engine, RESULTS_VERSION);
  struct dem_inputs disc = DEM_CASE("disc-explosion", "body.diameter=12 cm", "charge.energy=4 kJ/m",
                                    "stop.end_time=1 ms");
  struct dem_inputs block = DEM_CASE("block-impact", "body.columns=12", "body.rows=8", "stop.end_time=0.5 ms",
                                     "threshold.modulus=8", "contact.friction=0.3",
                                     "contact.tangential_damping=1e4 1/s", "fidelity.integrator=gear");
  assert_int_equal(changed("disc", &disc, GOLDEN_DISC) + changed("block", &block, GOLDEN_BLOCK), 0);
}

int main(int count, char **arguments) {
  (void)count;
  if (!golden_start(arguments))
    return 71;
  return check_run(NULL, NULL);
}
