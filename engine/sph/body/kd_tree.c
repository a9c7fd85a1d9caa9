/* Building the tree, and searching it. */
#include "engine/sph/body/kd_tree.h"

#include <math.h>
#include <stdlib.h>

#include "engine/grow.h"

enum { LEAF = 8, DEEPEST = 64 };

/* Node k covers consecutive points. A plane across its widest direction halves them between the nodes 2k + 1 and 2k
 * + 2. */
struct node {
  double plane;
  int direction;
};

/* One block of memory, with the arrays behind the struct. */
struct sph_kd_tree {
  size_t n, inner; /* nodes with children: 0 .. inner - 1 */
  struct node *node;
  double (*at)[3];
  uint32_t *id; /* of at[k] */
};

static void swap(struct sph_kd_tree *t, size_t a, size_t b) {
  const double x = t->at[a][0], y = t->at[a][1], z = t->at[a][2];
  const uint32_t id = t->id[a];
  for (int k = 0; k < 3; k++)
    t->at[a][k] = t->at[b][k];
  t->id[a] = t->id[b];
  t->at[b][0] = x;
  t->at[b][1] = y;
  t->at[b][2] = z;
  t->id[b] = id;
}

/* Quickselect: afterwards no coordinate before `middle` is larger, and none after it smaller, than that at `middle`. */
static void halve(struct sph_kd_tree *t, size_t low, size_t high, size_t middle, int direction) {
  while (high - low > 1) {
    const double a = t->at[low][direction], b = t->at[low + (high - low) / 2][direction],
                 c = t->at[high - 1][direction];
    const double pivot = fmax(fmin(a, b), fmin(fmax(a, b), c));
    size_t i = low, j = high - 1;
    while (i <= j) {
      while (t->at[i][direction] < pivot)
        i++;
      while (t->at[j][direction] > pivot)
        j--;
      if (i > j)
        break;
      swap(t, i, j);
      i++;
      if (!j)
        break;
      j--;
    }
    if (middle <= j)
      high = j + 1;
    else if (middle >= i)
      low = i;
    else
      return;
  }
}

static void build(struct sph_kd_tree *t, size_t k, size_t low, size_t high) {
  if (k >= t->inner)
    return;
  double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t i = low; i < high; i++)
    for (int d = 0; d < 3; d++) {
      least[d] = fmin(least[d], t->at[i][d]);
      most[d] = fmax(most[d], t->at[i][d]);
    }
  int direction = 0;
  for (int d = 1; d < 3; d++)
    if (most[d] - least[d] > most[direction] - least[direction])
      direction = d;
  const size_t middle = low + (high - low) / 2;
  halve(t, low, high, middle, direction);
  t->node[k] = (struct node){t->at[middle][direction], direction};
  build(t, 2 * k + 1, low, middle);
  build(t, 2 * k + 2, middle, high);
}

status sph_kd_tree_create(size_t n, const double *x, const double *y, const double *z, struct sph_kd_tree **out,
                          struct error *error) {
  *out = NULL;
  size_t leaves = 1;
  while (leaves * LEAF < n)
    leaves *= 2;
  struct sph_kd_tree *t = malloc(sizeof *t + leaves * sizeof *t->node + n * (sizeof *t->at + sizeof *t->id));
  if (!t)
    return status_fail(error, STATUS_MEMORY, "no memory to search among %zu particles", n);
  *t = (struct sph_kd_tree){.n = n, .inner = leaves - 1, .node = (struct node *)(t + 1)};
  t->at = (double(*)[3])(t->node + leaves);
  t->id = (uint32_t *)(t->at + n);
  for (size_t i = 0; i < n; i++) {
    t->at[i][0] = x[i];
    t->at[i][1] = y[i];
    t->at[i][2] = z[i];
    t->id[i] = (uint32_t)i;
  }
  build(t, 0, 0, n);
  *out = t;
  return STATUS_OK;
}

void sph_kd_tree_free(struct sph_kd_tree *t) {
  free(t);
}

/* A part of the tree that is still to be searched: the squared distance of its box from the point, and per direction.
 */
struct part {
  size_t k, low, high;
  double squares, away[3];
};

/* Goes down to the leaf on the point's side. The other halves that are within `reach` (squared) go to the stack. */
static inline struct part descend(const struct sph_kd_tree *t, const double p[3], struct part part, double reach,
                                  struct part *stack, int *depth) {
  while (part.k < t->inner) {
    const struct node node = t->node[part.k];
    const double beyond = p[node.direction] - node.plane, before = part.away[node.direction];
    const double squares = part.squares + beyond * beyond - before * before;
    const size_t middle = part.low + (part.high - part.low) / 2;
    const bool upper = beyond >= 0;
    if (squares <= reach) {
      struct part *other = &stack[(*depth)++];
      *other = part;
      other->k = 2 * part.k + (upper ? 1 : 2);
      *(upper ? &other->high : &other->low) = middle;
      other->squares = squares;
      other->away[node.direction] = beyond;
    }
    part.k = 2 * part.k + (upper ? 2 : 1);
    *(upper ? &part.low : &part.high) = middle;
  }
  return part;
}

static inline void best_of(const struct sph_kd_tree *t, const double p[3], size_t low, size_t high, size_t self,
                           double *best, size_t *id) {
  for (size_t i = low; i < high; i++) {
    const double dx = p[0] - t->at[i][0], dy = p[1] - t->at[i][1], dz = p[2] - t->at[i][2];
    const double squares = dx * dx + dy * dy + dz * dz;
    if (squares > *best || t->id[i] == self || (squares == *best && t->id[i] > *id))
      continue;
    *best = squares;
    *id = t->id[i];
  }
}

static const double rounding = 1 + 1e-12; /* error of the running sum of squares, which must not hide a tie */

size_t sph_kd_tree_other(const struct sph_kd_tree *t, const double p[3], size_t self) {
  struct part stack[DEEPEST];
  int depth = 0;
  double best = HUGE_VAL;
  size_t id = SIZE_MAX;
  const struct part all = {.high = t->n};
  /* The best point of the leaf of `point` is near, so the main search keeps few other halves. */
  struct part part = descend(t, p, all, -1, stack, &depth);
  best_of(t, p, part.low, part.high, self, &best, &id);
  for (part = descend(t, p, all, best * rounding, stack, &depth); depth;) {
    part = stack[--depth];
    if (part.squares > best * rounding)
      continue;
    part = descend(t, p, part, best * rounding, stack, &depth);
    best_of(t, p, part.low, part.high, self, &best, &id);
  }
  return id;
}

size_t sph_kd_tree_find(const struct sph_kd_tree *t, const double p[3]) {
  return sph_kd_tree_other(t, p, SIZE_MAX);
}

size_t sph_kd_tree_within(const struct sph_kd_tree *t, const double p[3], double radius, uint32_t *out,
                          size_t capacity) {
  struct part stack[DEEPEST];
  int depth = 0;
  size_t count = 0;
  const double reach = radius * radius;
  stack[depth++] = (struct part){.high = t->n};
  while (depth) {
    const struct part part = descend(t, p, stack[--depth], reach * rounding, stack, &depth);
    for (size_t i = part.low; i < part.high; i++) {
      const double dx = p[0] - t->at[i][0], dy = p[1] - t->at[i][1], dz = p[2] - t->at[i][2];
      if (dx * dx + dy * dy + dz * dz > reach)
        continue;
      if (count < capacity)
        out[count] = t->id[i];
      count++;
    }
  }
  return count;
}

bool sph_kd_tree_list(const struct sph_kd_tree *t, const double point[3], const double length[3], double radius,
                      uint32_t **list, size_t *capacity, size_t *total) {
  for (int image = 0; image < 27; image++) { /* the first is the point itself */
    const int shift[3] = {(image + 1) % 3 - 1, (image / 3 + 1) % 3 - 1, (image / 9 + 1) % 3 - 1};
    double p[3];
    bool near = true;
    for (int k = 0; k < 3; k++) {
      p[k] = point[k] + (shift[k] ? shift[k] * length[k] : 0);
      near &= !shift[k] || (length[k] > 0 && p[k] > -radius && p[k] < length[k] + radius);
    }
    if (!near)
      continue;
    const size_t room = *capacity - *total, found = sph_kd_tree_within(t, p, radius, *list + *total, room);
    if (found > room) {
      if (!grow_room(list, capacity, *total + found, sizeof **list))
        return false;
      sph_kd_tree_within(t, p, radius, *list + *total, found);
    }
    *total += found;
  }
  return true;
}
