/* Tests whether a point is inside a mesh, by the faces above it, which are listed by columns along z. */
#include <math.h>
#include <stdlib.h>

#include "engine/mesh/build.h"

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

static void count_faces(const struct mesh *m, struct mesh_columns *c) {
  for (size_t f = 0; f < m->faces; f++) {
    size_t low[2], high[2];
    columns_of(m, c, f, low, high);
    for (size_t i = low[0]; i <= high[0]; i++)
      for (size_t j = low[1]; j <= high[1]; j++)
        c->first[i * c->count[1] + j + 2]++;
  }
}

static void fill_faces(const struct mesh *m, struct mesh_columns *c) {
  for (size_t f = 0; f < m->faces; f++) {
    size_t low[2], high[2];
    columns_of(m, c, f, low, high);
    for (size_t i = low[0]; i <= high[0]; i++)
      for (size_t j = low[1]; j <= high[1]; j++)
        c->face[c->first[i * c->count[1] + j + 1]++] = (uint32_t)f;
  }
}

/* Counting sort of the faces by column. Counts stand two places ahead, and become starts one place ahead; filling moves
 * each start to its own place. */
status mesh_inside_make(struct mesh *m, struct error *error) {
  struct mesh_columns *c = m->columns = calloc(1, sizeof *c);
  const size_t total = c ? choose_columns(m, c) : 0, columns = c ? c->count[0] * c->count[1] : 0;
  if (c) {
    c->first = calloc(columns + 2, sizeof *c->first);
    c->face = malloc((total + 1) * sizeof *c->face);
  }
  if (!c || !c->first || !c->face)
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  count_faces(m, c);
  for (size_t i = 2; i <= columns; i++)
    c->first[i] += c->first[i - 1];
  fill_faces(m, c);
  return STATUS_OK;
}

void mesh_inside_free(struct mesh_columns *columns) {
  if (!columns)
    return;
  free(columns->first);
  free(columns->face);
  free(columns);
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

status mesh_inside_check(const struct mesh *m, const struct mesh_soup *soup, struct error *error) {
  const struct mesh_columns *c = m->columns;
  size_t longest = 1;
  for (size_t i = 0; i < c->count[0] * c->count[1]; i++)
    longest = c->first[i + 1] - c->first[i] > longest ? c->first[i + 1] - c->first[i] : longest;
  struct meeting *meetings = malloc(longest * sizeof *meetings);
  if (!meetings)
    return status_fail(error, STATUS_MEMORY, "no memory for a mesh of %zu faces", m->faces);
  status code = STATUS_OK;
  for (size_t f = 0; f < m->faces && !code; f++) {
    const double *a = m->vertex[m->face[f][0]], *b = m->vertex[m->face[f][1]], *d = m->vertex[m->face[f][2]];
    const double p[2] = {(a[0] + b[0] + d[0]) / 3, (a[1] + b[1] + d[1]) / 3};
    if (!in_turn(m, p, meetings))
      code = mesh_refuse(soup, soup->line[f], error,
                         "the surface cuts itself, or a part of it is inside out: along the line x = %g, y = %g "
                         "through this face one enters it twice (Blender: join overlapping parts by a boolean union)",
                         p[0] + m->centre[0], p[1] + m->centre[1]);
  }
  free(meetings);
  return code;
}
