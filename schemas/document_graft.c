/* Copies the contents of another document into a section of this one: a material's file as the material of a body. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* Values that `to` already has stay unchanged. */
static bool merge(document_node *to, document_node *from, const char *const *leave_out) {
  for (size_t i = 0; i < from->count; i++) {
    document_node *key = from->pairs[i].key, *value = from->pairs[i].value;
    if (text_is_one_of(key->text, leave_out))
      continue;
    const struct document_pair *own = document_node_find(to, key->text);
    const bool sections = own && own->value->kind == DOCUMENT_MAPPING && value->kind == DOCUMENT_MAPPING;
    if (!own && !document_node_append(to, key, value))
      return false;
    if (sections && !merge(own->value, value, NULL))
      return false;
  }
  return true;
}

static document_node *scalar(struct document *document, const char *text, const document_node *place) {
  document_node *node = document_node_make(document, DOCUMENT_SCALAR, text, strlen(text));
  if (!node)
    return NULL;
  node->plain = true;
  node->start = place->start;
  node->end = place->end;
  return node;
}

/* A scalar becomes an empty mapping; a mapping stays unchanged. */
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
  return document_node_find(section, key) || document_node_append(section, name, value);
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
  struct document_pair *pair = document_node_find(mapping, key);
  if (!pair)
    return;
  memmove(pair, pair + 1, (size_t)(mapping->pairs + mapping->count - pair - 1) * sizeof *pair);
  mapping->count--;
}
