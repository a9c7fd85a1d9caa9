/* Pairs of the near list, and the general overlap of pairs that neither a cached side nor a bond's window decides. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_NEAR_RANGE_H
#define CLAST_ENGINE_DEM_CONTACTS_NEAR_RANGE_H

#include "engine/dem/beams/breaking.h"
#include "engine/dem/contacts/neighbours.h"
#include "engine/dem/contacts/overlap.h"

/* Tests the cached separating sides, several pairs at a time. Pairs that they do not separate go to the general list.
 */
LANES_INLINE void near_range(struct dem_system *s) {
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

#endif
