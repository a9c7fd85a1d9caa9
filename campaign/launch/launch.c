/* The farm of a command, and the messages about its runs. */
#include "campaign/launch/launch.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/scheduler/provenance.h"
#include "campaign/scheduler/run.h"
#include "schemas/clock.h"

void launch_note(void *context, const char *text) {
  const struct launch_notes *notes = context;
  const bool warning = strncmp(text, "warning", 7) == 0;
  if (notes->quiet && !warning)
    return;
  if (notes->progress)
    progress_note(notes->progress, text);
  else
    fprintf(stderr, "clast: %s\n", text);
}

void launch_tell_runs(const char *store, int64_t computed, int64_t found, double cpu_s, double wall_s) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %" PRId64 " run%s computed in %s (%s of processor time)", store, computed,
          computed == 1 ? "" : "s", wall, cpu);
  if (found >= 0)
    fprintf(stderr, ", %" PRId64 " found in the store", found);
  fputc('\n', stderr);
}

void launch_tell_series(const struct launch *launch, status code, const char *store,
                        const struct series_summary *summary, bool found) {
  if (!launch->manager || launch->notes.quiet)
    return;
  if (code == STATUS_OK || code == STATUS_STOPPED)
    launch_tell_runs(store, summary->runs_done, found ? summary->runs_reused : -1, summary->cpu_s,
                     clock_s() - launch->begin_s);
  if (summary->runs_failed)
    fprintf(stderr, "some runs failed: clast query %s --named failures\n", store);
}

status launch_farm(const struct campaign *limits, const struct launch_options *options, const struct command_line *line,
                   status (*body)(void *context, struct launch *launch, struct error *error), void *context,
                   struct error *error) {
  struct farm_options farm_options = {.slots = (int)options->slots,
                                      .in_process = options->in_process,
                                      .use_mpi = farm_under_mpi()};
  struct farm *farm = NULL;
  scheduler_limits(limits, &farm_options);
  TRY(farm_start(&farm_options, run_work, &farm, error));
  struct launch launch = {.farm = farm, .manager = farm_rank(farm) == 0, .notes = {.quiet = options->quiet}};
  char *facts = provenance_json(farm_ranks(farm), farm_slots_total(farm), line->argc, line->argv);
  launch.scheduler = (struct scheduler_options){.facts = facts,
                                                .note = launch_note,
                                                .note_context = &launch.notes,
                                                .slots = farm_slots_total(farm)};
  launch.begin_s = clock_s();
  status code = facts ? body(context, &launch, error) : status_fail(error, STATUS_MEMORY, "out of memory");
  free(facts);
  const status stopped = farm_stop(farm, code ? NULL : error);
  return code ? code : stopped;
}

bool launch_other_rank(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};
  if (!farm_under_mpi() && farm_launched() <= 1)
    return false;
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    const char *rank = getenv(names[i]);
    if (rank)
      return strcmp(rank, "0") != 0;
  }
  return false;
}

status launch_quiet_ranks(status code, struct error *error) {
  if (code == STATUS_OK || !launch_other_rank())
    return code;
  error->message[0] = '\0';
  nanosleep(&(struct timespec){.tv_nsec = 500000000}, NULL);
  return code;
}
