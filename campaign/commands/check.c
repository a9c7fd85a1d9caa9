/* `clast check STORE`: checks that the store is complete and consistent. */
#include "campaign/commands/commands.h"

static void print_problem(void *context, const char *text) {
  char line[4096];
  ++*(size_t *)context;
  snprintf(line, sizeof line, "%s", text);
  text_make_plain(line, "");
  puts(line);
}

static status ask(struct store *store, const struct command_line *line, struct error *error) {
  size_t problems = 0;
  const status code = store_check(store, print_problem, &problems, error);
  if (code == STATUS_CONTENT)
    return status_fail(error, code, "%s has %zu problem%s, listed on standard output", line->arguments[0], problems,
                       problems == 1 ? "" : "s");
  if (code == STATUS_OK)
    fprintf(stderr, "%s: no problems\n", line->arguments[0]);
  return code;
}

COMMAND(check, "the store", "STORE", .ask = ask);
