/* Completion scripts of zsh and fish. */
#include "campaign/terminal/shells.h"

#include <string.h>

#include "schemas/text.h"

/* The first sentence of `doc` inside single quotes. zsh reads brackets and colons of it, so they are left out there. */
static void quoted(const char *doc, const char *leave_out, FILE *out) {
  char sentence[512];
  text_sentence(doc, sentence, sizeof sentence);
  for (const char *c = sentence; *c; c++)
    if (*c == '\'' || *c == '\\')
      fputc(' ', out); /* the shells do not agree on how to quote these */
    else if (!strchr(leave_out, *c))
      fputc(*c, out);
}

static void zsh_option(const struct option_row *row, FILE *out) {
  static const char marks[] = "[]:";
  fprintf(out, " '%s--%s%s[", row->kind == OPTION_LIST ? "*" : "", row->name, row->kind == OPTION_FLAG ? "" : "=");
  quoted(row->doc, marks, out);
  fputc(']', out);
  if (row->kind != OPTION_FLAG) {
    fputc(':', out);
    quoted(row->argument, marks, out);
    fputs(":_files", out);
  }
  fputc('\'', out);
}

void shells_zsh(size_t count, const struct command *const *commands, FILE *out) {
  fputs("#compdef clast\n"
        "# zsh completion for clast; made by `clast completion zsh` from its option tables.\n"
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
    fputs(" '--help[Explain the command]' '*:file:_files' ;;\n", out);
  }
  fputs("esac\n", out);
}

static void fish_option(const char *command, const struct option_row *row, FILE *out) {
  fprintf(out, "complete -c clast -n '__fish_seen_subcommand_from %s' -l %s", command, row->name);
  if (row->letter)
    fprintf(out, " -s %c", row->letter);
  fprintf(out, "%s -d '", row->kind == OPTION_FLAG ? "" : " -r");
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
}
