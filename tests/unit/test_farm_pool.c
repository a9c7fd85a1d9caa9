/* The farm on one machine: every way a task can end, in both modes, exactly once each. */
#include <dirent.h>
#include <malloc.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "schemas/clock.h"
#include "tests/support/check.h"
#include "tests/support/farm_tasks.h"

static struct farm *start(struct farm_options options) {
  struct farm *farm = NULL;
  OK(farm_start(&options, task_work, &farm, &error));
  return farm;
}

static status run_list(struct farm_options options, struct task_list *list, struct error *e) {
  struct farm *farm = start(options);
  const struct farm_manager manager = task_list_manager(list);
  const status result = farm_run(farm, &manager, e);
  farm_stop(farm);
  return result;
}

static void assert_each_once(const struct task_list *list) {
  for (size_t i = 0; i < list->count; i++)
    assert_int_equal(list->told[i].reports, 1);
  assert_int_equal(list->wrong, 0);
}

TEST(same_answers_whatever_the_slots) {
  uint64_t expected = 0;
  for (uint64_t id = 0; id < 500; id++)
    expected += task_value(id);
  for (int mode = 0; mode < 2; mode++) {
    for (int slots = 1; slots <= 5; slots += 2) {
      OWNED_BY(task_list_free) struct task_list list;
      task_list_new(&list, 500);
      OK(run_list((struct farm_options){.slots = slots, .in_process = mode}, &list, &error));
      assert_each_once(&list);
      assert_true(list.sum == expected);
    }
  }
}

TEST(no_tasks_and_fewer_than_slots) {
  for (size_t count = 0; count < 3; count++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, count);
    OK(run_list((struct farm_options){.slots = 4}, &list, &error));
    assert_each_once(&list);
  }
}

TEST(every_ending) {
  const double limit_s = 2; /* much longer than the end of a process under sanitizers, which looks for leaks */
  for (int mode = 0; mode < 2; mode++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, 40);
    list.tasks[3].kind = TASK_SEGV;
    list.tasks[7].kind = TASK_ABORT;
    list.tasks[11] = (struct task){.id = 11, .kind = TASK_EXIT, .number = 3};
    list.tasks[15].kind = TASK_HANG;
    list.tasks[19] = (struct task){.id = 19, .kind = TASK_FAIL, .number = STATUS_CONTENT};
    list.tasks[23] = (struct task){.id = 23, .kind = TASK_ALLOC, .amount = 3e8};
    list.tasks[27] = (struct task){.id = 27, .kind = TASK_EXIT, .number = 0};
    list.tasks[31].kind = TASK_WILD;
    list.tasks[35] = (struct task){.id = 35, .kind = TASK_FAIL, .number = STATUS_IO};
    list.tasks[38] = (struct task){.id = 38, .kind = TASK_EXIT, .number = 1};
    const struct farm_options options = {.slots = 2,
                                         .in_process = mode,
                                         .time_limit_s = limit_s,
                                         .memory_limit = (size_t)1 << 27};
    OK(run_list(options, &list, &error));
    assert_each_once(&list);
    assert_int_equal(list.told[3].report.ending, FARM_CRASHED);
    assert_int_equal(list.told[3].report.signal, SIGSEGV);
    assert_int_equal(list.told[3].report.exit_code, 0);
    assert_int_equal(list.told[7].report.ending, FARM_CRASHED);
    assert_int_equal(list.told[7].report.signal, SIGABRT);
    assert_non_null(strstr(list.told[7].message, "signal 6"));
    assert_int_equal(list.told[11].report.ending, FARM_CRASHED);
    assert_int_equal(list.told[11].report.exit_code, 3);
    assert_int_equal(list.told[15].report.ending, FARM_TIME_LIMIT);
    assert_true(list.told[15].report.wall_s >= 0.975 * limit_s && list.told[15].report.wall_s < limit_s + 2.6);
    assert_int_equal(list.told[19].report.ending, FARM_FAILED);
    assert_int_equal(list.told[19].report.exit_code, STATUS_CONTENT);
    assert_string_equal(list.told[19].message, "task 19 cannot");
    assert_int_equal(list.told[23].report.ending, FARM_MEMORY_LIMIT);
    assert_int_equal(list.told[27].report.ending, FARM_CRASHED); /* exit(0) without a result is no success */
    assert_int_equal(list.told[31].report.ending, FARM_LOST);    /* SIGKILL comes from outside */
    assert_int_equal(list.told[35].report.ending, FARM_LOST);    /* the machine's disk */
    assert_int_equal(list.told[38].report.ending, FARM_LOST);    /* a library that the system refused a thread */
    assert_non_null(strstr(list.told[38].message, "code 71"));
    for (size_t i = 0; i < list.count; i++)
      if (list.tasks[i].kind == TASK_ECHO)
        assert_int_equal(list.told[i].report.ending, FARM_DONE);
  }
}

TEST(large_results) {
  for (int mode = 0; mode < 2; mode++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, 40);
    for (size_t i = 0; i < list.count; i++)
      list.tasks[i] = (struct task){.id = i, .kind = TASK_BIG, .amount = i == 5 ? 2e7 : (double)(i * i * 977)};
    OK(run_list((struct farm_options){.slots = 2, .in_process = mode}, &list, &error));
    assert_each_once(&list);
    for (size_t i = 0; i < list.count; i++)
      assert_int_equal(list.told[i].report.ending, FARM_DONE);
  }
}

/* CPU and memory are those of the task, not of earlier tasks in the slot. */
TEST(costs_are_the_tasks_own) {
  for (int mode = 0; mode < 2; mode++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, 3);
    list.tasks[0] = (struct task){.id = 0, .kind = TASK_ALLOC, .amount = 1e8};
    list.tasks[1] = (struct task){.id = 1, .kind = TASK_BURN, .amount = 0.1};
    list.tasks[2] = (struct task){.id = 2, .kind = TASK_SLEEP, .amount = 0.1};
    OK(run_list((struct farm_options){.slots = 1, .in_process = mode}, &list, &error));
    assert_each_once(&list);
    assert_true(list.told[0].report.peak_memory > 90000000);
#ifndef __SANITIZE_ADDRESS__ /* its quarantine keeps freed memory */
    assert_true(list.told[1].report.peak_memory <
                90000000); /* in process only where /proc/self/clear_refs may be written */
#endif
    assert_true(list.told[1].report.cpu_s > 0.099 &&
                list.told[1].report.cpu_s < 0.2); /* above: 0.1 burnt + fork and exit on a loaded machine */
    assert_true(list.told[2].report.cpu_s < 0.05);
    assert_true(list.told[2].report.wall_s > 0.099);
  }
}

TEST(the_caller_can_stop) {
  const status reasons[] = {STATUS_STOPPED, STATUS_IO};
  for (int reason = 0; reason < 2; reason++) {
    for (int mode = 0; mode < 2; mode++) {
      OWNED_BY(task_list_free) struct task_list list;
      task_list_new(&list, 1000);
      for (size_t i = 0; i < list.count; i++)
        list.tasks[i] = (struct task){.id = i, .kind = TASK_SLEEP, .amount = 0.002};
      list.stop_after = 20;
      list.stop_with = reasons[reason];
      const status ended = run_list((struct farm_options){.slots = 2, .in_process = mode}, &list, &error);
      assert_int_equal(ended, reasons[reason]);
      assert_string_equal(error.message, "the caller has enough");
      for (size_t i = 0; i < list.count; i++)
        assert_in_range(list.told[i].reports, 0, 1);
      if (reasons[reason] == STATUS_IO)
        assert_int_equal(list.reported, 20); /* the campaign asked for no more tasks */
      else
        assert_in_range(list.reported, 20, 26); /* every started run is reported: two slots, a few sent ahead */
    }
  }
}

TEST(runs_again_after_a_run) {
  struct farm *farm = start((struct farm_options){.slots = 2});
  for (int round = 0; round < 3; round++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, 50);
    list.tasks[10].kind = TASK_SEGV;
    const struct farm_manager manager = task_list_manager(&list);
    OK(farm_run(farm, &manager, &error));
    assert_each_once(&list);
  }
  farm_stop(farm);
}

/* The last short tasks do not wait behind a long one that started earlier. */
TEST(nobody_waits_behind_a_long_task) {
  for (int mode = 0; mode < 2; mode++) {
    OWNED_BY(task_list_free) struct task_list list;
    task_list_new(&list, 6);
    for (size_t i = 0; i < list.count; i++)
      list.tasks[i] = (struct task){.id = i, .kind = TASK_SLEEP, .amount = i == 0 ? 1.0 : 0.02};
    const int64_t start_ns = clock_ns();
    OK(run_list((struct farm_options){.slots = 2, .in_process = mode}, &list, &error));
    const double wall = 1e-9 * (double)(clock_ns() - start_ns);
    assert_each_once(&list);
    for (size_t i = 1; i < list.count; i++)
      assert_true(list.told[i].report.slot != list.told[0].report.slot);
    assert_true(wall < 1.5); /* 1 s of the long task plus a margin for a loaded machine; behind it: 1.02 s and more */
  }
}

static _Atomic int *times_computed; /* set before the slots are forked, shared with them */

static status counting_work(const uint8_t *bytes, size_t size, uint8_t **result, size_t *result_size, struct error *e) {
  struct task task;
  memcpy(&task, bytes, sizeof task);
  times_computed[task.id]++;
  return task_work(bytes, size, result, result_size, e);
}

/* A task taken back from a busy slot and run elsewhere stays in that slot's channel: the slot must skip it. */
TEST(computed_once_though_taken_back) {
  for (int mode = 0; mode < 2; mode++) {
    times_computed = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(times_computed != MAP_FAILED);
    struct farm *farm = NULL;
    OK(farm_start(&(struct farm_options){.slots = 2, .in_process = mode}, counting_work, &farm, &error));
    struct task_list list;
    task_list_new(&list, 6);
    for (size_t i = 0; i < list.count; i++)
      list.tasks[i] = (struct task){.id = i, .kind = TASK_SLEEP, .amount = i == 0 ? 0.3 : 0.01};
    const struct farm_manager manager = task_list_manager(&list);
    OK(farm_run(farm, &manager, &error));
    task_sleep(0.2); /* the slot reads the rest of its channel */
    farm_stop(farm);
    assert_each_once(&list);
    for (size_t i = 0; i < list.count; i++)
      assert_int_equal(times_computed[i], 1);
    task_list_free(&list);
    munmap((void *)times_computed, 4096);
  }
}

static int open_files(void) {
  int count = 0;
  DIR *directory = opendir("/proc/self/fd");
  while (directory && readdir(directory))
    count++;
  if (directory)
    closedir(directory);
  return count;
}

TEST(leaks_nothing) {
  const bool full = getenv("CLAST_FULL") != NULL;
  for (int mode = 0; mode < 2; mode++) {
    const size_t count = (full ? 100000U : mode ? 5000U : 500U) / (SANITIZED ? 10U : 1U);
    const int before = open_files();
    struct farm *farm = start((struct farm_options){.slots = 2, .in_process = mode});
    size_t least_more = SIZE_MAX, bytes = 0;
    int files[4];
    for (int round = 0; round < 4; round++) { /* the first fills what stays allocated, the others must not add */
      struct task_list list;
      task_list_new(&list, count);
      for (size_t i = 0; i < count; i += 500)
        list.tasks[i].kind = TASK_SEGV;
      const struct farm_manager manager = task_list_manager(&list);
      OK(farm_run(farm, &manager, &error));
      assert_each_once(&list);
      files[round] = open_files();
      task_list_free(&list);
      const size_t now = mallinfo2().uordblks, more = now > bytes ? now - bytes : 0;
      least_more = round && more < least_more ? more : least_more;
      bytes = now;
    }
    farm_stop(farm);
    assert_in_range(files[3], files[0] - 2, files[0] + 2); /* a crashed slot's channel may not be back yet: two slots */
    assert_int_equal(open_files(), before);
    /* Under sanitizers mallinfo2() tells nothing, and they find leaks. After a round two slots that crashed late may
     * still have a buffer; a leak of 20 bytes a task would be 10 000 bytes in every round. */
    assert_true(least_more < 4096);
  }
}

TEST(asleep_while_tasks_sleep) {
  OWNED_BY(task_list_free) struct task_list list;
  task_list_new(&list, 2);
  for (size_t i = 0; i < 2; i++)
    list.tasks[i] = (struct task){.id = i, .kind = TASK_SLEEP, .amount = 2};
  struct farm *farm = start((struct farm_options){.slots = 2});
  const struct farm_manager manager = task_list_manager(&list);
  struct rusage before, after;
  getrusage(RUSAGE_SELF, &before);
  OK(farm_run(farm, &manager, &error));
  getrusage(RUSAGE_SELF, &after);
  const struct farm_usage usage = farm_usage(farm);
  farm_stop(farm);
  assert_true(usage.wall_s >= 2);
  /* It wakes for a tick, and when a task starts or ends. Processor time only tells a busy wait: what a waking costs
   * depends on the machine and on what else runs there. bench_farm measures it. */
  assert_in_range(after.ru_nvcsw - before.ru_nvcsw, 10, 60);
  assert_true(usage.manager_cpu_s < 0.2 * usage.wall_s);
  assert_in_range(list.ticks, 10, 21); /* every 100 ms at most, and not much less often */
}
