/* A study of convergence as tables, as rows for programs, and as pictures. */
#include "campaign/converge/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/charts/charts.h"
#include "campaign/terminal/uncertainty.h"
#include "schemas/limits.h"
#include "schemas/memory.h"

status study_print_knobs(enum table_format format, struct error *error) {
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"engine", "knob", "group", "input", "meaning", NULL});
  for (size_t i = 0; i < engine_count(); i++)
    for (const struct knob *knob = engine_at(i)->knobs; knob && knob->name; knob++) {
      table_text(table, engine_at(i)->name);
      table_text(table, knob->name);
      table_text(table, engine_knob_groups[knob->group]);
      table_text(table, knob->inputs[0].path ? knob->inputs[0].path : "");
      table_text(table, knob->meaning);
    }
  return table_end(table, error);
}

/* What the study prints, and the store of its runs. */
struct printing {
  const struct study *study;
  struct store *store;
  struct ask_doubts sum; /* of all levels */
};

/* Of the runs of a level. */
static status read_doubts(struct printing *printing, const struct study_ladder *ladder, size_t level, size_t quantity,
                          struct ask_doubts *doubts, struct error *error) {
  const struct study *study = printing->study;
  const long long first = study->limits.first_seed;
  char results[ASK_DOUBTS_RESULTS], where[80];
  snprintf(where, sizeof where, "seed BETWEEN %lld AND %lld", first, first + (long long)study->rule.most_seeds - 1);
  const struct ask_doubts_choice choice = {.point = ladder->point[level], .where = where};
  *doubts = (struct ask_doubts){0};
  TRY(ask_doubts_results(printing->store, study->quantity[quantity].name, results, error));
  TRY(ask_doubts(printing->store, &choice, results, doubts, error));
  ask_doubts_add(&printing->sum, doubts);
  return STATUS_OK;
}

static void print_level(struct table *table, const struct convergence_row *row, const struct ask_doubts *doubts) {
  char setting[80];
  if (row->n == 0)
    return; /* left out by the budget, or every run failed: print_limit names it */
  snprintf(setting, sizeof setting, "%.64s%s%s", row->setting, row->base ? " *" : "", row->reference ? " ref" : "");
  table_text(table, row->knob);
  table_text(table, setting);
  table_integer(table, row->n);
  table_rests_on(table, doubts);
  table_real(table, row->mean);
  table_real(table, row->half_width);
  table_real(table, row->deviation);
  table_real(table, row->skew);
  table_real(table, row->upper_mode);
  table_real(table, row->cpu);
  table_rests_on(table, doubts);
  table_real(table, row->bias);
  table_real(table, row->bias_half_width);
  table_real(table, row->correlation);
  table_real(table, row->correlation_low);
  table_real(table, row->correlation_high);
  table_real(table, row->break_even);
  table_real(table, row->error);
  table_text(table, row->frontier ? "yes" : "");
}

/* The conclusion from the levels of a knob, and the reason why it has no more runs. */
static void print_limit(const struct study_ladder *ladder, const struct study_found *found) {
  const struct convergence_limit_row *limit = &found->limit;
  printf("%s: ", limit->knob);
  if (!isnan(found->rows[0].step)) {
    switch ((enum convergence_verdict)limit->verdict) {
    case CONVERGENCE_ORDER:
      printf("order %.2g (%.2g to %.2g), limit %.5g (%.5g to %.5g); ", limit->order, limit->order_low,
             limit->order_high, limit->limit, limit->limit_low, limit->limit_high);
      break;
    case CONVERGENCE_NO_ORDER: printf("no order: differences do not shrink, no limit is in sight; "); break;
    case CONVERGENCE_UNCHANGED: printf("the two finest levels do not differ as far as these seeds tell; "); break;
    case CONVERGENCE_UNSURE: printf("no order yet: more seeds are needed to tell whether differences shrink; "); break;
    case CONVERGENCE_TOO_FEW:
    case CONVERGENCE_VERDICTS: printf("no order: it needs three levels and three seeds; "); break;
    }
  }
  printf("ended: %s", ladder->end);
  const char *before = "; without";
  for (size_t l = 0; l < found->count; l++)
    if (found->rows[l].n == 0) {
      printf("%s %s", before, found->rows[l].setting);
      before = ",";
    }
  putchar('\n');
}

/* Prints whether a cheaper level would save runs of a finer one. Levels that do not differ from the reference are
 * skipped, because the cheaper level can replace the reference. */
static void print_gain(size_t count, const struct study_found *found) {
  const double worth_it = 1.5; /* below this gain the estimator is not worth its effort */
  const struct convergence_row *best = NULL;
  double most = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      const struct convergence_row *row = &found[i].rows[l];
      const double gain = convergence_gain(row->correlation_low, row->cost_ratio);
      if (fabs(row->bias) > row->bias_half_width && gain > most) {
        best = row;
        most = gain;
      }
    }
  if (!best)
    puts("control variates: no level that differs from its reference has a known correlation with the next finer one");
  else
    printf("control variates: %s; the best is %s = %s, gain %.2g with its next finer level (at least %.2g)\n",
           most >= worth_it ? "a pair of levels would save time"
                            : "no pair of levels is sure to gain 1.5, so that plain "
                              "runs are the better use of time",
           best->knob, best->setting, best->gain, most);
}

static status print_quantity(struct printing *printing, size_t from, size_t quantity, size_t count,
                             const struct study_found *found, struct error *error) {
  const struct study *study = printing->study;
  const struct study_quantity *what = &study->quantity[quantity];
  const char *unit = what->row ? what->row->unit : NULL;
  const bool named = unit && strcmp(unit, "1") != 0;
  printf("%s%s, quantity %s%s%s%s\n", from || quantity ? "\n" : "", study->ladder[from].base->name, what->name,
         named ? " (" : "", named ? unit : "", named ? ")" : "");
  TABLE table = table_new(TABLE_TEXT, stdout);
  table_columns(table, (const char *const[]){"knob", "level", "n", "mean", "hw95", "sd", "skew", "upper_mode", "cpu_s",
                                             "bias", "bias_hw95", "corr", "corr_low", "corr_high", "break_even",
                                             "error", "frontier", NULL});
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      struct ask_doubts doubts;
      TRY(read_doubts(printing, &study->ladder[from + i], l, quantity, &doubts, error));
      print_level(table, &found[i].rows[l], &doubts);
    }
  TRY(table_end(table, error));
  for (size_t i = 0; i < count; i++)
    print_limit(&study->ladder[from + i], &found[i]);
  print_gain(count, found);
  return STATUS_OK;
}

static status print_rows(struct printing *printing, size_t from, size_t quantity, size_t count,
                         const struct study_found *found, struct table *table, struct error *error) {
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      struct ask_doubts doubts;
      TRY(read_doubts(printing, &printing->study->ladder[from + i], l, quantity, &doubts, error));
      for (size_t c = 0; c < convergence_table.count; c++) {
        const struct field *row = &convergence_table.rows[c];
        struct field_value value;
        field_get(row, &found[i].rows[l], &value);
        if (row->kind == FIELD_TEXT)
          table_text(table, value.text);
        else if (row->kind == FIELD_INTEGER)
          table_integer(table, value.integer);
        else if (row->kind == FIELD_BOOLEAN)
          table_boolean(table, value.number != 0);
        else
          table_real(table, value.number);
      }
      table_doubt_cells(table, &doubts);
    }
  return STATUS_OK;
}

static const char legend[] =
    "* the scene's own setting; ref: what bias is measured against. bias: mean less that of ref, with the half width\n"
    "of its 95 % interval. error: distance to the limit (without one |bias| + half width, which may be too small),\n"
    "and those of the other knobs of group resolution at *. frontier: no level is both cheaper and nearer. corr: with\n"
    "the next finer level; a control variate would save time from break_even on. upper_mode: share of the runs in the\n"
    "upper of two modes.\n";

status study_print(const struct study *study, enum table_format format, bool quiet, struct error *error) {
  OWNED struct study_found *found = malloc(LIMITS_STUDY_KNOBS * sizeof *found);
  if (!found)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  STORE store = NULL;
  TRY(store_open_reader(study->limits.store, &store, error));
  struct printing printing = {.study = study, .store = store};
  TABLE table = format == TABLE_TEXT ? NULL : table_new(format, stdout);
  for (size_t c = 0; table && c < convergence_table.count; c++)
    table_column(table, convergence_table.rows[c].path, convergence_table.rows[c].unit);
  if (table)
    table_doubt_columns(table);
  for (size_t from = 0, count = 0; from < study->ladder_count; from += count)
    for (size_t q = 0; q < study->quantity_count; q++) {
      count = study_of_scene(study, from, q, found);
      TRY(table ? print_rows(&printing, from, q, count, found, table, error)
                : print_quantity(&printing, from, q, count, found, error));
    }
  if (table)
    return table_end(table, error);
  fflush(stdout);
  uncertainty_doubts(&printing.sum, stderr);
  if (!quiet)
    fputs(legend, stderr);
  return STATUS_OK;
}

/* ---- pictures: results over cost, and the error over cost with the frontier ---- */

enum { CURVES = PICTURE_SERIES, MARKS = LIMITS_STUDY_KNOBS * KNOB_LEVELS };

struct drawing {
  struct study_found found[LIMITS_STUDY_KNOBS];
  struct picture_mean means[CURVES][MARKS];
  struct picture_curve curves[CURVES];
  size_t count;
  bool doubtful[LIMITS_STUDY_KNOBS][KNOB_LEVELS];
};

/* Adds a mark of the level to the last curve, in order of cost. */
static void add_mark(struct drawing *drawing, const struct convergence_row *row, bool of_errors, bool doubtful) {
  struct picture_mean *means = drawing->means[drawing->count];
  struct picture_curve *curve = &drawing->curves[drawing->count];
  const struct picture_mean mark = of_errors ? (struct picture_mean){row->cpu, row->error, NAN, NAN, NAN, doubtful}
                                             : (struct picture_mean){row->cpu,
                                                                     row->mean,
                                                                     row->mean - row->half_width,
                                                                     row->mean + row->half_width,
                                                                     NAN,
                                                                     doubtful};
  if (!isfinite(mark.x) || !isfinite(mark.y) || curve->count == MARKS)
    return;
  size_t place = curve->count++;
  for (; place > 0 && means[place - 1].x > mark.x; place--)
    means[place] = means[place - 1];
  means[place] = mark;
}

/* A curve of the levels of some knobs; with `frontier` only of those on it. */
static void add_curve(struct drawing *drawing, const char *label, size_t from, size_t knobs, bool of_errors,
                      bool frontier) {
  const struct study_found *found = drawing->found;
  drawing->curves[drawing->count] = (struct picture_curve){.label = label, .mean = drawing->means[drawing->count]};
  for (size_t i = from; i < from + knobs; i++)
    for (size_t l = 0; l < found[i].count; l++)
      if (!frontier || found[i].rows[l].frontier)
        add_mark(drawing, &found[i].rows[l], of_errors, drawing->doubtful[i][l]);
  drawing->count += drawing->curves[drawing->count].count > 0;
}

status study_print_picture(const struct study *study, bool of_errors, const char *path, struct error *error) {
  struct drawing *drawing = calloc(1, sizeof *drawing);
  if (!drawing)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  const size_t knobs = study_of_scene(study, 0, 0, drawing->found);
  struct printing printing = {.study = study};
  status code = store_open_reader(study->limits.store, &printing.store, error);
  for (size_t i = 0; i < knobs; i++)
    for (size_t l = 0; l < drawing->found[i].count && code == STATUS_OK; l++) {
      struct ask_doubts doubts;
      code = read_doubts(&printing, &study->ladder[i], l, 0, &doubts, error);
      drawing->doubtful[i][l] = doubts.doubtful > 0;
    }
  store_close(printing.store, NULL);
  if (code != STATUS_OK) {
    free(drawing);
    return code;
  }
  if (of_errors)
    add_curve(drawing, "frontier: no level is both cheaper and nearer", 0, knobs, true, true);
  for (size_t i = 0; i < knobs && drawing->count < CURVES; i++)
    add_curve(drawing, drawing->found[i].limit.knob, i, 1, of_errors, false);

  char title[800], quantity[CHARTS_LABEL], y[CHARTS_LABEL + 16];
  charts_label(study->quantity[0].name, quantity);
  snprintf(y, sizeof y, "%s%s", of_errors ? "error of " : "", quantity);
  snprintf(title, sizeof title, "%s: %s over the cost of a run", study->ladder[0].base->name, y);
  const struct picture_page page = charts_page(path, NULL);
  char caption[CHARTS_LABEL];
  snprintf(caption, sizeof caption, "A mark is a level of a knob: %s",
           of_errors ? "how far finer settings may move the mean, all knobs together"
                     : "mean over seeds with its 95 % interval");
  charts_doubts(&printing.sum, caption, sizeof caption);
  const struct picture_words words = {title, caption, "processor time of a run (s)", y};
  code = picture_curves(&page, &words, drawing->count, drawing->curves, error);
  free(drawing);
  return code;
}
