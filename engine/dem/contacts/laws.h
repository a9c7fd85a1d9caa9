/* The laws of contact, all in this file: a law is an entry of the list, a descriptor, and its formulas.
 *
 * Two grains overlap by the area A; the chord joins the two points where their outlines cross. The elastic force acts
 * at the chord's middle, at right angles to it (contact_range.h). A law says how large it is. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The list: number, word in a document, sentence of `clast explain`. AND stands between the entries. */
#define DEM_LAWS(LAW, AND)                                                                                             \
  LAW(CONSERVATIVE, "conservative",                                                                                    \
      "the gradient of an overlap potential: an undamped contact returns the energy put in")                           \
  AND LAW(PRINTED, "printed", "force Y A/L_c as in the paper: not a potential force")

#define DEM_LAWS_NUMBER(number, name, doc) DEM_CONTACT_##number
#define DEM_LAWS_NAME(number, name, doc)   name
#define DEM_LAWS_DOC(number, name, doc)    doc
#define DEM_LAWS_COMMA                     ,
/* `off` is no law: it comes after the last one, so that DEM_CONTACT_OFF is also the number of laws. */
enum dem_contact_law { DEM_LAWS(DEM_LAWS_NUMBER, DEM_LAWS_COMMA), DEM_CONTACT_OFF };

/* The words of the input contact.law. */
static const char *const dem_laws_names[] = {DEM_LAWS(DEM_LAWS_NAME, DEM_LAWS_COMMA), "off", NULL};

struct dem_law {
  /* The force is kappa A |chord|, the gradient of the energy kappa A^2 / 2. The ledger then counts that energy; without
   * it, the ledger counts the work done on contacts. */
  bool stores_energy;
  bool needs_velocities; /* the work, or the force itself, follows from velocities */
};

static const struct dem_law dem_laws[] = {
    [DEM_CONTACT_CONSERVATIVE] = {.stores_energy = true},
    [DEM_CONTACT_PRINTED] = {.needs_velocities = true},
};
_Static_assert(sizeof dem_laws / sizeof dem_laws[0] == DEM_CONTACT_OFF, "each law of the list has a descriptor");

/* NULL: off. */
static inline const struct dem_law *dem_laws_at(int law) {
  return law == DEM_CONTACT_OFF ? NULL : &dem_laws[law];
}

/* The coefficient of a pair: from Y/L_c (Pa/m) and the length S_ref that belongs to the pair (m). */
static inline double dem_laws_coefficient(enum dem_contact_law law, double modulus_per_length, double reference_side) {
  switch (law) {
  case DEM_CONTACT_CONSERVATIVE: return modulus_per_length / reference_side; /* kappa */
  case DEM_CONTACT_PRINTED: return modulus_per_length;
  case DEM_CONTACT_OFF: break;
  }
  return 0.0;
}

/* Force over depth of an overlap that is face on, thin, and `side` wide (m). The longest time step and the speed at
 * which grains pass through each other follow from it. */
static inline double dem_laws_spring(enum dem_contact_law law, double coefficient, double side) {
  switch (law) {
  case DEM_CONTACT_CONSERVATIVE: return coefficient * side * side;
  case DEM_CONTACT_PRINTED: return coefficient * side;
  case DEM_CONTACT_OFF: break;
  }
  return 0.0;
}

#ifdef LANES /* the loops over contacts */
#include "engine/dem/step/lanes.h"

/* Magnitude of the elastic force. `law` is a constant of the loop, so that a loop holds one law only. A law that needs
 * no velocities is proportional to the chord: its loop passes 1 and gets the force per chord. */
LANES_INLINE lanes_d dem_laws_elastic(enum dem_contact_law law, lanes_d coefficient, lanes_d area, lanes_d chord) {
  switch (law) {
  case DEM_CONTACT_CONSERVATIVE: return coefficient * area * chord;
  case DEM_CONTACT_PRINTED: return coefficient * area; /* K99 eq 2 */
  case DEM_CONTACT_OFF: break;
  }
  return lanes_all(0.0);
}
#endif
