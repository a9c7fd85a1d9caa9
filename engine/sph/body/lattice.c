/* The number of particles, and boxes fitted with whole rows. Other shapes are cut out of a lattice (lattice_cut.c). */
#include "engine/sph/body/lattice.h"

#include <math.h>
#include <stdlib.h>

#include "engine/sph/body/irregular.h"
#include "engine/sph/body/lattice_cell.h"
#include "engine/sph/body/particles.h"

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

status sph_lattice_too_thin(double wanted, double spacing, struct error *error) {
  return status_fail(
      error, STATUS_CONTENT,
      "a body is too thin for %.0f particles of spacing %.3g m: raise fidelity.particles, or take a thicker body",
      wanted, spacing);
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
    return sph_lattice_too_thin(wanted, cbrt(sph_shape_volume(box) / wanted), error);
  status code = sph_lattice_allocate(points, (size_t)n, error);
  if (code)
    return code;
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

/* What cannot repeat in any direction; NULL: it can. */
static const char *not_periodic(const struct sph_lattice *lattice, const struct sph_shape *shape) {
  if (lattice->grading.fine > 0)
    return "a graded body";
  if (lattice->turned)
    return "a turned lattice";
  switch (shape->kind) {
  case SPH_SHAPE_SPHERE: return "a sphere";
  case SPH_SHAPE_MESH: return "a mesh";
  default: return NULL;
  }
}

static status check_periodic(const struct sph_lattice *lattice, const struct sph_shape *shape, int k,
                             struct error *error) {
  const double unit[3] = {k == 0, k == 1, k == 2}, half = sph_shape_reach(shape, unit), *axis = shape->axis;
  const char name = "xyz"[k];
  const char *what = not_periodic(lattice, shape);
  if (what)
    return status_fail(error, STATUS_CONTENT, "%s cannot repeat along %c: use a box, or a cylinder along it.", what,
                       name);
  if (shape->kind == SPH_SHAPE_CYLINDER && (axis[(k + 1) % 3] != 0 || axis[(k + 2) % 3] != 0))
    return status_fail(error, STATUS_CONTENT, "a cylinder can repeat along its axis only, not along %c.", name);
  if (fabs(shape->centre[k] - half) > 1e-9 * half)
    return status_fail(error, STATUS_CONTENT,
                       "a body that repeats along %c begins at 0 there: its centre must be at %g m, not %g m.", name,
                       half, shape->centre[k]);
  return STATUS_OK;
}

/* The number of particles of a body without grading. */
static status decide(const struct sph_lattice *lattice, double volume, double *wanted, struct error *error) {
  const double s = lattice->spacing, bytes = lattice->kind == SPH_LATTICE_IRREGULAR ? 640 : 160;
  *wanted = lattice->particles;
  if (isnan(*wanted)) {
    if (!(s > 0 && isfinite(s)))
      return status_fail(error, STATUS_CONTENT,
                         "the spacing of particles is %g m: give a positive length, or a number.", s);
    *wanted = volume / s / s / s;
    if (!(*wanted >= 0.5))
      return status_fail(error, STATUS_CONTENT,
                         "particles of spacing %g m are larger than their body of %g m^3: give a smaller spacing.", s,
                         volume);
  }
  if (!(*wanted >= 0.5))
    return status_fail(error, STATUS_CONTENT, "a body of %g particles: give at least one.", *wanted);
  if (!(*wanted * bytes < (double)sph_particles_memory()) || *wanted > 4e9)
    return status_fail(
        error, STATUS_MEMORY,
        "%.4g particles need %.3g GB before the first step; this machine, or the limit set, has %.3g GB.", *wanted,
        *wanted * bytes / 1e9, (double)sph_particles_memory() / 1e9);
  *wanted = fmax(1, round(*wanted));
  return STATUS_OK;
}

static status check_all_periodic(const struct sph_lattice *lattice, const struct sph_shape *shape,
                                 struct error *error) {
  for (int k = 0; k < 3; k++) {
    const status code = lattice->periodic[k] ? check_periodic(lattice, shape, k, error) : STATUS_OK;
    if (code)
      return code;
  }
  return STATUS_OK;
}

static status fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                   struct error *error) {
  const bool graded = lattice->grading.fine > 0;
  double wanted = 0;
  status code = sph_shape_check(shape, error);
  if (!code && !graded)
    code = decide(lattice, sph_shape_volume(shape), &wanted, error);
  if (!code)
    code = check_all_periodic(lattice, shape, error);
  if (code)
    return code;
  if (lattice->kind == SPH_LATTICE_IRREGULAR || graded)
    return sph_irregular_fill(lattice, shape, wanted, points, error);

  const struct sph_lattice_cell *cell = &cells[lattice->kind];
  if (shape->kind == SPH_SHAPE_BOX && !lattice->turned)
    code = fill_box(lattice, cell, shape, wanted, points, error);
  else
    code = sph_lattice_cut_fill(lattice, cell, shape, wanted, points, error);
  points->nearest = points->spacing * (lattice->kind == SPH_LATTICE_HEXAGONAL ? hexagonal : 1);
  return code;
}

status sph_lattice_fill(const struct sph_lattice *lattice, const struct sph_shape *shape, struct sph_points *points,
                        struct error *error) {
  *points = (struct sph_points){0};
  const status code = fill(lattice, shape, points, error);
  if (code)
    sph_lattice_empty(points);
  return code;
}
