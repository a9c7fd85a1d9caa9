/* `clast scatter STORE`: the scatter of runs over seeds. */
#include <math.h>

#include "campaign/commands/commands.h"

struct options {
  const char *by, *quantity, *half_width, *picture;
  struct chart_options chart;
};

/* The half width as the user wrote it; NULL: NaN. In per cent it is a share of the mean, as in `seeds.until`. */
static status read_half_width(const char *text, struct scatter_choice *choice, struct error *error) {
  if (!text)
    return STATUS_OK;
  char *end;
  choice->half_width = strtod(text, &end);
  choice->relative = strcmp(end + strspn(end, " "), "%") == 0;
  if ((*end && !choice->relative) || !(choice->half_width > 0) || isinf(choice->half_width))
    return status_fail(
        error, STATUS_USAGE,
        "--half-width is a number above 0 in SI units, or a share of the mean such as \"5 %%\", not '%s'", text);
  choice->half_width /= choice->relative ? 100 : 1;
  return STATUS_OK;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  struct scatter_choice choice = {{.by = options->by}, options->quantity, NAN, false};
  char name[ASK_GROUP_NAME];
  TRY(read_half_width(options->half_width, &choice, error));
  TRY(ask_quantity_main(store, name, &choice.quantity, error));
  TRY(print_scatter_rows(store, &choice, line->format, error));
  if (!options->picture)
    return STATUS_OK;
  const struct picture_page page = charts_page(options->picture, &options->chart);
  return print_scatter_picture(store, &choice, &page, error);
}

static const struct option_row option_rows[] = {
    COMMANDS_BY(struct options, by),
    OPTION_ROW_TEXT("quantity", 'Q', "NAME", struct options, quantity, NULL),
    OPTION_ROW_TEXT("half-width", 0, "NUMBER", struct options, half_width, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE.png", struct options, picture),
    CHART_OPTIONS(struct options, chart),
};

COMMAND(scatter, "results", "STORE", .chooses_runs = true, COMMAND_OPTIONS(struct options, option_rows),
        .has_table = true, .ask = ask);
