/* Parsing over getopt_long, and everything else that follows from the option tables. */
#include "campaign/terminal/option.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

enum { ROWS_MAXIMUM = 30, HELP_VALUE = 1000, ROW_VALUE = 1001, COLUMN = 26, WIDTH = 96, WORD_MAXIMUM = 63 };

const char *option_nearest(const char *typed, size_t count, const char *const *names) {
  struct text_guess guess = text_guess(typed);
  for (size_t i = 0; i < count; i++)
    text_guess_offer(&guess, names[i]);
  return guess.nearest;
}

static status take_value(const struct command *command, const struct option_row *row, const char *text, void *options,
                         struct error *error) {
  void *slot = (char *)options + row->offset;
  switch (row->kind) {
  case OPTION_FLAG: *(bool *)slot = true; return STATUS_OK;
  case OPTION_TEXT: *(const char **)slot = text; return STATUS_OK;
  case OPTION_LIST: {
    struct option_list *list = slot;
    if (list->count == sizeof list->items / sizeof list->items[0])
      return status_fail(error, STATUS_USAGE, "--%s is given more than %zu times", row->name, list->count);
    list->items[list->count++] = text;
    return STATUS_OK;
  }
  case OPTION_INTEGER: {
    char *end = NULL;
    errno = 0;
    long long number = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || errno == ERANGE || number < row->minimum || number > row->maximum) {
      char range[64];
      if (row->maximum == INT64_MAX)
        snprintf(range, sizeof range, "from %" PRId64 " up", row->minimum);
      else
        snprintf(range, sizeof range, "from %" PRId64 " to %" PRId64, row->minimum, row->maximum);
      return status_fail(error, STATUS_USAGE, "--%s expects a whole number %s, got \"%.64s\" (clast %s --help)",
                         row->name, range, text, command->name);
    }
    *(int64_t *)slot = number;
    return STATUS_OK;
  }
  }
  return status_fail(error, STATUS_INTERNAL, "option --%s has no kind", row->name);
}

static status unknown_option(const struct command *command, const char *typed, int letter, struct error *error) {
  const char *names[ROWS_MAXIMUM + 1];
  size_t count = 0;
  for (size_t i = 0; i < command->option_count; i++)
    names[count++] = command->options[i].name;
  names[count++] = "help";
  if (letter)
    return status_fail(error, STATUS_USAGE, "clast %s has no option -%c; `clast %s --help` lists them", command->name,
                       letter, command->name);
  char word[WORD_MAXIMUM + 1];
  snprintf(word, sizeof word, "%.*s", (int)strcspn(typed + 2, "="), typed + 2);
  const char *nearest = option_nearest(word, count, names);
  return status_fail(error, STATUS_USAGE, "clast %s has no option --%s%s%s%s `clast %s --help` lists them",
                     command->name, word, nearest ? "; did you mean --" : ";", nearest ? nearest : "",
                     nearest ? "?" : "", command->name);
}

status option_parse(const struct command *command, int argc, char **argv, void *options, size_t *count,
                    char ***arguments, bool *help, struct error *error) {
  struct option names[ROWS_MAXIMUM + 2];
  char letters[2 * ROWS_MAXIMUM + 4] = ":h"; /* the colon: a missing value is told apart from an unknown option */
  size_t used = strlen(letters);
  if (command->option_count > ROWS_MAXIMUM || command->options_size > OPTION_STRUCT_MAXIMUM)
    return status_fail(error, STATUS_INTERNAL, "the option table of %s is too large", command->name);
  memset(options, 0, command->options_size);
  *help = false;
  for (size_t i = 0; i < command->option_count; i++) {
    const struct option_row *row = &command->options[i];
    int takes = row->kind == OPTION_FLAG ? no_argument : required_argument;
    names[i] = (struct option){.name = row->name, .has_arg = takes, .val = ROW_VALUE + (int)i};
    if (row->letter) {
      letters[used++] = row->letter;
      if (takes == required_argument)
        letters[used++] = ':';
    }
    if (row->initial && take_value(command, row, row->initial, options, error))
      return status_fail(error, STATUS_INTERNAL, "the default of --%s is wrong", row->name);
  }
  letters[used] = '\0';
  names[command->option_count] = (struct option){.name = "help", .has_arg = no_argument, .val = HELP_VALUE};
  names[command->option_count + 1] = (struct option){0};

  optind = 0; /* glibc: start over, also after another parse */
  opterr = 0;
  int given;
  while ((given = getopt_long(argc, argv, letters, names, NULL)) != -1) {
    if (given == HELP_VALUE || given == 'h') {
      *help = true;
      return STATUS_OK;
    }
    const char *word = argv[optind - 1];
    if (given == '?' && optopt >= HELP_VALUE)
      return status_fail(error, STATUS_USAGE, "--%s takes no value",
                         optopt == HELP_VALUE ? "help" : names[optopt - ROW_VALUE].name);
    if (given == '?')
      return unknown_option(command, word, optopt, error); /* optopt is 0 for a long name */
    const struct option_row *row = NULL;
    int code = given == ':' ? optopt : given;
    for (size_t i = 0; i < command->option_count; i++)
      if (code == ROW_VALUE + (int)i || (command->options[i].letter && code == command->options[i].letter))
        row = &command->options[i];
    if (!row)
      return status_fail(error, STATUS_INTERNAL, "option table of %s", command->name);
    if (given == ':')
      return status_fail(error, STATUS_USAGE, "--%s needs a value: --%s %s", row->name, row->name, row->argument);
    status code_of_value = take_value(command, row, optarg, options, error);
    if (code_of_value)
      return code_of_value;
  }
  *count = (size_t)(argc - optind);
  *arguments = argv + optind;
  if (*count < command->minimum_arguments)
    return status_fail(error, STATUS_USAGE, "clast %s needs %s; usage: clast %s %s", command->name,
                       command->minimum_arguments - *count > 1 || *count == 0 ? command->arguments
                                                                              : "one more argument",
                       command->name, command->arguments);
  if (*count > command->maximum_arguments)
    return status_fail(error, STATUS_USAGE, "clast %s does not know what to do with \"%.64s\"; usage: clast %s %s",
                       command->name, (*arguments)[command->maximum_arguments], command->name, command->arguments);
  return STATUS_OK;
}

static void print_row(char letter, const char *name, const char *argument, const char *doc, const char *initial,
                      FILE *out) {
  bool has_default = initial && *initial;
  char shown[160];
  char text[1024];
  char start[4] = "   ";
  if (letter)
    snprintf(start, sizeof start, "-%c,", letter);
  snprintf(shown, sizeof shown, "  %s --%s%s%s", start, name, argument ? " " : "", argument ? argument : "");
  snprintf(text, sizeof text, "%s%s%s%s", doc, has_default ? " (default " : "", has_default ? initial : "",
           has_default ? ")" : "");
  size_t at = strlen(shown);
  fputs(shown, out);
  if (at + 2 > COLUMN + 4) {
    fputc('\n', out);
    at = 0;
  }
  text_wrap(text, at, COLUMN + 4, WIDTH, out);
}

void option_lines(const char *line, FILE *out) {
  while (*line) {
    size_t length = strcspn(line, "\n");
    fprintf(out, "  %.*s\n", (int)length, line);
    line += length + (line[length] == '\n');
  }
}

void option_help(const struct command *command, FILE *out) {
  fprintf(out, "usage: clast %s %s%s%s\n\n%s\n\noptions:\n", command->name, command->option_count ? "[OPTIONS]" : "",
          command->option_count && *command->arguments ? " " : "", command->arguments, command->doc);
  for (size_t i = 0; i < command->option_count; i++) {
    const struct option_row *row = &command->options[i];
    print_row(row->letter, row->name, row->argument, row->doc, row->initial, out);
  }
  print_row('h', "help", NULL, "Print this text.", NULL, out);
  fputs("\nexamples:\n", out);
  option_lines(command->examples, out);
  fputs("\nexit codes:\n", out);
  static const status always[] = {STATUS_OK,       STATUS_FAILED_RUNS, STATUS_USAGE, STATUS_CONTENT, STATUS_MISSING,
                                  STATUS_INTERNAL, STATUS_MEMORY,      STATUS_IO,    STATUS_STOPPED};
  for (size_t i = 0; i < sizeof always / sizeof always[0]; i++)
    if (command->has_runs || (always[i] != STATUS_FAILED_RUNS && always[i] != STATUS_STOPPED))
      fprintf(out, "  %2d  %s\n", (int)always[i], status_meaning(always[i]));
}

void option_completion(size_t count, const struct command *const *commands, FILE *out) {
  fputs("# bash completion for clast; made by `clast completion bash` from its option tables.\n"
        "# Use: source <(clast completion bash)\n"
        "_clast() {\n"
        "  local word=${COMP_WORDS[COMP_CWORD]} options=\n"
        "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
        "    COMPREPLY=($(compgen -W \"",
        out);
  for (size_t i = 0; i < count; i++)
    fprintf(out, "%s ", commands[i]->name);
  fputs("--help --version\" -- \"$word\"))\n"
        "    return\n"
        "  fi\n"
        "  case ${COMP_WORDS[1]} in\n",
        out);
  for (size_t i = 0; i < count; i++) {
    fprintf(out, "    %s) options=\"", commands[i]->name);
    for (size_t k = 0; k < commands[i]->option_count; k++)
      fprintf(out, "--%s ", commands[i]->options[k].name);
    fputs("--help\" ;;\n", out);
  }
  fputs("  esac\n"
        "  if [[ $word == -* ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
        "  else\n"
        "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
        "  fi\n"
        "}\n"
        "complete -o filenames -F _clast clast\n",
        out);
}
