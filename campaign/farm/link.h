/* Sends and receives frames between ranks by non-blocking point-to-point MPI.
 *
 * Frames to one rank are collected and leave together as one message at farm_link_flush. Sends are MPI_Isend of a
 * buffer of their own, receives MPI_Iprobe + MPI_Irecv, because a blocking call waits for ever for a dead or stopped
 * partner if the message is above the eager limit (4 kB in shared memory). Frames of one rank arrive in order. */
#ifndef CLAST_CAMPAIGN_FARM_LINK_H
#define CLAST_CAMPAIGN_FARM_LINK_H

#include <stdbool.h>

#include "campaign/farm/frame.h"
#include "schemas/status.h"

struct farm_link;

/* True when this MPI library can connect to a launcher that has only the older PMI-1 or PMI-2 (srun --mpi=pmi2).
 * Debian's Open MPI cannot, and its MPI_Init would end the process with a long message. */
bool farm_link_knows_pmi(void);
/* MPI_Init. Signals must be blocked before, as MPI starts threads. */
status farm_link_open(struct farm_link **out, struct error *error);
int farm_link_rank(const struct farm_link *link);
int farm_link_ranks(const struct farm_link *link);
/* Queues a frame for a rank. STATUS_MEMORY when memory is refused. */
status farm_link_send(struct farm_link *link, int rank, enum farm_frame_kind kind, uint64_t handle, int parts,
                      const struct iovec *part, struct error *error);
status farm_link_flush(struct farm_link *link, struct error *error);
typedef status (*farm_link_take)(void *context, int rank, const struct farm_frame *frame, const uint8_t *payload,
                                 struct error *error);
/* Calls `take` for every frame that has arrived. *count: number of messages received and sends completed. */
status farm_link_drain(struct farm_link *link, farm_link_take take, void *context, int *count, struct error *error);
/* Calls MPI_Finalize when `together` (all ranks call it now). Else calls MPI_Abort with this exit code and does not
 * return. */
void farm_link_close(struct farm_link *link, bool together, int exit_code);

#endif
