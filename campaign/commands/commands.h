/* Every command of the program. A command NAME has two files: NAME.c with its record, and NAME.txt with its help. */
#pragma once

/* What a command may need: standard headers, options and tables, questions, what is printed and drawn, the farm. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/converge/accuracy.h"
#include "campaign/document/campaign.h"
#include "campaign/launch/launch.h"
#include "campaign/print/print.h"
#include "campaign/terminal/option.h"
#include "campaign/terminal/table.h"
#include "db/ask/ask.h"
#include "db/store/store.h"
#include "engine/engine.h"
#include "engine/outcome.h"
#include "engine/scene.h"
#include "schemas/memory.h"
#include "schemas/text.h"

/* The commands in the order of `clast help`. */
#define COMMANDS(ENTRY)                                                                                                \
  /* running */ ENTRY(run)                                                                                             \
  ENTRY(plan)                                                                                                          \
  ENTRY(simulate)                                                                                                      \
  ENTRY(converge)                                                                                                      \
  ENTRY(find)                                                                                                          \
  ENTRY(fit)                                                                                                           \
  ENTRY(serve)                                                                                                         \
  ENTRY(retry)                                                                                                         \
  /* scenes and inputs */ ENTRY(scenes)                                                                                \
  ENTRY(materials)                                                                                                     \
  ENTRY(explain)                                                                                                       \
  ENTRY(schema)                                                                                                        \
  ENTRY(cite)                                                                                                          \
  /* results */ ENTRY(status)                                                                                          \
  ENTRY(estimates)                                                                                                     \
  ENTRY(exponents)                                                                                                     \
  ENTRY(stats)                                                                                                         \
  ENTRY(scatter)                                                                                                       \
  ENTRY(sensitivity)                                                                                                   \
  ENTRY(scaling)                                                                                                       \
  ENTRY(spectrum)                                                                                                      \
  ENTRY(compare)                                                                                                       \
  ENTRY(query)                                                                                                         \
  ENTRY(plot)                                                                                                          \
  ENTRY(map)                                                                                                           \
  ENTRY(extremes)                                                                                                      \
  ENTRY(picture)                                                                                                       \
  ENTRY(report)                                                                                                        \
  /* the store */ ENTRY(exclude)                                                                                       \
  ENTRY(check)                                                                                                         \
  ENTRY(export)                                                                                                        \
  ENTRY(merge)                                                                                                         \
  ENTRY(replay)                                                                                                        \
  /* about clast */ ENTRY(help)                                                                                        \
  ENTRY(version)                                                                                                       \
  ENTRY(completion)

/* The record of each command, and its text, which CMakeLists.txt embeds. */
#define COMMANDS_DECLARE(name_)                                                                                        \
  extern const struct command name_##_command;                                                                         \
  extern const char name_##_text[];
COMMANDS(COMMANDS_DECLARE)

/* Defines the record of a command: name, heading in `clast help`, arguments, and other members of struct command. */
#define COMMAND(name_, group_, arguments_, ...)                                                                        \
  const struct command name_##_command = {.name = #name_,                                                              \
                                          .group = group_,                                                             \
                                          .arguments = arguments_,                                                     \
                                          .text = name_##_text,                                                        \
                                          __VA_ARGS__}

size_t commands_count(void);
const struct command *const *commands_all(void);
/* Finds a command by name. NULL: unknown; *error is STATUS_USAGE with the nearest known name. */
const struct command *commands_find(const char *name, struct error *error);

/* Runs a command. */
status commands_run(const struct command *command, const struct command_line *line, struct error *error);

/* ---- shared by the commands ---- */

/* The first comment line of a built-in document, which says what it is. */
void commands_headline(const char *text, char *line, size_t size);

/* Opens the store that the first argument names as a reader, chooses the runs, calls `ask`, says how many runs
 * are excluded, and closes the store. */
status commands_ask(const struct command_line *line,
                    status (*ask)(struct store *store, const struct command_line *line, struct error *error),
                    struct error *error);

void help_overview(FILE *out);                           /* what `clast help` prints */
void help_one(const struct command *command, FILE *out); /* what `clast help COMMAND` prints */

/* `clast plan` for `clast run --dry-run`: loads a campaign, plans it and prints the plan. store NULL: the campaign's.
 * slots 0: one per core. */
status plan_campaign(const char *path, const struct campaign_option *changes, const char *store, int64_t slots,
                     bool no_trial, enum accuracy_print print, struct error *error);

/* An option of several commands: what is pooled. */
#define COMMANDS_BY(type_, member_)                                                                                    \
  OPTION_ROW_TEXT(                                                                                                     \
      "by", 'b', "AXES", type_, member_, NULL,                                                                         \
      .doc = "Pool all points that share these varied inputs (strain,angle); \"\" pools all. Default: by point.")
