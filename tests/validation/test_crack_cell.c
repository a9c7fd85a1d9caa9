/* The strength of a stretched rod (Benz & Asphaug 1995, section 5.1) against the number of particles, when cells of a
 * fixed width crack as one (module crack_cell).
 *
 * Quick: 3000 and 12 000 particles at 60 /s. CLAST_FULL=1: 3000 to 150 000 at 60 and 360 /s. */
#include "tests/validation/rod_strength.h"

TEST(strength_depends_on_the_cell) {
  static const int particles[] = {3000, 12000, 50000, 150000};
  const int count = run_case_full() ? 4 : 2;
  assert_true(rod_strength_spread("fracture.cell=2 mm", "60 1/s", "18 us", count, particles) < 0.05);
  /* N^(1/m), as printed */
  assert_true(rod_strength_spread("fracture.cell=0 m", "60 1/s", "18 us", count, particles) > 0.1);
  if (run_case_full())
    assert_true(rod_strength_spread("fracture.cell=2 mm", "360 1/s", "4 us", count, particles) < 0.05);
}
