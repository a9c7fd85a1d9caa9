/* Instantiates the range loops for one CPU class: the including file sets LANES and KERNELS_TABLE, KERNELS_NAME. */
#include "engine/dem/beams/bond_range.h"
#include "engine/dem/contacts/near_range.h"
#include "engine/dem/step/motion_range.h"

static void kernels_beams_only(struct dem_system *s) {
  bond_range(s, BOND_FORCES, false, false);
}
static void kernels_conservative(struct dem_system *s) {
  bond_range(s, BOND_FORCES, true, false);
}
static void kernels_with_velocities(struct dem_system *s) {
  bond_range(s, BOND_FORCES, true, true);
}
static void kernels_near(struct dem_system *s) {
  near_range(s);
}
static void kernels_general(struct dem_system *s) {
  near_general(s, false, false);
}
static void kernels_general_velocities(struct dem_system *s) {
  near_general(s, false, true);
}
static void kernels_measure_beams(struct dem_system *s) {
  bond_range(s, BOND_MEASURE, false, false);
}
static void kernels_measure_bonds(struct dem_system *s) {
  bond_range(s, BOND_MEASURE, true, false);
}
static void kernels_measure_general(struct dem_system *s) {
  near_general(s, true, false);
}

static void kernels_rest(struct dem_system *s) {
  bond_rest(s);
}

static void kernels_forces(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF) {
    kernels_beams_only(s);
    return;
  }
  (s->velocities ? kernels_with_velocities : kernels_conservative)(s);
  kernels_near(s);
  (s->velocities ? kernels_general_velocities : kernels_general)(s);
}

static void kernels_measure(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF) {
    kernels_measure_beams(s);
    return;
  }
  kernels_measure_bonds(s);
  kernels_near(s);
  kernels_measure_general(s);
}

static bool kernels_verlet_drift(struct dem_system *s, bool *moved) {
  return motion_verlet_drift(s, moved);
}
static void kernels_verlet_kick(struct dem_system *s) {
  motion_verlet_kick(s);
}
static bool kernels_gear_predict(struct dem_system *s, bool *moved) {
  return motion_gear_predict(s, moved);
}
static void kernels_gear_correct(struct dem_system *s) {
  motion_gear_correct(s);
}
static void kernels_turn(struct dem_system *s) {
  for (size_t g = 0; g < s->padded; g += LANES)
    motion_turn(&s->c, g);
}
static void kernels_best_side(const struct dem_ring ring[2], struct dem_overlap *out) {
  overlap_best_side(ring, out);
}
static void kernels_overlap(struct dem_ring ring[2], struct dem_overlap *out) {
  overlap_rings(ring, out);
}

const struct dem_kernels KERNELS_TABLE = {
    .name = KERNELS_NAME,
    .rest = kernels_rest,
    .forces = kernels_forces,
    .measure = kernels_measure,
    .verlet_drift = kernels_verlet_drift,
    .verlet_kick = kernels_verlet_kick,
    .gear_predict = kernels_gear_predict,
    .gear_correct = kernels_gear_correct,
    .turn = kernels_turn,
    .best_side = kernels_best_side,
    .overlap = kernels_overlap,
};
