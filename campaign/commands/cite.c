/* `clast cite SCENE`: the papers of the modules that are on, from the sources of field tables and materials. */
#include "campaign/commands/commands.h"
#include "campaign/terminal/references.h"
#include "campaign/terminal/scene_option.h"
#include "campaign/terminal/scene_sources.h"
#include "campaign/terminal/table.h"

struct options {
  struct option_list set;
  bool bibtex;
  struct table_options table;
};

static void add_row(void *context, const char *what, const char *source) {
  struct table *table = context;
  char doi[512];
  references_doi(source, doi, sizeof doi);
  table_text(table, what);
  table_text(table, source);
  table_text(table, *doi ? doi : NULL);
}

enum { PAPERS = 64 };
static void note_papers(void *context, const char *what, const char *source) {
  (void)what;
  bool *named = context;
  for (size_t i = 0; i < references_count() && i < PAPERS; i++)
    named[i] = named[i] || references_named(i, source);
}

static status print_bibtex(const struct scene *scene, struct error *error) {
  bool named[PAPERS] = {false};
  scene_sources(scene, note_papers, named);
  for (size_t i = 0; i < references_count() && i < PAPERS; i++)
    if (named[i])
      references_bibtex(i, stdout);
  return table_flush(stdout, error);
}

static status print_table(const struct scene *scene, enum table_format format, struct error *error) {
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"what", "source", "doi", NULL});
  scene_sources(scene, add_row, table);
  return table_end(table, error);
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  enum table_format format = TABLE_TEXT;
  status code = table_choose(&options->table, &format, error);
  if (code == STATUS_OK && options->bibtex)
    code = table_text_only(&options->table, "BibTeX", error);
  if (code)
    return code;
  struct scene *scene = NULL;
  code = scene_option_load(line->arguments[0], &options->set, &scene, error);
  if (code == STATUS_OK)
    code = options->bibtex ? print_bibtex(scene, error) : print_table(scene, format, error);
  scene_free(scene);
  return code;
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
    OPTION_ROW_FLAG("bibtex", 0, struct options, bibtex, "Print the papers as BibTeX entries."),
    TABLE_OPTIONS(struct options, table),
};

const struct command cite_command = {
    .name = "cite",
    .group = "scenes and inputs",
    .arguments = "SCENE",
    .summary = "the papers behind what a scene switches on",
    .doc =
        "Prints the sources of a scene (a built-in name or a file) with their DOIs: sources of its engine, of the\n"
        "inputs that have an effect, of the values of its materials, and of the results. With --bibtex it prints the\n"
        "papers as BibTeX entries. `clast explain SCENE` shows the sources of the modules that are on.",
    .examples = "clast cite disc-explosion\nclast cite basalt-sphere --bibtex > papers.bib",
    .minimum_arguments = 1,
    .maximum_arguments = 1,
    COMMAND_OPTIONS(struct options, rows),
    .run = run,
};
