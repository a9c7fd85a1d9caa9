/* From a campaign to its finished store, and the table at the end. */
#include "campaign/launch/launch_campaign.h"

#include <inttypes.h>
#include <stdlib.h>

#include "campaign/print/print.h"
#include "schemas/clock.h"

enum { MANY_POINTS = 64 }; /* above this number the table at the end is printed only with --json or --csv */

static const char *plural(int64_t count) {
  return count == 1 ? "" : "s";
}

static void print_summary(const struct driver_summary *summary, const char *store, double wall_s, status code) {
  launch_tell_runs(store, summary->runs_done, summary->runs_reused, summary->cpu_s, wall_s);
  fprintf(stderr, "points: %" PRIu64 " of %" PRIu64 " complete", summary->points_done, summary->points);
  if (summary->points_interval_met || summary->points_cap_reached)
    fprintf(stderr, " (interval met %" PRIu64 ", most runs reached %" PRIu64 ")", summary->points_interval_met,
            summary->points_cap_reached);
  fputc('\n', stderr);
  if (summary->runs_censored)
    fprintf(stderr, "%" PRId64 " run%s ended at the hard end time: fragments may still have been breaking\n",
            summary->runs_censored, plural(summary->runs_censored));
  if (summary->attempts_failed)
    fprintf(stderr, "%" PRId64 " attempt%s failed: clast query %s --named failures\n", summary->attempts_failed,
            plural(summary->attempts_failed), store);
  if (code == STATUS_STOPPED)
    fputs("stopped; the same command goes on\n", stderr);
}

static status print_table(struct store *store, const char *path, const struct ask_points_choice *choice,
                          enum table_format format, bool quiet, struct error *error) {
  int64_t points = 0;
  TRY(ask_points_count(store, choice, &points, error));
  if (format == TABLE_TEXT && points > MANY_POINTS) {
    fprintf(stderr, "estimates of %" PRId64 " points: clast estimates %s --campaign %" PRId64 "\n", points, path,
            choice->campaign);
    return STATUS_OK;
  }
  status code = print_estimates(store, choice, format, stdout, error);
  if (!code && format == TABLE_TEXT && !quiet) {
    fflush(stdout); /* the legend comes below the table */
    print_estimates_legend(store);
  }
  return code;
}

/* Reads the store again, so that it prints what any later reader will find. */
static status print_answers(const char *path, int64_t campaign, enum table_format format, bool quiet,
                            struct error *error) {
  struct store *store = NULL;
  const struct ask_points_choice choice = {.campaign = campaign};
  TRY(store_open_reader(path, &store, error));
  status code = print_table(store, path, &choice, format, quiet, error);
  store_close(store, NULL);
  return code;
}

struct launching {
  const struct campaign *campaign;
  const char *store;
  enum table_format format;
};

/* NULL: nothing is shown. */
static struct progress *make_progress(const struct launch *launch) {
  if (!launch->manager || launch->notes.quiet)
    return NULL;
  const enum progress_style style = progress_style_of(stderr);
  const char *no_colour = getenv("NO_COLOR");
  return progress_create(stderr, style, style == PROGRESS_BAR && !(no_colour && *no_colour), 0);
}

static status run_campaign(void *context, struct launch *launch, struct error *error) {
  const struct launching *launching = context;
  const bool quiet = launch->notes.quiet;
  struct progress *progress = make_progress(launch);
  struct driver_summary summary = {0};
  launch->notes.progress = launch->scheduler.progress = progress;
  launch->scheduler.store_path = launching->store;
  const status code = driver_run(launching->campaign, launch->farm, &launch->scheduler, &summary, error);
  const double wall_s = clock_s() - launch->begin_s;
  launch->notes.progress = NULL;
  progress_free(progress);
  if (!launch->manager)
    return code;

  const bool done = code == STATUS_OK || code == STATUS_FAILED_RUNS;
  if ((done || code == STATUS_STOPPED) && !quiet)
    print_summary(&summary, launching->store, wall_s, code);
  if (!done)
    return code;
  const status printed = print_answers(launching->store, summary.campaign_id, launching->format, quiet,
                                       code ? NULL : error);
  return printed ? printed : code;
}

status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error) {
  struct launching launching = {campaign, store, format};
  return launch_farm(campaign, options, line, run_campaign, &launching, error);
}
