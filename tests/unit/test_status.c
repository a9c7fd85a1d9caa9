/* The pinned values are exit codes that scripts branch on: a change here is a change of the program's interface. */
#include "schemas/status.h"
#include "tests/support/check.h"

TEST(values_are_sysexits) {
  assert_int_equal(STATUS_OK, 0);
  assert_int_equal(STATUS_FAILED_RUNS, 1);
  assert_int_equal(STATUS_USAGE, 64);
  assert_int_equal(STATUS_CONTENT, 65);
  assert_int_equal(STATUS_MISSING, 66);
  assert_int_equal(STATUS_INTERNAL, 70);
  assert_int_equal(STATUS_MEMORY, 71);
  assert_int_equal(STATUS_IO, 74);
  assert_int_equal(STATUS_STOPPED, 75);
}

TEST(fail_fills_and_returns) {
  assert_int_equal(status_fail(&error, STATUS_IO, "cannot write '%s'", "a.db"), STATUS_IO);
  assert_int_equal(error.status, STATUS_IO);
  assert_string_equal(error.message, "cannot write 'a.db'");
  assert_int_equal(status_fail(NULL, STATUS_USAGE, "x"), STATUS_USAGE);
}
