/* `clast explain [PATH|WORD|SCENE]`: every path that has a row (of engines, the outcome, estimates and campaigns), the
 * words of the glossary, the columns of the store, and the model of a scene with its cost and its active inputs. */

#include "campaign/commands/commands.h"
#include "campaign/terminal/words.h"
#include "db/store/schema.h"
#include "schemas/file.h"

enum { WIDTH = 100 }; /* of lines, characters */

struct options {
  struct option_list set;
};

/* ---- words ---- */

/* glossary.txt, embedded by CMakeLists.txt: words, with their other words behind them; indented, their meaning. Entries
 * are separated by empty lines. */
extern const char glossary_text[];
enum { WORDS = 128 };

/* Copies the words and the meaning of the entry at *text, and goes on to the next one. False: there is none. */
static bool read_entry(const char **text, char words[WORDS], char meaning[1024]) {
  if (!**text)
    return false;
  const char *from = strchr(*text, '\n'), *end = strstr(from, "\n\n");
  const size_t length = end ? (size_t)(end - from) : strlen(from) - 1;
  snprintf(words, WORDS, "%.*s", (int)(from - *text), *text);
  snprintf(meaning, 1024, "%.*s", (int)length, from);
  *text = end ? end + 2 : "";
  return true;
}

static bool explain_column(const char *word) {
  size_t found = 0;
  for (size_t t = 0; t < schema_tables_count; t++)
    for (size_t i = 0; i < schema_tables[t].count; i++) {
      const struct schema_column *column = &schema_tables[t].columns[i];
      if (strcmp(column->name, word) != 0)
        continue;
      if (found++ == 0)
        printf("%s: a column of a store\n", word);
      printf("  in %s: %s%s%s\n", schema_tables[t].name, column->meaning, column->unit ? ", " : "",
             column->unit ? column->unit : "");
    }
  return found > 0;
}

static bool explain_exponent(const char *word) {
  enum exponent_method method;
  enum estimates_window window;
  struct error missed;
  bool is = false;
  if (estimates_named(word, &is, &method, &window, &missed) != STATUS_OK || !is)
    return false;
  printf("%s\n    Exponent of F(m) ~ m^-beta by %s in the window %s (clast explain beta, ML, window).\n", word,
         exponent_method_names[method], estimates_window_names[window]);
  return true;
}

/* Prints the conditions of a word as a list that is also Markdown; NULL: all. False: there is none. */
static bool explain_conditions(const char *word) {
  bool found = false;
  for (size_t i = 0; i < engine_count(); i++)
    for (const struct condition *c = engine_at(i)->conditions; c && c->word; c++) {
      if (word && strcmp(word, c->word) != 0)
        continue;
      found = true;
      char says[CONDITION_SAYS];
      words_print(stdout, "- ", "**%s** (%s): a run has this word when %s.", c->word, engine_at(i)->name,
                  condition_says(c, says));
      words_print(stdout, "  ", "Then: %s.", c->doubt);
      words_print(stdout, "  ", "%s: %s.", c->fact ? "The reason" : "The bound", c->reason);
      words_print(stdout, "  ", "What to do: %s.", c->remedy);
      words_print(stdout, "  ", "Results that rest on it%s: %s.", c->withheld ? ", which are withheld" : "",
                  !c->results    ? "all"
                  : !*c->results ? "none, it is only told before the run"
                                 : c->results);
    }
  return found;
}

/* Does a word mark every result of its engine? */
static bool marks_all(const struct condition *list, const char *word) {
  for (const struct condition *c = list; c->word; c++)
    if (!c->results && strcmp(c->word, word) == 0)
      return true;
  return false;
}

enum { RESTS = 1024 };

/* Appends the words of the conditions on which a result of an engine rests, besides those on which all rest; a withheld
 * one in parentheses. `path` NULL: the words on which all rest. */
static void rests_on(const struct engine_kind *kind, const char *path, char words[RESTS]) {
  const char *last = "", *before = "";
  for (const struct condition *c = kind->conditions; c && c->word; c++) {
    if (strcmp(last, c->word) == 0 || marks_all(kind->conditions, c->word) != !path ||
        (path && condition_mark(c, c->word, path) == CONDITION_SOUND))
      continue;
    const bool withheld = path ? condition_mark(kind->conditions, c->word, path) == CONDITION_WITHHELD : c->withheld;
    text_append(words, RESTS, withheld ? "%s(%s)" : "%s%s", before, c->word);
    last = c->word;
    before = ", ";
  }
}

/* Prints them as an item of a list; nothing when there are none. */
static void explain_rests_on(const struct engine_kind *kind, const char *path) {
  char words[RESTS] = "";
  rests_on(kind, path, words);
  if (*words)
    words_print(stdout, "- ", "%s (%s): %s", path ? path : "every result", kind->name, words);
}

/* Prints all conditions of a row that is a result. */
static void explain_doubts_of(const struct field_table *table, const char *path) {
  for (size_t i = 0; i < engine_count(); i++) {
    const struct engine_kind *kind = engine_at(i);
    char own[RESTS] = "", every[RESTS] = "";
    if (table != &outcome_table && table != kind->results)
      continue;
    rests_on(kind, path, own);
    rests_on(kind, NULL, every);
    if (!*own && !*every)
      continue;
    words_print(stdout, "    ", "Conditions (%s)%s: %s%s%s%s", kind->name,
                strchr(own, '(') ? "; a condition in parentheses withholds it" : "", own, *own ? "; " : "",
                *every ? "those of every result: " : "", every);
  }
}

/* Prints the meaning of a word of the glossary. */
static bool explain_glossary(const char *word) {
  char words[WORDS], meaning[1024];
  for (const char *text = glossary_text; read_entry(&text, words, meaning);) {
    if (!text_has_word(words, word))
      continue;
    printf("%s\n", word);
    text_wrap(meaning, 0, 4, 96, stdout);
    return true;
  }
  return false;
}

/* Prints the meaning of an exponent or a column of the store. False: it is neither. */
static bool explain_word(const char *word) {
  return explain_exponent(word) || explain_column(word);
}

/* Offers all words to the search for the nearest name. `name` keeps the one that is the nearest. */
static void guess_word(struct text_guess *guess, char name[WORDS]) {
  char words[WORDS], meaning[1024];
  for (const char *text = glossary_text; read_entry(&text, words, meaning);) {
    struct text_guess offered = *guess;
    words[strcspn(words, " ")] = '\0';
    text_guess_offer(&offered, words);
    if (offered.nearest != words)
      continue;
    snprintf(name, WORDS, "%s", words);
    *guess = offered;
    guess->nearest = name;
  }
}

/* The path of a result by one of its names in tables: "energy_kinetic" of "result_dem_energy_kinetic", and of
 * "energy_kinetic_mean". *said: meaning of the rest of the name, or NULL. The result points into `name` or `plain`. */
static const char *result_of(const char *name, char plain[256], const char **said) {
  static const char *const ends[][2] = {{"_mean", "mean over the runs of a point"},
                                        {"_sd", "standard deviation between the runs of a point"},
                                        {"_se", "standard error of the mean over the runs of a point"},
                                        {"_resolution_verdict", "what is known of the error of the resolution"},
                                        {"_resolution", "how far finer settings may move the result"},
                                        {"_hw95", "half width of the 95 % interval of the mean over seeds"},
                                        {"_low95", "lower end of the 95 % interval of the mean over seeds"},
                                        {"_high95", "upper end of the 95 % interval of the mean over seeds"},
                                        {"_weak", "1: too few runs of this kind for the interval of the mean"}};
  *said = NULL;
  for (size_t i = 0; i < engine_count(); i++) {
    char prefix[64];
    snprintf(prefix, sizeof prefix, "result_%s_", engine_at(i)->name);
    if (strncmp(name, prefix, strlen(prefix)) == 0) {
      name += strlen(prefix);
      break;
    }
  }
  const size_t length = strlen(name);
  for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
    const size_t tail = strlen(ends[i][0]);
    if (length <= tail || length - tail >= 256 || strcmp(name + length - tail, ends[i][0]) != 0)
      continue;
    snprintf(plain, 256, "%.*s", (int)(length - tail), name);
    *said = ends[i][1];
    return plain;
  }
  return name;
}

/* ---- paths ---- */

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

/* Results, outcome and estimates have no defaults. */
static bool has_results(const struct field_table *table) {
  bool is = table == &outcome_table || table == &estimates_table;
  for (size_t i = 0; i < engine_count(); i++)
    is |= table == engine_at(i)->results;
  return is;
}

/* Another row with the last part of the path that `first` has. */
static void explain_another(const struct field_table *table, const struct field *first, const struct field *row) {
  if (first->doc && row->doc && strcmp(first->doc, row->doc) == 0)
    printf("%s: the same of another body or law\n", row->path);
  else
    field_explain(table, row->path, has_results(table), stdout);
}

/* Prints what the paths of all tables say about `path`, `after` other text. Returns how many tables know it. */
static size_t explain_rows(const char *path, bool after, struct text_guess *guess) {
  const struct field_table *list[TABLES_MAXIMUM];
  const size_t count = tables(list);
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    struct error missed = {.status = STATUS_OK};
    const struct field *row = field_find(list[i], path, &missed);
    const bool section = has_prefix(list[i], path);
    const struct field *first = row || section ? NULL : field_ending(list[i], path, NULL);
    if (!row && !section && !first) {
      field_guess(list[i], guess);
      continue;
    }
    fputs(found++ || after ? "\n" : "", stdout);
    words_print(stdout, "", "%s: %s", list[i]->name, list[i]->doc);
    if (row || first) {
      field_explain(list[i], row ? row->path : first->path, has_results(list[i]), stdout);
      explain_doubts_of(list[i], row ? row->path : first->path);
    }
    if (section)
      field_explain(list[i], path, has_results(list[i]), stdout);
    for (const struct field *next = first; next && (next = field_ending(list[i], path, next));)
      explain_another(list[i], first, next);
  }
  return found;
}

static void explain_table(const struct field_table *table, const char *before) {
  fputs(before, stdout);
  words_print(stdout, "", "%s: %s", table->name, table->doc);
  field_explain(table, "", has_results(table), stdout);
}

/* A word for a whole table: campaign, results, outcome, estimates, or an engine's name. */
static bool explain_whole(const char *word) {
  const struct engine_kind *kind = engine_find(word, NULL);
  if (strcmp(word, "campaign") == 0) {
    explain_table(&campaign_table, "");
    for (size_t i = 0; i < campaign_keys_count; i++)
      printf("\n%s: %s\n%s", campaign_keys[i].name, campaign_keys[i].doc, campaign_keys[i].forms);
  } else if (strcmp(word, "results") == 0) {
    puts("results: what a run reports. In a store: columns of the view `runs`, with underscores for dots.\n");
    explain_table(&outcome_table, "");
    for (size_t i = 0; i < engine_count(); i++)
      explain_table(engine_at(i)->results, "\n");
  } else if (strcmp(word, "conditions") == 0) {
    puts("# What a number rests on\n");
    words_print(stdout, "",
                "Each condition compares a number with a bound, before the run or at its end. A run beyond a bound has "
                "the condition's word in its result `warnings`, and stays in every mean. The program made this text "
                "from the rows in engine/*/scene/conditions.c (`clast explain conditions`).");
    puts("\n## Results and their conditions\n\nIn parentheses: beyond the bound the result is withheld.\n");
    for (size_t i = 0; i < engine_count(); i++) {
      const struct field_table *tables[] = {&outcome_table, engine_at(i)->results};
      explain_rests_on(engine_at(i), NULL);
      for (size_t t = 0; t < 2; t++)
        for (size_t k = 0; k < tables[t]->count; k++)
          explain_rests_on(engine_at(i), tables[t]->rows[k].path);
    }
    puts("\n## Conditions\n");
    explain_conditions(NULL);
  } else if (strcmp(word, "outcome") == 0) {
    explain_table(&outcome_table, "");
  } else if (strcmp(word, "estimates") == 0) {
    explain_table(&estimates_table, "");
  } else if (kind) {
    explain_table(kind->inputs, "");
    explain_table(kind->results, "\n");
    for (size_t i = 0; kind->sections && kind->sections[i]; i++)
      explain_table(kind->sections[i], "\n");
  } else {
    return false;
  }
  return true;
}

/* Explains on stdout all rows that a path, its unique ending, a section or a key names. STATUS_CONTENT: there is none;
 * *error has the nearest known path. */
static status explain_path(const char *path, struct error *error) {
  struct text_guess guess = text_guess(path);
  const struct campaign_key *key = campaign_keys_find(path);
  bool word = explain_glossary(path);
  word = explain_conditions(path) || word; /* first: messages send here, and a path may end in the same word */
  if (word && (strchr(path, '/') || explain_whole(path)))
    return STATUS_OK;
  if (explain_rows(path, word, &guess)) {
    if (strcmp(path, OUTCOME_NAME(warnings)) == 0 && putchar('\n'))
      explain_conditions(NULL);
    return STATUS_OK;
  }
  if (key) {
    printf("%s%s: %s\n%s: %s\n%s", word ? "\n" : "", campaign_table.name, campaign_table.doc, key->name, key->doc,
           key->forms);
    if (key->table) {
      putchar('\n');
      field_explain(key->table, "", has_results(key->table), stdout);
    }
    return STATUS_OK;
  }
  char plain[256];
  const char *said = NULL, *result = result_of(path, plain, &said);
  if (explain_whole(path) || explain_word(path) || word)
    return STATUS_OK;
  if (strcmp(result, path) != 0 && explain_rows(result, false, &guess)) {
    printf("%s: %s%s\n", path, said ? said : "its name in a store with runs of two engines",
           said ? ", in a store" : "");
    return STATUS_OK;
  }
  for (size_t i = 0; i < campaign_keys_count; i++)
    text_guess_offer(&guess, campaign_keys[i].name);
  char near[WORDS];
  guess_word(&guess, near);
  const char *nearest = guess.nearest;
  return status_fail(error, STATUS_CONTENT,
                     "nothing is called \"%.128s\"%s%s%s `clast explain` lists all paths, `clast scenes` all scenes",
                     path, nearest ? "; did you mean " : ";", nearest ? nearest : "", nearest ? "?" : "");
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

/* A table of all paths, on stdout. */
static status explain_path_list(enum table_format format, struct error *error) {
  const struct field_table *list[TABLES_MAXIMUM];
  size_t count = tables(list);
  const bool people = table_for_people(format);
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"of", "path", "unit", "default", "meaning", NULL});
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < list[i]->count; k++) {
      const struct field *row = &list[i]->rows[k];
      const bool has_default = list[i] != &outcome_table && list[i] != &estimates_table &&
                               !(row->flags & (FIELD_REQUIRED | FIELD_DERIVED));
      char text[FIELD_TEXT_SIZE] = "";
      struct field_value value;
      if (has_default) {
        field_default(row, &value);
        (people ? field_show : field_print)(row, &value, text, sizeof text);
      }
      const bool angle = people && row->unit && strcmp(row->unit, "rad") == 0;
      list_row(table, list[i]->name, row->path, angle ? "deg" : row->unit, text, row->doc);
    }
  for (size_t i = 0; i < campaign_keys_count; i++)
    list_row(table, campaign_table.name, campaign_keys[i].name, NULL, "", campaign_keys[i].doc);
  return table_end(table, error);
}

/* ---- scenes ---- */

/* The active inputs; unless `all`, those that the scene gives. A scene that names its inputs itself is judged by them
 * before its program is allowed. */
static status print_inputs(const struct scene *scene, bool every, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  const bool all = every || scene->kind->definition;
  TABLE table = table_new(TABLE_ALL, stdout);
  table_columns(table, (const char *const[]){"input", "value", "meaning", NULL});
  size_t others = 0;
  for (size_t i = 0; i < inputs->count; i++) {
    const struct field *row = &inputs->rows[i];
    char text[FIELD_TEXT_SIZE], doc[FIELD_TEXT_SIZE];
    if (!field_is_active(inputs, row, scene->inputs))
      continue;
    others += !all && !scene->given[i];
    if (!all && !scene->given[i])
      continue;
    struct field_value value;
    field_get(row, scene->inputs, &value);
    field_show(row, &value, text, sizeof text);
    text_sentence(row->doc, doc, sizeof doc);
    table_text(table, row->path);
    table_text(table, text);
    table_text(table, doc);
  }
  TRY(table_end(table, error));
  if (others)
    printf("%zu other inputs have defaults; --all lists them, and says what is modelled and why\n", others);
  else if (!every && all)
    puts("--all shows the files, too");
  return STATUS_OK;
}

/* All active inputs for programs. */
static status list_inputs(const struct scene *scene, enum table_format format, struct error *error) {
  const struct field_table *inputs = scene->kind->inputs;
  TABLE table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"path", "value", "unit", "meaning", NULL});
  for (size_t i = 0; i < inputs->count; i++)
    if (field_is_active(inputs, &inputs->rows[i], scene->inputs))
      print_results_row(table, &inputs->rows[i], scene->inputs);
  return table_end(table, error);
}

/* "basalt-sphere@draft: fidelity.particles 10000, fidelity.precision float" */
static void list_settings(const struct scene *scene) {
  for (size_t i = 0; i < scene->settings_count; i++) {
    const struct scene_settings *settings = &scene->settings[i];
    OWNED char *line = NULL;
    FILE *out = text_open(&line);
    fprintf(out, "  %s@%s:", scene->name, settings->name);
    for (size_t j = 0; j < settings->count; j++) {
      const struct field *row = &scene->kind->inputs->rows[settings->item[j].row];
      char value[FIELD_TEXT_SIZE];
      field_show(row, &settings->item[j].value, value, sizeof value);
      fprintf(out, "%s %s %s", j ? "," : "", row->path, value);
    }
    text_close_small(out, &line);
    text_wrap_lines(line, WIDTH, stdout);
  }
}

/* Prints on stdout; for programs only the inputs. */
static status explain_scene(const struct scene *scene, enum table_format format, struct error *error) {
  if (!table_for_people(format))
    return list_inputs(scene, format, error);
  const bool all = format == TABLE_ALL;
  OWNED char *description = scene->kind->describe(scene->inputs, all);
  OWNED char *doubts = NULL;
  FILE *doubt = text_open(&doubts);
  fputs("in doubt: ", doubt);
  if (!condition_before(scene->kind->conditions, scene->inputs, doubt))
    fputs("nothing that the inputs alone tell\n", doubt);
  text_close_small(doubt, &doubts);
  if (!description)
    return status_fail(error, STATUS_MEMORY, "out of memory");
  char *const rest = all ? NULL : strstr(description, "\n\n"); /* what a user asks first comes first */
  if (rest)
    rest[1] = '\0';
  printf("%s, engine %s\n", scene->name, scene->kind->name);
  text_wrap_lines(description, WIDTH, stdout);
  text_wrap_lines(doubts, WIDTH, stdout);
  campaign_tell_kept(scene, "", stdout);
  putchar('\n');
  TRY(print_inputs(scene, all, error));
  if (rest) {
    putchar('\n');
    text_wrap_lines(rest + 2, WIDTH, stdout);
  }
  if (scene->settings_count > 0)
    puts("\nnamed settings (campaign/accuracy.md):");
  list_settings(scene);
  return STATUS_OK;
}

/* ---- the command ---- */

static status run(const struct command_line *line, struct error *error) {
  const struct options *options = line->options;
  if (line->count == 0)
    return explain_path_list(line->format, error);

  char name[FIELD_TEXT_SIZE], words[WORDS], meaning[1024]; /* "equation of state" is a word with underscores */
  const char *given = line->arguments[0];
  const bool heading = strncmp(given, "\xc2\xb1", 2) == 0; /* "±res" */
  snprintf(name, sizeof name, "%s", given + (heading ? 2 : 0));
  for (char *at = name; (at = strchr(at, ' '));)
    *at = '_';
  bool is_word = false;
  for (const char *text = glossary_text; !is_word && read_entry(&text, words, meaning);)
    is_word = text_has_word(words, name);
  const bool is_scene = (!is_word && file_name_is_document(given)) || strchr(given, '@') || scene_builtin_text(given) ||
                        options->set.count;
  if (!is_scene) {
    TRY(table_text_only(line->format, "the explanation of a path", error));
    return explain_path(name, error);
  }
  SCENE scene = NULL;
  TRY(option_load_scene(given, &options->set, &scene, error));
  return explain_scene(scene, line->format, error);
}

static const struct option_row rows[] = {
    SCENE_OPTION_SET(struct options, set),
};

COMMAND(explain, "scenes and inputs", "[PATH|WORD|SCENE]", COMMAND_OPTIONS(struct options, rows), .has_table = true,
        .run = run);
