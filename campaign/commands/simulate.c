/* `clast simulate SCENE`: one run, here and now. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/pictures/picture_canvas.h"
#include "analysis/statistics/estimates.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/explain.h"
#include "campaign/commands/results.h"
#include "campaign/commands/resume.h"
#include "campaign/commands/snapshots.h"
#include "campaign/document/campaign.h"
#include "campaign/driver/run.h"
#include "engine/atomic_file.h"

enum { BLOCK = 8 }; /* steps between looks at progress: under a second, also for a million particles */

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

/* The snapshot that is due; the restart file; a percentage on a terminal. */
static status look(void *context, const struct engine_kind *kind, void *run, struct error *error) {
  struct watch *watch = context;
  status code = watch->snapshots ? snapshots_look(watch->snapshots, kind, run, error) : STATUS_OK;
  if (!code && watch->resume)
    code = resume_look(watch->resume, kind, run, error);
  int percent = (int)floor(100 * kind->progress(run));
  if (watch->terminal && percent != watch->percent)
    fprintf(stderr, "\r%3d %% of the longest time it may take", watch->percent = percent);
  return code;
}

/* What the run is to leave behind has a place: found out before the run, not after it. */
static status places(const struct options *options, struct error *error) {
  status code = options->picture ? picture_canvas_named(options->picture, error) : STATUS_OK;
  if (!code && options->picture)
    code = atomic_file_try(options->picture, "picture", error);
  if (!code && options->fields)
    code = atomic_file_try(options->fields, "fields file", error);
  if (!code && options->restart)
    code = atomic_file_try(options->restart, "restart file", error);
  return code;
}

static status simulate(const struct scene *scene, const struct options *options, enum table_format format,
                       struct error *error) {
  char temporary[FIELD_TEXT_SIZE] = "";
  const char *fields = options->fields;
  if (options->picture && !fields) { /* the picture is drawn from a fields file */
    snprintf(temporary, sizeof temporary, "%s.%ld.h5", options->picture, (long)getpid());
    fields = temporary;
  }
  struct watch watch = {.percent = -1, .terminal = !options->quiet && isatty(STDERR_FILENO)};
  struct resume resume;
  if (options->restart) {
    resume_begin(&resume, options->restart);
    watch.resume = &resume;
  }
  struct run_request request = {.kind = scene->kind,
                                .inputs = scene->inputs,
                                .seed = (uint64_t)options->seed,
                                .fields_path = fields,
                                .restart_path = options->restart};
  struct run_result result = {0};
  status code = options->snapshots
                    ? snapshots_open(scene->name, options->snapshots,
                                     options->restart && access(options->restart, F_OK) == 0, &watch.snapshots, error)
                    : STATUS_OK;
  if (!code)
    code = run_simulate(&request, look, &watch, BLOCK, &result, error);
  if (watch.terminal)
    fputs("\r\033[K", stderr);
  if (!code && options->picture &&
      result.outcome.state != OUTCOME_INVALID) { /* which has no body, and writes no fields */
    char caption[FIELD_TEXT_SIZE + 64];
    snprintf(caption, sizeof caption, "%s, seed %lld", scene->name, (long long)options->seed);
    code = commands_picture(fields, options->picture, caption, error);
  }
  if (*temporary)
    remove(temporary);
  if (result.result) { /* also when a file of it could not be written: hours of computing are not to be lost for that */
    const status printed = results_print(scene->kind, options->seed, &result, format, code ? NULL : error);
    code = code ? code : printed;
  }
  if (!code && options->restart)
    resume_end(&resume);
  if (!code && !campaign_usable(&result.outcome))
    code = status_fail(error, STATUS_FAILED_RUNS, "the run ended without a usable result: %s", result.outcome.message);
  else if (!code && *result.outcome.message && !options->quiet)
    fprintf(stderr, "clast: %s\n", result.outcome.message);
  snapshots_close(watch.snapshots);
  run_result_clear(&result);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct scene *scene = NULL;
  status code = table_choose(&options->table, &format, error);
  if (!code)
    code = scene_load(line->arguments[0], NULL, &scene, error);
  for (size_t i = 0; !code && i < options->set.count; i++)
    code = explain_override(scene, options->set.items[i], error);
  if (!code)
    code = scene_check(scene, error);
  if (!code)
    code = places(options, error);
  if (!code)
    code = simulate(scene, options, format, error);
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    {"seed", 0, OPTION_INTEGER, "N", offsetof(struct options, seed), 0, INT64_MAX, "1",
     "Seed of the run: the same seed gives the same bits."},
    EXPLAIN_SET(struct options, set),
    {"picture", 'p', OPTION_TEXT, "FILE.png", offsetof(struct options, picture), 0, 0, NULL,
     "Draw the body at the end: fragments of grains, or the damage of particles on a cut."},
    {"fields", 0, OPTION_TEXT, "FILE.hdf", offsetof(struct options, fields), 0, 0, NULL,
     "Write all grains or particles, fragments, inputs and results at the end as an HDF5 file; named .hdf, ParaView "
     "opens it."},
    {"snapshots", 0, OPTION_INTEGER, "N", offsetof(struct options, snapshots), 0, 100000, "0",
     "Write up to N such files on the way, SCENE_000000.hdf and so on, evenly over the longest time the run may take; "
     "SCENE.hdf.series lists them with their times for ParaView."},
    {"restart", 0, OPTION_TEXT, "FILE", offsetof(struct options, restart), 0, 0, NULL,
     "Go on from this file if it is there. It is written every five minutes and when the run is interrupted (exit 75: "
     "the "
     "same command goes on, to the same bits), and removed at the end."},
    {"quiet", 'q', OPTION_FLAG, NULL, offsetof(struct options, quiet), 0, 0, NULL, "No progress on the terminal."},
    TABLE_OPTIONS(struct options, table),
};

const struct command simulate_command = {
    .name = "simulate",
    .group = "running",
    .arguments = "SCENE",
    .summary = "one run of a scene, with pictures and fields",
    .doc = "Runs one simulation of a SCENE (a built-in name or a file) and prints its results: fragments, largest\n"
           "fraction, energies, exponents of the fragment spectrum. Nothing is stored but the files asked for.",
    .examples = "clast simulate disc-explosion --seed 7 --picture disc.png\n"
                "clast simulate disc-explosion --set threshold.strain=5% --json",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .has_runs = true,
    .options = rows,
    .option_count = sizeof rows / sizeof rows[0],
    .options_size = sizeof(struct options),
    .run = run,
};
