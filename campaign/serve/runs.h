/* The runs that the server's jobs wait for: by identity, by the farm's id, and a queue of the runs that are on no
 * slot. */
#ifndef CLAST_CAMPAIGN_SERVE_RUNS_H
#define CLAST_CAMPAIGN_SERVE_RUNS_H

#include <stdbool.h>

#include "campaign/driver/record.h"

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct serve_job;

struct serve_wish { /* one job waits for one run */
  struct serve_job *job;
  struct serve_wish *next;
};

struct serve_run { /* a run that waits or is on a slot */
  uint64_t id;     /* id of the farm's task */
  struct record record;
  struct scene *scene;
  struct serve_wish *wishes;
  struct serve_run *next; /* next run in the queue */
  int lost;               /* attempts that the machine ended */
  UT_hash_handle hh, by_id;
};

struct serve_runs {                  /* all zero: empty */
  struct serve_run *all, *all_by_id; /* uthash */
  struct serve_run *queue, *queue_end;
  uint64_t last_id;
};

/* NULL: there is none. */
struct serve_run *serve_runs_find(const struct serve_runs *runs, const uint8_t identity[16]);
struct serve_run *serve_runs_with_id(const struct serve_runs *runs, uint64_t id);
/* Copies the scene and puts the run into the queue. NULL: no memory. */
struct serve_run *serve_runs_add(struct serve_runs *runs, const struct record *record, const struct scene *scene);
void serve_runs_push(struct serve_runs *runs, struct serve_run *run); /* puts the run into the queue again */
void serve_runs_pop(struct serve_runs *runs);                         /* takes the first one out of the queue */
bool serve_runs_wish(struct serve_run *run, struct serve_job *job);   /* false: no memory */
/* Removes and frees a run that is not in the queue. */
void serve_runs_remove(struct serve_runs *runs, struct serve_run *run);
void serve_runs_clear(struct serve_runs *runs);

#endif
