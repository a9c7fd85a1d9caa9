/* Forms of rows. `path` is what users write, `member` the member of the struct; the rest are further members of struct
 * field (.doc, .when). A file that uses the forms for inputs and results defines INPUTS and RESULTS, the structs'
 * names.
 */
#pragma once

#include <math.h>

#include "schemas/field.h"

#define ROW_OF(struct_, path_, member_, kind_, unit_, ...)                                                             \
  { .path = #path_, .kind = kind_, .unit = unit_, .offset = offsetof(struct struct_, member_), __VA_ARGS__ }
#define REAL_OF(struct_, path_, member_, unit_, default_, low_, high_, ...)                                            \
  ROW_OF(struct_, path_, member_, FIELD_REAL, unit_, .number = default_, .minimum = low_, .maximum = high_, __VA_ARGS__)

#define INPUT_REAL(path_, member_, ...) REAL_OF(INPUTS, path_, member_, __VA_ARGS__)
#define INPUT_SWITCH(path_, member_, default_, ...)                                                                    \
  ROW_OF(INPUTS, path_, member_, FIELD_BOOLEAN, NULL, .number = default_, .maximum = 1, __VA_ARGS__)
#define INPUT_CHOICE(path_, member_, choices_, ...)                                                                    \
  ROW_OF(INPUTS, path_, member_, FIELD_CHOICE, NULL, .choices = choices_, __VA_ARGS__)

/* Results that do not apply are off. */
#define RESULT_REAL(path_, member_, unit_, low_, ...)                                                                  \
  REAL_OF(RESULTS, path_, member_, unit_, NAN, low_, HUGE_VAL, .flags = FIELD_MAY_BE_OFF, __VA_ARGS__)
#define RESULT_SHARE(path_, member_, ...)                                                                              \
  REAL_OF(RESULTS, path_, member_, "1", NAN, 0, 1, .flags = FIELD_MAY_BE_OFF, __VA_ARGS__)
#define RESULT_COUNT(path_, member_, ...)                                                                              \
  ROW_OF(RESULTS, path_, member_, FIELD_INTEGER, "1", .maximum = HUGE_VAL, __VA_ARGS__)
