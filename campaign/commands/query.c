/* `clast query STORE [SQL]`: any SQL that only reads, and canned queries by name. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/rows.h"

enum { PARAMETERS_MAXIMUM = 64 };

struct options {
  bool list;
  const char *named;
  struct option_list with;
  int64_t seconds;
  struct table_options table;
};

static status list_canned(enum table_format format, struct error *error) {
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"name", "with", "answers", NULL});
  if (format != TABLE_TEXT)
    table_column(table, "sql", NULL);
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *canned = ask_canned_at(i);
    table_text(table, canned->name);
    table_text(table, canned->parameters);
    table_text(table, canned->doc);
    if (format != TABLE_TEXT)
      table_text(table, canned->sql);
  }
  return table_end(table, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
  if (options->list)
    return list_canned(format, error);
  if (line->count == 0)
    return status_fail(error, STATUS_USAGE, "clast query needs a store; usage: clast query STORE [SQL]");
  if ((line->count == 2) == (options->named != NULL))
    return status_fail(error, STATUS_USAGE,
                       "give either an SQL statement or --named NAME; `clast query --list` shows the names");
  const struct query_canned *canned = options->named ? ask_canned_find(options->named, error) : NULL;
  if (options->named && !canned)
    return STATUS_USAGE;

  struct query_parameter parameters[PARAMETERS_MAXIMUM];
  char names[PARAMETERS_MAXIMUM][64];
  for (size_t i = 0; i < options->with.count; i++) {
    const char *text = options->with.items[i], *equals = strchr(text, '=');
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof names[i])
      return status_fail(error, STATUS_USAGE, "--with expects NAME=VALUE, got \"%.64s\"", text);
    snprintf(names[i], sizeof names[i], "%.*s", (int)(equals - text), text);
    parameters[i] = (struct query_parameter){names[i], equals + 1};
  }
  struct store *store = NULL;
  code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  code = ask_register_functions(store, error);
  if (!code) {
    struct rows rows;
    struct query_sink sink = rows_sink(&rows, store, format, stdout);
    code = query_run(store, canned ? canned->sql : line->arguments[1], options->with.count, parameters,
                     (double)options->seconds, &sink, error);
    code = rows_end(&rows, code, error);
  }
  store_close(store, NULL);
  return code;
}

static const struct option_row rows_of_options[] = {
    OPTION_ROW_FLAG("list", 'l', struct options, list, "List the canned queries (with --json: their SQL too)."),
    OPTION_ROW_TEXT("named", 'n', "NAME", struct options, named, NULL, "Run a canned query."),
    OPTION_ROW_LIST("with", 'w', "NAME=VALUE", struct options, with,
                    "Value of a parameter :NAME in the SQL. May be given several times."),
    OPTION_ROW_INTEGER("seconds", 0, "S", struct options, seconds, 0, 1000000, "0",
                       "Stop the query after this many seconds (exit 75); 0: never."),
    TABLE_OPTIONS(struct options, table),
};

const struct command query_command = {
    .name = "query",
    .group = "results",
    .arguments = "STORE [SQL]",
    .summary = "query the store: SQL that only reads, or a canned query",
    .doc =
        "Runs one SQL statement that only reads, or a canned query by name, and prints its rows. A campaign may write\n"
        "to the store meanwhile. Views to start from: runs, points, spectra, estimates. The table column_doc explains\n"
        "the columns. Functions besides SQLite's own: stdev(x), median(x), hist_sum(masses).",
    .examples = "clast query out.db \"select replicate, largest_fraction from runs order by 2 limit 5\"\n"
                "clast query --list",
    .maximum_arguments = 2,
    COMMAND_OPTIONS(struct options, rows_of_options),
    .run = run,
};
