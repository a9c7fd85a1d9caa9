/* Draws the body of a fields file: grains in the plane or particles in space, as the file holds them. */
#include "campaign/charts/charts.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/pictures/snapshot_read.h"
#include "schemas/file.h"
#include "schemas/memory.h"
#include "schemas/unit.h"

enum { WIDTH = 900 };

static double width_of(const struct picture_choice *options) {
  return options->width > 0 ? options->width : WIDTH;
}

enum { DOUBTS = 300, MOST_FRAMES = 10000 };

/* All snapshots of a run, in one frame and one range of colours: a movie, or a sheet. */
struct movie {
  struct picture_frame frame;
  struct picture_sheet *sheet; /* NULL: a movie */
  const char *series;
  char folder[FIELD_TEXT_SIZE]; /* of the pictures that a movie needs; "": none */
  size_t count, at;
  char *fields[MOST_FRAMES], *picture[MOST_FRAMES]; /* owned: snapshots, and their pictures */
};

/* Writes "! in doubt, 1 of 1 runs: coarse" for a body whose run broke conditions. Prints a line for each on stderr, of
 * a movie for its last snapshot. */
static void tell_doubts(const char *fields, const struct movie *movie, bool quiet, char text[DOUBTS]) {
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
  doubts.withheld = 0; /* the body is drawn all the same */
  charts_doubts(NULL, &doubts, text, DOUBTS);
  if (!quiet && (!movie || movie->at + 1 == movie->count))
    uncertainty_doubts(&doubts, stderr);
}

void picture_draw_time(double seconds, char text[32]) {
  static const char *const unit[] = {"s", "ms", "\xc2\xb5s", "ns"};
  size_t k = 0;
  text[0] = 0;
  if (!isfinite(seconds))
    return;
  for (; k < 3 && seconds != 0 && fabs(seconds) < 0.9999; k++)
    seconds *= 1e3;
  snprintf(text, 32, "%.4g %s", seconds, unit[k]);
}

/* "disc_000003: seed 1, 812 us", "end (impact): seed 1, 812 us". The scene and the number of a snapshot are the file's
 * name; the fields of a stored run are named by a hash, and the store knows the scene. Of a movie: the name of its
 * series; of a sheet, also no time. */
static void name_run(const char *fields, const struct movie *movie, const char *engine, long long seed, double time,
                     char *text, size_t size) {
  const char *path = movie ? movie->series : fields;
  const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
  const size_t length = strcspn(base, ".");
  char shown[32], kind[64] = ""; /* the protocol of the scene */
  struct snapshot_read *file;
  if (length < 32)
    snprintf(text, size, "%.*s", (int)length, base);
  else
    ask_scene_of_fields(fields, text, size);
  if (snapshot_read_open(fields, &file, NULL) == STATUS_OK) {
    snapshot_read_text(file, "inputs", "kind", kind, sizeof kind);
    snapshot_read_close(file);
  }
  if (*kind && length < 32 && strncmp(text, kind, strlen(kind)) != 0)
    text_append(text, size, " (%s)", kind);
  if (*engine)
    text_append(text, size, "%sseed %lld", *text ? ": " : "", seed);
  picture_draw_time(time, shown);
  if (*shown && !(movie && movie->sheet))
    text_append(text, size, ", %s", shown);
}

/* Widens a frame to what the picture of the body would show, and keeps its fragments. */
static status widen(struct picture_frame *frame, const struct picture_body *body) {
  double view[4];
  free(frame->last);
  TRY(memory_array(&frame->last, frame->members = body->cells, sizeof *frame->last, "", NULL));
  for (size_t i = 0; i < body->cells; i++)
    frame->last[i] = body->fragment[i];
  TRY(picture_fragments_view(body, view));
  for (int k = 0; k < 2; k++) {
    frame->view[k] = fmin(frame->view[k], view[k]);
    frame->view[k + 2] = fmax(frame->view[k + 2], view[k + 2]);
  }
  return STATUS_OK;
}

/* Grains in the plane have one picture only. `picture` NULL: only widens the movie's frame. */
static status draw_grains(const char *fields, const char *picture, const struct picture_choice *options,
                          struct movie *movie, struct error *error) {
  struct picture_panel panel = {0};
  struct snapshot_read *file;
  char numbers[160], title[FIELD_TEXT_SIZE], doubts[DOUBTS] = "", engine[64] = "", caption[64];
  long long seed = 0;
  double time = NAN;
  status code = STATUS_OK;
  TRY(picture_fragments_read(fields, &panel.body, error));
  if (options->what || options->view || options->axis || options->at) {
    code = status_fail(error, STATUS_USAGE,
                       "%s: grains in the plane are drawn by their fragments; --what, --view, --axis and --at "
                       "are for particles in space",
                       fields);
    goto cleanup;
  }
  if (movie && !picture) {
    code = widen(&movie->frame, &panel.body);
    goto cleanup;
  }
  if (snapshot_read_open(fields, &file, NULL) == STATUS_OK) {
    snapshot_read_text(file, "run", "engine", engine, sizeof engine);
    snapshot_read_integer(file, "run", "seed", &seed);
    snapshot_read_real(file, "run", "time", &time);
    snapshot_read_close(file);
  }
  name_run(fields, movie, engine, seed, time, title, sizeof title);
  picture_fragments_numbers(&panel.body, "grains", numbers, sizeof numbers);
  tell_doubts(fields, movie, options->quiet, doubts);
  panel.caption = *doubts ? doubts : NULL;
  panel.frame = movie ? &movie->frame : NULL;
  if (movie && movie->sheet) {
    const char *largest = strstr(numbers, "largest");
    picture_draw_time(time, caption);
    text_append(caption, sizeof caption, "; %s", largest ? largest : "");
    code = picture_fragments_on_sheet(movie->sheet, options->caption ? options->caption : title, caption, &panel,
                                      error);
  } else
    code = picture_fragments(picture, width_of(options), options->caption ? options->caption : title, numbers, &panel,
                             error);
cleanup:
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
  look->axis = axis ? axis[0] - 'x' : 1;
  if (!options->at)
    return STATUS_OK;
  if (look->view != PICTURE_CUT)
    return status_fail(error, STATUS_USAGE, "--at is the place of a cut: give --view cut, too");
  return unit_read_whole(options->at, "m", &look->plane, error) ? STATUS_USAGE : STATUS_OK;
}

static void name_look(const char *fields, const struct movie *movie, const struct picture_look *look,
                      const struct picture_cloud *cloud, char *text, size_t size) {
  name_run(fields, movie, cloud->engine, cloud->seed, cloud->time, text, size);
  if (look->view == PICTURE_CUT && isfinite(look->plane))
    text_append(text, size, ", cut at %c = %.4g m", 'x' + look->axis, look->plane);
  else if (look->view == PICTURE_CUT)
    text_append(text, size, ", cut through the middle");
  else if (look->view == PICTURE_APART)
    text_append(text, size, ", fragments drawn apart");
}

/* How many numbers a picture lacks. Says on stderr if it has none. */
static size_t tell_lacking(const char *fields, const char *what, size_t count, const double *value, bool quiet) {
  size_t lacking = 0;
  for (size_t i = 0; i < count; i++)
    lacking += isfinite(value[i]) ? 0u : 1u;
  if (lacking == count && !quiet)
    fprintf(stderr, "clast: %s: no value of %s to draw: " PICTURE_BROKEN "\n", fields, what);
  return lacking;
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
                             struct movie *movie, struct error *error) {
  struct picture_look look;
  __attribute__((cleanup(picture_cloud_clear))) struct picture_cloud cloud = {0};
  const char *what;
  char title[FIELD_TEXT_SIZE], numbers[200], unit[32] = "", doubts[DOUBTS] = "";
  TRY(choose_look(options, &look, &what, error));
  TRY(picture_cloud_read(fields, &cloud, error));
  TRY(read_quantity(fields, options->what != NULL, &cloud, &what, unit, error));
  name_look(fields, movie, &look, &cloud, title, sizeof title);
  if (movie && movie->sheet)
    picture_draw_time(cloud.time, numbers);
  else
    picture_particles_numbers(&cloud, numbers, sizeof numbers);
  if (picture) {
    tell_doubts(fields, movie, options->quiet, doubts);
    if (cloud.value)
      (void)tell_lacking(fields, what, cloud.n, cloud.value, options->quiet || movie);
  }
  look.doubts = doubts;
  look.title = options->caption ? options->caption : title;
  look.subtitle = numbers;
  look.quantity = what;
  look.unit = unit;
  look.frame = movie ? &movie->frame : NULL;
  look.sheet = movie ? movie->sheet : NULL;
  TRY(picture_particles(picture, width_of(options), &cloud, &look, error));
  if (movie && !picture) {
    free(movie->frame.last);
    movie->frame.last = cloud.fragment;
    movie->frame.members = cloud.n;
    cloud.fragment = NULL;
  }
  return STATUS_OK;
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
  tell_doubts(fields, NULL, options->quiet, doubts);
  for (size_t k = 0; k < panels; k++)
    if (tell_lacking(fields, names[k], count, panel[k].values, options->quiet))
      text_append(doubts, DOUBTS, "%sNo mark: " PICTURE_BROKEN, *doubts ? ". " : "");
  name_look(fields, NULL, &(struct picture_look){.view = PICTURE_OUTSIDE}, &cloud, title, sizeof title);
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
                          struct movie *movie, struct error *error) {
  return picture_cloud_in_file(fields) ? draw_particles(fields, picture, options, movie, error)
                                       : draw_grains(fields, picture, options, movie, error);
}

/* ---- movies and sheets ---- */

static void movie_free(struct movie *movie) {
  free(movie->frame.last);
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

static status draw_sheet(const char *picture, const struct picture_choice *options, struct movie *movie,
                         struct error *error) {
  status code = STATUS_OK;
  TRY(picture_sheet_open(picture, movie->count, &movie->frame, &movie->sheet, error));
  for (movie->at = 0; movie->at < movie->count && !code; movie->at++)
    code = draw_fields(movie->fields[movie->at], picture, options, movie, error);
  return picture_sheet_close(movie->sheet, code, error);
}

static status draw_movie(const char *series, const char *picture, const struct picture_choice *options,
                         struct error *error) {
  __attribute__((cleanup(movie_free))) struct movie movie = {.frame = PICTURE_NO_FRAME, .series = series};
  char stem[FIELD_TEXT_SIZE + 16];
  const char *ending = strrchr(picture, '.');
  const bool gif = ending && strcmp(ending, ".gif") == 0;
  if (options->view && strcmp(options->view, "profile") == 0)
    return status_fail(error, STATUS_USAGE, "--view profile is for one snapshot");
  if (!gif && (!ending || (strcmp(ending, ".png") && strcmp(ending, ".svg") && strcmp(ending, ".pdf"))))
    return status_fail(error, STATUS_USAGE,
                       "%s: a movie's name ends in .gif; one picture of all snapshots is .png, .svg or .pdf", picture);
  if (gif) {
    snprintf(movie.folder, sizeof movie.folder, "%s.XXXXXX", picture);
    if (!mkdtemp(movie.folder)) {
      *movie.folder = '\0';
      return status_fail(error, STATUS_IO, "cannot make a folder beside %s: %s", picture, strerror(errno));
    }
  }
  snprintf(stem, sizeof stem, "%s/frame", movie.folder);
  TRY(read_series(series, stem, &movie, error));
  for (size_t i = 0; i < movie.count; i++)
    TRY(draw_fields(movie.fields[i], NULL, options, &movie, error));
  if (!gif)
    return draw_sheet(picture, options, &movie, error);
  for (movie.at = 0; movie.at < movie.count; movie.at++)
    TRY(draw_fields(movie.fields[movie.at], movie.picture[movie.at], options, &movie, error));
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
