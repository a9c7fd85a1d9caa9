/* The glossary of the terminal, and the columns of the store. */
#include "campaign/terminal/explain_words.h"

#include <stdio.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "db/store/schema.h"
#include "schemas/text.h"

/* glossary.txt, embedded by CMakeLists.txt: words, with their other words behind them; indented, their meaning. Entries
 * are separated by empty lines. */
extern const char glossary_text[];
enum { WORDS = 128 };

/* Copies the words and the meaning of the entry at *text, and goes on to the next one. False: there is none. */
static bool read_entry(const char **text, char words[WORDS], char meaning[1024]) {
  if (!**text)
    return false;
  const char *from = strchr(*text, '\n'), *end = strstr(from, "\n\n");
  const size_t length = end ? (size_t)(end - from) : strlen(from) - 1;
  snprintf(words, WORDS, "%.*s", (int)(from - *text), *text);
  snprintf(meaning, 1024, "%.*s", (int)length, from);
  *text = end ? end + 2 : "";
  return true;
}

static bool explain_column(const char *word) {
  size_t found = 0;
  for (size_t t = 0; t < schema_tables_count; t++)
    for (size_t i = 0; i < schema_tables[t].count; i++) {
      const struct schema_column *column = &schema_tables[t].columns[i];
      if (strcmp(column->name, word) != 0)
        continue;
      if (found++ == 0)
        printf("%s: a column of a store\n", word);
      printf("  in %s: %s%s%s\n", schema_tables[t].name, column->meaning, column->unit ? ", " : "",
             column->unit ? column->unit : "");
    }
  return found > 0;
}

static bool explain_exponent(const char *word) {
  enum exponent_method method;
  enum estimates_window window;
  struct error missed;
  bool is = false;
  if (estimates_named(word, &is, &method, &window, &missed) != STATUS_OK || !is)
    return false;
  printf("%s\n    Exponent of F(m) ~ m^-beta by %s in the window %s (clast explain beta, ML, window).\n", word,
         exponent_method_names[method], estimates_window_names[window]);
  return true;
}

bool explain_words(const char *word) {
  char words[WORDS], meaning[1024];
  for (const char *text = glossary_text; read_entry(&text, words, meaning);) {
    if (!text_has_word(words, word))
      continue;
    printf("%s\n", word);
    text_wrap(meaning, 0, 4, 96, stdout);
    return true;
  }
  return explain_exponent(word) || explain_column(word);
}

void explain_words_guess(struct text_guess *guess, char name[EXPLAIN_WORD]) {
  char words[WORDS], meaning[1024];
  for (const char *text = glossary_text; read_entry(&text, words, meaning);) {
    struct text_guess offered = *guess;
    words[strcspn(words, " ")] = '\0';
    text_guess_offer(&offered, words);
    if (offered.nearest != words)
      continue;
    snprintf(name, EXPLAIN_WORD, "%s", words);
    *guess = offered;
    guess->nearest = name;
  }
}

const char *explain_words_result(const char *name, char plain[256], const char **said) {
  static const char *const ends[][2] = {{"_mean", "mean over the runs of a point"},
                                        {"_sd", "standard deviation between the runs of a point"},
                                        {"_se", "standard error of the mean over the runs of a point"},
                                        {"_resolution_verdict", "what is known of the error of the resolution"},
                                        {"_resolution", "how far finer settings may move the result"},
                                        {"_hw95", "half width of the 95 % interval of the mean over seeds"}};
  *said = NULL;
  for (size_t i = 0; i < engine_count(); i++) {
    char prefix[64];
    snprintf(prefix, sizeof prefix, "result_%s_", engine_at(i)->name);
    if (strncmp(name, prefix, strlen(prefix)) == 0) {
      name += strlen(prefix);
      break;
    }
  }
  const size_t length = strlen(name);
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    const size_t tail = strlen(ends[i][0]);
    if (length <= tail || length - tail >= 256 || strcmp(name + length - tail, ends[i][0]) != 0)
      continue;
    snprintf(plain, 256, "%.*s", (int)(length - tail), name);
    *said = ends[i][1];
    return plain;
  }
  return name;
}
