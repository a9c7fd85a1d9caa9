/* Names of files. */
#include "engine/file_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

bool file_name_is_document(const char *word) {
  static const char *const endings[] = {".yaml", ".yml", ".json", NULL};
  const char *ending = strrchr(word, '.');
  return strchr(word, '/') || (ending && text_is_one_of(ending, endings));
}

char *file_name_in(const char *folder, const char *name) {
  if (name[0] == '/' || !folder || !*folder)
    return strdup(name);
  const size_t size = strlen(folder) + strlen(name) + 2;
  char *whole = malloc(size);
  if (whole)
    snprintf(whole, size, "%s/%s", folder, name);
  return whole;
}
