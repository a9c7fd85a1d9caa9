/* Points of the random lattice and the Voronoi cell of each. */
#include "engine/dem/lattice/lattice.h"

#include <math.h>
#include <stdlib.h>

#include "engine/random.h"

enum { BEYOND = 6 }; /* squares around a disc: a cell reaches sqrt(2), its neighbours lie within 3, 1 for rounding */

status dem_lattice_fill(const struct dem_lattice *lattice, struct dem_lattice_points *points, struct error *error) {
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
static bool cut(struct dem_lattice_cell *cell, double nx, double ny, double c, int64_t across) {
  double side[DEM_LATTICE_CORNERS];
  bool outside = false;
  for (int k = 0; k < cell->count; k++) {
    side[k] = nx * cell->x[k] + ny * cell->y[k] - c;
    outside |= side[k] > 0;
  }
  if (!outside)
    return true;
  struct dem_lattice_cell old = *cell;
  int n = 0;
  for (int k = 0; k < old.count; k++) {
    int next = k + 1 < old.count ? k + 1 : 0;
    if (n + 2 >= DEM_LATTICE_CORNERS)
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

bool dem_lattice_cell(const struct dem_lattice_points *points, uint32_t column, uint32_t row,
                      struct dem_lattice_cell *cell) {
  struct dem_point p = points->point[(size_t)row * points->columns + column];
  double left = -4, lower = -4, right = 4, upper = 4; /* beyond any cell: cut away, unless they are walls */
  if (points->walled) {
    left = -p.x;
    lower = -p.y;
    right = points->columns - p.x;
    upper = points->rows - p.y;
  }
  *cell = (struct dem_lattice_cell){.count = 4,
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

struct dem_point dem_lattice_corner(const struct dem_lattice_points *points, int64_t i, int64_t a, int64_t b) {
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
