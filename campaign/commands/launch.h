/* From a campaign to its finished store: what `clast run` and `clast retry` share. */
#ifndef CLAST_CAMPAIGN_COMMANDS_LAUNCH_H
#define CLAST_CAMPAIGN_COMMANDS_LAUNCH_H

#include "campaign/document/campaign.h"
#include "campaign/terminal/option.h"
#include "campaign/terminal/table.h"

struct launch_options {
  int64_t slots;
  bool in_process, quiet;
  struct table_options table;
};

#define LAUNCH_OPTIONS(type_, member_)                                                                                 \
  OPTION_ROW_INTEGER(                                                                                                  \
      "slots", 'j', "N", type_, member_.slots, 0, 4096, "0",                                                           \
      "Runs at a time. Under mpirun or srun: per rank. 0: one per core, or under mpirun or srun one per rank."),       \
      OPTION_ROW_FLAG(                                                                                                 \
          "in-process", 0, type_, member_.in_process,                                                                  \
          "Compute runs in the slot's own process. Faster for runs of a few milliseconds, but a crash ends the slot "  \
          "too."),                                                                                                     \
      OPTION_ROW_FLAG("quiet", 'q', type_, member_.quiet,                                                              \
                      "Print no progress and no remarks on stderr. Warnings and errors are printed.")

/* Starts the farm, runs the campaign, and prints the table of estimates from the store at the end, on rank 0. The farm
 * is started before anything opens HDF5 or starts a thread. */
status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error);

/* Is this a rank other than 0? Before MPI_Init only the launcher's environment tells. */
bool launch_other_rank(void);

/* Under mpirun only rank 0 prints errors: on other ranks this clears the message. It also lets the process live a
 * moment longer, because mpirun ends all ranks when the first one leaves with an error. Returns `code`. */
status launch_quiet_ranks(status code, struct error *error);

#endif
