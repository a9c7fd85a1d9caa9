/* What the tests of the store share: calls that must succeed, and one number of a query. Include cmocka first. */
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

static inline double number(struct store *store, const char *sql) {
  double value = 0;
  OK(query_number(store, sql, 0, NULL, &value, &error));
  return value;
}

#endif
