/* Reads every form of the key `vary` and links the axes. */
#include "campaign/document/campaign_read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/unit.h"

enum { MOST_LEVELS = 1000000, PATH_SIZE = 320 };

struct reading { /* one axis being read */
  struct campaign *campaign;
  struct design_axis *axis;
  document_node *node;
  char path[PATH_SIZE]; /* "vary.threshold.strain", for messages */
};

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

static unsigned own_percent(const struct reading *r) {
  return r->axis->row->flags & FIELD_PERCENT;
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
  *x = value.number;
  return true;
}

/* Reads a value by the axis' own row, as a number. */
static bool read_own(struct reading *r, document_node *node, double *x) {
  struct field_value value;
  struct field row = *r->axis->row;
  row.path = r->path;
  row.flags &= ~(unsigned)FIELD_MAY_BE_OFF; /* an end of a range cannot be off */
  if (!document_value(node, &row, &value))
    return false;
  note_unit(r, node, row.unit);
  *x = row.kind == FIELD_INTEGER ? (double)value.integer : value.number;
  return true;
}

static bool is_number(const struct field *row) {
  return row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
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
    if (document_value(document_item(node, i, NULL), &row, &r->axis->levels[i]))
      note_unit(r, document_item(node, i, NULL), row.unit);
    else
      good = false;
  return good;
}

static bool read_spaced(struct reading *r, document_node *from, document_node *to, double range, bool logarithmic) {
  const char *const unit = r->axis->row->unit ? r->axis->row->unit : "1";
  document_node *node = document_key(r->node, "n");
  struct field row = number_row(r, "1", 2, MOST_LEVELS, 0);
  row.kind = FIELD_INTEGER;
  struct field_value n;
  if (!node)
    return wrong(r, NULL, "'n', the number of values, is missing");
  if (!document_value(node, &row, &n))
    return false;
  if (!make_levels(r, (size_t)n.integer))
    return false;
  for (size_t i = 0; i < r->axis->level_count; i++) {
    const double x = design_axis_spaced(document_scalar(from), document_scalar(to), unit, r->axis->level_count,
                                        logarithmic, i);
    struct field_value *value = &r->axis->levels[i];
    value->kind = r->axis->row->kind;
    if (value->kind == FIELD_INTEGER)
      value->integer = (int64_t)llround(x);
    else
      value->number = x;
  }
  if (r->axis->row->kind == FIELD_INTEGER && range < (double)(r->axis->level_count - 1))
    return wrong(r, node, "more values than whole numbers in the range");
  return true;
}

static bool read_truncation(struct reading *r, bool positive) {
  document_node *node = document_key(r->node, "truncated");
  if (node && !read_pair(r, node, positive, &r->axis->lower, &r->axis->upper))
    return false;
  /* Position in a distribution, in standard deviations from its centre. */
  struct design_axis *axis = r->axis;
  const struct field *row = axis->row;
#define DEVIATIONS(x) (positive ? log(fmax(x, 0) / axis->a) / axis->b : ((x)-axis->a) / axis->b)
  double from = DEVIATIONS(axis->lower), to = DEVIATIONS(axis->upper);
  double least = DEVIATIONS(row->minimum), most = DEVIATIONS(row->maximum);
#undef DEVIATIONS
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

static bool read_normal(struct reading *r, document_node *node) {
  struct field any = number_row(r, r->axis->row->unit, -HUGE_VAL, HUGE_VAL, own_percent(r));
  struct field positive = number_row(r, r->axis->row->unit, 0, HUGE_VAL, FIELD_ABOVE_MINIMUM | own_percent(r));
  r->axis->kind = DESIGN_AXIS_NORMAL;
  if (document_kind(node) != DOCUMENT_MAPPING)
    return wrong(r, node, "expected {mean: m, sd: s}");
  bool good = read_number(r, document_key(node, "mean"), "mean", &any, &r->axis->a);
  good &= read_number(r, document_key(node, "sd"), "sd", &positive, &r->axis->b);
  document_unknown_keys(node, r->path, (const char *const[]){"mean", "sd", NULL});
  return good && read_truncation(r, false);
}

static bool read_lognormal(struct reading *r, document_node *node) {
  struct field positive = number_row(r, r->axis->row->unit, 0, HUGE_VAL, FIELD_ABOVE_MINIMUM | own_percent(r));
  struct field sigma = number_row(r, "1", 0, 100, FIELD_ABOVE_MINIMUM);
  r->axis->kind = DESIGN_AXIS_LOGNORMAL;
  if (document_kind(node) != DOCUMENT_MAPPING)
    return wrong(r, node, "expected {median: m, sigma: s}; sigma is the standard deviation of the natural logarithm");
  bool good = read_number(r, document_key(node, "median"), "median", &positive, &r->axis->a);
  good &= read_number(r, document_key(node, "sigma"), "sigma", &sigma, &r->axis->b);
  document_unknown_keys(node, r->path, (const char *const[]){"median", "sigma", NULL});
  return good && read_truncation(r, true);
}

/* Reads the values that correspond one to one to those of the other input. */
static bool read_linked_values(struct reading *r, document_node *values) {
  if (document_kind(values) != DOCUMENT_SEQUENCE)
    return wrong(r, values, "expected a list of values, one for each value of the input it follows");
  const bool good = read_values(r, values);
  r->axis->kind = DESIGN_AXIS_LINKED;
  return good;
}

/* Reads factor and offset: the value is factor times the other input, plus offset. */
static bool read_line(struct reading *r) {
  const struct field factor = number_row(r, "1", -HUGE_VAL, HUGE_VAL, 0);
  const struct field offset = number_row(r, r->axis->row->unit, -HUGE_VAL, HUGE_VAL, own_percent(r));
  document_node *factor_node = document_key(r->node, "factor"), *offset_node = document_key(r->node, "offset");
  bool good = true;
  r->axis->a = 1;
  if (factor_node)
    good &= read_number(r, factor_node, "factor", &factor, &r->axis->a);
  if (offset_node)
    good &= read_number(r, offset_node, "offset", &offset, &r->axis->b);
  return good;
}

static bool read_linked(struct reading *r, document_node *node) {
  struct error error;
  const struct campaign *campaign = r->campaign;
  const char *name = document_scalar(node);
  const struct field *row = name ? field_find(campaign->scene->kind->inputs, name, &error) : NULL;
  r->axis->kind = DESIGN_AXIS_LINKED;
  if (!row)
    return wrong(r, node, name ? error.message : "expected the path of the varied input that this one follows");
  const struct design_axis *other = campaign_axis(campaign, row);
  if (!other || other == r->axis)
    return wrong(r, node, "follows an input that is not varied; name one of the other keys of `vary`");
  r->axis->linked = (size_t)(other - campaign->axes);
  document_node *values = document_key(r->node, "values");
  if (values)
    return read_linked_values(r, values);
  if (!is_number(row) || !is_number(r->axis->row))
    return wrong(r, node, "only numbers follow by factor and offset; give `values`");
  return read_line(r);
}

static bool read_spaced_form(struct reading *r, document_node *from) {
  double a = 0, b = 0;
  document_node *to = document_key(r->node, "to");
  if (!to)
    return wrong(r, NULL, "'to' is missing");
  return read_own(r, from, &a) && read_own(r, to, &b) && read_spaced(r, from, to, fabs(b - a), false);
}

static bool read_logarithmic_form(struct reading *r, document_node *pair) {
  double a = 0, b = 0;
  return read_pair(r, pair, true, &a, &b) &&
         read_spaced(r, document_item(pair, 0, NULL), document_item(pair, 1, NULL), b - a, true);
}

static bool read_uniform(struct reading *r, document_node *pair) {
  r->axis->kind = DESIGN_AXIS_UNIFORM;
  return read_pair(r, pair, false, &r->axis->a, &r->axis->b);
}

static bool read_log_uniform(struct reading *r, document_node *pair) {
  r->axis->kind = DESIGN_AXIS_LOG_UNIFORM;
  return read_pair(r, pair, true, &r->axis->a, &r->axis->b);
}

/* The forms that are mappings: the first key tells which form it is. */
static const struct form {
  const char *keys[5];
  bool (*read)(struct reading *r, document_node *first);
} forms[] = {
    {{"from", "to", "n"}, read_spaced_form},
    {{"log", "n"}, read_logarithmic_form},
    {{"uniform"}, read_uniform},
    {{"log_uniform"}, read_log_uniform},
    {{"normal", "truncated"}, read_normal},
    {{"lognormal", "truncated"}, read_lognormal},
    {{"linked", "factor", "offset", "values"}, read_linked},
};

/* NULL: the mapping has no first key of a form, or several. */
static const struct form *find_form(const struct reading *r) {
  const struct form *found = NULL;
  for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
    if (!document_key(r->node, forms[i].keys[0]))
      continue;
    if (found)
      return NULL;
    found = &forms[i];
  }
  return found;
}

static bool read_form(struct reading *r) {
  const struct form *form = find_form(r);
  if (!form)
    return wrong(r, NULL,
                 "expected one of {from, to, n}, {log: [a, b], n}, {uniform: [a, b]}, {log_uniform: [a, b]}, {normal: "
                 "{mean, sd}}, {lognormal: {median, sigma}}, {linked: path}");
  for (int k = 0; form->keys[k]; k++)
    document_key(r->node, form->keys[k]); /* marks the keys as known before any error below can end the reading */
  document_unknown_keys(r->node, r->path, form->keys);
  if (form->read != read_linked && !is_number(r->axis->row))
    return wrong(r, NULL, "this input is no number: give a list of its values");
  return form->read(r, document_key(r->node, form->keys[0]));
}

static bool read_axis(struct reading *r) {
  if (r->axis->row->flags & FIELD_FILE)
    return wrong(r, NULL, "a shape file cannot be varied: write a scene, and a campaign, for each shape");
  switch (document_kind(r->node)) {
  case DOCUMENT_SEQUENCE: return read_values(r, r->node);
  case DOCUMENT_MAPPING: return read_form(r);
  default: return wrong(r, NULL, "expected a list of values or a range; a single value belongs in `set`");
  }
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

static int by_place(const void *a, const void *b) {
  const struct field_value *x = *(const struct field_value *const *)a, *y = *(const struct field_value *const *)b;
  return (x > y) - (x < y);
}

/* Any order that has equal values side by side, the first of them first. */
static int by_value(const void *a, const void *b) {
  const struct field_value *x = *(const struct field_value *const *)a, *y = *(const struct field_value *const *)b;
  int order = memcmp(&x->number, &y->number, sizeof x->number);
  if (order == 0)
    order = memcmp(&x->integer, &y->integer, sizeof x->integer);
  if (order == 0)
    order = strcmp(x->text, y->text);
  return order ? order : by_place(a, b);
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
  const struct field_value **sorted = calloc(axis->level_count, sizeof *sorted);
  if (!sorted) {
    document_report_memory(r->node, r->path);
    return false;
  }
  for (size_t i = 0; i < axis->level_count; i++)
    sorted[i] = &axis->levels[i];
  qsort(sorted, axis->level_count, sizeof *sorted, by_value);
  size_t kept = 0;
  for (size_t i = 0; i < axis->level_count; i++)
    if (kept == 0 || !field_same_value(axis->row, sorted[i], sorted[kept - 1]))
      sorted[kept++] = sorted[i];
  qsort(sorted, kept, sizeof *sorted, by_place);
  for (size_t i = 0; i < kept; i++)
    axis->levels[i] = *sorted[i]; /* which is level i or a later one */
  axis->level_count = kept;
  free(sorted);
  return true;
}

/* Finds the input of the index-th key and makes its axis. */
static bool begin_axis(struct reading *readings, size_t index, document_node *vary, struct campaign *campaign) {
  const char *key = NULL;
  struct error error = {0};
  struct reading *r = &readings[index];
  r->node = document_item(vary, index, &key);
  r->campaign = campaign;
  r->axis = &campaign->axes[index];
  snprintf(r->path, sizeof r->path, "vary.%.300s", key ? key : "");
  const struct field *row = key ? field_find(campaign->scene->kind->inputs, key, &error) : NULL;
  if (!row)
    return wrong(r, NULL, key ? error.message : "expected a path");
  const struct design_axis *same = campaign_axis(campaign, row);
  *r->axis = (struct design_axis){.row = row, .lower = -HUGE_VAL, .upper = HUGE_VAL};
  campaign->axis_count = index + 1;
  if (same)
    document_report(r->node, r->path, "the same input as %s", readings[same - campaign->axes].path);
  return !same;
}

/* Finds the inputs of all axes first, so that links may come in any order. */
static bool read_axes(struct reading *readings, size_t count, document_node *vary, struct campaign *campaign) {
  for (size_t i = 0; i < count; i++)
    if (!begin_axis(readings, i, vary, campaign))
      return false;
  bool good = true;
  for (size_t i = 0; i < count; i++)
    good &= read_axis(&readings[i]);
  good = good && check_links(readings, campaign);
  for (size_t i = 0; good && campaign->design.kind == CAMPAIGN_GRID && i < count; i++)
    if (campaign->axes[i].kind == DESIGN_AXIS_LEVELS)
      good = drop_equal(&readings[i]);
  return good;
}

bool campaign_vary_read(document_node *vary, struct campaign *campaign) {
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
    good = read_axes(readings, count, vary, campaign);
  else
    document_report_memory(vary, "vary");
  free(readings);
  return good;
}
