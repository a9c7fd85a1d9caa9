/* The breathing of a ring of grains against the exact answer of plane stress: a ring that expands everywhere at one
 * rate swings in and out with the frequency of the first axisymmetric mode. */
#include "tests/verification/dem_fixture.h"

#include "engine/dem/run/run.h"
#include "tests/support/run_case.h"

/* A value at infinite resolution, from two resolutions a factor of two apart, whose error is linear in the spacing. */
static double limit(double coarse, double fine) {
  return 2 * fine - coarse;
}

/* Young's modulus and Poisson's ratio of the grains' matter: beams alone, pulled slowly. A block's sides are stiffer
 * than its middle: the limit of many columns. */
static void matter(double *modulus, double *ratio) {
  enum { BODIES = 3 };
  double mean[2][2] = {{0, 0}, {0, 0}};
  for (int fine = 0; fine < 2; fine++) {
    struct dem_inputs in = DEM_CASE("uniaxial", "contact.law=off", fine ? "body.columns=50" : "body.columns=25",
                                    fine ? "body.rows=80" : "body.rows=40",
                                    fine ? "grain.spacing=0.5345 cm" : "grain.spacing=1.069 cm",
                                    fine ? "fidelity.time_step=1 us" : "fidelity.time_step=2 us",
                                    "loading.strain_end=0.2 %");
    for (uint64_t seed = 1; seed <= BODIES; seed++) {
      struct ran ran = run_case_run(&dem_engine, &in, seed);
      mean[fine][0] += ran.results.dem.young_modulus / BODIES;
      mean[fine][1] += ran.results.dem.poisson_ratio / BODIES;
      free(ran.fragments);
    }
    print_message("beams alone, %d columns: K %.4g Pa, nu %.3f\n", fine ? 50 : 25, mean[fine][0], mean[fine][1]);
  }
  *modulus = limit(mean[0][0], mean[1][0]);
  *ratio = limit(mean[0][1], mean[1][1]);
}

/* Radial stress of the two solutions J1(k r) and Y1(k r) at a free side, over E k / (1 - nu^2). */
static double side(double k, double r, double nu, bool second) {
  const double x = k * r;
  return second ? y0(x) - (1 - nu) * y1(x) / x : j0(x) - (1 - nu) * j1(x) / x;
}

/* Angular frequency of the first axisymmetric mode of a ring in plane stress (Love: u = A J1 + B Y1, no stress at both
 * sides). A thin ring has sqrt(E/rho)/R; the root is near it. */
static double breathing(double inner, double outer, double modulus, double nu, double density) {
  const double speed = sqrt(modulus / density / (1 - nu * nu)), thin = sqrt(1 - nu * nu) / (0.5 * (inner + outer));
  double low = 0.9 * thin, high = 1.1 * thin, sign = 0;
  for (int k = 0; k < 60; k++) {
    const double middle = k ? 0.5 * (low + high) : low;
    const double determinant = side(middle, inner, nu, false) * side(middle, outer, nu, true) -
                               side(middle, outer, nu, false) * side(middle, inner, nu, true);
    if (k == 0)
      sign = determinant;
    else if (determinant * sign > 0)
      low = middle;
    else
      high = middle;
  }
  return speed * low;
}

/* Angular frequency at which the mean radius of a ring of grains swings, from the crossings of its start value. */
static double measured(const struct dem_inputs *in, uint64_t seed, int swings) {
  struct dem_run *run = NULL;
  OK(dem_run_create(in, seed, &run, &error));
  const struct dem_tessellation *t = run->tessellation;
  double rest = 0, mass = 0, before = 0, first = 0, last = 0;
  for (uint32_t c = 0; c < t->cell_count; c++) {
    rest += t->area[c] * hypot(t->centroid[c].x, t->centroid[c].y);
    mass += t->area[c];
  }
  for (int crossings = 0; crossings <= 2 * swings;) {
    assert_true(dem_system_step(run->system));
    double radius = 0;
    for (uint32_t c = 0; c < t->cell_count; c++) {
      const struct dem_grain grain = dem_system_grain(run->system, c);
      radius += t->area[c] * hypot(grain.x, grain.y);
    }
    const double now = (radius - rest) / mass;
    if (before * now < 0) {
      const double time = dem_system_now(run->system)->time - in->fidelity.time_step * now / (now - before);
      first = crossings++ ? first : time;
      last = time;
    }
    before = now;
  }
  dem_run_free(run);
  return M_PI * 2 * swings / (last - first);
}

TEST(a_ring_breathes) {
  double modulus, nu, deviation[3];
  matter(&modulus, &nu);
  const char *const spacings[] = {"grain.spacing=1.5 cm", "grain.spacing=0.75 cm", "grain.spacing=0.375 cm"};
  const char *const steps[] = {"fidelity.time_step=4 us", "fidelity.time_step=2 us", "fidelity.time_step=1 us"};
  const int seeds[] = {8, 4, 2};
  for (int k = 0; k < 3; k++) {
    struct dem_inputs in = DEM_CASE("ring-explosion", "body.diameter=40 cm", "body.wall=6 cm", spacings[k], steps[k],
                                    "contact.law=off", "threshold.breaking=false", "expansion.rate=0.2 1/s");
    const double exact = breathing(dem_inputs_hole(&in), in.body.diameter / 2, modulus, nu, in.grain.density);
    const double thin = sqrt(modulus / in.grain.density) / (0.5 * (in.body.diameter - in.body.wall));
    assert_true(fabs(exact / thin - 1) < 0.02); /* terms of (wall/R)^2 = 0.12, with small factors */
    double mean = 0;
    for (uint64_t seed = 1; seed <= (uint64_t)seeds[k]; seed++)
      mean += measured(&in, seed, 4) / seeds[k];
    deviation[k] = mean / exact - 1;
    print_message("wall of %.0f spacings, %d rings: %.1f Hz, exact %.1f Hz (thin %.1f Hz), %+.4f\n",
                  in.body.wall / in.grain.spacing, seeds[k], mean / (2 * M_PI), exact / (2 * M_PI), thin / (2 * M_PI),
                  deviation[k]);
  }
  print_message("limit of a fine ring: %+.4f\n", limit(deviation[1], deviation[2]));
  /* Seeds scatter by 0.4 % at 8 spacings and 0.3 % at 16, and the limit of K by 0.5 %: 0.8 % in the limit. */
  assert_true(fabs(limit(deviation[1], deviation[2])) < 0.02);
  /* Rough sides carry less: the error is linear in the spacing, and below 0. */
  assert_true(deviation[0] < deviation[1] && deviation[1] < deviation[2] && deviation[2] < 0);
  assert_true(deviation[0] > -0.15);
}
