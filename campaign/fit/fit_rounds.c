/* The rounds of a fit as a series: one campaign for each shot of a round, a list of the members' inputs. Runs a fit
 * from its documents to its report. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "campaign/fit/fit.h"
#include "engine/random.h"
#include "schemas/memory.h"

/* ---- a round as campaigns ---- */

static status make_campaign(const struct fit *fit, struct campaign **out, struct error *error) {
  const struct observed_shot *shot = &fit->observed->shots[fit->shot];
  const struct campaign *from = fit->campaign;
  TRY(driver_list_begin(from, shot->scene, from->axis_count, fit->members, out, error));
  struct campaign *campaign = *out;
  for (size_t i = 0; i < from->axis_count; i++) {
    campaign->axes[i].row = from->axes[i].row;
    memcpy(campaign->axes[i].unit, from->axes[i].unit, sizeof from->axes[i].unit);
  }
  for (size_t j = 0; j < fit->members; j++) {
    for (size_t i = 0; i < fit->inputs; i++)
      fit_value(fit, i, fit->place[j * fit->inputs + i], &campaign->axes[fit->axis[i]].levels[j]);
    for (size_t i = 0; i < from->axis_count; i++) {
      const struct design_axis *axis = &from->axes[i];
      if (axis->kind == DESIGN_AXIS_LINKED)
        design_axis_follow(axis, &campaign->axes[axis->linked].levels[j], 0, &campaign->axes[i].levels[j]);
    }
  }
  char comment[80];
  snprintf(comment, sizeof comment, "Written by clast fit: round %zu, shot %zu.", fit->rounds + 1, fit->shot + 1);
  snprintf(campaign->name, sizeof campaign->name, "%.120s fit", from->name);
  return driver_list_end(campaign, fit->scene_reference, comment, error);
}

/* Reads the error of the resolution from a study in the store, for data without `resolution`. */
static status find_resolution(struct fit *fit, struct store *store, struct error *error) {
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    char column[FIELD_TEXT_SIZE];
    int64_t point = 0;
    if (!isnan(datum->resolution))
      continue;
    field_column_name(datum->ask.row ? datum->ask.row->path : datum->quantity, column, sizeof column);
    TRY(store_point_find(store, fit->observed->shots[datum->shot].scene, &point, error));
    if (point)
      TRY(ask_resolution(store, point, column, &fit->resolution[k], error));
    if (isfinite(fit->resolution[k].half_width))
      fit->data[k].resolution = fit->resolution[k].half_width / 1.96;
  }
  return STATUS_OK;
}

/* The scene of a member of the shot. NULL with *error. */
static struct scene *scene_of(const struct fit *fit, const double *z, struct error *error) {
  const struct campaign *campaign = fit->campaign;
  OWNED struct field_value *values = NULL;
  if (memory_array(&values, campaign->axis_count, sizeof *values, "a point", error))
    return NULL;
  for (size_t i = 0; i < fit->inputs; i++)
    fit_value(fit, i, z[i], &values[fit->axis[i]]);
  for (size_t i = 0; i < campaign->axis_count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LINKED)
      design_axis_follow(&campaign->axes[i], &values[campaign->axes[i].linked], 0, &values[i]);
  return campaign_point_scene_from(fit->observed->shots[fit->shot].scene, campaign, values, error);
}

static status next_round(void *context, const struct scheduler *scheduler, struct campaign **campaign,
                         struct error *error) {
  struct fit *fit = context;
  if (fit->phase == FIT_DONE)
    return STATUS_OK;
  if (fit->rounds == 0 && fit->shot == 0)
    TRY(find_resolution(fit, scheduler->store, error));
  return make_campaign(fit, campaign, error);
}

/* ---- the values of a round's runs ---- */

/* Reads the values of the shot's data at a point of the store: data x replicates. Point 0: it has none. */
static status read_data(struct fit *fit, struct store *store, const struct scene *scene, int64_t point,
                        const uint64_t *seeds, double *values, struct error *error) {
  const size_t count = fit->replicates;
  char results[ASK_DOUBTS_RESULTS] = "";
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    if (datum->shot != fit->shot)
      continue;
    double *of_datum = values + k * count, value;
    uint64_t seed;
    for (size_t r = 0; r < count; r++)
      of_datum[r] = NAN;
    if (!point)
      continue;
    text_append(results, sizeof results, "%s ", ask_specimens_result(&datum->ask));
    ANSWER runs = ask_specimens(store, point, scene->kind, &datum->ask, error);
    for (struct ask_doubts one = {0}; ask_specimens_next(&runs, &datum->ask, &seed, &value, &one);
         one = (struct ask_doubts){0})
      for (size_t r = 0; r < count; r++)
        if (seeds[r] == seed) {
          of_datum[r] = fit_transform(datum, value);
          ask_doubts_add(&fit->doubts[k], &one);
        }
    TRY(answer_end(&runs));
  }
  if (point) {
    OWNED char *own = NULL;
    FILE *out = text_open(&own);
    for (size_t r = 0; out && r < count; r++)
      fprintf(out, "%s%" PRId64, r ? ", " : "seed IN (", (int64_t)seeds[r]);
    if (!out || fputc(')', out) == EOF || !text_close(out, &own))
      return status_fail(error, STATUS_MEMORY, "out of memory");
    TRY(ask_doubts(store, &(struct ask_doubts_choice){.point = point, .where = own}, results, &fit->all_doubts, error));
  }
  fit->all_doubts.chosen = NULL; /* it is the store's, which is closed when the answer is drawn */
  return STATUS_OK;
}

/* Reads the replicates of the shot's data at z. A point that cannot be run has no values. */
static status read_point(struct fit *fit, struct store *store, const double *z, double *values, struct error *error) {
  const size_t count = fit->replicates;
  struct error invalid = {0};
  SCENE scene = scene_of(fit, z, &invalid);
  OWNED uint64_t *seeds = NULL;
  int64_t point = 0;
  TRY(memory_array(&seeds, count, sizeof *seeds, "a point", error));
  for (size_t r = 0; scene && r < count; r++)
    seeds[r] = campaign_seed(fit->campaign, scene, (int64_t)r);
  if (scene)
    TRY(store_point_find(store, scene, &point, error));
  return read_data(fit, store, scene, point, seeds, values, error);
}

/* ---- after a round ---- */

/* Moves the ensemble by one Kalman step. The final round follows when the data have their full weight or no rounds are
 * left. */
static status move_ensemble(struct fit *fit, struct error *error) {
  const size_t d = fit->observed->datum_count, from = fit->points - fit->members;
  OWNED double *g = NULL, *packed = NULL;
  TRY(memory_array(&g, fit->members * d, sizeof *g, "a round", error));
  TRY(memory_array(&packed, fit->points * d * fit->replicates, sizeof *packed, "a round", error));
  const struct surfaces_runs runs = fit_runs(fit, packed);
  for (size_t j = 0; j < fit->members; j++)
    for (size_t k = 0; k < d; k++)
      g[j * d + k] = surfaces_mean(&runs, k, from + j);
  TRY(fit_errors(fit, error));
  TRY(surfaces_errors(&runs, fit->data, fit->bounded, fit->members, fit->gamma, error));
  double y[OBSERVED_DATA];
  for (size_t k = 0; k < d; k++)
    y[k] = fit->data[k].value;
  fit->ensemble.g = g;
  fit->ensemble.y = y;
  fit->ensemble.round = fit->rounds;
  fit->ensemble.least = (1 - fit->ensemble.tempered) / (double)(fit->rule.rounds - 1 - (int64_t)fit->rounds);
  const status code = ensemble_kalman_step(&fit->ensemble, error);
  fit->ensemble.g = fit->ensemble.y = NULL;
  return code;
}

/* Draws the members of the next round from the posterior, evenly by weight. */
static status draw_from_posterior(struct fit *fit, struct error *error) {
  TRY(fit_solve(fit, error));
  for (size_t j = 0; j < fit->members; j++) {
    const double p = random_draw(fit->rule.seed, RANDOM_INFERENCE, UINT64_C(1) << 60, j);
    const size_t node = posterior_node(&fit->posterior, ((double)j + p) / (double)fit->members);
    for (size_t i = 0; i < fit->inputs; i++)
      fit->place[j * fit->inputs + i] = fmin(fmax(fit->posterior.z[node * fit->inputs + i], -3.5), 3.5);
  }
  return STATUS_OK;
}

static void tell(const struct fit *fit) {
  char text[256];
  if (!fit->rule.note)
    return;
  snprintf(text, sizeof text, "round %zu: %zu points, %.0f %% of the data used", fit->rounds, fit->points,
           100 * fit->ensemble.tempered);
  fit->rule.note(fit->rule.note_context, text);
}

static status after_ensemble(struct fit *fit, struct error *error) {
  fit->rounds++;
  switch (fit->phase) {
  case FIT_ENSEMBLE:
    TRY(move_ensemble(fit, error));
    if (fit->ensemble.tempered > 1 - 1e-9)
      fit->phase = FIT_ARRIVED;
    break;
  case FIT_ARRIVED:
    TRY(draw_from_posterior(fit, error));
    fit->phase = FIT_REFINED;
    break;
  default: fit->phase = FIT_DONE; break;
  }
  tell(fit);
  return STATUS_OK;
}

/* Are the inputs the same to the digits that they are written with? */
static bool same_place(const struct fit *fit, const double *a, const double *b) {
  for (size_t i = 0; i < fit->inputs; i++) {
    struct field_value p, q;
    fit_value(fit, i, a[i], &p);
    fit_value(fit, i, b[i], &q);
    if (!field_same_value(fit->campaign->axes[fit->axis[i]].row, &p, &q))
      return false;
  }
  return true;
}

/* Was member j drawn at the place of an earlier point? A narrow ensemble or posterior has few places. Its runs are the
 * same, and would be counted twice. */
static bool is_copy(const struct fit *fit, size_t j) {
  const double *place = fit->place + j * fit->inputs;
  bool copy = false;
  for (size_t i = 0; i < fit->points && !copy; i++)
    copy = same_place(fit, fit->z + i * fit->inputs, place);
  for (size_t i = 0; i < j && !copy; i++)
    copy = same_place(fit, fit->place + i * fit->inputs, place);
  return fit->phase != FIT_ENSEMBLE && copy; /* a Kalman step needs every member */
}

static status end_round(void *context, const struct scheduler *scheduler, struct error *error) {
  struct fit *fit = context;
  const size_t size = fit->observed->datum_count * fit->replicates; /* values of a point */
  size_t kept = fit->points;
  const bool last = fit->shot + 1 == fit->observed->shot_count;
  for (size_t j = 0; j < fit->members; j++) {
    const double *place = fit->place + j * fit->inputs;
    if (is_copy(fit, j))
      continue;
    TRY(read_point(fit, scheduler->store, place, fit->values + kept * size, error));
    if (last)
      memcpy(fit->z + kept * fit->inputs, place, fit->inputs * sizeof *fit->z);
    kept++;
  }
  fit->shot = last ? 0 : fit->shot + 1;
  if (!last)
    return STATUS_OK;
  fit->points = kept;
  return after_ensemble(fit, error);
}

/* ---- what the inputs tell before any run ---- */

/* The condition on the inputs that withholds the datum, if one does at each member, whatever the end finds; else NULL.
 */
static const struct condition *find_withheld(struct fit *fit, const struct observed_datum *datum) {
  const struct condition *found = NULL;
  fit->shot = datum->shot;
  for (size_t j = 0; j < fit->members; j++) {
    struct error invalid = {0};
    SCENE scene = scene_of(fit, fit->place + j * fit->inputs, &invalid);
    const struct condition *list = scene ? scene->kind->conditions : NULL;
    const condition_set broken = scene ? condition_before(list, scene->inputs, NULL) : 0;
    if (!scene)
      continue; /* a point that cannot run has no values */
    found = NULL;
    for (size_t k = 0; k < CONDITION_MOST && broken >> k; k++) {
      const struct condition one[2] = {list[k], {.word = NULL}};
      const bool unsure = list[k].unsure && list[k].unsure(scene->inputs);
      if (broken >> k & 1 && !unsure &&
          condition_mark(one, one[0].word, ask_specimens_result(&datum->ask)) == CONDITION_WITHHELD)
        found = &list[k];
    }
    if (!found)
      break;
  }
  fit->shot = 0;
  return found;
}

static status check_withheld(struct fit *fit, struct error *error) {
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct condition *row = find_withheld(fit, &fit->observed->data[k]);
    char label[2 * FIELD_TEXT_SIZE], says[CONDITION_SAYS];
    if (!row)
      continue;
    observed_label(fit->observed, k, label, sizeof label);
    return status_fail(error, STATUS_CONTENT,
                       "%s: every run withholds it: %s (clast explain %s); %s, or take another quantity", label,
                       condition_says(row, says), row->word, row->remedy);
  }
  return STATUS_OK;
}

/* ---- from the documents to the report ---- */

struct launching { /* the two documents, and what is made from them */
  struct campaign *campaign;
  struct observed *observed;
  struct fit *fit;
};

static void end_launching(struct launching *launching) {
  fit_free(launching->fit);
  observed_free(launching->observed);
  campaign_free(launching->campaign);
}

static status run_fit(struct fit *fit, const struct fit_launch *options, const struct command_line *line,
                      struct error *error) {
  LAUNCH launch = {0};
  TRY(launch_begin(&launch, fit->campaign, &options->launch, line, error));
  const struct series series = {.context = fit, .limits = fit->campaign, .next = next_round, .done = end_round};
  if (launch.manager && !launch.notes.quiet)
    fprintf(stderr, "clast: at most %" PRId64 " runs in %" PRId64 " rounds\n",
            (int64_t)(fit->observed->shot_count * fit->members * fit->replicates) * options->rounds, options->rounds);
  const status code = launch_series(&launch, &series, true, error);
  if (!launch.manager || code != STATUS_OK)
    return code;
  TRY(fit_find(fit, error));
  TRY(fit_print(fit, line->format, error));
  return options->picture ? fit_print_picture(fit, options->picture, &options->chart, error) : STATUS_OK;
}

status fit_rounds_launch(const struct command_line *line, const struct fit_launch *options, struct error *error) {
  __attribute__((cleanup(end_launching))) struct launching launching = {0};
  struct launch_notes notes = {.quiet = options->launch.quiet};
  const struct fit_rule rule = {.rounds = options->rounds,
                                .seed = (uint64_t)options->seed,
                                .note = launch_note,
                                .note_context = &notes};
  char scene[2 * FIELD_TEXT_SIZE]; /* path from the current folder */
  TRY(campaign_load(line->arguments[1], &launching.campaign, error));
  struct campaign *campaign = launching.campaign;
  TRY(observed_load(line->arguments[0], campaign, &launching.observed, error));
  driver_list_reference(campaign, line->arguments[1], scene, sizeof scene);
  if (!campaign->independent_given)
    campaign->independent = true; /* seeds that act alike at all points would be few specimens */
  if (options->store)
    snprintf(campaign->store, sizeof campaign->store, "%s", options->store);
  TRY(fit_create(campaign, launching.observed, &rule, scene, &launching.fit, error));
  option_words(line->arguments[1], &(struct option_list){0}, options->store, launching.fit->words,
               sizeof launching.fit->words);
  TRY(check_withheld(launching.fit, error));
  return run_fit(launching.fit, options, line, error);
}
