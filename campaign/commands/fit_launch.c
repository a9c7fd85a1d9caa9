/* Runs a fit with a farm. */
#include "campaign/commands/fit_launch.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/fit_print.h"
#include "campaign/driver/provenance.h"
#include "campaign/driver/run.h"
#include "campaign/terminal/progress.h"
#include "schemas/clock.h"

/* The two documents and what was made of them. */
struct subject {
  struct campaign *campaign;
  struct observed *observed;
  struct fit *fit;
  char reference[2 * FIELD_TEXT_SIZE]; /* of the scene, from the current folder */
};

static void clear(struct subject *subject) {
  fit_free(subject->fit);
  observed_free(subject->observed);
  campaign_free(subject->campaign);
}

static void note(void *context, const char *text) {
  const struct fit_launch_options *options = context;
  if (!options->launch.quiet || strncmp(text, "warning", 7) == 0)
    fprintf(stderr, "clast: %s\n", text);
}

static status load(struct subject *subject, const struct command_line *line, const struct fit_launch_options *options,
                   struct error *error) {
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
                                .note = note,
                                .note_context = (void *)options};
  return fit_create(campaign, subject->observed, &rule, subject->reference, &subject->fit, error);
}

static void print_summary(const struct subject *subject, const struct series_summary *summary, double wall_s) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(summary->cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %" PRId64 " runs computed in %s (%s of processor time), %" PRId64 " found in the store%s\n",
          subject->campaign->store, summary->runs_done, wall, cpu, summary->runs_reused,
          summary->runs_failed ? "; some runs failed" : "");
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

static status run_with_farm(struct subject *subject, const struct command_line *line,
                            const struct fit_launch_options *options, struct farm *farm, enum table_format format,
                            struct error *error) {
  const bool manager = farm_rank(farm) == 0;
  struct series_summary summary = {0};
  char *facts = provenance_json(farm_ranks(farm), farm_slots_total(farm), line->argc, line->argv);
  const struct driver_options driver = {.store_path = subject->campaign->store,
                                        .facts = facts,
                                        .note = note,
                                        .note_context = (void *)options};
  const struct series series = {subject->fit, fit_rounds_next, fit_rounds_done};
  const double begin = clock_s();
  if (manager && !options->launch.quiet)
    fprintf(stderr, "clast: at most %" PRId64 " runs in %" PRId64 " rounds%s\n", fit_rounds_most(subject->fit, false),
            options->rounds, options->check ? ", and those of the check" : "");
  status code = facts ? series_run(&series, farm, &driver, &summary, error)
                      : status_fail(error, STATUS_MEMORY, "out of memory");
  free(facts);
  if (manager && !options->launch.quiet && (code == STATUS_OK || code == STATUS_STOPPED))
    print_summary(subject, &summary, clock_s() - begin);
  return manager && code == STATUS_OK ? report(subject, options, format, error) : code;
}

status fit_launch(const struct command_line *line, const struct fit_launch_options *options, enum table_format format,
                  struct error *error) {
  struct subject subject = {0};
  status code = load(&subject, line, options, error);
  if (code == STATUS_OK) {
    struct farm_options farm_options = {.slots = (int)options->launch.slots,
                                        .in_process = options->launch.in_process,
                                        .use_mpi = farm_under_mpi()};
    struct farm *farm = NULL;
    driver_farm_options(subject.campaign, &farm_options);
    code = farm_start(&farm_options, run_work, &farm, error);
    if (code == STATUS_OK) {
      code = run_with_farm(&subject, line, options, farm, format, error);
      const status stopped = farm_stop(farm, code ? NULL : error);
      code = code ? code : stopped;
    }
  }
  clear(&subject);
  return code;
}
