/* Pinned answers: a text that the program computes is compared line by line with a file that was looked at.
 * CLAST_RENEW=1 writes the file anew: commit it only after each line of `git diff` is a change that you meant. */
#pragma once

#include <malloc.h>

#include "tests/support/check.h"

/* Words that blanks part. Two numbers may differ by `tolerance` of the larger one. */
__attribute__((unused)) static bool pinned_line(char *pinned, char *now, double tolerance) {
  char *rest[2], *end[2];
  char *a = strtok_r(pinned, " \n", &rest[0]), *b = strtok_r(now, " \n", &rest[1]);
  for (; a && b; a = strtok_r(NULL, " \n", &rest[0]), b = strtok_r(NULL, " \n", &rest[1])) {
    const double x = strtod(a, &end[0]), y = strtod(b, &end[1]);
    if (strcmp(a, b) != 0 &&
        (tolerance == 0 || *end[0] || *end[1] || !(fabs(x - y) <= tolerance * fmax(fabs(x), fabs(y)))))
      return false;
  }
  return !a && !b;
}

/* `name`: the file, in the folder tests. */
__attribute__((unused)) static void pinned_same(const char *name, const char *now, double tolerance) {
  char path[500], pinned[1000], line[1000], kept[2][1000];
  size_t changed = 0;
  snprintf(path, sizeof path, "%s/tests/%s", CLAST_SOURCE_DIR, name);
  if (getenv("CLAST_RENEW")) {
    FILE *file = fopen(path, "w");
    assert_true(file && fputs(now, file) >= 0 && fclose(file) == 0);
  }
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  for (bool more = true; more;) {
    const size_t length = strcspn(now, "\n");
    snprintf(line, sizeof line, "%.*s", (int)length, now);
    now += length + (now[length] == '\n');
    if (!fgets(pinned, sizeof pinned, file))
      *pinned = 0;
    pinned[strcspn(pinned, "\n")] = 0;
    snprintf(kept[0], sizeof kept[0], "%s", pinned);
    snprintf(kept[1], sizeof kept[1], "%s", line);
    if (!pinned_line(pinned, line, tolerance) && changed++ < 20)
      print_error("pinned: %s\nnow:    %s\n", kept[0], kept[1]);
    more = *kept[0] || *kept[1];
  }
  fclose(file);
  if (changed)
    fail_msg("%zu lines of tests/%s changed", changed, name);
}

/* The same for a program that computes only some lines of the file: each of them stands there. */
__attribute__((unused)) static void pinned_among(const char *name, char *now) {
  char path[500], *pinned = NULL, *rest = NULL;
  size_t size = 0, changed = 0;
  snprintf(path, sizeof path, "%s/tests/%s", CLAST_SOURCE_DIR, name);
  FILE *file = fopen(path, "r");
  assert_true(file && getdelim(&pinned, &size, 0, file) > 0);
  fclose(file);
  for (char *line = strtok_r(now, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
    if (!strstr(pinned, line) && changed++ < 20)
      print_error("now:    %s\n", line);
  free(pinned);
  if (changed)
    fail_msg("%zu lines are not in tests/%s", changed, name);
}

/* Fails if calls of `work` leave memory behind: the heap grows by the same number of bytes at each of the last five of
 * ten calls. The sanitizers see leaks by themselves; this sees them in a release. */
__attribute__((unused)) static void pinned_frees(const char *name, void (*work)(void *), void *context) {
  size_t last = 0, grown = 0, times = 0;
  for (size_t k = 0; k < 10; k++) {
    work(context);
    const struct mallinfo2 heap = mallinfo2();
    const size_t used = heap.uordblks + heap.hblkhd, more = used > last ? used - last : 0;
    times = more > 0 && more == grown ? times + 1 : 0;
    grown = more;
    last = used;
  }
  if (times >= 4)
    fail_msg("%s leaves %zu bytes behind", name, grown);
}
