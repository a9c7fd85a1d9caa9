/* What pool.c and pool_listen.c share. */
#ifndef CLAST_CAMPAIGN_FARM_POOL_PRIVATE_H
#define CLAST_CAMPAIGN_FARM_POOL_PRIVATE_H

#include <poll.h>
#include <sys/types.h>

#include "campaign/farm/pool.h"
#include "campaign/farm/server.h"

struct slot {
  int channel; /* -1: none at present */
  pid_t pid;
  bool given_up;
  int idle_ends;
  uint64_t killed;   /* handle of the task at whose deadline the slot was killed */
  uint64_t forgiven; /* handle of the task whose deadline was moved by forgiven_ns */
  int64_t forgiven_ns;
  struct farm_job_queue jobs; /* jobs sent to the slot, in order */
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
  double mean_wall_s; /* mean wall time of recent tasks */
  int64_t looked_ns;
};

/* Writes the bytes that wait for the slot, as far as its channel accepts them. */
void farm_pool_flush(struct slot *slot);

#endif
