/* Every command of the program, in the order `clast help` shows them. */
#ifndef CLAST_CAMPAIGN_COMMANDS_COMMANDS_H
#define CLAST_CAMPAIGN_COMMANDS_COMMANDS_H

#include "campaign/terminal/option.h"

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
/* NULL: *error says so (STATUS_USAGE) with the nearest known name. */
const struct command *commands_find(const char *name, struct error *error);

/* ---- what a command lends to another ---- */

void commands_help(FILE *out); /* what `clast help` prints */

/* `clast plan` for `clast run --dry-run`: loads a campaign, plans it and prints the plan. store NULL: the campaign's.
 * slots 0: one per core. */
struct campaign_option;
status commands_plan(const char *path, const struct campaign_option *changes, const char *store, int64_t slots,
                     bool no_trial, bool json, struct error *error);

#endif
