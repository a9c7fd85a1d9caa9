/* Keys that no table knows, and which one may have been meant. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

enum { PATH_SIZE = 300, LIST_SIZE = 400 };

/* "a, b, c", cut with "..." when it is too long. */
static void write_list(const char *const *words, char list[LIST_SIZE]) {
  size_t used = 0;
  *list = 0;
  for (size_t i = 0; words && words[i] && used < LIST_SIZE; i++) {
    int n = snprintf(list + used, LIST_SIZE - used, "%s%s", i ? ", " : "", words[i]);
    used += n > 0 ? (size_t)n : 0;
  }
  if (used >= LIST_SIZE)
    memcpy(list + LIST_SIZE - 4, "...", 4);
}

void document_unknown_key(document_node *key, const char *path, const char *const *known, const char *elsewhere) {
  if (key->faulty)
    return;
  struct document *document = key->document;
  if (document->error_count >= DOCUMENT_MOST_ERRORS) { /* only counted: the guess would not be shown */
    document->error_count++;
    return;
  }
  struct text_guess guess = text_guess(key->text);
  for (size_t i = 0; known && known[i]; i++)
    text_guess_offer(&guess, known[i]);

  char whole[PATH_SIZE], list[LIST_SIZE];
  snprintf(whole, sizeof whole, "%s%s%.100s", path ? path : "", path && *path ? "." : "", key->text);
  write_list(known, list);
  if (strcmp(key->text, "<<") == 0)
    document_report(key, whole, "merge keys are not part of YAML 1.2; write the keys out");
  else if (guess.nearest)
    document_report(key, whole, "unknown key; did you mean '%s'?", guess.nearest);
  else if (elsewhere && strcmp(elsewhere, key->text) == 0)
    document_report(key, whole, "a path with dots; nest it: write '%.*s:' and the rest indented below it",
                    (int)strcspn(elsewhere, "."), elsewhere);
  else if (elsewhere)
    document_report(key, whole, "unknown key; did you mean '%s'?", elsewhere);
  else if (*list)
    document_report(key, whole, "unknown key; known here are %s", list);
  else
    document_report(key, whole, "unknown key; remove it");
}

void document_unknown_keys(document_node *mapping, const char *path, const char *const *known) {
  for (size_t i = 0; mapping->kind == DOCUMENT_MAPPING && i < mapping->count; i++) {
    bool listed = mapping->pairs[i].seen;
    for (size_t k = 0; known && known[k] && !listed; k++)
      listed = strcmp(known[k], mapping->pairs[i].key->text) == 0;
    if (!listed)
      document_unknown_key(mapping->pairs[i].key, path, known, NULL);
  }
}
