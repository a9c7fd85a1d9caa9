/* Short forms of rows of inputs whose path is that of the member. The including file defines INPUTS, the name of the
 * struct. */
#pragma once

#include "schemas/rows.h"

#define ROW(path_, kind_, unit_, ...) ROW_OF(INPUTS, path_, path_, kind_, unit_, __VA_ARGS__)
#define REAL(path_, unit_, ...)       INPUT_REAL(path_, path_, unit_, __VA_ARGS__)
#define COUNT(path_, default_, low_, high_, ...)                                                                       \
  ROW(path_, FIELD_INTEGER, "1", .number = default_, .minimum = low_, .maximum = high_, __VA_ARGS__)
#define SWITCH(path_, ...) INPUT_SWITCH(path_, path_, __VA_ARGS__)
#define CHOICE(path_, ...) INPUT_CHOICE(path_, path_, __VA_ARGS__)
