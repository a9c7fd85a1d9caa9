/* A separate folder for a test program: make_folder and remove_folder are the set-up and tear-down of its group. */
#pragma once

#include <stdlib.h>

#include "tests/support/sweep.h"

static char folder[] = "/tmp/clast_test_XXXXXX";

/* The path of a file in the folder; valid until the next call. */
static inline const char *in_folder(const char *name) {
  static char path[200];
  snprintf(path, sizeof path, "%s/%.100s", folder, name);
  return path;
}

static inline int make_folder(void **state) {
  (void)state;
  return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state) {
  (void)state;
  return sweep(folder, NULL); /* fails when a test or a failed write left anything behind */
}
