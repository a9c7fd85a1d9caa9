/* Reads a study, finds how many seeds each level needs, and chooses. */
#include "campaign/converge/accuracy.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "campaign/converge/study.h"
#include "campaign/terminal/words.h"
#include "engine/grow.h"
#include "schemas/memory.h"

#define SMALL 0.1 /* of what is allowed: so much of a knob of two levels stops no answer */
enum {
  FEWEST_SEEDS = 3,
  MOST_SEEDS = 10000,
  STUDY_SEEDS = 1000,    /* a study with more is no advice */
  STUDY_FIRST_SEEDS = 4, /* of `clast converge` without --seeds */
  STUDY_MOST_SEEDS = 32, /* and without --max-seeds */
  LOOKED_AT = 1000
};

/* How far a result with this mean can move. */
static double most_of(bool share, double mean) {
  return share ? fmax(mean, 1 - mean) : HUGE_VAL;
}

/* Runs of a share that are all equal may miss a rare outcome: what n of them leave. */
static double left_by_equal(double mean, int64_t n) {
  return most_of(true, mean) * (1 - pow(0.05, 1 / (double)n));
}

int64_t accuracy_seeds(double mean, double deviation, double margin, bool share) {
  const bool equal = deviation >= 0 && !(deviation > SAMPLE_ROUNDING * fabs(mean));
  int64_t seeds;
  if (share && equal && margin > 0) {
    const double part = margin / most_of(share, mean), n = part < 1 ? log(0.05) / log1p(-part) : FEWEST_SEEDS;
    seeds = n > MOST_SEEDS ? 0 : (int64_t)ceil(n);
  } else
    seeds = (int64_t)(share && !equal ? scatter_runs_of_share(mean, deviation, margin)
                                      : scatter_runs_needed(deviation, margin));
  if (seeds == 0 || seeds > MOST_SEEDS)
    return 0;
  return seeds > FEWEST_SEEDS ? seeds : FEWEST_SEEDS;
}

struct seen_rate {
  char knob[64], setting[64];
  double rate; /* processor time of a run over the engine's measure of its work */
};

/* A point of the campaign, and what a run with its own settings takes. */
struct place {
  int64_t point; /* in the store; 0: not there */
  double work, own_s;
};

/* What a run of a studied level takes. */
struct level_cost {
  int64_t base_point;
  bool base;
  char knob[64], setting[64];
  double cpu_s;
};

struct kept_part {
  struct ask_part part;
  char knob[64], finest[64];
};

struct finding {
  const struct campaign *campaign;
  struct accuracy *accuracy;
  struct store *store;
  struct scene *scene; /* the one that was studied; owned */
  int64_t point;       /* its point in the store */
  int64_t last_point;  /* the last such point that the store has */
  struct study_quantity quantity;
  char results[ASK_DOUBTS_RESULTS];
  char own_out[128];  /* the scene's own level of the last knob, as "points = 400, ", if no run or law tells it; "" */
  char ran[64];       /* the knob of the last level with runs */
  char levels[2000];  /* with runs: "grains=0.01,0.005 time_step=0.4,0.2" */
  char unusual[256];  /* knobs among these that have other levels than their own: "grains,time_step"; "": none */
  char hopeless[256]; /* knobs whose finest level is marked by its runs: "grains,time_step"; "": none */
  char marks[ACCURACY_MARKS];    /* of the level that becomes an option */
  struct convergence_row finest; /* the reference of the last knob that has one, for levels finer than it */
  struct seen_rate *seen;        /* of levels that ran; owned */
  size_t seen_count, seen_room;
  struct place *places; /* the first points of the campaign; owned */
  size_t place_count, place_room;
  struct level_cost *costs; /* of all studies; owned */
  size_t cost_count, cost_room;
  struct kept_part *parts; /* of the scene and its levels; owned */
  size_t part_count, part_room;
  bool studied;
  int64_t own_n; /* most seeds of a level that is the scene's own */
};

static const struct knob *knob_of(const struct campaign *campaign, const char *name) {
  return engine_knob(campaign->scene->kind, name, NULL);
}

/* True when the campaign varies an input that this level of the knob sets. */
static bool is_varied(const struct campaign *campaign, const struct knob *knob, const char *setting) {
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

/* The next finer level of a knob of numbers, over a level. */
static double finer_by(const struct knob *knob) {
  return knob->step_power > 0 ? 0.5 : 2;
}

/* What a setting with this mean may be off. NaN: a time is given, not an accuracy. */
static double allowed(const struct campaign *campaign, double mean) {
  return campaign->accuracy_within * (campaign->accuracy_of_value ? fabs(mean) : 1);
}

/* Is the setting a level that a study of the knob has without a word of the user? */
static bool is_usual(const struct finding *finding, const struct knob *knob, const char *setting) {
  struct error ignored;
  struct ladder ladder;
  OWNED char *notes = NULL;
  bool is = false;
  if (ladder_make(knob, finding->scene, NULL, &ladder, &notes, &ignored) != STATUS_OK)
    return false;
  for (size_t l = 0; l < ladder.count; l++)
    is |= strcmp(ladder.level[l].setting, setting) == 0;
  ladder_clear(&ladder);
  return is;
}

/* SI unit of a knob's levels, as the user writes it behind them. */
static const char *unit_of(const struct campaign *campaign, const struct knob *knob) {
  const char *path = knob->inputs[0].path; /* NULL: named settings of the scene */
  const struct field *row = path ? field_find(campaign->scene->kind->inputs, path, NULL) : NULL;
  return row && row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
}

/* The levels of the study, for advice that goes on with it. */
static void note_level(struct finding *finding, const struct knob *knob, const struct convergence_row *row) {
  char *levels = finding->levels, *unusual = finding->unusual;
  if (strcmp(finding->ran, row->knob) == 0)
    text_append(levels, sizeof finding->levels, ",");
  else
    text_append(levels, sizeof finding->levels, "%s%s=", *levels ? " " : "", row->knob);
  text_append(levels, sizeof finding->levels, "%s%s", row->setting, unit_of(finding->campaign, knob));
  if (knob->group != KNOB_SETTINGS && !condition_has(unusual, row->knob) && !is_usual(finding, knob, row->setting))
    text_append(unusual, sizeof finding->unusual, "%s%s", *unusual ? "," : "", row->knob);
}

/* Levels of the user's own, of the knob that had no time for some: " --knob grains=0.02m,0.01m,0.005m". Others: "". */
static void own_levels(const struct finding *finding, char *text, size_t size) {
  const char *left_out = finding->accuracy->left_out, *more = strstr(left_out, " = ");
  char name[64], start[66];
  snprintf(name, sizeof name, "%.*s", (int)strcspn(left_out, " "), left_out);
  snprintf(start, sizeof start, "%s=", name);
  const char *ran = strstr(finding->levels, start);
  if (!more || !ran || !condition_has(finding->unusual, name))
    return;
  text_append(text, size, " --knob %.*s", (int)strcspn(ran, " "), ran);
  for (more += 3; *more; more += strspn(more, ", ")) { /* "0.01, 0.005" */
    text_append(text, size, ",%.*s%s", (int)strcspn(more, ","), more,
                unit_of(finding->campaign, knob_of(finding->campaign, name)));
    more += strcspn(more, ",");
  }
}

static double work_of(const struct scene *scene) {
  return scene->kind->work ? scene->kind->work(scene->inputs) : 1;
}

/* The cost of a level, or of the scene's own settings, by the study of a point. NaN: it has none. */
static double level_cost(const struct finding *finding, int64_t base_point, const char *knob, const char *setting,
                         bool own) {
  for (size_t i = 0; i < finding->cost_count; i++) {
    const struct level_cost *cost = &finding->costs[i];
    if (cost->base_point == base_point &&
        (own ? cost->base : strcmp(cost->knob, knob) == 0 && strcmp(cost->setting, setting) == 0))
      return cost->cpu_s;
  }
  return NAN;
}

/* The costs of all studies, and what a run of each point takes: by its study or its runs, else by those of the point
 * whose work is nearest. */
static status read_places(struct finding *finding, struct store *store, struct error *error) {
  const struct engine_kind *kind = finding->campaign->scene->kind;
  CAMPAIGN_WALK walk = {0};
  TRY(campaign_walk_begin(&walk, finding->campaign, error));
  for (int i = 0; i < LOOKED_AT && campaign_walk_next(&walk); i++) {
    struct error ignored;
    SCENE scene = campaign_walk_scene(&walk, &ignored);
    if (!scene)
      continue;
    if (!grow_room(&finding->places, &finding->place_room, finding->place_count + 1, sizeof *finding->places))
      return status_fail(error, STATUS_MEMORY, "no memory for the points of a campaign");
    struct place *place = &finding->places[finding->place_count++];
    *place = (struct place){.work = work_of(scene), .own_s = NAN};
    TRY(store_point_find(store, scene, &place->point, error));
  }
  ANSWER levels = ask_convergence_levels(store, 0, kind->results_version, finding->quantity.column, false, error);
  for (struct convergence_row row; ask_convergence_next(&levels, &row);) {
    if (!(row.cpu > 0))
      continue;
    if (!grow_room(&finding->costs, &finding->cost_room, finding->cost_count + 1, sizeof *finding->costs))
      return status_fail(error, STATUS_MEMORY, "no memory for the costs of a study");
    struct level_cost *cost = &finding->costs[finding->cost_count++];
    *cost = (struct level_cost){.base_point = row.base_point, .base = row.base, .cpu_s = row.cpu};
    snprintf(cost->knob, sizeof cost->knob, "%.63s", row.knob);
    snprintf(cost->setting, sizeof cost->setting, "%.63s", row.setting);
  }
  TRY(answer_end(&levels));
  ANSWER runs = ask_run_costs(store, kind->results_version, error);
  while (answer_next(&runs))
    for (size_t i = 0; i < finding->place_count; i++)
      if (finding->places[i].point == answer_integer(&runs, 0))
        finding->places[i].own_s = answer_real(&runs, 1);
  for (size_t i = 0; i < finding->place_count; i++) {
    const double studied = level_cost(finding, finding->places[i].point, "", "", true);
    if (finding->places[i].point && !isnan(studied))
      finding->places[i].own_s = studied;
  }
  return answer_end(&runs);
}

/* What a run of a setting takes, as a mean over the points of the campaign; run_s: at the point that was studied. */
static double mean_cost(const struct finding *finding, const struct accuracy_option *option, double run_s) {
  const double studied = level_cost(finding, finding->point, "", "", true), work = work_of(finding->scene);
  double sum = 0;
  for (size_t i = 0; i < finding->place_count; i++) {
    const struct place *place = &finding->places[i];
    const double cost = level_cost(finding, place->point, option->knob, option->setting, option->own);
    double own_s = studied * place->work / work, least = HUGE_VAL;
    for (size_t k = 0; k < finding->place_count; k++) {
      const struct place *other = &finding->places[k];
      const double far = k == i ? 0 : fabs(log(other->work / place->work));
      if (!isnan(other->own_s) && far < least) {
        least = far;
        own_s = other->own_s * place->work / other->work;
      }
    }
    sum += place->point && !isnan(cost) ? cost
                                        : run_s * (studied > 0 && own_s > 0 ? own_s / studied : place->work / work);
  }
  return finding->place_count ? sum / (double)finding->place_count : run_s;
}

static status note_rate(struct finding *finding, const struct knob *knob, const struct convergence_row *row,
                        struct error *error) {
  struct error refused;
  SCENE scene = scene_copy(finding->scene);
  if (!(row->cpu > 0) || ladder_turn(knob, scene, row->setting, &refused) != STATUS_OK)
    return STATUS_OK;
  if (!grow_room(&finding->seen, &finding->seen_room, finding->seen_count + 1, sizeof *finding->seen))
    return status_fail(error, STATUS_MEMORY, "no memory for the costs of a study");
  struct seen_rate *seen = &finding->seen[finding->seen_count++];
  *seen = (struct seen_rate){.rate = row->cpu / work_of(scene)};
  snprintf(seen->knob, sizeof seen->knob, "%.63s", row->knob);
  snprintf(seen->setting, sizeof seen->setting, "%.63s", row->setting);
  return STATUS_OK;
}

/* First pass: which levels there are. */
static status take_level(struct finding *finding, const struct convergence_row *row, struct error *error) {
  const struct knob *knob = knob_of(finding->campaign, row->knob);
  char *left_out = finding->accuracy->left_out;
  const size_t room = sizeof finding->accuracy->left_out;
  const bool of_resolution = knob && knob->group == KNOB_RESOLUTION;
  const bool ran = strcmp(finding->ran, row->knob) == 0;
  finding->studied = true;
  if (row->base && row->n > finding->own_n)
    finding->own_n = row->n;
  if (row->n > 0 && knob) {
    note_level(finding, knob, row);
    TRY(note_rate(finding, knob, row, error));
    snprintf(finding->ran, sizeof finding->ran, "%.63s", row->knob);
  }
  if (!ran)
    *finding->own_out = '\0';
  if (of_resolution && ran && row->base && row->open && row->n == 0)
    snprintf(finding->own_out, sizeof finding->own_out, "%.60s = %.60s, ", row->knob, row->setting);
  const bool finer_out = row->n == 0 && !row->base && isnan(row->resolution) && ran; /* finer than a level that ran */
  if (of_resolution && finer_out && !*left_out && *finding->own_out)
    snprintf(left_out, room, "%s%.30s", finding->own_out, row->setting);
  else if (of_resolution && finer_out && !*left_out)
    snprintf(left_out, room, "%.64s = %.64s", row->knob, row->setting);
  return STATUS_OK;
}

/* A knob's part of the error of an option. One change between levels may be small by chance: it counts only where it is
 * a small part of what is allowed. */
static void take_part(const struct finding *finding, const struct ask_part *part, struct accuracy_option *option) {
  if (option->part_count == LIMITS_STUDY_KNOBS)
    return;
  struct accuracy_part *to = &option->part[option->part_count++];
  const bool small = part->beyond < SMALL * option->within;
  *to = (struct accuracy_part){.knob = knob_of(finding->campaign, part->knob),
                               .open = part->open && !small && part->error != 0,
                               .error = part->error,
                               .left_by_seeds = part->left_by_seeds,
                               .beyond = part->coarser > 1 || small || !part->open ? part->beyond : (double)NAN,
                               .finest = strtod(part->finest, NULL),
                               .seeds = part->seeds};
  option->beyond += to->beyond;
}

static void take_parts(const struct finding *finding, struct accuracy_option *option) {
  for (size_t k = 0; k < finding->part_count; k++)
    if (finding->parts[k].part.point == option->point)
      take_part(finding, &finding->parts[k].part, option);
}

/* The parts of the scene that was studied and of its levels. */
static status read_parts(struct finding *finding, struct error *error) {
  ANSWER parts = ask_parts(finding->store, finding->point, finding->scene->kind->results_version,
                           finding->quantity.column, error);
  finding->part_count = 0;
  for (struct ask_part part; ask_parts_next(&parts, &part);) {
    if (!grow_room(&finding->parts, &finding->part_room, finding->part_count + 1, sizeof *finding->parts))
      return status_fail(error, STATUS_MEMORY, "no memory for the parts of an error");
    struct kept_part *kept = &finding->parts[finding->part_count++];
    kept->part = part;
    snprintf(kept->knob, sizeof kept->knob, "%.63s", part.knob);
    snprintf(kept->finest, sizeof kept->finest, "%.63s", part.finest);
  }
  for (size_t k = 0; k < finding->part_count; k++) {
    finding->parts[k].part.knob = finding->parts[k].knob;
    finding->parts[k].part.finest = finding->parts[k].finest;
  }
  return answer_end(&parts);
}

/* The error, with what may lie beyond the finest levels. */
static double resolution_of(const struct accuracy_option *option) {
  return option->error + (option->beyond > 0 ? option->beyond : 0);
}

/* As many seeds as the time of a point allows, and no more than make the interval 1 % of the error. */
static int64_t seeds_in(const struct accuracy_option *option, double point_s) {
  const int64_t useful = accuracy_seeds(option->mean, option->deviation, 0.01 * resolution_of(option), option->share);
  const int64_t most = useful ? useful : MOST_SEEDS;
  const double seeds = floor(point_s / option->run_s);
  return seeds < FEWEST_SEEDS ? 0 : seeds < (double)most ? (int64_t)seeds : most;
}

static double total_of(const struct accuracy_option *option, int64_t seeds) {
  if (seeds == 0)
    return NAN;
  const double student = sample_student((size_t)seeds, 0.95) * option->deviation / sqrt((double)seeds);
  double of_share = option->share ? sample_share_half_width((size_t)seeds, option->mean, option->deviation, 0.95)
                                  : (double)NAN;
  if (option->share && option->deviation >= 0 && isnan(of_share))
    of_share = left_by_equal(option->mean, seeds);
  return resolution_of(option) + fmax(student, of_share);
}

static status add_option(struct finding *finding, const struct convergence_row *row, struct accuracy_option *option,
                         struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  if (!grow_block(&accuracy->options, (accuracy->count + 1) * sizeof *accuracy->options))
    return status_fail(error, STATUS_MEMORY, "no memory for the alternatives");
  memcpy(option->marks, finding->marks, sizeof option->marks);
  option->share = finding->quantity.row && field_is_share(finding->quantity.row);
  option->mean = row->mean;
  option->n = row->n;
  option->within = allowed(finding->campaign, option->mean);
  take_parts(finding, option);
  const double most = most_of(option->share, option->mean) - option->error;
  if (!option->open) /* a bound has nothing beyond it */
    option->beyond = 0;
  else if (option->error == 0) /* equal runs do not tell how far others may be */
    option->beyond = NAN;
  else if (option->beyond > most)
    option->beyond = most;
  option->deviation = row->deviation;
  option->seeds = !isnan(accuracy->point_s) ? seeds_in(option, accuracy->point_s)
                  : isnan(option->beyond)   ? 0
                                            : accuracy_seeds(option->mean, row->deviation,
                                                             option->within - resolution_of(option), option->share);
  option->total = total_of(option, option->seeds);
  option->cpu_s = option->seeds ? (double)option->seeds * option->run_s : (double)NAN;
  accuracy->options[accuracy->count++] = *option;
  return STATUS_OK;
}

/* The first condition that would mark this scene's result and not that of the campaign's scene (finer grains with the
 * same time step). NULL: none. */
static const struct condition *mark_of(const struct campaign *campaign, const struct scene *scene) {
  const struct condition *list = scene->kind->conditions;
  const condition_set marks = condition_before(list, scene->inputs, NULL) &
                              ~condition_before(list, campaign->scene->inputs, NULL);
  size_t k = 0;
  while (marks && !(marks >> k & 1))
    k++;
  return marks ? &list[k] : NULL;
}

/* Work of a run of the campaign's scene with this setting of the knob. NaN: the scene refuses it, or it is marked. */
static double work_at(const struct campaign *campaign, const struct knob *knob, const char *setting) {
  struct error ignored;
  const struct engine_kind *kind = campaign->scene->kind;
  SCENE scene = scene_copy(campaign->scene);
  if (!kind->work || ladder_turn(knob, scene, setting, &ignored) != STATUS_OK || mark_of(campaign, scene))
    return NAN;
  return kind->work(scene->inputs);
}

/* The condition that marks a level. With a finer setting of another knob of resolution it may not: writes
 * "fidelity.time_step='2.5e-07 s'", and "" if none helps. NULL: the level is not marked. */
static const struct condition *mark_of_level(const struct campaign *campaign, const struct knob *knob,
                                             const char *setting, char *remedy, size_t size) {
  enum { HALVINGS = 10 };
  struct error ignored;
  SCENE level = scene_copy(campaign->scene);
  *remedy = '\0';
  const struct condition *mark = ladder_turn(knob, level, setting, &ignored) == STATUS_OK ? mark_of(campaign, level)
                                                                                          : NULL;
  for (const struct knob *other = campaign->scene->kind->knobs; mark && other->name; other++) {
    char own[64], finer[64];
    if (other == knob || other->group != KNOB_RESOLUTION || !(other->step_power > 0) || is_varied(campaign, other, ""))
      continue;
    ladder_setting(other, campaign->scene, own, sizeof own);
    for (int h = 1; h <= HALVINGS && !*remedy; h++) {
      SCENE scene = scene_copy(level);
      snprintf(finer, sizeof finer, "%.6g", ldexp(strtod(own, NULL), -h));
      if (ladder_turn(other, scene, finer, &ignored) == STATUS_OK && !mark_of(campaign, scene))
        snprintf(remedy, size, "%s='%s%s%s'", other->inputs[0].path, finer, *unit_of(campaign, other) ? " " : "",
                 unit_of(campaign, other));
    }
  }
  return mark;
}

/* Does a word mark half of the runs of a setting, and less than a quarter with the scene's own? More seeds do not help
 * there. Writes the marks of the setting. */
static status is_marked(struct finding *finding, int64_t point, bool *is, struct error *error) {
  struct ask_doubts here = {0}, own = {0};
  const struct ask_doubts_choice level = {.point = point}, scene = {.point = finding->point};
  TRY(ask_doubts(finding->store, &level, finding->results, &here, error));
  TRY(ask_doubts(finding->store, &scene, finding->results, &own, error));
  *is = false;
  if (here.runs == 0) /* of an extrapolated level: those of the finest stay */
    return STATUS_OK;
  snprintf(finding->marks, sizeof finding->marks, here.count ? "%" PRId64 " of %" PRId64 " runs of the study:" : "",
           here.doubtful, here.runs);
  for (size_t k = 0; k < here.count; k++) {
    int64_t there = 0;
    text_append(finding->marks, sizeof finding->marks, "%s %s", k ? "," : "", here.word[k].word);
    for (size_t i = 0; i < own.count; i++)
      there += strcmp(own.word[i].word, here.word[k].word) == 0 ? own.word[i].runs : 0;
    *is |= 2 * here.word[k].runs >= here.runs && 4 * there < own.runs;
  }
  return STATUS_OK;
}

static void note_marked(struct finding *finding, const struct knob *knob, const struct convergence_row *row) {
  struct accuracy *accuracy = finding->accuracy;
  char setting[STUDY_SETTING];
  study_show_setting(finding->campaign->scene->kind, knob, row->setting, setting);
  text_append(accuracy->marked, sizeof accuracy->marked, "%s%s = %s (%s)", *accuracy->marked ? "; " : "", row->knob,
              setting, finding->marks);
}

/* Second pass: a level as an option. */
static status take_option(struct finding *finding, const struct convergence_row *row, struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  const struct knob *knob = knob_of(finding->campaign, row->knob);
  const bool extrapolated = row->n == 0 && !row->base && isfinite(row->resolution) && finding->finest.n > 0 &&
                            strcmp(finding->finest.knob, row->knob) == 0;
  if (extrapolated && condition_has(finding->hopeless, row->knob))
    return STATUS_OK;
  /* Models and parts of one are not chosen by cost. */
  if (!knob || knob->group == KNOB_MODEL || knob->group == KNOB_PART || !isfinite(row->error) ||
      !(isfinite(row->deviation) || extrapolated))
    return STATUS_OK;
  if (row->reference)
    finding->finest = *row;
  bool there = row->base && row->n < finding->own_n; /* every knob has the scene's own settings as a level */
  for (size_t i = 0; row->base && i < accuracy->count; i++)
    there |= accuracy->options[i].own;
  bool marked = false;
  if (!row->base && is_varied(finding->campaign, knob, row->setting))
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
                                   .open = row->at_least,
                                   .error = row->error,
                                   .point = row->point};
  snprintf(option.setting, sizeof option.setting, "%.63s", row->setting);
  snprintf(option.knob, sizeof option.knob, "%.63s", row->knob);
  const struct convergence_row *finest = &finding->finest;
  const double run_s = !extrapolated ? row->cpu
                                     : finest->cpu * work_at(finding->campaign, knob, row->setting) /
                                           work_at(finding->campaign, knob, finest->setting);
  option.run_s = mean_cost(finding, &option, run_s);
  if (!extrapolated)
    return add_option(finding, row, &option, error);
  return option.run_s > 0 ? add_option(finding, finest, &option, error) : STATUS_OK;
}

static int by_error(const void *a, const void *b) {
  const struct accuracy_option *x = a, *y = b;
  return convergence_order(resolution_of(x), x->run_s, resolution_of(y), y->run_s);
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

static void choose(struct accuracy *accuracy) {
  qsort(accuracy->options, accuracy->count, sizeof *accuracy->options, isnan(accuracy->point_s) ? by_cost : by_total);
  accuracy->chosen = accuracy->options[0].seeds > 0 ? 0 : accuracy->count;
  for (size_t i = 1; i < accuracy->count; i++)
    if (by_error(&accuracy->options[i], &accuracy->options[accuracy->reference]) < 0)
      accuracy->reference = i;
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

/* The share of each point in the campaign's time. NaN: the campaign gives an accuracy, not a time. */
static status divide_time(const struct campaign *campaign, struct accuracy *accuracy, struct error *error) {
  CAMPAIGN_WALK walk = {0};
  TRY(campaign_walk_begin(&walk, campaign, error));
  accuracy->point_s = campaign->accuracy_time / (double)design_points(walk.design);
  return STATUS_OK;
}

/* Reads the study of this scene, if there is one. */
static status read_study(struct finding *finding, struct store *store, const struct scene *scene, struct error *error) {
  static status (*const passes[])(struct finding *, const struct convergence_row *, struct error *) = {take_level,
                                                                                                       take_option};
  int64_t point = 0;
  if (study_quantity_find(scene->kind, finding->campaign->accuracy_quantity, &finding->quantity, error) != STATUS_OK)
    return STATUS_CONTENT;
  finding->store = store;
  scene_free(finding->scene);
  finding->scene = scene_copy(scene);
  if (!finding->place_count)
    TRY(read_places(finding, store, error));
  TRY(ask_doubts_results(store, finding->quantity.column, finding->results, error));
  TRY(store_point_find(store, scene, &point, error));
  finding->point = point;
  finding->last_point = point ? point : finding->last_point;
  if (point)
    TRY(read_parts(finding, error));
  for (size_t pass = 0; point && pass < sizeof passes / sizeof passes[0]; pass++) {
    ANSWER levels = ask_convergence_levels(store, point, scene->kind->results_version, finding->quantity.column, true,
                                           error);
    for (struct convergence_row row; ask_convergence_next(&levels, &row);)
      TRY(passes[pass](finding, &row, error));
    TRY(answer_end(&levels));
  }
  return STATUS_OK;
}

/* Reads the study of the first point that has one, if that of the campaign's scene is missing, and names its point. */
static status read_points(struct finding *finding, struct store *store, struct error *error) {
  const struct campaign *campaign = finding->campaign;
  struct accuracy *accuracy = finding->accuracy;
  CAMPAIGN_WALK walk = {0};
  TRY(campaign_walk_begin(&walk, campaign, error));
  if (finding->studied && design_points(walk.design) > 1)
    snprintf(accuracy->studied, sizeof accuracy->studied, "the scene with its own values of what varies");
  bool named = design_points(walk.design) == 1;
  for (int i = 0; !(finding->studied && named) && i < LOOKED_AT && campaign_walk_next(&walk); i++) {
    struct error ignored;
    char inputs[256];
    int64_t point = 0;
    SCENE scene = campaign_walk_scene(&walk, &ignored);
    if (scene && !finding->studied)
      TRY(read_study(finding, store, scene, error));
    if (scene && finding->studied)
      TRY(store_point_find(store, scene, &point, error));
    if (!point || point != finding->point || named)
      continue;
    named = true;
    snprintf(accuracy->studied, sizeof accuracy->studied, "point %d, %s", i + 1,
             design_axis_show_point(campaign->axis_count, campaign->axes, scene->inputs, inputs, sizeof inputs));
  }
  return STATUS_OK;
}

/* The error of the chosen setting at another point against what is allowed there; 0: that point has no study of it. */
static status need_at(const struct finding *finding, struct store *store, const struct scene *scene,
                      struct convergence_row *row, double *need, struct error *error) {
  const struct campaign *campaign = finding->campaign;
  const struct accuracy_option *chosen = &finding->accuracy->options[finding->accuracy->chosen];
  struct study_quantity quantity;
  int64_t point = 0;
  *need = 0;
  TRY(study_quantity_find(scene->kind, campaign->accuracy_quantity, &quantity, error));
  TRY(store_point_find(store, scene, &point, error));
  if (!point || point == finding->point)
    return STATUS_OK;
  ANSWER levels = ask_convergence_levels(store, point, scene->kind->results_version, quantity.column, true, error);
  for (struct convergence_row level; ask_convergence_next(&levels, &level);)
    if (level.n > 0 && isfinite(level.error) &&
        (chosen->own ? level.base
                     : strcmp(level.knob, chosen->knob) == 0 && strcmp(level.setting, chosen->setting) == 0)) {
      const double within = allowed(campaign, level.mean);
      *row = level;
      *need = level.error / (isnan(within) ? chosen->error : within);
    }
  return answer_end(&levels);
}

/* Names the studied point at which the chosen setting is farthest from the accuracy, if one misses it. */
static status name_widest(const struct finding *finding, struct store *store, struct error *error) {
  const struct campaign *campaign = finding->campaign;
  struct accuracy *accuracy = finding->accuracy;
  double most = 1, need;
  size_t studied = 1; /* points: of this one the study is */
  CAMPAIGN_WALK walk = {0};
  if (accuracy->chosen == accuracy->count)
    return STATUS_OK;
  TRY(campaign_walk_begin(&walk, campaign, error));
  for (int i = 0; i < LOOKED_AT && campaign_walk_next(&walk); i++) {
    struct error ignored;
    struct convergence_row row = {.error = 0};
    char inputs[256], told[UNCERTAINTY_TEXT], unit[CAMPAIGN_UNIT];
    SCENE scene = campaign_walk_scene(&walk, &ignored);
    if (!scene)
      continue;
    TRY(need_at(finding, store, scene, &row, &need, error));
    studied += need > 0;
    if (!(need > most))
      continue;
    most = need;
    snprintf(accuracy->widest_point, sizeof accuracy->widest_point,
             "point %d, %s, was studied, too, and its error is larger: %s%s with the mean %.3g", i + 1,
             design_axis_show_point(campaign->axis_count, campaign->axes, scene->inputs, inputs, sizeof inputs),
             study_show_error(row.error, row.at_least, told),
             campaign_unit(campaign, campaign->accuracy_quantity, unit), row.mean);
  }
  if (studied == design_points(walk.design) && !*accuracy->widest_point) /* none is wider */
    *accuracy->studied = '\0';
  return STATUS_OK;
}

static status no_study(const struct campaign *campaign, const char *path, const char *store, struct error *error) {
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s%s has no study of %s for this campaign. Make it: `clast converge %s --quantity %s`",
                     store, access(store, F_OK) == 0 ? "" : " does not exist yet, so it", campaign->accuracy_quantity,
                     path, campaign->accuracy_quantity);
}

/* No setting has a result. Where runs at the scene's own settings are withheld, a study would be, too: says why. */
static status no_result(const struct finding *finding, const char *path, const char *store, struct error *error) {
  struct ask_doubts doubts = {0};
  char why[1200] = "";
  const char *quantity = finding->campaign->accuracy_quantity;
  if (finding->last_point)
    TRY(ask_doubts(finding->store, &(struct ask_doubts_choice){.point = finding->last_point}, finding->results, &doubts,
                   error));
  if (doubts.withheld == 0)
    return no_study(finding->campaign, path, store, error);
  for (size_t k = 0; k < doubts.count; k++) {
    const struct condition *row = doubts.word[k].row;
    if (row && row->withheld)
      text_append(why, sizeof why, ". %s: %s (`clast explain %s`)", row->word, row->remedy ? row->remedy : row->doubt,
                  row->word);
  }
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s has no %s for this campaign: with its own settings, %" PRId64 " of %" PRId64
                     " runs are withheld%s. Then study it: `clast converge %s --quantity %s`",
                     store, quantity, doubts.withheld, doubts.runs, why, path, quantity);
}

void accuracy_clear(struct accuracy *accuracy) {
  free(accuracy->options);
  *accuracy = (struct accuracy){0};
}

/* No option can be run often enough in the time. */
static status too_short(const struct accuracy *accuracy, const struct campaign *campaign, struct error *error) {
  double least = HUGE_VAL;
  for (size_t i = 0; i < accuracy->count; i++)
    least = fmin(least, FEWEST_SEEDS * accuracy->options[i].run_s * campaign->accuracy_time / accuracy->point_s);
  char given[32], needed[32];
  progress_duration(campaign->accuracy_time, given, sizeof given);
  progress_duration(least, needed, sizeof needed);
  return status_fail(error, STATUS_CONTENT,
                     "accuracy: %s of processor time is too short: the cheapest studied settings and %d seeds for each "
                     "of the %.0f points need %s. Allow more time, or take fewer points",
                     given, FEWEST_SEEDS, campaign->accuracy_time / accuracy->point_s, needed);
}

/* Appends the words of a command without the --set of the input that `remedy` (PATH=VALUE) sets anew. */
static void append_without(const char *words, const char *remedy, char *text, size_t size) {
  static const char set[] = " --set ";
  const size_t path = strcspn(remedy, "=") + 1;
  for (const char *at = words; *at;) {
    const char *word = at + strlen(set), *next = strstr(at + 1, set);
    const bool is_set = strncmp(at, set, strlen(set)) == 0, quoted = is_set && *word == '\'';
    if (is_set && strncmp(word + quoted, remedy, path) == 0)
      at = word + quoted + strcspn(word + quoted, quoted ? "'" : " ") + quoted;
    text_append(text, size, "%.*s", (int)(next ? next - at : (ptrdiff_t)strlen(at)), at);
    at = next ? next : "";
  }
}

/* The finest level of a knob; the scene's own setting if no level has runs. 0: it is a choice. */
static double finest_of(const struct campaign *campaign, const struct accuracy_part *part) {
  char own[64];
  if (part->finest > 0)
    return part->finest;
  ladder_setting(part->knob, campaign->scene, own, sizeof own);
  return strtod(own, NULL);
}

/* A study that is advised: `clast converge` with these words behind the campaign. */
struct advised {
  const struct knob *knob[LIMITS_STUDY_KNOBS];
  char levels[LIMITS_STUDY_KNOBS][512]; /* "0.02m,0.01m"; "": those of a study without a word of the user */
  size_t count;
  int64_t seeds;
  char remedy[160]; /* the --set that it needs: "fidelity.time_step='2.5e-07 s'"; "": none */
};

static status set_remedy(struct scene *scene, const char *remedy, struct error *error) {
  char path[FIELD_TEXT_SIZE], value[64];
  if (sscanf(remedy, "%63[^=]='%63[^']'", path, value) != 2) /* append_study() wrote it */
    return STATUS_OK;
  TRY(scene_set_text(scene, path, value, error));
  return scene_check(scene, error);
}

/* How many of the first seeds of a level have no run, and what a run takes; NaN: there is none. */
static status read_cost(const struct finding *finding, const struct scene *level, int64_t seeds, int64_t *missing,
                        double *run_s, struct error *error) {
  struct study_quantity main;
  int64_t point = 0, runs = 0, ran = 0;
  double cpu_s = 0;
  TRY(store_point_find(finding->store, level, &point, error));
  TRY(study_quantity_find(level->kind, OUTCOME_DEFAULT, &main, error));
  ANSWER answer = ask_run_of_point(finding->store, point, level->kind, main.row, main.of_outcome, error);
  for (struct ask_run_of_point run; point && ask_run_of_point_next(&answer, &run); runs++) {
    const int64_t seed = (int64_t)(run.seed - (uint64_t)finding->campaign->first_seed);
    ran += seed >= 0 && seed < seeds;
    cpu_s += run.cpu_s;
  }
  *missing = seeds - ran;
  *run_s = runs ? cpu_s / (double)runs : (double)NAN;
  return point ? answer_end(&answer) : STATUS_OK;
}

/* The rate of the studied level that is nearest to this one: of the same knob if there is one. */
static double rate_near(const struct finding *finding, const struct knob *knob, const char *setting) {
  double rate = NAN, least = HUGE_VAL;
  for (size_t i = 0; i < finding->seen_count; i++) {
    const struct seen_rate *seen = &finding->seen[i];
    const double far = fabs(log(strtod(seen->setting, NULL) / strtod(setting, NULL)));
    const double distance = strcmp(seen->knob, knob->name) != 0   ? 1e9
                            : strcmp(seen->setting, setting) == 0 ? 0
                            : isfinite(far)                       ? far
                                                                  : 1e6;
    if (distance < least) {
      least = distance;
      rate = seen->rate;
    }
  }
  return rate;
}

/* Adds what the levels of a knob lack. Those without runs take by their work what the nearest studied level tells. */
static status add_cost(const struct finding *finding, const struct ladder *ladder, int64_t seeds, bool *own,
                       int64_t *runs, double *cpu_s, struct error *error) {
  for (size_t l = 0; l < ladder->count; l++) {
    const struct ladder_level *level = &ladder->level[l];
    int64_t missing;
    double run_s;
    TRY(read_cost(finding, level->scene, seeds, &missing, &run_s, error));
    if (isnan(run_s))
      run_s = rate_near(finding, ladder->knob, level->setting) * work_of(level->scene);
    if (level->base && *own) /* the knobs share it */
      continue;
    *own |= level->base;
    *runs += missing;
    *cpu_s += missing ? (double)missing * run_s : 0;
  }
  return STATUS_OK;
}

/* What the study takes at all points of the campaign that it has. */
static status cost_of(const struct finding *finding, const struct advised *study, int64_t seeds, int64_t *runs,
                      double *cpu_s, struct error *error) {
  const struct campaign *campaign = finding->campaign;
  CAMPAIGN_WALK walk = {0};
  *runs = 0;
  *cpu_s = 0;
  TRY(campaign_walk_begin(&walk, campaign, error));
  for (int i = 0; i < STUDY_SCENES && campaign_walk_next(&walk); i++) {
    bool own = false;
    SCENE scene = campaign_walk_scene(&walk, error);
    TRY(scene ? set_remedy(scene, study->remedy, error) : STATUS_CONTENT);
    for (size_t k = 0; k < study->count; k++) {
      struct error ignored;
      struct ladder ladder;
      OWNED char *notes = NULL;
      if (ladder_make(study->knob[k], scene, *study->levels[k] ? study->levels[k] : NULL, &ladder, &notes, &ignored) !=
          STATUS_OK)
        continue;
      const status code = add_cost(finding, &ladder, seeds, &own, runs, cpu_s, error);
      ladder_clear(&ladder);
      TRY(code);
    }
  }
  return STATUS_OK;
}

/* "27 more runs, 14 s of processor time" */
static status append_cost(const struct finding *finding, const struct advised *study, int64_t seeds, char *text,
                          size_t size, struct error *error) {
  int64_t runs;
  double cpu_s;
  char time[32];
  TRY(cost_of(finding, study, seeds, &runs, &cpu_s, error));
  progress_duration(cpu_s, time, sizeof time);
  text_append(text, size, "%" PRId64 " more runs", runs);
  if (isfinite(cpu_s))
    text_append(text, size, ", %s of processor time", time);
  return STATUS_OK;
}

/* Has the store such levels of the knob for the scene with the remedy? Then their study is not advised again. */
static status is_studied(const struct finding *finding, const struct advised *study, double finest, bool *is,
                         struct error *error) {
  int64_t point = 0;
  SCENE scene = scene_copy(finding->scene);
  *is = false;
  TRY(set_remedy(scene, study->remedy, error));
  TRY(store_point_find(finding->store, scene, &point, error));
  if (!point)
    return STATUS_OK;
  ANSWER levels = ask_convergence_levels(finding->store, point, scene->kind->results_version, finding->quantity.column,
                                         false, error);
  const bool down = finer_by(study->knob[0]) < 1;
  for (struct convergence_row row; ask_convergence_next(&levels, &row);) {
    const double setting = strtod(row.setting, NULL) * (down ? 1 - 1e-5 : 1 + 1e-5);
    *is |= strcmp(row.knob, study->knob[0]->name) == 0 && row.n > 0 && (down ? setting <= finest : setting >= finest);
  }
  return answer_end(&levels);
}

/* Appends a level to a list, as the store spells it if it has this one up to digits, unless it is there already. */
static void append_level(const struct finding *finding, const struct knob *knob, double value, char *list,
                         size_t size) {
  char level[80], word[80];
  ladder_setting(knob, finding->campaign->scene, level, sizeof level); /* the scene's own */
  if (!(fabs(strtod(level, NULL) - value) < 2e-3 * value))
    snprintf(level, sizeof level, "%.4g", value);
  for (size_t i = 0; i < finding->seen_count; i++)
    if (strcmp(finding->seen[i].knob, knob->name) == 0 &&
        fabs(strtod(finding->seen[i].setting, NULL) - value) < 2e-3 * value)
      snprintf(level, sizeof level, "%s", finding->seen[i].setting);
  text_append(level, sizeof level, "%s", unit_of(finding->campaign, knob));
  for (const char *words = list; ladder_next_word(&words, word, sizeof word);)
    if (strcmp(word, level) == 0)
      return;
  text_append(list, size, "%s%s", *list ? "," : "", level);
}

/* The command that studies the knob at its finest level, one on either side, and the scene's own, whose error is
 * wanted. Levels that would be marked are studied with another input of a shorter step. */
static status append_study(const struct finding *finding, const struct accuracy_part *part, char *next, size_t size,
                           struct error *error) {
  const struct campaign *campaign = finding->campaign;
  const struct knob *knob = part->knob;
  const char *words = finding->accuracy->path;
  OWNED struct advised *study = memory_small(1, sizeof *study);
  const double finer = finer_by(knob), value = finest_of(campaign, part);
  char own[64], finest[64];
  *study = (struct advised){.knob = {knob}, .count = 1, .seeds = STUDY_FIRST_SEEDS};
  if (part->seeds > STUDY_FIRST_SEEDS) /* not fewer than the study has */
    study->seeds = part->seeds;
  ladder_setting(knob, campaign->scene, own, sizeof own);
  snprintf(finest, sizeof finest, "%.6g", value * finer);
  const struct condition *mark = value > 0 ? mark_of_level(campaign, knob, finest, study->remedy, sizeof study->remedy)
                                           : NULL;
  if (mark && !*study->remedy) {
    text_append(next, size, ", but runs of them would be in doubt, and do not count: clast explain %s", mark->word);
    return STATUS_OK;
  }
  bool studied = false;
  if (mark)
    TRY(is_studied(finding, study, value * finer, &studied, error));
  if (studied) {
    text_append(next, size, ". The store has them with --set %s: `clast plan ", study->remedy);
    append_without(words, study->remedy, next, size);
    text_append(next, size, " --set %s` goes on from there", study->remedy);
    return STATUS_OK;
  }
  if (mark)
    text_append(next, size,
                ", with --set %s here and in later commands, or in `set` of the campaign: else their runs "
                "are in doubt (clast explain %s) and do not count",
                study->remedy, mark->word);
  const double levels[] = {value / finer, value, value * finer, strtod(own, NULL)};
  for (size_t i = 0; i < 4 && value > 0; i++)
    append_level(finding, knob, levels[i], study->levels[0], sizeof study->levels[0]);
  text_append(next, size, ": `clast converge ");
  append_without(words, study->remedy, next, size);
  text_append(next, size, "%s%s --knob %s%s%s", mark ? " --set " : "", study->remedy, knob->name,
              *study->levels[0] ? "=" : "", study->levels[0]);
  if (study->seeds > STUDY_FIRST_SEEDS)
    text_append(next, size, " --seeds %" PRId64, study->seeds);
  text_append(next, size, "` (");
  TRY(append_cost(finding, study, study->seeds, next, size, error));
  if (study->seeds < STUDY_MOST_SEEDS) {
    text_append(next, size, "; at most ");
    TRY(append_cost(finding, study, STUDY_MOST_SEEDS, next, size, error));
    text_append(next, size, ", with %d seeds", STUDY_MOST_SEEDS);
  }
  text_append(next, size, ")");
  return STATUS_OK;
}

/* Have runs told that finer levels of the knob are in doubt, and does no other setting cure it? */
static bool is_hopeless(const struct finding *finding, const struct accuracy_part *part) {
  char finest[64], remedy[160];
  snprintf(finest, sizeof finest, "%.6g", finest_of(finding->campaign, part) * finer_by(part->knob));
  return condition_has(finding->hopeless, part->knob->name) &&
         !(mark_of_level(finding->campaign, part->knob, finest, remedy, sizeof remedy) && *remedy);
}

/* Finer levels of the knob without a limit. */
static status advise_levels(const struct finding *finding, const struct accuracy_part *part, char *next, size_t size,
                            struct error *error) {
  char setting[64], shown[STUDY_SETTING], upto[STUDY_SETTING + 8] = "";
  snprintf(setting, sizeof setting, "%.4g", finest_of(finding->campaign, part));
  if (finest_of(finding->campaign, part) > 0)
    snprintf(upto, sizeof upto, " up to %s", study_show_setting(finding->scene->kind, part->knob, setting, shown));
  text_append(next, size, "The results show no limit in %s%s", part->knob->name, upto);
  if (is_hopeless(finding, part)) {
    text_append(next, size, ", and the runs of its finest levels are in doubt. No setting that was studied is enough");
    return STATUS_OK;
  }
  text_append(
      next, size,
      ": no value of it is known to be enough, and more seeds alone do not help. Finer levels may show a limit");
  return append_study(finding, part, next, size, error);
}

/* With what the slowest law leaves beyond the levels. */
static double told_of(const struct accuracy_option *option, const struct accuracy_part *part) {
  return (part->error > 0 ? part->error : 0) + (option->open && part->beyond > 0 ? part->beyond : 0);
}

/* Finer levels of the knob that leaves most of the error. */
static status advise_widest(const struct finding *finding, const struct accuracy_part *widest, char *next, size_t size,
                            struct error *error) {
  char text[CAMPAIGN_UNIT];
  const struct accuracy_option *best = &finding->accuracy->options[finding->accuracy->reference];
  text_append(next, size, "Finer levels of %s, which leaves most of it (%.2g%s), may narrow it", widest->knob->name,
              told_of(best, widest), campaign_unit(finding->campaign, finding->campaign->accuracy_quantity, text));
  return append_study(finding, widest, next, size, error);
}

/* The knobs of a study with more seeds. They narrow the interval of each knob's distance to the limit, and leave its
 * middle. Knobs whose intervals are small beside the room for them stay as they are. 0: more seeds do not reach it. */
static double choose_seeds(const struct finding *finding, const struct accuracy_option *best, double room,
                           struct advised *study) {
  bool stays[LIMITS_STUDY_KNOBS] = {false};
  double rest = 0, sum = 0, seeds = 0; /* rest: of knobs that stay */
  for (bool again = true; again;) {
    size_t least = best->part_count;
    double width = HUGE_VAL;
    for (size_t k = 0; k < best->part_count; k++) {
      const double of = told_of(best, &best->part[k]) - best->part[k].left_by_seeds;
      if (!stays[k] && best->error > 0 && !(of >= width)) {
        least = k;
        width = of > 0 ? of : 0;
      }
    }
    again = least < best->part_count && rest + width <= SMALL * room;
    if (again) {
      stays[least] = true;
      rest += width;
    }
  }
  for (size_t k = 0; k < best->part_count; k++)
    if (!stays[k])
      sum += told_of(best, &best->part[k]) - best->part[k].left_by_seeds;
  const double factor = best->error > 0 ? sum / (room - rest) : 2; /* 0: no run differs yet */
  for (size_t k = 0; k < best->part_count; k++) {
    const struct accuracy_part *part = &best->part[k];
    if (stays[k])
      continue;
    const size_t length = strlen(part->knob->name);
    const char *levels = condition_has(finding->unusual, part->knob->name) ? finding->levels : NULL;
    while (levels && (strncmp(levels, part->knob->name, length) != 0 || levels[length] != '='))
      levels = (levels = strchr(levels, ' ')) ? levels + 1 : NULL;
    if (levels)
      snprintf(study->levels[study->count], sizeof study->levels[0], "%.*s", (int)strcspn(levels + length + 1, " "),
               levels + length + 1);
    study->knob[study->count++] = part->knob;
    seeds = fmax(seeds, ceil((double)part->seeds * factor * factor));
  }
  return seeds;
}

/* More seeds: how many, and what they take. */
static status advise_seeds(const struct finding *finding, const struct accuracy_part *widest, double middle, char *next,
                           size_t size, struct error *error) {
  const struct accuracy_option *best = &finding->accuracy->options[finding->accuracy->reference];
  OWNED struct advised *study = memory_small(1, sizeof *study);
  *study = (struct advised){.count = 0};
  const double room = best->within - middle;
  const double seeds = room > 0 ? choose_seeds(finding, best, room, study) : 0;
  char text[CAMPAIGN_UNIT];
  if (room <= 0 || seeds > STUDY_SEEDS || study->count == 0) {
    if (room > 0 && best->error > 0)
      text_append(next, size, "More than %d seeds at every level would be needed", STUDY_SEEDS);
    else
      text_append(
          next, size,
          "More seeds are not likely to help: they narrow the interval of this error, and leave about %.2g%s of it",
          fmin(middle, resolution_of(best)),
          campaign_unit(finding->campaign, finding->campaign->accuracy_quantity, text));
    text_append(next, size, ". No setting that was studied is enough");
    if (room > 0 || !widest)
      return STATUS_OK;
    text_append(next, size, ". ");
    return advise_widest(finding, widest, next, size, error);
  }
  study->seeds = (int64_t)seeds;
  if (best->error > 0)
    text_append(
        next, size,
        "More seeds narrow the interval of this error. If they leave %.2g of it, about %.0f at the levels of this "
        "study are needed, which take ",
        middle, seeds);
  else
    text_append(next, size, "More seeds may show a difference; %.0f at every level take ", seeds);
  TRY(append_cost(finding, study, study->seeds, next, size, error));
  text_append(next, size, ": `clast converge %s", finding->accuracy->path);
  const char *before = " --knob ";
  for (size_t k = 0; k < study->count; k++)
    if (!*study->levels[k]) {
      text_append(next, size, "%s%s", before, study->knob[k]->name);
      before = ",";
    }
  for (size_t k = 0; k < study->count; k++)
    if (*study->levels[k])
      text_append(next, size, " --knob %s=%s", study->knob[k]->name, study->levels[k]);
  text_append(next, size, " --max-seeds %.0f --within off --seeds %.0f`", seeds, seeds);
  return STATUS_OK;
}

/* No option reaches the accuracy: what would, for the one with the smallest error. */
static status advise(struct finding *finding, struct error *error) {
  struct accuracy *accuracy = finding->accuracy;
  const struct accuracy_option *best = &accuracy->options[accuracy->reference];
  const struct accuracy_part *open = NULL, *widest = NULL;
  char *next = accuracy->advice;
  const size_t size = sizeof accuracy->advice;
  double middle = 0; /* what more seeds leave */
  for (size_t k = 0; k < best->part_count; k++) {
    const struct accuracy_part *part = &best->part[k];
    middle += part->left_by_seeds > 0 ? part->left_by_seeds : 0;
    if (part->open && (!open || told_of(best, part) > told_of(best, open)))
      open = part;
    if (told_of(best, part) > 0 && part->knob->group == KNOB_RESOLUTION && !part->knob->choices[0] &&
        !is_hopeless(finding, part) && (!widest || told_of(best, part) > told_of(best, widest)))
      widest = part;
  }
  const bool by_resolution = !open && middle >= best->within;
  const char *name = open ? open->knob->name : "";
  const bool of_another = strncmp(accuracy->left_out, name, strlen(name)) != 0;
  const bool is_wide = widest && widest != open && told_of(best, widest) >= best->within;
  if (open && is_wide) /* finer levels of the open knob are not enough */
    return advise_widest(finding, widest, next, size, error);
  if (*accuracy->left_out && !by_resolution && !of_another) {
    char levels[600] = "";
    own_levels(finding, levels, sizeof levels);
    text_append(next, size,
                "The study had no time for %s: `clast converge %s --quantity %s%s` goes on with it and takes its time",
                accuracy->left_out, accuracy->path, finding->campaign->accuracy_quantity, levels);
    return STATUS_OK;
  }
  return open ? advise_levels(finding, open, next, size, error)
              : advise_seeds(finding, widest, middle, next, size, error);
}

static void release(struct finding *finding) {
  scene_free(finding->scene);
  free(finding->parts);
  free(finding->places);
  free(finding->costs);
  free(finding->seen);
}

status accuracy_find(const struct campaign *campaign, const char *path, const char *store_path,
                     struct accuracy *accuracy, struct error *error) {
  __attribute__((cleanup(release))) struct finding finding = {.campaign = campaign, .accuracy = accuracy};
  STORE store = NULL;
  *accuracy = (struct accuracy){.path = path};
  TRY(divide_time(campaign, accuracy, error));
  const status code = store_open_reader(store_path, &store, error);
  if (code == STATUS_MISSING)
    return no_study(campaign, path, store_path, error);
  TRY(code);
  TRY(read_study(&finding, store, campaign->scene, error));
  TRY(read_points(&finding, store, error));
  if (accuracy->count == 0)
    return no_result(&finding, path, store_path, error);
  choose(accuracy);
  if (accuracy->chosen == accuracy->count && isnan(accuracy->point_s))
    TRY(advise(&finding, error));
  return name_widest(&finding, store, error);
}

/* "particles = 40000", "stop = 0.0012 s", "the scene's own settings". */
static void name_option(const struct campaign *campaign, const struct accuracy_option *option, char *text,
                        size_t size) {
  char setting[STUDY_SETTING];
  study_show_setting(campaign->scene->kind, knob_of(campaign, option->knob), option->setting, setting);
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

/* Would a setting reach this accuracy? */
static bool is_reached(const struct accuracy *accuracy, const struct campaign *campaign, double within) {
  bool is = false;
  for (size_t i = 0; i < accuracy->count; i++) {
    const struct accuracy_option *option = &accuracy->options[i];
    const double margin = within * (campaign->accuracy_of_value ? fabs(option->mean) : 1) - resolution_of(option);
    is |= !isnan(option->beyond) && accuracy_seeds(option->mean, option->deviation, margin, option->share) > 0;
  }
  return is;
}

/* No level reaches the accuracy: what would. */
static status out_of_reach(const struct accuracy *accuracy, const struct campaign *campaign, struct error *error) {
  const struct accuracy_option *best = &accuracy->options[accuracy->reference];
  const char *quantity = campaign->accuracy_quantity, *path = accuracy->path;
  const double least = resolution_of(best);
  char width[64], share[64] = "", more[256] = "", chosen[256], smallest[1200], text[CAMPAIGN_UNIT];
  const char *unit = campaign_unit(campaign, campaign->accuracy_quantity, text);
  name_option(campaign, best, chosen, sizeof chosen);
  if (campaign->accuracy_of_value)
    snprintf(share, sizeof share, best->mean == 0 ? " (no share of a mean of 0 allows an error)" : " (%s)",
             text_percent(least / fabs(best->mean), (char[TEXT_PERCENT]){0}));
  const bool a_guess = best->open && least <= best->within; /* what lies beyond the finest level is not known */
  char wider[32];
  const double percent = campaign->accuracy_of_value ? 100 : 1,
               mean = campaign->accuracy_of_value ? fabs(best->mean) : 1;
  for (double more_than = 1.3;
       more_than * least < fmin(fabs(best->mean), most_of(best->share, best->mean)) && !*more && least > 0;
       more_than *= 2) {
    snprintf(wider, sizeof wider, "%.2g", more_than * least * percent / mean);
    if (more_than * least > best->within && is_reached(accuracy, campaign, strtod(wider, NULL) / percent))
      text_append(more, sizeof more, "allow more, such as `accuracy: {quantity: %s, within: %s%s}`, or ", quantity,
                  wider, campaign->accuracy_of_value ? " %" : unit);
  }
  snprintf(smallest, sizeof smallest,
           "The smallest error is %s%.2g%s%s%s, with %s%s mean is %.4g%s (%" PRId64 " seeds)",
           best->open ? "about " : "", least, unit, share,
           a_guess      ? " (a guess: no limit is seen, so that it may be much larger)"
           : best->open ? " (a guess, as no limit is seen)"
                        : "",
           chosen, best->extrapolated ? ", finer than any run: the finest level's" : ", whose", best->mean, unit,
           best->n);
  if (best->open && !(least > 0))
    snprintf(smallest, sizeof smallest,
             "No run of the study differs between the settings, which does not tell how far "
             "other runs may be");
  text_append(smallest, sizeof smallest, *accuracy->marked ? ". Levels whose runs are in doubt do not count: %s" : "%s",
              accuracy->marked);
  return status_fail(
      error, STATUS_CONTENT,
      "accuracy: %s%s%sno setting %s %s within %s. %s. %s. You can %sask for the least error in a time: `clast "
      "plan %s --within 10min`",
      *accuracy->studied ? "by the study of " : "", accuracy->studied, *accuracy->studied ? ", " : "",
      a_guess ? "is known to give" : "gives", quantity, show_width(campaign, width, sizeof width), smallest,
      accuracy->advice, more, path);
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
  const struct knob *knob = knob_of(campaign, option->knob);
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
  table_column(table, "known", NULL);
  if (guessed)
    table_column(table, "beyond", unit);
  table_column(table, "seeds", NULL);
  table_column(table, "total", unit);
  table_column(table, "run_cpu", "s");
  table_column(table, "point_cpu", "s");
  table_column(table, "run_cost", NULL);
  for (size_t i = 0; i < accuracy->count; i++) {
    const struct accuracy_option *option = &accuracy->options[i];
    char setting[STUDY_SETTING], text[UNCERTAINTY_TEXT];
    const struct knob *knob = people ? knob_of(campaign, option->knob) : NULL;
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
    table_text(table, option->open           ? option->error > 0 ? "at least" : "none seen"
                      : option->extrapolated ? "extrapolated"
                                             : "yes");
    if (guessed)
      table_real(table, rounded(people, 2, option->beyond));
    if (option->seeds)
      table_integer(table, option->seeds);
    else
      table_missing(table);
    table_real(table, rounded(people, 2, option->total));
    const double costs[] = {option->run_s, option->cpu_s, option->run_s / reference->run_s};
    for (size_t c = 0; c < sizeof costs / sizeof costs[0]; c++)
      table_real(table, rounded(people, 3, costs[c]));
  }
  return table_end(table, error);
}

/* The knobs whose parts the error has, or those of them without a limit, in the order of ask_resolution(): "grains,
 * time_step". Returns text. */
static const char *name_knobs(const struct accuracy_option *option, bool without_limit, char *text, size_t size) {
  *text = '\0';
  for (const char *last = "", *next; last; last = next) {
    next = NULL;
    for (size_t k = 0; k < option->part_count; k++) {
      const struct accuracy_part *part = &option->part[k];
      if (without_limit ? part->beyond > 0 : !isnan(part->error))
        next = strcmp(part->knob->name, last) > 0 && (!next || strcmp(part->knob->name, next) < 0) ? part->knob->name
                                                                                                   : next;
    }
    if (next)
      text_append(text, size, "%s%s", *text ? ", " : "", next);
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
  if (option->total >= most_of(option->share, option->mean))
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
              "%s \xc2\xb1 %.2g%s%s%s, resolution %s%s (%s)%s and the rest seeds, with %s and %" PRId64
              " seeds a point%s",
              campaign->accuracy_quantity, option->total, unit, more, share,
              study_show_error(option->error, option->open, resolution), unit,
              name_knobs(option, false, knobs, sizeof knobs), beyond, chosen, option->seeds, cost);
  if (option->deviation >= 0 && !(option->deviation > SAMPLE_ROUNDING * fabs(option->mean)))
    words_print(out, before, "all %" PRId64 " seeds of the study are equal with it: %s", option->n,
                option->share ? "the error holds that so many may miss a rare outcome" : "more of them tell no more");
  if (*accuracy->studied)
    words_print(out, before,
                "this is known of %s; the others have errors and means of their own, which may be wider: the table at "
                "the end of the run tells them",
                accuracy->studied);
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
      const double error_then = accuracy_least(accuracy, times[i].factor * accuracy->point_s, &open);
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
  if (print == ACCURACY_TEXT) {
    char width[64];
    if (isnan(accuracy.point_s))
      words_print(stdout, "accuracy  ", "%s within %s%s", campaign->accuracy_quantity,
                  show_width(campaign, width, sizeof width),
                  campaign->accuracy_of_value ? ": each setting by its own mean, column within" : "");
    print_choice(&accuracy, campaign, "accuracy  ", false, stdout);
    TRY(print_alternatives(&accuracy, campaign, TABLE_TEXT, stdout, error));
    words_print(stdout, "",
                "error: how far finer settings may move it. total: with the 95 %% interval over seeds. run_cpu, "
                "point_cpu: by the runs of the study, mean over the points. run_cost: against the smallest error");
    if (*accuracy.marked && accuracy.chosen < accuracy.count)
      words_print(stdout, "", "Left out, as their runs are in doubt (!) by a word that few of the scene's own have: %s",
                  accuracy.marked);
    if (accuracy.chosen < accuracy.count && accuracy.options[accuracy.chosen].extrapolated)
      words_print(stdout, "",
                  "The chosen setting is finer than any level that was run. Its error is that of the finest level "
                  "times (its step over that step)^%g, and its cost is by the engine's measure of work.",
                  LIMIT_ORDER_LEAST);
    putchar('\n');
  }
  return accuracy_apply(&accuracy, campaign, error);
}
