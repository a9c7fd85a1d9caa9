/* The shock fronts in a plate that a piston hits: places, speeds and the states behind them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/observe/observe.h"
#include "engine/sph/scene/derived.h"

/* A layer of matter that was one spacing thick at the start: sums over its particles. */
struct sph_plate_layer {
  double x, density, count;
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

/* The place of a front: the first one, from the far side, where density reaches the mean of the values ahead of the
 * front and behind it. */
static double front_place(const struct sph_run *run, double ahead, double behind) {
  double level = (ahead + behind) / 2, before = NAN, at = NAN;
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

void sph_plate_look(const struct sph_run *run, const struct sph_particles *p, double *shock, double *precursor) {
  const struct sph_plane_shock *exact = &run->exact;
  double between = exact->has_precursor ? exact->precursor.density : exact->first_density;
  fill_layers(run, p);
  *precursor = exact->has_precursor ? front_place(run, exact->first_density, between) : (double)NAN;
  *shock = exact->has_shock ? front_place(run, between, exact->shock.density) : (double)NAN;
}

/* Slope of places against times by least squares over the second half of the run, when a front has its final form. */
static double speed(const struct sph_run *run, size_t offset) {
  double from = run->inputs.stop.end_time / 2, n = 0, t = 0, x = 0, tt = 0, tx = 0;
  for (size_t k = 0; k < run->state.samples; k++) {
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

/* Shock: the middle half from the piston to the front. Precursor: well ahead of the shock, which is some spacings wide,
 * and behind the precursor's own rise. */
struct sph_plate_regions sph_plate_regions(const struct sph_run *run) {
  double shock, precursor, piston = run->inputs.piston.speed * sph_system_time(run->system);
  sph_plate_look(run, run->now, &shock, &precursor);
  const double from = run->exact.has_shock ? shock : piston;
  return (struct sph_plate_regions){
      .shock = {piston + (shock - piston) / 4, piston + (shock - piston) * 3 / 4},
      .precursor = {from + (precursor - from) * 0.4, from + (precursor - from) * 0.7},
  };
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
  const double piston = run->inputs.piston.speed * sph_system_time(run->system);
  const double behind = piston - sph_derived_spacing(&run->inputs) / 2;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++)
    if (run->now->x[i] < behind)
      return true;
  return false;
}
