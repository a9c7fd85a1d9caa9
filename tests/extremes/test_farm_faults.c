/* Faults and signals on one machine: after kill -9 of any process at any instant, no process is left behind and the
 * program ends with a clear status. */
#define CHECK_OWN_MAIN
#include "tests/support/check.h"
#include "tests/support/farm_process.h"

static const char *program;

#define ALONE .slots = 2, .special = -1

/* Depth of the killed process under the program. In isolation: program - server - slot - child. */
enum { MANAGER = -1, SERVER = 0, SLOT = 1, CHILD = 2 };

TEST(kill_anything) {
  const bool full = getenv("CLAST_FULL") != NULL;
  const int rounds = full ? 20 : 2;
  for (int in_process = 0; in_process < 2; in_process++) {
    for (int who = MANAGER; who <= (in_process ? SLOT : CHILD); who++) {
      for (int round = 0; round < rounds; round++) {
        struct outcome_of out;
        const struct running it = launch(program, (struct launch){ALONE, .in_process = in_process, .count = 100,
                                                                  .kind = TASK_SLEEP, .amount = 0.01});
        assert_true(await_journal(&it, 3));
        task_sleep(1e-3 * (double)((round * 37 + who * 11 + 13) % 40)); /* an instant that differs in each round */
        const pid_t victim = who == MANAGER ? it.pid : await_descendant(&it, it.pid, who, round % 2 && who == SLOT);
        assert_true(victim > 0);
        kill(victim, SIGKILL);
        assert_true(ended(&it, 20, &out));
        const int lines = journal_lines(&it);
        assert_int_equal(orphans(&it, 2), 0);
        if (who == MANAGER) {
          assert_int_equal(out.signal, SIGKILL);
        } else if (who == SERVER) {
          assert_int_equal(out.exit_code, STATUS_STOPPED);
          assert_int_equal(out.twice, 0);
        } else {
          /* At most one run is lost (the victim may have ended normally just before); all are reported. */
          assert_int_equal(out.exit_code, STATUS_OK);
          assert_int_equal(out.reported, 100);
          assert_int_equal(lines, 100);
          assert_int_equal(out.twice + out.wrong, 0);
          assert_in_range(out.done, 99, 100);
        }
      }
    }
  }
}

TEST(signals_drain) {
  const int signals[] = {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGUSR2, SIGXCPU};
  for (int i = 0; i < 6; i++) {
    struct outcome_of out;
    const struct running it = launch(program, (struct launch){ALONE, .in_process = i % 2, .count = 1000,
                                                              .kind = TASK_SLEEP, .amount = 0.05});
    assert_true(await_journal(&it, 4));
    killpg(it.pid, signals[i]); /* as a terminal does: slots and children get the signal too and must ignore it */
    assert_true(ended(&it, 5, &out));
    assert_int_equal(orphans(&it, 1), 0);
    assert_int_equal(out.exit_code, STATUS_STOPPED);
    assert_int_equal(out.stopping, 1);
    assert_true(out.reported < 100);
    assert_int_equal(out.twice + out.wrong, 0);
    assert_int_equal(out.done, out.reported);
  }
}

/* Signals that batch systems send early: runs that need longer than the grace period are finished. */
TEST(early_signals_wait) {
  const int signals[] = {SIGUSR1, SIGUSR2, SIGXCPU};
  for (int i = 0; i < 3; i++) {
    struct outcome_of out;
    const struct running it = launch(program, (struct launch){ALONE, .count = 10, .kind = TASK_SLEEP, .amount = 2.5});
    assert_true(await_descendant(&it, it.pid, CHILD, 1) > 0);
    killpg(it.pid, signals[i]);
    assert_true(ended(&it, 10, &out));
    assert_int_equal(orphans(&it, 1), 0);
    assert_int_equal(out.exit_code, STATUS_STOPPED);
    assert_int_equal(out.reported, 2);
    assert_int_equal(out.done, 2);
  }
}

/* Tasks that do not end within the grace period are dropped; a second signal ends the grace period at once. */
TEST(long_runs_are_dropped) {
  for (int second = 0; second < 2; second++) {
    struct outcome_of out;
    const struct running it = launch(program, (struct launch){ALONE, .count = 10, .kind = TASK_SLEEP, .amount = 30});
    assert_true(await_descendant(&it, it.pid, CHILD, 1) > 0);
    const int64_t start = clock_ns();
    kill(it.pid, second ? SIGUSR1 : SIGTERM); /* draining would take two minutes, the grace period is two seconds */
    if (second) {
      task_sleep(0.3);
      kill(it.pid, SIGTERM);
    }
    assert_true(ended(&it, 10, &out));
    const double took = 1e-9 * (double)(clock_ns() - start);
    assert_int_equal(orphans(&it, 1), 0);
    assert_int_equal(out.exit_code, STATUS_STOPPED);
    assert_int_equal(out.reported, 0);
    if (second)
      assert_true(took < 1.9); /* less than the grace period of 2 s */
    else
      assert_true(took > 1.9);
  }
}

/* Slots that tasks crash again and again are restarted; the series of crashes ends. */
TEST(crash_storm) {
  for (int in_process = 0; in_process < 2; in_process++) {
    struct outcome_of out;
    const struct running it = launch(program,
                                     (struct launch){ALONE, .in_process = in_process, .count = 300, .kind = TASK_SEGV});
    assert_true(ended(&it, 30, &out));
    assert_int_equal(orphans(&it, 1), 0);
    assert_int_equal(out.exit_code, STATUS_OK);
    assert_int_equal(out.reported, 300);
    assert_int_equal(out.done + out.twice, 0);
  }
}

TEST(stdout_stays_clean) {
  char path[] = "/tmp/clast_farm_stdout_XXXXXX", text[64] = "";
  const int file = mkstemp(path), saved = dup(STDOUT_FILENO);
  fflush(stdout);
  dup2(file, STDOUT_FILENO);
  struct outcome_of out;
  const struct running it = launch(program, (struct launch){ALONE, .count = 20, .kind = TASK_PRINT});
  const bool came = ended(&it, 10, &out);
  dup2(saved, STDOUT_FILENO);
  close(saved);
  assert_true(came);
  assert_int_equal(orphans(&it, 1), 0);
  assert_int_equal(out.done, 20);
  assert_int_equal(pread(file, text, sizeof text, 0), 0);
  close(file);
  unlink(path);
}

int main(int argc, char **argv) {
  if (argc > 2 && strcmp(argv[1], "work") == 0)
    return program_work(argv);
  char path[4096];
  program = program_path(path, sizeof path);
  return check_run(NULL, NULL);
}
