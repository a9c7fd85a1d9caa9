/* A study of convergence as a picture. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "campaign/converge/study_print.h"
#include "campaign/terminal/chart_option.h"

status study_picture(const struct study *study, const char *path, struct error *error) {
  enum { CURVES = 8 };
  struct study_found *found = malloc(STUDY_KNOBS * sizeof *found);
  struct picture_mean means[CURVES][KNOB_LEVELS];
  struct picture_curve curves[CURVES];
  size_t drawn = 0;
  if (!found)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  const size_t count = study_of_scene(study, 0, 0, found);
  for (size_t i = 0; i < count && drawn < CURVES; i++) {
    curves[drawn] = (struct picture_curve){.label = found[i].limit.knob, .mean = means[drawn]};
    for (size_t l = 0; l < found[i].count; l++) {
      const struct convergence_row *row = &found[i].rows[l];
      struct picture_mean mean = {row->cpu, row->mean, row->mean - row->half_width, row->mean + row->half_width, NAN};
      if (!isfinite(mean.x) || !isfinite(mean.y))
        continue;
      size_t place = curves[drawn].count++;
      for (; place > 0 && means[drawn][place - 1].x > mean.x; place--)
        means[drawn][place] = means[drawn][place - 1];
      means[drawn][place] = mean;
    }
    drawn += curves[drawn].count > 0;
  }
  char title[800];
  const struct field *row = study->quantity[0].row;
  char label[CHART_OPTION_LABEL];
  chart_option_label(row->path, label);
  snprintf(title, sizeof title, "%s: %s over the cost of a run", study->ladder[0].base->name, label);
  const struct picture_page page = chart_option_page(path, NULL);
  const struct picture_words words = {title, "A mark is a level of a knob: mean over seeds with its 95 % interval",
                                      "processor time of a run (s)", label};
  status code = picture_curves(&page, &words, drawn, curves, error);
  free(found);
  return code;
}
