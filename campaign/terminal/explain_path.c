/* Every path that has a row: of engines, the outcome, estimates and campaigns. */
#include "campaign/terminal/explain_path.h"

#include <string.h>

#include "analysis/statistics/estimates.h"
#include "campaign/document/campaign.h"
#include "campaign/document/campaign_keys.h"
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

status explain_path(const char *path, struct error *error) {
  const struct field_table *list[TABLES_MAXIMUM];
  size_t count = tables(list), found = 0;
  struct text_guess guess = text_guess(path);
  for (size_t i = 0; i < count; i++) {
    struct error missed = {.status = STATUS_OK};
    const struct field *row = field_find(list[i], path, &missed);
    if (!row && !has_prefix(list[i], path)) {
      field_guess(list[i], &guess);
      continue;
    }
    printf("%s%s: %s\n", found++ ? "\n" : "", list[i]->name, list[i]->doc);
    field_explain(list[i], row ? row->path : path, stdout);
  }
  if (found)
    return STATUS_OK;
  const struct campaign_key *key = campaign_keys_find(path);
  if (key) {
    explain_key(key);
    return STATUS_OK;
  }
  for (size_t i = 0; i < campaign_keys_count; i++)
    text_guess_offer(&guess, campaign_keys[i].name);
  const char *nearest = guess.nearest;
  return status_fail(error, STATUS_CONTENT,
                     "nothing is called \"%.128s\"%s%s%s `clast explain` lists all paths, `clast scenes` all scenes",
                     path, nearest ? "; did you mean " : ";", nearest ? nearest : "", nearest ? "?" : "");
}

/* The row's default as text; empty for what has none. */
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
