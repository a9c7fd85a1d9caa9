/* The rows of results that engine dem reports. */
#include "engine/dem/observe/results.h"

#include <math.h>

#include "schemas/rows.h"

static FIELD_WORDS(
    reasons, DEM_STOPS, [DEM_STOP_RUNNING] = "running", [DEM_STOP_QUIET] = "quiet", [DEM_STOP_END_TIME] = "end-time",
    [DEM_STOP_STRAIN] = "strain", [DEM_STOP_FAILURE] = "failure", [DEM_STOP_FAULT] = "fault");

#define RESULTS            dem_results
#define REAL(path_, ...)   RESULT_REAL(path_, path_, __VA_ARGS__)
#define SHARE(path_, ...)  RESULT_SHARE(path_, path_, __VA_ARGS__)
#define COUNT(path_, doc_) RESULT_COUNT(path_, path_, .doc = doc_)

static const struct field rows[] = {
    ROW_OF(dem_results, stop_reason, stop_reason, FIELD_CHOICE, NULL, .choices = reasons,
           .choice_docs = "the run has not ended\n"
                          "no beam broke for the scene's quiet time\n"
                          "the end time came\n"
                          "the final strain was reached\n"
                          "the stress fell below the scene's residual share of its maximum\n"
                          "a numerical fault: the outcome's state says which",
           .doc = "Why the run ended."),
    COUNT(grains, "Number of grains, without the explosive one."),
    COUNT(beams, "Number of beams at the start, without those of the explosive grain."),
    COUNT(broken, "Beams broken."),
    COUNT(broken_stretch, "Broken beams for which the stretching term of the breaking rule was the larger one."),
    COUNT(broken_bend, "Broken beams for which the bending term was the larger one."),
    SHARE(broken_share, .doc = "Broken beams over all beams."),
    REAL(first_break, "s", 0, .doc = "Time of the first break; off when none broke."),
    REAL(last_break, "s", 0, .doc = "Time of the last break; off when none broke."),
    REAL(energy_input, "J/m", 0,
         .doc = "Energy put in: initial kinetic energy (collision: in the common frame), or the work of the load."),
    REAL(threshold_energy, "J/m", 0,
         .doc = "Energy that would bring every beam, unbent, to its own threshold. Off without breaking."),
    REAL(stable_time_step, "s", 0,
         .doc =
             "Longest stable time step of the body as it starts: 2/omega_max for `verlet`, 0.54/omega_max for `gear`."),
    REAL(sound_speed_extension, "m/s", 0,
         .doc = "Estimate sqrt(E/rho): beams alone, aligned with the wave (the square lattice's value)."),
    REAL(sound_speed_compression, "m/s", 0,
         .doc = "Estimate sqrt((E + Y sqrt(pi)/2)/rho): beams and contacts, aligned with the wave."),
    REAL(overlap_share, "1", 0,
         .doc =
             "Pairs of grains that overlap, at the end, over the pairs that were neighbours at the start. Above 1 if "
             "many grains overlap that were none."),
    REAL(passing_share, "1", 0,
         .doc = "Fastest approach of two near grains that no beam joins and whose paths meet, over the speed at which "
                "they pass through each other. Above 1 the model has no answer for them. Off without contacts."),
    REAL(angular_momentum_error, "1", 0,
         .doc =
             "Change of the angular momentum about the origin, over the larger of its value at the start and the sum "
             "of the momenta times half of the body's size. Off for bodies between moving sides."),
    COUNT(late_breaks, "Beams broken in the second half of the run's time."),
    SHARE(largest_loss,
          .doc =
              "Loss of M_1/M of the largest fragment in the second half of the run's time; 0 for a final run. Expect "
              "about as much in the next doubling of the time."),
    REAL(energy.kinetic, "J/m", 0, .doc = "Kinetic energy at the end."),
    REAL(energy.vibration, "J/m", 0,
         .doc = "Part of the kinetic energy that is motion inside fragments: neither their translation nor their "
                "rotation. Without damping it does not decay, and breaks more beams."),
    REAL(energy.beam, "J/m", -HUGE_VAL, .doc = "Energy stored in beams at the end."),
    REAL(energy.contact, "J/m", -HUGE_VAL,
         .doc = "Energy stored in contacts at the end (printed law: work done on contacts, of which only a part can "
                "return)."),
    REAL(energy.damping, "J/m", -HUGE_VAL, .doc = "Energy taken by damping."),
    REAL(energy.friction, "J/m", -HUGE_VAL, .doc = "Energy taken by friction."),
    REAL(energy.broken_beam, "J/m", -HUGE_VAL,
         .doc = "Energy of the beams when they broke: the energy of the new surfaces. With contact.bonded off, less "
                "what contacts store that begin with a break."),
    REAL(energy.external_work, "J/m", -HUGE_VAL, .doc = "Work done by moving boundaries."),
    REAL(young_modulus, "Pa", -HUGE_VAL,
         .doc = "K: slope of stress against strain under uniaxial load, up to the first break.",
         .source = "K99 section 3.1"),
    REAL(poisson_ratio, "1", -HUGE_VAL, .doc = "nu: minus the slope of lateral against axial strain.",
         .source = "K99 section 3.1"),
    REAL(strength, "Pa", 0, .doc = "Largest stress under load, at any time step.", .source = "K99 section 3.2"),
    REAL(failure_strain, "1", 0, .doc = "Strain at the largest stress.", .source = "K99 section 3.2"),
    REAL(final_strain, "1", 0, .doc = "Strain at the end of the loading."),
    SHARE(upright_share,
          .doc =
              "Compression: broken beams whose crack (the common side) lies within 30 degrees of the load's direction, "
              "over all broken beams, up to the largest stress. Of isotropic sides it would be 1/3."),
    REAL(end_triangle_share, "1", 0,
         .doc = "Compression: share of beams broken inside the two 45-degree triangles on the confined ends, over the "
                "same share outside them, up to the largest stress. 0 is intact triangles, 1 no pattern.",
         .source = "K99 figure 8"),
};

const struct field_table dem_results = FIELD_TABLE(rows, struct dem_results, "dem results",
                                                   "What engine dem reports beyond the common outcome.");
