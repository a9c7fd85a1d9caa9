/* Fragments of SPH particles: cores, their damaged layers, single particles. */
#include "engine/sph/observe/observe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/material/material.h"
#include "schemas/memory.h"

/* ---- pairs of particles ---- */

/* A cell grid: finds all pairs of particles within a multiple of their mean smoothing length. The cells are hashed, on
 * one level per halving of h. Memory grows with n only: neither distant particles (1e9 m away) nor a wide range of
 * sizes cost any. */

enum cell_grid_role { CELL_GRID_ABSENT, CELL_GRID_ACTIVE, CELL_GRID_PASSIVE };
enum { LEVELS = 64 };

struct item {
  double at[3], half; /* half = reach h / 2 */
  uint32_t id;
  uint8_t level, role;
};

struct cell_grid {
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

static struct level level_at(const struct cell_grid *t, int number) {
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
static size_t bucket_of(const struct cell_grid *t, int level, const int64_t at[3]) {
  return (size_t)((uint64_t)at[0] + (uint64_t)at[1] * 0x9e3779b97f4a7c15u + (uint64_t)at[2] * 0xc2b2ae3d27d4eb4fu +
                  (uint64_t)level * 0x165667b19e3779f9u) &
         t->mask;
}

static size_t home_of(const struct cell_grid *t, const struct level *level, const struct item *item) {
  int64_t at[3];
  for (int d = 0; d < 3; d++)
    at[d] = cell_along(level, d, item->at[d]);
  return bucket_of(t, item->level, at);
}

/* Counting sort into buckets; inside a bucket by ascending id. */
static void sort_items(struct cell_grid *t, const struct level *level, const struct item *from, uint32_t *bucket) {
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
static double collect_items(struct cell_grid *t, size_t n, const double *x, const double *y, const double *z,
                            const double *h, const uint8_t *role, double reach, struct item *items) {
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    if (role[i] == CELL_GRID_ABSENT)
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

static void cell_grid_free(struct cell_grid *t) {
  if (!t)
    return;
  free(t->item);
  free(t->start);
  free(t);
}

/* A grid for the pairs with r <= reach (h_i + h_j)/2. An axis whose `periodic` length (m) is not NaN uses the minimum
 * image. The position and h of a particle that is not absent must be finite, h > 0. The data are copied.
 * STATUS_MEMORY. */
static status cell_grid_create(size_t n, const double *x, const double *y, const double *z, const double *h,
                               const uint8_t *role, double reach, const double periodic[3], struct cell_grid **out,
                               struct error *error) {
  *out = NULL;
  OWNED struct item *from = malloc((n + 1) * sizeof *from);
  OWNED uint32_t *bucket = malloc((n + 1) * sizeof *bucket);
  struct level level[LEVELS];
  struct cell_grid *t = memory_small(1, sizeof *t);
  const double largest = from ? collect_items(t, n, x, y, z, h, role, reach, from) : 0;
  for (t->mask = 1; t->mask < 2 * t->n;)
    t->mask = 2 * t->mask + 1;
  t->item = malloc((t->n + 1) * sizeof *t->item);
  t->start = calloc(t->mask + 2, sizeof *t->start);
  if (!from || !bucket || !t->item || !t->start) {
    cell_grid_free(t);
    return status_fail(error, STATUS_MEMORY, "no memory to find which of %zu particles are neighbours", n);
  }
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
  return STATUS_OK;
}

/* `square`: r^2 of the pair, m^2; the same bits for (i, j) and (j, i). */
typedef void (*cell_grid_pair)(void *context, uint32_t i, uint32_t j, double square);
struct visit {
  const struct cell_grid *t;
  cell_grid_pair pair;
  void *context;
  bool passive, periodic;
};

/* The items of one level in `count` successive buckets. own: the buckets are those of the item's own cell, where a pair
 * is visited from the lower id only. */
static void visit_buckets(const struct visit *visit, const struct item *item, int number, bool own, size_t bucket,
                          size_t count) {
  const struct cell_grid *t = visit->t;
  for (uint32_t k = t->start[bucket]; k < t->start[bucket + count]; k++) {
    const struct item *other = &t->item[k];
    if (other->level != number || other->id == item->id || (own && other->id < item->id))
      continue;
    if (visit->passive ? other->role == item->role : other->role == CELL_GRID_PASSIVE)
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

/* Visits the pairs of an active and a passive particle if `passive`, else the pairs of two active ones. A pair may come
 * twice (two cells can share a bucket), and the order of the pairs is arbitrary: the result of `pair` must not depend
 * on either. */
static void cell_grid_visit(const struct cell_grid *t, bool passive, cell_grid_pair pair, void *context) {
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
      if (filled[l] && (passive || t->item[k].role == CELL_GRID_ACTIVE))
        visit_level(&visit, &t->item[k], l, &level[l]);
}

/* ---- fragments ---- */

struct sph_fragments_options sph_fragments_default(void) {
  return (struct sph_fragments_options){.damage = 1, .link_length = 1, .layer = true, .periodic = {NAN, NAN, NAN}};
}

/* Members are the particles that are not left out. */
struct search {
  const struct sph_particles *p;
  const struct sph_fragments_options *options;
  struct sph_fragments *out;
  uint8_t *role;                  /* by particle: enum cell_grid_role; active: unbroken, passive: may join a layer */
  uint32_t *parent;               /* by particle: union-find of the cores */
  double *core_mass;              /* by particle that is a root: kg of its core; else 0 */
  double *nearest;                /* by broken particle: r^2 to its nearest unbroken one, m^2 */
  uint32_t *mate;                 /* by broken particle: that unbroken one; UINT32_MAX: none */
  struct fragment_member *member; /* by member */
  uint32_t *place, *particle;     /* member of a particle (UINT32_MAX: left out), particle of a member */
  uint32_t (*link)[2];            /* between members: a forest, so fewer than members */
  uint32_t *label;                /* by member: its fragment */
  size_t members, links;
};

/* Largest tension of the damaged stress, Pa: step 1 compares it with the static strength. */
static double tension(const struct sph_particles *p, size_t i, double damage, bool whole_shear) {
  double left = 1 - damage, pressure = p->pressure[i] < 0 ? left * p->pressure[i] : p->pressure[i];
  if (!p->stress[0])
    return -pressure;
  return (whole_shear ? 1 : left) * sph_material_largest_tension(p->stress[0][i], p->stress[1][i], p->stress[2][i],
                                                                 p->stress[3][i], p->stress[4][i], p->stress[5][i]) -
         pressure;
}

static bool is_unbroken(struct search *s, size_t i) {
  const struct sph_particles *p = s->p;
  double damage = sph_particles_damage(p, i);
  if (p->damage_cbrt && !(damage < s->options->damage))
    return false;
  if (!s->options->bodies || !(damage > 0) ||
      !(tension(p, i, damage, s->options->whole_shear) > s->options->bodies[p->body[i]].static_strength))
    return true; /* without damage there is no crack that could open */
  s->out->broken++;
  return false;
}

static void add_member(struct search *s, size_t i) {
  const struct sph_particles *p = s->p;
  s->place[i] = (uint32_t)s->members;
  s->particle[s->members] = (uint32_t)i;
  s->member[s->members++] = (struct fragment_member){.mass = p->mass[i],
                                                     .position = {p->x[i], p->y[i], p->z[i]},
                                                     .velocity = {p->vx[i], p->vy[i], p->vz[i]}};
}

/* Members, and the role of each particle in the search. */
static void classify(struct search *s) {
  const struct sph_particles *p = s->p;
  const double *h = s->options->h ? s->options->h : p->h;
  for (size_t i = 0; i < p->n; i++) {
    s->parent[i] = (uint32_t)i;
    s->mate[i] = UINT32_MAX;
    s->nearest[i] = HUGE_VAL;
    s->role[i] = CELL_GRID_ABSENT;
    s->out->part[i] = SPH_FRAGMENTS_LEFT_OUT;
    s->place[i] = UINT32_MAX;
    if (s->options->bodies && s->options->bodies[p->body[i]].left_out)
      continue;

    add_member(s, i);
    s->out->part[i] = SPH_FRAGMENTS_SINGLE; /* until it joins a layer */
    bool unbroken = is_unbroken(s, i);
    double sum = p->x[i] + p->y[i] + p->z[i] + p->vx[i] + p->vy[i] + p->vz[i] + p->mass[i] + h[i];
    if (!isfinite(sum) || !(h[i] > 0))
      continue;
    if (unbroken) {
      s->out->part[i] = SPH_FRAGMENTS_CORE;
      s->role[i] = CELL_GRID_ACTIVE;
    } else if (s->options->layer) {
      s->role[i] = CELL_GRID_PASSIVE;
    }
  }
}

static bool friends(const struct search *s, uint32_t i, uint32_t j) {
  return s->options->across_bodies || s->p->body[i] == s->p->body[j];
}

/* Step 2: joins the cores of two unbroken particles. */
static void join(void *context, uint32_t i, uint32_t j, double square) {
  struct search *s = context;
  (void)square;
  if (!friends(s, i, j) || !fragments_join(s->parent, i, j))
    return;
  s->link[s->links][0] = s->place[i];
  s->link[s->links++][1] = s->place[j];
}

/* Step 3: of the unbroken particles near a broken one keeps the nearest, then the one of the heavier core, then the one
 * of the core with the lower first particle. */
static void choose_mate(void *context, uint32_t i, uint32_t j, double square) {
  struct search *s = context;
  if (!friends(s, i, j))
    return;
  uint32_t broken = s->role[i] == CELL_GRID_PASSIVE ? i : j, unbroken = broken == i ? j : i;
  if (square > s->nearest[broken])
    return;
  if (square == s->nearest[broken]) {
    uint32_t old = fragments_root(s->parent, s->mate[broken]), new = fragments_root(s->parent, unbroken);
    if (new == old || s->core_mass[new] < s->core_mass[old])
      return;
    if (s->core_mass[new] == s->core_mass[old] && new > old)
      return;
  }
  s->nearest[broken] = square;
  s->mate[broken] = unbroken;
}

/* Step 3 where the depth of the layer is given: the pairs within it come from a grid of their own. */
static status choose_mates_within(struct search *s, double width, struct error *error) {
  const struct sph_particles *p = s->p;
  struct cell_grid *grid = NULL;
  OWNED double *reach = malloc((p->n + 1) * sizeof *reach);
  if (!reach)
    return status_fail(error, STATUS_MEMORY, "no memory for the damaged layers of %zu particles", p->n);
  for (size_t i = 0; i < p->n; i++)
    reach[i] = width;
  TRY(cell_grid_create(p->n, p->x, p->y, p->z, reach, s->role, 1, s->options->periodic, &grid, error));
  cell_grid_visit(grid, true, choose_mate, s);
  cell_grid_free(grid);
  return STATUS_OK;
}

/* Links of the cores, then of their layers. */
static status link_members(struct search *s, struct error *error) {
  const struct sph_particles *p = s->p;
  const double width = s->options->layer_width;
  struct cell_grid *grid = NULL;
  TRY(cell_grid_create(p->n, p->x, p->y, p->z, s->options->h ? s->options->h : p->h, s->role, s->options->link_length,
                       s->options->periodic, &grid, error));
  cell_grid_visit(grid, false, join, s);
  for (size_t i = 0; i < p->n; i++)
    if (s->role[i] == CELL_GRID_ACTIVE)
      s->core_mass[fragments_root(s->parent, (uint32_t)i)] += p->mass[i];
  if (s->options->layer && !(width > 0))
    cell_grid_visit(grid, true, choose_mate, s);
  cell_grid_free(grid);
  if (s->options->layer && width > 0)
    TRY(choose_mates_within(s, width, error));
  for (size_t i = 0; i < p->n; i++)
    if (s->mate[i] != UINT32_MAX) {
      s->out->part[i] = SPH_FRAGMENTS_LAYER;
      s->link[s->links][0] = s->place[i];
      s->link[s->links++][1] = s->place[s->mate[i]];
    }
  return STATUS_OK;
}

/* The particle that is the root of the core to which particle i belongs, as core or as layer. */
static uint32_t root_of(struct search *s, size_t i) {
  return fragments_root(s->parent, s->mate[i] != UINT32_MAX ? s->mate[i] : (uint32_t)i);
}

/* Moves each member to the image nearest to the root of its fragment. */
static void unwrap(struct search *s) {
  for (int d = 0; d < 3; d++) {
    double period = s->options->periodic[d];
    if (!(period > 0))
      continue;
    for (size_t k = 0; k < s->members; k++) {
      uint32_t root = root_of(s, s->particle[k]);
      if (root == s->particle[k])
        continue;
      double origin = s->member[s->place[root]].position[d], along = s->member[k].position[d] - origin;
      s->member[k].position[d] = origin + along - period * nearbyint(along / period);
    }
  }
}

/* A fragment that spans the periodic box has no ends along that axis: it can turn about that axis only. */
static status stop_endless_spins(struct search *s, struct error *error) {
  for (int d = 0; d < 3; d++) {
    double period = s->options->periodic[d];
    if (!(period > 0))
      continue;
    OWNED double(*range)[2] = malloc((s->out->count + 1) * sizeof *range);
    if (!range)
      return status_fail(error, STATUS_MEMORY, "no memory for %zu fragments", s->out->count);
    for (size_t f = 0; f < s->out->count; f++) {
      range[f][0] = HUGE_VAL;
      range[f][1] = -HUGE_VAL;
    }
    for (size_t k = 0; k < s->members; k++) {
      double *of = range[s->label[k]], x = s->member[k].position[d];
      of[0] = fmin(of[0], x);
      of[1] = fmax(of[1], x);
    }
    for (size_t f = 0; f < s->out->count; f++)
      if (range[f][1] - range[f][0] > period / 2)
        for (int other = 0; other < 3; other++)
          if (other != d)
            s->out->fragments[f].spin[other] = 0;
  }
  return STATUS_OK;
}

static void add_inertia(double tensor[6], double m, const double r[3]) {
  tensor[0] += m * (r[1] * r[1] + r[2] * r[2]);
  tensor[1] -= m * r[0] * r[1];
  tensor[2] -= m * r[0] * r[2];
  tensor[3] += m * (r[2] * r[2] + r[0] * r[0]);
  tensor[4] -= m * r[1] * r[2];
  tensor[5] += m * (r[0] * r[0] + r[1] * r[1]);
}

/* Shapes as solid ellipsoids of the same principal moments, whose half axes are a >= b >= c: I_1 = M (b^2 + c^2)/5 and
 * so on. Particles count as points: the lattice is turned, so that a body's faces cut it anywhere, and the points fill
 * the body up to its faces. The ratios are those of a box, too: 12:8:5 of 74 particles gives c/a = 0.41. Distances
 * between plates depend on the width that a particle is given: 0.50 with that of its volume. */
static status measure_shapes(struct search *s, struct error *error) {
  struct fragment *fragments = s->out->fragments;
  size_t end = 0; /* behind the last fragment that is measured */
  for (size_t f = 0; f < s->out->count; f++)
    end = fragments[f].count >= SPH_FRAGMENTS_SHAPED ? f + 1 : end;
  OWNED double(*tensor)[6] = calloc(end + 1, sizeof *tensor);
  if (!tensor)
    return status_fail(error, STATUS_MEMORY, "no memory for the shapes of %zu fragments", end);
  for (size_t k = 0; k < s->members; k++) {
    const size_t f = s->label[k];
    if (f >= end || fragments[f].count < SPH_FRAGMENTS_SHAPED)
      continue;
    double r[3];
    for (int d = 0; d < 3; d++)
      r[d] = s->member[k].position[d] - fragments[f].position[d];
    add_inertia(tensor[f], s->member[k].mass, r);
  }
  for (size_t f = 0; f < end; f++) {
    double value[3], axis[3][3];
    if (fragments[f].count < SPH_FRAGMENTS_SHAPED)
      continue;
    fragments_principal(tensor[f], value, axis);
    const double longest = value[1] + value[2] - value[0], middle = value[0] + value[2] - value[1],
                 shortest = value[0] + value[1] - value[2]; /* 2 M/5 times the squares of the half axes */
    if (!(longest > 0) || !(shortest > 1e-12 * longest))
      continue;
    const double square[3] = {longest, middle, shortest};
    for (int a = 0; a < 3; a++)
      fragments[f].length[a] = 2 * sqrt(5 * square[a] / (2 * fragments[f].mass));
    if (f == 0 && fragments[f].count >= SPH_FRAGMENTS_MEASURED) {
      s->out->axis_ratio[0] = sqrt(middle / longest);
      s->out->axis_ratio[1] = sqrt(shortest / longest);
    }
  }
  return STATUS_OK;
}

static void note_core(struct sph_fragments *out, double core) {
  if (core > out->core_second)
    out->core_second = core;
  if (out->core_second > out->core_largest) {
    out->core_second = out->core_largest;
    out->core_largest = core;
  }
}

static void sum_up(struct search *s) {
  struct sph_fragments *out = s->out;
  const struct sph_particles *p = s->p;
  memset(out->label, 0xff, p->n * sizeof *out->label);
  for (size_t k = 0; k < s->members; k++) {
    size_t i = s->particle[k];
    out->label[i] = s->label[k];
    out->mass += p->mass[i];
    if (out->part[i] == SPH_FRAGMENTS_SINGLE)
      out->single_mass += p->mass[i];
    if (s->core_mass[i] > p->mass[i])
      out->resolved++;
    note_core(out, s->core_mass[i]);
  }
  for (size_t f = 0; f < out->count; f++)
    out->fragments[f].first = s->particle[out->fragments[f].first];
}

static status check(const struct sph_particles *p, const struct sph_fragments_options *options, struct error *error) {
  if (!(options->damage > 0 && options->damage <= 1))
    return status_fail(error, STATUS_CONTENT, "fragments: damage is %g; give a threshold above 0 and at most 1",
                       options->damage);
  if (!(options->link_length > 0 && options->link_length <= 4))
    return status_fail(error, STATUS_CONTENT, "fragments: the link length is %g h; give one above 0 and at most 4 h",
                       options->link_length);
  for (size_t i = 0; options->bodies && i < p->n; i++)
    if (p->body[i] >= options->body_count)
      return status_fail(error, STATUS_CONTENT,
                         "fragments: particle %zu is of body %d, but only %zu bodies are described", i, p->body[i],
                         options->body_count);
  return STATUS_OK;
}

static status find(struct search *s, struct error *error) {
  const size_t n = s->p->n + 1;
  OWNED uint8_t *role = s->role = malloc(n);
  OWNED uint32_t *parent = s->parent = malloc(n * sizeof *parent);
  OWNED double *core_mass = s->core_mass = calloc(n, sizeof *core_mass);
  OWNED double *nearest = s->nearest = malloc(n * sizeof *nearest);
  OWNED uint32_t *mate = s->mate = malloc(n * sizeof *mate);
  OWNED struct fragment_member *member = s->member = malloc(n * sizeof *member);
  OWNED uint32_t *place = s->place = malloc(n * sizeof *place);
  OWNED uint32_t *particle = s->particle = malloc(n * sizeof *particle);
  OWNED uint32_t(*link)[2] = s->link = malloc(n * sizeof *link);
  OWNED uint32_t *label = s->label = malloc(n * sizeof *label);
  s->out->label = malloc(n * sizeof *s->out->label);
  s->out->part = malloc(n);
  if (!role || !parent || !core_mass || !nearest || !mate || !member || !place || !particle || !link || !label ||
      !s->out->label || !s->out->part)
    return status_fail(error, STATUS_MEMORY, "no memory to find the fragments of %zu particles", s->p->n);
  classify(s);
  TRY(link_members(s, error));
  unwrap(s);
  TRY(fragments_find(true, s->members, s->member, s->links, (const uint32_t(*)[2])s->link, s->label, &s->out->fragments,
                     &s->out->count, error));
  TRY(stop_endless_spins(s, error));
  sum_up(s);
  return measure_shapes(s, error);
}

status sph_fragments_find(const struct sph_particles *p, const struct sph_fragments_options *options,
                          struct sph_fragments *out, struct error *error) {
  *out = (struct sph_fragments){.n = p->n, .axis_ratio = {NAN, NAN}};
  struct search search = {.p = p, .options = options, .out = out};
  status code = check(p, options, error);
  if (!code)
    code = find(&search, error);
  if (code)
    sph_fragments_clear(out);
  return code;
}

void sph_fragments_clear(struct sph_fragments *fragments) {
  free(fragments->label);
  free(fragments->part);
  free(fragments->fragments);
  *fragments = (struct sph_fragments){0};
}
