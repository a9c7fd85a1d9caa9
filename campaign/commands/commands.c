/* The list of commands, and how one is run. */
#include "campaign/commands/commands.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#define COMMAND_ADDRESS(name_) &name_##_command,
static const struct command *const all[] = {COMMANDS(COMMAND_ADDRESS)};

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

status commands_ask(const struct command_line *line,
                    status (*ask)(struct store *store, const struct command_line *line, struct error *error),
                    struct error *error) {
  STORE store = NULL;
  TRY(store_open_reader(line->arguments[0], &store, error));
  TRY(ask_choose(store, &line->choice, error));
  TRY(ask(store, line, error));
  int64_t excluded = 0, others = 0, missing = 0, wanted;
  if (line->chooses_runs)
    TRY(ask_run_excluded_count(store, &excluded, error));
  if (line->chooses_runs && !line->lists_campaigns) /* those tell it by themselves */
    TRY(ask_run_missing(store, &missing, &wanted, error));
  TRY(ask_choice_others(store, &others, error));
  if (others > 0)
    fprintf(stderr,
            "clast: campaign %s: runs at its points count, whoever computed them; other campaigns computed %" PRId64
            " of them\n",
            line->choice.campaign, others);
  char numbers[ASK_CAMPAIGN_NUMBERS] = "";
  if (line->choice.campaign)
    TRY(ask_campaign_namesakes(store, line->choice.campaign, numbers, sizeof numbers, error));
  uncertainty_namesakes(numbers, line->choice.campaign, line->arguments[0]);
  uncertainty_excluded(excluded, line->arguments[0]);
  uncertainty_missing(missing, wanted, line->arguments[0]);
  uncertainty_left_out(ask_choice_left_out(store));
  return STATUS_OK;
}

static void stop_waiting(int number) {
  (void)number;
  _exit(STATUS_STOPPED);
}

/* While another program holds a store. A stop signal ends the waiting with STATUS_STOPPED: one that a farm has blocked
 * by way of the farm's end. */
static bool wait_for_store(const char *path, bool tell) {
  const struct sigaction stop = {.sa_handler = stop_waiting};
  struct sigaction now;
  sigset_t pending;
  if (tell)
    fprintf(stderr,
            "%sclast: %s: another program holds the store (a database browser with unsaved changes?): clast waits "
            "until it lets go\n",
            isatty(STDERR_FILENO) ? "\r\033[K" : "", path); /* over the line of progress */
  sigpending(&pending);
  for (size_t i = 0; i < FARM_STOP_SIGNALS; i++) {
    if (sigismember(&pending, farm_stop_signals[i]) > 0)
      return false;
    if (sigaction(farm_stop_signals[i], NULL, &now) == 0 && now.sa_handler == SIG_DFL)
      sigaction(farm_stop_signals[i], &stop, NULL);
  }
  return true;
}

status commands_run(const struct command *command, const struct command_line *line, struct error *error) {
  store_on_wait(wait_for_store);
  if (command->check)
    TRY(command->check(line, error));
  const status code = command->run ? command->run(line, error) : commands_ask(line, command->ask, error);
  return command->has_farm ? launch_quiet_ranks(code, error) : code;
}

void commands_headline(const char *text, char *line, size_t size) {
  while (*text == '#' && strstr(text, "yaml-language-server") &&
         strstr(text, "yaml-language-server") < strchr(text, '\n'))
    text = strchr(text, '\n') + 1;
  text += strspn(text, "# ");
  size_t length = strcspn(text, "\n"), whole = 0; /* whole: up to the last full stop in the line */
  for (size_t i = 0; i < length; i++)
    if ((text[i] == '.' && text[i + 1] == ' ') || (text[i + 1] == '\n' && strchr(".?)", text[i])))
      whole = i + 1;
  snprintf(line, size, "%.*s", (int)(whole ? whole : length), text);
}
