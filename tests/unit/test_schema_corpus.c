/* The C reader's part of schema_corpus.sh. Alone it tests that the reader judges the corpus as its folders say.
 *
 *     test_schema_corpus                              every document of corpus/<kind>/{good,bad,reader}
 *     test_schema_corpus judge scene-dem|scene-sph|campaign FILE...   lines "good FILE" or "bad FILE"
 *     test_schema_corpus generated scene-dem|scene-sph   documents made from the engine's table, one row after another,
 * with the reader's verdict: "good" or "bad", text, "%%" */
#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/campaign.h"
#include "engine/scene.h"
#include "tests/support/owned.h"

/* The engine behind "scene-<engine>"; NULL for "campaign". */
static const struct engine_kind *engine_of(const char *kind) {
  return strncmp(kind, "scene-", 6) == 0 ? engine_find(kind + 6, NULL) : NULL;
}

static bool judge(bool scene_kind, const char *path, bool show) {
  struct error error = {.status = STATUS_OK};
  status code;
  if (scene_kind) {
    SCENE scene = NULL;
    code = scene_load(path, NULL, &scene, &error);
  } else {
    CAMPAIGN campaign = NULL;
    code = campaign_load(path, &campaign, &error);
  }
  if (show && code)
    fprintf(stderr, "%s\n", error.message);
  return code == STATUS_OK;
}

static int judge_folder(const char *kind, const char *folder, bool good, int *count) {
  char whole[512], path[1024];
  int wrong = 0;
  snprintf(whole, sizeof whole, "%s/tests/unit/corpus/%s/%s", CLAST_SOURCE_DIR, kind, folder);
  DIR *list = opendir(whole);
  for (const struct dirent *entry; list && (entry = readdir(list));) {
    if (!strstr(entry->d_name, ".yaml") && !strstr(entry->d_name, ".json"))
      continue;
    snprintf(path, sizeof path, "%s/%.200s", whole, entry->d_name);
    ++*count;
    if (judge(engine_of(kind) != NULL, path, good) == good)
      continue;
    fprintf(stderr, "%s should be %s\n", path, good ? "accepted" : "refused");
    wrong++;
  }
  if (list)
    closedir(list);
  return wrong;
}

/* Nested block mapping of one or two paths, the second's common words written once. */
static void write_document(const char *engine, const char *first, const char *first_text, const char *second,
                           const char *second_text, FILE *out) {
  fprintf(out, "engine: %s\n", engine);
  int level = 0;
  const char *paths[2] = {first, second}, *texts[2] = {first_text, second_text};
  for (int p = 0; p < 2; p++) {
    const char *at = paths[p];
    if (!at)
      continue;
    size_t common = 0;
    level = 0;
    if (p == 1 && first)
      for (size_t i = 0; first[i] && first[i] == second[i]; i++)
        if (first[i] == '.')
          common = i + 1, level++;
    at += common;
    for (;; level++) {
      size_t length = strcspn(at, ".");
      fprintf(out, "%*s%.*s:", 2 * level, "", (int)length, at);
      if (!at[length])
        break;
      fputc('\n', out);
      at += length + 1;
    }
    fprintf(out, " %s\n", texts[p]);
  }
}

static void emit(const char *engine, const char *first, const char *first_text, const char *second,
                 const char *second_text) {
  OWNED char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return;
  write_document(engine, first, first_text, second, second_text, out);
  fclose(out);
  struct scene *scene = NULL;
  bool good = scene_parse("generated", text, &scene, NULL) == STATUS_OK;
  scene_free(scene);
  printf("%s\n%s%%%%\n", good ? "good" : "bad", text);
}

/* One row with one text, under every state of what it depends on. */
static void emit_row(const struct engine_kind *engine, const struct field *row, const char *text) {
  emit(engine->name, NULL, NULL, row->path, text);
  if (!row->when)
    return;
  const struct field *control = field_controller(engine->inputs, row);
  for (size_t i = 0; control && control->kind == FIELD_CHOICE && control->choices[i]; i++)
    emit(engine->name, control->path, control->choices[i], row->path, text);
  if (control && control->kind == FIELD_BOOLEAN) {
    emit(engine->name, control->path, "true", row->path, text);
    emit(engine->name, control->path, "false", row->path, text);
  }
}

static void generate(const struct engine_kind *engine) {
  static const char *const texts[] = {"3",       "3.5",  "-3",       "0",   "true",   "False", "words", "off",
                                      "null",    "~",    "",         "[1]", "{a: 1}", "yes",   "no",    "1e3",
                                      "5.0",     "1e30", "-1e30",    "007", "+1",     ".5",    "5.",    "''",
                                      "'3 x,y'", "3 _",  "\"true\"", "3 4", "1,5",    "- 3"};
  for (size_t i = 0; i < engine->inputs->count; i++) {
    const struct field *row = &engine->inputs->rows[i];
    if (row->flags & FIELD_FILE)
      continue; /* a schema cannot check whether a file exists */
    for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++)
      emit_row(engine, row, texts[k]);
    const double edges[] = {row->minimum,
                            row->maximum,
                            nextafter(row->minimum, -HUGE_VAL),
                            nextafter(row->maximum, HUGE_VAL),
                            nextafter(row->minimum, HUGE_VAL),
                            row->number};
    for (size_t k = 0; k < 6 && (row->kind == FIELD_REAL || row->kind == FIELD_INTEGER); k++) {
      char text[64];
      if (!isfinite(edges[k]))
        continue;
      field_print_number(edges[k], text);
      emit_row(engine, row, text);
      /* After a unit the schema cannot check the range, only the form. */
      const struct field_value edge = {.kind = row->kind, .number = edges[k], .integer = (int64_t)edges[k]};
      struct field_value ignored;
      if ((k != 0 && k != 5) || !field_needs_unit(row) || field_set_value(row, &edge, &ignored, NULL))
        continue;
      field_print(row, &edge, text, sizeof text);
      emit_row(engine, row, text);
    }
    for (size_t c = 0; row->kind == FIELD_CHOICE && row->choices[c]; c++)
      emit_row(engine, row, row->choices[c]);
    char unknown[140];
    snprintf(unknown, sizeof unknown, "%sx", row->path);
    emit(engine->name, NULL, NULL, unknown, "3");
    snprintf(unknown, sizeof unknown, "%s.x", row->path);
    emit(engine->name, NULL, NULL, unknown, "3");
  }
}

int main(int count, char **arguments) {
  const struct engine_kind *engine = count > 2 ? engine_of(arguments[2]) : NULL;
  if (count > 3 && strcmp(arguments[1], "judge") == 0) {
    for (int i = 3; i < count; i++)
      printf("%s %s\n", judge(engine != NULL, arguments[i], false) ? "good" : "bad", arguments[i]);
    return 0;
  }
  if (count == 3 && strcmp(arguments[1], "generated") == 0 && engine) {
    generate(engine);
    return 0;
  }
  int wrong = scene_builtin_count() == 0;
  for (size_t i = 0; i < scene_builtin_count(); i++) { /* the built-in scenes can be run unchanged */
    SCENE scene = NULL;
    struct error error;
    if (scene_load(scene_builtin_name(i), NULL, &scene, &error) || scene_check(scene, &error)) {
      fprintf(stderr, "built-in scene %s: %s\n", scene_builtin_name(i), error.message);
      wrong++;
    } else if (strcmp(scene->name, scene_builtin_name(i)) != 0) {
      fprintf(stderr, "built-in scene %s calls itself %s\n", scene_builtin_name(i), scene->name);
      wrong++;
    }
  }
  static const char *const kinds[] = {"scene-dem", "scene-sph", "campaign"};
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
    int good = 0, bad = 0;
    wrong += judge_folder(kinds[k], "good", true, &good);
    wrong += judge_folder(kinds[k], "bad", false, &bad) + judge_folder(kinds[k], "reader", false, &bad);
    fprintf(stderr, "%s: %d good and %d bad documents\n", kinds[k], good, bad);
    wrong += good < 3 || bad < 10;
  }
  return wrong != 0;
}
