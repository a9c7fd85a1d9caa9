/* The child is forked from the slot, which has no threads, no MPI and no open HDF5 files. That takes 0.1-0.3 ms; an
 * executable that loads HDF5 takes 5 ms. The answer comes through a pipe. Exit code, signal, CPU seconds and peak
 * memory come from wait4. */
#include "campaign/farm/isolate.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/clock.h"

static size_t address_space(void) {
  char text[64] = "";
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0)
    return 0;
  const ssize_t n = read(file, text, sizeof text - 1);
  close(file);
  return n > 0 ? (size_t)strtoull(text, NULL, 10) * (size_t)sysconf(_SC_PAGESIZE) : 0;
}

void farm_isolate_limit_memory(size_t bytes) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0)
    return;
  limit.rlim_cur = limit.rlim_max;
  const size_t base = bytes ? address_space() : 0;
  if (bytes && bytes < SIZE_MAX - base && (limit.rlim_max == RLIM_INFINITY || base + bytes < limit.rlim_max))
    limit.rlim_cur = base + bytes;
  setrlimit(RLIMIT_AS, &limit);
}

static bool renew_pipe(struct farm_isolate *isolate) {
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

bool farm_isolate_open(struct farm_isolate *isolate, int channel) {
  *isolate = (struct farm_isolate){.channel = channel, .child_signal = -1, .result = {-1, -1}};
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

static _Noreturn void compute(const struct farm_isolate *isolate, const struct farm_slot_setup *setup, uint64_t handle,
                              const uint8_t *task, size_t size, pid_t parent) {
  farm_slot_die_with(parent);
  close(isolate->channel); /* so that the main process sees a dead slot as a closed channel */
  close(isolate->child_signal);
  close(isolate->result[0]);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0}); /* core files of a thousand crashes would fill the disk */
  if (setup->options.memory_limit)
    farm_isolate_limit_memory(setup->options.memory_limit);

  uint8_t *result = NULL;
  size_t result_size = 0;
  struct error error = {0};
  const int64_t verdict = setup->work(task, size, &result, &result_size, &error);
  if (setup->options.memory_limit)
    farm_isolate_limit_memory(0); /* the limit holds for the work, not for its answer */

  struct iovec part[2] = {{.iov_base = (void *)&verdict, .iov_len = sizeof verdict},
                          {.iov_base = result, .iov_len = result_size}};
  if (verdict != STATUS_OK)
    part[1] = (struct iovec){.iov_base = error.message, .iov_len = strlen(error.message)};
  struct farm_bytes out = {0};
  if (!farm_frame_append(&out, FARM_FRAME_ANSWER, 0, handle, 2, part))
    _exit(STATUS_MEMORY);
  write_all(isolate->result[1], out.data, out.end);
  _exit(STATUS_OK);
}

/* ---- the slot ---- */

static bool drain_pipe(struct farm_isolate *isolate) {
  for (;;) {
    if (!farm_frame_reserve(&isolate->in, farm_frame_missing(&isolate->in, 4096)))
      return false;
    const ssize_t n = read(isolate->result[0], isolate->in.data + isolate->in.end,
                           isolate->in.capacity - isolate->in.end);
    if (n > 0) {
      isolate->in.end += (size_t)n;
      continue;
    }
    if (n < 0 && errno == EINTR)
      continue;
    return true;
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
static bool has_ended(const struct farm_isolate *isolate, pid_t child, int *wait_status, struct rusage *usage) {
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
static bool await_child(struct farm_isolate *isolate, pid_t child, int64_t limit_ns, int *wait_status,
                        struct rusage *usage) {
  bool in_time = true;
  int64_t until = limit_ns > 0 ? clock_ns() + limit_ns : INT64_MAX;
  for (;;) {
    struct pollfd fds[3] = {{.fd = isolate->child_signal, .events = POLLIN},
                            {.fd = isolate->result[0], .events = POLLIN},
                            {.fd = isolate->channel, .events = POLLRDHUP}};
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

struct answer { /* the child's, borrowed from the pipe's buffer */
  bool there;
  int64_t verdict;
  struct iovec bytes; /* the result, or with a verdict other than STATUS_OK the message */
};

static struct answer read_answer(struct farm_isolate *isolate, uint64_t handle, int ended) {
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

enum farm_ending farm_isolate_ending(int64_t verdict, bool limited) {
  if (verdict == STATUS_OK)
    return FARM_DONE;
  if (verdict == STATUS_MEMORY)
    return limited ? FARM_MEMORY_LIMIT : FARM_LOST;
  return verdict == STATUS_IO ? FARM_LOST : FARM_FAILED;
}

enum farm_ending farm_isolate_ending_by(int signal_number) {
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
    snprintf(text, size, "the run's process exited with code %d and no result", head->exit_code);
    return;
  }
  head->ending = farm_isolate_ending_by(head->signal);
  snprintf(text, size, "killed by signal %d (%s)%s", head->signal, strsignal(head->signal),
           head->signal == SIGKILL ? "; if nobody did it, the machine was out of memory" : "");
}

static bool append_answer(struct farm_bytes *out, uint64_t handle, struct farm_result *head,
                          const struct answer *answer, bool limited) {
  const struct iovec nothing = {NULL, 0};
  const bool done = answer->verdict == STATUS_OK;
  head->exit_code = (int)answer->verdict;
  head->ending = farm_isolate_ending(answer->verdict, limited);
  head->size = done ? answer->bytes.iov_len : 0;
  const struct iovec part[3] = {{head, sizeof *head}, done ? answer->bytes : nothing, done ? nothing : answer->bytes};
  if (farm_frame_append(out, FARM_FRAME_RESULT, 0, handle, 3, part))
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

bool farm_isolate_run(struct farm_isolate *isolate, const struct farm_slot_setup *setup, int slot, uint64_t handle,
                      const uint8_t *task, size_t size, struct farm_bytes *out) {
  char text[256];
  const pid_t self = getpid();
  const int64_t start = clock_ns();
  const pid_t child = fork();
  if (child < 0) {
    snprintf(text, sizeof text, "the system refused a process for the run: %s", strerror(errno));
    return append_failure(out, handle, &(struct farm_result){.ending = FARM_LOST, .slot = slot}, text);
  }
  if (child == 0)
    compute(isolate, setup, handle, task, size, self);

  int ended = 0;
  struct rusage usage = {0};
  const bool in_time = await_child(isolate, child, clock_from_s(setup->options.time_limit_s), &ended, &usage);
  struct farm_result head = {.slot = slot,
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
    written = append_answer(out, handle, &head, &answer, setup->options.memory_limit > 0);
  } else {
    judge_end(&head, in_time, ended, setup->options.time_limit_s, text, sizeof text);
    written = append_failure(out, handle, &head, text);
  }

  /* After half an answer, or more than one, the pipe is renewed. */
  if (!clean)
    return renew_pipe(isolate) && written;
  farm_frame_trim(&isolate->in);
  return written;
}
