/* Changes at the break of a beam: lanes, log, ledger, contact. The criterion is bond_break() in bond_range.h. */
#include "engine/dem/step/system_layout.h"

#include <math.h>

struct dem_contact dem_breaking_contact(const struct dem_system *s, int32_t pair) {
  const struct dem_contact_inputs *law = &s->in->contact;
  struct dem_contact contact = s->pair_contact[pair];
  if (!s->alive[pair])
    return contact;
  if (!law->bonded)
    contact.stiffness = 0.0;
  if (!law->damping_bonded)
    contact.normal_damping = contact.tangential_damping = 0.0;
  return contact;
}

void dem_breaking_set_contact(const struct dem_system *s, int32_t pair, struct dem_bond_block *block, size_t lane) {
  const struct dem_contact contact = dem_breaking_contact(s, pair);
  block->stiffness[lane] = contact.stiffness;
  block->normal_damping[lane] = contact.normal_damping;
  block->tangential_damping[lane] = contact.tangential_damping;
}

static void remove_beam(struct dem_system *s, struct dem_bond_block *block, int lane, int32_t pair) {
  block->axial[lane] = block->cross[lane] = block->diagonal[lane] = 0.0;
  block->weight_strain[lane] = block->weight_angle[lane] = 0.0;
  s->alive[pair] = 0;
  if (s->windowed[pair])
    dem_breaking_set_contact(s, pair, block, (size_t)lane);
}

/* Energy that appears when a contact begins with a break, J/m. Where contacts act only between grains without a beam, a
 * pair that overlaps as its beam breaks gets its contact at full force: the contact's potential, and the work of
 * half a step, as for the beam (dem_breaking_lane). The energy booked for the break is reduced by this;
 * else the ledger would gain it. */
static double contact_begins(const struct dem_system *s, int32_t pair) {
  const struct dem_law *law = dem_laws_at(s->in->contact.law);
  if (!law || !law->stores_energy || s->in->contact.bonded)
    return 0.0;
  const uint32_t i = s->pair[pair][0], j = s->pair[pair][1];
  const double dx = s->c.x[j] - s->c.x[i], dy = s->c.y[j] - s->c.y[i];
  struct dem_ring ring[2];
  struct dem_overlap o;
  dem_system_arrays_ring(s, i, 0.0, 0.0, &ring[0]);
  dem_system_arrays_ring(s, j, dx, dy, &ring[1]);
  s->kernels->overlap(ring, &o);
  if (o.apart || !(o.twice_area > 0.0))
    return 0.0;
  const double push = s->pair_contact[pair].stiffness * 0.5 * o.twice_area, fx = -push * o.chord_y,
               fy = push * o.chord_x;
  double energy = 0.25 * push * o.twice_area;
  const double torque_i = push * o.moment + o.origin_x * fy - o.origin_y * fx;
  const double torque_j = -push * o.moment - ((o.origin_x - dx) * fy - (o.origin_y - dy) * fx);
  const double power = fx * (s->c.vx[i] - s->c.vx[j]) + fy * (s->c.vy[i] - s->c.vy[j]) + torque_i * s->c.spin[i] +
                       torque_j * s->c.spin[j];
  return energy + 0.5 * s->in->fidelity.time_step * power;
}

void dem_breaking_lane(struct dem_system *s, struct dem_bond_block *block, int lane, double length, double ux,
                       double uy, double theta_first, double theta_second) {
  const size_t slot = (size_t)(block - s->bond) * DEM_BLOCK + (size_t)lane;
  const int32_t pair = s->lane_pair[slot];
  const double stretch = length - block->length[lane], twist = theta_first - theta_second;
  double energy = 0.5 * block->axial[lane] * stretch * stretch + 0.5 * block->diagonal[lane] * twist * twist +
                  block->cross[lane] * theta_first * theta_second;
  /* The work that the beam would have done in half a step is booked, too. Verlet: the second half of this step's kick
   * lacks the beam. Gear: its velocities follow from Adams' formula of fifth order. Where a force ends, the weights of
   * that formula (251, 646, -264, 106, -19)/720, summed over the next steps, take away the impulse of half a step. */
  const uint32_t i = block->first[lane], j = block->second[lane];
  const double m1 = block->diagonal[lane] * (theta_second - theta_first) - block->cross[lane] * theta_second;
  const double m2 = block->diagonal[lane] * (theta_first - theta_second) - block->cross[lane] * theta_first;
  const double tension = block->axial[lane] * stretch, shear = (m1 + m2) / length;
  const double vx = s->c.vx[i] - s->c.vx[j], vy = s->c.vy[i] - s->c.vy[j];
  const double power = (tension * ux - shear * uy) * vx + (tension * uy + shear * ux) * vy + m1 * s->c.spin[i] +
                       m2 * s->c.spin[j];
  energy += 0.5 * s->in->fidelity.time_step * power;
  const double begun = contact_begins(s, pair);
  s->now.broken_beam += energy - begun;
  s->now.begun += begun;
  const double strain = stretch / block->length[lane];
  s->log[s->now.break_count++] = (struct dem_break){
      .time = s->now.time,
      .beam = (uint32_t)pair,
      .strain = strain,
      .angle = {theta_first, theta_second},
      .bending = fmax(fabs(theta_first), fabs(theta_second)) * block->weight_angle[lane] >
                 stretch * stretch * block->weight_strain[lane],
  };
  s->now.last_break = s->now.time;
  remove_beam(s, block, lane, pair);
}

void dem_breaking_cut(struct dem_system *s, int32_t pair) {
  if (!s->alive[pair])
    return;
  const int32_t slot = s->pair_lane[pair];
  remove_beam(s, &s->bond[slot / DEM_BLOCK], slot % DEM_BLOCK, pair);
}

void dem_breaking_clear(const struct dem_system *s, struct dem_bond_block *block, int lane) {
  block->first[lane] = s->ghost;
  block->second[lane] = s->ghost + 1;
  double *field = (double *)((char *)block + offsetof(struct dem_bond_block, reference_x));
  const size_t fields = (sizeof *block - offsetof(struct dem_bond_block, reference_x)) / sizeof(dem_lane);
  for (size_t f = 0; f < fields; f++)
    field[f * DEM_BLOCK + (size_t)lane] = 0.0;
  block->reference_x[lane] = 1.0;
  block->length[lane] = 1.0;
}

void dem_breaking_turn(struct dem_bond_block *block, int lane, double ux, double uy, double sine, double cosine) {
  block->reference_angle[lane] += atan2(sine, cosine);
  block->reference_x[lane] = ux;
  block->reference_y[lane] = uy;
}
