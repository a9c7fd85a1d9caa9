/* The fork server: a small clean process (no threads, no MPI, no HDF5) that makes slots and buries them.
 *
 * It is forked first of all, so that slots can be replaced at any time later, when the main process itself can no
 * longer fork safely. It does nothing on its own: the main process asks over `control` (a SOCK_SEQPACKET pair: one
 * message, one packet), and the closing of `control` ends it and every slot. */
#ifndef CLAST_CAMPAIGN_FARM_SERVER_H
#define CLAST_CAMPAIGN_FARM_SERVER_H

#include "campaign/farm/slot.h"

enum farm_server_verb {
  FARM_SERVER_SPAWN = 1, /* -> server: make this slot */
  FARM_SERVER_KILL,      /* -> server: SIGKILL this slot if it still is this pid */
  FARM_SERVER_SPAWNED,   /* <- server: here is its pid, and the main end of its channel as SCM_RIGHTS */
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
