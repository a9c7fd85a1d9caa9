/* Constants of grains, beams and contacts, from the tessellation and the inputs. */

#include <float.h>
#include <math.h>

#include "engine/dem/step/system_layout.h"
#include "engine/random.h"

/* Common sides shorter than this share of the grains' mean diameter turn by large angles under small motions. A window
 * is seldom exact there, so the near list handles their contact. */
static const double shortest_window = 0.05;

double dem_assemble_reference_side(double side, double diameter_i, double diameter_j) {
  const double usual = 0.27 * (diameter_i + diameter_j);
  return side > 0.0 ? fmax(side, 0.5 * usual) : usual;
}

struct dem_contact dem_assemble_contact(const struct dem_system *s, uint32_t i, uint32_t j, double side) {
  const struct dem_contact_inputs *contact = &s->in->contact;
  const double per_length = 0.5 * (1.0 / s->diameter[i] + 1.0 / s->diameter[j]); /* 1 / L_c */
  const double mass = s->mass[i] * s->mass[j] / (s->mass[i] + s->mass[j]);       /* m_eff, K99 eq 6 */
  const double reference = dem_assemble_reference_side(side, s->diameter[i], s->diameter[j]);
  const double stiffness = dem_laws_coefficient(contact->law, s->in->grain.young_modulus * per_length, reference);
  return (struct dem_contact){stiffness, mass * contact->normal_damping, mass * contact->tangential_damping};
}

/* Grains are smaller than their cells by this share, so that rounding errors give no overlap at rest. */
static const double shrink = 1e-11;

static status grains(struct dem_system *s, const struct dem_tessellation *t, struct error *error) {
  double total = 0.0;
  for (size_t i = 0; i < s->count; i++) {
    const uint32_t first = t->first_vertex[i], sides = t->first_vertex[i + 1] - first;
    if (sides < 3 || sides > DEM_MAX_VERTICES)
      return status_fail(error, STATUS_CONTENT, "grain %zu has %u sides; 3 to %d can be used.", i, sides,
                         DEM_MAX_VERTICES);
    s->mass[i] = s->in->grain.density * t->area[i];
    s->inertia[i] = s->in->grain.density * t->polar_moment[i];
    if (!(s->mass[i] > 0.0 && s->mass[i] < 1e30 && s->inertia[i] > 0.0 && s->inertia[i] < 1e30))
      return status_fail(error, STATUS_CONTENT,
                         "grain %zu has mass %g kg/m and moment of inertia %g kg m; both must be positive.", i,
                         s->mass[i], s->inertia[i]);
    s->c.x[i] = t->centroid[i].x;
    s->c.y[i] = t->centroid[i].y;
    s->c.mobility_x[i] = s->c.mobility_y[i] = 1.0 / s->mass[i];
    s->c.mobility_angle[i] = 1.0 / s->inertia[i];
    s->diameter[i] = 2.0 * sqrt(t->area[i] / M_PI);
    s->present[i] = 1;
    total += s->diameter[i];
    /* Far from the origin rounding is larger than the usual gap. */
    const double far = fabs(t->centroid[i].x) + fabs(t->centroid[i].y) + s->diameter[i];
    const double keep = 1.0 - fmax(shrink, 8.0 * DBL_EPSILON * far / s->diameter[i]);
    s->first_vertex[i + 1] = first - t->first_vertex[0] + sides;
    for (uint32_t v = 0; v < sides; v++) {
      const size_t at = s->first_vertex[i] + v;
      s->outline_x[at] = keep * (t->vertex[first + v].x - t->centroid[i].x);
      s->outline_y[at] = keep * (t->vertex[first + v].y - t->centroid[i].y);
      s->c.radius[i] = fmax(s->c.radius[i], hypot(s->outline_x[at], s->outline_y[at]));
      if (!(s->c.radius[i] < 1e30))
        return status_fail(error, STATUS_CONTENT, "grain %zu has a vertex that is no finite number.", i);
    }
  }
  s->mean_diameter = total / (double)s->count;
  for (size_t i = s->count; i < s->padded; i++) {
    s->c.skin[i] = 1.0;
    s->c.x[i] = (double)(i - s->count); /* one metre apart: unused lanes see a beam of length one */
  }
  return STATUS_OK;
}

/* The window of one grain: the vertices before, at either end of, and after its common side. */
static void window(struct dem_system *s, struct dem_bond_block *block, size_t lane, int k, uint32_t grain,
                   uint32_t side) {
  const uint32_t first = s->first_vertex[grain], sides = s->first_vertex[grain + 1] - first;
  double x[4], y[4];
  for (uint32_t v = 0; v < 4; v++) {
    const uint32_t at = first + (side + sides - 1 + v) % sides;
    x[v] = s->outline_x[at];
    y[v] = s->outline_y[at];
  }
  const double mx = 0.5 * (x[1] + x[2]), my = 0.5 * (y[1] + y[2]), hx = 0.5 * (x[2] - x[1]), hy = 0.5 * (y[2] - y[1]);
  block->middle_x[k][lane] = mx;
  block->middle_y[k][lane] = my;
  block->half_x[k][lane] = hx;
  block->half_y[k][lane] = hy;
  block->before_x[k][lane] = x[0] - mx;
  block->before_y[k][lane] = y[0] - my;
  block->after_x[k][lane] = x[3] - mx;
  block->after_y[k][lane] = y[3] - my;
}

/* Factors of the strain and the angle threshold of one pair: a Weibull law about 1, so that modulus -> infinity gives
 * K99. The draws belong to the lattice squares of the two grains: a larger body of one seed, or other numbers of the
 * grains, change nothing. */
static void threshold_factors(const struct dem_inputs *in, const struct dem_tessellation *t, uint64_t seed, size_t pair,
                              double factor[2]) {
  factor[0] = factor[1] = 1.0;
  if (field_is_off(in->threshold.modulus))
    return;
  uint32_t a = t->pair[pair][0], b = t->pair[pair][1];
  if (dem_lattice_square(t->grid_x[b], t->grid_y[b]) < dem_lattice_square(t->grid_x[a], t->grid_y[a])) {
    const uint32_t swap = a;
    a = b;
    b = swap;
  }
  const uint64_t item = dem_lattice_square(t->grid_x[a], t->grid_y[a]);
  const uint64_t along = (t->grid_x[b] - t->grid_x[a]) & 0xffu, up = (t->grid_y[b] - t->grid_y[a]) & 0xffu;
  const uint64_t body = t->joined_at > 0 && a >= t->joined_at;
  for (uint64_t k = 0; k < 2; k++) {
    const double u = random_draw(seed, RANDOM_THRESHOLD, item, body << 32 | up << 16 | along << 8 | k);
    factor[k] = pow(-log1p(-u), 1.0 / in->threshold.modulus);
  }
}

/* Constants of one beam: K99 eqs 7-12 with b = 2a and I = S^3/12, and the weights of the breaking rule, eq 13. */
static void beam(const struct dem_inputs *in, const struct dem_tessellation *t, uint64_t seed, size_t pair,
                 double length, struct dem_bond_block *block, size_t lane) {
  const double side = t->side[pair];
  const double e = in->beam.young_modulus;
  const double a = length / (e * side), b = 2.0 * a;
  const double c = length * length * length / (e * side * side * side / 12.0);
  const double beta = e > 0.0 ? 1.0 / (b + c / 12.0) : 0.0;
  const double delta = e > 0.0 ? beta * (b / c + 1.0 / 3.0) : 0.0;
  block->axial[lane] = e * side / length;
  block->cross[lane] = 0.5 * beta * length * length;
  block->diagonal[lane] = delta * length * length;
  if (!in->threshold.breaking)
    return;

  double factor[2];
  threshold_factors(in, t, seed, pair, factor);
  const double strain = length * (in->threshold.strain * factor[0]);
  block->weight_strain[lane] = fmin(DBL_MAX, 1.0 / (strain * strain));
  block->weight_angle[lane] = fmin(DBL_MAX, 1.0 / (in->threshold.angle * factor[1]));
}

/* Contact of one pair, and its window where the pair has one. */
static void contact(struct dem_system *s, const struct dem_tessellation *t, size_t pair, struct dem_bond_block *block,
                    size_t lane) {
  const uint32_t i = t->pair[pair][0], j = t->pair[pair][1];
  const double side = t->side[pair], size = 0.5 * (s->diameter[i] + s->diameter[j]);
  s->pair_contact[pair] = dem_assemble_contact(s, i, j, side);
  if (s->in->contact.law == DEM_CONTACT_OFF || side < shortest_window * size)
    return;

  uint32_t common[2];
  struct dem_point along;
  if (!dem_tessellation_side(t, i, j, common, &along))
    return;
  s->windowed[pair] = 1;
  window(s, block, lane, 0, i, common[0]);
  window(s, block, lane, 1, j, common[1]);
  dem_breaking_set_contact(s, (int32_t)pair, block, lane);
}

static status bond(struct dem_system *s, const struct dem_tessellation *t, uint64_t seed, size_t pair,
                   struct error *error) {
  const uint32_t i = t->pair[pair][0], j = t->pair[pair][1];
  if (i >= j || j >= s->count)
    return status_fail(error, STATUS_CONTENT,
                       "pair %zu joins grains %u and %u: the first must be lower, both below %zu.", pair, i, j,
                       s->count);
  const double dx = s->c.x[j] - s->c.x[i], dy = s->c.y[j] - s->c.y[i], length = hypot(dx, dy), side = t->side[pair];
  if (!(side > 0.0 && side < 1e30 && length > 0.0))
    return status_fail(error, STATUS_CONTENT, "pair %zu has a common side of %g m and centres %g m apart.", pair, side,
                       length);

  struct dem_bond_block *block = &s->bond[pair / DEM_BLOCK];
  const size_t lane = pair % DEM_BLOCK;
  s->pair[pair][0] = i;
  s->pair[pair][1] = j;
  s->alive[pair] = 1;
  s->pair_lane[pair] = (int32_t)pair;
  s->lane_pair[pair] = (int32_t)pair;
  block->first[lane] = i;
  block->second[lane] = j;
  block->reference_x[lane] = dx / length;
  block->reference_y[lane] = dy / length;
  block->length[lane] = length; /* bond_rest makes these three the step's own to the last bit */
  beam(s->in, t, seed, pair, length, block, lane);
  contact(s, t, pair, block, lane);
  return STATUS_OK;
}

/* Neighbours of each grain, as compressed rows. The rows' ends are counted two entries ahead, so that filling the rows
 * moves each end to its place. */
static void partners(struct dem_system *s) {
  for (size_t k = 0; k < s->pair_count; k++)
    for (int end = 0; end < 2; end++)
      s->first_partner[s->pair[k][end] + 2]++;
  for (size_t i = 0; i < s->count; i++)
    s->first_partner[i + 2] += s->first_partner[i + 1];
  for (size_t k = 0; k < s->pair_count; k++)
    for (int end = 0; end < 2; end++) {
      const uint32_t at = s->first_partner[s->pair[k][end] + 1]++;
      s->partner[at] = s->pair[k][1 - end];
      s->partner_pair[at] = (uint32_t)k;
    }
}

status dem_assemble(struct dem_system *s, const struct dem_tessellation *t, uint64_t seed, struct error *error) {
  if (t->cell_count == 0 || t->cell_count > 0x0fffffffu || t->pair_count > 0x3fffffffu)
    return status_fail(error, STATUS_CONTENT, "a system needs 1 to 2^28 grains; there are %zu.", t->cell_count);
  s->count = t->cell_count;
  s->pair_count = t->pair_count;
  s->padded = (s->count + 2 + DEM_BLOCK - 1) / DEM_BLOCK * DEM_BLOCK;
  s->ghost = (uint32_t)s->count;
  s->vertex_count = t->first_vertex[t->cell_count] - t->first_vertex[0];
  if (!dem_system_arrays_allocate(s))
    return status_fail(error, STATUS_MEMORY, "not enough memory for %zu grains.", s->count);

  s->now.bond_blocks = s->bond_capacity;
  for (size_t lane = 0; lane < s->bond_capacity * DEM_BLOCK; lane++) {
    s->lane_pair[lane] = DEM_NO_PAIR;
    dem_breaking_clear(s, &s->bond[lane / DEM_BLOCK], (int)(lane % DEM_BLOCK));
  }
  status code = grains(s, t, error);
  for (size_t k = 0; k < s->pair_count && !code; k++)
    code = bond(s, t, seed, k, error);
  if (!code)
    partners(s);
  return code;
}
