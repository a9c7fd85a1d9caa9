/* Queues and the table of jobs. */
#include "campaign/farm/job.h"

#include <stdlib.h>
#include <string.h>

struct farm_job *farm_job_new(uint64_t handle, const uint8_t *bytes, size_t size) {
  struct farm_job *job = size < SIZE_MAX - sizeof *job ? malloc(sizeof *job + size) : NULL;
  if (!job)
    return NULL;
  *job = (struct farm_job){.handle = handle, .size = size};
  if (size)
    memcpy(job->bytes, bytes, size);
  return job;
}

void farm_job_push(struct farm_job_queue *queue, struct farm_job *job) {
  job->next = NULL;
  if (queue->last)
    queue->last->next = job;
  else
    queue->first = job;
  queue->last = job;
  queue->count++;
}

void farm_job_push_front(struct farm_job_queue *queue, struct farm_job *job) {
  job->next = queue->first;
  queue->first = job;
  if (!queue->last)
    queue->last = job;
  queue->count++;
}

struct farm_job *farm_job_pop(struct farm_job_queue *queue) {
  return queue->first ? farm_job_take(queue, queue->first->handle) : NULL;
}

struct farm_job *farm_job_take(struct farm_job_queue *queue, uint64_t handle) {
  struct farm_job *before = NULL;
  for (struct farm_job *job = queue->first; job; before = job, job = job->next) {
    if (job->handle != handle)
      continue;
    if (before)
      before->next = job->next;
    else
      queue->first = job->next;
    if (queue->last == job)
      queue->last = before;
    job->next = NULL;
    queue->count--;
    return job;
  }
  return NULL;
}

void farm_job_clear(struct farm_job_queue *queue) {
  for (struct farm_job *job; (job = farm_job_pop(queue));)
    free(job);
}

bool farm_job_table_add(struct farm_job_table *table, struct farm_job *job) {
  struct farm_job *jobs = table->jobs;
  job->handle = ++table->last_handle;
  HASH_ADD(hh, jobs, handle, sizeof job->handle, job);
  table->jobs = jobs;
  if (!farm_job_table_find(table, job->handle))
    return false;
  table->count++;
  return true;
}

struct farm_job *farm_job_table_find(const struct farm_job_table *table, uint64_t handle) {
  struct farm_job *job = NULL;
  HASH_FIND(hh, table->jobs, &handle, sizeof handle, job);
  return job;
}

void farm_job_table_remove(struct farm_job_table *table, uint64_t handle) {
  struct farm_job *job = farm_job_table_find(table, handle);
  if (!job)
    return;
  HASH_DELETE(hh, table->jobs, job);
  table->count--;
}

struct farm_job *farm_job_table_oldest(const struct farm_job_table *table, int rank) {
  for (struct farm_job *job = table->jobs; job; job = job->hh.next)
    if (job->rank == rank)
      return job;
  return NULL;
}

void farm_job_table_free(struct farm_job_table *table) {
  struct farm_job *job, *next;
  HASH_ITER(hh, table->jobs, job, next) {
    HASH_DELETE(hh, table->jobs, job);
    free(job);
  }
  *table = (struct farm_job_table){0};
}
