/* Conditions under which results of engine sph are valid (engine/condition.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/mesh/mesh.h"
#include "engine/sph/material/palpha.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "engine/vector3.h"

#define BEFORE(name, ...) CONDITION_BEFORE(struct sph_inputs, name, __VA_ARGS__)
#define AFTER(name, ...)  CONDITION_AFTER(struct sph_inputs, struct sph_run, struct sph_results, name, __VA_ARGS__)
#define ONLY              CONDITION_ONLY

static bool is_porous(const struct sph_body_inputs *body) {
  return body->material.palpha.curve != SPH_CRUSH_NONE && body->material.palpha.distention > 1;
}

/* J: the energy put in without the common motion. */
static double available(const struct sph_run *run) {
  const struct sph_ledger ledger = sph_system_ledger(run->system);
  return sph_run_energy_available(run, &ledger);
}

/* ---- the integration ---- */

AFTER(drift, r->outcome->energy_error)

BEFORE(courant, in->fidelity.cfl)

BEFORE(courant_undamped, ONLY(sph_derived_cfl(in) < SPH_INPUTS_CFL, courant(in) / sph_derived_cfl(in)))

AFTER(clamped, results->clamped_share)

AFTER(held, results->density_held_share)

AFTER(angular, results->angular_momentum_error)

/* Ratio of the densities of target and projectile; 1 where it causes no error. */
static double contrast(const void *inputs) {
  const struct sph_inputs *in = inputs;
  if (!sph_derived_has_projectile(in) || in->method.volume_weights)
    return 1;
  const double target = sph_derived_density(&in->target), projectile = sph_derived_density(&in->projectile);
  return fmax(target, projectile) / fmin(target, projectile);
}

/* ---- too few particles for the number ---- */

BEFORE(smoothing, in->gradient_correction.on ? (double)NAN : in->fidelity.smoothing)

/* Radius of the projectile over the coarser spacing of both bodies. The radius is that of the sphere of the
 * projectile's volume; of a plate, rod or tube, that of the sphere of the volume of a cube as wide as its thinnest
 * side. */
static double spacings(const void *inputs) {
  const struct sph_inputs *in = inputs;
  if (!sph_derived_has_projectile(in))
    return NAN;
  const struct sph_shape projectile = sph_derived_projectile(in);
  const double radius = fmin(sph_derived_projectile_radius(in), cbrt(3 / (4 * M_PI)) * sph_shape_thinnest(&projectile));
  return radius / (sph_derived_fine_spacing(in) * fmax(1, in->fidelity.projectile_spacing));
}

/* m: the edge of a cube of its volume. */
static double size_of(const struct sph_shape shape) {
  return cbrt(sph_shape_volume(&shape));
}

static double wall(const struct sph_body_inputs *body) {
  return body->radius - body->inner_radius;
}

/* Spacings through the wall of colliding rings, or through the radius of cylinders. */
BEFORE(layers, ONLY(in->kind == SPH_COLLISION, wall(&in->target) / sph_derived_spacing(in)))

/* m: the spacing by which a target as a whole is resolved, the coarsest one. A half-space is resolved where it is hit:
 * its far part only lets waves out. */
static double whole_spacing(const struct sph_inputs *in) {
  return in->sides.far == SPH_FAR_DAMPED ? sph_derived_fine_spacing(in) : sph_derived_coarsest_spacing(in);
}

/* Spacings through the thinnest side of the target. */
static double thickness(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_shape target = sph_derived_target(in);
  return in->kind == SPH_COLLISION || in->kind == SPH_PISTON ? (double)NAN
                                                             : sph_shape_thinnest(&target) / whole_spacing(in);
}

static double dust(const void *inputs) {
  const struct sph_inputs *in = inputs;
  if (!sph_derived_has_projectile(in) && !sph_derived_scene_cracks(in))
    return NAN;
  const double spacing = whole_spacing(in);
  return in->fragments.dust_mass / (sph_derived_density(&in->target) * spacing * spacing * spacing);
}

static bool graded(const void *inputs) {
  return sph_derived_is_graded(inputs);
}

/* Of a whole body 0 is right. In a graded body the coarse particles may all have stayed in the largest fragment. */
AFTER(dust_of_pieces,
      ONLY(r->outcome->fragment_count > 1, graded(in) ? in->fragments.dust_mass / run->heaviest_off : dust(in)))

AFTER(largest, r->outcome->largest_fraction * r->outcome->total_mass / r->outcome->complete_mass)

/* Distance over the spacing up to which particles at rest belong together, over the distance of nearest neighbours: of
 * irregular bodies, the distance from which all particles hang together (1.07 spacings with 300 particles, 1.11 with
 * 10 000). */
BEFORE(reach, in->fragments.link_length * in->fidelity.smoothing /
                  (in->target.lattice == SPH_LATTICE_CUBIC ? 1 : 1.122462048309373))

/* Width of the cells over the edge of a cube of the target's volume. */
BEFORE(cells, ONLY(in->crack_cell.width > 0 && sph_derived_scene_cracks(in),
                   in->crack_cell.width / size_of(sph_derived_target(in))))

/* Width of the cells over the spacing of the target as a whole. */
BEFORE(narrow, ONLY(in->crack_cell.width > 0 && sph_derived_scene_cracks(in), in->crack_cell.width / whole_spacing(in)))

/* The larger of both viscosities over the largest usual one. With reconstruction a smooth flow feels none of it. */
BEFORE(viscous, fmax(in->viscosity.alpha / 2, in->viscosity.beta / 6) /
                    (in->reconstruction.on && in->gradient_correction.on ? 2 : 1))

BEFORE(liquid, in->kind == SPH_IMPACT && !in->target.strength)

BEFORE(soft, in->kind == SPH_VIBRATION && (!in->gradient_correction.on || in->target.turned))

BEFORE(sampled, ONLY(in->kind == SPH_VIBRATION,
                     SPH_SAMPLES *(2 * in->target.length / sph_derived_wave_speed(&in->target)) / in->stop.end_time))

/* Whole pores widen no further in tension (material/palpha.h). */
BEFORE(uneven,
       in->kind == SPH_VIBRATION && is_porous(&in->target) && !field_is_off(in->target.material.palpha.sound_speed))

BEFORE(stout,
       ONLY(in->kind == SPH_VIBRATION && in->target.shape == SPH_SHAPE_CYLINDER, in->target.radius / in->target.length))

AFTER(cracked, ONLY(in->kind == SPH_VIBRATION, results->mean_damage))

/* The largest tension in the middle of the bar, in an elastic bar that has its energy, over that which is cut off. */
static double torn(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_material *material = &in->target.material;
  const double stress = in->vibration.speed *
                        sqrt(sph_material_young_modulus(material) * sph_derived_density(&in->target));
  return in->kind == SPH_VIBRATION && in->target.strength ? stress / 3 / material->tension_limit.pressure : (double)NAN;
}

BEFORE(amplitude, ONLY(in->kind == SPH_VIBRATION, in->vibration.speed / sph_derived_wave_speed(&in->target)))

/* The same distance, over that of the second neighbours. */
BEFORE(reach_too_far, reach(in) / sqrt(2))

AFTER(reach_of_start, run->has_gaps ? 0 : 2)

/* Bytes behind the last triangle of the bodies' shape files. */
static double tail(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_shape target = sph_derived_target(in), projectile = sph_derived_projectile(in);
  return (double)((target.mesh ? target.mesh->tail : 0) +
                  (sph_derived_has_projectile(in) && projectile.mesh ? projectile.mesh->tail : 0));
}

/* ---- plates ---- */

static double compression(const void *inputs) {
  const struct sph_inputs *in = inputs;
  struct sph_plane_shock exact;
  if (in->kind != SPH_PISTON || sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL) ||
      !exact.has_shock)
    return NAN;
  return exact.shock.density / exact.first_density;
}

AFTER(leaks, ONLY(in->kind == SPH_PISTON && sph_plate_leaks(run), HUGE_VAL))

/* End of the run over the time at which the first front reaches the far side. */
static double arrival(const void *inputs) {
  const struct sph_inputs *in = inputs;
  struct sph_plane_shock exact;
  if (in->kind != SPH_PISTON || sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL))
    return NAN;
  const double speed = exact.has_precursor ? exact.precursor.speed : exact.shock.speed;
  return in->stop.end_time * speed / in->target.width;
}

/* The larger of the errors of pressure and speed of the shock. A plateau that was not found is wrong, too. */
static double plateau(const struct condition_run *r) {
  const struct sph_run *run = r->run;
  if (run->inputs.kind != SPH_PISTON || !run->exact.has_shock)
    return NAN;
  const struct sph_results *results = r->results;
  const double pressure = fabs(results->shock.pressure / results->shock.pressure_exact - 1),
               speed = fabs(results->shock.speed / results->shock.speed_exact - 1);
  return isnan(pressure + speed) ? HUGE_VAL : fmax(pressure, speed);
}

AFTER(precursor, fmax(fabs(results->precursor.speed / results->precursor.speed_exact - 1),
                      fabs(results->precursor.pressure / results->precursor.pressure_exact - 1)))

/* ---- waves in bodies ---- */

/* Width of a crushing shock over the shortest extent of the porous bodies; the narrower of them. The linear viscosity
 * alpha c h, with the speed c of the wave along the crush curve, which is about that of the shock, balances it over a
 * width of 2 alpha h. */
static double front(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const double spacings = 2 * in->viscosity.alpha * in->fidelity.smoothing;
  double share = NAN;
  if ((in->kind == SPH_IMPACT || in->kind == SPH_COLLISION) && is_porous(&in->target)) {
    const bool box = in->target.shape == SPH_SHAPE_BOX, turned = in->kind == SPH_COLLISION;
    share = spacings * whole_spacing(in) /
            (turned ? 2 * wall(&in->target)
             : box  ? sph_derived_shortest_side(&in->target)
                    : size_of(sph_derived_target(in)));
  }
  if (sph_derived_has_projectile(in) && is_porous(&in->projectile))
    share = fmax(share, spacings * sph_derived_fine_spacing(in) * in->fidelity.projectile_spacing /
                            size_of(sph_derived_projectile(in)));
  return share;
}

/* ---- strength ---- */

/* Pa: the stress at which a rod breaks by Grady and Kipp's law at its rate; at least that of its weakest flaw. */
static double lawful_strength(const struct sph_inputs *in) {
  const struct sph_material *material = &in->target.material;
  const double m = material->weibull.m, k = material->weibull.k, speed = sph_material_crack_speed(material);
  const double alpha = 8 * M_PI * k * speed * speed * speed / ((m + 1) * (m + 2) * (m + 3));
  const double strain = (m + 3) * pow(m + 4, -(m + 4) / (m + 3)) * pow(alpha, -1 / (m + 3)) *
                        pow(in->stretch.rate, 3 / (m + 3));
  const struct sph_shape rod = sph_derived_target(in);
  return sph_material_young_modulus(material) * fmax(strain, pow(k * sph_shape_volume(&rod), -1 / m));
}

static bool is_rod_with_flaws(const struct sph_inputs *in) {
  return in->kind == SPH_STRETCH && sph_derived_cracks(&in->target);
}

/* The strength that particles of their own flaws will have is about 0.7 of the stress that opens one flaw in each of
 * them: measured for m of 4 to 8.5 and 1500 to 50 000 particles, also for cells. */
static void both_strengths(const void *inputs, double both[2]) {
  const struct sph_inputs *in = inputs;
  const double own = pow(fmax(sph_derived_spacing(in), in->crack_cell.width), 3);
  both[0] = 0.7 * sph_material_young_modulus(&in->target.material) *
            pow(in->target.material.weibull.k * own, -1 / in->target.material.weibull.m);
  both[1] = lawful_strength(in);
}

static double strength_before(const void *inputs) {
  double both[2];
  if (!is_rod_with_flaws(inputs))
    return NAN;
  both_strengths(inputs, both);
  return both[0] / both[1];
}

AFTER(strength_after, ONLY(is_rod_with_flaws(in), results->peak.stress / lawful_strength(in)))

/* ---- contact ---- */

BEFORE(approach, ONLY(in->contact.rule == SPH_CONTACT_WELDED, sph_derived_approach(in)))

/* The same, of a target that stays whole. */
AFTER(approach_of_whole, ONLY(in->kind == SPH_IMPACT && results->mean_damage < 0.1, approach(in)))

/* ---- what a result needs to have happened ---- */

/* stop.quiet_time over the time in which a wave crosses the target. */
BEFORE(quiet,
       ONLY(in->kind != SPH_PISTON && sph_derived_cracks(&in->target), in->stop.quiet_time / sph_derived_crossing(in)))

BEFORE(growth, ONLY(sph_derived_cracks(&in->target), in->stop.quiet_growth))

AFTER(cut, r->outcome->state == OUTCOME_END_TIME)

AFTER(shaped, ONLY(results->shapes.shaped, (double)results->shapes.shaped))

/* The momentum enhancement takes matter of the projectile that does not fly back as if it moved with the rest of the
 * target. The momentum along the normal that this matter has beyond that, over what the projectile brought. */
static double flown(const struct condition_run *r) {
  const struct sph_run *run = r->run;
  const struct sph_inputs *in = &run->inputs;
  const struct sph_particles *now = run->now;
  const struct sph_range target = run->range[0], projectile = run->range[1];
  double mass = 0, momentum = 0, beyond = 0;
  if (in->kind != SPH_IMPACT)
    return NAN;
  const struct sph_crater_options options = sph_report_crater_options(run);
  for (size_t i = target.first; i < target.first + target.n; i++)
    if (!(sph_crater_outwards(now, i, &options) > in->crater.ejection_speed)) {
      mass += now->mass[i];
      momentum += now->mass[i] * sph_crater_outwards(now, i, &options);
    }
  const double kept = mass > 0 ? momentum / mass : 0;
  for (size_t i = projectile.first; i < projectile.first + projectile.n; i++) {
    const double outwards = sph_crater_outwards(now, i, &options);
    if (!(outwards > 0) && !(sph_crater_speed(now, i) < in->crater.escape_speed)) /* slower matter falls back */
      beyond += now->mass[i] * (outwards - kept);
  }
  return fabs(beyond) / (projectile.mass * in->impact.speed * cos(in->impact.angle));
}

/* Ejecta of a body that is whole. */
AFTER(attached, ONLY(r->outcome->fragment_count == 1, results->ejecta.mass_fraction))

/* Has the other body changed the target's momentum? Few particles overlap, and press, later than their surfaces meet.
 */
static bool is_hit(const struct sph_run *run) {
  const struct sph_particles *start = run->start, *now = run->now;
  const double speed = run->inputs.kind == SPH_COLLISION ? run->inputs.collision.speed : run->inputs.impact.speed;
  double gained[3] = {0, 0, 0}, mass = 0;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    gained[0] += now->mass[i] * (now->vx[i] - start->vx[i]);
    gained[1] += now->mass[i] * (now->vy[i] - start->vy[i]);
    gained[2] += now->mass[i] * (now->vz[i] - start->vz[i]);
    mass += now->mass[i];
  }
  return speed > 0 && sqrt(vector3_dot(gained, gained)) > 1e-9 * mass * speed; /* far above rounding, far below a hit */
}

/* The time at which a wave has crossed the target once after the hit, over the simulated time; of a run without damage.
 * With damage the hit alone is needed: a body that spins may break before it. A crater in a half-space needs no wave
 * from the far side. A rod is pulled until it breaks. */
static double unfinished(const struct condition_run *r) {
  const struct sph_inputs *in = r->inputs;
  const struct sph_run *run = r->run;
  const bool broke = !isnan(run->state.first_damage), half_space = in->sides.far == SPH_FAR_DAMPED;
  if (is_rod_with_flaws(in))
    return broke ? (double)NAN : HUGE_VAL;
  if (in->kind != SPH_IMPACT && in->kind != SPH_COLLISION)
    return NAN;
  if (!is_hit(run))
    return HUGE_VAL;
  const double crossing = half_space && !sph_derived_cracks(&in->target) ? 0 : sph_derived_crossing(in);
  return broke ? (double)NAN : (sph_derived_arrival(in) + crossing) / r->outcome->time;
}

/* Energy of the overlap of bodies over what a collision can use: they have not parted yet. */
AFTER(pressing, results->contact.energy / available(r->run))

/* Pieces of bodies of which none cracks, over the number of bodies. */
static double pieces(const struct condition_run *r) {
  const struct sph_inputs *in = r->inputs;
  const struct sph_run *run = r->run;
  const bool fluid = !in->target.strength || (in->kind == SPH_COLLISION && !in->projectile.strength);
  if (sph_derived_scene_cracks(in) || fluid || in->kind == SPH_PISTON || run->has_gaps)
    return NAN;
  return (double)r->outcome->fragment_count / (in->kind == SPH_COLLISION ? 2 : 1);
}

/* The elastic strain that would hold all the energy put in, of a target that cannot crack. */
AFTER(borne, ONLY(in->kind == SPH_IMPACT && !sph_derived_cracks(&in->target),
                  sqrt(2 * available(r->run) / results->target_mass) / sph_derived_wave_speed(&in->target)))

/* The strain at which the weakest flaw of the target opens. */
static double weakest(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_shape target = sph_derived_target(in);
  const struct sph_material *material = &in->target.material;
  return sph_derived_cracks(&in->target)
             ? pow(material->weibull.k * sph_shape_volume(&target), -1 / material->weibull.m)
             : (double)NAN;
}

/* Twice the stress of the target's rotation, over that at which its weakest flaw opens. A body that begins to turn at
 * once rings, and reaches up to twice the stress of a steady rotation: about 0.4 rho omega^2 R^2 at the centre of a
 * sphere (0.37 measured in basalt). */
static double spun(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_body_inputs *target = &in->target;
  const double radius = sph_derived_crossing(in) * sph_derived_wave_speed(target) / 2;
  const double turn = 0.4 * sph_derived_density(target) * pow(target->spin * radius, 2);
  return turn > 0 ? 2 * turn / (sph_material_young_modulus(&target->material) * weakest(in)) : (double)NAN;
}

/* The largest speed along the normal that the rotation gives to the target's surface, over crater.ejection_speed. Only
 * a mesh can have a face of impact across which the axis of rotation (z) is not the normal: else NaN. */
static double tilt(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct sph_shape target = sph_derived_target(in);
  double point[3], frame[3][3];
  if (!(in->target.spin != 0) || !sph_bodies_face(&target, point, frame))
    return NAN;
  if (frame[2][0] == 0 && frame[2][1] == 0)
    return NAN;
  const double one[3] = {frame[2][1], -frame[2][0], 0}, other[3] = {-one[0], -one[1], 0};
  const double speed = fabs(in->target.spin) * fmax(sph_shape_reach(&target, one), sph_shape_reach(&target, other));
  return speed > 0 ? speed / in->crater.ejection_speed : (double)NAN;
}

/* The last stress over the largest one: near 1 the rod still bears its load. */
AFTER(unbroken, ONLY(in->kind == SPH_STRETCH && run->state.frame.samples > 0,
                     run->sample[run->state.frame.samples - 1].stress / run->state.peak_stress))

/* What the material of a rod without flaws bears, von Mises' stress or the tension limit of its pressure, over the peak
 * stress of a rod that failed. */
AFTER(clumped,
      ONLY(!sph_derived_cracks(&in->target) && unbroken(r) < 0.9,
           fmin(fmin(in->target.material.yield.stress, 3 * in->target.material.tension_limit.pressure), HUGE_VAL) /
               run->state.peak_stress))

static int by_number(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The place, m, that this share of a body's particles has behind it along the approach. */
static double place_of(const struct sph_run *run, int body, double share) {
  const size_t n = run->range[body].n;
  double *x = malloc(n * sizeof *x), place = NAN;
  if (x) {
    memcpy(x, run->now->x + run->range[body].first, n * sizeof *x);
    qsort(x, n, sizeof *x, by_number);
    place = x[(size_t)(share * (double)(n - 1))];
  }
  free(x);
  return place;
}

/* Distance of two bodies along their approach, without the 2 % of particles that are nearest to the other body, over
 * the reach of a pair. Below 1 they still act on each other, or have not met. */
AFTER(parted,
      ONLY(in->kind == SPH_COLLISION,
           results->rebound < 0 ? 0 : (place_of(run, 1, 0.02) - place_of(run, 0, 0.98)) / (2 * run->start->h[0])))

/* Depth of the crater over the spacing, where there is one: a hole, matter thrown out or matter pressed together. */
static double shallow(const struct condition_run *r) {
  const struct sph_results *results = r->results;
  const double changed = fmax(fmax(results->ejecta.mass_fraction, results->palpha.compaction.volume),
                              results->crater.depth);
  return changed > 0 ? results->crater.depth / sph_derived_fine_spacing(r->inputs) : (double)NAN;
}

/* The way that the floor of a crater, or a surface that closes its pores, would move in the simulated time once more,
 * as fast as now against the rest of the target; over the depth of the crater, one spacing at least. */
static double growing(const struct condition_run *r) {
  const struct sph_run *run = r->run;
  const struct sph_results *results = r->results;
  if (run->inputs.kind != SPH_IMPACT || !(fmax(results->crater.depth, results->palpha.compaction.volume) > 0))
    return NAN;
  enum { LAYERS = 3 };
  const struct sph_crater_options options = sph_report_crater_options(run);
  struct sph_crater_layer layer[LAYERS];
  const size_t n = sph_crater_profile(run->start, run->now, &options, layer, LAYERS);
  double floor = 0, rest = 0;
  for (size_t k = 0; k < n; k++)
    floor += layer[k].velocity / (double)n;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++)
    rest += run->now->mass[i] * sph_crater_outwards(run->now, i, &options) / run->range[0].mass;
  return n > 0 ? fabs(floor - rest) * r->outcome->time / fmax(results->crater.depth, options.spacing) : (double)NAN;
}

static bool is_damaged(const struct sph_run *run, size_t i) {
  return sph_particles_damage(run->now, i) >= run->inputs.fragments.damage;
}

/* How far undamaged matter of the target has moved (root of the mean square), over the depth of the crater, which is
 * measured from the surface at the start. */
static double moved(const struct condition_run *r) {
  const struct sph_run *run = r->run;
  const struct sph_particles *start = run->start, *now = run->now;
  const struct sph_results *results = r->results;
  const double depth = results->crater.depth;
  double sum = 0, mass = 0;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    if (is_damaged(run, i))
      continue;
    const double way[3] = {now->x[i] - start->x[i], now->y[i] - start->y[i], now->z[i] - start->z[i]};
    sum += now->mass[i] * vector3_dot(way, way);
    mass += now->mass[i];
  }
  const bool held = run->inputs.sides.far == SPH_FAR_DAMPED;
  return depth > 0 && mass > 0 && !held ? sqrt(sum / mass) / depth : (double)NAN;
}

/* Depth of the crater over that of a box with damped sides, or its width over that of the box: the larger one. */
static double wide(const struct condition_run *r) {
  const struct sph_run *run = r->run;
  const struct sph_results *results = r->results;
  if (run->inputs.sides.far != SPH_FAR_DAMPED || !(results->crater.depth > 0))
    return NAN;
  const double *side = run->shape[0].side;
  return fmax(results->crater.depth / side[2], 2 * results->crater.radius / fmin(side[0], side[1]));
}

/* Mean damage of a target without damped sides. */
AFTER(gone, ONLY(in->kind == SPH_IMPACT && in->sides.far != SPH_FAR_DAMPED, results->mean_damage))

/* Mass share of particles of the target for which `is` holds, of those for which `of` holds (NULL: all). */
static double share_of(const struct sph_run *run, bool (*is)(const struct sph_run *run, size_t i),
                       bool (*of)(const struct sph_run *run, size_t i)) {
  double part = 0, whole = 0;
  for (size_t i = run->range[0].first; i < run->range[0].first + run->range[0].n; i++) {
    if (of && !of(run, i))
      continue;
    whole += run->now->mass[i];
    part += is(run, i) ? run->now->mass[i] : 0;
  }
  return whole > 0 ? part / whole : (double)NAN;
}

static bool is_damped(const struct sph_run *run, size_t i) {
  return run->start->damping && run->start->damping[i] > 0;
}

/* Undamaged by its number, but melted (where the material has a melt energy), partly vapour, or vapour that has cooled
 * as it spread: far below its density at rest. */
static bool is_hot_and_whole(const struct sph_run *run, size_t i) {
  const struct sph_material *material = &run->inputs.target.material;
  const double melt = material->melt_energy, most = field_is_off(melt) ? material->tillotson.E_iv : melt;
  return !is_damaged(run, i) &&
         (run->now->energy[i] > most || run->now->density[i] < 0.5 * sph_material_bulk_density(material));
}

AFTER(box, ONLY(in->sides.far == SPH_FAR_DAMPED, share_of(run, is_damaged, is_damped)))

AFTER(hot, ONLY(in->target.strength, share_of(run, is_hot_and_whole, NULL)))

/* ---- inputs without effect ---- */

#define GIVEN(path, value) condition_given(&sph_inputs, path, value)

/* An input of fracture of a scene that cannot crack. */
BEFORE(no_fracture,
       !sph_derived_scene_cracks(in) && in->target.strength &&
           (in->crack_cell.width > 0 || in->crack_front.front != SPH_CRACK_FRONT_NONE ||
            GIVEN("fracture.growth", in->fracture.growth) || GIVEN("fracture.cap", in->fracture.cap) ||
            GIVEN("fracture.crack_radius", in->fracture.crack_radius) || GIVEN("fracture.draw", in->weibull.draw) ||
            GIVEN("fidelity.flaws", in->weibull.flaws) || GIVEN("stop.quiet_growth", in->stop.quiet_growth) ||
            GIVEN("fidelity.damage_step", in->fracture.damage_step) ||
            fabs(in->stop.quiet_time / sph_derived_quiet_time(in) - 1) > 1e-9 || in->fragments.static_strength > 0 ||
            (!is_porous(&in->target) && (in->crack_surfaces.on || GIVEN("fragments.damage", in->fragments.damage)))))

/* A limit of tension of a body with flaws. */
BEFORE(no_limit, (sph_derived_cracks(&in->target) && isfinite(in->target.material.tension_limit.pressure)) ||
                     (sph_derived_has_projectile(in) && sph_derived_cracks(&in->projectile) &&
                      isfinite(in->projectile.material.tension_limit.pressure)))

BEFORE(no_lattice, in->kind == SPH_IMPACT && in->fidelity.graded && in->target.lattice == SPH_LATTICE_CUBIC)

BEFORE(overruled, in->kind == SPH_IMPACT && in->fidelity.graded && sph_derived_has_projectile(in) &&
                      in->fidelity.spacings_per_radius > 0 &&
                      fabs(in->fidelity.fine_spacing / sph_derived_asked_spacing(in) - 1) > 1e-9)

#define SPACINGS 5 /* least number of them in the projectile's radius */

static void tell_spacings(const void *inputs, FILE *out) {
  const struct sph_inputs *in = inputs;
  sph_derived_tell_unkept(inputs, out);
  if (in->kind == SPH_IMPACT && in->fidelity.graded && in->fidelity.spacings_per_radius < SPACINGS)
    fprintf(out, "; spacings_per_radius itself is below %d", SPACINGS);
}

/* fidelity.coarsest bounds what fidelity.spacings_per_radius asks for. */
BEFORE(bounds_nothing, in->kind == SPH_IMPACT && in->fidelity.graded && in->fidelity.coarsest > 0 &&
                           !(sph_derived_has_projectile(in) && in->fidelity.spacings_per_radius > 0))

/* ---- materials ---- */

static double body_moduli(const struct sph_body_inputs *body) {
  const double ratio = sph_material_bulk_modulus(&body->material) / body->material.tillotson.A;
  return body->strength ? fmax(ratio, 1 / ratio) : (double)NAN;
}

static double body_poisson(const struct sph_body_inputs *body) {
  return body->strength ? sph_material_poisson_ratio(&body->material) : (double)NAN;
}

/* The projectile, if its number is beyond the target's (a NaN is not); else the target. */
static const struct sph_body_inputs *worse(const struct sph_inputs *in,
                                           double (*number)(const struct sph_body_inputs *), double sign) {
  const double target = number(&in->target);
  if (!sph_derived_has_projectile(in))
    return &in->target;
  const double projectile = number(&in->projectile);
  return sign * projectile > sign * target || isnan(target) ? &in->projectile : &in->target;
}

BEFORE(moduli, body_moduli(worse(in, body_moduli, 1)))

static void both_moduli(const void *inputs, double both[2]) {
  const struct sph_material *material = &worse(inputs, body_moduli, 1)->material;
  both[0] = sph_material_bulk_modulus(material);
  both[1] = material->tillotson.A;
}

BEFORE(poisson, body_poisson(worse(in, body_poisson, -1)))

static double body_rubbery(const struct sph_body_inputs *body) {
  return sph_derived_cracks(body) ? body_poisson(body) : (double)NAN;
}

BEFORE(rubbery, body_rubbery(worse(in, body_rubbery, 1)))

static void moduli_of(const struct sph_body_inputs *body, double both[2]) {
  both[0] = sph_material_bulk_modulus(&body->material);
  both[1] = body->material.elastic.shear_modulus;
}

static void both_of_poisson(const void *inputs, double both[2]) {
  moduli_of(worse(inputs, body_poisson, -1), both);
}

static void both_of_rubbery(const void *inputs, double both[2]) {
  moduli_of(worse(inputs, body_rubbery, 1), both);
}

/* Compliance of the pores along the elastic branch over that along the crush curve, where the two meet. */
static bool slopes(const struct sph_body_inputs *body, double both[2]) {
  struct sph_palpha_law law;
  if (!is_porous(body) || sph_palpha_prepare(&body->material.palpha, &body->material, &law, NULL))
    return false;
  const double begin = sph_palpha_crush_begin(&law), just_above = begin * (1 + 1e-9) + 1e-9 * law.given.solid_pressure;
  both[0] = fabs(sph_palpha_elastic_slope(&law, sph_palpha_elastic(&law, law.given.distention, begin)));
  both[1] = fabs(sph_palpha_crush_slope(&law, just_above));
  return true;
}

static double body_crush(const struct sph_body_inputs *body) {
  double both[2];
  return slopes(body, both) ? both[0] / both[1] : (double)NAN;
}

BEFORE(crush, body_crush(worse(in, body_crush, 1)))

static void both_slopes(const void *inputs, double both[2]) {
  slopes(worse(inputs, body_crush, 1), both);
}

/* What an impact does to its target. */
#define ALL_OF_AN_IMPACT                                                                                               \
  "fragment_count single_count largest_fraction second_fraction dust_fraction mean_fragment_mass "                     \
  "mean_fragment_mass_rest kinetic_energy_share "                                                                      \
  "first_damage undamaged_fraction mean_damage largest.bare_fraction largest.veneer_fraction "                         \
  "largest.dynamic_fraction largest.axis_middle largest.axis_short largest.speed second.mass second.angle "            \
  "ejecta.mass_fraction ejecta.momentum ejecta.momentum_enhancement crater.depth crater.radius crater.volume "         \
  "crater.compaction_share "                                                                                           \
  "energy.kinetic energy.internal mean_distention compaction.mass_fraction compaction.volume compaction.depth "        \
  "compaction.reach rebound"

#define ALL_OF_A_BODY                                                                                                  \
  "largest_fraction second_fraction dust_fraction undamaged_fraction mean_damage largest.bare_fraction "               \
  "largest.veneer_fraction largest.dynamic_fraction"

#define OF_THE_CRATER "crater.depth crater.radius crater.volume crater.compaction_share"

#define OF_THE_EJECTA "ejecta.mass_fraction ejecta.momentum ejecta.momentum_enhancement"

#define OF_THE_LARGEST                                                                                                 \
  "fragment_count single_count largest_fraction second_fraction mean_fragment_mass mean_fragment_mass_rest "           \
  "largest.veneer_fraction "                                                                                           \
  "largest.dynamic_fraction largest.axis_middle largest.axis_short largest.speed"

const struct condition sph_conditions[] = {
    CONDITION("drift", .number = "the energy error, over the energy put in without the common motion,",
              .bound = CONDITION_LARGEST_DRIFT, .doubt = "numerical errors made or lost more than 1 % of the energy",
              .reason = "our choice; the scene's fidelity.energy_bound may allow more",
              .remedy = "lower fidelity.cfl, or take more particles", .lasting = true, .after = drift),
    CONDITION("step", .number = "fidelity.cfl", .bound = 0.5, .doubt = "energy may drift",
              .reason = "measured (tests/extremes/map.md)", .remedy = "give a cfl of 0.3", .before = courant),
    CONDITION("growth", .number = "fidelity.cfl over its default, which follows from viscosity.alpha,", .bound = 1.25,
              .doubt = "with little viscosity waves as short as the spacing grow, and the energy with them",
              .reason = "growth in a step, and measured (tests/verification/sph_time_step.md)",
              .remedy = "leave out fidelity.cfl", .before = courant_undamped),
    CONDITION(
        "clamped",
        .number =
            "the energy given to cold matter that is held at u = 0, over the energy put in without the common motion,",
        .bound = 0.01, .doubt = "the computation makes energy where matter would have less than none",
        .reason = "as for the energy error", .remedy = "take more particles", .after = clamped),
    CONDITION("held", .number = "the share of particle steps that held the density at its lower limit", .bound = 0.01,
              .doubt = "expanded matter keeps a density that it has not", .reason = "our choice",
              .remedy = "give a lower limit, or end the run earlier", .after = held),
    CONDITION("turn", .number = "the error of the angular momentum", .bound = 0.01,
              .doubt = "a body that turns is strained by the computation, and may break by that",
              .reason = "our choice, as for the energy error", .remedy = "set method.gradient_correction: true",
              .after = angular),
    CONDITION("contrast", .number = "the ratio of the densities of target and projectile without method.volume_weights",
              .bound = 3, .doubt = "energy may drift",
              .reason = "the energy drifts by 1 % in some runs from 3.1 on (tests/extremes/map.md)",
              .remedy = "set method.volume_weights: true", .before = contrast),
    CONDITION(
        "coarse", .number = "the number of particle spacings in the projectile's radius", .bound = SPACINGS,
        .least = true,
        .doubt = "the shock of the impact is not resolved, and all that follows from it moves with the particles",
        .reason =
            "benchmarks of impact codes ask for 10 to 20 (Pierazzo and others 2008, Meteorit. Planet. Sci. 43, 1917)",
        .remedy =
            "take more particles; or, of a scene that is not graded, set fidelity: {graded: true, "
            "spacings_per_radius: 5, projectile_spacing: 1}, and where the scene has a fidelity.fine_spacing, make "
            "that a fifth of the radius; if it takes more particles, a message says how many",
        .results = ALL_OF_AN_IMPACT, .before = spacings, .beside = tell_spacings),
    CONDITION("wall", .number = "the number of particle spacings through the wall of colliding rings or cylinders",
              .bound = 4, .least = true,
              .doubt = "the wall is not resolved, and the speed of the rebound moves with the particles",
              .reason = "rings of 4 come back as fast as those of 5 within 2 % (tests/verification/sph_rings.md)",
              .remedy = "take more particles", .results = ALL_OF_AN_IMPACT, .before = layers),
    CONDITION("thin", .number = "the number of the coarsest particle spacings through the target's thinnest side",
              .bound = 3.5, .least = true,
              .doubt = "most particles lie at a surface, and bending and cracks are not resolved",
              .reason = "a plate of 8 mm that breaks keeps 0.17, 0.28, 0.35 and 0.44 undamaged with 1.2, 2, 3 and 4; "
                        "tensile-rod has 25 cracks with 3.4, and 2 from 4.2 on; half-spaces count by the spacing where "
                        "they are hit",
              .remedy = "take more particles", .before = thickness),
    CONDITION("single", .number = "the mass of the largest fragment over complete_mass, that of 9.5 particles,",
              .bound = 1, .least = true, .doubt = "no fragment is left that the particles resolve",
              .reason = "ten particles are the least that are more than their surface", .remedy = "take more particles",
              .results = OF_THE_LARGEST, .after = largest),
    CONDITION(
        "viscous",
        .number =
            "the larger of viscosity.alpha over 2 and viscosity.beta over 6, half of it with method.reconstruction,",
        .bound = 1, .doubt = "artificial viscosity takes energy from waves that are no shocks",
        .reason =
            "disruption with 2500 particles, seed 1: M_1/M 0.64, 0.71, 0.73 and undamaged 0.39, 0.49, 0.58 with an "
            "alpha of 1.5, 3 and 15; undamaged 0.40 and 0.42 with a beta of 6 and 12",
        .remedy = "leave both out", .before = viscous),
    CONDITION("liquid", .fact = "the target is a liquid (target.strength: false)",
              .doubt = "a liquid is never damaged, so its matter counts as whole", .reason = "damage means cracks",
              .remedy = "use masses of the crater and the ejecta", .results = ALL_OF_A_BODY, .withheld = true,
              .before = liquid),
    CONDITION("dust", .number = "fragments.dust_mass in the heaviest particles", .bound = 2, .least = true,
              .doubt = "dust is then no fragment at all, or single particles",
              .reason = "a fragment of one particle has no strength of its own",
              .remedy = "take more particles, or give a larger fragments.dust_mass", .results = "dust_fraction",
              .withheld = true, .if_so = "such particles come off", .unsure = graded, .before = dust,
              .after = dust_of_pieces),
    CONDITION("uncracked", .number = "the number of pieces of a body without flaws", .bound = 1,
              .doubt = "it cannot crack: its particles have lost their neighbours", .reason = "no flaws, no fragments",
              .remedy = "give the material weibull.m and weibull.k",
              .results = "fragment_count single_count second_fraction dust_fraction mean_fragment_mass "
                         "mean_fragment_mass_rest",
              .after = pieces),
    CONDITION("clumped", .number = "the strength of the material, over the peak stress of a rod without flaws,",
              .bound = 1.1, .doubt = "its particles have parted by an instability of the method in tension",
              .reason = "a rod that breaks by its tension limit has 1.06", .remedy = "raise method.artificial_stress",
              .results = "peak.stress peak.strain peak.time cracks largest_fraction", .after = clumped),
    CONDITION("spin", .number = "twice the stress of the target's rotation, over that which opens its weakest flaw,",
              .bound = 1, .doubt = "it begins to turn without the stress of rotation, rings, and may break by that",
              .reason = "a sphere of basalt reached 1.8 times the stress of its steady rotation, and broke",
              .remedy = "lower target.spin", .results = ALL_OF_A_BODY, .before = spun),
    CONDITION("ideal", .number = "the elastic strain that would hold all the energy put in, of a target without flaws,",
              .bound = 0.1, .doubt = "it cannot crack, and counts as whole: no solid bears so much",
              .reason = "a perfect solid bears about a tenth of its modulus (Orowan's estimate)",
              .remedy = "give the material weibull.m and weibull.k", .results = ALL_OF_A_BODY, .after = borne),
    CONDITION("weakest", .number = "the strain at which the weakest flaw of the target opens", .bound = 0.1,
              .doubt = "it hardly cracks: no rock bears so much", .reason = "rocks crack from 1e-4 to 1e-2 on",
              .remedy = "correct weibull.m or weibull.k: papers print k per cm^3, which is 1e6 per m^3",
              .before = weakest),
    CONDITION("links",
              .number = "the distance up to which particles belong together, over that of neighbours at the start,",
              .bound = 1, .least = true, .doubt = "a whole body counts as many fragments",
              .reason = "geometry of the particles",
              .remedy = "give a larger fragments.link_length: 1.36 over fidelity.smoothing", .before = reach,
              .after = reach_of_start),
    CONDITION("links", .number = "the distance up to which particles belong together, over that of second neighbours,",
              .bound = 1, .doubt = "fragments that lie apart count as one", .reason = "geometry of the particles",
              .remedy = "leave out fragments.link_length", .before = reach_too_far),
    CONDITION("cells", .number = "fracture.cell over the coarsest particle spacing", .bound = 1, .least = true,
              .doubt = "a cell holds one particle or none: each particle cracks by itself, as without cells",
              .reason = "geometry", .remedy = "take more particles, or a larger fracture.cell", .before = narrow),
    CONDITION("cells", .number = "fracture.cell over the cube root of the target's volume", .bound = 0.25,
              .doubt = "cells crack as one: a body of few cells is as strong as one of them, and breaks into them",
              .reason = "our choice: four cells across the body", .remedy = "give a smaller fracture.cell",
              .before = cells),
    CONDITION("soft", .fact = "the bar vibrates without method.gradient_correction, or with target.turned",
              .doubt = "the sides of the bar are too soft",
              .reason =
                  "elastic-bar rings 9 % too low without the correction; turned it rings 6, 2 and 2 % lower with 300, "
                  "2000 and 8000 particles",
              .remedy = "set method.gradient_correction: true and target.turned: false", .results = "frequency",
              .before = soft),
    CONDITION("amplitude", .number = "vibration.speed over the speed of waves", .bound = 0.01,
              .doubt = "the strain is so large that the frequency is not that of small vibrations",
              .reason = "elastic-bar rings as at 0.1 m/s up to 0.0065, and 4 % lower at 0.022",
              .remedy = "lower vibration.speed", .results = "frequency", .before = amplitude),
    CONDITION("amplitude", .number = "the largest tension in the bar (the pressure) over material.tension_limit",
              .bound = 1, .doubt = "the tension of the wave is cut off, and the bar does not ring as an elastic one",
              .reason = "elastic-bar rings at 54.8 kHz with 0.95, at 54.7, 53.9 and 90 with 1.1, 1.3 and 40",
              .remedy = "lower vibration.speed, or set material.tension_limit: off", .results = "frequency",
              .withheld = true, .before = torn),
    CONDITION("cracked", .number = "the mean damage of the bar", .bound = 0, .doubt = "a bar that cracks does not ring",
              .reason =
                  "elastic-bar with flaws rings at 54.8 kHz whole, at 47 and 38 kHz with a damage of 0.05 and 0.1",
              .remedy = "lower vibration.speed", .results = "frequency", .withheld = true, .after = cracked),
    CONDITION("samples", .number = "the number of samples in a period of the bar", .bound = 3, .least = true,
              .doubt = "crossings of zero between two samples are missed",
              .reason = "a bar of basalt rings at 54.8 kHz with 3.6 samples, at 41.7 kHz with 1.8",
              .remedy = "give an earlier stop.end_time: 20 periods are enough", .results = "frequency",
              .withheld = true, .before = sampled),
    CONDITION("uneven", .fact = "the pores of the bar have an elastic branch, on which they narrow but do not widen",
              .doubt = "pressed it is softer than pulled, at any amplitude, and does not ring at one frequency",
              .reason =
                  "elastic-bar of porous-ice and 600 particles gives 26.3, 27.9, 28.4 and 30.0 kHz in 80, 160, 400 and "
                  "1000 us, of 5000 particles 17.8 in 1000; without the branch 35.1 in 80 and 400",
              .remedy = "set porosity.sound_speed: off", .results = "frequency", .withheld = true, .before = uneven),
    CONDITION("stout", .number = "the radius of the bar over its length", .bound = 0.5,
              .doubt = "several motions ring together, and the frequency is that of none",
              .reason = "elastic-bar rings at 55.0, 52.8, 58.7, 56.4 kHz with 0.25, 0.5, 0.75, 1; Rayleigh's law for "
                        "slender bars falls on",
              .remedy = "give a longer target.length", .results = "frequency", .before = stout),
    CONDITION("tail", .number = "the number of bytes in the shape file behind its last triangle", .bound = 0,
              .doubt = "they are not read", .reason = "the header of a binary STL file gives the number of triangles",
              .remedy = "if they are a second body, write each body into a file of its own", .before = tail),
    CONDITION("kernel", .number = "fidelity.smoothing without method.gradient_correction", .bound = 0.9, .least = true,
              .doubt = "stresses and wave speeds are too small, up to 39 %",
              .reason = "a plate's shock is 2.5 % too weak at 0.9, 5 % at 0.85 and 20 % at 0.7",
              .remedy = "give 1.13, or set method.gradient_correction: true", .before = smoothing),
    CONDITION("piston", .number = "the compression by the shock", .bound = 1.8,
              .doubt = "matter of the plate goes through the piston",
              .reason = "compression that four layers of piston hold (tests/verification/sph_palpha_plate.md)",
              .remedy = "lower piston.speed", .if_so = "matter passes the piston", .before = compression,
              .after = leaks),
    CONDITION("arrival", .number = "stop.end_time over the time at which a wave reaches the far side of the plate",
              .bound = 1, .doubt = "speeds and plateaus of the fronts are wrong after that",
              .reason = "the wave comes back", .remedy = "give an earlier stop.end_time, or a larger target.width",
              .before = arrival),
    CONDITION("plateau", .number = "the error of the shock's pressure or speed, beside the exact one,", .bound = 0.02,
              .doubt = "the shock is wider than its plateau, or has not its final form",
              .reason = "the largest error that we allow for a plate of 200 points",
              .remedy = "take more points and a longer plate, or a lower viscosity.alpha",
              .results = "shock.speed shock.density shock.pressure shock.distention", .after = plateau),
    CONDITION("precursor", .number = "the error of the precursor's pressure or speed, beside the exact one,",
              .bound = 0.02, .doubt = "the precursor is wider than its plateau, or has not its final form",
              .reason = "as for the shock", .remedy = "take more points and a longer plate, or a lower viscosity.alpha",
              .results = "precursor.speed precursor.pressure precursor.distention", .after = precursor),
    CONDITION("strength", .number = "the peak stress of the rod, over that of Grady and Kipp's law,", .bound = 1.75,
              .doubt = "every particle must fail by a flaw of its own, so that the strength grows with the number of "
                       "particles as N^(1/m)",
              .reason = "our choice; tensile-rod has 1.4 with 3000 particles and 1.9 with 50 000",
              .remedy = "give fracture.cell, the width of cells that crack as one", .both = both_strengths,
              .unit = "Pa", .before = strength_before, .after = strength_after),
    CONDITION(
        "front", .number = "the width of a shock that closes pores, over the target's extent,", .bound = 0.1,
        .doubt = "the artificial viscosity smears the shock over the body, and too few pores close",
        .reason =
            "pumice-sphere at 3 kJ/kg closes 0.8, 1.3 and 1.7 cm^3 of pores at 0.34, 0.21 and 0.15, and has no limit "
            "in sight",
        .remedy = "take more particles, or a lower viscosity.alpha", .results = ALL_OF_AN_IMPACT, .before = front),
    CONDITION(
        "stick", .number = "the speed of the impact over that of waves", .bound = SPH_DERIVED_SLOW, .least = true,
        .doubt =
            "intact bodies that touch stick together with method.contact: welded, since a pair of two bodies acts as "
            "in one",
        .reason = "two elastic spheres of basalt part with 0.62 of their speed at 0.02, and 0.016 of it at 0.002",
        .remedy = "set method.contact: overlap, with five spacings or more in the projectile's radius",
        .results = ALL_OF_AN_IMPACT, .before = approach),
    CONDITION("stick", .number = "the speed of the impact, over that of waves, on a target that stays whole",
              .bound = 0.2, .least = true,
              .doubt = "bodies stick together with method.contact: welded as long as the target is whole",
              .reason = "two elastic spheres of steel part with 0.4 of the impact's speed at 0.036, and with 0.81 at "
                        "0.145; with method.contact: overlap it is 0.95",
              .remedy = "set method.contact: overlap, with five spacings or more in the projectile's radius",
              .results = ALL_OF_AN_IMPACT, .after = approach_of_whole),
    CONDITION("welded", .number = "the speed of the impact over that of waves, with method.contact: welded,",
              .bound = 0.2, .least = true, .doubt = "debris of two bodies sticks together and loses kinetic energy",
              .reason = "disruption by a ball of basalt at 160 to 600 m/s (0.035 to 0.13) has 6 to 11 % less kinetic "
                        "energy than with method.contact: overlap, and twice the kinetic_energy_share",
              .remedy = "set method.contact: overlap, with five spacings or more in the projectile's radius",
              .results = "energy.kinetic energy.internal kinetic_energy_share", .before = approach),
    CONDITION("quiet", .number = "stop.quiet_time over the time in which a wave crosses the target", .bound = 1,
              .least = true, .doubt = "the run may end before waves have come to all flaws",
              .reason = "after that time all of the body has been loaded once", .remedy = "leave out stop.quiet_time",
              .before = quiet),
    CONDITION("quiet", .number = "stop.quiet_growth", .bound = 0.01,
              .doubt = "the run ends while the body goes on breaking", .reason = "our choice; usual is 0.001",
              .remedy = "leave out stop.quiet_growth", .before = growth),
    CONDITION("cut", .fact = "stop.end_time ended the run while damage grew", .doubt = "more may break after that",
              .reason = "the run's state is end-time", .remedy = "raise stop.end_time", .after = cut),
    CONDITION("early", .number = "the time that a wave needs to cross the body after the hit, over the simulated time,",
              .bound = 1, .doubt = "the run ended before anything could break",
              .reason = "a body can break from the hit until a wave has crossed it",
              .remedy = "give a longer stop.end_time", .after = unfinished),
    CONDITION("pressing",
              .number =
                  "the energy of the overlap of bodies in contact, over the energy put in without the common motion,",
              .bound = 0.01,
              .doubt = "the bodies still press on each other: their speeds, and perhaps the damage, are not final",
              .reason = "spheres that have parted have 0, debris between two bodies has 5e-5",
              .remedy = "give a longer stop.end_time and stop.quiet_time", .after = pressing),
    CONDITION("event", .number = "the last stress over the largest one", .bound = 0.9,
              .doubt = "the rod has not failed: the largest stress so far is no strength", .reason = "our choice",
              .remedy = "give a longer stop.end_time", .results = "peak.stress peak.strain peak.time", .withheld = true,
              .after = unbroken),
    CONDITION("event", .number = "the last stress over the largest one", .bound = 0.9,
              .doubt = "the rod has not failed: it is still one piece, or its cracks are not through",
              .reason = "our choice", .remedy = "give a longer stop.end_time",
              .results = "cracks largest_fraction second_fraction dust_fraction mean_fragment_mass "
                         "mean_fragment_mass_rest undamaged_fraction mean_damage",
              .after = unbroken),
    CONDITION("apart",
              .number =
                  "the distance of the colliding bodies without their debris, over the reach of a pair of particles,",
              .bound = 1, .least = true, .doubt = "the bodies have not parted: their speed is not final",
              .reason = "bodies act on each other up to 2h", .remedy = "give a longer stop.end_time",
              .results = "rebound", .withheld = true, .after = parted),
    CONDITION("shallow", .number = "the depth of the crater in particle spacings", .bound = 2, .least = true,
              .doubt = "the crater is as shallow as the error of its depth, one spacing",
              .reason = "a hole of less than one spacing counts as none",
              .remedy = "take more particles, or fidelity.graded: true where it is false",
              .results = "crater.depth crater.radius crater.volume", .after = shallow),
    CONDITION("growing",
              .number = "how far the floor of the crater would still move in as much time again, over its depth,",
              .bound = 0.1, .doubt = "the crater still grows, and pores still close",
              .reason = "porous-target with 4000 particles: the depth is 18, 4 and 0 % below its final value at 0.16, "
                        "0.10 and 0.001, the volume of closed pores 21, 5 and 0 %",
              .remedy = "give a longer stop.end_time, and stop.quiet_time",
              .results = "crater.depth crater.radius crater.volume crater.compaction_share compaction.mass_fraction "
                         "compaction.volume compaction.depth compaction.reach",
              .after = growing),
    CONDITION("moved", .number = "the way that undamaged matter of the target has moved, over the crater's depth,",
              .bound = 0.2, .doubt = "the target has left the place from which the crater is measured",
              .reason = "our choice: the crater begins at the surface at the start",
              .remedy = "give an earlier stop.end_time", .results = OF_THE_CRATER, .withheld = true, .after = moved),
    CONDITION("shapes", .number = "the number of fragments of 60 particles or more, besides the largest,", .bound = 5,
              .least = true, .doubt = "a mean over so few fragments says nothing of the shapes of all",
              .reason = "our choice: 135 fragments of basalt-sphere scatter by 0.17 in b/a and 0.09 in c/a, means of 5 "
                        "by 0.07 and 0.04",
              .remedy = "take more particles", .results = "fragments.b_over_a fragments.c_over_a", .withheld = true,
              .absent = true, .after = shaped),
    CONDITION("attached", .fact = "matter moves out of the target, which is in one piece",
              .doubt = "nothing has come off: a part of the body moves outwards", .reason = "a fragment that is one",
              .remedy = "raise crater.ejection_speed, or give a longer stop.end_time", .results = OF_THE_EJECTA,
              .after = attached),
    CONDITION("tilt",
              .number =
                  "the speed at which the target's rotation moves its surface along the normal of the face that is "
                  "hit, over crater.ejection_speed,",
              .bound = 1, .doubt = "matter that only turns with the target counts as ejecta",
              .reason = "the axis of rotation is z, and the normal is another",
              .remedy = "raise crater.ejection_speed, or turn the mesh in its file until that face is level",
              .results = OF_THE_EJECTA, .before = tilt),
    CONDITION("flown",
              .number =
                  "the momentum that matter of the projectile keeps beyond that of the target, over all it brought,",
              .bound = 0.02, .doubt = "the projectile does not stay with the target: it has not given all its momentum",
              .reason = "our choice: the number is the error of the result, when all of that matter goes its own way",
              .remedy = "give a longer stop.end_time; a projectile that flies on has no momentum enhancement",
              .results = "ejecta.momentum_enhancement", .withheld = true, .after = flown),
    CONDITION("wide", .number = "the larger of the crater's depth and width over those of the target", .bound = 0.5,
              .doubt = "the crater is as large as the box that stands for a half-space", .reason = "our choice",
              .remedy = "take a larger target", .results = OF_THE_CRATER, .withheld = true, .after = wide),
    CONDITION("gone", .number = "the mean damage of the target", .bound = 0.9,
              .doubt = "no body is left that could have a crater", .reason = "our choice",
              .remedy = "use the fragments", .results = OF_THE_CRATER, .withheld = true, .after = gone),
    CONDITION(
        "box", .number = "the damaged share of the damped sides", .bound = 0.01,
        .doubt =
            "the damage reaches the sides of a box that stands for a half-space, so shares of the mass measure the box",
        .reason = "our choice", .remedy = "take a larger target, and use the crater and the ejecta",
        .results = ALL_OF_A_BODY, .withheld = true, .after = box),
    CONDITION("box", .number = "the damaged share of the damped sides", .bound = 0.01,
              .doubt = "a share of the box's mass depends on the box", .reason = "our choice",
              .remedy = "multiply shares of the mass by target_mass: that does not depend on the box",
              .results = "ejecta.mass_fraction compaction.mass_fraction mean_distention", .after = box),
    CONDITION(
        "hot",
        .number =
            "the mass share of the target that counts as undamaged and is melted, vapour or below half of its density",
        .bound = 0.01, .doubt = "hot matter that never was in tension has no damage, and counts as whole",
        .reason = "our choice", .remedy = "count energies, not damage", .results = ALL_OF_A_BODY, .withheld = true,
        .after = hot),
    CONDITION("effect", .fact = "an input of fracture is given, and no body has flaws",
              .doubt = "it has no effect: nothing cracks", .reason = "they act on flaws, and on the damage of cracks",
              .remedy = "give the material weibull.m and weibull.k, or leave it out",
              .inputs = "fracture.cell fracture.front fracture.growth fracture.cap fracture.crack_radius "
                        "fracture.draw fidelity.flaws fidelity.damage_step stop.quiet_growth stop.quiet_time "
                        "method.crack_surfaces fragments.damage fragments.static_strength",
              .results = "", .before = no_fracture),
    CONDITION("effect", .fact = "material.tension_limit of a body with flaws is given",
              .doubt = "it has no effect: cracks limit the tension", .reason = "engine/sph/modules/tension_limit.h",
              .remedy = "leave it out, or set fracture: off",
              .inputs = "target.material.tension_limit projectile.material.tension_limit", .results = "",
              .before = no_limit),
    CONDITION("effect", .fact = "target.lattice is cubic with fidelity.graded",
              .doubt = "it has no effect: a graded body has irregular points", .reason = "engine/sph/README.md",
              .remedy = "leave it out", .inputs = "target.lattice", .results = "", .before = no_lattice),
    CONDITION("effect", .fact = "fidelity.spacings_per_radius is given beside another fidelity.fine_spacing",
              .doubt = "it has no effect: fidelity.fine_spacing decides",
              .reason = "a value that is given wins over one that follows from others",
              .remedy = "leave one of them out", .inputs = "fidelity.spacings_per_radius", .results = "",
              .before = overruled),
    CONDITION("effect", .fact = "fidelity.coarsest is given without fidelity.spacings_per_radius",
              .doubt = "it has no effect: it bounds what that input asks for", .reason = "engine/sph/README.md",
              .remedy = "give both", .inputs = "fidelity.coarsest", .results = "", .before = bounds_nothing),
    CONDITION("moduli", .number = "the larger over the smaller of material.bulk_modulus and material.tillotson.A",
              .bound = 1.2, .doubt = "waves are as fast as tillotson.A makes them, cracks as bulk_modulus does",
              .reason = "at 1.2 the wave speeds of the two differ by 5 % in a rock of Poisson's ratio 0.25",
              .remedy = "give tillotson.A the measured bulk modulus, and set bulk_modulus: off", .before = moduli,
              .both = both_moduli, .unit = "Pa"),
    CONDITION("poisson", .number = "Poisson's ratio, by material.bulk_modulus and material.shear_modulus,", .bound = 0,
              .least = true, .doubt = "no rock widens when it is pulled", .reason = "K below 2/3 of the shear modulus",
              .remedy = "correct one of them", .before = poisson, .both = both_of_poisson, .unit = "Pa"),
    CONDITION("poisson", .number = "Poisson's ratio of a body that cracks", .bound = 0.45,
              .doubt = "no rock is so near to a liquid", .reason = "rocks have 0.05 to 0.4",
              .remedy = "correct one of them", .before = rubbery, .both = both_of_rubbery, .unit = "Pa"),
    CONDITION("crush",
              .number =
                  "the compliance of the pores on the elastic branch, over that on the crush curve where the two meet,",
              .bound = 1,
              .doubt = "the elastic branch is the softer one, so that shocks follow it and not the crush curve",
              .reason = "pores that close for good give way more",
              .remedy = "raise porosity.sound_speed, or lower porosity.solid_pressure", .before = crush,
              .both = both_slopes, .unit = "1/Pa"),
    {0},
};
