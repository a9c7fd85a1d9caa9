/* Particles drawn as discs: a cut, a view from outside, or the fragments apart. */
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/picture_layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

enum { RESOLVED = 10 }; /* particles: a smaller fragment is poorly resolved and gets a pale tint */

struct scene {
  const struct picture_cloud *cloud;
  const struct picture_look *look;
  size_t fragments, discs;
  uint32_t *count; /* particles by fragment */
  int64_t *number; /* by fragment: what it is coloured by */
  double *mass;    /* kg by fragment */
  double (*centre)[3];
  double middle[3]; /* m: centre of the heaviest fragment, or of all particles */
  struct picture_layout_disc *disc;
  double low, high, scale; /* range of the colours; values are divided by `scale` */
  double view[4];
  bool measuring;  /* only the frame is wanted */
  size_t left_out; /* number of particles outside the frame */
  char label[160];
  enum picture_ramp ramp;
};

static const double REACH = 0.80; /* disc radius divided by size: discs overlap a little, so that a cut has no holes */

#define SCENE_OF_DISCS __attribute__((cleanup(clear))) struct scene
static void clear(struct scene *s) {
  free(s->count);
  free(s->number);
  free(s->mass);
  free(s->centre);
  free(s->disc);
}

static void add_weighted(double sum[3], double mass, const double position[3]) {
  for (int d = 0; d < 3; d++)
    sum[d] += mass * position[d];
}

static status gather(struct scene *s) {
  const struct picture_cloud *c = s->cloud;
  for (size_t i = 0; i < s->cloud->n; i++)
    if (s->cloud->fragment[i] >= (int64_t)s->fragments)
      s->fragments = (size_t)s->cloud->fragment[i] + 1;
  TRY(memory_array(&s->count, s->fragments, sizeof *s->count, "", NULL));
  TRY(memory_array(&s->number, s->fragments, sizeof *s->number, "", NULL));
  TRY(memory_array(&s->mass, s->fragments, sizeof *s->mass, "", NULL));
  TRY(memory_array(&s->centre, s->fragments, sizeof *s->centre, "", NULL));
  TRY(memory_array(&s->disc, s->cloud->n, sizeof *s->disc, "", NULL));
  double total = 0, all[3] = {0, 0, 0};
  const struct picture_frame *frame = s->look ? s->look->frame : NULL;
  const bool follows = frame && frame->last && frame->members == c->n;
  for (size_t f = 0; f < s->fragments; f++)
    s->number[f] = follows ? INT64_MAX : (int64_t)f;
  for (size_t i = 0; i < c->n; i++) {
    total += c->mass[i];
    add_weighted(all, c->mass[i], c->position[i]);
    if (c->fragment[i] < 0)
      continue;
    const size_t f = (size_t)c->fragment[i];
    s->count[f]++;
    if (follows && frame->last[i] >= 0 && frame->last[i] < s->number[f])
      s->number[f] = frame->last[i];
    s->mass[f] += c->mass[i];
    add_weighted(s->centre[f], c->mass[i], c->position[i]);
  }
  for (size_t f = 0; f < s->fragments; f++) {
    s->number[f] = s->number[f] < INT64_MAX ? s->number[f] : (int64_t)f;
    for (int d = 0; d < 3; d++)
      s->centre[f][d] /= s->count[f] ? s->mass[f] : 1;
  }
  const bool large = s->fragments > 0 && s->count[0] >= RESOLVED;
  for (int d = 0; d < 3; d++)
    s->middle[d] = large ? s->centre[0][d] : all[d] / total;
  return STATUS_OK;
}

static bool resolved(const struct scene *s, size_t i) {
  return s->cloud->fragment[i] >= 0 && s->count[s->cloud->fragment[i]] >= RESOLVED;
}

static size_t weigh(const struct picture_cloud *cloud, double *total, double *single) {
  size_t searched = 0;
  *total = *single = 0;
  for (size_t i = 0; i < cloud->n; i++) {
    if (cloud->part[i] == PICTURE_LEFT_OUT)
      continue;
    searched++;
    *total += cloud->mass[i];
    if (cloud->part[i] == PICTURE_DUST)
      *single += cloud->mass[i];
  }
  return searched;
}

static int by_depth(const void *a, const void *b) {
  const struct picture_layout_disc *p = a, *q = b;
  if (p->depth != q->depth)
    return p->depth < q->depth ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

/* The disc of particle i, seen along the axis of sight. False: it is not drawn. */
static bool make_disc(const struct scene *s, size_t i, struct picture_layout_disc *disc) {
  const struct picture_cloud *c = s->cloud;
  const enum picture_view view = s->look->view;
  const int along = s->look->axis, right = along == 0 ? 1 : 0, up = along == 2 ? 1 : 2;
  if (view == PICTURE_APART && (c->part[i] >= PICTURE_DUST || c->fragment[i] < 0))
    return false;
  const double *at = c->position[i];
  *disc = (struct picture_layout_disc){at[right], at[up], REACH * c->size[i], at[along], (uint32_t)i};
  if (along == 1) /* x right, z up: y points away */
    disc->depth = -disc->depth;
  if (view != PICTURE_CUT)
    return true;
  const struct picture_frame *frame = s->look->frame;
  const double plane = isfinite(s->look->plane) || !frame ? s->look->plane : frame->plane;
  const double off = at[along] - (isfinite(plane) ? plane : s->middle[along]);
  if (fabs(off) >= disc->radius)
    return false;
  disc->depth = -fabs(off) / c->size[i];
  disc->radius = sqrt(disc->radius * disc->radius - off * off);
  return true;
}

static void choose_discs(struct scene *s) {
  s->discs = 0;
  for (size_t i = 0; i < s->cloud->n; i++)
    s->discs += make_disc(s, i, &s->disc[s->discs]);
  qsort(s->disc, s->discs, sizeof *s->disc, by_depth);
}

static void cover(double view[4], double x, double y, double radius) {
  view[0] = fmin(view[0], x - radius);
  view[1] = fmin(view[1], y - radius);
  view[2] = fmax(view[2], x + radius);
  view[3] = fmax(view[3], y + radius);
}

/* Is what has no fragments, such as a projectile, one body? It is before the run, and as long as its particles fill a
 * tenth of their box: a ball fills half of it, a spray after the impact nearly nothing. */
static bool is_body(const struct picture_cloud *c) {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, filled = 0, box = 1;
  size_t count = 0;
  if (c->time <= 0)
    return true;
  for (size_t i = 0; i < c->n; i++) {
    if (c->part[i] != PICTURE_LEFT_OUT)
      continue;
    count++;
    filled += c->size[i] * c->size[i] * c->size[i];
    for (int d = 0; d < 3; d++) {
      low[d] = fmin(low[d], c->position[i][d] - c->size[i] / 2);
      high[d] = fmax(high[d], c->position[i][d] + c->size[i] / 2);
    }
  }
  for (int d = 0; d < 3; d++)
    box *= high[d] - low[d];
  return count >= RESOLVED && filled > 0.1 * box;
}

/* Shows all resolved fragments, a projectile that is one body, and nine tenths of the rest along each axis, so
 * that jets do not shrink the body. With fragments apart: all drawn discs. */
static status choose_view(struct scene *s) {
  OWNED double *sorted = NULL;
  double all[4] = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, *view = s->view;
  TRY(memory_array(&sorted, s->discs, sizeof *sorted, "", NULL));
  memcpy(view, all, sizeof all);
  const bool whole = is_body(s->cloud);
  for (size_t k = 0; k < s->discs; k++) {
    const struct picture_layout_disc *d = &s->disc[k];
    cover(all, d->x, d->y, d->radius);
    if (s->look->view == PICTURE_APART || resolved(s, d->id) || (whole && s->cloud->part[d->id] == PICTURE_LEFT_OUT))
      cover(view, d->x, d->y, d->radius);
  }
  for (int axis = 0; axis < 2; axis++) {
    for (size_t k = 0; k < s->discs; k++)
      sorted[k] = axis ? s->disc[k].y : s->disc[k].x;
    qsort(sorted, s->discs, sizeof *sorted, sample_ascending);
    size_t out = s->discs / 20;
    view[axis] = fmin(view[axis], sorted[out]);
    view[axis + 2] = fmax(view[axis + 2], sorted[s->discs - 1 - out]);
  }
  double margin = 0.06 * fmax(view[2] - view[0], view[3] - view[1]);
  for (int axis = 0; axis < 2; axis++) {
    view[axis] = fmax(view[axis] - margin, all[axis] - margin / 6);
    view[axis + 2] = fmin(view[axis + 2] + margin, all[axis + 2] + margin / 6);
  }
  return STATUS_OK;
}

static bool is_inside(const double view[4], const struct picture_layout_disc *d) {
  return d->x - d->radius >= view[0] && d->x + d->radius <= view[2] && d->y - d->radius >= view[1] &&
         d->y + d->radius <= view[3];
}

/* Leaves out fragments and single particles that do not fit wholly into the frame, such as jets and small distant
 * fragments. */
static status leave_out(struct scene *s) {
  OWNED bool *out = NULL;
  size_t kept = 0;
  TRY(memory_array(&out, s->fragments, sizeof *out, "", NULL));
  for (size_t k = 0; k < s->discs; k++) {
    const int64_t f = s->cloud->fragment[s->disc[k].id];
    if (f >= 0 && !is_inside(s->view, &s->disc[k]))
      out[f] = true;
  }
  for (size_t k = 0; k < s->discs; k++) {
    const int64_t f = s->cloud->fragment[s->disc[k].id];
    const bool gone = f >= 0 ? out[f] : !is_inside(s->view, &s->disc[k]);
    if (!gone)
      s->disc[kept++] = s->disc[k];
    s->left_out += gone;
  }
  s->discs = kept;
  return STATUS_OK;
}

/* A unit of a fields file as other charts have it: "kg/m³" for "kg m-3". */
static void write_unit(const char *unit, char *text, size_t size) {
  char slashed[64] = "";
  while (*unit) {
    const size_t name = strcspn(unit, " -"), power = unit[name] == '-' ? strspn(unit + name + 1, "0123456789") : 0;
    const char *const digits = unit + name + 1;
    text_append(slashed, sizeof slashed, "%s%.*s", !*slashed ? "" : power ? "/" : " ", (int)name, unit);
    if (power && strncmp(digits, "1", power) != 0)
      text_append(slashed, sizeof slashed, "^%.*s", (int)power, digits);
    unit += name + (power ? 1 + power : unit[name] == '-');
    unit += *unit == ' ';
  }
  text_raise(slashed, text, size);
}

/* Chooses a prefix of the unit by the largest value shown, such as GPa. Shares, lengths and masses get none. */
static void choose_unit(struct scene *s, double largest) {
  static const struct {
    double factor;
    const char *letter;
  } prefix[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}};
  const char *unit = s->look->unit ? s->look->unit : "1", *letter = "";
  bool prefixed = strcmp(unit, "1") != 0 && strcmp(unit, "m") != 0 && strncmp(unit, "kg", 2) != 0;
  s->scale = 1;
  for (size_t k = 0; k < 3 && prefixed; k++)
    if (largest >= prefix[k].factor) {
      s->scale = prefix[k].factor;
      letter = prefix[k].letter;
      break;
    }
  char shown[64];
  write_unit(unit, shown, sizeof shown);
  snprintf(s->label, sizeof s->label, strcmp(unit, "1") == 0 ? "%s" : "%s (%s%s)",
           s->look->quantity ? s->look->quantity : "", letter, shown);
}

/* Collects the finite values of drawn particles. `searched`: only of particles that were searched for fragments, so
 * that a hot and dense projectile does not set the range of the body. */
static size_t collect_values(const struct scene *s, bool searched, double *values) {
  size_t count = 0;
  for (size_t k = 0; k < s->discs; k++) {
    uint32_t i = s->disc[k].id;
    if (isfinite(s->cloud->value[i]) && !(searched && s->cloud->part[i] == PICTURE_LEFT_OUT))
      values[count++] = s->cloud->value[i];
  }
  return count;
}

/* Chooses range and ramp for ascending values: without the outermost percent at both ends; shares (without a unit, and
 * within 0 and 1) always from 0 to 1; symmetric about 0 where there are both signs. */
static void choose_range(struct scene *s, const double *sorted, size_t count) {
  static const double nothing[2] = {0, 1};
  if (count == 0) {
    sorted = nothing;
    count = 2;
  }
  s->low = sorted[count / 100];
  s->high = sorted[count - 1 - count / 100];
  s->ramp = PICTURE_RAMP_RISING;
  if (s->look->unit && strcmp(s->look->unit, "1") == 0 && sorted[0] >= 0 && sorted[count - 1] <= 1) {
    s->low = 0;
    s->high = 1;
    if (s->look->quantity && strcmp(s->look->quantity, "damage") == 0)
      s->ramp = PICTURE_RAMP_DAMAGE;
  }
  if (s->low < 0 && s->high > 0) {
    s->ramp = PICTURE_RAMP_SIGNED;
    s->high = fmax(s->high, -s->low);
    s->low = -s->high;
  }
}

static status choose_colours(struct scene *s) {
  if (!s->cloud->value)
    return STATUS_OK;
  OWNED double *sorted = NULL;
  TRY(memory_array(&sorted, s->discs, sizeof *sorted, "", NULL));
  size_t count = collect_values(s, true, sorted);
  if (count == 0)
    count = collect_values(s, false, sorted);
  qsort(sorted, count, sizeof *sorted, sample_ascending);
  choose_range(s, sorted, count);
  choose_unit(s, fmax(fabs(s->low), fabs(s->high)));
  return STATUS_OK;
}

/* ---- drawing ---- */

void picture_particles_numbers(const struct picture_cloud *cloud, char *text, size_t size) {
  SCENE_OF_DISCS s = {.cloud = cloud};
  double total, single;
  size_t searched = weigh(cloud, &total, &single), fragments = 0;
  text[0] = 0;
  if (total > 0 && gather(&s) == STATUS_OK) {
    for (size_t f = 0; f < s.fragments; f++)
      fragments += s.count[f] > 1;
    double largest = s.fragments ? s.mass[0] : 0, second = s.fragments > 1 && s.count[1] > 1 ? s.mass[1] : 0;
    snprintf(text, size,
             "%zu particles: %zu fragment%s of two and more (largest %.1f %%, second %.1f %% of the mass), %.1f %% in "
             "single particles",
             searched, fragments, fragments == 1 ? "" : "s", 100 * largest / total, 100 * second / total,
             100 * single / total);
  }
}

/* Golden-angle steps of hue, as for bodies of grains. light: from -1 (far) to 1 (near). */
static void fragment_colour(cairo_t *cairo, const struct scene *s, size_t i, double light) {
  const int64_t f = s->cloud->fragment[i], part = s->cloud->part[i];
  if (part == PICTURE_LEFT_OUT || f < 0) {
    picture_canvas_colour(cairo, 0.55 + 0.1 * light, 0.01, 250, 1);
    return;
  }
  if (part == PICTURE_DUST) {
    picture_canvas_colour(cairo, 0.90 + 0.03 * light, 0.004, 250, 1);
    return;
  }
  const int64_t number = s->number[f];
  const double hue = fmod(252 + 137.50776 * (double)number, 360), wave = 0.03 * ((double)(number % 3) - 1);
  const bool large = s->count[f] >= RESOLVED;
  double lightness = (large ? 0.68 : 0.84) + wave + 0.14 * light, chroma = large ? 0.125 : 0.05;
  if (part == PICTURE_LAYER) {
    lightness += 0.05;
    chroma *= 0.75;
  }
  picture_canvas_colour(cairo, lightness, chroma, hue, 1);
}

static void value_colour(cairo_t *cairo, const struct scene *s, double value) {
  if (!isfinite(value)) { /* the particle has no value */
    cairo_set_source_rgb(cairo, 0.88, 0.88, 0.88);
    return;
  }
  const double share = s->high > s->low ? (value - s->low) / (s->high - s->low) : 0.5;
  picture_canvas_ramp(cairo, s->ramp, fmin(fmax(share, 0), 1));
}

static void draw_discs(cairo_t *cairo, const struct scene *s) {
  const bool cut = s->look->view == PICTURE_CUT;
  const double near = s->disc[s->discs - 1].depth, far = s->disc[s->discs / 50].depth;
  for (size_t k = 0; k < s->discs; k++) {
    const struct picture_layout_disc *d = &s->disc[k];
    const double light = cut || !(near > far) ? 0 : fmin(fmax(2 * (d->depth - far) / (near - far) - 1, -1), 1);
    if (!cut) { /* a dark rim separates the disc from those behind it */
      cairo_arc(cairo, d->x, d->y, 1.1 * d->radius, 0, 2 * M_PI);
      cairo_set_source_rgba(cairo, 0.1, 0.1, 0.12, 0.22);
      cairo_fill(cairo);
    }
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

/* Lists the heaviest fragments and the single particles with their shares of the mass. */
static void legend(cairo_t *cairo, const struct scene *s, double x, double y, double font) {
  enum { MOST = 8 };
  char text[48];
  double total, single;
  weigh(s->cloud, &total, &single);
  for (size_t f = 0; f < MOST && f < s->fragments && s->count[f] >= RESOLVED; f++, y += 1.6 * font) {
    size_t sample = 0; /* a particle of its core */
    while (sample < s->cloud->n &&
           !(s->cloud->fragment[sample] == (int64_t)f && s->cloud->part[sample] == PICTURE_CORE))
      sample++;
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
static void note(cairo_t *cairo, const struct scene *s, double left, double y, double width, double font) {
  char text[600] = "";
  size_t grey = 0;
  if (s->look->doubts && *s->look->doubts)
    text_append(text, sizeof text, "%s. ", s->look->doubts);
  for (size_t k = 0; s->cloud->value && k < s->discs; k++)
    grey += isfinite(s->cloud->value[s->disc[k].id]) ? 0u : 1u;
  if (grey)
    text_append(text, sizeof text, "Grey: " PICTURE_BROKEN ". ");
  if (s->left_out)
    text_append(text, sizeof text,
                s->left_out == 1 ? "%zu particle is beyond the frame." : "%zu particles are beyond the frame.",
                s->left_out);
  picture_canvas_note(cairo, left, y, width, 0.9 * font, text);
}

static void draw_on_sheet(struct picture_sheet *sheet, struct scene *s) {
  cairo_t *cairo = sheet->canvas.cairo;
  const double font = sheet->font, scale = picture_sheet_next(sheet, s->look->title, s->look->subtitle);
  draw_discs(cairo, s);
  cairo_restore(cairo);
  if (sheet->drawn == 1) {
    axes(cairo, s->look->axis, sheet->gap + 0.5 * font, sheet->below + 3 * font, font);
    picture_canvas_scale_bar(cairo, sheet->gap + 7 * font, sheet->below + 3 * font, scale, sheet->wide, font);
    if (s->cloud->value)
      picture_canvas_colour_bar(cairo, s->ramp, sheet->right, sheet->top, 1.2 * font, fmin(sheet->tall, 26 * font),
                                font, s->low / s->scale, s->high / s->scale, s->label);
  }
  if (sheet->drawn == sheet->count)
    note(cairo, s, sheet->gap, sheet->below + 5 * font, sheet->right, font);
}

static status draw(const char *path, double width, struct scene *s, struct error *error) {
  const struct picture_look *look = s->look;
  double font = width / 52, gap = 1.5 * font;
  double wide = width - 2 * gap - 9 * font; /* the colour bar or the legend is on the right */
  double tall = wide * (s->view[3] - s->view[1]) / (s->view[2] - s->view[0]);
  if (!isfinite(tall))
    return status_fail(error, STATUS_USAGE, "%s: the particles have no extent to draw", path);
  tall = fmin(fmax(tall, 14 * font), 1.1 * wide);
  double top = font * (1.2 + (look->title ? 1.9 : 0) + (look->subtitle ? 1.6 : 0));
  struct picture_canvas canvas;
  TRY(picture_canvas_open(&canvas, path, width, top + tall + 7.7 * font, error));
  cairo_t *cairo = canvas.cairo;
  const double scale = picture_canvas_place(cairo, s->view, gap, top, wide, tall);
  draw_discs(cairo, s);
  cairo_restore(cairo);
  picture_canvas_head(cairo, gap, width - 2 * gap, font, look->title, 0.95 * font, look->subtitle);
  axes(cairo, s->look->axis, gap + 0.5 * font, top + tall + 3.9 * font, font);
  picture_canvas_scale_bar(cairo, gap + 7 * font, top + tall + 3.9 * font, scale, wide, font);
  note(cairo, s, gap, top + tall + 5.7 * font, width - 2 * gap, font);
  if (s->cloud->value)
    picture_canvas_colour_bar(cairo, s->ramp, gap + wide + 1.2 * font, top, 1.2 * font, fmin(tall, 26 * font), font,
                              s->low / s->scale, s->high / s->scale, s->label);
  else
    legend(cairo, s, gap + wide + 1.2 * font, top, font);
  return picture_canvas_close(&canvas, STATUS_OK, error);
}

/* Chooses the discs, frame and colours. STATUS_MEMORY. */
static status choose(struct scene *s) {
  TRY(gather(s));
  choose_discs(s);
  if (s->look->view == PICTURE_APART && s->discs > 0)
    TRY(picture_layout_apart(s->cloud, s->discs, s->disc));
  if (s->discs == 0)
    return STATUS_OK;
  struct picture_frame *frame = s->look->frame;
  TRY(choose_view(s));
  if (frame && !s->measuring)
    memcpy(s->view, frame->view, sizeof s->view);
  TRY(leave_out(s));
  TRY(choose_colours(s));
  if (s->measuring) {
    cover(frame->view, s->view[0], s->view[1], 0);
    cover(frame->view, s->view[2], s->view[3], 0);
    frame->low = fmin(frame->low, s->low);
    frame->high = fmax(frame->high, s->high);
    frame->plane = isfinite(frame->plane) ? frame->plane : s->middle[s->look->axis];
  } else if (frame && s->cloud->value) {
    choose_range(s, &frame->low, 2);
    choose_unit(s, fmax(fabs(s->low), fabs(s->high)));
  }
  return STATUS_OK;
}

status picture_particles(const char *path, double width, const struct picture_cloud *cloud,
                         const struct picture_look *look, struct error *error) {
  if (look->axis < 0 || look->axis > 2)
    return status_fail(error, STATUS_USAGE, "%s: there is no axis %d", path, look->axis);
  for (size_t i = 0; i < cloud->n; i++)
    if (cloud->fragment[i] >= (int64_t)cloud->n)
      return status_fail(error, STATUS_USAGE, "%s: fragment numbers beyond the number of particles", path);

  SCENE_OF_DISCS s = {.cloud = cloud, .look = look, .measuring = !path};
  status code = cloud->n ? choose(&s) : STATUS_OK;
  if (code == STATUS_OK && !path)
    return STATUS_OK;
  if (code == STATUS_OK && s.discs > 0 && look->sheet)
    draw_on_sheet(look->sheet, &s);
  else if (code == STATUS_OK && s.discs > 0)
    code = draw(path, width, &s, error);
  else if (code == STATUS_OK)
    code = status_fail(error, STATUS_USAGE,
                       look->view == PICTURE_CUT
                           ? "%s: the plane of the cut meets no particle: choose another --at or --axis"
                           : "%s: there is no particle to draw",
                       path);
  if (code == STATUS_MEMORY)
    status_fail(error, code, "%s: no memory for the picture", path);
  return code;
}
