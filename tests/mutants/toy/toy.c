/* Each line that has mutants says what becomes of them: all are killed, or all survive. */
#include "toy.h"

int toy_in_range(int x, int low, int high) {
  return x >= low && x <= high; /* killed */
}

double toy_mean(const double *x, int n) {
  double sum = 0;             /* killed */
  for (int k = 0; k < n; k++) /* killed */
    sum += x[k];              /* killed */
  return sum / n;             /* killed */
}

/* With >= it is the same function, and the same object. */
int toy_larger(int a, int b) {
  if (a > b)  /* killed */
    return a; /* killed */
  return b;   /* killed */
}

/* Called by a child process that ends by _exit. */
int toy_in_child(int x) {
  if (x == 7)  /* killed */
    return 12; /* killed */
  return 4;    /* killed */
}

/* No test calls it. */
int toy_untested(int x) {
  if (x == 7)  /* survives */
    return 12; /* survives */
  return 4;    /* survives */
}
