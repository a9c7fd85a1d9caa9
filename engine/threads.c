/* Makes threads before OpenMP does, to see how many the system grants. */
#include "engine/threads.h"

#include <pthread.h>
#include <stdlib.h>

#include "schemas/memory.h"

#ifdef _OPENMP
/* Threads that OpenMP keeps for parallel loops which the calling thread begins. */
static _Thread_local int kept = 1;

/* Ends when the caller has opened the gate: until then all threads are there at once. */
static void *wait_at(void *gate) {
  pthread_mutex_lock(gate);
  pthread_mutex_unlock(gate);
  return NULL;
}

/* How many of `most` more threads to use: all, or half of those that the system grants. The limit may be one of memory,
 * and the other half is left to the data. */
static int more_granted(int most) {
  pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
  pthread_t *made = memory_small((size_t)most, sizeof *made);
  int count = 0;
  pthread_mutex_lock(&gate);
  while (count < most && pthread_create(&made[count], NULL, wait_at, &gate) == 0)
    count++;
  pthread_mutex_unlock(&gate);
  for (int i = 0; i < count; i++)
    pthread_join(made[i], NULL);
  free(made);
  return count < most ? count / 2 : count;
}

int threads_granted(int64_t wanted) {
  const int most = wanted > THREADS_MOST ? THREADS_MOST : (int)wanted;
  if (most <= 1)
    return 1;
  const int granted = most <= kept ? most : kept + more_granted(most - kept);
  int there = 0;
#pragma omp parallel num_threads(granted) reduction(+ : there) if (granted > 1)
  there++;
  kept = granted;
  return there;
}
#else
int threads_granted(int64_t wanted) {
  (void)wanted;
  return 1;
}
#endif

size_t threads_stacks(int64_t count) {
  pthread_attr_t attributes;
  size_t stack = 0, guard = 0;
  if (count <= 0 || pthread_attr_init(&attributes) != 0)
    return 0;
  pthread_attr_getstacksize(&attributes, &stack);
  pthread_attr_getguardsize(&attributes, &guard);
  pthread_attr_destroy(&attributes);
  return (size_t)count * (stack + guard);
}
