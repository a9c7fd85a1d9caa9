/* Hashed cells of several sizes. */
#include "engine/sph/observe/cell_grid.h"

#include <math.h>
#include <stdlib.h>

enum { LEVELS = 64 };

struct item {
  double at[3], half; /* half = reach h / 2 */
  uint32_t id;
  uint8_t level, role;
};

struct sph_cell_grid {
  size_t n, mask;    /* present particles; buckets - 1 */
  struct item *item; /* by bucket */
  uint32_t *start;   /* by bucket, and one more */
  double coarsest;   /* m, cells of level 0; each level halves them */
  double period[3];  /* m; 0 = open */
  int levels;
};

struct level {
  double size[3];
  int64_t wrap[3]; /* cells along a periodic axis; 1: fewer than three, all in one cell; 0: the axis is open */
};

static struct level level_at(const struct sph_cell_grid *t, int number) {
  struct level level;
  for (int d = 0; d < 3; d++) {
    level.size[d] = ldexp(t->coarsest, -number);
    level.wrap[d] = 0;
    if (t->period[d] > 0) {
      double cells = floor(t->period[d] / level.size[d]);
      level.wrap[d] = cells < 3 ? 1 : (int64_t)fmin(cells, 1e15);
      level.size[d] = t->period[d] / (double)level.wrap[d];
    }
  }
  return level;
}

static int64_t cell_along(const struct level *level, int axis, double x) {
  if (level->wrap[axis] == 1)
    return 0;
  double cell = floor(x / level->size[axis]);
  int64_t at = (int64_t)fmin(fmax(cell, -4e18), 4e18);
  if (level->wrap[axis] > 1) {
    at %= level->wrap[axis];
    at += at < 0 ? level->wrap[axis] : 0;
  }
  return at;
}

/* Cells that are neighbours along x have neighbouring buckets. Odd multipliers scatter rows and levels. */
static size_t bucket_of(const struct sph_cell_grid *t, int level, const int64_t at[3]) {
  return (size_t)((uint64_t)at[0] + (uint64_t)at[1] * 0x9e3779b97f4a7c15u + (uint64_t)at[2] * 0xc2b2ae3d27d4eb4fu +
                  (uint64_t)level * 0x165667b19e3779f9u) &
         t->mask;
}

static size_t home_of(const struct sph_cell_grid *t, const struct level *level, const struct item *item) {
  int64_t at[3];
  for (int d = 0; d < 3; d++)
    at[d] = cell_along(level, d, item->at[d]);
  return bucket_of(t, item->level, at);
}

/* Counting sort into buckets; inside a bucket by ascending id. */
static void sort_items(struct sph_cell_grid *t, const struct level *level, const struct item *from, uint32_t *bucket) {
  for (size_t k = 0; k < t->n; k++) {
    bucket[k] = (uint32_t)home_of(t, &level[from[k].level], &from[k]);
    t->start[bucket[k] + 1]++;
  }
  for (size_t b = 0; b <= t->mask; b++)
    t->start[b + 1] += t->start[b];
  for (size_t k = t->n; k-- > 0;)
    t->item[--t->start[bucket[k] + 1]] = from[k];
  for (size_t b = 0; b <= t->mask; b++) /* the loop above moved each start to the entry before it: move it back */
    t->start[b] = t->start[b + 1];
  t->start[t->mask + 1] = (uint32_t)t->n;
}

/* The particles that are not absent. Returns the largest reach h, m. */
static double collect_items(struct sph_cell_grid *t, size_t n, const double *x, const double *y, const double *z,
                            const double *h, const uint8_t *role, double reach, struct item *items) {
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    if (role[i] == SPH_CELL_GRID_ABSENT)
      continue;
    items[t->n++] = (struct item){.at = {x[i], y[i], z[i]},
                                  .half = 0.5 * reach * h[i],
                                  .id = (uint32_t)i,
                                  .role = role[i]};
    largest = fmax(largest, reach * h[i]);
  }
  return largest;
}

/* The finest level whose cells are at least reach h wide. Level 0 has cells of `largest`. */
static uint8_t level_for(const struct item *item, double largest) {
  uint8_t level = 0;
  for (double bound = largest; 4 * item->half <= bound && level < LEVELS - 1; bound /= 2)
    level++;
  return level;
}

status sph_cell_grid_create(size_t n, const double *x, const double *y, const double *z, const double *h,
                            const uint8_t *role, double reach, const double periodic[3], struct sph_cell_grid **out,
                            struct error *error) {
  *out = NULL;
  status code = STATUS_OK;
  struct sph_cell_grid *t = calloc(1, sizeof *t);
  struct item *from = malloc((n + 1) * sizeof *from);
  uint32_t *bucket = malloc((n + 1) * sizeof *bucket);
  struct level level[LEVELS];
  if (!t || !from || !bucket)
    goto no_memory;

  double largest = collect_items(t, n, x, y, z, h, role, reach, from);
  for (t->mask = 1; t->mask < 2 * t->n;)
    t->mask = 2 * t->mask + 1;
  t->item = malloc((t->n + 1) * sizeof *t->item);
  t->start = calloc(t->mask + 2, sizeof *t->start);
  if (!t->item || !t->start)
    goto no_memory;

  t->coarsest = largest * (1 + 1e-9); /* a rounded distance must not skip a cell */
  for (int d = 0; d < 3; d++)
    t->period[d] = periodic[d] > 0 ? periodic[d] : 0;
  t->levels = 1;
  for (size_t k = 0; k < t->n; k++) {
    from[k].level = level_for(&from[k], largest);
    if (from[k].level >= t->levels)
      t->levels = from[k].level + 1;
  }
  for (int l = 0; l < t->levels; l++)
    level[l] = level_at(t, l);
  sort_items(t, level, from, bucket);
  *out = t;
  goto cleanup;
no_memory:
  sph_cell_grid_free(t);
  code = status_fail(error, STATUS_MEMORY, "no memory to find which of %zu particles are neighbours", n);
cleanup:
  free(from);
  free(bucket);
  return code;
}

void sph_cell_grid_free(struct sph_cell_grid *t) {
  if (!t)
    return;
  free(t->item);
  free(t->start);
  free(t);
}

struct visit {
  const struct sph_cell_grid *t;
  sph_cell_grid_pair pair;
  void *context;
  bool passive, periodic;
};

/* The items of one level in `count` successive buckets. own: the buckets are those of the item's own cell, where a pair
 * is visited from the lower id only. */
static void visit_buckets(const struct visit *visit, const struct item *item, int number, bool own, size_t bucket,
                          size_t count) {
  const struct sph_cell_grid *t = visit->t;
  for (uint32_t k = t->start[bucket]; k < t->start[bucket + count]; k++) {
    const struct item *other = &t->item[k];
    if (other->level != number || other->id == item->id || (own && other->id < item->id))
      continue;
    if (visit->passive ? other->role == item->role : other->role == SPH_CELL_GRID_PASSIVE)
      continue;
    double square = 0, within = item->half + other->half;
    for (int d = 0; d < 3; d++) {
      double along = item->at[d] - other->at[d];
      if (visit->periodic && t->period[d] > 0)
        along -= t->period[d] * nearbyint(along / t->period[d]);
      square += along * along;
    }
    if (square <= within * within)
      visit->pair(visit->context, item->id, other->id, square);
  }
}

/* One cell, at its image inside the box where an axis is periodic. */
static void visit_cell(const struct visit *visit, const struct item *item, int number, bool own,
                       const struct level *level, const int64_t cell[3]) {
  int64_t at[3];
  for (int d = 0; d < 3; d++)
    at[d] = level->wrap[d] ? (cell[d] + level->wrap[d]) % level->wrap[d] : cell[d];
  visit_buckets(visit, item, number, own, bucket_of(visit->t, number, at), 1);
}

/* A row of cells along x, from `first` to `last` cells beside home; `own`: the item's own cell is the first of them. */
static void visit_row(const struct visit *visit, const struct item *item, int number, bool own,
                      const struct level *level, const int64_t home[3], int first, int last) {
  const size_t count = (size_t)(last - first + 1);
  const size_t row = bucket_of(visit->t, number, (int64_t[3]){home[0] + first, home[1], home[2]});
  const bool in_order = row + count <= visit->t->mask + 1; /* the row of cells is a row of buckets */
  if (!visit->periodic && !own && in_order) {
    visit_buckets(visit, item, number, false, row, count);
    return;
  }
  for (int c = first; c <= last; c++)
    visit_cell(visit, item, number, own && c == 0, level, (const int64_t[3]){home[0] + c, home[1], home[2]});
}

/* The cells round an item. A pair of two levels is found from its finer item, because the coarser cells hold the reach
 * of both. On the item's own level only the cells that follow its own are visited. */
static void visit_level(const struct visit *visit, const struct item *item, int number, const struct level *level) {
  int64_t home[3];
  int reach[3]; /* cells to either side */
  for (int d = 0; d < 3; d++) {
    home[d] = cell_along(level, d, item->at[d]);
    reach[d] = level->wrap[d] == 1 ? 0 : 1;
  }
  const bool same = item->level == number;
  for (int a = same ? 0 : -reach[2]; a <= reach[2]; a++)
    for (int b = same && a == 0 ? 0 : -reach[1]; b <= reach[1]; b++) {
      const bool own = same && a == 0 && b == 0;
      const int64_t beside[3] = {home[0], home[1] + b, home[2] + a};
      visit_row(visit, item, number, own, level, beside, own ? 0 : -reach[0], reach[0]);
    }
}

void sph_cell_grid_visit(const struct sph_cell_grid *t, bool passive, sph_cell_grid_pair pair, void *context) {
  const struct visit visit = {.t = t,
                              .pair = pair,
                              .context = context,
                              .passive = passive,
                              .periodic = t->period[0] > 0 || t->period[1] > 0 || t->period[2] > 0};
  bool filled[LEVELS] = {false};
  struct level level[LEVELS];
  for (int l = 0; l < t->levels; l++)
    level[l] = level_at(t, l);
  for (size_t k = 0; k < t->n; k++)
    filled[t->item[k].level] = true;
  for (size_t k = 0; k < t->n; k++)
    for (int l = 0; l <= t->item[k].level; l++)
      if (filled[l] && (passive || t->item[k].role == SPH_CELL_GRID_ACTIVE))
        visit_level(&visit, &t->item[k], l, &level[l]);
}
