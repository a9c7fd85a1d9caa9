/* The list of commands. */
#include "campaign/commands/commands.h"

#include <string.h>

#include "db/store/store.h"

static const struct command *const all[] = {
    /* running */ &run_command,
    &plan_command,
    &simulate_command,
    &converge_command,
    &fit_command,
    &serve_command,
    &retry_command,
    /* scenes and inputs */ &scenes_command,
    &materials_command,
    &explain_command,
    &schema_command,
    &cite_command,
    /* results */ &status_command,
    &estimates_command,
    &exponents_command,
    &stats_command,
    &scatter_command,
    &sensitivity_command,
    &spectrum_command,
    &compare_command,
    &query_command,
    &plot_command,
    &map_command,
    &extremes_command,
    &picture_command,
    &report_command,
    /* the store */ &check_command,
    &export_command,
    &merge_command,
    &replay_command,
    /* about clast */ &help_command,
    &version_command,
    &completion_command,
};

size_t commands_count(void) {
  return sizeof all / sizeof all[0];
}

const struct command *const *commands_all(void) {
  return all;
}

const struct command *commands_find(const char *name, struct error *error) {
  const char *names[sizeof all / sizeof all[0]];
  for (size_t i = 0; i < commands_count(); i++) {
    if (strcmp(all[i]->name, name) == 0)
      return all[i];
    names[i] = all[i]->name;
  }
  const char *nearest = option_nearest(name, commands_count(), names);
  status_fail(error, STATUS_USAGE, "there is no command \"%.64s\"%s%s%s `clast help` lists all", name,
              nearest ? "; did you mean `clast " : ";", nearest ? nearest : "", nearest ? "`?" : "");
  return NULL;
}

status commands_ask(const struct command_line *line, const struct table_options *table, commands_question *question,
                    struct error *error) {
  enum table_format format = TABLE_TEXT;
  struct store *store = NULL;
  TRY(table ? table_choose(table, &format, error) : STATUS_OK);
  TRY(store_open_reader(line->arguments[0], &store, error));
  status code = question(store, line, format, error);
  store_close(store, NULL);
  return code;
}
