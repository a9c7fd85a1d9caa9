/* Counts the runs behind a number whose words mark or withhold it. */
#include <string.h>

#include "db/ask/ask.h"
#include "db/sql.h"
#include "db/store/internal.h"
#include "db/store/views.h"

static void add_word(struct ask_doubts *doubts, const char *word, const struct condition *row, int64_t runs,
                     int64_t withheld) {
  size_t k = 0;
  while (k < doubts->count && (strcmp(doubts->word[k].word, word) != 0 || doubts->word[k].row != row))
    k++;
  if (k == sizeof doubts->word / sizeof doubts->word[0])
    return; /* more words than all engines have */
  if (k == doubts->count) {
    doubts->word[k] = (struct ask_doubt){.row = row};
    snprintf(doubts->word[doubts->count++].word, CONDITION_WORD, "%s", word);
  }
  doubts->word[k].runs += runs;
  doubts->word[k].withheld += withheld;
}

enum { ABSENT = sizeof((struct ask_doubts *)0)->absent / sizeof(struct ask_absent) };

void ask_doubts_absent(struct ask_doubts *doubts, const char *name, int64_t runs, int64_t of) {
  size_t k = 0;
  while (k < ABSENT && *doubts->absent[k].name && strcmp(doubts->absent[k].name, name) != 0)
    k++;
  if (k == ABSENT || of <= 0)
    return;
  snprintf(doubts->absent[k].name, sizeof doubts->absent[k].name, "%.63s", name);
  doubts->absent[k].runs += runs;
  doubts->absent[k].of += of;
}

status ask_doubts_count(struct store *store, double *doubtful, double *of_studies, struct error *error) {
  TRY(answer_number(store, of_studies, error, "SELECT count(*) FROM runs WHERE study"));
  return answer_number(store, doubtful, error, "SELECT count(*) FROM runs WHERE counts AND doubtful");
}

enum condition_mark ask_doubts_run(struct ask_doubts *doubts, const char *engine, const char *words,
                                   const char *results, int64_t runs) {
  const struct engine_kind *kind = engine_find(engine, NULL);
  const struct condition *list = kind ? kind->conditions : NULL, *row;
  const enum condition_mark mark = condition_mark(list, words, results);
  char word[CONDITION_WORD];
  doubts->runs += runs;
  doubts->doubtful += mark != CONDITION_SOUND ? runs : 0;
  doubts->withheld += mark == CONDITION_WITHHELD ? runs : 0;
  while (words[strspn(words, ", ")])
    if (condition_next(list, &words, results, word, &row))
      add_word(doubts, word, row, runs, mark == CONDITION_WITHHELD ? runs : 0);
  return mark;
}

void ask_doubts_add(struct ask_doubts *doubts, const struct ask_doubts *others) {
  doubts->runs += others->runs;
  doubts->doubtful += others->doubtful;
  doubts->withheld += others->withheld;
  doubts->excluded += others->excluded;
  doubts->chosen = others->chosen;
  for (size_t k = 0; k < ABSENT; k++)
    ask_doubts_absent(doubts, others->absent[k].name, others->absent[k].runs, others->absent[k].of);
  for (size_t k = 0; k < others->count; k++)
    add_word(doubts, others->word[k].word, others->word[k].row, others->word[k].runs, others->word[k].withheld);
}

enum { RESULTS = 32 };

/* The columns of `results`, but that of exponents, which tell themselves when there are too few fragments. */
static size_t columns_of(const char *results, char (*name)[ASK_GROUP_NAME]) {
  size_t count = 0;
  for (size_t length; results += strspn(results, " "), *results && count < RESULTS; results += length) {
    length = strcspn(results, " ");
    snprintf(name[count], ASK_GROUP_NAME, "%.*s", (int)length, results);
    count += strcmp(name[count], OUTCOME_NAME(mean_fragment_mass)) != 0;
  }
  return count;
}

status ask_doubts(struct store *store, const struct ask_doubts_choice *choice, const char *results,
                  struct ask_doubts *doubts, struct error *error) {
  sqlite3_str *where = sqlite3_str_new(NULL), *columns = sqlite3_str_new(NULL);
  char column[RESULTS][ASK_GROUP_NAME];
  const size_t count = columns_of(results, column);
  for (size_t i = 0; i < count; i++)
    sqlite3_str_appendf(columns, ", sum(counts AND \"%w\" IS NULL)", column[i]);
  if (choice->point)
    sqlite3_str_appendf(where, " AND point_id = %lld", (long long)choice->point);
  if (choice->run)
    sqlite3_str_appendf(where, " AND run_id = %lld", (long long)choice->run);
  if (choice->where)
    sqlite3_str_appendf(where, " AND (%s\n)", choice->where);
  ANSWER
  answer =
      answer_to(store, error,
                "SELECT engine, warnings, sum(counts), sum(surplus > 1)%z FROM runs WHERE (counts = 1 OR surplus > 1) "
                "AND results_version = ifnull((SELECT max(results_version) FROM point_total t WHERE t.point_id = "
                "runs.point_id AND t.runs > 0), results_version)%z GROUP BY engine, warnings ORDER BY engine, "
                "warnings",
                sqlite3_str_finish(columns), sqlite3_str_finish(where));
  while (answer_next(&answer)) {
    const int64_t runs = answer_integer(&answer, 2);
    doubts->excluded += answer_integer(&answer, 3);
    if (runs <= 0)
      continue;
    const char *words = answer_text(&answer, 1);
    const struct engine_kind *kind = engine_find(answer_text(&answer, 0), NULL);
    (void)ask_doubts_run(doubts, answer_text(&answer, 0), words, results, runs);
    for (size_t i = 0; i < count; i++)
      if (views_has_result(kind, column[i]) &&
          condition_mark(kind ? kind->conditions : NULL, words, column[i]) != CONDITION_WITHHELD)
        ask_doubts_absent(doubts, column[i], answer_integer(&answer, 4 + i), runs);
  }
  doubts->chosen = store->chosen;
  return answer_end(&answer);
}

status ask_doubts_results(struct store *store, const char *quantities, char results[ASK_DOUBTS_RESULTS],
                          struct error *error) {
  results[0] = 0;
  if (!quantities)
    quantities = "beta";
  const bool all = strcmp(quantities, "main") == 0;
  const char *names[VIEWS_STATISTICS_MAIN];
  for (size_t i = 0; all && i < views_statistics_main(names); i++)
    text_append(results, ASK_DOUBTS_RESULTS, "%s ", names[i]);
  while (!all && *quantities) {
    char name[ASK_GROUP_NAME];
    enum exponent_method method;
    enum estimates_window window;
    bool exponent;
    quantities = text_next_item(quantities, name, sizeof name);
    TRY(estimates_named(name, &exponent, &method, &window, error));
    if (exponent)
      snprintf(name, sizeof name, "%s", OUTCOME_NAME(mean_fragment_mass));
    else
      TRY(ask_group_quantity(store, name, name, error));
    text_append(results, ASK_DOUBTS_RESULTS, "%s ", name);
  }
  return STATUS_OK;
}

void ask_doubts_words(const struct ask_doubts *doubts, char *text, size_t size) {
  *text = 0;
  for (size_t k = 0; k < doubts->count; k++)
    if (!condition_has(text, doubts->word[k].word))
      text_append(text, size, "%s%s", *text ? ", " : "", doubts->word[k].word);
}
