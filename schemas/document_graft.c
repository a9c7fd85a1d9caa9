/* The contents of another document as a section of this one: a material's file as the material of a body. */
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"

static bool listed(const char *word, const char *const *words) {
  for (; words && *words; words++)
    if (strcmp(word, *words) == 0)
      return true;
  return false;
}

static struct document_pair *find(const document_node *mapping, const char *key) {
  for (size_t i = 0; i < mapping->count; i++)
    if (strcmp(mapping->pairs[i].key->text, key) == 0)
      return &mapping->pairs[i];
  return NULL;
}

static bool append(document_node *to, document_node *key, document_node *value) {
  if (to->count == to->capacity) {
    const size_t capacity = to->capacity ? 2 * to->capacity : 8;
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

/* What `to` gives itself stays. */
static bool merge(document_node *to, document_node *from, const char *const *leave_out) {
  for (size_t i = 0; i < from->count; i++) {
    document_node *key = from->pairs[i].key, *value = from->pairs[i].value;
    const struct document_pair *own = find(to, key->text);
    if (listed(key->text, leave_out))
      continue;
    if (!own && !append(to, key, value))
      return false;
    if (own && own->value->kind == DOCUMENT_MAPPING && value->kind == DOCUMENT_MAPPING &&
        !merge(own->value, value, NULL))
      return false;
  }
  return true;
}

static document_node *scalar(struct document *document, const char *text, const document_node *place) {
  const size_t length = strlen(text);
  document_node *node = calloc(1, sizeof *node + length + 1);
  if (!node)
    return NULL;
  node->document = document;
  node->kind = DOCUMENT_SCALAR;
  node->plain = true;
  node->start = place->start;
  node->end = place->end;
  memcpy(node->text, text, length);
  node->next = document->nodes;
  document->nodes = node;
  document->node_count++;
  return node;
}

/* A scalar becomes an empty mapping; a mapping stays what it is. */
static void make_section(document_node *section) {
  if (section->kind == DOCUMENT_SCALAR)
    section->count = 0;
  section->kind = DOCUMENT_MAPPING;
}

bool document_graft_word(document_node *section, const char *key, const char *word) {
  struct document *document = section->document;
  document_node *name = scalar(document, key, section), *value = scalar(document, word, section);
  if (!name || !value)
    return false;
  make_section(section);
  return find(section, key) || append(section, name, value);
}

bool document_graft(document_node *section, struct document *other, const char *const *leave_out) {
  struct document *document = section->document;
  other->owner = document;
  other->next_included = document->included;
  document->included = other;
  document->foreign_errors += other->error_count;
  make_section(section);
  return merge(section, other->root, leave_out);
}

void document_graft_drop(document_node *mapping, const char *key) {
  struct document_pair *pair = find(mapping, key);
  if (!pair)
    return;
  memmove(pair, pair + 1, (size_t)(mapping->pairs + mapping->count - pair - 1) * sizeof *pair);
  mapping->count--;
}
