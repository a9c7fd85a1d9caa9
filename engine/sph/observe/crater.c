#include "engine/sph/observe/crater.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MOST = 2048 }; /* columns along one side */
static const double compacted = 1.01;

static double distention(const struct sph_particles *start, size_t i) {
  return start->distention ? start->distention[i] : 1;
}

/* At P = 0: torn matter stands in (undamaged) tension, in which the pores of its elastic branch are open again, and yet
 * closed ones stay closed. */
static double at_rest(const struct sph_particles *now, size_t i) {
  return now->rest_distention ? now->rest_distention[i] : 1;
}

static bool is_ejected(const struct sph_particles *now, size_t i, double speed) {
  return now->vz[i] > speed || !isfinite(now->x[i] + now->y[i] + now->z[i]);
}

static double off_axis(const struct sph_particles *p, size_t i, const double axis[2]) {
  return hypot(p->x[i] - axis[0], p->y[i] - axis[1]);
}

/* A map of columns over the target's outline at the start. */
struct map {
  size_t nx, ny;
  double x, y, size;
  double *before, *after; /* highest particle at the start and now, -inf where none is */
  double *bottom;         /* lowest particle at the start */
};

static bool column_of(const struct map *m, double x, double y, size_t *at) {
  double i = floor((x - m->x) / m->size), j = floor((y - m->y) / m->size);
  if (!(i >= 0 && j >= 0 && i < (double)m->nx && j < (double)m->ny))
    return false;
  *at = (size_t)j * m->nx + (size_t)i;
  return true;
}

static status make_map(const struct sph_particles *start, const struct sph_particles *now,
                       const struct sph_crater_options *o, struct map *m, struct error *error) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (size_t i = o->first; i < o->first + o->count; i++) {
    low[0] = fmin(low[0], start->x[i]), high[0] = fmax(high[0], start->x[i]);
    low[1] = fmin(low[1], start->y[i]), high[1] = fmax(high[1], start->y[i]);
  }
  double widest = fmax(high[0] - low[0], high[1] - low[1]);
  *m = (struct map){.x = low[0], .y = low[1], .size = fmax(2 * o->spacing, widest / (SIDE_MOST - 1))};
  m->nx = (size_t)((high[0] - low[0]) / m->size) + 1;
  m->ny = (size_t)((high[1] - low[1]) / m->size) + 1;
  m->before = malloc(3 * m->nx * m->ny * sizeof(double));
  if (!m->before)
    return status_fail(error, STATUS_MEMORY, "no memory for a map of the crater");
  m->after = m->before + m->nx * m->ny;
  m->bottom = m->after + m->nx * m->ny;
  for (size_t k = 0; k < m->nx * m->ny; k++)
    m->before[k] = m->after[k] = -HUGE_VAL, m->bottom[k] = HUGE_VAL;
  for (size_t i = o->first; i < o->first + o->count; i++) {
    size_t at;
    if (column_of(m, start->x[i], start->y[i], &at)) {
      m->before[at] = fmax(m->before[at], start->z[i]);
      m->bottom[at] = fmin(m->bottom[at], start->z[i]);
    }
    if (!is_ejected(now, i, o->ejection_speed) && column_of(m, now->x[i], now->y[i], &at))
      m->after[at] = fmax(m->after[at], now->z[i]);
  }
  return STATUS_OK;
}

/* The connected region round the axis, at least one spacing deep. A column through which all has gone is as deep as the
 * target was there. */
static status dig(const struct map *m, const struct sph_crater_options *o, struct sph_crater *out,
                  struct error *error) {
  size_t *queue = malloc(m->nx * m->ny * sizeof *queue), head = 0, tail = 0, at;
  unsigned char *seen = calloc(m->nx * m->ny, 1);
  if (!queue || !seen) {
    free(queue);
    free(seen);
    return status_fail(error, STATUS_MEMORY, "no memory for a map of the crater");
  }
  double area = m->size * m->size, dug = 0;
  if (column_of(m, o->axis[0], o->axis[1], &at)) {
    /* the columns round the axis, too: the lattice may leave its own empty */
    for (size_t j = 0; j < m->ny; j++)
      for (size_t i = 0; i < m->nx; i++)
        if (hypot(m->x + ((double)i + 0.5) * m->size - o->axis[0], m->y + ((double)j + 0.5) * m->size - o->axis[1]) <
            1.5 * m->size) {
          queue[tail++] = j * m->nx + i;
          seen[j * m->nx + i] = 1;
        }
  }
  while (head < tail) {
    at = queue[head++];
    if (m->before[at] == -HUGE_VAL)
      continue;
    double deep = m->before[at] - fmax(m->after[at], m->bottom[at]);
    if (!(deep >= o->spacing))
      continue;
    dug += area;
    out->volume += deep * area;
    out->depth = fmax(out->depth, deep);
    size_t i = at % m->nx, j = at / m->nx;
    const size_t next[4] = {i > 0 ? at - 1 : at, i + 1 < m->nx ? at + 1 : at, j > 0 ? at - m->nx : at,
                            j + 1 < m->ny ? at + m->nx : at};
    for (int k = 0; k < 4; k++)
      if (!seen[next[k]]) {
        seen[next[k]] = 1;
        queue[tail++] = next[k];
      }
  }
  out->radius = sqrt(dug / M_PI);
  free(queue);
  free(seen);
  return STATUS_OK;
}

status sph_crater_find(const struct sph_particles *start, const struct sph_particles *now,
                       const struct sph_crater_options *o, struct sph_crater *out, struct error *error) {
  *out = (struct sph_crater){0};
  if (!o->count || !(o->spacing > 0))
    return STATUS_OK;
  double top = -HUGE_VAL;
  for (size_t i = o->first; i < o->first + o->count; i++) {
    if (off_axis(start, i, o->axis) < 2 * o->spacing)
      top = fmax(top, start->z[i]);
  }
  for (size_t i = o->first; i < o->first + o->count; i++) {
    double alpha = at_rest(now, i),
           closed = o->distention > 1 ? (distention(start, i) - alpha) / distention(start, i) : 0;
    double volume = start->mass[i] / start->density[i];
    bool crushed = closed > 0 && alpha < compacted && distention(start, i) >= compacted;
    if (crushed)
      out->compacted_mass += now->mass[i];
    if (is_ejected(now, i, o->ejection_speed)) {
      out->ejected_mass += now->mass[i];
      out->ejected_momentum += isfinite(now->vz[i]) ? now->mass[i] * now->vz[i] : 0;
      out->ejecta_volume += volume;
      continue;
    }
    out->compaction_volume += fmax(closed, 0) * volume; /* the solid's own volume is kept */
    if (crushed && off_axis(start, i, o->axis) < 2 * o->spacing)
      out->compaction_depth = fmax(out->compaction_depth, top - start->z[i]);
    if (closed > 0 && distention(start, i) - alpha > 0.01 * (o->distention - 1))
      out->compaction_reach = fmax(out->compaction_reach, hypot(off_axis(start, i, o->axis), top - start->z[i]));
  }
  struct map map;
  status code = make_map(start, now, o, &map, error);
  if (!code)
    code = dig(&map, o, out, error);
  free(map.before);
  return code;
}

size_t sph_crater_profile(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *o, struct sph_crater_layer *layers, size_t most) {
  double top = -HUGE_VAL;
  for (size_t i = o->first; i < o->first + o->count; i++)
    if (off_axis(start, i, o->axis) < 1.5 * o->spacing)
      top = fmax(top, start->z[i]);
  memset(layers, 0, most * sizeof *layers);
  for (size_t i = o->first; i < o->first + o->count; i++) {
    if (!(off_axis(start, i, o->axis) < 1.5 * o->spacing) || is_ejected(now, i, o->ejection_speed))
      continue;
    double layer = floor((top - start->z[i]) / o->spacing + 0.5);
    if (!(layer >= 0 && layer < (double)most))
      continue;
    struct sph_crater_layer *l = &layers[(size_t)layer];
    double d = now->damage_cbrt ? now->damage_cbrt[i] : 0;
    l->depth += 1; /* a count, for now */
    l->distention += at_rest(now, i);
    l->damage += d * d * d;
    l->pressure += now->pressure[i];
    l->velocity += now->vz[i];
  }
  size_t count = 0;
  for (size_t k = 0; k < most; k++) {
    struct sph_crater_layer l = layers[k];
    if (!(l.depth > 0))
      continue;
    layers[count++] = (struct sph_crater_layer){(double)k * o->spacing, l.distention / l.depth, l.damage / l.depth,
                                                l.pressure / l.depth, l.velocity / l.depth};
  }
  return count;
}
