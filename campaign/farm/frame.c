/* Builds and checks frames in a growing buffer of bytes. */
#include "campaign/farm/farm_private.h"

#include <stdlib.h>
#include <string.h>
#include <utlist.h>

static size_t padded(size_t size) {
  return (size + 15) & ~(size_t)15;
}

bool farm_frame_reserve(struct farm_bytes *bytes, size_t more) {
  const size_t used = bytes->end - bytes->begin;
  if (bytes->capacity - bytes->end >= more)
    return true;
  if (bytes->begin > 0 && bytes->capacity - used >= more && bytes->begin >= used) { /* cheap: halves do not overlap */
    memcpy(bytes->data, bytes->data + bytes->begin, used);
  } else {
    size_t capacity = bytes->capacity ? bytes->capacity : 4096;
    while (capacity - used < more) {
      if (capacity > SIZE_MAX / 4)
        return false;
      capacity *= 2;
    }
    uint8_t *data = malloc(capacity);
    if (!data)
      return false;
    if (used)
      memcpy(data, bytes->data + bytes->begin, used);
    free(bytes->data);
    bytes->data = data;
    bytes->capacity = capacity;
  }
  bytes->begin = 0;
  bytes->end = used;
  return true;
}

void farm_frame_free(struct farm_bytes *bytes) {
  free(bytes->data);
  *bytes = (struct farm_bytes){0};
}

void farm_frame_trim(struct farm_bytes *bytes) {
  bytes->begin = bytes->end = 0;
  if (bytes->capacity > (size_t)1 << 20)
    farm_frame_free(bytes);
}

/* Not cryptographic: it must detect damaged, shifted and foreign bytes, at memory speed. */
static uint64_t mix(uint64_t hash, const uint8_t *bytes, size_t size) {
  while (size > 0) {
    uint64_t word = 0;
    const size_t n = size < 8 ? size : 8;
    memcpy(&word, bytes, n);
    hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15); /* 2^64 over the golden ratio: an odd number of mixed bits */
    hash ^= hash >> 29;
    bytes += n;
    size -= n;
  }
  return hash;
}

static uint64_t check_of(const struct farm_frame *frame, const uint8_t *payload) {
  struct farm_frame head = *frame;
  head.check = 0;
  return mix(mix(frame->size, (const uint8_t *)&head, sizeof head), payload, frame->size);
}

bool farm_frame_append(struct farm_bytes *bytes, enum farm_frame_kind kind, uint16_t ticket, uint64_t handle, int parts,
                       const struct iovec *part) {
  size_t size = 0;
  for (int i = 0; i < parts; i++) {
    if (part[i].iov_len > FARM_FRAME_LARGEST - size)
      return false;
    size += part[i].iov_len;
  }
  const size_t total = sizeof(struct farm_frame) + padded(size);
  if (!farm_frame_reserve(bytes, total))
    return false;
  uint8_t *const payload = bytes->data + bytes->end + sizeof(struct farm_frame);
  uint8_t *to = payload;
  for (int i = 0; i < parts; i++) {
    if (part[i].iov_len)
      memcpy(to, part[i].iov_base, part[i].iov_len);
    to += part[i].iov_len;
  }
  memset(to, 0, padded(size) - size);
  struct farm_frame frame = {.magic = FARM_FRAME_MAGIC,
                             .kind = (uint16_t)kind,
                             .ticket = ticket,
                             .handle = handle,
                             .size = size};
  frame.check = check_of(&frame, payload);
  memcpy(bytes->data + bytes->end, &frame, sizeof frame);
  bytes->end += total;
  return true;
}

int farm_frame_next(struct farm_bytes *bytes, struct farm_frame *frame, const uint8_t **payload) {
  const size_t used = bytes->end - bytes->begin;
  if (used < sizeof *frame)
    return 0;
  memcpy(frame, bytes->data + bytes->begin, sizeof *frame);
  if (frame->magic != FARM_FRAME_MAGIC || frame->size > FARM_FRAME_LARGEST)
    return -1;
  const size_t total = sizeof *frame + padded(frame->size);
  if (used < total)
    return 0;
  *payload = bytes->data + bytes->begin + sizeof *frame;
  if (check_of(frame, *payload) != frame->check)
    return -1;
  bytes->begin += total;
  return 1;
}

bool farm_frame_result(const struct farm_frame *frame, const uint8_t *payload, struct farm_ended *ended) {
  struct farm_result *const result = &ended->result;
  if (frame->kind != FARM_FRAME_RESULT || frame->size < sizeof *result)
    return false;
  memcpy(result, payload, sizeof *result);
  if (result->size > frame->size - sizeof *result)
    return false;
  ended->bytes = payload + sizeof *result;
  ended->message = (const char *)ended->bytes + result->size;
  ended->message_size = frame->size - sizeof *result - result->size;
  return true;
}

size_t farm_frame_missing(const struct farm_bytes *bytes, size_t minimum) {
  const size_t used = bytes->end - bytes->begin;
  struct farm_frame frame;
  if (used < sizeof frame)
    return minimum;
  memcpy(&frame, bytes->data + bytes->begin, sizeof frame);
  if (frame.magic != FARM_FRAME_MAGIC || frame.size > FARM_FRAME_LARGEST)
    return minimum;
  const size_t total = sizeof frame + padded(frame.size);
  return total > used && total - used > minimum ? total - used : minimum;
}

/* ---- Queues and the table of jobs ---- */

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
  DL_APPEND(queue->first, job);
  queue->count++;
}

void farm_job_push_front(struct farm_job_queue *queue, struct farm_job *job) {
  DL_PREPEND(queue->first, job);
  queue->count++;
}

struct farm_job *farm_job_pop(struct farm_job_queue *queue) {
  return queue->first ? farm_job_take(queue, queue->first->handle) : NULL;
}

struct farm_job *farm_job_take(struct farm_job_queue *queue, uint64_t handle) {
  struct farm_job *found;
  DL_SEARCH_SCALAR(queue->first, found, handle, handle);
  if (found) {
    DL_DELETE(queue->first, found);
    queue->count--;
  }
  return found;
}

void farm_job_clear(struct farm_job_queue *queue) {
  for (struct farm_job *job; (job = farm_job_pop(queue));)
    free(job);
}

bool farm_job_table_add(struct farm_job_table *table, struct farm_job *job) {
  job->handle = ++table->last_handle;
  HASH_ADD(hh, table->jobs, handle, sizeof job->handle, job);
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
