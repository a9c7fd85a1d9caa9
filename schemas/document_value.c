#include <string.h>

#include "schemas/document_tree.h"

enum { LIST_SIZE = 400 };

const char *document_value_what(const document_node *node) {
  switch (node->kind) {
  case DOCUMENT_SCALAR:
    return node->plain && !node->text[0] ? "nothing" : "a single value";
  case DOCUMENT_SEQUENCE:
    return "a list";
  case DOCUMENT_MAPPING:
    return "keys and values";
  }
  return "something else";
}

static bool any_of(const char *text, const char *const *words) {
  for (; *words; words++)
    if (strcmp(text, *words) == 0) return true;
  return false;
}

/* YAML 1.2.2, 10.3.2, the core schema: which plain scalars are null. */
bool document_value_is_null(const document_node *node) {
  static const char *const nulls[] = {"", "~", "null", "Null", "NULL", NULL};
  return node->kind == DOCUMENT_SCALAR && node->plain && any_of(node->text, nulls);
}

static void describe(const struct field *row, char *text, size_t size) {
  switch (row->kind) {
  case FIELD_REAL:
  case FIELD_INTEGER:
    field_describe_range(row, text, size);
    break;
  case FIELD_BOOLEAN:
    snprintf(text, size, "true or false");
    break;
  case FIELD_CHOICE: {
    size_t used = 0;
    for (size_t i = 0; row->choices[i] && used < size; i++) {
      int n = snprintf(text + used, size - used, "%s%s",
                       !i                    ? ""
                       : row->choices[i + 1] ? ", "
                                             : " or ",
                       row->choices[i]);
      used += n > 0 ? (size_t)n : 0;
    }
    break;
  }
  case FIELD_TEXT:
    snprintf(text, size, "text");
    break;
  }
}

bool document_value(document_node *node, const struct field *row, struct field_value *value) {
  char expected[LIST_SIZE];
  if (node->faulty) return false;
  if (node->kind != DOCUMENT_SCALAR || document_value_is_null(node)) {
    describe(row, expected, sizeof expected);
    document_report(node, row->path, "expected %s, got %s", expected,
                    document_value_is_null(node) ? "nothing" : document_value_what(node));
    return false;
  }
  const char *text = node->text;
  bool unitless = !row->unit || strcmp(row->unit, "1") == 0;
  if (!node->plain && (row->kind == FIELD_BOOLEAN || (row->kind == FIELD_INTEGER && unitless))) {
    document_report(node, row->path, "expected %s, got a text in quotes; remove the quotes",
                    row->kind == FIELD_BOOLEAN ? "true or false" : "a whole number");
    return false;
  }
  if (row->kind == FIELD_BOOLEAN) {
    static const char *const yes[] = {"true", "True", "TRUE", NULL}, *const no[] = {"false", "False", "FALSE", NULL};
    if (any_of(text, yes)) text = "true";
    if (any_of(text, no)) text = "false";
  }
  struct error error;
  if (field_parse(row, text, value, &error) == STATUS_OK) return true;
  document_report(node, NULL, "%s", error.message); /* begins with the path */
  return false;
}
