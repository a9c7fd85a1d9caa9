/* Reads every form of the key `vary` and links the axes. */
#include "campaign/document/campaign_read.h"

#include <math.h>
#include <search.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/unit.h"

enum { MOST_LEVELS = 1000000, PATH_SIZE = 320 };

struct reading { /* one axis being read */
  struct campaign *campaign;
  struct design_axis *axis;
  document_node *node;
  const char *folder;
  char path[PATH_SIZE]; /* "vary.threshold.strain", for messages */
};

/* Reports an error at the node (NULL: at the axis). */
static bool wrong(struct reading *r, document_node *node, const char *text) {
  document_report(node ? node : r->node, r->path, "%s", text);
  return false;
}

/* Copy of the input's row with other limits: the mean of a distribution may be outside the range of its values. */
static struct field number_row(const struct reading *r, const char *unit, double minimum, double maximum,
                               unsigned flags) {
  struct field row = *r->axis->row;
  row.path = r->path;
  row.kind = FIELD_REAL;
  row.unit = unit;
  row.minimum = minimum;
  row.maximum = maximum;
  row.flags = flags;
  row.when = NULL;
  return row;
}

/* Tables use the unit of the first value that has one. `unit`: SI unit of the row that read the value; it differs from
 * the input's for a law's sigma or factor. */
static void note_unit(struct reading *r, document_node *node, const char *unit) {
  const char *text = document_scalar(node);
  if (*r->axis->unit || !text || !unit || r->axis->row->unit == NULL || strcmp(unit, r->axis->row->unit) != 0)
    return;
  text = unit_of(text);
  if (strlen(text) < sizeof r->axis->unit)
    snprintf(r->axis->unit, sizeof r->axis->unit, "%s", text);
}

static bool read_number(struct reading *r, document_node *node, const char *what, const struct field *row, double *x) {
  struct field_value value;
  if (!node) {
    document_report(r->node, r->path, "'%s' is missing", what);
    return false;
  }
  if (!document_value(node, row, &value))
    return false;
  note_unit(r, node, row->unit);
  *x = row->kind == FIELD_INTEGER ? (double)value.integer : value.number;
  return true;
}

/* Reads a value by the axis' own row, as a number. */
static bool read_own(struct reading *r, document_node *node, double *x) {
  struct field row = *r->axis->row;
  row.path = r->path;
  row.flags &= ~(unsigned)FIELD_MAY_BE_OFF; /* an end of a range cannot be off */
  return read_number(r, node, "", &row, x);
}

static bool read_pair(struct reading *r, document_node *node, bool positive, double *a, double *b) {
  if (document_kind(node) != DOCUMENT_SEQUENCE || document_count(node) != 2)
    return wrong(r, node, "expected two values, [from, to]");
  if (!read_own(r, document_item(node, 0, NULL), a) || !read_own(r, document_item(node, 1, NULL), b))
    return false;
  if (!(*a < *b))
    return wrong(r, node, "expected the smaller value first, and two different ones");
  if (positive && !(*a > 0))
    return wrong(r, node, "a logarithmic range needs both ends above zero; use {from, to, n} or {uniform: [a, b]}");
  return true;
}

static bool make_levels(struct reading *r, size_t count) {
  r->axis->kind = DESIGN_AXIS_LEVELS;
  r->axis->levels = calloc(count, sizeof *r->axis->levels);
  r->axis->level_count = r->axis->levels ? count : 0;
  if (!r->axis->levels)
    document_report_memory(r->node, r->path);
  return r->axis->levels;
}

static bool read_values(struct reading *r, document_node *node) {
  size_t count = document_count(node);
  if (count == 0 || count > MOST_LEVELS)
    return wrong(r, node, "expected one value at least (and at most 1000000)");
  if (!make_levels(r, count))
    return false;
  bool good = true;
  struct field row = *r->axis->row;
  row.path = r->path;
  for (size_t i = 0; i < count; i++)
    if (campaign_read_value(document_item(node, i, NULL), &row, r->folder, &r->axis->levels[i]))
      note_unit(r, document_item(node, i, NULL), row.unit);
    else
      good = false;
  return good;
}

/* Evenly spaced levels: {from: a, to: b, n: 3}, {log: [a, b], n: 3}. */
static bool read_spaced(struct reading *r, document_node *first, bool logarithmic) {
  struct design_axis *axis = r->axis;
  const char *const unit = axis->row->unit ? axis->row->unit : "1";
  document_node *from = first, *to = document_key(r->node, "to"), *count = document_key(r->node, "n");
  double a = 0, b = 0;
  if (!logarithmic && !to)
    return wrong(r, NULL, "'to' is missing");
  if (logarithmic ? !read_pair(r, first, true, &a, &b) : !read_own(r, from, &a) || !read_own(r, to, &b))
    return false;
  if (logarithmic) {
    from = document_item(first, 0, NULL);
    to = document_item(first, 1, NULL);
  }
  struct field row = number_row(r, "1", 2, MOST_LEVELS, 0);
  struct field_value n;
  row.kind = FIELD_INTEGER;
  if (!count)
    return wrong(r, NULL, "'n', the number of values, is missing");
  if (!document_value(count, &row, &n) || !make_levels(r, (size_t)n.integer))
    return false;
  for (size_t i = 0; i < axis->level_count; i++) {
    const double x = design_axis_spaced(document_scalar(from), document_scalar(to), unit, axis->level_count,
                                        logarithmic, i);
    struct field_value *value = &axis->levels[i];
    value->kind = axis->row->kind;
    if (value->kind == FIELD_INTEGER)
      value->integer = (int64_t)llround(x);
    else
      value->number = x;
  }
  if (axis->row->kind == FIELD_INTEGER && fabs(b - a) < (double)(axis->level_count - 1))
    return wrong(r, count, "more values than whole numbers in the range");
  return true;
}

/* Reads where a law is cut. */
static bool read_truncation(struct reading *r, bool positive) {
  document_node *node = document_key(r->node, "truncated");
  if (node && !read_pair(r, node, positive, &r->axis->lower, &r->axis->upper))
    return false;
  struct design_axis *axis = r->axis;
  const struct field *row = axis->row;
  const double from = design_axis_deviations(axis, axis->lower), to = design_axis_deviations(axis, axis->upper);
  const double least = design_axis_deviations(axis, row->minimum), most = design_axis_deviations(axis, row->maximum);
  /* beyond 37 standard deviations the mass of a normal law underflows */
  if (from > 37 || to < -37)
    return wrong(r, node, "the law has nothing there: more than 37 standard deviations from its middle");
  /* Checks that the values of the law are within the range of the input. A range that ends beyond six standard
   * deviations (one draw in 1e9) truncates the law without a message. */
  if ((from < least && least > -6) || (to > most && most < 6)) {
    document_report(r->node, r->path,
                    "the law reaches values that this input cannot take (%g to %g); cut it: {..., truncated: [a, b]}",
                    row->minimum, row->maximum);
    return false;
  }
  axis->lower = fmax(axis->lower, row->minimum);
  axis->upper = fmin(axis->upper, row->maximum);
  return true;
}

/* {normal: {mean: m, sd: s}}, {lognormal: {median: m, sigma: s}} */
static bool read_law(struct reading *r, document_node *node, bool logarithmic) {
  const char *const keys[] = {logarithmic ? "median" : "mean", logarithmic ? "sigma" : "sd", NULL};
  const char *const unit = r->axis->row->unit;
  const unsigned above = FIELD_ABOVE_MINIMUM, percent = r->axis->row->flags & FIELD_PERCENT;
  const struct field positive = number_row(r, unit, 0, HUGE_VAL, above | percent);
  const struct field any = number_row(r, unit, -HUGE_VAL, HUGE_VAL, percent), sigma = number_row(r, "1", 0, 100, above);
  if (document_kind(node) != DOCUMENT_MAPPING)
    return wrong(r, node,
                 logarithmic
                     ? "expected {median: m, sigma: s}; sigma is the standard deviation of the natural logarithm"
                     : "expected {mean: m, sd: s}");
  bool good = read_number(r, document_key(node, keys[0]), keys[0], logarithmic ? &positive : &any, &r->axis->a);
  good &= read_number(r, document_key(node, keys[1]), keys[1], logarithmic ? &sigma : &positive, &r->axis->b);
  document_unknown_keys(node, r->path, keys);
  return good && read_truncation(r, logarithmic);
}

/* {linked: path, values: [...]}, or a line: {linked: path, factor: f, offset: o} */
static bool read_linked(struct reading *r, document_node *node) {
  struct error error;
  struct design_axis *axis = r->axis;
  const struct campaign *campaign = r->campaign;
  const char *name = document_scalar(node);
  const struct field *row = name ? field_find_in(campaign->scene->kind->inputs, name, campaign->scene->inputs, &error)
                                 : NULL;
  if (!row)
    return wrong(r, node, name ? error.message : "expected the path of the varied input that this one follows");
  const struct design_axis *other = campaign_axis(campaign, row->path);
  if (!other || other == axis)
    return wrong(r, node, "follows an input that is not varied; name one of the other keys of `vary`");
  axis->linked = (size_t)(other - campaign->axes);
  document_node *values = document_key(r->node, "values");
  if (values && document_kind(values) != DOCUMENT_SEQUENCE)
    return wrong(r, values, "expected a list of values, one for each value of the input it follows");
  if (values) {
    const bool good = read_values(r, values);
    axis->kind = DESIGN_AXIS_LINKED;
    return good;
  }
  if (!field_is_number(row) || !field_is_number(axis->row))
    return wrong(r, node, "only numbers follow by factor and offset; give `values`");
  const struct field any = number_row(r, "1", -HUGE_VAL, HUGE_VAL, 0);
  const struct field offset = number_row(r, axis->row->unit, -HUGE_VAL, HUGE_VAL, axis->row->flags & FIELD_PERCENT);
  document_node *factor_node = document_key(r->node, "factor"), *offset_node = document_key(r->node, "offset");
  axis->a = 1;
  const bool good = !factor_node || read_number(r, factor_node, "factor", &any, &axis->a);
  return (!offset_node || read_number(r, offset_node, "offset", &offset, &axis->b)) && good;
}

/* The forms that are mappings: the first key tells which form it is. */
static const struct form {
  const char *keys[5];
  enum design_axis_kind kind;
  bool logarithmic;
} forms[] = {
    {{"from", "to", "n"}, DESIGN_AXIS_LEVELS, false},
    {{"log", "n"}, DESIGN_AXIS_LEVELS, true},
    {{"uniform"}, DESIGN_AXIS_UNIFORM, false},
    {{"log_uniform"}, DESIGN_AXIS_LOG_UNIFORM, true},
    {{"normal", "truncated"}, DESIGN_AXIS_NORMAL, false},
    {{"lognormal", "truncated"}, DESIGN_AXIS_LOGNORMAL, true},
    {{"linked", "factor", "offset", "values"}, DESIGN_AXIS_LINKED, false},
};

static bool read_form(struct reading *r) {
  const struct form *form = NULL;
  size_t found = 0;
  for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++)
    if (document_key(r->node, forms[i].keys[0])) {
      form = &forms[i];
      found++;
    }
  if (found != 1)
    return wrong(r, NULL,
                 "expected one of {from, to, n}, {log: [a, b], n}, {uniform: [a, b]}, {log_uniform: [a, b]}, {normal: "
                 "{mean, sd}}, {lognormal: {median, sigma}}, {linked: path}");
  for (int k = 0; form->keys[k]; k++)
    document_key(r->node, form->keys[k]); /* marks the keys as known before any error below can end the reading */
  document_unknown_keys(r->node, r->path, form->keys);
  if (form->kind != DESIGN_AXIS_LINKED && !field_is_number(r->axis->row))
    return wrong(r, NULL, "this input is no number: give a list of its values");
  document_node *first = document_key(r->node, form->keys[0]);
  r->axis->kind = form->kind;
  switch (form->kind) {
  case DESIGN_AXIS_LEVELS: return read_spaced(r, first, form->logarithmic);
  case DESIGN_AXIS_UNIFORM:
  case DESIGN_AXIS_LOG_UNIFORM: return read_pair(r, first, form->logarithmic, &r->axis->a, &r->axis->b);
  case DESIGN_AXIS_NORMAL:
  case DESIGN_AXIS_LOGNORMAL: return read_law(r, first, form->logarithmic);
  case DESIGN_AXIS_LINKED: break;
  }
  return read_linked(r, first);
}

/* Checks that every linked axis follows a free axis, and that linked lists have the same length. */
static bool check_links(struct reading *readings, struct campaign *campaign) {
  for (size_t i = 0; i < campaign->axis_count; i++) {
    struct design_axis *axis = &campaign->axes[i];
    if (axis->kind != DESIGN_AXIS_LINKED)
      continue;
    const struct design_axis *other = &campaign->axes[axis->linked];
    if (!*axis->unit && axis->row->unit && other->row->unit && strcmp(axis->row->unit, other->row->unit) == 0)
      memcpy(axis->unit, other->unit, sizeof axis->unit);
    if (other->kind == DESIGN_AXIS_LINKED)
      return wrong(&readings[i], NULL, "follows an input that is linked itself; link both to the same one");
    if (axis->level_count && (other->kind != DESIGN_AXIS_LEVELS || other->level_count != axis->level_count))
      return wrong(&readings[i], NULL, "`values` must be as many as the values of the input it follows");
  }
  return true;
}

/* Any order in which equal values of a row are equal. */
static int by_value(const void *a, const void *b) {
  const struct field_value *x = a, *y = b;
  const double left = x->number + 0.0, right = y->number + 0.0; /* -0 is 0 */
  int order = memcmp(&left, &right, sizeof left);
  if (order == 0)
    order = memcmp(&x->integer, &y->integer, sizeof x->integer);
  return order ? order : strcmp(x->text, y->text);
}

static void keep_value(void *value) {
  (void)value; /* values belong to their axis */
}

/* Equal values of a grid are one point: 7 % and 0.07 m/m. Keeps the first of them, unless the values of another input
 * belong to each. */
static bool drop_equal(struct reading *r) {
  struct design_axis *axis = r->axis;
  for (size_t i = 0; i < r->campaign->axis_count; i++) {
    const struct design_axis *other = &r->campaign->axes[i];
    if (other->kind == DESIGN_AXIS_LINKED && other->level_count && &r->campaign->axes[other->linked] == axis)
      return true;
  }
  void *tree = NULL; /* of the values that are kept */
  size_t kept = 0;
  bool good = true;
  for (size_t i = 0; good && i < axis->level_count; i++) {
    struct field_value *place = &axis->levels[kept];
    *place = axis->levels[i];
    struct field_value **found = tsearch(place, &tree, by_value);
    good = found != NULL;
    kept += good && *found == place;
  }
  tdestroy(tree, keep_value);
  axis->level_count = kept;
  if (!good)
    document_report_memory(r->node, r->path);
  return good;
}

/* Finds the input of the index-th key and makes its axis. */
static bool begin_axis(struct reading *readings, size_t index, document_node *vary, const char *folder,
                       struct campaign *campaign) {
  const char *key = NULL;
  struct error error = {0};
  struct reading *r = &readings[index];
  r->folder = folder;
  r->node = document_item(vary, index, &key);
  r->campaign = campaign;
  r->axis = &campaign->axes[index];
  snprintf(r->path, sizeof r->path, "vary.%.300s", key ? key : "");
  const struct field *row = key ? field_find_in(campaign->scene->kind->inputs, key, campaign->scene->inputs, &error)
                                : NULL;
  if (!row)
    return wrong(r, NULL, key ? error.message : "expected a path");
  const struct design_axis *same = campaign_axis(campaign, row->path);
  *r->axis = (struct design_axis){.row = row, .lower = -HUGE_VAL, .upper = HUGE_VAL};
  campaign->axis_count = index + 1;
  if (same)
    document_report(r->node, r->path, "the same input as %s", readings[same - campaign->axes].path);
  return !same;
}

/* Finds the inputs of all axes first, so that links may come in any order. */
static bool read_axes(struct reading *readings, size_t count, document_node *vary, const char *folder,
                      struct campaign *campaign) {
  for (size_t i = 0; i < count; i++)
    if (!begin_axis(readings, i, vary, folder, campaign))
      return false;
  bool good = true;
  for (size_t i = 0; i < count; i++) {
    struct reading *r = &readings[i];
    if (r->axis->row->flags & FIELD_FILE)
      good = wrong(r, NULL, "a shape file cannot be varied: write a scene, and a campaign, for each shape");
    else if (document_kind(r->node) == DOCUMENT_SEQUENCE)
      good &= read_values(r, r->node);
    else if (document_kind(r->node) == DOCUMENT_MAPPING)
      good &= read_form(r);
    else
      good = wrong(r, NULL, "expected a list of values or a range; a single value belongs in `set`");
  }
  good = good && check_links(readings, campaign);
  for (size_t i = 0; good && campaign->design.kind == CAMPAIGN_GRID && i < count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LEVELS)
      good = drop_equal(&readings[i]);
  return good;
}

bool campaign_vary_read(document_node *vary, const char *folder, struct campaign *campaign) {
  if (!vary)
    return true;
  if (document_kind(vary) != DOCUMENT_MAPPING) {
    document_report(vary, "vary", "expected a mapping of paths to values, e.g. threshold.strain: [1 %%, 3 %%]");
    return false;
  }
  const size_t count = document_count(vary);
  bool good = false;
  struct reading *readings = calloc(count + 1, sizeof *readings);
  campaign->axes = calloc(count + 1, sizeof *campaign->axes);
  if (readings && campaign->axes)
    good = read_axes(readings, count, vary, folder, campaign);
  else
    document_report_memory(vary, "vary");
  free(readings);
  return good;
}
