/* The test of the toy: it calls every function but one, and one only in a child process. */
#include <sys/wait.h>
#include <unistd.h>
#include "toy.h"

static int in_child(int x) {
  int status = 0;
  const pid_t child = fork();
  if (child == 0)
    _exit(toy_in_child(x));
  waitpid(child, &status, 0);
  return WEXITSTATUS(status);
}

int main(void) {
  const double x[] = {1, 2, 9, 1e9};
  const int range = toy_in_range(3, 3, 4) && toy_in_range(4, 3, 4) && !toy_in_range(5, 3, 4) &&
                    !toy_in_range(2, 3, 4) && toy_in_range(5, 3, 9);
  const int child = in_child(7) == 12 && in_child(6) == 4 && in_child(8) == 4;
  const int larger = toy_larger(3, 5) == 5 && toy_larger(5, 3) == 5;
  return !(range && larger && child && toy_mean(x, 3) == 4);
}
