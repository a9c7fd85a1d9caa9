/* How the front of a crack goes from particle to particle.
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
#endif

COLUMN(front_time)      /* s, when a crack's front reached the particle; infinite: not yet */
COLUMN(front_offset)    /* m: this and the next as in struct sph_crack_front_tip */
COLUMN(front_stress)    /* Pa */
COLUMN(front_normal[3]) /* 1 */

#ifdef SPH_MODULE_LOOPS

#include "engine/sph/modules/crack_front_links.h"
#include "engine/sph/modules/range_tools.h"

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
  const struct sph_weibull_lists *flaws = body->prepared[SPH_MODULE_weibull];
  const double *damage = fracture_own_damage(s, body), now = s->now.time + s->dt;
  const double arrest = s->in.crack_front.arrest * sph_derived_young_modulus(&body->physics.material);
  for (size_t i = b->low; i < b->high; i++) {
    const size_t own = s->id[i] - body->first;
    if (isfinite(s->c.front_time[i])) {
      crack_front_break(&s->c, i);
    } else if (damage[i] > 0) {
      struct sph_crack_front_tip start = {.time = now};
      start.stress = arrest * sph_weibull_lowest(flaws, own);
      crack_front_normal(&s->c, i, start.normal);
      crack_front_set(&s->c, i, &start);
    } else if (l->near[own]) {
      crack_front_arrive(s, l, i, own, now);
    }
  }
}

RANGE_HOOK void crack_front_after(struct sph_system *s, const struct sph_solid *body, struct sph_block *b) {
  sph_crack_front_publish(s, body, b->low, b->high);
}

static const sph_hook crack_front_hooks[SPH_STAGES] =
    {[SPH_CRACK] = crack_front_range, [SPH_RATES] = crack_front_after};

#endif
