/* Computes a scene, and during the run writes snapshots, restart file and a percentage on a terminal. */
#include "campaign/one_run/one_run.h"

#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "analysis/pictures/snapshot_read.h"
#include "campaign/charts/charts.h"
#include "campaign/farm/farm.h"
#include "engine/restart.h"
#include "schemas/clock.h"
#include "schemas/file.h"
#include "schemas/memory.h"

/* ---- a restart file: a run that can be stopped and goes on later ----
 * The stop signals of a farm write it and end the command with exit code 75. It is also written every few minutes, for
 * ends without a signal. */

struct resume {
  const char *path; /* path of the restart file */
  double saved;     /* s, monotonic: when it was last written */
};

enum { EVERY_S = 300 };

static volatile sig_atomic_t stopped; /* a signal handler can use only a global variable */

static void note(int number) {
  stopped = number;
}

/* From now on the first signal is only noted. A second one ends the process at once. */
static void resume_begin(struct resume *resume, const char *path) {
  struct sigaction action = {.sa_handler = note, .sa_flags = (int)SA_RESETHAND}, now;
  for (size_t k = 0; k < FARM_STOP_SIGNALS; k++)
    if (sigaction(farm_stop_signals[k], NULL, &now) != 0 || now.sa_handler != SIG_IGN) /* nohup, or `&` in a script */
      sigaction(farm_stop_signals[k], &action, NULL);
  *resume = (struct resume){path, clock_s()};
}

/* Between blocks of steps. STATUS_STOPPED after a signal, when the file is written; or the status of restart_save. */
static status resume_look(struct resume *resume, const struct engine_kind *kind, void *run, struct error *error) {
  if (!stopped && clock_s() - resume->saved < EVERY_S)
    return STATUS_OK;
  status code = restart_save(kind, run, resume->path, error);
  resume->saved = clock_s();
  if (code || !stopped)
    return code;
  return status_fail(error, STATUS_STOPPED,
                     "stopped at %.4g s of simulated time, saved in %s: the same command goes on from there",
                     kind->time(run), resume->path);
}

/* ---- fields files during the run, and the list of them with their times that ParaView reads (NAME.hdf.series) ---- */

struct snapshots {
  char name[FIELD_TEXT_SIZE];
  int64_t count, next; /* next: number of the next snapshot */
  bool resumed;        /* the run was restored, and snapshots_look() was not called yet */
  double *time;        /* s, by number; NaN: there is no such file */
};

enum { PATH = FIELD_TEXT_SIZE + 64 };

static void path_of(const struct snapshots *s, int64_t number, char path[PATH]) {
  snprintf(path, PATH, "%s_%06lld.hdf", s->name, (long long)number);
}

static void path_of_list(const struct snapshots *s, char path[PATH]) {
  snprintf(path, PATH, "%s.hdf.series", s->name);
}

/* `count` files NAME_000000.hdf, ... evenly over the longest time that a run may take, the first one near its
 * beginning, the last one at its end; a single one at the end. `resumed`: the run goes on from a restart file; earlier
 * snapshots are on the disk and stay in the list. STATUS_MEMORY, and the statuses of file_claim(). The caller frees
 * s->time, also after an error. */
static status snapshots_open(struct snapshots *s, const char *name, int64_t count, bool resumed, struct error *error) {
  char path[PATH];
  *s = (struct snapshots){.count = count, .resumed = resumed, .time = malloc((size_t)count * sizeof *s->time)};
  if (!s->time)
    return status_fail(error, STATUS_MEMORY, "no memory for %lld snapshots", (long long)count);
  snprintf(s->name, sizeof s->name, "%s", name);
  path_of_list(s, path);
  TRY(file_claim(path, "list of snapshots", error));
  for (int64_t k = 0; k < count; k++) {
    s->time[k] = NAN;
    path_of(s, k, path);
    TRY(file_may_replace(path, "snapshot", error));
  }
  return STATUS_OK;
}

/* How many snapshots are due before this share of the longest time. */
static double due_before(const struct snapshots *s, double progress) {
  return s->count > 1 ? progress * (double)(s->count - 1) : floor(progress);
}

/* Reads the times of the earlier snapshots of a restored run, which are on the disk. */
static void find_earlier(struct snapshots *s, double progress) {
  s->resumed = false;
  s->next = (int64_t)ceil(due_before(s, progress));
  for (int64_t k = 0; k < s->next && k < s->count; k++) {
    char path[PATH];
    struct snapshot_read *file;
    path_of(s, k, path);
    if (snapshot_read_open(path, &file, NULL))
      continue;
    if (!snapshot_read_real(file, "run", "time", &s->time[k]))
      s->time[k] = NAN;
    snapshot_read_close(file);
  }
}

/* ParaView's list of files with their times (style: JSON, version 1.0). Names are relative to it. */
static status write_series(const struct snapshots *s, struct error *error) {
  OWNED char *text = NULL;
  char path[PATH];
  size_t size = 0;
  FILE *out = text_open_sized(&text, &size);
  const char *base = strrchr(s->name, '/');
  fputs("{\n  \"file-series-version\": \"1.0\",\n  \"files\": [", out);
  const char *between = "\n";
  for (int64_t k = 0; k < s->count; k++) {
    if (isnan(s->time[k]))
      continue;
    char number[32];
    snprintf(path, sizeof path, "%s_%06lld.hdf", base ? base + 1 : s->name, (long long)k);
    field_print_number(s->time[k], number);
    fprintf(out, "%s    {\"name\": ", between);
    text_json_string(path, out);
    fprintf(out, ", \"time\": %s}", number);
    between = ",\n";
  }
  fputs("\n  ]\n}\n", out);
  if (!text_close(out, &text))
    return status_fail(error, STATUS_MEMORY, "no memory for the list of snapshots");
  path_of_list(s, path);
  return file_write(path, "list of snapshots", text, size, error);
}

/* Between blocks of steps. Writes the snapshot that is due, if there is one, and NAME.hdf.series again. Both files are
 * complete at any time. A step longer than the time between snapshots skips numbers. */
static status snapshots_look(struct snapshots *s, const struct engine_kind *kind, void *run, struct error *error) {
  double progress = kind->progress(run);
  if (s->resumed)
    find_earlier(s, progress);
  if (s->next >= s->count || due_before(s, progress) < (double)s->next || (s->count == 1 && progress < 1))
    return STATUS_OK;
  char path[PATH];
  int64_t number = s->next;
  path_of(s, number, path);
  TRY(kind->write_snapshot(run, path, error));
  s->time[number] = kind->time(run);
  s->next = number + 1;
  while (s->next < s->count && progress < 1 && due_before(s, progress) >= (double)s->next)
    s->next++; /* a step longer than the interval: the missed snapshots are left out */
  if (progress >= 1)
    s->next = s->count; /* the run has ended, perhaps before its longest time: this was the last snapshot */
  return write_series(s, error);
}

/* A run that ends before its longest time has fewer snapshots than were asked for. */
static void tell_missing(const struct snapshots *s, double time) {
  int64_t written = 0;
  const double digit = pow(10, floor(log10(time)) - 3); /* a time before the end would cut the run */
  for (int64_t k = 0; k < s->count; k++)
    written += !isnan(s->time[k]);
  if (written < s->count)
    fprintf(stderr,
            "clast: %lld of %lld snapshots written: they divide the longest time that the run may take, and it ended "
            "before. `--set stop.end_time='%.4g s'`, just after its end, gives all\n",
            (long long)written, (long long)s->count, digit * (floor(time / digit) + 1));
}

/* Files of an earlier run with this name, which had more snapshots. Programs that read all NAME_*.hdf would mix them.
 */
static void tell_older(const struct snapshots *s) {
  enum { LOOKED_AT = 1000 }; /* numbers after the last one */
  char path[PATH], first[PATH] = "";
  int64_t older = 0;
  for (int64_t k = 0; k < s->count + LOOKED_AT; k++) {
    path_of(s, k, path);
    if ((k < s->count && !isnan(s->time[k])) || access(path, F_OK) != 0)
      continue;
    if (older++ == 0)
      memcpy(first, path, sizeof first);
  }
  if (older)
    fprintf(
        stderr,
        "clast: warning: %lld snapshot%s of an earlier run lie%s beside these, from %s on: %s.hdf.series lists those "
        "of this run alone\n",
        (long long)older, text_plural(older), older == 1 ? "s" : "", first, s->name);
}

/* ---- the run ---- */

enum { BLOCK = 8 }; /* steps between two calls of look(): less than a second, even with a million particles */

struct watch {
  struct snapshots snapshots; /* count 0: none wanted */
  struct resume resume;       /* path NULL: a signal ends the run without a restart file */
  bool terminal;
  int percent;
};

/* Between blocks of steps: the snapshot that is due, the restart file, a percentage on a terminal. */
static status look(void *context, const struct engine_kind *kind, void *run, struct error *error) {
  struct watch *watch = context;
  if (watch->snapshots.count)
    TRY(snapshots_look(&watch->snapshots, kind, run, error));
  const status code = watch->resume.path ? resume_look(&watch->resume, kind, run, error) : STATUS_OK;

  const int percent = (int)floor(100 * kind->progress(run));
  if (watch->terminal && percent != watch->percent)
    fprintf(stderr, "\r%3d %% of the longest time it may take", percent);
  watch->percent = percent;
  return code;
}

/* `fields`: file for the fields at the end; NULL: none. */
static status compute(const struct scene *scene, const struct one_run_options *options, const char *fields,
                      struct run_result *result, struct error *error) {
  struct watch watch = {.percent = -1, .terminal = !options->quiet && isatty(STDERR_FILENO)};
  status code = STATUS_OK;
  if (options->restart)
    resume_begin(&watch.resume, options->restart);
  if (options->snapshots)
    code = snapshots_open(&watch.snapshots, scene->name, options->snapshots,
                          options->restart && access(options->restart, F_OK) == 0, error);
  const struct run_request request = {.kind = scene->kind,
                                      .inputs = scene->inputs,
                                      .seed = (uint64_t)options->seed,
                                      .fields_path = fields,
                                      .restart_path = options->restart};
  if (code == STATUS_OK)
    code = run_simulate(&request, look, &watch, BLOCK, result, error);
  if (watch.terminal)
    fputs("\r\033[K", stderr);
  if (code == STATUS_OK)
    tell_missing(&watch.snapshots, result->outcome.time);
  if (code == STATUS_OK && watch.snapshots.count)
    tell_older(&watch.snapshots);
  free(watch.snapshots.time);
  return code;
}

status one_run(const struct scene *scene, const struct one_run_options *options, struct run_result *result,
               struct error *error) {
  char temporary[FIELD_TEXT_SIZE] = "";
  if (options->fields || options->picture || options->snapshots || options->restart)
    TRY(engine_has_fields(scene->kind, "fields, pictures and restart files", error));
  TRY(engine_ready(scene->kind, scene->inputs, error));
  const char *fields = options->fields;
  if (options->picture && !fields) { /* the picture is drawn from a fields file */
    snprintf(temporary, sizeof temporary, "%s.%ld.h5", options->picture, (long)getpid());
    fields = temporary;
  }
  status code = compute(scene, options, fields, result, error);
  if (code == STATUS_OK && options->picture && result->outcome.state != OUTCOME_INVALID) { /* else there is no body */
    char caption[FIELD_TEXT_SIZE + 128], time[32];
    picture_draw_time(result->outcome.time, time);
    snprintf(caption, sizeof caption, "%s: seed %lld, %s", scene->name, (long long)options->seed, time);
    code = picture_draw(fields, options->picture, &(struct picture_choice){.caption = caption}, error);
  }
  if (*temporary)
    remove(temporary);
  return code;
}
