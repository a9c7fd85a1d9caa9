/* Engine dem through its public functions: tables, built-in scenes, refusals, stop rules; the chunk length has no
 * effect. */
#include "tests/support/run_case.h"

#include "engine/dem/run/run.h"
#include "engine/dem/step/system_layout.h"

static const char *const scenes[] = {"disc-explosion", "block-impact",   "uniaxial",
                                     "compression",    "disc-collision", "ring-explosion"};

static void check_table(const struct field_table *table) {
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    assert_non_null(row->doc);
    assert_true(strlen(row->doc) > 10);
    assert_true(row->offset < table->size);
    if (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER)
      assert_non_null(row->unit);
    for (size_t j = 0; j < i; j++) { /* no two rows have the same name or the same place */
      assert_string_not_equal(row->path, table->rows[j].path);
      assert_true(row->offset != table->rows[j].offset);
    }
  }
}

TEST(tables_are_whole) {
  check_table(&dem_inputs);
  check_table(&dem_results);
  check_table(&outcome_table);
  struct dem_inputs inputs;
  field_defaults(&dem_inputs, &inputs);
  for (size_t i = 0; i < dem_inputs.count; i++) { /* every default is in its own range */
    struct field_value value;
    field_get(&dem_inputs.rows[i], &inputs, &value);
    if (!(dem_inputs.rows[i].flags & FIELD_MAY_BE_OFF && field_is_off(value.number)) &&
        field_set(&dem_inputs.rows[i], &inputs, &value, &error))
      fail_msg("%s", error.message);
  }
  assert_int_equal(dem_inputs_check(&inputs, NULL), STATUS_OK);
}

TEST(builtin_scenes_say_what_they_model) {
  for (size_t k = 0; k < sizeof scenes / sizeof scenes[0]; k++) {
    struct dem_inputs inputs = DEM_CASE(scenes[k], NULL);
    assert_int_equal(inputs.kind, (int)k); /* listed in the order of enum dem_kind */
    OWNED char *text = dem_engine.describe(&inputs, true);
    assert_non_null(strstr(text, scenes[k]));
    assert_non_null(strstr(text, "stability limit"));
    assert_null(strstr(text, "cannot be run"));
    void *run;
    OK(dem_engine.prepare(&inputs, 1, &run, &error));
    size_t bytes = dem_system_arrays_bytes(((struct dem_run *)run)->system);
    if (!(bytes < dem_engine.memory(&inputs)))
      fail_msg("%s: %zu bytes promised, the system alone has %zu", scenes[k], dem_engine.memory(&inputs), bytes);
    double expected = dem_inputs_grains(&inputs), grains = (double)((struct dem_run *)run)->tessellation->cell_count;
    assert_true(fabs(grains / expected - 1) < 0.06); /* discs: the boundary scatters, most for the small ones */
    dem_engine.free(run);
  }
}

/* K99 table 1 in SI: the scene and the defaults must agree. */
TEST(explosion_starts_as_the_paper_says) {
  struct dem_inputs inputs = DEM_CASE("disc-explosion", NULL), defaults;
  field_defaults(&dem_inputs, &defaults);
  for (size_t i = 0; i < dem_inputs.count; i++) {
    struct field_value a, b;
    field_get(&dem_inputs.rows[i], &inputs, &a);
    field_get(&dem_inputs.rows[i], &defaults, &b);
    if (dem_inputs.rows[i].kind == FIELD_REAL && field_is_active(&dem_inputs, &dem_inputs.rows[i], &inputs) &&
        !(fabs(a.number - b.number) <= 1e-12 * fabs(b.number)) && !(isnan(a.number) && isnan(b.number)))
      fail_msg("%s: scene %g, default %g", dem_inputs.rows[i].path, a.number, b.number);
  }
  for (uint64_t seed = 0; seed < 20; seed++) {
    struct dem_run *run;
    OK(dem_run_create(&inputs, seed, &run, &error));
    double momentum[2], magnitude, speed = 0;
    dem_run_momentum(run, momentum, &magnitude);
    assert_true(magnitude > 0);
    /* the required bound; rounding gives some 1e-14 */
    assert_true(hypot(momentum[0], momentum[1]) < 1e-10 * magnitude);
    assert_true(fabs(run->state.frame.energy_input / 5e4 - 1) < 1e-12);
    assert_false(dem_system_grain(run->system, run->charge).present);
    size_t n = run->tessellation->cell_count, moving = 0;
    for (uint32_t i = 0; i < n; i++) {
      struct dem_grain g = dem_system_grain(run->system, i);
      double v = hypot(g.vx, g.vy), radius = hypot(g.x, g.y);
      if (!g.present || v == 0)
        continue;
      moving++;
      speed += v;
      assert_true(radius < 3.5 * inputs.grain.spacing); /* neighbours of the centre */
      /* outwards, except for an off-centre central grain */
      assert_true(g.x * g.vx + g.y * g.vy > -v * inputs.grain.spacing);
    }
    assert_in_range(moving, 3, 14);
    assert_true(speed / (double)moving > 100 && speed / (double)moving < 300); /* table 1: about 200 m/s */
    assert_in_range(n, 1060, 1140);                                            /* table 1: about 1100 */
    dem_run_free(run);
  }
}

TEST(impact_and_collision_start) {
  struct dem_inputs inputs = DEM_CASE("block-impact", "impact.angle=30 deg");
  struct dem_run *run;
  assert_int_equal(dem_run_create(&inputs, 1, &run, NULL), STATUS_OK);
  size_t moving = 0;
  for (uint32_t i = 0; i < run->tessellation->cell_count; i++) {
    struct dem_grain g = dem_system_grain(run->system, i);
    if (g.vx == 0 && g.vy == 0)
      continue;
    moving++;
    assert_true(fabs(g.vx - 200) < 1e-10 && fabs(g.vy - 400 * cos(M_PI / 6)) < 1e-10);
    assert_true(g.y < 0.015 && fabs(g.x - 0.205) < 0.015); /* the middle of the lower side of 40 cm x 20 cm */
  }
  assert_int_equal(moving, 1);
  dem_run_free(run);
  for (int k = 0; k < 2; k++) {
    inputs = DEM_CASE("disc-collision", k ? "collision.impact_parameter=0.95" : "collision.impact_parameter=0");
    assert_int_equal(dem_run_create(&inputs, 1, &run, NULL), STATUS_OK);
    double momentum[2], magnitude, count[2] = {0}, least = HUGE_VAL;
    dem_run_momentum(run, momentum, &magnitude);
    size_t n = run->tessellation->cell_count;
    for (uint32_t i = 0; i < n; i++) {
      struct dem_grain g = dem_system_grain(run->system, i);
      assert_true(fabs(g.vx) == 100 && g.vy == 0);
      count[g.vx > 0] += g.mass;
      for (uint32_t j = 0; j < n; j++) {
        struct dem_grain h = dem_system_grain(run->system, j);
        if (g.vx * h.vx < 0)
          least = fmin(least, hypot(g.x - h.x, g.y - h.y));
      }
    }
    assert_true(fabs(count[0] / count[1] - 1) < 0.1);
    /* close together, without contact */
    assert_true(least > 1.0 * inputs.grain.spacing && least < 5 * inputs.grain.spacing);
    dem_run_free(run);
  }
}

/* A ring is what lies between two circles, and widens everywhere at one rate about its centre of mass. */
TEST(ring_starts_as_described) {
  struct dem_inputs inputs = DEM_CASE("ring-explosion", "expansion.rate=40 1/s");
  const double outer = inputs.body.diameter / 2, inner = outer - inputs.body.wall;
  assert_true(fabs(dem_inputs_hole(&inputs) / inner - 1) < 1e-12);
  for (uint64_t seed = 0; seed < 5; seed++) {
    struct dem_run *run;
    assert_int_equal(dem_run_create(&inputs, seed, &run, NULL), STATUS_OK);
    double momentum[2], magnitude, mass = 0, x = 0, y = 0;
    dem_run_momentum(run, momentum, &magnitude);
    assert_true(hypot(momentum[0], momentum[1]) < 1e-12 * magnitude);
    assert_true(fabs(dem_run_angular_momentum(run)) < 1e-12 * magnitude * outer);
    const size_t n = run->tessellation->cell_count;
    for (uint32_t i = 0; i < n; i++) {
      const struct dem_grain g = dem_system_grain(run->system, i);
      assert_true(hypot(g.x, g.y) >= inner && hypot(g.x, g.y) <= outer);
      mass += g.mass;
      x += g.mass * g.x;
      y += g.mass * g.y;
    }
    for (uint32_t i = 0; i < n; i++) {
      const struct dem_grain g = dem_system_grain(run->system, i);
      assert_true(fabs(g.vx - 40 * (g.x - x / mass)) < 1e-12 && fabs(g.vy - 40 * (g.y - y / mass)) < 1e-12);
      assert_true(g.spin == 0);
    }
    /* mass and energy of a ring: its sides are rough by 0.3 grains, and 480 grains have no 3 % too many */
    assert_true(fabs(mass / (inputs.grain.density * M_PI * (outer * outer - inner * inner)) - 1) < 0.03);
    const double energy = mass * 40 * 40 * (outer * outer + inner * inner) / 4;
    assert_true(fabs(run->state.frame.energy_input / energy - 1) < 0.01);
    dem_run_free(run);
  }
}

/* Two rings collide as two discs do. */
TEST(rings_collide) {
  struct dem_inputs inputs = DEM_CASE("disc-collision", "body.wall=3 cm", "collision.speed=20 m/s",
                                      "threshold.breaking=false", "stop.end_time=3 ms");
  struct ran ran = run_case_run(&dem_engine, &inputs, 1);
  assert_int_equal(ran.count, 2);
  assert_true(ran.outcome.energy_error < 1e-3);
  assert_true(fabs((double)ran.results.dem.grains / dem_inputs_grains(&inputs) - 1) < 0.05);
  free(ran.fragments);
}

static void refuse(struct dem_inputs inputs, const char *word) {
  void *run = &run;
  assert_int_equal(dem_engine.prepare(&inputs, 1, &run, &error), STATUS_CONTENT);
  assert_null(run);
  if (!strstr(error.message, word))
    fail_msg("no '%s' in: %s", word, error.message);
}

TEST(what_cannot_run_is_refused) {
  struct dem_inputs inputs = DEM_CASE("disc-explosion", NULL);
  inputs.fidelity.time_step = 1e-4;
  refuse(inputs, "fidelity.time_step");
  inputs = DEM_CASE("disc-explosion", NULL);
  inputs.beam.young_modulus = 1e12;
  refuse(inputs, "unstable above");
  inputs = DEM_CASE("disc-explosion", "fidelity.integrator=gear", "fidelity.time_step=5 us"); /* 0.8 over omega_max */
  refuse(inputs, "gear");
  inputs = DEM_CASE("disc-explosion", NULL);
  inputs.body.diameter = 0.03;
  refuse(inputs, "grain.spacing");
  inputs = DEM_CASE("disc-explosion", NULL);
  inputs.grain.spacing = 1e-6;
  refuse(inputs, "too large");
  inputs = DEM_CASE("ring-explosion", NULL);
  inputs.body.wall = 0.02;
  refuse(inputs, "a wall needs at least 2 spacings to be whole; give a thicker wall");
  inputs.body.wall = 0.21;
  refuse(inputs, "off for a disc without a hole");
  inputs = DEM_CASE("compression", NULL);
  inputs.loading.ramp = 1;
  refuse(inputs, "loading.ramp");
  inputs = DEM_CASE("compression", NULL);
  inputs.body.rows = 3;
  refuse(inputs, "rows");
  inputs = DEM_CASE("block-impact", NULL);
  inputs.stop.end_time = 1e-9;
  refuse(inputs, "first time step");
  SCENE scene = NULL;
  OK(scene_load("block-impact", NULL, &scene, &error));
  OK(scene_set_text(scene, "charge.energy", "1 J/m", &error));
  assert_int_equal(scene_check(scene, &error), STATUS_CONTENT); /* an input without effect here */
  assert_non_null(strstr(error.message, "charge.energy"));
}

/* The estimate of the longest stable step, which is there before a body: no body of 20 is less stable than it by more
 * than a tenth, nor all more stable by more than a third; also with moduli other than those that it was found with. */
TEST(the_estimated_step_is_that_of_the_least_stable_body) {
  const char *const setting[] = {"grain.disorder=0", "grain.disorder=0.5",        "grain.disorder=1",
                                 "contact.law=off",  "beam.young_modulus=5e9 Pa", "grain.young_modulus=1e10 Pa"};
  for (int i = 0; i < 6; i++) {
    struct dem_inputs inputs = DEM_CASE("disc-explosion", setting[i], "body.diameter=12 cm");
    double least = HUGE_VAL;
    for (uint64_t seed = 1; seed <= 20; seed++) {
      struct dem_run *run;
      OK(dem_run_create(&inputs, seed, &run, &error));
      least = fmin(least, run->stable_time_step / dem_describe_stable_step(&inputs));
      dem_run_free(run);
    }
    assert_true(least > 0.9 && least < 1.33);
  }
}

/* The longest step of a run is that of its system, which test_dem_motion knows; the search for it ends within 1e-7 of
 * its square. It is accepted, and anything longer is refused. */
TEST(the_longest_step_is_the_systems) {
  const char *const integrators[] = {"fidelity.integrator=verlet", "fidelity.integrator=gear"};
  for (int i = 0; i < 2; i++) {
    struct dem_inputs inputs = DEM_CASE("uniaxial", integrators[i]);
    struct dem_run *run;
    OK(dem_run_create(&inputs, 1, &run, &error));
    const double longest = run->stable_time_step;
    assert_true(fabs(dem_system_stable_time_step(run->system) / longest - 1) < 1e-7);
    dem_run_free(run);
    inputs.fidelity.time_step = longest;
    OK(dem_run_create(&inputs, 1, &run, &error));
    dem_run_free(run);
    inputs.fidelity.time_step = nextafter(longest, 1);
    refuse(inputs, "unstable above");
  }
}

/* A small disc whose run ends soon. */
static struct dem_inputs small(void) {
  return DEM_CASE("disc-explosion", "body.diameter=12 cm", "charge.energy=4 kJ/m", "stop.end_time=2 ms");
}

TEST(chunks_do_not_matter) {
  struct dem_inputs inputs = small();
  struct ran whole = run_case_run(&dem_engine, &inputs, 3);
  void *run;
  assert_int_equal(dem_engine.prepare(&inputs, 3, &run, NULL), STATUS_OK);
  run_case_same(&dem_engine, &whole, run_case_end(&dem_engine, run, 0));
  dem_engine.free(run);
  free(whole.fragments);
}

TEST(stop_rules) {
  struct dem_inputs inputs = small();
  struct ran ran = run_case_run(&dem_engine, &inputs, 3);
  assert_true(ran.results.dem.broken > 10);
  assert_int_equal(ran.results.dem.broken, ran.results.dem.broken_stretch + ran.results.dem.broken_bend);
  if (ran.outcome.state == OUTCOME_COMPLETED) {
    assert_int_equal(ran.results.dem.stop_reason, DEM_STOP_QUIET);
    assert_true(fabs(ran.outcome.time - ran.results.dem.last_break - inputs.stop.quiet_time) <
                1.5 * inputs.fidelity.time_step);
  } else
    assert_int_equal(ran.results.dem.stop_reason, DEM_STOP_END_TIME);
  assert_true(ran.outcome.energy_error < 0.02); /* Verlet at 1 us with breaking; physics: 0.1 % unbroken */
  assert_true(ran.outcome.momentum_error < 1e-10);
  double mass = 0;
  uint64_t grains = 0;
  for (size_t k = 0; k < ran.count; k++) {
    mass += ran.fragments[k].mass;
    grains += ran.fragments[k].count;
    assert_true(k == 0 || ran.fragments[k].mass <= ran.fragments[k - 1].mass);
  }
  assert_int_equal(grains, ran.results.dem.grains);
  assert_true(fabs(mass / ran.outcome.total_mass - 1) < 1e-12);
  free(ran.fragments);

  inputs.stop.quiet_time = 1; /* never quiet: the run ends at the hard end and reports it */
  ran = run_case_run(&dem_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_END_TIME);
  assert_non_null(strstr(ran.outcome.message, "end_time"));
  assert_int_equal(ran.outcome.steps, 2000);
  free(ran.fragments);

  inputs = small(); /* too little to break anything: one fragment, complete at the end */
  inputs.charge.energy = 1e-3;
  ran = run_case_run(&dem_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_COMPLETED);
  assert_int_equal(ran.results.dem.stop_reason, DEM_STOP_END_TIME);
  assert_int_equal(ran.count, 1);
  assert_true(isnan(ran.results.dem.last_break));
  free(ran.fragments);

  inputs = small(); /* breaking at the smallest strain: dust, still finite */
  inputs.threshold.strain = inputs.threshold.angle = 1e-9;
  ran = run_case_run(&dem_engine, &inputs, 3);
  assert_true(ran.outcome.dust_fraction > 0.5);
  free(ran.fragments);
}

/* The report's figures from the ledger, compared with their definition: bounds alone do not detect a figure that is ten
 * times too small. */
TEST(figures_by_hand) {
  const struct dem_inputs cases[] = {small(), DEM_CASE("compression", "body.columns=8", "body.rows=12")};
  for (int c = 0; c < 2; c++) {
    struct dem_run *run;
    struct ran ran = {0};
    double translation = 0;
    assert_int_equal(dem_run_create(&cases[c], 3, &run, NULL), STATUS_OK);
    const struct dem_ledger first = dem_system_ledger(run->system);
    frame_advance(&run->frame, UINT64_MAX);
    const struct dem_ledger last = dem_system_ledger(run->system);
    assert_int_equal(dem_report_finish(run, &ran.outcome, &ran.results.dem, &ran.fragments, &ran.count, NULL),
                     STATUS_OK);
    const double input = run->state.frame.energy_input + fabs(last.external_work),
                 drift = fabs(dem_run_closed(&last) - dem_run_closed(&first));
    print_message("energy_error %.3g of %.3g J/m\n", ran.outcome.energy_error, input);
    /* sums in the same order: the difference is in the last digits of the whole */
    assert_true(fabs(ran.outcome.energy_error - drift / input) < 1e-14 && ran.outcome.energy_error > 1e-9);
    for (size_t k = 0; k < ran.count; k++)
      translation += 0.5 * ran.fragments[k].mass *
                     (pow(ran.fragments[k].velocity[0], 2) + pow(ran.fragments[k].velocity[1], 2));
    double rigid = translation;
    for (size_t k = 0; k < ran.count; k++)
      rigid += 0.5 * ran.fragments[k].moment_of_inertia * pow(ran.fragments[k].spin[2], 2);
    assert_true(last.kinetic - rigid > 1e-3 * input); /* the rest of the kinetic energy is motion inside fragments */
    assert_true(fabs(ran.results.dem.energy.vibration - (last.kinetic - rigid)) < 1e-12 * last.kinetic);
    assert_true(translation > 0 && fabs(ran.outcome.kinetic_energy_share / (translation / input) - 1) < 1e-12);
    free(ran.fragments);
    dem_run_free(run);
  }
}

/* A run is complete when it is quiet, and not before its minimum time. */
TEST(completed_needs_the_least_time) {
  struct dem_inputs inputs = small();
  inputs.stop.quiet_time = 2e-5;
  inputs.stop.least_time = 0;
  struct ran paper = run_case_run(&dem_engine, &inputs, 3);
  inputs.stop.least_time = 1e-3;
  struct ran later = run_case_run(&dem_engine, &inputs, 3);
  print_message("complete at %.4g s by the paper's rule, at %.4g s with a least time\n", paper.outcome.time,
                later.outcome.time);
  assert_int_equal(paper.outcome.state, OUTCOME_COMPLETED);
  assert_int_equal(later.outcome.state, OUTCOME_COMPLETED);
  assert_true(paper.outcome.time < 0.5e-3 && later.outcome.time > 1e-3 - 1e-9 && later.outcome.time < 2e-3);
  /* breaks after the paper's rule has ended the run */
  assert_true(later.results.dem.broken > paper.results.dem.broken);
  free(paper.fragments);
  free(later.fragments);
}

/* With a threshold that no beam reaches, the other term is the larger one of every break. */
TEST(breaks_are_told_apart) {
  for (int bend = 0; bend < 2; bend++) {
    struct dem_inputs inputs = small();
    *(bend ? &inputs.threshold.strain : &inputs.threshold.angle) = 1e3;
    struct ran ran = run_case_run(&dem_engine, &inputs, 3);
    assert_true(ran.results.dem.broken > 10);
    assert_int_equal(ran.results.dem.broken_bend, bend ? ran.results.dem.broken : 0);
    assert_int_equal(ran.results.dem.broken_stretch, bend ? 0 : ran.results.dem.broken);
    free(ran.fragments);
  }
}

/* How final a run is, compared with a run that ends at half of its time. */
TEST(finality_is_what_broke_late) {
  struct dem_inputs inputs = small();
  inputs.stop.quiet_time = 1;
  inputs.stop.end_time = 1e-3;
  struct ran whole = run_case_run(&dem_engine, &inputs, 3);
  inputs.stop.end_time = 0.5e-3;
  struct ran half = run_case_run(&dem_engine, &inputs, 3);
  const double loss = half.outcome.largest_fraction - whole.outcome.largest_fraction;
  print_message("M_1/M %.4f at half of the time, %.4f at its end\n", half.outcome.largest_fraction,
                whole.outcome.largest_fraction);
  assert_true(loss > 0.005);
  assert_true(fabs(whole.results.dem.largest_loss - loss) < 1e-12); /* sums of masses in other orders */
  assert_int_equal(whole.results.dem.late_breaks, whole.results.dem.broken - half.results.dem.broken);
  free(whole.fragments);
  free(half.fragments);
}

/* Grains so fast that no overlap can stop them. At 400 m/s there are none; 3 km/s is four times the speed of passing.
 */
TEST(grains_that_pass_are_flagged) {
  for (int fast = 0; fast < 2; fast++) {
    struct dem_inputs block = DEM_CASE("block-impact", "body.columns=8", "body.rows=6", "stop.end_time=0.3 ms",
                                       fast ? "impact.speed=3 km/s" : "impact.speed=400 m/s");
    struct ran ran = run_case_run(&dem_engine, &block, 3);
    print_message("passing_share %.3g; %s\n", ran.results.dem.passing_share, ran.outcome.message);
    assert_int_equal(ran.results.dem.passing_share > 1, fast);
    double closing, limit; /* the message has both, in 4 digits */
    if (fast) {
      assert_int_equal(sscanf(ran.outcome.message, "grains closed in at %lg m/s: above %lg", &closing, &limit), 2);
      assert_true(fabs(ran.results.dem.passing_share * limit / closing - 1) < 1e-3);
    }
    assert_int_equal(strstr(ran.outcome.message, "pass through each other") != NULL, fast);
    free(ran.fragments);
  }
}

/* Any number of grains modulo the SIMD lanes. Lists made at every step would also be right, but eight times slower. */
TEST(neighbour_lists_last) {
  struct dem_inputs inputs = small();
  for (uint64_t seed = 0; seed < 12; seed++) {
    struct dem_run *run;
    assert_int_equal(dem_run_create(&inputs, seed, &run, NULL), STATUS_OK);
    frame_advance(&run->frame, 300);
    assert_true(run->system->now.rebuilds < 60);
    dem_run_free(run);
  }
}

/* Pairs with a very short common side once had an unlimited contact stiffness; these two runs then ended with energy
 * errors of 67 and 5. A correct run drifts by less than 1e-3 at this time step; 1e-2 is far from both. */
TEST(short_common_sides_do_not_blow_up) {
  assert_true(dem_assemble_reference_side(0, 1, 1) == 0.54);
  assert_true(dem_assemble_reference_side(1e-9, 1, 1) == 0.27);
  assert_true(dem_assemble_reference_side(0.4, 1, 1) == 0.4);
  struct dem_inputs disc = DEM_CASE("disc-explosion", "threshold.strain=6 %", "threshold.angle=4 deg",
                                    "stop.end_time=3 ms");
  struct dem_inputs block = DEM_CASE("block-impact", "stop.end_time=0.5 ms");
  const struct ran ran[] = {run_case_run(&dem_engine, &disc, 20), run_case_run(&dem_engine, &block, 20)};
  for (int k = 0; k < 2; k++) {
    assert_true(ran[k].outcome.state == OUTCOME_END_TIME || ran[k].outcome.state == OUTCOME_COMPLETED);
    assert_true(ran[k].outcome.energy_error < 1e-2);
    free(ran[k].fragments);
  }
}

TEST(energy_bound_ends_a_run) {
  struct dem_inputs inputs = small();
  inputs.fidelity.energy_bound = 1e-9;
  struct ran ran = run_case_run(&dem_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  assert_int_equal(ran.results.dem.stop_reason, DEM_STOP_FAULT);
  assert_non_null(strstr(ran.outcome.message, "fidelity.time_step"));
  free(ran.fragments);
  inputs.stop.end_time = 5e-5; /* the run ends before the first regular check of the ledger: the last check counts */
  ran = run_case_run(&dem_engine, &inputs, 3);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  assert_int_equal(ran.outcome.steps, 50);
  free(ran.fragments);

  /* A drift of some per cent counts as a fault unless the scene sets another bound: Gear with strong damping, near its
   * longest step. */
  inputs = small();
  inputs.fidelity.integrator = DEM_GEAR;
  inputs.fidelity.time_step = 3e-6;
  inputs.contact.normal_damping = 2e4;
  ran = run_case_run(&dem_engine, &inputs, 3);
  print_message("%s\n", ran.outcome.message);
  assert_int_equal(ran.outcome.state, OUTCOME_ENERGY);
  free(ran.fragments);
  inputs.fidelity.energy_bound = 0.1;
  ran = run_case_run(&dem_engine, &inputs, 3);
  print_message("energy_error %.3g\n", ran.outcome.energy_error);
  assert_true(outcome_is_usable(ran.outcome.state));
  free(ran.fragments);
}

/* Grains that pass through others between two steps lose no energy, so the ledger does not show it: two discs that met
 * at 1000 km/s with 1 us steps once stayed whole, and the run counted as completed. */
TEST(grains_too_fast_for_the_step_end_a_run) {
  struct dem_inputs disc = small(), discs = DEM_CASE("disc-collision", "body.diameter=8 cm", "collision.speed=1e6 m/s");
  disc.charge.energy = 1e18;
  struct dem_inputs block = DEM_CASE("block-impact", "body.columns=8", "body.rows=6", "impact.speed=12 km/s");
  const struct dem_inputs *const inputs[] = {&disc, &discs, &block};
  for (int k = 0; k < 3; k++) {
    struct ran ran = run_case_run(&dem_engine, inputs[k], 3);
    assert_int_equal(ran.outcome.state, OUTCOME_TIME_STEP);
    assert_int_equal(ran.results.dem.stop_reason, DEM_STOP_FAULT);
    assert_int_equal(ran.outcome.steps, 0);
    assert_non_null(strstr(ran.outcome.message, "fidelity.time_step"));
    free(ran.fragments);
  }
  block.impact.speed = 3000; /* 3 mm a step, for grains of 12 mm */
  struct ran ran = run_case_run(&dem_engine, &block, 3);
  assert_true(ran.outcome.state == OUTCOME_COMPLETED || ran.outcome.state == OUTCOME_END_TIME);
  free(ran.fragments);
}

/* The paper's contact law needs half the step: its force jumps, and the energy drifts by 1 % in explosions of 20 kJ/m.
 */
TEST(the_step_follows_from_the_contact_law) {
  static const char *const laws[] = {"conservative", "printed", "off"};
  for (size_t k = 0; k < 3; k++) {
    SCENE scene = NULL;
    OK(scene_load("disc-explosion", NULL, &scene, &error));
    OK(scene_set_text(scene, "contact.law", laws[k], &error));
    OK(scene_check(scene, &error));
    const struct dem_inputs *in = scene->inputs;
    assert_true(in->fidelity.time_step == (k == 1 ? 0.5e-6 : 1e-6));
    OK(scene_set_text(scene, "fidelity.time_step", "2 us", &error));
    assert_true(fabs(in->fidelity.time_step - 2e-6) < 1e-20);
  }
}
