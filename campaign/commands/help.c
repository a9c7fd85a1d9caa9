/* `clast help [COMMAND]`: the list of commands, one command's help, or the manual page. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/manual.h"

static const struct manual_texts texts = {
    .purpose = "Runs ensembles of fragmentation simulations and keeps every result in one SQLite file.",
    .first_steps = "clast scenes                                   # what can be broken\n"
                   "clast simulate disc-explosion --picture a.png  # one run, drawn\n"
                   "clast run campaign.yaml                        # many runs; the same command resumes",
    .streams = "Data goes to stdout, remarks and errors to stderr.",
};

struct options {
  bool man;
};

void commands_help(FILE *out) {
  fprintf(out, "usage: clast COMMAND [OPTIONS] ...\n\n%s\n\nfirst steps:\n", texts.purpose);
  option_lines(texts.first_steps, out);
  const char *group = "";
  for (size_t i = 0; i < commands_count(); i++) {
    const struct command *command = commands_all()[i];
    if (strcmp(command->group, group) != 0)
      fprintf(out, "\n%s:\n", command->group);
    group = command->group;
    fprintf(out, "  %-12s %s\n", command->name, command->summary);
  }
  fprintf(out, "\n`clast COMMAND --help` tells more, with examples. %s\n", texts.streams);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (options->man && line->count > 0)
    return status_fail(error, STATUS_USAGE, "--man prints the manual page of all commands; leave out \"%.64s\"",
                       line->arguments[0]);
  if (options->man) {
    manual_write(&texts, commands_count(), commands_all(), stdout);
    return STATUS_OK;
  }
  if (line->count == 0) {
    commands_help(stdout);
    return STATUS_OK;
  }
  const struct command *command = commands_find(line->arguments[0], error);
  if (!command)
    return STATUS_USAGE;
  option_help(command, stdout);
  return STATUS_OK;
}

static const struct option_row rows[] = {
    OPTION_ROW_FLAG("man", 0, struct options, man,
                    "Print the manual page clast(1), every command in one text, as roff."),
};

const struct command help_command = {
    .name = "help",
    .group = "about clast",
    .arguments = "[COMMAND]",
    .summary = "this list, the help of one command, or the manual page",
    .doc = "Lists the commands, or prints one command's usage, options, examples and exit codes, or the manual page.",
    .examples = "clast help run\nclast help --man | man -l -",
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
