/* The output of one run of engine `sph`: the record of a protocol during the run, results and fragments at the end, and
 * its fields files. For this folder, run/ and sph.c. */
#ifndef CLAST_ENGINE_SPH_OBSERVE_OBSERVE_H
#define CLAST_ENGINE_SPH_OBSERVE_OBSERVE_H

#include "engine/snapshot_file.h"
#include "engine/sph/observe/crater.h"
#include "engine/sph/observe/sph_fragments.h"
#include "engine/sph/run/run.h"
#include "engine/warnings.h"

/* protocol_record.c: the curve of a stretch, a vibration or a piston. Other protocols record nothing. STATUS_MEMORY. */
status sph_protocol_record_start(struct sph_run *run, struct error *error);
void sph_protocol_record(struct sph_run *run); /* after each step */

/* plate.c: the shock fronts in a plate that a piston hits.
 * Starts: computes the exact answer and allocates the layers. STATUS_MEMORY, or an error of sph_plane_shock(). */
status sph_plate_start(struct sph_run *run, struct error *error);
/* Places of shock and precursor, m from the plate's surface at the start; NaN where there is none. `particles`: the
 * present ones. */
void sph_plate_look(const struct sph_run *run, const struct sph_particles *particles, double *shock, double *precursor);
/* State of the plate in layers of one spacing by their depth at the start; velocity along x. Fills at most `most`
 * layers and returns how many. */
size_t sph_plate_profile(const struct sph_run *run, struct sph_crater_layer *layers, size_t most);
/* Regions in which the state behind each front is measured now: from one place to the other, m. */
struct sph_plate_regions {
  double shock[2], precursor[2];
};
struct sph_plate_regions sph_plate_regions(const struct sph_run *run);
/* Mean of a column of the particles last read over a region; NaN without particles there. */
double sph_plate_mean(const struct sph_run *run, const double *column, const double region[2]);
/* Fills the results shock.* and precursor.* from the recorded curve and from the particles last read. */
void sph_plate_report(const struct sph_run *run, struct sph_results *results);
/* Is matter of the plate behind the piston's face? From the particles last read. */
bool sph_plate_leaks(const struct sph_run *run);

/* report.c: from the final state to outcome, results and fragments. */
struct sph_crater_options sph_report_crater_options(const struct sph_run *run);
/* The target's fragments by the inputs' rules, except for the two choices given. Uses the particles last read. */
status sph_report_fragments(const struct sph_run *run, double static_strength, bool layer, struct sph_fragments *out,
                            struct error *error);
/* *fragments: by descending mass, malloc'd. */
status sph_report_finish(struct sph_run *run, struct outcome *outcome, struct sph_results *results,
                         struct fragment **fragments, size_t *count, struct error *error);

/* snapshot.c: a fields file of the run as it is now. */
status sph_snapshot_write(struct sph_run *run, const char *path, struct error *error);
/* Particles as a VTKHDF 1.0 grid of vertices, row i particle i, and the table /fragments. It needs no run. flaws:
 * number of flaws of each particle, or NULL. */
void sph_snapshot_particles(struct snapshot_file *file, const struct sph_particles *particles,
                            const struct sph_fragments *fragments, const uint32_t *flaws);

#endif
