/* What a run's next step depends on, as the parts of a restart file: state, samples of the curve, moving system. */
#include "engine/restart.h"

#include <stdlib.h>
#include <string.h>

#include "engine/sph/sph.h"
#include "engine/sph/run.h"

enum { CPU, STATE, SAMPLES, SYSTEM, PARTS }; /* CPU: the class, within which bits are the same */

status sph_restart_save(struct sph_run *run, const char *path, struct error *error) {
  size_t size = sph_system_state_size(run->system);
  void *system = malloc(size);
  if (!system)
    return status_fail(error, STATUS_MEMORY, "no memory to save '%s'", path);
  sph_system_state_save(run->system, system);
  const char *cpu = sph_system_cpu_class(run->system);
  const struct restart_part parts[PARTS] = {
      [CPU] = {cpu, strlen(cpu)},
      [STATE] = {&run->state, sizeof run->state},
      [SAMPLES] = {run->sample, run->state.samples * sizeof *run->sample},
      [SYSTEM] = {system, size},
  };
  status code = restart_save(&sph_engine, &run->inputs, run->seed, PARTS, parts, path, error);
  free(system);
  return code;
}

static bool take(struct sph_run *run, const struct restart *restart) {
  struct restart_part state = restart_part(restart, STATE), samples = restart_part(restart, SAMPLES);
  struct restart_part system = restart_part(restart, SYSTEM);
  const struct restart_part cpu = restart_part(restart, CPU);
  const char *here = sph_system_cpu_class(run->system);
  if (cpu.size != strlen(here) || memcmp(cpu.at, here, cpu.size) != 0 || state.size != sizeof run->state)
    return false;
  memcpy(&run->state, state.at, state.size);
  if (run->state.samples > run->sample_capacity || samples.size != run->state.samples * sizeof *run->sample)
    return false;
  if (samples.size)
    memcpy(run->sample, samples.at, samples.size);
  return sph_system_state_load(run->system, system.at, system.size);
}

status sph_restart_load(const struct sph_inputs *inputs, const char *path, struct sph_run **out, struct error *error) {
  *out = NULL;
  struct restart *restart = NULL;
  struct sph_run *run = NULL;
  status code = restart_open(&sph_engine, inputs, PARTS, path, &restart, error);
  if (!code)
    code = sph_run_create(inputs, restart_seed(restart), &run, error);
  if (!code && !take(run, restart))
    code = restart_refuse(path, error);
  restart_close(restart);
  if (code)
    sph_run_free(run);
  else
    *out = run;
  return code;
}
