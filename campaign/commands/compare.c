/* `clast compare A B`: the difference of a quantity between points, campaigns or stores. */
#include <stdio.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/table.h"
#include "db/ask/pairs.h"

struct options {
  const char *quantity;
  struct table_options table;
};

static void print(struct table *table, const struct ask_pairs_row *row) {
  table_integer(table, row->point[0]);
  table_integer(table, row->point[1]);
  table_text(table, row->inputs);
  for (int k = 0; k < 2; k++)
    table_integer(table, (int64_t)row->difference.n[k]);
  table_integer(table, (int64_t)row->difference.pairs);
  for (int k = 0; k < 2; k++)
    table_real(table, row->difference.mean[k]);
  table_real(table, row->difference.difference);
  table_real(table, row->difference.half_width);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  struct ask_pairs *pairs = NULL;
  TRY(table_choose(&options->table, &format, error));
  TRY(ask_pairs_read(line->arguments[0], line->arguments[1], options->quantity, &pairs, error));
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"point_a", "point_b", "inputs", "n_a", "n_b", "pairs", "mean_a", "mean_b",
                                             "difference", "hw95", NULL});
  for (struct ask_pairs_row row; ask_pairs_next(pairs, &row);)
    print(table, &row);
  status code = ask_pairs_end(pairs, error);
  if (code)
    table_drop(table);
  else
    code = table_end(table, error);
  if (code == STATUS_OK && format == TABLE_TEXT)
    fprintf(stderr,
            "clast: %s: b less a, 95 %% interval over seeds; of pairs with one seed, or (pairs 0) of independent "
            "runs. It does not hold the error of the resolution\n",
            options->quantity);
  ask_pairs_free(pairs);
  return code;
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("quantity", 'q', "NAME", struct options, quantity, OUTCOME_DEFAULT,
                    "Result to compare: a column of the view runs."),
    TABLE_OPTIONS(struct options, table),
};

const struct command compare_command = {
    .name = "compare",
    .group = "results",
    .arguments = "A B",
    .summary = "the difference of a result between points, campaigns or stores",
    .doc =
        "A and B are each STORE, STORE:POINT (its number) or STORE:CAMPAIGN (its name). For two points the command\n"
        "prints one row, else a row for each pair of points with the same varied inputs: the means and their\n"
        "difference, b minus a, with the half width of its 95 % interval. If at least half of the runs have the same\n"
        "seed on both sides, it compares these as pairs; else the sides count as independent (Welch).",
    .examples = "clast compare out.db:1 out.db:2\nclast compare out.db out.db:demo --quantity fragment_count --csv",
    .minimum_arguments = 2,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
