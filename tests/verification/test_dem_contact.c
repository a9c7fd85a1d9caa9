/* Two squares face to face: contact times, stiffnesses, restitution, friction, balance of momentum. */
#include "tests/verification/dem_fixture.h"

static const double h = 0.01;

struct impact {
  double duration, restitution, deepest, push, least_push;
};

/* Two 1 cm squares meet at 2 v; `k` is the push over the approach at the deepest point. */
static struct impact collide(struct dem_inputs in, double v) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 1e-6 * h, false);
  DEM_SYSTEM *s = fixture_create(t, &in);
  dem_system_set_velocity(s, 0, v, 0.0, 0.0);
  dem_system_set_velocity(s, 1, -v, 0.0, 0.0);
  struct impact out = {.least_push = (double)INFINITY};
  double began = -1.0;
  for (int k = 0; k < 100000; k++) {
    assert_true(dem_system_step(s));
    const double deep = h - (s->c.x[1] - s->c.x[0]), push = -s->c.fx[0];
    if (deep > 0.0 && began < 0.0)
      began = dem_system_now(s)->time - 0.5 * in.fidelity.time_step;
    if (began >= 0.0 && deep > 0.0)
      out.least_push = fmin(out.least_push, push);
    if (deep > out.deepest)
      out.deepest = deep, out.push = push;
    if (began >= 0.0 && deep <= 0.0) {
      out.duration = dem_system_now(s)->time - 0.5 * in.fidelity.time_step - began;
      break;
    }
  }
  out.restitution = -s->c.vx[0] / v;
  fixture_near(s->c.vx[0] + s->c.vx[1], 0.0, 1e-14 * v * 10.0, "momentum");
  fixture_near(s->c.vy[0], 0.0, 1e-9 * v, "straight"); /* the sides coincide to rounding of the corners */
  return out;
}

/* Printed law: k = Y S / L_c = 8.862e9 dyn/cm (8.862e8 N/m per m), pi sqrt(m/2k) = 52.8 us. */
TEST(printed_law) {
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_PRINTED;
  in.fidelity.time_step = 1e-8;
  const struct impact i = collide(in, 0.5);
  fixture_near(i.push / i.deepest, 8.862e8, 0.0005e8, "stiffness"); /* four digits given */
  fixture_near(i.duration, 52.8e-6, 0.05e-6, "duration");           /* three digits given */
  fixture_near(i.restitution, 1.0, 1e-4, "restitution");
}

/* Conservative law: k = kappa S^2 = 1.454e10 dyn/cm, 41.2 us, and all energy comes back. */
TEST(conservative_law) {
  struct dem_inputs in = fixture_inputs();
  in.fidelity.time_step = 1e-8;
  const struct impact i = collide(in, 0.5);
  fixture_near(i.push / i.deepest, 1.454e9, 0.0005e9, "stiffness");
  fixture_near(i.duration, 41.2e-6, 0.05e-6, "duration");
  fixture_near(i.restitution, 1.0, 3e-4, "restitution"); /* the criterion of dem_contact.md */
}

/* gamma_N = 2.566e4/s: a damped oscillator that may not pull, restitution 0.550. */
TEST(damped_impact) {
  struct dem_inputs in = fixture_inputs();
  in.contact.law = DEM_CONTACT_PRINTED;
  in.fidelity.time_step = 1e-8;
  in.contact.normal_damping = 2.566e4;
  const struct impact i = collide(in, 0.5);
  fixture_near(i.restitution, 0.550, 0.0006, "restitution"); /* three digits given */
  assert_true(i.least_push >= 0.0);
}

/* Corner on side, spinning, off centre: the conservative law returns all energy, up to the square of the step. */
TEST(oblique_impact_conserves) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.5 * h, false);
  double deviation[2];
  for (int fine = 0; fine < 2; fine++) {
    struct dem_inputs in = fixture_inputs();
    in.fidelity.time_step = fine ? 2.5e-8 : 1e-7;
    DEM_SYSTEM *s = fixture_create(t, &in);
    fixture_place(s, 0, 0.5 * h, 0.7 * h, 0.6);
    dem_system_set_velocity(s, 0, 20.0, -1.0, 300.0);
    dem_system_set_velocity(s, 1, -20.0, 1.0, 100.0);
    const double before = fixture_total(dem_system_ledger(s));
    double deepest = 0.0;
    for (int k = 0; k * in.fidelity.time_step < 1e-3; k++) {
      assert_true(dem_system_step(s));
      if (k % 16 == 0)
        deepest = fmax(deepest, dem_system_ledger(s).contact);
    }
    assert_true(deepest > 0.05 * before);
    assert_true(s->c.vx[0] < 0.0);
    deviation[fine] = fabs(dem_system_ledger(s).kinetic / before - 1.0);
    fixture_near(dem_system_ledger(s).contact, 0.0, 0.0, "apart again");
  }
  print_message("          energy error %.1e at 0.1 us, %.1e at 0.025 us\n", deviation[0], deviation[1]);
  assert_true(deviation[0] < 3e-4 && deviation[1] < 3e-4);
}

/* A square slides on another: Coulomb's force is mu times the normal force, against the slip, and the damping and
 * friction in the ledger equal the energy lost by the motion. */
TEST(friction_takes_energy_out) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 1e-6 * h, false);
  for (int law = DEM_CONTACT_CONSERVATIVE; law <= DEM_CONTACT_PRINTED; law++) {
    double deviation[2];
    for (int fine = 0; fine < 2; fine++) {
      struct dem_inputs in = fixture_inputs();
      in.contact.law = law;
      in.fidelity.time_step = fine ? 1e-8 : 4e-8;
      in.contact.normal_damping = 1e4;
      in.contact.tangential_damping = 1e8; /* so stiff that Coulomb's limit acts until the slip has almost stopped */
      in.contact.friction = 0.3;
      DEM_SYSTEM *s = fixture_create(t, &in);
      dem_system_set_velocity(s, 0, 1.0, 2.0, 0.0);
      dem_system_set_velocity(s, 1, -1.0, -2.0, 0.0);
      const double before = fixture_total(dem_system_ledger(s));
      double kinetic = dem_system_ledger(s).kinetic;
      bool limited = false;
      for (int k = 0; k * in.fidelity.time_step < 1e-4; k++) {
        assert_true(dem_system_step(s));
        if (s->c.fx[0] < 0.0 && k * in.fidelity.time_step < 20e-6) {
          fixture_near(s->c.fy[0], 0.3 * s->c.fx[0], 0.02 * fabs(s->c.fx[0]), "Coulomb's limit");
          limited = true;
        }
      }
      assert_true(limited);
      const struct dem_ledger l = dem_system_ledger(s);
      assert_true(l.damping > 0.0 && l.friction > 0.0 && l.kinetic < kinetic);
      fixture_near(s->c.vx[0] + s->c.vx[1], 0.0, 1e-13, "momentum");
      fixture_near(s->c.vy[0] + s->c.vy[1], 0.0, 1e-13, "momentum");
      deviation[fine] = fabs(fixture_total(l) / before - 1.0);
    }
    print_message("          law %d: ledger open by %.1e at 40 ns, %.1e at 10 ns\n", law, deviation[0], deviation[1]);
    assert_true(deviation[1] < 2e-3 &&
                deviation[1] < 0.6 * deviation[0]); /* powers are booked at predicted velocities: first order */
  }
}

/* Contact and damping of bonded pairs obey their switches. */
TEST(bonded_switches) {
  DEM_TESSELLATION *t = fixture_squares(2, 1, h, 0.0, true);
  for (int on = 0; on < 2; on++) {
    struct dem_inputs in = fixture_inputs();
    in.contact.bonded = on;
    in.beam.young_modulus = 0.0;
    struct dem_system *s = fixture_create(t, &in);
    fixture_place(s, 1, 1.49 * h, 0.5 * h, 0.0);
    fixture_evaluate(s);
    /* bonded: S_ref is the common side, so the stiffness is the printed law's Y S / L_c */
    fixture_near(s->c.fx[1], on ? 8.862e8 * 0.01 * h : 0.0, 0.0005e8 * 0.01 * h, "contact on bonded");
    dem_breaking_cut(s, 0);
    fixture_evaluate(s);
    fixture_near(s->c.fx[1], 8.862e8 * 0.01 * h, 0.0005e8 * 0.01 * h, "S_ref stays when the beam has gone");
    dem_system_free(s);
    in.contact.bonded = true;
    in.contact.normal_damping = 1e4;
    in.contact.damping_bonded = on;
    s = fixture_create(t, &in);
    fixture_place(s, 1, 1.49 * h, 0.5 * h, 0.0);
    dem_system_set_velocity(s, 1, -1.0, 0.0, 0.0);
    in.fidelity.time_step = 1e-30;
    assert_true(dem_system_step(s));
    const double reduced = 0.5 * s->mass[0];
    fixture_near(s->c.fx[1], 8.862e8 * 0.01 * h + (on ? reduced * 1e4 : 0.0), 0.0005e8 * 0.01 * h, "damping on bonded");
    dem_system_free(s);
  }
}
