/* External loads on a body and their measurement: work of held grains, momentum under holds, strains and stresses of an
 * affine deformation, the mode of a break, energies that are known. */
#include "tests/verification/dem_fixture.h"

#include "engine/dem/run/run.h"
#include "tests/support/run_case.h"

/* One grain of two is driven along, across and around: the energy gained is the booked work. Two integrators. */
TEST(driven_grains_do_work) {
  for (int integrator = DEM_VERLET; integrator <= DEM_GEAR; integrator++)
    for (int which = 0; which < 3; which++) {
      DEM_TESSELLATION *t = fixture_squares(2, 2, 0.01, 0.0, true);
      struct dem_inputs in = fixture_inputs();
      in.contact.law = DEM_CONTACT_OFF; /* smooth: what remains is the integrator's error */
      in.fidelity.integrator = integrator;
      in.fidelity.time_step = 2e-7;
      DEM_SYSTEM *s = fixture_create(t, &in);
      dem_system_hold(s, 0, which == 0 ? 1u : which == 1 ? 2u : 4u);
      const double before = fixture_total(dem_system_ledger(s));
      for (int k = 0; k < 2000; k++) {
        const double speed = k < 1000 ? 1e-3 * k : 1.0; /* m/s; and a jolt below */
        const double jolt = k < 1500 ? 1.0 : -0.5;
        dem_system_drive(s, 0, which == 0 ? jolt * speed : 0.0, which == 1 ? jolt * speed : 0.0,
                         which == 2 ? 100.0 * jolt * speed : 0.0);
        assert_true(dem_system_step(s));
      }
      const struct dem_ledger l = dem_system_ledger(s);
      print_message("          %s, freedom %d: work %.3g, kinetic %.3g, beam %.3g, open by %.1e\n",
                    integrator == DEM_GEAR ? "Gear" : "Verlet", which, l.external_work, l.kinetic, l.beam,
                    (fixture_total(l) - before) / l.external_work);
      assert_true(l.external_work > 0.01); /* J/m: the driven grain's own kinetic energy is 0.25 at 1 m/s */
      assert_true(l.beam + l.kinetic > 0.5 * l.external_work);
      /* trapezoids of a force that changes within (2/15 us)^-1: (0.2/15)^2/12 = 1.5e-5 of what goes to and fro */
      fixture_near(fixture_total(l), before, 1e-3 * l.external_work, "work");
    }
}

/* Loaded bodies: the momentum given to held grains is what the free ones lose, to rounding; the work is the only energy
 * input. */
TEST(loads_balance) {
  struct dem_inputs cases[] = {DEM_CASE("compression", "body.columns=8", "body.rows=8", "loading.rate=5 1/s",
                                        "loading.ramp=1 ms"),
                               DEM_CASE("uniaxial", "body.columns=8", "body.rows=8", "loading.rate=5 1/s",
                                        "loading.ramp=1 ms")};
  for (int k = 0; k < 2; k++) {
    struct ran ran = run_case_run(&dem_engine, &cases[k], 3);
    assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
    assert_true(ran.results.dem.energy.external_work > 0.0);
    assert_true(ran.outcome.energy_error < 1e-3);    /* Verlet at a tenth of the stability limit, with breaks */
    assert_true(ran.outcome.momentum_error < 1e-11); /* sums of 1e4 steps' roundings */
    free(ran.fragments);
  }
}

/* Sides of a uniaxial load slide along x, those of K99's confined compression do not; neither turns or leaves its line.
 */
TEST(sides_are_held_as_described) {
  for (int confined = 0; confined < 2; confined++) {
    struct dem_inputs inputs = DEM_CASE(confined ? "compression" : "uniaxial", "body.columns=8", "body.rows=8",
                                        "loading.rate=5 1/s", "loading.ramp=0.5 ms");
    struct dem_run *run;
    assert_int_equal(dem_run_create(&inputs, 3, &run, NULL), STATUS_OK);
    frame_advance(&run->frame, 1000);
    double along = 0.0, turned = 0.0, line = 0.0;
    for (size_t k = 0; k < run->lower_count; k++) {
      const struct dem_grain g = dem_system_grain(run->system, run->lower[k]);
      const struct dem_grain first = dem_system_grain(run->system, run->lower[0]);
      const struct dem_point *from = &run->tessellation->centroid[run->lower[k]];
      along = fmax(along, fabs(g.x - from->x));
      turned = fmax(turned, fabs(g.angle));
      line = fmax(line, fabs((g.y - from->y) - (first.y - run->tessellation->centroid[run->lower[0]].y)));
    }
    assert_true(confined ? along == 0.0 : along > 1e-7);
    assert_true(turned == 0.0);
    assert_true(line < 1e-15);
    dem_run_free(run);
  }
}

/* Put a block by hand into an affine deformation: the recorded strains are the given ones, the stress is that of the
 * beams. */
TEST(strains_are_those_put_in) {
  struct dem_inputs inputs = DEM_CASE("uniaxial", "body.columns=12", "body.rows=10", "grain.disorder=0.7");
  struct dem_run *run;
  assert_int_equal(dem_run_create(&inputs, 4, &run, NULL), STATUS_OK);
  const double axial = 2e-3, lateral = -7e-4;
  const struct dem_tessellation *t = run->tessellation;
  for (uint32_t i = 0; i < t->cell_count; i++) {
    run->system->c.x[i] = t->centroid[i].x * (1.0 + lateral);
    run->system->c.y[i] = t->centroid[i].y; /* as the sides do: each row keeps its line */
    if (t->grid_y[i] == 0)
      run->system->c.y[i] -= 0.25 * axial * run->gauge_length;
    if (t->grid_y[i] == 9)
      run->system->c.y[i] += 0.75 * axial * run->gauge_length;
    run->system->c.fy[i] = t->grid_y[i] == 0 ? 3.0 : t->grid_y[i] == 9 ? -5.0 : 7.0;
  }
  run->sample_interval = 1;
  dem_loading_record(run);
  assert_int_equal(run->state.frame.samples, 1);
  fixture_near(run->sample[0].strain, axial, 1e-12, "axial strain");
  fixture_near(run->sample[0].lateral_strain, lateral, 1e-12, "lateral strain");
  /* 12 grains pull with 3 N/m each below, with 5 above: mean of both sides over twelve spacings */
  fixture_near(run->sample[0].stress, 12 * 4.0 / (12 * inputs.grain.spacing), 1e-9, "stress");
  dem_run_free(run);
}

/* A stretched beam breaks by stretching, a rotated and hardly stretched one by bending, a compressed one by neither.
 * The rule is K99's eq 13: strain squared, angle not, the larger angle of the two. */
TEST(modes_of_breaking) {
  const struct {
    double strain, first, second; /* in thresholds */
    int broken, bending;
  } cases[] = {{1.01, 0.0, 0.0, 1, 0},  {0.99, 0.0, 0.0, 0, 0}, {0.1, 0.995, 0.0, 1, 1}, {0.1, 0.0, -0.995, 1, 1},
               {0.1, 0.985, 0.2, 0, 0}, {0.8, 0.37, 0.1, 1, 0}, {0.8, 0.35, 0.1, 0, 0},  {0.6, -0.1, 0.65, 1, 1},
               {0.6, 0.1, 0.63, 0, 0},  {-1.5, 0.0, 0.0, 0, 0}, {-0.1, 3.0, 3.0, 0, 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, true);
    struct dem_inputs in = fixture_inputs();
    in.threshold.breaking = true;
    DEM_SYSTEM *s = fixture_create(t, &in);
    fixture_place(s, 0, t->centroid[0].x, t->centroid[0].y, cases[k].first * in.threshold.angle);
    fixture_place(s, 1, t->centroid[1].x + 0.01 * cases[k].strain * in.threshold.strain, t->centroid[1].y,
                  cases[k].second * in.threshold.angle);
    fixture_evaluate(s);
    const struct dem_break *log;
    const size_t breaks = dem_system_breaks(s, &log);
    if (breaks != (size_t)cases[k].broken)
      fail_msg("case %zu: %zu breaks", k, breaks);
    if (breaks && log[0].bending != cases[k].bending)
      fail_msg("case %zu: bending %d", k, (int)log[0].bending);
    if (breaks)
      fixture_near(log[0].strain, cases[k].strain * in.threshold.strain, 1e-12, "strain logged");
  }
}

/* A square lattice: every beam has S = l = spacing, and half E S l t^2 at the threshold. */
TEST(threshold_energy_of_a_square_lattice) {
  struct dem_inputs inputs = DEM_CASE("block-impact", "body.columns=6", "body.rows=5", "grain.disorder=0",
                                      "stop.end_time=2 us");
  struct ran ran = run_case_run(&dem_engine, &inputs, 1);
  assert_int_equal(ran.results.dem.beams, 5 * 5 + 6 * 4);
  const double one = 0.5 * inputs.beam.young_modulus * inputs.grain.spacing * inputs.grain.spacing *
                     inputs.threshold.strain * inputs.threshold.strain;
  fixture_near(ran.results.dem.threshold_energy, 49.0 * one, 1e-10 * one, "threshold energy");
  free(ran.fragments);

  inputs = DEM_CASE("disc-explosion", "body.diameter=8 cm", "grain.spacing=1 cm", "grain.disorder=0",
                    "stop.end_time=2 us");
  ran = run_case_run(&dem_engine, &inputs, 1);
  const double beams = (double)ran.results.dem.beams; /* without those of the explosive */
  fixture_near(ran.results.dem.threshold_energy, beams * one, 1e-9 * one, "without the explosive");
  free(ran.fragments);

  /* thresholds of an exponential law: their squares have the mean 2 and the variance 20 */
  inputs = DEM_CASE("block-impact", "grain.disorder=0", "threshold.modulus=1", "stop.end_time=2 us");
  ran = run_case_run(&dem_engine, &inputs, 1);
  const double mean = ran.results.dem.threshold_energy / one / (double)ran.results.dem.beams;
  fixture_near(mean, 2.0, 5.0 * sqrt(20.0 / (double)ran.results.dem.beams), "drawn thresholds");
  free(ran.fragments);
}

/* Every beam along the load of a square lattice breaks at t_eps, so its strength is E t_eps, wherever the load ends. */
TEST(strength_of_a_square_lattice) {
  const char *const ends[] = {"loading.strain_end=0.1 %", "loading.strain_end=3 %"};
  for (int k = 0; k < 2; k++) {
    struct dem_inputs inputs = DEM_CASE("uniaxial", "grain.disorder=0", "body.columns=8", "body.rows=8",
                                        "threshold.breaking=true", "threshold.strain=0.03 %", "loading.rate=0.1 1/s",
                                        "loading.ramp=0.5 ms", "fidelity.time_step=3 us", ends[k]);
    struct ran ran = run_case_run(&dem_engine, &inputs, 1);
    const double step = inputs.loading.rate * inputs.fidelity.time_step / inputs.threshold.strain; /* 0.1 % */
    fixture_near(ran.results.dem.strength / (inputs.beam.young_modulus * inputs.threshold.strain), 1.0, step,
                 "strength");
    fixture_near(ran.results.dem.failure_strain / inputs.threshold.strain, 1.0, step, "failure strain");
    free(ran.fragments);
  }
}

/* Mass and moment of inertia of every grain by triangles of its outline, in long double. */
TEST(grains_have_their_inertia) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, 1.0, 2);
  const struct dem_inputs in = fixture_inputs();
  DEM_SYSTEM *s = fixture_create(t, &in);
  for (uint32_t i = 0; i < t->cell_count; i++) {
    long double area = 0, moment = 0;
    for (uint32_t v = t->first_vertex[i]; v < t->first_vertex[i + 1]; v++) {
      const uint32_t w = v + 1 < t->first_vertex[i + 1] ? v + 1 : t->first_vertex[i];
      const long double ax = (long double)t->vertex[v].x - t->centroid[i].x,
                        ay = (long double)t->vertex[v].y - t->centroid[i].y;
      const long double bx = (long double)t->vertex[w].x - t->centroid[i].x,
                        by = (long double)t->vertex[w].y - t->centroid[i].y;
      const long double twice = ax * by - ay * bx;
      area += twice / 2;
      moment += twice / 12 * (ax * ax + ay * ay + ax * bx + ay * by + bx * bx + by * by);
    }
    const struct dem_grain g = dem_system_grain(s, i);
    fixture_near(g.mass, (double)(in.grain.density * area), 1e-12 * g.mass,
                 "mass"); /* roundings of coordinates of 6 cells */
    fixture_near(g.moment_of_inertia, (double)(in.grain.density * moment), 1e-12 * g.moment_of_inertia,
                 "moment of inertia");
  }
}

/* Thresholds drawn per beam: of a Weibull law ln t has the mean ln t0 - gamma/m and the standard deviation pi/(m sqrt
 * 6). */
TEST(thresholds_are_weibulls) {
  DEM_TESSELLATION *t = fixture_disc(0.2, 0.01, 1.0, 2);
  struct dem_inputs in = fixture_inputs();
  const double m = 4.0, n = (double)t->pair_count;
  in.threshold.breaking = true;
  in.threshold.modulus = m;
  DEM_SYSTEM *s = NULL;
  assert_int_equal(dem_system_create(t, &in, 11, &s, NULL), STATUS_OK);
  double sum[2] = {0}, square[2] = {0}, both = 0;
  for (size_t k = 0; k < t->pair_count; k++) {
    const struct dem_bond_block *b = &s->bond[k / DEM_BLOCK];
    const size_t lane = k % DEM_BLOCK;
    const double log_of[2] = {-0.5 * log(b->weight_strain[lane]) - log(b->length[lane] * in.threshold.strain),
                              -log(b->weight_angle[lane] * in.threshold.angle)};
    for (int q = 0; q < 2; q++)
      sum[q] += log_of[q] / n, square[q] += log_of[q] * log_of[q] / n;
    both += log_of[0] * log_of[1] / n;
  }
  const double spread = M_PI / (m * sqrt(6.0));
  for (int q = 0; q < 2; q++) { /* five standard errors of a mean; of a deviation, ln t has kurtosis 5.4 */
    fixture_near(sum[q], -0.57721566490153286 / m, 5.0 * spread / sqrt(n), "mean of ln t");
    fixture_near(sqrt(square[q] - sum[q] * sum[q]), spread, 5.0 * spread * sqrt(4.4 / 4.0 / n), "spread of ln t");
  }
  fixture_near((both - sum[0] * sum[1]) / (spread * spread), 0.0, 5.0 / sqrt(n), "correlation of the two");
}

/* Thresholds of the pair of two lattice squares over the scene's, by their place in the bond blocks; false: no such
 * pair. */
static bool thresholds_at(const struct dem_tessellation *t, const struct dem_inputs *in, const struct dem_system *s,
                          const uint64_t square[2], double factor[2]) {
  for (size_t k = 0; k < t->pair_count; k++) {
    uint64_t own[2];
    for (int end = 0; end < 2; end++)
      own[end] = dem_lattice_square(t->grid_x[t->pair[k][end]], t->grid_y[t->pair[k][end]]);
    if (!(own[0] == square[0] && own[1] == square[1]) && !(own[0] == square[1] && own[1] == square[0]))
      continue;
    const struct dem_bond_block *b = &s->bond[k / DEM_BLOCK];
    const size_t lane = k % DEM_BLOCK;
    factor[0] = 1.0 / sqrt(b->weight_strain[lane]) / b->length[lane] / in->threshold.strain;
    factor[1] = 1.0 / b->weight_angle[lane] / in->threshold.angle;
    return true;
  }
  return false;
}

/* The same body with its grains numbered from the last to the first. */
static struct dem_tessellation *renumbered(const struct dem_tessellation *t) {
  struct dem_tessellation *r = fixture_squares((uint32_t)t->cell_count, 2, 1.0, 0.0, true); /* room enough */
  r->cell_count = r->pair_count = 0;
  free(r->vertex);
  r->vertex = calloc(t->first_vertex[t->cell_count], sizeof *r->vertex);
  const uint32_t n = (uint32_t)t->cell_count;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t from = n - 1 - i, count = t->first_vertex[from + 1] - t->first_vertex[from];
    r->first_vertex[i + 1] = r->first_vertex[i] + count;
    memcpy(r->vertex + r->first_vertex[i], t->vertex + t->first_vertex[from], count * sizeof *r->vertex);
    r->centroid[i] = t->centroid[from];
    r->area[i] = t->area[from];
    r->polar_moment[i] = t->polar_moment[from];
    r->grid_x[i] = t->grid_x[from];
    r->grid_y[i] = t->grid_y[from];
  }
  r->cell_count = n;
  r->pair = realloc(r->pair, t->pair_count * sizeof *r->pair);
  r->side = realloc(r->side, t->pair_count * sizeof *r->side);
  for (size_t k = 0; k < t->pair_count; k++) {
    r->pair[k][0] = n - 1 - t->pair[k][1];
    r->pair[k][1] = n - 1 - t->pair[k][0];
    r->side[k] = t->side[k];
  }
  r->pair_count = t->pair_count;
  return r;
}

/* One seed gives a beam the same thresholds in a larger body, and for any numbering of its grains. */
TEST(thresholds_belong_to_places) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, 1.0, 2), *larger = fixture_disc(0.09, 0.01, 1.0, 2);
  struct dem_tessellation *other = renumbered(t), *const bodies[2] = {larger, other};
  struct dem_inputs in = fixture_inputs();
  in.threshold.breaking = true;
  in.threshold.modulus = 4.0;
  DEM_SYSTEM *s = NULL;
  assert_int_equal(dem_system_create(t, &in, 11, &s, NULL), STATUS_OK);
  for (int b = 0; b < 2; b++) {
    DEM_SYSTEM *there = NULL;
    assert_int_equal(dem_system_create(bodies[b], &in, 11, &there, NULL), STATUS_OK);
    for (size_t k = 0; k < t->pair_count; k++) {
      const uint32_t *pair = t->pair[k];
      const uint64_t square[2] = {dem_lattice_square(t->grid_x[pair[0]], t->grid_y[pair[0]]),
                                  dem_lattice_square(t->grid_x[pair[1]], t->grid_y[pair[1]])};
      double here[2], factor[2];
      assert_true(thresholds_at(t, &in, s, square, here));
      assert_true(thresholds_at(bodies[b], &in, there, square, factor));
      for (int q = 0; q < 2; q++) /* roundings of positions; another draw differs by tenths */
        fixture_near(factor[q], here[q], 1e-9, b ? "threshold, other numbers" : "threshold, larger body");
    }
  }
  dem_tessellation_free(other);
}

/* Squares face to face, a tenth slower than the speed reported to users and a tenth faster: the slow ones bounce, the
 * fast ones pass. */
TEST(grains_pass_where_said) {
  for (int law = DEM_CONTACT_CONSERVATIVE; law <= DEM_CONTACT_PRINTED; law++)
    for (int fast = 0; fast < 2; fast++) {
      struct dem_inputs inputs = DEM_CASE("disc-explosion", law == DEM_CONTACT_PRINTED ? "contact.law=printed" : NULL);
      const double speed = (fast ? 1.1 : 0.9) * dem_describe_passing_speed(&inputs);
      DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 1e-4, false);
      struct dem_inputs in = fixture_inputs();
      in.contact.law = law;
      in.fidelity.time_step = 1e-8;
      DEM_SYSTEM *s = fixture_create(t, &in);
      dem_system_set_velocity(s, 0, 0.5 * speed, 0.0, 0.0);
      dem_system_set_velocity(s, 1, -0.5 * speed, 0.0, 0.0);
      const double pass = 0.04 / speed; /* time to pass unhindered, four times over */
      while (dem_system_now(s)->time < 2.0 * pass)
        assert_true(dem_system_step(s));
      assert_true(fast ? s->c.x[0] > s->c.x[1] : s->c.x[0] < s->c.x[1]);
    }
}

/* Two discs before they meet: all energy is their translation, half of the relative speed each. */
TEST(energy_of_two_discs_on_approach) {
  struct dem_inputs inputs = DEM_CASE("disc-collision", "body.diameter=8 cm", "collision.speed=10 m/s",
                                      "stop.end_time=2 us", "collision.impact_parameter=0.4");
  struct ran ran = run_case_run(&dem_engine, &inputs, 1);
  assert_int_equal(ran.count, 2);
  fixture_near(ran.outcome.kinetic_energy_share, 1.0, 1e-12, "share");
  fixture_near(ran.results.dem.energy_input, 0.5 * ran.outcome.total_mass * 25.0, 1e-9 * ran.results.dem.energy_input,
               "input");
  const double *a = ran.fragments[0].position, *b = ran.fragments[1].position;
  /* centres 0.4 diameters apart across the approach, to a fraction of a grain: the lattices' outlines are random */
  fixture_near(fabs(a[1] - b[1]), 0.4 * inputs.body.diameter, 0.25 * inputs.grain.spacing, "impact parameter");
  free(ran.fragments);
}
