#include "engine/sph/run.h"
status sph_restart_save(struct sph_run *run, const char *path, struct error *error) { (void)run; return status_fail(error, STATUS_INTERNAL, "no restart for %s", path); }
status sph_restart_load(const struct sph_inputs *inputs, const char *path, struct sph_run **out, struct error *error) {(void)inputs; *out = NULL; return status_fail(error, STATUS_INTERNAL, "no restart for %s", path); }
