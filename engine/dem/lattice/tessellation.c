/* Joins cells that were cut one by one into one planar subdivision: corners that coincide become one, so that
 * neighbours share their vertices to the last bit and a body at rest has no overlap. */
#include "engine/dem/lattice/tessellation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/dem/lattice/lattice.h"
#include "engine/grow.h"

/* Corners nearer than this (in spacings) are one. Rounding puts the same corner at most some 1e-14 apart at coordinates
 * below 100; a true side is this short in one of 1e10 pairs. */
static const double same_corner = 1e-10;

struct corners { /* unique corners, found through the grid square that they lie in */
  uint32_t columns, rows;
  uint32_t *head, *next; /* lists by square; index + 1, 0 ends */
  struct dem_point *at;
  size_t count, capacity;
};

static uint32_t *corner_list(struct corners *corners, double x, double y) {
  double column = fmin(fmax(floor(x), 0), corners->columns - 1), row = fmin(fmax(floor(y), 0), corners->rows - 1);
  return &corners->head[(size_t)row * corners->columns + (size_t)column];
}

/* Index of the corner at p, which is added if it is new; UINT32_MAX: no memory. */
static uint32_t corner_find(struct corners *corners, struct dem_point p) {
  uint32_t *seen[4] = {0};
  for (int k = 0; k < 4; k++) {
    uint32_t *list = corner_list(corners, p.x + (k & 1 ? same_corner : -same_corner),
                                 p.y + (k & 2 ? same_corner : -same_corner));
    if (list == seen[0] || list == seen[1] || list == seen[2])
      continue;
    seen[k] = list;
    for (uint32_t c = *list; c; c = corners->next[c - 1])
      if (fabs(corners->at[c - 1].x - p.x) <= same_corner && fabs(corners->at[c - 1].y - p.y) <= same_corner)
        return c - 1;
  }
  if (corners->count == corners->capacity) {
    size_t capacity = 2 * corners->capacity + 64;
    if (!grow_block(&corners->at, capacity * sizeof *corners->at) ||
        !grow_block(&corners->next, capacity * sizeof *corners->next))
      return UINT32_MAX;
    corners->capacity = capacity;
  }
  uint32_t *list = corner_list(corners, p.x, p.y);
  uint32_t c = (uint32_t)corners->count++;
  corners->at[c] = p;
  corners->next[c] = *list;
  *list = c + 1;
  return c;
}

/* Area, centroid and second moment about the centroid of a polygon, relative to its first vertex. */
static void measure(const struct dem_point *vertex, size_t n, double *area, struct dem_point *centroid,
                    double *moment) {
  double a = 0, cx = 0, cy = 0, m = 0;
  for (size_t k = 1; k + 1 < n; k++) {
    double px = vertex[k].x - vertex[0].x, py = vertex[k].y - vertex[0].y;
    double qx = vertex[k + 1].x - vertex[0].x, qy = vertex[k + 1].y - vertex[0].y;
    double cross = px * qy - py * qx;
    a += cross;
    cx += cross * (px + qx);
    cy += cross * (py + qy);
    m += cross * (px * px + px * qx + qx * qx + py * py + py * qy + qy * qy);
  }
  *area = a / 2;
  cx /= 3 * a;
  cy /= 3 * a;
  *centroid = (struct dem_point){vertex[0].x + cx, vertex[0].y + cy};
  *moment = m / 12 - *area * (cx * cx + cy * cy);
}

struct builder {
  const struct dem_lattice *lattice;
  struct dem_lattice_points points;
  struct corners corners;
  struct dem_tessellation *out;
  size_t cell_capacity, vertex_capacity, pair_capacity;
  uint32_t *number; /* by lattice point: cell number, or UINT32_MAX */
  int64_t *across;  /* by vertex: what lies beyond the side that starts there */
  double ox, oy;    /* lattice coordinates of the world's origin of the body */
};

static struct dem_point world(const struct builder *b, struct dem_point p) {
  return (struct dem_point){b->lattice->origin.x + b->lattice->spacing * (p.x - b->ox),
                            b->lattice->origin.y + b->lattice->spacing * (p.y - b->oy)};
}

/* Cuts the cell of one lattice point and appends it if it belongs to the body. False: no memory. */
static bool add_cell(struct builder *b, uint32_t column, uint32_t row) {
  struct dem_tessellation *t = b->out;
  int64_t i = (int64_t)row * b->points.columns + column;
  b->number[i] = UINT32_MAX;
  if (b->lattice->outline == DEM_OUTLINE_DISC) { /* a centroid lies at most sqrt(2) spacings from its point */
    double reach = b->lattice->radius / b->lattice->spacing + 1.5;
    double x = b->points.point[i].x - b->ox, y = b->points.point[i].y - b->oy;
    if (x * x + y * y > reach * reach)
      return true;
  }
  struct dem_lattice_cell cell;
  if (!dem_lattice_cell(&b->points, column, row, &cell))
    return false;
  uint32_t corner[DEM_LATTICE_CORNERS];
  for (int k = 0; k < cell.count; k++) {
    corner[k] = corner_find(&b->corners,
                            dem_lattice_corner(&b->points, i, cell.across[k], cell.across[k ? k - 1 : cell.count - 1]));
    if (corner[k] == UINT32_MAX)
      return false;
  }
  size_t start = t->first_vertex[t->cell_count], n = 0;
  size_t need = start + (size_t)cell.count, capacity = b->vertex_capacity;
  if (!grow_room(&t->vertex, &capacity, need, sizeof *t->vertex) ||
      !grow_room(&b->across, &b->vertex_capacity, need, sizeof *b->across))
    return false;
  for (int k = 0; k < cell.count; k++) /* leave out a side whose ends are the same corner */
    if (corner[k] != corner[k + 1 < cell.count ? k + 1 : 0]) {
      t->vertex[start + n] = world(b, b->corners.at[corner[k]]);
      b->across[start + n++] = cell.across[k];
    }
  size_t c = t->cell_count;
  measure(t->vertex + start, n, &t->area[c], &t->centroid[c], &t->polar_moment[c]);
  if (b->lattice->outline == DEM_OUTLINE_DISC &&
      hypot(t->centroid[c].x - b->lattice->origin.x, t->centroid[c].y - b->lattice->origin.y) > b->lattice->radius)
    return true;
  t->grid_x[c] = column - b->points.centre;
  t->grid_y[c] = row - b->points.centre;
  b->number[i] = (uint32_t)c;
  t->cell_count++;
  t->first_vertex[c + 1] = (uint32_t)(start + n);
  return true;
}

static int by_second(const void *a, const void *b) {
  const uint32_t *p = a, *q = b;
  return p[0] < q[0] ? -1 : p[0] > q[0];
}

/* Pairs (first < second, sorted) from the sides that face another cell of the body. */
static bool add_pairs(struct builder *b) {
  struct dem_tessellation *t = b->out;
  for (uint32_t c = 0; c < t->cell_count; c++) {
    uint32_t start = t->first_vertex[c], end = t->first_vertex[c + 1];
    uint32_t found[DEM_LATTICE_CORNERS][2]; /* the other cell, the side's first vertex */
    size_t count = 0;
    for (uint32_t k = start; k < end; k++)
      if (b->across[k] >= 0 && b->number[b->across[k]] != UINT32_MAX && b->number[b->across[k]] > c) {
        found[count][0] = b->number[b->across[k]];
        found[count++][1] = k;
      }
    qsort(found, count, sizeof found[0], by_second);
    size_t capacity = b->pair_capacity;
    if (!grow_room(&t->pair, &capacity, t->pair_count + count, sizeof *t->pair) ||
        !grow_room(&t->side, &b->pair_capacity, t->pair_count + count, sizeof *t->side))
      return false;
    for (size_t f = 0; f < count; f++) {
      const struct dem_point *p = &t->vertex[found[f][1]];
      const struct dem_point *q = &t->vertex[found[f][1] + 1 < end ? found[f][1] + 1 : start];
      t->pair[t->pair_count][0] = c;
      t->pair[t->pair_count][1] = found[f][0];
      t->side[t->pair_count++] = hypot(q->x - p->x, q->y - p->y);
    }
  }
  return true;
}

static bool allocate(struct dem_tessellation *t, size_t cells) {
  size_t n = cells ? cells : 1;
  t->first_vertex = calloc(n + 1, sizeof *t->first_vertex);
  t->centroid = malloc(n * sizeof *t->centroid);
  t->area = malloc(n * sizeof *t->area);
  t->polar_moment = malloc(n * sizeof *t->polar_moment);
  t->grid_x = malloc(n * sizeof *t->grid_x);
  t->grid_y = malloc(n * sizeof *t->grid_y);
  return t->first_vertex && t->centroid && t->area && t->polar_moment && t->grid_x && t->grid_y;
}

status dem_tessellation_make(const struct dem_lattice *lattice, struct dem_tessellation **out, struct error *error) {
  *out = NULL;
  struct builder b = {.lattice = lattice};
  status code = STATUS_OK;
  double squares = lattice->outline == DEM_OUTLINE_DISC ? 4 * pow(lattice->radius / lattice->spacing + 8, 2)
                                                        : (double)lattice->columns * lattice->rows;
  if (!(squares >= 1 && squares < 1e8))
    return status_fail(error, STATUS_CONTENT,
                       "a body of %.3g grains cannot be made: change its size or the grain spacing", squares);
  code = dem_lattice_fill(lattice, &b.points, error);
  if (code)
    return code;
  size_t n = (size_t)b.points.columns * b.points.rows;
  bool fits = false;
  b.ox = lattice->outline == DEM_OUTLINE_DISC ? 0.5 * b.points.columns : 0;
  b.oy = lattice->outline == DEM_OUTLINE_DISC ? 0.5 * b.points.rows : 0;
  b.corners = (struct corners){.columns = b.points.columns, .rows = b.points.rows};
  b.corners.head = calloc(n, sizeof *b.corners.head);
  b.number = malloc(n * sizeof *b.number);
  b.out = calloc(1, sizeof *b.out);
  if (!b.corners.head || !b.number || !b.out || !allocate(b.out, n))
    goto cleanup;
  for (uint32_t row = 0; row < b.points.rows; row++)
    for (uint32_t column = 0; column < b.points.columns; column++)
      if (!add_cell(&b, column, row))
        goto cleanup;
  if (!add_pairs(&b))
    goto cleanup;
  fits = true;
  if (b.out->cell_count == 0)
    code = status_fail(error, STATUS_CONTENT, "no grain lies within the body: give a grain spacing below its size");
cleanup:
  if (!fits)
    code = status_fail(error, STATUS_MEMORY, "no memory for a body of %zu grains", n);
  if (!code) {
    *out = b.out;
    b.out = NULL;
  }
  dem_tessellation_free(b.out);
  free(b.points.point);
  free(b.corners.head);
  free(b.corners.next);
  free(b.corners.at);
  free(b.number);
  free(b.across);
  return code;
}

status dem_tessellation_join(const struct dem_tessellation *a, const struct dem_tessellation *b,
                             struct dem_tessellation **out, struct error *error) {
  *out = NULL;
  struct dem_tessellation *t = calloc(1, sizeof *t);
  size_t cells = a->cell_count + b->cell_count, pairs = a->pair_count + b->pair_count;
  uint32_t na = (uint32_t)a->cell_count, va = a->first_vertex[na], vb = b->first_vertex[b->cell_count];
  bool fits = t && allocate(t, cells);
  if (fits) {
    t->vertex = malloc((size_t)(va + vb) * sizeof *t->vertex);
    t->pair = malloc((pairs ? pairs : 1) * sizeof *t->pair);
    t->side = malloc((pairs ? pairs : 1) * sizeof *t->side);
  }
  if (!fits || !t->vertex || !t->pair || !t->side) {
    dem_tessellation_free(t);
    return status_fail(error, STATUS_MEMORY, "no memory for a body of %zu grains", cells);
  }
  t->cell_count = cells;
  t->pair_count = pairs;
  t->joined_at = na;
  const struct dem_tessellation *part[2] = {a, b};
  for (int p = 0; p < 2; p++) {
    uint32_t cell = p ? na : 0, vertex = p ? va : 0;
    size_t pair = p ? a->pair_count : 0, n = part[p]->cell_count;
    memcpy(t->vertex + vertex, part[p]->vertex, part[p]->first_vertex[n] * sizeof *t->vertex);
    memcpy(t->centroid + cell, part[p]->centroid, n * sizeof *t->centroid);
    memcpy(t->area + cell, part[p]->area, n * sizeof *t->area);
    memcpy(t->polar_moment + cell, part[p]->polar_moment, n * sizeof *t->polar_moment);
    memcpy(t->grid_x + cell, part[p]->grid_x, n * sizeof *t->grid_x);
    memcpy(t->grid_y + cell, part[p]->grid_y, n * sizeof *t->grid_y);
    for (size_t c = 0; c <= n; c++)
      t->first_vertex[cell + c] = vertex + part[p]->first_vertex[c];
    for (size_t k = 0; k < part[p]->pair_count; k++) {
      t->pair[pair + k][0] = cell + part[p]->pair[k][0];
      t->pair[pair + k][1] = cell + part[p]->pair[k][1];
      t->side[pair + k] = part[p]->side[k];
    }
  }
  *out = t;
  return STATUS_OK;
}

void dem_tessellation_free(struct dem_tessellation *t) {
  if (!t)
    return;
  free(t->first_vertex);
  free(t->vertex);
  free(t->centroid);
  free(t->area);
  free(t->polar_moment);
  free(t->grid_x);
  free(t->grid_y);
  free(t->pair);
  free(t->side);
  free(t);
}
