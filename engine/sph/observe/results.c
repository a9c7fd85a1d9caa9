/* The rows of the results of engine `sph`. */
#include "engine/sph/observe/results.h"

#include <math.h>

static const char *const reasons[] = {"running", "quiet", "end-time", "fault", NULL};

#define ROW(path_, kind_, unit_, ...)                                                                                  \
  { .path = #path_, .kind = kind_, .unit = unit_, .offset = offsetof(struct sph_results, path_), __VA_ARGS__ }
#define COUNT(path_, doc_) ROW(path_, FIELD_INTEGER, "1", .minimum = 0, .maximum = HUGE_VAL, .doc = doc_)
#define REAL(path_, unit_, low, ...)                                                                                   \
  ROW(path_, FIELD_REAL, unit_, .minimum = low, .maximum = HUGE_VAL, .number = NAN, .flags = FIELD_MAY_BE_OFF,         \
      __VA_ARGS__)
#define SHARE(path_, ...)                                                                                              \
  ROW(path_, FIELD_REAL, "1", .minimum = 0, .maximum = 1, .number = NAN, .flags = FIELD_MAY_BE_OFF, __VA_ARGS__)

static const struct field rows[] = {
    ROW(stop_reason, FIELD_CHOICE, NULL, .choices = reasons,
        .choice_docs = "the run has not ended\n"
                       "damage had ceased to grow by the scene's rule\n"
                       "the hard end came\n"
                       "a numerical fault: the outcome's state says which",
        .doc = "Why the run ended."),
    COUNT(particles, "Particles of the target (of a collision: of both bodies)."),
    COUNT(projectile_particles, "Particles of the projectile, or of the piston."),
    COUNT(flaws, "Explicit flaws in all bodies."),
    REAL(target_mass, "kg", 0, .doc = "Mass of the target: M of all mass fractions, which leave the projectile out."),
    REAL(projectile_mass, "kg", 0, .doc = "Mass of the projectile; off without one."),
    REAL(specific_energy, "J/kg", 0,
         .doc = "Q: kinetic energy of the projectile over the target's mass; off without one."),
    ROW(fracture_ceased, FIELD_BOOLEAN, NULL, .maximum = 1,
        .doc =
            "Damage had ceased to grow by the scene's rule (stop.quiet_time), or there is nothing that could break."),
    REAL(first_damage, "s", 0, .doc = "Time at which damage of a body with flaws began; off when there is none."),
    REAL(cease_time, "s", 0,
         .doc = "Time since which damage has grown by less than stop.quiet_growth; off when it still grows."),
    SHARE(mean_damage, .doc = "Mean damage of the target at the end, by mass.", .source = "BA95 eq. 14"),
    SHARE(undamaged_fraction,
          .doc = "Mass share of the target's particles below fragments.damage, before the static pass."),
    REAL(mean_distention, "1", 1,
         .doc = "Mean distention of the target at the end, by mass, at rest (P = 0): 1 is solid; off without pores.",
         .source = "Jutzi, Benz & Michel 2008"),
    SHARE(largest.bare_fraction, .doc = "M_1/M with the static pass and without the veneer of damaged particles.",
          .source = "BA95 section 4.4"),
    SHARE(largest.veneer_fraction, .doc = "M_1/M with the static pass and with the veneer.",
          .source = "BA95 section 4.4"),
    SHARE(largest.dynamic_fraction, .doc = "M_1/M without the static pass, with the veneer."),
    SHARE(largest.axis_middle,
          .doc = "Middle over longest axis of the ellipsoid with the largest fragment's moments of inertia."),
    SHARE(largest.axis_short, .doc = "Shortest over longest axis of that ellipsoid: 1 is a sphere."),
    REAL(largest.speed, "m/s", 0, .doc = "Speed of the largest fragment."),
    REAL(second.mass, "kg", 0, .doc = "Mass of the second largest fragment; off when there is none."),
    REAL(
        second.angle, "rad", 0,
        .doc =
            "Angle at the target's centre between the point of impact and the second largest fragment: pi is opposite.",
        .source = "BA95 section 5.2"),
    SHARE(ejecta.mass_fraction,
          .doc = "Impact: mass share of the target that leaves it faster than crater.ejection_speed.",
          .source = "Jutzi & Benz, section 3"),
    REAL(ejecta.momentum, "kg m/s", 0, .doc = "Impact: momentum of that mass, along the outward normal."),
    REAL(crater.depth, "m", 0,
         .doc = "Impact: depth of the crater in what is retained, below the first surface; in steps of a spacing, 0 "
                "below one."),
    REAL(crater.radius, "m", 0, .doc = "Impact: radius of a circle of the crater's area at the first surface."),
    REAL(crater.volume, "m^3", 0,
         .doc = "Impact: volume between the first and the present surface of what is retained."),
    SHARE(crater.compaction_share,
          .doc = "Impact: volume of closed pores over that and the ejecta's first volume: 1 is a crater made by "
                 "compaction alone. Off when "
                 "there is neither.",
          .source = "Jutzi & Benz, section 3.1"),
    SHARE(compaction.mass_fraction,
          .doc =
              "Mass share of the target with distention (at rest) below 1.01 that had 1.01 or more; off without pores.",
          .source = "Jutzi & Benz, figure 2"),
    REAL(compaction.volume, "m^3", 0,
         .doc = "Volume that the target's retained matter has lost by closing pores; off without pores."),
    REAL(compaction.depth, "m", 0,
         .doc = "First depth of the deepest matter near the axis with distention below 1.01; off without pores."),
    REAL(compaction.reach, "m", 0,
         .doc = "Distance from the point of impact of the farthest matter that lost a hundredth of its pores; off "
                "without pores."),
    REAL(energy.kinetic, "J", 0, .doc = "Kinetic energy at the end."),
    REAL(energy.internal, "J", 0, .doc = "Internal energy at the end, elastic energy included."),
    REAL(energy.damped, "J", -HUGE_VAL, .doc = "Energy taken by damped sides."),
    REAL(energy.work_of_held, "J", -HUGE_VAL, .doc = "Work done by grips."),
    REAL(energy.clamped, "J", -HUGE_VAL, .doc = "Energy put in where internal energy would have become negative."),
    REAL(energy_input, "J", 0, .doc = "Energy put in: kinetic energy at the start, and the size of the grips' work."),
    REAL(clamped_share, "1", 0, .doc = "energy.clamped over energy_input: booked apart, not credited in energy_error."),
    SHARE(density_held_share,
          .doc = "Particle-steps at the lowest density allowed, over all: clamps that put in no energy."),
    REAL(angular_momentum_error, "1", 0,
         .doc =
             "Change of angular momentum over the larger of its first size and the sum of momenta (the larger of start "
             "and end) "
             "times the target's reach; off with grips or damped sides. Only about axes across which nothing repeats."),
    SHARE(limited.courant,
          .doc = "Share of the steps whose length the speed of sound and the viscosity, or a damped side, set."),
    SHARE(limited.force, .doc = "Share of the steps whose length the acceleration set."),
    SHARE(limited.damage, .doc = "Share of the steps whose length the growth of damage set."),
    SHARE(limited.distention, .doc = "Share of the steps whose length the closing of pores set."),
    SHARE(limited.energy, .doc = "Share of the steps whose length the change of internal energy set."),
    SHARE(limited.density, .doc = "Share of the steps whose length the change of density set."),
    REAL(neighbours, "1", 0, .doc = "Mean number of neighbours within 2h at the end."),
    REAL(peak.stress, "Pa", -HUGE_VAL, .doc = "Stretch: largest mean axial stress between the grips."),
    REAL(peak.strain, "1", 0, .doc = "Stretch: strain rate times time, then."),
    REAL(peak.time, "s", 0, .doc = "Stretch: that time."),
    REAL(cracks, "1", 0,
         .doc = "Stretch: pieces of more than 1 % of the rod, less one (without static pass and veneer). Cracks that "
                "overlap, with "
                "bridges of broken rock between them, part nothing, although the rod bears no load."),
    REAL(frequency, "1/s", 0, .doc = "Vibration: frequency of the first mode, from its zero crossings."),
    REAL(rebound, "1", -HUGE_VAL, .doc = "Collision: speed at which the bodies part over the speed of approach."),
    REAL(shock.speed, "m/s", 0,
         .doc = "Piston: speed of the shock (with pores: of the front that crushes them) over the second half of the "
                "run; where density "
                "passes half way. Off when the piston is too slow for one.",
         .source = "Jutzi, Benz & Michel 2008"),
    REAL(shock.speed_exact, "m/s", 0, .doc = "Piston: what the jump conditions give for it.",
         .source = "Rankine; Hugoniot"),
    REAL(shock.density, "kg/m^3", 0, .doc = "Piston: mean density of the middle half from the piston to the shock."),
    REAL(shock.density_exact, "kg/m^3", 0, .doc = "Piston: what the jump conditions give for it."),
    REAL(shock.pressure, "Pa", -HUGE_VAL, .doc = "Piston: mean pressure there."),
    REAL(shock.pressure_exact, "Pa", 0, .doc = "Piston: what the jump conditions give for it."),
    REAL(shock.distention, "1", 1, .doc = "Piston: mean distention there; off without pores."),
    REAL(shock.distention_exact, "1", 1, .doc = "Piston: what the jump conditions and the crush curve give for it."),
    REAL(precursor.speed, "m/s", 0,
         .doc = "Piston: speed of the elastic front that runs ahead of the crushing one; off without pores, and when "
                "the shock is faster."),
    REAL(precursor.speed_exact, "m/s", 0, .doc = "Piston: what the jump conditions give for it."),
    REAL(precursor.pressure, "Pa", -HUGE_VAL, .doc = "Piston: mean pressure between the two fronts."),
    REAL(precursor.pressure_exact, "Pa", 0, .doc = "Piston: what it should be: P_e, or less with a slow piston."),
    REAL(precursor.distention, "1", 1, .doc = "Piston: mean distention there."),
    REAL(precursor.distention_exact, "1", 1, .doc = "Piston: what the elastic branch gives for it."),
};

const struct field_table sph_results = FIELD_TABLE(rows, struct sph_results, "sph results",
                                                   "What engine sph reports beyond the common outcome.");

double sph_results_finite(double value) {
  return isfinite(value) ? value : (double)NAN;
}

double sph_results_share(double part, double whole) {
  return whole > 0 ? sph_results_finite(part / whole) : (double)NAN;
}
