/* Finds keys that one mapping contains twice. */
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"

static int by_text(const void *a, const void *b) {
  const document_node *const *left = a, *const *right = b;
  int order = strcmp((*left)->text, (*right)->text);
  if (order)
    return order;
  return ((*left)->start > (*right)->start) - ((*left)->start < (*right)->start);
}

static void report(document_node *key, const char *path, const document_node *first) {
  struct document *document = key->document;
  if (document->error_count >= DOCUMENT_MOST_ERRORS) {
    document->error_count++; /* only counted */
    return;
  }
  char whole[400];
  snprintf(whole, sizeof whole, "%.200s%s%.150s", path, *path ? "." : "", key->text);
  document_report(key, whole, "given twice; the first is in line %zu; remove one",
                  document_report_line(document, first->start));
}

/* Keys are sorted, not compared pairwise: a file of a hundred thousand keys must not take minutes. */
bool document_duplicates_report(const document_node *mapping, const char *path) {
  document_node **keys = malloc((mapping->count + 1) * sizeof(document_node *));
  if (!keys)
    return false;
  for (size_t i = 0; i < mapping->count; i++)
    keys[i] = mapping->pairs[i].key;
  qsort(keys, mapping->count, sizeof *keys, by_text);
  for (size_t i = 1, first = 0; i < mapping->count; i++) {
    if (strcmp(keys[first]->text, keys[i]->text) != 0 || keys[i]->faulty || keys[first]->faulty)
      first = i;
    else
      report(keys[i], path, keys[first]);
  }
  free(keys);
  return true;
}
