/* `clast query STORE [SQL]`: any SQL that only reads, and canned queries by name. */
#include "campaign/commands/commands.h"

enum { PARAMETERS_MAXIMUM = 64 };

struct options {
  bool list;
  const char *named;
  struct option_list with;
  struct ask_choice choice;
  int64_t seconds;
};

struct parameters {
  struct query_parameter all[PARAMETERS_MAXIMUM];
  char names[PARAMETERS_MAXIMUM][64];
};

/* NAME=VALUE of each --with. */
static status read_parameters(const struct options *options, struct parameters *parameters, struct error *error) {
  for (size_t i = 0; i < options->with.count; i++) {
    const char *text = options->with.items[i], *equals = strchr(text, '=');
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof parameters->names[i])
      return status_fail(error, STATUS_USAGE, "--with expects NAME=VALUE, got \"%.64s\"", text);
    snprintf(parameters->names[i], sizeof parameters->names[i], "%.*s", (int)(equals - text), text);
    parameters->all[i] = (struct query_parameter){parameters->names[i], equals + 1};
  }
  return STATUS_OK;
}

/* A table of SQL has no marks: says that runs are in doubt, or of studies, unless the question asks for that. */
static status tell_marks(struct store *store, const char *sql, struct error *error) {
  double doubtful = 0, of_studies = 0;
  const bool views = strcasestr(sql, "runs") || strcasestr(sql, "points") || strcasestr(sql, "spectra") ||
                     strcasestr(sql, "estimates"); /* they have the column */
  if (!(views || strcasestr(sql, "run") || strcasestr(sql, "point") || strcasestr(sql, "result_")))
    return STATUS_OK;
  TRY(ask_doubts_count(store, &doubtful, &of_studies, error));
  if (of_studies > 0 && views && !strcasestr(sql, "study") && !strcasestr(sql, "point_id") &&
      !strcasestr(sql, "run_id"))
    fprintf(
        stderr,
        "clast: %.0f runs of this store are at points that only studies and searches have: `where not study` leaves "
        "them out of the views\n",
        of_studies);
  if (doubtful > 0 && !strcasestr(sql, OUTCOME_NAME(warnings)) && !strcasestr(sql, "doubtful"))
    fprintf(
        stderr,
        "clast: %.0f runs of this store have a result in doubt: see columns doubtful and warnings of the view runs\n",
        doubtful);
  return STATUS_OK;
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const struct query_canned *canned = options->named ? ask_canned_find(options->named, error) : NULL;
  struct parameters parameters;
  if (options->named && !canned)
    return STATUS_USAGE;
  TRY(read_parameters(options, &parameters, error));
  struct ask_choice choice = options->choice;
  choice.axes = true;
  if (choice.campaign || choice.where)
    TRY(ask_choose(store, &choice, error));
  TRY(ask_register_functions(store, error));
  const char *sql = canned ? canned->sql : line->arguments[1];
  TRY(table_answer(answer_to_user(store, sql, options->with.count, parameters.all, (double)options->seconds, error),
                   canned != NULL, line->format, stdout));
  return tell_marks(store, sql, error);
}

/* Lists the canned queries: name, parameters and meaning; for programs also the SQL. */
static status print_canned(enum table_format format, struct error *error) {
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"name", "with", "answers", NULL});
  if (!table_for_people(format))
    table_column(table, "sql", NULL);
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *canned = ask_canned_at(i);
    table_text(table, canned->name);
    table_text(table, canned->parameters);
    table_text(table, canned->doc);
    if (!table_for_people(format))
      table_text(table, canned->sql);
  }
  return table_end(table, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (options->list)
    return print_canned(line->format, error);
  if (line->count == 0 || (line->count == 2) == (options->named != NULL))
    return status_fail(error, STATUS_USAGE,
                       "clast query needs a store, and either an SQL statement or --named NAME; `clast query --list` "
                       "shows the names");
  return commands_ask(line, ask, error);
}

static const struct option_row rows_of_options[] = {
    OPTION_ROW_FLAG("list", 'l', struct options, list),
    OPTION_ROW_TEXT("named", 'n', "NAME", struct options, named, NULL),
    OPTION_ROW_LIST("with", 0, "NAME=VALUE", struct options, with),
    OPTION_ROW_TEXT("campaign", 0, "CAMPAIGN", struct options, choice.campaign, NULL),
    OPTION_ROW_TEXT("where", 'w', "SQL", struct options, choice.where, NULL),
    OPTION_ROW_INTEGER("seconds", 0, "S", struct options, seconds, 0, 1000000, "0"),
};

COMMAND(query, "results", "[STORE] [SQL]", COMMAND_OPTIONS(struct options, rows_of_options), .has_table = true,
        .run = run);
