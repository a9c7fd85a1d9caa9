/* Bodies of irregular points: uniform, or finer near a point (sph_grading). Points are placed in the body with a wanted
 * spacing s(x), then pushed apart until the density sum is uniform.
 *
 * A neighbour j pushes i along their line with (s_j / s_i)(1 - r/R), R = s_i + s_j (after the weighted Voronoi
 * relaxation of Diehl, Rockefeller, Fryer, Riethmiller & Statler 2015, who have other weights). With any push F(r/R)
 * and number density 1/s^3, the first-order bias of a slope in s is (-3 + 1 + 2) = 0 times an integral, so graded
 * points stay graded. A surface pushes as a continuum beyond it would, in closed form, so points fill the body up to
 * its surface. A fixed number of rounds bounds the time. The density sum (cubic spline, h = 1.13 s) then scatters by
 * 0.9 %; graded points scatter by 1.1 % about means that are within 2 % of the density everywhere. */
#include "engine/sph/body/bodies.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "engine/random.h"
#include "engine/sph/body/kd_tree.h"
#include "schemas/memory.h"

/* ---- pushing points apart ---- */

/* Found by trial: 24 rounds with steps that fall from 5 to 1 scatter as little as 200 small ones; with steps of 8
 * points do not settle. Graded points start less evenly. */
enum { ROUNDS = 24, ROUNDS_GRADED = 40, ROUNDS_PER_LIST = 4 };
static const double first_step = 5, last_step = 1, longest_move = 0.3; /* of s */
static const double list_reach = 2, list_skin = 0.4;                   /* of s */
static const double margin = 0.1; /* of s: least distance from a surface; that of lattices is half a spacing */

struct work {
  const struct sph_lattice *lattice;
  const struct sph_shape *shape;
  size_t n;
  double spacing;
  double length[3]; /* m, of periodic directions; 0 = open */
  double (*at)[3], (*push)[3], *s;
  size_t *first, capacity;
  uint32_t *list;
};

static double relax_spacing(const struct sph_grading *g, const double p[3]) {
  const double r[3] = {p[0] - g->point[0], p[1] - g->point[1], p[2] - g->point[2]};
  const double d = fmax(0, sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) - g->radius);
  return g->fine + g->growth * d * d / (d + 4 * g->fine);
}

static double wanted(const struct work *w, const double p[3]) {
  return w->lattice->grading.fine > 0 ? relax_spacing(&w->lattice->grading, p) : w->spacing;
}

static status no_memory(size_t n, struct error *error) {
  return status_fail(error, STATUS_MEMORY, "no memory to spread %zu particles", n);
}

/* The coordinates by column: x, y and z of n points each. NULL: no memory. */
static double *columns_of(size_t n, double (*at)[3]) {
  double *column = malloc(3 * n * sizeof *column);
  for (size_t i = 0; column && i < n; i++)
    for (size_t k = 0; k < 3; k++)
      column[k * n + i] = at[i][k];
  return column;
}

/* Lists the neighbours of all points. */
static status list(struct work *w, struct error *error) {
  OWNED struct sph_kd_tree *tree = NULL;
  OWNED double *column = columns_of(w->n, w->at);
  if (!column)
    return no_memory(w->n, error);
  TRY(sph_kd_tree_create(w->n, column, column + w->n, column + 2 * w->n, &tree, error));
  size_t total = 0;
  for (size_t i = 0; i < w->n; i++) {
    w->first[i] = total;
    if (!sph_kd_tree_list(tree, w->at[i], w->length, (list_reach + list_skin) * w->s[i], &w->list, &w->capacity,
                          &total))
      return no_memory(w->n, error);
  }
  w->first[w->n] = total;
  return STATUS_OK;
}

/* Does the wall end the body? Walls of periodic directions do not. */
static bool open_wall(const struct work *w, int wall) {
  if (w->shape->kind == SPH_SHAPE_BOX)
    return !(w->length[wall / 2] > 0);
  if (w->shape->kind == SPH_SHAPE_CYLINDER && wall < 2)
    return !(w->length[0] + w->length[1] + w->length[2] > 0);
  return true;
}

/* Adds the push of the walls on point i. A continuum beyond a plane at the depth d R pushes with
 * pi R^3 integral over q from d to 1 of (1 - q)(q^2 - d^2). */
static void push_walls(const struct work *w, size_t i, double f[3]) {
  const double over = 1 / (list_reach * w->s[i]);
  double depth[SPH_SHAPE_WALLS], normal[SPH_SHAPE_WALLS][3];
  const int walls = sph_shape_walls(w->shape, w->at[i], depth, normal);
  for (int wall = 0; wall < walls; wall++) {
    const double d = fmax(0, depth[wall] * over);
    if (d >= 1 || !open_wall(w, wall))
      continue;
    const double strength = M_PI * (1. / 12 + d * d * (-0.5 + d * (2. / 3 - 0.25 * d)));
    for (int k = 0; k < 3; k++)
      f[k] -= strength * normal[wall][k];
  }
}

/* The push f on point i. */
static void push(const struct work *w, size_t i, double f[3]) {
  const double each = 1 / (list_reach * list_reach * list_reach * w->s[i]);
  f[0] = f[1] = f[2] = 0;
  for (size_t k = w->first[i]; k < w->first[i + 1]; k++) {
    const size_t j = w->list[k];
    double r[3], squares = 0;
    for (int d = 0; d < 3; d++) {
      r[d] = w->at[i][d] - w->at[j][d];
      if (w->length[d] > 0)
        r[d] -= w->length[d] * rint(r[d] / w->length[d]);
      squares += r[d] * r[d];
    }
    const double both = 0.5 * list_reach * (w->s[i] + w->s[j]);
    if (squares >= both * both || squares == 0)
      continue;
    const double length = sqrt(squares), strength = each * w->s[j] * (1 / length - 1 / both);
    for (int d = 0; d < 3; d++)
      f[d] += strength * r[d];
  }
  push_walls(w, i, f);
}

/* Keeps a point inside the walls, and in the first period of periodic directions. */
static void confine(const struct work *w, double p[3], double s) {
  double depth[SPH_SHAPE_WALLS], normal[SPH_SHAPE_WALLS][3];
  const int walls = sph_shape_walls(w->shape, p, depth, normal);
  for (int wall = 0; wall < walls; wall++)
    for (int k = 0; k < 3 && depth[wall] < margin * s && open_wall(w, wall); k++)
      p[k] -= (margin * s - depth[wall]) * normal[wall][k];
  for (int k = 0; k < 3; k++)
    if (w->length[k] > 0)
      p[k] -= w->length[k] * floor(p[k] / w->length[k]);
}

/* Moves all points once. */
static void round_of(struct work *w, double step) {
  for (size_t i = 0; i < w->n; i++) {
    double *f = w->push[i];
    push(w, i, f);
    const double strength = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    const double move = w->s[i] * (strength * step > longest_move ? longest_move / strength : step);
    for (int k = 0; k < 3; k++)
      f[k] *= move;
  }
  for (size_t i = 0; i < w->n; i++) {
    for (int k = 0; k < 3; k++)
      w->at[i][k] += w->push[i][k];
    confine(w, w->at[i], w->s[i]);
    w->s[i] = wanted(w, w->at[i]);
  }
}

static status relax_spread(const struct sph_lattice *lattice, const struct sph_shape *shape, double spacing, size_t n,
                           double (*at)[3], struct error *error) {
  struct work w = {.lattice = lattice, .shape = shape, .n = n, .spacing = spacing, .at = at, .capacity = 64 * n + 64};
  status code = STATUS_OK;
  OWNED double(*pushes)[3] = w.push = malloc(n * sizeof *w.push);
  OWNED double *spacings = w.s = malloc(n * sizeof *w.s);
  OWNED size_t *first = w.first = malloc((n + 1) * sizeof *w.first);
  w.list = malloc(w.capacity * sizeof *w.list); /* it grows */
  for (int k = 0; k < 3; k++)
    if (lattice->periodic[k])
      w.length[k] = shape->kind == SPH_SHAPE_BOX ? shape->side[k] : shape->length;
  if (!pushes || !spacings || !first || !w.list)
    code = no_memory(n, error);
  for (size_t i = 0; i < n && !code; i++) {
    w.s[i] = wanted(&w, at[i]);
    confine(&w, at[i], w.s[i]);
  }
  const int rounds = lattice->grading.fine > 0 ? ROUNDS_GRADED : ROUNDS;
  for (int k = 0; k < rounds && !code; k++) {
    if (k % ROUNDS_PER_LIST == 0)
      code = list(&w, error);
    if (!code)
      round_of(&w, first_step * pow(last_step / first_step, (double)k / (rounds - 1)));
  }
  free(w.list);
  return code;
}

static const uint64_t places = (uint64_t)1 << 32; /* number of this file's first draw; those of lattice.c are below */

/* Volumes divided by their mean: the cubes of the spacings of the grading. */
static void fill_shares(const struct sph_grading *grading, size_t n, double (*at)[3], double *share) {
  double total = 0;
  for (size_t i = 0; i < n; i++) {
    const double s = relax_spacing(grading, at[i]);
    share[i] = s * s * s;
    total += share[i];
  }
  for (size_t i = 0; i < n; i++)
    share[i] *= (double)n / total;
}

/* Mean distance of nearest neighbours; 0 where there are none. */
static status find_nearest(const struct sph_points *points, double (*at)[3], double *mean, struct error *error) {
  OWNED struct sph_kd_tree *tree = NULL;
  TRY(sph_kd_tree_create(points->n, points->x, points->y, points->z, &tree, error));
  double sum = 0;
  for (size_t i = 0; i < points->n; i++) {
    const size_t j = sph_kd_tree_other(tree, at[i], i);
    if (j < points->n)
      sum += hypot(hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]), at[i][2] - at[j][2]);
  }
  *mean = sum / (double)points->n;
  return STATUS_OK;
}

/* Fills *points, and finds the mean distance of nearest neighbours. */
static status store(const struct sph_shape *shape, const struct sph_grading *grading, size_t n, double (*at)[3],
                    struct sph_points *points, struct error *error) {
  TRY(sph_lattice_allocate(points, n, error));
  if (grading->fine > 0) {
    points->share = malloc(n * sizeof *points->share);
    if (!points->share)
      return status_fail(error, STATUS_MEMORY, "no memory for the places of %zu particles", n);
    fill_shares(grading, n, at, points->share);
  }
  for (size_t i = 0; i < n; i++) {
    points->x[i] = at[i][0];
    points->y[i] = at[i][1];
    points->z[i] = at[i][2];
  }
  points->spacing = cbrt(sph_shape_volume(shape) / (double)n);
  points->stretch = 1;
  TRY(find_nearest(points, at, &points->nearest, error));
  if (n == 1)
    points->nearest = points->spacing;
  return STATUS_OK;
}

/* Uniform points start as the hexagonal lattice, each moved by up to 0.7 spacings per direction. This leaves nothing of
 * the order, but the density is uniform over long distances, where pushing points apart is slow. */
static status fill_uniform(const struct sph_lattice *lattice, const struct sph_shape *shape, double wanted,
                           struct sph_points *points, struct error *error) {
  struct sph_lattice regular = *lattice;
  regular.kind = SPH_LATTICE_HEXAGONAL;
  regular.particles = wanted;
  struct sph_points start;
  TRY(sph_lattice_fill(&regular, shape, &start, error));
  OWNED double(*at)[3] = malloc(start.n * sizeof *at);
  for (size_t i = 0; at && i < start.n; i++) {
    uint64_t bits[4];
    random_bits(lattice->seed, RANDOM_LATTICE, lattice->body, places + i, bits);
    const double p[3] = {start.x[i], start.y[i], start.z[i]};
    for (int k = 0; k < 3; k++)
      at[i][k] = p[k] + 1.4 * start.spacing * (random_uniform(bits[k]) - 0.5);
  }
  const double spacing = start.spacing;
  const size_t n = start.n;
  sph_lattice_empty(&start);
  if (!at)
    return no_memory(n, error);
  TRY(relax_spread(lattice, shape, spacing, n, at, error));
  return store(shape, &lattice->grading, n, at, points, error);
}

/* ---- graded points: the number of particles within r of the point ---- */

enum { SHELLS = 1024, RAYS = 512 };

struct shells {
  double r[SHELLS + 1];      /* m, edges of the shells */
  double open[SHELLS];       /* part of each shell, at its middle, that is in the body */
  double number[SHELLS + 1]; /* of whole shells, cumulative */
};

/* A direction d, uniform over the sphere for uniform u and turn of [0, 1). */
static void ray(double u, double turn, double d[3]) {
  const double z = 2 * u - 1, across = sqrt(fmax(0, 1 - z * z));
  d[0] = across * cos(2 * M_PI * turn);
  d[1] = across * sin(2 * M_PI * turn);
  d[2] = z;
}

static void cut_shells(const struct sph_grading *g, const struct sph_shape *shape, struct shells *shells) {
  double size = 0, away = 0;
  for (int k = 0; k < 3; k++) {
    const double unit[3] = {k == 0, k == 1, k == 2}, back[3] = {-unit[0], -unit[1], -unit[2]};
    const double reach = fmax(sph_shape_reach(shape, unit), sph_shape_reach(shape, back));
    size += reach * reach;
    away += (g->point[k] - shape->centre[k]) * (g->point[k] - shape->centre[k]);
  }
  const double furthest = sqrt(size) + sqrt(away), core = g->radius + 4 * g->fine;
  double d[RAYS][3];
  for (int i = 0; i < RAYS; i++)
    ray((i + 0.5) / RAYS, fmod(0.6180339887498949 * i, 1), d[i]);
  for (int k = 0; k <= SHELLS; k++) /* fine shells in the core, geometric beyond */
    shells->r[k] = core * expm1(log1p(furthest / core) * k / SHELLS);
  for (int k = 0; k < SHELLS; k++) {
    const double r = 0.5 * (shells->r[k] + shells->r[k + 1]);
    int in = 0;
    for (int i = 0; i < RAYS; i++)
      in += sph_shape_inside(shape, (double[3]){g->point[0] + r * d[i][0], g->point[1] + r * d[i][1],
                                                g->point[2] + r * d[i][2]});
    shells->open[k] = (double)in / RAYS;
  }
}

/* The number of particles in the body by the grading. */
static double count(const struct sph_grading *g, struct shells *shells) {
  double n = 0;
  shells->number[0] = 0;
  for (int k = 0; k < SHELLS; k++) {
    const double a = shells->r[k], b = shells->r[k + 1], r = 0.5 * (a + b);
    const double s = relax_spacing(g, (double[3]){g->point[0] + r, g->point[1], g->point[2]});
    const double whole = 4 * M_PI / 3 * (b - a) * (b * b + a * b + a * a) / (s * s * s);
    shells->number[k + 1] = shells->number[k] + whole;
    n += whole * shells->open[k];
  }
  return n;
}

static const double steepest = 0.12; /* growth at which spacings of neighbours differ by a factor of less than 1.15 */

static const double within = 0.01; /* relative error of a number of particles that shells and rays give */

/* STATUS_CONTENT: no growth gives so many particles. Leaves the most of them in the shells. */
static status check_range(struct sph_grading *g, double particles, struct shells *shells, struct error *error) {
  g->growth = steepest;
  const double fewest = count(g, shells);
  g->growth = 0;
  const double most = count(g, shells);
  if (!(particles >= (1 - within) * fewest && particles <= (1 + within) * most))
    return status_fail(
        error, STATUS_CONTENT,
        "spacing from %g m at the point of impact gives %.0f to %.0f particles, not %.0f: give "
        "fidelity.particles within this range, or a %s fine_spacing (where it is not given: %s spacings_per_radius)",
        g->fine, ceil(fewest), floor(most), particles, particles < fewest ? "larger" : "smaller",
        particles < fewest ? "fewer" : "more");
  return STATUS_OK;
}

/* m, distance of the body's farthest place from the point. */
static double farthest(const struct shells *shells) {
  int last = SHELLS - 1;
  while (last > 0 && shells->open[last] == 0)
    last--;
  return shells->r[last + 1];
}

/* The growth that gives so many particles. */
static double growth_of(struct sph_grading g, double particles, struct shells *shells) {
  double low = 0, high = steepest;
  for (int k = 0; k < 60; k++) {
    g.growth = 0.5 * (low + high);
    *(count(&g, shells) > particles ? &low : &high) = g.growth;
  }
  return g.growth;
}

double sph_irregular_coarsest(struct sph_grading grading, const struct sph_shape *shape, double particles) {
  OWNED struct shells *shells = memory_small(1, sizeof *shells);
  cut_shells(&grading, shape, shells);
  grading.growth = growth_of(grading, particles, shells);
  return relax_spacing(&grading, (double[3]){grading.point[0] + farthest(shells), grading.point[1], grading.point[2]});
}

/* The number of particles with the steepest growth that leaves no spacing of the body above `largest`. */
static double count_bounded(struct sph_grading grading, struct shells *shells, double largest) {
  const double far = fmax(0, farthest(shells) - grading.radius);
  grading.growth = fmin(steepest, (largest - grading.fine) * (far + 4 * grading.fine) / (far * far));
  return count(&grading, shells);
}

double sph_irregular_finest(struct sph_grading grading, const struct sph_shape *shape, double particles,
                            double coarsest) {
  OWNED struct shells *shells = memory_small(1, sizeof *shells);
  cut_shells(&grading, shape, shells);
  const double uniform = cbrt(sph_shape_volume(shape) / particles);
  double low = fmin(grading.fine, uniform), high = uniform;
  for (int k = 0; k < 50 && low < high; k++) {
    grading.fine = k == 0 ? low : 0.5 * (low + high);
    *(count_bounded(grading, shells, coarsest * uniform) > particles ? &low : &high) = grading.fine;
  }
  return high;
}

double sph_irregular_least(struct sph_grading grading, const struct sph_shape *shape, double coarsest) {
  OWNED struct shells *shells = memory_small(1, sizeof *shells);
  cut_shells(&grading, shape, shells);
  const double volume = sph_shape_volume(shape);
  double low = 1, high = volume / (grading.fine * grading.fine * grading.fine); /* a uniform body of this spacing */
  for (int k = 0; k < 50 && ceil(low) < ceil(high); k++) {
    const double particles = sqrt(low * high);
    *(count_bounded(grading, shells, coarsest * cbrt(volume / particles)) > particles ? &low : &high) = particles;
  }
  return ceil(high);
}

status sph_irregular_check(struct sph_grading grading, const struct sph_shape *shape, double particles,
                           struct error *error) {
  OWNED struct shells *shells = memory_small(1, sizeof *shells);
  cut_shells(&grading, shape, shells);
  return check_range(&grading, particles, shells, error);
}

/* Decides the growth, if it is not given, and the number of particles. */
static status decide(const struct sph_lattice *lattice, struct sph_grading *g, struct shells *shells, double *n,
                     struct error *error) {
  if (isnan(g->growth)) {
    TRY(check_range(g, lattice->particles, shells, error));
    g->growth = growth_of(*g, lattice->particles, shells);
  } else if (!(g->growth >= 0 && g->growth <= steepest)) {
    return status_fail(error, STATUS_CONTENT,
                       "spacing grows by %g per distance: give 0 to %g, so that neighbours are alike.", g->growth,
                       steepest);
  }
  *n = fmax(1, round(count(g, shells)));
  if (!(*n * 480 < (double)sph_particles_memory()) || *n > 4e9)
    return status_fail(
        error, STATUS_MEMORY,
        "%.4g particles need %.3g GB before the first step; this machine, or the limit set, has %.3g GB.", *n,
        *n * 480 / 1e9, (double)sph_particles_memory() / 1e9);
  return STATUS_OK;
}

/* Sorts the points so that neighbours in space are neighbours in memory; the sequence has no such order. */
static status sort(size_t n, double (*at)[3], struct error *error) {
  OWNED double *column = columns_of(n, at);
  OWNED uint32_t *order = malloc(n * sizeof *order);
  if (!column || !order)
    return no_memory(n, error);
  TRY(sph_hilbert_find(n, column, column + n, column + 2 * n, order, error));
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++)
      at[i][k] = column[k * n + order[i]];
  return STATUS_OK;
}

/* Places n points by a low-discrepancy sequence (Weyl's, with powers of the 3D analogue of the plastic number). Its
 * coordinates are the number within r and the direction. Only points inside the body are kept. Returns how many were
 * found. */
static size_t throw_points(const struct sph_lattice *lattice, const struct sph_shape *shape,
                           const struct shells *shells, size_t n, double (*at)[3]) {
  static const double weyl[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const double whole = shells->number[SHELLS];
  const uint64_t tries = (uint64_t)(4 * whole) + 1000000;
  uint64_t bits[4];
  random_bits(lattice->seed, RANDOM_LATTICE, lattice->body, places, bits);
  size_t i = 0;
  for (uint64_t trial = 0; i < n && trial < tries; trial++) {
    double u[3], d[3];
    for (int k = 0; k < 3; k++)
      u[k] = fmod(random_uniform(bits[k]) + (double)trial * weyl[k], 1);
    const double rank = u[0] * whole;
    int low = 0, high = SHELLS;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      *(shells->number[middle] <= rank ? &low : &high) = middle;
    }
    const double a = shells->r[low], b = shells->r[low + 1];
    const double part = (rank - shells->number[low]) / (shells->number[low + 1] - shells->number[low]);
    const double r = cbrt(a * a * a + part * (b * b * b - a * a * a));
    ray(u[1], u[2], d);
    for (int k = 0; k < 3; k++)
      at[i][k] = lattice->grading.point[k] + r * d[k];
    i += sph_shape_inside(shape, at[i]);
  }
  return i;
}

static status fill_graded(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                          struct error *error) {
  struct sph_lattice graded = *lattice;
  struct sph_grading *g = &graded.grading;
  OWNED struct shells *shells = memory_small(1, sizeof *shells);
  double number = 0;
  cut_shells(g, shape, shells);
  TRY(decide(lattice, g, shells, &number, error));
  const size_t n = (size_t)number;
  OWNED double(*at)[3] = malloc(n * sizeof *at);
  if (!at)
    return no_memory(n, error);
  if (throw_points(lattice, shape, shells, n, at) < n)
    return status_fail(
        error, STATUS_CONTENT,
        "a body is too thin, or too far from its point of impact, for graded particles: set fidelity.graded: false");
  TRY(sort(n, at, error));
  TRY(relax_spread(&graded, shape, g->fine, n, at, error));
  return store(shape, g, n, at, points, error);
}

status sph_irregular_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, double wanted,
                          struct sph_points *points, struct error *error) {
  return lattice->grading.fine > 0 ? fill_graded(lattice, shape, points, error)
                                   : fill_uniform(lattice, shape, wanted, points, error);
}
