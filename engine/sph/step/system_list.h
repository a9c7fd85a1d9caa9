/* When and how a system sorts its particles and makes lists of neighbours; for engine/sph/ only. */
#ifndef CLAST_ENGINE_SPH_STEP_SYSTEM_LIST_H
#define CLAST_ENGINE_SPH_STEP_SYSTEM_LIST_H

#include "engine/sph/step/system_layout.h"

/* New lists when the old ones may miss a pair (a block has no slack left); now and then the particles are sorted first,
 * by the count of listings alone. False (see failure): as sph_system_step. */
bool sph_system_list(struct sph_system *system);
/* Lists for the positions of the last listing (sph_pairs_listed), after a restart. */
bool sph_system_list_again(struct sph_system *system);
/* m: what h with its slack may be at most, so that no particle meets its own image in a thin periodic box; infinite in
 * the open. */
double sph_system_list_reach(const struct sph_domain *domain);

#endif
