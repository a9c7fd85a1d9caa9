/* Every command of the program, in the order `clast help` shows them. */
#ifndef CLAST_CAMPAIGN_COMMANDS_COMMANDS_H
#define CLAST_CAMPAIGN_COMMANDS_COMMANDS_H

#include "campaign/terminal/option.h"
#include "campaign/terminal/table.h"

extern const struct command run_command, plan_command, simulate_command, converge_command, fit_command, serve_command;
extern const struct command explain_command, scenes_command, materials_command, schema_command, cite_command;
extern const struct command status_command, stats_command, estimates_command, spectrum_command, query_command,
    picture_command, report_command;
extern const struct command check_command, export_command, merge_command, replay_command, retry_command;
extern const struct command map_command, plot_command, compare_command, scatter_command, sensitivity_command,
    exponents_command;
extern const struct command extremes_command;
extern const struct command help_command, version_command, completion_command;

size_t commands_count(void);
const struct command *const *commands_all(void);
/* Finds a command by name. NULL: unknown; *error is STATUS_USAGE with the nearest known name. */
const struct command *commands_find(const char *name, struct error *error);

/* ---- shared by the commands ---- */

struct store;

/* Queries an open store and prints the answer. `format`: format of the command's table. */
typedef status commands_question(struct store *store, const struct command_line *line, enum table_format format,
                                 struct error *error);

/* Opens the store that the first argument names as a reader, calls `question` and closes the store. `table`: the
 * command's table options; NULL: the command has none, and `format` is TABLE_TEXT. */
status commands_ask(const struct command_line *line, const struct table_options *table, commands_question *question,
                    struct error *error);

void commands_help(FILE *out); /* what `clast help` prints */

/* `clast plan` for `clast run --dry-run`: loads a campaign, plans it and prints the plan. store NULL: the campaign's.
 * slots 0: one per core. */
struct campaign_option;
status commands_plan(const char *path, const struct campaign_option *changes, const char *store, int64_t slots,
                     bool no_trial, bool json, struct error *error);

/* Options of several commands: the points and runs that they read. */
#define COMMANDS_POINT(type_, member_)                                                                                 \
  OPTION_ROW_INTEGER("point", 'p', "N", type_, member_, 0, INT64_MAX, "0",                                             \
                     "Only this point (point_id in the view points); 0: all.")
#define COMMANDS_WHERE(type_, member_)                                                                                 \
  OPTION_ROW_TEXT("where", 'w', "SQL", type_, member_, NULL,                                                           \
                  "Only runs that meet this SQL condition on the view runs: \"threshold_strain > 0.02\".")
#define COMMANDS_BY(type_, member_)                                                                                    \
  OPTION_ROW_TEXT("by", 'b', "AXES", type_, member_, NULL,                                                             \
                  "Pool all points that share these varied inputs (strain,angle); \"\" pools all. Default: by point.")

#endif
