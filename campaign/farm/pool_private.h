/* What pool.c and pool_listen.c share. */
#ifndef CLAST_CAMPAIGN_FARM_POOL_PRIVATE_H
#define CLAST_CAMPAIGN_FARM_POOL_PRIVATE_H

#include <poll.h>
#include <sys/types.h>

#include "campaign/farm/pool.h"
#include "campaign/farm/server.h"

struct slot {
  int channel; /* -1: none now */
  pid_t pid;
  bool given_up;
  int idle_ends;
  uint64_t killed;   /* handle of the task it was killed for */
  uint64_t forgiven; /* handle whose deadline was moved, and by how much */
  int64_t forgiven_ns;
  struct farm_job_queue jobs; /* sent to it, in order */
  struct farm_bytes in, out;
};

struct farm_pool {
  struct farm_slot_setup setup;
  size_t records_size;
  pid_t server;
  int control;
  struct slot *slots;
  struct pollfd *fds;
  struct farm_job_queue queue;
  struct farm_pool_sink sink;
  size_t count;
  double mean_wall_s; /* of recent tasks */
  int64_t looked_ns;
};

/* Writes to the slot what waits for it, as far as its channel takes it. */
void farm_pool_flush(struct slot *slot);

#endif
