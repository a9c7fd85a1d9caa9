#include "engine/sph/neighbours.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct cell {
  int64_t at[3];
};

struct grid {
  double size[3];
  int64_t wrap[3]; /* cells round a periodic axis; 0 = open */
  size_t mask;
  uint32_t *start, *item; /* by bucket */
  struct cell *cell;      /* by particle */
};

static size_t bucket_of(const struct grid *grid, const int64_t at[3]) {
  uint64_t key = (uint64_t)at[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)at[1] * 0xc2b2ae3d27d4eb4fu ^ (uint64_t)at[2] * 0x165667b19e3779f9u;
  key ^= key >> 32;
  key *= 0xd6e8feb86659fd93u;
  return (size_t)(key >> 20) & grid->mask;
}

static int64_t cell_along(const struct grid *grid, int axis, double x) {
  double t = floor(x / grid->size[axis]);
  int64_t at = t > -9e18 && t < 9e18 ? (int64_t)t : 0;
  if (grid->wrap[axis]) {
    at %= grid->wrap[axis];
    if (at < 0) at += grid->wrap[axis];
  }
  return at;
}

static int ascending(const void *a, const void *b) {
  uint32_t left = *(const uint32_t *)a, right = *(const uint32_t *)b;
  return left < right ? -1 : left > right;
}

static status grow(struct sph_neighbours *lists, struct error *error) {
  size_t capacity = lists->capacity ? lists->capacity + lists->capacity / 2 : 64 * (lists->n + 16);
  uint32_t *j = realloc(lists->j, capacity * sizeof *j);
  if (!j) return status_fail(error, STATUS_MEMORY, "no memory for %zu neighbours", capacity);
  lists->j = j;
  lists->capacity = capacity;
  return STATUS_OK;
}

status sph_neighbours_find(size_t n, const double *x, const double *y, const double *z, const double *h, double skin,
                           const double periodic[3], struct sph_neighbours *lists, struct error *error) {
  const double *place[3] = {x, y, z};
  struct grid grid = {.mask = 1};
  status code = STATUS_OK;
  double largest = 0;
  for (size_t i = 0; i < n; i++)
    largest = fmax(largest, h[i]);
  double reach = 2 * largest * (1 + skin);
  if (!(reach > 0)) reach = 1;
  for (int d = 0; d < 3; d++) {
    grid.size[d] = reach;
    if (isnan(periodic[d])) continue;
    if (periodic[d] < 2 * reach)
      return status_fail(error, STATUS_CONTENT,
                         "a periodic box of %.4g m is too thin: it must hold twice the reach of the largest particle, %.4g m",
                         periodic[d], 2 * reach);
    grid.wrap[d] = (int64_t)fmin(floor(periodic[d] / reach), 1e15);
    grid.size[d] = periodic[d] / (double)grid.wrap[d];
  }
  while (grid.mask < 2 * n)
    grid.mask = 2 * grid.mask + 1;
  grid.start = calloc(grid.mask + 2, sizeof *grid.start);
  grid.item = malloc((n + 1) * sizeof *grid.item);
  grid.cell = malloc((n + 1) * sizeof *grid.cell);
  if (lists->n != n || !lists->first) {
    size_t *first = realloc(lists->first, (n + 1) * sizeof *first);
    if (first) lists->first = first, lists->n = n;
  }
  if (!grid.start || !grid.item || !grid.cell || !lists->first || lists->n != n) {
    code = status_fail(error, STATUS_MEMORY, "no memory to find the neighbours of %zu particles", n);
    goto cleanup;
  }
  for (size_t i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++)
      grid.cell[i].at[d] = cell_along(&grid, d, place[d][i]);
    grid.start[bucket_of(&grid, grid.cell[i].at) + 1]++;
  }
  for (size_t b = 0; b <= grid.mask; b++)
    grid.start[b + 1] += grid.start[b];
  for (size_t i = n; i-- > 0;) /* from the end, so that start[b + 1] becomes the start of b, particles ascending */
    grid.item[--grid.start[bucket_of(&grid, grid.cell[i].at) + 1]] = (uint32_t)i;
  /* now start[b + 1] is the start of bucket b and start[b + 2] its end */
  lists->count = 0;
  for (size_t i = 0; i < n && !code; i++) {
    lists->first[i] = lists->count;
    for (int64_t step = 0; step < 27 && !code; step++) {
      int64_t at[3], offset[3] = {step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1};
      bool again = false;
      for (int d = 0; d < 3; d++) {
        at[d] = grid.cell[i].at[d] + offset[d];
        if (grid.wrap[d]) {
          at[d] = (at[d] + grid.wrap[d]) % grid.wrap[d];
          again = again || (grid.wrap[d] < 3 && offset[d] >= (int64_t)grid.wrap[d] - 1 && offset[d] > 0); /* 2 cells: once */
        }
      }
      if (again) continue;
      size_t bucket = bucket_of(&grid, at);
      size_t end = bucket == grid.mask ? n : grid.start[bucket + 2];
      for (size_t k = grid.start[bucket + 1]; k < end; k++) {
        uint32_t j = grid.item[k];
        if (j <= i || memcmp(grid.cell[j].at, at, sizeof at) != 0) continue;
        double square = 0;
        for (int d = 0; d < 3; d++) {
          double along = place[d][i] - place[d][j];
          if (grid.wrap[d]) along -= periodic[d] * nearbyint(along / periodic[d]);
          square += along * along;
        }
        double within = (h[i] + h[j]) * (1 + skin);
        if (!(square < within * within)) continue;
        if (lists->count == lists->capacity && (code = grow(lists, error))) break;
        lists->j[lists->count++] = j;
      }
    }
    if (!code) qsort(lists->j + lists->first[i], lists->count - lists->first[i], sizeof *lists->j, ascending);
  }
  lists->first[n] = lists->count;
cleanup:
  free(grid.start);
  free(grid.item);
  free(grid.cell);
  return code;
}

void sph_neighbours_clear(struct sph_neighbours *lists) {
  free(lists->first);
  free(lists->j);
  *lists = (struct sph_neighbours){0};
}
