/* `clast explain [PATH|SCENE]`: what an input or result means; what a scene models and costs. */
#include <stdlib.h>
#include <string.h>

#include "analysis/statistics/estimates.h"
#include "campaign/commands/commands.h"
#include "campaign/commands/results.h"
#include "campaign/document/campaign.h"
#include "campaign/document/campaign_keys.h"
#include "campaign/terminal/scene_option.h"
#include "campaign/terminal/table.h"
#include "engine/scene.h"

enum { TABLES_MAXIMUM = 24 };

struct options {
  struct option_list set;
  struct table_options table;
};

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

static status explain_path(const char *path, struct error *error) {
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

static status list_paths(const struct options *options, struct error *error) {
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;
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

static void explain_inputs(const struct scene *scene, FILE *out) {
  const struct field_table *inputs = scene->kind->inputs;
  int widest = 0;
  for (size_t i = 0; i < inputs->count; i++) {
    const int length = (int)strlen(inputs->rows[i].path);
    if (length > widest && field_is_active(inputs, &inputs->rows[i], scene->inputs))
      widest = length;
  }
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    if (!field_is_active(inputs, row, scene->inputs))
      continue;
    struct field_value value;
    char text[FIELD_TEXT_SIZE], doc[FIELD_TEXT_SIZE];
    field_get(row, scene->inputs, &value);
    if (row->kind == FIELD_REAL && !field_is_off(value.number)) /* six digits are enough for the eye */
      snprintf(text, sizeof text, "%.6g%s%s", value.number, strcmp(row->unit, "1") == 0 ? "" : " ",
               strcmp(row->unit, "1") == 0 ? "" : row->unit);
    else
      field_print(row, &value, text, sizeof text);
    text_sentence(row->doc, doc, sizeof doc);
    fprintf(out, "  %-*s  %-20s %s\n", widest, row->path, text, doc);
  }
}

/* The same for programs. */
static status list_inputs(const struct scene *scene, enum table_format format, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"path", "value", "unit", "meaning", NULL});
  for (size_t i = 0; i < inputs->count; i++)
    if (field_is_active(inputs, &inputs->rows[i], scene->inputs))
      results_row(table, &inputs->rows[i], scene->inputs);
  return table_end(table, error);
}

static status explain_scene(const struct scene *scene, enum table_format format, struct error *error) {
  if (format != TABLE_TEXT)
    return list_inputs(scene, format, error);
  char *description = scene->kind->describe(scene->inputs);
  if (!description)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  printf("%s, engine %s\n\n%s%s\ninputs:\n", scene->name, scene->kind->name, description,
         *description && description[strlen(description) - 1] == '\n' ? "" : "\n");
  free(description);
  explain_inputs(scene, stdout);
  return STATUS_OK;
}

static bool is_file_name(const char *name) {
  static const char *const endings[] = {".yaml", ".yml", ".json"};
  const char *ending = strrchr(name, '.');
  if (strchr(name, '/'))
    return true;
  for (size_t i = 0; ending && i < sizeof endings / sizeof endings[0]; i++)
    if (strcmp(ending, endings[i]) == 0)
      return true;
  return false;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (line->count == 0)
    return list_paths(options, error);
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code)
    return code;

  const char *name = line->arguments[0];
  if (!is_file_name(name) && !scene_builtin_text(name) && options->set.count == 0) {
    code = table_text_only(&options->table, "the explanation of a path", error);
    return code ? code : explain_path(name, error);
  }
  struct scene *scene = NULL;
  code = scene_option_load(name, &options->set, &scene, error);
  if (code == STATUS_OK)
    code = explain_scene(scene, format, error);
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
    TABLE_OPTIONS(struct options, table),
};

const struct command explain_command = {
    .name = "explain",
    .group = "scenes and inputs",
    .arguments = "[PATH|SCENE]",
    .summary = "what an input or result means; what a scene models and costs",
    .doc =
        "With a PATH (threshold.strain, or strain if that is unique, or contact for a section, or a key of a "
        "campaign):\n"
        "meaning, unit, range, default and source. With a SCENE (a built-in name or a file): what is modelled and "
        "why,\n"
        "the expected cost, and every input with its value; with --json or --csv the inputs only. Without argument: a\n"
        "table of all inputs, results and keys.",
    .examples = "clast explain threshold.strain\nclast explain disc-explosion --set threshold.strain=5%",
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
