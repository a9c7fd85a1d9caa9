/* One run of engine `sph`: bodies, the moving system, the protocol and what it has recorded so far. Inside this folder
 * only. */
#pragma once

#include "engine/engine.h"
#include "engine/frame.h"
#include "engine/outcome.h"
#include "engine/snapshot_file.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/material/palpha.h"
#include "engine/sph/observe/observe.h"
#include "engine/sph/observe/results.h"
#include "engine/sph/scene/inputs.h"
#include "engine/sph/step/system.h"

enum {
  SPH_RUN_BODIES = 2,
  SPH_SAMPLES = 400 /* of a protocol over the whole run: a sample costs about a tenth of a step */
};

/* One point of the curve that a protocol records: stress against strain (stretch), the mode's amplitude (vibration), or
 * the places of the fronts (piston). */
struct sph_sample {
  double time, strain, stress, mode, damage, front, precursor;
};

/* Values that change during a run beside the system itself: a plain struct, saved as raw bytes in a restart file. */
struct sph_state {
  struct frame_state frame;
  double momentum_start[3], angular_start[3];
  double momentum_scale_start;                /* kg m/s, sum |p| at the start */
  double smallest_step;                       /* s */
  double first_damage;                        /* s, NaN: none yet */
  double quiet_damage[1 + SPH_RUN_BODIES];    /* mean damage of all bodies and of each, when it last grew enough */
  double quiet_since;                         /* s, when one of them last did; for the rule of stop.quiet_time */
  uint64_t limited[SPH_LIMITS];               /* steps that each limiter set */
  double peak_stress, peak_strain, peak_time; /* stretch */
  double mode_before, mode_time;              /* vibration: amplitude at the last check */
  double crossing_first, crossing_last;       /* s, interpolated zero crossings of the mode */
  uint64_t crossings;
};

struct sph_run {
  struct frame frame; /* from the end of sph_run_create on */
  struct sph_inputs inputs;
  uint64_t seed;
  struct sph_shape shape[SPH_RUN_BODIES]; /* shapes at their places at the start */
  struct sph_range range[SPH_RUN_BODIES];
  int body_count;
  size_t targets;                          /* particles that can belong to fragments: ids below this one */
  double periodic[3];                      /* m, NaN = open */
  struct sph_particles *start;             /* as they were set up: positions and h at rest */
  struct sph_particles *now;               /* the system as last read; sph_run_read */
  struct sph_flaws *flaws[SPH_RUN_BODIES]; /* NULL: the body does not crack; freed once the system has them */
  size_t flaw_count;
  struct sph_system *system;
  struct sph_state state;
  struct sph_sample *sample; /* sample_capacity of them; NULL: the protocol records none */
  size_t sample_capacity;
  double sample_interval;        /* s */
  struct sph_plane_shock exact;  /* piston: the exact solution */
  struct sph_plate_layer *layer; /* piston: memory of plate.c */
  /* Do particles that belong together stand too far apart at the start, so that a whole body counts as many fragments?
   * Known from the first report on. */
  bool has_gaps;
  double heaviest_off; /* kg, the heaviest particle of the target that is not in the largest fragment; at the end */
};

/* Calls of struct engine_kind have its types: the run is a struct sph_run, inputs are a struct sph_inputs. */
status sph_run_create(const struct sph_inputs *inputs, uint64_t seed, struct sph_run **out, struct error *error);
void sph_run_free(void *run); /* NULL is fine */
/* The particles as they are now, in the order of their ids; owned by the run, valid until the next call. */
const struct sph_particles *sph_run_read(struct sph_run *run);
double sph_run_closed(const struct sph_ledger *ledger); /* the sum that must stay constant, J; `clamped` is not in it */
double sph_run_extent(const struct sph_run *run);       /* m, the target's reach: a length for errors */
/* Energy put in, without that of the motion of the common centre of mass, J: no collision can use it. Errors of energy
 * count relative to this, so that they do not depend on which body moves. Where momentum is not kept: all of it. */
double sph_run_energy_available(const struct sph_run *run, const struct sph_ledger *ledger);
bool sph_run_keeps_momentum(const struct sph_run *run); /* no matter is held, and no layer damps */

/* protocol.c: bodies with their flaws, places and motion. Fills shape, range, start, flaws... of the
 * run. */
status sph_protocol_bodies(struct sph_run *run, struct error *error);

/* describe.c */
char *sph_describe_scene(const void *inputs, bool all);
struct sph_column_set sph_describe_columns(const struct sph_inputs *inputs); /* that its system will have */
size_t sph_describe_memory(const void *inputs);                              /* bytes a run will need */
double sph_describe_steps(const void *inputs);                               /* to stop.end_time, an estimate */
double sph_describe_work(const void *inputs);                                /* particle-steps, an estimate */

/* conditions.c */
extern const struct condition sph_conditions[]; /* engine_kind.conditions */

/* The output of one run of engine `sph`: the record of a protocol during the run, results and fragments at the end, and
 * its fields files. For this folder, run/ and sph.c. */

/* protocol.c: the curve of a stretch, a vibration or a piston. Other protocols record nothing. STATUS_MEMORY. */
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
/* results: struct sph_results. *fragments: by descending mass, malloc'd. */
status sph_report_finish(void *run, struct outcome *outcome, void *results, struct fragment **fragments, size_t *count,
                         struct error *error);

/* snapshot.c: a fields file of the run as it is now. */
status sph_snapshot_write(void *run, const char *path, struct error *error);
/* Particles as a VTKHDF 1.0 grid of vertices, row i particle i, and the table /fragments. It needs no run. flaws:
 * number of flaws of each particle, or NULL. */
void sph_snapshot_particles(struct snapshot_file *file, const struct sph_particles *particles,
                            const struct sph_fragments *fragments, const uint32_t *flaws);
