/* The rounds of a study: chooses the next levels and numbers of seeds, and runs a round as a campaign. */
#include <math.h>
#include <stdlib.h>

#include "campaign/converge/study.h"
#include "campaign/document/campaign_write.h"
#include "campaign/driver/pooling.h"
#include "schemas/clock.h"

struct rounds { /* of one farm_run */
  struct study *study;
  const struct driver_options *options;
  struct store *store;
  double begin;
  double seconds, work; /* sums over the levels that have run: their ratio predicts the other levels */

  /* The round under way. */
  struct study_ladder *ladder;
  int64_t seeds;
  bool probe;                /* runs one seed of the cheapest level, because nothing has run yet */
  struct campaign *campaign; /* owned */
  struct driver *driver;     /* NULL between two rounds */
  struct farm_manager calls; /* the driver's callbacks */
  int out;                   /* tasks on slots */
  struct error error;        /* error of a callback that cannot return one */
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
    const double scale = study->rule.relative ? fabs(found.rows[study_reference(ladder)].mean) : 1;
    for (size_t l = 0; l < found.count; l++)
      if (!ladder->left_out[l] && !(found.rows[l].bias_half_width <= study->rule.within * scale))
        return false;
  }
  return true;
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
  return seconds / fmax(1, rounds->options->slots);
}

/* Leaves out the most expensive levels until the first round fits into the ladder's share of the time left. All ladders
 * that wait for their first round have equal shares. Levels whose runs exist cost nothing and stay. Returns the number
 * of levels that remain. */
static size_t fit_levels(const struct rounds *rounds, struct study_ladder *ladder, int64_t seeds) {
  size_t count = ladder->levels.count, waiting = 0;
  for (size_t i = 0; i < rounds->study->ladder_count; i++)
    waiting += rounds->study->ladder[i].seeds == 0 && !rounds->study->ladder[i].done;
  const double share = fmax(0, seconds_left(rounds)) / (double)waiting;
  for (; wall_time(rounds, ladder, seeds) > share; count--) {
    size_t worst = 0;
    double most = 0;
    for (size_t l = 0; l < ladder->levels.count; l++) {
      const double cost = ladder->left_out[l] ? 0 : cost_of(rounds, ladder, l, seeds);
      if (cost > most) {
        worst = l;
        most = cost;
      }
    }
    ladder->left_out[worst] = true;
  }
  return count;
}

static void end_ladder(struct study_ladder *ladder, const char *why) {
  ladder->done = true;
  ladder->end = why;
}

static const char budget[] = "the time given is spent";

/* Next number of seeds of the ladder. 0: the ladder is done. */
static int64_t next_seeds(const struct rounds *rounds, struct study_ladder *ladder) {
  const struct study_rule *rule = &rounds->study->rule;
  if (ladder->seeds == 0) {
    if (fit_levels(rounds, ladder, rule->first_seeds) >= 2)
      return rule->first_seeds;
    end_ladder(ladder, budget);
    return 0;
  }
  int64_t seeds = 2 * ladder->seeds < rule->most_seeds ? 2 * ladder->seeds : rule->most_seeds;
  while (seeds > ladder->seeds && wall_time(rounds, ladder, seeds) > seconds_left(rounds))
    seeds--;
  if (seeds > ladder->seeds)
    return seeds;
  end_ladder(ladder, budget);
  return 0;
}

/* The ladder with the fewest seeds that is not done, and its next number of seeds. NULL: all are done. */
static struct study_ladder *choose_ladder(struct rounds *rounds) {
  for (;;) {
    struct study_ladder *next = NULL;
    for (size_t i = 0; i < rounds->study->ladder_count; i++) {
      struct study_ladder *ladder = &rounds->study->ladder[i];
      if (!ladder->done && (!next || ladder->seeds < next->seeds))
        next = ladder;
    }
    if (!next)
      return NULL;
    rounds->probe = isnan(predict(rounds, next, 0));
    rounds->seeds = rounds->probe ? 1 : next_seeds(rounds, next);
    if (rounds->seeds > 0)
      return next;
  }
}

/* ---- a round as a campaign ---- */

static size_t cheapest_level(const struct study_ladder *ladder) {
  size_t best = 0;
  for (size_t l = 1; l < ladder->levels.count; l++)
    if (work_of(ladder->levels.level[l].scene) < work_of(ladder->levels.level[best].scene))
      best = l;
  return best;
}

/* True when some level gives the input another value than the base scene. False for an input without effect. */
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
    if (scene->given[input] && !field_same_value(row, &own, &other))
      return true;
  }
  return false;
}

/* Makes axes of the inputs that the knob sets; their i-th values are the i-th level. */
static status make_axes(const struct rounds *rounds, struct campaign *campaign, struct error *error) {
  const struct ladder *levels = &rounds->ladder->levels;
  const struct field_table *inputs = rounds->ladder->base->kind->inputs;
  const size_t cheapest = cheapest_level(rounds->ladder);
  campaign->axes = calloc(inputs->count, sizeof *campaign->axes);
  if (!campaign->axes)
    return status_fail(error, STATUS_MEMORY, "no memory for a round");
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    if (!is_turned(rounds->ladder, i))
      continue;
    struct design_axis *axis = &campaign->axes[campaign->axis_count++];
    *axis = (struct design_axis){.row = row, .kind = DESIGN_AXIS_LEVELS, .lower = -HUGE_VAL, .upper = HUGE_VAL};
    axis->levels = calloc(levels->count, sizeof *axis->levels);
    if (!axis->levels)
      return status_fail(error, STATUS_MEMORY, "no memory for a round");
    for (size_t l = 0; l < levels->count; l++)
      if (rounds->probe ? l == cheapest : !rounds->ladder->left_out[l])
        field_get(row, levels->level[l].scene->inputs, &axis->levels[axis->level_count++]);
  }
  return STATUS_OK;
}

static status make_campaign(struct rounds *rounds, struct error *error) {
  const struct study *study = rounds->study;
  struct campaign *campaign = rounds->campaign = calloc(1, sizeof *campaign);
  if (!campaign)
    return status_fail(error, STATUS_MEMORY, "no memory for a round");
  *campaign = study->limits;
  campaign->design = (struct campaign_design_keys){.kind = CAMPAIGN_LIST};
  campaign->per_point = rounds->seeds;
  const struct field *row = study->quantity[0].row;
  snprintf(campaign->quantity, sizeof campaign->quantity, "%s", row ? row->path : OUTCOME_DEFAULT);
  snprintf(campaign->name, sizeof campaign->name, "%.200s %s", study->limits.name, rounds->ladder->levels.knob->name);
  campaign->scene = scene_copy(rounds->ladder->base);
  if (!campaign->scene)
    return status_fail(error, STATUS_MEMORY, "no memory for a round");
  TRY(make_axes(rounds, campaign, error));
  char comment[128];
  snprintf(comment, sizeof comment, "Written by clast converge: levels of %s.", rounds->ladder->levels.knob->name);
  campaign->text = campaign_write_list(campaign, study->scene_reference, comment);
  return campaign->text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a round");
}

static status begin_round(struct rounds *rounds, struct error *error) {
  status code = make_campaign(rounds, error);
  if (code == STATUS_OK)
    code = driver_open(rounds->campaign, rounds->store, rounds->options, &rounds->driver, error);
  if (code == STATUS_OK)
    rounds->calls = driver_manager(rounds->driver);
  return code;
}

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
  if (ladder->narrow)
    end_ladder(ladder,
               isnan(study->rule.within) ? "one round was asked for" : "every bias is known to the wanted width");
  else if (study->budget_spent)
    end_ladder(ladder, budget);
  else if (ladder->seeds >= study->rule.most_seeds)
    end_ladder(ladder, "the largest number of seeds has run");
}

/* `outcome`: outcome of the round's session in the store. */
static status end_round(struct rounds *rounds, const char *outcome, struct error *error) {
  struct driver_summary summary;
  status code = driver_end(rounds->driver, error);
  driver_summarise(rounds->driver, &summary);
  rounds->study->runs_done += summary.runs_done;
  rounds->study->runs_failed += summary.runs_failed;
  rounds->study->cpu_s += summary.cpu_s;
  driver_free(rounds->driver);
  rounds->driver = NULL;
  campaign_free(rounds->campaign);
  rounds->campaign = NULL;
  if (code == STATUS_OK)
    code = store_end_session(rounds->store, summary.session_id, outcome, error);
  if (!rounds->probe)
    rounds->ladder->seeds = rounds->seeds;
  if (code == STATUS_OK)
    code = store_flush(rounds->store, error); /* queries read exponents, and they do not read an open batch */
  if (code == STATUS_OK)
    code = study_read(rounds->study, rounds->ladder, rounds->store, error);
  learn(rounds);
  judge(rounds);
  return code;
}

/* ---- the farm's callbacks ---- */

static bool next_task(void *context, struct farm_task *task) {
  struct rounds *rounds = context;
  struct error *error = &rounds->error;
  while (error->status == STATUS_OK) {
    rounds->study->budget_spent |= seconds_left(rounds) < 0;
    if (rounds->driver) {
      if (!rounds->study->budget_spent && rounds->calls.next(rounds->calls.context, task)) {
        rounds->out++;
        return true;
      }
      if (rounds->out > 0)
        return false;
      error->status = end_round(rounds, "finished", error);
      continue;
    }
    rounds->ladder = choose_ladder(rounds);
    if (!rounds->ladder)
      return false;
    error->status = begin_round(rounds, error);
  }
  return false;
}

static status take_report(void *context, const struct farm_report *report, struct error *error) {
  struct rounds *rounds = context;
  rounds->out--;
  return rounds->calls.report(rounds->calls.context, report, error);
}

static status tick(void *context, int running, struct error *error) {
  struct rounds *rounds = context;
  if (rounds->error.status != STATUS_OK) {
    *error = rounds->error;
    return rounds->error.status;
  }
  return rounds->driver ? rounds->calls.tick(rounds->calls.context, running, error) : STATUS_OK;
}

static void stopping(void *context, int signal_number) {
  struct rounds *rounds = context;
  if (rounds->driver)
    rounds->calls.stopping(rounds->calls.context, signal_number);
}

static status run_rounds(struct rounds *rounds, struct farm *farm, struct error *error) {
  struct study *study = rounds->study;
  for (size_t i = 0; i < study->ladder_count; i++) {
    TRY(study_read(study, &study->ladder[i], rounds->store, error));
  }
  learn(rounds);
  const struct farm_manager manager = {.context = rounds,
                                       .next = next_task,
                                       .report = take_report,
                                       .tick = tick,
                                       .stopping = stopping};
  status code = farm_run(farm, &manager, error);
  if (code == STATUS_OK && rounds->error.status != STATUS_OK) {
    *error = rounds->error;
    code = rounds->error.status;
  }
  struct error ignored;
  if (rounds->driver)
    (void)end_round(rounds, code == STATUS_STOPPED ? "stopped" : "failed", &ignored);
  if (code == STATUS_OK)
    code = pooling_store(rounds->store, 0, error);
  return code == STATUS_OK ? study_store(study, rounds->store, error) : code;
}

status study_rounds_run(struct study *study, struct farm *farm, const struct driver_options *options,
                        struct error *error) {
  if (farm_rank(farm) != 0)
    return farm_run(farm, NULL, error);
  struct driver_options own = *options;
  own.slots = farm_slots_total(farm);
  struct rounds rounds = {.study = study, .options = &own, .begin = clock_s()};
  char warning[1024] = "";
  status code = store_open_writer(own.store_path, &rounds.store, warning, sizeof warning, error);
  if (code == STATUS_OK && warning[0] && own.note)
    own.note(own.note_context, warning);
  if (code == STATUS_OK)
    code = run_rounds(&rounds, farm, error);
  else
    driver_release_ranks(farm);
  campaign_free(rounds.campaign);
  struct error closing = {0};
  const status closed = store_close(rounds.store, &closing);
  if (closed != STATUS_OK && code == STATUS_OK) {
    *error = closing;
    code = closed;
  }
  return code;
}
