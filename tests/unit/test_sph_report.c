/* The report of engine sph: results computed again from the particles, and results that are off because they cannot be
 * determined. */
#include "tests/support/run_case.h"

#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/step/system.h"

/* A small sphere whose run ends soon. */
#define SMALL(...) SPH_CASE("basalt-sphere", "fidelity.particles=400", "fidelity.projectile_spacing=0.7", __VA_ARGS__)

/* The static strength breaks only matter that cracks have entered. A body that cannot crack stays whole, however it
 * vibrates. So does one whose flaws are all stronger than the impact. */
TEST(sound_matter_stays_whole) {
  const struct sph_inputs cases[] = {SMALL("target.fracture=off"),
                                     SMALL("target.material.weibull.m=100", "target.material.weibull.k=1e200 1/m^3")};
  for (int c = 0; c < 2; c++) {
    struct ran ran = run_case_run(&sph_engine, &cases[c], 3);
    print_message("M_1/M %.3f, without static strength %.3f, undamaged %.3f\n", ran.outcome.largest_fraction,
                  ran.results.sph.largest.dynamic_fraction, ran.results.sph.undamaged_fraction);
    assert_true(ran.results.sph.largest.dynamic_fraction > 0.9);
    assert_true(ran.outcome.largest_fraction >
                ran.results.sph.largest.dynamic_fraction - (c == 0 ? 1e-9 : 0.02)); /* near the crater cracks grow */
    free(ran.fragments);
  }
}

/* A body with almost no pores breaks like the solid. */
TEST(few_pores_change_nothing) {
  const struct sph_inputs cases[] = {SMALL("stop.end_time=10 us"),
                                     SMALL("stop.end_time=10 us", "target.material.porosity.curve=quadratic",
                                           "target.material.porosity.distention=1.0000001",
                                           "target.material.porosity.elastic_pressure=5 MPa",
                                           "target.material.porosity.solid_pressure=300 MPa",
                                           "target.material.porosity.sound_speed=off")};
  double damage[2];
  for (int c = 0; c < 2; c++) {
    struct ran ran = run_case_run(&sph_engine, &cases[c], 3);
    damage[c] = ran.results.sph.mean_damage;
    free(ran.fragments);
  }
  print_message("damage of the solid %.6f, with pores of 1e-7 %.6f\n", damage[0], damage[1]);
  assert_true(damage[0] > 0.05);
  assert_true(fabs(damage[1] - damage[0]) < 1e-3 * damage[0]); /* 1e-7, and steps that the pores limit */
}

/* Dust means lighter than a mass of the scene, not one particle; a fragment of few particles has no shape and no
 * motion. */
TEST(small_fragments) {
  for (int c = 0; c < 2; c++) { /* a largest fragment of more and of less than 100 particles */
    const struct sph_inputs inputs = SMALL(c ? "impact.speed=6 km/s" : "impact.speed=2 km/s",
                                           "fragments.dust_mass=10 g");
    struct ran ran = run_case_run(&sph_engine, &inputs, 3);
    double dust = 0;
    for (size_t k = 0; k < ran.count; k++)
      dust += ran.fragments[k].mass < 0.01 ? ran.fragments[k].mass : 0;
    const double mean = ran.results.sph.target_mass / (double)ran.results.sph.particles;
    assert_true(fabs(ran.outcome.dust_fraction - dust / ran.results.sph.target_mass) < 1e-12);
    assert_true(fabs(ran.outcome.complete_mass / (9.5 * mean) - 1) < 1e-12);
    assert_true(ran.outcome.dust_fraction > (double)ran.outcome.single_count * mean / ran.results.sph.target_mass ||
                ran.outcome.fragment_count == ran.outcome.single_count + 1);
    assert_int_equal(ran.fragments[0].count < 100, c);
    assert_int_equal(isnan(ran.results.sph.largest.speed), c);
    assert_int_equal(isnan(ran.results.sph.largest.axis_short), c);
    assert_true(isnan(ran.results.sph.second.angle)); /* the second is small in both */
    free(ran.fragments);
  }
  /* by default a thousandth of the target, however many particles it has */
  const double few = SMALL(NULL).fragments.dust_mass, many = SPH_CASE("basalt-sphere", NULL).fragments.dust_mass;
  assert_true(few == many && fabs(few / (4.0 / 3 * M_PI * 2.7e-5 * 2700 * 1e-3) - 1) < 1e-9);
}

/* The particles of a graded body have many masses: the spectrum is complete from 9.5 of the heaviest on. */
TEST(complete_by_the_heaviest) {
  const struct sph_inputs inputs = SPH_CASE("disruption", "fidelity.graded=true", "fidelity.spacings_per_radius=3",
                                            "fidelity.coarsest=3", "fidelity.particles=1200",
                                            "fidelity.projectile_spacing=1", "stop.end_time=20 us");
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  double single = 0;
  for (size_t k = 0; k < ran.count; k++)
    single = fmax(single, ran.fragments[k].count == 1 ? ran.fragments[k].mass : 0);
  free(ran.fragments);
  const double heaviest = ran.outcome.complete_mass / 9.5;
  assert_true(single > 2 * ran.results.sph.target_mass / (double)ran.results.sph.particles && single <= heaviest);
  /* spacings grow by at most 0.12 of the distance, and the last particle lies a spacing before the far side */
  const double told = 2700 * pow(sph_derived_coarsest_spacing(&inputs), 3);
  assert_true(heaviest < 1.03 * told && heaviest > told / pow(1.12, 3));
}

/* The figures of the ledger in the report, computed again from the particles. Bounds alone do not detect a figure that
 * is ten times too small. */
TEST(figures_by_hand) {
  const struct sph_inputs cases[] = {SMALL("impact.speed=20 km/s", "stop.end_time=10 us", "viscosity.alpha=0",
                                           "viscosity.beta=0",          /* no heat: u is clamped */
                                           "fidelity.precision=float"), /* momentum that can be seen to be lost */
                                     SPH_CASE("tensile-rod", "fidelity.particles=1500", "stop.end_time=20 us",
                                              "target.turned=false"),
                                     SPH_CASE("colliding-cylinders", "fidelity.particles=300",
                                              "stop.end_time=0.6 ms", /* they have stopped each other */
                                              "fidelity.precision=float")};
  for (int c = 0; c < 3; c++) {
    struct sph_run *run;
    struct ran ran = {0};
    double energy[2] = {0, 0}, kinetic[2] = {0, 0}, momentum[2][3] = {{0}}, scale[2] = {0, 0}, translation = 0,
           change = 0, turning[2] = {0, 0}, mass = 0, common = 0;
    assert_int_equal(sph_run_create(&cases[c], 3, &run, NULL), STATUS_OK);
    for (int b = 0; b < 2 && c == 0; b++) /* a floor under the density that is reached */
      run->system->solid[b].lowest_density = 0.9 * run->system->solid[b].density;
    frame_advance(&run->frame, UINT64_MAX);
    const struct sph_particles *look[2] = {run->start, sph_run_read(run)};
    for (int k = 0; k < 2; k++)
      for (size_t i = 0; i < look[k]->n; i++) {
        const double m = look[k]->mass[i], v[3] = {look[k]->vx[i], look[k]->vy[i], look[k]->vz[i]};
        const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        kinetic[k] += 0.5 * m * square;
        mass += k == 0 ? m : 0;
        energy[k] += 0.5 * m * square + m * look[k]->energy[i];
        for (int d = 0; d < 3; d++)
          momentum[k][d] += m * v[d];
        scale[k] += m * sqrt(square);
        turning[k] += m * (look[k]->x[i] * v[1] -
                           look[k]->y[i] * v[0]); /* the only component conserved in a slab that repeats along z */
      }
    const struct sph_ledger ledger = sph_system_ledger(run->system);
    const double input = kinetic[0] + fabs(ledger.work_of_held),
                 drift = fabs(energy[1] - energy[0] - ledger.work_of_held);
    for (int d = 0; d < 3 && c != 1; d++) /* the rod is held */
      common += momentum[0][d] * momentum[0][d] / (2 * mass);
    OK(sph_report_finish(run, &ran.outcome, &ran.results.sph, &ran.fragments, &ran.count, &error));
    for (size_t k = 0; k < ran.count; k++)
      for (int d = 0; d < 3; d++)
        translation += 0.5 * ran.fragments[k].mass * pow(ran.fragments[k].velocity[d], 2);
    for (int d = 0; d < 3; d++)
      change += pow(momentum[1][d] - momentum[0][d], 2);
    const struct sph_results *r = &ran.results.sph;
    print_message("energy_error %.3g, clamped_share %.3g, density_held_share %.3g, momentum_error %.2g\n",
                  ran.outcome.energy_error, r->clamped_share, r->density_held_share, ran.outcome.momentum_error);
    /* sums in another order: some n^(1/2) roundings of the whole, 1e-14 */
    assert_true(fabs(r->energy_input / input - 1) < 1e-12 && fabs(r->energy.kinetic / kinetic[1] - 1) < 1e-12);
    assert_true(fabs(ran.outcome.energy_error - drift / (input - common)) < 1e-12 && ran.outcome.energy_error > 1e-7);
    assert_true(fabs(ran.outcome.kinetic_energy_share - translation / input) < 1e-12 &&
                (c == 2 || translation > 0.01 * input));
    if (c == 0) /* all momentum of the start is the projectile's, and none of it flies back */
      assert_true(r->ejecta.momentum > 0 &&
                  fabs(r->ejecta.momentum_enhancement - (1 + r->ejecta.momentum / -momentum[0][2])) < 1e-9);
    else
      assert_true(isnan(r->ejecta.momentum_enhancement));
    if (c == 2) {
      const double largest = fmax(scale[0], scale[1]) * sph_run_extent(run);
      assert_true(scale[1] < 0.7 * scale[0] && fabs(ran.outcome.momentum_error / (sqrt(change) / scale[0]) - 1) < 1e-4);
      assert_true(fabs(r->angular_momentum_error / (fabs(turning[1] - turning[0]) / largest) - 1) < 1e-9);
    } else if (c == 0) {
      assert_true(ledger.clamped > 0 && fabs(r->clamped_share / (ledger.clamped / (input - common)) - 1) < 1e-12);
      const double looks = (double)(run->system->now.steps * run->start->n);
      assert_true(ledger.density_held > 0 &&
                  fabs(r->density_held_share / ((double)ledger.density_held / looks) - 1) < 1e-12);
      assert_true(change > 0 && fabs(ran.outcome.momentum_error / (sqrt(change) / fmax(scale[0], scale[1])) - 1) <
                                    1e-4); /* 1e-9 of p, rounded at 1e-14 */
    } else {                               /* grips take momentum and do work */
      assert_true(isnan(ran.outcome.momentum_error) && ledger.work_of_held > 0.001 * input);
      assert_true(r->energy.work_of_held == ledger.work_of_held);
    }
    free(ran.fragments);
    sph_run_free(run);
  }
}

/* A part larger than its whole is an error of the sums and is reported unchanged; without a whole there is no share. */
TEST(a_share_above_one_is_shown) {
  const struct sph_inputs inputs = SMALL("stop.end_time=4 us");
  struct sph_run *run;
  assert_int_equal(sph_run_create(&inputs, 3, &run, NULL), STATUS_OK);
  for (int fault = 0; fault < 3; fault++) {
    struct ran ran = {0};
    if (fault == 1) {
      frame_advance(&run->frame, UINT64_MAX);
      for (int k = 0; k < SPH_LIMITS; k++)
        run->state.limited[k] = 0;
      run->state.limited[SPH_LIMIT_FORCE] = 3 * run->system->now.steps;
    }
    if (fault == 2)
      run->state.limited[SPH_LIMIT_FORCE] = run->system->now.steps; /* all of it */
    assert_int_equal(sph_report_finish(run, &ran.outcome, &ran.results.sph, &ran.fragments, &ran.count, NULL),
                     STATUS_OK);
    const double share = ran.results.sph.limited.force;
    assert_true(fault == 0 ? isnan(share) : share == (fault == 1 ? 3 : 1));
    assert_true(fault == 0 || ran.results.sph.limited.courant == 0);
    free(ran.fragments);
  }
  sph_run_free(run);
}

/* A result that cannot be determined is off, not a plausible number. */
TEST(no_angle_of_nowhere) {
  const struct sph_inputs inputs = SMALL("stop.end_time=4 us");
  struct sph_run *run;
  assert_int_equal(sph_run_create(&inputs, 3, &run, NULL), STATUS_OK);
  for (size_t i = 0; i < run->system->n;
       i++) /* all broken: the second fragment is a particle, and one of them is nowhere */
    run->system->c.damage[i] = 1;
  run->system->c.x[0] = NAN;
  struct ran ran = {0};
  assert_int_equal(sph_report_finish(run, &ran.outcome, &ran.results.sph, &ran.fragments, &ran.count, NULL), STATUS_OK);
  assert_true(ran.count > 1 && isnan(ran.results.sph.second.angle));
  free(ran.fragments);
  sph_run_free(run);
}

/* A body that rebounds carries momentum back, and the target gains as much more: of both bodies none is lost. */
TEST(rebound_counts_in_the_enhancement) {
  const struct sph_inputs inputs = SPH_CASE("disruption", "fidelity.particles=300", "fidelity.projectile_spacing=1",
                                            "impact.projectile=mass", "impact.mass=60 g", "impact.gap=0.1 mm",
                                            "target.fracture=off", "impact.speed=40 m/s", "impact.angle=0 deg",
                                            "target.material.yield_stress=off", "stop.end_time=0.3 ms");
  struct sph_run *run;
  struct ran ran = {0};
  assert_int_equal(sph_run_create(&inputs, 3, &run, NULL), STATUS_OK);
  frame_advance(&run->frame, UINT64_MAX);
  const struct sph_particles *now = sph_run_read(run);
  double momentum[2] = {0, 0};
  for (int b = 0; b < 2; b++)
    for (size_t i = run->range[b].first; i < run->range[b].first + run->range[b].n; i++)
      momentum[b] += now->mass[i] * now->vz[i];
  OK(sph_report_finish(run, &ran.outcome, &ran.results.sph, &ran.fragments, &ran.count, &error));
  const double brought = run->range[1].mass * 40;
  assert_true(momentum[1] > 0.1 * brought && ran.results.sph.ejecta.momentum == 0);
  assert_true(fabs(ran.results.sph.ejecta.momentum_enhancement - -momentum[0] / brought) < 0.02);
  free(ran.fragments);
  run->inputs.crater.escape_speed = 1000; /* all of it falls back */
  OK(sph_report_finish(run, &ran.outcome, &ran.results.sph, &ran.fragments, &ran.count, &error));
  assert_true(ran.results.sph.ejecta.momentum_enhancement == 1);
  free(ran.fragments);
  sph_run_free(run);
}
