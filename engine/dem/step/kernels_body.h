/* Instantiates the range loops for one CPU class: the including file sets LANES and KERNELS_TABLE, KERNELS_NAME. */
#include "engine/dem/beams/bond_range.h"
#include "engine/dem/contacts/near_range.h"
#include "engine/dem/step/motion_range.h"

static void kernels_rest(struct dem_system *s) {
  bond_rest(s);
}
static void kernels_near(struct dem_system *s) {
  near_range(s);
}

/* The loops of each law, with velocities and without. */
#define KERNELS_OF_LAW(number, name, doc)                                                                              \
  static void kernels_bonds_##number(struct dem_system *s) {                                                           \
    bond_range(s, BOND_FORCES, DEM_CONTACT_##number, true);                                                            \
  }                                                                                                                    \
  static void kernels_general_##number(struct dem_system *s) {                                                         \
    near_general(s, false, DEM_CONTACT_##number, true);                                                                \
  }                                                                                                                    \
  static void kernels_still_bonds_##number(struct dem_system *s) {                                                     \
    if (!dem_laws[DEM_CONTACT_##number].needs_velocities)                                                              \
      bond_range(s, BOND_FORCES, DEM_CONTACT_##number, false);                                                         \
  }                                                                                                                    \
  static void kernels_still_general_##number(struct dem_system *s) {                                                   \
    if (!dem_laws[DEM_CONTACT_##number].needs_velocities)                                                              \
      near_general(s, false, DEM_CONTACT_##number, false);                                                             \
  }
DEM_LAWS(KERNELS_OF_LAW, )
#undef KERNELS_OF_LAW

typedef void kernels_loop(struct dem_system *s);
#define KERNELS_BONDS(number, name, doc)                                                                               \
  { kernels_still_bonds_##number, kernels_bonds_##number }
#define KERNELS_GENERAL(number, name, doc)                                                                             \
  { kernels_still_general_##number, kernels_general_##number }
static kernels_loop *const kernels_bonds[][2] = {DEM_LAWS(KERNELS_BONDS, DEM_LAWS_COMMA)}; /* [1]: velocities */
static kernels_loop *const kernels_general[][2] = {DEM_LAWS(KERNELS_GENERAL, DEM_LAWS_COMMA)};
#undef KERNELS_BONDS
#undef KERNELS_GENERAL

static void kernels_forces(struct dem_system *s) {
  if (s->in->contact.law == DEM_CONTACT_OFF) {
    bond_range(s, BOND_FORCES, DEM_CONTACT_OFF, false);
    return;
  }
  kernels_bonds[s->in->contact.law][s->velocities](s);
  kernels_near(s);
  kernels_general[s->in->contact.law][s->velocities](s);
}

static void kernels_measure_beams(struct dem_system *s) {
  bond_range(s, BOND_MEASURE, DEM_CONTACT_OFF, false);
}
/* Overlaps and their energy: the same for all laws. */
static void kernels_measure_contacts(struct dem_system *s) {
  bond_range(s, BOND_MEASURE, DEM_CONTACT_CONSERVATIVE, false);
  kernels_near(s);
  near_general(s, true, DEM_CONTACT_CONSERVATIVE, false);
}
static void kernels_measure(struct dem_system *s) {
  (s->in->contact.law == DEM_CONTACT_OFF ? kernels_measure_beams : kernels_measure_contacts)(s);
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
