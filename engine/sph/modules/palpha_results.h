/* What module palpha reports of a finished run. */
#ifndef CLAST_ENGINE_SPH_MODULES_PALPHA_RESULTS_H
#define CLAST_ENGINE_SPH_MODULES_PALPHA_RESULTS_H

#include "engine/sph/observe/crater.h"

struct sph_run;

/* sph_module.report of palpha. */
void sph_palpha_results_report(const struct sph_run *run, struct sph_results *results);
/* Fills the results compaction.* and crater.compaction_share. `initial`: alpha_0. Both sets of particles have their
 * distentions. A pure function. */
void sph_palpha_results_compaction(const struct sph_particles *start, const struct sph_particles *now,
                                   const struct sph_crater_options *options, double initial,
                                   struct sph_results *results);

#endif
