/* Where a point is: inside a mesh or outside, and how far from it; where the line upwards leaves it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/mesh/build.h"
#include "engine/vector3.h"
#include "schemas/memory.h"

/* Squares in the x-y plane, and the faces above or below each. */
struct mesh_columns {
  size_t count[2];
  double low[2], wide[2];
  size_t *first; /* of count[0] * count[1] + 1 */
  uint32_t *face;
};

static size_t column(const struct mesh_columns *c, int k, double x) {
  const double at = floor((x - c->low[k]) / c->wide[k]);
  return at >= (double)c->count[k] ? c->count[k] - 1 : at > 0 ? (size_t)at : 0;
}

/* The columns from low to high, inclusive, that a face may touch. */
static void columns_of(const struct mesh *m, const struct mesh_columns *c, size_t face, size_t low[2], size_t high[2]) {
  const uint32_t *corner = m->face[face];
  for (int k = 0; k < 2; k++) {
    const double x[3] = {m->vertex[corner[0]][k], m->vertex[corner[1]][k], m->vertex[corner[2]][k]};
    low[k] = column(c, k, fmin(x[0], fmin(x[1], x[2])));
    high[k] = column(c, k, fmax(x[0], fmax(x[1], x[2])));
  }
}

/* About as many columns as faces; fewer where large faces would be in the lists of too many columns. */
static size_t choose_columns(const struct mesh *m, struct mesh_columns *c) {
  const double x = m->high[0] - m->low[0], y = m->high[1] - m->low[1];
  for (double wide = sqrt(x * y / (double)(m->faces + 1));; wide *= 2) {
    for (int k = 0; k < 2; k++) {
      const double extent = m->high[k] - m->low[k];
      c->low[k] = m->low[k];
      c->count[k] = (size_t)fmin(1024, fmax(1, ceil(extent / wide)));
      c->wide[k] = extent / (double)c->count[k];
    }
    size_t total = 0;
    for (size_t f = 0; f < m->faces; f++) {
      size_t low[2], high[2];
      columns_of(m, c, f, low, high);
      total += (high[0] - low[0] + 1) * (high[1] - low[1] + 1);
    }
    if (total <= 16 * m->faces + 64 || c->count[0] * c->count[1] == 1)
      return total;
  }
}

/* Counts the faces of each column, or fills them in. */
static void sort_faces(const struct mesh *m, struct mesh_columns *c, bool fill) {
  for (size_t f = 0; f < m->faces; f++) {
    size_t low[2], high[2];
    columns_of(m, c, f, low, high);
    for (size_t i = low[0]; i <= high[0]; i++)
      for (size_t j = low[1]; j <= high[1]; j++) {
        size_t *const first = &c->first[i * c->count[1] + j];
        if (fill)
          c->face[first[1]++] = (uint32_t)f;
        else
          first[2]++;
      }
  }
}

/* Counting sort of the faces by column. Counts stand two places ahead, and become starts one place ahead; filling moves
 * each start to its own place. */
static status list_faces(struct mesh *m, struct error *error) {
  struct mesh_columns *c = m->columns = memory_small(1, sizeof *c);
  const size_t total = choose_columns(m, c), columns = c->count[0] * c->count[1];
  c->first = calloc(columns + 2, sizeof *c->first);
  c->face = malloc((total + 1) * sizeof *c->face);
  if (!c->first || !c->face)
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  sort_faces(m, c, false);
  for (size_t i = 2; i <= columns; i++)
    c->first[i] += c->first[i - 1];
  sort_faces(m, c, true);
  return STATUS_OK;
}

/* +1 or -1: the edge from vertex a to b crosses, up or down along y, the ray from p along x. Both faces of an edge do
 * the same sum, so that they agree for any rounding. */
static int crossing(const struct mesh *m, uint32_t a, uint32_t b, const double p[2]) {
  const double *from = m->vertex[a], *to = m->vertex[b];
  const bool rises = to[1] > p[1];
  if ((from[1] > p[1]) == rises)
    return 0;
  const double *low = m->vertex[a < b ? a : b], *high = m->vertex[a < b ? b : a];
  const double x = low[0] + (p[1] - low[1]) * ((high[0] - low[0]) / (high[1] - low[1]));
  const double within = fmax(fmin(low[0], high[0]), fmin(x, fmax(low[0], high[0])));
  return within > p[0] ? (rises ? 1 : -1) : 0;
}

/* +1 or -1 for a face that the line through p along z meets from inside or from outside, seen from below; 0: it does
 * not. */
static int turn(const struct mesh *m, const uint32_t corner[3], const double p[2]) {
  return crossing(m, corner[0], corner[1], p) + crossing(m, corner[1], corner[2], p) +
         crossing(m, corner[2], corner[0], p);
}

/* z of the face's plane above p, within the face. */
static double height(const struct mesh *m, const uint32_t corner[3], const double p[2]) {
  const double *a = m->vertex[corner[0]], *b = m->vertex[corner[1]], *c = m->vertex[corner[2]];
  const double low = fmin(a[2], fmin(b[2], c[2])), high = fmax(a[2], fmax(b[2], c[2]));
  const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  if (n[2] == 0)
    return 0.5 * (low + high);
  const double z = a[2] - (n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1])) / n[2];
  return fmax(low, fmin(z, high));
}

bool mesh_inside(const struct mesh *m, const double p[3]) {
  for (int k = 0; k < 3; k++)
    if (!(p[k] > m->low[k] && p[k] < m->high[k]))
      return false;
  const struct mesh_columns *c = m->columns;
  const size_t at = column(c, 0, p[0]) * c->count[1] + column(c, 1, p[1]);
  int around = 0;
  for (size_t i = c->first[at]; i < c->first[at + 1]; i++) {
    const uint32_t *corner = m->face[c->face[i]];
    const int turned = turn(m, corner, p);
    if (turned && height(m, corner, p) > p[2])
      around += turned;
  }
  return around > 0;
}

bool mesh_top(const struct mesh *m, double point[3], double normal[3]) {
  const double centre[2] = {0, 0};
  double last = 0;
  for (uint32_t f = 0; f < m->faces; f++) {
    double n[3];
    if (turn(m, m->face[f], centre) <= 0)
      continue;
    mesh_normal(m, f, n);
    const double z = vector3_dot(n, m->vertex[m->face[f][0]]) / n[2];
    if (!(n[2] > 0) || !(z > last))
      continue;
    last = z;
    memcpy(normal, n, sizeof n);
  }
  memcpy(point, (const double[]){0, 0, last}, sizeof(double[3]));
  return last > 0;
}

/* ---- a surface that cuts itself ---- */

struct meeting {
  double z;
  int turn;
};

static int compare_meetings(const void *a, const void *b) {
  const struct meeting *p = a, *q = b;
  return p->z < q->z ? 1 : p->z > q->z ? -1 : p->turn - q->turn;
}

/* Follows the line through p from above: it must be outside and inside in turn. Faces that meet, within rounding, count
 * together. */
static bool in_turn(const struct mesh *m, const double p[2], struct meeting *meetings) {
  const struct mesh_columns *c = m->columns;
  const size_t at = column(c, 0, p[0]) * c->count[1] + column(c, 1, p[1]);
  const double together = 1e-9 * (m->high[2] - m->low[2]);
  size_t count = 0;
  for (size_t i = c->first[at]; i < c->first[at + 1]; i++) {
    const uint32_t *corner = m->face[c->face[i]];
    const int turned = turn(m, corner, p);
    if (turned)
      meetings[count++] = (struct meeting){height(m, corner, p), turned};
  }
  qsort(meetings, count, sizeof *meetings, compare_meetings);
  int around = 0;
  for (size_t i = 0; i < count; i++) {
    around += meetings[i].turn;
    const bool last = i + 1 == count || meetings[i].z - meetings[i + 1].z > together;
    if (last && (around < 0 || around > 1))
      return false;
  }
  return true;
}

static status check_turns(const struct mesh *m, const struct mesh_soup *soup, struct error *error) {
  const struct mesh_columns *c = m->columns;
  size_t longest = 1;
  for (size_t i = 0; i < c->count[0] * c->count[1]; i++)
    longest = c->first[i + 1] - c->first[i] > longest ? c->first[i + 1] - c->first[i] : longest;
  OWNED struct meeting *meetings = malloc(longest * sizeof *meetings);
  if (!meetings)
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  for (size_t f = 0; f < m->faces; f++) {
    const double *a = m->vertex[m->face[f][0]], *b = m->vertex[m->face[f][1]], *d = m->vertex[m->face[f][2]];
    const double p[2] = {(a[0] + b[0] + d[0]) / 3, (a[1] + b[1] + d[1]) / 3};
    if (!in_turn(m, p, meetings))
      return mesh_refuse(soup, soup->line[f], error,
                         "the surface cuts itself, or a part of it is inside out: along the line x = %g, y = %g "
                         "through this face one enters it twice (Blender: join overlapping parts by a boolean union)",
                         p[0] + m->centre[0], p[1] + m->centre[1]);
  }
  return STATUS_OK;
}

/* ---- distances, by a tree of boxes about the faces ---- */

enum { LEAF = 4, DEEPEST = 64 };

struct box {
  double low[3], high[3];
  uint32_t first, count; /* faces of a leaf; count 0: the two boxes from `first` on */
};

struct mesh_tree {
  struct box *box;
  uint32_t *face; /* in the order of the leaves */
};

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

static status make_tree(struct mesh *m, struct error *error) {
  struct mesh_tree *tree = m->tree = memory_small(1, sizeof *tree);
  OWNED struct sorting *sorting = malloc(m->faces * sizeof *sorting);
  tree->box = malloc(2 * m->faces * sizeof *tree->box); /* leaves hold two faces or more, but for a lone one */
  tree->face = malloc(m->faces * sizeof *tree->face);
  if (!sorting || !tree->box || !tree->face)
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  for (size_t f = 0; f < m->faces; f++)
    tree->face[f] = (uint32_t)f;
  uint32_t used = 1;
  split(m, tree, 0, 0, (uint32_t)m->faces, &used, sorting);
  return STATUS_OK;
}

status mesh_search_make(struct mesh *m, const struct mesh_soup *soup, struct error *error) {
  TRY(list_faces(m, error));
  TRY(check_turns(m, soup, error));
  return make_tree(m, error);
}

void mesh_search_free(struct mesh *m) {
  if (m->columns) {
    free(m->columns->first);
    free(m->columns->face);
  }
  if (m->tree) {
    free(m->tree->box);
    free(m->tree->face);
  }
  free(m->columns);
  free(m->tree);
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
