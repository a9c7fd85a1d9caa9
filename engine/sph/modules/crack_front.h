/* Cracks that run on beyond the particle of their flaw (equations below).
 *
 *   fracture.front         plane turns the module on
 *   fracture.front_arrest  smallest tension ahead of a front, over the tension that opens its flaw
 *
 * Without this module a crack ends at its particle, and every particle must fail by a flaw of its own, whose threshold
 * grows as (k V_p)^(-1/m). So strength grows with the number of particles without end. With it, strength depends on the
 * flaws of the body alone (tests/validation/crack_front.md).
 *
 * Neighbours are those of the body at the start: a front runs through rock that is still one piece. It does not cross
 * the periodic sides of a box.
 *
 * How the front of a crack goes from particle to particle.
 *
 * A particle whose damage begins is the start of a crack: its plane goes through the particle across the largest
 * tension, n, and its front begins then. A neighbour j of a reached particle i is reached at the earliest of
 *     t_i + |x_j - x_i|/c_g            over all i with
 *     |d_j| <= h,  d_j = d_i + (x_j - x_i) . n_i     (in the slab of the crack's plane: broken, it leaves the two
 *                                                     sides beyond the reach 2h of the pair loop)
 *     n_i . S n_i - P >= a E eps_i                   (eps_i: threshold of the flaw, a: fracture.front_arrest)
 * with places x of the start. Where the tension comes later, the front waits. j then has the plane n_j = n_i at the
 * distance d_j, and eps_j = eps_i.
 *
 * Damage of a reached particle grows at c_g/R_s, or as fast as by its own open flaws, without a cap, as long as its
 * largest tension is positive. The loops of `fracture` do it: they read the weakest threshold, the rate between two
 * thresholds and the cap. This module sets these as for a flaw of threshold 0. They act from the next step on. */

MODULE(crack_front)
MODULE_HOOKS(crack_front)
MODULE_INPUTS(crack_front)

#ifdef SPH_MODULE_STRUCTS
enum sph_crack_front { SPH_CRACK_FRONT_NONE, SPH_CRACK_FRONT_PLANE, SPH_CRACK_FRONTS };
struct sph_crack_front_inputs {
  int front;     /* enum sph_crack_front */
  double arrest; /* 1 */
};

/* Data of crack fronts beside the columns: the neighbours of every particle at the start, and the progress of cracks.
 * Particles are named by their number within their body, which sorting does not change. */
/* The columns front_* of a particle, where its neighbours can read them. */
struct sph_crack_front_tip {
  double time;   /* s, when the front was here; infinite: not yet */
  double offset; /* m, of the particle from the crack's plane, along the normal */
  double stress; /* Pa: the front goes on where the tension across the plane is at least this */
  double normal[3];
};

/* Hooks before the pair loop read `tip` and `near`; hooks after it write them. So no block sees what another has found
 * in the same step, and the bits do not depend on the number of threads. */
struct sph_crack_front_links {
  size_t particles;
  double speed;                    /* m/s, c_g */
  double *place;                   /* m, three coordinates of each particle at the start */
  size_t *first;                   /* particle q has the neighbours other[first[q]] ... other[first[q + 1] - 1] */
  uint32_t *other;                 /* within 2h at the start */
  struct sph_crack_front_tip *tip; /* a particle is reached once at most */
  unsigned char *near;             /* 1: a front has been at a neighbour */
};
#endif

COLUMN(front_time)      /* s, when a crack's front reached the particle; infinite: not yet */
COLUMN(front_offset)    /* m: this and the next as in struct sph_crack_front_tip */
COLUMN(front_stress)    /* Pa */
COLUMN(front_normal[3]) /* 1 */

#if defined(SPH_MODULE_LOOPS) || defined(SPH_MODULE_DESCRIPTORS)

/* Copies the columns front_* of the particles low .. high - 1 to `tip`, where their neighbours read them. */
static void crack_front_publish(struct sph_system *s, const struct sph_solid *body, size_t low, size_t high) {
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

#endif

#ifdef SPH_MODULE_LOOPS

/* Unit vector of the largest principal stress: the largest cross product of two rows of S - lambda. Any direction where
 * all principal stresses are equal. */
RANGE_INLINE void crack_front_normal(const struct sph_columns *c, size_t i, double normal[3]) {
  const double xx = c->stress[0][i], xy = c->stress[1][i], xz = c->stress[2][i], yy = c->stress[3][i];
  const double yz = c->stress[4][i], lambda = fracture_largest(xx, xy, xz, yy, yz);
  const double row[3][3] = {{xx - lambda, xy, xz}, {xy, yy - lambda, yz}, {xz, yz, -(xx + yy) - lambda}};
  double best = 0;
  normal[0] = normal[1] = 0, normal[2] = 1;
  for (int k = 0; k < 3; k++) {
    const double *a = row[k], *b = row[(k + 1) % 3];
    const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double square = cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2];
    if (!(square > best))
      continue;
    best = square;
    for (int d = 0; d < 3; d++)
      normal[d] = cross[d] / sqrt(square);
  }
}

/* Tension across a plane, Pa, before damage takes its part. */
RANGE_INLINE double crack_front_tension(const struct sph_columns *c, size_t i, const double n[3]) {
  const double xx = c->stress[0][i], xy = c->stress[1][i], xz = c->stress[2][i], yy = c->stress[3][i];
  const double yz = c->stress[4][i], zz = -(xx + yy);
  return xx * n[0] * n[0] + yy * n[1] * n[1] + zz * n[2] * n[2] +
         2 * (xy * n[0] * n[1] + xz * n[0] * n[2] + yz * n[1] * n[2]) - c->pressure[i];
}

/* Makes the particle behave as one with a flaw that any tension opens. */
RANGE_INLINE void crack_front_break(struct sph_columns *c, size_t i) {
  if (c->damage[i] >= 1)
    return;
  c->weakest[i] = 0;
  c->damage_cap[i] = 1;
  if (c->open_rate[i] > 0)
    return; /* by its own flaws */
  c->open_from[i] = 0;
  c->open_rate[i] = c->crack_rate[i];
}

RANGE_INLINE void crack_front_set(struct sph_columns *c, size_t i, const struct sph_crack_front_tip *tip) {
  c->front_time[i] = tip->time;
  c->front_offset[i] = tip->offset;
  c->front_stress[i] = tip->stress;
  for (int d = 0; d < 3; d++)
    c->front_normal[d][i] = tip->normal[d];
}

/* The front of the crack that reaches particle i first, if one has come by the time `now`. */
static void crack_front_arrive(struct sph_system *s, const struct sph_crack_front_links *l, size_t i, size_t own,
                               double now) {
  const double *x = l->place + 3 * own, width = s->c.h_initial[i];
  struct sph_crack_front_tip best = {.time = INFINITY};
  for (size_t k = l->first[own]; k < l->first[own + 1]; k++) {
    const struct sph_crack_front_tip *tip = &l->tip[l->other[k]];
    if (!(tip->time <= now))
      continue;
    const double *y = l->place + 3 * l->other[k], way[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
    const double time = tip->time + sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]) / l->speed;
    const double offset = tip->offset + way[0] * tip->normal[0] + way[1] * tip->normal[1] + way[2] * tip->normal[2];
    if (!(time <= now && time < best.time) || fabs(offset) > width ||
        !(crack_front_tension(&s->c, i, tip->normal) >= tip->stress))
      continue;
    best = *tip;
    best.time = time;
    best.offset = offset;
  }
  if (!isfinite(best.time))
    return;
  best.time = range_larger(best.time, now - s->dt); /* it waited for tension */
  crack_front_set(&s->c, i, &best);
}

RANGE_HOOK void crack_front_range(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  const struct sph_crack_front_links *l = body->prepared[SPH_MODULE_crack_front];
  const struct sph_flaws_lists *flaws = body->prepared[SPH_MODULE_weibull];
  const double *damage = fracture_own_damage(s, body), now = s->now.time + s->dt;
  const double arrest = s->in.crack_front.arrest * sph_material_young_modulus(&body->physics.material);
  for (size_t i = b->low; i < b->high; i++) {
    const size_t own = s->id[i] - body->first;
    if (isfinite(s->c.front_time[i])) {
      crack_front_break(&s->c, i);
    } else if (damage[i] > 0) {
      struct sph_crack_front_tip start = {.time = now};
      start.stress = arrest * sph_flaws_lowest(flaws, own);
      crack_front_normal(&s->c, i, start.normal);
      crack_front_set(&s->c, i, &start);
    } else if (l->near[own]) {
      crack_front_arrive(s, l, i, own, now);
    }
  }
}

RANGE_HOOK void crack_front_after(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  crack_front_publish(s, body, b->low, b->high);
}

static const sph_hook crack_front_hooks[SPH_STAGES] =
    {[SPH_CRACK] = crack_front_range, [SPH_RATES] = crack_front_after};

#endif

#ifdef SPH_MODULE_DESCRIPTORS

static bool crack_front_on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  return body->flaws != NULL && inputs->crack_front.front == SPH_CRACK_FRONT_PLANE;
}

static void crack_front_free_prepared(void *prepared) {
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

/* The lists of the particles within 2h of each, itself included. h: of each particle. False without memory. */
static bool crack_front_link_up(struct sph_crack_front_links *l, const struct sph_kd_tree *tree, const double *h) {
  l->first[0] = 0;
  for (size_t q = 0; q < l->particles; q++)
    l->first[q + 1] = l->first[q] + sph_kd_tree_within(tree, l->place + 3 * q, 2 * h[q], NULL, 0);
  l->other = malloc(l->first[l->particles] * sizeof *l->other);
  for (size_t q = 0; l->other && q < l->particles; q++)
    sph_kd_tree_within(tree, l->place + 3 * q, 2 * h[q], l->other + l->first[q], l->first[q + 1] - l->first[q]);
  return l->other != NULL;
}

static status crack_front_prepare(const struct sph_inputs *inputs, const struct sph_particles *p,
                                  struct sph_solid *body, struct error *error) {
  (void)inputs;
  struct sph_kd_tree *tree = NULL;
  const size_t n = body->last - body->first, from = body->first;
  struct sph_crack_front_links *links = memory_small(1, sizeof *links);
  links->particles = n;
  links->place = malloc(3 * n * sizeof *links->place);
  links->first = malloc((n + 1) * sizeof *links->first);
  links->tip = malloc(n * sizeof *links->tip);
  links->near = calloc(n, sizeof *links->near);
  if (!links->place || !links->first || !links->tip || !links->near) {
    crack_front_free_prepared(links);
    return status_fail(error, STATUS_MEMORY, "no memory for the crack fronts of %zu particles", n);
  }
  links->speed = sph_material_crack_speed(&body->physics.material);
  for (size_t q = 0; q < n; q++) {
    const double at[3] = {p->x[from + q], p->y[from + q], p->z[from + q]};
    memcpy(links->place + 3 * q, at, sizeof at);
    links->tip[q] = (struct sph_crack_front_tip){.time = INFINITY};
  }
  status code = sph_kd_tree_create(n, p->x + from, p->y + from, p->z + from, &tree, error);
  if (!code && !crack_front_link_up(links, tree, p->h + from))
    code = status_fail(error, STATUS_MEMORY, "no memory for the neighbours of %zu particles", n);
  sph_kd_tree_free(tree);
  if (code)
    crack_front_free_prepared(links);
  else
    body->prepared[SPH_MODULE_crack_front] = links;
  return code;
}

static void crack_front_restored(struct sph_system *s, const struct sph_solid *body) {
  struct sph_crack_front_links *l = body->prepared[SPH_MODULE_crack_front];
  memset(l->near, 0, l->particles);
  for (size_t q = 0; q < l->particles; q++)
    l->tip[q].time = INFINITY;
  crack_front_publish(s, body, body->first, body->last);
}

static const struct sph_column_need crack_front_columns[] = {{SPH_COLUMNS_OF(front_time), INFINITY, NULL},
                                                             {SPH_COLUMNS_OF(front_offset), 0, NULL},
                                                             {SPH_COLUMNS_OF(front_stress), 0, NULL},
                                                             {SPH_COLUMNS_OF(front_normal), 0, NULL},
                                                             {0}};

static const struct sph_module crack_front_module = {
    .name = "crack_front",
    .doc = "A crack runs on from the particle of its flaw, in its plane, at c_g, where the tension across the plane is "
           "at least what opens the flaw. A particle that the front has reached breaks while it is in tension, without "
           "a flaw of its own and without a cap.",
    .source = "our choice; c_g and what opens a flaw as in Benz & Asphaug 1995",
    .when = "a body whose material has Weibull parameters, with fracture.front: plane",
    .on = crack_front_on,
    .columns = crack_front_columns,
    .bytes_linked = 350, /* of a particle with 56 neighbours */
    .prepare = crack_front_prepare,
    .free_prepared = crack_front_free_prepared,
    .restored = crack_front_restored,
};

#endif

#ifdef SPH_MODULE_INPUT_ROWS
INPUT_CHOICE(fracture.front, crack_front.front,
             FIELD_WORDS_HERE(SPH_CRACK_FRONTS, [SPH_CRACK_FRONT_NONE] = "none", [SPH_CRACK_FRONT_PLANE] = "plane"),
             .absent = "none", .when = "target.fracture=auto|on",
             .choice_docs = "it ends at its particle, and each particle breaks by flaws of its own, as printed: "
                            "strength grows with the number of particles\n"
                            "it runs on in its plane at c_g",
             .doc = "Length of a crack that starts at a flaw.", .source = "BA95 for `none`; `plane` is ours"),
    INPUT_REAL(fracture.front_arrest, crack_front.arrest, "1", 0.5, 0, 1, .when = "fracture.front=plane",
               .doc = "A crack continues where the tension across its plane is at least this share of the tension that "
                      "opens its flaw. 0: any tension will do.",
               .source = "our choice"),
#endif
