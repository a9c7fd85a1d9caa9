/* Parses by getopt_long, and makes all other output from the option tables. */
#include "campaign/terminal/option.h"

#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture_canvas.h"
#include "schemas/file.h"
#include "schemas/text.h"

enum { ROWS_MAXIMUM = 30, HELP_VALUE = 1000, ROW_VALUE = 1001, COLUMN = 26, WIDTH = 96, WORD_MAXIMUM = 63 };

const char *option_nearest(const char *typed, size_t count, const char *const *names) {
  struct text_guess guess = text_guess(typed);
  for (size_t i = 0; i < count; i++)
    text_guess_offer(&guess, names[i]);
  return guess.nearest;
}

static status take_item(const struct option_row *row, const char *text, struct option_list *list, struct error *error) {
  if (list->count == sizeof list->items / sizeof list->items[0])
    return status_fail(error, STATUS_USAGE, "--%s is given more than %zu times", row->name, list->count);
  list->items[list->count++] = text;
  return STATUS_OK;
}

static status take_integer(const struct command *command, const struct option_row *row, const char *text, int64_t *out,
                           struct error *error) {
  char *end = NULL, range[64];
  errno = 0;
  const long long number = strtoll(text, &end, 10);
  const bool whole = end != text && *end == '\0' && errno != ERANGE;
  if (whole && number >= row->minimum && number <= row->maximum) {
    *out = number;
    return STATUS_OK;
  }
  if (row->maximum == INT64_MAX)
    snprintf(range, sizeof range, "from %" PRId64 " up", row->minimum);
  else
    snprintf(range, sizeof range, "from %" PRId64 " to %" PRId64, row->minimum, row->maximum);
  return status_fail(error, STATUS_USAGE, "--%s expects a whole number %s, got \"%.64s\" (clast %s --help)", row->name,
                     range, text, command->name);
}

static status take_value(const struct command *command, const struct option_row *row, const char *text, void *options,
                         struct error *error) {
  void *slot = (char *)options + row->offset;
  switch (row->kind) {
  case OPTION_FLAG: *(bool *)slot = true; return STATUS_OK;
  case OPTION_TEXT:
  case OPTION_OUTPUT:
  case OPTION_PICTURE: *(const char **)slot = text; return STATUS_OK;
  case OPTION_LIST: return take_item(row, text, slot, error);
  case OPTION_INTEGER: return take_integer(command, row, text, slot, error);
  }
  return status_fail(error, STATUS_INTERNAL, "option --%s has no kind", row->name);
}

status option_claim_outputs(const struct command *command, const void *options, struct error *error) {
  for (size_t i = 0; i < command->option_count; i++) {
    const struct option_row *row = &command->options[i];
    char what[WORD_MAXIMUM + 1];
    if (row->kind != OPTION_OUTPUT && row->kind != OPTION_PICTURE)
      continue;
    const char *path = *(const char *const *)((const char *)options + row->offset);
    snprintf(what, sizeof what, "file of --%s", row->name);
    if (path && row->kind == OPTION_PICTURE)
      TRY(picture_canvas_named(path, error));
    if (path)
      TRY(file_claim(path, what, error));
  }
  return STATUS_OK;
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

/* A command's options in getopt_long's form. */
struct getopt_tables {
  struct option names[ROWS_MAXIMUM + 2];
  char letters[2 * ROWS_MAXIMUM + 4];
};

/* Fills the tables and sets every option to its default. */
static status prepare(const struct command *command, struct getopt_tables *tables, void *options, struct error *error) {
  if (command->option_count > ROWS_MAXIMUM || command->options_size > OPTION_STRUCT_MAXIMUM)
    return status_fail(error, STATUS_INTERNAL, "the option table of %s is too large", command->name);
  memset(options, 0, command->options_size);
  char *letter = tables->letters;
  *letter++ = ':'; /* distinguishes a missing value from an unknown option */
  *letter++ = 'h';
  for (size_t i = 0; i < command->option_count; i++) {
    const struct option_row *row = &command->options[i];
    const int takes = row->kind == OPTION_FLAG ? no_argument : required_argument;
    tables->names[i] = (struct option){.name = row->name, .has_arg = takes, .val = ROW_VALUE + (int)i};
    if (row->letter)
      *letter++ = row->letter;
    if (row->letter && takes == required_argument)
      *letter++ = ':';
    if (row->initial && take_value(command, row, row->initial, options, error))
      return status_fail(error, STATUS_INTERNAL, "the default of --%s is wrong", row->name);
  }
  *letter = '\0';
  tables->names[command->option_count] = (struct option){.name = "help", .has_arg = no_argument, .val = HELP_VALUE};
  tables->names[command->option_count + 1] = (struct option){0};
  return STATUS_OK;
}

/* The row of what getopt_long returned: a letter, or a row's number. */
static const struct option_row *find_row(const struct command *command, int value) {
  if (value >= ROW_VALUE && (size_t)(value - ROW_VALUE) < command->option_count)
    return &command->options[value - ROW_VALUE];
  for (size_t i = 0; i < command->option_count; i++)
    if (command->options[i].letter && value == command->options[i].letter)
      return &command->options[i];
  return NULL;
}

/* One option that getopt_long found; `word` is how it was typed. */
static status take_option(const struct command *command, int given, const char *word, void *options,
                          struct error *error) {
  if (given == '?' && optopt == HELP_VALUE)
    return status_fail(error, STATUS_USAGE, "--help takes no value");
  const struct option_row *row = find_row(command, given == '?' || given == ':' ? optopt : given);
  if (given == '?' && row && optopt >= ROW_VALUE)
    return status_fail(error, STATUS_USAGE, "--%s takes no value", row->name);
  if (given == '?')
    return unknown_option(command, word, optopt, error); /* optopt is 0 for a long name */
  if (!row)
    return status_fail(error, STATUS_INTERNAL, "option table of %s", command->name);
  if (given == ':')
    return status_fail(error, STATUS_USAGE, "--%s needs a value: --%s %s", row->name, row->name, row->argument);
  return take_value(command, row, optarg, options, error);
}

static status check_arguments(const struct command *command, size_t count, char *const *arguments,
                              struct error *error) {
  if (count < command->minimum_arguments) {
    const bool one = count > 0 && command->minimum_arguments - count == 1;
    return status_fail(error, STATUS_USAGE, "clast %s needs %s; usage: clast %s %s", command->name,
                       one ? "one more argument" : command->arguments, command->name, command->arguments);
  }
  if (count > command->maximum_arguments)
    return status_fail(error, STATUS_USAGE, "clast %s does not know what to do with \"%.64s\"; usage: clast %s %s",
                       command->name, arguments[command->maximum_arguments], command->name, command->arguments);
  return STATUS_OK;
}

status option_parse(const struct command *command, int argc, char **argv, void *options, size_t *count,
                    char ***arguments, bool *help, struct error *error) {
  struct getopt_tables tables;
  TRY(prepare(command, &tables, options, error));
  optind = 0; /* glibc: start over, also after another parse */
  opterr = 0;
  *help = false;

  int given;
  while ((given = getopt_long(argc, argv, tables.letters, tables.names, NULL)) != -1) {
    if (given == HELP_VALUE || given == 'h') {
      *help = true;
      return STATUS_OK;
    }
    TRY(take_option(command, given, argv[optind - 1], options, error));
  }
  *count = (size_t)(argc - optind);
  *arguments = argv + optind;
  return check_arguments(command, *count, *arguments, error);
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
        "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} options=\n"
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
        "  if [[ $before == --set || $before == -s ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$_clast_inputs\" -S = -- \"$word\"))\n"
        "    compopt -o nospace 2>/dev/null\n"
        "  elif [[ $word != -* && ${COMP_WORDS[1]} == explain && $word != */* ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$_clast_inputs\" -- \"$word\"))\n"
        "  elif [[ $word == -* ]]; then\n"
        "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
        "  else\n"
        "    COMPREPLY=($(compgen -f -- \"$word\"))\n"
        "  fi\n"
        "}\n"
        "complete -o filenames -F _clast clast\n",
        out);
}
