/* Collects the lines of a plot and draws them. */
#include "campaign/charts/charts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LINES = PICTURE_SERIES, MOST_MEANS = 1000, LABEL = 600 };

struct line {
  char value[200]; /* value of the input that has one line for each value */
  int64_t version; /* results of different versions are different lines, never mixed */
  char label[LABEL];
  struct picture_mean *means; /* owned; room for MOST_MEANS */
  size_t count;
};

struct plot_lines {
  struct quantity quantity;
  struct line line[MOST_LINES];
  size_t count;
};

/* Finds the line of this value and version, or makes it. */
static status find_line(struct plot_lines *plot, const char *value, int64_t version, struct line **found,
                        struct error *error) {
  for (size_t i = 0; i < plot->count; i++) {
    *found = &plot->line[i];
    if (strcmp((*found)->value, value) == 0 && (*found)->version == version)
      return STATUS_OK;
  }
  if (plot->count == MOST_LINES)
    return status_fail(error, STATUS_USAGE, "a chart has at most %d lines: choose a --by with fewer values",
                       MOST_LINES);

  struct line *line = &plot->line[plot->count];
  line->means = malloc(MOST_MEANS * sizeof *line->means);
  if (!line->means)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  snprintf(line->value, sizeof line->value, "%s", value);
  line->version = version;
  plot->count++;
  *found = line;
  return STATUS_OK;
}

/* The value of the second axis, which names the line; "" without one. */
static void line_value(const struct plot_lines *plot, const struct quantity_row *row, char *value, size_t size) {
  const struct query_value *second = &row->input[1];
  value[0] = '\0';
  if (plot->quantity.axes != 2 || second->kind == QUERY_NULL)
    return;
  if (second->kind == QUERY_TEXT)
    snprintf(value, size, "%s", second->text);
  else
    snprintf(value, size, "%.6g", second->real);
}

static bool has_place(const struct line *line, double x) {
  for (size_t i = 0; i < line->count; i++)
    if (line->means[i].x == x)
      return true;
  return false;
}

static status add(void *context, const struct quantity_row *row, struct error *error) {
  struct plot_lines *plot = context;
  const struct query_value *x = &row->input[0];
  if (x->kind == QUERY_TEXT)
    return status_fail(error, STATUS_USAGE, "%s is no number, so it cannot be an axis: give it to --by",
                       plot->quantity.column[0]);
  if (x->kind == QUERY_NULL)
    return STATUS_OK; /* off, or does not apply: an axis of numbers cannot show it */

  char value[sizeof plot->line[0].value];
  struct line *line = NULL;
  line_value(plot, row, value, sizeof value);
  TRY(find_line(plot, value, row->results_version, &line, error));
  if (line->count == MOST_MEANS)
    return status_fail(error, STATUS_USAGE, "a line has at most %d points: choose an axis with fewer values",
                       MOST_MEANS);
  if (plot->quantity.exponent && has_place(line, x->real))
    return status_fail(
        error, STATUS_USAGE,
        "several points share %s = %g and one line, and their exponents cannot be averaged: separate them by --by",
        plot->quantity.column[0], x->real);
  line->means[line->count++] = (struct picture_mean){x->real, row->value, row->lower, row->upper, row->resolution};
  return STATUS_OK;
}

static int ascending(const void *a, const void *b) {
  double x = ((const struct picture_mean *)a)->x;
  double y = ((const struct picture_mean *)b)->x;
  return (x > y) - (x < y);
}

/* "weibull_k (1/m^3) = 5e+34"; the version is given only if there are several. */
static void label_lines(struct plot_lines *plot, const char *by) {
  bool several = false;
  for (size_t i = 1; i < plot->count; i++)
    several |= plot->line[i].version != plot->line[0].version;

  const bool two = plot->quantity.axes == 2;
  for (size_t i = 0; i < plot->count; i++) {
    struct line *line = &plot->line[i];
    char version[40] = "";
    char input[LABEL - sizeof version] = "";
    if (two && *line->value)
      snprintf(input, sizeof input, "%s = %s", by, line->value);
    else if (two)
      snprintf(input, sizeof input, "%s: none", by);
    if (several)
      snprintf(version, sizeof version, "%sresults_version %lld", two ? ", " : "", (long long)line->version);
    snprintf(line->label, sizeof line->label, "%s%s", input, version);
    qsort(line->means, line->count, sizeof *line->means, ascending);
  }
}

/* "threshold of beams in angle (rad): mean over seeds" */
static void title_of(const struct quantity *quantity, const char *y, char *title, size_t size) {
  char pooled[ASK_GROUP_POOLED], x[CHARTS_LABEL];
  charts_labels(quantity->pooled, pooled, sizeof pooled);
  charts_label(quantity->column[0], x);
  snprintf(title, size, "%s over %s: %s%s%s", y, x,
           quantity->exponent ? "fit to all runs of a point" : "mean over seeds", *pooled ? " and " : "", pooled);
  if (*title >= 'a' && *title <= 'z')
    *title = (char)(*title - 'a' + 'A');
}

static status draw(struct store *store, struct plot_lines *plot, const struct picture_page *page, struct error *error) {
  const struct quantity *quantity = &plot->quantity;
  char x[CHARTS_LABEL], by[CHARTS_LABEL] = "", y[CHARTS_LABEL], name[CHARTS_LABEL];
  char title[ASK_GROUP_POOLED + 3 * CHARTS_LABEL], caption[1200], intervals[600], resolution[400];
  status code = charts_axis(store, quantity->column[0], x, error);
  if (code == STATUS_OK && quantity->axes == 2)
    code = charts_axis(store, quantity->column[1], by, error);
  if (code == STATUS_OK)
    code = charts_axis(store, quantity->name, y, error);
  if (code)
    return code;
  label_lines(plot, by);
  struct picture_curve curves[MOST_LINES] = {0};
  for (size_t i = 0; i < plot->count; i++) {
    curves[i].label = *plot->line[i].label ? plot->line[i].label : NULL;
    curves[i].count = plot->line[i].count;
    curves[i].mean = plot->line[i].means;
  }
  charts_label(quantity->name, name);
  title_of(quantity, name, title, sizeof title);
  charts_intervals(quantity->pooled, intervals, sizeof intervals);
  charts_resolution(store, quantity->name, "thin bars add ", resolution, sizeof resolution);
  snprintf(caption, sizeof caption, "Bars: %s; %s", intervals, resolution);
  return picture_curves(page, &(struct picture_words){title, caption, x, y}, plot->count, curves, error);
}

status plot_lines_draw(struct store *store, const char *x, const char *by, const char *quantity,
                       const struct picture_page *page, struct error *error) {
  const struct quantity_choice choice =
      {.axis = {x, by},
       .name = quantity,
       .refusal = "a plot has one axis below (--x), at most one input that tells its lines apart (--by, another one), "
                  "and one quantity"};
  struct plot_lines plot = {0};
  status code = quantity_read(store, &choice, &plot.quantity, add, &plot, error);
  if (code == STATUS_OK)
    code = draw(store, &plot, page, error);
  if (code == STATUS_OK)
    quantity_tell_resolution(store, plot.quantity.name, plot.quantity.pooled);
  for (size_t i = 0; i < plot.count; i++)
    free(plot.line[i].means);
  return code;
}
