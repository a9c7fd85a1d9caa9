/* The engine `command`: a run is one run of a program that a scene names. */
#include "engine/command/command.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "engine/command/child.h"
#include "engine/command/definition.h"
#include "schemas/memory.h"

struct run {
  const struct definition *d;
  void *inputs, *values;
  uint64_t seed;
  char program[LIMITS_PATH];
  bool finished;
  int state; /* enum outcome_state */
  char message[FIELD_TEXT_SIZE];
  struct fragment *fragments;
  size_t fragment_count;
};

/* ---- may it run, and where is it? ---- */

/* The program's file. STATUS_MISSING. */
static status find_program(const struct definition *d, char path[LIMITS_PATH], struct error *error) {
  const char *program = d->settings.program, *at = getenv("PATH");
  if (d->place) {
    snprintf(path, LIMITS_PATH, "%s", d->place);
    return access(path, X_OK) == 0 ? STATUS_OK
                                   : status_fail(error, STATUS_MISSING, "the scene's program %.500s cannot be run: %s",
                                                 path, strerror(errno));
  }
  for (; at && *at; at += strcspn(at, ":"), at += *at == ':') {
    const int length = snprintf(path, LIMITS_PATH, "%.*s/%s", (int)strcspn(at, ":"), at, program);
    if (length > 0 && length < LIMITS_PATH && path[0] == '/' && access(path, X_OK) == 0)
      return STATUS_OK;
  }
  return status_fail(error, STATUS_MISSING,
                     "the scene's program %.100s is in no folder of PATH: install it, or add its folder to PATH",
                     program);
}

static status refuse(const struct definition *d, struct error *error) {
  return engine_commands_allowed()
             ? STATUS_OK
             : status_fail(error, STATUS_USAGE,
                           "the scene runs the program %.100s on this machine: read the scene (`clast explain` tells "
                           "what it runs), and give --allow-commands if you trust it",
                           d->settings.program);
}

static status ready(const void *inputs, struct error *error) {
  const struct definition *d = NULL;
  char path[LIMITS_PATH];
  TRY(definition_of(inputs, &d, error));
  TRY(refuse(d, error));
  return find_program(d, path, error);
}

/* ---- a run ---- */

static void free_run(void *pointer) {
  struct run *run = pointer;
  if (!run)
    return;
  free(run->inputs);
  free(run->values);
  free(run->fragments);
  free(run);
}

static status prepare(const void *inputs, uint64_t seed, void **out, struct error *error) {
  const struct definition *d = NULL;
  char program[LIMITS_PATH];
  *out = NULL;
  TRY(definition_of(inputs, &d, error));
  TRY(refuse(d, error));
  TRY(find_program(d, program, error));
  struct run *run = memory_small(1, sizeof *run);
  run->d = d;
  run->seed = seed;
  run->inputs = memory_small(1, d->inputs.size);
  run->values = memory_small(1, d->results.size);
  memcpy(run->inputs, inputs, d->inputs.size);
  memcpy(run->program, program, sizeof program);
  field_defaults(&d->results, run->values);
  *out = run;
  return STATUS_OK;
}

static char *filled(const struct run *run, const char *text, size_t *size) {
  char *out_text = NULL;
  FILE *out = text_open_sized(&out_text, size);
  definition_fill(run->d, text, run->inputs, run->seed, out);
  return text_close_small(out, &out_text);
}

static status start(const struct run *run, struct child *child, struct child_end *end, struct error *error) {
  const struct definition *d = run->d;
  const struct child_limits limits = {d->settings.limits.time,
                                      field_is_off(d->settings.limits.memory) ? 0 : (size_t)d->settings.limits.memory,
                                      (size_t)d->settings.limits.output};
  char *words[DEFINITION_WORDS + 2] = {(char *)d->settings.program};
  size_t size;
  for (size_t i = 0; i < d->file_count; i++) {
    const struct definition_file *file = &d->files[i];
    OWNED char *text = file->is_template ? filled(run, file->text, &size) : NULL;
    TRY(child_put(child, file->name, text ? text : file->text, text ? size : strlen(file->text), error));
  }
  for (size_t i = 0; i < d->word_count; i++)
    words[i + 1] = filled(run, d->words[i], &size);
  const status code = child_run(child, run->program, words, &limits, end, error);
  for (size_t i = 0; i < d->word_count; i++)
    free(words[i + 1]);
  return code;
}

/* An attempt without a result. */
static status failed(const struct run *run, const struct child *child, enum error_cause cause, const char *why,
                     struct error *error) {
  char words[400];
  output_last_words(child->folder, "stderr", words, sizeof words);
  status_fail(error, STATUS_FAILED_RUNS, "%s: %s%s%s%s", run->d->settings.program, why,
              *words ? "; its last words: '" : "", words, *words ? "'" : "");
  if (error)
    error->cause = cause;
  return STATUS_FAILED_RUNS;
}

/* The state that the scene gives to an exit code; -1: none. */
static int state_of(const struct definition *d, int code) {
  for (size_t i = 0; i < d->code_count; i++)
    if (d->codes[i].code == code)
      return d->codes[i].state;
  return code == 0 ? OUTCOME_COMPLETED : -1;
}

static status judge(struct run *run, const struct child *child, const struct child_end *end, struct error *error) {
  char why[LIMITS_MESSAGE];
  const char *not_finite = "";
  struct error wrong = {0};
  if (end->late) {
    snprintf(why, sizeof why, "it did not end within %g s (limits: time) and was killed", run->d->settings.limits.time);
    return failed(run, child, ERROR_TIME_LIMIT, why, error);
  }
  if (end->refused) {
    snprintf(why, sizeof why, "the system does not start %.500s: %s", run->program, strerror(end->refused));
    return failed(run, child, ERROR_PLAIN, why, error);
  }
  if (end->signal == SIGXFSZ) {
    snprintf(why, sizeof why, "it wrote a file larger than its limit of %.3g B (limits: output)",
             run->d->settings.limits.output);
    return failed(run, child, ERROR_PLAIN, why, error);
  }
  if (end->signal) {
    snprintf(why, sizeof why, "it was killed by signal %d (%s)", end->signal, strsignal(end->signal));
    return failed(run, child, ERROR_CRASH, why, error);
  }
  run->state = state_of(run->d, end->exit_code);
  if (run->state < 0) {
    snprintf(why, sizeof why, "it ended with exit code %d (peak memory %.3g MB)", end->exit_code,
             1e-6 * (double)end->peak_memory);
    return failed(run, child, ERROR_PLAIN, why, error);
  }
  if (!outcome_is_usable(run->state)) {
    output_last_words(child->folder, "stderr", run->message, sizeof run->message);
    return STATUS_OK;
  }
  const status code = output_read(run->d, child->folder, run->values, &run->fragments, &run->fragment_count,
                                  &not_finite, &wrong);
  if (code == STATUS_MEMORY)
    return status_fail(error, code, "%s", wrong.message);
  if (code)
    return failed(run, child, ERROR_PLAIN, wrong.message, error);
  if (*not_finite) {
    run->state = OUTCOME_NOT_FINITE;
    snprintf(run->message, sizeof run->message, "the program gives no finite number for %s", not_finite);
  }
  return STATUS_OK;
}

static status step(void *pointer, uint64_t most, bool *finished, struct error *error) {
  struct run *run = pointer;
  struct child child;
  struct child_end end = {0};
  *finished = run->finished;
  if (run->finished || most == 0)
    return STATUS_OK;
  status code = child_open(&child, error);
  if (code == STATUS_OK)
    code = start(run, &child, &end, error);
  if (code == STATUS_OK)
    code = judge(run, &child, &end, error);
  child_close(&child);
  *finished = run->finished = code == STATUS_OK;
  return code;
}

static double progress(const void *run) {
  return ((const struct run *)run)->finished;
}

static double time_of(const void *run) {
  (void)run;
  return 0;
}

/* Masses that are whole numbers of an element jump at each of them: a window that begins there reads an exponent that
 * is too large (2.3 for 2 from two elements). This one begins midway to the next, as all windows of whole elements do
 * (analysis/statistics/statistics.h). Other masses only lose part of an element. */
static double complete_mass(const struct definition_settings *settings, size_t count, const struct fragment *by_mass) {
  const double given = settings->fragments.complete_mass;
  if (count == 0 || !(given > 0))
    return given;
  double element = settings->fragments.element_mass;
  if (field_is_off(element))
    element = by_mass[count - 1].mass;
  const double elements = given / element, rounding = 1e-9 * elements;
  return fmax(given, (floor(elements + rounding) + 0.5) * element);
}

static status finish(void *pointer, struct outcome *outcome, void *result, struct fragment **fragments, size_t *count,
                     struct error *error) {
  struct run *run = pointer;
  const struct definition_settings *settings = &run->d->settings;
  (void)error;
  field_defaults(&outcome_table, outcome);
  field_defaults(&run->d->results, result);
  *fragments = NULL;
  *count = 0;
  if (outcome_is_usable(run->state)) { /* masses may be no numbers else */
    memcpy(result, run->values, run->d->results.size);
    *fragments = run->fragments;
    *count = run->fragment_count;
    run->fragments = NULL;
  }
  const struct outcome_small small = {settings->fragments.dust_mass, complete_mass(settings, *count, *fragments)};
  outcome_fragments(outcome, *count, *fragments, &small);
  outcome->state = run->state;
  memcpy(outcome->message, run->message, sizeof outcome->message);
  outcome->steps = 1;
  outcome->time = outcome->time_step = 0;
  return STATUS_OK;
}

/* ---- what is told ---- */

static const char *headline(const void *inputs) {
  const struct definition *d = NULL;
  return definition_of(inputs, &d, NULL) ? NULL : d->result_rows[0].path; /* NULL: it names none */
}

static status check(const void *inputs, struct error *error) {
  const struct definition *d;
  return definition_of(inputs, &d, error);
}

static char *describe(const void *inputs, bool all) {
  const struct definition *d = NULL;
  char *text = NULL;
  if (definition_of(inputs, &d, NULL))
    return NULL;
  FILE *out = text_open(&text);
  fprintf(out, "runs the program: %s", d->place ? d->place : d->settings.program);
  for (size_t i = 0; i < d->word_count; i++)
    fprintf(out, " %s", d->words[i]);
  fprintf(out, "\nversion: %s (%s)\n", d->settings.version,
          d->settings.same_bits ? "same inputs and seed, same bits" : "the scene does not promise the same bits");
  for (size_t i = 0; i < d->file_count; i++)
    fprintf(out, "%s: %s%s\n", d->files[i].is_template ? "template" : "file", d->files[i].name,
            all ? ", which is:" : "");
  for (size_t i = 0; all && i < d->file_count; i++)
    fprintf(out, "\n%s:\n%s\n", d->files[i].name, d->files[i].text);
  fprintf(out, "limits: %g s, files of %.3g MB", d->settings.limits.time, 1e-6 * d->settings.limits.output);
  if (!field_is_off(d->settings.limits.memory))
    fprintf(out, ", %.3g MB of memory", 1e-6 * d->settings.limits.memory);
  fprintf(out, "\nresults from %s:\n", d->settings.output);
  for (size_t i = 0; i < d->result_count; i++)
    fprintf(out, "  %s (%s): %s\n", d->result_rows[i].path, d->result[i].unit, d->result[i].doc);
  if (d->settings.fragments.name[0] || d->settings.fragments.file[0])
    fprintf(out, "  masses of fragments (%s)\n", d->settings.fragments.unit);
  text_make_plain(text_close_small(out, &text),
                  "\n\t"); /* a scene from a stranger must not move the cursor over what it runs */
  return text;
}

static size_t memory(const void *inputs) {
  const struct definition *d = NULL;
  return definition_of(inputs, &d, NULL) || field_is_off(d->settings.limits.memory) ? 0
                                                                                    : (size_t)d->settings.limits.memory;
}

static const struct engine_kind *of_scene(document_node *root, const char *folder) {
  return definition_read(root, folder, &command_engine);
}

static const struct engine_kind *of_task(const char *text, size_t size, struct error *error) {
  return definition_read_task(text, size, &command_engine, error);
}

/* ---- what the inputs alone tell ---- */

static double seedless(const void *inputs) {
  const struct definition *d = NULL;
  return !definition_of(inputs, &d, NULL) && !d->takes_seed;
}

static double elementless(const void *inputs) {
  const struct definition *d = NULL;
  return !definition_of(inputs, &d, NULL) && field_is_off(d->settings.fragments.element_mass) &&
         (d->settings.fragments.name[0] || d->settings.fragments.file[0]);
}

static const struct condition conditions[] = {
    CONDITION("seedless", .fact = "all seeds are the same run, as the program gets neither {{seed}} nor {{small_seed}}",
              .doubt = "intervals over seeds are of equal runs", .reason = "a program has no other word of the seed",
              .remedy = "give it one of them, or take one seed for each point", .results = "", .before = seedless),
    CONDITION(
        "elementless",
        .fact = "the lightest fragment of each run counts as its element, because `element_mass` of `fragments` is not "
                "given",
        .doubt = "the windows of exponents hang on one fragment of each run",
        .reason = "a program tells no smallest piece",
        .remedy =
            "give the mass of a grid cell, of a sieve's opening, or the smallest mass for which the model is meant",
        .results = "", .before = elementless),
    {.word = NULL},
};

static const struct field_table no_results = {.name = "command result",
                                              .doc = "The results that a scene names.",
                                              .size = sizeof(double)};

const struct engine_kind command_engine = {
    .name = "command",
    .dimensions = 0,
    .doc = "Runs a program that the scene names: its section `command` tells inputs, files, results and limits "
           "(engine/command/README.md). Needs --allow-commands.",
    .results_version = 3,
    .inputs = &definition_base,
    .results = &no_results,
    .of_scene = of_scene,
    .of_task = of_task,
    .sections = definition_sections,
    .check = check,
    .conditions = conditions,
    .ready = ready,
    .headline = headline,
    .describe = describe,
    .memory = memory,
    .prepare = prepare,
    .step = step,
    .progress = progress,
    .time = time_of,
    .finish = finish,
    .free = free_run,
};
