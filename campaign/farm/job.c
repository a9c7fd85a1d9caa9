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

static bool grow(struct farm_job_table *table) {
  const size_t capacity = table->capacity ? table->capacity * 2 : 64;
  struct farm_job **job = realloc(table->job, capacity * sizeof *job);
  if (job)
    table->job = job;
  uint32_t *use = realloc(table->use, capacity * sizeof *use);
  if (use)
    table->use = use;
  uint32_t *vacant = realloc(table->vacant, capacity * sizeof *vacant);
  if (vacant)
    table->vacant = vacant;
  if (!job || !use || !vacant)
    return false;
  for (size_t i = capacity; i-- > table->capacity;) {
    job[i] = NULL;
    use[i] = 0;
    vacant[table->vacant_count++] = (uint32_t)i;
  }
  table->capacity = capacity;
  return true;
}

bool farm_job_table_add(struct farm_job_table *table, struct farm_job *job) {
  if (table->vacant_count == 0 && !grow(table))
    return false;
  const uint32_t place = table->vacant[--table->vacant_count];
  table->use[place]++; /* from 1: no handle is 0, which means "none" in a slot's record */
  table->job[place] = job;
  table->count++;
  job->handle = (uint64_t)table->use[place] << 32 | place;
  return true;
}

struct farm_job *farm_job_table_find(const struct farm_job_table *table, uint64_t handle) {
  const size_t place = (uint32_t)handle;
  struct farm_job *job = place < table->capacity ? table->job[place] : NULL;
  return job && job->handle == handle ? job : NULL;
}

void farm_job_table_remove(struct farm_job_table *table, uint64_t handle) {
  if (!farm_job_table_find(table, handle))
    return;
  table->job[(uint32_t)handle] = NULL;
  table->vacant[table->vacant_count++] = (uint32_t)handle;
  table->count--;
}

void farm_job_table_free(struct farm_job_table *table) {
  for (size_t i = 0; i < table->capacity; i++)
    free(table->job[i]);
  free(table->job);
  free(table->use);
  free(table->vacant);
  *table = (struct farm_job_table){0};
}
