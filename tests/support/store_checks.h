/* Common parts of the store's tests: calls that must succeed, and one number of a query. Include cmocka first. */
#ifndef CLAST_TESTS_STORE_CHECKS_H
#define CLAST_TESTS_STORE_CHECKS_H

#include "tests/support/store_fixture.h"

static struct error error;
#define OK(call)                                                                                                       \
  do {                                                                                                                 \
    error.message[0] = 0;                                                                                              \
    if ((call) != STATUS_OK)                                                                                           \
      fail_msg("%s: %s", #call, error.message);                                                                        \
  } while (0)

/* The store's bits as text, malloc'd. */
__attribute__((unused)) static char *dump(const char *path) {
  struct store *store = NULL;
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  OK(store_open_reader(path, &store, &error));
  OK(store_export_digests(store, out, &error));
  fclose(out);
  OK(store_close(store, &error));
  return text;
}

static inline double number(struct store *store, const char *sql) {
  double value = 0;
  OK(answer_number(store, &value, &error, "%s", sql));
  return value;
}

#endif
