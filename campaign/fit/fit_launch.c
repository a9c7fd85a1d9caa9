/* Runs a fit with a farm. */
#include "campaign/fit/fit_launch.h"

#include <inttypes.h>
#include <string.h>

#include "campaign/fit/fit_print.h"
#include "schemas/clock.h"

/* The two documents, and the objects made from them. */
struct subject {
  struct campaign *campaign;
  struct observed *observed;
  struct fit *fit;
  char reference[2 * FIELD_TEXT_SIZE]; /* path of the scene from the current folder */
};

static void clear(struct subject *subject) {
  fit_free(subject->fit);
  observed_free(subject->observed);
  campaign_free(subject->campaign);
}

static status load(struct subject *subject, const struct command_line *line, const struct fit_launch_options *options,
                   struct launch_notes *notes, struct error *error) {
  const char *path = line->arguments[1], *slash = strrchr(path, '/');
  status code = campaign_load(path, &subject->campaign, error);
  if (code == STATUS_OK)
    code = observed_load(line->arguments[0], subject->campaign, &subject->observed, error);
  if (code != STATUS_OK)
    return code;
  struct campaign *campaign = subject->campaign;
  const char *scene = campaign->scene_reference;
  const bool is_file = strchr(scene, '/') || strchr(scene, '.');
  snprintf(subject->reference, sizeof subject->reference, "%.*s%s",
           slash && is_file && scene[0] != '/' ? (int)(slash + 1 - path) : 0, path, scene);
  if (options->store)
    snprintf(campaign->store, sizeof campaign->store, "%s", options->store);
  const struct fit_rule rule = {.rounds = options->rounds,
                                .check = options->check,
                                .seed = (uint64_t)options->seed,
                                .note = launch_note,
                                .note_context = notes};
  return fit_create(campaign, subject->observed, &rule, subject->reference, &subject->fit, error);
}

static status report(struct subject *subject, const struct fit_launch_options *options, enum table_format format,
                     struct error *error) {
  status code = fit_find(subject->fit, error);
  if (code == STATUS_OK)
    code = fit_print(subject->fit, format, error);
  if (code == STATUS_OK && options->picture)
    code = fit_print_picture(subject->fit, options->picture, &options->chart, error);
  return code;
}

struct launching {
  struct subject subject;
  const struct fit_launch_options *options;
  enum table_format format;
};

static status run_fit(void *context, struct launch *launch, struct error *error) {
  struct launching *launching = context;
  struct subject *subject = &launching->subject;
  const struct fit_launch_options *options = launching->options;
  const bool tells = launch->manager && !options->launch.quiet;
  struct series_summary summary = {0};
  const struct series series = {subject->fit, fit_rounds_next, fit_rounds_done};
  launch->driver.store_path = subject->campaign->store;
  if (tells)
    fprintf(stderr, "clast: at most %" PRId64 " runs in %" PRId64 " rounds%s\n", fit_rounds_most(subject->fit, false),
            options->rounds, options->check ? ", and those of the check" : "");
  status code = series_run(&series, launch->farm, &launch->driver, &summary, error);
  if (tells && (code == STATUS_OK || code == STATUS_STOPPED))
    launch_tell_runs(subject->campaign->store, summary.runs_done, summary.runs_reused, summary.cpu_s,
                     clock_s() - launch->begin_s);
  if (tells && summary.runs_failed)
    fprintf(stderr, "some runs failed: clast query %s --named failures\n", subject->campaign->store);
  return launch->manager && code == STATUS_OK ? report(subject, options, launching->format, error) : code;
}

status fit_launch(const struct command_line *line, const struct fit_launch_options *options, enum table_format format,
                  struct error *error) {
  struct launching launching = {.options = options, .format = format};
  struct launch_notes notes = {.quiet = options->launch.quiet};
  status code = load(&launching.subject, line, options, &notes, error);
  if (code == STATUS_OK)
    code = launch_farm(launching.subject.campaign, &options->launch, line, run_fit, &launching, error);
  clear(&launching.subject);
  return code;
}
