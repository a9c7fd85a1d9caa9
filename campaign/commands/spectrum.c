/* `clast spectrum STORE`: fragment spectra, pooled over seeds or inputs, beside a measured spectrum. */
#include "campaign/commands/commands.h"
#include "schemas/unit.h"

struct options {
  const char *by, *size, *with, *picture;
  int64_t dimensions;
  bool cumulative, runs, ejecta;
  struct chart_options chart;
};

static status print(struct store *store, const struct options *options, const struct spectrum_choice *choice,
                    enum table_format format, struct error *error) {
  const struct picture_page chart = charts_page(options->picture, &options->chart),
                            *page = options->picture ? &chart : NULL;
  if (options->ejecta)
    return print_ejecta(store, &choice->pool, page, format, error);
  TRY(choice->measured ? print_spectrum_match(store, choice, format, error)
                       : print_spectrum(store, choice, format, error));
  return page ? spectrum_curves_draw(store, choice, page, error) : STATUS_OK;
}

static status check(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (options->ejecta && (options->cumulative || options->runs || options->size || options->with))
    return status_fail(error, STATUS_USAGE,
                       "--ejecta shows masses over speeds: --cumulative, --size, --runs and --with are for fragments");
  return STATUS_OK;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  struct spectrum_choice choice = {.pool = {.by = options->by, .dimensions = (int)options->dimensions},
                                   .cumulative = options->cumulative,
                                   .runs = options->runs};
  __attribute__((cleanup(measured_release))) struct measured measured = {0};
  struct error why = {.message = "it is not above 0"};
  if (options->size && (unit_read_whole(options->size, "kg/m^3", &choice.density, &why) || !(choice.density > 0)))
    return status_fail(error, STATUS_USAGE, "--size is a density such as '2700 kg/m^3', not '%s': %s", options->size,
                       why.message);
  int dimensions = 0;
  if (options->size || options->dimensions)
    TRY(ask_pool_dimensions(store, &choice.pool, &dimensions, error));
  if (options->size && dimensions == 0)
    return status_fail(error, STATUS_USAGE,
                       "sizes follow from masses in 2 or 3 dimensions, and clast does not know those of a program's "
                       "model: add --dimensions 2 or --dimensions 3");
  if (options->with)
    TRY(spectrum_curves_measured(store, options->with, &choice, &measured, error));
  TRY(print(store, options, &choice, line->format, error));
  struct ask_group_pooled pooled;
  TRY(ask_group_pooled(store, options->by, &pooled, error));
  quantity_tell_shared(store, &pooled);
  return STATUS_OK;
}

static const struct option_row option_rows[] = {
    COMMANDS_BY(struct options, by),
    OPTION_ROW_FLAG("cumulative", 'c', struct options, cumulative),
    OPTION_ROW_TEXT("size", 0, "DENSITY", struct options, size, NULL),
    OPTION_ROW_INTEGER("dimensions", 0, "D", struct options, dimensions, 2, 3, 0),
    OPTION_ROW_FLAG("runs", 0, struct options, runs),
    OPTION_ROW_TEXT("with", 0, "FILE.csv", struct options, with, NULL),
    OPTION_ROW_OUTPUT(OPTION_PICTURE, "picture", 0, "FILE.png", struct options, picture),
    OPTION_ROW_FLAG("ejecta", 0, struct options, ejecta),
    CHART_OPTIONS(struct options, chart),
};

COMMAND(spectrum, "results", "STORE", .chooses_runs = true, COMMAND_OPTIONS(struct options, option_rows),
        .has_table = true, .check = check, .ask = ask);
