/* Tessellation pairs: beam and contact of eight pairs at a time.
 *
 * The beam is co-rotational (K99 eqs 7-12 with the correction of eq 12 in engine/dem/README.md). phi is the chord's
 * angle from its initial direction, and Theta = theta - phi:
 *   U   = alpha (l - l0)^2 / 2 + delta l0^2 (Theta_1 - Theta_2)^2 / 2 + beta l0^2 Theta_1 Theta_2 / 2
 *   M_1 = -dU/dTheta_1 = -beta l0^2 Theta_2 / 2 + delta l0^2 (Theta_2 - Theta_1), M_2 by swap
 *   F_1 = alpha (l - l0) e + (M_1 + M_2)/l e_perp, F_2 = -F_1   (from dphi/dx = e_perp / l)
 * The force has a potential, and conserves momentum and angular momentum.
 *
 * The contact's window: of each grain the common side, the side before it and the side after it (vertices 0..3). It
 * gives the overlap of the whole polygons exactly when, for each grain, its vertices 0 and 3 are outside the other's
 * common side while 1 or 2 is inside. Then all its other vertices are outside too (distance to a line has one minimum
 * round a convex outline), so none of its other sides reaches the half-plane of the other grain. If this does not hold
 * and no common side separates the grains, the lane goes to the general overlap. */
#pragma once

#include "engine/dem/contacts/contact_range.h"
#include "engine/dem/step/system_layout.h"

/* Sides nearer to one line than this share of their length count as in one line; the share is above the rounding of
 * positions. */
static const double bond_same_line = 1e-12;

enum bond_work { BOND_FORCES, BOND_MEASURE };

struct bond_ends { /* gathered states of the grains at either end */
  lanes_d x[2], y[2], angle[2], cosine[2], sine[2];
};

LANES_INLINE void bond_rotate(lanes_d c, lanes_d s, const double *x, const double *y, lanes_d *rx, lanes_d *ry) {
  const lanes_d bx = lanes_load(x), by = lanes_load(y);
  *rx = c * bx - s * by;
  *ry = s * bx + c * by;
}

LANES_INLINE lanes_d bond_length(lanes_d x, lanes_d y) {
  return lanes_sqrt(x * x + lanes_rounded(y * y));
}

/* Angle whose sine is s, |s| <= 1/8: series to s^17, next term below 1e-18. */
LANES_INLINE lanes_d bond_arcsine(lanes_d s) {
  const lanes_d z = s * s;
  return s + s * z *
                 (1.0 / 6.0 +
                  z * (3.0 / 40.0 +
                       z * (5.0 / 112.0 +
                            z * (35.0 / 1152.0 +
                                 z * (63.0 / 2816.0 +
                                      z * (231.0 / 13312.0 + z * (143.0 / 10240.0 + z * (6435.0 / 557056.0))))))));
}

/* Turns both windows to the grains' present places; (*origin_x, *origin_y) is the origin from grain 1's centre. */
LANES_INLINE void bond_place_windows(const struct dem_bond_block *block, int at, const struct bond_ends *ends,
                                     lanes_d apart_x, lanes_d apart_y, lanes_d x[2][4], lanes_d y[2][4],
                                     lanes_d ex[2][3], lanes_d ey[2][3], lanes_d cross[2][3], lanes_d *origin_x,
                                     lanes_d *origin_y) {
  lanes_d half_x[2], half_y[2], middle_x[2], middle_y[2];
  for (int k = 0; k < 2; k++) {
    const lanes_d c = ends->cosine[k], s = ends->sine[k];
    bond_rotate(c, s, block->middle_x[k] + at, block->middle_y[k] + at, &middle_x[k], &middle_y[k]);
    bond_rotate(c, s, block->half_x[k] + at, block->half_y[k] + at, &half_x[k], &half_y[k]);
    bond_rotate(c, s, block->before_x[k] + at, block->before_y[k] + at, &x[k][0], &y[k][0]);
    bond_rotate(c, s, block->after_x[k] + at, block->after_y[k] + at, &x[k][3], &y[k][3]);
    x[k][1] = -half_x[k];
    y[k][1] = -half_y[k];
    x[k][2] = half_x[k];
    y[k][2] = half_y[k];
  }
  const lanes_d shift_x = apart_x + middle_x[1] - middle_x[0], shift_y = apart_y + middle_y[1] - middle_y[0];
  *origin_x = middle_x[0];
  *origin_y = middle_y[0];
  for (int v = 0; v < 4; v++) {
    x[1][v] += shift_x;
    y[1][v] += shift_y;
  }
  for (int k = 0; k < 2; k++) {
    for (int e = 0; e < 3; e++) {
      ex[k][e] = x[k][e + 1] - x[k][e];
      ey[k][e] = y[k][e + 1] - y[k][e];
    }
    ex[k][1] = 2.0 * half_x[k];
    ey[k][1] = 2.0 * half_y[k];
    for (int e = 0; e < 3; e++)
      cross[k][e] = x[k][e] * ey[k][e] - y[k][e] * ex[k][e];
  }
}

/* Contact by the window; returns lanes that need the general overlap, *touching lanes have their sums in *sums. */
LANES_INLINE lanes_i bond_window(const struct dem_bond_block *block, int at, const struct bond_ends *ends,
                                 lanes_d apart_x, lanes_d apart_y, struct contact_sums *sums, lanes_d *origin_x,
                                 lanes_d *origin_y, lanes_i *touching, bool velocities) {
  const lanes_i active = lanes_load(block->stiffness + at) > 0.0;
  lanes_d x[2][4], y[2][4], ex[2][3], ey[2][3], cross[2][3];
  bond_place_windows(block, at, ends, apart_x, apart_y, x, y, ex, ey, cross, origin_x, origin_y);
  /* out[k][e][v]: vertex v of the other grain against side e of grain k, times the side's length; > 0 is outside. */
  lanes_d out[2][3][4];
  for (int k = 0; k < 2; k++)
    for (int v = 0; v < 4; v++)
      out[k][1][v] = x[1 - k][v] * ey[k][1] - y[1 - k][v] * ex[k][1] - cross[k][1];
  lanes_i separated = ~active, exact = active;
  for (int k = 0; k < 2; k++) {
    const lanes_d nearest = lanes_min(out[k][1][1], out[k][1][2]);
    const lanes_d end = lanes_min(out[k][1][0], out[k][1][3]);
    separated |= (nearest >= 0.0) & (nearest <= end);
    exact &= (nearest < 0.0) & (end >= 0.0);
  }
  *touching = exact & ~separated;
  const lanes_i general = ~separated & ~exact;
  *sums = (struct contact_sums){0};
  if (!lanes_any(*touching))
    return general;
  for (int k = 0; k < 2; k++)
    for (int e = 0; e < 3; e += 2)
      for (int v = 0; v < 4; v++)
        out[k][e][v] = x[1 - k][v] * ey[k][e] - y[1 - k][v] * ex[k][e] - cross[k][e];
  /* Clip side a of grain 1 and side b of grain 2 against each other's half-planes: in either case the crossing is at
   * distance / difference of distances. */
  lanes_d enter[2][3], leave[2][3];
  for (int k = 0; k < 2; k++)
    for (int e = 0; e < 3; e++)
      enter[k][e] = lanes_all(0.0), leave[k][e] = lanes_all(1.0);
  for (int a = 0; a < 3; a++) {
    for (int b = 0; b < 3; b++) {
      const lanes_d on_a = lanes_rounded(out[1][b][a] / (out[1][b][a] - out[1][b][a + 1]));
      const lanes_d on_b = lanes_quotient(out[0][a][b], out[0][a][b] - out[0][a][b + 1]);
      lanes_condition start_a = lanes_positive(out[1][b][a]), end_a = lanes_positive(out[1][b][a + 1]);
      lanes_condition start_b = lanes_positive(out[0][a][b]);
      if (a + b == 2 && a != 1) { /* sides that can lie in one line (a square lattice): counted once, as grain 1's */
        const lanes_d same_a = bond_same_line * (ex[1][b] * ex[1][b] + ey[1][b] * ey[1][b]);
        const lanes_d same_b = bond_same_line * (ex[0][a] * ex[0][a] + ey[0][a] * ey[0][a]);
        const lanes_condition along_a = lanes_within(out[1][b][a], same_a) & lanes_within(out[1][b][a + 1], same_a);
        const lanes_condition along_b = lanes_within(out[0][a][b], same_b) & lanes_within(out[0][a][b + 1], same_b);
        start_a &= ~along_a, end_a &= ~along_a, start_b &= ~along_b;
        enter[1][b] = lanes_raise(along_b, enter[1][b], lanes_all(2.0));
      }
      enter[0][a] = lanes_raise(start_a, enter[0][a], on_a);
      leave[0][a] = lanes_lower(end_a, leave[0][a], on_a);
      enter[1][b] = lanes_raise(start_b, enter[1][b], on_b);
      leave[1][b] = lanes_lower(lanes_positive(out[0][a][b + 1]), leave[1][b], on_b);
    }
  }
  for (int k = 0; k < 2; k++)
    for (int e = 0; e < 3; e++)
      contact_add_piece(sums, enter[k][e], leave[k][e], x[k][e], y[k][e], ex[k][e], ey[k][e], k == 0, velocities);
  return general;
}

/* Lengths and directions at rest, as bond_range will compute them: strain and angle start at exactly zero. */
static void bond_rest(struct dem_system *s) {
  for (size_t b = 0; b < s->now.bond_blocks; b++) {
    struct dem_bond_block *block = &s->bond[b];
    for (int at = 0; at < DEM_BLOCK; at += LANES) {
      const lanes_d dx = lanes_gather(s->c.x, block->second + at) - lanes_gather(s->c.x, block->first + at);
      const lanes_d dy = lanes_gather(s->c.y, block->second + at) - lanes_gather(s->c.y, block->first + at);
      const lanes_d length = bond_length(dx, dy), inverse = 1.0 / length;
      lanes_store(block->length + at, length);
      lanes_store(block->reference_x + at, lanes_rounded(dx * inverse));
      lanes_store(block->reference_y + at, lanes_rounded(dy * inverse));
    }
  }
}

/* Beams of LANES lanes now. */
struct bond_beams {
  lanes_d dx, dy, length, inverse; /* chord from grain 1 to grain 2; 1/length */
  lanes_d ux, uy;                  /* its direction */
  lanes_d theta_1, theta_2;        /* rotations of the ends against the chord */
  lanes_d stretch;                 /* l - l0 */
};

struct bond_forces {
  lanes_d x, y; /* on grain 1; grain 2 gets the opposite */
  lanes_d torque_1, torque_2;
};

LANES_INLINE struct bond_ends bond_gather(const struct dem_columns *c, const uint32_t *const index[2], bool contact) {
  struct bond_ends ends;
  for (int k = 0; k < 2; k++) {
    ends.x[k] = lanes_gather(c->x, index[k]);
    ends.y[k] = lanes_gather(c->y, index[k]);
    ends.angle[k] = lanes_gather(c->angle, index[k]);
    if (contact) {
      ends.cosine[k] = lanes_gather(c->cosine, index[k]);
      ends.sine[k] = lanes_gather(c->sine, index[k]);
    }
  }
  return ends;
}

/* Measures the chords. A chord that has turned far gets a new reference direction, unless the call only measures: then
 * the evaluation before has already turned all references that had to turn. */
LANES_INLINE struct bond_beams bond_chords(struct dem_bond_block *block, int at, const struct bond_ends *ends,
                                           enum bond_work work) {
  struct bond_beams b;
  b.dx = ends->x[1] - ends->x[0];
  b.dy = ends->y[1] - ends->y[0];
  b.length = bond_length(b.dx, b.dy);
  b.inverse = 1.0 / b.length;
  b.ux = lanes_rounded(b.dx * b.inverse);
  b.uy = lanes_rounded(b.dy * b.inverse);
  lanes_d sine, forward;
  for (;;) {
    const lanes_d rx = lanes_load(block->reference_x + at), ry = lanes_load(block->reference_y + at);
    sine = rx * (b.uy - ry) - ry * (b.ux - rx); /* = r x u, and exactly zero for u = r */
    forward = rx * b.ux + ry * b.uy;
    const lanes_i turned = (lanes_abs(sine) > 0.125) | (forward < 0.0);
    if (work == BOND_MEASURE || __builtin_expect(!lanes_any(turned), 1))
      break;
    for (int lane = 0; lane < LANES; lane++)
      if (turned[lane])
        dem_breaking_turn(block, at + lane, b.ux[lane], b.uy[lane], sine[lane], forward[lane]);
  }
  const lanes_d phi = lanes_load(block->reference_angle + at) + bond_arcsine(sine);
  b.theta_1 = ends->angle[0] - phi;
  b.theta_2 = ends->angle[1] - phi;
  b.stretch = b.length - lanes_load(block->length + at);
  return b;
}

/* K99 eq 13, on stretched beams only. */
LANES_INLINE void bond_break(struct dem_system *s, struct dem_bond_block *block, int at, const struct bond_beams *b) {
  const lanes_d bending = lanes_max(lanes_abs(b->theta_1), lanes_abs(b->theta_2));
  const lanes_d criterion = b->stretch * b->stretch * lanes_load(block->weight_strain + at) +
                            bending * lanes_load(block->weight_angle + at);
  const lanes_i broken = (criterion >= 1.0) & (b->stretch > 0.0);
  if (__builtin_expect(!lanes_any(broken), 1))
    return;
  for (int lane = 0; lane < LANES; lane++)
    if (broken[lane])
      dem_breaking_lane(s, block, at + lane, b->length[lane], b->ux[lane], b->uy[lane], b->theta_1[lane],
                        b->theta_2[lane]);
}

/* Forces of the beams; when measuring, their energy is added to the sums instead. */
LANES_INLINE struct bond_forces bond_beam_forces(struct dem_system *s, const struct dem_bond_block *block, int at,
                                                 const struct bond_beams *b, enum bond_work work) {
  const lanes_d axial = lanes_load(block->axial + at);
  const lanes_d along = lanes_load(block->cross + at), diagonal = lanes_load(block->diagonal + at);
  if (work == BOND_MEASURE) {
    const lanes_d energy = 0.5 * axial * b->stretch * b->stretch +
                           0.5 * diagonal * (b->theta_1 - b->theta_2) * (b->theta_1 - b->theta_2) +
                           along * b->theta_1 * b->theta_2;
    lanes_store(s->sums.beam + at, lanes_load(s->sums.beam + at) + energy);
  }
  const lanes_d m1 = diagonal * (b->theta_2 - b->theta_1) - along * b->theta_2;
  const lanes_d m2 = diagonal * (b->theta_1 - b->theta_2) - along * b->theta_1;
  const lanes_d tension = axial * b->stretch, shear = (m1 + m2) * b->inverse;
  return (struct bond_forces){.x = tension * b->ux - shear * b->uy,
                              .y = tension * b->uy + shear * b->ux,
                              .torque_1 = m1,
                              .torque_2 = m2};
}

/* Contacts by the windows: adds their forces, or their energy when measuring. `lane` is the first lane's number; lanes
 * that no window decides go to the general list. */
LANES_INLINE void bond_contacts(struct dem_system *s, const struct dem_bond_block *block, int at, uint32_t lane,
                                const uint32_t *const index[2], const struct bond_ends *ends,
                                const struct bond_beams *b, enum bond_work work, enum dem_contact_law law,
                                bool velocities, struct bond_forces *forces) {
  const struct dem_columns *c = &s->c;
  struct contact_sums sums;
  struct contact_pairs pairs = {.apart_x = b->dx, .apart_y = b->dy, .stiffness = lanes_load(block->stiffness + at)};
  lanes_i touching;
  const lanes_i general = bond_window(block, at, ends, b->dx, b->dy, &sums, &pairs.origin_x, &pairs.origin_y, &touching,
                                      velocities);
  if (lanes_any(general))
    for (uint32_t k = 0; k < LANES; k++)
      if (general[k])
        s->general[s->general_count++] = DEM_FROM_BOND | (lane + k);
  if (work == BOND_MEASURE) {
    const lanes_d area = lanes_mask(touching, 0.5 * sums.twice_area);
    lanes_store(s->sums.contact + at, lanes_load(s->sums.contact + at) + 0.5 * pairs.stiffness * area * area);
    for (int k = 0; k < LANES; k++)
      s->sums.overlaps += area[k] > 0.0;
    return;
  }
  if (!lanes_any(touching))
    return;
  if (velocities) {
    pairs.normal_damping = lanes_load(block->normal_damping + at);
    pairs.tangential_damping = lanes_load(block->tangential_damping + at);
    for (int k = 0; k < 2; k++) {
      pairs.vx[k] = lanes_gather(c->guess_vx, index[k]);
      pairs.vy[k] = lanes_gather(c->guess_vy, index[k]);
      pairs.spin[k] = lanes_gather(c->guess_spin, index[k]);
    }
  }
  const struct contact_force f = contact_force(&sums, &pairs, touching, law, s->in->contact.friction, velocities,
                                               &s->sums, at);
  forces->x += f.x;
  forces->y += f.y;
  forces->torque_1 += f.torque[0];
  forces->torque_2 += f.torque[1];
}

/* Adds the forces to the grains, lane by lane: two lanes may share a grain. */
LANES_INLINE void bond_scatter(double *fx, double *fy, double *torque, const uint32_t *const index[2],
                               const struct bond_forces *f) {
  for (int lane = 0; lane < LANES; lane++) {
    const uint32_t i = index[0][lane], j = index[1][lane];
    fx[i] += f->x[lane];
    fy[i] += f->y[lane];
    torque[i] += f->torque_1[lane];
    fx[j] -= f->x[lane];
    fy[j] -= f->y[lane];
    torque[j] += f->torque_2[lane];
  }
}

/* Work, law and velocities are constants of a call. */
LANES_INLINE void bond_range(struct dem_system *s, enum bond_work work, enum dem_contact_law law, bool velocities) {
  const bool contact = law != DEM_CONTACT_OFF;
  double *restrict fx = s->c.fx, *restrict fy = s->c.fy, *restrict torque = s->c.torque;
  for (size_t k = 0; k < s->now.bond_blocks; k++) {
    struct dem_bond_block *block = &s->bond[k];
    for (int at = 0; at < DEM_BLOCK; at += LANES) {
      const uint32_t *const index[2] = {block->first + at, block->second + at};
      const struct bond_ends ends = bond_gather(&s->c, index, contact);
      const struct bond_beams beams = bond_chords(block, at, &ends, work);
      if (work == BOND_FORCES)
        bond_break(s, block, at, &beams);
      struct bond_forces forces = bond_beam_forces(s, block, at, &beams, work);
      if (contact)
        bond_contacts(s, block, at, (uint32_t)(k * DEM_BLOCK + (size_t)at), index, &ends, &beams, work, law, velocities,
                      &forces);
      if (work == BOND_FORCES)
        bond_scatter(fx, fy, torque, index, &forces);
    }
  }
}
