/* The fork server: a small process without threads, MPI and HDF5 that forks slots and collects their exit status.
 *
 * It is forked first, so that slots can be replaced later, when the main process itself can no longer fork safely. It
 * acts only on requests of the main process over `control` (a SOCK_SEQPACKET pair: one message, one packet). Closing
 * `control` ends it and every slot. */
#ifndef CLAST_CAMPAIGN_FARM_SERVER_H
#define CLAST_CAMPAIGN_FARM_SERVER_H

#include "campaign/farm/slot.h"

enum farm_server_verb {
  FARM_SERVER_SPAWN = 1, /* -> server: make this slot */
  FARM_SERVER_KILL,      /* -> server: SIGKILL this slot if it still has this pid */
  FARM_SERVER_SPAWNED,   /* <- server: the slot's pid, and the main process's end of its channel as SCM_RIGHTS */
  FARM_SERVER_DIED,      /* <- server: wait status; pid 0: it could not be made, value = errno */
};

struct farm_server_message {
  int32_t verb, slot, pid, value;
};

/* Forks the server; *control is the main process's end. The caller's buffered stdio is flushed first. */
status farm_server_start(const struct farm_slot_setup *setup, pid_t *server, int *control, struct error *error);
bool farm_server_ask(int control, enum farm_server_verb verb, int slot, pid_t pid);
/* Non-blocking: 1 a message (with *channel >= 0 when it brings one), 0 none now, -1 the server is gone. */
int farm_server_hear(int control, struct farm_server_message *message, int *channel);
/* Closes control, waits for the server's end (killed after 2 s). All slots are dead on return. */
void farm_server_end(pid_t server, int control);

#endif
