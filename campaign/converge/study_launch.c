/* Farm, rounds, tables. */
#include "campaign/converge/study_launch.h"

#include <stdio.h>

#include "campaign/converge/study_print.h"
#include "schemas/clock.h"

/* On the manager, when the rounds have ended. */
static status show(const struct study *study, const struct study_launch *asked, struct error *error) {
  status code = study_print(study, asked->format, asked->options->quiet, error);
  if (code == STATUS_OK && asked->picture)
    code = study_picture(study, false, asked->picture, error);
  if (code == STATUS_OK && asked->frontier)
    code = study_picture(study, true, asked->frontier, error);
  return code;
}

struct launching {
  struct study *study;
  const struct study_launch *asked;
};

static status run_study(void *context, struct launch *launch, struct error *error) {
  const struct launching *launching = context;
  struct study *study = launching->study;
  launch->driver.store_path = study->limits.store;
  status code = study_rounds_run(study, launch->farm, &launch->driver, error);
  const bool tells = launch->manager && !launch->notes.quiet;
  if (tells && (code == STATUS_OK || code == STATUS_STOPPED))
    launch_tell_runs(study->limits.store, study->runs_done, -1, study->cpu_s, clock_s() - launch->begin_s);
  if (tells && study->runs_failed)
    fprintf(stderr, "some runs failed: clast query %s --named failures\n", study->limits.store);
  return launch->manager && code == STATUS_OK ? show(study, launching->asked, error) : code;
}

status study_launch(struct study *study, const struct study_launch *asked, struct error *error) {
  struct launching launching = {study, asked};
  return launch_farm(&study->limits, asked->options, asked->line, run_study, &launching, error);
}
