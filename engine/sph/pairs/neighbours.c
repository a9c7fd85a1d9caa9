/* The tree of boxes, and the search in it (lists.h).
 *
 *   level 2    [........]                     nodes of eight boxes side by side
 *   level 1    [........][........] ...       each box of a level holds one node of the level below
 *   level 0    [........][........] ...       leaf boxes of up to LEAF particles; a node belongs to one chunk
 *
 * The top level has at most TOP nodes. A search starts with all of them; the kernels test eight boxes at a time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/sph/pairs/lists.h"

#include "engine/sph/pairs/pairs.h"
#include "schemas/memory.h"

#include "engine/grow.h"

enum { LEAF = 16 /* a multiple of any per_list */, BOXES = 8, LEVELS = 12, TOP = 8 };
/* Largest side of a leaf box, in reaches: a fragment far away gets a leaf of its own and widens no box. */
static const double widest = 4;
static const struct sph_near_box no_box = {{NAN, NAN, NAN}, {0}, 0};

struct sph_neighbours {
  const struct sph_pair_kernels *kernels;
  size_t chunk, chunks, per_list;
  size_t levels, nodes[LEVELS]; /* number of nodes on each level */
  size_t level_first[LEVELS];   /* the first node of a level in `box` */
  struct sph_near_boxes *box;
  size_t *chunk_node;   /* by chunk: its first node on level 0 */
  uint32_t *leaf_first; /* by leaf, empty ones included: first particle and number of particles */
  uint8_t *leaf_size;
  size_t box_capacity, leaf_capacity, size_capacity;
  struct sph_near_particles particles;
  double period[3];
};

struct sph_neighbours *sph_neighbours_create(size_t n, size_t chunk, size_t per_list,
                                             const struct sph_pair_kernels *kernels) {
  struct sph_neighbours *s = memory_small(1, sizeof *s);
  s->kernels = kernels;
  s->chunk = chunk;
  s->per_list = per_list;
  s->chunk_node = calloc(n / chunk + 2, sizeof *s->chunk_node);
  if (!s->chunk_node) {
    free(s);
    return NULL;
  }
  return s;
}

void sph_neighbours_free(struct sph_neighbours *s) {
  if (!s)
    return;
  free(s->box);
  free(s->chunk_node);
  free(s->leaf_first);
  free(s->leaf_size);
  free(s);
}

struct bounds {
  double low[3], high[3], reach;
};
static const struct bounds nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};

/* Bounds that also hold particle i. */
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

/* The end of the leaf that begins at `first`, and its bounds. Particles that share a list stay in one leaf unless they
 * are far apart. */
static size_t take_leaf(const struct sph_neighbours *s, size_t first, size_t last, struct bounds *out) {
  struct bounds whole = nothing, all = nothing; /* of complete lists' particles; of all so far */
  const size_t full = first - first % s->per_list + LEAF;
  size_t end = first;
  for (; end < last && end < full; end++) {
    const struct bounds more = widen(all, &s->particles, end);
    const size_t cut = end - end % s->per_list;
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

/* The box round some bounds, enlarged by rounding errors. An infinite box is near everything. */
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
  for (int d = 0; d < 3; d++) {
    to->middle[d][lane] = box->middle[d];
    to->half[d][lane] = box->half[d];
  }
  to->reach[lane] = box->reach;
}
static struct sph_near_box get(const struct sph_near_boxes *from, size_t lane) {
  struct sph_near_box box = {.reach = from->reach[lane]};
  for (int d = 0; d < 3; d++) {
    box.middle[d] = from->middle[d][lane];
    box.half[d] = from->half[d][lane];
  }
  return box;
}

static size_t count_leaves(const struct sph_neighbours *s, size_t first, size_t last) {
  struct bounds b;
  size_t count = 0;
  for (; first < last; count++)
    first = take_leaf(s, first, last, &b);
  return count;
}

static void make_leaves(struct sph_neighbours *s, size_t chunk, size_t last) {
  size_t first = chunk * s->chunk;
  for (size_t g = BOXES * s->chunk_node[chunk]; g < BOXES * s->chunk_node[chunk + 1]; g++) {
    struct bounds b;
    struct sph_near_box box = no_box;
    s->leaf_first[g] = (uint32_t)first;
    s->leaf_size[g] = 0;
    if (first < last) {
      const size_t end = take_leaf(s, first, last, &b);
      s->leaf_size[g] = (uint8_t)(end - first);
      first = end;
      box = make_box(&b);
      for (int d = 0; d < 3; d++)
        if (!(b.low[d] <= b.high[d]))
          box = no_box;
    }
    put(&s->box[g / BOXES], g % BOXES, &box);
  }
}

/* One box round the eight of a node. */
static struct sph_near_box surround(const struct sph_near_boxes *node) {
  struct bounds b = nothing;
  for (size_t lane = 0; lane < BOXES; lane++) {
    const struct sph_near_box one = get(node, lane);
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
  return b.low[0] <= b.high[0] ? make_box(&b) : no_box;
}

static void make_level(struct sph_neighbours *s, size_t level) {
  const size_t below = s->nodes[level - 1];
  for (size_t k = 0; k < BOXES * s->nodes[level]; k++) {
    const struct sph_near_box box = k < below ? surround(&s->box[s->level_first[level - 1] + k]) : no_box;
    put(&s->box[s->level_first[level] + k / BOXES], k % BOXES, &box);
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
  TRY(check_periods(s, reach, n, periodic, error));
  (void)threads;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (size_t k = 0; k < s->chunks; k++) {
    const size_t last = (k + 1) * s->chunk < n ? (k + 1) * s->chunk : n;
    s->chunk_node[k + 1] = (count_leaves(s, k * s->chunk, last) + BOXES - 1) / BOXES;
  }
  for (size_t k = 0; k < s->chunks; k++)
    s->chunk_node[k + 1] += s->chunk_node[k];
  size_t boxes = 0;
  s->levels = 0;
  for (size_t count = s->chunk_node[s->chunks]; s->levels == 0 || s->nodes[s->levels - 1] > TOP;
       count = (count + BOXES - 1) / BOXES) {
    s->nodes[s->levels] = count;
    s->level_first[s->levels++] = boxes;
    boxes += count;
  }
  const size_t leaves = BOXES * s->nodes[0];
  if (!grow_aligned(&s->box, &s->box_capacity, boxes, sizeof *s->box, 0) ||
      !grow_aligned(&s->leaf_first, &s->leaf_capacity, leaves, sizeof *s->leaf_first, 0) ||
      !grow_aligned(&s->leaf_size, &s->size_capacity, leaves, sizeof *s->leaf_size, 0))
    return status_fail(error, STATUS_MEMORY, "no memory to find the neighbours of %zu particles", n);
  s->particles.first = s->leaf_first;
  s->particles.size = s->leaf_size;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (size_t k = 0; k < s->chunks; k++)
    make_leaves(s, k, (k + 1) * s->chunk < n ? (k + 1) * s->chunk : n);
  for (size_t level = 1; level < s->levels; level++)
    make_level(s, level);
  return STATUS_OK;
}

/* Working memory of a search. */
struct search {
  uint32_t *node[2], *leaf; /* nodes of two levels, leaves */
  size_t node_capacity[2], leaf_capacity;
  double *real;     /* x y z reach of candidates, `row` each */
  uint32_t *number; /* of candidates, counted from the first of the chunk */
  uint32_t *joined; /* a list whose particles are in two leaves */
  size_t real_capacity, number_capacity, joined_capacity;
};

/* Finds the nodes of level 0, from `node` on, that may hold neighbours of its leaves. */
static bool find_nodes(const struct sph_neighbours *s, size_t node, struct search *w, const uint32_t **found,
                       size_t *count) {
  const struct sph_near_box own = surround(&s->box[node]);
  size_t used = s->nodes[s->levels - 1], from = 0;
  if (!grow_aligned(&w->node[0], &w->node_capacity[0], used, sizeof **w->node, 0))
    return false;
  for (size_t k = 0; k < used; k++)
    w->node[0][k] = (uint32_t)k;
  for (size_t level = s->levels; level-- > 1; from = 1 - from) {
    const uint32_t lowest = (uint32_t)(node >> 3 * (level - 1));
    if (!grow_aligned(&w->node[1 - from], &w->node_capacity[1 - from], BOXES * used, sizeof **w->node, 0))
      return false;
    used = s->kernels->near_boxes(s->box + s->level_first[level], w->node[from], used, &own, s->period, lowest,
                                  w->node[1 - from]);
  }
  *found = w->node[from];
  *count = used;
  return true;
}

/* Finds the candidates of a leaf: its own particles, then all later ones that may be neighbours of one of them. */
static bool find_candidates(const struct sph_neighbours *s, size_t chunk, size_t leaf, const uint32_t *nodes,
                            size_t count, struct search *w, double *at[4], size_t *candidates) {
  const struct sph_near_box own = get(&s->box[leaf / BOXES], leaf % BOXES);
  const size_t first = s->leaf_first[leaf], size = s->leaf_size[leaf];
  if (!grow_aligned(&w->leaf, &w->leaf_capacity, BOXES * count, sizeof *w->leaf, 0))
    return false;
  const size_t leaves = s->kernels->near_boxes(s->box, nodes, count, &own, s->period, (uint32_t)leaf + 1, w->leaf);
  const size_t row = (leaves + 1) * (LEAF + 1) + BOXES;
  if (!grow_aligned(&w->real, &w->real_capacity, 4 * row, sizeof *w->real, 0) ||
      !grow_aligned(&w->number, &w->number_capacity, row, sizeof *w->number, 0))
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
                s->kernels->near_particles(&s->particles, w->leaf, leaves, &own, s->period, rest, w->number + size);
  for (size_t k = 0; k < *candidates; k++)
    w->number[k] -= (uint32_t)(chunk * s->chunk);
  for (int d = 0; d < 4; d++)
    memset(at[d] + *candidates, 0, BOXES * sizeof *w->real);
  memset(w->number + *candidates, 0, BOXES * sizeof *w->number);
  return true;
}

/* Merges the ascending list `more` into the ascending `list`; an entry of both has the tags of both. */
static bool join(struct search *w, uint32_t *list, size_t count, const uint32_t *more, size_t more_count,
                 size_t *out_count) {
  if (!grow_aligned(&w->joined, &w->joined_capacity, count + more_count, sizeof *w->joined, 0))
    return false;
  size_t used = 0;
  for (size_t a = 0, b = 0; a < count || b < more_count; used++) {
    const uint32_t left = a < count ? list[a] & SPH_NUMBER : UINT32_MAX,
                   right = b < more_count ? more[b] & SPH_NUMBER : UINT32_MAX;
    w->joined[used] = (left <= right ? list[a] : 0) | (right <= left ? more[b] : 0);
    a += left <= right;
    b += right <= left;
  }
  if (used)
    memcpy(list, w->joined, used * sizeof *list);
  *out_count = used;
  return true;
}

/* Appends the lists of a leaf. The first of them may have begun in the leaf before. */
static bool list_leaf(const struct sph_neighbours *s, size_t leaf, size_t first, double *const at[4], size_t candidates,
                      struct search *w, struct sph_neighbour_lists *lists, size_t *used) {
  const size_t size = s->leaf_size[leaf], base = s->leaf_first[leaf] - first;
  const size_t needed = *used + (size + 1) * (candidates + 2 * SPH_LIST_ALIGN);
  if (needed > lists->capacity && !grow_aligned(&lists->j, &lists->capacity, 2 * needed, sizeof *lists->j, *used))
    return false;
  double own[LEAF][4];
  for (size_t k = 0; k < size; k++)
    for (int d = 0; d < 4; d++)
      own[k][d] = at[d][k];
  for (size_t k = 0, next = 0; k < size; k = next) {
    const size_t list = (base + k) / s->per_list, before = (base + k) % s->per_list;
    next = k + s->per_list - before < size ? k + s->per_list - before : size;
    double *const others[4] = {at[0] + k + 1, at[1] + k + 1, at[2] + k + 1, at[3] + k + 1};
    size_t begin = *used,
           count = s->kernels->near_pairs(candidates - k - 1, others, w->number + k + 1, (const double(*)[4])own + k,
                                          next - k, s->period, s->per_list > 1 ? 1U << (SPH_TAGS + before) : 0,
                                          lists->j + *used, &lists->pairs);
    if (before) {
      begin = lists->start[list];
      if (!join(w, lists->j + begin, lists->count[list], lists->j + *used, count, &count))
        return false;
    }
    size_t end = begin + count;
    for (; end % SPH_LIST_ALIGN; end++)
      lists->j[end] = (uint32_t)(list * s->per_list);
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
  bool enough = grow_aligned(&lists->j, &lists->capacity, 1, sizeof *lists->j, 0);
  lists->start[0] = 0;
  lists->pairs = 0;
  for (size_t node = s->chunk_node[chunk]; enough && node < s->chunk_node[chunk + 1]; node++) {
    const uint32_t *nodes;
    size_t count, candidates;
    enough = find_nodes(s, node, &w, &nodes, &count);
    for (size_t lane = 0; enough && lane < BOXES && s->leaf_size[BOXES * node + lane]; lane++) {
      double *at[4];
      enough = find_candidates(s, chunk, BOXES * node + lane, nodes, count, &w, at, &candidates) &&
               list_leaf(s, BOXES * node + lane, first, at, candidates, &w, lists, &used);
    }
  }
  free(w.node[0]);
  free(w.node[1]);
  free(w.leaf);
  free(w.real);
  free(w.number);
  free(w.joined);
  return enough;
}
