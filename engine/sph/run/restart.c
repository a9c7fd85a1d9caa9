/* What a run's next step depends on, as the parts of a restart file: state, samples of the curve, moving system. */
#include "engine/restart.h"

#include <stdlib.h>

#include "engine/sph/run/run.h"
#include "engine/sph/sph.h"

enum { STATE, SAMPLES, SYSTEM, PARTS };

status sph_restart_save(struct sph_run *run, const char *path, struct error *error) {
  size_t size = sph_system_state_size(run->system);
  void *system = malloc(size);
  if (!system)
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  sph_system_state_save(run->system, system);
  const struct restart_part parts[PARTS] = {
      [STATE] = {&run->state, sizeof run->state},
      [SAMPLES] = {run->sample, run->state.samples * sizeof *run->sample},
      [SYSTEM] = {system, size},
  };
  status code = restart_save(&sph_engine, &run->inputs, run->seed, PARTS, parts, path, error);
  free(system);
  return code;
}

static bool take(struct sph_run *run, const struct restart *restart) {
  const struct restart_part system = restart_part(restart, SYSTEM);
  return restart_copy(restart, STATE, &run->state, sizeof run->state) && run->state.samples <= run->sample_capacity &&
         restart_copy(restart, SAMPLES, run->sample, run->state.samples * sizeof *run->sample) &&
         sph_system_state_load(run->system, system.at, system.size);
}

status sph_restart_load(const struct sph_inputs *inputs, const char *path, struct sph_run **out, struct error *error) {
  *out = NULL;
  struct restart *restart = NULL;
  struct sph_run *run = NULL;
  status code = restart_open(&sph_engine, inputs, PARTS, path, &restart, error);
  if (!code)
    code = sph_run_create(inputs, restart_seed(restart), &run, error);
  if (!code && !take(run, restart))
    code = sph_system_fault(run->system) == SPH_FAULT_MEMORY
               ? status_fail(error, STATUS_MEMORY, "%s", sph_system_failure(run->system))
               : restart_refuse(path, error);
  restart_close(restart);
  if (code)
    sph_run_free(run);
  else
    *out = run;
  return code;
}
