/* Fields files during a run, and the list of them with their times that ParaView reads (NAME.hdf.series). */
#ifndef CLAST_CAMPAIGN_ONE_RUN_SNAPSHOTS_H
#define CLAST_CAMPAIGN_ONE_RUN_SNAPSHOTS_H

#include <stdint.h>

#include "engine/engine.h"

struct snapshots; /* opaque */

/* `count` files NAME_000000.hdf, ... evenly over the longest time that a run may take, the first before it has moved
 * far. `resumed`: the run goes on from a restart file; what came before is on the disk and stays in the list.
 * STATUS_MEMORY. */
status snapshots_open(const char *name, int64_t count, bool resumed, struct snapshots **out, struct error *error);
void snapshots_close(struct snapshots *snapshots); /* NULL is fine */
/* To be called between blocks of steps: writes the snapshot that is due, if there is one, and NAME.hdf.series again.
 * Both are complete files at any moment. A step longer than the time between snapshots leaves numbers out. Returns what
 * write_snapshot returns, or STATUS_IO. */
status snapshots_look(struct snapshots *snapshots, const struct engine_kind *kind, void *run, struct error *error);

#endif
