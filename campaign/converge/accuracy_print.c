/* What is chosen, the table of alternatives, and why nothing is chosen. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy_finding.h"
#include "campaign/terminal/words.h"
#include "schemas/memory.h"

/* "particles = 40000", "stop = 0.0012 s", "the scene's own settings". */
static void name_option(const struct campaign *campaign, const struct accuracy_option *option, char *text,
                        size_t size) {
  char setting[STUDY_SETTING];
  study_show_setting(campaign->scene->kind, accuracy_knob(campaign, option->knob), option->setting, setting);
  if (option->own)
    snprintf(text, size, "the scene's own settings");
  else
    snprintf(text, size, "%s = %s", option->knob, setting);
}

/* "0.02 m/s", "5 % of its mean". Returns text. */
static const char *show_width(const struct campaign *campaign, char *text, size_t size) {
  char unit[CAMPAIGN_UNIT];
  const bool share = campaign->accuracy_of_value;
  snprintf(text, size, "%.3g%s", campaign->accuracy_within * (share ? 100 : 1),
           share ? " % of its mean" : campaign_unit(campaign, campaign->accuracy_quantity, unit));
  return text;
}

/* No option can be run often enough in the time. */
static status too_short(const struct accuracy *accuracy, const struct campaign *campaign, struct error *error) {
  double least = HUGE_VAL;
  for (size_t i = 0; i < accuracy->count; i++)
    least = fmin(least,
                 ACCURACY_FEWEST_SEEDS * accuracy->options[i].run_s * campaign->accuracy_time / accuracy->point_s);
  char given[32], needed[32];
  progress_duration(campaign->accuracy_time, given, sizeof given);
  progress_duration(least, needed, sizeof needed);
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s of processor time is too short: the cheapest studied settings and %d seeds for each "
                     "of the %.0f points need %s. Allow more time, or take fewer points",
                     given, ACCURACY_FEWEST_SEEDS, campaign->accuracy_time / accuracy->point_s, needed);
}

/* No level reaches the accuracy: what would. */
static status out_of_reach(const struct accuracy *accuracy, const struct campaign *campaign, struct error *error) {
  const struct accuracy_option *best = &accuracy->options[accuracy->reference];
  const char *quantity = campaign->accuracy_quantity, *path = accuracy->path;
  const double least = accuracy_resolution(best);
  char width[64], share[64] = "", chosen[256], smallest[1200], text[CAMPAIGN_UNIT];
  const char *unit = campaign_unit(campaign, campaign->accuracy_quantity, text);
  name_option(campaign, best, chosen, sizeof chosen);
  if (campaign->accuracy_of_value)
    snprintf(share, sizeof share, best->mean == 0 ? " (no share of a mean of 0 allows an error)" : " (%s)",
             text_percent(least / fabs(best->mean), (char[TEXT_PERCENT]){0}));
  const bool a_guess = best->open && least <= best->within; /* what lies beyond the finest level is not known */
  snprintf(smallest, sizeof smallest,
           "The smallest error is %s%.2g%s%s%s, with %s%s mean is %.4g%s (%" PRId64 " seeds)",
           best->open ? "about " : "", least, unit, share,
           a_guess      ? " (a guess: no limit is seen, so that it may be much larger)"
           : best->open ? " (a guess, as no limit is seen)"
                        : "",
           chosen, best->extrapolated ? ", finer than any level of the study: the finest one's" : ", whose", best->mean,
           unit, best->n);
  if (best->open && !(least > 0))
    snprintf(smallest, sizeof smallest,
             "No run of the study differs between the settings, which does not tell how far "
             "other runs may be");
  text_append(smallest, sizeof smallest, *accuracy->marked ? ". Levels whose runs are in doubt do not count: %s" : "%s",
              accuracy->marked);
  return status_fail(
      error, STATUS_CONTENT,
      "accuracy: %s%s%sno setting %s %s within %s. %s. %s. You can allow more, or ask for the least error in a time: "
      "`clast plan %s --within 10min`",
      *accuracy->place ? "by the study of " : "", accuracy->place, *accuracy->place ? ", " : "",
      a_guess ? "is known to give" : "gives", quantity, show_width(campaign, width, sizeof width), smallest,
      accuracy->advice, path);
}

status accuracy_apply(const struct accuracy *accuracy, struct campaign *campaign, struct error *error) {
  if (accuracy->chosen == accuracy->count && !isnan(accuracy->point_s))
    return too_short(accuracy, campaign, error);
  if (accuracy->chosen == accuracy->count)
    return out_of_reach(accuracy, campaign, error);
  const struct accuracy_option *option = &accuracy->options[accuracy->chosen];
  campaign->per_point = option->seeds;
  if (option->own)
    return STATUS_OK;
  const struct knob *knob = accuracy_knob(campaign, option->knob);
  return knob ? ladder_turn(knob, campaign->scene, option->setting, error) : STATUS_INTERNAL;
}

/* ---- the table of settings and seeds that reach an accuracy ---- */

/* People see as many digits as they need. */
static double rounded(bool people, int digits, double number) {
  char text[40];
  snprintf(text, sizeof text, "%.*g", digits, number);
  return people ? strtod(text, NULL) : number;
}

/* One row per way to run the campaign: cost of a point against that of the most accurate one. */
static status print_alternatives(const struct accuracy *accuracy, const struct campaign *campaign,
                                 enum table_format format, FILE *out, struct error *error) {
  const struct accuracy_option *reference = &accuracy->options[accuracy->reference];
  const bool people = table_for_people(format);
  bool guessed = !people; /* people see the guesses if there are any */
  for (size_t i = 0; i < accuracy->count; i++)
    guessed |= accuracy->options[i].beyond > 0;
  char unit_text[CAMPAIGN_UNIT];
  const char *unit = campaign_unit(campaign, campaign->accuracy_quantity, unit_text) + (*unit_text == ' ');
  TABLE table = table_new(format, out);
  table_columns(table, (const char *const[]){"choice", "knob", "setting", NULL});
  table_column(table, "mean", unit);
  if (campaign->accuracy_of_value)
    table_column(table, "within", unit);
  table_column(table, "error", unit);
  if (guessed)
    table_column(table, "beyond", unit);
  table_column(table, "seeds", NULL);
  table_column(table, "total", unit);
  table_column(table, "run_cpu", "s");
  table_column(table, "known", NULL);
  table_column(table, "point_cpu", "s");
  table_column(table, "run_cost", NULL);
  for (size_t i = 0; i < accuracy->count; i++) {
    const struct accuracy_option *option = &accuracy->options[i];
    char setting[STUDY_SETTING], text[UNCERTAINTY_TEXT];
    const struct knob *knob = people ? accuracy_knob(campaign, option->knob) : NULL;
    study_show_setting(campaign->scene->kind, knob, option->setting, setting);
    table_text(table, i == accuracy->chosen ? "chosen" : "");
    table_text(table, option->own ? "" : option->knob);
    table_text(table, option->own ? "the scene's own" : setting);
    table_real(table, rounded(people, 3, option->mean));
    if (campaign->accuracy_of_value)
      table_real(table, rounded(people, 2, option->within));
    if (people)
      table_text(table, study_show_error(option->error, option->open, text));
    else
      table_real(table, option->error);
    if (guessed)
      table_real(table, rounded(people, 2, option->beyond));
    if (option->seeds)
      table_integer(table, option->seeds);
    else
      table_missing(table);
    table_real(table, rounded(people, 2, option->total));
    table_real(table, rounded(people, 3, option->run_s));
    table_text(table, option->open           ? option->error > 0 ? "at least" : "none seen"
                      : option->extrapolated ? "extrapolated"
                                             : "yes");
    table_real(table, rounded(people, 3, option->cpu_s));
    table_real(table, rounded(people, 3, option->run_s / reference->run_s));
  }
  return table_end(table, error);
}

/* The knobs whose parts the error has, or those of them without a limit: "grains, time_step". Returns text. */
static const char *name_knobs(const struct accuracy_option *option, bool without_limit, char *text, size_t size) {
  *text = '\0';
  for (size_t k = 0; k < option->part_count; k++)
    if (without_limit ? option->part[k].beyond > 0 : !isnan(option->part[k].error))
      text_append(text, size, "%s%s", *text ? ", " : "", option->part[k].knob->name);
  return text;
}

/* The knobs of resolution that have levels in the scene and no part in the error: "grains, stop". Returns text. */
static const char *name_unstudied(const struct campaign *campaign, const struct accuracy_option *option, char *text,
                                  size_t size) {
  *text = '\0';
  for (const struct knob *knob = campaign->scene->kind->knobs; knob && knob->name; knob++) {
    bool has = knob->group != KNOB_RESOLUTION || accuracy_is_varied(campaign, knob, "");
    for (size_t k = 0; k < option->part_count; k++)
      has |= option->part[k].knob == knob;
    struct ladder levels;
    struct error ignored;
    OWNED char *notes = NULL;
    if (has || ladder_make(knob, campaign->scene, NULL, &levels, &notes, &ignored) != STATUS_OK)
      continue;
    ladder_clear(&levels);
    text_append(text, size, "%s%s", *text ? ", " : "", knob->name);
  }
  return text;
}

/* "+- 0.05 or more". Returns text. */
static const char *show_least(const struct accuracy *accuracy, double point_s, const char *unit, char *text,
                              size_t size) {
  bool open;
  const double least = accuracy_least(accuracy, point_s, &open);
  snprintf(text, size, "no result");
  if (!isnan(least))
    snprintf(text, size, "\xc2\xb1 %.2g%s%s", least, unit, open ? " or more" : "");
  return text;
}

/* What is chosen, which error it gives, and for a time what half and twice of it would give. `timed`: with the time by
 * the runs of the study; `plan` predicts it below by its own. */
static void print_choice(const struct accuracy *accuracy, const struct campaign *campaign, const char *before,
                         bool timed, FILE *out) {
  if (accuracy->chosen == accuracy->count)
    return;
  const struct accuracy_option *option = &accuracy->options[accuracy->chosen];
  const bool in_time = !isnan(accuracy->point_s);
  char time[32], allowed[32], chosen[256], cost[120] = "", share[64] = "", text[CAMPAIGN_UNIT], knobs[256];
  char beyond[64] = "", resolution[UNCERTAINTY_TEXT];
  const char *unit = campaign_unit(campaign, campaign->accuracy_quantity, text);
  name_option(campaign, option, chosen, sizeof chosen);
  if (option->beyond > 0)
    words_print(out, before,
                "no limit is seen in %s: total adds what a law of order %g would leave beyond the finest level, which "
                "is a guess and no bound",
                name_knobs(option, true, knobs, sizeof knobs), LIMIT_ORDER_LEAST);
  if (*option->marks)
    words_print(out, before, "the results of this choice are in doubt (!), %s (`clast explain` and the word)",
                option->marks);
  if (option->total >= accuracy_most(option->share, option->mean))
    words_print(out, before,
                "Such an error says nothing of a share with the mean %.2g: no setting of the study is "
                "near enough%s",
                option->mean, in_time ? " in this time" : "");
  progress_duration(option->cpu_s * (in_time ? campaign->accuracy_time / accuracy->point_s : 1), time, sizeof time);
  progress_duration(campaign->accuracy_time, allowed, sizeof allowed);
  if (timed)
    snprintf(cost, sizeof cost, ": %s of processor time", time);
  if (in_time)
    text_append(cost, sizeof cost, timed ? " (%s allowed)" : " (%s of processor time allowed)", allowed);
  const char *more = isnan(option->beyond) ? " or more" : "";
  if (campaign->accuracy_of_value)
    snprintf(share, sizeof share, " (%s of its mean %.3g%s)",
             text_percent(option->total / fabs(option->mean), (char[TEXT_PERCENT]){0}), option->mean, unit);
  if (option->beyond > 0)
    snprintf(beyond, sizeof beyond, ", %.2g%s beyond the levels", option->beyond, unit);
  words_print(out, before,
              "%s%s%s \xc2\xb1 %.2g%s%s%s, resolution %s%s (%s)%s and the rest seeds, with %s and %" PRId64
              " seeds a point%s",
              accuracy->place, *accuracy->place ? ": " : "", campaign->accuracy_quantity, option->total, unit, more,
              share, study_show_error(option->error, option->open, resolution), unit,
              name_knobs(option, false, knobs, sizeof knobs), beyond, chosen, option->seeds, cost);
  if (option->deviation >= 0 && !(option->deviation > SAMPLE_ROUNDING * fabs(option->mean)))
    words_print(out, before, "all %" PRId64 " seeds of the study are equal with it: %s", option->n,
                option->share ? "the error holds that so many may miss a rare outcome" : "more of them tell no more");
  if (*name_unstudied(campaign, option, knobs, sizeof knobs))
    words_print(out, before, "not studied, and not in this error: %s", knobs);
  if (option->n < ACCURACY_FEW_RUNS && 2 * option->total - accuracy_resolution(option) > option->within)
    words_print(out, before,
                "the scatter is that of %" PRId64 " runs only: after the campaign the same command counts its runs, "
                "too, and takes more seeds if they are needed",
                option->n);
  if (*accuracy->place && accuracy->some_studied)
    words_print(
        out, before,
        "other points have errors and means of their own, which may be wider; the table at the end of the run has "
        "`?` for the error of a point that no study has");
  if (*accuracy->widest_point)
    words_print(out, before, "%s", accuracy->widest_point);
  if (!in_time)
    return;
  char in_half[96], in_twice[96];
  words_print(out, before, "In half of the time: %s; in twice: %s",
              show_least(accuracy, accuracy->point_s / 2, unit, in_half, sizeof in_half),
              show_least(accuracy, accuracy->point_s * 2, unit, in_twice, sizeof in_twice));
}

static status alternatives_json(const struct accuracy *accuracy, const struct campaign *campaign, char **json,
                                struct error *error) {
  FILE *out = text_open(json);
  const status code = print_alternatives(accuracy, campaign, TABLE_JSON, out, error);
  if (code == STATUS_OK && !isnan(accuracy->point_s)) {
    static const struct {
      const char *name;
      double factor;
    } times[] = {{"error_in_half_the_time", 0.5}, {"error_in_the_time", 1}, {"error_in_twice_the_time", 2}};
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++) {
      bool open; /* column `known` tells it of each option */
      const double error_then = times[i].factor == 1 && accuracy->chosen < accuracy->count
                                    ? accuracy->options[accuracy->chosen].total
                                    : accuracy_least(accuracy, times[i].factor * accuracy->point_s, &open);
      fprintf(out, isnan(error_then) ? ", \"%s\": null" : ", \"%s\": %.17g", times[i].name, error_then);
    }
  }
  if (!text_close(out, json) && code == STATUS_OK)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  return code;
}

status accuracy_settle(struct campaign *campaign, const char *path, const char *store, enum accuracy_print print,
                       char **json, struct error *error) {
  __attribute__((cleanup(accuracy_clear))) struct accuracy accuracy = {0};
  if (field_is_off(campaign->accuracy_within) && field_is_off(campaign->accuracy_time))
    return STATUS_OK;
  TRY(accuracy_find(campaign, path, store, &accuracy, error));
  if (print == ACCURACY_JSON)
    TRY(alternatives_json(&accuracy, campaign, json, error));
  if (print == ACCURACY_NOTE)
    print_choice(&accuracy, campaign, "clast: ", true, stderr);
  if (print == ACCURACY_TEXT || print == ACCURACY_ALL) {
    char width[64];
    if (isnan(accuracy.point_s))
      words_print(stdout, "accuracy  ", "%s within %s%s", campaign->accuracy_quantity,
                  show_width(campaign, width, sizeof width),
                  campaign->accuracy_of_value ? ": each setting by its own mean, column within" : "");
    print_choice(&accuracy, campaign, "accuracy  ", false, stdout);
    TRY(print_alternatives(&accuracy, campaign, print == ACCURACY_ALL ? TABLE_ALL : TABLE_BARE, stdout, error));
    words_print(
        stdout, "",
        "error: how far finer settings may move it. total: with the 95 %% interval over seeds. run_cpu, "
        "point_cpu: by the runs of the study, mean over the points. run_cost: against the smallest error. `clast plan "
        "--all` has every column");
    bool borrowed = false;
    for (size_t i = 0; i < accuracy.count; i++)
      borrowed |= accuracy.options[i].borrowed;
    if (borrowed)
      words_print(stdout, "",
                  "A setting finer than any level of the study has no runs here: its mean and scatter are those of the "
                  "finest level.");
    if (*accuracy.marked && accuracy.chosen < accuracy.count)
      words_print(stdout, "", "Left out, as their runs are in doubt (!) by a word that few of the scene's own have: %s",
                  accuracy.marked);
    if (accuracy.chosen < accuracy.count && accuracy.options[accuracy.chosen].extrapolated)
      words_print(
          stdout, "",
          "The chosen setting is finer than any level of the study. The part of its knob in the error is that of the "
          "finest level times (its step over that step)^%g, and its cost is by the engine's measure of work.",
          LIMIT_ORDER_LEAST);
    putchar('\n');
  }
  return accuracy_apply(&accuracy, campaign, error);
}
