/* Places the fragments of a picture one after another on a grid of cells as wide as a disc. */
#include "analysis/pictures/picture_layout.h"

#include <math.h>
#include <stdlib.h>

#include "schemas/memory.h"

enum { WIDE = 2048 };          /* cells of the grid along each side */
static const double GAP = 1.5; /* cells between two fragments */

struct piece {
  size_t first, count; /* range of its discs in `order` */
  double x, y;         /* centre of its discs, m */
};

struct layout {
  struct picture_layout_disc *discs;
  size_t *order; /* discs by fragment */
  struct piece *piece;
  size_t pieces;
  unsigned char *taken; /* cells */
  double cell, x, y;    /* side of a cell; the middle of the grid, m */
};

#define LAYOUT __attribute__((cleanup(clear))) struct layout
static void clear(struct layout *l) {
  free(l->order);
  free(l->piece);
  free(l->taken);
}

/* Sorts the discs by fragment, by counting. */
static status gather(const struct picture_cloud *cloud, size_t count, struct layout *l) {
  for (size_t k = 0; k < count; k++)
    if ((size_t)cloud->fragment[l->discs[k].id] >= l->pieces)
      l->pieces = (size_t)cloud->fragment[l->discs[k].id] + 1;
  TRY(memory_array(&l->order, count, sizeof *l->order, "", NULL));
  TRY(memory_array(&l->piece, l->pieces, sizeof *l->piece, "", NULL));
  TRY(memory_array(&l->taken, (size_t)WIDE * WIDE, 1, "", NULL));
  for (size_t k = 0; k < count; k++)
    l->piece[cloud->fragment[l->discs[k].id]].count++;
  for (size_t p = 1; p < l->pieces; p++)
    l->piece[p].first = l->piece[p - 1].first + l->piece[p - 1].count;
  for (size_t p = 0; p < l->pieces; p++)
    l->piece[p].count = 0;
  for (size_t k = 0; k < count; k++) {
    struct piece *piece = &l->piece[cloud->fragment[l->discs[k].id]];
    l->order[piece->first + piece->count++] = k;
    piece->x += l->discs[k].x;
    piece->y += l->discs[k].y;
  }
  for (size_t p = 0; p < l->pieces; p++)
    if (l->piece[p].count) {
      l->piece[p].x /= (double)l->piece[p].count;
      l->piece[p].y /= (double)l->piece[p].count;
    }
  return STATUS_OK;
}

/* Cell of a coordinate relative to the middle; -1 outside the grid. */
static long cell_of(const struct layout *l, double from_middle) {
  const double at = floor(from_middle / l->cell) + WIDE / 2;
  return at >= 0 && at < WIDE ? (long)at : -1;
}

/* Is the place free when the piece is shifted by (dx, dy)? All places outside the grid are free. */
static bool is_free(const struct layout *l, const struct piece *piece, double dx, double dy) {
  for (size_t k = 0; k < piece->count; k++) {
    const struct picture_layout_disc *d = &l->discs[l->order[piece->first + k]];
    const long i = cell_of(l, d->x + dx - l->x), j = cell_of(l, d->y + dy - l->y);
    if (i >= 0 && j >= 0 && l->taken[(size_t)j * WIDE + (size_t)i])
      return false;
  }
  return true;
}

/* Marks the cells of the piece's discs and their neighbours as taken. */
static void take(struct layout *l, const struct piece *piece) {
  for (size_t k = 0; k < piece->count; k++) {
    const struct picture_layout_disc *d = &l->discs[l->order[piece->first + k]];
    const double reach = 2 * d->radius + GAP * l->cell;
    const long low_i = cell_of(l, d->x - reach - l->x), high_i = cell_of(l, d->x + reach - l->x);
    const long low_j = cell_of(l, d->y - reach - l->y), high_j = cell_of(l, d->y + reach - l->y);
    if (low_i < 0 || low_j < 0 || high_i < 0 || high_j < 0)
      continue;
    for (long j = low_j; j <= high_j; j++)
      for (long i = low_i; i <= high_i; i++)
        l->taken[(size_t)j * WIDE + (size_t)i] = 1;
  }
}

/* Moves a piece away from the middle until it is free. A piece in the middle gets a direction from its number, by
 * golden angles. */
static void place(struct layout *l, size_t p) {
  struct piece *piece = &l->piece[p];
  const double dx = piece->x - l->x, dy = piece->y - l->y, far = hypot(dx, dy);
  const double x = far > 1e-6 * l->cell ? dx / far : cos(2.399963 * (double)p);
  const double y = far > 1e-6 * l->cell ? dy / far : sin(2.399963 * (double)p);
  double step = 0;
  while (!is_free(l, piece, step * x, step * y))
    step += l->cell;
  for (size_t k = 0; k < piece->count; k++) {
    l->discs[l->order[piece->first + k]].x += step * x;
    l->discs[l->order[piece->first + k]].y += step * y;
  }
  take(l, piece);
}

status picture_layout_apart(const struct picture_cloud *cloud, size_t count, struct picture_layout_disc *discs) {
  LAYOUT l = {.discs = discs};
  double extent = 0, radius = 0;
  size_t heaviest = 0;
  TRY(gather(cloud, count, &l));
  if (count == 0)
    return STATUS_OK;
  while (l.piece[heaviest].count == 0)
    heaviest++;
  l.x = l.piece[heaviest].x;
  l.y = l.piece[heaviest].y;
  for (size_t k = 0; k < count; k++) {
    extent = fmax(extent, fmax(fabs(discs[k].x - l.x), fabs(discs[k].y - l.y)));
    radius += discs[k].radius / (double)count;
  }
  l.cell = fmax(radius, 4 * extent / WIDE); /* the grid is twice as wide as the cloud */
  for (size_t p = 0; p < l.pieces; p++)
    if (l.piece[p].count)
      place(&l, p);
  return STATUS_OK;
}
