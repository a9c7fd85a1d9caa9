/* The fork server: makes slots on request, and reports those that end. */
#include "campaign/farm/farm_private.h"

#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct server {
  const struct farm_slot_setup *setup;
  int control, child_signal;
  pid_t *pids; /* 0 = the slot has no process now */
};

static bool tell(int control, const struct farm_server_message *message, int channel) {
  struct iovec part = {(void *)message, sizeof *message};
  union {
    struct cmsghdr head;
    char bytes[CMSG_SPACE(sizeof(int))];
  } rights = {0};
  struct msghdr packet = {.msg_iov = &part, .msg_iovlen = 1};
  if (channel >= 0) {
    packet.msg_control = rights.bytes;
    packet.msg_controllen = sizeof rights.bytes;
    struct cmsghdr *head = CMSG_FIRSTHDR(&packet);
    head->cmsg_level = SOL_SOCKET;
    head->cmsg_type = SCM_RIGHTS;
    head->cmsg_len = CMSG_LEN(sizeof(int));
    memcpy(CMSG_DATA(head), &channel, sizeof channel);
  }
  ssize_t n;
  do
    n = sendmsg(control, &packet, MSG_NOSIGNAL);
  while (n < 0 && errno == EINTR);
  return n == (ssize_t)sizeof *message;
}

static void spawn(struct server *server, int slot) {
  int ends[2];
  pid_t pid = -1;
  const pid_t self = getpid();
  if (server->pids[slot])
    return;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0) {
    pid = fork();
    if (pid == 0) {
      close(server->control);
      close(server->child_signal);
      close(ends[0]);
      farm_slot_unblock();
      farm_slot_serve(server->setup, slot, ends[1], self);
    }
    const int why = errno;
    close(ends[1]);
    if (pid < 0)
      close(ends[0]);
    errno = why;
  }
  if (pid < 0) {
    tell(server->control, &(struct farm_server_message){FARM_SERVER_DIED, slot, 0, errno}, -1);
    return;
  }
  server->pids[slot] = pid;
  tell(server->control, &(struct farm_server_message){FARM_SERVER_SPAWNED, slot, pid, 0}, ends[0]);
  close(ends[0]);
}

/* Tells the main process of every slot that has ended. */
static void reap(struct server *server) {
  struct signalfd_siginfo info;
  while (read(server->child_signal, &info, sizeof info) > 0) {
  }
  int value;
  pid_t pid;
  while ((pid = waitpid(-1, &value, WNOHANG)) > 0) {
    for (int slot = 0; slot < server->setup->options.slots; slot++) {
      if (server->pids[slot] != pid)
        continue;
      server->pids[slot] = 0;
      tell(server->control, &(struct farm_server_message){FARM_SERVER_DIED, slot, pid, value}, -1);
    }
  }
}

static _Noreturn void end(struct server *server) {
  for (int slot = 0; slot < server->setup->options.slots; slot++)
    if (server->pids[slot])
      kill(server->pids[slot], SIGKILL);
  while (waitpid(-1, NULL, 0) > 0 || errno == EINTR) {
  }
  _exit(STATUS_OK);
}

/* mpirun binds a rank to one core when there are two ranks or fewer, and what it forks inherits that. Slots that would
 * share cores get all cores instead; the kernel limits them to the job's cpuset. */
static void spread(int slots) {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0 || CPU_COUNT(&set) >= slots)
    return;
  memset(&set, 0xff, sizeof set);
  sched_setaffinity(0, sizeof set, &set);
}

/* Signals typed at a terminal or sent by mpirun reach the whole group; the main process decides what they mean. Data is
 * printed by the main process alone: what a library prints in a run goes to stderr. */
static void detach(void) {
  for (size_t i = 0; i < FARM_STOP_SIGNALS; i++)
    signal(farm_stop_signals[i], SIG_IGN);
  signal(SIGQUIT, SIG_IGN);
  signal(SIGPIPE, SIG_DFL);
  signal(SIGCHLD, SIG_DFL);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing < 0)
    return;
  dup2(nothing, STDIN_FILENO);
  if (nothing > STDERR_FILENO)
    close(nothing);
}

/* Handles one message of the main process. An invalid message, or the end of `control`, ends the server and its
 * slots. */
static void obey(struct server *server) {
  struct farm_server_message message;
  const ssize_t n = recv(server->control, &message, sizeof message, 0);
  if (n < 0 && errno == EINTR)
    return;
  if (n != (ssize_t)sizeof message || message.slot < 0 || message.slot >= server->setup->options.slots)
    end(server);
  if (message.verb == FARM_SERVER_SPAWN)
    spawn(server, message.slot);
  if (message.verb == FARM_SERVER_KILL && message.pid > 0 && server->pids[message.slot] == message.pid)
    kill(message.pid, SIGKILL);
}

static _Noreturn void serve(const struct farm_slot_setup *setup, int control, pid_t parent) {
  farm_slot_die_with(parent);
  detach();
  spread(setup->options.slots);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  sigprocmask(SIG_SETMASK, &set, NULL);
  struct server server = {.setup = setup, .control = control};
  server.child_signal = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  server.pids = calloc((size_t)setup->options.slots, sizeof *server.pids);
  if (server.child_signal < 0 || !server.pids)
    _exit(STATUS_MEMORY);
  for (int slot = 0; slot < setup->options.slots; slot++)
    spawn(&server, slot);

  for (;;) {
    struct pollfd fds[2] = {{.fd = control, .events = POLLIN}, {.fd = server.child_signal, .events = POLLIN}};
    if (poll(fds, 2, -1) < 0 && errno != EINTR)
      end(&server);
    if (fds[1].revents & POLLIN)
      reap(&server);
    if (fds[0].revents)
      obey(&server);
  }
}

status farm_server_start(const struct farm_slot_setup *setup, pid_t *server, int *control, struct error *error) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    return status_fail(error, STATUS_MEMORY, "cannot make a socket pair for the fork server: %s", strerror(errno));
  malloc_trim(0); /* returns freed memory to the system: every later fork would copy its page table */
  fflush(NULL);   /* otherwise the children would print the buffered text again */
  const pid_t self = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    close(ends[0]);
    serve(setup, ends[1], self);
  }
  close(ends[1]);
  if (pid < 0) {
    close(ends[0]);
    return status_fail(error, STATUS_MEMORY, "cannot fork the fork server: %s (see `ulimit -u`)", strerror(errno));
  }
  *server = pid;
  *control = ends[0];
  return STATUS_OK;
}

bool farm_server_ask(int control, enum farm_server_verb verb, int slot, pid_t pid) {
  return tell(control, &(struct farm_server_message){(int32_t)verb, slot, pid, 0}, -1);
}

int farm_server_hear(int control, struct farm_server_message *message, int *channel) {
  *channel = -1;
  struct iovec part = {message, sizeof *message};
  union {
    struct cmsghdr head;
    char bytes[CMSG_SPACE(sizeof(int))];
  } rights;
  struct msghdr packet = {.msg_iov = &part,
                          .msg_iovlen = 1,
                          .msg_control = rights.bytes,
                          .msg_controllen = sizeof rights.bytes};
  const ssize_t n = recvmsg(control, &packet, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (n < 0)
    return errno == EAGAIN || errno == EINTR ? 0 : -1;
  for (struct cmsghdr *head = CMSG_FIRSTHDR(&packet); head; head = CMSG_NXTHDR(&packet, head))
    if (head->cmsg_level == SOL_SOCKET && head->cmsg_type == SCM_RIGHTS)
      memcpy(channel, CMSG_DATA(head), sizeof *channel);
  return n == (ssize_t)sizeof *message ? 1 : -1;
}

void farm_server_end(pid_t server, int control) {
  close(control);
  for (int i = 0; i < 2000; i++) {
    const pid_t ended = waitpid(server, NULL, WNOHANG);
    if (ended == server || (ended < 0 && errno != EINTR))
      return;
    nanosleep(&(struct timespec){.tv_nsec = i < 20 ? 100000 : 1000000}, NULL);
  }
  kill(server, SIGKILL); /* its slots die with it */
  while (waitpid(server, NULL, 0) < 0 && errno == EINTR) {
  }
}
