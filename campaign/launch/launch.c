/* The farm of a command, and the messages about its runs. */
#include "campaign/launch/launch.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "campaign/charts/charts.h"
#include "campaign/print/print.h"
#include "campaign/terminal/words.h"
#include "schemas/clock.h"

void launch_note(void *context, const char *text) {
  const struct launch_notes *notes = context;
  const bool warning = strncmp(text, "warning", 7) == 0;
  if (notes->quiet && !warning)
    return;
  if (notes->progress)
    progress_note(notes->progress, text);
  else
    fprintf(stderr, "clast: %s\n", text);
}

void launch_tell_runs(const char *store, int64_t computed, int64_t found, double cpu_s, double wall_s) {
  char wall[64], cpu[64];
  progress_duration(wall_s, wall, sizeof wall);
  progress_duration(cpu_s, cpu, sizeof cpu);
  fprintf(stderr, "%s: %" PRId64 " run%s computed in %s (%s of processor time)", store, computed, text_plural(computed),
          wall, cpu);
  if (found >= 0)
    fprintf(stderr, ", %" PRId64 " found in the store", found);
  fputc('\n', stderr);
}

status launch_series(struct launch *launch, const struct series *series, bool found, struct error *error) {
  struct series_summary summary;
  const char *store = launch->scheduler.store_path = series->limits->store;
  const status code = driver_run_series(series, launch->farm, &launch->scheduler, &summary, error);
  launch_end_progress(launch);
  STORE answers = NULL;
  int64_t excluded = 0; /* a run can belong to several campaigns of the series */
  if (launch->manager && store_open_reader(store, &answers, NULL) == STATUS_OK &&
      ask_run_excluded_count(answers, &excluded, NULL) == STATUS_OK)
    uncertainty_excluded(excluded, store);
  if (!launch->manager || launch->notes.quiet)
    return code;
  if (code == STATUS_OK || code == STATUS_STOPPED)
    launch_tell_runs(store, summary.runs_done, found ? summary.runs_reused : -1, summary.cpu_s,
                     clock_s() - launch->begin_s);
  uncertainty_missing(summary.runs_failed, 0, store);
  return code;
}

status launch_begin(struct launch *launch, const struct campaign *limits, const struct launch_options *options,
                    const struct command_line *line, struct error *error) {
  struct farm_options farm_options = {.slots = (int)options->slots,
                                      .in_process = options->in_process,
                                      .use_mpi = farm_under_mpi()};
  scheduler_limits(limits, &farm_options);
  if (limits->scene)
    TRY(engine_ready(limits->scene->kind, limits->scene->inputs, error));
  TRY(farm_start(&farm_options, run_work, &launch->farm, error));
  const int slots = farm_slots_total(launch->farm);
  launch->manager = farm_rank(launch->farm) == 0;
  launch->notes.quiet = options->quiet;
  launch->begin_s = clock_s();
  launch->facts = provenance_json(farm_ranks(launch->farm), slots, line->argc, line->argv);
  launch->scheduler = (struct scheduler_options){.facts = launch->facts,
                                                 .note = launch_note,
                                                 .note_context = &launch->notes,
                                                 .slots = slots};
  const enum progress_style style = progress_style_of(stderr);
  const char *no_colour = getenv("NO_COLOR");
  if (launch->manager && !options->quiet)
    launch->notes.progress = launch->scheduler.progress = progress_create(stderr, style,
                                                                          style == PROGRESS_BAR &&
                                                                              !(no_colour && *no_colour),
                                                                          0);
  return launch->facts ? STATUS_OK : status_fail(error, STATUS_MEMORY, "out of memory");
}

void launch_end_progress(struct launch *launch) {
  progress_free(launch->notes.progress);
  launch->notes.progress = launch->scheduler.progress = NULL;
}

void launch_end(struct launch *launch) {
  launch_end_progress(launch);
  farm_stop(launch->farm);
  free(launch->facts);
}

int launch_slots(int64_t slots) {
  const int ranks = farm_launched() > 1 ? farm_launched() : 1;
  return ranks * (slots > 0 ? (int)slots : farm_under_mpi() ? 1 : farm_cores());
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

/* ---- From a campaign to its finished store, and the table at the end ---- */

enum { MANY_POINTS = 64 }; /* above this number the table at the end is printed only with --json or --csv */

static void print_summary(const struct driver_summary *summary, const char *store, const char *quantity, double wall_s,
                          status code) {
  launch_tell_runs(store, summary->runs_done, summary->runs_reused, summary->cpu_s, wall_s);
  fprintf(stderr, "points: %" PRIu64 " of %" PRIu64 " %s", summary->points_done, summary->points,
          summary->runs_failed ? "ended" : "complete");
  if (summary->points_interval_met || summary->points_cap_reached)
    fprintf(stderr, ": %" PRIu64 " met seeds.until, %" PRIu64 " ended at seeds.max before that",
            summary->points_interval_met, summary->points_cap_reached);
  if (summary->points_equal)
    fprintf(stderr,
            "\n%" PRIu64 " of those that met it %s runs that are all equal: tables have the bounds of what so few "
            "may have missed, which are wider than asked",
            summary->points_equal, summary->points_equal == 1 ? "has" : "have");
  fputc('\n', stderr);
  if (summary->runs_censored)
    fprintf(stderr, "%" PRId64 " run%s ended at stop.end_time: fragments may still have been breaking\n",
            summary->runs_censored, text_plural(summary->runs_censored));
  if (summary->runs_surplus)
    fprintf(stderr, "%" PRId64 " run%s beyond the stopping rule: stored, but not counted (surplus)\n",
            summary->runs_surplus, text_plural(summary->runs_surplus));
  uncertainty_excluded(summary->runs_excluded, store);
  if (summary->runs_warned)
    fprintf(stderr,
            "%" PRId64 " run%s warned, %" PRId64 " of them in doubt in %s (!); means and stopping rules count %s\n",
            summary->runs_warned, text_plural(summary->runs_warned), summary->runs_doubtful, quantity,
            summary->runs_warned == 1 ? "it" : "them");
  char word[TEXT_WORD];
  if (summary->attempts_failed)
    fprintf(stderr, "%" PRId64 " attempt%s failed: clast query %s --named failures\n", summary->attempts_failed,
            text_plural(summary->attempts_failed), text_word(store, word));
  if (code == STATUS_STOPPED)
    fputs("stopped; the same command goes on\n", stderr);
}

/* Points that ended at seeds.max before seeds.until was met. The rule asks for more runs than a narrow interval needs.
 */
static void warn_unmet(const struct campaign *campaign, const struct driver_summary *summary) {
  const double asked = campaign->until_half_width * campaign->until_scale;
  char width[UNCERTAINTY_TEXT + 96] = "is not known", runs[64] = "how many is not known";
  const uint64_t unmet = summary->points_cap_reached;
  const double reached = summary->widest_half_width * campaign->until_scale /
                         (campaign->until_of_value ? fabs(summary->widest_mean) : 1);
  if (unmet == 0)
    return;
  if (isfinite(summary->widest_half_width))
    snprintf(width, sizeof width, "is ± %.2g%s%s", reached, campaign->until_unit,
             reached > asked
                 ? ""
                 : ": narrow enough, but the rule takes more runs before it trusts one (clast explain seeds.until)");
  if (summary->widest_runs)
    snprintf(runs, sizeof runs, "about %zu", summary->widest_runs);
  words_print(stderr, "",
              "clast: warning: %" PRIu64 " of %" PRIu64 " points ended at seeds.max (%" PRId64
              " runs) before seeds.until was met (%s to ± %g%s%s). Point %" PRId64
              " needs the most runs, %s; its interval %s. Raise seeds.max, or ask for less, and the same command goes "
              "on",
              unmet, summary->points, campaign->maximum, campaign->until_quantity, asked, campaign->until_unit,
              campaign->until_of_value ? " of the mean" : "", summary->widest_point, runs, width);
}

/* Means of the campaign's main quantity. */
static status print_means(struct store *store, const char *path, const char *quantity, enum table_format format,
                          bool quiet, struct error *error) {
  struct ask_column axes[LIMITS_AXES_OF_POOL];
  size_t count;
  char by[LIMITS_AXES_OF_POOL * sizeof axes->name] = "";
  struct ask_group_pooled pooled = {.inputs = ""};
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_POOL, axes, &count, error));
  for (size_t i = 0; i < count; i++)
    text_append(by, sizeof by, "%s%s", i ? "," : "", axes[i].name);
  TRY(table_answer(ask_group(store, by, quantity, &pooled, error), true, format, stdout));
  TRY(quantity_tell_doubts(store, quantity, error));
  if (quiet)
    return STATUS_OK;
  quantity_tell_resolutions(store, quantity, &pooled);
  char word[TEXT_WORD];
  fprintf(stderr, "fragments, M_1/M and exponents: clast estimates %s\n", text_word(path, word));
  return STATUS_OK;
}

/* The promise of `accuracy: {quantity, within}` came from a study; this is what the runs say. */
static status tell_accuracy(struct store *store, const struct campaign *campaign, struct error *error) {
  enum exponent_method method;
  enum estimates_window window;
  bool exponent, of_outcome;
  struct error ignored;
  if (field_is_off(campaign->accuracy_within) && field_is_off(campaign->accuracy_time))
    return STATUS_OK;
  TRY(estimates_named(campaign->accuracy_quantity, &exponent, &method, &window, error));
  if (exponent)
    return STATUS_OK;
  const struct field *row = campaign_quantity(campaign->scene->kind, campaign->accuracy_quantity, &of_outcome,
                                              &ignored);
  return quantity_tell_accuracy(store, campaign->accuracy_quantity, row ? field_shown_unit(row) : "",
                                campaign->accuracy_within, campaign->accuracy_of_value, error);
}

/* Reads the store again, so that it prints what any later reader will find. */
static status print_answers(const char *path, const struct campaign *document, int64_t campaign,
                            enum table_format format, bool quiet, struct error *error) {
  const char *quantity = document->quantity;
  STORE store = NULL;
  int64_t points = 0, missing, wanted;
  char number[24], word[TEXT_WORD];
  snprintf(number, sizeof number, "%" PRId64, campaign);
  TRY(store_open_reader(path, &store, error));
  TRY(ask_choose(store, &(struct ask_choice){.campaign = number}, error));
  TRY(ask_points_count(store, &points, error));
  TRY(ask_run_missing(store, &missing, &wanted, error));
  uncertainty_missing(missing, wanted, path);
  if (!table_for_people(format)) {
    TRY(print_estimates(store, format, !quiet, error));
    return quiet ? STATUS_OK : tell_accuracy(store, document, error);
  }
  if (quiet && format == TABLE_TEXT)
    format = TABLE_BARE;
  if (points > MANY_POINTS)
    fprintf(stderr, "estimates of %" PRId64 " points: clast estimates %s --campaign %" PRId64 "\n", points,
            text_word(path, word), campaign);
  else if (strcmp(quantity, OUTCOME_DEFAULT) != 0 && strncmp(quantity, "beta", 4) != 0)
    TRY(print_means(store, path, quantity, format, quiet, error));
  else
    TRY(print_estimates(store, format, !quiet, error));
  if (quiet)
    return STATUS_OK;
  TRY(tell_accuracy(store, document, error));
  return quantity_tell_idle(store, error);
}

status launch_campaign(const struct campaign *campaign, const char *store, const struct launch_options *options,
                       enum table_format format, const struct command_line *line, struct error *error) {
  LAUNCH launch = {0};
  TRY(launch_begin(&launch, campaign, options, line, error));
  const bool quiet = options->quiet;
  struct driver_summary summary = {0};
  launch.scheduler.store_path = store;
  const status code = driver_run(campaign, launch.farm, &launch.scheduler, &summary, error);
  const double wall_s = clock_s() - launch.begin_s;
  launch_end_progress(&launch);
  if (!launch.manager)
    return code;

  const bool done = code == STATUS_OK || code == STATUS_FAILED_RUNS;
  if ((done || code == STATUS_STOPPED) && !quiet)
    print_summary(&summary, store, campaign->quantity, wall_s, code);
  if (!done)
    return code;
  warn_unmet(campaign, &summary);
  const status printed = print_answers(store, campaign, summary.campaign_id, format, quiet, code ? NULL : error);
  return printed ? printed : code;
}
