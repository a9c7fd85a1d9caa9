/* A fit as tables and as a picture. The sentences are fit_tell.c. */
#include "campaign/fit/fit_print.h"

#include <math.h>

#include "campaign/fit/fit_tell.h"

static const double levels[PICTURE_QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};

static const struct field *row_of(const struct fit *fit, size_t input) {
  return fit->campaign->axes[fit->axis[input]].row;
}

/* ---- inputs ---- */

static void input_cells(const struct fit *fit, size_t i, bool check, struct table *table) {
  const double z05 = posterior_coordinate(0.05), z95 = posterior_coordinate(0.95);
  double z[3];
  for (int q = 0; q < 3; q++)
    z[q] = check ? approximate_quantile(&fit->check, i, levels[2 * q])
                 : posterior_quantile(&fit->posterior, i, levels[2 * q]);
  table_real(table, fit_number(fit, i, z05));
  table_real(table, fit_number(fit, i, z95));
  for (int q = 0; q < 3; q++)
    table_real(table, fit_number(fit, i, z[q]));
  table_real(table, (posterior_share(z[2]) - posterior_share(z[0])) / 0.9);
}

static const char *const input_columns[] = {"input",  "unit", "prior_05", "prior_95", "q05",
                                            "median", "q95",  "kept",     NULL};

static status print_inputs(const struct fit *fit, bool check, struct error *error) {
  struct table *table = table_new(TABLE_TEXT, stdout);
  table_columns(table, input_columns);
  for (size_t i = 0; i < fit->inputs; i++) {
    table_text(table, row_of(fit, i)->path);
    table_text(table, row_of(fit, i)->unit);
    input_cells(fit, i, check, table);
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
  return sqrt(variance) * (datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 + datum->value : 1);
}

static double predicted(const struct fit *fit, size_t k, double level) {
  return fit_back(&fit->observed->data[k], posterior_predicted(&fit->surfaces.model, &fit->posterior, k, level));
}

static void datum_cells(const struct fit *fit, size_t k, struct table *table) {
  const struct observed_datum *datum = &fit->observed->data[k];
  const double slope = datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 + datum->value : 1;
  table_real(table, datum->value);
  table_real(table, datum->error);
  table_real(table, seeds_of(fit, k));
  table_real(table, fit->data[k].resolution * slope);
  for (int q = 0; q < 3; q++)
    table_real(table, predicted(fit, k, levels[2 * q]));
  table_real(table, posterior_below(&fit->surfaces.model, &fit->posterior, k));
}

static const char *const datum_columns[] = {"measured", "value",  "error", "sd_seeds", "sd_resolution",
                                            "q05",      "median", "q95",   "below",    NULL};

static status print_data(const struct fit *fit, struct error *error) {
  struct table *table = table_new(TABLE_TEXT, stdout);
  char label[2 * FIELD_TEXT_SIZE];
  table_columns(table, datum_columns);
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    observed_label(fit->observed, k, label, sizeof label);
    table_text(table, label);
    datum_cells(fit, k, table);
  }
  return table_end(table, error);
}

/* ---- for programs ---- */

static void skip(struct table *table, int cells) {
  for (int i = 0; i < cells; i++)
    table_missing(table);
}

static void input_row(const struct fit *fit, size_t i, bool check, struct table *table) {
  table_text(table, check ? "check" : "input");
  table_text(table, row_of(fit, i)->path);
  table_text(table, row_of(fit, i)->unit);
  input_cells(fit, i, check, table);
  skip(table, 5);
}

static status print_rows(const struct fit *fit, enum table_format format, struct error *error) {
  struct table *table = table_new(format, stdout);
  char label[2 * FIELD_TEXT_SIZE];
  table_columns(table, (const char *const[]){"kind", "name", "unit", "prior_05", "prior_95", "q05", "median", "q95",
                                             "kept", "value", "error", "sd_seeds", "sd_resolution", "below", NULL});
  for (size_t i = 0; i < fit->inputs; i++)
    input_row(fit, i, false, table);
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    const double slope = datum->ask.kind == ASK_SPECIMENS_COUNT ? 1 + datum->value : 1;
    observed_label(fit->observed, k, label, sizeof label);
    table_text(table, "measured");
    table_text(table, label);
    table_text(table, datum->ask.row ? datum->ask.row->unit : "1");
    skip(table, 2);
    for (int q = 0; q < 3; q++)
      table_real(table, predicted(fit, k, levels[2 * q]));
    skip(table, 1);
    table_real(table, datum->value);
    table_real(table, datum->error);
    table_real(table, seeds_of(fit, k));
    table_real(table, fit->data[k].resolution * slope);
    table_real(table, posterior_below(&fit->surfaces.model, &fit->posterior, k));
  }
  for (size_t i = 0; fit->check.kept && i < fit->inputs; i++)
    input_row(fit, i, true, table);
  return table_end(table, error);
}

status fit_print(const struct fit *fit, enum table_format format, struct error *error) {
  if (format != TABLE_TEXT)
    return print_rows(fit, format, error);
  status code = print_inputs(fit, false, error);
  putchar('\n');
  if (code == STATUS_OK)
    code = print_data(fit, error);
  putchar('\n');
  if (code == STATUS_OK)
    fit_tell(fit, stdout);
  if (code == STATUS_OK && fit->check.kept) {
    printf("\nCheck without a formula for the likelihood (ABC, %zu runs nearest to the data, distance up to %.3g):\n",
           fit->check.kept, fit->check.tolerance);
    code = print_inputs(fit, true, error);
  }
  return code;
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
  static char labels[OBSERVED_DATA][2 * FIELD_TEXT_SIZE];
  struct picture_prediction rows[OBSERVED_DATA];
  char title[2 * FIELD_TEXT_SIZE];
  for (size_t k = 0; k < fit->observed->datum_count; k++) {
    const struct observed_datum *datum = &fit->observed->data[k];
    label_of(fit, k, labels[k], sizeof labels[k]);
    rows[k] = (struct picture_prediction){.label = labels[k], .measured = datum->value, .error = datum->error};
    for (int q = 0; q < PICTURE_QUANTILES; q++)
      rows[k].quantile[q] = predicted(fit, k, levels[q]);
  }
  snprintf(title, sizeof title, "%s: one more experiment, as the fit predicts it", fit->observed->name);
  const struct picture_page page = charts_page(path, chart);
  const struct picture_words words =
      {title, "Over the posterior; with the scatter of specimens, the errors of measurement and of the resolution",
       "predicted over measured", NULL};
  return picture_predicted(&page, &words, fit->observed->datum_count, rows, error);
}
