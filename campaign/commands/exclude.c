/* `clast exclude STORE RUN...`: leaves runs out of all statistics with a reason, and takes that back. */
#include <unistd.h>

#include "campaign/commands/commands.h"

struct options {
  const char *reason;
  bool undo;
};

static status check(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  const bool reason = options->reason && options->reason[strspn(options->reason, " \t\r\n")];
  for (size_t i = 1; i < line->count; i++)
    if (!*line->arguments[i] || strspn(line->arguments[i], "0123456789") != strlen(line->arguments[i]))
      return status_fail(error, STATUS_USAGE, "RUN is a number (run_id in the view runs), got \"%.64s\"",
                         line->arguments[i]);
  char word[TEXT_WORD];
  if (line->count == 1 && (options->reason || options->undo))
    return status_fail(error, STATUS_USAGE,
                       options->undo ? "which run? `clast exclude %s` lists those that are excluded, by run_id"
                                     : "which run? The query of `clast exclude --help` on %s lists them by run_id",
                       text_word(line->arguments[0], word));
  if (line->count > 1 && reason == options->undo)
    return status_fail(error, STATUS_USAGE,
                       "give --reason TEXT, which the store keeps, or --undo to count the run again");
  return STATUS_OK;
}

/* All runs, or none. */
static status change(struct store *store, const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  char reason[1024];
  snprintf(reason, sizeof reason, "%s", options->reason ? options->reason : "");
  text_make_plain(reason, "");
  for (size_t i = 1; i < line->count; i++)
    TRY(store_exclude(store, strtoll(line->arguments[i], NULL, 10), options->undo ? NULL : reason, error));
  return pooling_store(store, 0, error);
}

static status list(struct store *store, const struct command_line *line, struct error *error) {
  int64_t count = 0;
  TRY(ask_run_excluded_count(store, &count, error));
  if (count > 0 || !table_for_people(line->format))
    TRY(table_answer(ask_run_excluded(store, error), true, line->format, stdout));
  if (count == 0)
    fprintf(stderr, "%s: no run is excluded\n", line->arguments[0]);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  struct store *store = NULL;
  char warning[512] = "";
  if (line->count == 1 || access(line->arguments[0], F_OK) != 0)
    return commands_ask(line, list, error);
  TRY(store_open_writer(line->arguments[0], &store, warning, sizeof warning, error));
  if (*warning)
    fprintf(stderr, "clast: %s\n", warning);
  int64_t count = 0;
  status code = change(store, line, error);
  if (code == STATUS_OK)
    code = ask_run_excluded_count(store, &count, error);
  const status closed = store_close(store, code ? NULL : error);
  if (code == STATUS_OK && closed == STATUS_OK)
    fprintf(stderr,
            count ? "%s: %" PRId64 " run%s excluded now, and left out of all statistics\n"
                  : "%s: no run is excluded now\n",
            line->arguments[0], count, count == 1 ? " is" : "s are");
  return code ? code : closed;
}

static const struct option_row rows[] = {
    OPTION_ROW_TEXT("reason", 0, "TEXT", struct options, reason, NULL),
    OPTION_ROW_FLAG("undo", 0, struct options, undo),
};

COMMAND(exclude, "the store", "STORE [RUN...]", COMMAND_OPTIONS(struct options, rows), .has_table = true,
        .check = check, .run = run);
