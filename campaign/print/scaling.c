/* `clast scaling`: the runs of several sizes, the answer as a sentence and as rows, and the collapse as a picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/inference/scaling.h"
#include "campaign/print/print.h"
#include "campaign/terminal/words.h"
#include "engine/grow.h"
#include "schemas/memory.h"

enum { COLUMNS = 100 };
static const double EQUAL_NUMBERS = 0.05; /* numbers of elements that differ less are one size */

static const char *const names[SCALING_VALUES] = {"critical", "nu", "beta/nu", "gamma/nu", "D", "tau"};
static const char *const meanings[SCALING_VALUES] = {
    "where the curves of all sizes cross",
    "width of the transition ~ L^(-1/nu)",
    "P there ~ L^(-beta/nu)",
    "S there ~ L^(gamma/nu)",
    "cut-off of the masses T/S ~ L^D",
    "masses ~ m^-tau: 3 - (gamma/nu)/D",
};

/* The points: the runs that share all varied inputs. */
struct points {
  size_t axes, count, room, runs, runs_room;
  struct ask_column axis[LIMITS_AXES_OF_POOL];
  struct point {
    double input[LIMITS_AXES_OF_POOL]; /* NaN: text, or off */
    double elements;                   /* mean number of grains or particles; NaN: not known */
    size_t first, end;                 /* runs */
  } * point;
  struct scaling_run *run; /* until the sizes are known, second and third are of mass shares */
  int64_t *run_id;
  size_t ids_room;
  size_t size, control; /* axes */
  int dimensions;
  struct ask_doubts doubts;
};

static void release(struct points *points) {
  free(points->point);
  free(points->run);
  free(points->run_id);
}

static status add_pool(struct points *points, const struct ask_pool *pool, struct error *error) {
  static const char what[] = "the runs of several sizes";
  const struct pooled_runs *runs = &pool->data.runs;
  TRY(grow_or_fail(&points->point, &points->room, points->count + 1, sizeof *points->point, what, error));
  TRY(grow_or_fail(&points->run, &points->runs_room, points->runs + runs->count, sizeof *points->run, what, error));
  TRY(grow_or_fail(&points->run_id, &points->ids_room, points->runs + runs->count, sizeof *points->run_id, what,
                   error));
  struct point *point = &points->point[points->count++];
  *point = (struct point){.first = points->runs, .end = points->runs + runs->count};
  for (size_t a = 0; a < points->axes; a++)
    point->input[a] = pool->input[a].kind == QUERY_INTEGER || pool->input[a].kind == QUERY_REAL ? pool->input[a].real
                                                                                                : (double)NAN;
  double whole = 0;
  for (size_t r = 0; r < runs->count; r++) {
    double mass = 0, largest = 0, squares = 0, cubes = 0;
    for (size_t k = runs->first[r]; k < runs->first[r + 1]; k++) {
      mass += runs->masses[k];
      largest = fmax(largest, runs->masses[k]);
    }
    bool left_out = false; /* the largest one, once */
    for (size_t k = runs->first[r]; k < runs->first[r + 1]; k++) {
      const double share = runs->masses[k] / mass;
      if (!left_out && runs->masses[k] == largest) {
        left_out = true;
        continue;
      }
      squares += share * share;
      cubes += share * share * share;
    }
    points->run_id[points->runs] = pool->data.run_id[r];
    points->run[points->runs++] = (struct scaling_run){.seed = pool->data.seed[r],
                                                       .order = NAN,
                                                       .largest = largest / mass,
                                                       .second = squares,
                                                       .third = cubes};
    whole += mass / (double)runs->count;
  }
  point->elements = whole / pool->data.element_mass;
  points->dimensions = pool->data.dimensions;
  ask_doubts_add(&points->doubts, &pool->doubts);
  return STATUS_OK;
}

/* The quantity of each run, by the order of the runs of a point. */
static status add_orders(struct points *points, size_t p, const struct ask_pool *pool) {
  size_t at = points->point[p].first;
  for (size_t r = 0; r < pool->data.runs.count; r++)
    if (at < points->point[p].end && points->run_id[at] == pool->data.run_id[r])
      points->run[at++].order = pool->value[r];
  ask_doubts_add(&points->doubts, &pool->doubts);
  return STATUS_OK;
}

static status read_points(struct store *store, const char *quantity, struct points *points, struct error *error) {
  char by[LIMITS_AXES_OF_POOL * (sizeof points->axis[0].name + 1)] = "";
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_POOL, points->axis, &points->axes, error));
  if (points->axes < 2)
    return status_fail(error, STATUS_USAGE,
                       "scaling needs two varied inputs, a size and a control; this store has %s%s",
                       points->axes ? "one: " : "none", points->axes ? points->axis[0].name : "");
  for (size_t a = 0; a < points->axes; a++)
    text_append(by, sizeof by, "%s%s", a ? "," : "", points->axis[a].name);
  const struct ask_pool_choice choice = {.by = by};
  ASK_POOLS pools = ask_pools(store, &choice, NULL, error);
  for (const struct ask_pool *pool; (pool = ask_pools_next(&pools));)
    TRY(add_pool(points, pool, error));
  TRY(ask_pools_end(&pools));
  points->doubts = (struct ask_doubts){0};
  ASK_POOLS values = ask_pools(store, &choice, quantity, error);
  size_t p = 0;
  for (const struct ask_pool *pool; p < points->count && (pool = ask_pools_next(&values)); p++)
    TRY(add_orders(points, p, pool));
  return ask_pools_end(&values);
}

/* ---- which input is the size, and which the control ---- */

/* Has `axis` one value for each value of `of`, and of `also`? */
static bool follows(const struct points *points, size_t axis, size_t of, size_t also) {
  for (size_t i = 0; i < points->count; i++)
    for (size_t k = 0; k < i; k++) {
      const double *a = points->point[i].input, *b = points->point[k].input;
      if (a[of] == b[of] && a[also] == b[also] && a[axis] != b[axis] && !(isnan(a[axis]) && isnan(b[axis])))
        return false;
    }
  return true;
}

/* Does this input set the number of elements? Then points of one value differ less than points of two values. */
static bool is_size(const struct points *points, size_t axis) {
  double same = EQUAL_NUMBERS, other = HUGE_VAL;
  for (size_t i = 0; i < points->count; i++)
    for (size_t k = 0; k < i; k++) {
      const struct point *a = &points->point[i], *b = &points->point[k];
      const double ratio = fabs(log(a->elements / b->elements));
      if (a->input[axis] == b->input[axis])
        same = fmax(same, ratio);
      else if (isnan(a->input[axis]) || isnan(ratio))
        return false;
      else
        other = fmin(other, ratio);
    }
  return isfinite(other) && other > same;
}

/* The first input that sets the number of elements; their count: there is none. */
static size_t size_axis(const struct points *points) {
  size_t axis = 0;
  while (axis < points->axes && !is_size(points, axis))
    axis++;
  return axis;
}

static status name_axis(struct store *store, const struct points *points, const char *name, size_t *axis,
                        struct error *error) {
  char column[1][ASK_GROUP_NAME];
  size_t count = 0;
  TRY(ask_group_columns(store, name, 1, column, &count, error));
  for (*axis = 0; *axis < points->axes; ++*axis)
    if (count == 1 && strcmp(points->axis[*axis].name, column[0]) == 0)
      return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "%s is no varied input of this store", name);
}

static status choose_size(struct store *store, struct points *points, const char *name, struct error *error) {
  const size_t found = size_axis(points);
  points->size = found;
  if (name) {
    TRY(name_axis(store, points, name, &points->size, error));
    if (found < points->axes && !is_size(points, points->size))
      return status_fail(error, STATUS_USAGE, "%s does not set the number of grains or particles; %s does: --size %s",
                         points->axis[points->size].word, points->axis[found].word, points->axis[found].word);
    return STATUS_OK;
  }
  if (found < points->axes)
    return STATUS_OK;
  char list[1024] = "";
  for (size_t a = 0; a < points->axes; a++)
    text_append(list, sizeof list, "%s%s", a ? ", " : "", points->axis[a].word);
  return status_fail(error, STATUS_USAGE,
                     "no varied input alone sets the number of grains or particles; --size names one of %s", list);
}

static status choose_control(struct store *store, struct points *points, const char *name, struct error *error) {
  char list[1024] = "";
  size_t free_axes = 0;
  if (name)
    TRY(name_axis(store, points, name, &points->control, error));
  for (size_t a = 0; !name && a < points->axes; a++)
    if (!follows(points, a, points->size, points->size)) {
      text_append(list, sizeof list, "%s%s", free_axes++ ? ", " : "", points->axis[a].word);
      points->control = a;
    }
  if (!name && free_axes != 1)
    return status_fail(error, STATUS_USAGE,
                       free_axes ? "several inputs vary at a size: --control names one of %s, and --where gives each "
                                   "other one value"
                                 : "no input varies at a size: there is no control",
                       list);
  for (size_t a = 0; a < points->axes; a++)
    if (!follows(points, a, points->size, points->control))
      return status_fail(error, STATUS_USAGE, "%s varies, too, at a size and a value of %s: --where gives it one value",
                         points->axis[a].word, points->axis[points->control].word);
  return STATUS_OK;
}

static status set_dimensions(struct points *points, int stated, struct error *error) {
  if (points->dimensions == 0 && stated == 0)
    return status_fail(error, STATUS_USAGE,
                       "clast does not know whether the model of this store's program is plane: if it is, add "
                       "--dimensions 2 (L is the number of elements to the power 1/2)");
  points->dimensions = points->dimensions ? points->dimensions : stated;
  return points->dimensions == 2
             ? STATUS_OK
             : status_fail(error, STATUS_USAGE,
                           "clast scaling is for scenes in the plane: in space its intervals were measured on small "
                           "lattices alone");
}

/* Sizes as lengths in elements; sums of squares and cubes in elements, over their number. */
static void set_sizes(struct points *points) {
  for (size_t i = 0; i < points->count; i++) {
    double elements = 0, n = 0;
    for (size_t k = 0; k < points->count; k++)
      if (points->point[k].input[points->size] == points->point[i].input[points->size]) {
        const double count = points->point[k].elements;
        elements += isnan(count) ? points->point[k].input[points->size] : count;
        n++;
      }
    elements /= n;
    for (size_t r = points->point[i].first; r < points->point[i].end; r++) {
      struct scaling_run *run = &points->run[r];
      run->control = points->point[i].input[points->control];
      run->size = pow(elements, 1.0 / points->dimensions);
      run->second *= elements;
      run->third *= elements * elements;
    }
  }
}

/* ---- the answer ---- */

static const char *unit_of(const struct ask_column *column) {
  return strcmp(column->unit, "1") == 0 ? "" : column->unit;
}

static void write_value(const struct scaling *found, enum scaling_value v, double factor, char text[UNCERTAINTY_TEXT]) {
  const struct scaling_estimate *value = &found->value[v];
  uncertainty_number(value->estimate / factor, value->half_width / factor, text);
}

/* What the runs lack for exponents: ` Next: ...`. */
static void add_next(const struct points *points, const struct scaling *found, char *text, size_t size) {
  const struct ask_column *control = &points->axis[points->control];
  text_append(text, size, " Next: values of %s between %.4g and %.4g%s%s for every size, or more seeds.", control->word,
              found->about[0] / control->factor, found->about[1] / control->factor, *unit_of(control) ? " " : "",
              unit_of(control));
}

static void write_no_crossing(const struct points *points, const struct scaling *found, char *text, size_t size) {
  const struct ask_column *control = &points->axis[points->control];
  const char *unit = unit_of(control), *gap = *unit ? " " : "";
  const double at = found->nearest / control->factor;
  if (isnan(found->nearest)) {
    text_append(text, size,
                "No crossing: the least and the largest size have no %s in common. Next: the same values of "
                "%s for every size.",
                control->word, control->word);
    return;
  }
  const bool end = found->nearest == found->range[0] || found->nearest == found->range[1];
  char where[64] = "outside this range";
  if (end)
    snprintf(where, sizeof where, "%s %.4g%s%s", found->nearest == found->range[0] ? "below" : "above", at, gap, unit);
  text_append(
      text, size,
      "No crossing: from %.4g to %.4g%s%s the curves of Q of the least and the largest size do not cross%s. They "
      "are nearest at %.4g%s%s (Q %.2g and %.2g)",
      found->range[0] / control->factor, found->range[1] / control->factor, gap, unit,
      found->touch ? ", as far as these runs tell" : "", at, gap, unit, found->nearest_q[0], found->nearest_q[1]);
  if (found->touch)
    text_append(
        text, size,
        ": %s do they differ by two standard errors. Next: more seeds, sizes further apart, or values of %s %s.",
        found->differ ? "only elsewhere" : "nowhere", control->word, where);
  else
    text_append(text, size,
                ". So there is no critical %s in this range, and there are no exponents. Next: values of %s %s.",
                control->word, control->word, where);
}

static void write_answer(const struct points *points, const char *quantity, const struct scaling *found) {
  const struct ask_column *size = &points->axis[points->size], *control = &points->axis[points->control];
  char text[2048] = "", at[UNCERTAINTY_TEXT], value[UNCERTAINTY_TEXT], mark[UNCERTAINTY_TEXT], near[64], lost[64] = "";
  const char *unit = unit_of(control), *gap = *unit ? " " : "";
  uncertainty_mark(&points->doubts, mark);
  write_value(found, SCALING_CRITICAL, control->factor, at);
  text_append(at, sizeof at, "%s%s%s", gap, unit, mark);
  snprintf(near, sizeof near, "%.3g%s%s", found->crossing / control->factor, gap, unit);
  switch (found->kind) {
  case SCALING_FOUND:
    text_append(text, sizeof text, "Critical %s: %s (95 %%)", control->word, at);
    for (int v = SCALING_NU; v < SCALING_VALUES; v++) {
      const bool told = !isnan(found->value[v].estimate);
      write_value(found, v, 1, value);
      text_append(told ? text : lost, told ? sizeof text : sizeof lost, "%s %s %s",
                  told    ? ","
                  : *lost ? ","
                          : "",
                  names[v], told ? value : "");
    }
    text_append(text, sizeof text, ". The curves of %zu sizes are one (chi-square %.2g of %s, %.2g of S).",
                found->sizes, found->chi_square[0], quantity, found->chi_square[1]);
    if (found->may_jump)
      text_append(text, sizeof text, " A jump (beta/nu = 0, nu = 1/%d) is within the intervals: more seeds may tell.",
                  points->dimensions);
    if (*lost)
      text_append(text, sizeof text, " Most resampled runs give no%s: more seeds may.", lost);
    break;
  case SCALING_JUMP:
    text_append(text, sizeof text,
                "A jump at %s = %s (95 %%): within their intervals beta/nu is 0 and 1/nu is %d, as at a first-order "
                "transition.",
                control->word, at, points->dimensions);
    break;
  case SCALING_TOO_FEW:
    if (found->sizes < SCALING_LEAST_SIZES) {
      text_append(text, sizeof text, "Too few sizes: the runs have %zu, by %s; exponents need %d.", found->sizes,
                  size->word, SCALING_LEAST_SIZES);
      break;
    }
    text_append(text, sizeof text,
                "Too few points: a size has fewer than two values of %s, with %d runs each, near the crossing at %s.",
                control->word, SCALING_LEAST_RUNS, near);
    add_next(points, found, text, sizeof text);
    break;
  case SCALING_NO_CROSSING: write_no_crossing(points, found, text, sizeof text); break;
  case SCALING_NOT_ONE:
    text_append(text, sizeof text,
                "Not one curve: the sizes cross near %s, but no exponents make their curves one (chi-square %.2g of "
                "%s, %.2g of S; they are %.0f and %.0f %% apart).",
                near, found->chi_square[0], quantity, found->chi_square[1], 100 * found->distance[0],
                100 * found->distance[1]);
    add_next(points, found, text, sizeof text);
    break;
  case SCALING_NOT_TOLD:
    text_append(text, sizeof text, "Too few runs for exponents: the sizes cross near %s, but %s.", near,
                isnan(found->chi_square[0] + found->chi_square[1]) ? "no curve through that crossing fits them"
                                                                   : "they give no critical value with and without the "
                                                                     "smallest size, or most resampled runs do not");
    add_next(points, found, text, sizeof text);
    break;
  }
  text_wrap(text, 0, 0, COLUMNS, stdout);
}

static status print_rows(const struct points *points, const char *quantity, const struct scaling *found,
                         enum table_format format, struct error *error) {
  const struct ask_column *control = &points->axis[points->control];
  const bool people = table_for_people(format);
  char name[2 * sizeof control->name + 64];
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"name", "value", "value_hw95", "shift", "meaning", "answer", NULL});
  table_rare(table);
  table_doubt_columns(table);
  for (int v = 0; v < SCALING_VALUES; v++) {
    const struct scaling_estimate *value = &found->value[v];
    const double factor = people && v == SCALING_CRITICAL ? control->factor : 1;
    snprintf(name, sizeof name, v == SCALING_CRITICAL && people ? "critical %s%s%s%s" : "%s",
             v == SCALING_CRITICAL && people ? control->word : names[v], *control->unit ? " [" : "", control->unit,
             *control->unit ? "]" : "");
    table_text(table, name);
    table_rests_on(table, &points->doubts);
    table_reals(table, 3,
                (const double[]){value->estimate / factor, value->half_width / factor, value->shift / factor});
    table_text(table, meanings[v]);
    table_text(table, scaling_kind_names[found->kind]);
    table_doubt_cells(table, &points->doubts);
  }
  for (int k = 0; k < 4; k++) {
    const char *of = k % 2 ? "S" : people ? quantity : "P";
    snprintf(name, sizeof name, k < 2 ? "chi-square of %s" : "distance of %s", of);
    table_text(table, name);
    table_reals(table, 3, (const double[]){k < 2 ? found->chi_square[k] : found->distance[k - 2], NAN, NAN});
    table_text(table, k < 2 ? "reduced, of the collapse: 1 if the curves are one"
                            : "rms, from the collapsed curve, as a share");
    table_text(table, scaling_kind_names[found->kind]);
    table_doubt_cells(table, &points->doubts);
  }
  return table_end(table, error);
}

/* ---- the picture ---- */

static status draw(struct store *store, const struct points *points, const char *quantity, const struct scaling *found,
                   const struct picture_page *page, struct error *error) {
  const struct ask_column *control = &points->axis[points->control];
  const double *value[] = {&found->value[SCALING_CRITICAL].estimate, &found->value[SCALING_NU].estimate,
                           &found->value[SCALING_BETA].estimate, &found->value[SCALING_GAMMA].estimate};
  const bool scaled = isfinite(*value[0] + *value[1] + *value[2] + *value[3]);
  OWNED double *x = NULL;
  OWNED double(*y)[2][3] = NULL;
  struct picture_size size[SCALING_SIZES];
  char label[SCALING_SIZES][64], axis[256], panel[2][ASK_GROUP_NAME + 32], caption[CHARTS_LABEL] = "";
  size_t sizes = 0;
  TRY(memory_array(&x, found->cells + 1, sizeof *x, "a picture", error));
  TRY(memory_array(&y, found->cells + 1, sizeof *y, "a picture", error));
  for (size_t c = 0; c < found->cells; c++) {
    const struct scaling_cell *cell = &found->cell[c];
    if (c == 0 || cell->size != cell[-1].size) {
      snprintf(label[sizes], sizeof label[0], "L = %.3g, %.3g elements", cell->size,
               pow(cell->size, points->dimensions));
      size[sizes] = (struct picture_size){label[sizes], 0, x + c, (const double(*)[2][3])(y + c)};
      sizes++;
    }
    size[sizes - 1].count++;
    x[c] = scaled ? (cell->control - *value[0]) / control->factor * pow(cell->size, 1 / *value[1])
                  : cell->control / control->factor;
    for (int k = 0; k < 2; k++) {
      const int of = k && !scaled ? 2 : k; /* Q instead of S: the curves that should cross */
      const double scale = scaled ? pow(cell->size, k ? -*value[3] : *value[2]) : 1;
      y[c][k][0] = scale * cell->mean[of];
      y[c][k][1] = scale * (cell->mean[of] - cell->half_width[of]);
      y[c][k][2] = scale * (cell->mean[of] + cell->half_width[of]);
    }
  }
  const char *unit = *control->unit && strcmp(control->unit, "1") != 0 ? control->unit : NULL;
  snprintf(axis, sizeof axis, scaled ? "(%s − critical %s) L^(1/ν)%s%s%s" : "%s%.0s%s%s%s", control->word,
           control->word, unit ? " (" : "", unit ? unit : "", unit ? ")" : "");
  snprintf(panel[0], sizeof panel[0], scaled ? "%s × L^(β/ν)" : "%s", quantity);
  snprintf(panel[1], sizeof panel[1], scaled ? "S × L^(−γ/ν)" : "Q, of the largest in Σm²");
  snprintf(caption, sizeof caption, "means with 95 %% intervals over seeds%s",
           scaled ? "" : "; not scaled: no exponents. Q crosses at a critical value");
  charts_doubts(store, &points->doubts, caption, sizeof caption);
  const struct picture_words words = {scaled ? "Collapse of the sizes" : "The sizes", caption, axis, NULL};
  return picture_collapse(page, &words, (const char *const[]){panel[0], panel[1]}, sizes, size, error);
}

status print_scaling(struct store *store, const struct scaling_choice *choice, enum table_format format,
                     const struct picture_page *page, struct error *error) {
  __attribute__((cleanup(release))) struct points points = {0};
  char quantity[ASK_GROUP_NAME];
  SCALING found = {0};
  TRY(ask_group_quantity(store, choice->quantity, quantity, error));
  TRY(read_points(store, quantity, &points, error));
  TRY(set_dimensions(&points, (int)choice->dimensions, error));
  TRY(choose_size(store, &points, choice->size, error));
  TRY(choose_control(store, &points, choice->control, error));
  set_sizes(&points);
  TRY(scaling_find(points.runs, points.run, points.dimensions, &found, error));
  if (table_for_people(format))
    write_answer(&points, quantity, &found);
  const bool has_rows = found.kind == SCALING_FOUND || found.kind == SCALING_JUMP || found.kind == SCALING_NOT_ONE;
  if (!table_for_people(format) || has_rows)
    TRY(print_rows(&points, quantity, &found, format, error));
  if (table_for_people(format)) {
    words_print(
        stderr, "",
        "clast: %zu runs, sizes by %s; L is the number of grains or particles to the power 1/%d. P: the "
        "mean of %s. S: mean mass of a fragment without the largest one, in elements. 95 %% intervals over "
        "whole runs, and hold what the shift tells. shift: the value without the smallest size, less that with it",
        found.runs, points.axis[points.size].word, points.dimensions, quantity);
    uncertainty_doubts(&points.doubts, stderr);
  }
  return page ? draw(store, &points, quantity, &found, page, error) : STATUS_OK;
}
