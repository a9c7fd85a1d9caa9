/* Reads scalars through their rows, and a mapping into a struct through its field table. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/memory.h"

enum { LIST_SIZE = 400, PATH_SIZE = 300 };

const char *document_value_what(const document_node *node) {
  switch (node->kind) {
  case DOCUMENT_SCALAR: return node->plain && !node->text[0] ? "nothing" : "a single value";
  case DOCUMENT_SEQUENCE: return "a list";
  case DOCUMENT_MAPPING: return "keys and values";
  }
  return "something else";
}

/* YAML 1.2.2, 10.3.2, the core schema: which plain scalars are null. */
bool document_value_is_null(const document_node *node) {
  static const char *const nulls[] = {"", "~", "null", "Null", "NULL", NULL};
  return node->kind == DOCUMENT_SCALAR && node->plain && text_is_one_of(node->text, nulls);
}

static void describe(const struct field *row, char *text, size_t size) {
  switch (row->kind) {
  case FIELD_REAL:
  case FIELD_INTEGER: field_describe_range(row, text, size); break;
  case FIELD_BOOLEAN: snprintf(text, size, "true or false"); break;
  case FIELD_CHOICE: field_describe_choices(row, text, size); break;
  case FIELD_TEXT: snprintf(text, size, "text"); break;
  }
}

const char *document_value_path(const document_node *node, char *path, size_t size) {
  const document_node *chain[DOCUMENT_DEEPEST + 1];
  size_t depth = 0;
  *path = 0;
  for (; node && node->parent && depth <= DOCUMENT_DEEPEST; node = node->parent)
    chain[depth++] = node;
  while (depth-- > 0) {
    const document_node *at = chain[depth];
    size_t index = 0;
    while (!at->key && at->parent->pairs[index].value != at)
      index++;
    if (at->key)
      text_append(path, size, "%s%s", *path ? "." : "", at->key->text);
    else
      text_append(path, size, "[%zu]", index);
  }
  return path;
}

/* The row's own spelling: the core schema also accepts `True` and `FALSE` as booleans. */
static const char *own_spelling(const struct field *row, const char *text) {
  static const char *const yes[] = {"True", "TRUE", NULL}, *const no[] = {"False", "FALSE", NULL};
  if (row->kind != FIELD_BOOLEAN)
    return text;
  if (text_is_one_of(text, yes))
    return "true";
  return text_is_one_of(text, no) ? "false" : text;
}

static status read_value(const document_node *node, const struct field *row, struct field_value *value,
                         struct error *error) {
  const char *what = document_value_is_null(node) ? "nothing" : document_value_what(node);
  if (document_value_is_null(node) || node->kind != DOCUMENT_SCALAR) {
    char expected[LIST_SIZE];
    describe(row, expected, sizeof expected);
    return status_fail(error, STATUS_CONTENT, "expected %s, got %s", expected, what);
  }
  const bool unitless = !row->unit || strcmp(row->unit, "1") == 0;
  if (!node->plain && row->kind == FIELD_BOOLEAN)
    return status_fail(error, STATUS_CONTENT, "expected true or false, got a text in quotes; remove the quotes");
  if (!node->plain && row->kind == FIELD_INTEGER && unitless)
    return status_fail(error, STATUS_CONTENT, "expected a whole number, got a text in quotes; remove the quotes");
  const char *text = own_spelling(row, node->text);
  return node->document->si ? field_parse_si(row, text, value, error) : field_parse(row, text, value, error);
}

bool document_value(document_node *node, const struct field *row, struct field_value *value) {
  struct error error;
  char path[PATH_SIZE] = "";
  const size_t length = strlen(row->path);
  if (node->faulty)
    return false;
  if (read_value(node, row, value, &error) == STATUS_OK)
    return true;
  const char *text = node->document->text, *end = text + node->end;
  if (node->end > 0 && node->end + 1 < node->document->size && *end == ',' && isdigit((unsigned char)end[-1]) &&
      isdigit((unsigned char)end[1]))
    text_append(error.message, sizeof error.message, "; a decimal mark is a point, as a comma ends the value here");
  /* field_parse's message begins with the row's path. The node's own path replaces it: both are equal, or the node's
   * has a prefix such as "vary.". */
  const bool named = strncmp(error.message, row->path, length) == 0 && strncmp(error.message + length, ": ", 2) == 0;
  if (node->document->error_count < DOCUMENT_MOST_ERRORS)
    document_value_path(node, path, sizeof path);
  document_report(node, *path ? path : row->path, "%s", error.message + (named ? length + 2 : 0));
  return false;
}

/* ---- keys that no table has ---- */

static const char *nearest(const char *typed, const char *const *known) {
  struct text_guess guess = text_guess(typed);
  for (size_t i = 0; known && known[i]; i++)
    text_guess_offer(&guess, known[i]);
  return guess.nearest;
}

/* Reports a key that no table has. `known`: the names that are allowed at its level. `elsewhere` (may be NULL): whole
 * paths that may have been meant. */
static void report_unknown(document_node *key, const char *path, const char *const *known, const char *elsewhere) {
  if (key->faulty)
    return;
  struct document *document = key->document;
  if (document->error_count >= DOCUMENT_MOST_ERRORS) { /* only counted: the suggestion would not be shown */
    document->error_count++;
    return;
  }

  char whole[PATH_SIZE] = "", list[LIST_SIZE] = "";
  if (path && *path)
    text_append(whole, sizeof whole, "%s.", path);
  text_append(whole, sizeof whole, "%.100s", key->text);
  for (size_t i = 0; known && known[i]; i++)
    text_append(list, sizeof list, "%s%s", i ? ", " : "", known[i]);
  if (strlen(list) == LIST_SIZE - 1) /* cut */
    memcpy(list + LIST_SIZE - 4, "...", 4);
  const char *near = nearest(key->text, known);
  const bool dotted = !near && elsewhere && strcmp(elsewhere, key->text) == 0;
  const char *const word = elsewhere ? strrchr(elsewhere, '.') : NULL;
  if (!near && (!*list || dotted || (word && strcmp(word + 1, key->text) == 0)))
    near = elsewhere; /* else the keys that are known here tell more */
  if (strcmp(key->text, "<<") == 0)
    document_report(key, whole, "merge keys are not part of YAML 1.2; write the keys out");
  else if (dotted)
    document_report(key, whole, "a path with dots; nest it: write '%.*s:' and the rest indented below it",
                    (int)strcspn(elsewhere, "."), elsewhere);
  else if (near)
    document_report(key, whole, "unknown key; did you mean '%s'?", near);
  else if (*list)
    document_report(key, whole, "unknown key; known here are %s", list);
  else
    document_report(key, whole, "unknown key; remove it");
}

void document_unknown_keys(document_node *mapping, const char *path, const char *const *known) {
  for (size_t i = 0; mapping->kind == DOCUMENT_MAPPING && i < mapping->count; i++) {
    const struct document_pair *pair = &mapping->pairs[i];
    if (!pair->seen && !text_is_one_of(pair->key->text, known))
      report_unknown(pair->key, path, known, NULL);
  }
}

/* ---- a mapping through its table ---- */

/* One reading of a table: where each row was given (NULL: not), and whether its value was good. */
struct reading {
  const struct field_table *table;
  const char *const *also;
  void *object;
  struct place {
    document_node *key, *value;
    bool good;
  } * places;
};

/* The allowed words at this level, each once. The caller frees the array and the strings. */
static char **siblings(const struct reading *r, const char *prefix) {
  const size_t length = strlen(prefix);
  size_t count = 0, extra = 0;
  while (r->also && r->also[extra])
    extra++;
  char **words = memory_small(r->table->count + extra + 1, sizeof *words);
  for (size_t i = 0; i < r->table->count; i++) {
    char word[FIELD_TEXT_SIZE];
    const size_t size = field_first_word(r->table, i, prefix, length);
    snprintf(word, sizeof word, "%.*s", (int)size, r->table->rows[i].path + length * (size > 0));
    if (size)
      words[count++] = memory_small_text(word);
  }
  for (size_t i = 0; i < extra && length == 0; i++)
    words[count++] = memory_small_text(r->also[i]);
  return words;
}

static void unknown(const struct reading *r, const document_node *mapping, document_node *key, const char *prefix) {
  if (key->document->error_count >= DOCUMENT_MOST_ERRORS) {
    report_unknown(key, NULL, NULL, NULL); /* counted */
    return;
  }
  char path[PATH_SIZE];
  char **words = siblings(r, prefix);
  char near[FIELD_NEAR_SIZE];
  report_unknown(key, document_value_path(mapping, path, sizeof path), (const char *const *)words,
                 field_nearest(r->table, key->text, near) ? near : NULL);
  for (size_t i = 0; words[i]; i++)
    free(words[i]);
  free(words);
}

/* What a key means: the value of a row, a section, or neither. */
struct meaning {
  const struct field *row;
  bool section;
};

static struct meaning meaning_of(const struct field_table *table, const char *path) {
  struct meaning found = {0};
  const size_t length = strlen(path);
  for (size_t k = 0; k < table->count && !found.row; k++) {
    const char *known = table->rows[k].path;
    if (strcmp(known, path) == 0)
      found.row = &table->rows[k];
    else if (strncmp(known, path, length) == 0 && known[length] == '.')
      found.section = true;
  }
  return found;
}

static void read_row(struct reading *r, const struct field *row, document_node *key, document_node *node) {
  struct place *place = &r->places[row - r->table->rows];
  if (place->key)
    return; /* a duplicate: already reported, the first one is used */
  struct field_value value;
  *place = (struct place){.key = key, .value = node, .good = document_value(node, row, &value)};
  if (place->good)
    field_set_unchecked(row, r->object, &value);
}

static void walk(struct reading *r, document_node *mapping, const char *prefix) {
  for (size_t i = 0; i < mapping->count; i++) {
    document_node *key = mapping->pairs[i].key, *node = mapping->pairs[i].value;
    if (key->faulty || (!*prefix && text_is_one_of(key->text, r->also)))
      continue;
    mapping->pairs[i].seen = true;

    char path[PATH_SIZE] = "";
    const bool whole = text_append(path, sizeof path - 2, "%s%s", prefix, key->text); /* room for a point */
    const bool dotted = strchr(key->text, '.') != NULL; /* "a.b: 1" instead of a section a */
    const struct meaning meaning = dotted || !whole ? (struct meaning){0} : meaning_of(r->table, path);
    if (meaning.row) {
      read_row(r, meaning.row, key, node);
    } else if (meaning.section && node->kind == DOCUMENT_MAPPING) {
      text_append(path, sizeof path, ".");
      walk(r, node, path);
    } else if (meaning.section) {
      char keys[200];
      field_members(r->table, path, "", keys, sizeof keys);
      document_report(node, document_value_path(node, path, sizeof path),
                      "expected keys and values below it (%s), got %s", keys,
                      document_value_is_null(node) ? "nothing" : document_value_what(node));
    } else {
      unknown(r, mapping, key, prefix);
    }
  }
}

/* The innermost mapping that the document has along a path: a missing key is reported there. */
static document_node *holder(document_node *mapping, const char *path) {
  for (;;) {
    size_t length = strcspn(path, ".");
    char key[PATH_SIZE];
    snprintf(key, sizeof key, "%.*s", (int)length, path);
    const struct document_pair *next = path[length] ? document_node_find(mapping, key) : NULL;
    if (!next || next->value->kind != DOCUMENT_MAPPING)
      return mapping;
    mapping = next->value;
    path += length + 1;
  }
}

/* False when a controlling row was given with a bad value: the condition cannot be evaluated. */
static bool judgeable(const struct reading *r, const struct field *row) {
  for (size_t links = 0; row && row->when && links <= r->table->count; links++) {
    row = field_controller(r->table, row);
    const struct place *place = row ? &r->places[row - r->table->rows] : NULL;
    if (place && place->key && !place->good)
      return false;
  }
  return true;
}

bool document_read(document_node *node, const struct field_table *table, const char *const *also, void *object) {
  return document_read_given(node, table, also, object, NULL, NULL);
}

static void complete_object(const struct reading *r, bool *given, document_complete complete) {
  bool *mine = given ? given : memory_small(r->table->count + 1, sizeof *mine);
  for (size_t i = 0; i < r->table->count; i++)
    mine[i] = r->places[i].key != NULL;
  if (complete)
    complete(r->object, mine);
  if (!given)
    free(mine);
}

/* A required row that is active was not given. */
static void report_missing(document_node *node, const struct field *row) {
  char path[PATH_SIZE], whole[2 * PATH_SIZE];
  const document_node *place = holder(node, row->path);
  const size_t at = place->document == node->document ? place->start : node->start;
  document_value_path(node, path, sizeof path);
  snprintf(whole, sizeof whole, "%s%s%s", path, *path ? "." : "", row->path);
  document_report_at(node->document, at, at + 1, whole, "is missing and has no default; %s",
                     row->doc ? row->doc : "give it");
}

static void judge_conditions(const struct reading *r, document_node *node) {
  for (size_t i = 0; i < r->table->count; i++) {
    const struct field *row = &r->table->rows[i];
    const struct place *place = &r->places[i];
    if (!judgeable(r, row))
      continue;
    const bool active = field_is_active(r->table, row, r->object);
    if (active && row->flags & FIELD_REQUIRED && !place->key)
      report_missing(node, row);
    if (active || !place->key)
      continue;
    char path[PATH_SIZE], why[600];
    field_describe_inactive(r->table, row, r->object, why, sizeof why);
    document_value_path(place->value, path, sizeof path);
    document_report(place->key, path, "has no effect: it is %s; remove one or change the other", why);
  }
}

bool document_read_given(document_node *node, const struct field_table *table, const char *const *also, void *object,
                         bool *given, document_complete complete) {
  const struct document *document = node->document;
  const size_t before = document->error_count + document->foreign_errors;
  if (node->faulty)
    return false;
  if (node->kind != DOCUMENT_MAPPING) {
    char path[PATH_SIZE];
    document_report(node, document_value_path(node, path, sizeof path), "expected keys and values, got %s",
                    document_value_is_null(node) ? "nothing" : document_value_what(node));
    return false;
  }
  struct reading r = {.table = table,
                      .also = also,
                      .object = object,
                      .places = memory_small(table->count + 1, sizeof *r.places)};
  walk(&r, node, "");
  complete_object(&r, given, complete);
  judge_conditions(&r, node);
  free(r.places);
  return document->error_count + document->foreign_errors == before;
}
