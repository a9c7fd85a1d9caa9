/* Reading fields files: a child process calls HDF5 and answers requests. If the child dies, the file is damaged. */
#include "analysis/pictures/snapshot_read.h"

#include <errno.h>
#include <hdf5.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/file.h"
#include "schemas/memory.h"
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

/* ---- both sides ---- */

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

/* ---- the child: HDF5. A file stays open until the process ends ---- */

enum { MOST_COMPRESSED = 1100 }; /* deflate's limit is 1032 : 1 */

struct file {
  hid_t file;
  double bytes; /* largest size of the file's data if it is compressed */
};

/* An object of HDF5 that is closed where its block is left. */
#define OBJECT __attribute__((cleanup(close_object))) hid_t
static void close_object(hid_t *id) {
  if (*id >= 0)
    H5Idec_ref(*id);
}

static struct file *open_file(const char *path) {
  hsize_t size = 0;
  struct file *f = memory_small(1, sizeof *f);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* HDF5 prints nothing: the return values report errors */
  H5PLset_loading_state(0);              /* a file must not choose libraries to load: its unknown filters are errors */
  /* No lock: some file systems have none, and a program that only shows the file may hold one. clast puts whole files
   * in place and never writes into one. */
  OBJECT access = H5Pcreate(H5P_FILE_ACCESS);
  if (access >= 0)
    H5Pset_file_locking(access, false, true);
  f->file = H5Fopen(path, H5F_ACC_RDONLY, access >= 0 ? access : H5P_DEFAULT);
  if (f->file >= 0 && H5Fget_filesize(f->file, &size) >= 0) {
    f->bytes = (double)size * MOST_COMPRESSED;
    return f;
  }
  free(f);
  return NULL;
}

/* Each part of the path must be a hard link: external links lead to other files, and clast writes no soft links. */
static bool has_object(struct file *f, const char *name) {
  enum { LONGEST = 256 };
  char way[LONGEST];
  H5L_info_t link;
  size_t length = strlen(name);
  if (length >= LONGEST)
    return false;
  for (size_t end = 1; end <= length; end++) {
    if (name[end] != '/' && name[end] != 0)
      continue;
    memcpy(way, name, end);
    way[end] = 0;
    if (H5Lget_info(f->file, way, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)
      return false;
  }
  return length > 0;
}

/* Are the numbers stored in this file, without external or virtual storage? */
static bool plain(hid_t set) {
  OBJECT type = H5Dget_type(set);
  OBJECT layout = H5Dget_create_plist(set);
  H5T_class_t class = type < 0 ? H5T_NO_CLASS : H5Tget_class(type);
  return (class == H5T_INTEGER || class == H5T_FLOAT) && H5Tget_size(type) <= 8 && layout >= 0 &&
         H5Pget_external_count(layout) == 0 && H5Pget_layout(layout) != H5D_VIRTUAL;
}

/* Number of rows of a data set of plain numbers with the wanted shape; -1: another kind of data set, or too many
 * rows. */
static int64_t count_rows(hid_t set, size_t width) {
  hsize_t size[2] = {0, 0};
  if (!plain(set)) /* first: the shape of virtual storage can lie in other files */
    return -1;
  OBJECT space = H5Dget_space(set);
  int rank = width ? 2 : 1;
  bool good = space >= 0 && H5Sget_simple_extent_ndims(space) == rank &&
              H5Sget_simple_extent_dims(space, size, NULL) == rank && size[0] <= SNAPSHOT_READ_LARGEST &&
              (!width || size[1] == width);
  return good ? (int64_t)size[0] : -1;
}

static void *read_rows(const struct file *f, hid_t set, enum snapshot_read_kind kind, size_t count) {
  if ((double)count > f->bytes)
    return NULL;
  void *values = malloc((count ? count : 1) * 8);
  if (!values || count == 0)
    return values;
  hid_t type = kind == SNAPSHOT_READ_REAL ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0)
    return values;
  free(values);
  return NULL;
}

static void *rows_of(struct file *f, const char *name, size_t width, enum snapshot_read_kind kind, size_t *rows) {
  *rows = 0;
  if (!has_object(f, name))
    return NULL;
  OBJECT set = H5Dopen2(f->file, name, H5P_DEFAULT);
  int64_t count = set < 0 ? -1 : count_rows(set, width);
  void *values = count < 0 ? NULL : read_rows(f, set, kind, (size_t)count * (width ? width : 1));
  if (values)
    *rows = (size_t)count;
  return values;
}

/* Opens the attribute if it is a scalar of this class and has at most `most` bytes; else -1. */
static hid_t open_attribute(struct file *f, const char *at, const char *name, H5T_class_t class, size_t most) {
  if (!has_object(f, at))
    return -1;
  hid_t id = H5Aopen_by_name(f->file, at, name, H5P_DEFAULT, H5P_DEFAULT);
  if (id < 0)
    return -1;
  OBJECT type = H5Aget_type(id);
  OBJECT space = H5Aget_space(id);
  bool good = type >= 0 && space >= 0 && H5Tget_class(type) == class && H5Tget_size(type) <= most &&
              H5Sget_simple_extent_npoints(space) == 1 && (class != H5T_STRING || H5Tis_variable_str(type) == 0);
  if (good)
    return id;
  H5Aclose(id);
  return -1;
}

enum { LONGEST_TEXT = 65536 };

/* A data set of one text, as results have it. */
static bool text_of_result(struct file *f, const char *at, const char *name, char *text, size_t size) {
  char path[256];
  if (snprintf(path, sizeof path, "%s/%s", at, name) >= (int)sizeof path || !has_object(f, path))
    return false;
  OBJECT set = H5Dopen2(f->file, path, H5P_DEFAULT);
  if (set < 0)
    return false;
  OBJECT type = H5Dget_type(set);
  OBJECT space = H5Dget_space(set);
  OBJECT layout = H5Dget_create_plist(set);
  if (type < 0 || space < 0 || layout < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
      H5Tget_size(type) > LONGEST_TEXT || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Pget_external_count(layout) != 0 || H5Pget_layout(layout) == H5D_VIRTUAL)
    return false;
  OWNED char *whole = calloc(H5Tget_size(type) + 1, 1);
  if (!whole || H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, whole) < 0)
    return false;
  snprintf(text, size, "%s", whole);
  return true;
}

static bool text_of(struct file *f, const char *at, const char *name, char *text, size_t size) {
  text[0] = 0;
  OBJECT id = open_attribute(f, at, name, H5T_STRING, LONGEST_TEXT);
  if (id < 0)
    return text_of_result(f, at, name, text, size);
  OBJECT type = H5Aget_type(id);
  OWNED char *whole = calloc(H5Tget_size(type) + 1, 1);
  if (!whole || H5Aread(id, type, whole) < 0)
    return false;
  snprintf(text, size, "%s", whole);
  return true;
}

static bool number_of(struct file *f, const struct question *q, H5T_class_t class, hid_t type, void *value) {
  OBJECT id = open_attribute(f, q->at, q->name, class, 8);
  return id >= 0 && H5Aread(id, type, value) >= 0;
}

/* ---- the child: answers ---- */

static bool reply(int line, struct file *file, const struct question *q) {
  struct answer a = {0};
  OWNED void *values = NULL;
  switch (q->what) {
  case HAS: a.good = has_object(file, q->at); break;
  case ROWS:
    values = rows_of(file, q->at, q->width, q->kind, &a.rows);
    a.good = values;
    break;
  case TEXT: a.good = text_of(file, q->at, q->name, a.text, sizeof a.text); break;
  case REAL: a.good = number_of(file, q, H5T_FLOAT, H5T_NATIVE_DOUBLE, &a.real); break;
  case INTEGER: a.good = number_of(file, q, H5T_INTEGER, H5T_NATIVE_LLONG, &a.integer); break;
  }
  return put(line, &a, sizeof a) && (!values || put(line, values, size_of_rows(a.rows, q->width)));
}

/* Answers requests until the parent closes its end. A crash ends this process immediately, without the parent's
 * handlers. */
static _Noreturn void serve(int line, const char *path) {
  const int crashes[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};
  for (size_t k = 0; k < sizeof crashes / sizeof *crashes; k++)
    signal(crashes[k], SIG_DFL);
  struct file *file = open_file(path);
  struct question question;
  const struct answer opened = {.good = file};
  bool going = put(line, &opened, sizeof opened) && file;
  while (going && get(line, &question, sizeof question))
    going = reply(line, file, &question);
  _exit(0);
}

/* ---- the parent ---- */

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
  snprintf(text, size, "%.*s", (int)sizeof a.text, a.text);
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
