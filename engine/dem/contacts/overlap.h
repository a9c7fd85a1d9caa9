/* Overlap of any two convex polygons by boundary integrals, without case analysis.
 *
 * Every side of either is clipped to the other's half-planes (Cyrus-Beck intervals); the pieces of both outlines are
 * the outline of the overlap. Sides that coincide count once: as the first polygon's, with a tolerance above
 * rounding. Eight vertices of the clipped outline at a time. */
#ifndef CLAST_ENGINE_DEM_CONTACTS_OVERLAP_H
#define CLAST_ENGINE_DEM_CONTACTS_OVERLAP_H

#include <math.h>

#include "engine/dem/contacts/contact_force.h"
#include "engine/dem/contacts/neighbours.h"

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
  for (size_t v = 0; v < p->count; v += LANES) {
    const lanes_d x = lanes_load(p->x + v), y = lanes_load(p->y + v);
    const lanes_d ex = lanes_load(p->x + v + 1) - x, ey = lanes_load(p->y + v + 1) - y;
    lanes_d enter = lanes_all(0.0), leave = lanes_all(1.0);
    for (size_t k = 0; k < q->count; k++) {
      const double sx = q->x[k + 1] - q->x[k], sy = q->y[k + 1] - q->y[k];
      const double same = sqrt(sx * sx + sy * sy) * tolerance;
      lanes_d from = (x - q->x[k]) * sy - (y - q->y[k]) * sx;
      lanes_d to = (x + ex - q->x[k]) * sy - (y + ey - q->y[k]) * sx;
      const lanes_i along = (lanes_abs(from) <= same) & (lanes_abs(to) <= same);
      from = lanes_select(along, lanes_all(own ? -1.0 : 1.0), from);
      to = lanes_select(along, lanes_all(own ? -1.0 : 1.0), to);
      const lanes_d crossing = from / (from - to); /* infinite where both are outside and equal: nothing is left then */
      enter = lanes_max(enter, lanes_mask(from > 0.0, crossing));
      leave = lanes_min(leave, lanes_select(to > 0.0, crossing, lanes_all(1.0)));
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
  double size = 0.0;
  for (int k = 0; k < 2; k++)
    for (size_t v = 1; v < ring[k].count; v++)
      size = fmax(size, fmax(fabs(ring[k].x[v] - ring[k].x[0]), fabs(ring[k].y[v] - ring[k].y[0])));
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

#endif
