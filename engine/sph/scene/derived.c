/* Values that follow from the inputs of a scene alone. */
#include "engine/sph/scene/derived.h"

#include <math.h>
#include <string.h>

#include "engine/mesh/mesh.h"

enum { PISTON_LAYERS = 4 }; /* thicker than a support: no pair joins the plate and the piston's back */

double sph_derived_wave_speed(const struct sph_body_inputs *b) {
  return sph_material_longitudinal_speed(&b->material, b->strength);
}

bool sph_derived_cracks(const struct sph_body_inputs *b) {
  if (!b->strength || b->fracture == SPH_FRACTURE_OFF)
    return false;
  bool known = !field_is_off(b->material.weibull.m) && !field_is_off(b->material.weibull.k);
  return b->fracture == SPH_FRACTURE_ON || known;
}

bool sph_derived_scene_cracks(const struct sph_inputs *in) {
  return sph_derived_cracks(&in->target) || (sph_derived_has_projectile(in) && sph_derived_cracks(&in->projectile));
}

struct sph_body_physics sph_derived_physics(const struct sph_body_inputs *b, const struct sph_flaws *flaws) {
  struct sph_body_physics physics = {.material = b->material, .strength = b->strength, .flaws = flaws};
  if (field_is_off(b->material.yield.stress))
    physics.material.yield.stress = HUGE_VAL; /* never yields */
  return physics;
}

double sph_derived_density(const struct sph_body_inputs *b) {
  return sph_material_bulk_density(&b->material);
}

bool sph_derived_has_projectile(const struct sph_inputs *in) {
  return in->kind == SPH_IMPACT;
}

bool sph_derived_has_intruder(const struct sph_inputs *in) {
  return in->kind == SPH_IMPACT || in->kind == SPH_PISTON;
}

int sph_derived_bodies(const struct sph_inputs *in) {
  return sph_derived_has_intruder(in) || in->kind == SPH_COLLISION ? 2 : 1;
}

static struct sph_shape shape_of(const struct sph_body_inputs *b) {
  struct sph_shape shape = {.kind = b->shape, .axis = {0, 0, 1}};
  switch ((enum sph_shape_kind)b->shape) {
  case SPH_SHAPE_CYLINDER:
    shape.inner_radius = b->inner_radius;
    shape.length = b->length;
    shape.radius = b->radius;
    break;
  case SPH_SHAPE_SPHERE: shape.radius = b->radius; break;
  case SPH_SHAPE_BOX: memcpy(shape.side, (const double[]){b->width, b->depth, b->height}, sizeof shape.side); break;
  case SPH_SHAPE_MESH: {
    const struct mesh_file *file = mesh_files_find(b->mesh.file);
    shape.mesh = file ? file->mesh : NULL;
    shape.unit = b->mesh.unit;
    break;
  }
  case SPH_SHAPES: break;
  }
  return shape;
}

double sph_derived_shortest_side(const struct sph_body_inputs *body) {
  return fmin(body->width, fmin(body->depth, body->height));
}

double sph_derived_thickness(const struct sph_inputs *in, int direction, double at_least) {
  double spacing = sph_derived_spacing(in), support = 2 * spacing * in->fidelity.smoothing * (1 + in->fidelity.skin);
  return sph_lattice_period(in->target.lattice, spacing, direction, fmax(at_least, 2.1 * support));
}

struct sph_shape sph_derived_target(const struct sph_inputs *in) {
  struct sph_shape shape = shape_of(&in->target);
  if (in->kind == SPH_PISTON) {
    shape.side[1] = sph_derived_thickness(in, 1, in->target.depth);
    shape.side[2] = sph_derived_thickness(in, 2, in->target.height);
  }
  if (in->kind == SPH_COLLISION)
    shape.length = sph_derived_thickness(in, 2, in->target.length);
  return shape;
}

double sph_derived_target_mass(const struct sph_inputs *in) {
  struct sph_shape shape = sph_derived_target(in);
  return sph_derived_density(&in->target) * sph_shape_volume(&shape);
}

struct sph_shape sph_derived_projectile(const struct sph_inputs *in) {
  if (in->impact.projectile == SPH_BY_SIZE)
    return shape_of(&in->projectile);
  double mass = in->impact.mass, speed = in->impact.speed;
  if (in->impact.projectile == SPH_BY_ENERGY)
    mass = 2 * in->impact.specific_energy * sph_derived_target_mass(in) / (speed * speed);
  return (struct sph_shape){.kind = SPH_SHAPE_SPHERE,
                            .axis = {0, 0, 1},
                            .radius = cbrt(3 * mass / (4 * M_PI * sph_derived_density(&in->projectile)))};
}

double sph_derived_projectile_radius(const struct sph_inputs *in) {
  const struct sph_shape projectile = sph_derived_projectile(in);
  return cbrt(3 * sph_shape_volume(&projectile) / (4 * M_PI));
}

struct sph_shape sph_derived_piston(const struct sph_inputs *in) {
  struct sph_shape shape = sph_derived_target(in);
  shape.side[0] = PISTON_LAYERS * sph_derived_spacing(in);
  return shape;
}

double sph_derived_projectile_mass(const struct sph_inputs *in) {
  if (!sph_derived_has_projectile(in))
    return 0;
  struct sph_shape shape = sph_derived_projectile(in);
  return sph_derived_density(&in->projectile) * sph_shape_volume(&shape);
}

double sph_derived_specific_energy(const struct sph_inputs *in) {
  double v = in->impact.speed;
  return sph_derived_has_projectile(in) ? 0.5 * sph_derived_projectile_mass(in) * v * v / sph_derived_target_mass(in)
                                        : (double)NAN;
}

static double longest(const struct sph_shape *shape) {
  if (shape->kind == SPH_SHAPE_MESH) {
    double most = 0;
    for (int k = 0; k < 3 && shape->mesh; k++)
      most = fmax(most, shape->unit * (shape->mesh->high[k] - shape->mesh->low[k]));
    return most;
  }
  if (shape->kind == SPH_SHAPE_SPHERE)
    return 2 * shape->radius;
  if (shape->kind == SPH_SHAPE_CYLINDER)
    return fmax(2 * shape->radius, shape->length);
  return fmax(shape->side[0], fmax(shape->side[1], shape->side[2]));
}

/* Distance (m) by which the projectile must move back along its flight from the plane of the face that it hits, so that
 * no part of a mesh above that plane overlaps it. */
static double back_off(const struct sph_shape shape[2], const double flight[3]) {
  const double up[3] = {0, 0, 1}, most = 4 * (longest(&shape[0]) + longest(&shape[1]));
  const double least = 1e-3 * sph_shape_reach(&shape[1], up);
  struct sph_shape moved = shape[1];
  double back = 0, gap = 0;
  while (back < most && (gap = sph_shape_gap(&shape[0], &moved)) < 0) {
    back += fmax(-gap, least);
    for (int k = 0; k < 3; k++)
      moved.centre[k] = shape[1].centre[k] - back * flight[k];
  }
  return back;
}

status sph_derived_aim(const struct sph_inputs *in, struct sph_shape shape[2], double flight[3], struct error *error) {
  const double angle = in->impact.angle;
  shape[0] = sph_derived_target(in);
  shape[1] = sph_derived_projectile(in);
  memcpy(shape[1].axis, (const double[]){sin(angle), 0, -cos(angle)}, sizeof shape[1].axis);
  status code = sph_bodies_aim(&shape[0], &shape[1], angle, flight,
                               error);            /* in contact; the gap follows, back along the flight */
  if (!code && shape[0].kind == SPH_SHAPE_MESH) { /* its normal is known now, and with it the flight */
    memcpy(shape[1].axis, flight, sizeof shape[1].axis);
    code = sph_bodies_aim(&shape[0], &shape[1], angle, flight, error);
  }
  if (code)
    return code;
  const bool rough = shape[0].kind == SPH_SHAPE_MESH || shape[1].kind == SPH_SHAPE_MESH;
  const double back = rough ? back_off(shape, flight) : 0;
  for (int k = 0; k < 3; k++)
    shape[1].centre[k] -= flight[k] * in->impact.gap / cos(angle) + flight[k] * back;
  return STATUS_OK;
}

double sph_derived_spacing(const struct sph_inputs *in) {
  if (in->kind == SPH_PISTON)
    return in->target.width / (double)in->fidelity.points;
  struct sph_shape shape = shape_of(&in->target);
  return cbrt(sph_shape_volume(&shape) / (double)in->fidelity.particles);
}

bool sph_derived_is_graded(const struct sph_inputs *in) {
  return in->kind == SPH_IMPACT && in->fidelity.graded && in->fidelity.fine_spacing > 0;
}

double sph_derived_fine_spacing(const struct sph_inputs *in) {
  return sph_derived_is_graded(in) ? in->fidelity.fine_spacing : sph_derived_spacing(in);
}

struct sph_grading sph_derived_grading(const struct sph_inputs *in, const struct sph_shape *target) {
  struct sph_grading grading = {.fine = in->fidelity.fine_spacing, .radius = in->fidelity.fine_radius, .growth = NAN};
  double normal[3];
  sph_shape_top(target, grading.point, normal);
  return grading;
}

double sph_derived_coarsest_spacing(const struct sph_inputs *in) {
  const struct sph_shape target = sph_derived_target(in);
  if (!sph_derived_is_graded(in) || !(sph_shape_volume(&target) > 0))
    return sph_derived_spacing(in);
  return sph_irregular_coarsest(sph_derived_grading(in, &target), &target, (double)in->fidelity.particles);
}

double sph_derived_asked_spacing(const struct sph_inputs *in) {
  const double asked = sph_derived_projectile_radius(in) / in->fidelity.spacings_per_radius;
  const struct sph_shape target = sph_derived_target(in);
  if (field_is_off(in->fidelity.coarsest) || !(sph_shape_volume(&target) > 0 && asked > 0))
    return asked;
  struct sph_grading grading = sph_derived_grading(in, &target);
  grading.fine = asked;
  return sph_irregular_finest(grading, &target, (double)in->fidelity.particles, in->fidelity.coarsest);
}

void sph_derived_tell_unkept(const void *inputs, FILE *out) {
  const struct sph_inputs *in = inputs;
  const double asked = sph_derived_projectile_radius(in) / in->fidelity.spacings_per_radius;
  const struct sph_shape target = sph_derived_target(in);
  if (!(in->kind == SPH_IMPACT && in->fidelity.graded && in->fidelity.coarsest > 0 &&
        in->fidelity.fine_spacing > asked * (1 + 1e-9)))
    return;
  struct sph_grading grading = sph_derived_grading(in, &target);
  grading.fine = asked;
  fprintf(out, ": fidelity.coarsest %.3g allows the %.3g of spacings_per_radius from %.0f particles on",
          in->fidelity.coarsest, in->fidelity.spacings_per_radius,
          sph_irregular_least(grading, &target, in->fidelity.coarsest));
}

double sph_derived_smallest_spacing(const struct sph_inputs *in) {
  double fine = sph_derived_fine_spacing(in);
  return sph_derived_has_projectile(in) ? fmin(fine, fine * in->fidelity.projectile_spacing) : fine;
}

double sph_derived_cfl(const struct sph_inputs *in) {
  const double growth = pow(2.1, 4) * 0.35, damping = 0.08 * in->viscosity.alpha;
  const double
      e_folds = 1; /* of a wave without viscosity, until the end of the run: a coarse lattice has it from the start */
  double speed = sph_derived_wave_speed(&in->target);
  if (sph_derived_has_projectile(in))
    speed = fmax(speed, sph_derived_wave_speed(&in->projectile));
  const double lengths = in->stop.end_time * speed / (in->fidelity.smoothing * sph_derived_smallest_spacing(in));
  const double share = cbrt((damping + (lengths > 0 ? e_folds / lengths : 0)) / growth); /* dt c_L/h */
  return fmax(SPH_INPUTS_LEAST_CFL, fmin(SPH_INPUTS_CFL, share * (1 + 0.6 * in->viscosity.alpha)));
}

double sph_derived_particles(const struct sph_inputs *in) {
  double target = (double)in->fidelity.particles;
  if (in->kind == SPH_COLLISION) {
    const struct sph_shape body = sph_derived_target(in);
    return 2 * sph_shape_volume(&body) / pow(sph_derived_spacing(in), 3);
  }
  if (in->kind == SPH_PISTON) {
    struct sph_shape plate = sph_derived_target(in), piston = sph_derived_piston(in);
    return (sph_shape_volume(&plate) + sph_shape_volume(&piston)) / pow(sph_derived_spacing(in), 3);
  }
  if (!sph_derived_has_projectile(in))
    return target;
  struct sph_shape shape = sph_derived_projectile(in);
  double spacing = sph_derived_fine_spacing(in) * in->fidelity.projectile_spacing;
  return target + sph_shape_volume(&shape) / (spacing * spacing * spacing);
}

double sph_derived_arrival(const struct sph_inputs *in) {
  if (in->kind == SPH_IMPACT && in->impact.speed > 0)
    return in->impact.gap / (in->impact.speed * cos(in->impact.angle));
  return in->kind == SPH_COLLISION ? in->collision.gap / in->collision.speed : 0;
}

double sph_derived_approach(const struct sph_inputs *in) {
  if (!in->target.strength)
    return NAN;
  const double waves = sph_derived_wave_speed(&in->target);
  if (in->kind == SPH_COLLISION)
    return in->collision.speed / waves;
  if (in->kind != SPH_IMPACT || !in->projectile.strength)
    return NAN;
  return in->impact.speed / fmin(waves, sph_derived_wave_speed(&in->projectile));
}

double sph_derived_crossing(const struct sph_inputs *in) {
  struct sph_shape shape = sph_derived_target(in);
  double extent = in->kind == SPH_COLLISION ? 2 * shape.radius : longest(&shape);
  return extent / sph_derived_wave_speed(&in->target);
}

/* Period of the first mode of a free bar of length L and thickness h: 2 pi sqrt(12)/4.730^2 L^2/(h c) (Rayleigh, Theory
 * of Sound, chapter VIII). */
double sph_derived_quiet_time(const struct sph_inputs *in) {
  const struct sph_shape shape = sph_derived_target(in);
  const double waves = 2 * sph_derived_crossing(in), slenderness = longest(&shape) / sph_shape_thinnest(&shape);
  const bool bends = in->kind == SPH_IMPACT && in->sides.far != SPH_FAR_DAMPED && sph_derived_scene_cracks(in);
  return bends ? fmax(waves, 0.97 / 2 * slenderness * sph_derived_crossing(in)) : waves;
}
