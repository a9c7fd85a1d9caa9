/* The shock fronts in a plate that a piston hits: places, speeds and the states behind them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"

/* A layer of matter that was one spacing thick at the start: sums over its particles. */
struct sph_plate_layer {
  double x, density, pressure, count;
};

status sph_plate_start(struct sph_run *run, struct error *error) {
  const struct sph_inputs *in = &run->inputs;
  run->layer = malloc((size_t)in->fidelity.points * sizeof *run->layer);
  if (!run->layer)
    return status_fail(error, STATUS_MEMORY, "no memory for %lld layers", (long long)in->fidelity.points);
  return sph_plane_shock(&in->target.material, in->piston.speed, &run->exact, error);
}

static size_t layer_of(const struct sph_run *run, size_t i) {
  double last = (double)run->inputs.fidelity.points - 1;
  return (size_t)fmax(0, fmin(last, run->start->x[i] / sph_derived_spacing(&run->inputs)));
}

static void fill_layers(const struct sph_run *run, const struct sph_particles *p) {
  memset(run->layer, 0, (size_t)run->inputs.fidelity.points * sizeof *run->layer);
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    struct sph_plate_layer *l = &run->layer[layer_of(run, i)];
    l->x += p->x[i];
    l->density += p->density[i];
    l->pressure += p->pressure[i];
    l->count++;
  }
}

size_t sph_plate_profile(const struct sph_run *run, struct sph_crater_layer *layers, size_t most) {
  const struct sph_particles *p = run->now;
  double spacing = sph_derived_spacing(&run->inputs);
  size_t count = (size_t)fmin((double)most, (double)run->inputs.fidelity.points);
  fill_layers(run, p);
  for (size_t k = 0; k < count; k++)
    layers[k] = (struct sph_crater_layer){.depth = ((double)k + 0.5) * spacing};
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    size_t k = layer_of(run, i);
    if (k >= count)
      continue;
    double n = run->layer[k].count;
    layers[k].pressure += p->pressure[i] / n;
    layers[k].velocity += p->vx[i] / n;
#define PROFILE_COLUMN(member, of_impact, of_plate, absent, ...)                                                       \
  layers[k].member += (p->of_plate ? p->of_plate[i] : absent) / n;
#include "engine/sph/modules/declarations.h"
  }
  return count;
}

/* The first place, from the far side, where density reaches a level. */
static double place_of(const struct sph_run *run, double level) {
  double before = NAN, at = NAN;
  for (size_t k = (size_t)run->inputs.fidelity.points; k-- > 0;) {
    const struct sph_plate_layer *l = &run->layer[k];
    if (!(l->count > 0))
      continue;
    double density = l->density / l->count, x = l->x / l->count;
    if (density >= level)
      return isnan(before) ? (double)NAN : x + (at - x) * (density - level) / (density - before);
    before = density;
    at = x;
  }
  return NAN;
}

/* A front is where density reaches the mean of the values ahead of it and behind it. */
void sph_plate_look(const struct sph_run *run, const struct sph_particles *p, double *shock, double *precursor) {
  const struct sph_plane_shock *exact = &run->exact;
  double between = exact->has_precursor ? exact->precursor.density : exact->first_density;
  fill_layers(run, p);
  *precursor = exact->has_precursor ? place_of(run, (exact->first_density + between) / 2) : (double)NAN;
  *shock = exact->has_shock ? place_of(run, (between + exact->shock.density) / 2) : (double)NAN;
}

/* Slope of places against times by least squares over the second half of the run, when a front has its final form. */
static double speed(const struct sph_run *run, size_t offset) {
  double from = run->inputs.stop.end_time / 2, n = 0, t = 0, x = 0, tt = 0, tx = 0;
  for (size_t k = 0; k < run->state.frame.samples; k++) {
    double place, time = run->sample[k].time - from;
    memcpy(&place, (const char *)&run->sample[k] + offset, sizeof place);
    if (!(time >= 0) || isnan(place))
      continue;
    n++;
    t += time;
    x += place;
    tt += time * time;
    tx += time * place;
  }
  return n > 2 ? (tx - t * x / n) / (tt - t * t / n) : (double)NAN;
}

/* Width of the shock's rise, taken as linear: twice the distance from a quarter of it to three quarters. */
static double shock_width(const struct sph_run *run) {
  const struct sph_plane_shock *exact = &run->exact;
  const double ahead = exact->has_precursor ? exact->precursor.density : exact->first_density;
  const double rise = exact->shock.density - ahead;
  return 2 * (place_of(run, ahead + rise / 4) - place_of(run, ahead + rise * 3 / 4));
}

/* The three layers between two places where pressure changes least: the flat part between two fronts. If the shock is
 * nearly as fast as the precursor, the precursor's rise fills most of the distance between them. NaN: there are no
 * three layers. */
static void find_flat(const struct sph_run *run, double from, double to, double region[2]) {
  double least = HUGE_VAL;
  region[0] = region[1] = NAN;
  for (size_t k = 2; k < (size_t)run->inputs.fidelity.points; k++) {
    double x[3], pressure[3];
    for (size_t i = 0; i < 3; i++) { /* NaN in a layer without particles, which fails the tests below */
      const struct sph_plate_layer *l = &run->layer[k - 2 + i];
      x[i] = l->x / l->count;
      pressure[i] = l->pressure / l->count;
    }
    const double change = fabs(pressure[2] - pressure[0]);
    if (!(x[0] > from && x[2] < to && change < least))
      continue;
    least = change;
    region[0] = x[0] - (x[1] - x[0]) / 2;
    region[1] = x[2] + (x[2] - x[1]) / 2;
  }
}

/* Shock: the middle half from the piston to the front, without the front's own rise, which is tens of spacings wide in
 * a weak shock; at least the second quarter. Precursor: where pressure is flat. */
struct sph_plate_regions sph_plate_regions(const struct sph_run *run) {
  double shock, precursor, piston = run->inputs.piston.speed * run->system->now.time;
  sph_plate_look(run, run->now, &shock, &precursor);
  struct sph_plate_regions regions = {{NAN, NAN}, {NAN, NAN}};
  if (run->exact.has_shock) {
    const double length = shock - piston, flat = fmax(length / 2, length - shock_width(run));
    regions.shock[0] = piston + length / 4;
    regions.shock[1] = piston + fmin(flat, length * 3 / 4);
  }
  const double begin = run->exact.has_shock ? shock
                                            : piston + (precursor - piston) / 4; /* it oscillates at the piston */
  find_flat(run, begin, precursor, regions.precursor);
  return regions;
}

double sph_plate_mean(const struct sph_run *run, const double *column, const double region[2]) {
  const double *x = run->now->x;
  double sum = 0, n = 0;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    if (!(x[i] > region[0] && x[i] < region[1]))
      continue;
    sum += column[i];
    n++;
  }
  return sum / n;
}

void sph_plate_report(const struct sph_run *run, struct sph_results *r) {
  const struct sph_plane_shock *exact = &run->exact;
  const struct sph_particles *p = run->now;
  const struct sph_plate_regions regions = sph_plate_regions(run);
  if (exact->has_shock) {
    r->shock.speed = speed(run, offsetof(struct sph_sample, front));
    r->shock.density = sph_plate_mean(run, p->density, regions.shock);
    r->shock.pressure = sph_plate_mean(run, p->pressure, regions.shock);
    r->shock.speed_exact = exact->shock.speed;
    r->shock.density_exact = exact->shock.density;
    r->shock.pressure_exact = exact->shock.pressure;
  }
  if (exact->has_precursor) {
    r->precursor.speed = speed(run, offsetof(struct sph_sample, precursor));
    r->precursor.pressure = sph_plate_mean(run, p->pressure, regions.precursor);
    r->precursor.speed_exact = exact->precursor.speed;
    r->precursor.pressure_exact = exact->precursor.pressure;
  }
}

bool sph_plate_leaks(const struct sph_run *run) {
  const double piston = run->inputs.piston.speed * run->system->now.time;
  const double behind = piston - sph_derived_spacing(&run->inputs) / 2;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++)
    if (run->now->x[i] < behind)
      return true;
  return false;
}
