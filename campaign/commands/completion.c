/* `clast completion SHELL`: the script that lets bash, zsh or fish complete. The script calls `clast completion SHELL
 * -- WORD...`, which prints what may stand in place of the last word. */
#include "campaign/commands/commands.h"

extern const char completion_bash_text[], completion_zsh_text[], completion_fish_text[]; /* completion.SHELL */

static const struct shell {
  const char *name, *script;
  const char *between; /* a word and its meaning; NULL: the shell shows no meaning */
} shells[] = {{"bash", completion_bash_text, NULL},
              {"zsh", completion_zsh_text, ":"},
              {"fish", completion_fish_text, "\t"}};

/* Prints a word if it begins with what was typed. */
static void offer(const struct shell *shell, const char *typed, const char *word, const char *meaning) {
  const bool both = shell->between && *meaning;
  if (strncmp(word, typed, strlen(typed)) == 0)
    printf("%s%s%s\n", word, both ? shell->between : "", both ? meaning : "");
}

/* Offers the paths of all inputs, each once. */
static void offer_inputs(const struct shell *shell, const char *typed, const char *after) {
  for (size_t e = 0; e < engine_count(); e++)
    for (size_t i = 0; i < engine_at(e)->inputs->count; i++) {
      const char *path = engine_at(e)->inputs->rows[i].path;
      char word[FIELD_TEXT_SIZE];
      bool seen = false;
      for (size_t before = 0; before < e && !seen; before++) {
        const struct field *same = field_find(engine_at(before)->inputs, path, NULL);
        seen = same && strcmp(same->path, path) == 0;
      }
      snprintf(word, sizeof word, "%s%s", path, after);
      if (!seen)
        offer(shell, typed, word, "");
    }
}

static void offer_commands(const struct shell *shell, const char *typed) {
  for (size_t i = 0; i < commands_count(); i++) {
    char summary[256];
    int length;
    const char *text = option_part(commands_all()[i], OPTION_SUMMARY, &length);
    snprintf(summary, sizeof summary, "%.*s", length, text);
    offer(shell, typed, commands_all()[i]->name, summary);
  }
  offer(shell, typed, "--help", "");
  offer(shell, typed, "--version", "");
}

/* True when the word is the option, by name or letter. */
static bool is_option(const struct option_row *row, const char *word) {
  return strncmp(word, "--", 2) == 0 ? strcmp(word + 2, row->name) == 0
                                     : word[0] == '-' && row->letter && word[1] == row->letter && !word[2];
}

/* words[0] is the command, words[count - 1] what was typed of the word to complete. */
static void offer_words(const struct shell *shell, size_t count, char *const *words) {
  const char *typed = words[count - 1], *before = words[count - 2];
  const struct command *command = commands_find(words[0], NULL);
  const struct option_row *row;
  if (!command)
    return;
  for (size_t i = 0; (row = option_row(command, i)); i++)
    if (is_option(row, before) && row->argument) {
      if (strcmp(row->argument, "PATH=VALUE") == 0)
        offer_inputs(shell, typed, "=");
      return; /* otherwise the shell completes files */
    }
  if (*typed == '-') {
    for (size_t i = 0; (row = option_row(command, i)); i++) {
      char word[64], doc[OPTION_DOC], meaning[OPTION_DOC];
      snprintf(word, sizeof word, "--%s", row->name);
      option_doc(command, row, doc);
      text_sentence(doc, meaning, sizeof meaning);
      offer(shell, typed, word, meaning);
    }
    offer(shell, typed, "--help", "");
  } else if (strcmp(command->name, "explain") == 0 && !strchr(typed, '/')) {
    offer_inputs(shell, typed, "");
  }
}

static status run(const struct command_line *line, struct error *error) {
  for (size_t i = 0; i < sizeof shells / sizeof shells[0]; i++) {
    if (strcmp(line->arguments[0], shells[i].name) != 0)
      continue;
    if (line->count == 1)
      fputs(shells[i].script, stdout);
    else if (line->count == 2)
      offer_commands(&shells[i], line->arguments[1]);
    else
      offer_words(&shells[i], line->count - 1, line->arguments + 1);
    return STATUS_OK;
  }
  return status_fail(error, STATUS_USAGE, "completion exists for bash, zsh and fish, not for \"%.64s\"",
                     line->arguments[0]);
}

COMMAND(completion, "about clast", "SHELL [WORD...]", .run = run);
