/* Synthetic tasks for the farm's tests and bench: each shows one correct or faulty behaviour of a run. */
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "campaign/farm/farm.h"

enum task_kind {
  TASK_ECHO,
  TASK_BURN,
  TASK_SLEEP,
  TASK_SEGV,
  TASK_ABORT,
  TASK_EXIT,
  TASK_HANG,
  TASK_FAIL,
  TASK_ALLOC,
  TASK_BIG,
  TASK_PRINT,
  TASK_WILD
};

struct task {
  uint64_t id;
  int32_t kind, number; /* number: exit code, status */
  double amount;        /* seconds, bytes */
};

struct task_answer {
  uint64_t id, value;
};

static inline uint64_t task_value(uint64_t id) {
  return (id + 1) * UINT64_C(0x9e3779b97f4a7c15);
}

/* Uses this much CPU time of the thread, s, so that other programs on the machine do not change the work. On a shared
 * machine, however, wall time grows and utilisation falls; the farm is not the cause. */
static inline void task_burn(double seconds) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  const double end = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec + seconds;
  volatile double x = 1;
  do {
    for (int i = 0; i < 2000; i++)
      x = x * 1.0000001 + 1e-9;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  } while ((double)now.tv_sec + 1e-9 * (double)now.tv_nsec < end);
}

static inline void task_sleep(double seconds) {
  struct timespec left = {(time_t)seconds, (long)((seconds - (double)(time_t)seconds) * 1e9)};
  while (nanosleep(&left, &left) != 0) {
  }
}

static inline status task_work(const uint8_t *bytes, size_t size, uint8_t **result, size_t *result_size,
                               struct error *e) {
  struct task task;
  if (size < sizeof task)
    return status_fail(e, STATUS_CONTENT, "a task of %zu bytes", size);
  memcpy(&task, bytes, sizeof task);
  size_t big = 0;
  switch (task.kind) {
  case TASK_BURN: task_burn(task.amount); break;
  case TASK_SLEEP: task_sleep(task.amount); break;
  case TASK_SEGV:
    signal(SIGSEGV, SIG_DFL);
    raise(SIGSEGV);
    break;
  case TASK_ABORT: signal(SIGABRT, SIG_DFL); abort();
  case TASK_EXIT: exit(task.number);
  case TASK_HANG:
    for (;;)
      pause();
  case TASK_FAIL: return status_fail(e, (status)task.number, "task %d cannot", (int)task.id);
  case TASK_ALLOC: {
    volatile char *memory = malloc((size_t)task.amount);
    if (!memory)
      return status_fail(e, STATUS_MEMORY, "no %g bytes", task.amount);
    for (size_t i = 0; i < (size_t)task.amount; i += 4096)
      memory[i] = 1;
    free((void *)memory);
    break;
  }
  case TASK_BIG: big = (size_t)task.amount; break;
  case TASK_PRINT:
    printf("polluted\n");
    fflush(stdout);
    break;
  case TASK_WILD: /* writes into every file that it can open, then crashes: an incomplete stream */
    for (int file = 3; file < 64; file++)
      if (write(file, "CLF1 nonsense nonsense nonsense nonsense nonsense", 49) < 0)
        continue;
    raise(SIGKILL);
    break;
  default: break;
  }
  *result_size = sizeof(struct task_answer) + big;
  *result = malloc(*result_size);
  if (!*result)
    return status_fail(e, STATUS_MEMORY, "no memory");
  memset(*result, (int)(task.id & 0xff), *result_size);
  memcpy(*result, &(struct task_answer){task.id, task_value(task.id)}, sizeof(struct task_answer));
  return STATUS_OK;
}

/* What was told of a task. */
struct task_told {
  int reports;               /* how often it was reported */
  struct farm_report report; /* the last one; its bytes and its message are gone */
  char message[160];
};

/* A list of tasks and their results. */
struct task_list {
  struct task *tasks;
  size_t count, given;
  struct task_told *told;
  uint64_t sum; /* sum over the answers of completed tasks: independent of order */
  size_t reported, wrong;
  size_t stop_after; /* report() returns `stop_with` after this many reports, 0 = never */
  status stop_with;
  int stopping; /* calls of stopping() */
  int ticks;
  bool quiet;
};

static inline void task_list_new(struct task_list *list, size_t count) {
  memset(list, 0, sizeof *list);
  list->count = count;
  list->tasks = calloc(count + 1, sizeof *list->tasks);
  list->told = calloc(count + 1, sizeof *list->told);
  for (size_t i = 0; i < count; i++)
    list->tasks[i].id = i;
}

static inline void task_list_free(struct task_list *list) {
  free(list->tasks), free(list->told);
}

static inline bool task_list_next(void *context, struct farm_task *task) {
  struct task_list *list = context;
  if (list->given == list->count)
    return false;
  const struct task *it = &list->tasks[list->given++];
  *task = (struct farm_task){.id = it->id, .bytes = (const uint8_t *)it, .size = sizeof *it};
  return true;
}

static inline status task_list_report(void *context, const struct farm_report *report, struct error *e) {
  struct task_list *list = context;
  const size_t id = report->id;
  list->reported++;
  if (id >= list->count)
    return status_fail(e, STATUS_INTERNAL, "unknown id");
  list->told[id].reports++;
  list->told[id].report = *report;
  snprintf(list->told[id].message, sizeof list->told[id].message, "%s", report->message);
  if (report->ending == FARM_DONE) {
    struct task_answer answer;
    if (report->size < sizeof answer)
      list->wrong++;
    else {
      memcpy(&answer, report->bytes, sizeof answer);
      if (answer.id != id || answer.value != task_value(id))
        list->wrong++;
      list->sum += answer.value;
      for (size_t i = sizeof answer; i < report->size; i += 509)
        list->wrong += report->bytes[i] != (id & 0xff);
    }
    if (list->tasks[id].kind == TASK_BIG && report->size != sizeof answer + (size_t)list->tasks[id].amount)
      list->wrong++;
  }
  if (list->stop_after && list->reported >= list->stop_after)
    return status_fail(e, list->stop_with, "the caller has enough");
  return STATUS_OK;
}

static inline status task_list_tick(void *context, int running, struct error *e) {
  struct task_list *list = context;
  (void)running;
  (void)e;
  list->ticks++;
  return STATUS_OK;
}

static inline void task_list_stopping(void *context, int signal_number) {
  (void)signal_number;
  ((struct task_list *)context)->stopping++;
}

static inline struct farm_manager task_list_manager(struct task_list *list) {
  return (struct farm_manager){.context = list,
                               .next = task_list_next,
                               .report = task_list_report,
                               .tick = task_list_tick,
                               .stopping = task_list_stopping};
}
