/* Farm, driver, summary and the table at the end. */
#include "campaign/commands/launch.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/commands/estimates_table.h"
#include "campaign/driver/driver.h"
#include "campaign/driver/provenance.h"
#include "campaign/driver/run.h"
#include "schemas/clock.h"

enum { MANY_POINTS = 64 }; /* above this number the table at the end is printed only with --json or --csv */

struct notes {
  struct progress *progress;
  bool quiet;
};

static void note(void *context, const char *text) {
  const struct notes *notes = context;
  bool warning = strncmp(text, "warning", 7) == 0;
  if (notes->quiet && !warning)
    return;
  if (notes->progress)
    progress_note(notes->progress, text);
  else
    fprintf(stderr, "clast: %s\n", text);
}

static const char *plural(int64_t count) {
  return count == 1 ? "" : "s";
}

static void print_summary(const struct driver_summary *summary, const char *store, double wall_s, status code) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(summary->cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %" PRId64 " run%s computed in %s (%s of processor time), %" PRId64 " found in the store\n",
          store, summary->runs_done, plural(summary->runs_done), wall, cpu, summary->runs_reused);
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

/* Reads the store again, so that it prints what any later reader will find. */
static status print_estimates(const char *path, int64_t campaign, enum table_format format, bool quiet,
                              struct error *error) {
  struct store *store = NULL;
  int64_t points = 0;
  const struct ask_points_choice choice = {.campaign = campaign};
  status code = store_open_reader(path, &store, error);
  if (!code)
    code = ask_points_count(store, &choice, &points, error);
  if (!code && format == TABLE_TEXT && points > MANY_POINTS)
    fprintf(stderr, "estimates of %" PRId64 " points: clast estimates %s --campaign %" PRId64 "\n", points, path,
            campaign);
  else if (!code)
    code = estimates_table_print(store, &choice, format, stdout, error);
  if (!code && format == TABLE_TEXT && points <= MANY_POINTS && !quiet) {
    fflush(stdout); /* the legend comes below the table */
    estimates_table_explain(store);
  }
  store_close(store, NULL);
  return code;
}

static status manage(const struct campaign *campaign, const char *store, const struct launch_options *options,
                     struct farm *farm, enum table_format format, const struct command_line *line,
                     struct error *error) {
  bool manager = farm_rank(farm) == 0;
  struct progress *progress = NULL;
  if (manager && !options->quiet) {
    enum progress_style style = progress_style_of(stderr);
    const char *no_colour = getenv("NO_COLOR");
    progress = progress_create(stderr, style, style == PROGRESS_BAR && !(no_colour && *no_colour), 0);
  }
  char *facts = provenance_json(farm_ranks(farm), farm_slots_total(farm), line->argc, line->argv);
  struct notes notes = {progress, options->quiet};
  struct driver_options driver = {.store_path = store,
                                  .facts = facts,
                                  .progress = progress,
                                  .note = note,
                                  .note_context = &notes,
                                  .slots = farm_slots_total(farm)};
  struct driver_summary summary = {0};
  const double start_s = clock_s();
  status code = facts ? driver_run(campaign, farm, &driver, &summary, error)
                      : status_fail(error, STATUS_MEMORY, "out of memory");
  const double wall_s = clock_s() - start_s;
  progress_free(progress);
  free(facts);
  if (!manager)
    return code;
  bool ended = code == STATUS_OK || code == STATUS_FAILED_RUNS || code == STATUS_STOPPED;
  if (ended && !options->quiet)
    print_summary(&summary, store, wall_s, code);
  if (code == STATUS_OK || code == STATUS_FAILED_RUNS) {
    status printed = print_estimates(store, summary.campaign_id, format, options->quiet, code ? NULL : error);
    code = printed ? printed : code;
  }
  return code;
}

status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error) {
  struct farm_options farm_options = {.slots = (int)options->slots,
                                      .in_process = options->in_process,
                                      .use_mpi = farm_under_mpi()};
  struct farm *farm = NULL;
  driver_farm_options(campaign, &farm_options);
  status code = farm_start(&farm_options, run_work, &farm, error);
  if (code)
    return code;
  code = manage(campaign, store, options, farm, format, line, error);
  status stopped = farm_stop(farm, code ? NULL : error);
  return code ? code : stopped;
}

bool launch_other_rank(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};
  if (!farm_under_mpi() && farm_launched() <= 1)
    return false;
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    const char *rank = getenv(names[i]);
    if (rank)
      return strcmp(rank, "0") != 0;
  }
  return false;
}

status launch_quiet_ranks(status code, struct error *error) {
  if (code == STATUS_OK || !launch_other_rank())
    return code;
  error->message[0] = '\0';
  nanosleep(&(struct timespec){.tv_nsec = 500000000}, NULL);
  return code;
}
