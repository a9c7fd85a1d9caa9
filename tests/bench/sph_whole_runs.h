/* Whole steps of the SPH solid, for bench_sph: the scene `basalt-sphere` with all its physics. Each prints its figures.
 */
#pragma once

#include <stddef.h>

/* From impact to the end of fracture, in double and in float, with the error of float and the share of time per phase.
 */
void sph_whole_runs_figures(const char *name, const char *particles);
/* Cost of a particle-step from 1e4 to 1e6 particles, over the first steps of the impact. */
void sph_whole_runs_sizes(void);
/* What each module costs: the same steps with it and without. */
void sph_whole_runs_modules(void);
/* Two threads against one: wall time of whole steps. */
void sph_whole_runs_threads(void);
