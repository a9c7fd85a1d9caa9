/* The program that xargs and GNU parallel start in bench_farm. It uses the given seconds of thread CPU time and links
 * no other library. Compiled by the bench, so that the comparison does not pay for loading our libraries. */
#include <stdlib.h>
#include <time.h>

int main(int argc, char **argv) {
  struct timespec now;
  const double seconds = argc > 1 ? atof(argv[1]) : 0;
  volatile double x = 1;
  do {
    for (int i = 0; i < 2000; i++)
      x = x * 1.0000001 + 1e-9;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  } while ((double)now.tv_sec + 1e-9 * (double)now.tv_nsec < seconds);
  return 0;
}
