/* A study of convergence as pictures: results over cost, and the error over cost with the frontier. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "campaign/charts/charts.h"
#include "campaign/converge/study_print.h"

enum { CURVES = PICTURE_SERIES, MARKS = STUDY_KNOBS * KNOB_LEVELS };

struct drawing {
  struct study_found found[STUDY_KNOBS];
  size_t knobs;
  struct picture_mean means[CURVES][MARKS];
  struct picture_curve curves[CURVES];
  size_t count;
};

static struct picture_mean mean_of(const struct convergence_row *row) {
  return (struct picture_mean){row->cpu, row->mean, row->mean - row->half_width, row->mean + row->half_width, NAN};
}

static struct picture_mean error_of(const struct convergence_row *row) {
  return (struct picture_mean){row->cpu, row->error, NAN, NAN, NAN};
}

/* Adds a mark to the current curve, in order of cost. */
static void add_mark(struct drawing *drawing, struct picture_mean mark) {
  struct picture_mean *means = drawing->means[drawing->count];
  struct picture_curve *curve = &drawing->curves[drawing->count];
  if (!isfinite(mark.x) || !isfinite(mark.y) || curve->count == MARKS)
    return;
  size_t place = curve->count++;
  for (; place > 0 && means[place - 1].x > mark.x; place--)
    means[place] = means[place - 1];
  means[place] = mark;
}

static void begin_curve(struct drawing *drawing, const char *label) {
  drawing->curves[drawing->count] = (struct picture_curve){.label = label, .mean = drawing->means[drawing->count]};
}

static void end_curve(struct drawing *drawing) {
  drawing->count += drawing->curves[drawing->count].count > 0;
}

/* A curve for each knob, up to the number of line styles. */
static void add_knobs(struct drawing *drawing, size_t most,
                      struct picture_mean (*mark_of)(const struct convergence_row *row)) {
  for (size_t i = 0; i < drawing->knobs && drawing->count < most; i++) {
    begin_curve(drawing, drawing->found[i].limit.knob);
    for (size_t l = 0; l < drawing->found[i].count; l++)
      add_mark(drawing, mark_of(&drawing->found[i].rows[l]));
    end_curve(drawing);
  }
}

static void add_frontier(struct drawing *drawing) {
  begin_curve(drawing, "frontier: no level is both cheaper and nearer");
  for (size_t i = 0; i < drawing->knobs; i++)
    for (size_t l = 0; l < drawing->found[i].count; l++)
      if (drawing->found[i].rows[l].frontier)
        add_mark(drawing, error_of(&drawing->found[i].rows[l]));
  end_curve(drawing);
}

status study_picture(const struct study *study, bool of_errors, const char *path, struct error *error) {
  struct drawing *drawing = calloc(1, sizeof *drawing);
  if (!drawing)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  drawing->knobs = study_of_scene(study, 0, 0, drawing->found);
  if (of_errors)
    add_frontier(drawing);
  add_knobs(drawing, CURVES, of_errors ? error_of : mean_of);

  char title[800], quantity[CHARTS_LABEL], y[CHARTS_LABEL + 16];
  charts_label(study->quantity[0].name, quantity);
  snprintf(y, sizeof y, "%s%s", of_errors ? "error of " : "", quantity);
  snprintf(title, sizeof title, "%s: %s over the cost of a run", study->ladder[0].base->name, y);
  const struct picture_page page = charts_page(path, NULL);
  const struct picture_words words =
      {title,
       of_errors ? "A mark is a level of a knob: how far finer settings may move the mean, all knobs together"
                 : "A mark is a level of a knob: mean over seeds with its 95 % interval",
       "processor time of a run (s)", y};
  status code = picture_curves(&page, &words, drawing->count, drawing->curves, error);
  free(drawing);
  return code;
}
