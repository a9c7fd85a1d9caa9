/* Whole discs in motion: what is conserved, orders of the integrators, breaking, reproducible bits, bounded memory. */
#include "tests/bench/dem_disc.h"
#include "tests/verification/dem_fixture.h"

#include <gsl/gsl_eigen.h>

#ifndef __SANITIZE_ADDRESS__ /* the sanitizer brings its own */
static size_t allocations;   /* counted for the test that the step loop allocates nothing */
void *__libc_malloc(size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void *malloc(size_t size) {
  allocations++;
  return __libc_malloc(size);
}
void *realloc(void *old, size_t size) {
  allocations++;
  return __libc_realloc(old, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
  allocations++;
  return __libc_memalign(alignment, size);
}
#endif

/* K99's grains on a smaller disc, the charge at the same energy per mass; the whole body moves and rotates. */
static struct dem_system *charged(const struct dem_tessellation *t, const struct dem_inputs *in, double vx,
                                  double spin) {
  struct dem_system *s = fixture_create(t, in);
  dem_disc_charge(s, t, in->grain.density, 80.0 * in->grain.density * 0.0314);
  for (uint32_t i = 0; i < t->cell_count; i++) {
    const struct dem_grain g = dem_system_grain(s, i);
    if (g.present)
      dem_system_set_velocity(s, i, g.vx + vx - spin * g.y, g.vy + spin * g.x, g.spin + spin);
  }
  return s;
}

struct momenta {
  double px, py, l, scale, turn_scale;
};

static struct momenta momenta(const struct dem_system *s) {
  struct momenta m = {0};
  for (uint32_t i = 0; i < s->count; i++) {
    const struct dem_grain g = dem_system_grain(s, i);
    if (!g.present)
      continue;
    m.px += g.mass * g.vx;
    m.py += g.mass * g.vy;
    const double orbit = g.mass * (g.x * g.vy - g.y * g.vx);
    m.l += orbit + g.moment_of_inertia * g.spin;
    m.scale += g.mass * hypot(g.vx, g.vy);
    m.turn_scale += fabs(orbit) + fabs(g.moment_of_inertia * g.spin);
  }
  return m;
}

/* Momentum to 1e-12 and angular momentum to 1e-10 of the grains' own, through breaking, friction and either law. */
TEST(momenta_are_conserved) {
  DEM_TESSELLATION *t = fixture_disc(0.1, 0.01069, 1.0, 5);
  for (int kind = 0; kind < 4; kind++) {
    struct dem_inputs in = fixture_inputs();
    in.contact.law = kind == 1 ? DEM_CONTACT_PRINTED : DEM_CONTACT_CONSERVATIVE;
    in.threshold.breaking = kind >= 1;
    if (kind >= 2)
      in.contact.normal_damping = in.contact.tangential_damping = 1e4, in.contact.friction = 0.5,
      in.contact.damping_bonded = true;
    in.fidelity.integrator = kind == 3 ? DEM_GEAR : DEM_VERLET;
    DEM_SYSTEM *s = charged(t, &in, 3.0, 40.0);
    const struct momenta before = momenta(s);
    for (int k = 0; k < 2000; k++)
      assert_true(dem_system_step(s));
    const struct momenta after = momenta(s);
    fixture_near(after.px, before.px, 1e-12 * before.scale, "momentum x");
    fixture_near(after.py, before.py, 1e-12 * before.scale, "momentum y");
    /* Gear corrects positions and velocities apart, so r x v is kept only to its truncation error */
    fixture_near(after.l, before.l, (in.fidelity.integrator == DEM_GEAR ? 1e-4 : 1e-10) * before.turn_scale,
                 "angular momentum");
    const struct dem_break *log;
    assert_true(kind == 0 || dem_system_breaks(s, &log) > 20);
  }
}

/* Unbroken, undamped, conservative: total energy within 0.5 % over 10 ms at 1 us, and its error falls as dt^2. */
TEST(energy_is_conserved) {
  DEM_TESSELLATION *t = fixture_disc(0.1, 0.01069, 1.0, 5);
  double worst[3] = {0};
  for (int fine = 0; fine < 3; fine++) {
    struct dem_inputs in = fixture_inputs();
    in.fidelity.time_step = 2e-6 / (1 << fine);
    struct dem_system *s = charged(t, &in, 0.0, 0.0);
    const double before = fixture_total(dem_system_ledger(s));
    const int every = 20 << fine;
    double mean = 0.0;
    int count = 0;
    for (int k = 0; k * in.fidelity.time_step < 10e-3; k += every, ++count) {
      for (int i = 0; i < every; i++)
        assert_true(dem_system_step(s));
      const double deviation = fixture_total(dem_system_ledger(s)) / before - 1.0;
      mean += deviation;
      worst[fine] = fmax(worst[fine], fabs(deviation));
    }
    dem_system_free(s);
    print_message("          dt %.1f us: worst %.2e, mean %.2e\n", in.fidelity.time_step * 1e6, worst[fine],
                  mean / count);
  }
  assert_true(worst[1] < 0.005);
  /* order 2 is a factor 4; kinks of contact and the maximum over a chaotic run leave some room */
  assert_true(worst[0] / worst[1] > 3.0 && worst[1] / worst[2] > 3.0);
}

/* Order by the difference to a run with far smaller steps; beams only, which is a smooth problem. */
static double order(int integrator, double finest, const struct dem_tessellation *t) {
  double deviation[2];
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  in.fidelity.integrator = integrator;
  const double span = 64e-6;
  OWNED double *exact = calloc(3 * t->cell_count, sizeof *exact);
  for (int run = 0; run < 3; run++) {
    in.fidelity.time_step = run == 0 ? finest / 8.0 : run == 1 ? finest : 2.0 * finest;
    DEM_SYSTEM *s = charged(t, &in, 0.0, 0.0);
    for (int k = 0, steps = (int)lround(span / in.fidelity.time_step); k < steps; k++)
      assert_true(dem_system_step(s));
    double sum = 0.0;
    for (uint32_t i = 0; i < t->cell_count; i++) {
      const double v[3] = {s->c.x[i], s->c.y[i], 0.01 * s->c.angle[i]};
      for (int k = 0; k < 3; k++) {
        if (run == 0)
          exact[3 * i + (size_t)k] = v[k];
        sum += (v[k] - exact[3 * i + (size_t)k]) * (v[k] - exact[3 * i + (size_t)k]);
      }
    }
    if (run)
      deviation[run - 1] = sqrt(sum);
  }
  print_message("          %s: %.2e m at %.1f us, order %.2f\n", integrator == DEM_GEAR ? "Gear" : "Verlet",
                deviation[0], finest * 1e6, log2(deviation[1] / deviation[0]));
  return log2(deviation[1] / deviation[0]);
}

TEST(integrators_have_their_order) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01069, 1.0, 5);
  const double verlet = order(DEM_VERLET, 0.5e-6, t), gear = order(DEM_GEAR, 0.5e-6, t);
  assert_true(verlet > 1.9 && verlet < 2.1);
  assert_true(gear > 5.5); /* sixth order; with the coefficient for forces of velocities it is 5.0 */
}

/* Distance of a damped pair to its exact place: two squares, pressed together, start at rest, and a linear spring and a
 * linear dashpot drive them apart. They overlap during the whole test. */
static double damped_error(double time_step) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.fidelity.integrator = DEM_GEAR;
  in.fidelity.time_step = time_step;
  in.contact.normal_damping = 2e4;
  in.contact.damping_bonded = true;
  DEM_SYSTEM *s = fixture_create(t, &in);
  const double pressed = 1e-4, span = 16e-6;
  fixture_place(s, 1, t->centroid[1].x - pressed, t->centroid[1].y, 0.0);
  fixture_evaluate(s);
  s->now.gear_started = 0;                                                          /* the evaluation was a step, too */
  const double reduced = 0.5 * s->mass[0], square = s->c.fx[1] / pressed / reduced; /* both springs are linear */
  const double decay = 0.5 * in.contact.normal_damping, w = sqrt(square - decay * decay);
  for (int k = 0, steps = (int)lround(span / time_step); k < steps; k++)
    assert_true(dem_system_step(s));
  const double exact = -pressed * exp(-decay * span) * (cos(w * span) + decay / w * sin(w * span));
  assert_true(exact < 0.0); /* they still overlap */
  const double deviation = fabs(s->c.x[1] - s->c.x[0] - (t->centroid[1].x - t->centroid[0].x) - exact);
  return deviation;
}

TEST(gear_has_its_order_with_damping) {
  const double coarse = damped_error(1e-6), fine = damped_error(0.5e-6);
  print_message("          Gear, damped pair: %.2e m at 0.5 us, order %.2f\n", fine, log2(coarse / fine));
  assert_true(log2(coarse / fine) > 4.5);
}

/* Growth of the energy of a free pair's fastest mode in one of its periods, at `share` of the longest stable step. */
static double growth_per_period(int integrator, bool velocities, double share) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.bonded = false; /* beams alone: a linear system */
  in.contact.normal_damping = velocities ? 1e-9 : 0.0;
  in.fidelity.integrator = integrator;
  DEM_SYSTEM *s = fixture_create(t, &in);
  const double limit = dem_system_stable_time_step(s);
  in.fidelity.integrator = DEM_VERLET;
  const double fastest = 2.0 / dem_system_stable_time_step(s);
  in.fidelity.integrator = integrator;
  in.fidelity.time_step = share * limit;
  dem_system_set_velocity(s, 0, 1e-7, -2e-7, 3e-5);
  dem_system_set_velocity(s, 1, -1e-7, 2e-7, -1e-5);
  const double period = 2.0 * M_PI / fastest / in.fidelity.time_step; /* in steps */
  double energy[2];
  for (int half = 0; half < 2; half++) {
    for (int k = 0; k < (int)(500.0 * period); k++)
      assert_true(dem_system_step(s));
    energy[half] = fixture_total(dem_system_ledger(s));
  }
  return log(energy[1] / energy[0]) / 500.0;
}

/* The longest step that the engine reports: Verlet's is the edge of stability. Gear's method of this order has no edge:
 * its modes grow or fall as (h omega)^7, and the limit is where the fastest gains 1 % of its energy in a period. */
TEST(stable_steps_are_stable) {
  /* at h omega = 1.98 Verlet's energy swings by a factor 1/(1 - 0.99^2) = 50 and does not grow; ln 50 over 500 */
  assert_true(fabs(growth_per_period(DEM_VERLET, false, 0.99)) < 0.008);
  for (int velocities = 0; velocities < 2; velocities++) {
    const double at = growth_per_period(DEM_GEAR, velocities, 1.0),
                 below = growth_per_period(DEM_GEAR, velocities, 0.8);
    print_message("          Gear, coefficient of %s: energy %+.2f %% a period at its longest step, %+.2f %% at 0.8\n",
                  velocities ? "velocities" : "positions", 100.0 * at, 100.0 * below);
    assert_true(at > 0.008 && at < 0.010); /* 0.95 % and 0.84 % by the eigenvalues of one step */
    assert_true(below < 0.003);
  }
}

/* 2 / omega_max of two bonded parallelograms, by the eigenvalues of their 6 x 6 matrix: Timoshenko's beam between the
 * centres, and where bonded grains are in contact a spring of stiffness E S / L_c across the common side, 1/L_c the
 * mean of the inverse diameters. The side leans, so that the spring also turns the grains. */
TEST(stable_step_of_two_bonded_grains) {
  const double width[2] = {0.01, 0.016}, h = 0.01, lean = 0.004, side = hypot(h, lean);
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.fidelity.integrator = DEM_VERLET;
  in.grain.young_modulus = 20 * in.beam.young_modulus; /* so that the spring decides */
  double mass[6], inverse_length = 0.0;
  for (int i = 0; i < 2; i++) {
    const double left = i ? width[0] : 0.0, right = left + width[i];
    const struct dem_point corner[4] = {{left, 0.0}, {right, 0.0}, {right + lean, h}, {left + lean, h}};
    memcpy(t->vertex + 4 * i, corner, sizeof corner);
    t->centroid[i] = (struct dem_point){0.5 * (left + right + lean), 0.5 * h};
    t->area[i] = width[i] * h;
    t->polar_moment[i] = t->area[i] * (width[i] * width[i] + side * side) / 12.0;
    inverse_length += 0.25 / sqrt(t->area[i] / M_PI);
    mass[3 * i] = mass[3 * i + 1] = in.grain.density * t->area[i];
    mass[3 * i + 2] = in.grain.density * t->polar_moment[i];
  }
  t->side[0] = side;
  const double l = t->centroid[1].x - t->centroid[0].x, e = in.beam.young_modulus, i = side * side * side / 12.0;
  const double phi = 12.0 * e * i / (0.5 * e * side * l * l), axial = e * side / l;
  const double q = 12.0 * e * i / (l * l * l * (1.0 + phi)), near = q * l * l * (4.0 + phi) / 12.0,
               far = q * l * l * (2.0 - phi) / 12.0, arm = q * l / 2.0;
  const double beam[6][6] = {{axial, 0, 0, -axial, 0, 0}, {0, q, arm, 0, -q, arm},   {0, arm, near, 0, -arm, far},
                             {-axial, 0, 0, axial, 0, 0}, {0, -q, -arm, 0, q, -arm}, {0, arm, far, 0, -arm, near}};
  /* The gap of the side opens by n (u2 - u1) at its middle, which is width/2 from either centre: row B, spring B^T k B.
   */
  const double nx = h / side, ny = -lean / side;
  const double gap[6] = {-nx, -ny, -0.5 * width[0] * ny, nx, ny, -0.5 * width[1] * ny};
  const double spring = in.grain.young_modulus * side * inverse_length;
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(6);
  gsl_vector *values = gsl_vector_alloc(6);
  for (int c = 0; c < 4; c++) {
    in.contact.law = (const int[]){DEM_CONTACT_CONSERVATIVE, DEM_CONTACT_PRINTED, DEM_CONTACT_OFF,
                                   DEM_CONTACT_CONSERVATIVE}[c];
    in.contact.bonded = c < 3;
    gsl_matrix *k = gsl_matrix_alloc(6, 6);
    for (size_t a = 0; a < 6; a++)
      for (size_t b = 0; b < 6; b++)
        gsl_matrix_set(k, a, b, (beam[a][b] + (c < 2 ? spring * gap[a] * gap[b] : 0.0)) / sqrt(mass[a] * mass[b]));
    gsl_eigen_symm(k, values, work);
    DEM_SYSTEM *s = fixture_create(t, &in);
    const double expected = 2.0 / sqrt(gsl_vector_max(values));
    /* the power iteration ends at a change of 1e-7; grains are smaller than their cells by 1e-11 */
    fixture_near(dem_system_stable_time_step(s), expected, 1e-5 * expected, "longest step");
    gsl_matrix_free(k);
  }
  gsl_vector_free(values);
  gsl_eigen_symm_free(work);
}

/* One step from a made-up state: Pascal's triangle, and every coefficient of the corrector by its published value (Gear
 * 1971; Allen & Tildesley 1987, table E.1). The order alone does not determine all of them. */
TEST(gear_has_its_coefficients) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, true);
  const double published[2][6] = {{3.0 / 20.0, 251.0 / 360.0, 1.0, 11.0 / 18.0, 1.0 / 6.0, 1.0 / 60.0},
                                  {3.0 / 16.0, 251.0 / 360.0, 1.0, 11.0 / 18.0, 1.0 / 6.0, 1.0 / 60.0}};
  for (int damped = 0; damped < 2; damped++) {
    struct dem_inputs in = fixture_inputs();
    in.fidelity.integrator = DEM_GEAR;
    in.contact.normal_damping = damped ? 1.0 : 0.0; /* forces may depend on velocities: the other first coefficient */
    DEM_SYSTEM *s = fixture_create(t, &in);
    const double start[6] = {0.0152, 0.7e-5, 0.5e-5, -0.3e-5, 0.2e-5, 0.1e-5}; /* x and dt^k/k! d^k x of grain 1 */
    const double dt = in.fidelity.time_step;
    s->c.x[1] = start[0];
    s->c.vx[1] = start[1] / dt;
    for (int k = 2; k < 6; k++)
      s->c.gear[0][k][1] = start[k];
    s->now.gear_started = 1;
    assert_true(dem_system_step(s));
    const int pascal[6][6] = {{1, 1, 1, 1, 1, 1},  {0, 1, 2, 3, 4, 5}, {0, 0, 1, 3, 6, 10},
                              {0, 0, 0, 1, 4, 10}, {0, 0, 0, 0, 1, 5}, {0, 0, 0, 0, 0, 1}};
    double predicted[6] = {0};
    for (int k = 0; k < 6; k++)
      for (int j = 0; j < 6; j++)
        predicted[k] += pascal[k][j] * start[j];
    const double deviation = 0.5 * dt * dt * s->c.fx[1] / s->mass[1] - predicted[2];
    const double got[6] = {s->c.x[1],          s->c.vx[1] * dt,    s->c.gear[0][2][1],
                           s->c.gear[0][3][1], s->c.gear[0][4][1], s->c.gear[0][5][1]};
    assert_true(fabs(deviation) > 1e-6);
    for (int k = 0; k < 6; k++) /* roundings of values of 1e-5, and of the position itself */
      fixture_near(got[k], predicted[k] + published[damped][k] * deviation, k ? 1e-19 : 1e-17, "Gear");
  }
}

/* Breaking, damping and friction on: kinetic + stored + broken + dissipated stays what it was. */
TEST(ledger_closes) {
  DEM_TESSELLATION *t = fixture_disc(0.1, 0.01069, 1.0, 5);
  for (int kind = 0; kind < 4; kind++) {
    struct dem_inputs in = fixture_inputs();
    in.threshold.breaking = true;
    in.fidelity.time_step = 2.5e-7;
    in.contact.bonded = kind != 3; /* contacts that begin as beams break, at whatever overlap there is */
    in.contact.law = kind == 1 ? DEM_CONTACT_PRINTED : DEM_CONTACT_CONSERVATIVE;
    if (kind == 2)
      in.contact.normal_damping = in.contact.tangential_damping = 1e4, in.contact.friction = 0.5,
      in.contact.damping_bonded = true;
    DEM_SYSTEM *s = charged(t, &in, 0.0, 0.0);
    const double before = fixture_total(dem_system_ledger(s));
    for (int k = 0; k < 8000; k++)
      assert_true(dem_system_step(s));
    const struct dem_ledger l = dem_system_ledger(s);
    print_message(
        "          kinetic %.0f beam %.0f contact %.0f broken %.0f damping %.0f friction %.0f of %.0f: open by %.1e\n",
        l.kinetic, l.beam, l.contact, l.broken_beam, l.damping, l.friction, before, fixture_total(l) / before - 1.0);
    assert_true(l.broken_beam > 0.01 * before);
    assert_true(kind != 2 || (l.damping > 0.01 * before && l.friction > 0.0));
    fixture_near(fixture_total(l), before, 0.005 * before, "ledger"); /* the same bound as without breaking */
  }
}

/* A body at rest has no forces, to the last bit, and does not begin to move. */
TEST(rest_is_rest) {
  for (int disorder = 0; disorder < 2; disorder++) {
    const struct dem_lattice lattice = {.outline = DEM_OUTLINE_BLOCK,
                                        .spacing = 0.01,
                                        .disorder = disorder,
                                        .columns = 20,
                                        .rows = 20,
                                        .origin = {3.0, -7.0},
                                        .seed = 2};
    DEM_TESSELLATION *t = NULL;
    assert_int_equal(dem_tessellation_make(&lattice, &t, NULL), STATUS_OK);
    for (int law = 0; law < 3; law++) {
      struct dem_inputs in = fixture_inputs();
      in.contact.law = law;
      in.threshold.breaking = true;
      in.fidelity.integrator = law == 1 ? DEM_GEAR : DEM_VERLET;
      DEM_SYSTEM *s = fixture_create(t, &in);
      for (int k = 0; k < 10; k++)
        assert_true(dem_system_step(s));
      for (uint32_t i = 0; i < t->cell_count; i++) {
        double fx, fy, torque;
        dem_system_force(s, i, &fx, &fy, &torque);
        assert_true(fx == 0.0 && fy == 0.0 && torque == 0.0 && s->c.vx[i] == 0.0 && s->c.x[i] == t->centroid[i].x);
      }
      assert_true(fixture_total(dem_system_ledger(s)) == 0.0);
    }
  }
}

/* Every beam is stretched and breaks in the first step: from then on the same bits as grains that had no beams. */
TEST(broken_is_unbonded) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, 1.0, 5);
  for (int on_bonded = 0; on_bonded < 2; on_bonded++) {
    struct dem_inputs in = fixture_inputs();
    in.threshold.breaking = true;
    in.threshold.strain = 1e-9;
    in.contact.bonded = on_bonded;
    in.contact.normal_damping = 1e3;
    in.contact.damping_bonded = on_bonded;
    DEM_SYSTEM *broken = fixture_create(t, &in), *unbonded = fixture_create(t, &in);
    uint64_t seed = 9;
    for (uint32_t i = 0; i < t->cell_count; i++) {
      const double spin = 2000.0 * fixture_random(&seed);
      for (int which = 0; which < 2; which++) /* the whole expands, and corners of spinning grains hit each other */
        dem_system_set_velocity(which ? unbonded : broken, i, 30.0 * t->centroid[i].x, 30.0 * t->centroid[i].y, spin);
    }
    for (int32_t k = 0; k < (int32_t)t->pair_count; k++)
      dem_breaking_cut(unbonded, k);
    const struct dem_break *log;
    for (int k = 0; k < 1000; k++) {
      assert_true(dem_system_step(broken) && dem_system_step(unbonded));
      assert_int_equal(dem_system_breaks(broken, &log), t->pair_count);
      assert_memory_equal(broken->c.x, unbonded->c.x, t->cell_count * sizeof(double));
      assert_memory_equal(broken->c.spin, unbonded->c.spin, t->cell_count * sizeof(double));
    }
    assert_true(dem_system_ledger(broken).damping > 0.0); /* contacts did occur */
    assert_int_equal(dem_system_breaks(unbonded, &log), 0);
  }
}

/* Save in the middle, load into a fresh system: the same bits from then on, lists and all. */
TEST(restored_run_has_the_same_bits) {
  DEM_TESSELLATION *t = fixture_disc(0.1, 0.01069, 1.0, 5);
  for (int integrator = 0; integrator < 2; integrator++) {
    struct dem_inputs in = fixture_inputs();
    in.threshold.breaking = true;
    in.fidelity.integrator = integrator;
    in.contact.normal_damping = 1e3;
    in.threshold.modulus = 5.0;
    DEM_SYSTEM *s = charged(t, &in, 0.0, 0.0), *copy = fixture_create(t, &in);
    for (int k = 0; k < 777; k++)
      assert_true(dem_system_step(s));
    size_t size, size_now;
    OWNED void *bytes = dem_system_state_copy(s, &size);
    assert_false(dem_system_state_load(copy, bytes, size - 1));
    assert_true(dem_system_state_load(copy, bytes, size));
    for (int k = 0; k < 777; k++) {
      assert_true(dem_system_step(s) && dem_system_step(copy));
      if (k % 100 == 0) {
        const struct dem_ledger a = dem_system_ledger(s); /* evaluating one and not the other changes nothing */
        assert_true(a.kinetic > 0.0);
      }
    }
    OWNED void *now = dem_system_state_copy(s, &size_now), *again = dem_system_state_copy(copy, &size);
    assert_int_equal(size_now, size);
    assert_memory_equal(now, again, size);
  }
}

/* Gear's start on a beam in longitudinal oscillation: x = A cos wt + B sin wt, whose derivatives are known. */
TEST(gear_starts_with_the_derivatives) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, true);
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_OFF;
  in.fidelity.time_step = 1e-7;
  in.fidelity.integrator = DEM_GEAR;
  DEM_SYSTEM *s = fixture_create(t, &in);
  const double stretch = 1e-5, speed = 0.2;
  fixture_place(s, 1, t->centroid[1].x + stretch, t->centroid[1].y, 0.0);
  dem_system_set_velocity(s, 0, -0.5 * speed, 0.0, 0.0);
  dem_system_set_velocity(s, 1, 0.5 * speed, 0.0, 0.0);
  fixture_evaluate(s);
  s->now.ready = 1;
  assert_true(dem_system_start_gear(s));
  const double w = sqrt(2.0 * in.beam.young_modulus / s->mass[0]),
               turn = w * in.fidelity.time_step;       /* alpha = E for S = l */
  const double u = 0.5 * stretch, v = 0.5 * speed / w; /* of grain 1 about the middle; v in radians of the swing */
  const double exact[6] =
      {0, 0, -u * turn * turn / 2, -v * pow(turn, 3) / 6, u * pow(turn, 4) / 24, v * pow(turn, 5) / 120};
  const double order[6] = {0, 0, 1e-12, pow(turn, 4), pow(turn, 3), pow(turn, 2)}; /* of the one-sided differences */
  for (int k = 2; k < 6; k++) /* the next derivatives' terms stand before them with factors of a few */
    fixture_near(s->c.gear[0][k][1], exact[k], fabs(exact[k]) * (10.0 * order[k] * (1.0 + u / v + v / u) + 1e-6),
                 "derivative");
}

/* Long grains that do nothing but turn: their lists must be rebuilt, or the end of one passes through the other. */
TEST(turning_grains_meet) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, 0.01, 0.0, false);
  const double half_length = 0.01, half_width = 0.0025, apart = 0.011; /* ends reach 0.0125 across, skins 0.0056 */
  for (int i = 0; i < 2; i++) {
    t->centroid[i] = (struct dem_point){apart * i, 0.0};
    t->area[i] = 4.0 * half_length * half_width;
    t->polar_moment[i] = t->area[i] * (half_length * half_length + half_width * half_width) / 3.0;
    for (int v = 0; v < 4; v++)
      t->vertex[4 * i + v] = (struct dem_point){apart * i + (v == 1 || v == 2 ? half_width : -half_width),
                                                v >= 2 ? half_length : -half_length};
  }
  struct dem_inputs in = fixture_inputs();
  DEM_SYSTEM *s = fixture_create(t, &in);
  dem_system_set_velocity(s, 1, 0.0, 0.0, 800.0); /* a quarter turn in 2000 steps */
  bool met = false;
  for (int k = 0; k < 2200 && !met; k++) {
    assert_true(dem_system_step(s));
    met = s->c.torque[0] != 0.0;
  }
  assert_true(met);
  /* its corner comes over the other's side when half_length sin a + half_width cos a = apart - half_width */
  const double reach = half_length * sin(s->c.angle[1]) + half_width * cos(s->c.angle[1]);
  fixture_near(reach, apart - half_width, 800.0 * in.fidelity.time_step * half_length,
               "first touch"); /* one step's way */
}

/* A grain a thousand kilometres away costs no memory, and does not slow the search down. */
TEST(far_flung_grain) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, 1.0, 5);
  struct dem_inputs in = fixture_inputs();
  DEM_SYSTEM *s = fixture_create(t, &in);
  const size_t bytes = dem_system_arrays_bytes(s);
  for (size_t k = 0; k < t->pair_count; k++)
    if (t->pair[k][0] == 0 || t->pair[k][1] == 0)
      dem_breaking_cut(s, (int32_t)k);
  fixture_place(s, 0, 1e6, -1e6, 0.0);
  dem_system_set_velocity(s, 0, 1e4, 0.0, 10.0);
  for (int k = 0; k < 2000; k++)
    assert_true(dem_system_step(s));
  assert_int_equal(dem_system_arrays_bytes(s), bytes);
  for (uint32_t i = 1; i < 20;
       ++i) /* so fast that their skins are as wide as skins get: room for more pairs, no more */
    dem_system_set_velocity(s, i, 0.0, 0.0, 1e6);
  for (int k = 0; k < 100; k++)
    assert_true(dem_system_step(s));
  assert_true(dem_system_arrays_bytes(s) < 4 * bytes);
}

TEST(step_loop_allocates_nothing) {
#ifndef __SANITIZE_ADDRESS__
  struct dem_tessellation *t = fixture_disc(0.1, 0.01069, 1.0, 5);
  struct dem_inputs in = fixture_inputs();
  in.threshold.breaking = true;
  struct dem_system *s = charged(t, &in, 0.0, 0.0);
  assert_true(dem_system_step(s));
  const size_t before = allocations;
  for (int k = 0; k < 3000; k++)
    assert_true(dem_system_step(s));
  assert_true(s->now.rebuilds > 5);
  assert_int_equal(allocations, before);
  dem_system_free(s);
  assert_true(allocations > 0);
  dem_tessellation_free(t);
#endif
}

/* Steps far beyond the stability limit, absurd thresholds and velocities: the step returns false or a finite state,
 * never a crash. */
TEST(extremes) {
  DEM_TESSELLATION *t = fixture_disc(0.06, 0.01, 1.0, 5);
  const double steps[] = {1e-30, 1e-4, 1.0, 1e20}, thresholds[] = {0.0, 1e-300, 1e20};
  for (size_t a = 0; a < 4; a++)
    for (size_t b = 0; b < 3; b++)
      for (int integrator = 0; integrator < 2; integrator++) {
        struct dem_inputs in = fixture_inputs();
        in.fidelity.time_step = steps[a];
        in.threshold.breaking = true;
        in.threshold.strain = in.threshold.angle = thresholds[b];
        in.fidelity.integrator = integrator;
        in.contact.normal_damping = in.contact.tangential_damping = b == 1 ? 1e20 : 0.0;
        in.contact.friction = 1.0;
        DEM_SYSTEM *s = charged(t, &in, 0.0, 1e3);
        for (int k = 0; k < 300 && dem_system_step(s); k++) {
        }
        dem_system_ledger(s);
        dem_system_overlap_share(s);
      }
  struct dem_inputs in = fixture_inputs();
  in.fidelity.time_step = 20e-6; /* unstable without breaking: grows until it is no number */
  struct dem_system *s = charged(t, &in, 0.0, 0.0);
  assert_true(in.fidelity.time_step > dem_system_stable_time_step(s));
  int taken = 0;
  while (taken < 100000 && dem_system_step(s))
    taken++;
  assert_true(taken < 100000);
  dem_system_free(s);
  in.grain.density = (double)NAN;
  assert_int_equal(dem_system_create(t, &in, 0, &s, &error), STATUS_CONTENT);
  assert_null(s);
}
