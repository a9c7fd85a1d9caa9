/* Chooses the contents of a picture of particles: discs, direction of view, frame and colours. */
#include "analysis/pictures/picture_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/sample.h"

static const double REACH = 0.80; /* disc radius divided by size: discs overlap a little, so that a cut has no holes */

void picture_scene_clear(struct picture_scene *s) {
  free(s->count);
  free(s->mass);
  free(s->centre);
  free(s->disc);
}

static void add_weighted(double sum[3], double mass, const double position[3]) {
  for (int d = 0; d < 3; d++)
    sum[d] += mass * position[d];
}

static status allocate(struct picture_scene *s) {
  for (size_t i = 0; i < s->cloud->n; i++)
    if (s->cloud->fragment[i] >= (int64_t)s->fragments)
      s->fragments = (size_t)s->cloud->fragment[i] + 1;
  s->count = calloc(s->fragments + 1, sizeof *s->count);
  s->mass = calloc(s->fragments + 1, sizeof *s->mass);
  s->centre = calloc(s->fragments + 1, sizeof *s->centre);
  s->disc = malloc((s->cloud->n + 1) * sizeof *s->disc);
  return s->count && s->mass && s->centre && s->disc ? STATUS_OK : STATUS_MEMORY;
}

status picture_scene_gather(struct picture_scene *s) {
  const struct picture_cloud *c = s->cloud;
  if (allocate(s))
    return STATUS_MEMORY;
  double total = 0, all[3] = {0, 0, 0};
  for (size_t i = 0; i < c->n; i++) {
    total += c->mass[i];
    add_weighted(all, c->mass[i], c->position[i]);
    if (c->fragment[i] < 0)
      continue;
    const size_t f = (size_t)c->fragment[i];
    s->count[f]++;
    s->mass[f] += c->mass[i];
    add_weighted(s->centre[f], c->mass[i], c->position[i]);
  }
  for (size_t f = 0; f < s->fragments; f++)
    for (int d = 0; d < 3; d++)
      s->centre[f][d] /= s->count[f] ? s->mass[f] : 1;
  const bool large = s->fragments > 0 && s->count[0] >= PICTURE_SCENE_RESOLVED;
  for (int d = 0; d < 3; d++)
    s->middle[d] = large ? s->centre[0][d] : all[d] / total;
  return STATUS_OK;
}

static bool resolved(const struct picture_scene *s, size_t i) {
  return s->cloud->fragment[i] >= 0 && s->count[s->cloud->fragment[i]] >= PICTURE_SCENE_RESOLVED;
}

size_t picture_scene_masses(const struct picture_cloud *cloud, double *total, double *single) {
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
static bool make_disc(const struct picture_scene *s, size_t i, struct picture_layout_disc *disc) {
  const struct picture_cloud *c = s->cloud;
  const enum picture_view view = s->look->view;
  const int along = s->axis, right = along == 0 ? 1 : 0, up = along == 2 ? 1 : 2;
  if (view == PICTURE_APART && (c->part[i] >= PICTURE_DUST || c->fragment[i] < 0))
    return false;
  const double *at = c->position[i];
  *disc = (struct picture_layout_disc){at[right], at[up], REACH * c->size[i], at[along], (uint32_t)i};
  if (along == 1) /* x right, z up: y points away */
    disc->depth = -disc->depth;
  if (view != PICTURE_CUT)
    return true;
  const double off = at[along] - (isfinite(s->look->plane) ? s->look->plane : s->middle[along]);
  if (fabs(off) >= disc->radius)
    return false;
  disc->depth = -fabs(off) / c->size[i];
  disc->radius = sqrt(disc->radius * disc->radius - off * off);
  return true;
}

void picture_scene_choose_discs(struct picture_scene *s) {
  s->discs = 0;
  for (size_t i = 0; i < s->cloud->n; i++)
    s->discs += make_disc(s, i, &s->disc[s->discs]);
  qsort(s->disc, s->discs, sizeof *s->disc, by_depth);
}

/* For a view from outside: the visible share, 0 to 1, of the least visible of the heaviest fragments; and the mass
 * share of hidden ones. */
static status look_at_largest(struct picture_scene *s, double *least) {
  enum { HEAVIEST = 4 };
  double visible[HEAVIEST], total, single;
  size_t count = 0;
  while (count < HEAVIEST && count < s->fragments && s->count[count] >= PICTURE_SCENE_RESOLVED)
    count++;
  picture_scene_masses(s->cloud, &total, &single);
  *least = 1;
  s->hidden = 0;
  const status code = picture_layout_visible(s->cloud, s->discs, s->disc, count, visible);
  for (size_t f = 0; code == STATUS_OK && f < count; f++) {
    *least = fmin(*least, visible[f]);
    s->hidden += visible[f] < 0.03 ? s->mass[f] / total : 0;
  }
  return code;
}

status picture_scene_turn(struct picture_scene *s) {
  double best = -1, least;
  int axis = s->look->axis;
  for (int k = 0; k < 3 && s->look->axis < 0; k++) {
    s->axis = (k + 1) % 3; /* y first: it is kept unless another is better */
    picture_scene_choose_discs(s);
    if (look_at_largest(s, &least))
      return STATUS_MEMORY;
    if (least > best + 0.01) {
      best = least;
      axis = s->axis;
    }
  }
  s->axis = axis;
  picture_scene_choose_discs(s);
  return look_at_largest(s, &least);
}

static void cover(double view[4], double x, double y, double radius) {
  view[0] = fmin(view[0], x - radius);
  view[1] = fmin(view[1], y - radius);
  view[2] = fmax(view[2], x + radius);
  view[3] = fmax(view[3], y + radius);
}

/* Shows all resolved fragments and nine tenths of the rest along each axis, so that jets do not shrink the body. With
 * fragments apart: all drawn discs. */
static status choose_view(struct picture_scene *s) {
  double *sorted = malloc((s->discs + 1) * sizeof *sorted), all[4] = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double *view = s->view;
  if (!sorted)
    return STATUS_MEMORY;
  memcpy(view, all, sizeof all);
  for (size_t k = 0; k < s->discs; k++) {
    const struct picture_layout_disc *d = &s->disc[k];
    cover(all, d->x, d->y, d->radius);
    if (s->look->view == PICTURE_APART || resolved(s, d->id))
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
  free(sorted);
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
static status leave_out(struct picture_scene *s) {
  bool *out = calloc(s->fragments + 1, sizeof *out);
  size_t kept = 0;
  if (!out)
    return STATUS_MEMORY;
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
  free(out);
  return STATUS_OK;
}

status picture_scene_frame(struct picture_scene *s) {
  const status code = choose_view(s);
  return code ? code : leave_out(s);
}

/* Chooses a prefix of the unit by the largest value shown, such as GPa. Shares, lengths and masses get none. */
static void choose_unit(struct picture_scene *s, double largest) {
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
  snprintf(s->label, sizeof s->label, strcmp(unit, "1") == 0 ? "%s" : "%s (%s%s)",
           s->look->quantity ? s->look->quantity : "", letter, unit);
}

/* Collects the finite values of drawn particles. `searched`: only of particles that were searched for fragments, so
 * that a hot and dense projectile does not set the range of the body. */
static size_t collect_values(const struct picture_scene *s, bool searched, double *values) {
  size_t count = 0;
  for (size_t k = 0; k < s->discs; k++) {
    uint32_t i = s->disc[k].id;
    if (isfinite(s->cloud->value[i]) && !(searched && s->cloud->part[i] == PICTURE_LEFT_OUT))
      values[count++] = s->cloud->value[i];
  }
  return count;
}

/* Is it a quantity without a unit whose values are within 0 and 1? */
static bool is_share(const struct picture_scene *s, double least, double most) {
  return s->look->unit && strcmp(s->look->unit, "1") == 0 && least >= 0 && most <= 1;
}

/* Chooses range and ramp for ascending values: without the outermost percent at both ends; shares always from 0 to 1;
 * symmetric about 0 where there are both signs. */
static void choose_range(struct picture_scene *s, const double *sorted, size_t count) {
  static const double nothing[2] = {0, 1};
  if (count == 0) {
    sorted = nothing;
    count = 2;
  }
  s->low = sorted[count / 100];
  s->high = sorted[count - 1 - count / 100];
  s->ramp = PICTURE_RAMP_RISING;
  if (is_share(s, sorted[0], sorted[count - 1])) {
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

status picture_scene_choose_colours(struct picture_scene *s) {
  if (!s->cloud->value)
    return STATUS_OK;
  double *sorted = malloc((s->discs + 1) * sizeof *sorted);
  if (!sorted)
    return STATUS_MEMORY;
  size_t count = collect_values(s, true, sorted);
  if (count == 0)
    count = collect_values(s, false, sorted);
  qsort(sorted, count, sizeof *sorted, sample_ascending);
  choose_range(s, sorted, count);
  free(sorted);
  choose_unit(s, fmax(fabs(s->low), fabs(s->high)));
  return STATUS_OK;
}
