/* `clast check STORE`: checks that the store is complete and consistent. */
#include <stdio.h>

#include "campaign/commands/commands.h"
#include "db/store/store.h"
#include "schemas/text.h"

static void print_problem(void *context, const char *text) {
  size_t *count = context;
  char line[4096];
  ++*count;
  snprintf(line, sizeof line, "%s", text);
  text_make_plain(line, "");
  puts(line);
}

static status ask(struct store *store, const struct command_line *line, enum table_format format, struct error *error) {
  size_t problems = 0;
  const status code = store_check(store, print_problem, &problems, error);
  (void)format;
  if (code == STATUS_CONTENT)
    return status_fail(error, code, "%s has %zu problem%s, listed on standard output", line->arguments[0], problems,
                       problems == 1 ? "" : "s");
  if (code == STATUS_OK)
    fprintf(stderr, "%s: no problems\n", line->arguments[0]);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  return commands_ask(line, NULL, ask, error);
}

const struct command check_command = {
    .name = "check",
    .group = "the store",
    .arguments = "STORE",
    .summary = "check a store: integrity, sums, orphaned rows, missing files",
    .doc =
        "Checks the file's integrity and foreign keys, looks for orphaned rows and missing field files, and compares\n"
        "running sums and spectra with the fragment masses, masses with the total mass, results with their ranges,\n"
        "the identity of every run with its scene, and runs and points with their digests. Prints one line\n"
        "per problem; exit 65 if there is one.",
    .examples = "clast check out.db\nclast check out.db && cp out.db /archive/",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .run = run,
};
