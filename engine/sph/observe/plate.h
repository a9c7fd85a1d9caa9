/* What a piston's plate tells of its fronts: where they are, how fast they go, the state behind each. Inside this
 * folder only. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_PLATE_H
#define CLAST_ENGINE_SPH_OBSERVE_PLATE_H

#include "engine/sph/run/run.h"

/* The exact answer and room for layers. STATUS_MEMORY, or what sph_plane_shock refuses. */
status sph_plate_start(struct sph_run *run, struct error *error);
/* Places of shock and precursor, m from the plate's first surface; NaN where there is none. `p`: as read now. */
void sph_plate_look(const struct sph_run *run, const struct sph_particles *p, double *shock, double *precursor);
/* State of the plate in layers of one spacing by their depth at the start; velocity along x. At most `most`; returns
 * how many. */
size_t sph_plate_profile(const struct sph_run *run, struct sph_crater_layer *layers, size_t most);
/* Rows shock.* and precursor.* from what was recorded and from the particles last read. */
void sph_plate_report(const struct sph_run *run, struct sph_results *results);

#endif
