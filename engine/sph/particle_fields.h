/* Particles as data sets of a fields file: VTKHDF 1.0, an unstructured grid of vertices, so that ParaView and VTK open it as
 * it stands; row i is particle i. A matter of particles and fragments alone, for tests and pictures without a run. */
#ifndef CLAST_ENGINE_SPH_PARTICLE_FIELDS_H
#define CLAST_ENGINE_SPH_PARTICLE_FIELDS_H

#include "engine/fields_file.h"
#include "engine/sph/particles.h"
#include "engine/sph/pieces.h"

/* `flaws`: how many each particle has, or NULL. Also the table of fragments, /fragments. */
void sph_particle_fields_add(struct fields_file *file, const struct sph_particles *particles, const struct sph_pieces *pieces,
                             const uint32_t *flaws);

#endif
