/* `clast materials [NAME|FILE]`: the built-in materials, or one as a document with its sources. */
#include <math.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/words.h"

/* The materials of one engine. */
static status list(const struct engine_materials *materials, enum table_format format, struct error *error) {
  const struct field_table *values = materials->values;
  OWNED void *material = memory_small(1, values->size);
  TABLE table = table_new(format, stdout);
  table_column(table, "name", NULL);
  for (size_t k = 0; materials->overview[k][0]; k++) {
    const char *unit = field_find(values, materials->overview[k][1], NULL)->unit;
    table_column(table, materials->overview[k][0], strcmp(unit, "1") == 0 ? NULL : unit);
  }
  table_column(table, "what", NULL);
  for (size_t i = 0; materials->name(i); i++) {
    char what[256];
    TRY(materials->load(materials->name(i), material, error));
    commands_headline(materials->text(materials->name(i)), what, sizeof what);
    table_text(table, materials->name(i));
    for (size_t k = 0; materials->overview[k][0]; k++) {
      struct field_value value;
      field_get(field_find(values, materials->overview[k][1], NULL), material, &value);
      table_real(table, value.number);
    }
    table_text(table, what);
  }
  return table_end(table, error);
}

/* Judges a file as a scene does that takes its material; with `fewer`, one whose body needs fewer values. Tells of the
 * conditions that this material breaks. */
static status judge(const struct engine_materials *materials, const char *file, bool fewer, struct error *error) {
  const struct engine_trial *trial = &materials->trial;
  SCENE scene = NULL;
  TRY(scene_parse("material", trial->scene, &scene, error));
  if (fewer)
    TRY(scene_set_text(scene, trial->input, trial->value, error));
  const struct condition *list = scene->kind->conditions;
  const condition_set before = condition_before(list, scene->inputs, NULL);
  TRY(scene_set_text(scene, trial->section, file, error));
  TRY(scene_check(scene, error));
  const condition_set broken = condition_before(list, scene->inputs, NULL) & ~before;
  for (size_t k = 0; list[k].word; k++) {
    char says[CONDITION_SAYS];
    if (broken >> k & 1)
      words_print(stderr, "", "clast: warning: %s: %s (clast explain %s)", list[k].word, condition_says(&list[k], says),
                  list[k].word);
  }
  return STATUS_OK;
}

/* What a file leaves to the material that it is like, and of which values it gives one of two that belong together. */
static status tell_like(const struct engine_materials *materials, document_node *root, struct error *error) {
  const struct field_table *values = materials->values;
  static const char *const words[] = {"material", "source", "sources", "like", NULL};
  OWNED void *own = memory_small(1, values->size), *like = memory_small(1, values->size); /* both at last */
  OWNED bool *given = memory_small(values->count, sizeof *given);
  document_node *name = document_key(root, "like");
  char text[2048] = "", shown[FIELD_TEXT_SIZE];
  bool one[2] = {false};
  if (!name || !document_scalar(name))
    return STATUS_OK;
  TRY(materials->load(document_scalar(name), like, error));
  field_defaults(values, own);
  document_read_given(root, values, words, own, given, NULL);
  for (size_t i = 0; i < values->count; i++) {
    struct field_value value;
    for (int k = 0; k < 2; k++)
      one[k] |= given[i] && strcmp(values->rows[i].path, materials->together[k]) == 0;
    field_get(&values->rows[i], own, &value);
    if (given[i])
      TRY(field_set(&values->rows[i], like, &value, error));
  }
  for (size_t i = 0; i < values->count; i++) {
    const struct field *row = &values->rows[i];
    struct field_value value;
    bool other = false;
    field_get(row, like, &value);
    for (int k = 0; k < 2; k++) /* the other name of a value that the file gives */
      other |= strcmp(row->path, materials->either[k]) == 0 &&
               given[field_find(values, materials->either[1 - k], NULL) - values->rows];
    if (other || given[i] || !field_is_active(values, row, like) || (row->kind == FIELD_REAL && isnan(value.number)))
      continue;
    field_show(row, &value, shown, sizeof shown);
    text_append(text, sizeof text, "%s%s %s", *text ? ", " : "", row->path, shown);
  }
  if (*text)
    words_print(stderr, "", "clast: as in %s: %s", document_scalar(name), text);
  if (one[0] != one[1])
    words_print(stderr, "",
                "clast: warning: %s is the file's own and %s is that of %s: one measurement gives both, and "
                "one alone means little. Give both",
                materials->together[!one[0]], materials->together[one[0]], document_scalar(name));
  return STATUS_OK;
}

/* Checks a material's file and prints it unchanged. */
static status check_file(const struct engine_materials *materials, const char *file, struct error *error) {
  DOCUMENT document = NULL;
  struct error other;
  const status code = judge(materials, file, false, error);
  if (code != STATUS_OK && judge(materials, file, true, &other) != STATUS_OK)
    return code;
  if (code != STATUS_OK)
    words_print(stderr, "", "clast: this is a material for %s; another one refuses it: %s", materials->trial.what,
                error->message);
  TRY(document_open(file, &document, error));
  fputs(document_text(document), stdout);
  return tell_like(materials, document_root(document), error);
}

/* Prints the document of a named material; it names the nearest one. */
static status print_document(const struct engine_materials *materials, const char *name, struct error *error) {
  OWNED void *material = memory_small(1, materials->values->size);
  TRY(materials->load(name, material, error));
  fputs(materials->text(name), stdout);
  return STATUS_OK;
}

/* The first engine with materials, or the one that has this name. */
static const struct engine_materials *materials_of(const char *name) {
  const struct engine_materials *first = NULL;
  for (size_t i = 0; i < engine_count(); i++) {
    const struct engine_materials *materials = engine_at(i)->materials;
    if (materials && name && materials->text(name))
      return materials;
    first = first ? first : materials;
  }
  return first;
}

static status run(const struct command_line *line, struct error *error) {
  if (line->count == 0) {
    for (size_t i = 0; i < engine_count(); i++)
      if (engine_at(i)->materials)
        TRY(list(engine_at(i)->materials, line->format, error));
    return STATUS_OK;
  }
  TRY(table_text_only(line->format, "a material's document", error));
  const char *name = line->arguments[0];
  const bool file = strchr(name, '/') || strchr(name, '.');
  return (file ? check_file : print_document)(materials_of(name), name, error);
}

COMMAND(materials, "scenes and inputs", "[NAME|FILE]", .has_table = true, .run = run);
