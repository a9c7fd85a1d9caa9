/* The descriptor of engine `sph`: its hooks call the run and its reports. */
#include "engine/sph/sph.h"

#include <math.h>

#include "engine/restart.h"
#include "engine/sph/observe/observe.h"

static void complete(void *inputs, const bool *given) {
  sph_inputs_complete(inputs, given);
}

static status check_given(const void *inputs, const bool *given, struct error *error) {
  return sph_inputs_check_given(inputs, given, error);
}
static status check(const void *inputs, struct error *error) {
  return sph_inputs_check(inputs, error);
}

static unsigned warn(const void *inputs, FILE *out) {
  return sph_warn_inputs(inputs, out);
}

static char *describe(const void *inputs) {
  return sph_describe_scene(inputs);
}

static size_t memory(const void *inputs) {
  return sph_describe_memory(inputs);
}

static double work(const void *inputs) {
  return sph_describe_work(inputs);
}

static int64_t *threads(void *inputs) {
  return &((struct sph_inputs *)inputs)->fidelity.threads;
}

static status prepare(const void *inputs, uint64_t seed, void **run, struct error *error) {
  struct sph_run *made;
  status code = sph_run_create(inputs, seed, &made, error);
  *run = made;
  return code;
}

static status step(void *run, uint64_t max_steps, bool *finished, struct error *error) {
  struct sph_run *r = run;
  const status code = sph_run_advance(r, max_steps);
  *finished = r->state.finished;
  return code ? status_fail(error, code, "%s", sph_system_failure(r->system)) : STATUS_OK;
}

static double time_of(const void *run) {
  return sph_system_time(((const struct sph_run *)run)->system);
}

static double progress(const void *run) {
  const struct sph_run *r = run;
  return r->state.finished ? 1 : fmin(sph_system_time(r->system) / r->inputs.stop.end_time, 1);
}

static status finish(void *run, struct outcome *outcome, void *result, struct fragment **fragments,
                     size_t *fragment_count, struct error *error) {
  return sph_report_finish(run, outcome, result, fragments, fragment_count, error);
}

static status write_snapshot(void *run, const char *path, struct error *error) {
  return sph_snapshot_write(run, path, error);
}

static struct restart_run restart(void *run) {
  struct sph_run *r = run;
  return (struct restart_run){.inputs = &r->inputs,
                              .seed = r->seed,
                              .state = {&r->state, sizeof r->state},
                              .samples = &r->state.samples,
                              .sample = r->sample,
                              .sample_size = sizeof *r->sample,
                              .sample_capacity = r->sample_capacity,
                              .system_size = sph_system_state_size(r->system)};
}

static void save_system(const void *run, void *bytes) {
  sph_system_state_save(((const struct sph_run *)run)->system, bytes);
}

static status load_system(void *run, const void *bytes, size_t size, struct error *error) {
  const struct sph_run *r = run;
  if (sph_system_state_load(r->system, bytes, size))
    return STATUS_OK;
  status code = sph_system_fault(r->system) == SPH_FAULT_MEMORY ? STATUS_MEMORY : STATUS_CONTENT;
  return status_fail(error, code, "%s", sph_system_failure(r->system));
}

static void release(void *run) {
  sph_run_free(run);
}

const struct engine_kind sph_engine = {
    .name = "sph",
    .dimensions = 3,
    .doc =
        "Solids that crack, in space: smoothed particle hydrodynamics with strength, Tillotson's equation of state and "
        "explicit Weibull flaws. Benz & Asphaug (1994, 1995), with the corrections and options that `clast explain` "
        "names "
        "at each input.",
    .results_version = 7,
    .inputs = &sph_inputs,
    .results = &sph_results,
    .complete = complete,
    .check_given = check_given,
    .check = check,
    .warn = warn,
    .describe = describe,
    .memory = memory,
    .work = work,
    .threads = threads,
    .prepare = prepare,
    .step = step,
    .progress = progress,
    .time = time_of,
    .finish = finish,
    .write_snapshot = write_snapshot,
    .restart = restart,
    .save_system = save_system,
    .load_system = load_system,
    .free = release,
};
