#include "engine/sph/observe/sph_fragments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/material/fracture.h"
#include "engine/sph/observe/cell_grid.h"

struct sph_fragments_options sph_fragments_default(void) {
  return (struct sph_fragments_options){.damage = 1, .link_length = 1, .veneer = true, .periodic = {NAN, NAN, NAN}};
}

struct search {
  const struct sph_particles *p;
  const struct sph_fragments_options *options;
  struct sph_fragments *out;
  uint8_t *role;                  /* enum sph_cell_grid_role */
  uint32_t *parent;               /* of the cores */
  double *core_mass;              /* by root */
  double *nearest;                /* by broken particle: r^2 to its nearest whole one */
  uint32_t *mate;                 /* by broken particle: that one, UINT32_MAX for none */
  struct fragment_member *member; /* of what is not left out */
  uint32_t *place, *particle;     /* particle -> member and back */
  uint32_t (*link)[2];            /* between members */
  uint32_t *label;                /* by member */
  size_t members, links;
};

static bool is_left_out(const struct sph_fragments_options *options, const struct sph_particles *p, size_t i) {
  return options->bodies && options->bodies[p->body[i]].left_out;
}

/* BA95 section 4.4, first step: tension of the damaged stress against the static strength. */
static double tension(const struct sph_particles *p, size_t i, double damage) {
  double left = 1 - damage, pressure = p->pressure[i] < 0 ? left * p->pressure[i] : p->pressure[i];
  if (!p->stress[0])
    return -pressure;
  return left * sph_fracture_largest_tension(p->stress[0][i], p->stress[1][i], p->stress[2][i], p->stress[3][i],
                                             p->stress[4][i], p->stress[5][i]) -
         pressure;
}

static void sort_out(struct search *s) {
  const struct sph_particles *p = s->p;
  const double *h = s->options->h ? s->options->h : p->h;
  for (size_t i = 0; i < p->n; i++) {
    s->parent[i] = (uint32_t)i;
    s->mate[i] = UINT32_MAX;
    s->nearest[i] = HUGE_VAL;
    s->role[i] = SPH_CELL_GRID_ABSENT;
    s->out->part[i] = SPH_FRAGMENTS_LEFT_OUT;
    s->place[i] = UINT32_MAX;
    if (is_left_out(s->options, p, i))
      continue;
    s->place[i] = (uint32_t)s->members;
    s->particle[s->members] = (uint32_t)i;
    s->member[s->members++] = (struct fragment_member){.mass = p->mass[i],
                                                       .position = {p->x[i], p->y[i], p->z[i]},
                                                       .velocity = {p->vx[i], p->vy[i], p->vz[i]}};
    double sum = p->x[i] + p->y[i] + p->z[i] + p->vx[i] + p->vy[i] + p->vz[i] + p->mass[i] + h[i];
    double damage = p->damage_cbrt ? p->damage_cbrt[i] * p->damage_cbrt[i] * p->damage_cbrt[i] : 0;
    bool whole = damage < s->options->damage || !p->damage_cbrt;
    if (whole && s->options->bodies && tension(p, i, damage) > s->options->bodies[p->body[i]].static_strength) {
      whole = false;
      s->out->broken++;
    }
    s->out->part[i] = SPH_FRAGMENTS_DUST; /* until something is found for it */
    if (!isfinite(sum) || !(h[i] > 0))
      continue;
    s->role[i] = whole ? SPH_CELL_GRID_ACTIVE : s->options->veneer ? SPH_CELL_GRID_PASSIVE : SPH_CELL_GRID_ABSENT;
    if (whole)
      s->out->part[i] = SPH_FRAGMENTS_CORE;
  }
}

static bool friends(const struct search *s, uint32_t i, uint32_t j) {
  return s->options->across_bodies || s->p->body[i] == s->p->body[j];
}

static void join(void *context, uint32_t i, uint32_t j, double square) {
  struct search *s = context;
  (void)square;
  if (!friends(s, i, j) || !fragments_join(s->parent, i, j))
    return;
  s->link[s->links][0] = s->place[i]; /* a forest: fewer links than particles */
  s->link[s->links++][1] = s->place[j];
}

/* Nearest, then the heavier fragment, then the one with the lower first particle. */
static void veneer(void *context, uint32_t i, uint32_t j, double square) {
  struct search *s = context;
  if (!friends(s, i, j))
    return;
  uint32_t broken = s->role[i] == SPH_CELL_GRID_PASSIVE ? i : j, whole = broken == i ? j : i;
  if (square > s->nearest[broken])
    return;
  if (square == s->nearest[broken]) {
    uint32_t now = fragments_root(s->parent, s->mate[broken]), then = fragments_root(s->parent, whole);
    if (now == then || s->core_mass[then] < s->core_mass[now] ||
        (s->core_mass[then] == s->core_mass[now] && then > now))
      return;
  }
  s->nearest[broken] = square;
  s->mate[broken] = whole;
}

static status link_up(struct search *s, struct error *error) {
  const struct sph_particles *p = s->p;
  struct sph_cell_grid *touching = NULL;
  status code = sph_cell_grid_create(p->n, p->x, p->y, p->z, s->options->h ? s->options->h : p->h, s->role,
                                     s->options->link_length, s->options->periodic, &touching, error);
  if (code)
    return code;
  sph_cell_grid_visit(touching, false, join, s);
  for (size_t i = 0; i < p->n; i++)
    if (s->role[i] == SPH_CELL_GRID_ACTIVE)
      s->core_mass[fragments_root(s->parent, (uint32_t)i)] += p->mass[i];
  if (s->options->veneer)
    sph_cell_grid_visit(touching, true, veneer, s);
  sph_cell_grid_free(touching);
  for (size_t i = 0; i < p->n; i++)
    if (s->mate[i] != UINT32_MAX) {
      s->out->part[i] = SPH_FRAGMENTS_VENEER;
      s->link[s->links][0] = s->place[i];
      s->link[s->links++][1] = s->place[s->mate[i]];
    }
  return STATUS_OK;
}

/* The fragment of particle i, named by a particle of it. */
static uint32_t fragment_of(struct search *s, size_t i) {
  return fragments_root(s->parent, s->mate[i] != UINT32_MAX ? s->mate[i] : (uint32_t)i);
}

/* Members stand at the image nearest to their fragment's root. */
static void unwrap(struct search *s) {
  for (int d = 0; d < 3; d++) {
    double period = s->options->periodic[d];
    if (!(period > 0))
      continue;
    for (size_t k = 0; k < s->members; k++) {
      double origin = s->member[s->place[fragment_of(s, s->particle[k])]].position[d];
      double along = s->member[k].position[d] - origin;
      s->member[k].position[d] = s->particle[k] == fragment_of(s, s->particle[k])
                                     ? origin
                                     : origin + along - period * nearbyint(along / period);
    }
  }
}

/* A fragment that goes round the box has no end: it cannot turn but about that axis. */
static status hold_round(struct search *s, struct error *error) {
  for (int d = 0; d < 3; d++) {
    double period = s->options->periodic[d];
    if (!(period > 0))
      continue;
    double(*range)[2] = malloc((s->out->count + 1) * sizeof *range);
    if (!range)
      return status_fail(error, STATUS_MEMORY, "no memory for %zu fragments", s->out->count);
    for (size_t f = 0; f < s->out->count; f++)
      range[f][0] = HUGE_VAL, range[f][1] = -HUGE_VAL;
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
    free(range);
  }
  return STATUS_OK;
}

/* Of a solid ellipsoid I_1 = M (b^2 + c^2)/5 and so on, a the longest: its squared axes from the principal moments. */
static void measure_shape(const struct search *s, double ratio[2]) {
  double tensor[6] = {0}, value[3], axis[3][3];
  const struct fragment *f = s->out->fragments;
  ratio[0] = ratio[1] = NAN;
  if (s->out->count == 0 || f->count < 4)
    return;
  for (size_t k = 0; k < s->members; k++) {
    if (s->label[k] != 0)
      continue;
    double r[3], m = s->member[k].mass;
    for (int d = 0; d < 3; d++)
      r[d] = s->member[k].position[d] - f->position[d];
    tensor[0] += m * (r[1] * r[1] + r[2] * r[2]);
    tensor[3] += m * (r[2] * r[2] + r[0] * r[0]);
    tensor[5] += m * (r[0] * r[0] + r[1] * r[1]);
    tensor[1] -= m * r[0] * r[1];
    tensor[2] -= m * r[0] * r[2];
    tensor[4] -= m * r[1] * r[2];
  }
  fragments_principal(tensor, value, axis);
  double longest = value[1] + value[2] - value[0], middle = value[0] + value[2] - value[1],
         shortest = value[0] + value[1] - value[2];
  if (!(longest > 0) || !(shortest > 1e-12 * longest))
    return;
  ratio[0] = sqrt(middle / longest);
  ratio[1] = sqrt(shortest / longest);
}

static void sum_up(struct search *s) {
  struct sph_fragments *out = s->out;
  const struct sph_particles *p = s->p;
  memset(out->label, 0xff, p->n * sizeof *out->label);
  for (size_t k = 0; k < s->members; k++) {
    size_t i = s->particle[k];
    out->label[i] = s->label[k];
    out->mass += p->mass[i];
    if (out->part[i] == SPH_FRAGMENTS_DUST)
      out->dust_mass += p->mass[i];
    if (s->label[k] != 0) {
      const double *v = s->member[k].velocity, *with = out->fragments[0].velocity;
      double x = v[0] - with[0], y = v[1] - with[1], z = v[2] - with[2],
             energy = 0.5 * p->mass[i] * (x * x + y * y + z * z);
      if (isfinite(energy))
        out->ejected_energy += energy;
    }
    double core = s->core_mass[i]; /* of a root; else 0 */
    if (core > p->mass[i])
      out->resolved++;
    if (core > out->bare_second)
      out->bare_second = core;
    if (out->bare_second > out->bare_largest) {
      out->bare_second = out->bare_largest;
      out->bare_largest = core;
    }
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

status sph_fragments_find(const struct sph_particles *p, const struct sph_fragments_options *options,
                          struct sph_fragments *pieces, struct error *error) {
  *pieces = (struct sph_fragments){.n = p->n, .axis_ratio = {NAN, NAN}};
  size_t room = p->n + 1;
  struct search s = {.p = p, .options = options, .out = pieces};
  status code = check(p, options, error);
  if (code)
    goto cleanup;
  pieces->label = malloc(room * sizeof *pieces->label);
  pieces->part = malloc(room);
  s.role = malloc(room);
  s.parent = malloc(room * sizeof *s.parent);
  s.core_mass = calloc(room, sizeof *s.core_mass);
  s.nearest = malloc(room * sizeof *s.nearest);
  s.mate = malloc(room * sizeof *s.mate);
  s.member = malloc(room * sizeof *s.member);
  s.place = malloc(room * sizeof *s.place);
  s.particle = malloc(room * sizeof *s.particle);
  s.link = malloc(room * sizeof *s.link);
  s.label = malloc(room * sizeof *s.label);
  if (!pieces->label || !pieces->part || !s.role || !s.parent || !s.core_mass || !s.nearest || !s.mate || !s.member ||
      !s.place || !s.particle || !s.link || !s.label) {
    code = status_fail(error, STATUS_MEMORY, "no memory to find the fragments of %zu particles", p->n);
    goto cleanup;
  }
  sort_out(&s);
  if ((code = link_up(&s, error)))
    goto cleanup;
  unwrap(&s);
  if ((code = fragments_find_space(s.members, s.member, s.links, (const uint32_t(*)[2])s.link, s.label,
                                   &pieces->fragments, &pieces->count, error)) ||
      (code = hold_round(&s, error)))
    goto cleanup;
  sum_up(&s);
  measure_shape(&s, pieces->axis_ratio);
cleanup:
  if (code)
    sph_fragments_clear(pieces);
  free(s.role);
  free(s.parent);
  free(s.core_mass);
  free(s.nearest);
  free(s.mate);
  free(s.member);
  free(s.place);
  free(s.particle);
  free(s.link);
  free(s.label);
  return code;
}

void sph_fragments_clear(struct sph_fragments *pieces) {
  free(pieces->label);
  free(pieces->part);
  free(pieces->fragments);
  *pieces = (struct sph_fragments){0};
}
