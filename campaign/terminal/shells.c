/* Completion scripts of zsh and fish. */
#include "campaign/terminal/shells.h"

#include <stdbool.h>
#include <string.h>

#include "schemas/text.h"

/* True when the option's value begins with the path of an input. */
static bool takes_input(const struct option_row *row) {
  return row->argument && strcmp(row->argument, "PATH=VALUE") == 0;
}

/* The first sentence of `doc` inside single quotes. zsh gives brackets and colons a meaning, so they are left out for
 * zsh. */
static void quoted(const char *doc, const char *leave_out, FILE *out) {
  char sentence[512];
  text_sentence(doc, sentence, sizeof sentence);
  for (const char *c = sentence; *c; c++)
    if (*c == '\'' || *c == '\\')
      fputc(' ', out); /* the shells do not agree on how to quote these */
    else if (!strchr(leave_out, *c))
      fputc(*c, out);
}

/* dashes, name, equals: "--", "set", "=" or "-", "s", "". */
static void zsh_form(const struct option_row *row, const char *dashes, const char *name, const char *equals,
                     FILE *out) {
  static const char marks[] = "[]:";
  fprintf(out, " '%s%s%s%s[", row->kind == OPTION_LIST ? "*" : "", dashes, name,
          row->kind == OPTION_FLAG ? "" : equals);
  quoted(row->doc, marks, out);
  fputc(']', out);
  if (row->kind != OPTION_FLAG) {
    fputc(':', out);
    quoted(row->argument, marks, out);
    fputs(takes_input(row) ? ":{compadd -S = -a inputs}" : ":_files", out);
  }
  fputc('\'', out);
}

static void zsh_option(const struct option_row *row, FILE *out) {
  const char letter[] = {row->letter, '\0'};
  zsh_form(row, "--", row->name, "=", out);
  if (row->letter)
    zsh_form(row, "-", letter, "", out);
}

void shells_zsh(size_t count, const struct command *const *commands, FILE *out) {
  fputs("# zsh completion for clast; made by `clast completion zsh` from its option tables.\n"
        "# Use: put it as _clast into a folder of $fpath.\n"
        "local -a commands\n"
        "commands=(\n",
        out);
  for (size_t i = 0; i < count; i++) {
    fprintf(out, "  '%s:", commands[i]->name);
    quoted(commands[i]->summary, ":", out);
    fputs("'\n", out);
  }
  fputs(")\n"
        "if (( CURRENT == 2 )); then\n"
        "  _describe command commands\n"
        "  return\n"
        "fi\n"
        "local command=$words[2]\n"
        "shift words\n"
        "(( CURRENT-- ))\n"
        "case $command in\n",
        out);
  for (size_t i = 0; i < count; i++) {
    fprintf(out, "  %s) _arguments", commands[i]->name);
    for (size_t k = 0; k < commands[i]->option_count; k++)
      zsh_option(&commands[i]->options[k], out);
    fprintf(out, " '--help[Explain the command]' '*:file:{%s_files}' ;;\n",
            strcmp(commands[i]->name, "explain") == 0 ? "compadd -a inputs; " : "");
  }
  fputs("esac\n", out);
}

static void fish_option(const char *command, const struct option_row *row, FILE *out) {
  fprintf(out, "complete -c clast -n '__fish_seen_subcommand_from %s' -l %s", command, row->name);
  if (row->letter)
    fprintf(out, " -s %c", row->letter);
  const char *value = takes_input(row) ? " -x -a '$__clast_inputs='" : " -r";
  fprintf(out, "%s -d '", row->kind == OPTION_FLAG ? "" : value);
  quoted(row->doc, "", out);
  fputs("'\n", out);
}

void shells_fish(size_t count, const struct command *const *commands, FILE *out) {
  fputs("# fish completion for clast; made by `clast completion fish` from its option tables.\n"
        "# Use: clast completion fish > ~/.config/fish/completions/clast.fish\n",
        out);
  for (size_t i = 0; i < count; i++) {
    fprintf(out, "complete -c clast -n __fish_use_subcommand -f -a %s -d '", commands[i]->name);
    quoted(commands[i]->summary, "", out);
    fputs("'\n", out);
  }
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < commands[i]->option_count; k++)
      fish_option(commands[i]->name, &commands[i]->options[k], out);
  fputs("complete -c clast -n '__fish_seen_subcommand_from explain' -a '$__clast_inputs' -d Input\n", out);
}
