/* `clast export STORE [TARGET]`: one compact file for hand-over, rows for other programs, or a folder of CSV files. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/export/cinema.h"
#include "campaign/export/export_crate.h"
#include "campaign/export/export_files.h"

struct options {
  const char *per, *license, *author;
  bool csv, lines, bits, cinema, crate;
};

static status check(const struct options *options, const char *target, struct error *error) {
  if (options->csv + options->lines + options->bits + options->cinema + options->crate > 1)
    return status_fail(error, STATUS_USAGE, "--csv, --jsonl, --bits, --cinema and --crate exclude each other");
  if (options->per && (options->bits || options->cinema || options->crate))
    return status_fail(error, STATUS_USAGE, "--per and --%s exclude each other",
                       options->bits     ? "bits"
                       : options->cinema ? "cinema"
                                         : "crate");
  if ((options->license || options->author) && !options->crate)
    return status_fail(error, STATUS_USAGE, "--license and --author belong to --crate");
  if (options->per && strcmp(options->per, "run") != 0 && strcmp(options->per, "point") != 0)
    return status_fail(error, STATUS_USAGE, "--per expects run or point, got \"%.64s\"", options->per);
  if (options->lines && !options->per)
    return status_fail(error, STATUS_USAGE, "--jsonl needs --per run or --per point");
  if (!options->per && !target)
    return status_fail(error, STATUS_USAGE,
                       "clast export needs a target, or --per run or --per point for rows on standard output; usage: "
                       "clast export STORE [TARGET]");
  return STATUS_OK;
}

static status export_rows(struct store *store, const struct options *options, const char *target, struct error *error) {
  const char *view = strcmp(options->per, "run") == 0 ? "runs" : "points";
  const enum table_format format = options->lines ? TABLE_JSON_LINES : TABLE_CSV;
  return target ? export_files_write(store, target, view, format, error)
                : export_files_view(store, view, format, stdout, error);
}

static status export_cinema(struct store *store, const char *folder, struct error *error) {
  size_t rows = 0, not_drawn = 0;
  const status code = cinema_write(store, folder, &rows, &not_drawn, error);
  if (code == STATUS_OK && not_drawn > 0)
    fprintf(stderr, "clast: %zu of %zu runs have no picture: their fields files are gone or damaged\n", not_drawn,
            rows);
  return code;
}

static status export_as_crate(struct store *store, const char *path, const struct options *options, const char *folder,
                              struct error *error) {
  const struct export_crate_options crate = {.folder = folder, .license = options->license, .author = options->author};
  return export_crate(store, path, &crate, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *target = line->count > 1 ? line->arguments[1] : NULL;
  struct store *store = NULL;
  status code = check(options, target, error);
  if (!code)
    code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = options->per      ? export_rows(store, options, target, error)
         : options->csv    ? export_files_folder(store, target, error)
         : options->cinema ? export_cinema(store, target, error)
         : options->crate  ? export_as_crate(store, line->arguments[0], options, target, error)
         : options->bits   ? export_files_write(store, target, NULL, TABLE_CSV, error)
                           : store_export(store, target, error);
  if (!code && target)
    fprintf(stderr, "%s written\n", target);
  store_close(store, NULL);
  return code;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_TEXT("per", 0, "run|point", struct options, per, NULL,
                    "Write a row for each run or each point: inputs and results in SI units. As CSV, to standard "
                    "output if no TARGET is given."),
    OPTION_ROW_FLAG("jsonl", 0, struct options, lines, "With --per: JSON Lines, one object on each line."),
    OPTION_ROW_FLAG("csv", 0, struct options, csv,
                    "Write a folder of CSV files: runs, points, spectra, estimates, and column_doc with the meaning "
                    "and unit of each column."),
    OPTION_ROW_FLAG("bits", 0, struct options, bits,
                    "Write every value that does not depend on where and when a run was computed, as text in the order "
                    "of identities. Two stores of one campaign give the same file, however they were computed."),
    OPTION_ROW_FLAG("cinema", 0, struct options, cinema,
                    "Write a Cinema database for ParaView and Cinema viewers: a folder with data.csv, and pictures of "
                    "all runs whose fields are kept and of their points' spectra."),
    OPTION_ROW_FLAG("crate", 0, struct options, crate,
                    "Write an RO-Crate (Process Run Crate) for an archive: a folder with the store, the campaigns, "
                    "tables as CSV, and metadata that tell which program made them, and when."),
    OPTION_ROW_TEXT("license", 0, "URL", struct options, license, NULL,
                    "Of the crate, such as https://creativecommons.org/licenses/by/4.0/."),
    OPTION_ROW_TEXT("author", 0, "NAME", struct options, author, NULL, "Of the crate."),
};

const struct command export_command = {
    .name = "export",
    .group = "the store",
    .arguments = "STORE [TARGET]",
    .summary = "one compact file for hand-over, or rows for other programs",
    .doc =
        "Writes a compact copy of the store as one SQLite file, also while a campaign is running; with --per the rows\n"
        "of runs or points; or with --csv its views as CSV files in a folder; with --cinema pictures. It never "
        "overwrites\n"
        "a store. It does overwrite its other files.",
    .examples = "clast export out.db handover.db\nclast export out.db --per point > points.csv",
    .minimum_arguments = 1,
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, option_rows),
    .run = run,
};
