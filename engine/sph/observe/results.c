/* The rows of the results of engine `sph`. */
#include "engine/sph/observe/results.h"

#include <math.h>

static FIELD_WORDS(reasons, SPH_STOPS, [SPH_STOP_RUNNING] = "running", [SPH_STOP_QUIET] = "quiet",
                   [SPH_STOP_END_TIME] = "end-time", [SPH_STOP_FAULT] = "fault");

#define RESULTS            sph_results
#define REAL(path_, ...)   RESULT_REAL(path_, path_, __VA_ARGS__)
#define SHARE(path_, ...)  RESULT_SHARE(path_, path_, __VA_ARGS__)
#define COUNT(path_, doc_) RESULT_COUNT(path_, path_, .doc = doc_)

static const struct field rows[] = {
    ROW_OF(sph_results, stop_reason, stop_reason, FIELD_CHOICE, NULL, .choices = reasons,
           .choice_docs = "the run has not ended\n"
                          "fracture ceased by the rule of stop.quiet_time\n"
                          "the run reached stop.end_time\n"
                          "a numerical fault: the state of the outcome names it",
           .doc = "Why the run ended."),
    COUNT(particles, "Number of particles in the target (in both bodies of a collision)."),
    COUNT(projectile_particles, "Number of particles in the projectile or piston."),
    COUNT(flaws, "Number of explicit flaws in all bodies."),
    REAL(target_mass, "kg", 0,
         .doc = "Mass of the target, in a collision of both bodies. All mass fractions are shares of it, so they leave "
                "the projectile out."),
    REAL(projectile_mass, "kg", 0, .doc = "Mass of the projectile; off without one."),
    REAL(specific_energy, "J/kg", 0,
         .doc = "Q: kinetic energy of the projectile over the mass of the target; off without a projectile."),
    ROW_OF(sph_results, fracture_ceased, fracture_ceased, FIELD_BOOLEAN, NULL, .maximum = 1,
           .doc = "Fracture ceased by the rule of stop.quiet_time, or no damage began before stop.end_time."),
    REAL(first_damage, "s", 0,
         .doc = "Time when damage of a body with flaws began; off without damage. It is looked for at every eighth "
                "step, so it may be eight steps late."),
    REAL(cease_time, "s", 0,
         .doc = "Time when fracture ceased: damage has grown by less than stop.quiet_growth since. Off when fracture "
                "has not ceased."),
    SHARE(mean_damage, .doc = "Mean damage D of the target at the end, weighted by mass.", .source = "BA95 eq. 14"),
    SHARE(undamaged_fraction, .doc = "Mass share of the target's particles with damage below fragments.damage. "
                                     "Particles that only the static strength breaks count as undamaged."),
    SHARE(largest.bare_fraction,
          .doc = "M_1/M of the core: mass of the largest fragment without its damaged layer over the target's mass, "
                 "with the static strength.",
          .source = "BA95 section 4.4"),
    SHARE(largest.veneer_fraction, .label = "M_1/M with the damaged layer",
          .doc = "M_1/M: mass of the largest fragment with its damaged layer (veneer) over the target's mass, with the "
                 "static "
                 "strength.",
          .source = "BA95 section 4.4"),
    SHARE(largest.dynamic_fraction, .doc = "M_1/M with the damaged layer and without the static strength."),
    SHARE(largest.axis_middle, .doc = "Middle over longest axis of the ellipsoid that has the moments of inertia of "
                                      "the largest fragment. Off when that has fewer than 100 particles."),
    SHARE(largest.axis_short, .doc = "Shortest over longest axis of the same ellipsoid. 1 is a sphere."),
    REAL(largest.speed, "m/s", 0,
         .doc = "Speed of the largest fragment's centre of mass. Off when that has fewer than 100 particles."),
    REAL(second.mass, "kg", 0, .doc = "Mass of the second largest fragment; off when there is only one."),
    REAL(second.angle, "rad", 0,
         .doc = "Impact: angle between the directions from the centre of mass to the point of impact and to the second "
                "largest fragment. 180 deg is the antipode. Off when that has fewer than 100 particles.",
         .source = "BA95 section 5.2"),
    RESULT_COUNT(fragments.shaped, shapes.shaped,
                 .doc = "Number of fragments of at least 60 particles, without the largest: those whose shapes count."),
    RESULT_SHARE(fragments.b_over_a, shapes.b_over_a,
                 .doc =
                     "Middle over longest length of fragments of at least 60 particles, without the largest: the mean "
                     "over the fragments. Lengths are the axes of the solid ellipsoid with the fragment's moments of "
                     "inertia. Off without such a fragment."),
    RESULT_SHARE(fragments.c_over_a, shapes.c_over_a, .doc = "Shortest over longest length of the same fragments."),
    SHARE(ejecta.mass_fraction, .label = "ejecta as a share of the target's mass",
          .doc = "Impact: mass share of the target leaving faster than crater.ejection_speed and crater.escape_speed. "
                 "Times target_mass: their mass. `clast spectrum STORE --ejecta` shows it over the speed.",
          .source = "Jutzi & Benz, section 3"),
    REAL(ejecta.momentum, "kg m/s", 0, .doc = "Impact: momentum of the ejecta along the outward normal."),
    REAL(
        ejecta.momentum_enhancement, "1", 1,
        .doc =
            "Impact: 1 plus the momentum of the ejecta, and of matter of the projectile that moves outwards, over that "
            "of the projectile, along the normal: what the rest of the target gains, over what the projectile brings. "
            "Ejecta are faster than crater.ejection_speed; all matter counts that is faster than crater.escape_speed.",
        .source = "Cheng and others 2023"),
    REAL(crater.depth, "m", 0,
         .doc = "Impact: largest depth of the crater below the surface at the start, along the outward normal at the "
                "point of impact. 0 when it is less than the spacing of the particles."),
    REAL(crater.radius, "m", 0, .doc = "Impact: radius of a circle whose area is that of the crater at the surface."),
    REAL(crater.volume, "m^3", 0,
         .doc =
             "Impact: volume of the crater, between the surface at the start and the surface of the retained matter."),
    SHARE(crater.compaction_share,
          .doc = "Impact: volume lost by compaction over the sum of that volume and the ejecta's volume at the start. "
                 "1 is a crater made by compaction alone. Off when both volumes are 0.",
          .source = "Jutzi & Benz, section 3.1"),
    REAL(energy.kinetic, "J", 0, .doc = "Kinetic energy at the end."),
    REAL(energy.internal, "J", 0, .doc = "Internal energy at the end, elastic energy included."),
    REAL(energy.damped, "J", -HUGE_VAL,
         .doc =
             "Energy that the damping layer of a box took out of motion (sides.far: damped); 0 in all other scenes."),
    REAL(energy.work_of_held, "J", -HUGE_VAL,
         .doc = "Work done on the body by matter that is held at a given velocity: the grips of a stretch, the piston; "
                "0 in all other scenes."),
    REAL(energy.clamped, "J", -HUGE_VAL, .doc = "Energy added where internal energy would have become negative."),
    REAL(energy_input, "J", 0,
         .doc = "Energy put in: kinetic energy at the start plus the absolute value of energy.work_of_held."),
    REAL(clamped_share, "1", 0,
         .doc =
             "energy.clamped over the energy put in, without that of the motion of all matter together. energy_error "
             "does not subtract it."),
    SHARE(density_held_share,
          .doc = "Share of all particle steps that held the density at its lower limit. Such a step adds no energy."),
    REAL(angular_momentum_error, "1", 0,
         .doc = "Relative change of angular momentum; off with grips, a piston or a damping layer. The scale is the "
                "larger of the angular momentum at the start and the sum of momenta (the larger of start and end) "
                "times the target's extent. Only axes count across which nothing is periodic."),
#define TIME_STEP_LIMIT(NAME, member, doc_) SHARE(limited.member, .doc = "Share of the steps limited by " doc_ "."),
#include "engine/sph/modules/declarations.h"
    REAL(neighbours, "1", 0, .doc = "Mean number of neighbours within 2h at the end."),
    REAL(peak.stress, "Pa", -HUGE_VAL, .label = "strength: largest mean stress",
         .doc = "Stretch: largest mean axial stress between the grips."),
    REAL(peak.strain, "1", 0, .doc = "Stretch: strain (strain rate times time) at the largest stress."),
    REAL(peak.time, "s", 0, .doc = "Stretch: time of the largest stress."),
    REAL(cracks, "1", 0,
         .doc = "Stretch: number of parts of more than 1 % of the rod's mass, minus one. Parts are found without "
                "static strength and without damaged layers. Overlapping cracks joined by broken rock do not count, "
                "even if the rod no longer carries load."),
    REAL(frequency, "1/s", 0, .doc = "Vibration: frequency of the first mode, from its zero crossings."),
    REAL(rebound, "1", -HUGE_VAL, .doc = "Collision: speed of separation of the bodies over their speed of approach."),
    REAL(shock.speed, "m/s", -HUGE_VAL,
         .doc = "Piston: speed of the shock (behind a precursor: of the crushing front) over the second half of the "
                "run. The front is where density passes the mean of the values ahead and behind. Off when the piston "
                "is too slow for a shock. Of no use, and maybe below 0, with the warning arrival.",
         .source = "Jutzi, Benz & Michel 2008"),
    REAL(shock.speed_exact, "m/s", 0, .doc = "Piston: speed of the shock by the jump conditions.",
         .source = "Rankine; Hugoniot"),
    REAL(shock.density, "kg/m^3", 0,
         .doc = "Piston: mean density behind the shock, in the middle half between piston and shock."),
    REAL(shock.density_exact, "kg/m^3", 0, .doc = "Piston: density behind the shock by the jump conditions."),
    REAL(shock.pressure, "Pa", -HUGE_VAL, .doc = "Piston: mean pressure behind the shock, in the same region."),
    REAL(shock.pressure_exact, "Pa", 0, .doc = "Piston: pressure behind the shock by the jump conditions."),
    REAL(precursor.speed, "m/s", -HUGE_VAL,
         .doc = "Piston: speed of the elastic precursor, which runs ahead of the crushing front; off where there is "
                "none, and when the shock is faster. Of no use, and maybe below 0, with the warning arrival."),
    REAL(precursor.speed_exact, "m/s", 0, .doc = "Piston: speed of the precursor by the jump conditions."),
    REAL(precursor.pressure, "Pa", -HUGE_VAL, .doc = "Piston: mean pressure between precursor and shock."),
    REAL(precursor.pressure_exact, "Pa", 0,
         .doc = "Piston: exact pressure behind the precursor: that at which pores begin to close, or less when the "
                "piston is slow."),
#define SPH_MODULE_RESULT_ROWS
#include "engine/sph/modules/declarations.h"
};

static const struct field_table nested = FIELD_TABLE(rows, struct sph_results, "sph results",
                                                     "Results of engine sph beside the common outcome.");
struct field_table sph_results;
FIELD_TABLE_AT_START(sph_results, nested)

double sph_results_finite(double value) {
  return isfinite(value) ? value : (double)NAN;
}

double sph_results_share(double part, double whole) {
  return whole > 0 ? sph_results_finite(part / whole) : (double)NAN;
}
