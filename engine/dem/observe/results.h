/* Results of engine `dem` in addition to struct outcome: table result_dem. A quantity that does not apply is off (NaN).
 */
#pragma once

#include "schemas/field.h"

enum dem_stop {
  DEM_STOP_RUNNING,
  DEM_STOP_QUIET,
  DEM_STOP_END_TIME,
  DEM_STOP_STRAIN,
  DEM_STOP_FAILURE,
  DEM_STOP_FAULT,
  DEM_STOPS
};

struct dem_results {
  int stop_reason; /* enum dem_stop */
  int64_t grains, beams, broken, broken_stretch, broken_bend;
  double broken_share, first_break, last_break;
  double energy_input, threshold_energy, stable_time_step, sound_speed_extension, sound_speed_compression;
  double overlap_share, passing_share;
  double angular_momentum_error;
  int64_t late_breaks;
  double largest_loss;
  struct {
    double kinetic, vibration, beam, contact, damping, friction, broken_beam, external_work;
  } energy;
  double young_modulus, poisson_ratio, strength, failure_strain, final_strain, upright_share, end_triangle_share;
};

extern const struct field_table dem_results;
