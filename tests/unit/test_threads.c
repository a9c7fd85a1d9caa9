/* Threads that the system refuses: fewer are used, and the process goes on. */
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/threads.h"
#include "tests/support/check.h"

static size_t address_space(void) {
  unsigned long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  assert_non_null(file);
  assert_int_equal(fscanf(file, "%lu", &pages), 1);
  fclose(file);
  return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* In a process of its own, with address space for the stacks of `room` threads and a half: the number granted. */
static int granted_with(int64_t room, int64_t wanted) {
  int code = 0;
  const pid_t pid = fork();
  if (pid == 0) {
    const size_t limit = address_space() + threads_stacks(room) + threads_stacks(1) / 2;
    setrlimit(RLIMIT_AS, &(struct rlimit){limit, limit});
    const int first = threads_granted(wanted), again = threads_granted(wanted);
    _exit(first <= again ? first : 0); /* what OpenMP keeps needs no second stack */
  }
  assert_true(pid > 0 && waitpid(pid, &code, 0) == pid);
  assert_true(WIFEXITED(code));
  return WEXITSTATUS(code);
}

/* First the test that forks: the child of a process that has used OpenMP must not use it. */
TEST(fewer_than_wanted) {
#ifdef __SANITIZE_ADDRESS__
  skip(); /* the sanitizer reserves address space of its own */
#endif
  assert_int_equal(granted_with(0, 8), 1);
  const int some = granted_with(3, 8);
  assert_true(some >= 1 && some <= 4);
}

TEST(as_many_as_wanted) {
  assert_int_equal(threads_granted(-1), 1);
  assert_int_equal(threads_granted(1), 1);
#ifdef _OPENMP
  assert_int_equal(threads_granted(5), 5);
  assert_int_equal(threads_granted(3), 3);
  assert_int_equal(threads_granted(7), 7);
#endif
  assert_int_equal(threads_stacks(0), 0);
  assert_true(threads_stacks(3) == 3 * threads_stacks(1));
  assert_true(threads_stacks(1) >= 1 << 14);
}
