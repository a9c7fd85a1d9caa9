/* The fit's state: priors and data in the form that the algebra needs, and the solution from all runs. */
#include "campaign/fit/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

double fit_transform(const struct observed_datum *datum, double value) {
  return datum->ask.kind == ASK_SPECIMENS_COUNT ? log1p(value) : value;
}

double fit_back(const struct observed_datum *datum, double transformed) {
  return datum->ask.kind == ASK_SPECIMENS_COUNT ? expm1(transformed) : transformed;
}

/* Six digits: the document of a round stays readable, and its values read back as the same bits. */
void fit_value(const struct fit *fit, size_t input, double z, struct field_value *value) {
  const struct design_axis *axis = &fit->campaign->axes[fit->axis[input]];
  struct field_value low, high, rounded;
  char text[32];
  design_axis_quantile(axis, posterior_share(z), value);
  if (value->kind != FIELD_REAL)
    return;
  design_axis_quantile(axis, 0, &low);
  design_axis_quantile(axis, 1, &high);
  snprintf(text, sizeof text, "%.6g", value->number);
  rounded = *value;
  rounded.number = strtod(text, NULL);
  if (rounded.number >= low.number && rounded.number <= high.number)
    *value = rounded;
}

double fit_number(const struct fit *fit, size_t input, double z) {
  struct field_value value;
  design_axis_quantile(&fit->campaign->axes[fit->axis[input]], posterior_share(z), &value);
  return field_number(&value);
}

/* ---- from the documents ---- */

static status check_campaign(const struct campaign *campaign, struct error *error) {
  const int kind = campaign->design.kind;
  if (kind == CAMPAIGN_GRID || kind == CAMPAIGN_LIST)
    return status_fail(error, STATUS_CONTENT,
                       "a fit begins with random points from the priors: give the campaign `design: {kind: "
                       "latin_hypercube, points: 40}` and laws such as {log_uniform: [a, b]} in `vary`");
  if (campaign->design.points < FIT_FEWEST_MEMBERS)
    return status_fail(error, STATUS_CONTENT,
                       "design.points is %lld; an ensemble has at least %d members, better 20 to "
                       "100",
                       (long long)campaign->design.points, FIT_FEWEST_MEMBERS);
  if (campaign->per_point < 2)
    return status_fail(error, STATUS_CONTENT,
                       "a fit needs the scatter over seeds: give `seeds: {per_point: N}` with N of at least 2, better "
                       "3 to 10");
  return STATUS_OK;
}

static status find_inputs(struct fit *fit, struct error *error) {
  const struct campaign *campaign = fit->campaign;
  for (size_t i = 0; i < campaign->axis_count; i++) {
    const struct design_axis *axis = &campaign->axes[i];
    if (axis->kind == DESIGN_AXIS_LINKED)
      continue;
    if (axis->kind == DESIGN_AXIS_LEVELS)
      return status_fail(error, STATUS_CONTENT,
                         "vary.%s is a list of values; a fit needs a prior law: {uniform: [a, b]}, {log_uniform: [a, "
                         "b]}, {normal: ...} or {lognormal: ...}",
                         axis->row->path);
    if (fit->inputs == INFERENCE_INPUTS)
      return status_fail(error, STATUS_CONTENT, "more than %d unknown inputs", INFERENCE_INPUTS);
    fit->bounded[fit->inputs] = axis->kind == DESIGN_AXIS_UNIFORM || axis->kind == DESIGN_AXIS_LOG_UNIFORM;
    fit->axis[fit->inputs++] = i;
  }
  return fit->inputs ? STATUS_OK
                     : status_fail(error, STATUS_CONTENT,
                                   "the campaign varies nothing: give the unknown inputs in `vary`, with their priors");
}

/* For a count N, ln(1 + N) has the error dN / (1 + N). */
static double slope_of(const struct observed_datum *datum) {
  return datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 / (1 + datum->value) : 1;
}

static void find_data(struct fit *fit) {
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *from = &fit->observed->data[k];
    const double slope = slope_of(from);
    fit->counts[k] = from->ask.kind == ASK_SPECIMENS_COUNT || (from->ask.row && from->ask.row->kind == FIELD_INTEGER);
    fit->data[k] = (struct posterior_datum){.value = fit_transform(from, from->value),
                                            .error = from->error * slope,
                                            .resolution = isnan(from->resolution) ? 0 : from->resolution * slope,
                                            .specimens = (size_t)fit->observed->shots[from->shot].specimens,
                                            .shot = from->shot};
    fit->resolution[k] = (struct ask_resolution){.verdict = ASK_RESOLUTION_NOT_STUDIED, .half_width = NAN};
  }
}

static status allocate(struct fit *fit, struct error *error) {
  fit->members = (size_t)fit->campaign->design.points;
  fit->replicates = (size_t)fit->campaign->per_point;
  fit->capacity = fit->members * (size_t)fit->rule.rounds;
  const size_t d = fit->observed->datum_count;
  TRY(memory_array(&fit->z, fit->capacity * fit->inputs, sizeof(double), "a fit", error));
  TRY(memory_array(&fit->values, fit->capacity * d * fit->replicates, sizeof(double), "a fit", error));
  return memory_array(&fit->place, fit->members * fit->inputs, sizeof(double), "a fit", error);
}

/* Makes the first ensemble: the points of `clast run` for this campaign. */
static status draw_members(struct fit *fit, struct error *error) {
  CAMPAIGN_WALK walk = {0};
  TRY(campaign_walk_begin(&walk, fit->campaign, error));
  for (size_t j = 0; j < fit->members && campaign_walk_next(&walk); j++)
    for (size_t i = 0; i < fit->inputs; i++) {
      const size_t a = fit->axis[i];
      fit->place[j * fit->inputs + i] = posterior_coordinate(
          design_axis_share(&fit->campaign->axes[a], &walk.values[a]));
    }
  return STATUS_OK;
}

status fit_create(const struct campaign *campaign, const struct observed *observed, const struct fit_rule *rule,
                  const char *scene_reference, struct fit **out, struct error *error) {
  TRY(memory_array(out, 1, sizeof **out, "a fit", error));
  struct fit *fit = *out;
  fit->campaign = campaign;
  fit->observed = observed;
  fit->scene_reference = scene_reference;
  fit->rule = *rule;
  TRY(check_campaign(campaign, error));
  TRY(find_inputs(fit, error));
  TRY(allocate(fit, error));
  TRY(draw_members(fit, error));
  find_data(fit);
  fit->ensemble = (struct ensemble_kalman){.members = fit->members,
                                           .inputs = fit->inputs,
                                           .outputs = observed->datum_count,
                                           .z = fit->place,
                                           .gamma = fit->gamma,
                                           .seed = rule->seed};
  return STATUS_OK;
}

void fit_free(struct fit *fit) {
  if (!fit)
    return;
  free(fit->z);
  free(fit->values);
  free(fit->place);
  surfaces_clear(&fit->surfaces);
  posterior_clear(&fit->posterior);
  free(fit);
}

/* ---- the solution ---- */

struct surfaces_runs fit_runs(const struct fit *fit, double *packed) {
  const size_t d = fit->observed->datum_count, r = fit->replicates;
  for (size_t i = 0; i < fit->points; i++)
    for (size_t k = 0; k < d; k++)
      memcpy(packed + (k * fit->points + i) * r, fit->values + (i * d + k) * r, r * sizeof *packed);
  return (struct surfaces_runs){.points = fit->points,
                                .inputs = fit->inputs,
                                .outputs = d,
                                .replicates = r,
                                .z = fit->z,
                                .values = packed,
                                .shared_seeds = !fit->campaign->independent};
}

static bool seeds_differ(const struct fit *fit, size_t datum) {
  const size_t d = fit->observed->datum_count, r = fit->replicates;
  for (size_t i = 0; i < fit->points; i++) {
    const double *of_point = fit->values + (i * d + datum) * r;
    for (size_t j = 1; j < r; j++)
      if (of_point[j] != of_point[0] && isfinite(of_point[j]) && isfinite(of_point[0]))
        return true;
  }
  return false;
}

/* Fails if no point has two runs with a value of a datum, and says what withholds them. */
static status check_scatter(const struct fit *fit, size_t datum, struct error *error) {
  const size_t d = fit->observed->datum_count, r = fit->replicates;
  const struct ask_doubts *doubts = &fit->doubts[datum];
  char label[2 * FIELD_TEXT_SIZE], why[400] = "give more seeds (seeds.per_point), or another quantity";
  for (size_t i = 0; i < fit->points; i++) {
    size_t values = 0;
    for (size_t j = 0; j < r; j++)
      values += isfinite(fit->values[(i * d + datum) * r + j]) != 0;
    if (values > 1)
      return STATUS_OK;
  }
  observed_label(fit->observed, datum, label, sizeof label);
  for (size_t k = 0; k < doubts->count; k++)
    if (doubts->word[k].row && doubts->word[k].row->withheld)
      snprintf(why, sizeof why,
               "it is withheld in %lld of %lld runs: %s (clast explain %s); %s, or take another quantity",
               (long long)doubts->word[k].runs, (long long)doubts->runs, doubts->word[k].word, doubts->word[k].word,
               doubts->word[k].row->remedy);
  return status_fail(error, STATUS_CONTENT,
                     "%s: no point has two runs with a value, so its scatter over seeds is not known: %s", label, why);
}

status fit_errors(struct fit *fit, struct error *error) {
  char label[2 * FIELD_TEXT_SIZE];
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *from = &fit->observed->data[k];
    const double slope = slope_of(from);
    TRY(check_scatter(fit, k, error));
    fit->data[k].error = from->error * slope;
    fit->exact[k] = !(from->error > 0) && !(fit->data[k].resolution > 0) && !seeds_differ(fit, k);
    if (!fit->exact[k])
      continue;
    observed_label(fit->observed, k, label, sizeof label);
    if (from->ask.kind != ASK_SPECIMENS_COUNT)
      return status_fail(error, STATUS_CONTENT,
                         "%s: it has no error, and no seed changes it, so one run would decide all: give it an `error` "
                         "above 0 (in `measured`)",
                         label);
    fit->data[k].error = slope;
  }
  return STATUS_OK;
}

status fit_solve(struct fit *fit, struct error *error) {
  OWNED double *packed = NULL;
  TRY(memory_array(&packed, fit->points * fit->observed->datum_count * fit->replicates, sizeof *packed, "a fit",
                   error));
  const struct surfaces_runs runs = fit_runs(fit, packed);
  surfaces_clear(&fit->surfaces);
  posterior_clear(&fit->posterior);
  TRY(fit_errors(fit, error));
  TRY(surfaces_fit(&runs, fit->data, fit->bounded, &fit->surfaces, error));
  return posterior_make(&fit->surfaces.model, fit->rule.seed, &fit->posterior, error);
}

status fit_find(struct fit *fit, struct error *error) {
  TRY(fit_solve(fit, error));
  identify_find(&fit->surfaces.model, &fit->posterior, &fit->found);
  return STATUS_OK;
}
