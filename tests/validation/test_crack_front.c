/* The strength of a stretched rod (Benz & Asphaug 1995, section 5.1) against the number of particles, when a crack ends
 * at its particle and when it continues into the next (module crack_front).
 *
 * Quick: 3000 and 12 000 particles at 60 /s. CLAST_FULL=1: 12 000, 50 000 and 150 000 at 60 and 360 /s. */
#include "tests/validation/rod_strength.h"

TEST(strength_does_not_grow) {
  static const int quick[] = {3000, 12000}, full[] = {12000, 50000, 150000};
  const int *particles = run_case_full() ? full : quick, count = run_case_full() ? 3 : 2;
  assert_true(rod_strength_spread("fracture.front=plane", "60 1/s", "12 us", count, particles) < 0.05);
  /* N^(1/m), as printed */
  assert_true(rod_strength_spread("fracture.front=none", "60 1/s", "18 us", count, particles) > 0.1);
  if (run_case_full())
    assert_true(rod_strength_spread("fracture.front=plane", "360 1/s", "4 us", count, particles) < 0.05);
}
