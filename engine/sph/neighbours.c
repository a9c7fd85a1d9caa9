#include "engine/sph/neighbours.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 64, PAD = 8, CELLS = 27 };

/* Particles whose reach is within a factor of 2, in cells of twice the largest reach among them. */
struct level {
  double reach, size[3];
  int64_t wrap[3]; /* cells round a periodic axis; 0 = open */
  size_t first, count, mask, bucket; /* its particles in `sorted`; its buckets in `start` */
};

/* Particles in the order of levels and buckets: candidates stand side by side. */
struct search {
  size_t n, levels;
  struct level level[LEVELS];
  double *x, *y, *z, *reach;
  uint32_t *id, *start;
  uint8_t *level_of; /* by particle */
  uint32_t (*across)[2]; /* pairs of different levels, lower number first */
  size_t across_count, across_capacity;
  const double *given[4]; /* x y z reach by particle */
  struct {                /* gathered candidates */
    size_t count, capacity, reals_capacity;
    uint32_t *place;
    double *reals; /* x y z reach, each count + PAD */
  } near;
};

static int64_t cell_along(const struct level *level, int axis, double x) {
  double t = floor(x / level->size[axis]);
  int64_t at = t > -9e18 && t < 9e18 ? (int64_t)t : 0; /* what is not finite: its distances are not below any reach */
  if (level->wrap[axis]) {
    at %= level->wrap[axis];
    if (at < 0) at += level->wrap[axis];
  }
  return at;
}

static size_t bucket_of(const struct level *level, const int64_t at[3]) {
  uint64_t key = (uint64_t)at[0] * 0x9e3779b97f4a7c15u ^ (uint64_t)at[1] * 0xc2b2ae3d27d4eb4fu ^
                 (uint64_t)at[2] * 0x165667b19e3779f9u;
  key = (key ^ key >> 32) * 0xd6e8feb86659fd93u;
  return level->bucket + ((size_t)(key >> 20) & level->mask);
}

/* The buckets of a cell and those round it, each once. */
static size_t buckets_round(const struct level *level, const int64_t cell[3], size_t out[CELLS]) {
  size_t count = 0;
  for (int k = 0; k < CELLS; k++) {
    int64_t at[3];
    const int64_t offset[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    for (int d = 0; d < 3; d++) {
      at[d] = (int64_t)((uint64_t)cell[d] + (uint64_t)offset[d]);
      if (level->wrap[d]) at[d] = (at[d] + level->wrap[d]) % level->wrap[d];
    }
    const size_t bucket = bucket_of(level, at);
    bool again = false;
    for (size_t m = 0; m < count; m++)
      again |= out[m] == bucket;
    if (!again) out[count++] = bucket;
  }
  return count;
}

static status set_levels(struct search *s, const double *reach, const double periodic[3], struct error *error) {
  double least = INFINITY;
  for (size_t i = 0; i < s->n; i++)
    if (reach[i] > 0 && reach[i] < least) least = reach[i];
  size_t count[LEVELS] = {0}, buckets = 0, first = 0;
  double largest[LEVELS] = {0};
  for (size_t i = 0; i < s->n; i++) {
    const double ratio = reach[i] / least;
    const int k = ratio >= 1 && isfinite(ratio) ? ilogb(ratio) : 0;
    s->level_of[i] = (uint8_t)(k < LEVELS ? k : LEVELS - 1);
    count[s->level_of[i]]++;
    if (reach[i] > largest[s->level_of[i]] && isfinite(reach[i])) largest[s->level_of[i]] = reach[i];
  }
  uint8_t number[LEVELS] = {0}; /* empty levels are left out */
  for (int k = 0; k < LEVELS; k++) {
    if (!count[k]) continue;
    struct level *level = &s->level[s->levels];
    *level = (struct level){.reach = largest[k] > 0 ? largest[k] : 1, .first = first, .count = count[k], .mask = 1, .bucket = buckets};
    number[k] = (uint8_t)s->levels++;
    while (level->mask < level->count)
      level->mask = 2 * level->mask + 1;
    buckets += level->mask + 1;
    first += level->count;
    for (int d = 0; d < 3; d++) {
      level->size[d] = 2 * level->reach;
      if (isnan(periodic[d])) continue;
      if (periodic[d] < 4 * level->reach)
        return status_fail(error, STATUS_CONTENT,
                           "a periodic box of %.4g m is too thin for its particles: it must hold twice their reach, %.4g m",
                           periodic[d], 4 * level->reach);
      level->wrap[d] = (int64_t)fmin(floor(periodic[d] / level->size[d]), 1e15);
      level->size[d] = periodic[d] / (double)level->wrap[d];
    }
  }
  for (size_t i = 0; i < s->n; i++)
    s->level_of[i] = number[s->level_of[i]];
  s->start = calloc(buckets + 2, sizeof *s->start);
  return s->start ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory to find the neighbours of %zu particles", s->n);
}

static void cell_of(const struct level *level, double x, double y, double z, int64_t cell[3]) {
  cell[0] = cell_along(level, 0, x);
  cell[1] = cell_along(level, 1, y);
  cell[2] = cell_along(level, 2, z);
}

static void sort(struct search *s, const double *x, const double *y, const double *z, const double *reach) {
  const struct level *last = &s->level[s->levels - 1];
  const size_t buckets = last->bucket + last->mask + 1;
  int64_t cell[3];
  for (size_t i = 0; i < s->n; i++) {
    const struct level *level = &s->level[s->level_of[i]];
    cell_of(level, x[i], y[i], z[i], cell);
    s->start[bucket_of(level, cell) + 1]++;
  }
  for (size_t b = 0; b <= buckets; b++)
    s->start[b + 1] += s->start[b];
  for (size_t i = s->n; i-- > 0;) { /* downwards: within a bucket by number. start[b + 1] becomes the start of b */
    const struct level *level = &s->level[s->level_of[i]];
    cell_of(level, x[i], y[i], z[i], cell);
    const size_t k = --s->start[bucket_of(level, cell) + 1];
    s->x[k] = x[i], s->y[k] = y[i], s->z[k] = z[i], s->reach[k] = reach[i];
    s->id[k] = (uint32_t)i;
  }
}

static bool grow(void **array, size_t *capacity, size_t wanted, size_t size) {
  if (wanted <= *capacity) return true;
  const size_t more = wanted + wanted / 4 + 1024;
  void *grown = realloc(*array, more * size);
  if (!grown) return false;
  *array = grown;
  *capacity = more;
  return true;
}

/* What may be near the particles `first` .. `last` - 1 of the sorted order, which share a cell of `level`: those of the
 * buckets round it (of a higher number than the lowest of ours, among equals), gathered side by side. */
static bool gather(struct search *s, size_t first, size_t last, const struct level *level, const int64_t cell[3],
                   const double periodic[3], const struct sph_pair_kernels *kernels, bool equals) {
  size_t bucket[CELLS];
  const size_t buckets = buckets_round(level, cell, bucket);
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, reach = 0, square = 0, middle[3];
  uint32_t lowest = UINT32_MAX;
  for (size_t k = first; k < last; k++) {
    const double at[3] = {s->x[k], s->y[k], s->z[k]};
    for (int d = 0; d < 3; d++) {
      low[d] = at[d] < low[d] ? at[d] : low[d];
      high[d] = at[d] > high[d] ? at[d] : high[d];
    }
    reach = s->reach[k] > reach ? s->reach[k] : reach;
    lowest = s->id[k] < lowest ? s->id[k] : lowest;
  }
  for (int d = 0; d < 3; d++) {
    middle[d] = 0.5 * (low[d] + high[d]);
    square += 0.25 * (high[d] - low[d]) * (high[d] - low[d]);
  }
  const double far = fabs(middle[0]) + fabs(middle[1]) + fabs(middle[2]);
  const double round = (reach + sqrt(square)) * (1 + 1e-12) + 1e-15 * far; /* a sphere that holds all of ours with their reach */
  size_t used = 0;
  for (size_t b = 0; b < buckets; b++) {
    const size_t from = s->start[bucket[b] + 1], count = s->start[bucket[b] + 2] - from;
    if (!count) continue;
    if (!grow((void **)&s->near.place, &s->near.capacity, used + count + PAD, sizeof *s->near.place)) return false;
    used += kernels->within(count, s->x + from, s->y + from, s->z + from, s->reach + from, s->id + from, middle, round, periodic,
                            equals ? lowest + 1 : 0, s->near.place + used);
  }
  if (!grow((void **)&s->near.reals, &s->near.reals_capacity, 4 * (used + PAD), sizeof *s->near.reals)) return false;
  s->near.count = used;
  double *x = s->near.reals, *y = x + used + PAD, *z = y + used + PAD, *its = z + used + PAD;
  for (size_t m = 0; m < used; m++) {
    const size_t j = s->near.place[m];
    x[m] = s->given[0][j], y[m] = s->given[1][j], z[m] = s->given[2][j], its[m] = s->given[3][j];
  }
  memset(x + used, 0, PAD * sizeof *x);
  memset(y + used, 0, PAD * sizeof *y);
  memset(z + used, 0, PAD * sizeof *z);
  memset(its + used, 0, PAD * sizeof *its);
  return true;
}

/* Of particle k (in the sorted order) with what was gathered: pairs of equals go to `lists`, others aside. */
static bool look(struct search *s, size_t k, bool equals, const double periodic[3], const struct sph_pair_kernels *kernels,
                 struct sph_neighbours *lists) {
  const uint32_t i = s->id[k];
  const double at[3] = {s->x[k], s->y[k], s->z[k]}, *x = s->near.reals;
  const size_t count = s->near.count, row = count + PAD;
  if (!grow((void **)&lists->j, &lists->capacity, lists->used + count + PAD, sizeof *lists->j)) return false;
  uint32_t *found = lists->j + lists->used;
  const size_t used = kernels->within(count, x, x + row, x + 2 * row, x + 3 * row, s->near.place, at, s->reach[k], periodic,
                                      equals ? i + 1 : 0, found);
  if (equals) {
    lists->start[i] = lists->used;
    lists->count[i] = (uint32_t)used;
    lists->used += used;
    return true;
  }
  if (!grow((void **)&s->across, &s->across_capacity, s->across_count + used, sizeof *s->across)) return false;
  for (size_t m = 0; m < used; m++, s->across_count++) {
    const uint32_t j = found[m];
    s->across[s->across_count][0] = i < j ? i : j;
    s->across[s->across_count][1] = i < j ? j : i;
  }
  return true;
}

/* Pairs of different levels join the list of the lower number. */
static bool merge(const struct search *s, struct sph_neighbours *lists) {
  const size_t total = lists->used + s->across_count;
  size_t *start = malloc((s->n + 1) * sizeof *start), at = 0;
  uint32_t *more = calloc(s->n + 1, sizeof *more), *j = malloc((total + 1) * sizeof *j);
  const bool enough = start && more && j;
  if (enough) {
    for (size_t m = 0; m < s->across_count; m++)
      more[s->across[m][0]]++;
    for (size_t i = 0; i < s->n; i++) {
      start[i] = at;
      memcpy(j + at, lists->j + lists->start[i], lists->count[i] * sizeof *j);
      at += lists->count[i] + more[i];
    }
    for (size_t m = 0; m < s->across_count; m++) {
      const uint32_t i = s->across[m][0];
      j[start[i] + lists->count[i]++] = s->across[m][1];
    }
    free(lists->j);
    lists->j = j;
    lists->used = total;
    lists->capacity = total + 1;
    memcpy(lists->start, start, s->n * sizeof *start);
  } else {
    free(j);
  }
  free(start);
  free(more);
  return enough;
}

static bool make_lists(struct sph_neighbours *lists, size_t n) {
  if (lists->n >= n && lists->start) return true;
  size_t *start = realloc(lists->start, (n + 1) * sizeof *start);
  if (start) lists->start = start;
  uint32_t *count = realloc(lists->count, (n + 1) * sizeof *count);
  if (count) lists->count = count;
  if (start && count) lists->n = n;
  return start && count;
}

status sph_neighbours_find(size_t n, const double *x, const double *y, const double *z, const double *reach,
                           const double periodic[3], const struct sph_pair_kernels *kernels, struct sph_neighbours *lists,
                           struct error *error) {
  struct search s = {.n = n, .given = {x, y, z, reach}};
  status code = STATUS_OK;
  double *reals = malloc(4 * (n + PAD) * sizeof *reals);
  s.id = calloc(n + PAD, sizeof *s.id);
  s.level_of = malloc(n + 1);
  lists->used = 0;
  bool enough = reals && s.id && s.level_of && make_lists(lists, n);
  if (enough && n) code = set_levels(&s, reach, periodic, error);
  if (!enough || code || !n) goto cleanup;
  memset(reals, 0, 4 * (n + PAD) * sizeof *reals);
  s.x = reals, s.y = s.x + n + PAD, s.z = s.y + n + PAD, s.reach = s.z + n + PAD;
  sort(&s, x, y, z, reach);
  for (size_t l = 0; l < s.levels && enough; l++)
    for (size_t m = l; m < s.levels && enough; m++) {
      const struct level *level = &s.level[m];
      const size_t end = s.level[l].first + s.level[l].count;
      for (size_t first = s.level[l].first, next = first; first < end && enough; first = next) {
        int64_t cell[3], other[3];
        cell_of(level, s.x[first], s.y[first], s.z[first], cell);
        do {
          if (++next < end) cell_of(level, s.x[next], s.y[next], s.z[next], other);
        } while (next < end && memcmp(cell, other, sizeof cell) == 0);
        enough = gather(&s, first, next, level, cell, periodic, kernels, l == m);
        for (size_t k = first; k < next && enough; k++)
          enough = look(&s, k, l == m, periodic, kernels, lists);
      }
    }
  if (enough && s.across_count) enough = merge(&s, lists);
cleanup:
  if (!code && !enough) code = status_fail(error, STATUS_MEMORY, "no memory to find the neighbours of %zu particles", n);
  free(reals);
  free(s.id);
  free(s.level_of);
  free(s.start);
  free(s.across);
  free(s.near.place);
  free(s.near.reals);
  return code;
}

void sph_neighbours_clear(struct sph_neighbours *lists) {
  free(lists->start);
  free(lists->count);
  free(lists->j);
  *lists = (struct sph_neighbours){0};
}
