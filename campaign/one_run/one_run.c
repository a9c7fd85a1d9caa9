/* Computes a scene, and during the run writes snapshots, restart file and a percentage on a terminal. */
#include "campaign/one_run/one_run.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#include "campaign/charts/charts.h"
#include "campaign/one_run/resume.h"
#include "campaign/one_run/snapshots.h"

enum { BLOCK = 8 }; /* steps between two calls of look(): less than a second, even with a million particles */

struct watch {
  struct snapshots *snapshots; /* NULL: none wanted */
  struct resume *resume;       /* NULL: a signal ends the run without a restart file */
  bool terminal;
  int percent;
};

/* Between blocks of steps: the snapshot that is due, the restart file, a percentage on a terminal. */
static status look(void *context, const struct engine_kind *kind, void *run, struct error *error) {
  struct watch *watch = context;
  status code = STATUS_OK;
  if (watch->snapshots)
    code = snapshots_look(watch->snapshots, kind, run, error);
  if (code)
    return code;
  if (watch->resume)
    code = resume_look(watch->resume, kind, run, error);

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
  struct resume resume;
  if (options->restart) {
    resume_begin(&resume, options->restart);
    watch.resume = &resume;
  }
  if (options->snapshots) {
    const bool resumed = options->restart && access(options->restart, F_OK) == 0;
    TRY(snapshots_open(scene->name, options->snapshots, resumed, &watch.snapshots, error));
  }

  const struct run_request request = {.kind = scene->kind,
                                      .inputs = scene->inputs,
                                      .seed = (uint64_t)options->seed,
                                      .fields_path = fields,
                                      .restart_path = options->restart};
  status code = run_simulate(&request, look, &watch, BLOCK, result, error);
  if (watch.terminal)
    fputs("\r\033[K", stderr);
  snapshots_close(watch.snapshots);
  return code;
}

static status draw(const struct scene *scene, const struct one_run_options *options, const char *fields,
                   const struct run_result *result, struct error *error) {
  if (!options->picture || result->outcome.state == OUTCOME_INVALID)
    return STATUS_OK; /* an invalid run has no body, and writes no fields */
  char caption[FIELD_TEXT_SIZE + 64];
  snprintf(caption, sizeof caption, "%s, seed %lld", scene->name, (long long)options->seed);
  return picture_draw(fields, options->picture, &(struct picture_choice){.caption = caption}, error);
}

status one_run(const struct scene *scene, const struct one_run_options *options, struct run_result *result,
               struct error *error) {
  char temporary[FIELD_TEXT_SIZE] = "";
  const char *fields = options->fields;
  if (options->picture && !fields) { /* the picture is drawn from a fields file */
    snprintf(temporary, sizeof temporary, "%s.%ld.h5", options->picture, (long)getpid());
    fields = temporary;
  }
  status code = compute(scene, options, fields, result, error);
  if (code == STATUS_OK)
    code = draw(scene, options, fields, result, error);
  if (*temporary)
    remove(temporary);
  return code;
}
