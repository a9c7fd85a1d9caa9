/* The big fields of a run as one self-describing HDF5 file, which VTK or ParaView opens as it is: particles, fragments,
 * results, and the curve that a protocol records. */
#include <stdlib.h>

#include "engine/sph/observe/particle_columns.h"
#include "engine/sph/observe/plate.h"
#include "engine/sph/sph.h"

static const struct snapshot_file_column curve_columns[] = {
    {"time", "s", "when", 0},
    {"strain", "1", "stretch: strain rate times time", 0},
    {"stress", "Pa", "stretch: mean axial stress between the grips", 0},
    {"mode", "1", "vibration: velocities projected on the first mode, over their first size", 0},
    {"damage", "1", "mean damage of bodies with flaws", 0},
    {"front", "m", "piston: where the shock is", 0},
    {"precursor", "m", "piston: where the elastic precursor is", 0},
};
/* Along the axis of an impact, from the surface down, or along a plate: how pores and damage change with depth. */
static const struct snapshot_file_column axis_columns[] = {
    {"depth", "m", "of the layer at the start, below the surface", 0},
    {"distention", "1",
     "mean over retained particles within 1.5 spacings of the axis, at rest (P = 0); of a plate: as it is, over its "
     "layer",
     0},
    {"damage", "1", "mean D there", 0},
    {"pressure", "Pa", "mean there", 0},
    {"velocity", "m/s", "mean there, outwards; of a plate along x", 0},
};
static double axis_value(const void *context, size_t row, size_t column, size_t k) {
  (void)k;
  const struct sph_crater_layer *l = (const struct sph_crater_layer *)context + row;
  const double values[] = {l->depth, l->distention, l->damage, l->pressure, l->velocity};
  return values[column];
}

static double curve_value(const void *context, size_t row, size_t column, size_t k) {
  (void)k;
  const struct sph_sample *s = (const struct sph_sample *)context + row;
  const double values[] = {s->time, s->strain, s->stress, s->mode, s->damage, s->front, s->precursor};
  return values[column];
}

status sph_snapshot_write(struct sph_run *run, const char *path, struct error *error) {
  struct outcome outcome;
  struct sph_results results;
  struct fragment *fragments = NULL;
  struct sph_fragments pieces = {0};
  struct snapshot_file *file = NULL;
  size_t count = 0;
  status code = sph_report_finish(run, &outcome, &results, &fragments, &count, error);
  free(fragments); /* once more, for the labels */
  if (code)
    return code;
  uint32_t *flaws = malloc((run->now->n + 1) * sizeof *flaws);
  if (!flaws) {
    code = status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
    goto cleanup;
  }
  if ((code = sph_report_pieces(run, run->inputs.fragments.static_strength, run->inputs.fragments.veneer, &pieces,
                                error)) ||
      (code = snapshot_file_open(sph_engine.name, sph_engine.doc, sph_engine.results_version, run->seed, &sph_inputs,
                                 &run->inputs, &file, error)))
    goto cleanup;
  snapshot_file_real(file, "run", "time", outcome.time);
  snapshot_file_table(file, "inputs", &sph_inputs, &run->inputs);
  snapshot_file_table(file, "outcome", &outcome_table, &outcome);
  snapshot_file_table(file, "results", &sph_results, &results);
  sph_particle_columns_add(file, run->now, &pieces, sph_system_flaws(run->system, flaws) ? flaws : NULL);
  if (run->sample)
    snapshot_file_columns(file, "curve", run->state.samples, sizeof curve_columns / sizeof curve_columns[0],
                          curve_columns, curve_value, run->sample);
  if (run->inputs.kind == SPH_IMPACT || run->inputs.kind == SPH_PISTON) {
    static const size_t most = 4096;
    struct sph_crater_options options = sph_report_crater(run);
    struct sph_crater_layer *layers = malloc(most * sizeof *layers);
    if (layers)
      snapshot_file_columns(file, "axis",
                            run->inputs.kind == SPH_PISTON
                                ? sph_plate_profile(run, layers, most)
                                : sph_crater_profile(run->start, run->now, &options, layers, most),
                            sizeof axis_columns / sizeof axis_columns[0], axis_columns, axis_value, layers);
    else
      snapshot_file_fail(file);
    free(layers);
  }
  code = snapshot_file_save(file, path, error);
cleanup:
  snapshot_file_close(file);
  free(flaws);
  sph_fragments_clear(&pieces);
  return code;
}
