/* `clast materials [NAME|FILE]`: the built-in materials, or one as a document with its sources. */
#include <stdlib.h>
#include <string.h>

#include "campaign/commands/commands.h"
#include "campaign/terminal/table.h"
#include "engine/sph/material/materials.h"

struct options {
  struct table_options table;
};

/* The document's first comment line says what the material is. */
static void headline(const char *text, char *line, size_t size) {
  text += strspn(text, "# ");
  snprintf(line, size, "%.*s", (int)strcspn(text, "\n"), text);
}

static status list(enum table_format format, struct error *error) {
  struct table *table = table_new(format, stdout);
  status code = STATUS_OK;
  table_column(table, "name", NULL);
  table_column(table, "density", "kg/m^3");
  table_column(table, "bulk_modulus", "Pa");
  table_column(table, "shear_modulus", "Pa");
  table_column(table, "weibull_m", NULL);
  table_column(table, "weibull_k", "1/m^3");
  table_column(table, "what", NULL);
  for (size_t i = 0; !code && i < sph_materials_count(); i++) {
    struct sph_material material;
    char what[256];
    code = sph_materials_load(sph_materials_name(i), &material, error);
    if (code)
      break;
    headline(sph_materials_text(sph_materials_name(i)), what, sizeof what);
    table_text(table, sph_materials_name(i));
    table_real(table, material.density);
    table_real(table, material.tillotson.A);
    table_real(table, material.elastic.shear_modulus);
    table_real(table, material.weibull.m);
    table_real(table, material.weibull.k);
    table_text(table, what);
  }
  status ended = table_end(table, code ? NULL : error);
  return code ? code : ended;
}

/* Prints the document of a named material, or checks a file and prints it unchanged. */
static status print_document(const char *name, struct error *error) {
  struct sph_material material;
  char *text = NULL;
  const bool file = strchr(name, '/') || strchr(name, '.');
  const status code = file ? sph_materials_open(name, &material, &text, error)
                           : sph_materials_load(name, &material, error); /* names the nearest one */
  if (code == STATUS_OK)
    fputs(file ? text : sph_materials_text(name), stdout);
  free(text);
  return code;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  TRY(table_choose(&options->table, &format, error));
  if (line->count == 0)
    return list(format, error);
  TRY(table_text_only(&options->table, "a material's document", error));
  return print_document(line->arguments[0], error);
}

static const struct option_row rows[] = {TABLE_OPTIONS(struct options, table)};

const struct command materials_command = {
    .name = "materials",
    .group = "scenes and inputs",
    .arguments = "[NAME|FILE]",
    .summary = "the built-in materials; with a name, its document with sources",
    .doc = "Lists the materials that a scene of engine sph can name (material: basalt). With a NAME it prints the "
           "document\n"
           "of that material, with a source for each value. Save it, edit it, and give the file to a body (material:\n"
           "./my-rock.yaml). With such a FILE it checks the values in it, and prints it. If a value is missing, the "
           "scene\n"
           "that uses the file says which. A scene can override each value, and a campaign can vary it\n"
           "(target.material.weibull.m).",
    .examples = "clast materials\nclast materials basalt > my-rock.yaml",
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
