/* A slot: a process that takes tasks from its channel and gives results back, one at a time.
 *
 * Tasks may be sent before the slot is free, and can still be taken back: each sent task has a ticket in memory shared
 * with the main process. The process that swaps the ticket out owns the task: the slot runs it, or the main process
 * gives it to an idle slot. So the last tasks of a campaign never wait behind a long one. */
#ifndef CLAST_CAMPAIGN_FARM_SLOT_H
#define CLAST_CAMPAIGN_FARM_SLOT_H

#include <stdatomic.h>
#include <sys/types.h>

#include "campaign/farm/farm.h"
#include "campaign/farm/frame.h"

#define FARM_SLOT_TICKETS 64

struct farm_slot_record {
  _Atomic uint64_t running;                   /* handle of the running task, 0 = none; a crash is counted for it */
  _Atomic int64_t started_ns;                 /* start time of `running` */
  _Atomic uint64_t ticket[FARM_SLOT_TICKETS]; /* handle of the waiting task, 0 = taken by either side */
};

struct farm_slot_setup {
  struct farm_options options;
  farm_work work;
  struct farm_slot_record *records; /* one per slot, shared */
};

/* Main function of a slot process whose parent is `parent`; serves until the channel closes. */
_Noreturn void farm_slot_serve(const struct farm_slot_setup *setup, int slot, int channel, pid_t parent);

/* Makes the kernel kill this process when `parent` dies. Then checks `parent`, which may have died before the call. */
void farm_slot_die_with(pid_t parent);

#endif
