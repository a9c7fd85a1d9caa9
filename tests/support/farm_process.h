/* For tests that kill processes: a program that farms tasks (the test itself, called again as `program work ...`),
 * started alone or under mpirun, watched and killed from outside, with a check that no process of it is left.
 *
 * Every process of a launch carries the same tag in its environment, so that /proc shows which are still alive,
 * whatever their parent process is by then. */
#pragma once

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/wait.h>

#include "schemas/clock.h"
#include "tests/support/check.h"
#include "tests/support/farm_tasks.h"

#define TAG_VARIABLE "CLAST_FARM_TEST_TAG"

/* The path of this test's program. Its file is that of all tests of its folder, and its name says which one runs. */
static inline const char *program_path(char *path, size_t size) {
  const ssize_t length = readlink("/proc/self/exe", path, size - 1);
  path[length > 0 ? length : 0] = '\0';
  char *slash = strrchr(path, '/');
  if (slash)
    snprintf(slash + 1, size - (size_t)(slash + 1 - path), "%s", program_invocation_short_name);
  return path;
}

struct launch {
  int ranks; /* 0: alone, else mpirun -n ranks */
  int slots, in_process, count, kind;
  double amount, time_limit_s, lost_after_s, drain_s;
  int special, special_kind; /* one task that is different; -1 none */
};

struct outcome_of {
  int exit_code, signal; /* of the program or mpirun */
  int status, reported, twice, wrong, done, lost, stopping, slots_total;
  double manager_cpu_s, waiting_cpu_s, wall_s;
  unsigned long long sum;
  long most_wakings; /* ppoll() calls of the rank that made most of them while the farm ran */
  bool summary;      /* the program reached the end and wrote a summary */
};

/* How often this process has asked ppoll() to wait: test_farm_ranks.c counts. The kernel's count of voluntary switches
 * has others too, such as some sched_yield() of Open MPI: 320 to 456 for 213 waits in two seconds, as the machine was.
 */
extern long ppoll_calls;

/* ---- the program ---- */

static inline status append_line(const char *variable, const char *line) {
  const char *path = getenv(variable);
  const int file = path ? open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600) : -1;
  const size_t length = strlen(line);
  if (file >= 0 && write(file, line, length) != (ssize_t)length)
    return STATUS_IO;
  if (file >= 0)
    close(file);
  return STATUS_OK;
}

static inline status journal_report(void *context, const struct farm_report *report, struct error *e) {
  const status result = task_list_report(context, report, e);
  char line[64];
  snprintf(line, sizeof line, "%llu %d %d\n", (unsigned long long)report->id, (int)report->ending, report->rank);
  return append_line("CLAST_FARM_TEST_JOURNAL", line) == STATUS_OK ? result : STATUS_IO;
}

static inline int program_work(char **argv) {
  struct launch it;
  struct task_list list;
  struct farm *farm = NULL;
  sscanf(argv[2], "%d,%d,%d,%d,%d,%lf,%lf,%lf,%lf,%d,%d", &it.ranks, &it.slots, &it.in_process, &it.count, &it.kind,
         &it.amount, &it.time_limit_s, &it.lost_after_s, &it.drain_s, &it.special, &it.special_kind);
  const struct farm_options options = {.slots = it.slots,
                                       .in_process = it.in_process,
                                       .use_mpi = farm_under_mpi(),
                                       .time_limit_s = it.time_limit_s,
                                       .lost_after_s = it.lost_after_s,
                                       .drain_s = it.drain_s};
  if (farm_start(&options, task_work, &farm, &error) != STATUS_OK) {
    fprintf(stderr, "%s\n", error.message);
    return 99;
  }
  task_list_new(&list, (size_t)it.count);
  for (int i = 0; i < it.count; i++)
    list.tasks[i] = (struct task){.id = (uint64_t)i,
                                  .kind = i == it.special ? it.special_kind : it.kind,
                                  .amount = it.amount};
  struct farm_manager manager = task_list_manager(&list);
  manager.report = journal_report;
  const int total = farm_slots_total(farm);
  const long before = ppoll_calls;
  const status result = farm_run(farm, &manager, &error);
  char line[32];
  snprintf(line, sizeof line, "%ld\n", ppoll_calls - before);
  append_line("CLAST_FARM_TEST_WAKINGS", line);
  if (farm_rank(farm) == 0) {
    const struct farm_usage usage = farm_usage(farm);
    int twice = 0, done = 0, lost = 0;
    for (int i = 0; i < it.count; i++) {
      twice += list.told[i].reports > 1;
      done += list.told[i].reports == 1 && list.told[i].report.ending == FARM_DONE;
      lost += list.told[i].report.ending == FARM_LOST;
    }
    FILE *file = fopen(getenv("CLAST_FARM_TEST_SUMMARY"), "w");
    if (file) {
      fprintf(file, "%d %d %d %d %d %d %d %d %g %g %g %llu", (int)result, (int)list.reported, twice, (int)list.wrong,
              done, lost, list.stopping, total, usage.manager_cpu_s, usage.waiting_cpu_s, usage.wall_s,
              (unsigned long long)list.sum);
      fclose(file);
    }
  }
  task_list_free(&list);
  farm_stop(farm);
  return (int)result;
}

/* ---- the test's side ---- */

struct running {
  pid_t pid;
  char tag[64], summary[128], journal[128], wakings[128];
};

static inline struct running launch(const char *program, struct launch it) {
  static int number = 0;
  struct running running;
  char text[256], ranks[16];
  snprintf(running.tag, sizeof running.tag, "%d.%d", (int)getpid(), ++number);
  snprintf(running.summary, sizeof running.summary, "/tmp/clast_farm_%s.summary", running.tag);
  snprintf(running.journal, sizeof running.journal, "/tmp/clast_farm_%s.journal", running.tag);
  snprintf(running.wakings, sizeof running.wakings, "/tmp/clast_farm_%s.wakings", running.tag);
  snprintf(text, sizeof text, "%d,%d,%d,%d,%d,%g,%g,%g,%g,%d,%d", it.ranks, it.slots, it.in_process, it.count, it.kind,
           it.amount, it.time_limit_s, it.lost_after_s, it.drain_s, it.special, it.special_kind);
  snprintf(ranks, sizeof ranks, "%d", it.ranks);
  running.pid = fork();
  if (running.pid == 0) {
    setpgid(0, 0);
    for (size_t i = 0; i < FARM_STOP_SIGNALS; i++) /* the test may run under nohup, which ignores some */
      signal(farm_stop_signals[i], SIG_DFL);
    setenv(TAG_VARIABLE, running.tag, 1);
    setenv("CLAST_FARM_TEST_SUMMARY", running.summary, 1);
    setenv("CLAST_FARM_TEST_JOURNAL", running.journal, 1);
    setenv("CLAST_FARM_TEST_WAKINGS", running.wakings, 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
#ifdef __SANITIZE_ADDRESS__
    if (it.ranks)
      setenv("ASAN_OPTIONS", "detect_leaks=0", 1); /* Open MPI itself leaks; without it, our leaks are checked */
#endif
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDIN_FILENO);
    if (!getenv("CLAST_FARM_TEST_LOUD"))
      dup2(nothing, STDERR_FILENO); /* mpirun prints long messages at the end */
    if (it.ranks)
      execlp("mpirun", "mpirun", "--oversubscribe", "-n", ranks, program, "work", text, (char *)NULL);
    else
      execl(program, program, "work", text, (char *)NULL);
    _exit(127);
  }
  return running;
}

/* Processes of the launch, zombies left out. */
static inline int family(const struct running *running, pid_t *pids, int most) {
  int count = 0;
  DIR *directory = opendir("/proc");
  for (struct dirent *entry; directory && (entry = readdir(directory));) {
    const int pid = atoi(entry->d_name);
    char path[64], needle[128], bytes[16384];
    if (pid <= 0)
      continue;
    snprintf(path, sizeof path, "/proc/%d/environ", pid);
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
      continue;
    const ssize_t n = read(file, bytes, sizeof bytes - 1);
    close(file);
    if (n <= 0)
      continue; /* a zombie has none */
    const int length = snprintf(needle, sizeof needle, TAG_VARIABLE "=%s", running->tag);
    for (ssize_t i = 0; i + length < n; i += (ssize_t)strlen(bytes + i) + 1) {
      bytes[n] = '\0';
      if (strcmp(bytes + i, needle) == 0) {
        if (count < most)
          pids[count] = (pid_t)pid;
        count++;
        break;
      }
    }
  }
  if (directory)
    closedir(directory);
  return count < most ? count : most;
}

static inline pid_t parent_of(pid_t pid) {
  char path[64], bytes[512] = "";
  snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return 0;
  const ssize_t n = read(file, bytes, sizeof bytes - 1);
  close(file);
  const char *after = n > 0 ? strrchr(bytes, ')') : NULL;
  int parent = 0;
  if (after)
    sscanf(after + 1, " %*c %d", &parent);
  return parent;
}

/* The pid of the `nth` process at this depth under `top` (0 = its children), ordered by pid; 0 when there is none. */
static inline pid_t descendant(const struct running *running, pid_t top, int depth, int nth) {
  pid_t pids[128];
  const int count = family(running, pids, 128);
  for (int i = 0; i < count; i++)
    for (int j = i + 1; j < count; j++)
      if (pids[j] < pids[i]) {
        const pid_t swap = pids[i];
        pids[i] = pids[j];
        pids[j] = swap;
      }
  for (int i = 0; i < count; i++) {
    pid_t up = pids[i];
    int level = -1;
    while (up && up != top && level < 8)
      up = parent_of(up), level++;
    if (up == top && pids[i] != top && level == depth && nth-- == 0)
      return pids[i];
  }
  return 0;
}

static inline pid_t await_descendant(const struct running *running, pid_t top, int depth, int nth) {
  for (int i = 0; i < 1000; i++) {
    const pid_t pid = descendant(running, top, depth, nth);
    if (pid)
      return pid;
    task_sleep(0.01);
  }
  return 0;
}

/* Number of lines in the journal so far. */
static inline int journal_lines(const struct running *running) {
  FILE *file = fopen(running->journal, "r");
  int lines = 0;
  for (int c; file && (c = getc(file)) != EOF;)
    lines += c == '\n';
  if (file)
    fclose(file);
  return lines;
}

static inline bool await_journal(const struct running *running, int lines) {
  for (int i = 0; i < 2000; i++) {
    if (journal_lines(running) >= lines)
      return true;
    task_sleep(0.01);
  }
  return false;
}

/* Waits for the end of the launched process; false if it has not ended after `seconds`. */
static inline bool ended(const struct running *running, double seconds, struct outcome_of *out) {
  *out = (struct outcome_of){0};
  int value = 0;
  pid_t got = 0;
  const int64_t until = clock_ns() + clock_from_s(seconds);
  while ((got = waitpid(running->pid, &value, WNOHANG)) == 0 && clock_ns() < until)
    task_sleep(0.005);
  if (got == 0) {
    pid_t pids[128];
    const int count = family(running, pids, 128);
    for (int i = 0; i < count; i++)
      kill(pids[i], SIGKILL);
    waitpid(running->pid, &value, 0);
    return false;
  }
  out->exit_code = WIFEXITED(value) ? WEXITSTATUS(value) : -1;
  out->signal = WIFSIGNALED(value) ? WTERMSIG(value) : 0;
  FILE *file = fopen(running->summary, "r");
  out->summary = file && fscanf(file, "%d %d %d %d %d %d %d %d %lf %lf %lf %llu", &out->status, &out->reported,
                                &out->twice, &out->wrong, &out->done, &out->lost, &out->stopping, &out->slots_total,
                                &out->manager_cpu_s, &out->waiting_cpu_s, &out->wall_s, &out->sum) == 12;
  if (file)
    fclose(file);
  file = fopen(running->wakings, "r");
  for (long count; file && fscanf(file, "%ld", &count) == 1;)
    out->most_wakings = count > out->most_wakings ? count : out->most_wakings;
  if (file)
    fclose(file);
  return true;
}

/* Number of processes of the launch still alive after at most `seconds` (tests expect 0); they are then killed. */
static inline int orphans(const struct running *running, double seconds) {
  pid_t pids[128];
  int count = 0;
  const int64_t until = clock_ns() + clock_from_s(seconds);
  while ((count = family(running, pids, 128)) > 0 && clock_ns() < until)
    task_sleep(0.01);
  for (int i = 0; i < count; i++)
    kill(pids[i], SIGKILL);
  unlink(running->summary);
  unlink(running->journal);
  unlink(running->wakings);
  return count;
}
