/* The list of knobs. */
#include "engine/knob.h"

#include <string.h>

#include "schemas/text.h"

const char *const knob_group_names[] = {"resolution", "part", "model", "settings"};

/* Factors of particles and grains: a third of the number each, so that the spacing of an SPH body changes by 1.44. Time
 * steps: halves. */
#define SPH(name_, group_, ...)                                                                                        \
  { .name = name_, .engine = "sph", .group = KNOB_##group_, __VA_ARGS__ }
#define DEM(name_, group_, ...)                                                                                        \
  { .name = name_, .engine = "dem", .group = KNOB_##group_, __VA_ARGS__ }
#define THIRDS .factors = {1.0 / 9, 1.0 / 3, 1, 3}
#define HALVES .factors = {2, 1, 0.5, 0.25, 0.125}
#define ON_OFF .choices = {"false", "true"}

static const struct knob knobs[] = {
    SPH("particles", RESOLUTION, .inputs = {{"fidelity.particles", 1}}, THIRDS, .step_power = -1.0 / 3,
        .meaning = "number of particles of the target; the projectile's spacing follows"),
    SPH("points", RESOLUTION, .inputs = {{"fidelity.points", 1}}, HALVES, .step_power = -1,
        .meaning = "spacings along a plate"),
    SPH("projectile", RESOLUTION, .inputs = {{"fidelity.projectile_spacing", 1}}, .factors = {2, 1.41, 1, 0.71},
        .step_power = 1, .meaning = "particle spacing of the projectile over the target's"),
    SPH("time_step", RESOLUTION,
        .inputs = {{"fidelity.cfl", 1}, {"fidelity.damage_step", 1}, {"fidelity.distention_step", 1}}, HALVES,
        .step_power = 1, .pairs = true, .meaning = "all limits of the time step together"),
    SPH("courant", PART, .inputs = {{"fidelity.cfl", 1}}, HALVES, .step_power = 1, .pairs = true,
        .meaning = "time step over what a wave needs through h"),
    SPH("damage_step", PART, .inputs = {{"fidelity.damage_step", 1}}, .factors = {2, 1, 0.5, 0.25, 0.1},
        .step_power = 1, .pairs = true, .meaning = "largest change of D^(1/3) in a time step"),
    SPH("precision", RESOLUTION, .inputs = {{"fidelity.precision"}}, .choices = {"float", "double"}, .pairs = true,
        .meaning = "arithmetic of the pair loop"),
    SPH("flaw_list", RESOLUTION, .inputs = {{"fidelity.flaws"}}, .choices = {"compact", "exact"}, .pairs = true,
        .meaning = "how a particle's flaws are stored"),
    SPH("stop", RESOLUTION, .inputs = {{"stop.quiet_time", 1}, {"stop.end_time", 1}}, .factors = {0.5, 1, 2, 4},
        .pairs = true, .meaning = "how long no damage must grow until the run ends; the hard end moves with it"),

    SPH("smoothing", MODEL, .inputs = {{"fidelity.smoothing", 1}}, .factors = {0.9, 1, 1.15, 1.3}, .pairs = true,
        .meaning = "smoothing length over the spacing: number of neighbours"),
    SPH("strength", MODEL, .inputs = {{"target.strength"}}, ON_OFF, .pairs = true,
        .meaning = "the target resists shear"),
    SPH("fracture", MODEL, .inputs = {{"target.fracture"}}, .choices = {"off"}, .pairs = true,
        .meaning = "the target has flaws, from which cracks grow"),
    SPH("porosity", MODEL, .inputs = {{"target.material.porosity.curve"}}, .choices = {"none"}, .pairs = true,
        .meaning = "pores are crushed"),
    SPH("gradient_correction", MODEL, .inputs = {{"method.gradient_correction"}}, ON_OFF, .pairs = true,
        .meaning = "velocity gradients exact for linear fields"),
    SPH("artificial_stress", MODEL, .inputs = {{"method.artificial_stress"}}, .choices = {"0", "0.3"}, .pairs = true,
        .meaning = "repulsion against clumping in tension"),
    SPH("flaw_draw", MODEL, .inputs = {{"fracture.draw"}}, .choices = {"ranked", "poisson"},
        .meaning = "flaw strengths by rank, or drawn"),

    SPH("settings", SETTINGS, .meaning = "named settings of the scene (`settings` in its document): draft, reference"),

    DEM("grains", RESOLUTION, .inputs = {{"grain.spacing", 1}}, .factors = {2, 1.41, 1, 0.71}, .step_power = 1,
        .meaning = "mean size of a grain of a disc: half as many grains each"),
    DEM("time_step", RESOLUTION, .inputs = {{"fidelity.time_step", 1}}, HALVES, .step_power = 1, .pairs = true,
        .meaning = "time step"),
    DEM("integrator", RESOLUTION, .inputs = {{"fidelity.integrator"}}, .choices = {"verlet", "gear"}, .pairs = true,
        .meaning = "velocity Verlet, or Gear's method of fifth order"),
    DEM("stop", RESOLUTION, .inputs = {{"stop.quiet_time", 1}, {"stop.least_time", 1}, {"stop.end_time", 1}},
        .factors = {0.25, 0.5, 1, 2, 4}, .pairs = true,
        .meaning = "how long no beam must break until a run ends; its least time and the hard end move with it"),

    DEM("contact_law", MODEL, .inputs = {{"contact.law"}}, .choices = {"off", "printed", "conservative"}, .pairs = true,
        .meaning = "repulsion of overlapping grains"),
    DEM("contact_bonded", MODEL, .inputs = {{"contact.bonded"}}, ON_OFF, .pairs = true,
        .meaning = "grains that a beam joins repel each other, too"),
    DEM("breaking", MODEL, .inputs = {{"threshold.breaking"}}, ON_OFF, .pairs = true, .meaning = "beams may break"),
    DEM("settings", SETTINGS, .meaning = "named settings of the scene (`settings` in its document): draft, reference"),
};
_Static_assert(sizeof knobs / sizeof knobs[0] <= KNOB_MOST, "raise KNOB_MOST");

size_t knob_count(void) {
  return sizeof knobs / sizeof knobs[0];
}

const struct knob *knob_at(size_t index) {
  return &knobs[index];
}

size_t knob_index(const struct knob *knob) {
  return (size_t)(knob - knobs);
}

const struct knob *knob_find(const char *engine, const char *name, struct error *error) {
  char known[1024] = "";
  for (size_t i = 0; i < knob_count(); i++) {
    if (strcmp(knobs[i].engine, engine) != 0)
      continue;
    if (strcmp(knobs[i].name, name) == 0)
      return &knobs[i];
    text_append(known, sizeof known, "%s%s", *known ? ", " : "", knobs[i].name);
  }
  status_fail(error, STATUS_USAGE, "engine %s has no knob '%.64s'; it has %s (`clast converge --list`)", engine, name,
              *known ? known : "none");
  return NULL;
}
