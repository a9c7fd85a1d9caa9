/* A study of convergence as tables, as rows for programs, and as pictures. */
#include "campaign/converge/study.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/charts/charts.h"
#include "campaign/terminal/words.h"
#include "db/store/views.h"
#include "schemas/memory.h"

/* Has the knob levels in the scene? Else prints why not. */
static bool applies(const struct knob *knob, const struct scene *scene) {
  struct ladder levels;
  struct error why;
  OWNED char *notes = NULL;
  if (scene && ladder_make(knob, scene, NULL, &levels, &notes, &why) != STATUS_OK) {
    words_print(stderr, "", "clast: not in this scene: %s", why.message);
    return false;
  }
  if (scene)
    ladder_clear(&levels);
  return true;
}

status study_print_knobs(const struct scene *scene, enum table_format format, struct error *error) {
  const struct engine_kind *kind = scene ? scene->kind : NULL;
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"engine", "knob", "group", "input", "meaning", NULL});
  for (size_t i = 0; i < (kind ? 1 : engine_count()); i++) {
    const struct engine_kind *of = kind ? kind : engine_at(i);
    for (const struct knob *knob = of->knobs; knob && knob->name; knob++) {
      if (!applies(knob, scene))
        continue;
      table_text(table, of->name);
      table_text(table, knob->name);
      table_text(table, engine_knob_groups[knob->group]);
      table_text(table, knob->inputs[0].path ? knob->inputs[0].path : "");
      table_text(table, knob->meaning);
    }
  }
  return table_end(table, error);
}

/* What the study prints, and the store of its runs. */
/* Below the tables for people: a sentence for each column that they show. */
static const struct {
  const char *column; /* NULL: always shown */
  const char *text;
} legend[] = {
    {NULL, "knob: the setting that is changed. *: the scene's own level; a knob's levels are compared with the seeds "
           "that all of them have, so that n and mean of * differ between knobs."},
    {"bias", "ref: what bias is measured against. bias: mean minus that of ref, with the half width of its 95 % "
             "interval."},
    {"error",
     "error: how far finer settings may move the mean, summed over all knobs of group resolution, as in `clast "
     "estimates` and `clast plan`; other knobs than that of the row are at *. A knob leaves its largest "
     "distance to the limit by the law of all seeds, which is not this mean minus the limit (none seen: |bias| "
     "+ half width, which is no bound: >=). No difference seen: runs of equal seed are equal at all levels, which adds "
     "nothing; how many other runs may differ is part of the interval over seeds."},
    {"frontier",
     "best: no other studied level of the scene has as small an error for less time, or a smaller one for as little; "
     ">= counts as its number."},
};
enum { LEGEND = sizeof legend / sizeof legend[0] };

struct printing {
  enum table_format format;
  const struct study *study;
  struct store *store;
  bool hidden[LEGEND]; /* columns that the last table left out */
  bool compared;       /* a table was printed */
};

/* Of the runs at the points `in` (ids, comma-separated) with the seeds of the study. */
static status doubts_of(const struct printing *printing, const char *in, const char *quantities,
                        struct ask_doubts *doubts, struct error *error) {
  const struct study *study = printing->study;
  const long long first = study->limits.first_seed, last = first + (long long)study->rule.most_seeds - 1;
  OWNED char *where = NULL;
  char results[ASK_DOUBTS_RESULTS];
  FILE *text = text_open(&where);
  fprintf(text, "point_id IN (%s) AND seed BETWEEN %lld AND %lld", in, first, last);
  text_close_small(text, &where);
  *doubts = (struct ask_doubts){0};
  TRY(ask_doubts_results(printing->store, quantities, results, error));
  return ask_doubts(printing->store, &(struct ask_doubts_choice){.where = where}, results, doubts, error);
}

/* Of the runs of a level. */
static status read_doubts(const struct printing *printing, const struct study_ladder *ladder, size_t level,
                          size_t quantity, struct ask_doubts *doubts, struct error *error) {
  char point[24];
  snprintf(point, sizeof point, "%lld", (long long)ladder->point[level]);
  return doubts_of(printing, point, printing->study->quantity[quantity].name, doubts, error);
}

/* Of the runs of all levels of the first ladders, for the first quantities. A run of several ladders counts once. */
static status sum_doubts(const struct printing *printing, size_t ladders, size_t quantities, struct ask_doubts *sum,
                         struct error *error) {
  const struct study *study = printing->study;
  OWNED char *points = NULL;
  char names[ASK_DOUBTS_RESULTS] = "";
  FILE *text = text_open(&points);
  for (size_t i = 0; i < ladders; i++)
    for (size_t l = 0; l < study->ladder[i].levels.count; l++)
      fprintf(text, "%s%lld", i || l ? "," : "", (long long)study->ladder[i].point[l]);
  text_close_small(text, &points);
  for (size_t q = 0; q < quantities; q++)
    text_append(names, sizeof names, "%s%s", q ? "," : "", study->quantity[q].name);
  return doubts_of(printing, points, names, sum, error);
}

char *study_show_setting(const struct engine_kind *kind, const struct knob *knob, const char *setting,
                         char text[STUDY_SETTING]) {
  char *end, unit[64];
  const double number = strtod(setting, &end);
  const char *path = knob ? knob->inputs[0].path : NULL;
  const struct field *row = path ? field_find(kind->inputs, path, NULL) : NULL;
  if (*end || end == setting || !row) {
    snprintf(text, STUDY_SETTING, "%.64s", setting);
    return text;
  }
  field_label_unit(row->unit, unit, sizeof unit);
  snprintf(text, STUDY_SETTING, number >= 1e6 ? "%.0f%s%s" : "%.6g%s%s", number, *unit ? " " : "", unit);
  return text;
}

/* The setting of a level of a ladder. */
static char *show_level(const struct study_ladder *ladder, const struct convergence_row *row,
                        char text[STUDY_SETTING]) {
  return study_show_setting(ladder->base->kind, ladder->levels.knob, row->setting, text);
}

/* The rows of a quantity, for print. */
static status find_shown(const struct printing *printing, size_t from, size_t quantity, size_t *count,
                         struct study_found *found, struct error *error) {
  *count = study_of_scene(printing->study, from, quantity, found);
  return study_errors(printing->study, from, quantity, printing->store, *count, found, error);
}

static enum ask_resolution_verdict verdict_of(double error, bool at_least) {
  return isnan(error) ? ASK_RESOLUTION_NOT_STUDIED
         : !at_least  ? ASK_RESOLUTION_KNOWN
         : error > 0  ? ASK_RESOLUTION_AT_LEAST
                      : ASK_RESOLUTION_NO_DIFFERENCE;
}

const char *study_show_error(double error, bool at_least, char text[UNCERTAINTY_TEXT]) {
  uncertainty_resolution_cell(verdict_of(error, at_least), error, text);
  return text;
}

/* Mean of a level with its interval, as of any table. */
static struct sample_summary summary_of(const struct study *study, const struct study_ladder *ladder, size_t level,
                                        size_t quantity) {
  struct sample_summary mean = sample_summarise((size_t)ladder->seeds, ladder->values[quantity][level], 0.95);
  const struct sample_range range = sample_range(study->quantity[quantity].row);
  sample_in_range(&mean, &range, 0.95);
  return mean;
}

static void print_level(struct table *table, const struct study_ladder *ladder, const struct convergence_row *row,
                        bool weak, const struct ask_doubts *doubts) {
  char setting[STUDY_SETTING], text[UNCERTAINTY_TEXT];
  /* Of runs that differ in their last bits only. */
  const bool rounding = fabs(row->bias) < 1e-12 * fabs(row->mean) && row->bias_half_width < 1e-12 * fabs(row->mean);
  if (row->n == 0 && !(row->base && isfinite(row->error)))
    return; /* left out by the budget, or every run failed: print_limit names it */
  show_level(ladder, row, setting);
  text_append(setting, sizeof setting, "%s%s", row->base ? " *" : "", row->reference ? " ref" : "");
  table_text(table, row->knob);
  table_text(table, setting);
  table_integer(table, row->n);
  table_rests_on(table, doubts);
  table_reals(table, 2, (const double[]){row->mean, row->half_width});
  table_integer(table, weak);
  table_rests_on(table, doubts);
  table_reals(table, 2, (const double[]){rounding ? 0 : row->bias, rounding ? 0 : row->bias_half_width});
  if (isfinite(row->error))
    table_text(table, study_show_error(row->error, row->at_least, text));
  else
    table_missing(table);
  table_real(table, row->cpu);
  table_text(table, row->frontier ? "yes" : "");
  table_reals(table, 3, (const double[]){row->deviation, row->skew, row->upper_mode});
}

/* ---- sentences ---- */

enum { WIDTH = 100 };

/* The first line of a quantity says what is known of it at one level, as `plan` does: the scene's own, or the finest
 * one with runs; of the knob with most seeds. */
static bool find_told(size_t count, const struct study_found *found, size_t *knob, size_t *level) {
  const struct convergence_row *told = NULL;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      const struct convergence_row *row = &found[i].rows[l];
      const int rank = row->base ? 2 : row->reference, best = !told ? -1 : told->base ? 2 : told->reference;
      if (row->n == 0 || rank < best || (rank == best && row->n <= told->n))
        continue;
      *knob = i;
      *level = l;
      told = row;
    }
  return told;
}

/* The change between the two finest levels as one of a doubling, or a halving, of the knob's first input. */
static void print_change(const struct knob *knob, const struct study_found *found, FILE *out) {
  const struct convergence_row *row[2] = {NULL, NULL}; /* the two finest levels with runs */
  char text[UNCERTAINTY_TEXT];
  for (size_t l = 0; l < found->count; l++)
    if (found->rows[l].n > 0) {
      row[0] = row[1];
      row[1] = &found->rows[l];
    }
  const double factor = row[0] ? log(2) * fabs(knob->step_power) / log(row[0]->step / row[1]->step) : 1;
  const struct limit_range *change = &found->limit.change;
  uncertainty_number(factor * change->value, factor * (change->high - change->low) / 2, text);
  fprintf(out, "no limit %s, moving by %s per %s of %s", found->limit.verdict == LIMIT_FALLING ? "inferred" : "seen",
          text, knob->step_power < 0 ? "doubling" : "halving", knob->inputs[0].path);
}

/* How many seeds show no difference between the levels of the knob, which adds nothing; 0: some do, it has no two
 * levels, or it adds something. */
static int64_t equal_seeds(const struct study_found *found) {
  int64_t levels = 0, seeds = 0;
  for (size_t l = 0; l < found->count; l++) {
    const struct convergence_row *row = &found->rows[l];
    if (row->n == 0)
      continue;
    if (row->bias != 0 || row->bias_half_width != 0 || row->resolution > 0)
      return 0; /* the law of equal runs may leave a little, which the sum then has */
    levels++;
    seeds = row->n;
  }
  return found->adds && levels > 1 ? seeds : 0;
}

static bool has_runs(const struct study_found *found) {
  int64_t n = 0;
  for (size_t l = 0; l < found->count; l++)
    n += found->rows[l].n;
  return n > 0;
}

/* Are the runs of every level equal for all seeds, as in a scene without random numbers? */
static bool seeds_are_equal(size_t count, const struct study_found *found) {
  bool any = false;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      const struct convergence_row *row = &found[i].rows[l];
      any |= row->n > 1;
      if (row->n > 1 && row->deviation > SAMPLE_ROUNDING * fabs(row->mean))
        return false;
    }
  return any;
}

/* "M_1/M = 0.218 +- 0.026 (seeds, 95 %). Error of the resolution: >= 0.09 (grains >= 0.05, time_step 0.04)." */
static status print_sentence(const struct printing *printing, size_t from, size_t quantity, size_t count,
                             const struct study_found *found, FILE *out, struct error *error) {
  const struct study *study = printing->study;
  size_t knob = 0, level = 0;
  if (!find_told(count, found, &knob, &level))
    return STATUS_OK;
  const struct study_ladder *ladder = &study->ladder[from + knob];
  const struct convergence_row *told = &found[knob].rows[level];
  char label[CHARTS_LABEL], text[UNCERTAINTY_TEXT], setting[STUDY_SETTING], unit[64] = "";
  charts_label(study->quantity[quantity].name, label);
  if (study->quantity[quantity].row)
    field_label_unit(ask_result_unit(study->quantity[quantity].row, ladder->base->kind->dimensions), unit, sizeof unit);
  if (*unit)
    text_append(label, sizeof label, " (%s)", unit);
  const struct sample_summary mean = summary_of(study, ladder, level, quantity);
  uncertainty_seeds(&mean, text);
  if (!told->base)
    fprintf(out, "%s = %s: ", told->knob, show_level(ladder, told, setting));
  fprintf(out, "%s = %s.", label, text);
  if (isfinite(told->error))
    fprintf(out, " Error of the resolution: %s%s%s", study_show_error(told->error, told->at_least, text),
            *unit ? " " : "", unit);
  double sum = 0;
  const char *before = " (";
  ANSWER parts = ask_parts(printing->store, ladder->base_point, ladder->base->kind->results_version,
                           study->quantity[quantity].column, error);
  for (struct ask_part part; ask_parts_next(&parts, &part);) {
    if (part.point != ladder->point[level] || !(part.error > 0 || (part.open && part.error == 0 && told->error > 0)))
      continue;
    fprintf(out, "%s%s %s", before, part.knob,
            part.error > 0 ? study_show_error(fmin(part.error, told->error), part.open, text) : ">= 0");
    sum += part.error;
    before = ", ";
  }
  TRY(answer_end(&parts));
  if (sum > (1 + 1e-9) * told->error)
    fputs("; a share cannot move farther", out);
  fprintf(out, "%s%s", *before == ',' ? ")" : "", isfinite(told->error) ? "." : "");
  before = " No difference seen (seeds): ";
  for (size_t i = 0; i < count; i++)
    if (equal_seeds(&found[i]) > 0) {
      fprintf(out, "%s%s (%" PRId64 ")", before, found[i].rows[0].knob, equal_seeds(&found[i]));
      before = ", ";
    }
  fputs(*before == ',' ? "." : "", out);
  before = " Not studied, and not in this error: ";
  for (size_t i = 0; i < count; i++)
    if (found[i].adds && !has_runs(&found[i])) {
      fprintf(out, "%s%s", before, found[i].rows[0].knob);
      before = ", ";
    }
  fputs(*before == ',' ? "." : "", out);
  if (seeds_are_equal(count, found))
    fputs(" All seeds of a level are equal: more of them tell no more.", out);
  if (told->error > 0 && told->error >= fabs(told->mean))
    fputs(" Such an error is as large as the value: finer levels are needed, or more seeds.", out);
  fputc('\n', out);
  return STATUS_OK;
}

/* The limit with the scatter of the seeds in its interval. The distances of the levels are known far better, as equal
 * seeds have the same scatter at all of them: the table and the first line tell these. */
static void print_seen(const struct study_found *found, FILE *out) {
  const struct convergence_limit_row *limit = &found->limit;
  fprintf(out, "limit %.5g (%.5g to %.5g, seeds included), mean over laws of order %.2g to %.2g (best: %.2g); ",
          limit->limit.value, limit->limit.low, limit->limit.high, limit->order.low, limit->order.high,
          limit->order.value);
  if (limit->limit.high - limit->limit.low > 2 * (limit->one_power.high - limit->one_power.low))
    fprintf(out,
            "%.5g to %.5g by the laws of one power alone: the levels do not exclude that two errors cancel here, and "
            "more seeds or more levels may; ",
            limit->one_power.low, limit->one_power.high);
}

static bool was_run(const struct study *study, const struct study_ladder *ladder, size_t level) {
  for (int64_t s = 0; s < study->rule.most_seeds; s++)
    if (ladder->ran[level][s])
      return true;
  return false;
}

/* Has a run of the level a result? An exponent belongs to all of them. */
static bool has_result(const struct study *study, const struct study_ladder *ladder, size_t level, size_t quantity) {
  for (int64_t s = 0; s < study->rule.most_seeds; s++)
    if (isfinite(ladder->values[quantity][level][s]))
      return true;
  return !study->quantity[quantity].row && was_run(study, ladder, level);
}

/* The levels without a mean, each with its reason: no time, not asked for, or all results withheld or missing. Levels
 * of a knob that had no time may have results all the same: its own level is one of the other knobs, too, and the store
 * may have runs. */
static status print_missing(const struct printing *printing, const struct study_ladder *ladder, size_t quantity,
                            const struct study_found *found, FILE *out, struct error *error) {
  struct ask_doubts here, all = {0};
  char ran[KNOB_LEVELS * 200] = "", words[256] = "";
  char late[sizeof ran] = "", lone[sizeof ran] = "", setting[STUDY_SETTING];
  for (size_t l = 0; l < found->count; l++) {
    const struct convergence_row *row = &found->rows[l];
    const bool by_law = row->base && !row->open && found->limit.verdict == LIMIT_SEEN;
    const char *own = by_law ? " *, whose error follows from the law" : row->base ? " *" : "";
    if (row->n > 0)
      continue;
    show_level(ladder, row, setting);
    if (ladder->seeds == 0 && has_result(printing->study, ladder, l, quantity)) {
      text_append(lone, sizeof lone, "%s %s%s", *lone ? "," : "", setting, own);
      continue;
    }
    if (was_run(printing->study, ladder, l) && !ladder->left_out[l]) {
      TRY(read_doubts(printing, ladder, l, quantity, &here, error));
      text_append(ran, sizeof ran, "%s %s%s", *ran ? "," : "", setting, own);
      ask_doubts_add(&all, &here);
      continue;
    }
    if (ladder->levels.level[l].unasked)
      fprintf(out, "; without %s%s", setting, own);
    else
      text_append(late, sizeof late, "%s %s%s", *late ? "," : "; there was no time for", setting, own);
  }
  fputs(late, out);
  for (size_t k = 0; k < all.count; k++)
    if (all.word[k].row && all.word[k].row->withheld)
      text_append(words, sizeof words, "%s%s", *words ? ", " : "", all.word[k].word);
  if (*ran && *words)
    fprintf(out, "; run, but results are withheld (%s):%s", words, ran);
  else if (*ran)
    fprintf(out, "; run, but without a usable result:%s (%s)", ran,
            printing->study->quantity[quantity].row
                ? "`clast status` tells how runs ended, `clast explain` when the result is off"
                : "too few fragments for an exponent: more seeds give more, if any break off");
  if (*lone)
    fprintf(out, "; with results, but a comparison takes two levels with %" PRId64 " seeds:%s",
            printing->study->rule.first_seeds, lone);
  return STATUS_OK;
}

/* The law of a knob, which levels it leaves out and why, and why the knob has no more runs. */
static status print_limit(const struct printing *printing, const struct study_ladder *ladder, size_t quantity,
                          const struct study_found *found, FILE *out, struct error *error) {
  const struct convergence_limit_row *limit = &found->limit;
  const struct knob *knob = ladder->levels.knob;
  char setting[STUDY_SETTING];
  const char *before = "";
  fprintf(out, "%s: ", limit->knob);
  if (limit->verdict == LIMIT_SEEN)
    print_seen(found, out);
  else if (limit->verdict == LIMIT_NOT_SEEN || limit->verdict == LIMIT_FALLING) {
    print_change(knob, found, out);
    fputs(limit->verdict == LIMIT_FALLING ? ": the changes get smaller, but" : ":", out);
    fprintf(out, " the three finest levels do not follow limit + a step^p with p from %g to %g", LIMIT_ORDER_LEAST,
            LIMIT_ORDER_MOST);
    if (!seeds_are_equal(1, found))
      fprintf(out, " (if they did, chance would put them this far off in %s%s of studies)",
              limit->fit < 1e-5 ? "less than " : "", text_percent(fmax(limit->fit, 1e-5), (char[TEXT_PERCENT]){0}));
    fputs("; ", out);
  } else if (limit->verdict == LIMIT_CONSTANT)
    fprintf(out, "no difference seen, all runs are equal; ");
  else if (!isnan(found->rows[0].step))
    fprintf(out, "no limit inferred, which needs three levels and three seeds; ");
  else if (has_runs(found) && found->rows[0].open)
    fprintf(out, "no law says how far it is from a limit; ");
  int64_t dropped = limit->verdict == LIMIT_SEEN ? limit->dropped : 0;
  for (size_t l = 0; l < found->count && dropped > 0; l++)
    if (found->rows[l].n > 0) {
      fprintf(out, "%s%s", *before ? ", " : "the law leaves out ", show_level(ladder, &found->rows[l], setting));
      before = ",";
      dropped--;
    }
  if (*before)
    fprintf(out, ", as it fits all finer levels (%.2g) and not with the next one (%.2g); ", limit->fit,
            limit->fit_with);
  fprintf(out, "ended: %s", ladder->end);
  TRY(print_missing(printing, ladder, quantity, found, out, error));
  fputc('\n', out);
  return STATUS_OK;
}

/* The table of a quantity. */
static status print_levels(struct printing *printing, size_t from, size_t quantity, size_t count,
                           const struct study_found *found, struct error *error) {
  const struct study *study = printing->study;
  TABLE table = table_new(printing->format, stdout);
  table_columns(table, (const char *const[]){"knob", "level", "n", "mean", "mean_hw95", NULL});
  table_range(table, views_range(study->quantity[quantity].name));
  table_columns(table,
                (const char *const[]){"mean_weak", "bias", "bias_hw95", "error", "cpu_s", "frontier", "sd", NULL});
  static const char *const rare[] = {"skewness", "share of upper mode"};
  for (size_t c = 0; c < sizeof rare / sizeof rare[0]; c++) {
    table_column(table, rare[c], NULL);
    table_rare(table);
  }
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      struct ask_doubts doubts;
      TRY(read_doubts(printing, &study->ladder[from + i], l, quantity, &doubts, error));
      const bool weak = summary_of(study, &study->ladder[from + i], l, quantity).weak;
      print_level(table, &study->ladder[from + i], &found[i].rows[l], weak, &doubts);
    }
  TRY(table_end(table, error));
  for (size_t k = 0; k < LEGEND; k++)
    printing->hidden[k] = legend[k].column && table_hides(table, legend[k].column);
  return STATUS_OK;
}

static status print_quantity(struct printing *printing, size_t from, size_t quantity, size_t count,
                             const struct study_found *found, struct error *error) {
  const struct study *study = printing->study;
  const struct study_quantity *what = &study->quantity[quantity];
  const struct scene *base = study->ladder[from].base;
  const char *unit = what->row ? ask_result_unit(what->row, base->kind->dimensions) : NULL;
  const bool named = unit && strcmp(unit, "1") != 0;
  bool ran = false, any = false; /* with and without a result */
  bool results = false;          /* of a knob that had no time to compare them */
  for (size_t i = 0; i < count; i++) {
    ran |= has_runs(&found[i]);
    for (size_t l = 0; l < found[i].count; l++) {
      any |= isfinite(study->ladder[from + i].wall[l]);
      results |= has_result(study, &study->ladder[from + i], l, quantity);
    }
  }
  if (from || quantity)
    putchar('\n');
  OWNED char *sentences = NULL;
  FILE *out = text_open(&sentences);
  status code = print_sentence(printing, from, quantity, count, found, out, error);
  text_close_small(out, &sentences);
  TRY(code);
  text_wrap_lines(sentences, WIDTH, stdout);
  char point[512];
  design_axis_show_point(study->varied_count, study->varied, base->inputs, point, sizeof point);
  if (!ran)
    words_print(stdout, "", "%s%s%s: %s", base->name, *point ? ", " : "", point,
                results ? "no knob has all seeds of two levels, so none is compared"
                : any   ? "no level has a result"
                        : "nothing was run in the time given");
  if (!any)
    return STATUS_OK;
  if (ran)
    words_print(stdout, "", "%s%s%s, quantity %s%s%s%s", base->name, *point ? ", " : "", point, what->name,
                named ? " (" : "", named ? unit : "", named ? ")" : "");
  printing->compared |= ran;
  if (ran)
    TRY(print_levels(printing, from, quantity, count, found, error));
  free(sentences);
  sentences = NULL;
  out = text_open(&sentences);
  for (size_t i = 0; i < count && code == STATUS_OK; i++)
    code = print_limit(printing, &study->ladder[from + i], quantity, &found[i], out, error);
  text_close_small(out, &sentences);
  text_wrap_lines(sentences, WIDTH, stdout);
  return code;
}

enum { OF_LIMIT = 2 }; /* the columns of a limit after knob and quantity, which a level has too */

static status print_rows(const struct printing *printing, size_t from, size_t quantity, size_t count,
                         const struct study_found *found, struct table *table, struct error *error) {
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < found[i].count; l++) {
      struct ask_doubts doubts;
      TRY(read_doubts(printing, &printing->study->ladder[from + i], l, quantity, &doubts, error));
      const struct study *study = printing->study;
      for (size_t a = 0; a < study->varied_count; a++)
        table_field(table, study->varied[a].row, study->ladder[from].base->inputs);
      for (size_t c = 0; c < convergence_table.count; c++)
        table_field(table, &convergence_table.rows[c], &found[i].rows[l]);
      for (size_t c = OF_LIMIT; c < convergence_limit_table.count; c++)
        table_field(table, &convergence_limit_table.rows[c], &found[i].limit);
      table_text(table, ask_resolution_names[verdict_of(found[i].rows[l].error, found[i].rows[l].at_least)]);
      table_doubt_cells(table, &doubts);
    }
  return STATUS_OK;
}

status study_print(const struct study *study, enum table_format format, bool quiet, struct error *error) {
  OWNED struct study_found *found = NULL;
  char words[2000] = "";
  TRY(memory_array(&found, LIMITS_STUDY_KNOBS, sizeof *found, "the rows of a study", error));
  STORE store = NULL;
  TRY(store_open_reader(study->limits.store, &store, error));
  struct printing printing = {.format = format, .study = study, .store = store};
  TABLE table = table_for_people(format) ? NULL : table_new(format, stdout);
  for (size_t a = 0; table && a < study->varied_count; a++) {
    char name[FIELD_TEXT_SIZE];
    field_column_name(study->varied[a].row->path, name, sizeof name);
    table_column(table, name, study->varied[a].row->unit);
  }
  for (size_t c = 0; table && c < convergence_table.count; c++)
    table_column(table, convergence_table.rows[c].path, convergence_table.rows[c].unit);
  for (size_t c = OF_LIMIT; table && c < convergence_limit_table.count; c++)
    table_column(table, convergence_limit_table.rows[c].path, convergence_limit_table.rows[c].unit);
  if (table)
    table_column(table, "error_verdict", NULL);
  if (table)
    table_doubt_columns(table);
  for (size_t from = 0, count = 0; from < study->ladder_count; from += count)
    for (size_t q = 0; q < study->quantity_count; q++) {
      TRY(find_shown(&printing, from, q, &count, found, error));
      TRY(table ? print_rows(&printing, from, q, count, found, table, error)
                : print_quantity(&printing, from, q, count, found, error));
    }
  if (table)
    return table_end(table, error);
  fflush(stdout);
  struct ask_doubts sum;
  TRY(sum_doubts(&printing, study->ladder_count, study->quantity_count, &sum, error));
  uncertainty_doubts(&sum, stderr);
  if (quiet || !printing.compared)
    return STATUS_OK;
  for (size_t k = 0; k < LEGEND; k++)
    if (!printing.hidden[k])
      text_append(words, sizeof words, "%s%s", *words ? " " : "", legend[k].text);
  words_print(stderr, "", "%s", words);
  if (format == TABLE_ALL)
    words_print(stderr, "", "share of upper mode: of the runs, where their values have two modes (peaks).");
  bool main = false;
  char word[TEXT_WORD];
  for (size_t q = 0; q < study->quantity_count; q++)
    main |= strcmp(study->quantity[q].name, OUTCOME_DEFAULT) == 0;
  if (main)
    fprintf(stderr, "clast: next: `clast estimates %s --studies` has this error beside M_1/M of each level, and ",
            text_word(study->limits.store, word));
  fprintf(stderr,
          main ? "`accuracy: {within: ...}` in a campaign chooses settings by it\n"
               : "clast: next: `accuracy: {quantity: %s, within: ...}` in a campaign chooses settings by it\n",
          study->quantity[0].name);
  return STATUS_OK;
}

/* ---- the picture: the levels of a knob over its step, the law with its band, and the limit at 0 ---- */

status study_print_picture(const struct study *study, const char *path, struct error *error) {
  enum { STEPS = 40 };
  const struct study_ladder *ladder = study_stepped(study);
  const struct engine_kind *kind = ladder->base->kind;
  const struct knob *knob = ladder->levels.knob;
  const struct sample_range range = views_range(study->quantity[0].column);
  struct picture_mean levels[KNOB_LEVELS], band[STEPS + 1];
  struct limit_point points[STEPS + 1];
  struct limit_law law;
  struct study_found found;
  struct ask_doubts doubts, sum = {0};
  size_t place[KNOB_LEVELS], count = 0;
  double coarsest = 0;
  STORE store = NULL;
  TRY(store_open_reader(study->limits.store, &store, error));
  study_find(study, ladder, 0, &found);
  for (size_t l = found.count; l-- > 0;) {
    const struct convergence_row *row = &found.rows[l];
    if (row->n == 0)
      continue;
    TRY(read_doubts(&(struct printing){.study = study, .store = store}, ladder, l, 0, &doubts, error));
    ask_doubts_add(&sum, &doubts);
    coarsest = row->step;
    levels[count++] = (struct picture_mean){row->step,
                                            row->mean,
                                            row->mean - row->half_width,
                                            row->mean + row->half_width,
                                            NAN,
                                            doubts.doubtful > 0};
  }
  for (size_t i = 0; i <= STEPS; i++)
    points[i].step = coarsest * (double)i / STEPS;
  study_law(study, ladder, 0, &law, place, STEPS + 1, points);
  for (size_t i = 0; i <= STEPS; i++)
    band[i] = (struct picture_mean){points[i].step, points[i].mean.value, points[i].mean.low, points[i].mean.high, NAN,
                                    false};

  char label[2][120], title[1200], point[512], y[CHARTS_LABEL], x[200], unit[64];
  snprintf(label[0], sizeof label[0], "levels of %s, mean over seeds with its 95 %% interval", knob->name);
  snprintf(label[1], sizeof label[1], "law with its 95 %% band; at step 0 the limit, %.5g (%.5g to %.5g)",
           law.limit.value, law.limit.low, law.limit.high);
  const struct picture_curve curves[] =
      {{.label = label[0], .count = count, .mean = levels, .range = &range},
       {.label = label[1], .count = STEPS + 1, .mean = band, .band = true, .range = &range}};
  charts_label(study->quantity[0].name, y);
  design_axis_show_point(study->varied_count, study->varied, ladder->base->inputs, point, sizeof point);
  snprintf(title, sizeof title, "%s%s%s: %s and its limit", ladder->base->name, *point ? ", " : "", point, y);
  if (study->quantity[0].row)
    TRY(charts_axis(store, study->quantity[0].column, y, error)); /* with its unit */
  const char *input = knob->inputs[0].path;
  field_label_unit(field_find(kind->inputs, input, NULL)->unit, unit, sizeof unit);
  snprintf(x, sizeof x, knob->step_power == 1 ? "step: %s" : "step: %s to the power %.3g", input, knob->step_power);
  if (*unit)
    text_append(x, sizeof x, knob->step_power == 1 ? " (%s)" : " (%s to this power)", unit);
  char caption[CHARTS_LABEL] = "A mark is a level of a knob";
  charts_doubts(NULL, &sum, caption, sizeof caption);
  const struct picture_page page = charts_page(path, NULL);
  return picture_curves(&page, &(struct picture_words){title, caption, x, y}, law.verdict == LIMIT_SEEN ? 2 : 1, curves,
                        error);
}
