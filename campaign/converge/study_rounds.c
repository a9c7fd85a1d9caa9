/* The rounds of a study as a series of campaigns: chooses the next levels and numbers of seeds. Runs a study from its
 * farm to its tables. */
#include <math.h>
#include <string.h>

#include "campaign/converge/study.h"
#include "campaign/terminal/words.h"
#include "schemas/clock.h"
#include "schemas/memory.h"

struct rounds {
  struct study *study;
  double begin;
  int slots;
  bool begun, quiet, told;
  double seconds, work; /* sums over the levels that have run: their ratio predicts the other levels */

  /* The round under way. */
  struct study_ladder *ladder;
  int64_t seeds;
  bool probe; /* runs one seed of the cheapest level, because nothing has run yet */
};

static double work_of(const struct scene *scene) {
  return scene->kind->work ? scene->kind->work(scene->inputs) : 1;
}

/* Wall time of a run of the level, s: measured, or estimated by the engine's measure of work from other levels of the
 * ladder or from other ladders. NaN: nothing has run. */
static double predict(const struct rounds *rounds, const struct study_ladder *ladder, size_t level) {
  if (!isnan(ladder->wall[level]))
    return ladder->wall[level];
  double seconds = 0, work = 0;
  for (size_t l = 0; l < ladder->levels.count; l++)
    if (!isnan(ladder->wall[l])) {
      seconds += ladder->wall[l];
      work += work_of(ladder->levels.level[l].scene);
    }
  const double rate = work > 0 ? seconds / work : rounds->seconds / rounds->work;
  return rate * work_of(ladder->levels.level[level].scene);
}

static double seconds_left(const struct rounds *rounds) {
  return rounds->study->rule.seconds - (clock_s() - rounds->begin);
}

/* True when every bias of every quantity is known to the wanted width. */
static bool is_narrow(const struct study *study, const struct study_ladder *ladder) {
  if (isnan(study->rule.within))
    return true;
  struct study_found found;
  for (size_t q = 0; q < study->quantity_count; q++) {
    study_find(study, ladder, q, &found);
    const bool needs_all = !study->quantity[q].row; /* an exponent: more seeds may give a level one */
    const double scale = study->rule.relative ? fabs(found.rows[study_reference(ladder)].mean) : 1;
    for (size_t l = 0; l < found.count; l++)
      if (!ladder->left_out[l] && (needs_all || found.rows[l].n > 0) &&
          !(found.rows[l].bias_half_width <= study->rule.within * scale))
        return false;
  }
  return true;
}

/* Has some quantity two levels with results? An exponent may need more seeds. */
static bool compares(const struct study *study, const struct study_ladder *ladder) {
  struct study_found found;
  for (size_t q = 0; q < study->quantity_count; q++) {
    int levels = 0;
    study_find(study, ladder, q, &found);
    for (size_t l = 0; l < found.count; l++)
      levels += found.rows[l].n > 0;
    if (levels > 1 || !study->quantity[q].row)
      return true;
  }
  return false;
}

/* Wall time (s) on one slot of the missing runs among the level's first `seeds` seeds. */
static double cost_of(const struct rounds *rounds, const struct study_ladder *ladder, size_t level, int64_t seeds) {
  int64_t missing = 0;
  for (int64_t s = 0; s < seeds; s++)
    missing += !ladder->ran[level][s];
  return missing ? (double)missing * predict(rounds, ladder, level) : 0;
}

static double wall_time(const struct rounds *rounds, const struct study_ladder *ladder, int64_t seeds) {
  double seconds = 0;
  for (size_t l = 0; l < ladder->levels.count; l++)
    seconds += ladder->left_out[l] ? 0 : cost_of(rounds, ladder, l, seeds);
  return seconds / fmax(1, rounds->slots);
}

/* Leaves out the most expensive levels until the first round fits into the time. Levels whose runs exist cost nothing
 * and stay; so does the scene's own level, `own`, as long as another one can go. Returns the number of levels that
 * remain. */
static size_t fit_levels(const struct rounds *rounds, struct study_ladder *ladder, int64_t seeds, double seconds,
                         bool own) {
  size_t count = 0;
  for (size_t l = 0; l < ladder->levels.count; l++) {
    ladder->left_out[l] = ladder->levels.level[l].unasked;
    count += !ladder->left_out[l];
  }
  for (; wall_time(rounds, ladder, seeds) > seconds; count--) {
    size_t worst = 0;
    double most = 0;
    for (size_t l = 0; l < ladder->levels.count; l++) {
      const bool stays = ladder->left_out[l] || (own && ladder->levels.level[l].base && count > 1);
      const double cost = stays ? 0 : cost_of(rounds, ladder, l, seeds);
      if (cost > most) {
        worst = l;
        most = cost;
      }
    }
    ladder->left_out[worst] = true;
  }
  return count;
}

/* The first round of a ladder. All that wait for theirs have equal shares of the time left; a knob of resolution may
 * take half of it for the three levels that a law needs, as the error rests on it. A ladder that needs more waits until
 * the others have had their round; then it may take all that is left, and go without the scene's own level, whose error
 * follows from the law of the others. */
static bool begin_ladder(const struct rounds *rounds, struct study_ladder *ladder, int64_t seeds) {
  const double left = fmax(0, seconds_left(rounds));
  size_t waiting = 0;
  for (size_t i = 0; i < rounds->study->ladder_count; i++)
    waiting += rounds->study->ladder[i].seeds == 0 && !rounds->study->ladder[i].done;
  size_t count = fit_levels(rounds, ladder, seeds, left / (double)waiting, true);
  if (count < 3 && ladder->levels.knob->group == KNOB_RESOLUTION && waiting > 1)
    count = fit_levels(rounds, ladder, seeds, left / 2, true);
  if (count < 2 && ladder->waits)
    count = fit_levels(rounds, ladder, seeds, left, true);
  if (count < 2 && ladder->waits)
    count = fit_levels(rounds, ladder, seeds, left, false);
  return count >= 2;
}

/* The scene's own level that was not asked for is a level like the others if the store has its runs all the same. */
static void end_ladder(struct study_ladder *ladder, const char *why) {
  for (size_t l = 0; l < ladder->levels.count; l++) {
    int64_t ran = 0;
    for (int64_t s = 0; s < ladder->seeds; s++)
      ran += ladder->ran[l][s];
    if (ladder->levels.level[l].unasked && ran > 0 && ran == ladder->seeds)
      ladder->left_out[l] = false;
  }
  ladder->done = true;
  ladder->end = why;
}

static void end_by_time(const struct rounds *rounds, struct study_ladder *ladder) {
  end_ladder(ladder, rounds->study->budget_spent ? "the time given is spent" : "more does not fit into the time given");
}

/* Next number of seeds of the ladder. 0: the ladder is done, or waits. */
static int64_t next_seeds(const struct rounds *rounds, struct study_ladder *ladder) {
  const struct study_rule *rule = &rounds->study->rule;
  if (ladder->seeds == 0) {
    if (begin_ladder(rounds, ladder, rule->first_seeds))
      return rule->first_seeds;
    if (ladder->waits)
      end_by_time(rounds, ladder);
    ladder->waits = true;
    return 0;
  }
  int64_t seeds = 2 * ladder->seeds < rule->most_seeds ? 2 * ladder->seeds : rule->most_seeds;
  while (seeds > ladder->seeds && wall_time(rounds, ladder, seeds) > seconds_left(rounds))
    seeds--;
  if (seeds > ladder->seeds)
    return seeds;
  end_by_time(rounds, ladder);
  return 0;
}

static int64_t turn_of(const struct study_ladder *ladder) {
  return ladder->seeds == 0 ? ladder->waits : 1 + ladder->seeds;
}

/* The ladder with the fewest seeds that is not done, and its next number of seeds. One that waits comes after those
 * that begin. NULL: all are done. */
static struct study_ladder *choose_ladder(struct rounds *rounds) {
  for (;;) {
    struct study_ladder *next = NULL;
    for (size_t i = 0; i < rounds->study->ladder_count; i++) {
      struct study_ladder *ladder = &rounds->study->ladder[i];
      if (!ladder->done && (!next || turn_of(ladder) < turn_of(next)))
        next = ladder;
    }
    if (!next)
      return NULL;
    rounds->probe = isnan(predict(rounds, next, 0));
    if (rounds->probe && rounds->study->budget_spent)
      end_by_time(rounds, next); /* no time to find out what a run takes */
    else if (rounds->probe)
      rounds->seeds = 1;
    else
      rounds->seeds = next_seeds(rounds, next);
    if (rounds->seeds > 0 && !next->done)
      return next;
  }
}

/* ---- a round as a campaign ---- */

/* True when some level gives the input another value than the base scene, or keeps the value that follows from others
 * there. False for an input without effect. */
static bool is_turned(const struct study_ladder *ladder, size_t input) {
  const struct scene *base = ladder->base;
  const struct field *row = &base->kind->inputs->rows[input];
  struct field_value own, other;
  if (!field_is_active(base->kind->inputs, row, base->inputs))
    return false;
  field_get(row, base->inputs, &own);
  for (size_t l = 0; l < ladder->levels.count; l++) {
    const struct scene *scene = ladder->levels.level[l].scene;
    field_get(row, scene->inputs, &other);
    if (scene->given[input] && !(base->given[input] && field_same_value(row, &own, &other)))
      return true;
  }
  return false;
}

/* A list of the levels: axes are the inputs that the knob sets, and their i-th values are the i-th level. */
static status make_campaign(const struct rounds *rounds, struct campaign **out, struct error *error) {
  const struct study *study = rounds->study;
  const struct ladder *levels = &rounds->ladder->levels;
  const struct scene *base = rounds->ladder->base;
  const struct field_table *inputs = base->kind->inputs;
  const struct ladder_level *level[KNOB_LEVELS];
  size_t axes = 0, points = 0, cheapest = levels->level[0].unasked;
  for (size_t l = cheapest + 1; l < levels->count; l++)
    if (!levels->level[l].unasked && work_of(levels->level[l].scene) < work_of(levels->level[cheapest].scene))
      cheapest = l;
  for (size_t l = 0; l < levels->count; l++)
    if (rounds->probe ? l == cheapest : !rounds->ladder->left_out[l])
      level[points++] = &levels->level[l];
  for (size_t i = 0; i < inputs->count; i++)
    axes += is_turned(rounds->ladder, i);
  TRY(driver_list_begin(&study->limits, base, axes, points, out, error));
  struct design_axis *axis = (*out)->axes;
  for (size_t i = 0; i < inputs->count; i++) {
    if (!is_turned(rounds->ladder, i))
      continue;
    axis->row = &inputs->rows[i];
    for (size_t l = 0; l < points; l++)
      field_get(axis->row, level[l]->scene->inputs, &axis->levels[l]);
    axis++;
  }
  struct campaign *campaign = *out;
  const char *knob = levels->knob->name;
  const struct field *row = study->quantity[0].row;
  char comment[128];
  campaign->per_point = rounds->seeds;
  snprintf(campaign->quantity, sizeof campaign->quantity, "%s", row ? row->path : OUTCOME_DEFAULT);
  snprintf(campaign->name, sizeof campaign->name, "%.200s %s", study->limits.name, knob);
  snprintf(comment, sizeof comment, "Written by clast converge: levels of %s.", knob);
  return driver_list_end(campaign, study->scene_reference, comment, error);
}

/* ---- the series ---- */

static void learn(struct rounds *rounds) {
  rounds->seconds = rounds->work = 0;
  for (size_t i = 0; i < rounds->study->ladder_count; i++)
    for (size_t l = 0; l < rounds->study->ladder[i].levels.count; l++) {
      const struct study_ladder *ladder = &rounds->study->ladder[i];
      if (isnan(ladder->wall[l]))
        continue;
      rounds->seconds += ladder->wall[l];
      rounds->work += work_of(ladder->levels.level[l].scene);
    }
}

static void judge(struct rounds *rounds) {
  struct study *study = rounds->study;
  struct study_ladder *ladder = rounds->ladder;
  if (rounds->probe)
    return;
  ladder->narrow = is_narrow(study, ladder);
  if (!isnan(study->rule.within) && !compares(study, ladder))
    end_ladder(ladder, "no two levels have results");
  else if (ladder->narrow)
    end_ladder(ladder,
               isnan(study->rule.within) ? "one round was asked for" : "every bias is known to the wanted width");
  else if (study->budget_spent)
    end_by_time(rounds, ladder);
  else if (ladder->seeds >= study->rule.most_seeds)
    end_ladder(ladder, "the largest number of seeds has run");
}

/* Runs that the first seeds of all levels lack. *seconds: their wall time. All knobs of a point share its own level. */
static int64_t count_missing(const struct rounds *rounds, int64_t seeds, double *seconds) {
  const struct study *study = rounds->study;
  int64_t runs = 0;
  *seconds = 0;
  for (size_t i = 0; i < study->ladder_count; i++) {
    const struct study_ladder *ladder = &study->ladder[i];
    const bool new_point = i == 0 || ladder->base != study->ladder[i - 1].base;
    for (size_t l = 0; l < ladder->levels.count; l++)
      if (!ladder->left_out[l] && (new_point || !ladder->levels.level[l].base)) {
        for (int64_t s = 0; s < seeds; s++)
          runs += !ladder->ran[l][s];
        *seconds += cost_of(rounds, ladder, l, seeds) / fmax(1, rounds->slots);
      }
  }
  return runs;
}

/* How much there is to do at least and at most, as soon as a run has told how long one takes. */
static void tell_size(struct rounds *rounds) {
  const struct study *study = rounds->study;
  const struct study_rule *rule = &study->rule;
  size_t points = 0, knobs = 0;
  double seconds, all_s;
  for (size_t i = 0; i < study->ladder_count; i++) {
    points += i == 0 || study->ladder[i].base != study->ladder[i - 1].base;
    knobs += points == 1; /* every point has the same */
  }
  const int64_t runs = count_missing(rounds, rule->first_seeds, &seconds),
                all = count_missing(rounds, isnan(rule->within) ? rule->first_seeds : rule->most_seeds, &all_s);
  rounds->told |= !isnan(seconds);
  if (!rounds->told || rounds->quiet || all == 0)
    return;
  char time[32], all_time[32], most[64] = "";
  progress_duration(seconds, time, sizeof time);
  progress_duration(all_s, all_time, sizeof all_time);
  if (isfinite(rule->seconds))
    snprintf(most, sizeof most, "; it ends after %.4g s (--seconds)", rule->seconds);
  if (runs > 0)
    fprintf(stderr, "clast: %zu %s, %zu %s: the first %lld seeds of all levels take %lld more runs, about %s%s\n",
            points, points == 1 ? "point" : "points", knobs,
            points == 1 ? (knobs == 1 ? "knob" : "knobs") : (knobs == 1 ? "knob each" : "knobs each"),
            (long long)rule->first_seeds, (long long)runs, time, most);
  if (all > runs)
    fprintf(stderr, "clast: %smore seeds until every bias is narrow (--within): at most %lld runs, about %s\n",
            runs > 0 ? "then " : "", (long long)all, all_time);
}

/* Tells whether the study takes the place of an earlier one of the same knob that has more seeds. */
static status tell_replaced(const struct rounds *rounds, struct store *store, struct error *error) {
  const struct study *study = rounds->study;
  for (size_t i = 0; !rounds->quiet && i < study->ladder_count; i++) {
    const struct study_ladder *ladder = &study->ladder[i];
    const char *knob = ladder->levels.knob->name;
    int64_t before = 0;
    ANSWER levels = ask_convergence_levels(store, ladder->base_point, ladder->base->kind->results_version,
                                           study->quantity[0].column, false, error);
    for (struct convergence_row row; ask_convergence_next(&levels, &row);)
      if (strcmp(row.knob, knob) == 0 && row.n > before)
        before = row.n;
    TRY(answer_end(&levels));
    if (before <= ladder->seeds || ladder->seeds == 0)
      continue;
    struct study_found found;
    bool smaller;
    study_find(study, ladder, 0, &found);
    TRY(study_is_smaller(ladder, &found, store, &smaller, error));
    fprintf(stderr,
            "clast: the study of %s in this store has %lld seeds, this one %lld%s. --seeds %lld studies with as many\n",
            knob, (long long)before, (long long)ladder->seeds,
            smaller ? " and no other level: the store keeps that one" : ", but another level: it takes its place",
            (long long)before);
  }
  return STATUS_OK;
}

static status next_round(void *context, const struct scheduler *scheduler, struct campaign **campaign,
                         struct error *error) {
  struct rounds *rounds = context;
  struct study *study = rounds->study;
  rounds->slots = scheduler->options.slots;
  for (size_t i = 0; !rounds->begun && i < study->varied_count; i++) /* of the studied campaign, for --by */
    TRY(store_add_axis(scheduler->store, study->varied[i].row, study->varied[i].unit, error));
  for (size_t i = 0; !rounds->begun && i < study->ladder_count; i++)
    TRY(study_read(study, &study->ladder[i], scheduler->store, error));
  if (!rounds->begun)
    learn(rounds);
  rounds->begun = true;
  if (!rounds->told)
    tell_size(rounds);
  study->budget_spent |= seconds_left(rounds) < 0;
  rounds->ladder = choose_ladder(rounds);
  if (!rounds->ladder) {
    for (size_t i = 0; i < study->ladder_count; i++) /* knobs share their own level */
      TRY(study_read(study, &study->ladder[i], scheduler->store, error));
    TRY(tell_replaced(rounds, scheduler->store, error));
    return study_store(study, scheduler->store, error);
  }
  return make_campaign(rounds, campaign, error);
}

static const char no_result[] = "its first run ended without a result";

static status end_round(void *context, const struct scheduler *scheduler, struct error *error) {
  struct rounds *rounds = context;
  if (!rounds->probe)
    rounds->ladder->seeds = rounds->seeds;
  TRY(study_read(rounds->study, rounds->ladder, scheduler->store, error));
  learn(rounds);
  judge(rounds);
  if (rounds->probe && isnan(predict(rounds, rounds->ladder, 0)) && !rounds->study->budget_spent)
    end_ladder(rounds->ladder, no_result);
  return STATUS_OK;
}

static bool is_enough(void *context) {
  struct rounds *rounds = context;
  rounds->study->budget_spent |= seconds_left(rounds) < 0;
  return rounds->study->budget_spent;
}

/* ---- from the farm to the tables ---- */

static status run_study(struct study *study, const struct study_request *request, const struct command_line *line,
                        struct error *error) {
  LAUNCH launch = {0};
  TRY(launch_begin(&launch, &study->limits, &request->launch, line, error));
  struct rounds rounds = {.study = study, .begin = clock_s(), .quiet = request->launch.quiet};
  const struct series series = {.context = &rounds,
                                .limits = &study->limits,
                                .next = next_round,
                                .done = end_round,
                                .is_enough = is_enough};
  const status code = launch_series(&launch, &series, false, error);
  if (!launch.manager || code != STATUS_OK)
    return code;
  int64_t most = 0;
  bool died = false;
  for (size_t i = 0; i < study->ladder_count; i++) {
    most = study->ladder[i].seeds > most ? study->ladder[i].seeds : most;
    died |= study->ladder[i].end == no_result;
  }
  if (most == 0 && died)
    return status_fail(error, STATUS_FAILED_RUNS, "the first run ended without a result, so that nothing was studied");
  if (most == 0)
    return status_fail(error, STATUS_USAGE,
                       "--seconds %.4g: too short for %lld seeds of two levels of any knob; runs so far are in %s, and "
                       "the same command with more time goes on",
                       study->rule.seconds, (long long)study->rule.first_seeds, study->limits.store);
  TRY(study_print(study, line->format, request->launch.quiet, error));
  const struct study_ladder *last = &study->ladder[study->ladder_count - 1];
  if (request->picture && !request->launch.quiet && last->base != study->ladder[0].base)
    fputs("clast: a picture is of the first point, which its title names; with --set of the varied inputs the command "
          "draws another\n",
          stderr);
  return request->picture ? study_print_picture(study, request->picture, error) : STATUS_OK;
}

/* Names what withholds a result with the scene's own settings, before anything is computed. Returns whether there is
 * one. */
static bool tell_withheld(const struct study *study, const struct scene *scene) {
  const struct condition *list = scene->kind->conditions;
  const condition_set broken = condition_before(list, scene->inputs, NULL);
  bool any = false;
  for (size_t k = 0; list && list[k].word; k++)
    for (size_t q = 0; q < study->quantity_count; q++) {
      char says[CONDITION_SAYS];
      if (!(broken >> k & 1) || !list[k].withheld || !study->quantity[q].row ||
          condition_mark(list, list[k].word, study->quantity[q].column) != CONDITION_WITHHELD)
        continue;
      words_print(stderr, "", "clast: warning: %s is withheld with the scene's own settings: %s%s%s (clast explain %s)",
                  study->quantity[q].name, condition_says(&list[k], says), list[k].remedy ? "; " : "",
                  list[k].remedy ? list[k].remedy : "", list[k].word);
      any = true;
    }
  return any;
}

status study_launch(const struct study_request *request, const struct command_line *line, struct error *error) {
  OWNED struct study_subject *subject = memory_small(1, sizeof *subject);
  status code = study_request_read(request, line->arguments[0], subject, error);
  if (code == STATUS_OK && subject->scene_count)
    code = engine_ready(subject->scenes[0]->kind, subject->scenes[0]->inputs, error);
  for (size_t s = 0; code == STATUS_OK && !launch_other_rank() && s < subject->scene_count; s++)
    if (tell_withheld(&subject->study, subject->scenes[s]))
      break;
  if (code == STATUS_OK)
    code = run_study(&subject->study, request, line, error);
  study_request_clear(subject);
  return code;
}
