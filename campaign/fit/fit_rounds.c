/* The rounds of a fit as campaigns: one campaign for each shot of a round, a list of the members' inputs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign_write.h"
#include "campaign/fit/fit.h"
#include "campaign/fit/fit_values.h"
#include "engine/random.h"

int64_t fit_rounds_most(const struct fit *fit, bool check) {
  const int64_t shots = (int64_t)fit->observed->shot_count;
  int64_t specimens = 0;
  for (size_t s = 0; s < fit->observed->shot_count; s++)
    specimens += fit->observed->shots[s].specimens;
  return check ? fit->rule.check * (FIT_CHECK_ROUNDS + 1) / 2 * specimens
               : shots * fit->rule.rounds * (int64_t)(fit->members * fit->replicates);
}

/* ---- a round as campaigns ---- */

static bool is_check(const struct fit *fit) {
  return fit->phase == FIT_CHECKED;
}

/* The places of the current round, and their number. */
static const double *places(const struct fit *fit, size_t *count) {
  *count = is_check(fit) ? fit->proposed : fit->members;
  return is_check(fit) ? fit->check.z + fit->check.kept * fit->inputs : fit->place;
}

static status make_axes(const struct fit *fit, struct campaign *campaign, struct error *error) {
  size_t count;
  const double *z = places(fit, &count);
  campaign->axes = calloc(fit->campaign->axis_count, sizeof *campaign->axes);
  for (size_t i = 0; campaign->axes && i < fit->campaign->axis_count; i++) {
    struct design_axis *axis = &campaign->axes[campaign->axis_count++];
    *axis = (struct design_axis){.row = fit->campaign->axes[i].row,
                                 .kind = DESIGN_AXIS_LEVELS,
                                 .lower = -HUGE_VAL,
                                 .upper = HUGE_VAL};
    axis->levels = calloc(count, sizeof *axis->levels);
    axis->level_count = count;
    if (!axis->levels)
      return status_fail(error, STATUS_MEMORY, "no memory for a round");
  }
  if (!campaign->axes)
    return status_fail(error, STATUS_MEMORY, "no memory for a round");
  for (size_t j = 0; j < count; j++) {
    for (size_t i = 0; i < fit->inputs; i++)
      fit_value(fit, i, z[j * fit->inputs + i], &campaign->axes[fit->axis[i]].levels[j]);
    for (size_t i = 0; i < campaign->axis_count; i++) {
      const struct design_axis *from = &fit->campaign->axes[i];
      if (from->kind == DESIGN_AXIS_LINKED)
        design_axis_follow(from, &campaign->axes[from->linked].levels[j], 0, &campaign->axes[i].levels[j]);
    }
  }
  return STATUS_OK;
}

static status make_campaign(const struct fit *fit, struct campaign *campaign, struct error *error) {
  const struct observed_shot *shot = &fit->observed->shots[fit->shot];
  char comment[64];
  *campaign = *fit->campaign;
  campaign->axes = NULL; /* the fit's campaign owns these; they must not be freed twice */
  campaign->axis_count = 0;
  campaign->text = NULL;
  campaign->scene = scene_copy(shot->scene);
  campaign->design = (struct campaign_design_keys){.kind = CAMPAIGN_LIST};
  campaign->keep = CAMPAIGN_KEEP_NONE;
  if (is_check(fit)) {
    campaign->per_point = shot->specimens;
    campaign->independent = true; /* each particle is a specimen of its own */
  }
  snprintf(campaign->name, sizeof campaign->name, "%.100s %s %zu, %.100s", fit->campaign->name,
           is_check(fit) ? "check" : "fit", is_check(fit) ? fit->check_rounds + 1 : fit->rounds + 1, shot->name);
  if (!campaign->scene)
    return status_fail(error, STATUS_MEMORY, "no memory for a round");
  TRY(make_axes(fit, campaign, error));
  snprintf(comment, sizeof comment, "Written by clast fit: a round of its runs.");
  campaign->text = campaign_write_list(campaign, fit->scene_reference, comment);
  return campaign->text ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a round");
}

/* Reads the error of the resolution from a study in the store, for data without `resolution`. */
static status find_resolution(struct fit *fit, struct store *store, struct error *error) {
  status code = STATUS_OK;
  for (size_t k = 0; code == STATUS_OK && k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    char column[FIELD_TEXT_SIZE];
    int64_t point = 0;
    if (!isnan(datum->resolution))
      continue;
    field_column_name(datum->ask.row ? datum->ask.row->path : datum->quantity, column, sizeof column);
    code = store_point_find(store, fit->observed->shots[datum->shot].scene, &point, error);
    if (code == STATUS_OK && point)
      code = ask_resolution(store, point, column, &fit->resolution[k], error);
    if (code == STATUS_OK && isfinite(fit->resolution[k].half_width))
      fit->data[k].resolution = fit->resolution[k].half_width / 1.96;
  }
  return code;
}

struct campaign *fit_rounds_next(void *context, struct store *store, struct error *error) {
  struct fit *fit = context;
  if (fit->phase == FIT_DONE)
    return NULL;
  if (fit->rounds == 0 && fit->shot == 0) {
    error->status = find_resolution(fit, store, error);
    if (error->status != STATUS_OK)
      return NULL;
  }
  struct campaign *campaign = calloc(1, sizeof *campaign);
  error->status = campaign ? make_campaign(fit, campaign, error)
                           : status_fail(error, STATUS_MEMORY, "no memory for a round");
  if (error->status == STATUS_OK)
    return campaign;
  campaign_free(campaign);
  return NULL;
}

/* ---- after a round ---- */

/* Moves the ensemble by one Kalman step. The final round follows when the data have their full weight or no rounds are
 * left. */
static status move_ensemble(struct fit *fit, struct error *error) {
  const size_t d = fit->observed->datum_count, from = fit->points - fit->members;
  double *g = calloc(fit->members * d, sizeof *g), *packed = calloc(fit->points * d * fit->replicates, sizeof *packed);
  status code = g && packed ? STATUS_OK : status_fail(error, STATUS_MEMORY, "no memory for a round");
  if (code == STATUS_OK) {
    const struct surfaces_runs runs = fit_values_runs(fit, packed);
    for (size_t j = 0; j < fit->members; j++)
      for (size_t k = 0; k < d; k++)
        g[j * d + k] = surfaces_mean(&runs, k, from + j);
    code = surfaces_errors(&runs, fit->data, fit->bounded, fit->members, fit->gamma, error);
  }
  double y[OBSERVED_DATA];
  for (size_t k = 0; k < d; k++)
    y[k] = fit->data[k].value;
  fit->ensemble.g = g;
  fit->ensemble.y = y;
  fit->ensemble.round = fit->rounds;
  fit->ensemble.least = (1 - fit->ensemble.tempered) / (double)(fit->rule.rounds - 1 - (int64_t)fit->rounds);
  if (code == STATUS_OK)
    code = ensemble_kalman_step(&fit->ensemble, error);
  fit->ensemble.g = fit->ensemble.y = NULL;
  free(g);
  free(packed);
  return code;
}

/* Draws the members of the next round from the posterior, evenly by weight. */
static status draw_from_posterior(struct fit *fit, struct error *error) {
  const status code = fit_solve(fit, error);
  for (size_t j = 0; code == STATUS_OK && j < fit->members; j++) {
    const double p = random_draw(fit->rule.seed, RANDOM_INFERENCE, UINT64_C(1) << 60, j);
    const size_t node = posterior_node(&fit->posterior, ((double)j + p) / (double)fit->members);
    for (size_t i = 0; i < fit->inputs; i++)
      fit->place[j * fit->inputs + i] = fmin(fmax(fit->posterior.z[node * fit->inputs + i], -3.5), 3.5);
  }
  return code;
}

static void tell(const struct fit *fit) {
  char text[256];
  if (!fit->rule.note)
    return;
  if (is_check(fit))
    snprintf(text, sizeof text, "check %zu: distance %.3g, %.0f %% of the particles came nearer", fit->check_rounds,
             fit->check.tolerance, 100 * fit->check.accepted);
  else
    snprintf(text, sizeof text, "round %zu: %zu points, %.0f %% of the data taken in", fit->rounds, fit->points,
             100 * fit->ensemble.tempered);
  fit->rule.note(fit->rule.note_context, text);
}

static status after_ensemble(struct fit *fit, struct error *error) {
  status code = STATUS_OK;
  fit->rounds++;
  switch (fit->phase) {
  case FIT_ENSEMBLE:
    code = move_ensemble(fit, error);
    if (fit->ensemble.tempered > 1 - 1e-9)
      fit->phase = FIT_ARRIVED;
    break;
  case FIT_ARRIVED:
    code = draw_from_posterior(fit, error);
    fit->phase = FIT_REFINED;
    break;
  default: fit->phase = FIT_DONE; break;
  }
  if (code == STATUS_OK)
    tell(fit);
  if (fit->phase == FIT_DONE && fit->rule.check)
    fit->phase = FIT_CHECKED;
  if (code == STATUS_OK && fit->phase == FIT_CHECKED) {
    code = fit_solve(fit, error); /* its errors scale the distances */
    fit->proposed = approximate_propose(&fit->check);
  }
  return code;
}

/* Distance of each particle from the data, in units of the scatter and errors at the middle of the posterior. The
 * errors of measurement and resolution are drawn at random for each particle. */
static void find_distances(struct fit *fit, double *distance) {
  const size_t d = fit->observed->datum_count;
  double middle[INFERENCE_INPUTS], c[INFERENCE_INPUTS * INFERENCE_INPUTS];
  double mean[INFERENCE_OUTPUTS], spread[INFERENCE_OUTPUTS * INFERENCE_OUTPUTS];
  posterior_moments(&fit->posterior, middle, c);
  posterior_expect(&fit->surfaces.model, middle, mean, spread);
  for (size_t n = 0; n < fit->proposed; n++) {
    double squares = 0;
    for (size_t k = 0; k < d; k++) {
      const double own = hypot(fit->data[k].error, fit->data[k].resolution);
      const double u = random_draw(fit->rule.seed, RANDOM_INFERENCE, UINT64_C(1) << 59 | fit->check_rounds << 32 | n,
                                   k);
      const double value = fit->specimens[n * d + k] + own * posterior_coordinate(u);
      const double step = (value - fit->data[k].value) / sqrt(spread[k * d + k]);
      squares += step * step;
    }
    distance[n] = sqrt(squares);
  }
}

static status after_check(struct fit *fit, struct error *error) {
  double *distance = calloc(fit->proposed + 1, sizeof *distance);
  if (!distance)
    return status_fail(error, STATUS_MEMORY, "no memory for a check");
  find_distances(fit, distance);
  approximate_take(&fit->check, distance);
  free(distance);
  fit->check_rounds++;
  tell(fit);
  if (fit->check_rounds >= FIT_CHECK_ROUNDS || fit->check.accepted < 0.1)
    fit->phase = FIT_DONE;
  else
    fit->proposed = approximate_propose(&fit->check);
  return STATUS_OK;
}

status fit_rounds_done(void *context, struct store *store, struct error *error) {
  struct fit *fit = context;
  size_t count;
  const double *z = places(fit, &count);
  status code = STATUS_OK;
  if (is_check(fit))
    code = fit_values_check(fit, store, z, error);
  else
    code = fit_values_read(fit, store, z, error);
  if (code != STATUS_OK || ++fit->shot < fit->observed->shot_count)
    return code;
  fit->shot = 0;
  if (is_check(fit))
    return after_check(fit, error);
  memcpy(fit->z + fit->points * fit->inputs, fit->place, count * fit->inputs * sizeof *fit->z);
  fit->points += count;
  return after_ensemble(fit, error);
}
