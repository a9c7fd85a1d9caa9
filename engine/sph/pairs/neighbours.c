#include "engine/sph/pairs/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GROUP = 16 /* a multiple of any share */, EIGHT = 8, LEVELS = 12, TOP = 8, LINE = 64 };
static const double widest = 4; /* of a group, in reaches: a fragment far off stands alone and does not widen a box */

/* Level 0: groups of particles, in eights that belong to one chunk. Level l + 1: eights of level l. */
struct sph_neighbours {
  const struct sph_pair_kernels *kernels;
  size_t chunk, chunks, share;
  size_t levels, eights[LEVELS]; /* how many there are of each */
  size_t first_eight[LEVELS];    /* where they stand in `box` */
  struct sph_near_boxes *box;
  size_t *chunk_at;      /* by chunk: its first eight of groups */
  uint32_t *group_first; /* by group, those that are not there included */
  uint8_t *group_size;
  size_t box_capacity, group_capacity, size_capacity;
  struct sph_near_particles particles;
  double period[3];
};

static bool grow(void **array, size_t *capacity, size_t wanted, size_t keep, size_t size) {
  if (wanted <= *capacity)
    return true;
  const size_t more = wanted + wanted / 8 + LINE;
  void *grown = aligned_alloc(LINE, (more * size + LINE - 1) / LINE * LINE);
  if (!grown)
    return false;
  if (keep)
    memcpy(grown, *array, keep * size);
  free(*array);
  *array = grown;
  *capacity = more;
  return true;
}

struct sph_neighbours *sph_neighbours_create(size_t n, size_t chunk, size_t share,
                                             const struct sph_pair_kernels *kernels) {
  struct sph_neighbours *s = calloc(1, sizeof *s);
  if (!s)
    return NULL;
  s->kernels = kernels;
  s->chunk = chunk;
  s->share = share;
  s->chunk_at = calloc(n / chunk + 2, sizeof *s->chunk_at);
  if (s->chunk_at)
    return s;
  free(s);
  return NULL;
}

void sph_neighbours_free(struct sph_neighbours *s) {
  if (!s)
    return;
  free(s->box);
  free(s->chunk_at);
  free(s->group_first);
  free(s->group_size);
  free(s);
}

size_t sph_neighbours_bytes(const struct sph_neighbours *s) {
  return sizeof *s + s->box_capacity * sizeof *s->box + s->group_capacity * sizeof *s->group_first + s->size_capacity;
}

struct bounds {
  double low[3], high[3], reach;
};
static const struct bounds nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};

static struct bounds widen(struct bounds b, const struct sph_near_particles *p, size_t i) {
  b.reach = p->reach[i] > b.reach ? p->reach[i] : b.reach;
  for (int d = 0; d < 3; d++) {
    const double at = p->place[d][i];
    b.low[d] = at < b.low[d] ? at : b.low[d];
    b.high[d] = at > b.high[d] ? at : b.high[d];
  }
  return b;
}

static bool is_wide(const struct bounds *b) {
  const double most = widest * b->reach;
  return b->high[0] - b->low[0] > most || b->high[1] - b->low[1] > most || b->high[2] - b->low[2] > most;
}

/* The end of the group that begins at `first`. Those that share a list stay together, but when they are far apart. */
static size_t take_group(const struct sph_neighbours *s, size_t first, size_t last, struct bounds *out) {
  struct bounds whole = nothing, all = nothing; /* of full shares, of all so far */
  const size_t full = first - first % s->share + GROUP;
  size_t end = first;
  for (; end < last && end < full; end++) {
    const struct bounds more = widen(all, &s->particles, end);
    const size_t cut = end - end % s->share;
    if (end == cut)
      whole = all;
    if (end > first && is_wide(&more)) {
      *out = cut > first ? whole : all;
      return cut > first ? cut : end;
    }
    all = more;
  }
  *out = all;
  return end;
}

/* Everything within bounds, rounding allowed for. Nothing at all: NaN, which is near nothing; what is beyond all
 * measure is near everything. */
static struct sph_near_box make_box(const struct bounds *b) {
  struct sph_near_box box = {.reach = b->reach * (1 + 1e-12)};
  for (int d = 0; d < 3; d++) {
    if (b->low[d] < -1e100 || b->high[d] > 1e100)
      return (struct sph_near_box){.reach = INFINITY};
    box.middle[d] = 0.5 * (b->low[d] + b->high[d]);
    box.half[d] = 0.5 * (b->high[d] - b->low[d]);
    box.reach += 1e-15 * (fabs(b->low[d]) + fabs(b->high[d]));
  }
  return box;
}

static void put(struct sph_near_boxes *to, size_t lane, const struct sph_near_box *box) {
  for (int d = 0; d < 3; d++)
    to->middle[d][lane] = box->middle[d], to->half[d][lane] = box->half[d];
  to->reach[lane] = box->reach;
}
static struct sph_near_box get(const struct sph_near_boxes *from, size_t lane) {
  struct sph_near_box box = {.reach = from->reach[lane]};
  for (int d = 0; d < 3; d++)
    box.middle[d] = from->middle[d][lane], box.half[d] = from->half[d][lane];
  return box;
}

static size_t count_groups(const struct sph_neighbours *s, size_t first, size_t last) {
  struct bounds b;
  size_t count = 0;
  for (; first < last; count++)
    first = take_group(s, first, last, &b);
  return count;
}

static void make_groups(struct sph_neighbours *s, size_t chunk, size_t last) {
  const struct sph_near_box none = {{NAN, NAN, NAN}, {0}, 0};
  size_t first = chunk * s->chunk;
  for (size_t g = EIGHT * s->chunk_at[chunk]; g < EIGHT * s->chunk_at[chunk + 1]; g++) {
    struct bounds b;
    struct sph_near_box box = none;
    s->group_first[g] = (uint32_t)first;
    s->group_size[g] = 0;
    if (first < last) {
      const size_t end = take_group(s, first, last, &b);
      s->group_size[g] = (uint8_t)(end - first);
      first = end;
      box = make_box(&b);
      for (int d = 0; d < 3; d++)
        if (!(b.low[d] <= b.high[d]))
          box = none;
    }
    put(&s->box[g / EIGHT], g % EIGHT, &box);
  }
}

/* One box round eight. */
static struct sph_near_box surround(const struct sph_near_boxes *eight) {
  struct bounds b = nothing;
  for (size_t lane = 0; lane < EIGHT; lane++) {
    const struct sph_near_box one = get(eight, lane);
    if (isnan(one.middle[0]))
      continue;
    if (isinf(one.reach))
      return one;
    b.reach = one.reach > b.reach ? one.reach : b.reach;
    for (int d = 0; d < 3; d++) {
      b.low[d] = fmin(b.low[d], one.middle[d] - one.half[d]);
      b.high[d] = fmax(b.high[d], one.middle[d] + one.half[d]);
    }
  }
  return b.low[0] <= b.high[0] ? make_box(&b) : (struct sph_near_box){{NAN, NAN, NAN}, {0}, 0};
}

static void make_level(struct sph_neighbours *s, size_t level) {
  const struct sph_near_box none = {{NAN, NAN, NAN}, {0}, 0};
  const size_t below = s->eights[level - 1];
  for (size_t k = 0; k < EIGHT * s->eights[level]; k++) {
    const struct sph_near_box box = k < below ? surround(&s->box[s->first_eight[level - 1] + k]) : none;
    put(&s->box[s->first_eight[level] + k / EIGHT], k % EIGHT, &box);
  }
}

static status check_periods(struct sph_neighbours *s, const double *reach, size_t n, const double periodic[3],
                            struct error *error) {
  double largest = 0;
  bool wrapped = false;
  for (int d = 0; d < 3; d++) {
    s->period[d] = periodic[d];
    wrapped |= !isnan(periodic[d]);
  }
  for (size_t i = 0; wrapped && i < n; i++)
    largest = reach[i] > largest && isfinite(reach[i]) ? reach[i] : largest;
  for (int d = 0; d < 3; d++)
    if (periodic[d] < 4 * largest)
      return status_fail(
          error, STATUS_CONTENT,
          "a periodic box of %.4g m is too thin for its particles: it must hold twice their reach, %.4g m", periodic[d],
          4 * largest);
  return STATUS_OK;
}

status sph_neighbours_find(struct sph_neighbours *s, size_t n, const double *x, const double *y, const double *z,
                           const double *reach, const double periodic[3], int threads, struct error *error) {
  s->particles = (struct sph_near_particles){.place = {x, y, z}, .reach = reach};
  s->chunks = (n + s->chunk - 1) / s->chunk;
  const status code = check_periods(s, reach, n, periodic, error);
  if (code)
    return code;
  (void)threads;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
#endif
  for (size_t k = 0; k < s->chunks; k++) {
    const size_t last = (k + 1) * s->chunk < n ? (k + 1) * s->chunk : n;
    s->chunk_at[k + 1] = (count_groups(s, k * s->chunk, last) + EIGHT - 1) / EIGHT;
  }
  for (size_t k = 0; k < s->chunks; k++)
    s->chunk_at[k + 1] += s->chunk_at[k];
  size_t boxes = 0;
  s->levels = 0;
  for (size_t count = s->chunk_at[s->chunks]; s->levels == 0 || s->eights[s->levels - 1] > TOP;
       count = (count + EIGHT - 1) / EIGHT) {
    s->eights[s->levels] = count;
    s->first_eight[s->levels++] = boxes;
    boxes += count;
  }
  const size_t groups = EIGHT * s->eights[0];
  if (!grow((void **)&s->box, &s->box_capacity, boxes, 0, sizeof *s->box) ||
      !grow((void **)&s->group_first, &s->group_capacity, groups, 0, sizeof *s->group_first) ||
      !grow((void **)&s->group_size, &s->size_capacity, groups, 0, sizeof *s->group_size))
    return status_fail(error, STATUS_MEMORY, "no memory to find the neighbours of %zu particles", n);
  s->particles.first = s->group_first;
  s->particles.size = s->group_size;
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
#endif
  for (size_t k = 0; k < s->chunks; k++)
    make_groups(s, k, (k + 1) * s->chunk < n ? (k + 1) * s->chunk : n);
  for (size_t level = 1; level < s->levels; level++)
    make_level(s, level);
  return STATUS_OK;
}

/* What a search has found so far. */
struct search {
  uint32_t *eight[2], *group; /* numbers of boxes */
  size_t eight_capacity[2], group_capacity;
  double *real;     /* x y z reach of candidates, `row` each */
  uint32_t *number; /* of candidates: from the chunk's first one on */
  uint32_t *joint;  /* a list that began in the group before */
  size_t real_capacity, number_capacity, joint_capacity;
};

/* The eights of groups that may hold neighbours of the groups of `eight`, that one first. */
static bool find_eights(const struct sph_neighbours *s, size_t eight, struct search *w, const uint32_t **found,
                        size_t *count) {
  const struct sph_near_box own = surround(&s->box[eight]);
  size_t used = s->eights[s->levels - 1], from = 0;
  if (!grow((void **)&w->eight[0], &w->eight_capacity[0], used, 0, sizeof **w->eight))
    return false;
  for (size_t k = 0; k < used; k++)
    w->eight[0][k] = (uint32_t)k;
  for (size_t level = s->levels; level-- > 1; from = 1 - from) {
    const uint32_t lowest = (uint32_t)(eight >> 3 * (level - 1));
    if (!grow((void **)&w->eight[1 - from], &w->eight_capacity[1 - from], EIGHT * used, 0, sizeof **w->eight))
      return false;
    used = s->kernels->near_boxes(s->box + s->first_eight[level], w->eight[from], used, &own, s->period, lowest,
                                  w->eight[1 - from]);
  }
  *found = w->eight[from];
  *count = used;
  return true;
}

/* Those of the group itself, then all that may be neighbours of one of them. */
static bool find_candidates(const struct sph_neighbours *s, size_t chunk, size_t group, const uint32_t *eights,
                            size_t count, struct search *w, double *at[4], size_t *candidates) {
  const struct sph_near_box own = get(&s->box[group / EIGHT], group % EIGHT);
  const size_t first = s->group_first[group], size = s->group_size[group];
  if (!grow((void **)&w->group, &w->group_capacity, EIGHT * count, 0, sizeof *w->group))
    return false;
  const size_t groups = s->kernels->near_boxes(s->box, eights, count, &own, s->period, (uint32_t)group + 1, w->group);
  const size_t row = (groups + 1) * (GROUP + 1) + EIGHT;
  if (!grow((void **)&w->real, &w->real_capacity, 4 * row, 0, sizeof *w->real) ||
      !grow((void **)&w->number, &w->number_capacity, row, 0, sizeof *w->number))
    return false;
  double *rest[4];
  for (int d = 0; d < 4; d++) {
    at[d] = w->real + (size_t)d * row;
    rest[d] = at[d] + size;
    memcpy(at[d], (d < 3 ? s->particles.place[d] : s->particles.reach) + first, size * sizeof *w->real);
  }
  for (size_t k = 0; k < size; k++)
    w->number[k] = (uint32_t)(first + k);
  *candidates = size +
                s->kernels->near_particles(&s->particles, w->group, groups, &own, s->period, rest, w->number + size);
  for (size_t k = 0; k < *candidates; k++)
    w->number[k] -= (uint32_t)(chunk * s->chunk);
  for (int d = 0; d < 4; d++)
    memset(at[d] + *candidates, 0, EIGHT * sizeof *w->real);
  memset(w->number + *candidates, 0, EIGHT * sizeof *w->number);
  return true;
}

/* Joins two ascending lists, the second of which stands at `more`, in the place of the first; with the tags of both. */
static bool join(struct search *w, uint32_t *list, size_t count, const uint32_t *more, size_t more_count,
                 size_t *joined) {
  if (!grow((void **)&w->joint, &w->joint_capacity, count + more_count, 0, sizeof *w->joint))
    return false;
  size_t used = 0;
  for (size_t a = 0, b = 0; a < count || b < more_count; used++) {
    const uint32_t left = a < count ? list[a] & SPH_NUMBER : UINT32_MAX,
                   right = b < more_count ? more[b] & SPH_NUMBER : UINT32_MAX;
    w->joint[used] = (left <= right ? list[a] : 0) | (right <= left ? more[b] : 0);
    a += left <= right;
    b += right <= left;
  }
  if (used)
    memcpy(list, w->joint, used * sizeof *list);
  *joined = used;
  return true;
}

/* The lists of a group, of which the first may have begun in the group before. */
static bool list_group(const struct sph_neighbours *s, size_t group, size_t first, double *const at[4],
                       size_t candidates, struct search *w, struct sph_neighbour_lists *lists, size_t *used) {
  const size_t size = s->group_size[group], base = s->group_first[group] - first,
               room = candidates + 2 * SPH_LIST_ALIGN;
  const size_t needed = *used + (size + 1) * room;
  if (needed > lists->capacity && !grow((void **)&lists->j, &lists->capacity, 2 * needed, *used, sizeof *lists->j))
    return false;
  double own[GROUP][4];
  for (size_t k = 0; k < size; k++)
    for (int d = 0; d < 4; d++)
      own[k][d] = at[d][k];
  for (size_t k = 0, next = 0; k < size; k = next) {
    const size_t list = (base + k) / s->share, before = (base + k) % s->share;
    next = k + s->share - before < size ? k + s->share - before : size;
    double *const others[4] = {at[0] + k + 1, at[1] + k + 1, at[2] + k + 1, at[3] + k + 1};
    size_t begin = *used,
           count = s->kernels->near_pairs(candidates - k - 1, others, w->number + k + 1, (const double(*)[4])own + k,
                                          next - k, s->period, s->share > 1 ? 1U << (SPH_TAGS + before) : 0,
                                          lists->j + *used, &lists->pairs);
    if (before) {
      begin = lists->start[list];
      if (!join(w, lists->j + begin, lists->count[list], lists->j + *used, count, &count))
        return false;
    }
    size_t end = begin + count;
    for (; end % SPH_LIST_ALIGN; end++)
      lists->j[end] = (uint32_t)(list * s->share);
    lists->start[list] = (uint32_t)begin;
    lists->count[list] = (uint32_t)count;
    lists->start[list + 1] = (uint32_t)end;
    *used = end;
  }
  return true;
}

bool sph_neighbours_list(const struct sph_neighbours *s, size_t chunk, struct sph_neighbour_lists *lists) {
  struct search w = {0};
  const size_t first = chunk * s->chunk;
  size_t used = 0;
  bool enough = grow((void **)&lists->j, &lists->capacity, 1, 0, sizeof *lists->j);
  lists->start[0] = 0;
  lists->pairs = 0;
  for (size_t eight = s->chunk_at[chunk]; enough && eight < s->chunk_at[chunk + 1]; eight++) {
    const uint32_t *eights;
    size_t count, candidates;
    enough = find_eights(s, eight, &w, &eights, &count);
    for (size_t lane = 0; enough && lane < EIGHT && s->group_size[EIGHT * eight + lane]; lane++) {
      double *at[4];
      enough = find_candidates(s, chunk, EIGHT * eight + lane, eights, count, &w, at, &candidates) &&
               list_group(s, EIGHT * eight + lane, first, at, candidates, &w, lists, &used);
    }
  }
  free(w.eight[0]);
  free(w.eight[1]);
  free(w.group);
  free(w.real);
  free(w.number);
  free(w.joint);
  return enough;
}
