/* A task on its way: the manager's own record of it, or a rank's copy. */
#ifndef CLAST_CAMPAIGN_FARM_JOB_H
#define CLAST_CAMPAIGN_FARM_JOB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define HASH_NONFATAL_OOM 1
#include <uthash.h>

struct farm_job {
  struct farm_job *next; /* next job in the same queue */
  uint64_t handle;       /* set by the farm, never used twice */
  uint64_t id;           /* the caller's number of the task */
  int rank;              /* rank that it was sent to (manager only) */
  uint16_t ticket;       /* while it is in a slot */
  UT_hash_handle hh;     /* in the manager's table */
  size_t size;
  _Alignas(16) uint8_t bytes[];
};

/* NULL when memory is refused. Freed by free(). */
struct farm_job *farm_job_new(uint64_t handle, const uint8_t *bytes, size_t size);

struct farm_job_queue {
  struct farm_job *first, *last;
  size_t count;
};
void farm_job_push(struct farm_job_queue *queue, struct farm_job *job);
void farm_job_push_front(struct farm_job_queue *queue, struct farm_job *job);
struct farm_job *farm_job_pop(struct farm_job_queue *queue); /* NULL when empty */
/* Takes out the job with this handle; NULL: there is none. Searches from the front, because slots answer in order. */
struct farm_job *farm_job_take(struct farm_job_queue *queue, uint64_t handle);
void farm_job_clear(struct farm_job_queue *queue);

/* The manager's table of the jobs that are out, by handle. */
struct farm_job_table {
  struct farm_job *jobs; /* uthash, in order of addition */
  size_t count;
  uint64_t last_handle; /* handles count from 1: no handle is 0, which means "none" in a slot's record */
};
bool farm_job_table_add(struct farm_job_table *table, struct farm_job *job); /* sets job->handle; false: no memory */
struct farm_job *farm_job_table_find(const struct farm_job_table *table, uint64_t handle);
void farm_job_table_remove(struct farm_job_table *table, uint64_t handle); /* does not free the job */
/* The oldest job that was sent to this rank, or NULL. */
struct farm_job *farm_job_table_oldest(const struct farm_job_table *table, int rank);
void farm_job_table_free(struct farm_job_table *table); /* frees the jobs too */

#endif
