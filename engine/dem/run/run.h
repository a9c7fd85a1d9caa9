/* One run of engine `dem`: body, moving grains, protocol and records so far. For engine/dem and its tests only. */
#pragma once

#include "engine/condition.h"
#include "engine/dem/observe/results.h"
#include "engine/dem/scene/inputs.h"
#include "engine/dem/step/system.h"
#include "engine/engine.h"
#include "engine/frame.h"
#include "engine/outcome.h"

/* One point of the stress-strain curve: means over the steps since the point before it. Extension is positive. */
struct dem_sample {
  double time, strain, stress, lateral_strain;
  uint64_t broken;
};

/* Values that change during a run besides the system. A plain struct: restart files save its raw bytes. */
struct dem_state {
  struct frame_state frame;
  double momentum_start[2];           /* of the grains that are free along that axis */
  double force_before[2], impulse[2]; /* on held grains: at the step before; its time integral (trapezoids) */
  double stress_sum, strain_sum;      /* loading: since the last sample */
  uint64_t summed;
  double stress_peak, strain_peak, time_peak; /* loading: magnitudes at the largest stress */
};

struct dem_run {
  struct frame frame; /* from the end of dem_run_create on */
  struct dem_inputs inputs;
  uint64_t seed;
  struct dem_tessellation *tessellation;
  struct dem_system *system;
  struct dem_state state;
  double stable_time_step;
  double angular_start;    /* kg m^2/s per m, about the origin */
  double grain_diameter;   /* m, of the circle of mean area */
  double threshold_energy; /* J/m, at the start; NaN without breaking */
  double passing_speed;    /* m/s: grains that close in faster pass through each other; 0 without contacts */

  uint32_t charge;     /* the explosive grain, or UINT32_MAX */
  unsigned char *held; /* by grain: bit 1 x, 2 y, 4 rotation */

  /* loading */
  uint32_t *lower, *upper, *left, *right; /* held layers; gauge of the lateral strain at half height */
  size_t lower_count, upper_count, left_count, right_count;
  double gauge_length, gauge_width, section; /* m */
  uint64_t sample_interval;
  struct dem_sample *sample;
  size_t sample_capacity;
};

/* dem.c. Calls of struct engine_kind have its types: the run is a struct dem_run, inputs are a struct dem_inputs. */
status dem_run_create(const struct dem_inputs *inputs, uint64_t seed, struct dem_run **out, struct error *error);
void dem_run_free(void *run);                           /* NULL is fine */
double dem_run_closed(const struct dem_ledger *ledger); /* the sum that must stay constant, J/m */
/* Sum over grains free along each axis, and sum of all magnitudes, kg/s per m of thickness. */
void dem_run_momentum(const struct dem_run *run, double momentum[2], double *magnitude);
/* Angular momentum of the present grains about the origin, kg m^2/s per m of thickness. */
double dem_run_angular_momentum(const struct dem_run *run);
/* protocol.c: the body, and the load or impact at the start. */
status dem_protocol_body(const struct dem_inputs *inputs, uint64_t seed, struct dem_tessellation **out,
                         struct error *error);
status dem_protocol_start(struct dem_run *run, struct error *error);

/* loading.c: blocks between two moving sides. */
status dem_loading_start(struct dem_run *run, struct error *error);
void dem_loading_drive(struct dem_run *run);             /* before a step */
void dem_loading_record(struct dem_run *run);            /* after it */
double dem_loading_slope_end(const struct dem_run *run); /* largest strain of the slopes that are results */
double dem_loading_bend(const struct dem_run *run);      /* its change from their first half to the second, over it */
void dem_loading_results(const struct dem_run *run, struct dem_results *results);

/* report.c; `results`: struct dem_results */
status dem_report_fragments(const struct dem_run *run, uint32_t *label, struct fragment **fragments, size_t *count,
                            struct error *error);
status dem_report_finish(void *run, struct outcome *outcome, void *results, struct fragment **fragments, size_t *count,
                         struct error *error);

/* describe.c */
char *dem_describe_scene(const void *inputs, bool all); /* struct dem_inputs */
/* Closing speed above which two free grains pass through each other: no overlap stores that much energy, m/s. */
double dem_describe_passing_speed(const struct dem_inputs *inputs);
void dem_describe_sound_speeds(const struct dem_inputs *inputs, double *extension, double *compression);
double dem_describe_stable_step(const struct dem_inputs *inputs); /* s: an estimate, without a body */
double dem_describe_damping(const struct dem_inputs *inputs);     /* 1/s: the largest active damping */

/* conditions.c */
extern const struct condition dem_conditions[]; /* engine_kind.conditions */

/* snapshot.c */
status dem_snapshot_write(void *run, const char *path, struct error *error);
