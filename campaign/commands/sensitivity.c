/* `clast sensitivity`: which input matters, from any points of a store; and Sobol indices with totals, from a design
 * that it writes. */
#include "campaign/commands/commands.h"

struct options {
  const char *design, *quantity;
  int64_t blocks, seed;
};

static status write_design(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (line->count < 2)
    return status_fail(error, STATUS_USAGE,
                       "--design writes a campaign: clast sensitivity CAMPAIGN.yaml NEW.yaml "
                       "--design %s",
                       options->design);
  if (strcmp(options->design, "saltelli") != 0)
    return status_fail(error, STATUS_USAGE, "--design is saltelli, not '%s'", options->design);
  const status code = sensitivity_design_write(line->arguments[0], line->arguments[1], (size_t)options->blocks,
                                               (uint64_t)options->seed, error);
  char word[TEXT_WORD];
  (void)text_word(line->arguments[1], word);
  if (code == STATUS_OK)
    fprintf(
        stderr,
        "clast: wrote %s and its points beside it; `clast plan %s` tells what it costs, `clast run %s` fills a store "
        "of its own\n",
        line->arguments[1], word + 1, word + 1);
  return code;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char name[ASK_GROUP_NAME];
  struct scatter_choice choice = {.quantity = options->quantity};
  TRY(ask_quantity_main(store, name, &choice.quantity, error));
  return line->count > 1 ? print_sensitivity(store, line->arguments[1], choice.quantity, line->format, error)
                         : print_sensitivity_points(store, &choice, line->format, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  return options->design ? write_design(line, error) : commands_ask(line, ask, error);
}

static const struct option_row option_rows[] = {
    OPTION_ROW_TEXT("design", 0, "KIND", struct options, design, NULL),
    OPTION_ROW_INTEGER("blocks", 0, "N", struct options, blocks, 2, 1 << 20, "64"),
    OPTION_ROW_INTEGER("seed", 0, "N", struct options, seed, 0, INT64_MAX, "1"),
    OPTION_ROW_TEXT("quantity", 'Q', "NAME", struct options, quantity, NULL),
};

COMMAND(sensitivity, "results", "STORE|CAMPAIGN.yaml [NEW.yaml]", .chooses_runs = true,
        COMMAND_OPTIONS(struct options, option_rows), .has_table = true, .run = run);
