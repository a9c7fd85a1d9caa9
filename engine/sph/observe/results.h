/* Results of engine `sph` in addition to struct outcome: table result_sph. A quantity that does not apply is off (NaN).
 * The file that measures a result fills it here: report.c, crater.c, plate.c, and modules for the results that they
 * declare. */
#pragma once

#include "engine/ejecta.h"
#include "engine/sph/modules/structs.h"

enum sph_stop { SPH_STOP_RUNNING, SPH_STOP_QUIET, SPH_STOP_END_TIME, SPH_STOP_FAULT, SPH_STOPS };

struct sph_results {
  int stop_reason; /* enum sph_stop */
  int64_t particles, projectile_particles, flaws;
  double target_mass, projectile_mass, specific_energy;
  bool fracture_ceased;
  double first_damage, cease_time;
  double mean_damage, undamaged_fraction;
  struct {
    double bare_fraction, veneer_fraction, dynamic_fraction;
    double axis_middle, axis_short;
    double speed;
  } largest;
  struct {
    double mass, angle;
  } second;
  struct {
    int64_t shaped;
    double b_over_a, c_over_a;
  } shapes; /* rows fragments.* */
  struct {
    double mass_fraction, momentum, momentum_enhancement;
  } ejecta;
  struct ejecta ejecta_over_speed; /* table ejecta; its sums are those of ejecta.*. No row: engine_kind.ejecta */
  struct {
    double depth, radius, volume, compaction_share;
  } crater;
  struct {
    double kinetic, internal, damped, work_of_held, clamped;
  } energy;
  double energy_input, clamped_share, density_held_share, angular_momentum_error;
  struct {
#define TIME_STEP_LIMIT(NAME, member, doc) double member;
#include "engine/sph/modules/declarations.h"
  } limited;
  double neighbours;
  struct {
    double stress, strain, time;
  } peak;
  double cracks;
  double frequency;
  double rebound;
  struct {
    double speed, speed_exact, density, density_exact, pressure, pressure_exact;
  } shock;
  struct {
    double speed, speed_exact, pressure, pressure_exact;
  } precursor;
#define MODULE_RESULTS(name) struct sph_##name##_results name;
#include "engine/sph/modules/declarations.h"
};

extern struct field_table sph_results; /* constant once main() begins */

/* A result that is not finite is off (NaN). */
double sph_results_finite(double value);
/* part / whole; off when the whole is not above 0. The value is not clamped: a share outside of 0..1 is an error of the
 * sums, and `clast check` reports it. Sum a part in the order of the whole, so that rounding does not lift it above. */
double sph_results_share(double part, double whole);
