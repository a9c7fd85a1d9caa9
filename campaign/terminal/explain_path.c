/* Every path that has a row: of engines, the outcome, estimates and campaigns. */
#include "campaign/terminal/explain_path.h"

#include <string.h>

#include "analysis/statistics/estimates.h"
#include "campaign/document/campaign.h"
#include "campaign/document/campaign_keys.h"
#include "campaign/terminal/explain_words.h"
#include "engine/scene.h"

enum { TABLES_MAXIMUM = 24 };

/* All field tables of which `clast explain` knows the paths. */
static size_t tables(const struct field_table *list[TABLES_MAXIMUM]) {
  size_t count = 0;
  for (size_t i = 0; i < engine_count() && count + 5 < TABLES_MAXIMUM; i++) {
    list[count++] = engine_at(i)->inputs;
    list[count++] = engine_at(i)->results;
  }
  list[count++] = &outcome_table;
  list[count++] = &estimates_table;
  list[count++] = &campaign_table;
  list[count++] = &campaign_design_table;
  return count;
}

static bool has_prefix(const struct field_table *table, const char *prefix) {
  size_t length = strlen(prefix);
  for (size_t i = 0; i < table->count; i++)
    if (strncmp(table->rows[i].path, prefix, length) == 0 && table->rows[i].path[length] == '.')
      return true;
  return false;
}

static void explain_key(const struct campaign_key *key) {
  printf("%s: %s\n%s: %s\n%s", campaign_table.name, campaign_table.doc, key->name, key->doc, key->forms);
  if (!key->table)
    return;
  putchar('\n');
  field_explain(key->table, "", stdout);
}

/* Prints what the paths of all tables say about `path`. Returns how many tables know it. */
static size_t explain_rows(const char *path, struct text_guess *guess) {
  const struct field_table *list[TABLES_MAXIMUM];
  const size_t count = tables(list);
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    struct error missed = {.status = STATUS_OK};
    const struct field *row = field_find(list[i], path, &missed);
    if (!row && !has_prefix(list[i], path)) {
      field_guess(list[i], guess);
      continue;
    }
    printf("%s%s: %s\n", found++ ? "\n" : "", list[i]->name, list[i]->doc);
    field_explain(list[i], row ? row->path : path, stdout);
  }
  return found;
}

static void explain_table(const struct field_table *table, const char *before) {
  printf("%s%s: %s\n", before, table->name, table->doc);
  field_explain(table, "", stdout);
}

static void explain_results(void) {
  puts("results: what a run reports. In a store they are columns of the view `runs`, with underscores for dots.\n");
  explain_table(&outcome_table, "");
  for (size_t i = 0; i < engine_count(); i++)
    explain_table(engine_at(i)->results, "\n");
}

static void explain_campaign(void) {
  explain_table(&campaign_table, "");
  for (size_t i = 0; i < campaign_keys_count; i++)
    printf("\n%s: %s\n%s", campaign_keys[i].name, campaign_keys[i].doc, campaign_keys[i].forms);
}

/* A word for a whole table: campaign, results, outcome, estimates, or an engine's name. */
static bool explain_whole(const char *word) {
  if (strcmp(word, "campaign") == 0)
    explain_campaign();
  else if (strcmp(word, "results") == 0)
    explain_results();
  else if (strcmp(word, "outcome") == 0)
    explain_table(&outcome_table, "");
  else if (strcmp(word, "estimates") == 0)
    explain_table(&estimates_table, "");
  else {
    struct error missed;
    const struct engine_kind *kind = engine_find(word, &missed);
    if (!kind)
      return false;
    explain_table(kind->inputs, "");
    explain_table(kind->results, "\n");
  }
  return true;
}

status explain_path(const char *path, struct error *error) {
  struct text_guess guess = text_guess(path);
  const struct campaign_key *key = campaign_keys_find(path);
  const size_t found = explain_rows(path, &guess);
  if (found)
    return STATUS_OK;
  if (key) {
    explain_key(key);
    return STATUS_OK;
  }
  char plain[256];
  const char *said = NULL, *result = explain_words_result(path, plain, &said);
  if (explain_whole(path) || explain_words(path))
    return STATUS_OK;
  if (strcmp(result, path) != 0 && explain_rows(result, &guess)) {
    printf("%s: %s%s\n", path, said ? said : "its name in a store with runs of two engines",
           said ? ", in a store" : "");
    return STATUS_OK;
  }
  for (size_t i = 0; i < campaign_keys_count; i++)
    text_guess_offer(&guess, campaign_keys[i].name);
  char word[EXPLAIN_WORD];
  explain_words_guess(&guess, word);
  const char *nearest = guess.nearest;
  return status_fail(error, STATUS_CONTENT,
                     "nothing is called \"%.128s\"%s%s%s `clast explain` lists all paths, `clast scenes` all scenes",
                     path, nearest ? "; did you mean " : ";", nearest ? nearest : "", nearest ? "?" : "");
}

/* The row's default as text; empty for a row without default. */
static void default_text(const struct field_table *of, const struct field *row, char *text, size_t size) {
  text[0] = '\0';
  if (of == &outcome_table || of == &estimates_table || (row->flags & (FIELD_REQUIRED | FIELD_DERIVED)))
    return;
  struct field_value value;
  field_default(row, &value);
  field_print(row, &value, text, size);
}

static void list_row(struct table *table, const char *of, const char *path, const char *unit, const char *value,
                     const char *doc) {
  char text[FIELD_TEXT_SIZE];
  text_sentence(doc, text, sizeof text);
  table_text(table, of);
  table_text(table, path);
  table_text(table, unit && strcmp(unit, "1") != 0 ? unit : NULL);
  table_text(table, *value ? value : NULL);
  table_text(table, text);
}

status explain_path_list(enum table_format format, struct error *error) {
  const struct field_table *list[TABLES_MAXIMUM];
  size_t count = tables(list);
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"of", "path", "unit", "default", "meaning", NULL});
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < list[i]->count; k++) {
      const struct field *row = &list[i]->rows[k];
      char text[FIELD_TEXT_SIZE];
      default_text(list[i], row, text, sizeof text);
      list_row(table, list[i]->name, row->path, row->unit, text, row->doc);
    }
  for (size_t i = 0; i < campaign_keys_count; i++)
    list_row(table, campaign_table.name, campaign_keys[i].name, NULL, "", campaign_keys[i].doc);
  return table_end(table, error);
}
