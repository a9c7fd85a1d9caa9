/* `clast simulate SCENE`: one run, without a store. */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "analysis/pictures/picture_canvas.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/results.h"
#include "campaign/commands/resume.h"
#include "campaign/commands/snapshots.h"
#include "campaign/document/campaign.h"
#include "campaign/driver/run.h"
#include "campaign/terminal/scene_option.h"
#include "engine/atomic_file.h"

enum { BLOCK = 8 }; /* steps between two calls of look(): less than a second, even with a million particles */

struct options {
  int64_t seed, snapshots;
  struct option_list set;
  const char *fields, *picture, *restart;
  bool quiet;
  struct table_options table;
};

struct watch {
  struct snapshots *snapshots; /* NULL: none wanted */
  struct resume *resume;       /* NULL: it ends where it is stopped */
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

/* Can the files be written? An error is found before the run, not after it. */
static status try_files(const struct options *options, struct error *error) {
  const char *const files[][2] = {{options->picture, "picture"},
                                  {options->fields, "fields file"},
                                  {options->restart, "restart file"}};
  if (options->picture) {
    status code = picture_canvas_named(options->picture, error);
    if (code)
      return code;
  }
  for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
    if (!files[i][0])
      continue;
    status code = atomic_file_try(files[i][0], files[i][1], error);
    if (code)
      return code;
  }
  return STATUS_OK;
}

/* Runs the scene with what watches it. *result is the caller's, also on errors. */
static status compute(const struct scene *scene, const struct options *options, const char *fields,
                      struct run_result *result, struct error *error) {
  struct watch watch = {.percent = -1, .terminal = !options->quiet && isatty(STDERR_FILENO)};
  struct resume resume;
  if (options->restart) {
    resume_begin(&resume, options->restart);
    watch.resume = &resume;
  }
  if (options->snapshots) {
    const bool resumed = options->restart && access(options->restart, F_OK) == 0;
    status code = snapshots_open(scene->name, options->snapshots, resumed, &watch.snapshots, error);
    if (code)
      return code;
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

static status draw(const struct scene *scene, const struct options *options, const char *fields,
                   const struct run_result *result, struct error *error) {
  if (!options->picture || result->outcome.state == OUTCOME_INVALID)
    return STATUS_OK; /* an invalid run has no body, and writes no fields */
  char caption[FIELD_TEXT_SIZE + 64];
  snprintf(caption, sizeof caption, "%s, seed %lld", scene->name, (long long)options->seed);
  return commands_picture(fields, options->picture, caption, error);
}

static status simulate(const struct scene *scene, const struct options *options, enum table_format format,
                       struct error *error) {
  char temporary[FIELD_TEXT_SIZE] = "";
  const char *fields = options->fields;
  if (options->picture && !fields) { /* the picture is drawn from a fields file */
    snprintf(temporary, sizeof temporary, "%s.%ld.h5", options->picture, (long)getpid());
    fields = temporary;
  }
  struct run_result result = {0};
  status code = compute(scene, options, fields, &result, error);
  if (code == STATUS_OK)
    code = draw(scene, options, fields, &result, error);
  if (*temporary)
    remove(temporary);

  /* Results are printed also when a file could not be written: hours of computing must not be lost for that. */
  if (result.result) {
    const status printed = results_print(scene, options->seed, &result, format, code ? NULL : error);
    code = code ? code : printed;
  }
  if (code)
    goto cleanup;
  if (options->restart)
    resume_end(options->restart);
  if (!campaign_usable(&result.outcome))
    code = status_fail(error, STATUS_FAILED_RUNS, "the run ended without a usable result: %s", result.outcome.message);
  else if (*result.outcome.message && !options->quiet)
    fprintf(stderr, "clast: %s\n", result.outcome.message);
cleanup:
  run_result_clear(&result);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct scene *scene = NULL;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
  code = scene_option_load(line->arguments[0], &options->set, &scene, error);
  if (code)
    goto cleanup;
  code = try_files(options, error);
  if (code)
    goto cleanup;
  code = simulate(scene, options, format, error);
cleanup:
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("seed", 0, "N", struct options, seed, 0, INT64_MAX, "1",
                       "Seed of the run: the same seed gives the same bits."),
    SCENE_OPTION_SET(struct options, set),
    OPTION_ROW_TEXT("picture", 'p', "FILE.png", struct options, picture, NULL,
                    "Draw the body at the end: fragments of grains, or the damage of particles on a cut."),
    OPTION_ROW_TEXT(
        "fields", 0, "FILE.hdf", struct options, fields, NULL,
        "Write all grains or particles, fragments, inputs and results at the end as an HDF5 file. ParaView opens it if "
        "its name ends in .hdf."),
    OPTION_ROW_INTEGER("snapshots", 0, "N", struct options, snapshots, 0, 100000, "0",
                       "Write up to N such files during the run, SCENE_000000.hdf and so on, evenly over the longest "
                       "time that the run "
                       "may take. SCENE.hdf.series lists them with their times for ParaView."),
    OPTION_ROW_TEXT(
        "restart", 0, "FILE", struct options, restart, NULL,
        "Go on from this file if it exists. It is written every five minutes and when the run is interrupted (exit 75; "
        "the same command goes on, to the same bits). It is removed at the end."),
    OPTION_ROW_FLAG("quiet", 'q', struct options, quiet, "No progress on the terminal."),
    TABLE_OPTIONS(struct options, table),
};

const struct command simulate_command = {
    .name = "simulate",
    .group = "running",
    .arguments = "SCENE",
    .summary = "one run of a scene, with pictures and fields",
    .doc = "Runs one simulation of a SCENE (a built-in name or a file) and prints its results: fragments, largest\n"
           "fraction, energies, exponents of the fragment spectrum. It writes no file unless an option names one.",
    .examples = "clast simulate disc-explosion --seed 7 --picture disc.png\n"
                "clast simulate disc-explosion --set threshold.strain=5% --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .has_runs = true,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
