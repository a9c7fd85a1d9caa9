/* Makes options of the levels of a study: error, cost, number of seeds; and chooses. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy_finding.h"
#include "engine/grow.h"

#define SMALL 0.1 /* of what is allowed: so much of a knob of two levels stops no answer */
enum { MOST_SEEDS = 10000 };

double accuracy_most(bool share, double mean) {
  return share ? fmax(mean, 1 - mean) : HUGE_VAL;
}

/* Runs of a share that are all equal may miss a rare outcome: what n of them leave. */
static double left_by_equal(double mean, int64_t n) {
  return accuracy_most(true, mean) * (1 - pow(0.05, 1 / (double)n));
}

int64_t accuracy_seeds(double mean, double deviation, double margin, bool share) {
  const bool equal = deviation >= 0 && !(deviation > SAMPLE_ROUNDING * fabs(mean));
  int64_t seeds;
  if (share && equal && margin > 0) {
    const double part = margin / accuracy_most(share, mean),
                 n = part < 1 ? log(0.05) / log1p(-part) : ACCURACY_FEWEST_SEEDS;
    seeds = n > MOST_SEEDS ? 0 : (int64_t)ceil(n);
  } else
    seeds = (int64_t)(share && !equal ? scatter_runs_of_share(mean, deviation, margin)
                                      : scatter_runs_needed(deviation, margin));
  if (seeds == 0 || seeds > MOST_SEEDS)
    return 0;
  return seeds > ACCURACY_FEWEST_SEEDS ? seeds : ACCURACY_FEWEST_SEEDS;
}

/* True when the campaign varies an input that this level of the knob sets. */
bool accuracy_is_varied(const struct campaign *campaign, const struct knob *knob, const char *setting) {
  for (size_t i = 0; i < KNOB_INPUTS && knob->inputs[i].path; i++)
    if (campaign_axis(campaign, knob->inputs[i].path))
      return true;
  const struct scene_settings *settings = knob->group == KNOB_SETTINGS ? scene_settings_find(campaign->scene, setting)
                                                                       : NULL;
  for (size_t i = 0; settings && i < settings->count; i++)
    if (campaign_axis(campaign, campaign->scene->kind->inputs->rows[settings->item[i].row].path))
      return true;
  return false;
}

/* What a setting with this mean may be off. NaN: a time is given, not an accuracy. */
double accuracy_allowed(const struct campaign *campaign, double mean) {
  return campaign->accuracy_within * (campaign->accuracy_of_value ? fabs(mean) : 1);
}

/* A knob's part of the error of an option. One change between levels may be small by chance: it counts only where it is
 * a small part of what is allowed. */
static void take_part(const struct accuracy_row_part *from, struct accuracy_option *option) {
  const struct ask_part *part = &from->part;
  const bool small = part->beyond < SMALL * option->within;
  size_t at = option->part_count;
  if (at == LIMITS_STUDY_KNOBS || isnan(part->error)) /* NaN: no levels were compared */
    return;
  option->part_count++;
  for (; at > 0 && strcmp(option->part[at - 1].knob->name, from->knob->name) > 0; at--)
    option->part[at] = option->part[at - 1];
  option->part[at] = (struct accuracy_part){.knob = from->knob,
                                            .open = part->open && !small && part->error != 0,
                                            .error = part->error,
                                            .left_by_seeds = part->left_by_seeds,
                                            .beyond = part->coarser > 1 || small || !part->open ? part->beyond
                                                                                                : (double)NAN,
                                            .finest = from->finest,
                                            .seeds = part->seeds};
  option->beyond += option->part[at].beyond;
}

/* The error, with what may lie beyond the finest levels. */
double accuracy_resolution(const struct accuracy_option *option) {
  return option->error + (option->beyond > 0 ? option->beyond : 0);
}

/* As many seeds as the time of a point allows, and no more than make the interval 1 % of the error. */
static int64_t seeds_in(const struct accuracy_option *option, double point_s) {
  const int64_t useful = accuracy_seeds(option->mean, option->deviation, 0.01 * accuracy_resolution(option),
                                        option->share);
  const int64_t most = useful ? useful : MOST_SEEDS;
  const double seeds = floor(point_s / option->run_s);
  return seeds < ACCURACY_FEWEST_SEEDS ? 0 : seeds < (double)most ? (int64_t)seeds : most;
}

static double total_of(const struct accuracy_option *option, int64_t seeds) {
  if (seeds == 0)
    return NAN;
  const double student = sample_student((size_t)seeds, 0.95) * option->deviation / sqrt((double)seeds);
  double of_share = option->share ? sample_share_half_width((size_t)seeds, option->mean, option->deviation, 0.95)
                                  : (double)NAN;
  if (option->share && option->deviation >= 0 && isnan(of_share))
    of_share = left_by_equal(option->mean, seeds);
  return accuracy_resolution(option) + fmax(student, of_share);
}

/* The number of seeds by mean, deviation and error of an option. */
static void count_seeds(const struct accuracy *accuracy, struct accuracy_option *option) {
  option->seeds = !isnan(accuracy->point_s) ? seeds_in(option, accuracy->point_s)
                  : isnan(option->beyond)   ? 0
                                            : accuracy_seeds(option->mean, option->deviation,
                                                             option->within - accuracy_resolution(option), option->share);
}

static void sum_up(struct accuracy_option *option) {
  option->total = total_of(option, option->seeds);
  option->cpu_s = option->seeds ? (double)option->seeds * option->run_s : (double)NAN;
}

static status add_option(struct accuracy_finding *finding, const struct convergence_row *row,
                         struct accuracy_option *option, struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  if (!grow_block(&accuracy->options, (accuracy->count + 1) * sizeof *accuracy->options))
    return status_fail(error, STATUS_MEMORY, "no memory for the alternatives");
  memcpy(option->marks, finding->marks, sizeof option->marks);
  option->share = finding->quantity.row && field_is_share(finding->quantity.row);
  option->mean = row->mean;
  option->n = row->n;
  option->within = accuracy_allowed(finding->campaign, option->mean);
  for (size_t k = 0; k < finding->part_count; k++)
    if (finding->parts[k].part.point == option->point)
      take_part(&finding->parts[k], option);
  const double most = accuracy_most(option->share, option->mean) - option->error;
  if (!option->open) /* a bound has nothing beyond it */
    option->beyond = 0;
  else if (option->error == 0) /* equal runs do not tell how far others may be */
    option->beyond = NAN;
  else if (option->beyond > most)
    option->beyond = fmax(most, 0);
  option->deviation = row->deviation;
  count_seeds(accuracy, option);
  sum_up(option);
  accuracy->options[accuracy->count++] = *option;
  return STATUS_OK;
}

/* The first condition that would mark this scene's result and not that of the studied one (finer grains with the same
 * time step). NULL: none. */
const struct condition *accuracy_mark(const struct scene *studied, const struct scene *scene) {
  const struct condition *list = scene->kind->conditions;
  const condition_set marks = condition_before(list, scene->inputs, NULL) &
                              ~condition_before(list, studied->inputs, NULL);
  size_t k = 0;
  while (marks && !(marks >> k & 1))
    k++;
  return marks ? &list[k] : NULL;
}

/* Work of a run of the studied scene with this setting of the knob. NaN: the scene refuses it, or it is marked. */
static double work_at(const struct scene *studied, const struct knob *knob, const char *setting) {
  struct error ignored;
  SCENE scene = scene_copy(studied);
  if (!scene->kind->work || ladder_turn(knob, scene, setting, &ignored) != STATUS_OK || accuracy_mark(studied, scene))
    return NAN;
  return scene->kind->work(scene->inputs);
}

/* What a run of an option takes by the study of a point. NaN: it has none. */
static double cost_at(const struct accuracy_finding *finding, int64_t point, const struct accuracy_option *option) {
  size_t count;
  const struct convergence_row *rows = accuracy_rows(finding, point, &count);
  for (size_t r = 0; r < count; r++)
    if (rows[r].cpu > 0 &&
        (option->own ? rows[r].base
                     : strcmp(rows[r].knob, option->knob) == 0 && strcmp(rows[r].setting, option->setting) == 0))
      return rows[r].cpu;
  return NAN;
}

/* What a run with its own settings takes at a point: by its study or its runs, or by those of the point whose work is
 * nearest. NaN: no point tells. */
static double own_cost(const struct accuracy_finding *finding, const struct accuracy_place *place) {
  double least = HUGE_VAL, own_s = NAN;
  for (size_t k = 0; k < finding->place_count; k++) {
    const struct accuracy_place *other = &finding->places[k];
    const double far = other == place ? -1 : fabs(log(other->work / place->work));
    if (isnan(other->own_s) || !(far < least))
      continue;
    least = far;
    own_s = other->own_s * place->work / other->work;
  }
  return own_s;
}

/* As a mean over the points of the campaign; run_s: at the point that was studied. */
static double mean_cost(const struct accuracy_finding *finding, const struct accuracy_option *option, double run_s) {
  const double studied = cost_at(finding, finding->point, &(struct accuracy_option){.own = true});
  double sum = 0, points = 0;
  for (size_t i = 0; i < finding->place_count; i++) {
    const struct accuracy_place *place = &finding->places[i];
    const double cost = place->point ? cost_at(finding, place->point, option) : (double)NAN;
    const double by_own = own_cost(finding, place) / studied, by_work = place->work / accuracy_work(finding->scene);
    if (isnan(place->work)) /* the scene of the point is refused */
      continue;
    sum += !isnan(cost) ? cost : run_s * (by_own > 0 ? by_own : by_work);
    points++;
  }
  return points > 0 ? sum / points : run_s;
}

/* Does a word mark half of the runs of a setting, and less than a quarter with the scene's own? More seeds do not help
 * there. Writes the marks of the setting. */
static status is_marked(struct accuracy_finding *finding, int64_t point, bool *is, struct error *error) {
  struct ask_doubts here = {0}, own = {0};
  const struct ask_doubts_choice level = {.point = point}, scene = {.point = finding->point};
  TRY(ask_doubts(finding->store, &level, finding->results, &here, error));
  TRY(ask_doubts(finding->store, &scene, finding->results, &own, error));
  *is = false;
  if (here.runs == 0) /* of an extrapolated level: those of the finest stay */
    return STATUS_OK;
  snprintf(finding->marks, sizeof finding->marks, here.count ? "%" PRId64 " of %" PRId64 " runs:" : "", here.doubtful,
           here.runs);
  for (size_t k = 0; k < here.count; k++) {
    int64_t there = 0;
    text_append(finding->marks, sizeof finding->marks, "%s %s", k ? "," : "", here.word[k].word);
    for (size_t i = 0; i < own.count; i++)
      there += strcmp(own.word[i].word, here.word[k].word) == 0 ? own.word[i].runs : 0;
    *is |= 2 * here.word[k].runs >= here.runs && 4 * there < own.runs;
  }
  return STATUS_OK;
}

static void note_marked(struct accuracy_finding *finding, const struct knob *knob, const struct convergence_row *row) {
  struct accuracy *accuracy = finding->accuracy;
  char setting[STUDY_SETTING];
  study_show_setting(finding->campaign->scene->kind, knob, row->setting, setting);
  text_append(accuracy->marked, sizeof accuracy->marked, "%s%s = %s (%s)", *accuracy->marked ? "; " : "", row->knob,
              setting, finding->marks);
}

/* A level as an option. */
static status take_option(struct accuracy_finding *finding, const struct convergence_row *row, int64_t own_n,
                          struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  const struct knob *knob = accuracy_knob(finding->campaign, row->knob);
  const bool extrapolated = row->n == 0 && !row->base && isfinite(row->resolution) && !row->open && finding->finest &&
                            strcmp(finding->finest->knob, row->knob) == 0;
  if (extrapolated && condition_has(finding->hopeless, row->knob))
    return STATUS_OK;
  /* Models and parts of one are not chosen by cost. */
  if (!knob || knob->group == KNOB_MODEL || knob->group == KNOB_PART || !isfinite(row->error) ||
      !(isfinite(row->deviation) || extrapolated))
    return STATUS_OK;
  if (row->reference)
    finding->finest = row->n > 0 ? row : NULL;
  bool there = row->base && row->n < own_n; /* every knob has the scene's own settings as a level */
  for (size_t i = 0; row->base && i < accuracy->count; i++)
    there |= accuracy->options[i].own;
  bool marked = false;
  if (!row->base && accuracy_is_varied(finding->campaign, knob, row->setting))
    return STATUS_OK;
  TRY(is_marked(finding, row->point, &marked, error));
  if (marked && !row->base)
    note_marked(finding, knob, row);
  if (marked && !row->base && row->reference)
    text_append(finding->hopeless, sizeof finding->hopeless, "%s%s", *finding->hopeless ? "," : "", row->knob);
  if (there || (marked && !row->base))
    return STATUS_OK;

  struct accuracy_option option = {.own = row->base,
                                   .extrapolated = extrapolated,
                                   .borrowed = extrapolated,
                                   .open = row->at_least,
                                   .error = row->error,
                                   .point = row->point};
  snprintf(option.setting, sizeof option.setting, "%.63s", row->setting);
  snprintf(option.knob, sizeof option.knob, "%.63s", row->knob);
  const struct convergence_row *finest = finding->finest;
  const double run_s = !extrapolated ? row->cpu
                                     : finest->cpu * work_at(finding->scene, knob, row->setting) /
                                           work_at(finding->scene, knob, finest->setting);
  option.run_s = mean_cost(finding, &option, run_s);
  if (!extrapolated)
    return add_option(finding, row, &option, error);
  return option.run_s > 0 ? add_option(finding, finest, &option, error) : STATUS_OK;
}

static int by_error(const void *a, const void *b) {
  const struct accuracy_option *x = a, *y = b;
  return convergence_order(accuracy_resolution(x), x->run_s, accuracy_resolution(y), y->run_s);
}

/* With the interval over the seeds of a time. */
static int by_total(const void *a, const void *b) {
  const struct accuracy_option *x = a, *y = b;
  const int order = convergence_order(x->total, x->cpu_s, y->total, y->cpu_s);
  return order ? order : by_error(a, b);
}

/* The settings that reach the accuracy, by cost; then the others by error. */
static int by_cost(const void *a, const void *b) {
  const struct accuracy_option *x = a, *y = b;
  const int order = convergence_order(x->cpu_s, 0, y->cpu_s, 0);
  return order ? order : by_error(a, b);
}

static void sort_and_choose(struct accuracy *accuracy) {
  qsort(accuracy->options, accuracy->count, sizeof *accuracy->options, isnan(accuracy->point_s) ? by_cost : by_total);
  accuracy->reference = 0;
  accuracy->chosen = accuracy->options[0].seeds > 0 ? 0 : accuracy->count;
  for (size_t i = 1; i < accuracy->count; i++)
    if (by_error(&accuracy->options[i], &accuracy->options[accuracy->reference]) < 0)
      accuracy->reference = i;
}

/* The runs of the store with an option's settings at a point of the campaign. */
static status read_runs(const struct accuracy_finding *finding, const struct accuracy_place *place,
                        const struct accuracy_option *option, struct sample_summary *runs, struct error *error) {
  const struct study_quantity *quantity = &finding->quantity;
  const struct knob *knob = accuracy_knob(finding->campaign, option->knob);
  struct sample_moments moments = {0};
  int64_t point = place->point;
  *runs = (struct sample_summary){0};
  if (!option->own) {
    SCENE scene = scene_copy(place->scene);
    if (!knob || ladder_turn(knob, scene, option->setting, &(struct error){0}) != STATUS_OK)
      return STATUS_OK;
    TRY(store_point_find(finding->store, scene, &point, error));
  }
  ANSWER answer = ask_run_of_point(finding->store, point, place->scene->kind, quantity->row, quantity->of_outcome,
                                   error);
  for (struct ask_run_of_point run; ask_run_of_point_next(&answer, &run);)
    if (outcome_is_usable(run.state) && !run.withheld && !run.surplus && !run.excluded)
      sample_add(&moments, run.value);
  *runs = sample_summarise_moments(&moments, 0.95);
  return answer_end(&answer);
}

/* Takes mean and scatter of an option from all of its runs, those of the campaign, too: the point that needs most seeds
 * decides. */
static status learn(const struct accuracy_finding *finding, struct accuracy_option *option, struct error *error) {
  const double mean = option->mean;
  int64_t most = -1;
  option->learned = true;
  for (size_t i = 0; finding->quantity.row && i < finding->place_count; i++) {
    const struct accuracy_place *place = &finding->places[i];
    struct accuracy_option here = *option;
    struct sample_summary runs;
    if (!place->scene)
      continue;
    TRY(read_runs(finding, place, option, &runs, error));
    if (runs.n < ACCURACY_FEWEST_SEEDS)
      continue;
    here.mean = runs.mean;
    here.borrowed = false;
    here.n = (int64_t)runs.n;
    here.deviation = runs.standard_deviation;
    here.within = accuracy_allowed(finding->campaign, here.mean);
    if (place->point == finding->point)
      *option = here;
    else if (finding->campaign->accuracy_of_value && mean != 0) /* as large a share of the mean there */
      here.error *= fabs(here.mean / mean), here.beyond *= fabs(here.mean / mean);
    count_seeds(finding->accuracy, &here);
    most = here.seeds == 0 || most == 0 ? 0 : here.seeds > most ? here.seeds : most;
  }
  count_seeds(finding->accuracy, option);
  if (option->seeds && (most == 0 || most > option->seeds))
    option->seeds = most;
  sum_up(option);
  return STATUS_OK;
}

/* Scatter over seeds is the scene's more than the setting's: a setting with few runs has at least that of the many runs
 * of another one. */
static void share_scatter(struct accuracy_finding *finding, const struct accuracy_option *of) {
  struct accuracy *accuracy = finding->accuracy;
  for (size_t i = 0; of->n >= ACCURACY_FEW_RUNS && i < accuracy->count; i++) {
    struct accuracy_option *option = &accuracy->options[i];
    if (option->learned || option->n >= ACCURACY_FEW_RUNS || !(option->deviation < of->deviation))
      continue;
    option->deviation = of->deviation;
    count_seeds(accuracy, option);
    sum_up(option);
  }
}

status accuracy_learn(struct accuracy_finding *finding, struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  const bool in_time = !isnan(accuracy->point_s);
  while (accuracy->chosen < accuracy->count && !accuracy->options[accuracy->chosen].learned) {
    struct accuracy_option *chosen = &accuracy->options[accuracy->chosen];
    const int64_t seeds = chosen->seeds;
    TRY(learn(finding, chosen, error));
    if (in_time) { /* the same command must not take the time again */
      chosen->seeds = seeds;
      sum_up(chosen);
      return STATUS_OK;
    }
    share_scatter(finding, chosen);
    sort_and_choose(accuracy);
  }
  return STATUS_OK;
}

double accuracy_least(const struct accuracy *accuracy, double point_s, bool *open) {
  double least = NAN;
  *open = false;
  for (size_t i = 0; i < accuracy->count; i++) {
    const struct accuracy_option *option = &accuracy->options[i];
    const double total = total_of(option, seeds_in(option, point_s));
    if (convergence_order(total, 0, least, 0) >= 0)
      continue;
    least = total;
    *open = isnan(option->beyond);
  }
  return least;
}

status accuracy_choose_options(struct accuracy_finding *finding, struct error *error) {
  size_t count;
  int64_t own_n = 0; /* most seeds of a level that is the scene's own */
  const struct convergence_row *rows = accuracy_rows(finding, finding->point, &count);
  *finding->hopeless = '\0';
  finding->finest = NULL;
  for (size_t r = 0; r < count; r++)
    if (rows[r].base && rows[r].n > own_n)
      own_n = rows[r].n;
  for (size_t r = 0; r < count; r++)
    TRY(take_option(finding, &rows[r], own_n, error));
  if (finding->accuracy->count > 0)
    sort_and_choose(finding->accuracy);
  return STATUS_OK;
}
