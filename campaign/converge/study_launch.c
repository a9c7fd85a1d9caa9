/* Farm, rounds, tables. */
#include "campaign/converge/study_launch.h"

#include <stdlib.h>
#include <string.h>

#include "campaign/converge/study_print.h"
#include "campaign/driver/provenance.h"
#include "campaign/driver/run.h"
#include "campaign/terminal/progress.h"
#include "schemas/clock.h"

static void note(void *context, const char *text) {
  const struct study_launch *launch = context;
  if (!launch->quiet || strncmp(text, "warning", 7) == 0)
    fprintf(stderr, "clast: %s\n", text);
}

static void print_summary(const struct study *study, double wall_s) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(study->cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %lld runs computed in %s (%s of processor time)%s\n", study->limits.store,
          (long long)study->runs_done, wall, cpu, study->runs_failed ? "; some runs failed" : "");
}

/* On the manager, when the rounds have ended. */
static status show(const struct study *study, const struct study_launch *launch, struct error *error) {
  status code = study_print(study, launch->format, launch->quiet, error);
  if (code == STATUS_OK && launch->picture)
    code = study_picture(study, false, launch->picture, error);
  if (code == STATUS_OK && launch->frontier)
    code = study_picture(study, true, launch->frontier, error);
  return code;
}

status study_launch(struct study *study, const struct study_launch *launch, struct error *error) {
  struct farm_options farm_options = {.slots = launch->slots,
                                      .in_process = launch->in_process,
                                      .use_mpi = farm_under_mpi()};
  struct farm *farm = NULL;
  driver_farm_options(&study->limits, &farm_options);
  status code = farm_start(&farm_options, run_work, &farm, error);
  if (code)
    return code;
  char *facts = provenance_json(farm_ranks(farm), farm_slots_total(farm), launch->argc, launch->argv);
  const struct driver_options driver = {.store_path = study->limits.store,
                                        .facts = facts,
                                        .note = note,
                                        .note_context = (void *)launch};
  const double begin = clock_s();
  code = facts ? study_rounds_run(study, farm, &driver, error) : status_fail(error, STATUS_MEMORY, "out of memory");
  free(facts);
  if (farm_rank(farm) == 0 && !launch->quiet && (code == STATUS_OK || code == STATUS_STOPPED))
    print_summary(study, clock_s() - begin);
  if (farm_rank(farm) == 0 && code == STATUS_OK)
    code = show(study, launch, error);
  status stopped = farm_stop(farm, code ? NULL : error);
  return code ? code : stopped;
}
