/* `clast compare A B`: the difference of a quantity between points, campaigns or stores. */
#include <math.h>

#include "campaign/commands/commands.h"
#include "db/store/views.h"

struct options {
  const char *quantity;
};

static const char *const sides[] = {"a", "b"};

/* People see the inputs first, and the interval of each mean. */
static void name_columns(struct table *table, bool people, const struct sample_range *range) {
  char name[32];
  table_columns(table, people ? (const char *const[]){"inputs", "point a", "point b", "n a", "n b", "pairs", NULL}
                              : (const char *const[]){"point_a", "point_b", "inputs", "n_a", "n_b", "pairs", NULL});
  for (int k = 0; k < 2; k++) { /* a narrow head ends its lines at blanks */
    const char *const *const end = people ? (const char *const[]){"", "_hw95", "_weak"} : (const char *const[]){""};
    for (int i = 0; i < (people ? 3 : 1); i++) {
      snprintf(name, sizeof name, people ? "mean %s%s" : "mean_%s%s", sides[k], end[i]);
      table_column(table, name, NULL);
      table_range(table, *range);
    }
  }
  table_columns(table, (const char *const[]){"difference", "hw95", NULL});
  table_doubt_columns(table);
}

/* The mean of a side; for people with its interval. */
static void mean_cells(struct table *table, bool people, const struct ask_pairs_row *row, int k) {
  const struct sample_summary *side = &row->difference.side[k];
  table_rests_on(table, row->doubts[k]);
  table_real(table, people && row->untold[k] ? (double)NAN : isfinite(side->mean) ? side->mean : row->exponent[k]);
  if (!people)
    return;
  table_real(table, side->half_width);
  table_integer(table, side->weak);
}

/* Prints a row. Returns whether it has no interval although both sides have several runs. */
static bool print(struct table *table, bool people, const struct ask_pairs_row *row, struct ask_doubts *sum) {
  char inputs[2 * ASK_POOL_LABEL + 8];
  const bool same = strcmp(row->label[0], row->label[1]) == 0;
  snprintf(inputs, sizeof inputs, "%s%s%s%s", same ? "" : "a: ", row->label[0],
           same ? "" : "; b: ", same ? "" : row->label[1]);
  struct ask_doubts both = *row->doubts[0];
  ask_doubts_add(&both, row->doubts[1]);
  ask_doubts_add(sum, &both);
  if (people)
    table_text(table, inputs);
  table_integer(table, row->point[0]);
  table_integer(table, row->point[1]);
  if (!people)
    table_text(table, row->inputs);
  const bool untold = people && (row->untold[0] || row->untold[1]);
  for (int k = 0; k < 2; k++)
    table_integer(table, (int64_t)row->runs[k]);
  table_integer(table, (int64_t)row->difference.pairs);
  for (int k = 0; k < 2; k++)
    mean_cells(table, people, row, k);
  table_rests_on(table, &both);
  table_real(table, untold ? (double)NAN : row->difference.difference);
  table_real(table, untold ? (double)NAN : row->difference.half_width);
  table_doubt_cells(table, &both);
  return !untold && isnan(row->difference.half_width) && row->difference.side[0].n > 1 && row->difference.side[1].n > 1;
}

/* The exponents that the table leaves out. */
struct untold {
  char reason[300];
  bool no_interval; /* of one that the table has */
};

static void note_untold(struct untold *untold, const struct ask_pairs_row *row) {
  for (int k = 0; k < 2; k++) {
    untold->no_interval |= !row->untold[k] && isfinite(row->exponent[k]) && row->difference.side[k].n == 0;
    pooled_exponent_tell(row->untold[k], untold->reason, sizeof untold->reason);
  }
}

/* "beta_masses_from_5 -: the exponent is too uncertain to print: fewer than 5 fragments" */
static status tell_untold(const struct untold *untold, const char *quantity, struct error *error) {
  bool exponent;
  enum exponent_method method;
  enum estimates_window window;
  if (untold->no_interval)
    fputs("clast: no difference where an exponent has no interval: without one of its runs there is no fit\n", stderr);
  if (!*untold->reason)
    return STATUS_OK;
  TRY(estimates_named(quantity, &exponent, &method, &window, error));
  fprintf(stderr, "clast: beta_%s_%s -: %s", exponent_method_names[method], estimates_window_names[window],
          untold->reason);
  if (window > ESTIMATES_FROM_2)
    fprintf(stderr, ". `-Q beta_%s_%s` takes lighter fragments, too", exponent_method_names[method],
            estimates_window_names[ESTIMATES_FROM_2]);
  fputc('\n', stderr);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  ASK_PAIRS pairs = NULL;
  TRY(ask_pairs_read(line->arguments[0], line->arguments[1], options->quantity, &line->choice, &pairs, error));
  TABLE table = table_new(line->format, stdout);
  const bool people = table_for_people(line->format);
  const struct sample_range range = views_range(pairs->quantity);
  name_columns(table, people, &range);
  struct ask_doubts doubts = {0};
  struct untold untold = {0};
  bool equal = false, weak = false, part = false; /* part: runs without a partner */
  for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);) {
    for (int k = 0; k < 2; k++) {
      sample_in_range(&row.difference.side[k], &range, 0.95);
      weak |= row.difference.side[k].weak;
    }
    equal = print(table, people, &row, &doubts) || equal;
    note_untold(&untold, &row);
    part |= row.difference.pairs &&
            (row.difference.pairs < row.difference.side[0].n || row.difference.pairs < row.difference.side[1].n);
  }
  TRY(ask_pairs_end(pairs, error));
  TRY(table_end(table, error));
  for (const struct ask_pairs_side *side = pairs->side; side < pairs->side + 2; side++) {
    uncertainty_namesakes(side->namesakes, side->choice.campaign, side->path);
    uncertainty_excluded(side->excluded, side->path);
    uncertainty_missing(side->missing, side->wanted, side->path);
    uncertainty_left_out(side->left_out);
  }
  OWNED char *apart = NULL, *alone = NULL;
  TRY(ask_pairs_alone(pairs, &alone, error));
  if (*alone)
    fprintf(stderr, "clast: without a partner: %s\n", alone);
  TRY(ask_pairs_apart(pairs, &apart, error));
  if (*apart)
    fprintf(stderr, "clast: a and b also differ in %s\n", apart);
  if (people) {
    TRY(tell_untold(&untold, pairs->quantity, error));
    uncertainty_doubts(&doubts, stderr);
    fprintf(
        stderr,
        "clast: %s: means, and b minus a, with 95 %% intervals over seeds%s; the difference of pairs with one seed, "
        "or (pairs 0) of independent runs. It does not hold the error of the resolution\n",
        pairs->quantity, weak ? " (~: weak, too few runs)" : "");
    if (part)
      fputs("clast: means are of all runs; runs without a partner of their seed are not in the difference\n", stderr);
    if (equal)
      fputs("clast: no interval where all runs, or all differences, are equal to 14 digits: other seeds may differ\n",
            stderr);
  }
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("quantity", 'Q', "NAME", struct options, quantity, NULL),
};

COMMAND(compare, "results", "A B", .chooses_runs = true, COMMAND_OPTIONS(struct options, rows), .has_table = true,
        .run = run);
