/* Text for `clast explain` and `plan`: the model of a scene with reasons, its memory and time, and numbers to compare.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/mesh/mesh.h"
#include "engine/sph/material/palpha.h"
#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"
#include "schemas/memory.h"

/* Memory beside the moving system: per particle (particles as set up and as read back, and fragments at the end; the
 * peak of a whole process less the system, measured), per flaw, and of any process. */
enum { BYTES_BESIDE = 450, BYTES_PER_FLAW = 16, BYTES_ANYWAY = 4 << 20 };
/* Nanoseconds of one core for a particle-step of the basalt sphere without options (bench_sph; AVX-512 at 2 to 3 GHz);
 * modules say what options add. */
enum { COST_DOUBLE = 260, COST_FLOAT = 160 };
static const double euler = 0.57721566490153286;

/* Share of the target's volume that has flaws: a stretched rod has none in its ends. */
static double flawed_share(const struct sph_inputs *in) {
  return in->kind == SPH_STRETCH ? 1 - 2 * in->stretch.flaw_free / in->target.length : 1;
}

/* Flaws of the target: drawn until each particle, or cell of fracture.cell, has one on average. */
static double flaws_expected(const struct sph_inputs *in) {
  const struct sph_shape target = sph_derived_target(in);
  double owners = (double)in->fidelity.particles;
  if (in->crack_cell.width > 0)
    owners = fmin(owners, sph_shape_volume(&target) / pow(in->crack_cell.width, 3));
  return flawed_share(in) * owners * (log(fmax(owners, 1)) + euler);
}

enum { BODIES = 2 };

/* Needs of the bodies of a scene in the moving system. */
struct need {
  struct sph_module_set modules[BODIES]; /* of each body */
  struct sph_column_set columns;         /* of all */
  size_t pairs;                          /* bytes per particle of the pair loop's options */
  size_t linked;                         /* bytes per particle that modules prepare */
  size_t bytes;                          /* per particle, of modules alone */
};

static struct need need_of(const struct sph_inputs *in) {
  static const struct sph_flaws some = {.particles = 1};
  const bool damped = in->target.shape == SPH_SHAPE_BOX && in->sides.far == SPH_FAR_DAMPED;
  struct need need = {.columns = sph_system_columns_of_all(damped)};
  struct sph_column_set of_modules = {0};
  for (int b = 0; b < 1 + sph_derived_has_projectile(in); b++) {
    const struct sph_body_inputs *body = b ? &in->projectile : &in->target;
    const struct sph_body_physics physics = sph_derived_physics(body, sph_derived_cracks(body) ? &some : NULL);
    need.modules[b] = sph_modules_of(&physics, in);
    const struct sph_column_set own = sph_modules_columns(&need.modules[b], &physics);
    set_unite(of_modules.word, own.word, SPH_COLUMNS);
    need.pairs = 0; /* options of the pair loop: the same for all bodies */
    FOR_MODULES(m, need.modules[b]) {
      need.linked += (size_t)sph_modules_at(m)->bytes_linked;
      need.pairs += (size_t)sph_modules_at(m)->bytes_in_pairs;
    }
  }
  set_unite(need.columns.word, of_modules.word, SPH_COLUMNS);
  need.bytes = need.pairs + need.linked + set_size(of_modules.word, SPH_COLUMNS) * sizeof(double);
  return need;
}

struct sph_column_set sph_describe_columns(const struct sph_inputs *in) {
  return need_of(in).columns;
}

size_t sph_describe_memory(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const struct need need = need_of(in);
  const double particles = sph_derived_particles(in);
  double bytes = BYTES_ANYWAY + particles * (sph_system_columns_bytes(&need.columns, need.pairs, &in->fidelity) +
                                             BYTES_BESIDE + (double)need.linked);
  if (sph_derived_cracks(&in->target))
    bytes += flaws_expected(in) * BYTES_PER_FLAW;
  return bytes < 1e18 ? (size_t)bytes : SIZE_MAX / 2;
}

/* m/s: the Courant limit of a body at rest (modules/motion.h) times its spacing. Closed pores bring its particles
 * nearer to each other. */
static double signal_expected(const struct sph_inputs *in, const struct sph_body_inputs *body) {
  struct sph_material solid = body->material;
  solid.palpha.curve = SPH_CRUSH_NONE;
  return cbrt(sph_material_solid_ratio(&body->material)) *
         (sph_material_longitudinal_speed(&solid, body->strength) +
          0.6 * in->viscosity.alpha * sph_material_longitudinal_speed(&solid, false));
}

double sph_describe_steps(const void *inputs) {
  const struct sph_inputs *in = inputs;
  const double spacing = sph_derived_fine_spacing(in), finest = sph_derived_smallest_spacing(in);
  double per_spacing = signal_expected(in, &in->target) / spacing; /* 1/s */
  if (sph_derived_has_projectile(in))
    per_spacing = fmax(per_spacing, signal_expected(in, &in->projectile) / (spacing * in->fidelity.projectile_spacing));
  if (in->kind == SPH_IMPACT) /* waves in compressed matter are faster than at rest */
    per_spacing += 0.25 * in->impact.speed / finest;
  return in->stop.end_time * per_spacing / (in->fidelity.cfl * in->fidelity.smoothing);
}

/* Particle-steps of one core in a second. */
static double speed_expected(const struct sph_inputs *in) {
  const struct need need = need_of(in);
  double cost = in->fidelity.precision == SPH_FLOAT ? COST_FLOAT : COST_DOUBLE;
  for (size_t m = 0; m < SPH_MODULES; m++)
    if (set_has(need.modules[0].word, m) || set_has(need.modules[1].word, m))
      cost += sph_modules_at(m)->cost;
  return 1e9 / cost;
}

double sph_describe_work(const void *inputs) {
  return sph_derived_particles(inputs) * sph_describe_steps(inputs);
}

/* ---- text ---- */

static void mesh(const struct sph_shape *s, FILE *out) {
  const struct mesh *m = s->mesh;
  double side[3] = {0};
  for (int k = 0; k < 3 && m; k++)
    side[k] = s->unit * (m->high[k] - m->low[k]);
  fprintf(out, "mesh of %zu faces, %.4g x %.4g x %.4g m, %.4g m^3,", m ? m->faces : 0, side[0], side[1], side[2],
          sph_shape_volume(s));
}

static void shape(const char *name, const struct sph_shape *s, const struct sph_body_inputs *b, double spacing,
                  bool graded, FILE *out) {
  static FIELD_WORDS(lattices, SPH_LATTICES, [SPH_LATTICE_HEXAGONAL] = "hexagonal lattice",
                     [SPH_LATTICE_CUBIC] = "cubic lattice", [SPH_LATTICE_IRREGULAR] = "irregular points");
  double volume = sph_shape_volume(s);
  fprintf(out, "  %s: ", name);
  if (s->kind == SPH_SHAPE_SPHERE)
    fprintf(out, "sphere of radius %.4g m", s->radius);
  else if (s->kind == SPH_SHAPE_CYLINDER)
    fprintf(out, "%s of radius %.4g m, length %.4g m", s->inner_radius > 0 ? "ring" : "cylinder", s->radius, s->length);
  else if (s->kind == SPH_SHAPE_MESH)
    mesh(s, out);
  else
    fprintf(out, "box of %.4g x %.4g x %.4g m", s->side[0], s->side[1], s->side[2]);
  const double particles = round(volume / (spacing * spacing * spacing));
  fprintf(out, " of %s, %.4g kg; about %.0f particle%s, spacing %.3g m, %s\n", b->material_name,
          sph_derived_density(b) * volume, particles, particles == 1 ? "" : "s", spacing,
          lattices[graded ? SPH_LATTICE_IRREGULAR : b->lattice]);
}

static void protocol(const struct sph_inputs *in, FILE *out) {
  struct sph_shape target = sph_derived_target(in), projectile;
  double spacing = sph_derived_spacing(in);
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT:
    fprintf(out, "impact at %.4g m/s, %.3g degrees from the normal\n", in->impact.speed, in->impact.angle * 180 / M_PI);
    break;
  case SPH_STRETCH:
    fprintf(out,
            "stretch: a rod is pulled by its ends at %.4g /s, stretching evenly from the start (Benz & Asphaug 1995 "
            "section 5.1)\n",
            in->stretch.rate);
    break;
  case SPH_VIBRATION:
    fprintf(out, "vibration: a free bar rings along its axis in its first mode, ends at %.4g m/s\n",
            in->vibration.speed);
    break;
  case SPH_COLLISION:
    fprintf(out,
            "collision: two equal bodies approach at %.4g m/s, slabs that repeat along their axes (Gray et al. 2001)\n",
            in->collision.speed);
    break;
  case SPH_PISTON:
    fprintf(out,
            "piston: a plate, a bar that repeats sideways, is driven at %.4g m/s along x (Jutzi, Benz & Michel 2008)\n",
            in->piston.speed);
    break;
  case SPH_KINDS: break;
  }
  shape("target", &target, &in->target, spacing, in->kind == SPH_IMPACT && in->fidelity.graded, out);
  if (sph_derived_has_projectile(in)) {
    projectile = sph_derived_projectile(in);
    shape("projectile", &projectile, &in->projectile, sph_derived_fine_spacing(in) * in->fidelity.projectile_spacing,
          false, out);
    if (in->fidelity.graded) {
      fprintf(out, "  graded: spacing %.3g m within %.3g m of the point of impact, up to %.3g m far from it",
              in->fidelity.fine_spacing, in->fidelity.fine_radius, sph_derived_coarsest_spacing(in));
      sph_derived_tell_unkept(in, out);
      fputc('\n', out);
    }
  }
}

/* The modules, and the bodies in which each is on. */
static void modules(const struct sph_inputs *in, bool all, FILE *out) {
  static const char *const who[] = {"", "target", "projectile", "target, projectile"};
  const struct need need = need_of(in);
  const char *before = "  modelled: ";
  for (size_t m = 0; m < SPH_MODULES && !all; m++)
    if (set_has(need.modules[0].word, m) || set_has(need.modules[1].word, m)) {
      fprintf(out, "%s%s", before, sph_modules_at(m)->name);
      before = ", ";
    }
  if (!all) {
    fputc('\n', out);
    return;
  }
  for (size_t m = 0; m < SPH_MODULES; m++) {
    const struct sph_module *module = sph_modules_at(m);
    const unsigned on = set_has(need.modules[0].word, m) + 2U * set_has(need.modules[1].word, m);
    if (on)
      fprintf(out, "  %s (%s): %s [%s]\n", module->name, who[on], module->doc, module->source);
    else
      fprintf(out, "  %s: no; on with %s\n", module->name, module->when);
  }
  fprintf(out, "  these modules add %zu bytes per particle\n", need.bytes);
}

static void numbers(const struct sph_inputs *in, FILE *out) {
  const struct sph_body_inputs *target = &in->target;
  const bool porous = sph_material_solid_ratio(&target->material) > 1;
  double speed = sph_derived_wave_speed(target), crossing = sph_derived_crossing(in);
  fprintf(out, "  waves: c_p %.0f m/s, through the target in %.3g s", speed, crossing);
  if (target->strength)
    fprintf(out, "; Young's modulus %.4g Pa, Poisson's ratio %.3g%s", sph_material_young_modulus(&target->material),
            sph_material_poisson_ratio(&target->material), porous ? " (of the solid between the pores)" : "");
  fputc('\n', out);
  struct sph_palpha_law law;
  if (porous && sph_palpha_prepare(&target->material.palpha, &target->material, &law, NULL) == STATUS_OK)
    fprintf(out, "  pores close from %.4g Pa on, and all are closed at %.4g Pa\n", sph_palpha_crush_begin(&law),
            law.given.solid_pressure);
  if (sph_derived_cracks(target)) {
    double E = sph_material_young_modulus(&target->material), m = target->material.weibull.m, n = flaws_expected(in);
    double log_kv = log(target->material.weibull.k) +
                    log(flawed_share(in) * sph_derived_target_mass(in) / target->material.density); /* solid volume */
    fprintf(out,
            "  flaws: about %.3g; the weakest opens at strain %.3g (%.3g Pa), the last at %.3g (%.3g Pa); cracks grow "
            "at %.0f m/s\n",
            n, exp(-log_kv / m), E * exp(-log_kv / m), exp((log(n) - log_kv) / m), E * exp((log(n) - log_kv) / m),
            sph_material_crack_speed(&target->material));
  }
  if (sph_derived_has_projectile(in)) {
    double mass = sph_derived_projectile_mass(in), energy = 0.5 * mass * in->impact.speed * in->impact.speed;
    double spacing = sph_derived_fine_spacing(in) * fmax(1, in->fidelity.projectile_spacing);
    fprintf(out, "  impact energy %.4g J of %.4g kg: Q = %.4g J/kg of the target; %.3g spacings in its radius\n",
            energy, mass, sph_derived_specific_energy(in), sph_derived_projectile_radius(in) / spacing);
  }
  if (in->kind == SPH_VIBRATION && target->strength && !porous)
    fprintf(out, "  a thin bar of that length rings at %.5g Hz\n",
            sqrt(sph_material_young_modulus(&target->material) / target->material.density) / (2 * target->length));
}

char *sph_describe_scene(const void *inputs, bool all) {
  const struct sph_inputs *in = inputs;
  char *text = NULL;
  FILE *out = text_open(&text);
  struct error error = {0};
  protocol(in, out);
  if (sph_inputs_check(in, &error))
    fprintf(out, "  cannot be run: %s\n", error.message);
  const double particles = sph_derived_particles(in), steps = sph_describe_steps(in), speed = speed_expected(in);
  fprintf(out, "  about %.3g steps of %.4g particles to stop.end_time%s: ", steps, particles,
          sph_derived_cracks(&in->target) ? ", fewer when fracture ceases before" : "");
  text_duration(steps * particles / speed, out);
  fprintf(out, " of a core that does %.2g particle-steps a second\n\n", speed);
  modules(in, all, out);
  numbers(in, out);
  struct sph_plane_shock exact;
  if (in->kind == SPH_PISTON && !sph_plane_shock(&in->target.material, in->piston.speed, &exact, NULL))
    sph_plane_shock_describe(&exact, out);
  fprintf(out, "  memory: about %.0f bytes per particle, %.3g MB in all\n", (double)sph_describe_memory(in) / particles,
          (double)sph_describe_memory(in) / 1e6);
  OWNED char *plain = text_close(out, &text);
  return plain ? text_people(plain) : NULL;
}
