/* Sizes, masses, speeds and times of a scene that follow from the inputs alone. */
#pragma once

#include "engine/sph/body/bodies.h"
#include "engine/sph/scene/inputs.h"
#include "engine/sph/step/system.h"

bool sph_derived_has_projectile(const struct sph_inputs *inputs);
int sph_derived_bodies(const struct sph_inputs *inputs);
/* Is there a second body that belongs to no fragment, a projectile or a piston? Its ids follow the target's. */
bool sph_derived_has_intruder(const struct sph_inputs *inputs);
/* Does the body crack? With fracture: auto it does if the material has Weibull's m and k. */
bool sph_derived_cracks(const struct sph_body_inputs *body);
bool sph_derived_scene_cracks(const struct sph_inputs *inputs); /* does one of its bodies? */
/* The physics of a body for the moving system. */
struct sph_body_physics sph_derived_physics(const struct sph_body_inputs *body, const struct sph_flaws *flaws);
double sph_derived_density(const struct sph_body_inputs *body);       /* kg/m^3, bulk */
double sph_derived_wave_speed(const struct sph_body_inputs *body);    /* m/s, longitudinal */
double sph_derived_shortest_side(const struct sph_body_inputs *body); /* m, of a box */
/* Outlines of target and projectile (of the size that impact.projectile selects), both at the origin. */
struct sph_shape sph_derived_target(const struct sph_inputs *inputs);
struct sph_shape sph_derived_projectile(const struct sph_inputs *inputs);
double sph_derived_projectile_radius(const struct sph_inputs *inputs); /* m, of the sphere of its volume */
struct sph_shape sph_derived_piston(const struct sph_inputs *inputs);  /* outline of the piston, at the origin */
/* Thickness, m, of a body that repeats along y or z (direction 1 or 2): whole periods of the target's lattice, not less
 * than `at_least`, and thick enough that no particle meets its own image. */
double sph_derived_thickness(const struct sph_inputs *inputs, int direction, double at_least);
double sph_derived_target_mass(const struct sph_inputs *inputs);      /* kg */
double sph_derived_projectile_mass(const struct sph_inputs *inputs);  /* kg; 0 without one */
double sph_derived_spacing(const struct sph_inputs *inputs);          /* m, of the target: (V/n)^(1/3) */
bool sph_derived_is_graded(const struct sph_inputs *inputs);          /* have the target's particles several masses? */
double sph_derived_fine_spacing(const struct sph_inputs *inputs);     /* m, of the target where the projectile hits */
double sph_derived_coarsest_spacing(const struct sph_inputs *inputs); /* m, of the target where it is largest */
/* m, the fine spacing of fidelity.spacings_per_radius, or what fidelity.coarsest leaves of it */
double sph_derived_asked_spacing(const struct sph_inputs *inputs);
/* Prints ": why this is coarser than fidelity.spacings_per_radius asks, and from how many particles on it is not". */
void sph_derived_tell_unkept(const void *inputs, FILE *out);
/* About the point of impact on a target that is graded. */
struct sph_grading sph_derived_grading(const struct sph_inputs *inputs, const struct sph_shape *target);
double sph_derived_particles(const struct sph_inputs *inputs); /* of all bodies; an estimate for plans */
/* s, until the bodies of an impact or collision meet; 0 for scenes without a gap. */
double sph_derived_arrival(const struct sph_inputs *inputs);
/* Speed at which two bodies meet over that of waves in the softer one; NaN unless both have strength. Below
 * SPH_DERIVED_SLOW bodies that are welded on contact stick: elastic spheres of basalt part with 0.62 of their speed at
 * 0.02. */
double sph_derived_approach(const struct sph_inputs *inputs);
#define SPH_DERIVED_SLOW 0.03
double sph_derived_crossing(const struct sph_inputs *inputs); /* s, of a wave through the target's longest extent */
/* s: no growth of damage for so long ends a run. Waves have crossed the target twice; one that is hit and slender has
 * also bent there and back once, half a period. */
double sph_derived_quiet_time(const struct sph_inputs *inputs);
double sph_derived_smallest_spacing(const struct sph_inputs *inputs); /* m, of all bodies */
/* Largest Courant number, at most SPH_INPUTS_CFL, at which waves as short as the spacing grow by a factor of e at most
 * until stop.end_time. The step lets a wave of frequency w grow by (w dt)^4/4 in a step [its matrix of growth], with w
 * = 2.1 c_L/h for the shortest one; viscosity damps it by about 0.08 alpha c_L dt/h.
 * tests/verification/sph_time_step.md */
double sph_derived_cfl(const struct sph_inputs *inputs);
/* Target and projectile at the start, and the unit direction of flight. The projectile hits the target where the normal
 * is z; the angle between flight and normal is impact.angle, whatever the gap. STATUS_CONTENT. */
status sph_derived_aim(const struct sph_inputs *inputs, struct sph_shape shape[2], double flight[3],
                       struct error *error);
/* Specific impact energy Q = (m v^2 / 2) / M, J/kg; NaN without an impact. */
double sph_derived_specific_energy(const struct sph_inputs *inputs);
