/* JSON Schema of a field table: properties, then conditions as if/then clauses. */
#include "schemas/json_schema.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

/* A decimal number, perhaps with a unit behind it. A schema cannot check the unit or the value in SI; the reader checks
 * them. The last part keeps `$` from matching before a line end. */
#define NUMBER          "^ *[-+]?([0-9]+\\\\.?[0-9]*|\\\\.[0-9]+)([eE][-+]?[0-9]+)?"
#define UNIT            " *[^-+0-9. ,_\\\\n][^,_\\\\n]*| +1/[^,_\\\\n]+)$(?!\\\\n)"
#define NUMBER_AND_UNIT NUMBER "( *|" UNIT /* the unit may be left out */
#define NUMBER_IN_UNIT  NUMBER "(" UNIT

static void margin(int indent, FILE *out) {
  fprintf(out, "\n%*s", 2 * indent, "");
}

static void number(double value, FILE *out) {
  char text[32];
  field_print_number(value, text);
  fputs(text, out);
}

static void range(const struct field *row, FILE *out) {
  if (row->minimum > -HUGE_VAL) {
    fprintf(out, ", \"%s\": ", row->flags & FIELD_ABOVE_MINIMUM ? "exclusiveMinimum" : "minimum");
    number(row->minimum, out);
  }
  if (row->maximum < HUGE_VAL) {
    fprintf(out, ", \"%s\": ", row->flags & FIELD_BELOW_MAXIMUM ? "exclusiveMaximum" : "maximum");
    number(row->maximum, out);
  }
}

/* A number without a unit, within the row's range. For a row with a unit only 0. */
static void bare(const struct field *row, FILE *out) {
  const bool zero = row->flags & FIELD_ABOVE_MINIMUM ? row->minimum < 0 : row->minimum <= 0;
  if (field_needs_unit(row)) {
    fputs(zero ? "{\"const\": 0}, " : "", out);
    return;
  }
  fputs("{\"type\": \"number\"", out);
  range(row, out);
  fputs("}, ", out);
}

static void type(const struct field *row, FILE *out) {
  const bool unit = field_needs_unit(row);
  switch (row->kind) {
  case FIELD_INTEGER:
    if (!unit) {
      fputs("\"type\": \"integer\"", out);
      range(row, out);
      break;
    }
    __attribute__((fallthrough));
  case FIELD_REAL:
    fputs("\"anyOf\": [", out);
    bare(row, out);
    fprintf(out, "{\"type\": \"string\", \"pattern\": \"%s\"}", unit ? NUMBER_IN_UNIT : NUMBER_AND_UNIT);
    fputs(row->flags & FIELD_MAY_BE_OFF ? ", {\"const\": \"off\"}]" : "]", out);
    break;
  case FIELD_BOOLEAN: fputs("\"type\": \"boolean\"", out); break;
  case FIELD_TEXT:
    if (!row->choices) { /* a plain 12 or true is accepted as text, too */
      fprintf(out, "\"type\": [\"string\", \"number\", \"boolean\"], %s\"maxLength\": %d",
              row->flags & FIELD_REQUIRED ? "\"minLength\": 1, " : "", FIELD_TEXT_SIZE - 1);
      break;
    }
    fprintf(out, "\"anyOf\": [{\"type\": \"string\", \"pattern\": \"/|[.](ya?ml|json)$\", \"maxLength\": %d}, {",
            FIELD_TEXT_SIZE - 1);
    __attribute__((fallthrough));
  case FIELD_CHOICE:
    for (size_t i = 0; row->choices[i]; i++) {
      fputs(i ? ", " : "\"enum\": [", out);
      text_json_string(row->choices[i], out);
    }
    fputs(row->kind == FIELD_TEXT ? "]}]" : "]", out);
    break;
  }
}

static void describe_choices(const struct field *row, FILE *out) {
  const char *doc = row->choice_docs;
  for (size_t i = 0; doc && row->choices[i]; i++) {
    const size_t length = strcspn(doc, "\n");
    fprintf(out, " `%s`: %.*s.", row->choices[i], (int)length, doc);
    doc += length + (doc[length] == '\n');
  }
}

static void describe(const struct field *row, FILE *out) {
  const bool number = row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
  fputs(row->doc ? row->doc : "", out);
  if (number && row->unit && strcmp(row->unit, "1"))
    fprintf(out, " With its unit, such as %s.", row->unit);
  fputs(row->flags & FIELD_PERCENT ? " In percent: 3 %." : "", out);
  fputs(row->flags & FIELD_MAY_BE_OFF ? " Or `off`." : "", out);
  if (row->kind == FIELD_CHOICE)
    describe_choices(row, out);
  if (row->when) {
    fprintf(out, " Only when %.*s is ", (int)strcspn(row->when, "="), row->when);
    field_describe_condition(row, out);
    fputc('.', out);
  }
  if (row->source)
    fprintf(out, " Source: %s.", row->source);
}

/* The description that an editor shows: the row's doc, unit, choices, condition and source as one text. */
static void description(const struct field *row, FILE *out) {
  char *text = NULL;
  FILE *words = text_open(&text);
  describe(row, words);
  text_close_small(words, &text);
  text_json_string(*text == ' ' ? text + 1 : text, out);
  free(text);
}

static void default_value(const struct field *row, FILE *out) {
  if (row->flags & (FIELD_REQUIRED | FIELD_DERIVED))
    return;
  struct field_value value;
  field_default(row, &value);
  fputs(", \"default\": ", out);
  if (!field_needs_unit(row)) {
    field_json_value(row, &value, out);
    return;
  }
  char text[FIELD_TEXT_SIZE];
  field_print(row, &value, text, sizeof text);
  text_json_string(text, out);
}

static bool same_start(const char *a, const char *b, size_t length) {
  return strncmp(a, b, length) == 0;
}

/* True when the row has this condition, or its controlling row depends on it. */
static bool rests_on(const struct field_table *table, const struct field *row, const char *when) {
  for (size_t links = 0; row && row->when && links <= table->count; links++) {
    if (strcmp(row->when, when) == 0)
      return true;
    row = field_controller(table, row);
  }
  return false;
}

/* Does the row rest on a condition? `when` NULL: is it required, without a condition? */
static bool is_picked(const struct field_table *table, size_t i, const char *when) {
  const struct field *row = &table->rows[i];
  return when ? rests_on(table, row, when) : row->flags & FIELD_REQUIRED && !row->when;
}

/* Length of the word of row i behind a prefix of `length` bytes. 0: the row is not picked, or an earlier one that is
 * has the same word. */
static size_t picked_word(const struct field_table *table, size_t i, const char *when, const char *prefix,
                          size_t length) {
  const char *path = table->rows[i].path;
  if (!same_start(path, prefix, length) || !is_picked(table, i, when))
    return 0;
  const size_t word = strcspn(path + length, "."), end = length + word;
  for (size_t j = 0; j < i; j++) {
    const char *other = table->rows[j].path;
    if (same_start(other, path, end) && (other[end] == '.' || !other[end]) && is_picked(table, j, when))
      return 0;
  }
  return word;
}

/* The words of one level that lead to a required row without a condition; returns how many. `out` NULL: counts only. */
static int required(const struct field_table *table, const char *prefix, size_t length, FILE *out) {
  int count = 0;
  for (size_t i = 0; i < table->count; i++) {
    const size_t word = picked_word(table, i, NULL, prefix, length);
    if (word && out)
      fprintf(out, "%s\"%.*s\"", count ? ", " : "", (int)word, table->rows[i].path + length);
    count += word > 0;
  }
  return count;
}

int json_schema_required(const struct field_table *table, FILE *out) {
  return required(table, "", 0, out);
}

static void properties(const struct field_table *table, const char *prefix, size_t length, int indent, FILE *out);

/* A section with a choice `name` may be a word or a file instead (engine/scene.c), one with a number `per_point` that
 * number (campaign/document). */
static const char *form_of(const struct field_table *table, const char *path, size_t whole) {
  for (size_t i = 0; i < table->count; i++) {
    const char *const rest = table->rows[i].path + whole;
    if (!same_start(table->rows[i].path, path, whole))
      continue;
    if (strcmp(rest, "name") == 0 && table->rows[i].choices)
      return "[\"object\", \"string\"]";
    if (strcmp(rest, "per_point") == 0)
      return "[\"object\", \"integer\"], \"minimum\": 1";
  }
  return "\"object\"";
}

/* Writes the section whose path is the first `whole` bytes of `path`, including a dot at the end. */
static void write_section(const struct field_table *table, const char *path, size_t whole, int indent, FILE *out) {
  const char *const form = form_of(table, path, whole);
  const bool named = strstr(form, "string");
  fprintf(out, "\"type\": %s, \"additionalProperties\": false,", form);
  margin(indent, out);
  if (required(table, path, whole, NULL) > 0) {
    fputs("\"required\": [", out);
    required(table, path, whole, out);
    fputs("],", out);
    margin(indent, out);
  }
  fputs("\"properties\": {", out);
  if (named) {
    margin(indent + 1, out);
    fputs("\"file\": {\"type\": \"string\", \"description\": \"A document with the values, relative to this one.\"},",
          out);
  }
  properties(table, path, whole, indent + 1, out);
  margin(indent, out);
  fputs("}}", out);
}

/* Every section is written once, at its first row. */
static void properties(const struct field_table *table, const char *prefix, size_t length, int indent, FILE *out) {
  bool first = true;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    const size_t word = field_first_word(table, i, prefix, length);
    if (!word)
      continue;
    const bool section = row->path[length + word] == '.';
    if (!first)
      fputc(',', out);
    first = false;
    margin(indent, out);
    fprintf(out, "\"%.*s\": {", (int)word, row->path + length);
    if (section) {
      write_section(table, row->path, length + word + 1, indent + 1, out);
      continue;
    }
    type(row, out);
    default_value(row, out);
    fputc(',', out);
    margin(indent + 1, out);
    fputs("\"description\": ", out);
    description(row, out);
    fputc('}', out);
  }
}

void json_schema_properties(const struct field_table *table, int indent, FILE *out) {
  properties(table, "", 0, indent, out);
}

/* ---- conditions ---- */

/* {"required": ["a"], "properties": {"a": {"required": ["b"], "properties": {"b": LEAF}}}} with `opened` braces to
 * close. */
static int descend(const char *path, FILE *out) {
  int opened = 0;
  for (;;) {
    size_t word = strcspn(path, ".");
    fprintf(out, "{\"required\": [\"%.*s\"], \"properties\": {\"%.*s\": ", (int)word, path, (int)word, path);
    opened += 2;
    if (!path[word])
      return opened;
    path += word + 1;
  }
}

static void values(const struct field *row, const char *list, bool excluded, FILE *out) {
  fputs(excluded ? "{\"not\": {\"enum\": [" : "{\"enum\": [", out);
  for (const char *at = list;;) {
    size_t length = strcspn(at, "|");
    bool word = row->kind == FIELD_CHOICE || row->kind == FIELD_TEXT || strncmp(at, "off", 3) == 0;
    fprintf(out, "%s%s%.*s%s", at == list ? "" : ", ", word ? "\"" : "", (int)length, at, word ? "\"" : "");
    if (!at[length])
      break;
    at += length + 1;
  }
  fputs(excluded ? "]}}" : "]}", out);
}

/* True when the condition holds in an empty document. */
static bool holds_by_default(const struct field_table *table, const struct field *row, const char *when) {
  OWNED void *object = memory_small(1, table->size);
  field_defaults(table, object);
  struct field probe = {.path = "", .when = when};
  /* Only this condition is tested: the controlling row's own condition has its own clause. */
  struct field alone = *row;
  alone.when = NULL;
  const struct field_table small = {.rows = &alone, .count = 1, .size = table->size};
  bool holds = field_is_active(&small, &probe, object);
  return holds;
}

/* The rows that rest on a condition, as properties that are refused: {"properties": {"a": false, "b": {...}}}. */
static void refused(const struct field_table *table, const char *when, const char *prefix, size_t length, int indent,
                    FILE *out) {
  bool first = true;
  fputs("{\"properties\": {", out);
  for (size_t i = 0; i < table->count; i++) {
    const char *path = table->rows[i].path;
    const size_t word = picked_word(table, i, when, prefix, length);
    if (!word)
      continue;
    if (!first)
      fputc(',', out);
    if (path[length + word] == '.') {
      margin(indent, out);
      fprintf(out, "\"%.*s\": ", (int)word, path + length);
      refused(table, when, path, length + word + 1, indent + 1, out);
    } else {
      fprintf(out, "%s\"%.*s\": false", first ? "" : " ", (int)word, path + length);
    }
    first = false;
  }
  fputs("}}", out);
}

/* "The condition holds, or no row that depends on it is given": an if/then clause. It is if/else when the condition
 * holds by default, so that a document without the controlling key follows the default. */
static void write_condition(const struct field_table *table, const struct field *control, const char *when, int indent,
                            FILE *out) {
  const bool holds = holds_by_default(table, control, when);
  margin(indent, out);
  fputs("{\"if\": ", out);
  int opened = descend(control->path, out);
  values(control, strchr(when, '=') + 1, holds, out);
  while (opened-- > 0)
    fputc('}', out);
  fprintf(out, ", \"%s\": ", holds ? "then" : "else");
  refused(table, when, "", 0, indent + 1, out);
  fputc('}', out);
}

/* Writes one clause per condition, as items of an allOf array; returns how many. */
static int conditions(const struct field_table *table, int indent, FILE *out) {
  int count = 0;
  for (size_t i = 0; i < table->count; i++) {
    const char *when = table->rows[i].when;
    const struct field *control = field_controller(table, &table->rows[i]);
    bool seen = false;
    for (size_t j = 0; when && j < i && !seen; j++)
      seen = table->rows[j].when && strcmp(table->rows[j].when, when) == 0;
    if (!control || seen)
      continue;
    if (count++)
      fputc(',', out);
    write_condition(table, control, when, indent, out);
  }
  return count;
}

void json_schema_write(const struct field_table *table, const char *title, const char *extra,
                       const char *extra_required, FILE *out) {
  fputs("{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": ", out);
  text_json_string(title, out);
  fputs(",\n  \"description\": ", out);
  text_json_string(table->doc ? table->doc : table->name, out);
  fputs(",\n  \"type\": \"object\",\n  \"additionalProperties\": false,\n  \"required\": [", out);
  if (extra_required)
    text_json_string(extra_required, out);
  if (extra_required && required(table, "", 0, NULL) > 0)
    fputs(", ", out);
  json_schema_required(table, out);
  fputs("],\n  \"properties\": {", out);
  if (extra)
    fprintf(out, "\n    %s,", extra);
  json_schema_properties(table, 2, out);
  fputs("\n  },\n  \"allOf\": [", out);
  if (conditions(table, 2, out) == 0)
    fputs("\n    true", out);
  fputs("\n  ]\n}\n", out);
}
