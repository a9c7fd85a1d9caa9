/* The loop of a slot: takes tasks, computes them in its own process or in a child, sends results in batches. */
#include "campaign/farm/farm_private.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/clock.h"

/* ---- one run in its own child process, with limits and a deadline: no error of the run can affect the slot ---- */

/* The child is forked from the slot, which has no threads, no MPI and no open HDF5 files. That takes 0.1-0.3 ms; an
 * executable that loads HDF5 takes 5 ms. The answer comes through a pipe. Exit code, signal, CPU seconds and peak
 * memory come from wait4. */

/* Kept between runs. */
struct isolate {
  int child_signal; /* signalfd of SIGCHLD */
  int result[2];    /* pipe; renewed after a run that may have left something in it */
  struct farm_bytes in;
};

struct serving {
  const struct farm_slot_setup *setup;
  int slot, channel; /* when the channel closes, the child is killed and the slot ends */
  struct isolate isolate;
  struct farm_bytes in, out;
  int64_t memory_floor, flushed_ns;
};

static size_t address_space(void) {
  char text[64] = "";
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return 0;
  const ssize_t n = read(file, text, sizeof text - 1);
  close(file);
  return n > 0 ? (size_t)strtoull(text, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

static bool has_limit; /* the task in this process has a limit of memory */

/* Soft RLIMIT_AS; 0: none. */
static void limit_memory(size_t bytes) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0)
    return;
  limit.rlim_cur = limit.rlim_max;
  has_limit = bytes > 0;
  const size_t base = bytes ? address_space() : 0;
  if (bytes && bytes < SIZE_MAX - base && (limit.rlim_max == RLIM_INFINITY || base + bytes < limit.rlim_max))
    limit.rlim_cur = base + bytes;
  setrlimit(RLIMIT_AS, &limit);
}

void farm_allow_memory(size_t bytes) {
  struct rlimit limit;
  if (!has_limit || getrlimit(RLIMIT_AS, &limit) != 0)
    return;
  limit.rlim_cur = limit.rlim_max - limit.rlim_cur > bytes ? limit.rlim_cur + bytes : limit.rlim_max;
  setrlimit(RLIMIT_AS, &limit);
}

static enum farm_ending told_ending; /* farm_end_as(); FARM_DONE: it was not called */

void farm_end_as(enum farm_ending ending) {
  told_ending = ending;
}

static bool renew_pipe(struct isolate *isolate) {
  for (int i = 0; i < 2; i++) {
    if (isolate->result[i] >= 0)
      close(isolate->result[i]);
    isolate->result[i] = -1;
  }
  farm_frame_free(&isolate->in);
  if (pipe2(isolate->result, O_CLOEXEC) != 0)
    return false;
  return fcntl(isolate->result[0], F_SETFL, O_NONBLOCK) == 0;
}

static bool open_isolate(struct isolate *isolate) {
  *isolate = (struct isolate){.child_signal = -1, .result = {-1, -1}};
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  sigprocmask(SIG_BLOCK, &set, NULL);
  isolate->child_signal = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  return isolate->child_signal >= 0 && renew_pipe(isolate);
}

/* ---- the child ---- */

static void write_all(int file, const uint8_t *bytes, size_t size) {
  while (size > 0) {
    const ssize_t n = write(file, bytes, size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      _exit(STATUS_IO);
    bytes += n;
    size -= (size_t)n;
  }
}

struct answer { /* of a run; the child's is borrowed from the pipe's buffer */
  bool there;
  int64_t verdict;    /* status of the work, and above 32 bits what farm_end_as() said */
  struct iovec bytes; /* the result, or with a verdict other than STATUS_OK the message */
};

/* Computes the task in this process. The bytes of a result are malloc'd, those of a message are in *error. */
static struct answer compute(const struct serving *s, const uint8_t *task, size_t size, struct error *error) {
  const size_t memory_limit = s->setup->options.memory_limit;
  struct answer answer = {.there = true};
  uint8_t *result = NULL;
  if (memory_limit)
    limit_memory(memory_limit);
  told_ending = FARM_DONE;
  answer.verdict = s->setup->work(task, size, &result, &answer.bytes.iov_len, error);
  if (memory_limit)
    limit_memory(0); /* the limit holds for the work, not for its answer */
  answer.bytes.iov_base = result;
  if (answer.verdict != STATUS_OK) {
    free(result);
    answer.verdict |= (int64_t)told_ending << 32;
    answer.bytes = (struct iovec){error->message, strlen(error->message)};
  }
  return answer;
}

static _Noreturn void serve_child(const struct serving *s, uint64_t handle, const uint8_t *task, size_t size,
                                  pid_t parent) {
  farm_slot_die_with(parent);
  close(s->channel); /* so that the main process sees a dead slot as a closed channel */
  close(s->isolate.child_signal);
  close(s->isolate.result[0]);
  farm_slot_unblock();
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0}); /* core files of a thousand crashes would fill the disk */

  struct error error = {0};
  struct answer answer = compute(s, task, size, &error);
  const struct iovec part[2] = {{&answer.verdict, sizeof answer.verdict}, answer.bytes};
  struct farm_bytes out = {0};
  if (!farm_frame_append(&out, FARM_FRAME_ANSWER, 0, handle, 2, part))
    _exit(STATUS_MEMORY);
  write_all(s->isolate.result[1], out.data, out.end);
  _exit(STATUS_OK);
}

/* ---- its parent, the slot ---- */

static void drain_pipe(struct isolate *isolate) {
  struct farm_bytes *const in = &isolate->in;
  while (farm_frame_reserve(in, farm_frame_missing(in, 4096))) {
    const ssize_t n = read(isolate->result[0], in->data + in->end, in->capacity - in->end);
    if (n > 0)
      in->end += (size_t)n;
    else if (n == 0 || errno != EINTR)
      return;
  }
}

static int timeout_ms(int64_t until_ns) {
  if (until_ns == INT64_MAX)
    return -1;
  const int64_t left = until_ns - clock_ns();
  if (left <= 0)
    return 0;
  return left > 3600 * CLOCK_S ? 3600000 : (int)(left / CLOCK_MS) + 1;
}

/* True when the child has ended; then *wait_status and *usage are filled. */
static bool has_ended(const struct isolate *isolate, pid_t child, int *wait_status, struct rusage *usage) {
  struct signalfd_siginfo info;
  while (read(isolate->child_signal, &info, sizeof info) > 0) {
  }
  const pid_t ended = wait4(child, wait_status, WNOHANG, usage);
  if (ended < 0 && errno != EINTR) {
    *wait_status = SIGKILL; /* another waitpid has taken its status: treated as a crash */
    return true;
  }
  return ended == child;
}

/* Waits for the child's end; false: it was killed at its deadline. */
static bool await_child(struct serving *s, pid_t child, int *wait_status, struct rusage *usage) {
  struct isolate *const isolate = &s->isolate;
  const int64_t limit_ns = clock_from_s(s->setup->options.time_limit_s);
  bool in_time = true;
  int64_t until = limit_ns > 0 ? clock_ns() + limit_ns : INT64_MAX;
  for (;;) {
    struct pollfd fds[3] = {{.fd = isolate->child_signal, .events = POLLIN},
                            {.fd = isolate->result[0], .events = POLLIN},
                            {.fd = s->channel, .events = POLLRDHUP}};
    const int asked_ms = timeout_ms(until);
    const int64_t before = clock_ns();
    if (poll(fds, 3, asked_ms) <= 0)
      fds[0].revents = fds[1].revents = fds[2].revents = 0;
    if (asked_ms >= 0) { /* time during which all processes were stopped (Ctrl-Z) does not count for the run */
      const int64_t late = clock_ns() - before - asked_ms * CLOCK_MS;
      if (late > CLOCK_S)
        until += late;
    }
    if (fds[2].revents & (POLLRDHUP | POLLHUP | POLLERR)) {
      kill(child, SIGKILL); /* the main process has ended */
      _exit(STATUS_OK);
    }
    if (fds[1].revents & POLLIN)
      drain_pipe(isolate);
    if ((fds[0].revents & POLLIN) && has_ended(isolate, child, wait_status, usage))
      break;
    if (clock_ns() >= until) {
      kill(child, SIGKILL);
      until = INT64_MAX;
      in_time = false;
    }
  }
  drain_pipe(isolate);
  return in_time;
}

/* Appends the frame of a run without a result: the reason in words. */
static bool append_failure(struct farm_bytes *out, uint64_t handle, const struct farm_result *head, const char *text) {
  return farm_frame_append(out, FARM_FRAME_RESULT, 0, handle, 2,
                           (struct iovec[]){{(void *)head, sizeof *head}, {(void *)text, strlen(text)}});
}

static struct answer read_answer(struct isolate *isolate, uint64_t handle, int ended) {
  struct farm_frame frame;
  const uint8_t *payload = NULL;
  struct answer answer = {0};
  const int got = farm_frame_next(&isolate->in, &frame, &payload);
  if (got != 1 || frame.kind != FARM_FRAME_ANSWER || frame.handle != handle || frame.size < sizeof answer.verdict ||
      !WIFEXITED(ended) || WEXITSTATUS(ended) != 0)
    return answer;
  answer.there = true;
  memcpy(&answer.verdict, payload, sizeof answer.verdict);
  answer.bytes = (struct iovec){(void *)(payload + sizeof answer.verdict), frame.size - sizeof answer.verdict};
  return answer;
}

/* Ending of a run whose work returned `verdict`. A lack of memory or disk counts as a fault of the machine, unless the
 * campaign has a memory limit (`limited`). */
static enum farm_ending ending_of(int64_t verdict, bool limited) {
  if (verdict == STATUS_OK)
    return FARM_DONE;
  if (verdict >> 32)
    return (enum farm_ending)(verdict >> 32);
  if (verdict == STATUS_MEMORY)
    return limited ? FARM_MEMORY_LIMIT : FARM_LOST;
  return verdict == STATUS_IO ? FARM_LOST : FARM_FAILED;
}

enum farm_ending farm_slot_ending_by(int signal_number) {
  static const int own[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    if (signal_number == own[i])
      return FARM_CRASHED;
  return FARM_LOST;
}

/* Finds out why the child ended without an answer. */
static void judge_end(struct farm_result *head, bool in_time, int ended, double limit_s, char *text, size_t size) {
  if (!in_time) {
    head->ending = FARM_TIME_LIMIT;
    snprintf(text, size, "ended at its time limit of %g s", limit_s);
    return;
  }
  if (!WIFSIGNALED(ended)) {
    head->ending = head->exit_code == STATUS_MEMORY || head->exit_code == STATUS_IO ? FARM_LOST : FARM_CRASHED;
    snprintf(text, size, "the run's process exited with code %d and no result%s", head->exit_code,
             head->exit_code == STATUS_MEMORY ? ": the system refused it memory or a thread" : "");
    return;
  }
  head->ending = farm_slot_ending_by(head->signal);
  snprintf(text, size, "killed by signal %d (%s)%s", head->signal, strsignal(head->signal),
           head->signal == SIGKILL ? "; if nobody did it, the machine was out of memory" : "");
}

static bool append_answer(struct farm_bytes *out, uint64_t handle, struct farm_result *head,
                          const struct answer *answer, bool limited) {
  const bool done = answer->verdict == STATUS_OK;
  head->exit_code = (int)(answer->verdict & 0xff);
  head->ending = ending_of(answer->verdict, limited);
  head->size = done ? answer->bytes.iov_len : 0;
  if (farm_frame_append(out, FARM_FRAME_RESULT, 0, handle, 2, (struct iovec[]){{head, sizeof *head}, answer->bytes}))
    return true;
  if (!done)
    return false;

  /* The result is too large, or there is no memory for a copy of it here. */
  char text[96];
  snprintf(text, sizeof text, "no memory to pass on a result of %zu bytes", answer->bytes.iov_len);
  head->ending = FARM_LOST;
  head->exit_code = STATUS_MEMORY;
  head->size = 0;
  return append_failure(out, handle, head, text);
}

/* Runs the task in a child and appends the RESULT frame to `out`. False when memory or processes are refused. */
static bool run_isolated(struct serving *s, uint64_t handle, const uint8_t *task, size_t size) {
  struct isolate *const isolate = &s->isolate;
  const struct farm_options *options = &s->setup->options;
  char text[256];
  const pid_t self = getpid();
  const int64_t start = clock_ns();
  const pid_t child = fork();
  if (child < 0) {
    snprintf(text, sizeof text, "the system refused a process for the run: %s", strerror(errno));
    return append_failure(&s->out, handle, &(struct farm_result){.ending = FARM_LOST, .slot = s->slot}, text);
  }
  if (child == 0)
    serve_child(s, handle, task, size, self);

  int ended = 0;
  struct rusage usage = {0};
  const bool in_time = await_child(s, child, &ended, &usage);
  struct farm_result head = {.slot = s->slot,
                             .exit_code = WIFEXITED(ended) ? WEXITSTATUS(ended) : 0,
                             .signal = WIFSIGNALED(ended) ? WTERMSIG(ended) : 0,
                             .wall_s = 1e-9 * (double)(clock_ns() - start),
                             .cpu_s = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                                      1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec),
                             .peak_memory = (int64_t)usage.ru_maxrss * 1024};
  const struct answer answer = read_answer(isolate, handle, ended);
  const bool clean = answer.there && isolate->in.begin == isolate->in.end;
  bool written;
  if (answer.there) {
    written = append_answer(&s->out, handle, &head, &answer, options->memory_limit > 0);
  } else {
    judge_end(&head, in_time, ended, options->time_limit_s, text, sizeof text);
    written = append_failure(&s->out, handle, &head, text);
  }

  /* After half an answer, or more than one, the pipe is renewed. */
  if (!clean)
    return renew_pipe(isolate) && written;
  farm_frame_trim(&isolate->in);
  return written;
}

/* ---- the loop of a slot ---- */

/* Results of short tasks are sent together: after this time, at this number, or when no task waits. */
#define FLUSH_AFTER_NS (200 * CLOCK_MS / 1000)
#define FLUSH_AT_BYTES 32768

void farm_slot_unblock(void) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
}

void farm_slot_die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent)
    _exit(STATUS_OK);
}

static void flush(struct serving *s) {
  struct farm_bytes *const out = &s->out;
  while (out->begin < out->end) {
    const ssize_t n = send(s->channel, out->data + out->begin, out->end - out->begin, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      _exit(STATUS_OK); /* the main process has ended */
    out->begin += (size_t)n;
  }
  farm_frame_trim(out);
}

/* Peak memory in process is the high-water mark of the slot. It is reset after a task that raised it (where the kernel
 * permits this), so that a task does not inherit the peak of a larger predecessor. */
static int64_t peak_memory(int64_t *floor) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const int64_t peak = (int64_t)usage.ru_maxrss * 1024;
  if (*floor == 0) { /* peak of the slot before its first task */
    *floor = peak;
    return peak;
  }
  if (peak > *floor + (1 << 20)) {
    const int file = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    if (file >= 0) {
      if (write(file, "5", 1) != 1)
        *floor = peak;
      close(file);
    }
  }
  return peak;
}

static bool run_here(struct serving *s, uint64_t handle, const uint8_t *task, size_t size) {
  struct error error = {0};
  const int64_t start = clock_ns();
  const double cpu = clock_cpu_with_children_s();
  const struct answer answer = compute(s, task, size, &error);
  struct farm_result head = {.slot = s->slot,
                             .cpu_s = clock_cpu_with_children_s() - cpu,
                             .wall_s = 1e-9 * (double)(clock_ns() - start),
                             .peak_memory = peak_memory(&s->memory_floor)};
  const bool written = append_answer(&s->out, handle, &head, &answer, s->setup->options.memory_limit > 0);
  if (answer.verdict == STATUS_OK)
    free(answer.bytes.iov_base);
  return written;
}

static bool claim(struct farm_slot_record *record, const struct farm_frame *frame) {
  uint64_t expected = frame->handle;
  /* `running` is set first: if the slot dies between these lines, the main process finds the task's ticket not taken
   * and runs the task again. */
  atomic_store(&record->started_ns, clock_ns());
  atomic_store(&record->running, frame->handle);
  if (frame->ticket < FARM_SLOT_TICKETS && atomic_compare_exchange_strong(&record->ticket[frame->ticket], &expected, 0))
    return true;
  atomic_store(&record->running, 0);
  return false;
}

/* A library that ends the process of a run with EXIT_FAILURE is one, such as OpenMP, that the system refused memory or
 * a thread. The run is not at fault: the exit code says what happened. */
static void end_of_process(int code, void *unused) {
  (void)unused;
  if (code == EXIT_FAILURE)
    _exit(STATUS_MEMORY);
}

/* Computes every task in the buffer, sending results now and then. */
static void run_tasks(struct serving *s) {
  struct farm_slot_record *const record = &s->setup->records[s->slot];
  struct farm_frame frame;
  const uint8_t *payload;
  int got;
  while ((got = farm_frame_next(&s->in, &frame, &payload)) == 1) {
    if (frame.kind != FARM_FRAME_TASK || !claim(record, &frame))
      continue;
    if (!(s->setup->options.in_process ? run_here : run_isolated)(s, frame.handle, payload, frame.size))
      _exit(STATUS_MEMORY);
    atomic_store(&record->running, 0);
    const int64_t now = clock_ns();
    if (now - s->flushed_ns > FLUSH_AFTER_NS || s->out.end - s->out.begin > FLUSH_AT_BYTES) {
      flush(s);
      s->flushed_ns = now;
    }
  }
  if (got < 0)
    _exit(STATUS_INTERNAL);
  flush(s);
}

/* Waits for more bytes. The end of the channel ends the slot. */
static void read_tasks(struct serving *s) {
  if (s->in.begin == s->in.end)
    farm_frame_trim(&s->in);
  if (!farm_frame_reserve(&s->in, farm_frame_missing(&s->in, 4096)))
    _exit(STATUS_MEMORY);
  ssize_t n;
  do
    n = recv(s->channel, s->in.data + s->in.end, s->in.capacity - s->in.end, 0);
  while (n < 0 && errno == EINTR);
  if (n <= 0)
    _exit(STATUS_OK);
  s->in.end += (size_t)n;
  s->flushed_ns = clock_ns();
}

_Noreturn void farm_slot_serve(const struct farm_slot_setup *setup, int slot, int channel, pid_t parent) {
  farm_slot_die_with(parent);
  /* If the machine runs out of memory, the kernel should kill a run and not the manager. A process may always raise its
   * own OOM score. */
  const int score = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (score >= 0) {
    (void)!write(score, "500", 3);
    close(score);
  }
  on_exit(end_of_process, NULL);
  struct serving serving = {.setup = setup, .slot = slot, .channel = channel, .flushed_ns = clock_ns()};
  peak_memory(&serving.memory_floor);
  if (!setup->options.in_process && !open_isolate(&serving.isolate))
    _exit(STATUS_MEMORY);
  for (;;) {
    run_tasks(&serving);
    read_tasks(&serving);
  }
}
