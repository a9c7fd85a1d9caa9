/* The command line as tables: one row per option, one record per command. The tables give parsing, `--help`, the
 * nearest known name after a typing error, completion and the manual page. No other place lists these names.
 *
 * A command declares a plain struct for its options, rows with offsetof into it, and a function that runs or asks. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "campaign/document/campaign.h"
#include "campaign/terminal/table.h"

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
  const char *doc;          /* one or two sentences, of a row of several commands; NULL: in the command's text */
};

/* Rows by kind: long name, letter or 0, name of the value, struct and member, range, default; `.doc = ...` follows in a
 * row of several commands. */
#define OPTION_ROW_FLAG(name_, letter_, type_, member_, ...)                                                           \
  { .name = name_, .letter = letter_, .kind = OPTION_FLAG, .offset = offsetof(type_, member_), __VA_ARGS__ }
#define OPTION_ROW_TEXT(name_, letter_, argument_, type_, member_, initial_, ...)                                      \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_TEXT, .argument = argument_, .offset = offsetof(type_, member_),  \
    .initial = initial_, __VA_ARGS__                                                                                   \
  }
#define OPTION_ROW_OUTPUT(kind_, name_, letter_, argument_, type_, member_)                                            \
  { .name = name_, .letter = letter_, .kind = kind_, .argument = argument_, .offset = offsetof(type_, member_) }
#define OPTION_ROW_LIST(name_, letter_, argument_, type_, member_, ...)                                                \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_LIST, .argument = argument_, .offset = offsetof(type_, member_),  \
    __VA_ARGS__                                                                                                        \
  }
#define OPTION_ROW_INTEGER(name_, letter_, argument_, type_, member_, minimum_, maximum_, initial_, ...)               \
  {                                                                                                                    \
    .name = name_, .letter = letter_, .kind = OPTION_INTEGER, .argument = argument_,                                   \
    .offset = offsetof(type_, member_), .minimum = minimum_, .maximum = maximum_, .initial = initial_, __VA_ARGS__     \
  }

/* Argument of a command. */
struct command_line {
  const void *options; /* the command's struct, filled */
  size_t count;        /* operands, as many as the command takes */
  char **arguments;
  bool chooses_runs;        /* of the command */
  bool lists_campaigns;     /* of the command */
  struct ask_choice choice; /* by --point, --campaign, --where and --studies */
  enum table_format format; /* by --json and --csv; TABLE_TEXT for a command without them */
  bool help;                /* --help was given; then no other argument was checked */
  int argc;                 /* the whole command line, for provenance */
  char *const *argv;
};

struct command {
  const char *name;
  const char *group;     /* heading in `clast help` */
  const char *arguments; /* "STORE [SQL]": one word each, optional ones in brackets, "..." behind a repeated one */
  const char *text;      /* campaign/commands/NAME.txt: option_part() tells its form */
  const struct option_row *options;
  size_t option_count;
  size_t options_size;  /* sizeof the options struct */
  bool has_table;       /* prints a table: has --json and --csv, too */
  bool chooses_runs;    /* asks for runs of a store: has --point, --campaign, --where and --studies, too */
  bool lists_campaigns; /* of these, it tells each campaign: also studies and searches, without --studies */
  bool has_runs;        /* exits 1 and 75 apply */
  bool computes;        /* may compute runs: has --allow-commands, too */
  bool has_farm;        /* computes with a farm: under mpirun only rank 0 prints an error (launch_quiet_ranks()) */
  /* Data goes to stdout, remarks to stderr; an error is returned, not printed. A command has `run` or `ask`. */
  status (*run)(const struct command_line *line, struct error *error);
  /* Checks the options before that; NULL: there is nothing to check. */
  status (*check)(const struct command_line *line, struct error *error);
  /* Asks the store that the first argument names, opened as a reader, and prints the answer. With
   * chooses_runs, the store shows the chosen runs alone. */
  status (*ask)(struct store *store, const struct command_line *line, struct error *error);
};
/* The options of a command: their struct and their rows (an array). */
#define COMMAND_OPTIONS(type_, rows_)                                                                                  \
  .options = (rows_), .option_count = sizeof(rows_) / sizeof(rows_)[0], .options_size = sizeof(type_)

enum { OPTION_STRUCT_MAXIMUM = 4096 }; /* largest size of an options struct */

/* argv[0] is the command's name. Fills *options (options_size bytes) and the parts of *line that come from them; the
 * operands, in order, point into argv, which is permuted. STATUS_USAGE: *error names the wrong argument and the nearest
 * known option. */
status option_parse(const struct command *command, int argc, char **argv, void *options, struct command_line *line,
                    struct error *error);

/* Claims the outputs that the options name (file_claim). STATUS_USAGE: two have the same name, or a picture has an
 * ending that cannot be drawn. STATUS_IO: one cannot be written. */
status option_claim_outputs(const struct command *command, const void *options, struct error *error);

/* The rows of a command, with those of its table: NULL behind the last one. */
const struct option_row *option_row(const struct command *command, size_t index);

/* A part of a command's text, without its last newline; *length: its bytes. The parts, with an empty line between them:
 * - the summary for `clast help`, one line;
 * - what the command does and prints, with lines broken by hand;
 * - if it has options of its own, "options:" and below it a line "NAME: one or two sentences" for each; a line that
 *   begins with two spaces continues the one above;
 * - "examples:" and below it commands that work unchanged in a folder with such files. */
enum option_part { OPTION_SUMMARY, OPTION_ABOUT, OPTION_ROWS, OPTION_EXAMPLES };
const char *option_part(const struct command *command, enum option_part part, int *length);

/* Copies what the help tells about an option, as one line; empty: nothing, which a test finds. */
enum { OPTION_DOC = 1024 };
void option_doc(const struct command *command, const struct option_row *row, char doc[OPTION_DOC]);

/* The nearest of `count` names to what was typed, or NULL when none is near (schemas/text.h). */
const char *option_nearest(const char *typed, size_t count, const char *const *names);

/* ---- options of several commands ---- */

/* Inputs of a scene. */
#define SCENE_OPTION_SET(type_, member_)                                                                               \
  OPTION_ROW_LIST(                                                                                                     \
      "set", 's', "PATH=VALUE", type_, member_,                                                                        \
      .doc =                                                                                                           \
          "Override an input of the scene: threshold.strain=3%, impact.speed='50 m/s'. May be given several times. "   \
          "clast drops inputs of the scene that no longer have an effect.")

/* Loads the scene `name` (built-in or a file), sets each PATH=VALUE of `set`, and checks it. The caller frees *scene,
 * also on errors. STATUS_USAGE, STATUS_CONTENT, what scene_load returns. */
status option_load_scene(const char *name, const struct option_list *set, struct scene **scene, struct error *error);

/* Sets and checks the inputs of a loaded scene. */
status option_set_inputs(struct scene *scene, const struct option_list *set, struct error *error);

/* Changes of a campaign for this invocation. */
struct campaign_option {
  struct option_list set;
  int64_t seeds;
  const char *within; /* a time; NULL: none */
};

#define CAMPAIGN_OPTION(type_, member_)                                                                                \
  OPTION_ROW_LIST(                                                                                                     \
      "set", 's', "PATH=VALUE", type_, member_.set,                                                                    \
      .doc = "Another value of an input, like a line under `set` of the campaign: threshold.strain=0.03. May be "      \
             "given several times."),                                                                                  \
      OPTION_ROW_INTEGER("seeds", 0, "N", type_, member_.seeds, 0, 1000000000000, "0",                                 \
                         .doc = "Number of seeds for every point, instead of the campaign's; 0: the campaign's."),     \
      OPTION_ROW_TEXT("within", 0, "TIME", type_, member_.within, NULL,                                                \
                      .doc = "Choose settings and number of seeds for the least error of the campaign's quantity in "  \
                             "so much time on the slots, such as 2h; needs a study (`clast converge`).")

/* campaign_load with the changes. slots: runs at a time, for `within`. STATUS_USAGE when a change is wrong. */
/* What a command takes again, for advice: "FILE --set 'a=2 cm' --store x.db"; store NULL: without. */
void option_words(const char *file, const struct option_list *set, const char *store, char *text, size_t size);
status option_load_campaign(const char *path, const struct campaign_option *option, int slots,
                            struct campaign **campaign, struct error *error);
