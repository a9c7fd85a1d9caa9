/* Grains of a body: points of a random lattice, the Voronoi cell of each, and the cells joined into one planar
 * subdivision. */
#include "engine/dem/lattice/tessellation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/grow.h"
#include "engine/random.h"
#include "schemas/memory.h"

/* ---- points and cells, in lattice units (spacing 1) ----
 *
 * One point per grid square, drawn uniformly from the concentric square of side `disorder` (K99 section 2.1: "randomly
 * and independently in each square of the grid with a maximal distance a from the center", a between 0 and the
 * spacing). K99 does not say whether that region is a disc or a square. A disc of radius a = spacing would leave the
 * grid square, against "in each square"; the square of side a = spacing fills it exactly, so the region is that square.
 * No place in the plane is then farther than sqrt(2) from a point. Hence a cell reaches at most sqrt(2) from its point,
 * and neighbours lie at most three squares apart. */

enum { CELL_CORNERS = 40 };

/* A cell while it is cut: corners counter-clockwise relative to its point; `across` identifies the neighbour beyond the
 * side from corner k to k + 1: the index of another point, or -1..-4 for the left, lower, right, upper wall. */
struct cell {
  int count;
  double x[CELL_CORNERS], y[CELL_CORNERS];
  int64_t across[CELL_CORNERS];
};

enum { BEYOND = 6 }; /* squares around a disc: a cell reaches sqrt(2), its neighbours lie within 3, 1 for rounding */

status dem_tessellation_points(const struct dem_lattice *lattice, struct dem_lattice_points *points,
                               struct error *error) {
  *points = (struct dem_lattice_points){.columns = lattice->columns, .rows = lattice->rows, .walled = true};
  if (lattice->outline == DEM_OUTLINE_DISC) {
    points->centre = (uint32_t)ceil(lattice->radius / lattice->spacing) + BEYOND;
    points->columns = points->rows = 2 * points->centre + 1;
    points->walled = false;
  }
  points->point = malloc((size_t)points->columns * points->rows * sizeof *points->point);
  if (!points->point)
    return status_fail(error, STATUS_MEMORY, "no memory for a lattice of %u x %u grains", points->columns,
                       points->rows);
  for (uint32_t row = 0; row < points->rows; row++)
    for (uint32_t column = 0; column < points->columns; column++) {
      /* An item is a square counted from the disc's centre or the block's corner: a larger body of one seed holds the
       * smaller one's points. */
      uint64_t item = dem_lattice_square(column - points->centre, row - points->centre);
      uint64_t bits[4];
      random_bits(lattice->seed, RANDOM_LATTICE, item, lattice->stream, bits);
      points->point[(size_t)row * points->columns +
                    column] = (struct dem_point){column + 0.5 + lattice->disorder * (random_uniform(bits[0]) - 0.5),
                                                 row + 0.5 + lattice->disorder * (random_uniform(bits[1]) - 0.5)};
    }
  return STATUS_OK;
}

/* Keeps the part with nx x + ny y <= c; the new side faces `across`. */
static bool cut(struct cell *cell, double nx, double ny, double c, int64_t across) {
  double side[CELL_CORNERS];
  bool outside = false;
  for (int k = 0; k < cell->count; k++) {
    side[k] = nx * cell->x[k] + ny * cell->y[k] - c;
    outside |= side[k] > 0;
  }
  if (!outside)
    return true;
  struct cell old = *cell;
  int n = 0;
  for (int k = 0; k < old.count; k++) {
    int next = k + 1 < old.count ? k + 1 : 0;
    if (n + 2 >= CELL_CORNERS)
      return false;
    if (side[k] <= 0) {
      cell->x[n] = old.x[k];
      cell->y[n] = old.y[k];
      cell->across[n++] = old.across[k];
    }
    if ((side[k] <= 0) != (side[next] <= 0)) {
      double t = side[k] / (side[k] - side[next]);
      cell->x[n] = old.x[k] + t * (old.x[next] - old.x[k]);
      cell->y[n] = old.y[k] + t * (old.y[next] - old.y[k]);
      cell->across[n++] = side[k] <= 0 ? across : old.across[k];
    }
  }
  cell->count = n;
  return n > 0;
}

/* Cuts one cell. False when it has too many corners (never seen: nearly all of its 48 candidates would have to be
 * neighbours). */
static bool cut_cell(const struct dem_lattice_points *points, uint32_t column, uint32_t row, struct cell *cell) {
  struct dem_point p = points->point[(size_t)row * points->columns + column];
  double left = -4, lower = -4, right = 4, upper = 4; /* beyond any cell: cut away, unless they are walls */
  if (points->walled) {
    left = -p.x;
    lower = -p.y;
    right = points->columns - p.x;
    upper = points->rows - p.y;
  }
  *cell = (struct cell){.count = 4,
                        .x = {left, left, right, right},
                        .y = {upper, lower, lower, upper},
                        .across = {-1, -2, -3, -4}};
  for (int ring = 1; ring <= 3; ring++)
    for (int dy = -ring; dy <= ring; dy++)
      for (int dx = -ring; dx <= ring; dx += (dy == -ring || dy == ring) ? 1 : 2 * ring) {
        int64_t x = (int64_t)column + dx, y = (int64_t)row + dy;
        if (x < 0 || y < 0 || x >= points->columns || y >= points->rows)
          continue;
        int64_t j = y * points->columns + x;
        double qx = points->point[j].x - p.x, qy = points->point[j].y - p.y;
        double half = 0.5 * (qx * qx + qy * qy);
        double reach = 0; /* a bisector beyond the farthest corner cuts nothing */
        for (int k = 0; k < cell->count; k++)
          reach = fmax(reach, cell->x[k] * cell->x[k] + cell->y[k] * cell->y[k]);
        if (half * 0.5 < reach * (1 + 1e-9) && !cut(cell, qx, qy, half, j))
          return false;
      }
  return true;
}

static struct dem_point circumcentre(const struct dem_point *p, int64_t i, int64_t j, int64_t k) {
  double ax = p[j].x - p[i].x, ay = p[j].y - p[i].y, bx = p[k].x - p[i].x, by = p[k].y - p[i].y;
  double a = ax * ax + ay * ay, b = bx * bx + by * by, d = 2 * (ax * by - ay * bx);
  return (struct dem_point){p[i].x + (a * by - b * ay) / d, p[i].y + (b * ax - a * bx) / d};
}

/* The corner between the sides that the cell of point i shares with a and b. All cells that meet there get the same
 * bits. */
static struct dem_point corner_of(const struct dem_lattice_points *points, int64_t i, int64_t a, int64_t b) {
  int64_t key[3] = {i, a, b}; /* sorted: walls first */
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < 2; k++)
      if (key[k] > key[k + 1]) {
        int64_t swap = key[k];
        key[k] = key[k + 1];
        key[k + 1] = swap;
      }
  const struct dem_point *p = points->point;
  if (key[0] >= 0)
    return circumcentre(p, key[0], key[1], key[2]);
  const double wall[5] = {0, 0, 0, points->columns, points->rows}; /* by minus the name */
  if (key[1] < 0) /* two walls: -4 upper, -3 right, -2 lower, -1 left; one is odd (vertical), one even */
    return key[0] % 2 ? (struct dem_point){wall[-key[0]], wall[-key[1]]}
                      : (struct dem_point){wall[-key[1]], wall[-key[0]]};
  /* a wall and the bisector of two points */
  double qx = p[key[2]].x - p[key[1]].x, qy = p[key[2]].y - p[key[1]].y;
  double mx = p[key[1]].x + 0.5 * qx, my = p[key[1]].y + 0.5 * qy, at = wall[-key[0]];
  return key[0] % 2 ? (struct dem_point){at, my - (at - mx) * qx / qy}
                    : (struct dem_point){mx - (at - my) * qy / qx, at};
}

/* ---- one planar subdivision ----
 *
 * Corners of cells that were cut one by one become one where they coincide, so that neighbours share their vertices to
 * the last bit and a body at rest has no overlap. */

/* Corners nearer than this (in spacings) count as one. Rounding puts the same corner at most some 1e-14 apart at
 * coordinates below 100; a true side is this short in one of 1e10 pairs. */
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

static bool is_at(const struct corners *corners, uint32_t corner, struct dem_point p) {
  const struct dem_point at = corners->at[corner];
  return fabs(at.x - p.x) <= same_corner && fabs(at.y - p.y) <= same_corner;
}

/* The corner at p, in up to four squares; UINT32_MAX: none. */
static uint32_t corner_known(struct corners *corners, struct dem_point p) {
  const uint32_t *seen[4] = {0};
  for (int k = 0; k < 4; k++) {
    const uint32_t *list = corner_list(corners, p.x + (k & 1 ? same_corner : -same_corner),
                                       p.y + (k & 2 ? same_corner : -same_corner));
    if (list == seen[0] || list == seen[1] || list == seen[2])
      continue;
    seen[k] = list;
    for (uint32_t c = *list; c; c = corners->next[c - 1])
      if (is_at(corners, c - 1, p))
        return c - 1;
  }
  return UINT32_MAX;
}

/* Index of the corner at p, which is added if it is new; UINT32_MAX: no memory. */
static uint32_t corner_find(struct corners *corners, struct dem_point p) {
  const uint32_t known = corner_known(corners, p);
  if (known != UINT32_MAX)
    return known;
  size_t room = corners->capacity;
  if (!grow_room(&corners->at, &room, corners->count + 1, sizeof *corners->at) ||
      !grow_room(&corners->next, &corners->capacity, corners->count + 1, sizeof *corners->next))
    return UINT32_MAX;
  uint32_t *list = corner_list(corners, p.x, p.y);
  const uint32_t c = (uint32_t)corners->count++;
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
  int64_t *across;  /* by vertex: the neighbour (or wall) beyond the side that starts there */
  double ox, oy;    /* lattice coordinates of the world's origin of the body */
};

static struct dem_point world(const struct builder *b, struct dem_point p) {
  return (struct dem_point){b->lattice->origin.x + b->lattice->spacing * (p.x - b->ox),
                            b->lattice->origin.y + b->lattice->spacing * (p.y - b->oy)};
}

/* Is the point so far outside of a disc that its cell is, too? A centroid lies at most sqrt(2) spacings from its point.
 */
static bool is_far_outside(const struct builder *b, struct dem_point p) {
  if (b->lattice->outline != DEM_OUTLINE_DISC)
    return false;
  const double reach = b->lattice->radius / b->lattice->spacing + 1.5, x = p.x - b->ox, y = p.y - b->oy;
  return x * x + y * y > reach * reach;
}

static bool is_outside(const struct builder *b, struct dem_point centroid) {
  const struct dem_lattice *lattice = b->lattice;
  if (lattice->outline != DEM_OUTLINE_DISC)
    return false;
  const double distance = hypot(centroid.x - lattice->origin.x, centroid.y - lattice->origin.y);
  return distance > lattice->radius || distance < lattice->hole;
}

/* The unique corners of the cell of point i. False: no memory. */
static bool find_corners(struct builder *b, int64_t i, const struct cell *cell, uint32_t corner[CELL_CORNERS]) {
  for (int k = 0; k < cell->count; k++) {
    const int64_t before = cell->across[k ? k - 1 : cell->count - 1];
    corner[k] = corner_find(&b->corners, corner_of(&b->points, i, cell->across[k], before));
    if (corner[k] == UINT32_MAX)
      return false;
  }
  return true;
}

/* Writes the cell's vertices from `start` on, without sides whose ends are the same corner. Returns their number. */
static size_t write_vertices(struct builder *b, const struct cell *cell, const uint32_t *corner, size_t start) {
  size_t n = 0;
  for (int k = 0; k < cell->count; k++) {
    if (corner[k] == corner[k + 1 < cell->count ? k + 1 : 0])
      continue;
    b->out->vertex[start + n] = world(b, b->corners.at[corner[k]]);
    b->across[start + n++] = cell->across[k];
  }
  return n;
}

/* Cuts the cell of one lattice point and appends it if it belongs to the body. False: no memory. */
static bool add_cell(struct builder *b, uint32_t column, uint32_t row) {
  struct dem_tessellation *t = b->out;
  const int64_t i = (int64_t)row * b->points.columns + column;
  b->number[i] = UINT32_MAX;
  if (is_far_outside(b, b->points.point[i]))
    return true;

  struct cell cell;
  uint32_t corner[CELL_CORNERS];
  if (!cut_cell(&b->points, column, row, &cell) || !find_corners(b, i, &cell, corner))
    return false;
  const size_t c = t->cell_count, start = t->first_vertex[c], need = start + (size_t)cell.count;
  size_t room = b->vertex_capacity;
  if (!grow_room(&t->vertex, &room, need, sizeof *t->vertex) ||
      !grow_room(&b->across, &b->vertex_capacity, need, sizeof *b->across))
    return false;
  const size_t n = write_vertices(b, &cell, corner, start);
  measure(t->vertex + start, n, &t->area[c], &t->centroid[c], &t->polar_moment[c]);
  if (is_outside(b, t->centroid[c]))
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
    uint32_t found[CELL_CORNERS][2]; /* the other cell, the side's first vertex */
    size_t count = 0;
    for (uint32_t k = start; k < end; k++) {
      const uint32_t other = b->across[k] < 0 ? UINT32_MAX : b->number[b->across[k]];
      if (other == UINT32_MAX || other <= c)
        continue;
      found[count][0] = other;
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

/* Cuts all cells of the lattice points. False: no memory. */
static bool cut_body(struct builder *b) {
  const size_t n = (size_t)b->points.columns * b->points.rows;
  b->corners = (struct corners){.columns = b->points.columns, .rows = b->points.rows};
  b->corners.head = calloc(n, sizeof *b->corners.head);
  b->number = malloc(n * sizeof *b->number);
  b->out = memory_small(1, sizeof *b->out);
  if (!b->corners.head || !b->number || !allocate(b->out, n))
    return false;
  for (uint32_t row = 0; row < b->points.rows; row++)
    for (uint32_t column = 0; column < b->points.columns; column++)
      if (!add_cell(b, column, row))
        return false;
  return add_pairs(b);
}

static void free_builder(struct builder *b) {
  dem_tessellation_free(b->out);
  free(b->points.point);
  free(b->corners.head);
  free(b->corners.next);
  free(b->corners.at);
  free(b->number);
  free(b->across);
}

status dem_tessellation_make(const struct dem_lattice *lattice, struct dem_tessellation **out, struct error *error) {
  *out = NULL;
  struct builder b = {.lattice = lattice};
  const bool disc = lattice->outline == DEM_OUTLINE_DISC;
  const double squares = disc ? 4 * pow(lattice->radius / lattice->spacing + 8, 2)
                              : (double)lattice->columns * lattice->rows;
  if (!(squares >= 1 && squares < 1e8))
    return status_fail(error, STATUS_CONTENT,
                       "a body of %.3g grains is not possible: change its size or the grain spacing", squares);
  TRY(dem_tessellation_points(lattice, &b.points, error));
  status code = STATUS_OK;
  b.ox = disc ? 0.5 * b.points.columns : 0;
  b.oy = disc ? 0.5 * b.points.rows : 0;
  if (!cut_body(&b)) {
    code = status_fail(error, STATUS_MEMORY, "no memory for a body of %zu grains",
                       (size_t)b.points.columns * b.points.rows);
  } else if (b.out->cell_count == 0) {
    code = status_fail(error, STATUS_CONTENT, "no grain lies within the body: give a grain spacing below its size");
  } else {
    *out = b.out;
    b.out = NULL;
  }
  free_builder(&b);
  return code;
}

/* Copies a tessellation into a larger one, from these numbers on. */
static void copy_part(struct dem_tessellation *to, const struct dem_tessellation *from, uint32_t cell, uint32_t vertex,
                      size_t pair) {
  const size_t n = from->cell_count;
  memcpy(to->vertex + vertex, from->vertex, from->first_vertex[n] * sizeof *to->vertex);
  memcpy(to->centroid + cell, from->centroid, n * sizeof *to->centroid);
  memcpy(to->area + cell, from->area, n * sizeof *to->area);
  memcpy(to->polar_moment + cell, from->polar_moment, n * sizeof *to->polar_moment);
  memcpy(to->grid_x + cell, from->grid_x, n * sizeof *to->grid_x);
  memcpy(to->grid_y + cell, from->grid_y, n * sizeof *to->grid_y);
  for (size_t c = 0; c <= n; c++)
    to->first_vertex[cell + c] = vertex + from->first_vertex[c];
  for (size_t k = 0; k < from->pair_count; k++) {
    to->pair[pair + k][0] = cell + from->pair[k][0];
    to->pair[pair + k][1] = cell + from->pair[k][1];
    to->side[pair + k] = from->side[k];
  }
}

status dem_tessellation_join(const struct dem_tessellation *a, const struct dem_tessellation *b,
                             struct dem_tessellation **out, struct error *error) {
  *out = NULL;
  struct dem_tessellation *t = memory_small(1, sizeof *t);
  const size_t cells = a->cell_count + b->cell_count, pairs = a->pair_count + b->pair_count;
  const uint32_t vertices = a->first_vertex[a->cell_count];
  t->vertex = malloc((size_t)(vertices + b->first_vertex[b->cell_count]) * sizeof *t->vertex);
  t->pair = malloc((pairs + 1) * sizeof *t->pair);
  t->side = malloc((pairs + 1) * sizeof *t->side);
  if (!allocate(t, cells) || !t->vertex || !t->pair || !t->side) {
    dem_tessellation_free(t);
    return status_fail(error, STATUS_MEMORY, "no memory for a body of %zu grains", cells);
  }
  t->cell_count = cells;
  t->pair_count = pairs;
  t->joined_at = a->cell_count;
  copy_part(t, a, 0, 0, 0);
  copy_part(t, b, (uint32_t)a->cell_count, vertices, a->pair_count);
  *out = t;
  return STATUS_OK;
}

bool dem_tessellation_side(const struct dem_tessellation *t, uint32_t i, uint32_t j, uint32_t side[2],
                           struct dem_point *along) {
  const uint32_t fi = t->first_vertex[i], ni = t->first_vertex[i + 1] - fi;
  const uint32_t fj = t->first_vertex[j], nj = t->first_vertex[j + 1] - fj;
  const double tolerance = 1e-9 * sqrt(t->area[i]);
  for (side[0] = 0; side[0] < ni; side[0]++)
    for (side[1] = 0; side[1] < nj; side[1]++) {
      const struct dem_point *p = &t->vertex[fi + side[0]], *q = &t->vertex[fi + (side[0] + 1) % ni];
      const struct dem_point *r = &t->vertex[fj + side[1]], *u = &t->vertex[fj + (side[1] + 1) % nj];
      if (fabs(p->x - u->x) <= tolerance && fabs(p->y - u->y) <= tolerance && fabs(q->x - r->x) <= tolerance &&
          fabs(q->y - r->y) <= tolerance) {
        *along = (struct dem_point){q->x - p->x, q->y - p->y};
        return true;
      }
    }
  return false;
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
