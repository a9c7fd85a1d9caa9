/* Reads the quantity from groups of runs, or fits the exponent of each point. */
#include "campaign/charts/charts.h"

#include <stdio.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "campaign/terminal/uncertainty.h"
#include "db/ask/columns.h"
#include "db/ask/group.h"
#include "db/ask/point.h"
#include "db/ask/points.h"
#include "engine/outcome.h"

/* Columns of ask_group after the axes. */
enum { VERSION = 1, MEAN = 6, HALF_WIDTH = 9, RESOLUTION = 10, COLUMNS = 12 };

enum { QUANTITY_AXES = 64 };

struct reading {
  struct store *store;
  const struct quantity_choice *choice;
  struct quantity *quantity;
  enum exponent_method method;
  enum estimates_window window;
  struct ask_column written[QUANTITY_AXES]; /* the varied inputs, in the units that the campaign gives */
  size_t written_count;
  const struct ask_column *axis[2]; /* the written unit of each axis; NULL: SI */
  status (*each)(void *context, const struct quantity_row *row, struct error *error);
  void *context;
};

static const struct ask_column *written_axis(const struct reading *reading, const char *name) {
  for (size_t i = 0; i < reading->written_count; i++)
    if (strcmp(reading->written[i].name, name) == 0)
      return &reading->written[i];
  return NULL;
}

/* Passes a row to the caller, its inputs in the campaign's units. */
static status give(const struct reading *reading, struct quantity_row *row, struct error *error) {
  struct query_value inputs[2];
  for (size_t i = 0; i < reading->quantity->axes; i++)
    inputs[i] = reading->axis[i] ? ask_columns_value(reading->axis[i], &row->input[i]) : row->input[i];
  row->input = inputs;
  return reading->each(reading->context, row, error);
}

/* Takes the names of the inputs and of the quantity from the columns of ask_group. */
static status read_names(struct reading *reading, const struct answer *groups, struct error *error) {
  struct quantity *quantity = reading->quantity;
  const size_t axes = quantity->axes;
  if (answer_count(groups) != axes + COLUMNS ||
      (axes == 2 && strcmp(answer_name(groups, 0), answer_name(groups, 1)) == 0))
    return status_fail(error, STATUS_USAGE, "%s", reading->choice->refusal);

  for (size_t i = 0; i < axes; i++) {
    snprintf(quantity->column[i], sizeof quantity->column[i], "%s", answer_name(groups, i));
    reading->axis[i] = written_axis(reading, quantity->column[i]);
  }
  const char *mean = answer_name(groups, axes + MEAN);
  if (!quantity->exponent)
    snprintf(quantity->name, sizeof quantity->name, "%.*s", (int)(strlen(mean) - strlen("_mean")), mean);
  return STATUS_OK;
}

static status read_groups(struct reading *reading, struct answer *groups, struct error *error) {
  const size_t axes = reading->quantity->axes;
  while (answer_next(groups)) {
    const struct query_value inputs[2] = {answer_value(groups, 0), answer_value(groups, axes - 1)};
    const double mean = answer_real(groups, axes + MEAN);
    const double half_width = answer_real(groups, axes + HALF_WIDTH); /* NaN for one run */
    struct quantity_row row = {inputs,
                               answer_integer(groups, axes + VERSION),
                               mean,
                               mean - half_width,
                               mean + half_width,
                               answer_real(groups, axes + RESOLUTION)};
    TRY(give(reading, &row, error));
  }
  return answer_end(groups);
}

static status read_exponents(struct reading *reading, struct error *error) {
  const char *inputs[2] = {reading->quantity->column[0], reading->quantity->column[1]};
  const bool newest = reading->choice->newest;
  ANSWER points = ask_points_rows(reading->store, &(struct ask_points_choice){0}, newest, reading->quantity->axes,
                                  inputs, error);
  for (struct ask_points_row point; ask_points_next(&points, &point);) {
    struct pooled_exponent fit;
    struct ask_resolution resolution;
    if (point.n == 0 && !newest)
      continue;
    TRY(point_exponent(reading->store, point.point_id, newest ? 0 : point.results_version, reading->method,
                       reading->window, 0.95, &fit, error));
    TRY(ask_resolution(reading->store, point.point_id, reading->choice->name, &resolution, error));
    const double half_width = fit.interval.half_width;
    struct quantity_row row = {point.inputs,
                               point.results_version,
                               fit.fit.beta,
                               fit.fit.beta - half_width,
                               fit.fit.beta + half_width,
                               resolution.half_width};
    TRY(give(reading, &row, error));
  }
  return answer_end(&points);
}

status quantity_read(struct store *store, const struct quantity_choice *choice, struct quantity *quantity,
                     status (*each)(void *context, const struct quantity_row *row, struct error *error), void *context,
                     struct error *error) {
  struct reading reading = {.store = store, .choice = choice, .quantity = quantity, .each = each, .context = context};
  *quantity = (struct quantity){.axes = choice->axis[1] ? 2 : 1};
  snprintf(quantity->name, sizeof quantity->name, "%s", choice->name);
  TRY(estimates_named(choice->name, &quantity->exponent, &reading.method, &reading.window, error));
  TRY(ask_columns_axes(store, true, QUANTITY_AXES, reading.written, &reading.written_count, error));
  char by[600];
  snprintf(by, sizeof by, "%s%s%s", choice->axis[0], choice->axis[1] ? "," : "",
           choice->axis[1] ? choice->axis[1] : "");
  ANSWER groups = ask_group(store, by, quantity->exponent ? OUTCOME_DEFAULT : choice->name, quantity->pooled, error);
  TRY(answer_status(&groups));
  TRY(read_names(&reading, &groups, error));
  if (!quantity->exponent)
    return read_groups(&reading, &groups, error);
  quantity->pooled[0] = '\0'; /* exponents belong to single points */
  return read_exponents(&reading, error);
}

void quantity_tell_resolution(struct store *store, const char *name, const char *pooled) {
  struct ask_resolution resolution;
  char text[UNCERTAINTY_TEXT];
  if (ask_resolution(store, 0, name, &resolution, NULL))
    return;
  uncertainty_resolution(&resolution, text);
  fprintf(stderr, "clast: %s: intervals are over %s (95 %%); %s\n", name, *pooled ? "points" : "seeds", text);
}

void quantity_tell_resolutions(struct store *store, const char *names, const char *pooled) {
  char name[128];
  if (strcmp(names, "main") == 0)
    names = OUTCOME_DEFAULT;
  while (*names) {
    const size_t length = strcspn(names, ",");
    snprintf(name, sizeof name, "%.*s", (int)length, names);
    quantity_tell_resolution(store, name + strspn(name, " "), pooled);
    names += length + (names[length] == ',');
  }
}
