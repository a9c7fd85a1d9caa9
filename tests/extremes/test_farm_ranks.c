/* The farm over MPI ranks, started by mpirun as a user does: same answers, no busy wait, and every way in which a
 * process can be killed. */
#define CHECK_OWN_MAIN
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>

#include "tests/support/check.h"
#include "tests/support/farm_process.h"

static const char *program;

static uint64_t expected_sum(int count) {
  uint64_t sum = 0;
  for (int i = 0; i < count; i++)
    sum += task_value((uint64_t)i);
  return sum;
}

TEST(same_answers_whatever_the_ranks) {
  const struct launch launches[] = {
      {.ranks = 0, .slots = 2, .count = 300, .special = -1},
      {.ranks = 1, .slots = 1, .count = 300, .special = -1},
      {.ranks = 2, .slots = 1, .count = 300, .special = -1, .in_process = 1},
      {.ranks = 3, .slots = 1, .count = 300, .special = -1},
      {.ranks = 2, .slots = 2, .count = 300, .special = -1},
      {.ranks = 3, .slots = 1, .count = 20000, .special = -1, .in_process = 1},
      {.ranks = 3, .slots = 0, .count = 1, .special = -1},
      {.ranks = 3, .slots = 1, .count = 0, .special = -1},
      {.ranks = 3, .slots = 1, .count = 40, .special = -1, .kind = TASK_BIG, .amount = 3e6},
  };
  for (size_t i = 0; i < sizeof launches / sizeof *launches; i++) {
    struct outcome_of out;
    const struct running it = launch(program, launches[i]);
    assert_true(ended(&it, 30, &out));
    assert_int_equal(orphans(&it, 2), 0);
    assert_int_equal(out.exit_code, STATUS_OK);
    assert_int_equal(out.done, launches[i].count);
    assert_int_equal(out.reported, launches[i].count);
    assert_int_equal(out.twice + out.wrong + out.stopping, 0);
    assert_true(out.sum == expected_sum(launches[i].count));
    const int ranks = launches[i].ranks ? launches[i].ranks : 1, slots = launches[i].slots ? launches[i].slots : 1;
    assert_int_equal(out.slots_total, ranks * slots);
  }
}

TEST(a_crash_costs_one_run) {
  const int kinds[] = {TASK_SEGV, TASK_HANG};
  for (int i = 0; i < 2; i++) {
    struct outcome_of out;
    const struct running it = launch(program, (struct launch){.ranks = 3,
                                                              .slots = 1,
                                                              .in_process = i,
                                                              .count = 100,
                                                              .special = 33,
                                                              .special_kind = kinds[i],
                                                              .time_limit_s = 0.5});
    assert_true(ended(&it, 20, &out));
    assert_int_equal(orphans(&it, 2), 0);
    assert_int_equal(out.exit_code, STATUS_OK);
    assert_int_equal(out.reported, 100);
    assert_int_equal(out.done, 99);
    assert_int_equal(out.twice + out.lost, 0);
  }
}

/* The farm sleeps in ppoll(). This definition comes before libc's, for the library as well. */
long ppoll_calls;
int ppoll(struct pollfd *fds, nfds_t count, const struct timespec *timeout, const sigset_t *mask) {
  ppoll_calls++;
  struct timespec left = timeout ? *timeout : (struct timespec){0}; /* the system call changes it */
  return (int)syscall(SYS_ppoll, fds, count, timeout ? &left : NULL, mask, _NSIG / 8);
}

/* One task of 2 s on one rank: the manager and the ranks with nothing to do sleep. */
TEST(idle_ranks_sleep) {
  struct outcome_of out;
  const struct running
      it = launch(program,
                  (struct launch){.ranks = 3, .slots = 1, .count = 1, .kind = TASK_SLEEP, .amount = 2, .special = -1});
  assert_true(ended(&it, 20, &out));
  assert_int_equal(orphans(&it, 2), 0);
  assert_int_equal(out.exit_code, STATUS_OK);
  /* An idle rank sleeps 5 ms at a time (FARM_SLEEP_USUAL_NS), later 10 ms: less than 200 wakings a second. Processor
   * time only tells a busy wait, which takes all that it can get: what a waking costs depends on the machine and on
   * what else runs there. bench_farm measures it. */
  assert_true(out.most_wakings > 0 && (double)out.most_wakings < 200 * out.wall_s);
  assert_true(out.manager_cpu_s < 0.2 * out.wall_s);
  assert_true(out.waiting_cpu_s / 2 < 0.2 * out.wall_s);
}

/* A dead rank ends the job in Open MPI 4.1. The manager receives SIGTERM and is called to commit; no process is left
 * over. */
TEST(a_killed_rank_ends_the_job) {
  const int rounds = getenv("CLAST_FULL") ? 10 : 1;
  for (int victim = 0; victim < 3; victim++) { /* rank 0, rank 1, mpirun */
    for (int round = 0; round < rounds; round++) {
      struct outcome_of out;
      const struct running it = launch(program, (struct launch){.ranks = 3,
                                                                .slots = 1,
                                                                .count = 2000,
                                                                .kind = TASK_SLEEP,
                                                                .amount = 0.01,
                                                                .special = -1});
      assert_true(await_journal(&it, 10));
      task_sleep(1e-3 * (double)((round * 37 + victim * 11) % 40));
      const pid_t pid = victim == 2 ? it.pid : await_descendant(&it, it.pid, 0, victim);
      assert_true(pid > 0);
      kill(pid, SIGKILL);
      assert_true(ended(&it, 10, &out));
      assert_int_equal(orphans(&it, 5), 0);
      assert_true(out.exit_code != 0); /* whatever mpirun reports, the exit code is not success */
    }
  }
}

TEST(signals_to_mpirun) {
  const int signals[] = {SIGUSR1, SIGUSR2, SIGTERM, SIGINT};
  for (int i = 0; i < 4; i++) {
    struct outcome_of out;
    const struct running it = launch(program, (struct launch){.ranks = 3,
                                                              .slots = 1,
                                                              .count = 2000,
                                                              .kind = TASK_SLEEP,
                                                              .amount = 0.05,
                                                              .special = -1});
    assert_true(await_journal(&it, 10));
    kill(it.pid, signals[i]);
    assert_true(ended(&it, 10, &out));
    assert_int_equal(orphans(&it, 3), 0);
    assert_true(out.summary); /* the manager ended in time */
    assert_int_equal(out.status, STATUS_STOPPED);
    assert_int_equal(out.stopping, 1);
    assert_int_equal(out.twice + out.wrong, 0);
    if (signals[i] == SIGUSR1 || signals[i] == SIGUSR2) {
      assert_int_equal(out.exit_code, STATUS_STOPPED);
      assert_int_equal(out.lost, 0);
    } else {
      /* mpirun returns 1 whatever the ranks do: the test reads the result from the store */
      assert_true(out.exit_code != 0);
    }
  }
}

/* A rank that freezes is noticed; its run is lost, the others finish, and the program ends with MPI_Abort because
 * MPI_Finalize would hang. */
TEST(a_frozen_rank_is_left_behind) {
  struct outcome_of out;
  const struct running it = launch(program, (struct launch){.ranks = 3,
                                                            .slots = 1,
                                                            .count = 60,
                                                            .kind = TASK_SLEEP,
                                                            .amount = 0.05,
                                                            .lost_after_s = 3,
                                                            .special = -1});
  assert_true(await_journal(&it, 6));
  const pid_t victim = await_descendant(&it, it.pid, 0, 2);
  assert_true(victim > 0);
  kill(victim, SIGSTOP);
  assert_true(ended(&it, 20, &out));
  assert_int_equal(orphans(&it, 5), 0);
  assert_true(out.summary);
  assert_int_equal(out.status, STATUS_OK);
  assert_int_equal(out.reported, 60);
  assert_int_equal(out.twice, 0);
  assert_int_equal(out.done, 59);
  assert_int_equal(out.lost, 1); /* the run it was computing; the tasks queued on it went to other ranks */
}

int main(int argc, char **argv) {
  if (argc > 2 && strcmp(argv[1], "work") == 0)
    return program_work(argv);
  char path[4096];
  program = program_path(path, sizeof path);
  return check_run(NULL, NULL);
}
