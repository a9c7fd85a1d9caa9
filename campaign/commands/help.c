/* `clast help [COMMAND]`: the list of commands, or one command's help. */
#include "campaign/commands/commands.h"
#include "campaign/commands/help.h"

#include <string.h>

void help_overview(FILE *out) {
  fputs("usage: clast COMMAND [OPTIONS] ...\n\n"
        "Runs ensembles of fragmentation simulations and keeps every result in one SQLite file.\n\n"
        "first steps:\n"
        "  clast scenes                                   # what can be broken\n"
        "  clast simulate disc-explosion --picture a.png  # one run, drawn\n"
        "  clast run campaign.yaml                        # many runs; the same command resumes\n",
        out);
  const char *group = "";
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *command = commands_all()[i];
    if (strcmp(command->group, group) != 0)
      fprintf(out, "\n%s:\n", command->group);
    group = command->group;
    fprintf(out, "  %-11s %s\n", command->name, command->summary);
  }
  fputs("\n`clast COMMAND --help` tells more, with examples. Data goes to stdout, remarks and errors to stderr.\n", out);
}

static status run(const struct command_line *line, struct error *error) {
  if (line->count == 0) {
    help_overview(stdout);
    return STATUS_OK;
  }
  const struct command *command = commands_find(line->arguments[0], error);
  if (!command)
    return STATUS_USAGE;
  option_help(command, stdout);
  return STATUS_OK;
}

const struct command help_command = {
    .name = "help",
    .group = "about clast",
    .arguments = "[COMMAND]",
    .summary = "this list, or the help of one command",
    .doc = "Lists the commands, or prints one command's usage, options, examples and exit codes.",
    .examples = "clast help\nclast help run",
    .maximum_arguments = 1,
    .run = run,
};
