/* Fuzz target: any text as a number with a unit. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/unit.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void must(bool truth) {
  if (!truth)
    abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static const char *const expected[] = {"1", "m", "m/s", "kg/m^3", "Pa", "rad", "B", "1/s", "J/m"};
  char *text = malloc(size + 1), shown[32];
  struct error error;
  must(text != NULL);
  memcpy(text, bytes, size);
  text[size] = 0;
  for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
    double si = -7, back = 0;
    error.message[0] = 0;
    status code = unit_read(text, expected[i], &si, &error);
    must(code == STATUS_OK || (code == STATUS_CONTENT && error.message[0] && si == -7));
    if (code)
      continue;
    must(isfinite(si));
    field_print_number(si, shown);
    must(unit_read(shown, expected[i], &back, &error) == STATUS_OK && back == si);
  }
  struct unit unit;
  if (unit_parse(text, &unit, &error) == STATUS_OK) {
    must(isfinite(unit.factor) && unit.factor > 0 && unit_same_dimension(&unit, &unit));
    if (size < 200) { /* a unit that parses alone parses after a number, and its reciprocal cancels it */
      char joined[300];
      struct unit product;
      snprintf(joined, sizeof joined, "(%s)/(%s)", text, text);
      if (unit_parse(joined, &product, &error) == STATUS_OK)
        must(fabs(product.factor - 1) < 1e-9 && unit_same_dimension(&product, &(struct unit){0}));
    }
  }
  free(text);
  return 0;
}
