/* `clast materials [NAME|FILE]`: the built-in materials, or one as a document with its sources. */
#include "campaign/commands/commands.h"

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

/* Prints the document of a named material, or checks a file and prints it unchanged. A fluid needs no strength, so a
 * file without it is none that is wrong. */
static status print_document(const struct engine_materials *materials, const char *name, struct error *error) {
  OWNED void *material = memory_small(1, materials->values->size);
  OWNED char *text = NULL;
  const bool file = strchr(name, '/') || strchr(name, '.');
  const status code = file ? materials->load_file(name, material, &text, error)
                           : materials->load(name, material, error); /* names the nearest one */
  char needed[512] = "";
  if (text)
    materials->also_needed(text, needed, sizeof needed);
  if (*needed)
    fprintf(stderr, "clast: a scene whose body has strength also needs %s (`clast explain target.material`)\n", needed);
  TRY(code);
  fputs(file ? text : materials->text(name), stdout);
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
  return print_document(materials_of(line->arguments[0]), line->arguments[0], error);
}

COMMAND(materials, "scenes and inputs", "[NAME|FILE]", .has_table = true, .run = run);
