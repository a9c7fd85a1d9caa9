/* Inputs that follow from others, and numbers that follow from the inputs alone. */
#include <math.h>
#include <string.h>

#include "engine/builtin.h"
#include "engine/sph/inputs.h"
#include "engine/sph/materials.h"

static const double pi = 3.14159265358979323846;

/* ---- numbers of materials and bodies ---- */

double sph_inputs_bulk_modulus(const struct sph_material *m) {
  return field_is_off(m->bulk_modulus) ? m->tillotson.A : m->bulk_modulus;
}

double sph_inputs_young_modulus(const struct sph_material *m) {
  double K = sph_inputs_bulk_modulus(m);
  return 9 * K * m->shear_modulus / (3 * K + m->shear_modulus);
}

double sph_inputs_poisson_ratio(const struct sph_material *m) {
  double K = sph_inputs_bulk_modulus(m);
  return (3 * K - 2 * m->shear_modulus) / (2 * (3 * K + m->shear_modulus));
}

double sph_inputs_wave_speed(const struct sph_body_inputs *b) { /* pressure answers with A, whatever K says */
  double modulus = b->material.tillotson.A + (b->strength ? 4.0 / 3 * b->material.shear_modulus : 0);
  return sqrt(modulus / b->material.density);
}

double sph_inputs_crack_speed(const struct sph_material *m) {
  return 0.4 * sqrt((sph_inputs_bulk_modulus(m) + 4.0 / 3 * m->shear_modulus) / m->density);
}

bool sph_inputs_cracks(const struct sph_body_inputs *b) {
  if (!b->strength || b->fracture == SPH_FRACTURE_OFF)
    return false;
  bool known = !field_is_off(b->material.weibull.m) && !field_is_off(b->material.weibull.k);
  return b->fracture == SPH_FRACTURE_ON || known;
}

bool sph_inputs_has_projectile(const struct sph_inputs *in) { return in->kind == SPH_IMPACT; }

int sph_inputs_bodies(const struct sph_inputs *in) { return in->kind == SPH_IMPACT || in->kind == SPH_COLLISION ? 2 : 1; }

static struct sph_shape shape_of(const struct sph_body_inputs *b) {
  struct sph_shape shape = {.kind = b->shape, .axis = {0, 0, 1}};
  switch ((enum sph_shape_kind)b->shape) {
  case SPH_SHAPE_CYLINDER:
    shape.inner_radius = b->inner_radius;
    shape.length = b->length;
    shape.radius = b->radius;
    break;
  case SPH_SHAPE_SPHERE:
    shape.radius = b->radius;
    break;
  case SPH_SHAPE_BOX:
    memcpy(shape.side, (const double[]){b->width, b->depth, b->height}, sizeof shape.side);
    break;
  }
  return shape;
}

struct sph_shape sph_inputs_target(const struct sph_inputs *in) { return shape_of(&in->target); }

double sph_inputs_target_mass(const struct sph_inputs *in) {
  struct sph_shape shape = sph_inputs_target(in);
  return in->target.material.density * sph_shape_volume(&shape);
}

struct sph_shape sph_inputs_projectile(const struct sph_inputs *in) {
  if (in->impact.projectile == SPH_BY_SIZE)
    return shape_of(&in->projectile);
  double mass = in->impact.mass, speed = in->impact.speed;
  if (in->impact.projectile == SPH_BY_ENERGY)
    mass = 2 * in->impact.specific_energy * sph_inputs_target_mass(in) / (speed * speed);
  return (struct sph_shape){.kind = SPH_SHAPE_SPHERE, .axis = {0, 0, 1},
                            .radius = cbrt(3 * mass / (4 * pi * in->projectile.material.density))};
}

double sph_inputs_projectile_mass(const struct sph_inputs *in) {
  if (!sph_inputs_has_projectile(in))
    return 0;
  struct sph_shape shape = sph_inputs_projectile(in);
  return in->projectile.material.density * sph_shape_volume(&shape);
}

double sph_inputs_specific_energy(const struct sph_inputs *in) {
  double v = in->impact.speed;
  return sph_inputs_has_projectile(in) ? 0.5 * sph_inputs_projectile_mass(in) * v * v / sph_inputs_target_mass(in) : (double)NAN;
}

double sph_inputs_spacing(const struct sph_inputs *in) {
  struct sph_shape shape = sph_inputs_target(in);
  return cbrt(sph_shape_volume(&shape) / (double)in->fidelity.particles);
}

double sph_inputs_fine_spacing(const struct sph_inputs *in) {
  bool graded = in->kind == SPH_IMPACT && in->fidelity.graded && in->fidelity.fine_spacing > 0;
  return graded ? in->fidelity.fine_spacing : sph_inputs_spacing(in);
}

double sph_inputs_smallest_spacing(const struct sph_inputs *in) {
  double fine = sph_inputs_fine_spacing(in);
  return sph_inputs_has_projectile(in) ? fmin(fine, fine * in->fidelity.projectile_spacing) : fine;
}

double sph_inputs_particles(const struct sph_inputs *in) {
  double target = (double)in->fidelity.particles;
  if (in->kind == SPH_COLLISION)
    return 2 * target;
  if (!sph_inputs_has_projectile(in))
    return target;
  struct sph_shape shape = sph_inputs_projectile(in);
  double spacing = sph_inputs_fine_spacing(in) * in->fidelity.projectile_spacing;
  return target + sph_shape_volume(&shape) / (spacing * spacing * spacing);
}

static double longest(const struct sph_shape *shape) {
  if (shape->kind == SPH_SHAPE_SPHERE)
    return 2 * shape->radius;
  if (shape->kind == SPH_SHAPE_CYLINDER)
    return fmax(2 * shape->radius, shape->length);
  return fmax(shape->side[0], fmax(shape->side[1], shape->side[2]));
}

double sph_inputs_crossing(const struct sph_inputs *in) {
  struct sph_shape shape = sph_inputs_target(in);
  double extent = in->kind == SPH_COLLISION ? 2 * shape.radius : longest(&shape);
  return extent / sph_inputs_wave_speed(&in->target);
}

/* ---- what was not given ---- */

#define FREE(member) (!given[row_at(offsetof(struct sph_inputs, member))])

static size_t row_at(size_t offset) {
  size_t row = 0;
  while (sph_inputs.rows[row].offset != offset)
    row++;
  return row;
}

/* The values of the named material, but for those that the scene gives. */
static void complete_material(struct sph_inputs *in, struct sph_body_inputs *body, const char *fallback, const bool *given) {
  struct sph_material material;
  size_t name = (size_t)((char *)&body->material_name - (char *)in), first = (size_t)((char *)&body->material - (char *)in);
  if (!given[row_at(name)])
    for (body->material_name = 0; strcmp(builtin_material_names[body->material_name], fallback) != 0;)
      body->material_name++;
  if ((size_t)body->material_name >= sph_materials_count() ||
      sph_materials_load(builtin_material_names[body->material_name], &material, NULL))
    field_defaults(&sph_materials_table, &material); /* custom: none */
  for (size_t i = 0; i < sph_inputs.count; i++) {
    size_t offset = sph_inputs.rows[i].offset;
    if (!given[i] && offset >= first && offset < first + sizeof material)
      memcpy((char *)in + offset, (char *)&material + (offset - first), sizeof(double));
  }
}

/* Young's modulus times the mean strength of the weakest of kV flaws: Gamma(1 + 1/m) (kV)^(-1/m). */
static double static_strength(const struct sph_inputs *in) {
  if (!sph_inputs_cracks(&in->target))
    return NAN;
  struct sph_shape shape = sph_inputs_target(in);
  double m = in->target.material.weibull.m;
  double log_strain = lgamma(1 + 1 / m) - (log(in->target.material.weibull.k) + log(sph_shape_volume(&shape))) / m;
  double strength = sph_inputs_young_modulus(&in->target.material) * exp(log_strain);
  return strength > 0 && strength <= 1e15 ? strength : (double)NAN;
}

void sph_inputs_complete(struct sph_inputs *in, const bool *given) {
  complete_material(in, &in->target, "basalt", given);
  complete_material(in, &in->projectile, "nylon", given);
  double spacing = sph_inputs_spacing(in), crossing = sph_inputs_crossing(in);
  if (FREE(sides.depth))
    in->sides.depth = 0.1 * fmin(in->target.width, fmin(in->target.depth, in->target.height));
  if (FREE(fidelity.fine_spacing))
    in->fidelity.fine_spacing = 0.5 * spacing;
  if (FREE(fidelity.fine_radius))
    in->fidelity.fine_radius = 4 * in->fidelity.fine_spacing;
  if (FREE(impact.gap))
    in->impact.gap = sph_inputs_fine_spacing(in);
  if (FREE(collision.gap))
    in->collision.gap = 2 * spacing;
  if (FREE(stretch.grip))
    in->stretch.grip = fmax(in->target.length / 20, 3 * spacing);
  if (FREE(stretch.flaw_free))
    in->stretch.flaw_free = fmax(in->target.length / 10, in->stretch.grip + 2.5 * spacing);
  if (FREE(fragments.static_strength))
    in->fragments.static_strength = static_strength(in);
  if (FREE(stop.quiet_time))
    in->stop.quiet_time = 2 * crossing;
  if (FREE(stop.end_time)) {
    in->stop.end_time = 10 * crossing;
    if (in->kind == SPH_IMPACT && in->impact.speed > 0)
      in->stop.end_time += in->impact.gap / (in->impact.speed * cos(in->impact.angle));
    else if (in->kind == SPH_COLLISION)
      in->stop.end_time += in->collision.gap / in->collision.speed;
  }
}
