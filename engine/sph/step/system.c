#include "engine/sph/step/system.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/modules/ranges.h"
#include "engine/sph/step/system_step.h"

void sph_system_free(struct sph_system *s) {
  if (!s)
    return;
  for (size_t b = 0; s->solid && b < s->body_count; b++)
    sph_weibull_free(s->solid[b].weibull);
  sph_pairs_free(s->pairs);
  free(s->arena);
  free(s->id);
  free(s->held);
  free(s->order);
  free(s->solid);
  free(s->block);
  free(s);
}

size_t sph_system_bytes(const struct sph_system *s) {
  size_t bytes = sizeof *s + s->arena_doubles * sizeof(double) + s->n * 2 * sizeof(uint32_t) +
                 s->body_count * sizeof *s->solid + s->block_count * sizeof *s->block + sph_pairs_bytes(s->pairs);
  if (s->held)
    bytes += s->n * sizeof *s->held;
  for (size_t b = 0; b < s->body_count; b++)
    bytes += sph_weibull_bytes(s->solid[b].weibull);
  return bytes;
}

int sph_system_fault(const struct sph_system *s) {
  return s->fault;
}
const char *sph_system_failure(const struct sph_system *s) {
  return s->failure;
}
double sph_system_time(const struct sph_system *s) {
  return s->now.time;
}
double sph_system_last_step(const struct sph_system *s) {
  return s->now.last_step;
}
int sph_system_limiter(const struct sph_system *s) {
  return (int)s->now.limiter;
}
uint64_t sph_system_steps(const struct sph_system *s) {
  return s->now.steps;
}
double sph_system_neighbours(const struct sph_system *s) {
  return s->now.neighbours;
}

static double wrapped(double x, double length) {
  if (!(length > 0))
    return x;
  x -= length * floor(x / length);
  return x < length ? x : 0;
}

void sph_system_read(const struct sph_system *s, struct sph_particles *out) {
  for (size_t i = 0; i < s->n; i++) {
    const size_t to = s->id[i];
    out->x[to] = wrapped(s->c.x[i], s->domain.periodic[0]);
    out->y[to] = wrapped(s->c.y[i], s->domain.periodic[1]);
    out->z[to] = wrapped(s->c.z[i], s->domain.periodic[2]);
    out->vx[to] = s->c.vx[i];
    out->vy[to] = s->c.vy[i];
    out->vz[to] = s->c.vz[i];
    out->mass[to] = s->c.mass[i];
    out->density[to] = s->c.density[i];
    out->energy[to] = s->c.energy[i];
    out->h[to] = s->c.h[i];
    out->pressure[to] = s->c.pressure[i];
    if (out->stress[0] && s->strength) {
      for (int k = 0; k < 5; k++)
        out->stress[k][to] = s->c.stress[k][i];
      out->stress[5][to] = -(s->c.stress[0][i] + s->c.stress[3][i]);
    }
    if (out->damage_cbrt && s->damage)
      out->damage_cbrt[to] = s->c.damage[i];
    if (out->damping && s->c.damping)
      out->damping[to] = s->c.damping[i];
    if (out->distention)
      out->distention[to] = s->c.distention ? s->c.distention[i] : 1;
    if (out->rest_distention)
      out->rest_distention[to] = s->c.rest_distention ? s->c.rest_distention[i] : 1;
    if (out->held && s->held)
      out->held[to] = s->held[i];
  }
  for (size_t b = 0; b < s->body_count; b++)
    memset(out->body + s->solid[b].first, (int)b, s->solid[b].last - s->solid[b].first);
}

bool sph_system_flaws(const struct sph_system *s, uint32_t *count) {
  if (!s->fracture)
    return false;
  for (size_t b = 0; b < s->body_count; b++) {
    const struct sph_solid *body = &s->solid[b];
    for (size_t i = body->first; i < body->last; i++) /* bodies stand in the order of their ids */
      count[i] = body->weibull ? sph_weibull_total(body->weibull, i - body->first) : 0;
  }
  return true;
}

double sph_system_damage(const struct sph_system *s, double *rate) {
  double volume = 0, damage = 0, growth = 0;
  for (size_t b = 0; s->fracture && b < s->body_count; b++) {
    if (!s->solid[b].weibull)
      continue;
    for (size_t i = s->solid[b].first; i < s->solid[b].last; i++) {
      const double v = s->c.mass[i], d = s->c.damage[i];
      volume += v;
      damage += v * d * d * d;
      const double own = s->c.tension && s->solid[b].physics.porosity ? s->c.tension[i] : d; /* what flaws have done */
      growth += v * 3 * own * own * s->c.damage_rate[i];
    }
  }
  if (rate)
    *rate = volume > 0 ? growth / volume : 0;
  return volume > 0 ? damage / volume : 0;
}
