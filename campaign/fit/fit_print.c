/* A fit as tables, as sentences, and as a picture. The sentences say which inputs the data determine, which they do
 * not, and what the errors include. */
#include "campaign/fit/fit.h"

#include <math.h>
#include <string.h>

#include "campaign/terminal/words.h"
#include "schemas/unit.h"

enum { WIDTH = 110, LABEL = 2 * FIELD_TEXT_SIZE, PARAGRAPH = (OBSERVED_DATA + 4) * LABEL };

static const double levels[PICTURE_QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};

static const struct field *row_of(const struct fit *fit, size_t input) {
  return fit->campaign->axes[fit->axis[input]].row;
}

static double share_below(const struct fit *fit, size_t k, double transformed) {
  return posterior_below(&fit->surfaces.model, &fit->posterior, k, transformed);
}

/* Share of predicted experiments beyond this datum, on the side where fewer are. */
static double beyond(const struct fit *fit, size_t k) {
  /* A count takes half a fragment on either side, since the law of the prediction is smooth; a mean of n counts 1/2n.
   */
  const struct observed_datum *datum = &fit->observed->data[k];
  const double half = fit->counts[k] ? 0.5 / (double)fit->data[k].specimens : 0;
  return fmin(share_below(fit, k, fit_transform(datum, datum->value + half)),
              1 - share_below(fit, k, fit_transform(datum, datum->value - half)));
}

/* Does a measured value lie where no inputs within the priors lead? Then the posterior is where the priors end. Of many
 * data some are far off by chance. */
static bool is_outside(const struct fit *fit) {
  for (size_t k = 0; k < fit->observed->datum_count; k++)
    if (beyond(fit, k) < 0.025 / (double)fit->observed->datum_count)
      return true;
  return false;
}

/* ---- inputs ---- */

static void skip(struct table *table, int cells) {
  for (int i = 0; i < cells; i++)
    table_missing(table);
}

/* The campaign's unit of an input, else the SI unit; and the SI value of one of it. */
static double shown_unit(const struct fit *fit, size_t i, char text[64]) {
  struct unit unit;
  const char *written = fit->campaign->axes[fit->axis[i]].unit;
  const bool good = *written && unit_parse(written, &unit, NULL) == STATUS_OK;
  text_unit(good ? written : row_of(fit, i)->unit, text, 64);
  return good ? unit.factor : 1;
}

static void quantiles_of(const struct fit *fit, size_t i, double unit, double quantile[3]) {
  for (int q = 0; q < 3; q++)
    quantile[q] = fit_number(fit, i, posterior_quantile(&fit->posterior, i, levels[2 * q])) / unit;
}

/* q05, median, q95, for people in one cell. */
static void quantile_cells(struct table *table, bool people, const double *quantile, const struct ask_doubts *doubts) {
  if (!people) {
    table_reals(table, 3, quantile);
    return;
  }
  table_rests_on(table, doubts);
  table_interval(table, quantile[1], quantile[0], quantile[2]);
}

static void input_cells(const struct fit *fit, size_t i, double unit, bool people, struct table *table) {
  const double z05 = posterior_coordinate(0.05), z95 = posterior_coordinate(0.95);
  double quantile[3];
  table_reals(table, 2, (const double[]){fit_number(fit, i, z05) / unit, fit_number(fit, i, z95) / unit});
  if (is_outside(fit)) {
    skip(table, people ? 2 : 4);
    return;
  }
  quantiles_of(fit, i, unit, quantile);
  quantile_cells(table, people, quantile, &fit->all_doubts);
  table_fixed(table, fit->found.kept[i], 2);
}

static status print_inputs(const struct fit *fit, enum table_format format, struct error *error) {
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"input", "unit", NULL});
  table_column(table, "prior_05", NULL);
  table_rare(table);
  table_column(table, "prior_95", NULL);
  table_rare(table);
  table_columns(table, (const char *const[]){"median (q05 to q95)", "kept", NULL});
  for (size_t i = 0; i < fit->inputs; i++) {
    table_text(table, row_of(fit, i)->path);
    char unit[64];
    const double one = shown_unit(fit, i, unit);
    table_text(table, unit);
    input_cells(fit, i, one, true, table);
  }
  return table_end(table, error);
}

/* ---- what was measured ---- */

/* Standard deviation over seeds of a datum's specimens at the middle of the posterior, in the unit of the
 * measurement. */
static double seeds_of(const struct fit *fit, size_t k) {
  const struct observed_datum *datum = &fit->observed->data[k];
  double x[INFERENCE_INPUTS];
  posterior_place(&fit->surfaces.model, fit->found.centre, x);
  const double variance = seed_scatter_variance(&fit->surfaces.scatter[k], x) / (double)fit->data[k].specimens;
  if (variance < 1e-300) /* no seed changes it */
    return 0;
  return sqrt(variance) * (datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 + datum->value : 1);
}

/* A quantile of one more experiment, in the range of the quantity. The normal law of the scatter has no ends. What it
 * places beyond an end of the range is taken to be at that end, which only moves the quantiles that lie beyond it. */
static double predicted(const struct fit *fit, size_t k, double level) {
  const struct observed_datum *datum = &fit->observed->data[k];
  const double value = fit_back(datum, posterior_predicted(&fit->surfaces.model, &fit->posterior, k, level));
  switch (datum->ask.kind) {
  case ASK_SPECIMENS_RESULT: return fmin(fmax(value, datum->ask.row->minimum), datum->ask.row->maximum);
  case ASK_SPECIMENS_SHARE: return fmin(fmax(value, 0), 1);
  case ASK_SPECIMENS_COUNT: return fmax(value, 0);
  case ASK_SPECIMENS_EXPONENT: break; /* any number */
  }
  return value;
}

/* The value and its errors: sd_seeds and sd_resolution, in the unit of the measurement. For people the measured error
 * is in the cell of the value. */
static void value_cells(const struct fit *fit, size_t k, bool people, struct table *table) {
  const struct observed_datum *datum = &fit->observed->data[k];
  const double slope = datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 + datum->value : 1;
  const double errors[] = {datum->error, seeds_of(fit, k), fit->data[k].resolution * slope};
  if (!people) {
    table_real(table, datum->value);
    table_reals(table, 3, errors);
    return;
  }
  table_interval(table, datum->value, datum->value - errors[0], datum->value + errors[0]);
  for (int i = 1; i < 3; i++)
    table_interval(table, errors[i], NAN, NAN);
}

/* *below: does the table show this column? */
static status print_data(const struct fit *fit, enum table_format format, bool *below, struct error *error) {
  TABLE table = table_new(format, stdout);
  char label[LABEL];
  table_columns(table, (const char *const[]){"measured", "value \xc2\xb1 error", "sd_seeds", "sd_resolution",
                                             "median (q05 to q95)", "below", NULL});
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    observed_label(fit->observed, k, label, sizeof label);
    table_text(table, label);
    value_cells(fit, k, true, table);
    double quantile[3];
    for (int q = 0; q < 3; q++)
      quantile[q] = predicted(fit, k, levels[2 * q]);
    quantile_cells(table, true, quantile, &fit->doubts[k]);
    table_interval(table, share_below(fit, k, fit->data[k].value), NAN, NAN);
  }
  TRY(table_end(table, error));
  *below = !table_hides(table, "below");
  return STATUS_OK;
}

/* ---- for programs ---- */

static status print_rows(const struct fit *fit, enum table_format format, struct error *error) {
  TABLE table = table_new(format, stdout);
  char label[LABEL];
  table_columns(table, (const char *const[]){"kind", "name", "unit", "prior_05", "prior_95", "q05", "median", "q95",
                                             "kept", "value", "error", "sd_seeds", "sd_resolution", "below", NULL});
  table_doubt_columns(table);
  for (size_t i = 0; i < fit->inputs; i++) {
    table_text(table, "input");
    table_text(table, row_of(fit, i)->path);
    table_text(table, row_of(fit, i)->unit);
    input_cells(fit, i, 1, false, table);
    skip(table, 5);
    table_doubt_cells(table, &fit->all_doubts);
  }
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct field *row = fit->observed->data[k].ask.row;
    observed_label(fit->observed, k, label, sizeof label);
    table_text(table, "measured");
    table_text(table, label);
    table_text(table, row ? ask_result_unit(row, fit->campaign->scene->kind->dimensions) : "1");
    skip(table, 2);
    for (int q = 0; q < 3; q++)
      table_real(table, predicted(fit, k, levels[2 * q]));
    skip(table, 1);
    value_cells(fit, k, false, table);
    table_real(table, share_below(fit, k, fit->data[k].value));
    table_doubt_cells(table, &fit->doubts[k]);
  }
  return table_end(table, error);
}

/* ---- the sentences under the tables ---- */

static size_t count_mixed(const struct fit *fit, size_t direction) {
  size_t count = 0;
  for (size_t i = 0; i < fit->inputs; i++)
    count += identify_mixed(&fit->found, direction, i);
  return count;
}

/* "a, b and c" of the inputs that are part of a direction. */
static const char *list_mixed(const struct fit *fit, size_t direction, char text[PARAGRAPH]) {
  const size_t count = count_mixed(fit, direction);
  size_t written = 0;
  text[0] = '\0';
  for (size_t i = 0; i < fit->inputs; i++) {
    if (!identify_mixed(&fit->found, direction, i))
      continue;
    const char *before = written == 0 ? "" : written + 1 == count ? " and " : ", ";
    text_append(text, PARAGRAPH, "%s%s", before, row_of(fit, i)->path);
    written++;
  }
  return text;
}

/* The inputs at both ends of a direction: a standard deviation along it from the middle of the posterior. */
static const char *list_ends(const struct fit *fit, size_t direction, char text[PARAGRAPH]) {
  const struct identify_direction *d = &fit->found.direction[direction];
  text[0] = '\0';
  for (size_t i = 0; i < fit->inputs; i++) {
    if (!identify_mixed(&fit->found, direction, i))
      continue;
    const double z = fit->found.centre[i], step = d->deviation * d->along[i];
    char unit[64];
    const double one = shown_unit(fit, i, unit);
    text_append(text, PARAGRAPH, "%s%s from %.3g to %.3g%s%s", *text ? ", " : "", row_of(fit, i)->path,
                fit_number(fit, i, z - step) / one, fit_number(fit, i, z + step) / one,
                strcmp(unit, "1") == 0 || !*unit ? "" : " ", strcmp(unit, "1") == 0 ? "" : unit);
  }
  return text;
}

/* The interval of an input counts as that of its prior when it keeps this share of the prior's width. */
static const double AS_WIDE = 0.9;

/* Inputs whose posterior is narrow across a line, though wide along it: the two with the largest correlation, and the
 * line's ends at the 5 and 95 % quantiles of the first. `of`: only pairs with this input; fit->inputs: all. wide: as
 * the prior, or nearly. */
static bool tell_line(const struct fit *fit, size_t of, bool wide, FILE *out) {
  static const double LEAST = 0.8; /* correlation; our choice: the posterior then is a third as wide as long, or less */
  const size_t p = fit->inputs;
  double mean[INFERENCE_INPUTS], covariance[INFERENCE_INPUTS * INFERENCE_INPUTS], most = 0;
  size_t a = 0, b = 0;
  posterior_moments(&fit->posterior, mean, covariance);
  for (size_t i = 0; i < p; i++)
    for (size_t j = 0; j < i; j++) {
      const double r = covariance[i * p + j] / sqrt(covariance[i * p + i] * covariance[j * p + j]);
      if ((of == p || of == i || of == j) && fabs(r) > fabs(most)) {
        most = r;
        a = j;
        b = i;
      }
    }
  if (!(fabs(most) >= LEAST))
    return false;
  char unit[2][64], ends[2][200];
  for (int end = 0; end < 2; end++) {
    const double at = posterior_quantile(&fit->posterior, a, end ? 0.95 : 0.05);
    const double with = mean[b] + covariance[a * p + b] / covariance[a * p + a] * (at - mean[a]);
    const double one[2] = {shown_unit(fit, a, unit[0]), shown_unit(fit, b, unit[1])};
    for (int k = 0; k < 2; k++)
      unit[k][0] = strcmp(unit[k], "1") == 0 ? '\0' : unit[k][0];
    snprintf(ends[end], sizeof ends[end], "%.3g%s%s with %.3g%s%s", fit_number(fit, a, at) / one[0],
             *unit[0] ? " " : "", unit[0], fit_number(fit, b, with) / one[1], *unit[1] ? " " : "", unit[1]);
  }
  words_print(
      out, "",
      "RIDGE: %s and %s change together (correlation of the posterior %.2f): %s gives about the same as %s. %s. "
      "State the two together, or measure something that changes along it.",
      row_of(fit, a)->path, row_of(fit, b)->path, most, ends[0], ends[1],
      wide ? "The priors set the ends of this line"
           : "Where it ends may depend on the points of the fit: more points may lengthen it");
  return true;
}

static void tell_open_direction(const struct fit *fit, size_t direction, FILE *out) {
  char names[PARAGRAPH], ends[PARAGRAPH];
  const double information = fit->found.direction[direction].information, given = 100 * information / (1 + information);
  list_mixed(fit, direction, names);
  if (count_mixed(fit, direction) > 1) {
    words_print(
        out, "",
        "RIDGE: these data cannot tell %s apart. What was measured hardly changes while they change together: %s. "
        "Along this line %.0f %% of what is known comes from the data and the rest from the priors, which set its "
        "ends. State the inputs together, or measure something that changes along it.",
        names, list_ends(fit, direction, ends), given);
    return;
  }
  size_t input = 0;
  while (input + 1 < fit->inputs && !identify_mixed(&fit->found, direction, input))
    input++;
  if (tell_line(fit, input, true, out)) /* a steep line is nearly this input alone */
    return;
  if (fit->found.kept[input] >= AS_WIDE) /* whatever they tell near one place */
    words_print(out, "", "NOT DETERMINED: %s. Its interval is that of its prior.", names);
  else
    words_print(out, "",
                "NOT DETERMINED: %s. The data give %.0f %% of what is known of it, its prior the rest, and yet they "
                "exclude a part of its range (share of prior).",
                names, given);
}

/* What the data determine of several inputs together, though not of each. */
static void tell_together(const struct fit *fit, size_t direction, FILE *out) {
  char names[PARAGRAPH], ends[PARAGRAPH];
  bool ridge = false; /* along which each of them is known less */
  for (size_t i = fit->found.determined; i < fit->inputs; i++)
    ridge |= count_mixed(fit, i) > 1;
  if (count_mixed(fit, direction) > 1)
    words_print(out, "", "TOGETHER: the data determine %s together, to one standard deviation on either side%s: %s.",
                list_mixed(fit, direction, names), ridge ? " of the ridge below" : "", list_ends(fit, direction, ends));
}

/* The answer: each input with its interval, and what the data determine; or that no inputs give what was measured. */
static void tell_determined(const struct fit *fit, FILE *out) {
  const size_t known = fit->found.determined, p = fit->inputs;
  char found[PARAGRAPH] = "", unit[64];
  bool as_wide = false;
  if (is_outside(fit)) {
    words_print(out, "",
                "OUTSIDE: no inputs within the priors give %s (MISFIT below). The inputs have no interval (-): widen "
                "the priors, or ask what the model lacks.",
                fit->observed->datum_count > 1 ? "all that was measured" : "what was measured");
    return;
  }
  for (size_t i = 0; i < p; i++) {
    double quantile[3];
    quantiles_of(fit, i, shown_unit(fit, i, unit), quantile);
    char text[UNCERTAINTY_TEXT];
    uncertainty_interval(quantile[1], quantile[0], quantile[2], text);
    text_append(found, sizeof found, "%s%s %s%s%s", *found ? ", " : "", row_of(fit, i)->path, text, *unit ? " " : "",
                unit);
    as_wide = as_wide || fit->found.kept[i] >= AS_WIDE;
  }
  words_print(out, "", "%s: median and 90 %% interval.", found);
  const bool wide = as_wide || fit->found.widest > M_SQRT1_2;
  if (known == p && tell_line(fit, p, wide, out))
    return;
  if (known == p && wide)
    words_print(out, "", "The data tell more than the priors at most places, and yet they leave %s.",
                as_wide  ? "an input its whole range (share of prior): inputs that are far apart give what was measured"
                : p == 1 ? "the input more than half of the prior's variance"
                         : "a combination of inputs more than half of the prior's variance");
  else if (known == p)
    words_print(out, "", "The data determine %s: in every direction they tell more than the priors.",
                p == 1 ? "the input" : "all inputs");
  else
    words_print(out, "", "The data determine %zu combination%s of the %zu unknown input%s.", known,
                known == 1 ? "" : "s", p, p == 1 ? "" : "s");
  for (size_t i = 0; known < p && i < known; i++)
    tell_together(fit, i, out);
  for (size_t i = known; i < p; i++)
    tell_open_direction(fit, i, out);
}

static bool is_unstudied(const struct fit *fit, size_t k) {
  return isnan(fit->observed->data[k].resolution) && fit->resolution[k].verdict == ASK_RESOLUTION_NOT_STUDIED;
}

/* A number or a share of fragments above a mass is no result that `clast converge` knows. */
static bool has_study(const struct observed_datum *datum) {
  return datum->ask.kind != ASK_SPECIMENS_COUNT && datum->ask.kind != ASK_SPECIMENS_SHARE;
}

/* The command that studies the data of a shot: the campaign at the scene's own values of its unknown inputs. */
static void tell_study(const struct fit *fit, size_t s, FILE *out) {
  const struct observed_shot *shot = &fit->observed->shots[s];
  char command[PARAGRAPH] = "", names[PARAGRAPH] = "";
  size_t count = 0;
  for (size_t k = 0; k < fit->observed->datum_count && count < LIMITS_STUDY_QUANTITIES; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    if (datum->shot == s && is_unstudied(fit, k) && has_study(datum))
      text_append(names, sizeof names, "%s%s", count++ ? "," : "",
                  datum->ask.row ? datum->ask.row->path : datum->quantity);
  }
  if (count == 0)
    return;
  bool fits = text_append(command, sizeof command, "%s%s", fit->words, shot->set);
  for (size_t i = 0; i < fit->inputs; i++) {
    const struct design_axis *axis = &fit->campaign->axes[fit->axis[i]];
    struct field_value own;
    char value[FIELD_TEXT_SIZE], set[2 * FIELD_TEXT_SIZE];
    field_get(axis->row, shot->scene->inputs, &own);
    snprintf(set, sizeof set, "%s=%s", axis->row->path, design_axis_print(axis, &own, value, sizeof value));
    fits = fits && text_append(command, sizeof command, " --set") && text_append_word(command, sizeof command, set);
  }
  if (fits && text_append(command, sizeof command, " -Q %s", names))
    words_print(
        out, "",
        "RESOLUTION: a study tells it%s%s, at the scene's own values of the unknown inputs: `clast converge %s`",
        fit->observed->shot_count > 1 ? " of " : "", fit->observed->shot_count > 1 ? shot->name : "", command);
}

/* Names the data whose error of resolution is unknown, and what tells it. */
static void tell_not_studied(const struct fit *fit, FILE *out) {
  char names[PARAGRAPH] = "", label[LABEL];
  bool none = false;
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    if (!is_unstudied(fit, k))
      continue;
    observed_label(fit->observed, k, label, sizeof label);
    text_append(names, sizeof names, "%s %s", *names ? "," : "", label);
    none |= !has_study(&fit->observed->data[k]);
  }
  if (!*names)
    return;
  words_print(out, "",
              "RESOLUTION: what a finer resolution would change is not known and counts as 0 for%s. The intervals are "
              "too narrow. Give `resolution` with the value%s.",
              names,
              none ? ", or as a share in `fragments:` (resolution: 10 %); no study tells it of fragments above a mass"
                   : "");
  for (size_t s = 0; s < fit->observed->shot_count; s++)
    tell_study(fit, s, out);
}

static void tell_errors(const struct fit *fit, FILE *out) {
  size_t single = 0;
  for (size_t s = 0; s < fit->observed->shot_count; s++)
    single += fit->observed->shots[s].specimens == 1;
  if (single)
    words_print(
        out, "",
        "One experiment is one specimen: sd_seeds is the scatter between seeds, not the standard error of a mean, "
        "and the intervals hold it.");
  tell_not_studied(fit, out);
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    char label[LABEL];
    const struct ask_resolution *r = &fit->resolution[k];
    if (!isnan(fit->observed->data[k].resolution) || !(r->half_width > 0) || r->verdict == ASK_RESOLUTION_KNOWN)
      continue;
    observed_label(fit->observed, k, label, sizeof label);
    words_print(out, "",
                "RESOLUTION: %s %s; the study in the store tells an error of at least %.2g, which is in the intervals.",
                label,
                r->verdict == ASK_RESOLUTION_DIVERGES ? "does not converge"
                                                      : "has at least one knob in which no limit is seen",
                r->half_width);
  }
}

/* Where points share their seeds and a seed moves all of them alike, the scatter is that of few specimens, however many
 * points there are. Variances of P points with the correlation rho have 1 + (P - 1) rho^2 times the variance of
 * independent ones in their mean. Tells the datum of which least is known. */
static void tell_shared_seeds(const struct fit *fit, FILE *out) {
  enum { ENOUGH = 10 }; /* degrees of freedom: the standard deviation is known to a factor of 1.6 then */
  double least = ENOUGH;
  size_t datum = 0;
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct seed_scatter *scatter = &fit->surfaces.scatter[k];
    const double free = (double)scatter->freedom / (1 + ((double)fit->points - 1) * scatter->shared * scatter->shared);
    if (fit->exact[k] || !(free < least) ||
        !(2 * free < (double)scatter->freedom)) /* else the seeds are not the cause */
      continue;
    least = free;
    datum = k;
  }
  if (!(least < ENOUGH))
    return;
  char label[LABEL];
  observed_label(fit->observed, datum, label, sizeof label);
  words_print(out, "",
              "SEEDS: all points share %zu seeds, which move %s alike (correlation %.2g). So its scatter over seeds is "
              "known from about %.2g specimens, and may be %.2g times as large as sd_seeds; the intervals do not hold "
              "that. Leave `independent: false` out of the campaign: each point then has seeds of its own, and all "
              "runs are new.",
              fit->replicates, label, fit->surfaces.scatter[datum].shared, 1 + least, sample_deviation_factor(least));
}

/* Names the assumptions of the algebra that do not hold. */
static void tell_doubts(const struct fit *fit, FILE *out) {
  char label[LABEL];
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct seed_scatter *scatter = &fit->surfaces.scatter[k];
    const double below = share_below(fit, k, fit->data[k].value);
    observed_label(fit->observed, k, label, sizeof label);
    if (fit->exact[k])
      words_print(out, "", "NO SCATTER: no seed changes %s, and it has no error: an error of one fragment is assumed.",
                  label);
    /* For a normal law, skewness and excess have standard errors sqrt(6/n) and sqrt(24/n). */
    const double n = (double)scatter->freedom;
    char found[96] = "";
    if (fabs(scatter->skewness) > 4 * sqrt(6 / n))
      text_append(found, sizeof found, "skewness %.2g", scatter->skewness);
    if (fabs(scatter->excess) > 4 * sqrt(24 / n))
      text_append(found, sizeof found, "%sexcess kurtosis %.2g%s", *found ? ", " : "", scatter->excess,
                  scatter->excess < -1 ? ": two heaps" : "");
    if (*found)
      words_print(out, "",
                  "SCATTER: %s is not normal over seeds (%s), as the likelihood takes it to be. A sampler without a "
                  "formula (pyabc, on `clast serve`) fits without that.",
                  label, found);
    if (beyond(fit, k) < 0.025)
      words_print(out, "", "MISFIT: %s %s well: at most %.2g of predicted experiments lie %s it%s.",
                  fit->observed->datum_count > 1 ? "the inputs that suit all data together do not predict"
                                                 : "no inputs within the priors predict",
                  label, fmax(beyond(fit, k), 1e-4), below < 0.5 ? "below" : "above",
                  fit->counts[k] ? " or within half a fragment (column below: without the half)" : "");
    if (fit->surfaces.left_out[k] > 1.5)
      words_print(
          out, "",
          "SURFACE: for %s the points are missed by %.2g times what the surface says of its own error; more members "
          "or more seeds help.",
          label, fit->surfaces.left_out[k]);
  }
}

static void tell(const struct fit *fit, bool below, FILE *out) {
  tell_errors(fit, out);
  tell_shared_seeds(fit, out);
  tell_doubts(fit, out);
  words_print(out, "",
              "Surfaces through %zu points of %zu seeds in %zu rounds; posterior %s. share of prior: width of the 90 "
              "%% interval over "
              "that of the prior. %sSource of the data: %.200s",
              fit->points, fit->replicates, fit->rounds, fit->posterior.sampled ? "sampled" : "on a grid",
              below ? "below: share of predicted experiments below the value. " : "", fit->observed->source);
}

/* ---- the whole report ---- */

status fit_print(const struct fit *fit, enum table_format format, struct error *error) {
  if (!table_for_people(format))
    return print_rows(fit, format, error);
  tell_determined(fit, stdout);
  putchar('\n');
  TRY(print_inputs(fit, format, error));
  putchar('\n');
  bool below = false;
  TRY(print_data(fit, format, &below, error));
  putchar('\n');
  tell(fit, below, stdout);
  uncertainty_doubts(&fit->all_doubts, stderr);
  return STATUS_OK;
}

/* "shot 1: mass share of the largest fragment M1/M = 0.31". */
static void label_of(const struct fit *fit, size_t k, char *label, size_t size) {
  const struct observed_datum *datum = &fit->observed->data[k];
  const char *shot = fit->observed->shot_count > 1 ? fit->observed->shots[datum->shot].name : "";
  char name[CHARTS_LABEL];
  if (datum->ask.kind == ASK_SPECIMENS_COUNT)
    snprintf(name, sizeof name, "fragments above %.3g M", datum->share);
  else if (datum->ask.kind == ASK_SPECIMENS_SHARE)
    snprintf(name, sizeof name, "mass share of fragments above %.3g M", datum->share);
  else
    charts_label(datum->ask.row ? datum->ask.row->path : datum->quantity, name);
  snprintf(label, size, "%.40s%s%s = %.4g", shot, shot[0] ? ": " : "", name, datum->value);
}

status fit_print_picture(const struct fit *fit, const char *path, const struct chart_options *chart,
                         struct error *error) {
  static char labels[OBSERVED_DATA][LABEL];
  struct picture_prediction rows[OBSERVED_DATA];
  char title[LABEL];
  size_t unstudied = 0;
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    unstudied += is_unstudied(fit, k);
    const struct observed_datum *datum = &fit->observed->data[k];
    label_of(fit, k, labels[k], sizeof labels[k]);
    text_append(labels[k], sizeof labels[k], "%s", fit->doubts[k].doubtful ? " !" : "");
    rows[k] = (struct picture_prediction){.label = labels[k], .measured = datum->value, .error = datum->error};
    for (int q = 0; q < PICTURE_QUANTILES; q++)
      rows[k].quantile[q] = predicted(fit, k, levels[q]);
  }
  snprintf(title, sizeof title, "%s: one more experiment, as the fit predicts it", fit->observed->name);
  const struct picture_page page = charts_page(path, chart);
  char caption[CHARTS_LABEL] = "Over the posterior; with the scatter of specimens, the errors of measurement "
                               "and of the resolution";
  if (unstudied)
    text_append(caption, sizeof caption, ", which is not known for %zu of %zu numbers and counts as 0", unstudied,
                fit->observed->datum_count);
  charts_doubts(NULL, &fit->all_doubts, caption, sizeof caption);
  const struct picture_words words = {title, caption, "predicted over measured", NULL};
  return picture_predicted(&page, &words, fit->observed->datum_count, rows, error);
}
