/* Pictures are complete files of the right kind with ink in the right places; an error leaves no file behind. With a
 * folder as argument the pictures stay there. */
#define CHECK_OWN_MAIN
#include <cairo.h>
#include <sys/stat.h>
#include <unistd.h>

#include "analysis/analysis.h"
#include "analysis/pictures/picture.h"
#include "engine/random.h"
#include "tests/support/check.h"
#include "tests/support/sweep.h"

static char folder[256];
static const char *at(const char *name) {
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

enum { SIDE = 36, MOST = SIDE * SIDE };

/* A disc of jittered squares, broken round random centres and expanding outwards, with dust at the rim. */
struct example {
  size_t cells;
  uint32_t first[MOST + 1], fragment[MOST], crack[8][2];
  double vertex[4 * MOST][2];
};

static double jitter(int i, int j, int axis) {
  return 0.35 * (random_draw(8, (uint64_t)axis, (uint64_t)i, (uint64_t)j) - 0.5);
}

static void make_example(struct example *e, double spread) {
  enum { CENTRES = 40 };
  double cx[CENTRES], cy[CENTRES];
  for (uint64_t c = 0; c < CENTRES; c++) {
    double r = 0.97 * sqrt(random_draw(9, 0, c, 0)), angle = 2 * M_PI * random_draw(9, 1, c, 0);
    cx[c] = r * cos(angle);
    cy[c] = r * sin(angle);
  }
  *e = (struct example){0};
  uint32_t dust = CENTRES;
  for (int j = 0; j < SIDE; j++) {
    for (int i = 0; i < SIDE; i++) {
      double x = (i + 0.5) / SIDE * 2 - 1, y = (j + 0.5) / SIDE * 2 - 1;
      if (hypot(x, y) > 1)
        continue;
      uint32_t label = 0;
      for (uint32_t c = 1; c < CENTRES; c++)
        if (hypot(x - cx[c], y - cy[c]) < hypot(x - cx[label], y - cy[label]))
          label = c;
      bool alone = hypot(x, y) > 0.95 || random_draw(9, 2, (uint64_t)i, (uint64_t)j) < 0.03;
      double ox = alone ? x : cx[label], oy = alone ? y : cy[label];
      size_t n = e->cells++;
      e->fragment[n] = alone ? dust++ : label;
      e->first[n + 1] = (uint32_t)(4 * (n + 1));
      const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      for (int v = 0; v < 4; v++) {
        int p = i + corner[v][0], q = j + corner[v][1];
        e->vertex[4 * n + (size_t)v][0] = 0.1 * ((p + jitter(p, q, 0)) / SIDE * 2 - 1 + spread * ox);
        e->vertex[4 * n + (size_t)v][1] = 0.1 * ((q + jitter(p, q, 1)) / SIDE * 2 - 1 + spread * oy);
      }
    }
  }
  uint32_t seen[MOST] = {0}, next = 0, number[MOST]; /* labels without gaps */
  for (size_t n = 0; n < e->cells; n++) {
    if (!seen[e->fragment[n]]++)
      number[e->fragment[n]] = next++;
    e->fragment[n] = number[e->fragment[n]];
  }
  for (int k = 0; k < 8; k++) {
    e->crack[k][0] = (uint32_t)e->cells / 2 + (uint32_t)k;
    e->crack[k][1] = e->crack[k][0] + 1;
  }
}

static struct picture_body body_of(struct example *e) {
  return (struct picture_body){.cells = e->cells,
                               .first_vertex = e->first,
                               .vertex = e->vertex,
                               .fragment = e->fragment,
                               .cracks = 8,
                               .crack = e->crack};
}

/* Share of pixels that are not white, and of coloured ones. */
static void ink(const char *path, double *dark, double *coloured, int *width, int *height) {
  cairo_surface_t *surface = cairo_image_surface_create_from_png(path);
  assert_int_equal(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  *width = cairo_image_surface_get_width(surface);
  *height = cairo_image_surface_get_height(surface);
  const unsigned char *data = cairo_image_surface_get_data(surface);
  int stride = cairo_image_surface_get_stride(surface), not_white = 0, hued = 0;
  for (int y = 0; y < *height; y++) {
    for (int x = 0; x < *width; x++) {
      const unsigned char *p = data + y * stride + 4 * x;
      int low = p[0] < p[1] ? p[0] : p[1], high = p[0] > p[1] ? p[0] : p[1];
      low = p[2] < low ? p[2] : low;
      high = p[2] > high ? p[2] : high;
      not_white += low < 250;
      hued += high - low > 40;
    }
  }
  *dark = (double)not_white / (*width * *height);
  *coloured = (double)hued / (*width * *height);
  cairo_surface_destroy(surface);
}

TEST(fragments_are_drawn) {
  static struct example after;
  make_example(&after, 0.25);
  const struct picture_panel panel = {.body = body_of(&after), .caption = "after 10 ms"};
  OK(picture_fragments(at("one.png"), 900, "An example of a broken disc", "40 pieces and dust", &panel, &error));
  OK(picture_fragments(at("disc.svg"), 900, NULL, NULL, &panel, &error));
  char numbers[160];
  struct picture_body small = {.cells = 3,
                               .first_vertex = (uint32_t[]){0, 4, 8, 12},
                               .vertex = (double[12][2]){{0, 0},
                                                         {2, 0},
                                                         {2, 1},
                                                         {0, 1},
                                                         {2, 0},
                                                         {3, 0},
                                                         {3, 1},
                                                         {2, 1},
                                                         {5, 0},
                                                         {6, 0},
                                                         {6, 1},
                                                         {5, 1}},
                               .fragment = (uint32_t[]){0, 0, 1}};
  picture_fragments_numbers(&small, "cells", numbers, sizeof numbers);
  assert_string_equal(numbers, "3 cells in 2 fragments, 1 of them single; largest 75.0 % of the area");
  double dark, coloured;
  int width, height;
  ink(at("one.png"), &dark, &coloured, &width, &height);
  assert_int_equal(width, 900);
  assert_true(coloured > 0.25 && dark < 0.8); /* a disc fills pi/4 of its square, gaps and titles take the rest */
  FILE *svg = fopen(at("disc.svg"), "r");
  assert_non_null(svg);
  char head[128] = "";
  assert_true(fread(head, 1, sizeof head - 1, svg) > 0 && strstr(head, "<?xml"));
  fclose(svg);
}

TEST(spectra_are_drawn) {
  enum { RUNS = 40, EACH = 80 };
  static double masses[2][RUNS * EACH];
  const struct pooled_form form = {0};
  struct picture_series series[2] = {{0}, {0}};
  struct picture_fit fits[2][2];
  struct pooled_bin *bins[2];
  for (size_t s = 0; s < 2; s++) {
    size_t first[RUNS + 1];
    for (size_t i = 0; i < RUNS * EACH; i++)
      masses[s][i] = 0.0057 * pow(1 - random_draw(5, s, i, 0), -1 / (0.8 + 0.5 * (double)s));
    for (size_t r = 0; r <= RUNS; r++)
      first[r] = r * EACH;
    struct pooled_runs runs = {RUNS, first, masses[s]};
    assert_int_equal(pooled_spectrum(&runs, &form, &bins[s], &series[s].count, NULL), STATUS_OK);
    series[s].bins = bins[s];
    series[s].label = s ? "threshold 6 %" : "threshold 3 %";
    series[s].fits = 2;
    series[s].fit = fits[s];
    fits[s][0] = (struct picture_fit){s ? "\xce\xb2 = 2.30 \xc2\xb1 0.03 (likelihood)"
                                        : "\xce\xb2 = 1.80 \xc2\xb1 0.02 (likelihood)",
                                      1.8 + 0.5 * (double)s,
                                      0.0057,
                                      HUGE_VAL,
                                      EACH,
                                      0,
                                      NULL};
    fits[s][1] = (struct picture_fit){"least squares", 1.7 + 0.3 * (double)s, 0.0057, 10, EACH, 0, NULL};
  }
  assert_int_equal(picture_spectrum(&(struct picture_page){.path = at("spectrum.png"), .width = 900},
                                    &(struct picture_words){"disc-explosion, 40 runs", NULL, "mass (kg)", "F(m)"},
                                    &form, 2, series, NULL),
                   STATUS_OK);
  assert_int_equal(picture_spectrum(&(struct picture_page){.path = at("spectrum.svg"), .width = 600},
                                    &(struct picture_words){NULL, NULL, "mass (kg)", "F(m)"}, &form, 1, series, NULL),
                   STATUS_OK);
  double dark, coloured;
  int width, height;
  ink(at("spectrum.png"), &dark, &coloured, &width, &height);
  assert_true(dark > 0.02 && dark < 0.3 && coloured > 0.003);
  series[0].count = 0;
  assert_int_equal(picture_spectrum(&(struct picture_page){.path = at("none.png"), .width = 600},
                                    &(struct picture_words){NULL, NULL, "mass (kg)", "F(m)"}, &form, 1, series, &error),
                   STATUS_USAGE);
  free(bins[0]);
  free(bins[1]);
}

/* The cumulative line is the mean of the runs' N(>m). For beta 2 the law below M has N(>m) ~ 1/m - 1/M. */
TEST(a_line_has_the_largest_fragments) {
  const struct picture_run run[] = {{4, 1, 3}, {2, 2, 0}, {0.5, 0, 0}};
  const struct picture_fit fit = {NULL, 2, 1, 4, 1, 3, run};
  const struct pooled_form form = {.cumulative = true};
  assert_true(fabs(picture_spectrum_fit(&fit, &form, 1) - 6 / 3.0) < 1e-12);
  assert_true(fabs(picture_spectrum_fit(&fit, &form, 2) - (2 + 1 + 3 * (1 / 2.0 - 1 / 4.0) / (1 - 1 / 4.0)) / 3) <
              1e-12);
  assert_true(fabs(picture_spectrum_fit(&fit, &form, 3) - (1 + 3 * (1 / 3.0 - 1 / 4.0) / (1 - 1 / 4.0)) / 3) < 1e-12);
}

TEST(maps_are_drawn) {
  struct picture_tile points[24] = {{0}};
  for (int i = 0; i < 24; i++) {
    points[i].x = 0.01 * (i % 6 + 1);
    points[i].y = i / 6 + 1;
    points[i].value = 1.6 + 0.03 * (i % 6) + 0.1 * (i / 6);
  }
  points[7].value = NAN;
  const char *const x = "threshold.strain", *const y = "beam.threshold.angle (deg)";
  assert_int_equal(picture_map(&(struct picture_page){.path = at("map.png"), .width = 900},
                               &(struct picture_words){"beta over both thresholds", NULL, x, y}, "beta", 24, points, 0,
                               NULL, NULL),
                   STATUS_OK);
  double dark, coloured;
  int width, height;
  ink(at("map.png"), &dark, &coloured, &width, &height);
  assert_true(coloured > 0.3);
  const struct picture_tile loose[] = {{.x = 2, .y = 0.1, .value = 5},
                                       {.x = 1, .y = 0.1, .value = 4, .doubtful = true},
                                       {.x = 2, .y = 0.3, .value = 7},
                                       {.x = 1, .y = 0.1, .value = 4.5},
                                       {.x = 3, .y = 0.2, .value = NAN}};
  assert_int_equal(picture_map(&(struct picture_page){.path = at("loose.png"), .width = 600},
                               &(struct picture_words){NULL, NULL, "x", "y"}, "M_1/M", 5, loose, 0, NULL, NULL),
                   STATUS_OK);
  const struct picture_tile sampled[] = {{.x = 1, .y = 0.1, .value = 5},
                                         {.x = 40, .y = 0.3, .value = 7, .doubtful = true},
                                         {.x = 2, .y = 0.2, .value = 6}};
  assert_int_equal(picture_map(&(struct picture_page){.path = at("sampled.png"), .width = 600},
                               &(struct picture_words){NULL, NULL, "x", "y"}, "M_1/M", 3, sampled, 0, NULL, NULL),
                   STATUS_OK);
  ink(at("sampled.png"), &dark, &coloured, &width, &height);
  assert_true(coloured < 0.1); /* marks, no tiles */
  const struct picture_tile nowhere[] = {{.x = NAN, .y = 1, .value = 1}};
  assert_int_equal(picture_map(&(struct picture_page){.path = at("none.png"), .width = 600},
                               &(struct picture_words){NULL, NULL, "x", "y"}, "M_1/M", 1, nowhere, 0, NULL, NULL),
                   STATUS_USAGE);
  assert_int_equal(picture_map(&(struct picture_page){.path = at("none.png"), .width = 600},
                               &(struct picture_words){NULL, NULL, "x", "y"}, "M_1/M", 0, loose, 0, NULL, NULL),
                   STATUS_USAGE);
  for (int i = 0; i < 24; i++)
    points[i].panel = (size_t)(i % 3 == 2);
  assert_int_equal(picture_map(&(struct picture_page){.path = at("panels.png"), .width = 900},
                               &(struct picture_words){"beta, a panel for each k", NULL, x, y}, "beta", 24, points, 2,
                               (const char *const[]){"k = 1", "k = 2"}, NULL),
                   STATUS_OK);
  const double whole = coloured;
  ink(at("panels.png"), &dark, &coloured, &width, &height);
  assert_true(coloured > whole); /* tiles */
  for (int i = 0; i < 24; i++)
    points[i].value = NAN;
  assert_int_equal(picture_map(&(struct picture_page){.path = at("none.png"), .width = 900},
                               &(struct picture_words){NULL, NULL, x, y}, "beta", 24, points, 0, NULL, NULL),
                   STATUS_USAGE);
}

TEST(profiles_are_drawn) {
  double x[40], alpha[40], damage[40];
  for (int i = 0; i < 40; i++)
    x[i] = 0.003 * i, alpha[i] = 1.5 - 0.5 * exp(-0.1 * i), damage[i] = i < 20;
  alpha[7] = NAN; /* a gap */
  const struct picture_profile panels[] = {{"distention", alpha, {HUGE_VAL, -HUGE_VAL}}, {"damage", damage, {0, 1}}};
  assert_int_equal(picture_profile(&(struct picture_page){.path = at("profile.png"), .width = 900},
                                   &(struct picture_words){"Below a crater", NULL, "depth (m)", NULL}, 40, x, 2, panels,
                                   NULL),
                   STATUS_OK);
  double dark, coloured;
  int width, height;
  ink(at("profile.png"), &dark, &coloured, &width, &height);
  assert_true(width == 900 && height > 500 && coloured > 0.002); /* two lines of 2.7 pixels and dots on them */
  assert_int_equal(picture_profile(&(struct picture_page){.path = at("flat.svg"), .width = 600},
                                   &(struct picture_words){NULL, NULL, "x", NULL}, 40, x, 1,
                                   &(struct picture_profile){"zero", (double[40]){0}, {HUGE_VAL, -HUGE_VAL}}, NULL),
                   STATUS_OK);
  assert_int_equal(picture_profile(&(struct picture_page){.path = at("none.png"), .width = 600},
                                   &(struct picture_words){NULL, NULL, "x", NULL}, 1, x, 1, panels, NULL),
                   STATUS_USAGE);
  assert_int_equal(picture_profile(&(struct picture_page){.path = at("none.png"), .width = 600},
                                   &(struct picture_words){NULL, NULL, "x", NULL}, 40, x, 0, panels, NULL),
                   STATUS_USAGE);
}

/* The whole of a file. */
static char *text_of(const char *path) {
  static char text[200000];
  FILE *in = fopen(path, "r");
  assert_non_null(in);
  text[fread(text, 1, sizeof text - 1, in)] = '\0';
  fclose(in);
  return text;
}

static status curves(const char *name, size_t count, const struct picture_curve *curve) {
  return picture_curves(&(struct picture_page){.path = at(name), .width = 900, .keep_script = true},
                        &(struct picture_words){"M_1/M", "seeds", "k (1/m^3)", "largest fraction"}, count, curve, NULL);
}

/* The frame holds all bodies before the run, also a projectile far from the target, which has no fragments; later only
 * while it is one body, so that its spray does not shrink the target. */
TEST(frame_holds_the_projectile) {
  enum { EACH = 125, N = EACH + 2000 };
  static double position[N][3], size[N], mass[N];
  static int64_t fragment[N], part[N];
  for (int spray = 0; spray < 2; spray++)
    for (int few = 0; few < 2; few++)
      for (int late = 0; late < 2; late++) {
        const int balls = few ? 1 : EACH;
        struct picture_cloud cloud = {.n = 2000 + (size_t)balls,
                                      .position = position,
                                      .size = size,
                                      .mass = mass,
                                      .fragment = fragment,
                                      .part = part,
                                      .engine = "sph",
                                      .time = late ? 1e-6 : 0};
        for (int k = 0; k < 2000 + balls; k++) {
          const bool ball = k >= 2000;
          const int side = ball ? 5 : 20, i = ball ? k - 2000 : k;
          const double step = ball && spray ? 4 : 1;
          position[k][0] = step * (i % side);
          position[k][1] = step * (i / side % side);
          position[k][2] = step * (i / side / side) + (ball ? 30 : 0);
          size[k] = mass[k] = 1;
          fragment[k] = ball ? -1 : 0;
          part[k] = ball ? PICTURE_LEFT_OUT : PICTURE_CORE;
        }
        struct picture_frame frame = PICTURE_NO_FRAME;
        const struct picture_look look = {.view = PICTURE_OUTSIDE, .axis = 1, .plane = NAN, .frame = &frame};
        assert_int_equal(picture_particles(NULL, 480, &cloud, &look, NULL), STATUS_OK);
        const bool holds = frame.view[3] > (few ? 30 : spray ? 46 : 34);
        assert_int_equal(holds, !late || (!few && !spray));
      }
}

/* gnuplot receives exactly the given numbers, and a gap stays a gap; the axis is logarithmic from a factor of 20. */
TEST(curves_are_drawn) {
  const struct picture_mean high[] = {{1, 0.9, 0.85, 0.95, 0.1, false},
                                      {10, 0.9, 0.85, 0.95, NAN, true},
                                      {100, 0.9, NAN, NAN, 0.2, false}};
  const struct picture_mean low[] = {{1, 0.1, 0.1, 0.1, 0, false},
                                     {10, NAN, 0, 0, NAN, false},
                                     {100, 0.125, NAN, NAN, NAN, false}};
  const struct sample_range share = {0, 1, true};
  const struct picture_curve both[] = {{.label = "high", .count = 3, .mean = high, .range = &share},
                                       {.label = "low", .count = 3, .mean = low}};
  assert_int_equal(curves("curves.png", 2, both), STATUS_OK);
  double dark, coloured;
  int width, height;
  ink(at("curves.png"), &dark, &coloured, &width, &height);
  assert_true(width == 900 && coloured > 0.005);
  assert_string_equal(text_of(at("curves.dat")),
                      "# x mean low high thin_low thin_high doubtful\n"
                      "1 0.9 0.85 0.95 0.75 1 0\n"
                      "10 0.9 0.85 0.95 NaN NaN 1\n100 0.9 NaN NaN 0.7 1 0\n\n\n"
                      "# x mean low high thin_low thin_high doubtful\n1 0.1 NaN NaN NaN NaN 0\n"
                      "10 NaN NaN NaN NaN NaN 0\n100 0.125 NaN NaN NaN NaN 0\n\n\n");
  const char *script = text_of(at("curves.gp"));
  assert_non_null(strstr(script, "\nlog_x = 1\n"));
  assert_non_null(strstr(script, "\noutput_file = './curves.png'\n"));
  assert_non_null(strstr(script, "0xD55E00")); /* vermilion of Okabe and Ito */
  const struct picture_mean short_way[] = {{1, 0.1, NAN, NAN, NAN, false}, {19, 0.9, NAN, NAN, NAN, false}};
  assert_int_equal(curves("narrow.pdf", 1,
                          &(struct picture_curve){.label = "one label", .count = 2, .mean = short_way}),
                   STATUS_OK);
  assert_non_null(strstr(text_of(at("narrow.gp")), "\nlog_x = 0\n"));
  assert_memory_equal(text_of(at("narrow.pdf")), "%PDF", 4);
  assert_int_equal(curves("one.svg", 1, &(struct picture_curve){.label = "lonely", .count = 1, .mean = high}),
                   STATUS_OK);
  assert_non_null(strstr(text_of(at("one.svg")), "lonely"));
  const char *cited = "measured: Nakamura and Fujiwara 1991, Icarus 92, pages 132 to 146, shot 10 of their table 2 "
                      "(sieves: number of a class from its mass)"; /* lines of 96 letters at most */
  assert_int_equal(curves("cited.svg", 1, &(struct picture_curve){.label = cited, .count = 1, .mean = high}),
                   STATUS_OK);
  assert_non_null(strstr(text_of(at("cited.gp")), "table 2'.\"\\n\".'(sieves"));
  assert_non_null(strstr(text_of(at("cited.gp")), "\nlegend_lines = 2\n"));
  const char *rocks[] = {"A limestone of Solnhofen", "Carrara marble", "sandstone_of_a_quarry_near_the_river_Ruhr"};
  struct picture_curve bars = {.count = 3, .mean = high, .places = 2, .place = rocks};
  assert_int_equal(curves("bars.png", 1, &bars), STATUS_OK);
  assert_non_null(strstr(text_of(at("bars.gp")), "\nplace_turned = 0\n"));
  bars.places = 3;
  assert_int_equal(curves("bars.png", 1, &bars), STATUS_OK);
  assert_non_null(strstr(text_of(at("bars.gp")), "\nplace_turned = 1\n"));
  assert_int_equal(curves("none.png", 0, NULL), STATUS_USAGE);
  assert_int_equal(curves("none.png", 1, &(struct picture_curve){.label = NULL, .count = 1, .mean = &low[1]}),
                   STATUS_USAGE);
  assert_int_equal(curves("none.png", 9, both), STATUS_USAGE);
}

/* Bars of the resolution of two series with the same x and y do not hide each other: they are some pixels apart. */
TEST(thin_bars_stand_apart) {
  for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
    const struct picture_mean mean[] = {{1, 0.5, NAN, NAN, 0.1, false},
                                        {logarithmic ? 1000 : 2, 0.5, NAN, NAN, 0.1, false}};
    const struct picture_curve both[] = {{.label = "a", .count = 2, .mean = mean},
                                         {.label = "b", .count = 2, .mean = mean}};
    static const char *const colours[] = {"stroke='rgb(  0, 114, 178)'", "stroke='rgb(213,  94,   0)'"};
    double x[2] = {NAN, NAN};
    assert_int_equal(curves("thin.svg", 2, both), STATUS_OK);
    for (int c = 0; c < 2; c++) { /* its first path is the bar at the first x */
      const char *path = strstr(text_of(at("thin.svg")), colours[c]);
      assert_non_null(path);
      assert_int_equal(sscanf(strstr(path, "d='M") + 4, "%lf", &x[c]), 1);
    }
    assert_true(x[1] - x[0] > 4 && x[1] - x[0] < 20);
  }
}

/* Text from users reaches the picture as plain text: no command, no markup, no file. */
TEST(hostile_text_is_text) {
  const struct picture_mean mean[] = {{1, 2, 1, 3, NAN, false}, {2, 3, 2, 4, NAN, false}};
  const char *evil = "'; system('touch hacked'); `touch hacked` \"$(touch hacked)\" @x {/=99 a}_b \\n\n! touch hacked\n"
                     "\x01\xff\xc3 'end";
  const struct picture_curve curve = {.label = evil, .count = 2, .mean = mean};
  struct picture_page page = {.path = at("| touch hacked ;'`touch hacked`.svg"), .width = 900, .keep_script = true};
  char path[512];
  snprintf(path, sizeof path, "%s", page.path);
  page.path = path;
  if (picture_curves(&page, &(struct picture_words){evil, evil, evil, evil}, 1, &curve, &error))
    fail_msg("%s", error.message);
  const char *svg = text_of(path);
  assert_non_null(strstr(svg, "'; system('touch hacked'); `touch hacked` \"$(touch hacked)\" @x {/=99 a}_b \\n"));
  assert_null(strchr(svg, 1));
  assert_int_not_equal(access("hacked", F_OK), 0);
  assert_int_not_equal(access(at("hacked"), F_OK), 0);
}

TEST(missing_gnuplot_is_told) {
  const struct picture_mean mean[] = {{1, 2, 1, 3, NAN, false}, {2, 3, 2, 4, NAN, false}};
  const struct picture_curve curve = {.label = "a", .count = 2, .mean = mean};
  const struct picture_page page = {.path = "missing.png", .width = 900};
  char path[4096];
  snprintf(path, sizeof path, "%s", getenv("PATH"));
  setenv("PATH", "/nowhere", 1);
  assert_int_equal(picture_curves(&page, &(struct picture_words){0}, 1, &curve, &error), STATUS_MISSING);
  assert_non_null(strstr(error.message, "apt-get install gnuplot-nox"));
  setenv("PATH", path, 1);
  assert_int_not_equal(access("missing.png", F_OK), 0);
}

TEST(errors_leave_nothing) {
  static struct example e;
  make_example(&e, 0.1);
  struct picture_panel panel = {.body = body_of(&e)};
  assert_int_equal(picture_fragments(at("a.jpg"), 600, NULL, NULL, &panel, &error), STATUS_USAGE);
  assert_non_null(strstr(error.message, ".png"));
  assert_int_equal(picture_fragments(at("no/such/a.png"), 600, NULL, NULL, &panel, &error), STATUS_IO);
  assert_int_equal(picture_fragments(at("no/such/a.svg"), 600, NULL, NULL, &panel, &error), STATUS_IO);
  assert_int_equal(picture_fragments(at("none.png"), NAN, NULL, NULL, &panel, &error), STATUS_USAGE);
  e.fragment[3] = 4000000000u;
  assert_int_equal(picture_fragments(at("none.png"), 600, NULL, NULL, &panel, &error), STATUS_USAGE);
  e.fragment[3] = 0;
  e.vertex[9][0] = NAN;
  picture_fragments(at("nan.png"), 600, NULL, NULL, &panel, &error); /* must not trap */
  struct stat found;
  assert_int_not_equal(stat(at("none.png"), &found), 0);
  panel.body.cells = 0;
  assert_int_equal(picture_fragments(at("none.png"), 600, NULL, NULL, &panel, &error), STATUS_USAGE);
}

/* ---- pinned pixels ---- */

/* Fonts differ between machines, and with them the words. Is it the font of the pinned pictures? */
static bool same_font(void) {
  cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 10, 10);
  cairo_t *cairo = cairo_create(surface);
  cairo_text_extents_t size;
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, 100);
  cairo_text_extents(cairo, "Hamburg 0.35", &size);
  cairo_destroy(cairo);
  cairo_surface_destroy(surface);
  return fabs(size.width - 701) < 1 && fabs(size.height - 97) < 1;
}

enum { CELL = 16 };

/* Writes a picture as rows of cells of 16 x 16 pixels: red, green and blue of their mean colour, 0 to f each. */
static void print_cells(const char *name, FILE *out) {
  cairo_surface_t *surface = cairo_image_surface_create_from_png(at(name));
  assert_int_equal(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  const int width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
  const unsigned char *data = cairo_image_surface_get_data(surface);
  fprintf(out, "%s %d x %d\n", name, width, height);
  for (int row = 0; row < height / CELL; row++) {
    for (int column = 0; column < width / CELL; column++) {
      int sum[3] = {0};
      for (int k = 0; k < CELL * CELL; k++)
        for (int c = 0; c < 3; c++)
          sum[c] += data[(row * CELL + k / CELL) * cairo_image_surface_get_stride(surface) +
                         4 * (column * CELL + k % CELL) + 2 - c];
      fprintf(out, " %x%x%x", sum[0] / (CELL * CELL * 16), sum[1] / (CELL * CELL * 16), sum[2] / (CELL * CELL * 16));
    }
    fputc('\n', out);
  }
  cairo_surface_destroy(surface);
}

/* Compares cell by cell. With the same font three levels may differ by one (rounding); with another font three in a
 * hundred by more than three. */
static void same_cells(const char *pinned, const char *now, bool strict) {
  size_t cells = 0, others = 0;
  for (; *pinned && *now; pinned++, now++) {
    const char *digits = "0123456789abcdef", *a = strchr(digits, *pinned), *b = strchr(digits, *now);
    if (*pinned == *now)
      cells++;
    else if (a && b)
      cells++, others += strict ? (size_t)llabs(a - b) : llabs(a - b) > 3;
    else
      fail_msg("pictures.txt: other pictures, from here on: %.60s", pinned);
  }
  assert_true(*pinned == *now);
  if (others > (strict ? 3 : cells / 100 * 3))
    fail_msg("%zu of %zu levels changed; CLAST_RENEW=1 writes tests/unit/pictures.txt anew: see what changed", others,
             cells);
}

/* A small body of squares with a crack, and of two fragments and a grain far off; a cloud of particles whose fragments,
 * layers and dust are told apart; tiles of safe, warned and refused runs. */
TEST(pixels_are_pinned) {
  struct picture_body body = {.cells = 4,
                              .first_vertex = (uint32_t[]){0, 4, 8, 11, 15},
                              .vertex = (double[15][2]){{0, 0},
                                                        {2, 0},
                                                        {2, 1},
                                                        {0, 1},
                                                        {2, 0},
                                                        {3, 0},
                                                        {3, 1},
                                                        {2, 1},
                                                        {3.2, 0},
                                                        {4.2, 0},
                                                        {3.2, 1},
                                                        {0, 1.3},
                                                        {1, 1.3},
                                                        {1, 2.3},
                                                        {0, 2.3}},
                              .fragment = (uint32_t[]){0, 0, 1, 2},
                              .cracks = 1,
                              .crack = (uint32_t[][2]){{0, 1}}};
  int64_t last[] = {2, 1, 0, 3}; /* the first fragment becomes 2 and 1, the second becomes the heaviest */
  const struct picture_frame frames[2] = {{.view = {-1, 0, 3, 2}, .members = 4, .last = last},
                                          {.view = {2.5, -1, 4.5, 1}}};
  struct picture_panel panels[3] = {{.body = body, .caption = "whole"},
                                    {.body = body, .frame = &frames[0]},
                                    {.body = body, .caption = "right", .frame = &frames[1]}};
  OK(picture_fragments(at("grains.png"), 320, "Grains", "four of them", &panels[0], &error));
  OK(picture_fragments(at("framed.png"), 320, "Grains", NULL, &panels[1], &error));

  const struct picture_frame all = {.view = {-1, -1, 5, 3}};
  struct picture_sheet *sheet = NULL;
  assert_int_equal(picture_sheet_open(at("sheet.png"), 3, &all, &sheet, NULL), STATUS_OK);
  panels[2].caption = "under the last one";
  for (int k = 0; k < 3; k++)
    assert_int_equal(picture_fragments_on_sheet(sheet, "Sheet", k == 1 ? "middle" : "side", &panels[k], NULL),
                     STATUS_OK);
  assert_int_equal(picture_sheet_close(sheet, STATUS_OK, NULL), STATUS_OK);

  enum { N = 24 };
  double position[N][3], size[N], mass[N], value[N];
  int64_t fragment[N], part[N];
  for (int k = 0; k < N; k++) {
    position[k][0] = 0.01 * (k % 4) + (k >= 16 ? 0.06 : 0);
    position[k][1] = 0.01 * (k / 4 % 2) + 0.001 * k;
    position[k][2] = 0.012 * (k / 8);
    size[k] = k == 5 ? 0.016 : 0.01;
    mass[k] = k == 5 ? 0.004 : 0.001;
    value[k] = k / 23.0;
    fragment[k] = k == 23 ? -1 : k == 22 ? 2 : k >= 16;
    part[k] = k == 23 ? PICTURE_LEFT_OUT : k == 22 ? PICTURE_DUST : k % 8 == 0 ? PICTURE_LAYER : PICTURE_CORE;
  }
  struct picture_cloud cloud = {.n = N,
                                .position = position,
                                .size = size,
                                .mass = mass,
                                .fragment = fragment,
                                .part = part,
                                .engine = "sph",
                                .seed = 3,
                                .time = 1e-6};
  char numbers[200];
  picture_particles_numbers(&cloud, numbers, sizeof numbers);
  /* 16 particles have 19 g, 6 have 6 g, and one has 1 g by itself; one has no fragment */
  assert_string_equal(numbers, "23 particles: 2 fragments of two and more (largest 73.1 %, second 23.1 % of the mass), "
                               "3.8 % in single particles");
  struct picture_look look = {.view = PICTURE_CUT, .axis = 1, .plane = NAN, .title = "Cut", .subtitle = "by fragment"};
  assert_int_equal(picture_particles(at("cut.png"), 480, &cloud, &look, NULL), STATUS_OK);
  look = (struct picture_look){.view = PICTURE_OUTSIDE, .axis = 2, .plane = NAN, .title = "Outside"};
  assert_int_equal(picture_particles(at("outside.png"), 480, &cloud, &look, NULL), STATUS_OK);
  look = (struct picture_look){.view = PICTURE_APART, .axis = 1, .plane = NAN, .title = "Apart"};
  assert_int_equal(picture_particles(at("apart.png"), 480, &cloud, &look, NULL), STATUS_OK);
  cloud.value = value;
  look = (struct picture_look){.view = PICTURE_OUTSIDE, .axis = 0, .plane = NAN, .quantity = "damage", .unit = "1"};
  assert_int_equal(picture_particles(at("damage.png"), 480, &cloud, &look, NULL), STATUS_OK);
  for (int k = 0; k < N; k++)
    value[k] = 1e8 * (k - 8);
  look = (struct picture_look){.view = PICTURE_CUT, .axis = 2, .plane = 0.012, .quantity = "pressure", .unit = "Pa"};
  assert_int_equal(picture_particles(at("pressure.png"), 480, &cloud, &look, NULL), STATUS_OK);

  static const char *const names[] = {"grains.png", "framed.png", "cut.png",      "outside.png",
                                      "apart.png",  "damage.png", "pressure.png", "sheet.png"};
  static const char *const path = CLAST_SOURCE_DIR "/tests/unit/pictures.txt";
  OWNED char *now = NULL, *pinned = NULL;
  size_t length = 0;
  FILE *out = open_memstream(&now, &length);
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    print_cells(names[k], out);
  fclose(out);
  if (getenv("CLAST_RENEW")) {
    FILE *file = fopen(path, "w");
    assert_true(file && fwrite(now, 1, length, file) == length && fclose(file) == 0);
  }
  FILE *file = fopen(path, "r");
  assert_true(file && getdelim(&pinned, &(size_t){0}, 0, file) > 0);
  fclose(file);
  same_cells(pinned, now, same_font());
}

static bool is_among(const char *word, size_t length, size_t count, const char *const *words) {
  for (size_t k = 0; k < count; k++)
    if (strlen(words[k]) == length && strncmp(words[k], word, length) == 0)
      return true;
  return false;
}

/* Is it a picture of a test, or a script that it keeps? Pictures that are refused are called none. */
static bool is_drawn(const char *name) {
  static const char *const pictures[] = {".png", ".svg", ".pdf"}, *const scripts[] = {".gp", ".dat"},
                           *const kept[] = {"curves", "bars",  "cited",
                                            "narrow", "thin",  "one",
                                            "frame",  "lines", "| touch hacked ;'`touch hacked`"};
  const char *ending = strrchr(name, '.');
  if (!ending || strncmp(name, "none", 4) == 0)
    return false;
  return is_among(ending, strlen(ending), 3, pictures) ||
         (is_among(ending, strlen(ending), 2, scripts) &&
          is_among(name, (size_t)(ending - name), sizeof kept / sizeof *kept, kept));
}

int main(int count, char **arguments) {
  if (count > 1)
    snprintf(folder, sizeof folder, "%s", arguments[1]);
  else {
    snprintf(folder, sizeof folder, "pictures.XXXXXX");
    if (!mkdtemp(folder))
      return 1;
  }
  int failed = check_run(NULL, NULL);
  if (count < 2 && sweep(folder, is_drawn) != 0)
    failed++;
  return failed;
}
