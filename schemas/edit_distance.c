#include "schemas/edit_distance.h"

#include <stdint.h>
#include <string.h>

size_t edit_distance(const char *a, size_t length, const char *b) {
  size_t m = strlen(b), rows[3][EDIT_DISTANCE_LENGTH + 1];
  if (length > EDIT_DISTANCE_LENGTH || m > EDIT_DISTANCE_LENGTH)
    return SIZE_MAX;
  for (size_t j = 0; j <= m; j++)
    rows[0][j] = j;
  for (size_t i = 1; i <= length; i++) {
    size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *second = rows[(i + 1) % 3];
    row[0] = i;
    for (size_t j = 1; j <= m; j++) {
      size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
      if (above[j] + 1 < best)
        best = above[j] + 1;
      if (row[j - 1] + 1 < best)
        best = row[j - 1] + 1;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && second[j - 2] + 1 < best)
        best = second[j - 2] + 1;
      row[j] = best;
    }
  }
  return rows[length % 3][m];
}

size_t edit_distance_limit(size_t length) {
  return length < 2 ? 0 : length < 4 ? 1 : length / 3 > 2 ? length / 3 : 2;
}
