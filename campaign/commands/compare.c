/* `clast compare A B`: the difference of a quantity between points, campaigns or stores. */
#include <math.h>

#include "campaign/commands/commands.h"

struct options {
  const char *quantity;
};

/* Prints a row. Returns whether it has no interval although both sides have several runs. */
static bool print(struct table *table, bool people, const struct ask_pairs_row *row, struct ask_doubts *sum) {
  char inputs[2 * ASK_POOL_LABEL + 8];
  const bool same = strcmp(row->label[0], row->label[1]) == 0;
  snprintf(inputs, sizeof inputs, "%s%s%s%s", same ? "" : "a: ", row->label[0],
           same ? "" : "; b: ", same ? "" : row->label[1]);
  struct ask_doubts both = *row->doubts[0];
  ask_doubts_add(&both, row->doubts[1]);
  ask_doubts_add(sum, &both);
  table_integer(table, row->point[0]);
  table_integer(table, row->point[1]);
  table_text(table, people ? inputs : row->inputs);
  for (int k = 0; k < 2; k++)
    table_integer(table, (int64_t)row->difference.n[k]);
  table_integer(table, (int64_t)row->difference.pairs);
  for (int k = 0; k < 2; k++) {
    table_rests_on(table, row->doubts[k]);
    table_real(table, row->difference.mean[k]);
  }
  table_rests_on(table, &both);
  table_reals(table, 2, (const double[]){row->difference.difference, row->difference.half_width});
  table_doubt_cells(table, &both);
  return isnan(row->difference.half_width) && row->difference.n[0] > 1 && row->difference.n[1] > 1;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  ASK_PAIRS pairs = NULL;
  TRY(ask_pairs_read(line->arguments[0], line->arguments[1], options->quantity, &line->choice, &pairs, error));
  TABLE table = table_new(line->format, stdout);
  const bool people = table_for_people(line->format); /* a narrow head ends its lines at blanks */
  table_columns(table, people ? (const char *const[]){"point a", "point b", "inputs", "n a", "n b", "pairs", "mean a",
                                                      "mean b", "difference", "hw95", NULL}
                              : (const char *const[]){"point_a", "point_b", "inputs", "n_a", "n_b", "pairs", "mean_a",
                                                      "mean_b", "difference", "hw95", NULL});
  table_doubt_columns(table);
  struct ask_doubts doubts = {0};
  bool equal = false, part = false; /* part: runs without a partner */
  for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);) {
    equal = print(table, people, &row, &doubts) || equal;
    part |= row.difference.pairs &&
            (row.difference.pairs < row.difference.n[0] || row.difference.pairs < row.difference.n[1]);
  }
  TRY(ask_pairs_end(pairs, error));
  TRY(table_end(table, error));
  for (int side = 0; side < 2; side++) {
    const char *path;
    int64_t left_out;
    const int64_t count = ask_pairs_excluded(pairs, side, &left_out, &path);
    uncertainty_excluded(count, path);
    uncertainty_left_out(left_out);
  }
  OWNED char *apart = NULL;
  TRY(ask_pairs_apart(pairs, &apart, error));
  if (*apart)
    fprintf(stderr, "clast: a and b also differ in %s\n", apart);
  if (people) {
    uncertainty_doubts(&doubts, stderr);
    fprintf(stderr,
            "clast: %s: b minus a, 95 %% interval over seeds; of pairs with one seed, or (pairs 0) of independent "
            "runs. It does not hold the error of the resolution\n",
            ask_pairs_quantity(pairs));
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
