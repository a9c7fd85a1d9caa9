/* A piston drives a shock into a plate of porous aluminium without strength (T5): a thin bar, periodic across, against the
 * jump conditions (palpha_exact.h). Front speeds, the plateau behind the shock, the precursor, the energy; converging.
 *
 * By default 200 points, and 400 with CLAST_FULL unset only for the stronger shock; CLAST_FULL=1: 200, 400, 800. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
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
    .distention = 1.275, .elastic_pressure = 80e6, .solid_pressure = 700e6, .sound_speed = 4110};

enum { ACROSS = 5, PISTON = 4 }; /* particles across the bar; layers of the piston */
static const double length = 0.02;

static struct sph_particles *make_bar(size_t along, double speed, struct sph_parameters *parameters) {
  const double dx = length / (double)along, rho = 2700 / 1.275;
  struct sph_particles *p;
  assert_int_equal(sph_particles_make((along + PISTON) * ACROSS * ACROSS, SPH_WITH_HELD | SPH_WITH_DISTENTION, &p, NULL),
                   STATUS_OK);
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
  parameters->periodic[1] = parameters->periodic[2] = ACROSS * dx;
  return p;
}

struct measured {
  double front, precursor; /* m, places where the density passes half way */
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
  double Us, precursor, density, pressure, alpha, precursor_pressure, drift;
};

static struct outcome run(size_t along, double piston) {
  struct exact_front precursor, shock;
  exact_piston(&exact_porous_aluminium, piston, &precursor, &shock);
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
    at[k] = measure(p, &precursor, &shock, piston * times[k]);
  }
  struct sph_ledger end = sph_system_ledger(s);
  struct outcome o = {.Us = (at[1].front - at[0].front) / (times[1] - times[0]),
                      .precursor = (at[1].precursor - at[0].precursor) / (times[1] - times[0]),
                      .density = at[1].density,
                      .pressure = at[1].pressure,
                      .alpha = at[1].alpha,
                      .precursor_pressure = at[1].precursor_pressure};
  /* of the work that the piston did */
  o.drift = (end.kinetic + end.internal - start.kinetic - start.internal - end.work_of_held) / end.work_of_held;
  print_message("%4zu points, piston %g m/s: Us %.1f (%.1f) rho %.2f (%.2f) P %.2f MPa (%.2f) alpha %.5f (%.5f) "
                "precursor %.1f (%.1f) at %.2f MPa, energy error %.2e, clamped %.1e, %zu on the plateau, %llu steps\n",
                along, piston, o.Us, shock.speed, o.density, shock.density, o.pressure / 1e6, shock.pressure / 1e6, o.alpha,
                shock.alpha, o.precursor, precursor.speed, o.precursor_pressure / 1e6, o.drift,
                end.clamped / end.work_of_held, at[1].count, (unsigned long long)sph_system_steps(s));
  sph_system_free(s);
  sph_particles_free(p);
  return o;
}

int main(int argc, char **argv) {
  size_t n = argc > 1 ? (size_t)atoi(argv[1]) : 200;
  run(n, 458);
  run(n, 200);
}
