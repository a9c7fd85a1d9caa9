/* Shared by the commands that compute with a farm: their options, and the farm from its start to its end. */
#pragma once

#include "campaign/scheduler/scheduler.h"
#include "campaign/terminal/option.h"
#include "campaign/terminal/table.h"

struct launch_options {
  int64_t slots;
  bool in_process, quiet;
};

#define LAUNCH_OPTIONS(type_, member_)                                                                                 \
  OPTION_ROW_INTEGER(                                                                                                  \
      "slots", 'j', "N", type_, member_.slots, 0, 4096, "0",                                                           \
      .doc =                                                                                                           \
          "Runs at a time. Under mpirun or srun: per rank. 0: one per core, or under mpirun or srun one per rank."),   \
      OPTION_ROW_FLAG("in-process", 0, type_, member_.in_process,                                                      \
                      .doc = "Compute runs in the slot's own process. Faster for runs of a few milliseconds, but a "   \
                             "crash ends the slot "                                                                    \
                             "too."),                                                                                  \
      OPTION_ROW_FLAG("quiet", 'q', type_, member_.quiet,                                                              \
                      .doc = "Print no progress and no remarks on stderr but on numbers in doubt (!). Warnings and "   \
                             "errors are printed.")

/* Context of launch_note, which prints remarks for the user. */
struct launch_notes {
  struct progress *progress; /* NULL: none is shown */
  bool quiet;                /* warnings only */
};
void launch_note(void *notes, const char *text);

/* The farm of a command. A variable of type LAUNCH ends the farm where its block is left. */
struct launch {
  struct farm *farm;
  struct scheduler_options scheduler; /* facts, notes and slots are filled in; the command adds the store */
  struct launch_notes notes;
  char *facts;  /* owned */
  bool manager; /* rank 0 */
  double begin_s;
};
#define LAUNCH __attribute__((cleanup(launch_end))) struct launch

/* Starts the farm, on every rank, before anything opens HDF5 or starts a thread. `limits`: limits of time and memory.
 */
status launch_begin(struct launch *launch, const struct campaign *limits, const struct launch_options *options,
                    const struct command_line *line, struct error *error);
void launch_end(struct launch *launch); /* for LAUNCH; a zeroed one is fine */

/* Prints a line on stderr: how many runs were computed, and how many were found in the store (-1: left out). */
void launch_tell_runs(const char *store, int64_t computed, int64_t found, double cpu_s, double wall_s);

/* No progress is shown from here on. launch_series() and launch_end() do it, too. */
void launch_end_progress(struct launch *launch);

/* Runs a series (driver_run_series()) into the store of its limits. Then prints that line, and one when runs failed;
 * nothing on other ranks or when the user asked for quiet. found: whether to tell how many were found in the store. */
status launch_series(struct launch *launch, const struct series *series, bool found, struct error *error);

/* Runs at a time on all ranks, as the farm will have them: known before it starts. slots: the option; 0: not given. */
int launch_slots(int64_t slots);

/* True on a rank other than 0. Before MPI_Init only the launcher's environment tells. */
bool launch_other_rank(void);

/* Under mpirun only rank 0 prints errors: on other ranks this clears the message. It also lets the process live a
 * moment longer, because mpirun ends all ranks when the first one leaves with an error. Returns `code`. */
status launch_quiet_ranks(status code, struct error *error);

/* ---- From a campaign to its finished store: shared by `clast run` and `clast retry` ---- */

/* Runs the campaign with a farm, and prints the table of estimates from the store at the end, on rank 0. */
status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error);
