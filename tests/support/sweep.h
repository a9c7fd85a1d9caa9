/* Removes a test's folder when the test ends, passed or failed. */
#pragma once

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Removes the folder and the files in it, and prints their names, but those of files that are expected (NULL: none).
 * Returns the number of the others. */
static inline int sweep(const char *folder, bool (*is_expected)(const char *name)) {
  int left = 0;
  DIR *list = opendir(folder);
  for (const struct dirent *entry; list && (entry = readdir(list));) {
    char path[1024];
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
      continue;
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    unlink(path);
    if (is_expected && is_expected(entry->d_name))
      continue;
    fprintf(stderr, "left behind: %s\n", path);
    left++;
  }
  if (list)
    closedir(list);
  rmdir(folder);
  return left;
}
