/* Limits with exact answers, on small bodies: nothing breaks, everything breaks, all flaws are equal, no pores, no
 * speed. */
#include "engine/dem/run/run.h"
#include "engine/dem/step/system_layout.h"
#include "tests/support/run_case.h"

static void release(struct ran *ran) {
  free(ran->fragments);
}

#define DISC(...)                                                                                                      \
  DEM_CASE("disc-explosion", "body.diameter=8 cm", "charge.energy=2 kJ/m", "stop.end_time=1 ms", __VA_ARGS__)
#define IMPACT(...)                                                                                                    \
  SPH_CASE("basalt-sphere", "fidelity.particles=300", "fidelity.projectile_spacing=0.6", "stop.end_time=30 us",        \
           "fragments.static_strength=off", __VA_ARGS__)

/* Without breaking, the body stays one piece with all its grains and mass; energy and momenta are conserved. */
static void one_piece(const struct ran *ran, double energy, double momentum) {
  assert_int_equal(ran->outcome.state, OUTCOME_COMPLETED);
  assert_true(ran->outcome.largest_fraction == 1 && ran->outcome.second_fraction == 0);
  assert_int_equal(ran->outcome.fragment_count, 1);
  assert_true(ran->outcome.dust_fraction == 0);
  assert_true(ran->outcome.energy_error < energy);
  assert_true(ran->outcome.momentum_error < momentum);
}

TEST(grains_that_cannot_part_stay_one_body) {
  const struct dem_inputs cases[] = {
      DISC("threshold.breaking=false"),
      DISC("threshold.strain=100000 %", "threshold.angle=1000 rad"),
      DISC("threshold.breaking=false", "fidelity.integrator=gear"),
      DISC("threshold.breaking=false", "contact.law=off"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    struct ran ran = run_case_run(&dem_engine, &cases[c], 3);
    /* 0.002 of the energy: Verlet at 1 us (0.0009 at 10 ms). Momentum: rounding of 1000 steps. */
    one_piece(&ran, 2e-3, 1e-11);
    assert_int_equal(ran.results.dem.broken, 0);
    release(&ran);
  }
}

/* The weakest charge that is allowed, in place of a body at rest: no beam breaks, and the ledger closes. */
TEST(a_charge_of_nothing_breaks_nothing) {
  const struct dem_inputs inputs = DISC("charge.energy=1e-12 J/m");
  struct ran ran = run_case_run(&dem_engine, &inputs, 3);
  one_piece(&ran, 2e-3, 1e-11); /* bounds as in the case above */
  assert_int_equal(ran.results.dem.broken, 0);
  release(&ran);
}

/* Beams without strength: each grain is a fragment, and the largest fragment is the largest grain. Each of the two
 * thresholds is enough. */
TEST(beams_of_no_strength_leave_dust) {
  const struct dem_inputs cases[] = {
      DISC("threshold.strain=1e-7 %", "threshold.angle=1e-6 deg"),
      DISC("threshold.strain=1e-7 %", "threshold.angle=1000 rad"),
      DISC("threshold.strain=100000 %", "threshold.angle=1e-6 deg"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    struct ran ran = run_case_run(&dem_engine, &cases[c], 3);
    assert_true(ran.outcome.state <= OUTCOME_END_TIME);
    assert_int_equal(ran.outcome.fragment_count, ran.results.dem.grains);
    assert_int_equal(ran.outcome.single_count, ran.results.dem.grains);
    assert_true(ran.outcome.dust_fraction == 1);
    assert_int_equal(ran.fragments[0].count, 1);
    release(&ran);
  }
}

/* The thresholds themselves: with modulus m the logarithm of a factor is ln(-ln(1 - u))/m. Of 1e3 draws of u the
 * smallest is about 1e-3, and 20 bounds the other logarithm up to u = 2e-9. Weights are 1/strain^2 and 1/angle. */
TEST(thresholds_of_large_modulus_have_one_value) {
  const double modulus = 1e6;
  const struct dem_inputs inputs[] = {DISC("threshold.modulus=off"), DISC("threshold.modulus=1e6")};
  struct dem_run *run[2] = {NULL, NULL};
  for (int k = 0; k < 2; k++)
    OK(dem_run_create(&inputs[k], 3, &run[k], &error));
  const struct dem_system *all = run[0]->system, *drawn = run[1]->system;
  for (size_t slot = 0; slot < all->bond_capacity * DEM_BLOCK; slot++) {
    const struct dem_bond_block *a = &all->bond[slot / DEM_BLOCK], *b = &drawn->bond[slot / DEM_BLOCK];
    const size_t lane = slot % DEM_BLOCK;
    assert_true(fabs(b->weight_strain[lane] - a->weight_strain[lane]) <= 40 / modulus * a->weight_strain[lane]);
    assert_true(fabs(b->weight_angle[lane] - a->weight_angle[lane]) <= 20 / modulus * a->weight_angle[lane]);
  }
  for (int k = 0; k < 2; k++)
    dem_run_free(run[k]);
}

/* m to infinity: thresholds drawn from a law with a single value equal that value. */
TEST(thresholds_of_large_modulus_are_all_alike) {
  const struct dem_inputs cases[] = {DISC("threshold.modulus=off"), DISC("threshold.modulus=1e6")};
  struct ran all = run_case_run(&dem_engine, &cases[0], 3), drawn = run_case_run(&dem_engine, &cases[1], 3);
  assert_true(all.results.dem.broken > 20); /* otherwise the comparison tests nothing */
  assert_int_equal(all.results.dem.broken, drawn.results.dem.broken);
  assert_int_equal(all.count, drawn.count);
  for (size_t k = 0; k < all.count; k++)
    assert_true(all.fragments[k].mass == drawn.fragments[k].mass && all.fragments[k].first == drawn.fragments[k].first);
  /* Thresholds differ by 1e-5 at most, so the time of the first break differs by at most a time step. */
  assert_true(fabs(all.results.dem.first_break - drawn.results.dem.first_break) < 1.5e-6);
  release(&all);
  release(&drawn);
}

TEST(solids_without_flaws_stay_whole) {
  const struct sph_inputs cases[] = {
      IMPACT("target.fracture=off"),
      IMPACT("target.material.weibull.k=1 1/m^3", "target.material.weibull.m=1"), /* strains of 1e4 */
      /* without damage there is no crack that tension could open */
      IMPACT("target.material.weibull.k=1 1/m^3", "target.material.weibull.m=1", "fragments.static_strength=1 Pa"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    struct ran ran = run_case_run(&sph_engine, &cases[c], 3);
    one_piece(&ran, 1e-3, 1e-11); /* 2e-4 and rounding */
    assert_true(ran.results.sph.mean_damage == 0 && ran.results.sph.undamaged_fraction == 1);
    release(&ran);
  }
}

/* Flaws that open at zero strain: the target breaks completely, also at 1 m/s, which strong flaws would bear. (Welded:
 * by method.contact: overlap so few particles would press later than in these 60 us.) */
TEST(solids_of_no_strength_become_dust) {
#define WEAK(...)                                                                                                      \
  IMPACT("target.material.weibull.k=1e200 1/m^3", "target.material.weibull.m=8.5", "fracture.cap=none",                \
         "fragments.dust_mass=20 g", __VA_ARGS__)
  const struct sph_inputs cases[] = {
      WEAK("impact.speed=3.2 km/s"),
      WEAK("impact.speed=1 m/s", "method.contact=welded", "impact.gap=0", "stop.end_time=60 us",
           "stop.quiet_time=60 us"),
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    struct ran ran = run_case_run(&sph_engine, &cases[c], 3);
    assert_true(ran.outcome.state <= OUTCOME_END_TIME);
    assert_true(ran.results.sph.undamaged_fraction == 0);
    assert_int_equal(ran.outcome.fragment_count, ran.results.sph.particles); /* single particles */
    assert_true(ran.outcome.dust_fraction == 1);
    release(&ran);
  }
}

/* alpha_0 to 1 from above: a sphere with ever fewer pores approaches the solid one; at 1 it equals it bit by bit. */
TEST(pores_that_vanish_leave_the_solid) {
#define POROUS(alpha)                                                                                                  \
  IMPACT("target.material.porosity.curve=quadratic", "target.material.porosity.distention=" alpha,                     \
         "target.material.porosity.elastic_pressure=1 MPa", "target.material.porosity.solid_pressure=200 MPa",         \
         "target.material.porosity.sound_speed=off")
  const struct sph_inputs solid = IMPACT("fidelity.precision=double"), none = POROUS("1");
  const struct sph_inputs few[] = {POROUS("1.001"), POROUS("1.00001"), POROUS("1.0000001")};
  struct ran whole = run_case_run(&sph_engine, &solid, 3), same = run_case_run(&sph_engine, &none, 3);
  assert_int_equal(whole.count, same.count);
  assert_memory_equal(whole.fragments, same.fragments, whole.count * sizeof *whole.fragments);
  double before = HUGE_VAL;
  for (size_t k = 0; k < 3; k++) {
    struct ran ran = run_case_run(&sph_engine, &few[k], 3);
    const double off = fabs(ran.results.sph.mean_damage - whole.results.sph.mean_damage);
    assert_true(off < before || off < 1e-6);
    before = off;
    release(&ran);
  }
  assert_true(before < 1e-3);
  release(&whole);
  release(&same);
}

/* Nothing moves: no energy, no damage, no time step that is too short. */
TEST(no_speed_changes_nothing) {
  const struct sph_inputs inputs = IMPACT("impact.speed=0 m/s", "impact.gap=0");
  struct ran ran = run_case_run(&sph_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_true(ran.outcome.largest_fraction == 1 && ran.results.sph.mean_damage == 0);
  assert_true(ran.results.sph.energy_input == 0 && isnan(ran.outcome.energy_error));
  for (int d = 0; d < 3; d++)
    assert_true(ran.fragments[0].velocity[d] == 0);
  release(&ran);
}
