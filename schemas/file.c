/* Inputs and outputs of a command. */
#include "schemas/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "schemas/memory.h"
#include "schemas/text.h"

enum { NAMES = 100, BLOCK = 1 << 16 };
#define ENDING_ROOM sizeof ".-2147483648.-2147483648.unfinished"
static const off_t LOCK_BYTE = (off_t)1 << 62; /* SQLite locks other bytes of a file, and both locks may be held */

/* Where a name leads: to a file, or to `base` in a folder when there is no file yet. */
struct place {
  dev_t device;
  ino_t inode;
  const char *base; /* "": the file exists */
};

/* The files that this command reads, and those that it has claimed to write. */
static struct known {
  struct known *next;
  dev_t device;
  ino_t inode;
  char *path;
  bool written; /* an output that is in place; the command may read it */
} * inputs, *outputs;

static const char *base_of(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static bool find_place(const char *path, struct place *place) {
  struct stat there;
  const char *base = base_of(path);
  if (stat(path, &there) == 0)
    base = "";
  else {
    OWNED char *folder = base == path ? strdup(".") : strndup(path, (size_t)(base - path));
    if (!folder || stat(folder, &there) != 0)
      return false;
  }
  *place = (struct place){there.st_dev, there.st_ino, base};
  return true;
}

static bool same_place(const char *one, const char *other) {
  struct place a, b;
  return find_place(one, &a) && find_place(other, &b) && a.device == b.device && a.inode == b.inode &&
         strcmp(a.base, b.base) == 0;
}

static void note(struct known **list, const char *path, const struct stat *file) {
  struct known *known = memory_small(1, sizeof *known);
  *known = (struct known){*list, file->st_dev, file->st_ino, memory_small_text(path), false};
  *list = known;
}

/* An input that has been removed is none: its inode may be that of a newer file. */
static bool is_input(const struct stat *file) {
  for (const struct known *input = inputs; input; input = input->next) {
    struct stat now;
    if (input->device == file->st_dev && input->inode == file->st_ino && stat(input->path, &now) == 0 &&
        now.st_dev == file->st_dev && now.st_ino == file->st_ino)
      return true;
  }
  return false;
}

static status refuse(const char *path, const char *what, const char *why, struct error *error) {
  return status_fail(error, STATUS_IO, "cannot write the %s '%s': %s", what, path, why);
}

static status refuse_input(const char *path, const char *what, struct error *error) {
  return refuse(path, what, "this command reads it: name another file for the output", error);
}

status file_input(const char *path, struct error *error) {
  struct stat file;
  for (const struct known *output = outputs; output; output = output->next)
    if (!output->written && same_place(output->path, path))
      return refuse_input(output->path, "output", error);
  if (stat(path, &file) != 0 || !S_ISREG(file.st_mode))
    return STATUS_OK;
  for (const struct known *input = inputs; input; input = input->next)
    if (input->device == file.st_dev && input->inode == file.st_ino && strcmp(input->path, path) == 0)
      return STATUS_OK;
  note(&inputs, path, &file);
  return STATUS_OK;
}

status file_read(const char *path, const char *what, unsigned char **bytes, size_t *size, struct error *error) {
  char block[BLOCK], *text = NULL;
  size_t got;
  struct stat about;
  *bytes = NULL;
  FILE *file = fopen(path, "rbe");
  if (!file)
    return status_fail(error,
                       errno == ENOENT   ? STATUS_MISSING
                       : errno == ENOMEM ? STATUS_MEMORY
                                         : STATUS_IO,
                       "cannot read the %s '%s': %s", what, path, strerror(errno));
  if (fstat(fileno(file), &about) != 0 || !(S_ISREG(about.st_mode) || S_ISFIFO(about.st_mode))) {
    fclose(file);
    return status_fail(error, STATUS_IO, "cannot read the %s '%s': it is no plain file", what, path);
  }
  FILE *copy = text_open_sized(&text, size);
  while ((got = fread(block, 1, sizeof block, file)) > 0)
    fwrite(block, 1, got, copy);
  const int why = ferror(file) ? errno : 0;
  fclose(file);
  if (!text_close(copy, &text))
    return status_fail(error, STATUS_MEMORY, "no memory to read '%s'", path);
  *bytes = (unsigned char *)text;
  if (!why)
    return STATUS_OK;
  free(text);
  *bytes = NULL;
  return status_fail(error, STATUS_IO, "cannot read the %s '%s': %s", what, path, strerror(why));
}

/* ---- names ---- */

bool file_name_ends(const char *word) {
  static const char *const endings[] = {".yaml", ".yml", ".json", NULL};
  const char *ending = strrchr(word, '.');
  return ending && text_is_one_of(ending, endings);
}

bool file_name_is_document(const char *word) {
  return strchr(word, '/') || file_name_ends(word);
}

char *file_name_in(const char *folder, const char *name) {
  if (name[0] == '/' || !folder || !*folder)
    return strdup(name);
  char *whole = NULL;
  name += strncmp(name, "./", 2) == 0 ? 2 : 0;
  return asprintf(&whole, "%s/%s", folder, name) < 0 ? NULL : whole;
}

/* ---- what an output may not replace ---- */

/* The first bytes of a file, with a 0 after them. */
static bool read_head(const char *path, char head[17]) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  const ssize_t got = file < 0 ? -1 : read(file, head, 16);
  if (file >= 0)
    close(file);
  head[got > 0 ? got : 0] = '\0';
  return got >= 0;
}

static bool is_database(const char *head) {
  return strcmp(head, "SQLite format 3") == 0; /* and a 0 (SQLite's file format, 1.3) */
}

const char *const file_companions[] = {"-journal", "-wal", "-shm", NULL};

static const char *companion_ending(const char *path) {
  const char *const *ending = file_companions;
  while (*ending && !text_ends_in(path, *ending))
    ending++;
  return *ending;
}

bool file_is_companion(const char *path) {
  return companion_ending(path) != NULL;
}

/* Is it a name that SQLite uses beside a store that exists? */
static bool is_beside_store(const char *path) {
  const char *ending = companion_ending(path);
  if (!ending)
    return false;
  OWNED char *store = strndup(path, strlen(path) - strlen(ending));
  char head[17];
  struct stat file;
  /* A store that this process has opened is not opened here: closing it again would release SQLite's locks. */
  return store && stat(store, &file) == 0 && (is_input(&file) || (read_head(store, head) && is_database(head)));
}

/* Is it a file that a campaign keeps: STORE-fields/<identity>.h5 (campaign/scheduler/scheduler.c)? */
static bool is_kept(const char *path) {
  OWNED char *real = realpath(path, NULL);
  const char *base = real ? base_of(real) : "";
  return strspn(base, "0123456789abcdef") == 32 && strcmp(base + 32, ".h5") == 0 && base - real > 8 &&
         strncmp(base - 8, "-fields/", 8) == 0;
}

/* Is it a document by its own name, or by the name that a link leads to? */
static bool is_document(const char *path, const char *head) {
  OWNED char *real = realpath(path, NULL);
  const char *const names[] = {path, real ? real : path};
  const bool rows = strncmp(head, "{\"run_id\"", 9) == 0 || strncmp(head, "{\"point_id\"", 11) == 0;
  bool found = false;
  for (size_t i = 0; i < 2; i++)
    found |= text_ends_in(names[i], ".yaml") || text_ends_in(names[i], ".yml") ||
             (text_ends_in(names[i], ".json") && !rows);
  return found;
}

status file_may_replace(const char *path, const char *what, struct error *error) {
  struct stat file;
  char head[17];
  if (is_beside_store(path))
    return refuse(path, what, "SQLite keeps a store's journal under this name: name another file", error);
  if (stat(path, &file) != 0)
    return STATUS_OK;
  if (S_ISDIR(file.st_mode))
    return refuse(path, what, strerror(EISDIR), error);
  if (!S_ISREG(file.st_mode))
    return STATUS_OK;
  if (is_input(&file))
    return refuse_input(path, what, error);
  if (!read_head(path, head))
    return refuse(path, what, strerror(errno), error);
  if (is_database(head))
    return refuse(path, what, "it is a store or another SQLite database: name another file, or remove it first", error);
  if (strcmp(what, "fields file") != 0 && is_kept(path)) /* a campaign mends its own: engine/snapshot_file.c */
    return refuse(path, what, "it has the fields of a run of a store: name another file, or remove it first", error);
  if (is_document(path, head))
    return refuse(path, what, "it is a document, such as a campaign or a scene: name another file, or remove it first",
                  error);
  return STATUS_OK;
}

/* ---- writing ---- */

/* Is it a pipe, a device, or a file that is open already (/dev/stdout, /dev/fd/1)? These are never replaced. */
static bool is_direct(const char *path) {
  static const char open_files[] = "/proc/";
  char link[sizeof open_files - 1];
  struct stat file;
  if (stat(path, &file) == 0 && !S_ISREG(file.st_mode) && !S_ISDIR(file.st_mode))
    return true;
  return strncmp(path, "/dev/fd/", 8) == 0 || strncmp(path, open_files, sizeof link) == 0 ||
         (readlink(path, link, sizeof link) == (ssize_t)sizeof link && memcmp(link, open_files, sizeof link) == 0);
}

/* Locks a file; the lock dies with its process. Returns 0 or an errno. */
static int lock(int file) {
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = LOCK_BYTE, .l_len = 1};
  return fcntl(file, F_OFD_SETLK, &lock) == 0 ? 0 : errno;
}

/* Does the open file have this name, and no other? */
static bool is_at(int file, const char *name) {
  struct stat mine, there;
  return fstat(file, &mine) == 0 && lstat(name, &there) == 0 && S_ISREG(mine.st_mode) && mine.st_nlink == 1 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino && !is_input(&mine);
}

/* Removes the file that a killed writer left. Without a lock its writer may still be alive. */
static bool remove_leftover(const char *name) {
  const int file = open(name, O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  const bool removed = file >= 0 && lock(file) == 0 && is_at(file, name) && unlink(name) == 0;
  if (file >= 0)
    close(file);
  return removed;
}

/* Creates the temporary file, writes its name and returns its descriptor, or -1 with errno. Another process may take a
 * file that is not yet locked for a leftover and remove it; then the next try makes a new one. Where the file system
 * has no locks, leftovers stay. */
static int create(const char *path, char *temporary, size_t size) {
  int number = 0;
  for (int tries = 0; tries < NAMES; tries++) {
    if (number == 0)
      snprintf(temporary, size, "%s.unfinished", path);
    else
      snprintf(temporary, size, "%s.%ld-%d.unfinished", path, (long)getpid(), number);
    const int file = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) {
      const int held = lock(file);
      if (held != EACCES && held != EAGAIN && is_at(file, temporary))
        return file;
      close(file);
    } else if (errno != EEXIST)
      return -1;
    else if (!remove_leftover(temporary))
      number++;
  }
  errno = EEXIST;
  return -1;
}

status file_begin(struct file_output *file, const char *path, const char *what, struct error *error) {
  const size_t size = strlen(path) + ENDING_ROOM;
  int descriptor;
  *file = (struct file_output){.what = what};
  TRY(file_may_replace(path, what, error));
  file->path = malloc(2 * size);
  if (!file->path)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  snprintf(file->path, size, "%s", path);
  file->temporary = file->path + size;
  if (is_direct(path)) {
    snprintf(file->temporary, size, "%s", path);
    descriptor = open(path, O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
  } else
    descriptor = create(path, file->temporary, size);
  file->out = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
  if (file->out)
    return STATUS_OK;
  const int why = errno;
  if (descriptor >= 0) { /* no memory for the stream */
    if (strcmp(file->temporary, path) != 0)
      unlink(file->temporary);
    close(descriptor);
  }
  free(file->path);
  if (why == ENOMEM)
    return status_fail(error, STATUS_MEMORY, "no memory to write '%s'", path);
  return refuse(path, what, strerror(why), error);
}

/* Flushes the folder of `path` to the disk, so that names made in it outlive a power cut. Some file systems cannot
 * flush a folder; that is no error. */
static void keep_name(const char *path) {
  const char *base = strrchr(path, '/');
  OWNED char *name = base ? strndup(path, base == path ? 1 : (size_t)(base - path)) : strdup(".");
  const int folder = name ? open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
  if (folder >= 0) {
    (void)fsync(folder);
    close(folder);
  }
}

/* Puts the whole file in place. */
static status put_in_place(struct file_output *file, struct error *error) {
  const bool direct = strcmp(file->temporary, file->path) == 0;
  errno = 0;
  bool good = fflush(file->out) == 0 && !ferror(file->out) && (direct || fsync(fileno(file->out)) == 0);
  if (good && !direct) {
    TRY(file_may_replace(file->path, file->what, error));
    good = rename(file->temporary, file->path) == 0;
    if (good)
      keep_name(file->path);
    for (struct known *output = outputs; good && output; output = output->next)
      output->written |= strcmp(output->path, file->path) == 0;
  }
  return good ? STATUS_OK : refuse(file->path, file->what, strerror(errno ? errno : EIO), error);
}

status file_end(struct file_output *file, status code, struct error *error) {
  if (code == STATUS_OK)
    code = put_in_place(file, error);
  else if (code == STATUS_IO && error && !strstr(error->message, file->path)) {
    const struct error why = *error;
    status_fail(error, code, "%s: %s", file->path, why.message);
  }
  if (code != STATUS_OK && strcmp(file->temporary, file->path) != 0)
    unlink(file->temporary);
  fclose(file->out); /* releases the lock, after all is on the disk */
  free(file->path);
  return code;
}

status file_write(const char *path, const char *what, const void *bytes, size_t size, struct error *error) {
  struct file_output file;
  TRY(file_begin(&file, path, what, error));
  const bool whole = fwrite(bytes, 1, size, file.out) == size && fflush(file.out) == 0;
  return file_end(&file, whole ? STATUS_OK : refuse(path, what, strerror(errno), error), error);
}

status file_claim(const char *path, const char *what, struct error *error) {
  struct file_output file;
  const bool direct = is_direct(path);
  for (const struct known *output = outputs; output && !direct; output = output->next)
    if (same_place(output->path, path))
      return status_fail(error, STATUS_USAGE,
                         "two outputs have the same name, '%s' and '%s': name another file for the %s", output->path,
                         path, what);
  if (direct) /* opening a pipe would wait for its reader */
    return access(path, W_OK) == 0 ? STATUS_OK : refuse(path, what, strerror(errno), error);
  TRY(file_begin(&file, path, what, error));
  file_end(&file, STATUS_STOPPED, NULL);
  note(&outputs, path, &(struct stat){0});
  return STATUS_OK;
}

status file_folder(const char *path, struct error *error) {
  struct stat there;
  if (mkdir(path, 0777) == 0) {
    keep_name(path);
    return STATUS_OK;
  }
  if (errno == EEXIST && stat(path, &there) == 0 && S_ISDIR(there.st_mode))
    return STATUS_OK;
  return status_fail(error, STATUS_IO, "cannot make the folder '%s': %s: name another one", path, strerror(errno));
}
