/* The one monotonic clock, for durations and deadlines, and the CPU seconds of this process. */
#pragma once

#include <stdint.h>
#include <sys/resource.h>
#include <time.h>

#define CLOCK_MS INT64_C(1000000) /* ns */
#define CLOCK_S  INT64_C(1000000000)

static inline int64_t clock_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (int64_t)now.tv_sec * CLOCK_S + now.tv_nsec;
}

static inline double clock_s(void) {
  return 1e-9 * (double)clock_ns();
}

/* s of a clock of POSIX. */
static inline double clock_read_s(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline double clock_cpu_s(void) {
  return clock_read_s(CLOCK_PROCESS_CPUTIME_ID);
}

/* Processor time of this process and of the programs that it has waited for, s. */
static inline double clock_cpu_with_children_s(void) {
  struct rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  return clock_cpu_s() + (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* Seconds as ns, at most 1e18. */
static inline int64_t clock_from_s(double seconds) {
  return seconds > 1e9 ? (int64_t)1e18 : (int64_t)(seconds * 1e9);
}
