/* Pushes irregular points apart (irregular.h). */
#include "engine/sph/body/irregular.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "engine/sph/body/kd_tree.h"

/* Found by trial: 24 rounds with steps that fall from 5 to 1 scatter as little as 200 small ones; with steps of 8
 * points do not settle. Graded points start less evenly. */
enum { ROUNDS = 24, ROUNDS_GRADED = 40, ROUNDS_PER_LIST = 4 };
static const double first_step = 5, last_step = 1, longest_move = 0.3; /* of s */
static const double reach = 2, skin = 0.4;                             /* of s */
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

double sph_relax_spacing(const struct sph_grading *g, const double p[3]) {
  const double r[3] = {p[0] - g->point[0], p[1] - g->point[1], p[2] - g->point[2]};
  const double d = fmax(0, sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) - g->radius);
  return g->fine + g->growth * d * d / (d + 4 * g->fine);
}

static double wanted(const struct work *w, const double p[3]) {
  return w->lattice->grading.fine > 0 ? sph_relax_spacing(&w->lattice->grading, p) : w->spacing;
}

/* Appends the neighbours of p, which is one periodic image of a point, to the list. */
static bool append(struct work *w, const struct sph_kd_tree *tree, const double p[3], double radius, size_t *total) {
  size_t found = sph_kd_tree_within(tree, p, radius, w->list + *total, w->capacity - *total);
  if (found > w->capacity - *total) {
    const size_t capacity = w->capacity + w->capacity / 2 + found;
    uint32_t *grown = realloc(w->list, capacity * sizeof *grown);
    if (!grown)
      return false;
    w->list = grown;
    w->capacity = capacity;
    found = sph_kd_tree_within(tree, p, radius, w->list + *total, w->capacity - *total);
  }
  *total += found;
  return true;
}

static bool list_images(struct work *w, const struct sph_kd_tree *tree, size_t i, size_t *total) {
  const double radius = (reach + skin) * w->s[i];
  for (int image = 0; image < 27; image++) {
    const int shift[3] = {(image + 1) % 3 - 1, (image / 3 + 1) % 3 - 1,
                          (image / 9 + 1) % 3 - 1}; /* the first is the point itself */
    double p[3];
    bool near = true;
    for (int k = 0; k < 3; k++) {
      p[k] = w->at[i][k] + shift[k] * w->length[k];
      if (shift[k])
        near &= w->length[k] > 0 && p[k] > -radius && p[k] < w->length[k] + radius;
    }
    if (near && !append(w, tree, p, radius, total))
      return false;
  }
  return true;
}

/* Lists the neighbours of all points. */
static status list(struct work *w, struct error *error) {
  struct sph_kd_tree *tree = NULL;
  double *column = malloc(3 * w->n * sizeof *column);
  if (!column)
    return status_fail(error, STATUS_MEMORY, "no memory to spread %zu particles", w->n);
  for (size_t i = 0; i < w->n; i++)
    for (size_t k = 0; k < 3; k++)
      column[k * w->n + i] = w->at[i][k];
  status code = sph_kd_tree_create(w->n, column, column + w->n, column + 2 * w->n, &tree, error);
  if (code)
    goto cleanup;

  size_t total = 0;
  for (size_t i = 0; i < w->n; i++) {
    w->first[i] = total;
    if (!list_images(w, tree, i, &total)) {
      code = status_fail(error, STATUS_MEMORY, "no memory to spread %zu particles", w->n);
      goto cleanup;
    }
  }
  w->first[w->n] = total;
cleanup:
  sph_kd_tree_free(tree);
  free(column);
  return code;
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
  const double over = 1 / (reach * w->s[i]);
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
  const double each = 1 / (reach * reach * reach * w->s[i]);
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
    const double both = 0.5 * reach * (w->s[i] + w->s[j]);
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

status sph_relax_spread(const struct sph_lattice *lattice, const struct sph_shape *shape, double spacing, size_t n,
                        double (*at)[3], struct error *error) {
  struct work w = {.lattice = lattice, .shape = shape, .n = n, .spacing = spacing, .at = at, .capacity = 64 * n + 64};
  status code = STATUS_OK;
  for (int k = 0; k < 3; k++)
    if (lattice->periodic[k])
      w.length[k] = shape->kind == SPH_SHAPE_BOX ? shape->side[k] : shape->length;
  w.push = malloc(n * sizeof *w.push);
  w.s = malloc(n * sizeof *w.s);
  w.first = malloc((n + 1) * sizeof *w.first);
  w.list = malloc(w.capacity * sizeof *w.list);
  if (!w.push || !w.s || !w.first || !w.list) {
    code = status_fail(error, STATUS_MEMORY, "no memory to spread %zu particles", n);
    goto cleanup;
  }
  for (size_t i = 0; i < n; i++) {
    w.s[i] = wanted(&w, at[i]);
    confine(&w, at[i], w.s[i]);
  }
  const int rounds = lattice->grading.fine > 0 ? ROUNDS_GRADED : ROUNDS;
  for (int k = 0; k < rounds; k++) {
    if (k % ROUNDS_PER_LIST == 0) {
      code = list(&w, error);
      if (code)
        goto cleanup;
    }
    round_of(&w, first_step * pow(last_step / first_step, (double)k / (rounds - 1)));
  }
cleanup:
  free(w.push);
  free(w.s);
  free(w.first);
  free(w.list);
  return code;
}
