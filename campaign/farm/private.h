/* struct farm, shared by farm.c (start, end), manage.c (rank 0) and serve.c (the other ranks). */
#ifndef CLAST_CAMPAIGN_FARM_PRIVATE_H
#define CLAST_CAMPAIGN_FARM_PRIVATE_H

#include <signal.h>
#include <sys/types.h>

#include "campaign/farm/farm.h"
#include "campaign/farm/job.h"
#include "campaign/farm/link.h"
#include "campaign/farm/pool.h"

#define FARM_HOST_SIZE 64

/* An MPI message does not wake a sleeping process: check, and when no message came, sleep twice as long as before, up
 * to 5 ms. If no message comes for longer, the sleep grows to 10 ms within half a second: with 5 ms an idle rank used
 * 0.3 % of a core on a quiet machine but 0.6 % on a loaded one. The longer sleep costs nothing after such a pause. */
#define FARM_SLEEP_LEAST_NS (50 * INT64_C(1000))
#define FARM_SLEEP_USUAL_NS (5 * INT64_C(1000000))
#define FARM_SLEEP_MOST_NS  (10 * INT64_C(1000000))

static inline int64_t farm_sleep_longer(int64_t sleep_ns) {
  const int64_t longer = sleep_ns < FARM_SLEEP_USUAL_NS ? 2 * sleep_ns : sleep_ns + sleep_ns / 64;
  return longer < FARM_SLEEP_MOST_NS ? longer : FARM_SLEEP_MOST_NS;
}

struct farm_hello {
  int32_t slots;
  char host[FARM_HOST_SIZE];
};

struct farm_end {
  int64_t status, drop; /* drop: kill running tasks */
};

/* The manager's record of a rank; [0] is its own pool. */
struct farm_peer {
  int slots, started_with;
  size_t out; /* number of tasks that it has */
  double mean_wall_s;
  int64_t heard_ns;
  bool lost, recalling, bye;
  double cpu_s;
  char host[FARM_HOST_SIZE];
};

struct farm {
  struct farm_options options;
  struct farm_pool *pool; /* NULL once dropped */
  struct farm_link *link; /* NULL: no other ranks */
  int rank, ranks;
  struct farm_peer *peers; /* manager: one per rank */
  struct farm_usage usage;
  /* Stop signals, read from a file: no handler and no global is needed. */
  int signals;
  bool stopped; /* a stop signal has come */
  sigset_t mask_before;
  pid_t launcher; /* parent at the start; if it changes under MPI, mpirun has died */
  bool broken;    /* a rank is lost or does not answer: MPI_Finalize would hang */
  status last;    /* status of the last run */
};

status farm_manage(struct farm *farm, const struct farm_manager *manager, struct error *error);
status farm_serve(struct farm *farm, struct error *error);

/* The next stop signal that has come; 0: none. Also SIGTERM, once, when the launcher has died. */
int farm_signal(struct farm *farm);

#endif
