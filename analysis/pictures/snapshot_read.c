/* Reading fields files: a child process calls HDF5 and answers requests. If the child dies, the file is damaged. */
#include "analysis/pictures/snapshot_read.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "analysis/pictures/snapshot_hdf5.h"
#include "schemas/file.h"
#include "schemas/text.h"

enum { NAME_SIZE = 128 };

enum what { HAS, ROWS, TEXT, REAL, INTEGER };

struct question {
  enum what what;
  enum snapshot_read_kind kind;
  size_t width;
  char at[NAME_SIZE], name[NAME_SIZE];
};

/* The rows follow it. */
struct answer {
  bool good;
  size_t rows;
  double real;
  long long integer;
  char text[SNAPSHOT_READ_TEXT];
};

struct snapshot_read {
  pid_t child;
  int line; /* a socket to the child */
  bool lost;
};

/* ---- both sides */

static bool put(int line, const void *bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    ssize_t step = send(line, (const char *)bytes + done, size - done, MSG_NOSIGNAL);
    if (step < 0 && errno != EINTR)
      return false;
    done += step > 0 ? (size_t)step : 0;
  }
  return true;
}

static bool get(int line, void *bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    ssize_t step = recv(line, (char *)bytes + done, size - done, 0);
    if (step == 0 || (step < 0 && errno != EINTR))
      return false;
    done += step > 0 ? (size_t)step : 0;
  }
  return true;
}

static size_t size_of_rows(size_t rows, size_t width) {
  return rows * (width ? width : 1) * 8; /* double, int64_t */
}

/* ---- the child */

static bool reply(int line, struct snapshot_hdf5 *file, const struct question *q) {
  struct answer a = {0};
  void *values = NULL;
  switch (q->what) {
  case HAS: a.good = snapshot_hdf5_has(file, q->at); break;
  case ROWS:
    values = snapshot_hdf5_rows(file, q->at, q->width, q->kind, &a.rows);
    a.good = values;
    break;
  case TEXT: a.good = snapshot_hdf5_text(file, q->at, q->name, a.text, sizeof a.text); break;
  case REAL: a.good = snapshot_hdf5_real(file, q->at, q->name, &a.real); break;
  case INTEGER: a.good = snapshot_hdf5_integer(file, q->at, q->name, &a.integer); break;
  }
  bool sent = put(line, &a, sizeof a) && (!values || put(line, values, size_of_rows(a.rows, q->width)));
  free(values);
  return sent;
}

/* Answers requests until the parent closes its end. A crash ends this process immediately, without the parent's
 * handlers. */
static _Noreturn void serve(int line, const char *path) {
  const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
  for (size_t k = 0; k < sizeof crashes / sizeof *crashes; k++)
    signal(crashes[k], SIG_DFL);
  struct snapshot_hdf5 *file = snapshot_hdf5_open(path);
  struct question question;
  const struct answer opened = {.good = file};
  bool going = put(line, &opened, sizeof opened) && file;
  while (going && get(line, &question, sizeof question))
    going = reply(line, file, &question);
  _exit(0);
}

/* ---- the parent */

/* False: the child has ended. Then all later requests fail, too. */
static bool listen_to(struct snapshot_read *f, void *bytes, size_t size) {
  f->lost = f->lost || !get(f->line, bytes, size);
  return !f->lost;
}

static bool ask(struct snapshot_read *f, struct question *q, const char *at, const char *name, struct answer *a) {
  if (f->lost || strlen(at) >= sizeof q->at || strlen(name) >= sizeof q->name)
    return false;
  memcpy(q->at, at, strlen(at) + 1);
  memcpy(q->name, name, strlen(name) + 1);
  f->lost = !put(f->line, q, sizeof *q);
  return listen_to(f, a, sizeof *a) && a->good;
}

static struct snapshot_read *start(const char *path) {
  int ends[2];
  struct snapshot_read *f = calloc(1, sizeof *f);
  if (!f || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends)) {
    free(f);
    return NULL;
  }
  f->line = ends[0];
  f->child = fork();
  if (f->child == 0) {
    close(ends[0]);
    serve(ends[1], path);
  }
  close(ends[1]);
  if (f->child > 0)
    return f;
  close(ends[0]);
  free(f);
  return NULL;
}

status snapshot_read_open(const char *path, struct snapshot_read **out, struct error *error) {
  struct answer opened;
  struct stat about;
  *out = NULL;
  TRY(file_input(path, error));
  if (access(path, R_OK))
    return status_fail(error, errno == ENOENT ? STATUS_MISSING : STATUS_IO, "cannot read %s: %s", path,
                       strerror(errno));
  if (stat(path, &about) != 0 || !S_ISREG(about.st_mode)) /* HDF5 would wait for a pipe */
    return status_fail(error, STATUS_IO, "cannot read %s: it is a folder, pipe, socket or device", path);
  struct snapshot_read *f = start(path);
  if (!f)
    return status_fail(error, STATUS_MEMORY, "no memory or no process to read %s", path);
  if (!listen_to(f, &opened, sizeof opened) || !opened.good) {
    snapshot_read_close(f);
    return snapshot_read_refuse(path, error);
  }
  *out = f;
  return STATUS_OK;
}

bool snapshot_read_close(struct snapshot_read *f) {
  bool whole = !f->lost;
  shutdown(f->line, SHUT_RDWR); /* works even if another child holds a copy of this end */
  close(f->line);
  while (waitpid(f->child, NULL, 0) < 0 && errno == EINTR)
    ;
  free(f);
  return whole;
}

status snapshot_read_refuse(const char *path, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "%s is no fields file of clast, or it is damaged; `clast simulate --fields` and "
                     "`clast replay --fields` write such files",
                     path);
}

bool snapshot_read_has(struct snapshot_read *f, const char *name) {
  struct answer a;
  return ask(f, &(struct question){.what = HAS}, name, "", &a);
}

void *snapshot_read_rows(struct snapshot_read *f, const char *name, size_t width, enum snapshot_read_kind kind,
                         size_t *rows) {
  struct answer a;
  *rows = 0;
  if (!ask(f, &(struct question){.what = ROWS, .width = width, .kind = kind}, name, "", &a))
    return NULL;
  void *values = a.rows <= SNAPSHOT_READ_LARGEST ? malloc(size_of_rows(a.rows, width) + 1) : NULL;
  if (!values || !listen_to(f, values, size_of_rows(a.rows, width))) {
    f->lost = true; /* the following bytes on the socket are no answer */
    free(values);
    return NULL;
  }
  *rows = a.rows;
  return values;
}

bool snapshot_read_text(struct snapshot_read *f, const char *at, const char *name, char *text, size_t size) {
  struct answer a;
  text[0] = 0;
  if (!ask(f, &(struct question){.what = TEXT}, at, name, &a))
    return false;
  size_t length = strnlen(a.text, sizeof a.text);
  size_t kept = length < size ? length : size - 1;
  memcpy(text, a.text, kept);
  text[kept] = 0;
  if (text_is_plain(text))
    return true;
  text[0] = 0;
  return false;
}

bool snapshot_read_real(struct snapshot_read *f, const char *at, const char *name, double *value) {
  struct answer a;
  if (!ask(f, &(struct question){.what = REAL}, at, name, &a))
    return false;
  *value = a.real;
  return true;
}

bool snapshot_read_integer(struct snapshot_read *f, const char *at, const char *name, long long *value) {
  struct answer a;
  if (!ask(f, &(struct question){.what = INTEGER}, at, name, &a))
    return false;
  *value = a.integer;
  return true;
}
