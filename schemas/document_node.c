/* Nodes of a document's tree: creating, inserting into a mapping or list, finding by key. */
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"

document_node *document_node_make(struct document *document, enum document_kind kind, const char *text, size_t length) {
  document_node *node = calloc(1, sizeof *node + length + 1);
  if (!node)
    return NULL;
  node->document = document;
  node->kind = kind;
  if (length)
    memcpy(node->text, text, length);
  node->next = document->nodes;
  document->nodes = node;
  document->node_count++;
  return node;
}

bool document_node_append(document_node *to, document_node *key, document_node *value) {
  if (to->count == to->capacity) {
    const size_t capacity = to->capacity ? 2 * to->capacity : 4;
    struct document_pair *pairs = realloc(to->pairs, capacity * sizeof *pairs);
    if (!pairs)
      return false;
    to->pairs = pairs;
    to->capacity = capacity;
  }
  to->pairs[to->count++] = (struct document_pair){.key = key, .value = value};
  value->parent = to;
  value->key = key;
  return true;
}

struct document_pair *document_node_find(const document_node *mapping, const char *key) {
  for (size_t i = 0; i < mapping->count; i++)
    if (strcmp(mapping->pairs[i].key->text, key) == 0)
      return &mapping->pairs[i];
  return NULL;
}
