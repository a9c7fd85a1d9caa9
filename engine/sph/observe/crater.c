/* Crater and ejecta of a target. */
#include "engine/sph/observe/observe.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "engine/vector3.h"
#include "schemas/memory.h"

enum { SIDE_MOST = 2048 }; /* columns along one side */

double sph_crater_speed(const struct sph_particles *p, size_t i) {
  return sqrt(p->vx[i] * p->vx[i] + p->vy[i] * p->vy[i] + p->vz[i] * p->vz[i]);
}

double sph_crater_outwards(const struct sph_particles *p, size_t i, const struct sph_crater_options *o) {
  return vector3_dot((const double[3]){p->vx[i], p->vy[i], p->vz[i]}, o->frame[2]);
}

/* m, of particle i along axis k of the frame. */
static double place(const struct sph_particles *p, size_t i, const struct sph_crater_options *o, int k) {
  return vector3_dot((const double[3]){p->x[i], p->y[i], p->z[i]}, o->frame[k]);
}

static double height(const struct sph_particles *p, size_t i, const struct sph_crater_options *o) {
  return place(p, i, o, 2);
}

static bool is_ejected(const struct sph_particles *now, size_t i, const struct sph_crater_options *o) {
  return sph_crater_outwards(now, i, o) > o->ejection_speed || !isfinite(now->x[i] + now->y[i] + now->z[i]);
}

/* m, of particle i at the start. */
static double spacing_of(const struct sph_particles *start, size_t i, const struct sph_crater_options *o) {
  return o->graded ? fmax(o->spacing, cbrt(start->mass[i] / start->density[i])) : o->spacing;
}

/* m, of particle i from the axis. */
static double off_axis(const struct sph_particles *p, size_t i, const struct sph_crater_options *o) {
  return hypot(place(p, i, o, 0) - o->axis[0], place(p, i, o, 1) - o->axis[1]);
}

/* m, the highest particle less than `spacings` of its spacings from the axis. */
static double top_of(const struct sph_particles *start, const struct sph_crater_options *o, double spacings) {
  double top = -HUGE_VAL;
  for (size_t i = o->first; i < o->first + o->count; i++)
    if (off_axis(start, i, o) < spacings * spacing_of(start, i, o))
      top = fmax(top, height(start, i, o));
  return top;
}

/* A map of columns over the target's outline at the start. A column is two of the finest spacings wide. A coarser
 * particle belongs to all columns that a square of two of its own spacings touches, so that no column is without
 * particles at the start. */
struct map {
  size_t nx, ny;
  double x, y, size;      /* m: corner, and side of a column */
  double *before, *after; /* m, highest particle at the start and now, -inf where there is none */
  double *bottom;         /* m, lowest particle at the start */
  double *least;          /* m, spacing of the highest particle at the start: a hole is at least as deep */
};

static bool column_of(const struct map *m, double x, double y, size_t *at) {
  double i = floor((x - m->x) / m->size), j = floor((y - m->y) / m->size);
  if (!(i >= 0 && j >= 0 && i < (double)m->nx && j < (double)m->ny))
    return false;
  *at = (size_t)j * m->nx + (size_t)i;
  return true;
}

/* Columns from `first` to `last` along one side that [low, high] touches; none: last < first. */
static void columns_between(double low, double high, size_t n, long *first, long *last) {
  *first = (long)fmin((double)n, fmax(0, floor(low)));
  *last = (long)fmax(-1, fmin((double)n - 1, floor(high)));
}

static status make_map(const struct sph_particles *start, const struct sph_crater_options *o, struct map *m,
                       struct error *error) {
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (size_t i = o->first; i < o->first + o->count; i++) {
    const double x = place(start, i, o, 0), y = place(start, i, o, 1);
    low[0] = fmin(low[0], x);
    low[1] = fmin(low[1], y);
    high[0] = fmax(high[0], x);
    high[1] = fmax(high[1], y);
  }
  double widest = fmax(high[0] - low[0], high[1] - low[1]);
  *m = (struct map){.x = low[0], .y = low[1], .size = fmax(2 * o->spacing, widest / (SIDE_MOST - 1))};
  m->nx = (size_t)((high[0] - low[0]) / m->size) + 1;
  m->ny = (size_t)((high[1] - low[1]) / m->size) + 1;

  size_t columns = m->nx * m->ny;
  m->before = malloc(4 * columns * sizeof(double));
  if (!m->before)
    return status_fail(error, STATUS_MEMORY, "no memory for a map of the crater");
  m->after = m->before + columns;
  m->bottom = m->after + columns;
  m->least = m->bottom + columns;
  for (size_t k = 0; k < columns; k++) {
    m->before[k] = -HUGE_VAL;
    m->after[k] = -HUGE_VAL;
    m->bottom[k] = HUGE_VAL;
    m->least[k] = o->spacing;
  }
  return STATUS_OK;
}

static void fill_map(const struct sph_particles *start, const struct sph_particles *now,
                     const struct sph_crater_options *o, struct map *m) {
  for (size_t i = o->first; i < o->first + o->count; i++)
    for (int later = 0; later < 2; later++) {
      const struct sph_particles *p = later ? now : start;
      const double spacing = spacing_of(start, i, o), wide = (spacing - o->spacing) / m->size;
      const double x = (place(p, i, o, 0) - m->x) / m->size, y = (place(p, i, o, 1) - m->y) / m->size;
      const double z = height(p, i, o);
      long left, right, front, back;
      if (later && is_ejected(now, i, o))
        continue;
      columns_between(x - wide, x + wide, m->nx, &left, &right);
      columns_between(y - wide, y + wide, m->ny, &front, &back);
      for (long r = front; r <= back; r++)
        for (long c = left; c <= right; c++) {
          const size_t at = (size_t)r * m->nx + (size_t)c;
          if (later) {
            m->after[at] = fmax(m->after[at], z);
            continue;
          }
          if (z > m->before[at])
            m->least[at] = spacing;
          m->before[at] = fmax(m->before[at], z);
          m->bottom[at] = fmin(m->bottom[at], z);
        }
    }
}

/* Columns to visit; each is added once. */
struct queue {
  size_t *column, head, tail;
  bool *seen; /* by column */
};

static void enter(struct queue *q, size_t column) {
  if (q->seen[column])
    return;
  q->seen[column] = true;
  q->column[q->tail++] = column;
}

/* The axis' column and those round it: a lattice may leave the axis' column empty. */
static void enter_axis(const struct map *m, const double axis[2], struct queue *q) {
  size_t at;
  if (!column_of(m, axis[0], axis[1], &at))
    return;
  for (size_t j = 0; j < m->ny; j++)
    for (size_t i = 0; i < m->nx; i++) {
      double x = m->x + ((double)i + 0.5) * m->size, y = m->y + ((double)j + 0.5) * m->size;
      if (hypot(x - axis[0], y - axis[1]) < 1.5 * m->size)
        enter(q, j * m->nx + i);
    }
}

static void enter_neighbours(const struct map *m, size_t at, struct queue *q) {
  size_t i = at % m->nx, j = at / m->nx;
  if (i > 0)
    enter(q, at - 1);
  if (i + 1 < m->nx)
    enter(q, at + 1);
  if (j > 0)
    enter(q, at - m->nx);
  if (j + 1 < m->ny)
    enter(q, at + m->nx);
}

/* The connected region round the axis, at least one spacing of its place deep. A column that has lost all its particles
 * is as deep as the target was there. */
static status measure_hole(const struct map *m, const struct sph_crater_options *o, struct sph_results *results,
                           struct error *error) {
  size_t columns = m->nx * m->ny;
  OWNED size_t *column = malloc(columns * sizeof *column);
  OWNED bool *seen = calloc(columns, sizeof *seen);
  if (!column || !seen)
    return status_fail(error, STATUS_MEMORY, "no memory for a map of the crater");

  struct queue q = {.column = column, .seen = seen};
  double area = m->size * m->size, dug = 0, volume = 0, depth = 0;
  enter_axis(m, o->axis, &q);
  while (q.head < q.tail) {
    size_t at = q.column[q.head++];
    if (m->before[at] == -HUGE_VAL)
      continue;
    double deep = m->before[at] - fmax(m->after[at], m->bottom[at]);
    if (!(deep >= m->least[at]))
      continue;
    dug += area;
    volume += deep * area;
    depth = fmax(depth, deep);
    enter_neighbours(m, at, &q);
  }
  results->crater.depth = depth;
  results->crater.radius = sqrt(dug / M_PI);
  results->crater.volume = sph_results_finite(volume);
  return STATUS_OK;
}

/* Sums over the target's particles. Without a module that compacts matter, all of the crater is ejecta. Matter that
 * falls back has left the crater, but the target keeps it. */
static void measure_ejecta(const struct sph_particles *start, const struct sph_particles *now,
                           const struct sph_crater_options *o, struct sph_results *results) {
  double mass = 0, momentum = 0, volume = 0;
  memset(&results->ejecta_over_speed, 0, sizeof results->ejecta_over_speed);
  for (size_t i = o->first; i < o->first + o->count; i++) {
    if (!is_ejected(now, i, o))
      continue;
    volume += start->mass[i] / start->density[i];
    const double speed = sph_crater_speed(now, i);
    if (speed < o->escape_speed) /* false for NaN */
      continue;
    const double outwards = sph_crater_outwards(now, i, o);
    const double along = isfinite(outwards) ? now->mass[i] * outwards : 0;
    mass += now->mass[i];
    momentum += along;
    ejecta_add(&results->ejecta_over_speed, speed, now->mass[i], along);
  }
  results->ejecta.mass_fraction = sph_results_share(mass, o->mass);
  results->ejecta.momentum = sph_results_finite(momentum);
  results->crater.compaction_share = sph_results_share(0, volume);
}

status sph_crater_measure(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *o, struct sph_results *results, struct error *error) {
  if (!o->count || !(o->spacing > 0))
    return STATUS_OK;
  measure_ejecta(start, now, o, results);

  struct map map;
  TRY(make_map(start, o, &map, error));
  fill_map(start, now, o, &map);
  status code = measure_hole(&map, o, results, error);
  free(map.before);
  return code;
}

static const double compacted = 1.01; /* distention below which matter counts as compacted */

/* By the distention at P = 0. Fractured matter is under (undamaged) tension, which opens the pores of the elastic
 * branch again; at rest only permanently closed pores count. */
void sph_crater_compaction(const struct sph_particles *start, const struct sph_particles *now,
                           const struct sph_crater_options *o, double initial, struct sph_results *results) {
  const double top = top_of(start, o, 2);
  double ejecta_volume = 0, mass = 0, closed_volume = 0, depth = 0, reach = 0;
  for (size_t i = o->first; i < o->first + o->count; i++) {
    double alpha = now->rest_distention[i], alpha_start = start->distention[i];
    double closed = (alpha_start - alpha) / alpha_start;
    double volume = start->mass[i] / start->density[i];
    bool crushed = closed > 0 && alpha < compacted && alpha_start >= compacted;
    if (crushed)
      mass += now->mass[i];
    if (is_ejected(now, i, o)) {
      ejecta_volume += volume;
      continue;
    }
    closed_volume += fmax(closed, 0) * volume; /* the volume of the solid does not change */
    if (crushed && off_axis(start, i, o) < 2 * spacing_of(start, i, o))
      depth = fmax(depth, top - height(start, i, o));
    if (closed > 0 && alpha_start - alpha > 0.01 * (initial - 1))
      reach = fmax(reach, hypot(off_axis(start, i, o), top - height(start, i, o)));
  }
  results->crater.compaction_share = sph_results_share(closed_volume, closed_volume + ejecta_volume);
  results->palpha.compaction.mass_fraction = sph_results_share(mass, o->mass);
  results->palpha.compaction.volume = sph_results_finite(closed_volume);
  results->palpha.compaction.depth = depth;
  results->palpha.compaction.reach = reach;
}

size_t sph_crater_profile(const struct sph_particles *start, const struct sph_particles *now,
                          const struct sph_crater_options *o, struct sph_crater_layer *layers, size_t most) {
  double top = top_of(start, o, 1.5);
  memset(layers, 0, most * sizeof *layers);
  for (size_t i = o->first; i < o->first + o->count; i++) {
    if (!(off_axis(start, i, o) < 1.5 * spacing_of(start, i, o)) || is_ejected(now, i, o))
      continue;
    double layer = floor((top - height(start, i, o)) / o->spacing + 0.5);
    if (!(layer >= 0 && layer < (double)most))
      continue;
    struct sph_crater_layer *l = &layers[(size_t)layer];
    l->depth += 1; /* the number of particles, until the loop ends */
    l->damage += sph_particles_damage(now, i);
    const double pressure = sph_particles_acting_pressure(now, i);
    if (!isnan(pressure)) {
      l->pressure += pressure;
      l->bearing += 1;
    }
    l->velocity += sph_crater_outwards(now, i, o);
#define PROFILE_COLUMN(member, of_impact, of_plate, absent, ...)                                                       \
  l->member += now->of_impact ? now->of_impact[i] : absent;
#include "engine/sph/modules/declarations.h"
  }

  size_t count = 0;
  for (size_t k = 0; k < most; k++) {
    struct sph_crater_layer l = layers[k];
    if (!(l.depth > 0))
      continue;
    layers[count++] = (struct sph_crater_layer){
        .depth = (double)k * o->spacing,
        .damage = l.damage / l.depth,
        .pressure = l.pressure / l.bearing,
        .bearing = l.bearing,
        .velocity = l.velocity / l.depth,
#define PROFILE_COLUMN(member, ...) .member = l.member / l.depth,
#include "engine/sph/modules/declarations.h"
    };
  }
  return count;
}
