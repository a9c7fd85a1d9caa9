/* `clast completion SHELL`: the script that lets bash, zsh or fish complete commands and options. */
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/shells.h"
#include "engine/engine.h"

/* Writes the paths of all inputs, each once: the possible values of --set. */
static void write_inputs(FILE *out) {
  for (size_t e = 0; e < engine_count(); e++) {
    const struct field_table *inputs = engine_at(e)->inputs;
    for (size_t i = 0; i < inputs->count; i++) {
      bool seen = false;
      for (size_t before = 0; before < e && !seen; before++)
        for (size_t k = 0; k < engine_at(before)->inputs->count && !seen; k++)
          seen = strcmp(engine_at(before)->inputs->rows[k].path, inputs->rows[i].path) == 0;
      if (!seen)
        fprintf(out, "%s ", inputs->rows[i].path);
    }
  }
}

static status run(const struct command_line *line, struct error *error) {
  static const struct {
    const char *name, *before, *after; /* text around the list of inputs */
    void (*print)(size_t count, const struct command *const *commands, FILE *out);
  } shells[] = {
      {"bash", "_clast_inputs=\"", "\"\n", option_completion},
      {"zsh", "#compdef clast\nlocal -a inputs\ninputs=(", ")\n", shells_zsh},
      {"fish", "set -g __clast_inputs ", "\n", shells_fish},
  };
  for (size_t i = 0; i < sizeof shells / sizeof shells[0]; i++)
    if (strcmp(line->arguments[0], shells[i].name) == 0) {
      fputs(shells[i].before, stdout);
      write_inputs(stdout);
      fputs(shells[i].after, stdout);
      shells[i].print(commands_count(), commands_all(), stdout);
      return STATUS_OK;
    }
  return status_fail(error, STATUS_USAGE, "completion exists for bash, zsh and fish, not for \"%.64s\"",
                     line->arguments[0]);
}

const struct command completion_command = {
    .name = "completion",
    .group = "about clast",
    .arguments = "SHELL",
    .summary = "print the completion script of bash, zsh or fish",
    .doc = "Prints a script that lets a shell complete commands, options and file names with the Tab key. `cmake "
           "--install`\n"
           "puts all three scripts into the folders of the shells.",
    .examples =
        "source <(clast completion bash)\nclast completion bash > ~/.local/share/bash-completion/completions/clast",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    .run = run,
};
