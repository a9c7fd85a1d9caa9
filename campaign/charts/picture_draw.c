/* Draws the body of a fields file: grains in the plane or particles in space, as the file holds them. */
#include "campaign/charts/charts.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/pictures/snapshot_read.h"
#include "campaign/terminal/table.h"
#include "schemas/document.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/text.h"
#include "schemas/unit.h"

enum { WIDTH = 900 };

static double width_of(const struct picture_choice *options) {
  return options->width > 0 ? options->width : WIDTH;
}

enum { DOUBTS = 300 };

/* Writes "! in doubt, 1 of 1 runs: coarse" for a body whose run broke conditions, and prints a line for each on stderr.
 */
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

/* The scene and the number of a snapshot are the file's name; the fields of a stored run are named by a hash. */
static void name_file(const char *fields, char *text, size_t size) {
  const char *slash = strrchr(fields, '/'), *base = slash ? slash + 1 : fields;
  const size_t length = strcspn(base, ".");
  snprintf(text, size, "%.*s", length < 32 ? (int)length : 0, base);
}

/* "disc_000003: dem, seed 1, 812 µs" */
static void name_run(const char *fields, char *text, size_t size) {
  struct snapshot_read *file;
  char engine[64] = "";
  long long seed = 0;
  double time = NAN;
  name_file(fields, text, size);
  if (snapshot_read_open(fields, &file, NULL))
    return;
  const bool known = snapshot_read_text(file, "run", "engine", engine, sizeof engine) &&
                     snapshot_read_integer(file, "run", "seed", &seed);
  if (!snapshot_read_real(file, "run", "time", &time))
    time = NAN;
  if (!snapshot_read_close(file) || !known)
    return;
  text_append(text, size, "%s%s, seed %lld", *text ? ": " : "", engine, seed);
  if (isfinite(time))
    text_append(text, size, ", %.4g \xc2\xb5s", 1e6 * time);
}

/* Widens a frame to what the picture of the body would show. */
static status widen(struct picture_frame *frame, const struct picture_body *body) {
  double view[4];
  TRY(picture_fragments_view(body, view));
  for (int k = 0; k < 2; k++) {
    frame->view[k] = fmin(frame->view[k], view[k]);
    frame->view[k + 2] = fmax(frame->view[k + 2], view[k + 2]);
  }
  return STATUS_OK;
}

/* Grains in the plane have one picture only. `frame` NULL: the picture's own; `picture` NULL: only widens the frame. */
static status draw_grains(const char *fields, const char *picture, const struct picture_choice *options,
                          struct picture_frame *frame, struct error *error) {
  struct picture_panel panel = {0};
  char numbers[160], title[FIELD_TEXT_SIZE], doubts[DOUBTS] = "";
  status code = STATUS_OK;
  TRY(picture_fragments_read(fields, &panel.body, error));
  name_run(fields, title, sizeof title);
  picture_fragments_numbers(&panel.body, "grains", numbers, sizeof numbers);
  if (!frame) /* all pictures of a movie have one size */
    tell_doubts(fields, doubts);
  panel.caption = *doubts ? doubts : NULL;
  if (frame && picture)
    memcpy(panel.view, frame->view, sizeof panel.view);
  if (options->what || options->view || options->axis || options->at)
    code = status_fail(error, STATUS_USAGE,
                       "%s: grains in the plane are drawn by their fragments; --what, --view, --axis and --at "
                       "are for particles in space",
                       fields);
  else if (!picture)
    code = widen(frame, &panel.body);
  else
    code = picture_fragments(picture, width_of(options), options->caption ? options->caption : title, numbers, 1,
                             &panel, error);
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

static void name_look(const char *fields, const struct picture_look *look, const struct picture_cloud *cloud,
                      char *text, size_t size) {
  name_file(fields, text, size);
  if (*cloud->engine)
    text_append(text, size, "%s%s, seed %lld", *text ? ": " : "", cloud->engine, cloud->seed);
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
                             struct picture_frame *frame, struct error *error) {
  struct picture_look look;
  __attribute__((cleanup(picture_cloud_clear))) struct picture_cloud cloud = {0};
  const char *what;
  char title[FIELD_TEXT_SIZE], numbers[200], unit[32] = "", doubts[DOUBTS] = "";
  TRY(choose_look(options, &look, &what, error));
  TRY(picture_cloud_read(fields, &cloud, error));
  TRY(read_quantity(fields, options->what != NULL, &cloud, &what, unit, error));
  name_look(fields, &look, &cloud, title, sizeof title);
  picture_particles_numbers(&cloud, numbers, sizeof numbers);
  if (!frame) /* all pictures of a movie have one size */
    tell_doubts(fields, doubts);
  look.doubts = doubts;
  look.title = options->caption ? options->caption : title;
  look.subtitle = numbers;
  look.quantity = what;
  look.unit = unit;
  look.frame = frame;
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
  char unit[32] = "", title[FIELD_TEXT_SIZE], doubts[DOUBTS] = "";
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
  tell_doubts(fields, doubts);
  name_look(fields, &(struct picture_look){.view = PICTURE_OUTSIDE}, &cloud, title, sizeof title);
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

static status draw_fields(const char *fields, const char *picture, const struct picture_choice *options,
                          struct picture_frame *frame, struct error *error) {
  return picture_cloud_in_file(fields) ? draw_particles(fields, picture, options, frame, error)
                                       : draw_grains(fields, picture, options, frame, error);
}

/* ---- movies: NAME_000.png, NAME_001.png, ... of all snapshots of a run, in one frame and one range of colours ---- */

enum { MOST_FRAMES = 10000 };

struct movie {
  char folder[FIELD_TEXT_SIZE]; /* of the pictures that only a .gif needs; "": they are the user's */
  size_t count;
  char *fields[MOST_FRAMES], *picture[MOST_FRAMES]; /* owned: snapshots, and their pictures */
};

static void movie_free(struct movie *movie) {
  for (size_t i = 0; i < movie->count; i++) {
    if (*movie->folder && movie->picture[i])
      unlink(movie->picture[i]);
    free(movie->fields[i]);
    free(movie->picture[i]);
  }
  if (*movie->folder)
    rmdir(movie->folder);
}

/* Reads the list of snapshots that `clast simulate --snapshots` writes. Their pictures get names that begin with
 * `stem`.
 */
static status read_series(const char *series, const char *stem, struct movie *movie, struct error *error) {
  struct document *document = NULL;
  TRY(document_open(series, &document, error));
  const char *slash = strrchr(series, '/');
  OWNED char *folder = strndup(series, slash ? (size_t)(slash - series) : 0);
  document_node *files = document_key(document_root(document), "files");
  const size_t count = files ? document_count(files) : 0;
  for (size_t i = 0; i < count && i < MOST_FRAMES; i++) {
    document_node *name = document_key(document_item(files, i, NULL), "name");
    const char *word = name ? document_scalar(name) : NULL;
    movie->fields[i] = file_name_in(folder, word ? word : "");
    if (asprintf(&movie->picture[i], "%s_%03zu.png", stem, i) < 0)
      movie->picture[i] = NULL;
    movie->count++;
    if (!movie->fields[i] || !movie->picture[i])
      break;
  }
  document_free(document);
  if (movie->count == 0)
    return status_fail(error, STATUS_CONTENT, "%s lists no snapshots", series);
  return movie->picture[movie->count - 1] && movie->fields[movie->count - 1]
             ? STATUS_OK
             : status_fail(error, STATUS_MEMORY, "no memory for a movie");
}

static status join(const char *picture, const struct picture_choice *options, const struct movie *movie,
                   struct error *error) {
  OWNED const char **name = memory_small(movie->count, sizeof *name);
  OWNED unsigned char *bytes = NULL;
  size_t size = 0;
  const char *slash = strrchr(movie->folder, '/');
  for (size_t i = 0; i < movie->count; i++)
    name[i] = movie->picture[i] + (slash ? slash + 1 - movie->folder : 0);
  TRY(file_read(movie->picture[0], "picture", &bytes, &size, error));
  struct picture_page page = charts_page(picture, &options->chart);
  page.width = bytes[18] * 256 + bytes[19]; /* PNG: width at byte 16, height at byte 20, big-endian */
  return picture_movie(&page, bytes[22] * 256 + bytes[23], movie->count, name, error);
}

static status draw_movie(const char *series, const char *picture, const struct picture_choice *options,
                         struct error *error) {
  __attribute__((cleanup(movie_free))) struct movie movie = {0};
  struct picture_frame frame = PICTURE_NO_FRAME;
  const char *ending = strrchr(picture, '.');
  const bool gif = ending && strcmp(ending, ".gif") == 0;
  if (!gif && (!ending || strcmp(ending, ".png") != 0))
    return status_fail(error, STATUS_USAGE, "%s: all snapshots become a movie, NAME.gif, or pictures, NAME.png",
                       picture);
  if (options->view && strcmp(options->view, "profile") == 0)
    return status_fail(error, STATUS_USAGE, "--view profile is for one snapshot");
  char stem[FIELD_TEXT_SIZE + 16];
  snprintf(stem, sizeof stem, "%.*s", (int)(ending - picture), picture);
  if (gif) { /* a folder of its own: pictures of these names may be there */
    snprintf(movie.folder, sizeof movie.folder, "%s.XXXXXX", picture);
    if (!mkdtemp(movie.folder)) {
      *movie.folder = '\0';
      return status_fail(error, STATUS_IO, "cannot make a folder beside %s: %s", picture, strerror(errno));
    }
    snprintf(stem, sizeof stem, "%s/frame", movie.folder);
  }
  TRY(read_series(series, stem, &movie, error));
  for (size_t i = 0; i < 2 * movie.count; i++) {
    const size_t k = i % movie.count;
    TRY(draw_fields(movie.fields[k], i < movie.count ? NULL : movie.picture[k], options, &frame, error));
  }
  if (!gif) {
    printf("%zu pictures, %s to %s\n", movie.count, movie.picture[0], movie.picture[movie.count - 1]);
    return STATUS_OK;
  }
  return join(picture, options, &movie, error);
}

status picture_draw(const char *fields, const char *picture, const struct picture_choice *options,
                    struct error *error) {
  const size_t length = strlen(fields);
  if (length > 7 && strcmp(fields + length - 7, ".series") == 0)
    return draw_movie(fields, picture, options, error);
  if (!picture_cloud_in_file(fields) || !options->view || strcmp(options->view, "profile") != 0)
    return draw_fields(fields, picture, options, NULL, error);
  if (options->axis || options->at)
    return status_fail(error, STATUS_USAGE, "--axis and --at are for pictures of the body, not for --view profile");
  return draw_profile(fields, picture, options, error);
}
