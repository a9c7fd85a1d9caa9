/* Rare changes of single lanes of the bond blocks, outside the vector loops. */
#ifndef CLAST_ENGINE_DEM_BEAMS_BREAKING_H
#define CLAST_ENGINE_DEM_BEAMS_BREAKING_H

#include "engine/dem/step/system_layout.h"

/* Breaks a beam: logs it, books its energy, sets its elastic constants to zero (K99 section 2.3), and switches on the
 * pair's contact and damping if they were off while the beam held. (ux, uy) is the chord's direction. */
void dem_breaking_lane(struct dem_system *system, struct dem_bond_block *block, int lane, double length, double ux,
                       double uy, double theta_first, double theta_second);

/* Removes a beam without a log entry (removed grains). */
void dem_breaking_cut(struct dem_system *system, int32_t pair);

/* Points an unused lane at the ghosts, with every constant zero. */
void dem_breaking_clear(const struct dem_system *system, struct dem_bond_block *block, int lane);

/* Makes the chord's present direction its reference (sine and cosine: of the turn since the old one), so that
 * the angle from the reference stays small and the total angle unwrapped. */
void dem_breaking_turn(struct dem_bond_block *block, int lane, double ux, double uy, double sine, double cosine);

/* Present coefficients of a tessellation pair's contact: zero while the beam holds, if the inputs switch off contacts
 * of bonded pairs. */
struct dem_contact dem_breaking_contact(const struct dem_system *system, int32_t pair);
/* Writes these coefficients to the pair's lane. */
void dem_breaking_set_contact(const struct dem_system *system, int32_t pair, struct dem_bond_block *block, size_t lane);

#endif
