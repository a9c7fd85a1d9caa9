/* Distances from a mesh, by a tree of boxes about its faces. */
#include <math.h>
#include <stdlib.h>

#include "engine/mesh/build.h"
#include "engine/vector3.h"

enum { LEAF = 4, DEEPEST = 64 };

struct box {
  double low[3], high[3];
  uint32_t first, count; /* faces of a leaf; count 0: the two boxes from `first` on */
};

struct mesh_tree {
  struct box *box;
  uint32_t *face; /* in the order of the leaves */
};

/* ---- the tree ---- */

struct sorting {
  double middle;
  uint32_t face;
};

static int compare(const void *a, const void *b) {
  const struct sorting *p = a, *q = b;
  return p->middle < q->middle ? -1 : p->middle > q->middle ? 1 : p->face < q->face ? -1 : p->face > q->face;
}

static void surround(const struct mesh *m, const uint32_t *faces, size_t count, struct box *box) {
  for (int k = 0; k < 3; k++) {
    box->low[k] = INFINITY;
    box->high[k] = -INFINITY;
  }
  for (size_t i = 0; i < count; i++)
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) {
        const double x = m->vertex[m->face[faces[i]][c]][k];
        box->low[k] = fmin(box->low[k], x);
        box->high[k] = fmax(box->high[k], x);
      }
}

/* Halves the faces of a box along its longest side until they are few. `used`: boxes so far. */
static void split(const struct mesh *m, struct mesh_tree *tree, uint32_t at, uint32_t first, uint32_t count,
                  uint32_t *used, struct sorting *sorting) {
  struct box *box = &tree->box[at];
  surround(m, tree->face + first, count, box);
  if (count <= LEAF) {
    box->first = first;
    box->count = count;
    return;
  }
  int longest = 0;
  for (int k = 1; k < 3; k++)
    if (box->high[k] - box->low[k] > box->high[longest] - box->low[longest])
      longest = k;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t *corner = m->face[tree->face[first + i]];
    sorting[i].face = tree->face[first + i];
    sorting[i].middle = m->vertex[corner[0]][longest] + m->vertex[corner[1]][longest] + m->vertex[corner[2]][longest];
  }
  qsort(sorting, count, sizeof *sorting, compare);
  for (uint32_t i = 0; i < count; i++)
    tree->face[first + i] = sorting[i].face;
  const uint32_t children = *used;
  box->first = children;
  box->count = 0;
  *used += 2;
  split(m, tree, children, first, count / 2, used, sorting);
  split(m, tree, children + 1, first + count / 2, count - count / 2, used, sorting);
}

status mesh_distance_make(struct mesh *m, struct error *error) {
  struct mesh_tree *tree = m->tree = calloc(1, sizeof *tree);
  struct sorting *sorting = malloc(m->faces * sizeof *sorting);
  if (tree) {
    tree->box = malloc(2 * m->faces * sizeof *tree->box); /* leaves hold two faces or more, but for a lone one */
    tree->face = malloc(m->faces * sizeof *tree->face);
  }
  if (!tree || !sorting || !tree->box || !tree->face) {
    free(sorting);
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  }
  for (size_t f = 0; f < m->faces; f++)
    tree->face[f] = (uint32_t)f;
  uint32_t used = 1;
  split(m, tree, 0, 0, (uint32_t)m->faces, &used, sorting);
  free(sorting);
  return STATUS_OK;
}

void mesh_distance_free(struct mesh_tree *tree) {
  if (!tree)
    return;
  free(tree->box);
  free(tree->face);
  free(tree);
}

/* ---- the nearest point ---- */

/* Moves `nearest` to the point of the edge from a to b if that is nearer to p. */
static void try_edge(const double p[3], const double a[3], const double b[3], double *squares, double nearest[3]) {
  double along[3], from[3], off[3];
  vector3_subtract(b, a, along);
  vector3_subtract(p, a, from);
  const double part = fmax(0, fmin(1, vector3_dot(from, along) / vector3_dot(along, along)));
  for (int k = 0; k < 3; k++)
    off[k] = from[k] - part * along[k];
  const double away = vector3_dot(off, off);
  if (!(away < *squares))
    return;
  *squares = away;
  for (int k = 0; k < 3; k++)
    nearest[k] = a[k] + part * along[k];
}

/* The foot of p on the plane of a face counts if it is left of all its edges; else the nearest point is on an edge. */
static bool try_face(const struct mesh *m, uint32_t face, const double p[3], double *squares, double nearest[3]) {
  const uint32_t *corner = m->face[face];
  const double before = *squares;
  double n[3], from[3], edge[3], left[3];
  bool over = true;
  mesh_normal(m, face, n);
  for (int c = 0; c < 3; c++) {
    const double *a = m->vertex[corner[c]], *b = m->vertex[corner[(c + 1) % 3]];
    vector3_subtract(b, a, edge);
    vector3_subtract(p, a, from);
    vector3_cross(n, edge, left);
    over = over && vector3_dot(left, from) >= 0;
  }
  const double above = vector3_dot(n, from);
  if (over && above * above < *squares) {
    *squares = above * above;
    for (int k = 0; k < 3; k++)
      nearest[k] = p[k] - above * n[k];
  }
  for (int c = 0; c < 3 && !over; c++)
    try_edge(p, m->vertex[corner[c]], m->vertex[corner[(c + 1) % 3]], squares, nearest);
  return *squares < before;
}

static double squares_to(const struct box *box, const double p[3]) {
  double squares = 0;
  for (int k = 0; k < 3; k++) {
    const double out = fmax(0, fmax(box->low[k] - p[k], p[k] - box->high[k]));
    squares += out * out;
  }
  return squares;
}

double mesh_distance(const struct mesh *m, const double p[3], double normal[3]) {
  const struct mesh_tree *tree = m->tree;
  uint32_t stack[DEEPEST], count = 0, face = 0;
  double squares = INFINITY, nearest[3] = {0};
  stack[count++] = 0;
  while (count > 0) {
    const struct box *box = &tree->box[stack[--count]];
    if (squares_to(box, p) >= squares)
      continue;
    for (uint32_t i = 0; i < box->count; i++)
      if (try_face(m, tree->face[box->first + i], p, &squares, nearest))
        face = tree->face[box->first + i];
    if (box->count)
      continue;
    const bool second = squares_to(&tree->box[box->first + 1], p) < squares_to(&tree->box[box->first], p);
    stack[count++] = box->first + !second; /* the search visits the nearer one first */
    stack[count++] = box->first + second;
  }
  const bool inside = mesh_inside(m, p);
  const double distance = sqrt(squares);
  const double rounding = 1e-12 * (m->high[0] - m->low[0] + m->high[1] - m->low[1] + m->high[2] - m->low[2]);
  if (normal && distance > rounding)
    for (int k = 0; k < 3; k++)
      normal[k] = (inside ? nearest[k] - p[k] : p[k] - nearest[k]) / distance;
  else if (normal)
    mesh_normal(m, face, normal);
  return inside ? -distance : distance;
}
