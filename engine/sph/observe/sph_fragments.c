/* Fragments of SPH particles: cores, their damaged layers, single particles. */
#include "engine/sph/observe/observe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/body/kd_tree.h"
#include "engine/sph/material/material.h"
#include "schemas/memory.h"

struct sph_fragments_options sph_fragments_default(void) {
  return (struct sph_fragments_options){.damage = 1, .link_length = 1, .layer = true, .periodic = {NAN, NAN, NAN}};
}

enum role { ABSENT, UNBROKEN, BROKEN };

/* Members are the particles that are not left out. */
struct search {
  const struct sph_particles *p;
  const struct sph_fragments_options *options;
  struct sph_fragments *out;
  uint8_t *role;                  /* by particle: enum role; broken ones may join a layer */
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
    s->role[i] = ABSENT;
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
      s->role[i] = UNBROKEN;
    } else if (s->options->layer) {
      s->role[i] = BROKEN;
    }
  }
}

/* Bodies that touch are not bonded. */
static bool friends(const struct search *s, uint32_t i, uint32_t j) {
  return s->p->body[i] == s->p->body[j];
}

/* Step 2: joins the cores of two unbroken particles. */
static void join(struct search *s, uint32_t i, uint32_t j, double square) {
  (void)square;
  if (!friends(s, i, j) || !fragments_join(s->parent, i, j))
    return;
  s->link[s->links][0] = s->place[i];
  s->link[s->links++][1] = s->place[j];
}

/* Step 3: of the unbroken particles near a broken one keeps the nearest, then the one of the heavier core, then the one
 * of the core with the lower first particle. */
static void choose_mate(struct search *s, uint32_t i, uint32_t j, double square) {
  if (!friends(s, i, j))
    return;
  uint32_t broken = s->role[i] == BROKEN ? i : j, unbroken = broken == i ? j : i;
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

/* ---- pairs of particles ---- */

/* `square`: r^2 of the pair, m^2; the same bits for (i, j) and (j, i). A pair may come twice, and the order of the
 * pairs is arbitrary: the result must not depend on either. */
typedef void (*pair_visitor)(struct search *s, uint32_t i, uint32_t j, double square);

/* The particles that are not absent, in a tree. Along a periodic axis their places there are within the box. */
struct places {
  struct sph_kd_tree *tree;
  size_t n, room; /* room: items of `near` */
  double *at[3];
  uint32_t *id, *near; /* near: places that a search finds */
};

/* Visits the pairs of the k-th particle with particles of the same or a smaller h. */
static status visit_around(struct search *s, struct places *places, size_t k, const double *h, double reach,
                           enum role other, pair_visitor visit, struct error *error) {
  const double *const x[] = {s->p->x, s->p->y, s->p->z}, *const periodic = s->options->periodic;
  const uint32_t i = places->id[k];
  const double from[3] = {places->at[0][k], places->at[1][k], places->at[2][k]};
  size_t found = 0; /* a rounded distance must not hide one */
  if (!sph_kd_tree_list(places->tree, from, periodic, reach * h[i] * (1 + 1e-9), &places->near, &places->room, &found))
    return status_fail(error, STATUS_MEMORY, "no memory for the neighbours of a particle");
  for (size_t m = 0; m < found; m++) {
    const uint32_t j = places->id[places->near[m]];
    if (j == i || s->role[j] != other || h[j] > h[i])
      continue;
    double square = 0, within = 0.5 * reach * h[i] + 0.5 * reach * h[j];
    for (int d = 0; d < 3; d++) {
      double along = x[d][i] - x[d][j];
      if (periodic[d] > 0)
        along -= periodic[d] * nearbyint(along / periodic[d]);
      square += along * along;
    }
    if (square <= within * within)
      visit(s, i, j, square);
  }
  return STATUS_OK;
}

/* Visits the pairs of an unbroken particle and another one, broken or not, with r <= reach (h_i + h_j)/2. */
static status visit_pairs(struct search *s, const double *h, double reach, enum role other, pair_visitor visit,
                          struct error *error) {
  const size_t n = s->p->n;
  const double *const x[] = {s->p->x, s->p->y, s->p->z}, *const periodic = s->options->periodic;
  OWNED double *at = malloc((3 * n + 1) * sizeof *at);
  OWNED uint32_t *id = malloc((n + 1) * sizeof *id);
  struct places places = {.at = {at, at + n, at + 2 * n}, .id = id};
  if (!at || !id)
    return status_fail(error, STATUS_MEMORY, "no memory to find which of %zu particles are neighbours", n);
  for (size_t i = 0; i < n; i++) {
    if (s->role[i] == ABSENT)
      continue;
    for (int d = 0; d < 3; d++)
      places.at[d][places.n] = periodic[d] > 0 ? x[d][i] - periodic[d] * floor(x[d][i] / periodic[d]) : x[d][i];
    id[places.n++] = (uint32_t)i;
  }
  if (places.n == 0)
    return STATUS_OK;
  status code = sph_kd_tree_create(places.n, places.at[0], places.at[1], places.at[2], &places.tree, error);
  for (size_t k = 0; k < places.n && !code; k++)
    if (s->role[id[k]] == UNBROKEN)
      code = visit_around(s, &places, k, h, reach, other, visit, error);
    else if (other == BROKEN)
      code = visit_around(s, &places, k, h, reach, UNBROKEN, visit, error);
  sph_kd_tree_free(places.tree);
  free(places.near);
  return code;
}

/* Links of the cores, then of their layers. A given depth of the layer takes the place of the links there. */
static status link_members(struct search *s, struct error *error) {
  const struct sph_particles *p = s->p;
  const struct sph_fragments_options *o = s->options;
  const double *h = o->h ? o->h : p->h;
  OWNED double *width = malloc((p->n + 1) * sizeof *width);
  if (!width)
    return status_fail(error, STATUS_MEMORY, "no memory for the damaged layers of %zu particles", p->n);
  TRY(visit_pairs(s, h, o->link_length, UNBROKEN, join, error));
  for (size_t i = 0; i < p->n; i++) {
    width[i] = o->layer_width;
    if (s->role[i] == UNBROKEN)
      s->core_mass[fragments_root(s->parent, (uint32_t)i)] += p->mass[i];
  }
  if (o->layer && o->layer_width > 0)
    TRY(visit_pairs(s, width, 1, BROKEN, choose_mate, error));
  else if (o->layer)
    TRY(visit_pairs(s, h, o->link_length, BROKEN, choose_mate, error));
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
  const status code = find(&search, error);
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
