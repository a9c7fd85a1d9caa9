/* `clast stats STORE --by AXES`: means over seeds, with their errors. */
#include "campaign/commands/commands.h"

struct options {
  const char *by, *quantity;
};

/* Exponents are fitted to all runs of a point together: they have no mean over runs. */
static status check(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char name[ASK_GROUP_NAME], word[TEXT_WORD];
  for (const char *names = options->quantity ? options->quantity : ""; *names;) {
    enum exponent_method method;
    enum estimates_window window;
    bool is;
    names = text_next_item(names, name, sizeof name);
    (void)estimates_named(name, &is, &method, &window, NULL);
    if (is)
      return status_fail(
          error, STATUS_USAGE,
          "%s: exponents are fitted to all runs of a point together, not averaged: `clast estimates %s` has them, "
          "`clast plot` and `clast map` draw them with -Q beta",
          name, text_word(line->arguments[0], word));
  }
  return STATUS_OK;
}

/* Warns that means count the runs of twin points as if they were independent. */
static status warn_of_twins(struct store *store, struct error *error) {
  struct ask_group_twins twins;
  const status code = ask_group_twins(store, &twins, error);
  if (code == STATUS_OK && twins.pairs > 0)
    fprintf(stderr,
            "clast: warning: %" PRId64 " pair%s of points with the same seeds differ only in inputs that one of the "
            "two lacks (points %" PRId64 " and %" PRId64 ": %s). A program without these inputs stored one of them. "
            "Seeds count twice here, so the intervals are too narrow; compute the campaign into a new store "
            "(`clast run FILE --store NEW.db`) for statistics of one program alone.\n",
            twins.pairs, twins.pairs == 1 ? "" : "s", twins.point[0], twins.point[1], twins.input);
  return code;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char name[ASK_GROUP_NAME];
  const char *asked = options->quantity;
  TRY(ask_quantity_main(store, name, &asked, error));
  const char *quantity = strcmp(asked, "main") == 0 ? NULL : asked;
  struct ask_group_pooled pooled = {.inputs = ""};
  char changing[ASK_GROUP_POOLED] = "";
  TRY(table_answer(ask_group(store, options->by, quantity, &pooled, error), true, line->format, stdout));
  if (*pooled.inputs)
    fprintf(stderr,
            "clast: pooled over %s: mean and scatter are over points, not over runs; the interval is over points and "
            "seeds%s\n",
            pooled.inputs, pooled.single ? "; in a row of one point, its runs" : "");
  TRY(ask_group_changing(store, options->by, changing, error));
  if (*changing)
    fprintf(stderr, "clast: from row to row the value of %s changes, too (--by)\n", changing);
  quantity_tell_shared(store, &pooled);
  if (table_for_people(line->format)) {
    TRY(quantity_tell_doubts(store, asked, error));
    TRY(quantity_tell_idle(store, error));
    quantity_tell_resolutions(store, asked, &pooled);
  }
  return warn_of_twins(store, error);
}

static const struct option_row rows_of_options[] = {
    OPTION_ROW_TEXT("by", 'b', "AXES", struct options, by, ""),
    OPTION_ROW_TEXT("quantity", 'Q', "NAMES", struct options, quantity, NULL),
};

COMMAND(stats, "results", "STORE", .chooses_runs = true, COMMAND_OPTIONS(struct options, rows_of_options),
        .has_table = true, .check = check, .ask = ask);
