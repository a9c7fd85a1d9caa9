/* A slot: a process that takes tasks from its channel and gives results back, one at a time.
 *
 * Tasks may be sent ahead. What has been sent can still be taken back exactly: each sent task holds a ticket in memory
 * shared with the main process, and whoever swaps the ticket out owns the task: the slot to run it, the main process to
 * give it to somebody idle. So prefetching never makes the last tasks of a campaign wait behind a long one. */
#ifndef CLAST_CAMPAIGN_FARM_SLOT_H
#define CLAST_CAMPAIGN_FARM_SLOT_H

#include <stdatomic.h>
#include <sys/types.h>

#include "campaign/farm/farm.h"
#include "campaign/farm/frame.h"

#define FARM_SLOT_TICKETS 64

struct farm_slot_record {
  _Atomic uint64_t running;   /* handle of the task being computed, 0 = none: who is to blame for a crash */
  _Atomic int64_t started_ns; /* of `running` */
  _Atomic uint64_t ticket[FARM_SLOT_TICKETS]; /* handle offered, 0 = taken by either side */
};

struct farm_slot_setup {
  struct farm_options options;
  farm_work work;
  struct farm_slot_record *records; /* one per slot, shared */
};

/* Body of a slot process whose parent is `parent`; serves until the channel closes. */
_Noreturn void farm_slot_serve(const struct farm_slot_setup *setup, int slot, int channel, pid_t parent);

/* This process dies with `parent`: asked of the kernel, then checked, as the parent may have died before the asking. */
void farm_slot_die_with(pid_t parent);

#endif
