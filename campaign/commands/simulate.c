/* `clast simulate SCENE`: one run, without a store. */
#include "campaign/commands/commands.h"
#include "campaign/one_run/one_run.h"

struct options {
  struct one_run_options run;
  struct option_list set;
};

static status simulate(const struct scene *scene, const char *reference, const struct one_run_options *options,
                       enum table_format format, struct error *error) {
  RUN_RESULT result = {0};
  campaign_warn_scene(scene, "clast: warning: ", stderr);
  status code = one_run(scene, options, &result, error);
  /* Results are printed also when a file could not be written: hours of computing must not be lost for that. */
  if (result.result) {
    const status printed = print_results(scene, reference, options->seed, &result, format, code ? NULL : error);
    code = code ? code : printed;
  }
  TRY(code);
  if (options->restart)
    remove(options->restart); /* the run has ended */
  if (!outcome_is_usable(result.outcome.state))
    code = status_fail(error, STATUS_FAILED_RUNS, "the run ended without a usable result: %s", result.outcome.message);
  else if (*result.outcome.message && !options->quiet)
    fprintf(stderr, "clast: %s\n", result.outcome.message);
  condition_tell(scene->kind->conditions, result.outcome.warnings,
                 condition_before(scene->kind->conditions, scene->inputs, NULL), "clast: warning: ", stderr);
  if (options->snapshots && !options->quiet && table_for_people(format)) {
    char series[LIMITS_PATH], movie[LIMITS_PATH], words[2][TEXT_WORD];
    snprintf(series, sizeof series, "%s.hdf.series", scene->name);
    snprintf(movie, sizeof movie, "%s.gif", scene->name);
    fprintf(stderr, "clast: `clast picture %s %s` makes a movie of the snapshots, %s.png one picture\n",
            text_word(series, words[0]), text_word(movie, words[1]), scene->name);
  }
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  SCENE scene = NULL;
  TRY(option_load_scene(line->arguments[0], &options->set, &scene, error));
  char reference[1000];
  option_words(line->arguments[0], &options->set, NULL, reference, sizeof reference);
  return simulate(scene, reference, &options->run, line->format, error);
}

static const struct option_row rows[] = {
    OPTION_ROW_INTEGER("seed", 0, "N", struct options, run.seed, 0, INT64_MAX, "1"),
    SCENE_OPTION_SET(struct options, set),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE.png", struct options, run.picture),
    OPTION_ROW_OUTPUT(OPTION_OUTPUT, "fields", 0, "FILE.hdf", struct options, run.fields),
    OPTION_ROW_INTEGER("snapshots", 0, "N", struct options, run.snapshots, 0, 100000, "0"),
    OPTION_ROW_OUTPUT(OPTION_OUTPUT, "restart", 0, "FILE", struct options, run.restart),
    OPTION_ROW_FLAG("quiet", 'q', struct options, run.quiet),
};

COMMAND(simulate, "running", "SCENE", .has_runs = true, .computes = true, COMMAND_OPTIONS(struct options, rows),
        .has_table = true, .run = run);
