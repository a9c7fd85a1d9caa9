/* A piston drives a shock into a plate of porous aluminium without strength (T5): a thin bar, periodic across, against
 * the jump conditions (palpha_exact.h). Front speeds, the plateau behind the shock, the precursor, the energy;
 * converging. By default 100 and 200 points along the bar; with CLAST_FULL=1 200, 400 and 800. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "engine/sph/system.h"
#include "palpha_exact.h"

static const struct sph_material aluminium = {.density = 2700,
                                              .tillotson = {7.52e10, 6.5e10, 0.5, 1.63, 5, 5, 5e6, 3e6, 1.39e7},
                                              .melt_energy = NAN,
                                              .tension_limit = NAN};
static const struct sph_palpha porous = {
    .distention = 1.275, .curve = SPH_CRUSH_QUADRATIC, .elastic_pressure = 80e6, .solid_pressure = 700e6, .sound_speed = 4110};

enum { ACROSS = 5, PISTON = 4 }; /* particles across the bar; layers of the piston */
static const double length = 0.02;

static struct sph_particles *make_bar(size_t along, double speed, struct sph_parameters *parameters) {
  const double dx = length / (double)along, rho = 2700 / 1.275;
  struct sph_particles *p;
  assert_int_equal(
      sph_particles_make((along + PISTON) * ACROSS * ACROSS, SPH_WITH_HELD | SPH_WITH_DISTENTION, &p, NULL), STATUS_OK);
  for (size_t i = 0; i < p->n; i++) {
    size_t layer = i / (ACROSS * ACROSS);
    p->x[i] = ((double)layer + 0.5 - PISTON) * dx;
    p->y[i] = ((double)(i / ACROSS % ACROSS) + 0.5) * dx;
    p->z[i] = ((double)(i % ACROSS) + 0.5) * dx;
    p->mass[i] = rho * dx * dx * dx;
    p->density[i] = rho;
    p->h[i] = dx / 0.95;
    p->distention[i] = 1.275;
    if (layer < PISTON) {
      p->vx[i] = speed;
      p->held[i] = SPH_HELD_X | SPH_HELD_Y | SPH_HELD_Z;
    }
  }
  *parameters = sph_parameters_default();
  parameters->gradient_correction = true; /* sums on a lattice squeezed one way are 0.996, at rest 1.02: 1 % of P, 2 % of speeds */
  parameters->periodic[1] = parameters->periodic[2] = ACROSS * dx;
  return p;
}

struct measured {
  double front, precursor;                           /* m, places where the density passes half way */
  double density, pressure, alpha, energy, velocity; /* means over the plateau */
  double precursor_pressure;
  size_t count;
};

/* Mean over layers: each layer of the bar has moved as one. */
static double layer_mean(const double *value, size_t layer) {
  double sum = 0;
  for (size_t k = 0; k < ACROSS * ACROSS; k++)
    sum += value[layer * ACROSS * ACROSS + k];
  return sum / (ACROSS * ACROSS);
}

static double passes(const struct sph_particles *p, double level) { /* from the far end: first place above the level */
  for (size_t l = p->n / (ACROSS * ACROSS) - 1; l-- > 0;) {
    double here = layer_mean(p->density, l), ahead = layer_mean(p->density, l + 1);
    if (here >= level) {
      double share = (here - level) / (here - ahead), x = layer_mean(p->x, l);
      return x + share * (layer_mean(p->x, l + 1) - x);
    }
  }
  return NAN;
}

static struct measured measure(const struct sph_particles *p, const struct exact_front *precursor,
                               const struct exact_front *shock, double piston_at) {
  struct measured m = {0};
  m.front = passes(p, (precursor->density + shock->density) / 2);
  m.precursor = passes(p, (2700 / 1.275 + precursor->density) / 2);
  /* the plateau: the middle half between piston and front */
  double low = piston_at + (m.front - piston_at) / 4, high = piston_at + (m.front - piston_at) * 3 / 4;
  double quiet = m.front + (m.precursor - m.front) * 0.4, end = m.front + (m.precursor - m.front) * 0.7;
  size_t ahead = 0;
  for (size_t i = PISTON * ACROSS * ACROSS; i < p->n; i++) {
    if (p->x[i] > quiet && p->x[i] < end) {
      m.precursor_pressure += p->pressure[i];
      ahead++;
    }
    if (p->x[i] < low || p->x[i] > high) continue;
    m.density += p->density[i];
    m.pressure += p->pressure[i];
    m.alpha += p->distention[i];
    m.energy += p->energy[i];
    m.velocity += p->vx[i];
    m.count++;
  }
  double n = (double)m.count;
  m.density /= n, m.pressure /= n, m.alpha /= n, m.energy /= n, m.velocity /= n;
  m.precursor_pressure /= (double)ahead;
  return m;
}

struct outcome {
  struct exact_front precursor, shock; /* exact */
  struct measured last;
  double Us, precursor_speed, drift;
};

static struct outcome run(size_t along, double piston) {
  struct outcome o;
  exact_piston(&exact_porous_aluminium, piston, &o.precursor, &o.shock);
  struct sph_parameters parameters;
  struct sph_particles *p = make_bar(along, piston, &parameters);
  struct sph_body_physics body = {.material = aluminium, .porosity = &porous};
  struct sph_system *s;
  struct error error;
  if (sph_system_create(p, 1, &body, &parameters, &s, &error) != STATUS_OK) fail_msg("%s", error.message);
  struct sph_ledger start = sph_system_ledger(s);
  struct measured at[2];
  const double times[2] = {2.6e-6, 4.6e-6}; /* the precursor is then at 10.7 and 18.9 mm of 20 */
  for (int k = 0; k < 2; k++) {
    while (sph_system_time(s) < times[k])
      if (!sph_system_step(s, times[k])) fail_msg("%s", sph_system_failure(s));
    sph_system_read(s, p);
    at[k] = measure(p, &o.precursor, &o.shock, piston * times[k]);
  }
  struct sph_ledger end = sph_system_ledger(s);
  o.last = at[1];
  o.Us = (at[1].front - at[0].front) / (times[1] - times[0]);
  o.precursor_speed = (at[1].precursor - at[0].precursor) / (times[1] - times[0]);
  o.drift = (end.kinetic + end.internal - start.kinetic - start.internal - end.work_of_held) / end.work_of_held;
  print_message(
      "%3zu points, %g m/s: Us %.1f (%.1f) rho %.2f (%.2f) P %.2f (%.2f) MPa alpha %.5f (%.5f) precursor %.1f "
      "(%.1f) m/s %.2f MPa; energy %.1e, clamped %.1e J of %.3g; %llu steps\n",
      along, piston, o.Us, o.shock.speed, o.last.density, o.shock.density, o.last.pressure / 1e6,
      o.shock.pressure / 1e6, o.last.alpha, o.shock.alpha, o.precursor_speed, o.precursor.speed,
      o.last.precursor_pressure / 1e6, o.drift, end.clamped, end.work_of_held, (unsigned long long)sph_system_steps(s));
  sph_system_free(s);
  sph_particles_free(p);
  return o;
}

static void near(double got, double want, double relative, const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%s: got %.6g, expected %.6g +- %g", what, got, want, relative);
}

/* Of 200 points only 24 lie between piston and weak shock, which viscosity spreads over about ten; the precursor, a weak step,
 * over 15. The solid is stiff: P follows rho with K/P = 38 times its error at 1960 MPa. Energy: what the step's order leaves. */
static void check(const struct outcome *o, size_t along) {
  const bool coarse = along < 400;
  near(o->Us, o->shock.speed, 0.01, "Us");
  near(o->last.density, o->shock.density, coarse ? 0.005 : 0.001, "density behind the shock");
  near(o->last.pressure, o->shock.pressure, coarse ? 0.03 : 0.01, "pressure behind the shock");
  near(o->last.alpha, o->shock.alpha, 0.005 / o->shock.alpha, "alpha behind the shock");
  near(o->precursor_speed, o->precursor.speed, coarse ? 0.02 : 0.005, "precursor");
  near(o->last.precursor_pressure, o->precursor.pressure, 0.01, "pressure of the precursor");
  if (!(fabs(o->drift) < 0.005)) fail_msg("energy is off by %g of the work done", o->drift);
}

/* Both states at 200 points (400 and 800 with CLAST_FULL). The weak shock leaves alpha = 1.0334, which nothing but the curve
 * decides: its errors fall with the spacing. */
static void both_states(void **state) {
  (void)state;
  const char *full = getenv("CLAST_FULL");
  const bool all = full && !strcmp(full, "1");
  struct outcome coarse = run(100, 200);
  for (size_t along = 200; along <= (all ? 800 : 200); along *= 2) {
    struct outcome strong = run(along, 458), weak = run(along, 200);
    check(&strong, along);
    check(&weak, along);
    assert_true(fabs(weak.last.alpha - weak.shock.alpha) < 0.5 * fabs(coarse.last.alpha - coarse.shock.alpha));
    assert_true(fabs(weak.last.density - weak.shock.density) < 0.5 * fabs(coarse.last.density - coarse.shock.density));
    assert_true(fabs(weak.precursor_speed - weak.precursor.speed) < 0.5 * fabs(coarse.precursor_speed - coarse.precursor.speed));
    coarse = weak;
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(both_states)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
