/* The command line as tables: one row per option, one record per command. The tables give parsing, `--help`, the
 * nearest known name after a typing error, bash completion and the manual page. No other place lists these names.
 *
 * A command declares a plain struct for its options, rows with offsetof into it, and a function that runs. */
#ifndef CLAST_CAMPAIGN_TERMINAL_OPTION_H
#define CLAST_CAMPAIGN_TERMINAL_OPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "schemas/status.h"

enum option_kind {
  OPTION_FLAG,    /* bool */
  OPTION_TEXT,    /* const char *, borrowed from argv; NULL when not given and without default */
  OPTION_OUTPUT,  /* the same: a file that the command writes; claimed before the command runs (schemas/file.h) */
  OPTION_PICTURE, /* the same: a picture; its ending is checked, too */
  OPTION_INTEGER, /* int64_t within [minimum, maximum] */
  OPTION_LIST,    /* struct option_list: may be given several times */
};

struct option_list {
  size_t count;
  const char *items[64];
};

struct option_row {
  const char *name; /* long name without dashes */
  char letter;      /* short form, or 0 */
  enum option_kind kind;
  const char *argument;     /* name of the value in the help: "FILE", "N"; NULL for a flag */
  size_t offset;            /* in the command's options struct */
  int64_t minimum, maximum; /* OPTION_INTEGER */
  const char *initial;      /* default, as a user would type it; NULL: zero, false, NULL */
  const char *doc;          /* one or two sentences */
};

/* Rows by kind: long name, letter or 0, name of the value, struct and member, range, default, doc. */
#define OPTION_ROW_FLAG(name_, letter_, type_, member_, doc_)                                                          \
  { .name = name_, .letter = letter_, .kind = OPTION_FLAG, .offset = offsetof(type_, member_), .doc = doc_ }
#define OPTION_ROW_TEXT(name_, letter_, argument_, type_, member_, initial_, doc_)                                     \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_TEXT, .argument = argument_, .offset = offsetof(type_, member_),  \
    .initial = initial_, .doc = doc_                                                                                   \
  }
#define OPTION_ROW_OUTPUT(kind_, name_, letter_, argument_, type_, member_, doc_)                                      \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = kind_, .argument = argument_, .offset = offsetof(type_, member_),        \
    .doc = doc_                                                                                                        \
  }
#define OPTION_ROW_LIST(name_, letter_, argument_, type_, member_, doc_)                                               \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_LIST, .argument = argument_, .offset = offsetof(type_, member_),  \
    .doc = doc_                                                                                                        \
  }
#define OPTION_ROW_INTEGER(name_, letter_, argument_, type_, member_, minimum_, maximum_, initial_, doc_)              \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_INTEGER, .argument = argument_,                                   \
    .offset = offsetof(type_, member_), .minimum = minimum_, .maximum = maximum_, .initial = initial_, .doc = doc_     \
  }

/* Argument of a command. */
struct command_line {
  const void *options; /* the command's struct, filled */
  size_t count;        /* operands, within the command's bounds */
  char **arguments;
  int argc; /* the whole command line, for provenance */
  char *const *argv;
};

struct command {
  const char *name;
  const char *group;     /* heading in `clast help` */
  const char *arguments; /* "STORE [SQL]"; optional ones in brackets, "..." for repeated ones */
  const char *summary;   /* one line for `clast help` */
  const char *doc;       /* what it does and what it prints, two or three sentences, lines broken by hand */
  const char *examples;  /* two lines, each a command that works unchanged in a folder with such files */
  size_t minimum_arguments, maximum_arguments;
  const struct option_row *options;
  size_t option_count;
  size_t options_size; /* sizeof the options struct */
  bool has_runs;       /* exits 1 and 75 apply */
  /* Prints data on stdout, remarks on stderr; an error is returned, not printed. */
  status (*run)(const struct command_line *line, struct error *error);
};
/* The options of a command: their struct and their rows (an array). */
#define COMMAND_OPTIONS(type_, rows_)                                                                                  \
  .options = (rows_), .option_count = sizeof(rows_) / sizeof(rows_)[0], .options_size = sizeof(type_)

enum { OPTION_STRUCT_MAXIMUM = 4096 }; /* largest size of an options struct */

/* argv[0] is the command's name. Fills *options (options_size bytes) and leaves the operands, in order, in *arguments
 * (pointing into argv, which is permuted). *help: --help was given; then no other argument was checked. STATUS_USAGE:
 * *error names the wrong argument and the nearest known option. */
status option_parse(const struct command *command, int argc, char **argv, void *options, size_t *count,
                    char ***arguments, bool *help, struct error *error);

/* Claims the outputs that the options name (file_claim). STATUS_USAGE: two have the same name, or a picture has an
 * ending that cannot be drawn. STATUS_IO: one cannot be written. */
status option_claim_outputs(const struct command *command, const void *options, struct error *error);

/* Prints the lines of `lines`, indented by two spaces. */
void option_lines(const char *lines, FILE *out);

void option_help(const struct command *command, FILE *out);

/* The bash completion script of all commands. It takes the paths of inputs from the variable _clast_inputs. */
void option_completion(size_t count, const struct command *const *commands, FILE *out);

/* The nearest of `count` names to what was typed, or NULL when none is near (schemas/text.h). */
const char *option_nearest(const char *typed, size_t count, const char *const *names);

#endif
