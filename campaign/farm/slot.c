/* The loop of a slot: takes tasks, computes them in its own process or in a child, sends results in batches. */
#include "campaign/farm/slot.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "campaign/farm/isolate.h"
#include "schemas/clock.h"

/* Results of short tasks are sent together: after this time, at this number, or when no task waits. */
#define FLUSH_AFTER_NS (200 * CLOCK_MS / 1000)
#define FLUSH_AT_BYTES 32768

void farm_slot_die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)
    _exit(STATUS_OK);
}

static void flush(int channel, struct farm_bytes *out) {
  while (out->begin < out->end) {
    const ssize_t n = send(channel, out->data + out->begin, out->end - out->begin, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      _exit(STATUS_OK); /* the main process has ended */
    out->begin += (size_t)n;
  }
  farm_frame_trim(out);
}

/* Peak memory in process is the high-water mark of the slot. It is reset after a task that raised it (where the kernel
 * permits this), so that a task does not inherit the peak of a larger predecessor. */
static int64_t peak_memory(int64_t *floor) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const int64_t peak = (int64_t)usage.ru_maxrss * 1024;
  if (*floor == 0) { /* peak of the slot before its first task */
    *floor = peak;
    return peak;
  }
  if (peak > *floor + (1 << 20)) {
    const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    if (file >= 0) {
      if (write(file, "5", 1) != 1)
        *floor = peak;
      close(file);
    }
  }
  return peak;
}

static bool run_here(const struct farm_slot_setup *setup, int slot, uint64_t handle, const uint8_t *task, size_t size,
                     int64_t *floor, struct farm_bytes *out) {
  uint8_t *result = NULL;
  size_t result_size = 0;
  struct error error = {0};
  const size_t memory_limit = setup->options.memory_limit;
  if (memory_limit)
    farm_isolate_limit_memory(memory_limit);
  const int64_t start = clock_ns();
  const double cpu = clock_cpu_s();
  const status verdict = setup->work(task, size, &result, &result_size, &error);
  struct farm_result head = {.slot = slot,
                             .cpu_s = clock_cpu_s() - cpu,
                             .wall_s = 1e-9 * (double)(clock_ns() - start),
                             .exit_code = verdict,
                             .peak_memory = peak_memory(floor)};
  if (memory_limit)
    farm_isolate_limit_memory(0);
  struct iovec part[2] = {{&head, sizeof head}, {result, result_size}};
  head.size = result_size;
  if (verdict != STATUS_OK) {
    head.ending = farm_isolate_ending(verdict, memory_limit > 0);
    head.size = 0;
    part[1] = (struct iovec){error.message, strlen(error.message)};
  }
  bool written = farm_frame_append(out, FARM_FRAME_RESULT, 0, handle, 2, part);
  if (!written) {
    head.ending = FARM_LOST;
    head.exit_code = STATUS_MEMORY;
    head.size = 0;
    char text[128];
    snprintf(text, sizeof text, "no memory to pass on a result of %zu bytes", result_size);
    part[1] = (struct iovec){text, strlen(text)};
    written = farm_frame_append(out, FARM_FRAME_RESULT, 0, handle, 2, part);
  }
  free(result);
  return written;
}

static bool claim(struct farm_slot_record *record, const struct farm_frame *frame) {
  uint64_t expected = frame->handle;
  /* `running` is set first: if the slot dies between these lines, the main process finds the task's ticket not taken
   * and runs the task again. */
  atomic_store(&record->started_ns, clock_ns());
  atomic_store(&record->running, frame->handle);
  if (frame->ticket < FARM_SLOT_TICKETS && atomic_compare_exchange_strong(&record->ticket[frame->ticket], &expected, 0))
    return true;
  atomic_store(&record->running, 0);
  return false;
}

/* If the machine runs out of memory, the kernel should kill a run and not the manager. A process may always raise its
 * own OOM score. */
static void offer_to_oom_killer(void) {
  const int score = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (score < 0)
    return;
  if (write(score, "500", 3) != 3)
    errno = 0;
  close(score);
}

struct serving {
  const struct farm_slot_setup *setup;
  int slot, channel;
  struct farm_isolate isolate;
  struct farm_bytes in, out;
  int64_t memory_floor, flushed_ns;
};

/* Computes every task in the buffer, sending results now and then. */
static void run_tasks(struct serving *s) {
  struct farm_slot_record *const record = &s->setup->records[s->slot];
  struct farm_frame frame;
  const uint8_t *payload;
  int got;
  while ((got = farm_frame_next(&s->in, &frame, &payload)) == 1) {
    if (frame.kind != FARM_FRAME_TASK || !claim(record, &frame))
      continue;
    const bool written = s->setup->options.in_process
                             ? run_here(s->setup, s->slot, frame.handle, payload, frame.size, &s->memory_floor, &s->out)
                             : farm_isolate_run(&s->isolate, s->setup, s->slot, frame.handle, payload, frame.size,
                                                &s->out);
    if (!written)
      _exit(STATUS_MEMORY);
    atomic_store(&record->running, 0);
    const int64_t now = clock_ns();
    if (now - s->flushed_ns > FLUSH_AFTER_NS || s->out.end - s->out.begin > FLUSH_AT_BYTES) {
      flush(s->channel, &s->out);
      s->flushed_ns = now;
    }
  }
  if (got < 0)
    _exit(STATUS_INTERNAL);
  flush(s->channel, &s->out);
}

/* Waits for more bytes. The end of the channel ends the slot. */
static void read_tasks(struct serving *s) {
  if (s->in.begin == s->in.end)
    farm_frame_trim(&s->in);
  if (!farm_frame_reserve(&s->in, farm_frame_missing(&s->in, 4096)))
    _exit(STATUS_MEMORY);
  ssize_t n;
  do
    n = recv(s->channel, s->in.data + s->in.end, s->in.capacity - s->in.end, 0);
  while (n < 0 && errno == EINTR);
  if (n <= 0)
    _exit(STATUS_OK);
  s->in.end += (size_t)n;
  s->flushed_ns = clock_ns();
}

_Noreturn void farm_slot_serve(const struct farm_slot_setup *setup, int slot, int channel, pid_t parent) {
  farm_slot_die_with(parent);
  offer_to_oom_killer();
  struct serving serving = {.setup = setup, .slot = slot, .channel = channel, .flushed_ns = clock_ns()};
  peak_memory(&serving.memory_floor);
  if (!setup->options.in_process && !farm_isolate_open(&serving.isolate, channel))
    _exit(STATUS_MEMORY);
  for (;;) {
    run_tasks(&serving);
    read_tasks(&serving);
  }
}
