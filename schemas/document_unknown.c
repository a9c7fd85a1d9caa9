/* Reports keys that no table has, and suggests the intended one. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

enum { PATH_SIZE = 300, LIST_SIZE = 400 };

/* "a, b, c"; a long list is cut and ends in "...". */
static void write_list(const char *const *words, char list[LIST_SIZE]) {
  *list = 0;
  for (size_t i = 0; words && words[i]; i++)
    text_append(list, LIST_SIZE, "%s%s", i ? ", " : "", words[i]);
  if (strlen(list) == LIST_SIZE - 1)
    memcpy(list + LIST_SIZE - 4, "...", 4);
}

static const char *nearest(const char *typed, const char *const *known) {
  struct text_guess guess = text_guess(typed);
  for (size_t i = 0; known && known[i]; i++)
    text_guess_offer(&guess, known[i]);
  return guess.nearest;
}

void document_unknown_key(document_node *key, const char *path, const char *const *known, const char *elsewhere) {
  if (key->faulty)
    return;
  struct document *document = key->document;
  if (document->error_count >= DOCUMENT_MOST_ERRORS) { /* only counted: the suggestion would not be shown */
    document->error_count++;
    return;
  }

  char whole[PATH_SIZE] = "", list[LIST_SIZE];
  if (path && *path)
    text_append(whole, sizeof whole, "%s.", path);
  text_append(whole, sizeof whole, "%.100s", key->text);
  write_list(known, list);
  const char *near = nearest(key->text, known);
  const bool dotted = !near && elsewhere && strcmp(elsewhere, key->text) == 0;
  if (!near)
    near = elsewhere;
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
      document_unknown_key(pair->key, path, known, NULL);
  }
}
