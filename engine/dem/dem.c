/* The descriptor of engine `dem`. */
#include "engine/dem/dem.h"

#include <math.h>

#include "engine/dem/run/run.h"

/* An upper bound per grain: outlines, beams and contacts of the moving system, the tessellation, and the search for
 * fragments at the end. tests/unit/test_dem_engine.c compares it with the built-in scenes. */
enum { BYTES_PER_GRAIN = 4000, BYTES_ANYWAY = 1 << 20 };

static status check(const void *inputs, struct error *error) {
  return dem_inputs_check(inputs, error);
}

static char *describe(const void *inputs) {
  return dem_describe_scene(inputs);
}

static size_t memory(const void *inputs) {
  return (size_t)(dem_inputs_grains(inputs) * BYTES_PER_GRAIN) + BYTES_ANYWAY;
}

static unsigned warn(const void *inputs, FILE *out) {
  return dem_warn_inputs(inputs, out);
}

static double work(const void *inputs) {
  const struct dem_inputs *in = inputs;
  return dem_inputs_grains(in) * dem_inputs_end_time(in) / in->fidelity.time_step;
}

static status prepare(const void *inputs, uint64_t seed, void **run, struct error *error) {
  struct dem_run *made;
  status code = dem_run_create(inputs, seed, &made, error);
  *run = made;
  return code;
}

static status step(void *run, uint64_t max_steps, bool *finished, struct error *error) {
  struct dem_run *r = run;
  const status code = frame_advance(&r->frame, max_steps);
  *finished = r->state.frame.finished;
  return code ? status_fail(error, code, "no memory for a step") : STATUS_OK;
}

static double time_of(const void *run) {
  return dem_system_time(((const struct dem_run *)run)->system);
}

static double progress(const void *run) {
  const struct dem_run *r = run;
  return r->state.frame.finished ? 1 : fmin(dem_system_time(r->system) / dem_inputs_end_time(&r->inputs), 1);
}

static status finish(void *run, struct outcome *outcome, void *result, struct fragment **fragments,
                     size_t *fragment_count, struct error *error) {
  return dem_report_finish(run, outcome, result, fragments, fragment_count, error);
}

static status write_snapshot(void *run, const char *path, struct error *error) {
  return dem_snapshot_write(run, path, error);
}

static size_t system_size(const void *run) {
  return dem_system_state_size(((const struct dem_run *)run)->system);
}

static void save_system(const void *run, void *bytes) {
  dem_system_state_save(((const struct dem_run *)run)->system, bytes);
}

static status load_system(void *run, const void *bytes, size_t size, struct error *error) {
  const struct dem_run *r = run;
  return dem_system_state_load(r->system, bytes, size) ? STATUS_OK : status_fail(error, STATUS_CONTENT, "%s", "");
}

static void release(void *run) {
  dem_run_free(run);
}

static const struct knob knobs[] = {
    KNOB("grains", RESOLUTION, .inputs = {{"grain.spacing", 1}}, .factors = {2, 1.41, 1, 0.71}, .step_power = 1,
         .meaning = "mean size of a grain of a disc: half as many grains each"),
    KNOB("time_step", RESOLUTION, .inputs = {{"fidelity.time_step", 1}}, KNOB_HALVES, .step_power = 1, .pairs = true,
         .meaning = "time step"),
    KNOB("integrator", RESOLUTION, .inputs = {{"fidelity.integrator"}}, .choices = {"verlet", "gear"}, .pairs = true,
         .meaning = "velocity Verlet, or Gear's method of fifth order"),
    KNOB("stop", RESOLUTION, .inputs = {{"stop.quiet_time", 1}, {"stop.least_time", 1}, {"stop.end_time", 1}},
         .factors = {0.25, 0.5, 1, 2, 4}, .pairs = true,
         .meaning = "how long no beam must break until a run ends; its least time and the hard end move with it"),

    KNOB("contact_law", MODEL, .inputs = {{"contact.law"}}, .choices = {"off", "printed", "conservative"},
         .pairs = true, .meaning = "repulsion of overlapping grains"),
    KNOB("contact_bonded", MODEL, .inputs = {{"contact.bonded"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "grains that a beam joins repel each other, too"),
    KNOB("breaking", MODEL, .inputs = {{"threshold.breaking"}}, KNOB_ON_OFF, .pairs = true,
         .meaning = "beams may break"),
    KNOB_OF_SETTINGS,
    {.name = NULL},
};

const struct engine_kind dem_engine = {
    .name = "dem",
    .dimensions = 2,
    .doc =
        "Discrete elements in the plane: a solid of rigid Voronoi grains on breakable Timoshenko beams, with repulsion "
        "of overlapping grains. Kun, D'Addetta, Herrmann & Ramm (1999), with the corrections that `clast explain` "
        "names at each input.",
    /* 2: the reference side of a contact has a floor. 3: contacts that begin with a break (contact.bonded off) are in
     * the ledger; grains too fast for the time step end a run. 4: Gear's first coefficients; thresholds by place;
     * stop.least_time. */
    .results_version = 4,
    .inputs = &dem_inputs,
    .results = &dem_results,
    .knobs = knobs,
    .check = check,
    .warn = warn,
    .describe = describe,
    .memory = memory,
    .work = work,
    .prepare = prepare,
    .step = step,
    .progress = progress,
    .time = time_of,
    .finish = finish,
    .write_snapshot = write_snapshot,
    .system_size = system_size,
    .save_system = save_system,
    .load_system = load_system,
    .free = release,
};
