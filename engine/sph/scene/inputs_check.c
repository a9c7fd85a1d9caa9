/* Conditions across inputs: refuses scenes that cannot be run, with a remedy. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/sph/material/palpha.h"
#include "engine/sph/scene/derived.h"

#define REFUSE(...) return status_fail(error, STATUS_CONTENT, __VA_ARGS__)

/* ---- materials ---- */

/* What decides whether a body uses a value: ".strength", ".fracture", a choice of its material; "" is always. */
static const char *decider(const struct field *row, const struct field **controller) {
  *controller = field_controller(&sph_inputs, row);
  const char *word = *controller ? strrchr((*controller)->path, '.') : NULL;
  return word ? word : "";
}

/* Does an active row need a value? What may be off is needed all the same where it is used: flaws where fracture is on,
 * and shear_modulus. */
static bool is_needed(const struct field *row, const struct sph_body_inputs *body) {
  const struct field *controller;
  if (strcmp(decider(row, &controller), ".fracture") == 0)
    return body->fracture == SPH_FRACTURE_ON;
  return !(row->flags & FIELD_MAY_BE_OFF) || strcmp(strrchr(row->path, '.'), ".shear_modulus") == 0;
}

static status refuse_missing(const struct field *row, const char *material, struct error *error) {
  const struct field *controller;
  const char *by = decider(row, &controller), *off = "false";
  char reason[100] = "", remedy[200] = "name another material";
  if (strcmp(by, ".strength") == 0) {
    snprintf(reason, sizeof reason, " because the body has strength");
  } else if (strcmp(by, ".fracture") == 0) {
    snprintf(reason, sizeof reason, " because fracture is on");
    off = "off";
  } else if (*by) {
    snprintf(reason, sizeof reason, " by the %s", controller->label);
    off = controller->choices[0];
  }
  if (*by)
    snprintf(remedy, sizeof remedy, "set %s: %s", controller->path, off);
  REFUSE("%s%s is needed%s, and the material '%s' has none: give it, take it from another material (`like: %s` in a "
         "file), or %s",
         row->path, strstr(row->path, ".porosity.distention") ? " (or porosity.fraction)" : "", reason, material,
         strcmp(by, ".curve") == 0 ? "pumice" : "granite", remedy);
}

/* Is it a value of the body's material that is needed and missing? */
static bool is_missing(const struct sph_inputs *in, const struct sph_body_inputs *body, const struct field *row) {
  const size_t material = (size_t)((const char *)&body->material - (const char *)in);
  struct field_value value;
  if (row->offset < material || row->offset >= material + sizeof body->material)
    return false;
  field_get(row, in, &value);
  return value.kind == FIELD_REAL && isnan(value.number) && field_is_active(&sph_inputs, row, in) &&
         is_needed(row, body);
}

/* The next such value behind `after` (NULL: the first); NULL: none. */
static const struct field *next_needed(const struct sph_inputs *in, const struct sph_body_inputs *body,
                                       const struct field *after) {
  for (size_t k = after ? (size_t)(after - sph_inputs.rows) + 1 : 0; k < sph_inputs.count; k++)
    if (is_missing(in, body, &sph_inputs.rows[k]))
      return &sph_inputs.rows[k];
  return NULL;
}

/* Tells all that is missing at once. */
static status check_needed(const struct sph_inputs *in, const struct sph_body_inputs *body, struct error *error) {
  const struct field *row = next_needed(in, body, NULL);
  if (!row)
    return STATUS_OK;
  const status code = refuse_missing(row, body->material_name, error);
  for (size_t more = 0; (row = next_needed(in, body, row)); more++)
    text_append(error->message, sizeof error->message, "%s%s", more ? ", " : "; also missing: ", row->path);
  return code;
}

static status check_flaws(const char *body_name, const struct sph_body_inputs *body, struct error *error) {
  const bool m_off = field_is_off(body->material.weibull.m), k_off = field_is_off(body->material.weibull.k);
  if (!body->strength || body->fracture != SPH_FRACTURE_AUTO || m_off == k_off)
    return STATUS_OK;
  REFUSE(
      "%s.material.weibull.%s is given without weibull.%s: give both, or set both off for a body that does not crack",
      body_name, m_off ? "k" : "m", m_off ? "m" : "k");
}

static status check_material(const struct sph_inputs *in, const char *body_name, const struct sph_body_inputs *body,
                             struct error *error) {
  const struct sph_material *m = &body->material;
  TRY(check_needed(in, body, error));
  if (!(m->tillotson.E_cv > m->tillotson.E_iv))
    REFUSE("%s.material.tillotson.E_cv is %.4g J/kg, not above tillotson.E_iv %.4g J/kg: raise E_cv, as vaporisation "
           "ends after it begins",
           body_name, m->tillotson.E_cv, m->tillotson.E_iv);
  TRY(check_flaws(body_name, body, error));
  for (size_t k = 0; k < SPH_MODULES; k++) {
    struct error why = {0};
    if (sph_modules_at(k)->check_material && sph_modules_at(k)->check_material(m, &why))
      REFUSE("%s.material.%.3000s", body_name, why.message);
  }
  return STATUS_OK;
}

/* Values that may be off must be set to off explicitly. */
static bool must_be_given(const struct field *row, const char *body) {
  const size_t length = strlen(body);
  return strncmp(row->path, body, length) == 0 && strncmp(row->path + length, ".material.", 10) == 0 &&
         sph_materials_must_give(row->path + length + 10);
}

status sph_inputs_check_given(const void *scene, const bool *given, struct error *error) {
  const struct sph_inputs *in = scene;
  for (int b = 0; b < 2; b++) {
    const char *body = b ? "projectile" : "target";
    const struct sph_body_inputs *inputs = b ? &in->projectile : &in->target;
    char missing[1024] = "";
    for (size_t k = 0; k < sph_inputs.count && !sph_materials_text(inputs->material_name); k++) {
      const struct field *row = &sph_inputs.rows[k];
      const bool must = must_be_given(row, body) && !given[k] && field_is_active(&sph_inputs, row, in);
      if (!must && !is_missing(in, inputs, row))
        continue;
      text_append(missing, sizeof missing, "%s%s%s", *missing ? ", " : "",
                  row->path + strlen(body) + strlen(".material."), row->flags & FIELD_MAY_BE_OFF ? " (or off)" : "");
    }
    if (*missing)
      REFUSE(
          "%s.material '%s' lacks %s: give what is missing (`clast explain %s.material`), or begin with the values of "
          "another one (`like: %s` in a file)",
          body, inputs->material_name, missing, body, strstr(missing, "porosity.") ? "pumice" : "granite");
  }
  return STATUS_OK;
}

/* Boxes of which some sides are given. A plate repeats along the others. */
void sph_inputs_remark(const void *scene, const bool *given, char *text, size_t size) {
  static const char *const sides[] = {"width", "depth", "height"};
  const struct sph_inputs *in = scene;
  text[0] = '\0';
  for (int b = 0; b < 2 && in->kind != SPH_PISTON; b++) {
    char has[100] = "", others[300] = "", path[FIELD_TEXT_SIZE], shown[FIELD_TEXT_SIZE];
    for (size_t i = 0; i < 3; i++) {
      struct field_value value;
      snprintf(path, sizeof path, "%s.%s", b ? "projectile" : "target", sides[i]);
      const struct field *row = field_find(&sph_inputs, path, NULL);
      if (!field_is_active(&sph_inputs, row, in))
        continue;
      field_get(row, in, &value);
      field_show(row, &value, shown, sizeof shown);
      if (given[row - sph_inputs.rows])
        text_append(has, sizeof has, "%s%s", *has ? " and " : "", path);
      else
        text_append(others, sizeof others, "%s%s %s", *others ? ", " : "", path, shown);
    }
    if (*has && *others)
      text_append(text, size, "%sof a box, %s is given, and the other sides have their defaults: %s", *text ? "; " : "",
                  has, others);
  }
}

/* ---- sizes ---- */

static status check_mesh(const char *name, const struct sph_body_inputs *body, const struct sph_shape *shape,
                         struct error *error) {
  if (!*body->mesh.file)
    REFUSE("%s.mesh.file is missing: name a shape file, STL or OBJ", name);
  if (!shape->mesh)
    REFUSE("%s.mesh.file is not here (SHA-256 %.64s): give the name of the shape file", name, body->mesh.file);
  if (isnan(body->mesh.unit))
    REFUSE("%s.mesh.unit is missing: give the length that 1 in the shape file stands for, such as 1 km", name);
  return STATUS_OK;
}

static status check_shape(const char *name, const struct sph_body_inputs *body, const struct sph_shape *shape,
                          struct error *error) {
  const bool cylinder = body->shape == SPH_SHAPE_CYLINDER && shape->kind == SPH_SHAPE_CYLINDER;
  if (cylinder && body->inner_radius >= body->radius)
    REFUSE("%s.inner_radius is %.4g m, the radius %.4g m: a ring needs a smaller hole", name, body->inner_radius,
           body->radius);
  if (shape->kind == SPH_SHAPE_MESH)
    TRY(check_mesh(name, body, shape, error));
  const double volume = sph_shape_volume(shape);
  if (!(volume > 0) || !isfinite(volume))
    REFUSE("%s has a volume of %.4g m^3: give other sizes", name, volume);
  return STATUS_OK;
}

static status check_cylinder(const struct sph_inputs *in, const char *protocol, struct error *error) {
  if (in->target.shape != SPH_SHAPE_CYLINDER)
    REFUSE("%s is done to a cylinder: set target.shape: cylinder", protocol);
  return STATUS_OK;
}

static status check_arrival(const struct sph_inputs *in, const char *who, const char *input, double gap,
                            struct error *error) {
  const double arrival = sph_derived_arrival(in);
  if (arrival >= in->stop.end_time)
    REFUSE("%s %.4g s over %s %.4g m, but the run ends at %.4g s: raise stop.end_time or lower the gap", who, arrival,
           input, gap, in->stop.end_time);
  return STATUS_OK;
}

/* ---- impacts ---- */

static status check_projectile(const struct sph_inputs *in, struct error *error) {
  if (in->impact.projectile == SPH_BY_ENERGY && !(in->impact.speed > 0))
    REFUSE("impact.specific_energy at impact.speed 0 would need a projectile without end: give a speed, or "
           "impact.projectile: size");
  const struct sph_shape projectile = sph_derived_projectile(in);
  if (in->impact.projectile == SPH_BY_SIZE)
    TRY(check_shape("projectile", &in->projectile, &projectile, error));
  const bool extreme = !(projectile.radius > 1e-12 && projectile.radius < 1e9);
  if (projectile.kind == SPH_SHAPE_SPHERE && extreme)
    REFUSE("a projectile of radius %.4g m (from %s) is out of range", projectile.radius,
           in->impact.projectile == SPH_BY_MASS ? "impact.mass" : "impact.specific_energy");
  if (in->target.shape == SPH_SHAPE_CYLINDER && in->target.inner_radius > 0)
    REFUSE("a projectile comes down along the axis of a ring and misses it: give target.inner_radius: 0");
  return STATUS_OK;
}

static status check_flight(const struct sph_inputs *in, struct error *error) {
  struct sph_shape shape[2];
  double flight[3];
  if (!(in->impact.speed > 0))
    return STATUS_OK;
  TRY(check_arrival(in, "the projectile needs", "impact.gap", in->impact.gap, error));
  TRY(sph_derived_aim(in, shape, flight, error));
  const bool meshes = shape[0].kind == SPH_SHAPE_MESH || shape[1].kind == SPH_SHAPE_MESH; /* aimed at a face */
  if (!meshes && sph_shape_gap_ahead(&shape[0], &shape[1], flight) > 0)
    REFUSE("the projectile flies past the target: lower impact.angle (%.4g rad) or impact.gap (%.4g m)",
           in->impact.angle, in->impact.gap);
  return STATUS_OK;
}

static status check_graded(const struct sph_inputs *in, struct error *error) {
  struct sph_shape shape[2];
  double flight[3];
  if (in->fidelity.fine_spacing > sph_derived_spacing(in))
    REFUSE("fidelity.fine_spacing is %.4g m, above the uniform spacing %.4g m of so many particles: lower it, raise "
           "fidelity.spacings_per_radius, or set fidelity.graded: false",
           in->fidelity.fine_spacing, sph_derived_spacing(in));
  TRY(sph_derived_aim(in, shape, flight, error));
  return sph_irregular_check(sph_derived_grading(in, &shape[0]), &shape[0], (double)in->fidelity.particles, error);
}

static status check_impact(const struct sph_inputs *in, struct error *error) {
  if (in->target.spin != 0 && !in->gradient_correction.on)
    REFUSE("target.spin %.4g rad/s without method.gradient_correction: the uncorrected velocity gradient strains a "
           "body that only turns, and breaks it: set method.gradient_correction: true",
           in->target.spin);
  if (in->target.spin != 0 && in->target.shape == SPH_SHAPE_BOX && in->sides.far == SPH_FAR_DAMPED)
    REFUSE(
        "target.spin %.4g rad/s with sides.far: damped: such a box stands for a half-space, which does not turn, and "
        "its sides would brake the rotation: set sides.far: free, or target.spin: 0",
        in->target.spin);
  TRY(check_projectile(in, error));
  TRY(check_flight(in, error));
  const double pieces = sph_derived_particles(in) - (double)in->fidelity.particles;
  if (pieces < 1 - 1e-9) /* one is enough, within rounding of its volume */
    REFUSE("the projectile would be %.2g particles: lower fidelity.projectile_spacing from %.4g to %.2g, raise "
           "fidelity.particles, or take a larger projectile",
           pieces, in->fidelity.projectile_spacing, 0.95 * in->fidelity.projectile_spacing * cbrt(pieces));
  return in->fidelity.graded ? check_graded(in, error) : STATUS_OK;
}

/* ---- other protocols ---- */

static status check_stretch(const struct sph_inputs *in, struct error *error) {
  TRY(check_cylinder(in, "stretch", error));
  if (2 * in->stretch.grip >= 0.9 * in->target.length)
    REFUSE("grips of %.4g m leave too little of a rod of %.4g m: give a shorter stretch.grip, more fidelity.particles "
           "or a longer target.length",
           in->stretch.grip, in->target.length);
  if (2 * in->stretch.flaw_free >= 0.95 * in->target.length)
    REFUSE("ends of %.4g m without flaws leave too little of a rod of %.4g m: give a shorter stretch.flaw_free",
           in->stretch.flaw_free, in->target.length);
  return STATUS_OK;
}

static status check_collision(const struct sph_inputs *in, struct error *error) {
  const double spacing = sph_derived_spacing(in);
  TRY(check_cylinder(in, "collision", error));
  if (in->target.turned)
    REFUSE("a turned lattice cannot repeat along the axis: set target.turned: false");
  TRY(check_arrival(in, "the bodies need", "collision.gap", in->collision.gap, error));
  if (in->collision.gap < spacing / 2)
    REFUSE("collision.gap is %.4g m, less than half a particle spacing (%.4g m): the bodies would overlap",
           in->collision.gap, spacing);
  return STATUS_OK;
}

static status check_piston(const struct sph_inputs *in, struct error *error) {
  struct sph_plane_shock exact;
  if (in->target.shape != SPH_SHAPE_BOX)
    REFUSE("a piston runs into a plate: set target.shape: box");
  if (in->target.strength)
    REFUSE("a piston's shock is compared with that of matter without strength: set target.strength: false");
  if (in->sides.far == SPH_FAR_DAMPED)
    REFUSE("a plate repeats sideways, and its far side is never reached: set sides.far: free");
  if (in->target.turned)
    REFUSE("a turned lattice cannot repeat sideways: set target.turned: false");
  if (in->fidelity.points < 20)
    REFUSE("fidelity.points is %lld: a shock is spread over about ten particles, so give 20 or more",
           (long long)in->fidelity.points);
  return sph_plane_shock(&in->target.material, in->piston.speed, &exact, error);
}

static status check_protocol(const struct sph_inputs *in, struct error *error) {
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT: return check_impact(in, error);
  case SPH_STRETCH: return check_stretch(in, error);
  case SPH_VIBRATION: return check_cylinder(in, "vibration", error);
  case SPH_COLLISION: return check_collision(in, error);
  case SPH_PISTON: return check_piston(in, error);
  case SPH_KINDS: break;
  }
  return STATUS_OK;
}

const char *sph_inputs_check_fewer(const struct sph_inputs *in) {
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT: return "lower fidelity.particles, or raise fidelity.projectile_spacing";
  case SPH_COLLISION: return "lower fidelity.particles or target.length";
  case SPH_PISTON: return "lower fidelity.points, or target.depth and target.height";
  case SPH_STRETCH:
  case SPH_VIBRATION:
  case SPH_KINDS: break;
  }
  return "lower fidelity.particles";
}

/* ---- any scene ---- */

static status check_bodies(const struct sph_inputs *in, struct error *error) {
  const struct sph_shape target = sph_derived_target(in);
  TRY(check_material(in, "target", &in->target, error));
  status code = check_shape("target", &in->target, &target, error);
  if (code || !sph_derived_has_projectile(in))
    return code;
  return check_material(in, "projectile", &in->projectile, error);
}

static status check_cracks(const struct sph_inputs *in, struct error *error) {
  if (sph_derived_scene_cracks(in) && in->artificial_stress.epsilon > 0)
    REFUSE("method.artificial_stress would hold cracks together: set it to 0, or target.fracture: off");
  if ((in->crack_surfaces.on || in->reconstruction.on) && !in->gradient_correction.on)
    REFUSE("method.%s needs the velocity gradients of method.gradient_correction: set that to true",
           in->crack_surfaces.on ? "crack_surfaces" : "reconstruction");
  if (in->artificial_stress.epsilon > 0 && (in->crack_surfaces.on || in->reconstruction.on))
    REFUSE("method.artificial_stress cannot be used with method.crack_surfaces or method.reconstruction: set it to 0");
  if (!(in->crack_cell.width > 0))
    return STATUS_OK;
  if (in->crack_front.front == SPH_CRACK_FRONT_PLANE)
    REFUSE("fracture.cell cannot be used with fracture.front: plane: set fracture.cell: 0 m, or fracture.front: none");
  if (in->fracture.crack_radius == SPH_CRACK_RADIUS_SUPPORT)
    REFUSE("fracture.crack_radius: support has no meaning for cells: set it to volume, or fracture.cell: 0 m");
  return STATUS_OK;
}

static status check_lengths(const struct sph_inputs *in, struct error *error) {
  const double spacing = sph_derived_smallest_spacing(in);
  if (in->fragments.layer_width > 30 * spacing) /* each particle finds 1e5 others */
    REFUSE("fragments.layer_width is %.4g m, more than 30 particle spacings of %.4g m: give a smaller width",
           in->fragments.layer_width, spacing);
  const bool damped = in->target.shape == SPH_SHAPE_BOX && in->sides.far == SPH_FAR_DAMPED;
  if (damped && 2 * in->sides.depth >= sph_derived_shortest_side(&in->target))
    REFUSE("sides.depth is %.4g m, which leaves nothing of the box undamped: give less than half of the shortest side",
           in->sides.depth);
  return STATUS_OK;
}

static status check_cost(const struct sph_inputs *in, struct error *error) {
  const double particles = sph_derived_particles(in), end = in->stop.end_time;
  if (!(particles <= 2e9))
    REFUSE("%.3g particles are too many (at most 2e9): %s", particles, sph_inputs_check_fewer(in));
  if (!(end > 0) || !isfinite(end))
    REFUSE("stop.end_time is %.4g s: give a time", end);
  const double step = in->fidelity.cfl * sph_derived_smallest_spacing(in) / sph_derived_wave_speed(&in->target);
  if (!(end / step <= 1e10))
    REFUSE("the run could take %.3g time steps (at most 1e10): end it earlier (stop.end_time %.4g s) or take larger "
           "particles",
           end / step, end);
  return STATUS_OK;
}

status sph_inputs_check(const void *inputs, struct error *error) {
  static status (*const checks[])(const struct sph_inputs *, struct error *) = {check_bodies, check_protocol,
                                                                                check_cracks, check_lengths,
                                                                                check_cost};
  for (size_t k = 0; k < sizeof checks / sizeof checks[0]; k++)
    TRY(checks[k](inputs, error));
  return STATUS_OK;
}
