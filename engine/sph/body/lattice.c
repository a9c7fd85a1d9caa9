/* The number of particles, and boxes fitted with whole rows. Other shapes are cut out of a lattice (struct cut). */
#include "engine/sph/body/bodies.h"

#include <math.h>
#include <stdlib.h>

#include "engine/random.h"

/* Lattices cut by a shape's surface: the search for the offset that gives the wanted number of particles. */

/* A right-angled cell with particles at `basis` (fractions of its sides). Lengths are in spacings: the hexagonal
 * lattice's neighbours are 2^(1/6) apart, its rows sqrt(3)/2 and its layers sqrt(2/3) of that. */
struct sph_lattice_cell {
  double side[3]; /* distance of particles in a row, of rows, of layers */
  int period[3];  /* particles in a row, rows, layers until the lattice repeats */
  int count;
  double basis[4][3];
};

/* The period of a lattice along a direction, in spacings. */
static inline double sph_lattice_cell_period(const struct sph_lattice_cell *cell, int direction) {
  return cell->side[direction] * cell->period[direction];
}

struct cut {
  const struct sph_lattice_cell *cell;
  const struct sph_shape *shape;
  double frame[3][3]; /* its columns are the lattice's axes */
  double side[3];     /* m, of the cell */
  double reach[3];    /* m, of the shape along the lattice's axes */
  bool layered;       /* layers are fitted to a cylinder's length; the frame is the cylinder's */
  bool local;         /* `inside` works in the lattice's frame */
};

/* A place of the lattice's frame in that of the scene. */
static void to_world(const struct cut *c, const double p[3], double world[3]) {
  for (int k = 0; k < 3; k++)
    world[k] = c->shape->centre[k] + c->frame[k][0] * p[0] + c->frame[k][1] * p[1] + c->frame[k][2] * p[2];
}

static bool inside(const struct cut *c, const double p[3]) {
  const struct sph_shape *s = c->shape;
  if (!c->local) {
    double world[3];
    to_world(c, p, world);
    return sph_shape_inside(s, world);
  }
  const double across = p[0] * p[0] + p[1] * p[1];
  if (s->kind == SPH_SHAPE_SPHERE)
    return across + p[2] * p[2] < s->radius * s->radius;
  const bool in_ring = across < s->radius * s->radius && across >= s->inner_radius * s->inner_radius;
  return in_ring && fabs(p[2]) < 0.5 * s->length;
}

struct box { /* of cells */
  int64_t low[3], high[3];
};

/* Is the whole box outside of the shape? Particles are up to one cell beyond their cell's corner. */
static bool misses(const struct cut *c, const double offset[3], const struct box *box) {
  double middle[3], world[3], half = 0;
  for (int k = 0; k < 3; k++) {
    const double wide = 0.5 * (double)(box->high[k] - box->low[k] + 1) * c->side[k];
    middle[k] = ((double)box->low[k] + offset[k]) * c->side[k] + wide;
    half += wide * wide;
  }
  to_world(c, middle, world);
  return sph_shape_distance(c->shape, world, NULL) > sqrt(half);
}

/* One row of particles along x. p: y and z of the row. */
static size_t cut_row(const struct cut *c, double basis, double offset, const struct box *box, double p[3],
                      struct sph_points *points, size_t n) {
  for (int64_t ix = box->low[0]; ix < box->high[0]; ix++) {
    p[0] = ((double)ix + basis + offset) * c->side[0];
    if (fabs(p[0]) >= c->reach[0] || !inside(c, p))
      continue;
    if (points) {
      points->x[n] = p[0];
      points->y[n] = p[1];
      points->z[n] = p[2];
    }
    n++;
  }
  return n;
}

/* Counts the particles of a box of cells that are inside the shape and, with `points`, stores them relative to the
 * centre, in the lattice's frame. Boxes that the shape does not reach are left out, so that the cost of thin shapes of
 * any direction is proportional to their particles. Returns `n` plus the number. */
static size_t cut_box(const struct cut *c, const double offset[3], const struct box *box, struct sph_points *points,
                      size_t n) {
  enum { SMALL = 8 };
  if (misses(c, offset, box))
    return n;
  int longest = 0;
  for (int k = 1; k < 3; k++)
    if (box->high[k] - box->low[k] > box->high[longest] - box->low[longest])
      longest = k;
  const int64_t length = box->high[longest] - box->low[longest];
  if (length > SMALL) {
    struct box part[2] = {*box, *box};
    part[0].high[longest] = part[1].low[longest] = box->low[longest] + length / 2;
    n = cut_box(c, offset, &part[0], points, n);
    return cut_box(c, offset, &part[1], points, n);
  }
  for (int64_t iz = box->low[2]; iz < box->high[2]; iz++)
    for (int64_t iy = box->low[1]; iy < box->high[1]; iy++)
      for (int b = 0; b < c->cell->count; b++) {
        const double *basis = c->cell->basis[b];
        double p[3] = {0, ((double)iy + basis[1] + offset[1]) * c->side[1],
                       ((double)iz + basis[2] + offset[2]) * c->side[2]};
        if (fabs(p[2]) < c->reach[2] && fabs(p[1]) < c->reach[1])
          n = cut_row(c, basis[0], offset[0], box, p, points, n);
      }
  return n;
}

static size_t cut(const struct cut *c, const double offset[3], struct sph_points *points) {
  struct box all;
  for (int k = 0; k < 3; k++) { /* offset and basis are each within a cell */
    all.low[k] = (int64_t)floor(-c->reach[k] / c->side[k]) - 2;
    all.high[k] = (int64_t)ceil(c->reach[k] / c->side[k]) + 2;
  }
  return cut_box(c, offset, &all, points, 0);
}

/* The offset of a trial, in cells. A turned lattice draws it from the seed; else the first trial centres a particle and
 * the next ones cover the cell evenly. */
static void offsets(const struct sph_lattice *lattice, uint64_t trial, double out[3]) {
  static const double weyl[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  uint64_t bits[4];
  random_bits(lattice->seed, RANDOM_LATTICE, lattice->body, trial + 1, bits);
  for (int k = 0; k < 3; k++)
    out[k] = lattice->turned ? random_uniform(bits[k]) : fmod((double)trial * weyl[k], 1);
}

static void stack_layers(struct cut *c, double spacing, double layers) { /* whole layers along a cylinder */
  const double taller = c->shape->length / layers / (spacing * c->cell->side[2]);
  c->side[0] = spacing * sph_lattice_cell_period(c->cell, 0) / sqrt(taller);
  c->side[1] = spacing * sph_lattice_cell_period(c->cell, 1) / sqrt(taller);
  c->side[2] = spacing * sph_lattice_cell_period(c->cell, 2) * taller;
}

/* Does the body become forty times larger when it gets one spacing wider on all sides? Then the lattice mostly misses
 * it, and a search for better offsets would take long. Layers cannot miss the ends. */
static bool thin(const struct cut *c) {
  const struct sph_shape *s = c->shape;
  const double each = c->side[0] * c->side[1] * c->side[2] / c->cell->count, layer = c->side[2] / c->cell->period[2];
  const double across = c->layered ? sqrt(each / layer) : cbrt(each), along = c->layered ? 0 : across;
  if (s->kind == SPH_SHAPE_SPHERE)
    return false;
  if (s->kind == SPH_SHAPE_MESH)
    return !(sph_shape_mesh_area(s) * across < 39 * sph_shape_volume(s));
  double wider = 1;
  for (int k = 0; k < 3; k++)
    wider *= s->side[k] + 2 * across;
  if (s->kind == SPH_SHAPE_CYLINDER) {
    const double outer = s->radius + across, inner = fmax(0, s->inner_radius - across);
    wider = M_PI * (outer - inner) * (outer + inner) * (s->length + 2 * along);
  }
  return !(wider < 40 * sph_shape_volume(s));
}

/* Searches the offset that gives the wanted number of particles. The number changes with the offset by a few per mille
 * of thousands of particles, by more of few. Returns the number, 0 when the lattice misses the shape. */
static size_t search(const struct sph_lattice *lattice, const struct cut *c, double wanted, double best[3]) {
  const uint64_t trials = wanted < 2000 ? 1000 : 100;
  double off = HUGE_VAL;
  size_t n = 0;
  for (uint64_t trial = 0; trial < trials && off > 0.002; trial++) {
    double offset[3];
    offsets(lattice, trial, offset);
    if (c->layered) { /* half a layer from the end */
      const double end = (0.5 * c->side[2] / c->cell->period[2] - 0.5 * c->shape->length) / c->side[2];
      offset[2] = end - floor(end);
    }
    const size_t count = cut(c, offset, NULL);
    if (!count || fabs((double)count - wanted) / wanted >= off)
      continue;
    off = fabs((double)count - wanted) / wanted;
    n = count;
    for (int k = 0; k < 3; k++)
      best[k] = offset[k];
  }
  return n;
}

/* Scales to exactly V/n per particle (layers stay), moves the centre of mass to that of the shape, and turns the
 * lattice into the frame of the scene. */
static void settle(const struct cut *c, double wanted, struct sph_points *points) {
  const size_t n = points->n;
  const double ratio = wanted / (double)n, across = c->layered ? sqrt(ratio) : cbrt(ratio),
               along = c->layered ? 1 : across;
  double mean[3] = {0};
  for (size_t i = 0; i < n; i++) {
    mean[0] += points->x[i] / (double)n;
    mean[1] += points->y[i] / (double)n;
    mean[2] += c->layered ? 0 : points->z[i] / (double)n;
  }
  for (size_t i = 0; i < n; i++) {
    const double p[3] = {across * (points->x[i] - mean[0]), across * (points->y[i] - mean[1]),
                         along * (points->z[i] - mean[2])};
    double world[3];
    to_world(c, p, world);
    points->x[i] = world[0];
    points->y[i] = world[1];
    points->z[i] = world[2];
  }
}

/* As search(), for the number of layers nearest to the ideal one, or for the next one if that fits the wanted number of
 * particles better. */
static size_t search_layers(const struct sph_lattice *lattice, struct cut *c, double spacing, double wanted,
                            double best[3], double *layers) {
  const double length = c->shape->length;
  const bool periodic = lattice->periodic[0] || lattice->periodic[1] || lattice->periodic[2];
  const int step = periodic ? c->cell->period[2] : 1;
  const double ideal = length / (spacing * c->cell->side[2]) / step, nearest = fmax(1, round(ideal));
  const double other = fmax(1, nearest + (ideal > nearest ? 1 : -1));
  *layers = nearest * step;
  stack_layers(c, spacing, *layers);
  if (thin(c))
    return 0;
  size_t n = search(lattice, c, wanted, best);
  if (fabs((double)n - wanted) <= 0.01 * wanted)
    return n;

  double second[3];
  stack_layers(c, spacing, other * step);
  const size_t m = search(lattice, c, wanted, second);
  if (fabs((double)m - wanted) < fabs((double)n - wanted)) {
    n = m;
    *layers = other * step;
    for (int k = 0; k < 3; k++)
      best[k] = second[k];
  }
  stack_layers(c, spacing, *layers);
  return n;
}

/* The refusal of a body that has no room for its particles. */
static status too_thin(double wanted, double spacing, struct error *error) {
  return status_fail(
      error, STATUS_CONTENT,
      "a body is too thin for %.0f particles of spacing %.3g m: raise fidelity.particles, or take a thicker body",
      wanted, spacing);
}

static status fill_cut(const struct sph_lattice *lattice, const struct sph_lattice_cell *cell,
                       const struct sph_shape *shape, double wanted, struct sph_points *points, struct error *error) {
  struct cut c = {.cell = cell, .shape = shape};
  const double spacing = cbrt(sph_shape_volume(shape) / wanted);
  c.layered = shape->kind == SPH_SHAPE_CYLINDER && !lattice->turned;
  c.local = c.layered || shape->kind == SPH_SHAPE_SPHERE;
  sph_shape_frame(shape, c.frame);
  if (lattice->turned)
    random_rotation(lattice->seed, RANDOM_LATTICE, lattice->body, 0, c.frame);
  for (int k = 0; k < 3; k++) {
    const double axis[3] = {c.frame[0][k], c.frame[1][k], c.frame[2][k]}, back[3] = {-axis[0], -axis[1], -axis[2]};
    c.side[k] = spacing * sph_lattice_cell_period(cell, k);
    c.reach[k] = fmax(sph_shape_reach(shape, axis), sph_shape_reach(shape, back));
  }

  double offset[3] = {0}, layers = 0;
  size_t n = 0;
  if (c.layered)
    n = search_layers(lattice, &c, spacing, wanted, offset, &layers);
  else if (!thin(&c))
    n = search(lattice, &c, wanted, offset);
  if (!n || (double)n < 0.5 * wanted || (double)n > 2 * wanted + 2)
    return too_thin(wanted, spacing, error);

  TRY(sph_lattice_allocate(points, n, error));
  cut(&c, offset, points);
  points->spacing = cbrt(sph_shape_volume(shape) / (double)n);
  const double taller = c.layered ? shape->length / layers / (spacing * cell->side[2]) : 1;
  points->stretch = fmax(taller, 1 / taller);
  settle(&c, wanted, points);
  return STATUS_OK;
}

static const double hexagonal = 1.122462048309373;
static const struct sph_lattice_cell cells[] = {
    [SPH_LATTICE_HEXAGONAL] = {{1.122462048309373, 0.9720806486198328, 0.9164864246657354},
                               {1, 2, 2},
                               4,
                               {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 1. / 6, 0.5}, {0, 2. / 3, 0.5}}},
    [SPH_LATTICE_CUBIC] = {{1, 1, 1}, {1, 1, 1}, 1, {{0, 0, 0}}},
};

double sph_lattice_period(int kind, double spacing, int direction, double at_least) {
  const double one = spacing * (kind == SPH_LATTICE_IRREGULAR ? 1 : sph_lattice_cell_period(&cells[kind], direction));
  return one * fmax(1, ceil(at_least / one * (1 - 1e-12)));
}

void sph_lattice_empty(struct sph_points *points) {
  free(points->x);
  free(points->y);
  free(points->z);
  free(points->share);
  *points = (struct sph_points){0};
}

status sph_lattice_allocate(struct sph_points *points, size_t n, struct error *error) {
  points->n = n;
  points->x = malloc(n * sizeof *points->x);
  points->y = malloc(n * sizeof *points->y);
  points->z = malloc(n * sizeof *points->z);
  if (points->x && points->y && points->z)
    return STATUS_OK;
  return status_fail(error, STATUS_MEMORY, "no memory for the places of %zu particles", n);
}

/* ---- boxes along the axes: whole rows, stretched to fit ---- */

static void fit_box(const struct sph_lattice *lattice, const struct sph_lattice_cell *cell, const struct sph_shape *box,
                    double wanted, double best[3]) {
  const double spacing = cbrt(sph_shape_volume(box) / wanted);
  double ideal[3], least = INFINITY;
  int step[3];
  for (int k = 0; k < 3; k++) {
    ideal[k] = box->side[k] / (spacing * cell->side[k]);
    step[k] = lattice->periodic[k] ? cell->period[k] : 1;
  }
  enum { AROUND = 3 };
  for (int trial = 0; trial < (2 * AROUND) * (2 * AROUND) * (2 * AROUND); trial++) {
    const int shift[3] = {trial % (2 * AROUND) - AROUND + 1, trial / (2 * AROUND) % (2 * AROUND) - AROUND + 1,
                          trial / (4 * AROUND * AROUND) - AROUND + 1};
    double count[3], n = 1, widest = 0, narrowest = INFINITY;
    for (int k = 0; k < 3; k++) {
      count[k] = fmax(1, floor(ideal[k] / step[k]) + shift[k]) * step[k];
      n *= count[k];
      widest = fmax(widest, ideal[k] / count[k]);
      narrowest = fmin(narrowest, ideal[k] / count[k]);
    }
    /* A number that is 1 % off costs as much as a lattice that is 2 % wider in one direction than in another. Beyond
     * 1 %, each further 0.2 % costs as much. */
    const double miss = fabs(log(n / wanted)), off = miss <= 0.01 ? miss / 0.01 : 1 + (miss - 0.01) / 0.002;
    const double uneven = log(widest / narrowest) / 0.02;
    const double cost = off * off + uneven * uneven;
    if (cost < least) {
      least = cost;
      for (int k = 0; k < 3; k++)
        best[k] = count[k];
    }
  }
}

static status fill_box(const struct sph_lattice *lattice, const struct sph_lattice_cell *cell,
                       const struct sph_shape *box, double wanted, struct sph_points *points, struct error *error) {
  double count[3];
  fit_box(lattice, cell, box, wanted, count);
  const double n = count[0] * count[1] * count[2];
  if (n > 2 * wanted + 2 || n < 0.5 * wanted)
    return too_thin(wanted, cbrt(sph_shape_volume(box) / wanted), error);
  TRY(sph_lattice_allocate(points, (size_t)n, error));
  points->spacing = cbrt(sph_shape_volume(box) / (double)points->n);
  double step[3], corner[3];
  points->stretch = 1;
  for (int k = 0; k < 3; k++) {
    step[k] = box->side[k] / count[k];
    corner[k] = box->centre[k] - 0.5 * box->side[k];
    const double stretch = step[k] / (points->spacing * cell->side[k]);
    points->stretch = fmax(points->stretch, fmax(stretch, 1 / stretch));
  }
  const bool shifted = cell->period[1] == 2; /* rows lie in the gaps of the next ones, shifted by half a particle */
  size_t i = 0;
  for (size_t layer = 0; layer < (size_t)count[2]; layer++)
    for (size_t row = 0; row < (size_t)count[1]; row++)
      for (size_t at = 0; at < (size_t)count[0]; at++, i++) {
        const double x = shifted ? 0.25 + 0.5 * (double)((row + layer) % 2) : 0.5;
        const double y = shifted ? 1. / 3 + 1. / 3 * (double)(layer % 2) : 0.5;
        points->x[i] = corner[0] + ((double)at + x) * step[0];
        points->y[i] = corner[1] + ((double)row + y) * step[1];
        points->z[i] = corner[2] + ((double)layer + 0.5) * step[2];
      }
  return STATUS_OK;
}

/* ---- any lattice ---- */

/* The number of particles of a body without grading. */
static status decide(const struct sph_lattice *lattice, double volume, double *wanted, struct error *error) {
  const double s = lattice->spacing, bytes = lattice->kind == SPH_LATTICE_IRREGULAR ? 640 : 160;
  *wanted = lattice->particles;
  if (isnan(*wanted))
    *wanted = volume / s / s / s;
  if (!(*wanted * bytes < (double)sph_particles_memory()) || *wanted > 4e9)
    return status_fail(
        error, STATUS_MEMORY,
        "%.4g particles need %.3g GB before the first step; this machine, or the limit set, has %.3g GB.", *wanted,
        *wanted * bytes / 1e9, (double)sph_particles_memory() / 1e9);
  *wanted = fmax(1, round(*wanted));
  return STATUS_OK;
}

static status fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                   struct error *error) {
  const bool graded = lattice->grading.fine > 0;
  double wanted = 0;
  if (!graded)
    TRY(decide(lattice, sph_shape_volume(shape), &wanted, error));
  if (lattice->kind == SPH_LATTICE_IRREGULAR || graded)
    return sph_irregular_fill(lattice, shape, wanted, points, error);

  const struct sph_lattice_cell *cell = &cells[lattice->kind];
  if (shape->kind == SPH_SHAPE_BOX && !lattice->turned)
    TRY(fill_box(lattice, cell, shape, wanted, points, error));
  else
    TRY(fill_cut(lattice, cell, shape, wanted, points, error));
  points->nearest = points->spacing * (lattice->kind == SPH_LATTICE_HEXAGONAL ? hexagonal : 1);
  return STATUS_OK;
}

status sph_lattice_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                        struct error *error) {
  *points = (struct sph_points){0};
  const status code = fill(lattice, shape, points, error);
  if (code)
    sph_lattice_empty(points);
  return code;
}
