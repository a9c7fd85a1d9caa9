/* A broken body: one hue per large fragment, pale tints for small ones, light grey for dust, a dark outline round
 * every fragment, cracks inside them. */
#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/snapshot_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

enum { LARGE = 10 }; /* cells: a smaller fragment is poorly resolved and gets a pale tint */

/* Cells sorted by fragment: cells of fragment f are order[start[f]] ... order[start[f + 1] - 1]. */
struct grouping {
  size_t fragments;
  uint32_t *start, *order;
};

#define GROUPING __attribute__((cleanup(grouping_free))) struct grouping
static void grouping_free(struct grouping *grouping) {
  free(grouping->start);
  free(grouping->order);
}

static status group(const struct picture_body *body, struct grouping *out) {
  *out = (struct grouping){0};
  for (size_t i = 0; i < body->cells; i++)
    if (body->fragment[i] >= out->fragments)
      out->fragments = (size_t)body->fragment[i] + 1;
  if (out->fragments > body->cells)
    return STATUS_USAGE; /* each fragment has a cell */
  TRY(memory_array(&out->start, out->fragments + 2, sizeof *out->start, "", NULL));
  TRY(memory_array(&out->order, body->cells, sizeof *out->order, "", NULL));
  for (size_t i = 0; i < body->cells; i++)
    out->start[body->fragment[i] + 2]++;
  for (size_t f = 2; f < out->fragments + 2; f++)
    out->start[f] += out->start[f - 1];
  for (size_t i = 0; i < body->cells; i++)
    out->order[out->start[body->fragment[i] + 1]++] = (uint32_t)i;
  return STATUS_OK;
}

static void centre_of(const struct picture_body *body, size_t cell, double centre[2]) {
  centre[0] = centre[1] = 0;
  uint32_t first = body->first_vertex[cell], end = body->first_vertex[cell + 1];
  for (uint32_t v = first; v < end; v++) {
    centre[0] += body->vertex[v][0] / (end - first);
    centre[1] += body->vertex[v][1] / (end - first);
  }
}

static void cover(double view[4], const double point[2]) {
  for (int axis = 0; axis < 2; axis++) {
    view[axis] = fmin(view[axis], point[axis]);
    view[axis + 2] = fmax(view[axis + 2], point[axis]);
  }
}

static const double nothing[4] = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

/* Computes the view of all cells, and the view of all fragments of two or more cells. */
static void cover_cells(const struct picture_body *body, const struct grouping *grouping, double all[4],
                        double large[4]) {
  memcpy(all, nothing, sizeof nothing);
  memcpy(large, nothing, sizeof nothing);
  for (size_t i = 0; i < body->cells; i++) {
    uint32_t f = body->fragment[i];
    bool is_large = grouping->start[f + 1] - grouping->start[f] > 1;
    for (uint32_t v = body->first_vertex[i]; v < body->first_vertex[i + 1]; v++) {
      cover(all, body->vertex[v]);
      if (is_large)
        cover(large, body->vertex[v]);
    }
  }
}

/* Extends a view to 96 % of the cells along each axis. centre: work space of one number per cell. */
static void cover_most(const struct picture_body *body, double *centre, double view[4]) {
  for (int axis = 0; axis < 2; axis++) {
    for (size_t i = 0; i < body->cells; i++) {
      double both[2];
      centre_of(body, i, both);
      centre[i] = both[axis];
    }
    qsort(centre, body->cells, sizeof *centre, sample_ascending);
    size_t out = body->cells / 50;
    view[axis] = fmin(view[axis], centre[out]);
    view[axis + 2] = fmax(view[axis + 2], centre[body->cells - 1 - out]);
  }
}

/* Shows all cells. If distant single cells would shrink the picture much, it shows all other fragments and 96 % of the
 * cells. */
status picture_fragments_view(const struct picture_body *body, double view[4]) {
  OWNED double *centre = NULL;
  double all[4], bulk[4];
  GROUPING grouping = {0};
  TRY(group(body, &grouping));
  TRY(memory_array(&centre, body->cells, sizeof *centre, "", NULL));
  cover_cells(body, &grouping, all, bulk);
  cover_most(body, centre, bulk);
  bool near = all[2] - all[0] <= 1.25 * (bulk[2] - bulk[0]) && all[3] - all[1] <= 1.25 * (bulk[3] - bulk[1]);
  memcpy(view, near ? all : bulk, 4 * sizeof *view);
  double margin = 0.02 * fmax(view[2] - view[0], view[3] - view[1]);
  if (!(margin > 0))
    margin = 1;
  for (int axis = 0; axis < 2; axis++) {
    view[axis] -= margin;
    view[axis + 2] += margin;
  }
  return STATUS_OK;
}

static void path_of(cairo_t *cairo, const struct picture_body *body, uint32_t cell) {
  cairo_new_sub_path(cairo); /* otherwise a line would join it to the previous cell */
  for (uint32_t v = body->first_vertex[cell]; v < body->first_vertex[cell + 1]; v++)
    cairo_line_to(cairo, body->vertex[v][0], body->vertex[v][1]);
  cairo_close_path(cairo);
}

/* The number that a fragment is coloured by. */
static size_t number_of(const struct picture_panel *panel, const struct grouping *g, size_t f) {
  const struct picture_frame *frame = panel->frame;
  int64_t number = INT64_MAX;
  if (!frame || !frame->last || frame->members != panel->body.cells)
    return f;
  for (uint32_t i = g->start[f]; i < g->start[f + 1]; i++)
    number = frame->last[g->order[i]] < number ? frame->last[g->order[i]] : number;
  return (size_t)number;
}

/* Golden-angle steps of hue: fragments of successive numbers often lie side by side and get very different colours. */
static void colour(cairo_t *cairo, size_t fragment, size_t cells, double darker, double alpha) {
  double hue = fmod(252 + 137.50776 * (double)fragment, 360), wave = 0.045 * ((double)(fragment % 3) - 1);
  if (cells == 1)
    picture_canvas_colour(cairo, 0.905 - darker, 0.003, 250, alpha);
  else if (cells < LARGE)
    picture_canvas_colour(cairo, 0.86 - darker, 0.055, hue, alpha);
  else
    picture_canvas_colour(cairo, 0.70 + wave - darker, 0.125, hue, alpha);
}

/* Only fragments that fit wholly into the panel are drawn. */
static bool is_inside(const struct picture_body *body, const struct grouping *g, size_t f, const double view[4]) {
  for (uint32_t i = g->start[f]; i < g->start[f + 1]; i++)
    for (uint32_t v = body->first_vertex[g->order[i]]; v < body->first_vertex[g->order[i] + 1]; v++) {
      const double *at = body->vertex[v];
      if (at[0] < view[0] || at[0] > view[2] || at[1] < view[1] || at[1] > view[3])
        return false;
    }
  return true;
}

/* Draws all cells of a fragment: first a wide dark stroke, then the fill and a thin stroke in the fragment's colour.
 * The visible rest of the dark stroke is the fragment's outline, and no background shows between cells. */
static void draw_fragment(cairo_t *cairo, const struct picture_panel *panel, const struct grouping *g, size_t f,
                          double cell) {
  const struct picture_body *body = &panel->body;
  const size_t count = g->start[f + 1] - g->start[f], number = number_of(panel, g, f);
  if (count == 0)
    return;
  for (uint32_t i = g->start[f]; i < g->start[f + 1]; i++)
    path_of(cairo, body, g->order[i]);
  colour(cairo, number, count, count == 1 ? 0.18 : 0.42, 1);
  cairo_set_line_width(cairo, cell * (count == 1 ? 0.10 : 0.17));
  cairo_stroke(cairo);
  colour(cairo, number, count, 0, 1);
  cairo_set_line_width(cairo, cell * 0.03);
  for (uint32_t i = g->start[f]; i < g->start[f + 1]; i++) {
    path_of(cairo, body, g->order[i]);
    cairo_fill_preserve(cairo);
    cairo_stroke(cairo);
  }
  if (count == 1)
    return;
  for (uint32_t i = g->start[f]; i < g->start[f + 1]; i++)
    path_of(cairo, body, g->order[i]);
  colour(cairo, number, count, 0.14, 0.55); /* grain boundaries */
  cairo_set_line_width(cairo, cell * 0.028);
  cairo_stroke(cairo);
}

/* The side of `cell` whose middle is nearest to the centre of `other`. */
static void draw_crack(cairo_t *cairo, const struct picture_body *body, uint32_t cell, uint32_t other) {
  double centre[2], best = HUGE_VAL;
  centre_of(body, other, centre);
  uint32_t first = body->first_vertex[cell], end = body->first_vertex[cell + 1], from = first, to = first;
  for (uint32_t v = first; v < end; v++) {
    uint32_t w = v + 1 < end ? v + 1 : first;
    double distance = hypot((body->vertex[v][0] + body->vertex[w][0]) / 2 - centre[0],
                            (body->vertex[v][1] + body->vertex[w][1]) / 2 - centre[1]);
    if (distance < best) {
      best = distance;
      from = v;
      to = w;
    }
  }
  cairo_move_to(cairo, body->vertex[from][0], body->vertex[from][1]);
  cairo_line_to(cairo, body->vertex[to][0], body->vertex[to][1]);
}

static double area_of(const struct picture_body *body, size_t cell) {
  double area = 0;
  uint32_t first = body->first_vertex[cell], end = body->first_vertex[cell + 1];
  for (uint32_t v = first; v < end; v++) {
    const double *a = body->vertex[v], *b = body->vertex[v + 1 < end ? v + 1 : first];
    area += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  return fabs(area);
}

void picture_fragments_numbers(const struct picture_body *body, const char *cells, char *text, size_t size) {
  GROUPING grouping = {0};
  size_t single = 0, fragments = 0;
  double total = 0, largest = 0;
  text[0] = 0;
  if (body->cells == 0)
    return;
  if (group(body, &grouping) == STATUS_OK) {
    for (size_t f = 0; f < grouping.fragments; f++) {
      double area = 0;
      for (uint32_t i = grouping.start[f]; i < grouping.start[f + 1]; i++)
        area += area_of(body, grouping.order[i]);
      fragments += grouping.start[f + 1] > grouping.start[f];
      single += grouping.start[f + 1] - grouping.start[f] == 1;
      total += area;
      largest = fmax(largest, area);
    }
    snprintf(text, size, "%zu %s in %zu fragment%s, %zu of them single; largest %.1f %% of the area", body->cells,
             cells, fragments, fragments == 1 ? "" : "s", single, 100 * largest / total);
  }
}

enum { NOTE = 400 };

/* In the coordinates of picture_canvas_place(). Writes into `note` the caption, and how many grains are not drawn. */
static status draw_body(cairo_t *cairo, const struct picture_panel *panel, const double view[4], char note[NOTE]) {
  const struct picture_body *body = &panel->body;
  size_t beyond = 0;
  GROUPING grouping = {0};
  TRY(group(body, &grouping));
  double area = 0;
  for (size_t i = 0; i < body->cells; i++)
    area += area_of(body, i);
  const double cell = sqrt(area / (double)body->cells); /* a typical size */
  for (size_t f = grouping.fragments; f-- > 0;)
    if (is_inside(body, &grouping, f, view))
      draw_fragment(cairo, panel, &grouping, f, cell); /* the largest is drawn last, on top */
    else
      beyond += grouping.start[f + 1] - grouping.start[f];
  for (size_t i = 0; i < body->cracks; i++) {
    const uint32_t f = body->fragment[body->crack[i][0]];
    if (f == body->fragment[body->crack[i][1]] && is_inside(body, &grouping, f, view))
      draw_crack(cairo, body, body->crack[i][0], body->crack[i][1]);
  }
  cairo_set_source_rgb(cairo, 0.12, 0.08, 0.08);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_width(cairo, 0.11 * cell);
  cairo_stroke(cairo);
  snprintf(note, NOTE, "%s", panel->caption ? panel->caption : "");
  if (beyond)
    text_append(note, NOTE, "%s%zu of %zu grains beyond the frame", *note ? "; " : "", beyond, body->cells);
  return STATUS_OK;
}

static status fail(const char *path, status code, struct error *error) {
  return status_fail(error, code, "%s: %s", path,
                     code == STATUS_MEMORY ? "no memory for the picture"
                                           : "fragment numbers beyond the number of cells");
}

status picture_fragments(const char *path, double width, const char *title, const char *subtitle,
                         const struct picture_panel *panel, struct error *error) {
  const double font = width / 46, gap = 0.03 * width, wide = width - 2 * gap;
  double view[4];
  char note[NOTE] = "";
  if (panel->body.cells == 0)
    return status_fail(error, STATUS_USAGE, "%s: there is no cell to draw", path);
  const status framed = panel->frame ? STATUS_OK : picture_fragments_view(&panel->body, view);
  if (framed)
    return fail(path, framed, error);
  if (panel->frame)
    memcpy(view, panel->frame->view, sizeof view);
  double tall = wide * (view[3] - view[1]) / (view[2] - view[0]);
  if (!isfinite(tall))
    return status_fail(error, STATUS_USAGE, "%s: positions of the cells are not finite", path);
  tall = fmin(tall, 1.5 * wide);
  const double top = font * (0.8 + (title ? 1.9 : 0) + (subtitle ? 1.6 : 0)), below = top + tall + 1.75 * font;
  struct picture_canvas canvas;
  TRY(picture_canvas_open(&canvas, path, width, top + tall + 3 * font, error));
  cairo_t *cairo = canvas.cairo;
  picture_canvas_head(cairo, gap, wide, font, title, font, subtitle);
  const double scale = picture_canvas_place(cairo, view, gap, top, wide, tall);
  const status code = draw_body(cairo, panel, view, note);
  cairo_restore(cairo);
  picture_canvas_scale_bar(cairo, gap + 0.02 * wide, below, scale, wide, font);
  cairo_set_source_rgb(cairo, 0.25, 0.25, 0.25);
  picture_canvas_text(cairo, gap + wide * 0.98, below, font, PICTURE_RIGHT, false, note);
  return picture_canvas_close(&canvas, code ? fail(path, code, error) : STATUS_OK, error);
}

status picture_fragments_on_sheet(struct picture_sheet *sheet, const char *title, const char *caption,
                                  const struct picture_panel *panel, struct error *error) {
  cairo_t *cairo = sheet->canvas.cairo;
  char note[NOTE] = "";
  const double scale = picture_sheet_next(sheet, title, caption);
  const status code = draw_body(cairo, panel, sheet->view, note);
  cairo_restore(cairo);
  if (sheet->drawn == 1)
    picture_canvas_scale_bar(cairo, sheet->gap, sheet->below + 3 * sheet->font, scale, sheet->wide, sheet->font);
  if (sheet->drawn == sheet->count)
    picture_canvas_note(cairo, sheet->gap, sheet->below + 5 * sheet->font, sheet->right, sheet->font, note);
  return code ? fail(sheet->canvas.file.path, code, error) : STATUS_OK;
}

/* ---- reading from a fields file ---- */

/* The columns of the file, with their lengths; NULL: the file lacks the column. */
struct columns {
  size_t points, ids, offsets, fragments, grains, beams, alives;
  double *point, *alive, *beam;
  int64_t *id, *offset, *fragment, *grain;
};

/* The offsets must rise from 0 to the number of vertices. */
static bool take_cells(const struct columns *c, struct picture_body *body) {
  const bool there = c->point && c->offset && c->id && c->fragment;
  if (!there || c->fragments == 0 || c->offsets != c->fragments + 1)
    return false;

  body->cells = c->fragments;
  body->first_vertex = malloc((body->cells + 1) * sizeof *body->first_vertex);
  body->vertex = malloc((c->ids + 1) * sizeof *body->vertex);
  body->fragment = malloc(body->cells * sizeof *body->fragment);
  if (!body->first_vertex || !body->vertex || !body->fragment)
    return false;

  if (c->offset[0] != 0 || c->offset[body->cells] != (int64_t)c->ids)
    return false;
  for (size_t i = 0; i <= body->cells; i++) {
    if (i && c->offset[i] < c->offset[i - 1])
      return false;
    body->first_vertex[i] = (uint32_t)c->offset[i];
  }
  for (size_t i = 0; i < c->ids; i++) {
    if (c->id[i] < 0 || c->id[i] >= (int64_t)c->points)
      return false;
    const double *point = &c->point[3 * (size_t)c->id[i]];
    if (!isfinite(point[0]) || !isfinite(point[1]))
      return false;
    memcpy(body->vertex[i], point, sizeof body->vertex[i]);
  }
  for (size_t i = 0; i < body->cells; i++) {
    if (c->fragment[i] < 0 || c->fragment[i] > SNAPSHOT_READ_LARGEST)
      return false;
    body->fragment[i] = (uint32_t)c->fragment[i];
  }
  return true;
}

/* Collects broken beams between two grains of the same fragment. Beams refer to grains, and each cell names the grain
 * that it outlines. A file without beams has no cracks. */
static bool take_cracks(const struct columns *c, struct picture_body *body) {
  const bool there = c->beam && c->alive && c->grain;
  if (!there || c->beams != c->alives || c->grains != body->cells)
    return true;
  int64_t last = -1;
  for (size_t i = 0; i < c->grains; i++)
    last = c->grain[i] > last ? c->grain[i] : last;
  if (last < 0 || last > SNAPSHOT_READ_LARGEST)
    return false;

  const size_t grains = (size_t)last + 1;
  OWNED uint32_t *cell = malloc(grains * sizeof *cell); /* of each grain; UINT32_MAX: none */
  body->crack = malloc((c->beams + 1) * sizeof *body->crack);
  const bool good = cell && body->crack;
  for (size_t i = 0; good && i < grains; i++)
    cell[i] = UINT32_MAX;
  for (size_t i = 0; good && i < c->grains; i++)
    if (c->grain[i] >= 0)
      cell[c->grain[i]] = (uint32_t)i;
  for (size_t i = 0; good && i < c->beams; i++) {
    const double a = c->beam[2 * i], b = c->beam[2 * i + 1], end = (double)grains;
    const bool known = a >= 0 && a < end && b >= 0 && b < end;
    if (c->alive[i] != 0 || !known)
      continue;
    uint32_t first = cell[(size_t)a], second = cell[(size_t)b];
    if (first == UINT32_MAX || second == UINT32_MAX || body->fragment[first] != body->fragment[second])
      continue;
    body->crack[body->cracks][0] = first;
    body->crack[body->cracks++][1] = second;
  }
  return good;
}

status picture_fragments_read(const char *path, struct picture_body *body, struct error *error) {
  *body = (struct picture_body){0};
  struct snapshot_read *file;
  TRY(snapshot_read_open(path, &file, error));

  struct columns c;
  const enum snapshot_read_kind real = SNAPSHOT_READ_REAL, whole = SNAPSHOT_READ_INTEGER;
  OWNED double *point = c.point = snapshot_read_rows(file, "/VTKHDF/Points", 3, real, &c.points);
  OWNED int64_t *id = c.id = snapshot_read_rows(file, "/VTKHDF/Connectivity", 0, whole, &c.ids);
  OWNED int64_t *offset = c.offset = snapshot_read_rows(file, "/VTKHDF/Offsets", 0, whole, &c.offsets);
  OWNED int64_t *of = c.fragment = snapshot_read_rows(file, "/VTKHDF/CellData/fragment", 0, whole, &c.fragments);
  OWNED int64_t *grain = c.grain = snapshot_read_rows(file, "/VTKHDF/CellData/grain", 0, whole, &c.grains);
  OWNED double *beam = c.beam = snapshot_read_rows(file, "/beams/grains", 2, real, &c.beams);
  OWNED double *alive = c.alive = snapshot_read_rows(file, "/beams/alive", 0, real, &c.alives);
  if (snapshot_read_close(file) && take_cells(&c, body) && take_cracks(&c, body))
    return STATUS_OK;

  picture_fragments_clear(body);
  return snapshot_read_refuse(path, error);
}

void picture_fragments_clear(struct picture_body *body) {
  free(body->first_vertex);
  free(body->vertex);
  free(body->fragment);
  free(body->crack);
  *body = (struct picture_body){0};
}
