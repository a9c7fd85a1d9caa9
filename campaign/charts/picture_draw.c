/* Draws the body of a fields file: grains in the plane or particles in space, as the file holds them. */
#include "campaign/charts/charts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/snapshot_read.h"
#include "campaign/terminal/table.h"
#include "schemas/text.h"
#include "schemas/unit.h"

enum { WIDTH = 900 };

static double width_of(const struct picture_choice *options) {
  return options->width > 0 ? options->width : WIDTH;
}

enum { DOUBTS = 300 };

/* Writes "! in doubt, 1 of 1 runs: coarse" for a body whose run broke conditions, and prints a line for each of them on
 * stderr. */
static void tell_doubts(const char *fields, char text[DOUBTS]) {
  struct snapshot_read *file;
  struct error error;
  struct ask_doubts doubts = {0};
  char engine[64] = "", words[FIELD_TEXT_SIZE] = "";
  text[0] = 0;
  if (snapshot_read_open(fields, &file, &error))
    return;
  const bool known = snapshot_read_text(file, "run", "engine", engine, sizeof engine) &&
                     snapshot_read_text(file, "outcome", "warnings", words, sizeof words);
  if (!snapshot_read_close(file) || !known)
    return;
  ask_doubts_run(&doubts, engine, words, OUTCOME_DEFAULT, 1);
  charts_doubts(&doubts, text, DOUBTS);
  uncertainty_doubts(&doubts, stderr);
}

/* Grains in the plane have one picture only. */
static status draw_grains(const char *fields, const char *picture, const struct picture_choice *options,
                          struct error *error) {
  struct picture_panel panel = {0};
  char numbers[160], doubts[DOUBTS];
  status code = STATUS_OK;
  TRY(picture_fragments_read(fields, &panel.body, error));
  picture_fragments_numbers(&panel.body, "grains", numbers, sizeof numbers);
  tell_doubts(fields, doubts);
  panel.caption = *doubts ? doubts : NULL;
  if (options->what || options->view || options->axis || options->at)
    code = status_fail(error, STATUS_USAGE,
                       "%s: grains in the plane are drawn by their fragments; --what, --view, --axis and --at "
                       "are for particles in space",
                       fields);
  else
    code = picture_fragments(picture, width_of(options), options->caption, numbers, 1, &panel, error);
  picture_fragments_clear(&panel.body);
  return code;
}

/* --what, --view, --axis and --at as a look; `what` NULL: fragments. */
static status choose_look(const struct picture_choice *options, struct picture_look *look, const char **what,
                          struct error *error) {
  static const char *const views[] = {[PICTURE_CUT] = "cut", [PICTURE_OUTSIDE] = "outside", [PICTURE_APART] = "apart"};
  enum { VIEWS = sizeof views / sizeof views[0] };
  const char *axis = options->axis;
  *what = options->what ? options->what : "damage";
  if (strcmp(*what, "fragments") == 0)
    *what = NULL;
  *look = (struct picture_look){.view = *what ? PICTURE_CUT : PICTURE_APART, .plane = NAN};
  if (options->view) {
    size_t view = 0;
    while (view < VIEWS && (!views[view] || strcmp(options->view, views[view]) != 0))
      view++;
    if (view == VIEWS)
      return status_fail(error, STATUS_USAGE, "--view is cut, outside, apart or profile, not '%s'", options->view);
    look->view = (enum picture_view)view;
  }
  if (axis && (strlen(axis) != 1 || !strchr("xyz", axis[0])))
    return status_fail(error, STATUS_USAGE, "--axis is x, y or z, not '%s'", axis);
  if (axis)
    look->axis = axis[0] - 'x';
  else
    look->axis = look->view == PICTURE_OUTSIDE ? -1 : 1; /* -1: an oblique view */
  if (!options->at)
    return STATUS_OK;
  if (look->view != PICTURE_CUT)
    return status_fail(error, STATUS_USAGE, "--at is the place of a cut: give --view cut, too");
  return unit_read(options->at, "m", &look->plane, error) ? STATUS_USAGE : STATUS_OK;
}

static void name_look(const struct picture_look *look, const struct picture_cloud *cloud, char *text, size_t size) {
  text[0] = '\0';
  if (*cloud->engine)
    text_append(text, size, "%s, seed %lld", cloud->engine, cloud->seed);
  if (isfinite(cloud->time))
    text_append(text, size, ", %.4g \xc2\xb5s", 1e6 * cloud->time);
  if (look->view == PICTURE_CUT && isfinite(look->plane))
    text_append(text, size, ", cut at %c = %.4g m", 'x' + look->axis, look->plane);
  else if (look->view == PICTURE_CUT)
    text_append(text, size, ", cut through the middle");
  else if (look->view == PICTURE_APART)
    text_append(text, size, ", fragments drawn apart");
}

/* Reads the quantity for the colours: --what, else damage, or pressure for bodies without damage. NULL: fragments. */
static status read_quantity(const char *fields, bool chosen, struct picture_cloud *cloud, const char **what,
                            char unit[32], struct error *error) {
  if (!*what)
    return STATUS_OK;
  if (!chosen) {
    if (picture_cloud_read_column(fields, cloud, *what, &cloud->value, unit, NULL) == STATUS_OK)
      return STATUS_OK;
    *what = "pressure";
  }
  return picture_cloud_read_column(fields, cloud, *what, &cloud->value, unit, error);
}

static status draw_particles(const char *fields, const char *picture, const struct picture_choice *options,
                             struct error *error) {
  struct picture_look look;
  __attribute__((cleanup(picture_cloud_clear))) struct picture_cloud cloud = {0};
  const char *what;
  char title[FIELD_TEXT_SIZE], numbers[200], unit[32] = "", doubts[DOUBTS];
  TRY(choose_look(options, &look, &what, error));
  TRY(picture_cloud_read(fields, &cloud, error));
  TRY(read_quantity(fields, options->what != NULL, &cloud, &what, unit, error));
  name_look(&look, &cloud, title, sizeof title);
  picture_particles_numbers(&cloud, numbers, sizeof numbers);
  tell_doubts(fields, doubts);
  look.doubts = doubts;
  look.title = options->caption ? options->caption : title;
  look.subtitle = numbers;
  look.quantity = what;
  look.unit = unit;
  return picture_particles(picture, width_of(options), &cloud, &look, error);
}

/* One column of a profile, beside its depths. */
struct panel {
  double *values;
  char label[100];
};

/* STATUS_CONTENT when the column is not as long as that of the depths. */
static status read_panel(const char *fields, const char *name, size_t count, struct panel *panel, struct error *error) {
  char unit[32] = "", shown[64];
  size_t rows = 0;
  TRY(picture_cloud_read_axis(fields, name, &panel->values, &rows, unit, error));
  if (rows != count)
    return status_fail(error, STATUS_CONTENT, "%s is damaged: the columns of its profile differ in length", fields);
  field_label_unit(unit, shown, sizeof shown);
  snprintf(panel->label, sizeof panel->label, *shown ? "%s (%s)" : "%s", name, shown);
  return STATUS_OK;
}

/* Draws profiles along the axis: --what, or distention and damage. */
static status draw_profile(const char *fields, const char *picture, const struct picture_choice *options,
                           struct error *error) {
  enum { MOST = 2 };
  const char *names[MOST] = {options->what ? options->what : "distention", "damage"};
  const size_t panels = options->what ? 1 : MOST;
  struct panel panel[MOST] = {{NULL}};
  struct picture_profile profile[MOST];
  struct picture_cloud cloud;
  double *depth = NULL;
  char unit[32] = "", title[FIELD_TEXT_SIZE], doubts[DOUBTS];
  size_t count = 0;
  TRY(picture_cloud_read(fields, &cloud, error));
  status code = picture_cloud_read_axis(fields, "depth", &depth, &count, unit, error);
  for (size_t k = 0; !code && k < panels; k++) {
    code = read_panel(fields, names[k], count, &panel[k], error);
    const bool share = strcmp(names[k], "damage") == 0;
    profile[k] = (struct picture_profile){panel[k].label,
                                          panel[k].values,
                                          {share ? 0 : HUGE_VAL, share ? 1 : -HUGE_VAL}};
  }
  if (code)
    goto cleanup;
  name_look(&(struct picture_look){.view = PICTURE_OUTSIDE}, &cloud, title, sizeof title);
  tell_doubts(fields, doubts);
  const struct picture_page page = charts_page(picture, &options->chart);
  const struct picture_words words = {options->caption ? options->caption : title, doubts, "depth at the start (m)",
                                      NULL};
  code = picture_profile(&page, &words, count, depth, panels, profile, error);
cleanup:
  free(depth);
  for (size_t k = 0; k < MOST; k++)
    free(panel[k].values);
  picture_cloud_clear(&cloud);
  return code;
}

status picture_draw(const char *fields, const char *picture, const struct picture_choice *options,
                    struct error *error) {
  if (!picture_cloud_in_file(fields))
    return draw_grains(fields, picture, options, error);
  if (!options->view || strcmp(options->view, "profile") != 0)
    return draw_particles(fields, picture, options, error);
  if (options->axis || options->at)
    return status_fail(error, STATUS_USAGE, "--axis and --at are for pictures of the body, not for --view profile");
  return draw_profile(fields, picture, options, error);
}
