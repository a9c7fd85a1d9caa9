/* Threads that the system grants. OpenMP ends the process when the system refuses a thread that it asks for, so a loop
 * asks here first how many it may have. Results do not depend on the number. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef _OPENMP
#include <omp.h>
#else
#define omp_get_thread_num()  0
#define omp_get_max_threads() 1
#endif

enum { THREADS_MOST = 1024 };

/* The number of threads, the calling one included, that its parallel loops can have now: `wanted`, or fewer if
 * the system refuses more (`ulimit -u`, limits of memory). At least 1, at most THREADS_MOST. OpenMP has made them by
 * then, and keeps them for loops with this number. Without OpenMP always 1. */
int threads_granted(int64_t wanted);

/* Address space that `count` threads beside the calling one take for their stacks, bytes. */
size_t threads_stacks(int64_t count);
