/* Puts values into a document after it was read, and writes the changed document as text. */
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* ---- putting ---- */

static document_node *create(struct document *document, enum document_kind kind, const char *text) {
  document_node *node = document_node_make(document, kind, text, strlen(text));
  if (!node)
    return NULL;
  node->plain = true;
  node->put = true;
  return node;
}

/* Sets mapping[key]; replaces an existing value. */
static bool set(document_node *mapping, const char *key, document_node *value) {
  document_node *name = create(mapping->document, DOCUMENT_SCALAR, key);
  if (!name)
    return false;
  struct document_pair *pair = document_node_find(mapping, key);
  if (!pair)
    return document_node_append(mapping, name, value);
  pair->key = name;
  pair->value = value;
  value->parent = mapping;
  value->key = name;
  return true;
}

/* The value at a key of the document, or a new mapping if it is absent or null. The value may be no mapping. NULL: no
 * memory. */
static document_node *section_at(struct document *document, const char *key) {
  const struct document_pair *pair = document_node_find(document->root, key);
  if (pair && !document_value_is_null(pair->value)) /* "set:" without a value */
    return pair->value;
  document_node *section = create(document, DOCUMENT_MAPPING, "");
  return section && set(document->root, key, section) ? section : NULL;
}

status document_change_put(struct document *document, const char *const keys[2], const char *value, const char *origin,
                           struct error *error) {
  if (!document->origin)
    document->origin = strdup(origin);
  document_node *into = keys[1] ? section_at(document, keys[0]) : document->root;
  if (into && into->kind != DOCUMENT_MAPPING)
    return status_fail(error, STATUS_CONTENT, "%s: `%s` is no mapping, so it cannot hold `%.100s` of %s",
                       document->name, keys[0], keys[1], origin);
  document_node *scalar = create(document, DOCUMENT_SCALAR, value);
  const char *key = keys[1] ? keys[1] : keys[0];
  if (!document->origin || !into || !scalar || !set(into, key, scalar))
    return status_fail(error, STATUS_MEMORY, "%s: no memory", document->name);
  document->changed = true;
  return STATUS_OK;
}

/* ---- writing ---- */

/* Plain text that means the same inside brackets: words, numbers with units. Other text is quoted. */
#define DIGITS  "0123456789"
#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
static bool stays_plain(const char *text) {
  const size_t length = strlen(text), sign = strspn(text, "-+.") == 1;
  const char *first = sign ? DIGITS : DIGITS LETTERS;
  if (length == sign || !strchr(first, text[sign]))
    return false;
  return strspn(text, DIGITS LETTERS " ._%/^*()+-") == length && text[length - 1] != ' ';
}

static void write_scalar(const document_node *node, FILE *out) {
  if (node->plain && (!*node->text || stays_plain(node->text)))
    fputs(*node->text ? node->text : "null", out);
  else
    text_json_string(node->text, out);
}

static void write_node(const document_node *node, FILE *out) {
  if (node->kind == DOCUMENT_SCALAR) {
    write_scalar(node, out);
    return;
  }
  const bool mapping = node->kind == DOCUMENT_MAPPING;
  fputc(mapping ? '{' : '[', out);
  for (size_t i = 0; i < node->count; i++) {
    fputs(i ? ", " : "", out);
    if (mapping) {
      write_scalar(node->pairs[i].key, out);
      fputs(": ", out);
    }
    write_node(node->pairs[i].value, out);
  }
  fputc(mapping ? '}' : ']', out);
}

char *document_change_text(const struct document *document) {
  if (!document->changed)
    return strdup(document->text);
  char *text = NULL;
  size_t size = 0;
  FILE *out = text_open(&text, &size);
  if (!out)
    return NULL;
  fprintf(out, "# as read, with values of the %s; comments are left out\n", document->origin);
  for (size_t i = 0; i < document->root->count; i++) {
    write_scalar(document->root->pairs[i].key, out);
    fputs(": ", out);
    write_node(document->root->pairs[i].value, out);
    fputc('\n', out);
  }
  return text_close(out, &text);
}
