/* A quantity over one or two varied inputs: reads it from groups of runs, or fits the exponent of each point, and draws
 * it as the lines of `clast plot` or the tiles of `clast map`. */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/charts/charts.h"
#include "campaign/terminal/words.h"
#include "db/store/views.h"
#include "engine/grow.h"
#include "schemas/memory.h"

/* Columns of ask_group after the axes. */
enum {
  VERSION = 1,
  POINTS = 2,
  RUNS = 3,
  MEAN = 7,
  HALF_WIDTH = 10,
  LOW = 11,
  HIGH = 12,
  WEAK = 13,
  RESOLUTION = 14,
  VERDICT = 15,
  DOUBTFUL = 17,
  COLUMNS = 19
};

enum {
  MOST_ROWS = 10000,
  MOST_LINES = PICTURE_SERIES,
  MOST_PANELS = 6,
  MOST_MEANS = 1000,
  MOST_PLACES = 40,
  INPUT_TEXT = 200,
  AXES = 3
};

struct row {
  double input[AXES];          /* in the campaign's unit; NaN: a text, off, or does not apply */
  char text[AXES][INPUT_TEXT]; /* the inputs for people; "": off, or does not apply */
  int64_t version;             /* results_version */
  int64_t points;              /* that the value is a mean of */
  double value, lower, upper;  /* bounds of the 95 % interval; NaN: unknown */
  double half_width;           /* of this interval, also where a share's interval ends at 0 or 1 */
  double resolution;           /* possible change of the value by finer settings; NaN: unknown */
  bool doubtful;               /* rests on runs in doubt */
  bool weak;                   /* too few runs for an interval that can be trusted */
  int decimals;                /* of a value without an interval; -1: its leading digits */
};

struct quantity {
  bool exponent;
  size_t axes;                     /* 1 to AXES */
  char column[AXES][256];          /* the axes' columns in the views */
  char name[256];                  /* column of the quantity, or the exponent's name */
  char main[ASK_GROUP_NAME];       /* the quantity that a user who names none sees */
  struct ask_group_pooled pooled;  /* what the means that are drawn average over */
  bool seeds;                      /* a mean is of several runs of a point */
  char untold[400];                /* why some exponents are not told: their values are NaN */
  char changing[ASK_GROUP_POOLED]; /* varied inputs that are not drawn and change from point to point; "": none */
  char apart[256];                 /* the first input in which points of one place differ; "": none */
  struct row *row;                 /* owned */
  size_t count, room;
  struct ask_column written[LIMITS_AXES_OF_TABLE]; /* the varied inputs, in the units that the campaign gives */
  size_t written_count;
  const struct ask_column *unit[AXES]; /* the written unit of each axis; NULL: SI */
};

static void release(struct quantity *quantity) {
  free(quantity->row);
}

/* Adds a row with its inputs in the campaign's units. */
static status add_row(struct quantity *quantity, const struct query_value *inputs, struct row row,
                      struct error *error) {
  if (quantity->count == MOST_ROWS)
    return status_fail(error, STATUS_USAGE, "a chart has at most %d points: choose axes with fewer values", MOST_ROWS);
  if (!grow_room(&quantity->row, &quantity->room, quantity->count + 1, sizeof row))
    return status_fail(error, STATUS_MEMORY, "no memory for a chart");
  for (size_t i = 0; i < quantity->axes; i++) {
    const struct query_value value = quantity->unit[i] ? ask_columns_value(quantity->unit[i], &inputs[i]) : inputs[i];
    row.input[i] = value.kind == QUERY_TEXT ? (double)NAN : value.real;
    row.text[i][0] = '\0';
    if (value.kind == QUERY_TEXT)
      snprintf(row.text[i], INPUT_TEXT, "%s", value.text);
    else if (value.kind != QUERY_NULL)
      snprintf(row.text[i], INPUT_TEXT, "%.6g", value.real);
    if (value.kind != QUERY_TEXT)
      text_powers(row.text[i], INPUT_TEXT);
  }
  quantity->row[quantity->count++] = row;
  return STATUS_OK;
}

/* Takes the names of the inputs and of the quantity from the columns of ask_group. */
static status read_names(struct quantity *quantity, const struct answer *groups, const char *refusal,
                         struct error *error) {
  const size_t axes = quantity->axes;
  bool twice = false;
  for (size_t i = 0; i < axes && i < answer_count(groups); i++)
    for (size_t k = 0; k < i; k++)
      twice |= strcmp(answer_name(groups, i), answer_name(groups, k)) == 0;
  if (answer_count(groups) != axes + COLUMNS || twice)
    return status_fail(error, STATUS_USAGE, "%s", refusal);

  for (size_t i = 0; i < axes; i++) {
    snprintf(quantity->column[i], sizeof quantity->column[i], "%s", answer_name(groups, i));
    for (size_t k = 0; k < quantity->written_count; k++)
      if (strcmp(quantity->written[k].name, quantity->column[i]) == 0)
        quantity->unit[i] = &quantity->written[k];
  }
  const char *mean = answer_name(groups, axes + MEAN);
  if (!quantity->exponent)
    snprintf(quantity->name, sizeof quantity->name, "%.*s", (int)(strlen(mean) - strlen("_mean")), mean);
  return STATUS_OK;
}

static status read_groups(struct quantity *quantity, struct answer *groups, struct error *error) {
  const size_t axes = quantity->axes;
  while (answer_next(groups)) {
    struct query_value inputs[AXES];
    for (size_t i = 0; i < axes; i++)
      inputs[i] = answer_value(groups, i);
    const struct row row = {.version = answer_integer(groups, axes + VERSION),
                            .points = answer_integer(groups, axes + POINTS),
                            .value = answer_real(groups, axes + MEAN),
                            .lower = answer_real(groups, axes + LOW),
                            .upper = answer_real(groups, axes + HIGH),
                            .half_width = answer_real(groups, axes + HALF_WIDTH),
                            .resolution = answer_real(groups, axes + RESOLUTION),
                            .doubtful = answer_integer(groups, axes + DOUBTFUL) > 0,
                            .weak = answer_integer(groups, axes + WEAK) > 0,
                            .decimals = -1};
    quantity->seeds |= answer_integer(groups, axes + RUNS) > row.points;
    TRY(add_row(quantity, inputs, row, error));
  }
  return answer_end(groups);
}

/* newest: only of each point's newest results_version, including points without runs. */
static status read_exponents(struct store *store, struct quantity *quantity, enum exponent_method method,
                             enum estimates_window window, bool newest, struct error *error) {
  const char *inputs[AXES] = {quantity->column[0], quantity->column[1], quantity->column[2]};
  ANSWER points = ask_points_rows(store, newest, quantity->axes, inputs, error);
  for (struct ask_points_row point; ask_points_next(&points, &point);) {
    struct pooled_exponent fit;
    struct ask_resolution resolution;
    struct ask_doubts doubts = {0};
    if (point.n == 0 && !newest)
      continue;
    TRY(point_exponent(store, point.point_id, newest ? 0 : point.results_version, method, window, 0.95, &fit, error));
    TRY(ask_resolution(store, point.point_id, quantity->name, &resolution, error));
    TRY(ask_doubts(store, &(struct ask_doubts_choice){.point = point.point_id}, OUTCOME_NAME(mean_fragment_mass),
                   &doubts, error));
    const char *untold = pooled_exponent_untold(&fit);
    const double beta = untold ? (double)NAN : fit.fit.beta, half_width = fit.interval.half_width;
    const struct row row = {.version = point.results_version,
                            .value = beta,
                            .lower = beta - half_width,
                            .upper = beta + half_width,
                            .half_width = half_width,
                            .resolution = resolution.half_width,
                            .doubtful = !untold && doubts.doubtful > 0,
                            .weak = !untold && !isfinite(half_width) && point.n > 1,
                            .decimals = pooled_exponent_decimals(&fit)};
    pooled_exponent_tell(untold, quantity->untold, sizeof quantity->untold);
    TRY(add_row(quantity, point.inputs, row, error));
  }
  return answer_end(&points);
}

/* What a chart can take as its axes where the user names none: `most` inputs, of which it needs `least`. */
struct axes_wanted {
  size_t least, most;
  int64_t separate; /* values that the input of --by may have */
};

/* Can it be the input number `place` of a chart? All points have it. On an axis, their values are all numbers; a plot
 * also takes words. */
static bool suits(const struct axes_wanted *wanted, size_t place, const struct ask_group_values *values) {
  if (place >= wanted->least)
    return values->given == values->points && values->kinds > 1 && values->kinds <= wanted->separate;
  return values->numbers == values->points ||
         (wanted->least < 2 && values->given == values->points && values->numbers == 0 && values->kinds <= MOST_PLACES);
}

/* Is the column what the user named? */
static bool is_named(const struct ask_column *column, const char *word) {
  char name[sizeof column->name] = "";
  for (size_t i = 0; word && word[i] && i + 1 < sizeof name; i++)
    name[i] = word[i] == '.' ? '_' : word[i];
  return *name && text_ends_in_words(column->name, name, "_");
}

/* Takes for each axis that the user did not name (NULL) the first input that was varied and that suits all points, and
 * names them on stderr. An input with one value comes after the others. --by is taken only if nothing was named. */
static status choose_axes(struct store *store, const struct axes_wanted *wanted, const char *inputs[AXES],
                          struct ask_column axes[LIMITS_AXES_OF_TABLE], struct error *error) {
  static const char *const option[] = {"--x", "--y"}, *const by = "--by";
  char chosen[600] = "";
  size_t count = 0, named = 0, taken = 0, filled = 0, last = 0;
  const size_t least = wanted->least;
  bool used[LIMITS_AXES_OF_TABLE] = {false};
  if (inputs[0] && (least < 2 || inputs[1]))
    return STATUS_OK;
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_TABLE, axes, &count, error));
  for (size_t k = 0; k < AXES; k++) {
    named += inputs[k] != NULL;
    for (size_t i = 0; i < count; i++)
      used[i] |= is_named(&axes[i], inputs[k]);
  }
  if (count < least)
    return status_fail(error, STATUS_USAGE,
                       count ? "only %s was varied: `clast plot` draws a quantity over one input"
                             : "no input was varied: `clast scatter` shows the runs, `clast spectrum` their fragments",
                       axes[0].word);
  const size_t most = named ? least : wanted->most;
  for (int constant = 0; constant < 2; constant++)
    for (size_t i = 0; i < count; i++) {
      struct ask_group_values values;
      while (taken < most && inputs[taken])
        taken++;
      if (taken == most)
        break;
      TRY(ask_group_values(store, axes[i].name, &values, error));
      if (used[i] || (values.kinds < 2) != constant || !suits(wanted, taken, &values))
        continue;
      used[i] = true;
      last = i > last ? i : last;
      filled++;
      inputs[taken] = axes[i].word;
      text_append(chosen, sizeof chosen, " %s %s", taken < least ? option[taken] : by, axes[i].word);
    }
  for (taken = 0; taken < least && inputs[taken];)
    taken++;
  if (taken < least) {
    *chosen = '\0';
    for (size_t i = 0; i < count; i++)
      text_append(chosen, sizeof chosen, "%s%s", i ? ", " : "", axes[i].word);
    return status_fail(error, STATUS_USAGE,
                       least < 2 ? "no varied input has numbers in all points: name one with -x, and the points that "
                                   "have it are drawn: %s"
                                 : "no two varied inputs have numbers in all points: name two with -x and -y, and the "
                                   "points that have both are drawn: %s",
                       chosen);
  }
  fprintf(stderr, "clast: drawn over the first %sinputs that were varied%s:%s\n", named ? "other " : "",
          named || last < filled ? "" : " and suit all points", chosen);
  return STATUS_OK;
}

/* Reads the quantity `name` over some inputs, the last ones NULL. STATUS_USAGE: unknown names; `refusal` if they are
 * not different inputs and one quantity. The caller releases it, also after an error. */
static status read_quantity(struct store *store, const char *const inputs[AXES], const char *name, bool newest,
                            const char *refusal, struct quantity *quantity, struct error *error) {
  enum exponent_method method;
  enum estimates_window window;
  char by[900] = "";
  for (size_t i = 0; i < AXES && inputs[i]; i++, quantity->axes++)
    text_append(by, sizeof by, "%s%s", i ? "," : "", inputs[i]);
  TRY(ask_quantity_main(store, quantity->main, &name, error));
  snprintf(quantity->name, sizeof quantity->name, "%s", name);
  TRY(estimates_named(name, &quantity->exponent, &method, &window, error));
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_TABLE, quantity->written, &quantity->written_count, error));
  ANSWER groups = ask_group(store, by, quantity->exponent ? OUTCOME_DEFAULT : name, &quantity->pooled, error);
  TRY(answer_status(&groups));
  TRY(read_names(quantity, &groups, refusal, error));
  TRY(ask_group_changing(store, by, quantity->changing, error));
  if (!quantity->exponent)
    return read_groups(quantity, &groups, error);
  (void)text_next_item(quantity->pooled.inputs, quantity->apart, sizeof quantity->apart);
  quantity->pooled.inputs[0] = '\0'; /* exponents belong to single points */
  return read_exponents(store, quantity, method, window, newest, error);
}

/* Tells on stderr what the runs behind the quantities leave in doubt, and at the end of a caption. */
static status add_doubts(struct store *store, const char *quantities, char *caption, size_t size, struct error *error) {
  char results[ASK_DOUBTS_RESULTS];
  struct ask_doubts doubts = {0};
  TRY(ask_doubts_results(store, quantities, results, error));
  TRY(ask_doubts(store, &(struct ask_doubts_choice){0}, results, &doubts, error));
  charts_doubts(store, &doubts, caption, size);
  uncertainty_doubts(&doubts, stderr);
  return STATUS_OK;
}

status quantity_tell_doubts(struct store *store, const char *quantities, struct error *error) {
  char caption[CHARTS_LABEL] = "";
  return add_doubts(store, quantities, caption, sizeof caption, error);
}

status quantity_no_values(struct store *store, const char *quantity, struct error *error) {
  char results[ASK_DOUBTS_RESULTS], words[256] = "";
  struct ask_doubts doubts = {0};
  TRY(ask_doubts_results(store, quantity, results, error));
  TRY(ask_doubts(store, &(struct ask_doubts_choice){0}, results, &doubts, error));
  for (size_t k = 0; k < doubts.count; k++)
    if (doubts.word[k].row && doubts.word[k].row->withheld && !condition_has(words, doubts.word[k].word))
      text_append(words, sizeof words, "%s%s", *words ? ", " : "", doubts.word[k].word);
  if (doubts.withheld == 0)
    return status_fail(error, STATUS_USAGE, "no finished run has a value of %s", quantity);
  return status_fail(error, STATUS_USAGE, "no run has a value of %s: it is withheld in %lld of %lld runs (%s)",
                     quantity, (long long)doubts.withheld, (long long)doubts.runs, words);
}

status quantity_tell_idle(struct store *store, struct error *error) {
  char idle[ASK_GROUP_POOLED];
  TRY(ask_group_idle(store, idle, error));
  if (*idle)
    words_print(stderr, "",
                "clast: no effect in these runs: %s (runs that differ in it alone have the same results, to the last "
                "bit). Where points are pooled over it and others, copies count as points of their own, and the "
                "interval is too narrow: --where chooses one value",
                idle);
  return STATUS_OK;
}

void quantity_tell_shared(struct store *store, const struct ask_group_pooled *pooled) {
  const int64_t levels = *pooled->inputs ? ask_campaign_levels(store) : 0;
  if (levels > 0)
    fprintf(stderr,
            "clast: %" PRId64 " of these points are of studies and searches: `clast estimates` tells each point\n",
            levels);
  if (pooled->lacks_seeds)
    words_print(stderr, "",
                "clast: points share seeds: what a seed changes at all of them alike is not in the interval (that of a "
                "mean has it if every point has two seeds or more; `independent: true` gives each point its own)");
}

void quantity_tell_resolution(struct store *store, const char *name, const struct ask_group_pooled *pooled) {
  struct ask_resolution resolution;
  char text[UNCERTAINTY_TEXT];
  if (ask_resolution(store, 0, name, &resolution, NULL))
    return;
  uncertainty_resolution(&resolution, text);
  fprintf(stderr, "clast: %s: intervals are over %s (95 %%%s); %s\n", name,
          !pooled || !*pooled->inputs ? "seeds"
          : pooled->single            ? "points and seeds, of one point over seeds"
                                      : "points and seeds",
          views_range(name).share ? "" : "; none where all are equal to 14 digits", text);
}

void quantity_tell_resolutions(struct store *store, const char *names, const struct ask_group_pooled *pooled) {
  char name[128];
  if (strcmp(names, "main") == 0)
    names = OUTCOME_DEFAULT;
  while (*names) {
    names = text_next_item(names, name, sizeof name);
    for (char *dot = name; (dot = strchr(dot, '.'));) /* a column's name has none */
      *dot = '_';
    quantity_tell_resolution(store, name, pooled);
  }
}

/* "0.02 m/s", "5 %": an error, or its share of a mean. */
static void show_error(double error, bool of_value, const char *unit, char *text, size_t size) {
  const double number = of_value ? 100 * error : error;
  if (isinf(number)) { /* a share of the mean 0 */
    snprintf(text, size, "no share of its mean, which is 0");
    return;
  }
  snprintf(text, size, of_value && number >= 99.5 ? "%.0f%s%s" : "%.3g%s%s", number, *unit && !of_value ? " " : "",
           of_value ? " %" : unit);
}

status quantity_tell_accuracy(struct store *store, const char *name, const char *unit, double within, bool of_value,
                              struct error *error) {
  struct ask_column axes[LIMITS_AXES_OF_POOL];
  struct ask_group_pooled pooled;
  char by[LIMITS_AXES_OF_POOL * sizeof axes->name] = "", allowed[64], widest[64], where[400] = "", told[160];
  size_t count;
  int64_t points = 0, kept = 0, not_studied = 0, open = 0;
  double largest = -1;
  TRY(ask_columns_axes(store, true, LIMITS_AXES_OF_POOL, axes, &count, error));
  for (size_t i = 0; i < count; i++)
    text_append(by, sizeof by, "%s%s", i ? "," : "", axes[i].name);
  ANSWER groups = ask_group(store, by, name, &pooled, error);
  while (answer_next(&groups)) {
    const double mean = answer_real(&groups, count + MEAN), resolution = answer_real(&groups, count + RESOLUTION);
    const double spread = fmax(answer_real(&groups, count + HALF_WIDTH),
                               fmax(answer_real(&groups, count + HIGH) - mean,
                                    mean - answer_real(&groups, count + LOW)));
    if (isnan(mean) || answer_integer(&groups, count + RUNS) < 2)
      continue;
    const double total = (isnan(spread) ? 0 : spread) + (isnan(resolution) ? 0 : resolution); /* NaN: equal runs */
    const double compared = !of_value ? total : total > 0 ? total / fabs(mean) : 0;
    points++;
    not_studied += isnan(resolution);
    const enum ask_resolution_verdict verdict = ask_resolution_verdict(answer_text(&groups, count + VERDICT));
    open += verdict == ASK_RESOLUTION_AT_LEAST || verdict == ASK_RESOLUTION_DIVERGES;
    kept += compared <= within;
    if (!(compared > largest))
      continue;
    largest = compared;
    *where = '\0';
    for (size_t i = 0; i < count; i++) {
      const struct query_value raw = answer_value(&groups, i), value = ask_columns_value(&axes[i], &raw);
      if (value.kind == QUERY_TEXT)
        text_append(where, sizeof where, "%s%s %s", *where ? ", " : "", axes[i].word, value.text);
      else if (value.kind != QUERY_NULL)
        text_append(where, sizeof where, "%s%s %.4g%s%s", *where ? ", " : "", axes[i].word, value.real,
                    strcmp(axes[i].unit, "1") != 0 && *axes[i].unit ? " " : "",
                    strcmp(axes[i].unit, "1") != 0 ? axes[i].unit : "");
    }
  }
  TRY(answer_end(&groups));
  if (points == 0)
    return STATUS_OK;
  show_error(within, of_value, unit, allowed, sizeof allowed);
  show_error(largest, of_value, unit, widest, sizeof widest);
  snprintf(told, sizeof told, "%" PRId64 " point%s judged", points, text_plural(points));
  if (!isnan(within))
    snprintf(told, sizeof told, "%" PRId64 " of %" PRId64 " point%s within %s%s", kept, points,
             points == 1 ? " is" : "s are", allowed, of_value ? " of the mean" : "");
  words_print(stderr, "", "clast: accuracy: %s by %s; the largest error is %s%s%s%s%s%s", told,
              not_studied == points ? "the interval over seeds alone (no point was studied)"
                                    : "interval over seeds and error of the resolution together",
              widest, *where ? " (" : "", where, *where ? ")" : "",
              not_studied && not_studied < points ? "; points whose resolution was not studied count with seeds alone"
                                                  : "",
              kept < points && !isnan(within)
                  ? ". `clast plan` counts these runs, too: the same command again takes more seeds, or says why not"
                  : "");
  if (open > 0)
    words_print(stderr, "",
                "clast: accuracy: no limit is seen at %" PRId64 " of them, so that their error may be larger than that",
                open);
  return STATUS_OK;
}

/* How the values of a chart were made: "mean over seeds and ...". */
static void made_of(const struct quantity *quantity, char *text, size_t size) {
  char pooled[ASK_GROUP_POOLED];
  charts_labels(quantity->pooled.inputs, pooled, sizeof pooled);
  snprintf(text, size, "%s%s%s",
           quantity->exponent ? "fit to all runs of a point"
           : quantity->seeds  ? "mean over seeds"
           : *pooled          ? "mean"
                              : "one run a point",
           !*pooled                  ? ""
           : quantity->pooled.single ? " and, of several points, "
           : quantity->seeds         ? " and "
                                     : " over ",
           pooled);
}

/* Keeps of the pooled inputs what holds for the rows that are drawn: on an axis of numbers, those of one scene can be
 * single points where others pool. */
static void keep_drawn(struct quantity *quantity, size_t axes) {
  bool several = false;
  quantity->pooled.single = false;
  for (size_t r = 0; r < quantity->count; r++) {
    const struct row *row = &quantity->row[r];
    bool drawn = isfinite(row->value);
    for (size_t i = 0; i < axes; i++)
      drawn = drawn && (!isnan(row->input[i]) || (axes == 1 && *row->text[i]));
    several |= drawn && row->points > 1;
    quantity->pooled.single |= drawn && row->points < 2;
  }
  if (!several)
    quantity->pooled.inputs[0] = '\0';
}

/* Fails if tables show none of the exponents. */
static status check_told(const struct quantity *quantity, struct error *error) {
  for (size_t i = 0; i < quantity->count; i++)
    if (isfinite(quantity->row[i].value))
      return STATUS_OK;
  if (!*quantity->untold)
    return STATUS_OK;
  return status_fail(error, STATUS_USAGE, "no point has an exponent to draw: %s", quantity->untold);
}

/* Exponents of several points at one place of a chart are not averaged: names the place and the input that tells the
 * points apart, by the words to type. most: inputs that the chart can have. */
static status several_points(const struct quantity *quantity, const struct row *row, size_t most, struct error *error) {
  char place[600] = "", apart[sizeof quantity->apart];
  const char *word = quantity->apart;
  for (size_t i = 0; i < quantity->axes; i++) {
    const struct ask_column *unit = quantity->unit[i];
    text_append(place, sizeof place, "%s%s = %s", i ? ", " : "", unit ? unit->word : quantity->column[i],
                *row->text[i] ? row->text[i] : "none");
    if (unit && *unit->unit && strcmp(unit->unit, "1") != 0)
      text_append(place, sizeof place, " %s", unit->unit);
  }
  field_column_name(word, apart, sizeof apart);
  for (size_t i = 0; i < quantity->written_count; i++)
    if (strcmp(quantity->written[i].name, apart) == 0)
      word = quantity->written[i].word;
  return status_fail(error, STATUS_USAGE, "several points have %s, and their exponents are not averaged: %s%s", place,
                     quantity->axes < most && *word ? "separate them by --by " : "choose one of them by --where",
                     quantity->axes < most ? word : "");
}

/* ---- lines ---- */

struct line {
  const struct row *first; /* has the value of the input that has one line for each value, and the results_version;
                              results of different versions are different lines, never mixed */
  char label[2 * CHARTS_LABEL];
  struct picture_mean *means; /* owned; room for MOST_MEANS */
  size_t count;
};

struct plot {
  struct quantity quantity;
  const char *place[MOST_PLACES];     /* the words of an axis that has no numbers */
  char name[MOST_PLACES][INPUT_TEXT]; /* the same as a picture shows them */
  size_t places;
  struct line line[MOST_LINES];
  size_t count;
};

static void release_plot(struct plot *plot) {
  for (size_t i = 0; i < plot->count; i++)
    free(plot->line[i].means);
  release(&plot->quantity);
}

/* Finds the line of this row, or makes it. Lines of numbers are in their order; others come as the rows do. */
static status find_line(struct plot *plot, const struct row *row, struct line **found, struct error *error) {
  for (size_t i = 0; i < plot->count; i++) {
    *found = &plot->line[i];
    if (strcmp((*found)->first->text[1], row->text[1]) == 0 && (*found)->first->version == row->version)
      return STATUS_OK;
  }
  if (plot->count == MOST_LINES)
    return status_fail(error, STATUS_USAGE, "a chart has at most %d lines: choose a --by with fewer values",
                       MOST_LINES);
  size_t place = plot->count++;
  for (; place > 0 && row->input[1] < plot->line[place - 1].first->input[1]; place--)
    plot->line[place] = plot->line[place - 1];
  *found = &plot->line[place];
  **found = (struct line){.first = row, .means = memory_small(MOST_MEANS, sizeof *(*found)->means)};
  return STATUS_OK;
}

/* Finds the place of a word on the axis, or makes it. */
static status find_place(struct plot *plot, const char *text, double *x, struct error *error) {
  size_t place = 0;
  while (place < plot->places && strcmp(plot->place[place], text) != 0)
    place++;
  if (place == MOST_PLACES)
    return status_fail(error, STATUS_USAGE, "%s has more than %d values: give it to --by", plot->quantity.column[0],
                       MOST_PLACES);
  if (place == plot->places)
    plot->place[plot->places++] = text;
  *x = (double)place + 1;
  return STATUS_OK;
}

/* Words of the axis have the order of the points, which is that of the campaign. */
static status order_places(struct store *store, struct plot *plot, struct error *error) {
  const char *input = plot->quantity.column[0];
  bool words = false;
  double x;
  for (size_t i = 0; i < plot->quantity.count; i++)
    words |= isnan(plot->quantity.row[i].input[0]) && *plot->quantity.row[i].text[0];
  if (!words)
    return STATUS_OK;
  ANSWER points = ask_points_rows(store, true, 1, &input, error);
  for (struct ask_points_row point; ask_points_next(&points, &point);)
    for (size_t i = 0; point.inputs[0].kind == QUERY_TEXT && i < plot->quantity.count; i++) {
      const char *text = plot->quantity.row[i].text[0];
      if (isnan(plot->quantity.row[i].input[0]) && strncmp(text, point.inputs[0].text, INPUT_TEXT - 1) == 0)
        TRY(find_place(plot, text, &x, error));
    }
  return answer_end(&points);
}

/* "weak sandstone" of "weak sandstone - rock.yaml": the file stands in a name only where two rocks have the same. */
static void name_places(struct plot *plot) {
  for (size_t i = 0; i < plot->places; i++) {
    const char *text = plot->place[i], *file = NULL;
    for (const char *at = text; (at = strstr(at, " - ")); at++)
      file = strchr(at, '.') ? at : file;
    const size_t length = file ? (size_t)(file - text) : strlen(text);
    for (size_t k = 0; file && k < plot->places; k++)
      if (k != i && strncmp(plot->place[k], text, length) == 0 &&
          (!plot->place[k][length] || strncmp(plot->place[k] + length, " - ", 3) == 0))
        file = NULL;
    snprintf(plot->name[i], INPUT_TEXT, "%.*s", file ? (int)length : INPUT_TEXT, text);
    plot->place[i] = plot->name[i];
  }
}

static status add_mean(struct plot *plot, const struct row *row, struct error *error) {
  double x = row->input[0];
  struct line *line = NULL;
  if (isnan(x) && *row->text[0])
    TRY(find_place(plot, row->text[0], &x, error));
  if (isnan(x))
    return STATUS_OK; /* off, or does not apply: an axis of numbers cannot show it */
  TRY(find_line(plot, row, &line, error));
  if (line->count == MOST_MEANS)
    return status_fail(error, STATUS_USAGE, "a line has at most %d points: choose an axis with fewer values",
                       MOST_MEANS);
  for (size_t i = 0; plot->quantity.exponent && i < line->count; i++)
    if (line->means[i].x == x)
      return several_points(&plot->quantity, row, 2, error);
  line->means[line->count++] = (struct picture_mean){x,          row->value,      row->lower,
                                                     row->upper, row->resolution, row->doubtful};
  return STATUS_OK;
}

/* "weibull_k (1/m^3) = 5e+34"; the version is given only if there are several. */
static void label_lines(struct plot *plot, const char *by) {
  bool several = false;
  for (size_t i = 1; i < plot->count; i++)
    several |= plot->line[i].first->version != plot->line[0].first->version;
  const bool two = plot->quantity.axes == 2;
  for (size_t i = 0; i < plot->count; i++) {
    struct line *line = &plot->line[i];
    const char *value = line->first->text[1];
    char version[40] = "", input[sizeof line->label - sizeof version] = "";
    if (two)
      snprintf(input, sizeof input, *value ? "%s = %s" : "%s: none", by, value);
    if (several)
      snprintf(version, sizeof version, "%sresults_version %lld", two ? ", " : "", (long long)line->first->version);
    snprintf(line->label, sizeof line->label, "%s%s", input, version);
    qsort(line->means, line->count, sizeof *line->means, sample_ascending); /* by x, which comes first */
  }
}

/* In a caption and on stderr: from point to point other inputs change, too, as in a sample or in two campaigns. */
static void tell_changing(const struct quantity *quantity, const char *drawn, char *caption, size_t size) {
  char sentence[ASK_GROUP_POOLED + 100];
  charts_labels(quantity->changing, sentence, sizeof sentence);
  text_append(caption, size, "; from point to point %s changes, too", sentence);
  fprintf(stderr, "clast: %sfrom one to the next %s changes, too; `clast sensitivity` ranks the inputs\n", drawn,
          sentence);
}

/* Why no value has an interval. */
static const char *no_interval(const struct quantity *quantity) {
  return quantity->exponent ? "too few runs or fragments" : "no point has two runs that differ";
}

/* Takes the rows of a quantity as lines and draws them. */
static status draw_lines(struct store *store, struct plot *plot, const struct picture_page *page, struct error *error) {
  const struct quantity *quantity = &plot->quantity;
  keep_drawn(&plot->quantity, 1);
  TRY(order_places(store, plot, error));
  for (size_t i = 0; i < quantity->count; i++)
    TRY(add_mean(plot, &quantity->row[i], error));
  TRY(check_told(quantity, error));
  char x[CHARTS_LABEL], by[CHARTS_LABEL] = "", y[CHARTS_LABEL], name[CHARTS_LABEL], over[CHARTS_LABEL];
  char title[ASK_GROUP_POOLED + 5 * CHARTS_LABEL], caption[1200], intervals[600], resolution[400];
  char made[ASK_GROUP_POOLED + 60], scene[CHARTS_LABEL];
  TRY(charts_scene(store, scene, error));
  TRY(charts_axis(store, quantity->column[0], x, error));
  if (quantity->axes == 2)
    TRY(charts_axis(store, quantity->column[1], by, error));
  TRY(charts_axis(store, quantity->name, y, error));
  label_lines(plot, by);
  name_places(plot);
  struct picture_curve curves[MOST_LINES] = {0};
  const struct sample_range range = views_range(quantity->name);
  for (size_t i = 0; i < plot->count; i++) {
    curves[i].label = *plot->line[i].label ? plot->line[i].label : NULL;
    curves[i].count = plot->line[i].count;
    curves[i].places = plot->places;
    curves[i].place = plot->place;
    curves[i].mean = plot->line[i].means;
    curves[i].scattered = *quantity->changing;
    curves[i].range = &range;
  }
  charts_label(quantity->name, name);
  charts_label(quantity->column[0], over);
  made_of(quantity, made, sizeof made);
  snprintf(title, sizeof title, "%s over %s%s: %s", name, over, scene, made);
  if (*title >= 'a' && *title <= 'z')
    *title = (char)(*title - 'a' + 'A');
  charts_intervals(&quantity->pooled, intervals, sizeof intervals);
  charts_resolution(store, quantity->name, "; thin bars add what is known of it", resolution, sizeof resolution);
  size_t weak = 0, bars = 0;
  for (size_t i = 0; i < quantity->count; i++) {
    weak += quantity->row[i].weak && isfinite(quantity->row[i].value);
    bars += quantity->row[i].half_width > 0;
  }
  snprintf(caption, sizeof caption, "%s: %s; %s", bars ? "Error bars" : "No error bars",
           bars ? intervals : no_interval(quantity), resolution);
  if (weak > 0)
    text_append(caption, sizeof caption, "; %zu of the marks: %s", weak,
                quantity->exponent ? "no interval (clast explain weak)"
                                   : "a weak interval, too few runs (~ in tables)");
  if (*quantity->untold)
    text_append(caption, sizeof caption, "; no mark: %s", quantity->untold);
  if (*quantity->changing)
    tell_changing(quantity, plot->places ? "" : "no line joins the points: ", caption, sizeof caption);
  TRY(add_doubts(store, quantity->name, caption, sizeof caption, error));
  return picture_curves(page, &(struct picture_words){title, caption, x, y}, plot->count, curves, error);
}

status quantity_plot(struct store *store, const char *x, const char *by, const char *name,
                     const struct picture_page *page, struct error *error) {
  __attribute__((cleanup(release_plot))) struct plot plot = {0};
  struct ask_column axes[LIMITS_AXES_OF_TABLE];
  const char *inputs[AXES] = {x, by};
  TRY(choose_axes(store, &(struct axes_wanted){1, 2, MOST_LINES}, inputs, axes, error));
  TRY(read_quantity(store, inputs, name, false,
                    "a plot has one axis below (--x), at most one input that tells its lines apart (--by, another "
                    "one), and one quantity",
                    &plot.quantity, error));
  TRY(draw_lines(store, &plot, page, error));
  quantity_tell_resolution(store, plot.quantity.name, &plot.quantity.pooled);
  return STATUS_OK;
}

/* ---- tiles ---- */

/* The panels of a map, one for each value of the third input. */
struct panels {
  size_t count;
  char text[MOST_PANELS][CHARTS_LABEL + INPUT_TEXT];
};

/* An interval must not shrink by rounding. With a digit more than in tables, whose digits it rounds to. */
static double three_digits_up(double half_width) {
  const double last = pow(10, floor(log10(half_width)) - 2);
  return last * ceil(half_width / last * (1 - 1e-12));
}

static status draw_tiles(struct store *store, const struct quantity *quantity, size_t count,
                         const struct picture_tile *tile, const struct panels *panels, const struct row *widest,
                         const struct picture_page *page, struct error *error) {
  char x[CHARTS_LABEL], y[CHARTS_LABEL], z[CHARTS_LABEL], title[ASK_GROUP_POOLED + 3 * CHARTS_LABEL], caption[1200];
  char made[ASK_GROUP_POOLED + 60], intervals[600], resolution[400], scene[CHARTS_LABEL];
  const char *label[MOST_PANELS];
  for (size_t p = 0; p < panels->count; p++)
    label[p] = panels->text[p];
  TRY(charts_axis(store, quantity->column[0], x, error));
  TRY(charts_axis(store, quantity->column[1], y, error));
  TRY(charts_axis(store, quantity->name, z, error));
  TRY(charts_scene(store, scene, error));
  made_of(quantity, made, sizeof made);
  snprintf(title, sizeof title, "%s%s: %s", z, scene, made);
  title[0] = (char)toupper((unsigned char)title[0]);
  charts_intervals(&quantity->pooled, intervals, sizeof intervals);
  charts_resolution(store, quantity->name, "", resolution, sizeof resolution);
  char width[64] = "";
  if (widest && fabs(widest->upper + widest->lower - 2 * widest->value) > 1e-9 * (widest->upper - widest->lower))
    snprintf(width, sizeof width, "from %.3g to %.3g", widest->lower, widest->upper); /* it ends where the range does */
  else if (widest)
    snprintf(width, sizeof width, "\xc2\xb1 %.3g", three_digits_up(widest->half_width));
  if (widest)
    snprintf(caption, sizeof caption, "The widest of the %s is %s, `clast %s` has all; %s", intervals, width,
             quantity->exponent ? "estimates" : "stats", resolution);
  else
    snprintf(caption, sizeof caption, "No interval: %s; %s", no_interval(quantity), resolution);
  size_t weak = 0;
  for (size_t i = 0; i < count; i++)
    weak += tile[i].weak;
  if (weak > 0)
    text_append(caption, sizeof caption, "; ~, %zu of %zu: %s", weak, count,
                quantity->exponent ? "no interval (clast explain weak)" : "weak, too few runs");
  if (*quantity->untold)
    text_append(caption, sizeof caption, "; \xc3\x97: %s", quantity->untold);
  if (*quantity->changing)
    tell_changing(quantity, "", caption, sizeof caption);
  TRY(add_doubts(store, quantity->name, caption, sizeof caption, error));
  return picture_map(page, &(struct picture_words){title, caption, x, y}, z, count, tile, panels->count,
                     panels->count ? label : NULL, error);
}

/* Decimals of a value in tables, below -1: its digits, -1: three of them. */
static int decimals_of(const struct row *row, const struct sample_range *range) {
  char text[UNCERTAINTY_TEXT];
  if (!(row->half_width > 0))
    return row->decimals;
  if (!(row->half_width < 10))
    return -1;
  uncertainty_cell(row->value, row->half_width, range, text);
  text[strcspn(text, " ")] = '\0';
  const int decimals = strchr(text, '.') ? (int)strlen(strchr(text, '.') + 1) : 0;
  return text[0] == '(' ? -1 - decimals : decimals; /* (2.5 +- 0.1)e-05 */
}

/* The panel of a row; rows come in order of their inputs, so panels are in order of the third one. */
static status find_panel(struct store *store, const struct quantity *quantity, const struct row *row,
                         struct panels *panels, size_t *panel, struct error *error) {
  char by[CHARTS_LABEL], text[sizeof *panels->text];
  *panel = 0;
  if (quantity->axes < AXES)
    return STATUS_OK;
  TRY(charts_axis(store, quantity->column[2], by, error));
  snprintf(text, sizeof text, *row->text[2] ? "%s = %s" : "%s: none", by, row->text[2]);
  while (*panel < panels->count && strcmp(panels->text[*panel], text) != 0)
    (*panel)++;
  if (*panel == MOST_PANELS)
    return status_fail(error, STATUS_USAGE, "a map has at most %d panels: choose a --by with fewer values",
                       MOST_PANELS);
  if (*panel == panels->count)
    snprintf(panels->text[panels->count++], sizeof text, "%s", text);
  return STATUS_OK;
}

/* Makes a tile of each row that has two numbers, and draws them. */
static status make_tiles(struct store *store, const struct quantity *quantity, struct picture_tile *tile,
                         const struct picture_page *page, struct error *error) {
  const struct row *widest = NULL; /* the row with the widest interval; NULL: there is none */
  size_t count = 0;
  struct panels panels = {0};
  const struct sample_range range = views_range(quantity->name);
  for (size_t r = 0; r < quantity->count; r++) {
    const struct row *row = &quantity->row[r];
    size_t panel;
    if (isnan(row->input[0]) || isnan(row->input[1]))
      continue; /* off, or does not apply: an axis of numbers cannot show it */
    TRY(find_panel(store, quantity, row, &panels, &panel, error));
    for (size_t i = 0; quantity->exponent && i < count; i++)
      if (tile[i].x == row->input[0] && tile[i].y == row->input[1] && tile[i].panel == panel)
        return several_points(quantity, row, AXES, error);
    tile[count++] = (struct picture_tile){.x = row->input[0],
                                          .y = row->input[1],
                                          .value = row->value,
                                          .doubtful = row->doubtful,
                                          .weak = row->weak && isfinite(row->value),
                                          .decimals = decimals_of(row, &range),
                                          .panel = panel};
    if (isfinite(row->value) && row->half_width > 0 &&
        (!widest || row->upper - row->lower > widest->upper - widest->lower))
      widest = row;
  }
  TRY(check_told(quantity, error));
  return draw_tiles(store, quantity, count, tile, &panels, widest, page, error);
}

/* An axis of words alone, such as names of materials, has no place on a map. */
static status check_numbers(const struct quantity *quantity, const char *const inputs[AXES], struct error *error) {
  for (size_t i = 0; i < 2; i++) {
    size_t words = 0;
    for (size_t r = 0; r < quantity->count; r++)
      words += isnan(quantity->row[r].input[i]) && *quantity->row[r].text[i];
    if (words > 0 && words == quantity->count)
      return status_fail(
          error, STATUS_USAGE,
          "the values of %s are words, and both axes of a map have numbers: `clast plot` draws words, with "
          "-x %s --by %s",
          inputs[i], inputs[i], inputs[1 - i]);
  }
  return STATUS_OK;
}

status quantity_map(struct store *store, const char *x, const char *y, const char *by, const char *name,
                    const struct picture_page *page, struct error *error) {
  __attribute__((cleanup(release))) struct quantity quantity = {0};
  OWNED struct picture_tile *tile = NULL;
  struct ask_column axes[LIMITS_AXES_OF_TABLE];
  const char *inputs[AXES] = {x, y, by};
  TRY(choose_axes(store, &(struct axes_wanted){2, AXES, MOST_PANELS}, inputs, axes, error));
  TRY(read_quantity(store, inputs, name, true,
                    "a map needs two different inputs (--x, --y), at most a third one (--by) and one quantity",
                    &quantity, error));
  TRY(check_numbers(&quantity, inputs, error));
  keep_drawn(&quantity, 2);
  TRY(memory_array(&tile, quantity.count, sizeof *tile, "the map", error));
  TRY(make_tiles(store, &quantity, tile, page, error));
  quantity_tell_resolution(store, quantity.name, &quantity.pooled);
  return STATUS_OK;
}
