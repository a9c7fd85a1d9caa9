/* gnuplot as a child process. */
#include "analysis/pictures/chart_run.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "schemas/file.h"

extern char **environ;

enum { PATH = 4096 };

struct folder {
  char path[PATH];
  char script[300], data[300], picture[300]; /* file names within the folder */
};

void chart_run_stem(const char *path, char *stem, size_t size) {
  const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
  const char *dot = strrchr(base, '.');
  snprintf(stem, size, "%.*s", (int)(dot ? (size_t)(dot - base) : strlen(base)), base);
}

static void remove_file(const struct folder *folder, const char *name) {
  char path[PATH + 512];
  snprintf(path, sizeof path, "%s/%s", folder->path, name);
  unlink(path);
}

static void remove_folder(const struct folder *folder) {
  remove_file(folder, folder->script);
  remove_file(folder, folder->data);
  remove_file(folder, folder->picture);
  remove_file(folder, "messages");
  rmdir(folder->path);
}

static status write_text(const struct folder *folder, const char *name, const char *text, size_t size,
                         struct error *error) {
  char path[PATH + 512];
  snprintf(path, sizeof path, "%s/%s", folder->path, name);
  return file_write(path, "chart", text, size, error);
}

/* *end: gnuplot's exit code; -1: it was killed. STATUS_MISSING: gnuplot is not installed. */
static status run_gnuplot(const struct folder *folder, int *end, struct error *error) {
  posix_spawn_file_actions_t actions;
  char script[302];
  snprintf(script, sizeof script, "./%s", folder->script); /* a name may begin with a dash */
  char *arguments[] = {"gnuplot", "-d", script, NULL};     /* -d: without start-up files */
  pid_t child;
  int state;
  if (posix_spawn_file_actions_init(&actions))
    return status_fail(error, STATUS_MEMORY, "no memory to start gnuplot");
  posix_spawn_file_actions_addchdir_np(&actions, folder->path);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "messages", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int code = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code == ENOENT)
    return status_fail(error, STATUS_MISSING,
                       "gnuplot draws the charts of clast, and this machine has none: `apt-get install gnuplot-nox`. "
                       "Tables and --plot do not need it");
  if (code)
    return status_fail(error, STATUS_MEMORY, "gnuplot does not start: %s", strerror(code));
  while (waitpid(child, &state, 0) < 0)
    if (errno != EINTR)
      return status_fail(error, STATUS_INTERNAL, "gnuplot was lost: %s", strerror(errno));
  *end = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  return STATUS_OK;
}

/* gnuplot's messages, joined on one line. */
static void read_messages(const struct folder *folder, char *text, size_t size) {
  char path[PATH + 512];
  snprintf(path, sizeof path, "%s/messages", folder->path);
  FILE *in = fopen(path, "r");
  size_t count = in ? fread(text, 1, size - 1, in) : 0;
  if (in)
    fclose(in);
  text[count] = '\0';
  for (size_t i = 0; i < count; i++)
    if ((unsigned char)text[i] < ' ')
      text[i] = ' ';
}

/* Puts the picture in place, and with page->keep_script NAME.gp and NAME.dat beside it. */
static status keep(const struct picture_page *page, const struct chart_run_files *files, const char *drawn,
                   struct error *error) {
  const int stem = (int)(strrchr(page->path, '.') - page->path);
  char script[PATH + 8], data[PATH + 8];
  unsigned char *bytes = NULL;
  size_t size = 0;
  snprintf(script, sizeof script, "%.*s.gp", stem, page->path);
  snprintf(data, sizeof data, "%.*s.dat", stem, page->path);
  if (page->keep_script) {
    TRY(file_may_replace(script, "script", error));
    TRY(file_may_replace(data, "data of the chart", error));
    TRY(file_write(script, "script", files->script, files->script_size, error));
    TRY(file_write(data, "data of the chart", files->data, files->data_size, error));
  }
  TRY(file_read(drawn, "picture", &bytes, &size, error));
  const status code = file_write(page->path, "picture", bytes, size, error);
  free(bytes);
  return code;
}

static status draw(const struct picture_page *page, const struct chart_run_files *files, const struct folder *folder,
                   struct error *error) {
  char path[PATH + 512], messages[2000];
  struct stat about;
  int end = 0;
  TRY(run_gnuplot(folder, &end, error));
  snprintf(path, sizeof path, "%s/%s", folder->path, folder->picture);
  if (end == 0 && stat(path, &about) == 0 && about.st_size > 0)
    return keep(page, files, path, error);
  read_messages(folder, messages, sizeof messages);
  return status_fail(error, page->templates ? STATUS_CONTENT : STATUS_IO, "%s: gnuplot drew nothing (exit %d): %s",
                     page->path, end, *messages ? messages : "it does not say why; is the disk full?");
}

status chart_run(const struct picture_page *page, const struct chart_run_files *files, struct error *error) {
  struct folder folder;
  char stem[256];
  if (strlen(page->path) + 16 > PATH)
    return status_fail(error, STATUS_USAGE, "the name of the picture is too long");
  TRY(file_may_replace(page->path, "picture", error));
  chart_run_stem(page->path, stem, sizeof stem);
  snprintf(folder.path, sizeof folder.path, "%s.XXXXXX", page->path);
  snprintf(folder.script, sizeof folder.script, "%s.gp", stem);
  snprintf(folder.data, sizeof folder.data, "%s.dat", stem);
  snprintf(folder.picture, sizeof folder.picture, "%s%s", stem, strrchr(page->path, '.'));
  if (!mkdtemp(folder.path))
    return status_fail(error, STATUS_IO, "cannot write the picture '%s': %s", page->path, strerror(errno));
  status code = write_text(&folder, folder.script, files->script, files->script_size, error);
  if (code == STATUS_OK)
    code = write_text(&folder, folder.data, files->data, files->data_size, error);
  if (code == STATUS_OK)
    code = draw(page, files, &folder, error);
  remove_folder(&folder);
  return code;
}
