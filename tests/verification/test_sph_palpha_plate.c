/* Scene porous-plate (T5): a piston drives a shock into porous aluminium without strength. The run's report and the
 * engine's exact answer against jump conditions solved independently of the engine (palpha_exact.h): front speeds, the
 * plateau behind the shock, the precursor, the energy; converging. By default a weak shock at 100 and 200 points along
 * the bar, and the fastest at 200; CLAST_FULL=1: four speeds, 200, 400 and 800 points. */
#include "engine/sph/material/material.h"
#include "engine/sph/material/palpha.h"
#include "palpha_exact.h"
#include "tests/support/run_case.h"

static void near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%s: got %.8g, expected %.8g +- %g", what, got, want, relative);
}

/* ---- the engine's own exact answer ---- */

static struct sph_material aluminium(double distention) {
  struct sph_material m;
  OK(sph_materials_load("porous-aluminium", &m, &error));
  m.palpha.distention = distention;
  return m;
}

/* 1e-6: the elastic branch is one step of fourth order there, 2000 of second order here. */
static void front_is(const struct sph_front *f, const struct exact_front *want) {
  near(f->speed, want->speed, 1e-6, "speed of a front");
  near(f->density, want->density, 1e-6, "density behind a front");
  near(f->pressure, want->pressure, 1e-6, "pressure behind a front");
  near(f->energy, want->energy, 1e-5, "energy behind a front");
  near(f->velocity, want->velocity, 1e-6, "velocity behind a front");
  near(f->distention, want->alpha, 1e-6, "distention behind a front");
}

TEST(exact_answers_agree) {
  for (int a = 0; a < 4; a++)
    for (int k = 0; k < 4; k++) {
      const double distention = (double[]){1, 1.1, 1.275, 1.6}[a], piston = (double[]){30, 200, 458, 900}[k];
      struct exact_matter matter = exact_porous_aluminium;
      struct sph_material material = aluminium(distention);
      struct exact_front precursor, shock;
      struct sph_plane_shock got;
      matter.alpha0 = distention;
      exact_piston(&matter, piston, &precursor, &shock);
      OK(sph_plane_shock(&material, piston, &got, &error));
      assert_true(got.has_shock);
      assert_int_equal(got.has_precursor, distention > 1 && shock.speed < precursor.speed);
      if (got.has_precursor)
        front_is(&got.precursor, &precursor);
      if (got.has_precursor || !(distention > 1))
        front_is(&got.shock, &shock);
    }
}

/* Matter of fewer pores than the curve begins with keeps them until it meets the curve, above P_e. */
TEST(pores_begin_to_close_on_the_curve) {
  struct sph_material m;
  struct sph_palpha_law law;
  struct sph_plane_shock got;
  OK(sph_materials_load("pumice", &m, &error));
  OK(sph_palpha_prepare(&m.palpha, &m, &law, &error));
  assert_true(sph_palpha_crush_begin(&law) == m.palpha.elastic_pressure);
  m.palpha.distention = 1 / 0.6; /* no sound speed is given, so that the elastic branch is alpha_0 */
  OK(sph_palpha_prepare(&m.palpha, &m, &law, &error));
  double begin = m.palpha.elastic_pressure, end = m.palpha.transition_pressure;
  while (end - begin > 1e-9 * end) {
    const double p = (begin + end) / 2,
                 of_low = (m.palpha.transition_pressure - p) / (m.palpha.transition_pressure - 1e6),
                 of_high = (m.palpha.solid_pressure - p) / (m.palpha.solid_pressure - 1e6);
    const double alpha = 1 + (4.64 - 1.9) * pow(of_low, 12) + (1.9 - 1) * pow(of_high, 3);
    *(alpha > m.palpha.distention ? &begin : &end) = p;
  }
  near(sph_palpha_crush_begin(&law), begin, 1e-8, "pressure at which pores begin to close");
  OK(sph_plane_shock(&m, 10, &got, &error));
  assert_true(got.has_precursor && got.has_shock);
  near(got.precursor.pressure, begin, 1e-8, "pressure of the precursor");
  near(got.precursor.distention, m.palpha.distention, 1e-12, "its distention");
  const double mass = got.precursor.density *
                      (got.shock.speed - got.precursor.velocity); /* momentum across the shock */
  near(got.shock.pressure - begin, mass * (got.shock.velocity - got.precursor.velocity), 1e-6, "pressure of the shock");
  assert_true(got.shock.speed < 400 && got.shock.distention < 1.64);
}

/* A piston slower than the matter behind the precursor crushes no pores; a very fast one leaves no precursor: then the
 * jump is from rest. */
TEST(slow_and_fast_pistons) {
  struct sph_material m = aluminium(1.275);
  struct sph_plane_shock got;
  OK(sph_plane_shock(&m, 5, &got, &error));
  assert_true(got.has_precursor && !got.has_shock && isnan(got.shock.speed));
  near(got.precursor.velocity, 5, 1e-9, "velocity behind an elastic front");
  assert_true(got.precursor.pressure < 80e6 && got.precursor.distention < 1.275 && got.precursor.distention > 1.2738);
  near(got.precursor.speed, 4110, 0.005, "elastic front, nearly c_e");
  OK(sph_plane_shock(&m, 4000, &got, &error));
  assert_true(!got.has_precursor && got.has_shock && got.shock.distention == 1 && got.shock.speed > 4110);
  near(got.shock.pressure, got.first_density * got.shock.speed * 4000, 1e-9, "momentum across a shock from rest");
  near(got.shock.energy, 4000. * 4000 / 2, 1e-9, "energy across a shock from rest");
  near(exact_solid_pressure(&exact_porous_aluminium, got.shock.density, got.shock.energy), got.shock.pressure, 1e-9,
       "its pressure");
  assert_int_equal(sph_plane_shock(&m, 1e9, &got, &error), STATUS_CONTENT);
  /* a solid: the known Hugoniot state of Melosh's aluminium */
  m.palpha.curve = SPH_CRUSH_NONE;
  OK(sph_plane_shock(&m, 1000, &got, &error));
  near(got.shock.speed, 6753.5, 1e-4, "Us of solid aluminium");
  near(got.shock.pressure, 18.234e9, 1e-4, "P of solid aluminium");
}

/* ---- the moving plate ---- */

static struct sph_results run(int points, double piston) {
  char along[40], speed[60];
  snprintf(along, sizeof along, "fidelity.points=%d", points);
  snprintf(speed, sizeof speed, "piston.speed=%.17g m/s", piston);
  struct sph_inputs inputs = SPH_CASE("porous-plate", along, speed);
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  const struct sph_results r = ran.results.sph;
  free(ran.fragments);
  print_message("%3d points, %g m/s: Us %.1f (%.1f) rho %.2f (%.2f) P %.2f (%.2f) MPa alpha %.5f (%.5f) precursor %.1f "
                "(%.1f) m/s "
                "%.2f MPa; energy %.1e; %lld steps\n",
                points, piston, r.shock.speed, r.shock.speed_exact, r.shock.density, r.shock.density_exact,
                r.shock.pressure / 1e6, r.shock.pressure_exact / 1e6, r.palpha.shock, r.palpha.shock_exact,
                r.precursor.speed, r.precursor.speed_exact, r.precursor.pressure / 1e6, ran.outcome.energy_error,
                (long long)ran.outcome.steps);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_true(ran.outcome.energy_error < 0.005); /* of the work done: the criterion */
  assert_int_equal(r.particles, points * 25);
  struct exact_front precursor, shock;
  exact_piston(&exact_porous_aluminium, piston, &precursor, &shock);
  near(r.shock.speed_exact, shock.speed, 1e-6, "exact Us");
  near(r.shock.pressure_exact, shock.pressure, 1e-6, "exact P");
  near(r.precursor.speed_exact, precursor.speed, 1e-6, "exact precursor");
  return r;
}

/* alpha of matter that was raised from rest to P and never had a higher pressure. */
static double exact_alpha(const struct exact_matter *m, double P) {
  return P > m->P_e ? exact_crush(m, exact_alpha_e(m), P) : exact_elastic(m, P, exact_alpha_e(m));
}

/* Between a shock of 1000 m/s and the precursor, which is nearly as fast, 200 points leave nothing that is flat: the
 * foot of the shock raises P above P_e by some 0.4 % there, and 0.4 % of P close pores by 3e-4 of alpha. */
static bool precursor_is_flat(double piston, int points) {
  return piston < 1000 || points >= 400;
}

/* Us 1 %, plateau 1 %, alpha 0.005, precursor 0.5 % and its pressure 1 %. P behind a weak shock follows rho with K/P =
 * 38 times its error. At 1000 m/s 0.6 % of P: where matter slips between the piston's layers 200 points lose 0.86 %. */
static void check(const struct sph_results *r, double piston, int points) {
  near(r->shock.speed, r->shock.speed_exact, 0.01, "Us");
  near(r->shock.density, r->shock.density_exact, points < 400 ? 0.002 : 0.001, "density behind the shock");
  near(r->shock.pressure, r->shock.pressure_exact, piston < 1000 ? 0.01 : 0.006, "pressure behind the shock");
  near(r->palpha.shock, r->palpha.shock_exact, 0.005 / r->palpha.shock_exact, "alpha behind the shock");
  near(r->precursor.speed, r->precursor.speed_exact, 0.005, "precursor");
  near(r->precursor.pressure, r->precursor.pressure_exact, 0.01, "pressure of the precursor");
  const double on_curve = exact_alpha(&exact_porous_aluminium, r->precursor.pressure);
  near(r->palpha.precursor, on_curve, 1e-4, "alpha of the precursor at its pressure"); /* it changes by 1.1e-3 */
  if (precursor_is_flat(piston, points))
    near(r->palpha.precursor, r->palpha.precursor_exact, 1e-4, "alpha of the precursor");
}

/* Error of a result that depends only on the curve: the weak shock leaves alpha = 1.0334. */
static double weak_error(const struct sph_results *r) {
  return fabs(r->palpha.shock - r->palpha.shock_exact);
}
static double precursor_error(const struct sph_results *r) {
  return fabs(r->precursor.speed - r->precursor.speed_exact);
}

static void other_speeds(int points) {
  static const double full[] = {100, 458, 1000}, quick[] = {1000};
  const double *piston = run_case_full() ? full : quick;
  const size_t count = run_case_full() ? sizeof full / sizeof *full : sizeof quick / sizeof *quick;
  for (size_t k = 0; k < count; k++) {
    const struct sph_results other = run(points, piston[k]);
    check(&other, piston[k], points);
  }
}

TEST(all_speeds) {
  struct sph_results coarse = run(100, 200);
  for (int points = 200; points <= (run_case_full() ? 800 : 200); points *= 2) {
    const struct sph_results weak = run(points, 200);
    check(&weak, 200, points);
    assert_true(weak_error(&weak) < 1e-3); /* a smeared shock is also too weak: 1.3e-2 at 100, 3.2e-3 at 200 points */
    assert_true(precursor_error(&weak) < 0.6 * precursor_error(&coarse));
    coarse = weak;
    other_speeds(points);
  }
}

/* Shocks that close a part of the pores of other matter, and move at a tenth of the speed of elastic waves: with the
 * viscosity of those waves pumice at 150 m/s has half of its pressure. Threefold compression in a front of few
 * particles: the density carried through it is 5 % low without geometric weights. */
TEST(weak_shocks_in_other_matter) {
  static const struct {
    const char *material;
    double piston, within; /* m/s; of P */
  } shocks[] = {{"pumice", 150, 0.02},
                {"perlite-mix", 200, 0.02},
                {"porous-ice", 300, 0.02},
                {"pumice", 250, 0.03},
                {"pumice", 400, 0.04}};
  const size_t count = run_case_full() ? sizeof shocks / sizeof *shocks : 1;
  for (size_t k = 0; k < count; k++) {
    char material[60], speed[40];
    snprintf(material, sizeof material, "target.material.name=%s", shocks[k].material);
    snprintf(speed, sizeof speed, "piston.speed=%g m/s", shocks[k].piston);
    struct sph_inputs inputs = SPH_CASE("porous-plate", "fidelity.points=200", material, speed);
    struct ran ran = run_case_run(&sph_engine, &inputs, 1);
    const struct sph_results r = ran.results.sph;
    free(ran.fragments);
    print_message("%s, %g m/s: Us %.1f (%.1f) rho %.1f (%.1f) P %.3f (%.3f) MPa\n", shocks[k].material,
                  shocks[k].piston, r.shock.speed, r.shock.speed_exact, r.shock.density, r.shock.density_exact,
                  r.shock.pressure / 1e6, r.shock.pressure_exact / 1e6);
    assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
    near(r.shock.pressure, r.shock.pressure_exact, shocks[k].within, "P");
    near(r.shock.speed, r.shock.speed_exact, 0.03, "Us");
  }
}

/* alpha_0 = 1 is the solid: one front, no distention; and a piston that is too slow for a shock leaves only the elastic
 * front. */
TEST(solid_and_elastic) {
  struct sph_inputs inputs = SPH_CASE("porous-plate", "fidelity.points=100", "target.material.porosity.distention=1",
                                      "piston.speed=1 km/s");
  struct ran ran = run_case_run(&sph_engine, &inputs, 1);
  free(ran.fragments);
  const struct sph_results solid = ran.results.sph;
  near(solid.shock.speed, 6753.5, 0.01, "Us of the solid");
  near(solid.shock.pressure, 18.234e9, 0.01, "P of the solid");
  assert_true(isnan(solid.precursor.speed) && isnan(solid.palpha.shock) && isnan(solid.palpha.shock_exact));
  inputs = SPH_CASE("porous-plate", "fidelity.points=100", "piston.speed=5 m/s");
  ran = run_case_run(&sph_engine, &inputs, 1);
  free(ran.fragments);
  const struct sph_results elastic = ran.results.sph;
  near(elastic.precursor.speed, elastic.precursor.speed_exact, 0.02, "elastic front");
  near(elastic.precursor.pressure, elastic.precursor.pressure_exact, 0.01, "its pressure");
  assert_true(isnan(elastic.shock.speed) && isnan(elastic.shock.pressure_exact));
}
