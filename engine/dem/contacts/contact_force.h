/* Force of one contact from its overlap, several contacts at a time. K99 eqs 1-6; engine/dem/README.md gives the
 * derivation.
 *
 * With C the sum of the pieces of grain 1's outline inside grain 2 (the chord from P1 to P2) and n the unit vector that
 * is C turned left by 90 degrees (it points from 2 to 1): moving grain 1 by d changes the overlap area A by
 * -|C| n . d. So the potential kappa A^2 / 2 gives grain 1 the force kappa A |C| n, with the moment kappa A W about the
 * origin, W = sum of (|p1|^2 - |p0|^2)/2 over the pieces = C . (chord's middle): the force acts at the chord's middle.
 * Other laws (laws.h) have the same direction and place. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_CONTACT_FORCE_H
#define CLAST_ENGINE_DEM_CONTACTS_CONTACT_FORCE_H

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

#endif
