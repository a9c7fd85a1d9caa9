/* Values that are put into a document after it was read, and the document written out again with them. */
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* ---- putting ---- */

static document_node *create(struct document *document, enum document_kind kind, const char *text) {
  const size_t length = strlen(text);
  document_node *node = calloc(1, sizeof *node + length + 1);
  if (!node)
    return NULL;
  node->document = document;
  node->kind = kind;
  node->plain = true;
  node->put = true;
  memcpy(node->text, text, length);
  node->next = document->nodes;
  document->nodes = node;
  document->node_count++;
  return node;
}

/* Sets mapping[key], replacing what is there. */
static bool set(document_node *mapping, const char *key, document_node *value) {
  document_node *name = create(mapping->document, DOCUMENT_SCALAR, key);
  if (!name)
    return false;
  value->parent = mapping;
  value->key = name;
  for (size_t i = 0; i < mapping->count; i++)
    if (strcmp(mapping->pairs[i].key->text, key) == 0) {
      mapping->pairs[i].key = name;
      mapping->pairs[i].value = value;
      return true;
    }
  struct document_pair *pairs = realloc(mapping->pairs, (mapping->count + 1) * sizeof *pairs);
  if (!pairs)
    return false;
  mapping->pairs = pairs;
  mapping->capacity = mapping->count + 1;
  pairs[mapping->count++] = (struct document_pair){.key = name, .value = value};
  return true;
}

static document_node *find(const document_node *mapping, const char *key) {
  for (size_t i = 0; i < mapping->count; i++)
    if (strcmp(mapping->pairs[i].key->text, key) == 0)
      return mapping->pairs[i].value;
  return NULL;
}

status document_change_put(struct document *document, const char *const keys[2], const char *value, const char *origin,
                           struct error *error) {
  document_node *into = document->root, *scalar = NULL;
  if (!document->origin)
    document->origin = strdup(origin);
  if (!document->origin)
    goto no_memory;
  if (keys[1]) {
    into = find(document->root, keys[0]);
    if (into && document_value_is_null(into)) /* "set:" with nothing behind it */
      into = NULL;
    if (into && into->kind != DOCUMENT_MAPPING)
      return status_fail(error, STATUS_CONTENT, "%s: `%s` is no mapping, so that `%.100s` of %s cannot be put into it",
                         document->name, keys[0], keys[1], origin);
    if (!into) {
      into = create(document, DOCUMENT_MAPPING, "");
      if (!into || !set(document->root, keys[0], into))
        goto no_memory;
    }
  }
  scalar = create(document, DOCUMENT_SCALAR, value);
  if (!scalar || !set(into, keys[1] ? keys[1] : keys[0], scalar))
    goto no_memory;
  document->changed = true;
  return STATUS_OK;
no_memory:
  return status_fail(error, STATUS_MEMORY, "%s: no memory", document->name);
}

/* ---- writing ---- */

/* Plain text that means the same inside brackets: words, numbers with units. All else is quoted. */
static bool stays_plain(const char *text) {
  static const char safe[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ._%/^*()+-";
  const char first = *text;
  const bool sign = first == '-' || first == '+' || first == '.';
  const bool begins = (first >= '0' && first <= '9') || (first >= 'a' && first <= 'z') ||
                      (first >= 'A' && first <= 'Z') || (sign && text[1] >= '0' && text[1] <= '9');
  const size_t length = strlen(text);
  return begins && strspn(text, safe) == length && text[length - 1] != ' ';
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
  FILE *out = open_memstream(&text, &size);
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
