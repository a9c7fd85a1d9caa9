/* One run in its own child process, with limits and a deadline. No error of the run can affect the slot. */
#ifndef CLAST_CAMPAIGN_FARM_ISOLATE_H
#define CLAST_CAMPAIGN_FARM_ISOLATE_H

#include "campaign/farm/slot.h"

/* Kept by a slot between runs. */
struct farm_isolate {
  int channel;      /* the slot's: when it closes, the child is killed and the slot ends */
  int child_signal; /* signalfd of SIGCHLD */
  int result[2];    /* pipe; renewed after a run that may have left something in it */
  struct farm_bytes in;
};

bool farm_isolate_open(struct farm_isolate *isolate, int channel);
/* Runs the task in a child and appends the RESULT frame to `out`. False when memory or processes are refused. */
bool farm_isolate_run(struct farm_isolate *isolate, const struct farm_slot_setup *setup, int slot, uint64_t handle,
                      const uint8_t *task, size_t size, struct farm_bytes *out);

/* Ending of a run whose work returned `verdict`. A lack of memory or disk counts as a fault of the machine, unless the
 * campaign has a memory limit (`limited`). */
enum farm_ending farm_isolate_ending(int64_t verdict, bool limited);
/* Ending of a run whose process was killed by this signal. The run itself raises only the signals of a crash (SIGSEGV,
 * SIGABRT and the like). All others come from outside: from a user, a batch system, or the kernel out of memory. */
enum farm_ending farm_isolate_ending_by(int signal_number);

void farm_isolate_limit_memory(size_t bytes); /* soft RLIMIT_AS; 0 = none */

#endif
