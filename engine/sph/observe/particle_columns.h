/* Particles as data sets of a fields file: VTKHDF 1.0, an unstructured grid of vertices, so that ParaView and VTK open
 * it as it stands; row i is particle i. A matter of particles and fragments alone, for tests and pictures without a
 * run. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_PARTICLE_COLUMNS_H
#define CLAST_ENGINE_SPH_OBSERVE_PARTICLE_COLUMNS_H

#include "engine/snapshot_file.h"
#include "engine/sph/body/particles.h"
#include "engine/sph/observe/sph_fragments.h"

/* `flaws`: how many each particle has, or NULL. Also the table of fragments, /fragments. */
void sph_particle_columns_add(struct snapshot_file *file, const struct sph_particles *particles,
                              const struct sph_fragments *pieces, const uint32_t *flaws);

#endif
