/* `clast cite SCENE`: the papers of the modules that are on, from the sources of field tables and materials. */
#include <ctype.h>
#include <math.h>

#include "campaign/commands/commands.h"

struct options {
  struct option_list set;
  bool bibtex;
};

/* references.bib, embedded by CMakeLists.txt. BibTeX ignores the key `cited`, the first of an entry: what sources call
 * the paper, with "; " between: names, which the year follows, or an abbreviation with the year in it. */
extern const char references_text[];
static const char cited_key[] = "  cited = {";

static const char *entry_after(const char *entry) {
  const char *end = strstr(entry, "\n}\n") + strlen("\n}\n");
  return *end ? end : NULL;
}

/* Copies the value of an entry's key; false: it has none. */
static bool value_of(const char *entry, const char *key, char *value, size_t size) {
  char mark[32];
  snprintf(mark, sizeof mark, "\n  %s = {", key);
  const char *at = strstr(entry, mark);
  if (!at || at > strstr(entry, "\n}\n"))
    return false;
  at += strlen(mark);
  snprintf(value, size, "%.*s", (int)strcspn(at, "}"), at);
  return true;
}

/* True when the names at `at` in the source are part of a longer list of names: "Monaghan" is not "Gray, Monaghan &
 * Swift". */
static bool is_longer(const char *source, const char *at, size_t length) {
  const char *behind = at + length;
  const bool ends = at >= source + 2 && (strncmp(at - 2, ", ", 2) == 0 || strncmp(at - 2, "& ", 2) == 0);
  return ends || ((behind[0] == ',' || behind[0] == ' ') && behind[1] == '&');
}

/* Does the source ("Benz & Asphaug (1994, 1995), eq. 6", "K99 table 1") name the paper of the entry? */
static bool names_paper(const char *entry, const char *source) {
  char cited[256] = "", year[16] = "", *rest = NULL;
  value_of(entry, "cited", cited, sizeof cited);
  value_of(entry, "year", year, sizeof year);
  for (char *names = strtok_r(cited, ";", &rest); names; names = strtok_r(NULL, ";", &rest)) {
    names += strspn(names, " ");
    const size_t length = strlen(names);
    const bool short_form = isdigit((unsigned char)names[length - 1]);
    for (const char *at = strstr(source, names); at; at = strstr(at + 1, names)) {
      const char *found = strstr(at + length, year); /* perhaps after other years */
      const bool year_follows = found && (size_t)(found - at) - length < strspn(at + length, " (),0123456789");
      if (short_form || (year_follows && !is_longer(source, at, length)))
        return true;
    }
  }
  return false;
}

enum { PAPERS = 64, RESTS = 400 };
struct citing {
  struct table *table; /* a row for each source; NULL: none */
  bool named[PAPERS];
  char rests[PAPERS + 1][RESTS]; /* what rests on each paper, in short; the last: on none of them */
};

/* "weibull" of target.material.weibull.k, "density of nylon" of projectile.material.density of nylon. */
static void add_short(char rests[RESTS], const char *what) {
  static const char *const heads[] = {"target.", "projectile.", "material."};
  char word[2 * FIELD_TEXT_SIZE], have[RESTS + 4], item[2 * FIELD_TEXT_SIZE + 4];
  for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
    what += strncmp(what, heads[i], strlen(heads[i])) == 0 ? strlen(heads[i]) : 0;
  snprintf(word, sizeof word, "%.*s%s", (int)strcspn(what, ". "), what, strchr(what, ' ') ? strchr(what, ' ') : "");
  snprintf(have, sizeof have, ", %s, ", rests);
  snprintf(item, sizeof item, ", %s, ", word);
  if (!strstr(have, item))
    text_append(rests, RESTS, "%s%s", *rests ? ", " : "", word);
}

/* Takes a source. `what`: its subject, which is the engine, a path, or "target.material.density of basalt". */
static void cite(struct citing *citing, const char *what, const char *source) {
  char all[512] = "", doi[128];
  size_t paper = 0;
  bool any = false;
  for (const char *entry = references_text; entry && paper < PAPERS; entry = entry_after(entry), paper++) {
    if (!names_paper(entry, source))
      continue;
    any = citing->named[paper] = true;
    add_short(citing->rests[paper], what);
    if (value_of(entry, "doi", doi, sizeof doi))
      text_append(all, sizeof all, "%s%s", *all ? " " : "", doi);
  }
  if (!any)
    add_short(citing->rests[PAPERS], what);
  if (!citing->table)
    return;
  table_text(citing->table, what);
  table_text(citing->table, source);
  table_text(citing->table, *all ? all : NULL);
}

/* A switch that is off, a law `none` or a coefficient of 0 has no effect, so that its paper is not cited. */
static bool absent(const struct field *row, const void *inputs) {
  struct field_value value;
  field_get(row, inputs, &value);
  switch (row->kind) {
  case FIELD_REAL: return isnan(value.number) || value.number == 0;
  case FIELD_BOOLEAN: return value.number == 0;
  case FIELD_CHOICE: return strcmp(value.text, "none") == 0 || strcmp(value.text, "off") == 0;
  case FIELD_INTEGER:
  case FIELD_TEXT: break;
  }
  return false;
}

/* Sources of the values of a named material; one for a section whose values have the same source. */
static void cite_materials(const struct scene *scene, struct citing *citing) {
  const struct field_table *inputs = scene->kind->inputs;
  char name[FIELD_TEXT_SIZE] = "", before[FIELD_TEXT_SIZE] = "";
  size_t section = 0; /* length of "target.material." */
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    const char *ending = strstr(row->path, ".material.");
    struct field_value value;
    if (!ending || !scene->kind->materials || !field_is_active(inputs, row, scene->inputs))
      continue;
    if (strcmp(ending, ".material.name") == 0) {
      field_get(row, scene->inputs, &value);
      snprintf(name, sizeof name, "%s", value.text);
      section = (size_t)(ending - row->path) + strlen(".material.");
      before[0] = '\0';
      continue;
    }
    char source[FIELD_TEXT_SIZE], what[2 * FIELD_TEXT_SIZE];
    if (scene->given[i] || absent(row, scene->inputs) ||
        scene->kind->materials->source(name, row->path + section, source) != STATUS_OK || strcmp(source, before) == 0)
      continue;
    snprintf(before, sizeof before, "%s", source);
    snprintf(what, sizeof what, "%s of %s", row->path, name);
    cite(citing, what, source);
  }
}

static void cite_scene(const struct scene *scene, struct citing *citing) {
  const struct field_table *inputs = scene->kind->inputs, *results = scene->kind->results;
  cite(citing, scene->kind->name, scene->kind->doc);
  for (size_t i = 0; i < inputs->count; i++)
    if (inputs->rows[i].source && field_is_active(inputs, &inputs->rows[i], scene->inputs) &&
        !absent(&inputs->rows[i], scene->inputs))
      cite(citing, inputs->rows[i].path, inputs->rows[i].source);
  cite_materials(scene, citing);
  for (size_t i = 0; i < results->count; i++)
    if (results->rows[i].source)
      cite(citing, results->rows[i].path, results->rows[i].source);
}

static status print_bibtex(const struct scene *scene, struct error *error) {
  struct citing citing = {0};
  size_t paper = 0;
  cite_scene(scene, &citing);
  for (const char *entry = references_text; entry && paper < PAPERS; entry = entry_after(entry), paper++) {
    if (!citing.named[paper])
      continue;
    const char *cited = strstr(entry, cited_key), *rest = strchr(cited, '\n') + 1;
    printf("%.*s%.*s}\n", (int)(cited - entry), entry, (int)(strstr(rest, "\n}\n") + 1 - rest), rest);
  }
  return table_flush(stdout, error);
}

/* Each paper once, with what rests on it. */
static status print_papers(const struct scene *scene, enum table_format format, struct error *error) {
  struct citing citing = {0};
  size_t paper = 0;
  cite_scene(scene, &citing);
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"paper", "doi", "for", NULL});
  for (const char *entry = references_text; entry && paper < PAPERS; entry = entry_after(entry), paper++) {
    char cited[256] = "", year[16] = "", title[256] = "", text[600], doi[128];
    if (!citing.named[paper])
      continue;
    value_of(entry, "cited", cited, sizeof cited);
    value_of(entry, "year", year, sizeof year);
    value_of(entry, "title", title, sizeof title); /* "{Title" of {{Title}} */
    snprintf(text, sizeof text, "%.*s %s: %s", (int)strcspn(cited, ";"), cited, year, title + (*title == '{'));
    table_text(table, text);
    table_text(table, value_of(entry, "doi", doi, sizeof doi) ? doi : NULL);
    table_text(table, citing.rests[paper]);
  }
  if (*citing.rests[PAPERS]) {
    table_text(table, "other sources, and our own choices");
    table_missing(table);
    table_text(table, citing.rests[PAPERS]);
  }
  TRY(table_end(table, error));
  fputs("clast: --all has the source of each input and result, --bibtex the papers as BibTeX entries\n", stderr);
  return STATUS_OK;
}

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  SCENE scene = NULL;
  if (options->bibtex)
    TRY(table_text_only(line->format, "BibTeX", error));
  TRY(option_load_scene(line->arguments[0], &options->set, &scene, error));
  if (options->bibtex)
    return print_bibtex(scene, error);
  if (line->format == TABLE_TEXT)
    return print_papers(scene, line->format, error);
  TABLE table = table_new(line->format, stdout);
  table_columns(table, (const char *const[]){"what", "source", "doi", NULL});
  cite_scene(scene, &(struct citing){.table = table});
  return table_end(table, error);
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
    OPTION_ROW_FLAG("bibtex", 0, struct options, bibtex),
};

COMMAND(cite, "scenes and inputs", "SCENE", COMMAND_OPTIONS(struct options, rows), .has_table = true, .run = run);
