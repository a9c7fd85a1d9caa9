/* Runs programs. A keeper process stands between this process and the program:
 *
 *   clast --(life, report: pipes)--> keeper (own session) --> program (own process group) --> its processes
 *
 * The keeper waits for the program, its time limit, or the end of `life`, which also comes when clast is killed. It
 * then kills the program's group and every process that was handed over to it: as a subreaper it inherits orphans, also
 * those that left the group. At the end of `life` it removes the folder. */
#include "engine/command/child.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/clock.h"

enum { DEPTH = 32, ENVIRONMENT = 16, ENTRY = 8192 };

/* ---- the folder ---- */

static int remove_entry(const char *path, const struct stat *about, int type, struct FTW *at) {
  (void)about, (void)at;
  if (type == FTW_DNR)
    (void)chmod(path, S_IRWXU);
  (void)remove(path);
  return 0;
}

static void remove_folder(const char *folder) {
  for (int i = 0; i < 2; i++) /* again for a folder that could not be read */
    (void)nftw(folder, remove_entry, DEPTH, FTW_DEPTH | FTW_PHYS | FTW_MOUNT);
}

status child_open(struct child *child, struct error *error) {
  const char *under = getenv("TMPDIR");
  *child = (struct child){.life = -1, .report = -1, .keeper = -1};
  const int length = snprintf(child->folder, sizeof child->folder, "%s/clast-run-XXXXXX",
                              under && *under == '/' ? under : "/tmp");
  if (length < 0 || (size_t)length >= sizeof child->folder || !mkdtemp(child->folder)) {
    child->folder[0] = '\0';
    return status_fail(error, STATUS_IO, "no folder for a run could be made in %.200s: %s (TMPDIR names another place)",
                       under && *under == '/' ? under : "/tmp", strerror(errno));
  }
  return STATUS_OK;
}

status child_put(const struct child *child, const char *name, const char *text, size_t size, struct error *error) {
  char path[LIMITS_PATH];
  snprintf(path, sizeof path, "%s/%s", child->folder, name);
  FILE *file = fopen(path, "wxe");
  const bool written = file && fwrite(text, 1, size, file) == size;
  if (file && fclose(file) == 0 && written)
    return STATUS_OK;
  return status_fail(error, STATUS_IO, "%s could not be written: %s", path, strerror(errno));
}

/* ---- the program's process ---- */

static char *entry(char *at, size_t size, const char *name, const char *value) {
  snprintf(at, size, "%s=%s", name, value);
  return at;
}

static void limit(int resource, rlim_t most) {
  struct rlimit now;
  if (getrlimit((__rlimit_resource_t)resource, &now) != 0)
    return;
  now.rlim_cur = most < now.rlim_cur ? most : now.rlim_cur;
  now.rlim_max = now.rlim_cur;
  (void)setrlimit((__rlimit_resource_t)resource, &now);
}

static void redirect(const char *name, int flags, int to) {
  const int file = open(name, flags | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (file < 0 || dup2(file, to) < 0)
    _exit(STATUS_IO);
}

static _Noreturn void be_program(const struct child *child, const char *program, char *const *words,
                                 const struct child_limits *limits, volatile int *refused) {
  static const char *const kept[] = {"PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "OMP_NUM_THREADS"};
  static char text[ENVIRONMENT][ENTRY];
  char *environment[ENVIRONMENT + 1];
  size_t count = 0;
  setpgid(0, 0);
  for (int number = 1; number < SIGRTMAX; number++)
    signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  if (chdir(child->folder) != 0)
    _exit(STATUS_IO);
  umask(S_IRWXG | S_IRWXO);
  for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
    const char *value = getenv(kept[i]);
    if (!value && strcmp(kept[i], "OMP_NUM_THREADS") == 0)
      value = "1";
    if (value && strlen(value) < ENTRY - 32)
      environment[count] = entry(text[count], ENTRY, kept[i], value), count++;
  }
  environment[count] = entry(text[count], ENTRY, "HOME", child->folder), count++;
  environment[count] = entry(text[count], ENTRY, "TMPDIR", child->folder), count++;
  environment[count] = entry(text[count], ENTRY, "LC_ALL", "C.UTF-8"), count++;
  environment[count] = entry(text[count], ENTRY, "TZ", "UTC"), count++;
  environment[count] = NULL;
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect("stdout", O_WRONLY | O_CREAT | O_EXCL, STDOUT_FILENO);
  redirect("stderr", O_WRONLY | O_CREAT | O_EXCL, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, limits->output);
  if (limits->memory)
    limit(RLIMIT_AS, limits->memory);
  close_range(STDERR_FILENO + 1, ~0U, 0);
  execve(program, words, environment);
  *refused = errno;
  _exit(STATUS_IO);
}

/* ---- the keeper ---- */

/* Kills the children of this process. False: the system does not list them. */
static bool kill_children(void) {
  char path[64];
  long child;
  snprintf(path, sizeof path, "/proc/self/task/%d/children", (int)getpid());
  FILE *list = fopen(path, "re");
  if (!list)
    return false;
  while (fscanf(list, "%ld", &child) == 1)
    kill((pid_t)child, SIGKILL);
  fclose(list);
  return true;
}

static void kill_all(pid_t program, bool reaped) {
  if (!reaped)
    kill(-program, SIGKILL);
  for (;;) {
    const bool listed = kill_children();
    const pid_t ended = waitpid(-1, NULL, listed ? 0 : WNOHANG);
    if (ended == 0 || (ended < 0 && errno != EINTR))
      return;
  }
}

struct keeping {
  const struct child *child;
  int life, report, signals;
};

/* Waits for the program's end. False: clast has ended. */
static bool watch(const struct keeping *k, pid_t program, double time_limit, struct child_end *end) {
  const int64_t until = clock_ns() + clock_from_s(time_limit);
  for (bool killed = false;;) {
    struct pollfd fds[2] = {{.fd = k->life, .events = POLLIN}, {.fd = k->signals, .events = POLLIN}};
    const int64_t left = (until - clock_ns()) / CLOCK_MS + 1;
    const int wait_ms = killed ? -1 : left <= 0 ? 0 : left > 3600000 ? 3600000 : (int)left;
    (void)poll(fds, 2, wait_ms);
    if (fds[0].revents)
      return false;
    struct signalfd_siginfo info;
    while (read(k->signals, &info, sizeof info) > 0) {
    }
    int ended = 0;
    siginfo_t seen = {0}; /* the group is killed before its number can be used again */
    if (waitid(P_PID, (id_t)program, &seen, WEXITED | WNOHANG | WNOWAIT) == 0 && seen.si_pid == program) {
      struct rusage usage;
      kill(-program, SIGKILL);
      wait4(program, &ended, 0, &usage);
      end->exit_code = WIFEXITED(ended) ? WEXITSTATUS(ended) : 0;
      end->signal = WIFSIGNALED(ended) ? WTERMSIG(ended) : 0;
      end->peak_memory = (int64_t)usage.ru_maxrss * 1024;
      end->late = killed;
      return true;
    }
    if (!killed && clock_ns() >= until) {
      kill(-program, SIGKILL);
      killed = true;
    }
  }
}

static _Noreturn void keep(const struct keeping *k, const char *program, char *const *words,
                           const struct child_limits *limits) {
  struct child_end end = {0};
  volatile int refused = 0; /* the program's process writes it: until execve() it has the memory of this one */
  setsid();
  prctl(PR_SET_PDEATHSIG, 0);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t child = vfork();
  if (child == 0)
    be_program(k->child, program, words, limits, &refused);
  bool here = child > 0;
  if (here) {
    setpgid(child, child);
    here = watch(k, child, limits->time, &end);
    end.refused = refused;
  }
  kill_all(child, here || child <= 0);
  if (here && write(k->report, &end, sizeof end) == sizeof end) {
    char byte;
    while (read(k->life, &byte, 1) < 0 && errno == EINTR) {
    }
  }
  remove_folder(k->child->folder);
  _exit(STATUS_OK);
}

/* Files of clast, such as those of the store or of a slot's channel, do not stay open in the keeper. */
static void close_others(struct keeping *k) {
  enum { FIRST = STDERR_FILENO + 1 };
  const int life = fcntl(k->life, F_DUPFD, FIRST + 4), report = fcntl(k->report, F_DUPFD, FIRST + 4);
  if (life < 0 || report < 0 || dup2(life, FIRST) < 0 || dup2(report, FIRST + 1) < 0)
    _exit(STATUS_IO);
  close_range(FIRST + 2, ~0U, 0);
  k->life = FIRST;
  k->report = FIRST + 1;
  (void)fcntl(k->life, F_SETFD, FD_CLOEXEC);
  (void)fcntl(k->report, F_SETFD, FD_CLOEXEC);
}

status child_run(struct child *child, const char *program, char *const *words, const struct child_limits *limits,
                 struct child_end *end, struct error *error) {
  int life[2], report[2];
  *end = (struct child_end){0};
  if (pipe2(life, O_CLOEXEC) != 0)
    return status_fail(error, STATUS_MEMORY, "the system refused a pipe: %s", strerror(errno));
  if (pipe2(report, O_CLOEXEC) != 0) {
    close(life[0]);
    close(life[1]);
    return status_fail(error, STATUS_MEMORY, "the system refused a pipe: %s", strerror(errno));
  }
  const pid_t keeper = fork();
  if (keeper == 0) {
    struct keeping k = {child, life[0], report[1], -1};
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGCHLD);
    signal(SIGCHLD, SIG_DFL);
    sigprocmask(SIG_BLOCK, &set, NULL);
    close_others(&k);
    k.signals = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
    keep(&k, program, words, limits);
  }
  close(life[0]);
  close(report[1]);
  child->life = life[1];
  child->report = report[0];
  child->keeper = keeper;
  if (keeper < 0)
    return status_fail(error, STATUS_MEMORY, "the system refused a process: %s", strerror(errno));
  ssize_t n;
  do
    n = read(report[0], end, sizeof *end);
  while (n < 0 && errno == EINTR);
  return n == (ssize_t)sizeof *end ? STATUS_OK
                                   : status_fail(error, STATUS_MEMORY, "the system refused a process for the program");
}

void child_close(struct child *child) {
  if (child->life >= 0)
    close(child->life);
  if (child->report >= 0)
    close(child->report);
  if (child->keeper > 0)
    while (waitpid(child->keeper, NULL, 0) < 0 && errno == EINTR) {
    }
  if (child->folder[0])
    remove_folder(child->folder); /* the keeper has done it, if there was one */
  *child = (struct child){.life = -1, .report = -1, .keeper = -1};
}
