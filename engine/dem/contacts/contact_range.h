/* Contacts, several at a time: the force from the overlap, the overlap itself, and the pairs of the near list. K99 eqs
 * 1-6; engine/dem/README.md gives the derivation.
 *
 * With C the sum of the pieces of grain 1's outline inside grain 2 (the chord from P1 to P2) and n the unit vector that
 * is C turned left by 90 degrees (it points from 2 to 1): moving grain 1 by d changes the overlap area A by
 * -|C| n . d. So the potential kappa A^2 / 2 gives grain 1 the force kappa A |C| n, with the moment kappa A W about the
 * origin, W = sum of (|p1|^2 - |p0|^2)/2 over the pieces = C . (chord's middle): the force acts at the chord's middle.
 * Other laws (laws.h) have the same direction and place. */
#pragma once

#include <math.h>

#include "engine/dem/contacts/laws.h"
#include "engine/dem/step/lanes.h"
#include "engine/dem/step/system_layout.h"

/* Sums over the pieces p0 -> p1 of one outline inside the other, about an origin near the contact. */
struct contact_sums {
  lanes_d twice_area;       /* of both outlines' pieces: p0 x p1 */
  lanes_d chord_x, chord_y; /* grain 1's pieces: p1 - p0 */
  lanes_d moment;           /* grain 1's: (|p1|^2 - |p0|^2) / 2 */
  lanes_d xx, xy, yy;       /* grain 1's: p1 (x) p1 - p0 (x) p0, for the chord's middle; only with velocities */
};

/* Part [enter, leave] of the side from (x, y) along (ex, ey), in units of the side. */
LANES_INLINE void contact_add_piece(struct contact_sums *sums, lanes_d enter, lanes_d leave, lanes_d x, lanes_d y,
                                    lanes_d ex, lanes_d ey, bool own, bool velocities) {
  const lanes_d part = lanes_mask(leave > enter, leave - enter);
  sums->twice_area += part * (x * ey - y * ex);
  if (!own)
    return;
  const lanes_d both = lanes_mask(leave > enter, enter + leave); /* an empty part may have infinite ends */
  sums->chord_x += part * ex;
  sums->chord_y += part * ey;
  sums->moment += part * (x * ex + y * ey + 0.5 * both * (ex * ex + ey * ey));
  if (velocities) {
    sums->xx += part * (2.0 * x * ex + both * ex * ex);
    sums->xy += part * (x * ey + y * ex + both * ex * ey);
    sums->yy += part * (2.0 * y * ey + both * ey * ey);
  }
}

struct contact_pairs {
  lanes_d origin_x, origin_y; /* from grain 1's centre */
  lanes_d apart_x, apart_y;   /* centre of grain 2 from centre of grain 1 */
  lanes_d stiffness, normal_damping, tangential_damping;
  lanes_d vx[2], vy[2], spin[2]; /* only with velocities */
};

struct contact_force {
  lanes_d x, y, torque[2]; /* force on grain 1; torques on either about its own centre */
};

/* `law` and `velocities` are constants of the loop. `touching`: lanes that overlap. `friction_limit`: mu. Powers are
 * added to block lanes `at`... of *booked. */
LANES_INLINE struct contact_force contact_force(const struct contact_sums *sums, const struct contact_pairs *pairs,
                                                lanes_i touching, enum dem_contact_law law, double friction_limit,
                                                bool velocities, struct dem_sums *booked, int at) {
  const lanes_d area = lanes_mask(touching, 0.5 * sums->twice_area);
  const lanes_d cx = lanes_mask(touching, sums->chord_x), cy = lanes_mask(touching, sums->chord_y);
  const lanes_d moment = lanes_mask(touching, sums->moment);
  const lanes_d away_x = pairs->origin_x - pairs->apart_x, away_y = pairs->origin_y - pairs->apart_y;
  struct contact_force force;
  if (!velocities) {
    const lanes_d f = dem_laws_elastic(law, pairs->stiffness, area, lanes_all(1.0));
    force.x = -f * cy;
    force.y = f * cx;
    force.torque[0] = f * moment + (pairs->origin_x * force.y - pairs->origin_y * force.x);
    force.torque[1] = -f * moment - (away_x * force.y - away_y * force.x);
    return force;
  }
  const lanes_d length = lanes_sqrt(cx * cx + cy * cy);
  const lanes_i real = length > 0.0;
  const lanes_d inverse = lanes_mask(real, 1.0 / length);
  const lanes_d tx = cx * inverse, ty = cy * inverse, nx = -ty, ny = tx;
  /* The chord's middle: p (x) p taken from P1 to P2 is C (x) M + M (x) C, so n . (..) . t = |C| (n . M). */
  const lanes_d along = moment * inverse;
  const lanes_d across = lanes_mask(touching,
                                    nx * tx * sums->xx + (nx * ty + ny * tx) * sums->xy + ny * ty * sums->yy) *
                         inverse;
  const lanes_d mx = along * tx + across * nx, my = along * ty + across * ny;
  const lanes_d r1x = pairs->origin_x + mx, r1y = pairs->origin_y + my, r2x = away_x + mx, r2y = away_y + my;
  const lanes_d ux = (pairs->vx[1] - pairs->spin[1] * r2y) - (pairs->vx[0] - pairs->spin[0] * r1y); /* K99 eq 5 */
  const lanes_d uy = (pairs->vy[1] + pairs->spin[1] * r2x) - (pairs->vy[0] + pairs->spin[0] * r1x);
  const lanes_d approach = ux * nx + uy * ny, slip = ux * tx + uy * ty;
  const lanes_d elastic = dem_laws_elastic(law, pairs->stiffness, area, length);
  /* K99 eq 3 with the sign that takes energy out; never attractive. */
  const lanes_d damped = elastic + pairs->normal_damping * approach;
  const lanes_d normal = lanes_mask(touching, lanes_max(damped, damped * 0.0));
  /* K99 eq 4, corrected: -sign(v_T) min(m gamma_T |v_T|, mu |F_N|). */
  const lanes_d speed = lanes_abs(slip);
  const lanes_d friction = lanes_min(pairs->tangential_damping * speed, friction_limit * normal);
  const lanes_d signed_friction = lanes_select(slip < 0.0, -friction, friction);
  force.x = normal * nx + signed_friction * tx;
  force.y = normal * ny + signed_friction * ty;
  force.torque[0] = r1x * force.y - r1y * force.x;
  force.torque[1] = -(r2x * force.y - r2y * force.x);
  lanes_store(booked->contact + at, lanes_load(booked->contact + at) + lanes_mask(touching, elastic * approach));
  lanes_store(booked->damping + at,
              lanes_load(booked->damping + at) + lanes_mask(touching, (normal - elastic) * approach));
  lanes_store(booked->friction + at, lanes_load(booked->friction + at) + lanes_mask(touching, friction * speed));
  return force;
}

/* ---- overlap of any two convex polygons by boundary integrals, without case analysis ----
 *
 * Every side of either is clipped to the other's half-planes (Cyrus-Beck intervals); the pieces of both outlines are
 * the outline of the overlap. Sides that coincide count once: as the first polygon's, with a tolerance above
 * rounding. Eight vertices of the clipped outline at a time. */

/* Finds the side of either polygon that best separates the two, i.e. with the largest gap; several sides at a time. */
LANES_INLINE void overlap_best_side(const struct dem_ring ring[2], struct dem_overlap *out) {
  out->gap = -(double)INFINITY;
  for (int owner = 0; owner < 2; owner++) {
    const struct dem_ring *a = &ring[owner], *b = &ring[1 - owner];
    for (size_t k = 0; k < a->count; k += LANES) {
      const lanes_d x = lanes_load(a->x + k), y = lanes_load(a->y + k);
      const lanes_d ex = lanes_load(a->x + k + 1) - x, ey = lanes_load(a->y + k + 1) - y;
      const lanes_d size = lanes_sqrt(ex * ex + ey * ey);
      lanes_d nearest = lanes_all((double)INFINITY), vertex = lanes_all(0.0);
      for (size_t v = 0; v < b->count; v++) {
        const lanes_d out_by = (b->x[v] - x) * ey - (b->y[v] - y) * ex;
        const lanes_i nearer = out_by < nearest;
        nearest = lanes_select(nearer, out_by, nearest);
        vertex = lanes_select(nearer, lanes_all((double)v), vertex);
      }
      const lanes_d gap = nearest / size;
      for (size_t lane = 0; lane < LANES && k + lane < a->count; lane++)
        if (gap[lane] > out->gap && size[lane] > 0.0) {
          out->gap = gap[lane];
          out->owner = owner;
          out->side = k + lane;
          out->vertex = (size_t)vertex[lane];
        }
    }
  }
}

/* Pieces of p inside q. A side of p that runs along a side of q to within `tolerance`, m, counts for p if `own`. */
LANES_INLINE void overlap_clip(const struct dem_ring *p, const struct dem_ring *q, double tolerance, bool own,
                               struct contact_sums *sums) {
  double same[DEM_MAX_VERTICES + DEM_BLOCK];
  for (size_t k = 0; k < q->count; k += LANES) {
    const lanes_d sx = lanes_load(q->x + k + 1) - lanes_load(q->x + k),
                  sy = lanes_load(q->y + k + 1) - lanes_load(q->y + k);
    lanes_store(same + k, lanes_sqrt(sx * sx + sy * sy) * tolerance);
  }
  for (size_t v = 0; v < p->count; v += LANES) {
    const lanes_d x = lanes_load(p->x + v), y = lanes_load(p->y + v);
    const lanes_d ex = lanes_load(p->x + v + 1) - x, ey = lanes_load(p->y + v + 1) - y;
    lanes_d enter = lanes_all(0.0), leave = lanes_all(1.0);
    for (size_t k = 0; k < q->count; k++) {
      const double sx = q->x[k + 1] - q->x[k], sy = q->y[k + 1] - q->y[k];
      lanes_d from = (x - q->x[k]) * sy - (y - q->y[k]) * sx;
      lanes_d to = (x + ex - q->x[k]) * sy - (y + ey - q->y[k]) * sx;
      const lanes_i along = (lanes_abs(from) <= same[k]) & (lanes_abs(to) <= same[k]);
      from = lanes_select(along, lanes_all(own ? -1.0 : 1.0), from);
      to = lanes_select(along, lanes_all(own ? -1.0 : 1.0), to);
      /* Infinite where both are outside and equal: nothing is left then. */
      const lanes_d crossing = lanes_rounded(from / (from - to));
      enter = lanes_raise(lanes_positive(from), enter, crossing);
      leave = lanes_lower(lanes_positive(to), leave, crossing);
    }
    contact_add_piece(sums, enter, leave, x, y, ex, ey, own, true);
  }
}

LANES_INLINE double overlap_total(lanes_d value) {
  double total = 0.0;
  for (int lane = 0; lane < LANES; lane++)
    total += value[lane];
  return total;
}

/* Computes the overlap. Moves the rings' origin to the contact. */
static inline void overlap_rings(struct dem_ring ring[2], struct dem_overlap *out) {
  lanes_d farthest = lanes_all(0.0);
  for (int k = 0; k < 2; k++)
    for (size_t v = 0; v < ring[k].count; v += LANES)
      farthest = lanes_max(farthest, lanes_max(lanes_abs(lanes_load(ring[k].x + v) - ring[k].x[0]),
                                               lanes_abs(lanes_load(ring[k].y + v) - ring[k].y[0])));
  double size = 0.0;
  for (int lane = 0; lane < LANES; lane++)
    size = farthest[lane] > size ? farthest[lane] : size;
  const double tolerance = 1e-12 * size; /* above the rounding of positions */
  overlap_best_side(ring, out);
  out->apart = out->gap >= -tolerance;
  if (out->apart)
    return;
  out->origin_x = ring[1 - out->owner].x[out->vertex];
  out->origin_y = ring[1 - out->owner].y[out->vertex];
  for (int k = 0; k < 2; k++)
    for (size_t v = 0; v <= dem_overlap_last(&ring[k]); v++) {
      ring[k].x[v] -= out->origin_x;
      ring[k].y[v] -= out->origin_y;
    }
  struct contact_sums sums = {0};
  overlap_clip(&ring[0], &ring[1], tolerance, true, &sums);
  overlap_clip(&ring[1], &ring[0], tolerance, false, &sums);
  out->twice_area = overlap_total(sums.twice_area);
  out->chord_x = overlap_total(sums.chord_x);
  out->chord_y = overlap_total(sums.chord_y);
  out->moment = overlap_total(sums.moment);
  out->xx = overlap_total(sums.xx);
  out->xy = overlap_total(sums.xy);
  out->yy = overlap_total(sums.yy);
}

/* ---- pairs of the near list ----
 *
 * And the general overlap of pairs that neither a cached side nor a bond's window decides. */

/* Tests the cached separating sides, several pairs at a time. Pairs that they do not separate go to the general list.
 */
static void near_range(struct dem_system *s) {
  const struct dem_columns *c = &s->c;
  const size_t blocks = (s->now.near_count + DEM_BLOCK - 1) / DEM_BLOCK;
  for (size_t b = 0; b < blocks; b++) {
    const struct dem_near_block *block = &s->near[b];
    for (int at = 0; at < DEM_BLOCK; at += LANES) {
      const uint32_t *owner = block->owner + at, *other = block->other + at;
      const lanes_d oc = lanes_gather(c->cosine, owner), os = lanes_gather(c->sine, owner);
      const lanes_d bc = lanes_gather(c->cosine, other), bs = lanes_gather(c->sine, other);
      const lanes_d dx = lanes_gather(c->x, other) - lanes_gather(c->x, owner);
      const lanes_d dy = lanes_gather(c->y, other) - lanes_gather(c->y, owner);
      const lanes_d sx = lanes_load(block->side_x + at), sy = lanes_load(block->side_y + at);
      const lanes_d ex = oc * sx - os * sy, ey = os * sx + oc * sy;
      lanes_d out[3];
      for (int v = 0; v < 3; v++) {
        const lanes_d vx = lanes_load(block->vertex_x[v] + at), vy = lanes_load(block->vertex_y[v] + at);
        const lanes_d x = dx + (bc * vx - bs * vy), y = dy + (bs * vx + bc * vy);
        out[v] = x * ey - y * ex - lanes_load(block->offset + at);
      }
      const lanes_i apart = (out[1] > 0.0) & (out[1] <= out[0]) & (out[1] <= out[2]);
      if (!lanes_any(~apart))
        continue;
      for (int lane = 0; lane < LANES; lane++)
        if (!apart[lane] && owner[lane] != s->ghost)
          s->general[s->general_count++] = (uint32_t)(b * DEM_BLOCK + (size_t)(at + lane));
    }
  }
}

/* Buffer of contacts until there are enough for a full vector. */
enum { NEAR_COLUMNS = 12 };
struct near_batch {
  int count;
  uint32_t first[LANES], second[LANES];
  double column[NEAR_COLUMNS][LANES]; /* sums, origin, coefficients: the order of near_add */
};

LANES_INLINE void near_flush(struct dem_system *s, struct near_batch *batch, bool measure, enum dem_contact_law law,
                             bool velocities) {
  if (!batch->count)
    return;
  for (int lane = batch->count; lane < LANES; lane++) {
    batch->first[lane] = s->ghost;
    batch->second[lane] = s->ghost + 1;
    for (int f = 0; f < NEAR_COLUMNS; f++)
      batch->column[f][lane] = 0.0;
  }
  const struct dem_columns *c = &s->c;
  lanes_d v[NEAR_COLUMNS];
  for (int f = 0; f < NEAR_COLUMNS; f++)
    v[f] = lanes_load(batch->column[f]);
  const struct contact_sums sums =
      {.twice_area = v[0], .chord_x = v[1], .chord_y = v[2], .moment = v[3], .xx = v[4], .xy = v[5], .yy = v[6]};
  struct contact_pairs pairs = {.origin_x = v[7],
                                .origin_y = v[8],
                                .stiffness = v[9],
                                .normal_damping = v[10],
                                .tangential_damping = v[11]};
  const uint32_t *index[2] = {batch->first, batch->second};
  pairs.apart_x = lanes_gather(c->x, index[1]) - lanes_gather(c->x, index[0]);
  pairs.apart_y = lanes_gather(c->y, index[1]) - lanes_gather(c->y, index[0]);
  if (measure) {
    lanes_store(s->sums.contact, lanes_load(s->sums.contact) + 0.125 * pairs.stiffness * v[0] * v[0]);
    for (int lane = 0; lane < batch->count; lane++)
      s->sums.overlaps += v[0][lane] > 0.0;
  } else {
    if (velocities)
      for (int k = 0; k < 2; k++) {
        pairs.vx[k] = lanes_gather(c->guess_vx, index[k]);
        pairs.vy[k] = lanes_gather(c->guess_vy, index[k]);
        pairs.spin[k] = lanes_gather(c->guess_spin, index[k]);
      }
    const struct contact_force f = contact_force(&sums, &pairs, v[0] > 0.0, law, s->in->contact.friction, velocities,
                                                 &s->sums, 0);
    for (int lane = 0; lane < batch->count; lane++) {
      const uint32_t i = batch->first[lane], j = batch->second[lane];
      c->fx[i] += f.x[lane];
      c->fy[i] += f.y[lane];
      c->torque[i] += f.torque[0][lane];
      c->fx[j] -= f.x[lane];
      c->fy[j] -= f.y[lane];
      c->torque[j] += f.torque[1][lane];
    }
  }
  batch->count = 0;
}

/* A pair for the general overlap, with its present coefficients. */
struct near_candidate {
  uint32_t first, second;
  struct dem_contact contact;
};

LANES_INLINE struct near_candidate near_candidate(const struct dem_system *s, uint32_t code) {
  const uint32_t slot = code & ~DEM_FROM_BOND;
  if (code & DEM_FROM_BOND) {
    const int32_t pair = s->lane_pair[slot];
    return (struct near_candidate){s->pair[pair][0], s->pair[pair][1], dem_breaking_contact(s, pair)};
  }
  const struct dem_near_pair *near = &s->near_pair[slot];
  if (near->pair == DEM_NO_PAIR)
    return (struct near_candidate){near->first, near->second, near->contact};
  return (struct near_candidate){near->first, near->second, dem_breaking_contact(s, near->pair)};
}

/* The pairs of the general list lie far apart in memory. Before the pair at `k`: asks for what the pairs after it need,
 * in the order in which one address follows from another. */
LANES_INLINE void near_prefetch(const struct dem_system *s, size_t k) {
  enum { OUTLINES = 2, COEFFICIENTS = 4, PAIRS = 6 }; /* so many pairs ahead */
  if (k + PAIRS >= s->general_count)
    return;
  const uint32_t *code = &s->general[k];
  if (code[PAIRS] & DEM_FROM_BOND)
    __builtin_prefetch(&s->lane_pair[code[PAIRS] & ~DEM_FROM_BOND]);
  else
    __builtin_prefetch(&s->near_pair[code[PAIRS]]);
  const int32_t pair = code[COEFFICIENTS] & DEM_FROM_BOND ? s->lane_pair[code[COEFFICIENTS] & ~DEM_FROM_BOND]
                                                          : s->near_pair[code[COEFFICIENTS]].pair;
  if (pair != DEM_NO_PAIR) {
    __builtin_prefetch(&s->pair[pair]);
    __builtin_prefetch(&s->pair_contact[pair]);
    __builtin_prefetch(&s->alive[pair]);
  }
  const uint32_t slot = code[OUTLINES] & ~DEM_FROM_BOND;
  const bool bond = code[OUTLINES] & DEM_FROM_BOND;
  const uint32_t grain[2] = {bond ? s->pair[s->lane_pair[slot]][0] : s->near_pair[slot].first,
                             bond ? s->pair[s->lane_pair[slot]][1] : s->near_pair[slot].second};
  for (int end = 0; end < 2; end++) {
    __builtin_prefetch(&s->outline_x[s->first_vertex[grain[end]]]);
    __builtin_prefetch(&s->outline_y[s->first_vertex[grain[end]]]);
  }
}

LANES_INLINE void near_add(struct near_batch *batch, const struct near_candidate *candidate,
                           const struct dem_overlap *overlap) {
  const struct dem_contact *contact = &candidate->contact;
  const double column[NEAR_COLUMNS] = {overlap->twice_area,
                                       overlap->chord_x,
                                       overlap->chord_y,
                                       overlap->moment,
                                       overlap->xx,
                                       overlap->xy,
                                       overlap->yy,
                                       overlap->origin_x,
                                       overlap->origin_y,
                                       contact->stiffness,
                                       contact->normal_damping,
                                       contact->tangential_damping};
  batch->first[batch->count] = candidate->first;
  batch->second[batch->count] = candidate->second;
  for (int f = 0; f < NEAR_COLUMNS; f++)
    batch->column[f][batch->count] = column[f];
  batch->count++;
}

/* Evaluates the pairs one by one with the general overlap. A near pair that is apart gets a new cached side (unless
 * measuring). */
LANES_INLINE void near_general(struct dem_system *s, bool measure, enum dem_contact_law law, bool velocities) {
  struct near_batch batch = {0};
  struct dem_ring ring[2];
  for (size_t k = 0; k < s->general_count; k++) {
    const uint32_t code = s->general[k];
    near_prefetch(s, k);
    const struct near_candidate candidate = near_candidate(s, code);
    const uint32_t i = candidate.first, j = candidate.second;
    dem_system_arrays_ring(s, i, 0.0, 0.0, &ring[0]);
    dem_system_arrays_ring(s, j, s->c.x[j] - s->c.x[i], s->c.y[j] - s->c.y[i], &ring[1]);
    struct dem_overlap overlap;
    overlap_rings(ring, &overlap);
    if (overlap.apart) {
      if (!measure && !(code & DEM_FROM_BOND))
        dem_neighbours_cache_side(s, code, &overlap);
      continue;
    }
    if (!(overlap.twice_area > 0.0) || !(candidate.contact.stiffness > 0.0))
      continue;
    near_add(&batch, &candidate, &overlap);
    if (batch.count == LANES)
      near_flush(s, &batch, measure, law, velocities);
  }
  near_flush(s, &batch, measure, law, velocities);
}
