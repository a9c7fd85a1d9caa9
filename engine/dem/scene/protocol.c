/* Builds the bodies and sets them in motion: K99 section 3.3. Loads between moving sides: loading.c. */
#include "engine/dem/run/run.h"

#include <math.h>

enum { BODY_FIRST = 0, BODY_SECOND = 1 }; /* streams of the lattice */

status dem_protocol_body(const struct dem_inputs *in, uint64_t seed, struct dem_tessellation **out,
                         struct error *error) {
  struct dem_lattice lattice = {.outline = dem_inputs_round(in) ? DEM_OUTLINE_DISC : DEM_OUTLINE_BLOCK,
                                .spacing = in->grain.spacing,
                                .disorder = in->grain.disorder,
                                .radius = in->body.diameter / 2,
                                .hole = dem_inputs_hole(in),
                                .columns = (uint32_t)in->body.columns,
                                .rows = (uint32_t)in->body.rows,
                                .seed = seed,
                                .stream = BODY_FIRST};
  if (in->kind != DEM_DISC_COLLISION)
    return dem_tessellation_make(&lattice, out, error);

  /* Two discs on approach along x. A grain's outline reaches at most sqrt(2) spacings from its point, and its centroid
   * lies in the disc: with circles of 1.5 spacings more they cannot touch at the start. */
  *out = NULL;
  double across = in->collision.impact_parameter * in->body.diameter;
  double along = dem_inputs_approach(in, in->body.diameter + 3 * in->grain.spacing);
  struct dem_tessellation *first = NULL, *second = NULL;
  lattice.origin = (struct dem_point){-along / 2, -across / 2};
  status code = dem_tessellation_make(&lattice, &first, error);
  lattice.origin = (struct dem_point){along / 2, across / 2};
  lattice.stream = BODY_SECOND;
  if (!code)
    code = dem_tessellation_make(&lattice, &second, error);
  if (!code)
    code = dem_tessellation_join(first, second, out, error);
  dem_tessellation_free(first);
  dem_tessellation_free(second);
  return code;
}

static uint32_t grain_nearest(const struct dem_tessellation *t, double x, double y) {
  uint32_t nearest = 0;
  double best = HUGE_VAL;
  for (uint32_t c = 0; c < t->cell_count; c++) {
    double distance = hypot(t->centroid[c].x - x, t->centroid[c].y - y);
    if (distance < best) {
      best = distance;
      nearest = c;
    }
  }
  return nearest;
}

/* K99 section 3.3.1. Each neighbour of the central grain starts perpendicular to their common side, with a speed
 * proportional to side over mass, so that the momenta, sums of side x normal around a closed polygon, add up to zero;
 * the kinetic energies add up to E_o. The central grain "plays the role of the explosive": the paper gives it neither a
 * velocity nor a place among the fragments, and balances the momenta of the neighbours alone. So it vanishes: its beams
 * and contacts end at t = 0, and no total contains its mass. */
static status charge(struct dem_run *run, struct error *error) {
  const struct dem_tessellation *t = run->tessellation;
  run->charge = grain_nearest(t, 0, 0);
  double sum = 0, sides = 0, outline = 0;
  for (int pass = 0; pass < 2; pass++) {
    double scale = pass ? sqrt(2 * run->inputs.charge.energy / sum) : 0;
    for (size_t p = 0; p < t->pair_count; p++) {
      if (t->pair[p][0] != run->charge && t->pair[p][1] != run->charge)
        continue;
      uint32_t other = t->pair[p][t->pair[p][0] == run->charge];
      uint32_t common[2];
      struct dem_point side;
      if (!dem_tessellation_side(t, run->charge, other, common, &side))
        return status_fail(error, STATUS_INTERNAL, "the charge and its neighbour share no side");
      double mass = dem_system_grain(run->system, other).mass;
      if (pass) /* outward normal of a counter-clockwise side (dx, dy) is (dy, -dx) */
        dem_system_set_velocity(run->system, other, scale * side.y / mass, -scale * side.x / mass, 0);
      else {
        sum += (side.x * side.x + side.y * side.y) / mass;
        sides += hypot(side.x, side.y);
      }
    }
  }
  uint32_t start = t->first_vertex[run->charge], end = t->first_vertex[run->charge + 1];
  for (uint32_t k = start; k < end; k++) {
    struct dem_point p = t->vertex[k], q = t->vertex[k + 1 < end ? k + 1 : start];
    outline += hypot(q.x - p.x, q.y - p.y);
  }
  if (!(sides > outline * (1 - 1e-9)))
    return status_fail(error, STATUS_CONTENT,
                       "the charge is not enclosed by grains: give a body.diameter of more than a few grain.spacing");
  dem_system_remove(run->system, run->charge);
  return STATUS_OK;
}

/* K99 section 3.3.2: "one polygon at the lower middle part of the block is given a high velocity directed inside". */
static void impact(struct dem_run *run) {
  const struct dem_tessellation *t = run->tessellation;
  uint32_t column = (uint32_t)(run->inputs.body.columns / 2);
  double speed = run->inputs.impact.speed, angle = run->inputs.impact.angle;
  for (uint32_t c = 0; c < t->cell_count; c++)
    if (t->grid_y[c] == 0 && t->grid_x[c] == column)
      dem_system_set_velocity(run->system, c, speed * sin(angle), speed * cos(angle), 0);
}

static void collision(struct dem_run *run) {
  const struct dem_tessellation *t = run->tessellation;
  struct dem_point centre[2] =
      {{0, 0}, {0, 0}}; /* of the first body, mirrored: the other body is on the opposite side of the origin */
  for (uint32_t c = 0; c < t->cell_count; c++) {
    centre[0].x = fmin(centre[0].x, t->centroid[c].x);
    centre[0].y = fmin(centre[0].y, t->centroid[c].y);
    centre[1].x = fmax(centre[1].x, t->centroid[c].x);
    centre[1].y = fmax(centre[1].y, t->centroid[c].y);
  }
  double radius = run->inputs.body.diameter / 2;
  double x = centre[1].x - radius,
         y = centre[1].y - radius; /* rough centre of the second disc, to tell the discs apart */
  for (uint32_t c = 0; c < t->cell_count; c++) {
    double v = run->inputs.collision.speed / 2;
    dem_system_set_velocity(run->system, c, t->centroid[c].x * x + t->centroid[c].y * y > 0 ? -v : v, 0, 0);
  }
}

/* A uniform expansion about the centre of mass, which has neither momentum nor angular momentum. */
static void expansion(struct dem_run *run) {
  const struct dem_tessellation *t = run->tessellation;
  struct dem_point centre = {0, 0};
  double mass = 0;
  for (uint32_t c = 0; c < t->cell_count; c++) {
    centre.x += t->area[c] * t->centroid[c].x;
    centre.y += t->area[c] * t->centroid[c].y;
    mass += t->area[c];
  }
  const double rate = run->inputs.expansion.rate;
  for (uint32_t c = 0; c < t->cell_count; c++)
    dem_system_set_velocity(run->system, c, rate * (t->centroid[c].x - centre.x / mass),
                            rate * (t->centroid[c].y - centre.y / mass), 0);
}

status dem_protocol_start(struct dem_run *run, struct error *error) {
  status code = STATUS_OK;
  switch ((enum dem_kind)run->inputs.kind) {
  case DEM_DISC_EXPLOSION: code = charge(run, error); break;
  case DEM_BLOCK_IMPACT: impact(run); break;
  case DEM_DISC_COLLISION: collision(run); break;
  case DEM_RING_EXPLOSION: expansion(run); break;
  case DEM_UNIAXIAL:
  case DEM_COMPRESSION: return dem_loading_start(run, error);
  case DEM_KINDS: break;
  }
  run->state.frame.energy_input = dem_system_ledger(run->system).kinetic;
  run->angular_start = dem_run_angular_momentum(run);
  return code;
}
