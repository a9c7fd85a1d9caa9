/* Fields files during a run, and the list of them with their times that ParaView reads (NAME.hdf.series). */
#ifndef CLAST_CAMPAIGN_ONE_RUN_SNAPSHOTS_H
#define CLAST_CAMPAIGN_ONE_RUN_SNAPSHOTS_H

#include <stdint.h>

#include "engine/engine.h"

struct snapshots; /* opaque */

/* `count` files NAME_000000.hdf, ... evenly over the longest time that a run may take, the first one near its
 * beginning. `resumed`: the run goes on from a restart file; earlier snapshots are on the disk and stay in the list.
 * STATUS_MEMORY, and the statuses of file_claim(). */
status snapshots_open(const char *name, int64_t count, bool resumed, struct snapshots **out, struct error *error);
void snapshots_close(struct snapshots *snapshots); /* NULL is fine */
/* Must be called between blocks of steps. Writes the snapshot that is due, if there is one, and NAME.hdf.series again.
 * Both files are complete at any time. A step longer than the time between snapshots skips numbers. Returns the status
 * of write_snapshot, or STATUS_IO. */
status snapshots_look(struct snapshots *snapshots, const struct engine_kind *kind, void *run, struct error *error);

#endif
