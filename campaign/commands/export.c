/* `clast export STORE [TARGET]`: one compact file for hand-over, rows for other programs, or a folder of CSV files. */
#include <string.h>
#include <strings.h>

#include "campaign/commands/commands.h"
#include "campaign/export/export.h"

struct options {
  const char *per, *license, *author;
  bool csv, lines, bits, crate;
};

/* Does the name promise a table? */
static bool is_table(const char *name) {
  static const char *const endings[] = {".csv", ".json", ".jsonl", ".txt", ".tsv"};
  const char *dot = strrchr(name, '.');
  for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
    if (strcasecmp(dot, endings[i]) == 0)
      return true;
  return false;
}

/* Options that exclude each other. */
static status check(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const bool other = options->bits || options->crate;
  const struct ask_choice *choice = &line->choice;
  const struct rule {
    bool broken;
    const char *text;
  } rules[] = {
      {options->csv + options->lines + options->bits + options->crate > 1,
       "--csv, --jsonl, --bits and --crate exclude each other"},
      {options->per && other, "--per excludes --bits and --crate"},
      {(choice->point || choice->campaign || choice->where) && !options->per && !options->csv,
       "--point, --campaign and --where belong to --per and --csv: other forms have the whole store"},
      {(options->license || options->author) && !options->crate, "--license and --author belong to --crate"},
      {options->lines && !options->per, "--jsonl needs --per run or --per point"},
      {!options->per && !options->csv && !other && line->count > 1 && is_table(line->arguments[1]),
       "without an option the target is a store. For rows give --per run or --per point (--jsonl for JSON), for a "
       "folder "
       "of tables --csv"},
      {!options->per && line->count < 2,
       "clast export needs a target, or --per run or --per point for rows on standard output; usage: "
       "clast export STORE [TARGET]"},
  };
  for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++)
    if (rules[i].broken)
      return status_fail(error, STATUS_USAGE, "%s", rules[i].text);
  if (options->per && strcmp(options->per, "run") != 0 && strcmp(options->per, "point") != 0)
    return status_fail(error, STATUS_USAGE, "--per expects run or point, got \"%.64s\"", options->per);
  return STATUS_OK;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const char *target = line->count > 1 ? line->arguments[1] : NULL;
  const struct export_crate_options crate = {target, options->license, options->author};
  if (!options->per && !options->csv)
    TRY(ask_choose(store, &(struct ask_choice){0}, error)); /* the whole store */
  if (options->per)
    TRY(export_files_write(store, target, strcmp(options->per, "run") == 0 ? "runs" : "points",
                           options->lines ? TABLE_JSON_LINES : TABLE_CSV, error));
  else if (options->csv)
    TRY(export_files_folder(store, target, error));
  else if (options->crate)
    TRY(export_crate(store, line->arguments[0], &crate, error));
  else if (options->bits)
    TRY(export_files_write(store, target, NULL, TABLE_CSV, error));
  else
    TRY(store_export(store, target, error));
  if (target)
    fprintf(stderr, "%s written\n", target);
  return STATUS_OK;
}

static const struct option_row option_rows[] = {
    OPTION_ROW_TEXT("per", 0, "run|point", struct options, per, NULL),
    OPTION_ROW_FLAG("jsonl", 0, struct options, lines),
    OPTION_ROW_FLAG("csv", 0, struct options, csv),
    OPTION_ROW_FLAG("bits", 0, struct options, bits),
    OPTION_ROW_FLAG("crate", 0, struct options, crate),
    OPTION_ROW_TEXT("license", 0, "URL", struct options, license, NULL),
    OPTION_ROW_TEXT("author", 0, "NAME", struct options, author, NULL),
};

COMMAND(export, "the store", "STORE [TARGET]", COMMAND_OPTIONS(struct options, option_rows), .chooses_runs = true,
        .check = check, .ask = ask);
