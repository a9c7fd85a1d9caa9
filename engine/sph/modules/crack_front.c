/* Cracks that run on beyond the particle of their flaw (crack_front.h has the equations).
 *
 *   fracture.front         plane turns the module on
 *   fracture.front_arrest  smallest tension ahead of a front, over the tension that opens its flaw
 *
 * Without this module a crack ends at its particle, and every particle must fail by a flaw of its own, whose threshold
 * grows as (k V_p)^(-1/m). So strength grows with the number of particles without end. With it, strength depends on the
 * flaws of the body alone (tests/validation/crack_front.md).
 *
 * Neighbours are those of the body at the start: a front runs through rock that is still one piece. It does not cross
 * the periodic sides of a box. */
#include "engine/sph/modules/crack_front_links.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sph/body/kd_tree.h"
#include "engine/sph/material/derived.h"
#include "engine/sph/modules/ranges.h"

#define INPUTS sph_crack_front_inputs

static const struct field input_rows[] = {
    INPUT_CHOICE(fracture.front, front,
                 FIELD_WORDS_HERE(SPH_CRACK_FRONTS, [SPH_CRACK_FRONT_NONE] = "none", [SPH_CRACK_FRONT_PLANE] = "plane"),
                 .absent = "none", .when = "target.fracture=auto|on",
                 .choice_docs =
                     "it ends at its particle, and each particle breaks by flaws of its own, as printed: strength "
                     "grows with the number of particles\n"
                     "it runs on in its plane at c_g",
                 .doc = "Length of a crack that starts at a flaw.", .source = "BA95 for `none`; `plane` is ours"),
    INPUT_REAL(fracture.front_arrest, arrest, "1", 0.5, 0, 1, .when = "fracture.front=plane",
               .doc = "A crack continues where the tension across its plane is at least this share of the tension that "
                      "opens its flaw. 0: any tension will do.",
               .source = "our choice"),
};
const struct field_table sph_crack_front_inputs = SPH_MODULE_TABLE(sph_crack_front_inputs, input_rows);

enum { BYTES_EACH = 350 }; /* of a particle with 56 neighbours */

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  return body->flaws != NULL && inputs->crack_front.front == SPH_CRACK_FRONT_PLANE;
}

static void free_prepared(void *prepared) {
  struct sph_crack_front_links *links = prepared;
  if (!links)
    return;
  free(links->place);
  free(links->first);
  free(links->other);
  free(links->tip);
  free(links->near);
  free(links);
}

static size_t bytes_prepared(const void *prepared) {
  const struct sph_crack_front_links *l = prepared;
  return sizeof *l + l->first[l->particles] * sizeof *l->other +
         l->particles * (3 * sizeof *l->place + sizeof *l->first + sizeof *l->tip + sizeof *l->near);
}

/* Particles within 2h of particle q, itself included; written if there is room. */
static size_t within(const struct sph_crack_front_links *l, const struct sph_kd_tree *tree, double h, size_t q,
                     uint32_t *out, size_t room) {
  return sph_kd_tree_within(tree, l->place + 3 * q, 2 * h, out, room);
}

/* The lists of neighbours. h: of each particle. False without memory. */
static bool link_up(struct sph_crack_front_links *l, const struct sph_kd_tree *tree, const double *h) {
  l->first[0] = 0;
  for (size_t q = 0; q < l->particles; q++)
    l->first[q + 1] = l->first[q] + within(l, tree, h[q], q, NULL, 0);
  l->other = malloc(l->first[l->particles] * sizeof *l->other);
  for (size_t q = 0; l->other && q < l->particles; q++)
    within(l, tree, h[q], q, l->other + l->first[q], l->first[q + 1] - l->first[q]);
  return l->other != NULL;
}

static bool take(struct sph_crack_front_links *l, size_t n) {
  l->particles = n;
  l->place = malloc(3 * n * sizeof *l->place);
  l->first = malloc((n + 1) * sizeof *l->first);
  l->tip = malloc(n * sizeof *l->tip);
  l->near = calloc(n, sizeof *l->near);
  return l->place && l->first && l->tip && l->near;
}

static status prepare(const struct sph_inputs *inputs, const struct sph_particles *p, struct sph_solid *body,
                      struct error *error) {
  (void)inputs;
  struct sph_kd_tree *tree = NULL;
  const size_t n = body->last - body->first, from = body->first;
  struct sph_crack_front_links *links = calloc(1, sizeof *links);
  if (!links || !take(links, n)) {
    free_prepared(links);
    return status_fail(error, STATUS_MEMORY, "no memory for the crack fronts of %zu particles", n);
  }
  links->speed = sph_derived_crack_speed(&body->physics.material);
  for (size_t q = 0; q < n; q++) {
    const double at[3] = {p->x[from + q], p->y[from + q], p->z[from + q]};
    memcpy(links->place + 3 * q, at, sizeof at);
    links->tip[q] = (struct sph_crack_front_tip){.time = INFINITY};
  }
  status code = sph_kd_tree_create(n, p->x + from, p->y + from, p->z + from, &tree, error);
  if (!code && !link_up(links, tree, p->h + from))
    code = status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", n);
  sph_kd_tree_free(tree);
  if (code)
    free_prepared(links);
  else
    body->prepared[SPH_MODULE_crack_front] = links;
  return code;
}

void sph_crack_front_publish(struct sph_system *s, const struct sph_solid *body, size_t low, size_t high) {
  struct sph_crack_front_links *l = body->prepared[SPH_MODULE_crack_front];
  const struct sph_columns *c = &s->c;
  for (size_t i = low; i < high; i++) {
    struct sph_crack_front_tip *tip = &l->tip[s->id[i] - body->first];
    if (!isfinite(c->front_time[i]) || isfinite(tip->time))
      continue;
    *tip = (struct sph_crack_front_tip){.time = c->front_time[i],
                                        .offset = c->front_offset[i],
                                        .stress = c->front_stress[i],
                                        .normal = {c->front_normal[0][i], c->front_normal[1][i],
                                                   c->front_normal[2][i]}};
    const size_t own = s->id[i] - body->first;
    for (size_t k = l->first[own]; k < l->first[own + 1]; k++)
      __atomic_store_n(&l->near[l->other[k]], 1, __ATOMIC_RELAXED); /* several threads may write here; all write 1 */
  }
}

static void restored(struct sph_system *s, const struct sph_solid *body) {
  struct sph_crack_front_links *l = body->prepared[SPH_MODULE_crack_front];
  memset(l->near, 0, l->particles);
  for (size_t q = 0; q < l->particles; q++)
    l->tip[q].time = INFINITY;
  sph_crack_front_publish(s, body, body->first, body->last);
}

static const struct sph_column_need columns[] = {{SPH_COLUMNS_OF(front_time), INFINITY, NULL},
                                                 {SPH_COLUMNS_OF(front_offset), 0, NULL},
                                                 {SPH_COLUMNS_OF(front_stress), 0, NULL},
                                                 {SPH_COLUMNS_OF(front_normal), 0, NULL},
                                                 {0}};

const struct sph_module sph_crack_front_module = {
    .name = "crack_front",
    .doc = "A crack runs on from the particle of its flaw, in its plane, at c_g, where the tension across the plane is "
           "at least what opens the flaw. A particle that the front has reached breaks while it is in tension, without "
           "a flaw of its own and without a cap.",
    .source = "our choice; c_g and what opens a flaw as in Benz & Asphaug 1995",
    .when = "a body whose material has Weibull parameters, with fracture.front: plane",
    .on = on,
    .columns = columns,
    .bytes_linked = BYTES_EACH,
    .prepare = prepare,
    .free_prepared = free_prepared,
    .bytes_prepared = bytes_prepared,
    .restored = restored,
};
