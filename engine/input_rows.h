/* Short forms of rows, for the tables of inputs. The including file defines INPUTS, the name of the struct. */
#ifndef CLAST_ENGINE_INPUT_ROWS_H
#define CLAST_ENGINE_INPUT_ROWS_H

#include "schemas/field.h"

#define ROW(path_, kind_, unit_, ...)                                                                                  \
  { .path = #path_, .kind = kind_, .unit = unit_, .offset = offsetof(struct INPUTS, path_), __VA_ARGS__ }
#define REAL(path_, unit_, default_, low, high, ...)                                                                   \
  ROW(path_, FIELD_REAL, unit_, .number = default_, .minimum = low, .maximum = high, __VA_ARGS__)
#define COUNT(path_, default_, low, high, ...)                                                                         \
  ROW(path_, FIELD_INTEGER, "1", .number = default_, .minimum = low, .maximum = high, __VA_ARGS__)
#define SWITCH(path_, default_, ...) ROW(path_, FIELD_BOOLEAN, NULL, .number = default_, .maximum = 1, __VA_ARGS__)
#define CHOICE(path_, choices_, ...) ROW(path_, FIELD_CHOICE, NULL, .choices = choices_, __VA_ARGS__)

#endif
