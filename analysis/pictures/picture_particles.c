/* Particles drawn as discs: a cut, a view from outside, or the fragments apart. */
#include <math.h>
#include <stdio.h>

#include "analysis/pictures/picture_scene.h"
#include "schemas/text.h"

void picture_particles_numbers(const struct picture_cloud *cloud, char *text, size_t size) {
  struct picture_scene s = {.cloud = cloud};
  double total, single;
  size_t searched = picture_scene_masses(cloud, &total, &single), fragments = 0;
  text[0] = 0;
  if (total > 0 && picture_scene_gather(&s) == STATUS_OK) {
    for (size_t f = 0; f < s.fragments; f++)
      fragments += s.count[f] > 1;
    double largest = s.fragments ? s.mass[0] : 0, second = s.fragments > 1 && s.count[1] > 1 ? s.mass[1] : 0;
    snprintf(text, size,
             "%zu particles: %zu fragment%s of two and more (largest %.1f %%, second %.1f %% of the mass), %.1f %% in "
             "single particles",
             searched, fragments, fragments == 1 ? "" : "s", 100 * largest / total, 100 * second / total,
             100 * single / total);
  }
  picture_scene_clear(&s);
}

/* Golden-angle steps of hue, as for bodies of grains. light: from -1 (far) to 1 (near). */
static void fragment_colour(cairo_t *cairo, const struct picture_scene *s, size_t i, double light) {
  const int64_t f = s->cloud->fragment[i], part = s->cloud->part[i];
  if (part == PICTURE_LEFT_OUT || f < 0) {
    picture_canvas_colour(cairo, 0.55 + 0.1 * light, 0.01, 250, 1);
    return;
  }
  if (part == PICTURE_DUST) {
    picture_canvas_colour(cairo, 0.90 + 0.03 * light, 0.004, 250, 1);
    return;
  }
  const double hue = fmod(252 + 137.50776 * (double)f, 360), wave = 0.03 * ((double)(f % 3) - 1);
  const bool large = s->count[f] >= PICTURE_SCENE_RESOLVED;
  double lightness = (large ? 0.68 : 0.84) + wave + 0.14 * light, chroma = large ? 0.125 : 0.05;
  if (part == PICTURE_LAYER) {
    lightness += 0.05;
    chroma *= 0.75;
  }
  picture_canvas_colour(cairo, lightness, chroma, hue, 1);
}

static void value_colour(cairo_t *cairo, const struct picture_scene *s, double value) {
  if (!isfinite(value)) { /* the particle has no value */
    cairo_set_source_rgb(cairo, 0.88, 0.88, 0.88);
    return;
  }
  const double share = s->high > s->low ? (value - s->low) / (s->high - s->low) : 0.5;
  picture_canvas_ramp(cairo, s->ramp, fmin(fmax(share, 0), 1));
}

/* Draws a dark rim that separates a disc from those behind it. */
static void draw_rim(cairo_t *cairo, const struct picture_layout_disc *d) {
  cairo_arc(cairo, d->x, d->y, 1.1 * d->radius, 0, 2 * M_PI);
  cairo_set_source_rgba(cairo, 0.1, 0.1, 0.12, 0.22);
  cairo_fill(cairo);
}

static void draw_discs(cairo_t *cairo, const struct picture_scene *s) {
  const bool cut = s->look->view == PICTURE_CUT;
  const double near = s->disc[s->discs - 1].depth, far = s->disc[s->discs / 50].depth;
  for (size_t k = 0; k < s->discs; k++) {
    const struct picture_layout_disc *d = &s->disc[k];
    const double light = cut || !(near > far) ? 0 : fmin(fmax(2 * (d->depth - far) / (near - far) - 1, -1), 1);
    if (!cut)
      draw_rim(cairo, d);
    if (s->cloud->value)
      value_colour(cairo, s, s->cloud->value[d->id]);
    else
      fragment_colour(cairo, s, d->id, light);
    cairo_arc(cairo, d->x, d->y, d->radius, 0, 2 * M_PI);
    cairo_fill(cairo);
  }
}

/* Draws the directions of the axes as two short arrows in the lower left corner. */
static void axes(cairo_t *cairo, int along, double x, double y, double font) {
  static const char *const names[] = {"x", "y", "z"};
  const char *right = names[along == 0 ? 1 : 0], *up = names[along == 2 ? 1 : 2];
  double length = 2.2 * font, head = 0.35 * font;
  cairo_set_source_rgb(cairo, 0.25, 0.25, 0.25);
  cairo_set_line_width(cairo, 0.10 * font);
  cairo_move_to(cairo, x + length, y);
  cairo_line_to(cairo, x, y);
  cairo_line_to(cairo, x, y - length);
  cairo_move_to(cairo, x + length - head, y - head);
  cairo_line_to(cairo, x + length, y);
  cairo_line_to(cairo, x + length - head, y + head);
  cairo_move_to(cairo, x - head, y - length + head);
  cairo_line_to(cairo, x, y - length);
  cairo_line_to(cairo, x + head, y - length + head);
  cairo_stroke(cairo);
  picture_canvas_text(cairo, x + length + 0.4 * font, y + 0.3 * font, 0.95 * font, PICTURE_LEFT, false, right);
  picture_canvas_text(cairo, x, y - length - 0.4 * font, 0.95 * font, PICTURE_CENTRE, false, up);
}

static void legend_line(cairo_t *cairo, double x, double y, double font, const char *text) {
  cairo_rectangle(cairo, x, y, font, font);
  cairo_fill(cairo);
  cairo_set_source_rgb(cairo, 0.2, 0.2, 0.2);
  picture_canvas_text(cairo, x + 1.5 * font, y + 0.85 * font, 0.95 * font, PICTURE_LEFT, false, text);
}

/* Index of a particle in a fragment's core; n if there is none. */
static size_t core_particle(const struct picture_cloud *cloud, size_t fragment) {
  size_t i = 0;
  while (i < cloud->n && !(cloud->fragment[i] == (int64_t)fragment && cloud->part[i] == PICTURE_CORE))
    i++;
  return i;
}

/* Lists the heaviest fragments and the single particles with their shares of the mass. */
static void legend(cairo_t *cairo, const struct picture_scene *s, double x, double y, double font) {
  enum { MOST = 8 };
  char text[48];
  double total, single;
  picture_scene_masses(s->cloud, &total, &single);
  for (size_t f = 0; f < MOST && f < s->fragments && s->count[f] >= PICTURE_SCENE_RESOLVED; f++, y += 1.6 * font) {
    size_t sample = core_particle(s->cloud, f);
    if (sample == s->cloud->n)
      continue;
    fragment_colour(cairo, s, sample, 0);
    snprintf(text, sizeof text, "%.3g %%", 100 * s->mass[f] / total);
    legend_line(cairo, x, y, font, text);
  }
  if (!(single > 0 && total > 0))
    return;
  picture_canvas_colour(cairo, 0.90, 0.004, 250, 1);
  snprintf(text, sizeof text, "%.3g %% single", 100 * single / total);
  legend_line(cairo, x, y, font, text);
}

/* Writes a note under the picture about particles that are missing or have no value. */
static void note(cairo_t *cairo, const struct picture_scene *s, double left, double y, double font) {
  char text[300] = "";
  size_t grey = 0;
  for (size_t k = 0; s->cloud->value && k < s->discs; k++)
    grey += isfinite(s->cloud->value[s->disc[k].id]) ? 0u : 1u;
  if (grey)
    text_append(text, sizeof text, "Grey: broken matter, which bears no tension. ");
  if (s->hidden > 0)
    text_append(text, sizeof text, "Fragments with %.3g %% of the mass are hidden: see the view apart. ",
                100 * s->hidden);
  if (s->left_out)
    text_append(text, sizeof text, "%zu particles are beyond the frame.", s->left_out);
  cairo_set_source_rgb(cairo, 0.35, 0.35, 0.35);
  picture_canvas_text(cairo, left, y, 0.9 * font, PICTURE_LEFT, false, text);
}

static status draw(const char *path, double width, struct picture_scene *s, struct error *error) {
  const struct picture_look *look = s->look;
  double font = width / 52, gap = 1.5 * font;
  double wide = width - 2 * gap - 9 * font; /* the colour bar or the legend is on the right */
  double tall = wide * (s->view[3] - s->view[1]) / (s->view[2] - s->view[0]);
  if (!isfinite(tall))
    return status_fail(error, STATUS_USAGE, "%s: the particles have no extent to draw", path);
  tall = fmin(fmax(tall, 14 * font), 1.1 * wide);
  double scale = fmin(wide / (s->view[2] - s->view[0]), tall / (s->view[3] - s->view[1]));
  double top = font * (1.2 + (look->title ? 1.9 : 0) + (look->subtitle ? 1.6 : 0));
  struct picture_canvas canvas;
  TRY(picture_canvas_open(&canvas, path, width, top + tall + 6.6 * font, error));
  cairo_t *cairo = canvas.cairo;
  cairo_save(cairo);
  cairo_rectangle(cairo, gap, top, wide, tall);
  cairo_clip(cairo);
  cairo_translate(cairo, gap + wide / 2, top + tall / 2);
  cairo_scale(cairo, scale, -scale);
  cairo_translate(cairo, -(s->view[0] + s->view[2]) / 2, -(s->view[1] + s->view[3]) / 2);
  draw_discs(cairo, s);
  cairo_restore(cairo);
  picture_canvas_head(cairo, gap, width - 2 * gap, font, look->title, 0.95 * font, look->subtitle);
  axes(cairo, s->axis, gap + 0.5 * font, top + tall + 3.9 * font, font);
  picture_canvas_scale_bar(cairo, gap + 7 * font, top + tall + 3.9 * font, scale, wide, font);
  note(cairo, s, gap, top + tall + 5.7 * font, font);
  if (s->cloud->value)
    picture_canvas_colour_bar(cairo, s->ramp, gap + wide + 1.2 * font, top, 1.2 * font, fmin(tall, 26 * font), font,
                              s->low / s->scale, s->high / s->scale, s->label);
  else
    legend(cairo, s, gap + wide + 1.2 * font, top, font);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}

/* Chooses the discs, frame and colours. STATUS_MEMORY. */
static status choose(struct picture_scene *s) {
  status code = picture_scene_gather(s);
  if (code)
    return code;
  s->axis = s->look->axis < 0 ? 1 : s->look->axis;
  picture_scene_choose_discs(s);
  if (s->look->view == PICTURE_OUTSIDE)
    code = picture_scene_turn(s);
  if (s->look->view == PICTURE_APART && s->discs > 0)
    code = picture_layout_apart(s->cloud, s->discs, s->disc);
  if (code || s->discs == 0)
    return code;
  code = picture_scene_frame(s);
  return code ? code : picture_scene_choose_colours(s);
}

/* Chooses and draws. Sets *error itself unless the code is STATUS_MEMORY. */
static status compose(const char *path, double width, struct picture_scene *s, struct error *error) {
  TRY(s->cloud->n ? choose(s) : STATUS_OK);
  if (s->discs > 0)
    return draw(path, width, s, error);
  if (s->look->view == PICTURE_CUT)
    return status_fail(error, STATUS_USAGE, "%s: the plane of the cut meets no particle: choose another --at or --axis",
                       path);
  return status_fail(error, STATUS_USAGE, "%s: there is no particle to draw", path);
}

status picture_particles(const char *path, double width, const struct picture_cloud *cloud,
                         const struct picture_look *look, struct error *error) {
  if (look->axis > 2)
    return status_fail(error, STATUS_USAGE, "%s: there is no axis %d", path, look->axis);
  for (size_t i = 0; i < cloud->n; i++)
    if (cloud->fragment[i] >= (int64_t)cloud->n)
      return status_fail(error, STATUS_USAGE, "%s: fragment numbers beyond the number of particles", path);

  struct picture_scene s = {.cloud = cloud, .look = look};
  status code = compose(path, width, &s, error);
  if (code == STATUS_MEMORY)
    status_fail(error, code, "%s: no memory for the picture", path);
  picture_scene_clear(&s);
  return code;
}
