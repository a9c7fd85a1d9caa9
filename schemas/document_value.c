/* Reads one scalar through its row, and names nodes in messages. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

enum { LIST_SIZE = 400, PATH_SIZE = 256 };

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

/* field_parse's message begins with the row's path. The node's own path replaces it: both are equal, or the node's has
 * a prefix such as "vary.". */
static void report(document_node *node, const struct field *row, const char *message) {
  char path[PATH_SIZE] = "";
  size_t length = strlen(row->path);
  if (strncmp(message, row->path, length) == 0 && strncmp(message + length, ": ", 2) == 0)
    message += length + 2;
  if (node->document->error_count < DOCUMENT_MOST_ERRORS)
    document_value_path(node, path, sizeof path);
  document_report(node, *path ? path : row->path, "%s", message);
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
  if (node->faulty)
    return false;
  if (read_value(node, row, value, &error) == STATUS_OK)
    return true;
  report(node, row, error.message);
  return false;
}
