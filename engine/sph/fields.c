#include "engine/sph/run.h"
status sph_fields_write(struct sph_run *run, const char *path, struct error *error) { (void)run; return status_fail(error, STATUS_INTERNAL, "no fields for %s", path); }
