/* Conditions across inputs: refuses scenes that cannot be run, with a remedy. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/builtin.h"
#include "engine/sph/body/bodies.h"
#include "engine/sph/material/materials.h"
#include "engine/sph/material/plane_shock.h"
#include "engine/sph/modules/modules.h"
#include "engine/sph/scene/derived.h"
#include "engine/sph/scene/inputs.h"

#define REFUSE(...) return status_fail(error, STATUS_CONTENT, __VA_ARGS__)

/* ---- materials ---- */

/* Who needs each row of sph_materials_table, in its order. */
enum need { ALWAYS, STRENGTH, FRACTURE, BY_CHOICE };
static const struct {
  enum need need;
  const char *choice_name; /* of a choice: what messages call it */
} needs[] = {
#define MATERIAL_VALUE(member_, unit_, low_, high_, flags_, need_, doc_, source_) {need_, NULL},
#define MATERIAL_CHOICE(member_, choices_, flags_, need_, name_, ...)             {need_, name_},
#define MATERIAL_CHOICE_VALUE(...)                                                {BY_CHOICE, NULL},
    SPH_MATERIAL_COMMON(MATERIAL_VALUE)
#include "engine/sph/modules/declarations.h"
};

static bool has(const struct sph_body_inputs *body, enum need need) {
  switch (need) {
  case STRENGTH: return body->strength;
  case FRACTURE: return body->strength && body->fracture == SPH_FRACTURE_ON;
  case ALWAYS:
  case BY_CHOICE: break;
  }
  return true;
}

/* Whether the body cannot do without the value of row k. Flaws and shear_modulus may be off, but not where they are
 * used. */
static bool needed(size_t k, const struct sph_body_inputs *body) {
  const struct field *row = &sph_materials_table.rows[k];
  const struct field *choice = field_controller(&sph_materials_table, row);
  if (!has(body, needs[k].need) || (choice && !has(body, needs[choice - sph_materials_table.rows].need)))
    return false;
  if (needs[k].need == FRACTURE || strcmp(row->path, "shear_modulus") == 0)
    return true;
  return !(row->flags & FIELD_MAY_BE_OFF) && field_is_active(&sph_materials_table, row, &body->material);
}

static status refuse_missing(size_t k, const char *body_name, const char *material, struct error *error) {
  const struct field *row = &sph_materials_table.rows[k];
  const struct field *choice = field_controller(&sph_materials_table, row);
  char reason[100] = "", remedy[200] = "name another material";
  switch (needs[k].need) {
  case ALWAYS: break;
  case STRENGTH:
    snprintf(reason, sizeof reason, " because the body has strength");
    snprintf(remedy, sizeof remedy, "set %s.strength: false", body_name);
    break;
  case FRACTURE:
    snprintf(reason, sizeof reason, " because fracture is on");
    snprintf(remedy, sizeof remedy, "set %s.fracture: off", body_name);
    break;
  case BY_CHOICE:
    snprintf(reason, sizeof reason, " by the %s", needs[choice - sph_materials_table.rows].choice_name);
    snprintf(remedy, sizeof remedy, "set %s.material.%s: %s", body_name, choice->path, choice->choices[0]);
    break;
  }
  REFUSE("%s.material.%s is needed%s, and the material '%s' has none: give it, or %s", body_name, row->path, reason,
         material, remedy);
}

static status check_material(const char *body_name, const struct sph_body_inputs *body, struct error *error) {
  const struct sph_material *m = &body->material;
  for (size_t k = 0; k < sph_materials_table.count; k++) {
    struct field_value value;
    field_get(&sph_materials_table.rows[k], m, &value);
    if (value.kind == FIELD_REAL && isnan(value.number) && needed(k, body))
      return refuse_missing(k, body_name, builtin_material_names[body->material_name], error);
  }
  if (!(m->tillotson.E_cv > m->tillotson.E_iv))
    REFUSE(
        "%s.material.tillotson.E_cv is %.4g J/kg, not above tillotson.E_iv %.4g J/kg: vaporisation begins before it is "
        "complete",
        body_name, m->tillotson.E_cv, m->tillotson.E_iv);
  bool m_off = field_is_off(m->weibull.m), k_off = field_is_off(m->weibull.k);
  if (body->strength && body->fracture == SPH_FRACTURE_AUTO && m_off != k_off)
    REFUSE(
        "%s.material.weibull.%s is given without weibull.%s: give both, or set both off for a body that does not crack",
        body_name, m_off ? "k" : "m", m_off ? "m" : "k");
  for (size_t k = 0; k < SPH_MODULES; k++) {
    struct error why = {0};
    if (sph_modules_at(k)->check_material && sph_modules_at(k)->check_material(m, &why))
      REFUSE("%s.material.%.3000s", body_name, why.message);
  }
  return STATUS_OK;
}

/* Values that may be off must be said to be off: without a yield stress a body is elastic at any stress. */
status sph_inputs_check_given(const struct sph_inputs *in, const bool *given, struct error *error) {
  static const char *const must[] = {"yield_stress", "melt_energy", "tension_limit", "weibull.m", "weibull.k"};
  for (int b = 0; b < 2; b++) {
    const char *body = b ? "projectile" : "target";
    const struct sph_body_inputs *inputs = b ? &in->projectile : &in->target;
    if ((size_t)inputs->material_name < sph_materials_count())
      continue; /* a named one has its own values */
    for (size_t i = 0; i < sizeof must / sizeof must[0]; i++) {
      char path[128];
      snprintf(path, sizeof path, "%s.material.%s", body, must[i]);
      const struct field *row = field_find(&sph_inputs, path, NULL);
      if (row && !given[row - sph_inputs.rows] && field_is_active(&sph_inputs, row, in))
        REFUSE("%s is not given, and the material is of your own: give it, or `off` (%s)", path, row->doc);
    }
  }
  return STATUS_OK;
}

/* ---- sizes ---- */

static status check_shape(const char *name, const struct sph_body_inputs *body, const struct sph_shape *shape,
                          struct error *error) {
  if (body->shape == SPH_SHAPE_CYLINDER && shape->kind == SPH_SHAPE_CYLINDER && body->inner_radius >= body->radius)
    REFUSE("%s.inner_radius is %.4g m, the radius %.4g m: a ring needs a smaller hole", name, body->inner_radius,
           body->radius);
  if (shape->kind == SPH_SHAPE_MESH && !*body->mesh.file)
    REFUSE("%s.mesh.file is missing: name a shape file, STL or OBJ", name);
  if (shape->kind == SPH_SHAPE_MESH && !shape->mesh)
    REFUSE("%s.mesh.file is not here (SHA-256 %.64s): give the name of the shape file", name, body->mesh.file);
  if (shape->kind == SPH_SHAPE_MESH && isnan(body->mesh.unit))
    REFUSE("%s.mesh.unit is missing: give the length that 1 in the shape file stands for, such as 1 km", name);
  if (!(sph_shape_volume(shape) > 0) || !isfinite(sph_shape_volume(shape)))
    REFUSE("%s has a volume of %.4g m^3: give other sizes", name, sph_shape_volume(shape));
  return STATUS_OK;
}

static status check_cylinder(const struct sph_inputs *in, const char *protocol, struct error *error) {
  if (in->target.shape != SPH_SHAPE_CYLINDER)
    REFUSE("%s is done to a cylinder: set target.shape: cylinder", protocol);
  return STATUS_OK;
}

static status check_impact(const struct sph_inputs *in, struct error *error) {
  struct sph_shape target = sph_derived_target(in), projectile;
  if (in->impact.projectile == SPH_BY_ENERGY && !(in->impact.speed > 0))
    REFUSE("impact.specific_energy at impact.speed 0 would need a projectile without end: give a speed, or "
           "impact.projectile: "
           "size");
  projectile = sph_derived_projectile(in);
  status code = in->impact.projectile == SPH_BY_SIZE ? check_shape("projectile", &in->projectile, &projectile, error)
                                                     : STATUS_OK;
  if (code)
    return code;
  if (!(projectile.kind == SPH_SHAPE_SPHERE ? projectile.radius > 1e-12 && projectile.radius < 1e9 : true))
    REFUSE("a projectile of radius %.4g m (from %s) is out of range", projectile.radius,
           in->impact.projectile == SPH_BY_MASS ? "impact.mass" : "impact.specific_energy");
  if (target.kind == SPH_SHAPE_CYLINDER && target.inner_radius > 0)
    REFUSE("a projectile comes down along the axis of a ring and misses it: give target.inner_radius: 0");
  if (in->impact.speed > 0) {
    double arrival = in->impact.gap / (in->impact.speed * cos(in->impact.angle));
    if (arrival >= in->stop.end_time)
      REFUSE("the projectile needs %.4g s over impact.gap %.4g m, but the run ends at %.4g s: raise stop.end_time or "
             "lower the gap",
             arrival, in->impact.gap, in->stop.end_time);
    struct sph_shape shape[2];
    double flight[3];
    if ((code = sph_derived_aim(in, shape, flight, error)))
      return code;
    const bool meshes = shape[0].kind == SPH_SHAPE_MESH || shape[1].kind == SPH_SHAPE_MESH; /* aimed at a face */
    if (!meshes && sph_shape_gap_ahead(&shape[0], &shape[1], flight, NULL) > 0)
      REFUSE("the projectile flies past the target: lower impact.angle (%.4g rad) or impact.gap (%.4g m)",
             in->impact.angle, in->impact.gap);
  }
  double pieces = sph_derived_particles(in) - (double)in->fidelity.particles;
  if (pieces < 1 - 1e-9) /* one is enough, within rounding of its volume */
    REFUSE("the projectile would be %.2g particles: lower fidelity.projectile_spacing (now %.4g), raise "
           "fidelity.particles, or "
           "take a larger projectile",
           pieces, in->fidelity.projectile_spacing);
  if (in->fidelity.graded && in->fidelity.fine_spacing > sph_derived_spacing(in))
    REFUSE("fidelity.fine_spacing is %.4g m, above the uniform spacing %.4g m of so many particles: lower it, or set "
           "fidelity.graded: false",
           in->fidelity.fine_spacing, sph_derived_spacing(in));
  return STATUS_OK;
}

static status check_piston(const struct sph_inputs *in, struct error *error) {
  struct sph_plane_shock exact;
  if (in->target.shape != SPH_SHAPE_BOX)
    REFUSE("a piston runs into a plate: set target.shape: box");
  if (in->target.strength)
    REFUSE("a piston's shock is compared with that of matter without strength: set target.strength: false");
  if (in->sides.far == 1)
    REFUSE("a plate repeats sideways, and its far side is never reached: set sides.far: free");
  if (in->target.turned)
    REFUSE("a turned lattice cannot repeat sideways: set target.turned: false");
  if (in->fidelity.points < 20)
    REFUSE("fidelity.points is %lld: a shock is spread over about ten particles, so give 20 or more",
           (long long)in->fidelity.points);
  return sph_plane_shock(&in->target.material, in->piston.speed, &exact, error);
}

static status check_protocol(const struct sph_inputs *in, struct error *error) {
  status code;
  double spacing = sph_derived_spacing(in);
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT: return check_impact(in, error);
  case SPH_STRETCH:
    if ((code = check_cylinder(in, "stretch", error)))
      return code;
    if (2 * in->stretch.grip >= 0.9 * in->target.length)
      REFUSE("grips of %.4g m leave too little of a rod of %.4g m: give a shorter stretch.grip, more "
             "fidelity.particles or a longer "
             "target.length",
             in->stretch.grip, in->target.length);
    if (2 * in->stretch.flaw_free >= 0.95 * in->target.length)
      REFUSE("ends of %.4g m without flaws leave too little of a rod of %.4g m: give a shorter stretch.flaw_free",
             in->stretch.flaw_free, in->target.length);
    return STATUS_OK;
  case SPH_VIBRATION: return check_cylinder(in, "vibration", error);
  case SPH_COLLISION:
    if ((code = check_cylinder(in, "collision", error)))
      return code;
    if (in->target.turned)
      REFUSE("a turned lattice cannot repeat along the axis: set target.turned: false");
    if (in->collision.gap / in->collision.speed >= in->stop.end_time)
      REFUSE("the bodies need %.4g s over collision.gap %.4g m, but the run ends at %.4g s: raise stop.end_time or "
             "lower the gap",
             in->collision.gap / in->collision.speed, in->collision.gap, in->stop.end_time);
    if (in->collision.gap < spacing / 2)
      REFUSE("collision.gap is %.4g m, less than half a particle spacing (%.4g m): the bodies would overlap",
             in->collision.gap, spacing);
    return STATUS_OK;
  case SPH_PISTON: return check_piston(in, error);
  }
  return STATUS_OK;
}

const char *sph_inputs_check_fewer(const struct sph_inputs *in) {
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT: return "lower fidelity.particles, or raise fidelity.projectile_spacing";
  case SPH_COLLISION: return "lower fidelity.particles or target.length";
  case SPH_PISTON: return "lower fidelity.points, or target.depth and target.height";
  case SPH_STRETCH:
  case SPH_VIBRATION: break;
  }
  return "lower fidelity.particles";
}

status sph_inputs_check(const struct sph_inputs *in, struct error *error) {
  struct sph_shape target = sph_derived_target(in);
  status code = check_material("target", &in->target, error);
  if (code)
    return code;
  code = check_shape("target", &in->target, &target, error);
  if (code)
    return code;
  if (sph_derived_has_projectile(in))
    code = check_material("projectile", &in->projectile, error);
  if (code)
    return code;
  code = check_protocol(in, error);
  if (code)
    return code;

  bool cracks = sph_derived_cracks(&in->target) ||
                (sph_derived_has_projectile(in) && sph_derived_cracks(&in->projectile));
  if (cracks && in->method.artificial_stress > 0)
    REFUSE("method.artificial_stress would hold cracks together: set it to 0, or target.fracture: off");
  if (in->fracture.cell > 0 && in->fracture.front == SPH_CRACK_FRONT_PLANE)
    REFUSE("fracture.cell cannot be used with fracture.front: plane: set fracture.cell: 0 m, or fracture.front: none");
  if (in->fracture.cell > 0 && in->fracture.crack_radius == SPH_CRACK_RADIUS_SUPPORT)
    REFUSE("fracture.crack_radius: support has no meaning for cells: set it to volume, or fracture.cell: 0 m");
  if (in->fragments.layer_width > 30 * sph_derived_smallest_spacing(in)) /* each finds 1e5 others */
    REFUSE("fragments.layer_width is %.4g m, more than 30 particle spacings of %.4g m: give a smaller width",
           in->fragments.layer_width, sph_derived_smallest_spacing(in));
  if (in->target.shape == SPH_SHAPE_BOX && in->sides.far == 1 &&
      2 * in->sides.depth >= fmin(in->target.width, fmin(in->target.depth, in->target.height)))
    REFUSE("sides.depth is %.4g m, which leaves nothing of the box undamped: give less than half of the shortest side",
           in->sides.depth);
  double particles = sph_derived_particles(in);
  if (!(particles <= 2e9))
    REFUSE("%.3g particles are too many (at most 2e9): %s", particles, sph_inputs_check_fewer(in));
  if (!(in->stop.end_time > 0) || !isfinite(in->stop.end_time))
    REFUSE("stop.end_time is %.4g s: give a time", in->stop.end_time);
  double step = in->fidelity.cfl * sph_derived_smallest_spacing(in) / sph_derived_wave_speed(&in->target);
  double steps = in->stop.end_time / step;
  if (!(steps <= 1e10))
    REFUSE("the run could take %.3g time steps (at most 1e10): end it earlier (stop.end_time %.4g s) or take larger "
           "particles",
           steps, in->stop.end_time);
  return STATUS_OK;
}
