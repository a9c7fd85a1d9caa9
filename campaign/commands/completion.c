/* `clast completion bash`: the script that lets bash complete commands and options. */
#include <string.h>

#include "campaign/commands/commands.h"

static status run(const struct command_line *line, struct error *error) {
  if (strcmp(line->arguments[0], "bash") != 0)
    return status_fail(error, STATUS_USAGE, "completion is made for bash only, not for \"%.64s\"", line->arguments[0]);
  option_completion(commands_count(), commands_all(), stdout);
  return STATUS_OK;
}

const struct command completion_command = {
    .name = "completion",
    .group = "about clast",
    .arguments = "bash",
    .summary = "print the bash completion script",
    .doc = "Prints a script that lets bash complete commands, options and file names with the Tab key.",
    .examples =
        "source <(clast completion bash)\nclast completion bash > ~/.local/share/bash-completion/completions/clast",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .run = run,
};
