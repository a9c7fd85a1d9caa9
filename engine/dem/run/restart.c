/* What a run's next step depends on, as the parts of a restart file: state, samples of the curve, moving system. */
#include "engine/restart.h"

#include <stdlib.h>

#include "engine/dem/dem.h"
#include "engine/dem/run/run.h"

enum { STATE, SAMPLES, SYSTEM, PARTS };

status dem_restart_save(struct dem_run *run, const char *path, struct error *error) {
  size_t size = dem_system_state_size(run->system);
  void *system = malloc(size);
  if (!system)
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  dem_system_state_save(run->system, system);
  const struct restart_part parts[PARTS] = {
      [STATE] = {&run->state, sizeof run->state},
      [SAMPLES] = {run->sample, run->state.samples * sizeof *run->sample},
      [SYSTEM] = {system, size},
  };
  status code = restart_save(&dem_engine, &run->inputs, run->seed, PARTS, parts, path, error);
  free(system);
  return code;
}

static bool take(struct dem_run *run, const struct restart *restart) {
  const struct restart_part system = restart_part(restart, SYSTEM);
  return restart_copy(restart, STATE, &run->state, sizeof run->state) && run->state.samples <= run->sample_capacity &&
         restart_copy(restart, SAMPLES, run->sample, run->state.samples * sizeof *run->sample) &&
         dem_system_state_load(run->system, system.at, system.size);
}

status dem_restart_load(const struct dem_inputs *inputs, const char *path, struct dem_run **out, struct error *error) {
  *out = NULL;
  struct restart *restart = NULL;
  struct dem_run *run = NULL;
  status code = restart_open(&dem_engine, inputs, PARTS, path, &restart, error);
  if (!code)
    code = dem_run_create(inputs, restart_seed(restart), &run, error);
  if (!code && !take(run, restart))
    code = restart_refuse(path, error);
  restart_close(restart);
  if (code)
    dem_run_free(run);
  else
    *out = run;
  return code;
}
