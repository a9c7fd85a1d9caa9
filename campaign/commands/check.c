/* `clast check STORE`: is everything in it whole and consistent? */
#include <stdio.h>

#include "campaign/commands/commands.h"
#include "db/store/store.h"

static void print_problem(void *context, const char *text) {
  size_t *count = context;
  ++*count;
  puts(text);
}

static status run(const struct command_line *line, struct error *error) {
  struct store *store = NULL;
  status code = store_open_reader(line->arguments[0], &store, error);
  if (code)
    return code;
  size_t problems = 0;
  code = store_check(store, print_problem, &problems, error);
  store_close(store, NULL);
  if (code == STATUS_CONTENT)
    return status_fail(error, code, "%s has %zu problem%s, listed on standard output", line->arguments[0], problems,
                       problems == 1 ? "" : "s");
  if (code == STATUS_OK)
    fprintf(stderr, "%s: no problems\n", line->arguments[0]);
  return code;
}

const struct command check_command = {
    .name = "check",
    .group = "the store",
    .arguments = "STORE",
    .summary = "is the store whole: integrity, sums, orphans, missing files",
    .doc =
        "Checks the file's integrity, foreign keys, orphaned rows, kept files that are missing, running sums and\n"
        "spectra against the fragment masses, masses against the total, results against their ranges, and every run's\n"
        "identity against its scene. Each problem is a line on stdout; exit 65 when there is any.",
    .examples = "clast check out.db\nclast check out.db && cp out.db /archive/",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .run = run,
};
