/* The descriptor of engine `sph`: its calls are those of the run and its reports. */
#include "engine/sph/sph.h"

#include "engine/sph/run/run.h"
#include "engine/sph/scene/derived.h"

static int64_t *threads(void *inputs) {
  return &((struct sph_inputs *)inputs)->fidelity.threads;
}

static status prepare(const void *inputs, uint64_t seed, void **run, struct error *error) {
  struct sph_run *made;
  status code = sph_run_create(inputs, seed, &made, error);
  *run = made;
  return code;
}

static void *copy_system(const void *run, size_t *size) {
  return sph_system_state_copy(((const struct sph_run *)run)->system, size);
}

static status load_system(void *run, const void *bytes, size_t size, struct error *error) {
  const struct sph_run *r = run;
  if (sph_system_state_load(r->system, bytes, size))
    return STATUS_OK;
  status code = r->system->fault == SPH_FAULT_MEMORY ? STATUS_MEMORY : STATUS_CONTENT;
  return status_fail(error, code, "%s", r->system->failure);
}

static const size_t also[] = {offsetof(struct sph_results, crater.depth),
                              offsetof(struct sph_results, crater.radius),
                              offsetof(struct sph_results, ejecta.mass_fraction),
                              offsetof(struct sph_results, shock.speed),
                              offsetof(struct sph_results, precursor.speed),
                              offsetof(struct sph_results, precursor.pressure)};

static const struct knob knobs[] = {
    KNOB("particles", RESOLUTION,
         .inputs = {{"fidelity.particles", 1},
                    {"fidelity.spacings_per_radius", 1.0 / 3},
                    {"fidelity.fine_spacing", -1.0 / 3, .given = true},
                    {"fidelity.fine_radius", 0}},
         KNOB_THIRDS, .step_power = -1.0 / 3, .tell_unkept = sph_derived_tell_unkept,
         .meaning = "number of particles of the target; all spacings follow: that of the projectile, and in a graded "
                    "body that of the zone that it hits"),
    KNOB("impact_zone", PART,
         .inputs = {{"fidelity.spacings_per_radius", 1},
                    {"fidelity.fine_spacing", -1, .given = true},
                    {"fidelity.fine_radius", 0}},
         .factors = {0.5, 0.71, 1, 1.41}, .step_power = -1, .tell_unkept = sph_derived_tell_unkept,
         .meaning = "particle spacings in the projectile's radius where it hits and in the projectile; the number of "
                    "particles stays, so that the rest of the body gets coarser"),
    KNOB("points", RESOLUTION, .inputs = {{"fidelity.points", 1}}, KNOB_HALVES, .step_power = -1,
         .meaning = "spacings along a plate"),
    KNOB("projectile", RESOLUTION, .inputs = {{"fidelity.projectile_spacing", 1}}, .factors = {2, 1.41, 1, 0.71},
         .step_power = 1, .meaning = "particle spacing of the projectile over the target's"),
    KNOB("time_step", RESOLUTION,
         .inputs = {{"fidelity.cfl", 1}, {"fidelity.damage_step", 1}, {"fidelity.distention_step", 1}}, KNOB_HALVES,
         .step_power = 1, .pairs = true, .meaning = "all limits of the time step together"),
    KNOB("courant", PART, .inputs = {{"fidelity.cfl", 1}}, KNOB_HALVES, .step_power = 1, .pairs = true,
         .meaning = "time step over what a wave needs through h"),
    KNOB("damage_step", PART, .inputs = {{"fidelity.damage_step", 1}}, .factors = {2, 1, 0.5, 0.25, 0.1},
         .step_power = 1, .pairs = true, .meaning = "largest change of D^(1/3) in a time step"),
    KNOB("precision", RESOLUTION, .inputs = {{"fidelity.precision"}}, .choices = {"float", "double"}, .pairs = true,
         .meaning = "arithmetic of the pair loop"),
    KNOB("flaw_list", RESOLUTION, .inputs = {{"fidelity.flaws"}}, .choices = {"compact", "exact"}, .pairs = true,
         .meaning = "how a particle's flaws are stored"),
    KNOB("stop", RESOLUTION, .inputs = {{"stop.quiet_time", 1}, {"stop.end_time", 1}}, .factors = {0.5, 1, 2, 4},
         .pairs = true, .meaning = "how long no damage must grow until the run ends; stop.end_time moves with it"),

    KNOB("smoothing", MODEL, .inputs = {{"fidelity.smoothing", 1}}, .factors = {0.9, 1, 1.15, 1.3}, .pairs = true,
         .meaning = "smoothing length over the spacing: number of neighbours"),
    KNOB("viscosity", MODEL, .inputs = {{"viscosity.alpha", 1}, {"viscosity.beta", 1}}, .factors = {2, 1, 0.5},
         .step_power = 1, .pairs = true, .meaning = "artificial viscosity, linear and quadratic together"),
    KNOB("strength", MODEL, .inputs = {{"target.strength"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "the target resists shear"),
    KNOB("fracture", MODEL, .inputs = {{"target.fracture"}}, .choices = {"off"}, .pairs = true,
         .meaning = "the target has flaws, from which cracks grow"),
    KNOB("porosity", MODEL, .inputs = {{"target.material.porosity.curve"}}, .choices = {"none"}, .pairs = true,
         .meaning = "pores are crushed"),
    KNOB("gradient_correction", MODEL, .inputs = {{"method.gradient_correction"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "velocity gradients exact for linear fields"),
    KNOB("crack_surfaces", MODEL, .inputs = {{"method.crack_surfaces"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "matter that holds together does not feel loose neighbours"),
    KNOB("reconstruction", MODEL, .inputs = {{"method.reconstruction"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "viscosity on velocities carried to the midpoint of a pair"),
    KNOB("artificial_stress", MODEL, .inputs = {{"method.artificial_stress"}}, .choices = {"0", "0.3"}, .pairs = true,
         .meaning = "repulsion against clumping in tension"),
    KNOB("flaw_draw", MODEL, .inputs = {{"fracture.draw"}}, .choices = {"ranked", "poisson"},
         .meaning = "flaw strengths by rank, or drawn"),

    KNOB_OF_SETTINGS,
    {.name = NULL},
};

static const char *headline(const void *inputs) {
  const struct sph_inputs *in = inputs;
  switch ((enum sph_kind)in->kind) {
  case SPH_IMPACT:
    return in->sides.far == SPH_FAR_DAMPED ? "crater.volume" : NULL; /* of a half-space, no share has a meaning */
  case SPH_STRETCH: return "peak.stress";
  case SPH_VIBRATION: return "frequency";
  case SPH_PISTON: return "shock.pressure";
  default: return NULL;
  }
}

const struct engine_kind sph_engine = {
    .name = "sph",
    .dimensions = 3,
    .doc = "Solids that crack, in space: smoothed particle hydrodynamics with strength, Tillotson's equation of state "
           "and explicit Weibull flaws. Benz & Asphaug (1994, 1995), with the corrections and options that `clast "
           "explain` names at each input.",
    .results_version = 15,
    .inputs = &sph_inputs,
    .results = &sph_results,
    .knobs = knobs,
    .materials = &sph_materials,
    .complete = sph_inputs_complete,
    .check_given = sph_inputs_check_given,
    .remark = sph_inputs_remark,
    .check = sph_inputs_check,
    .conditions = sph_conditions,
    .headline = headline,
    .describe = sph_describe_scene,
    .also = also,
    .also_count = sizeof also / sizeof *also,
    .ejecta = offsetof(struct sph_results, ejecta_over_speed),
    .ejecta_sum = offsetof(struct sph_results, ejecta.momentum),
    .memory = sph_describe_memory,
    .steps = sph_describe_steps,
    .work = sph_describe_work,
    .threads = threads,
    .prepare = prepare,
    .step = frame_step,
    .progress = frame_progress,
    .time = frame_time,
    .finish = sph_report_finish,
    .write_snapshot = sph_snapshot_write,
    .copy_system = copy_system,
    .load_system = load_system,
    .free = sph_run_free,
};
