/* Text plots: points are in their decade's column, bars on both sides, lines fit the terminal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/pictures/picture.h"
#include "tests/support/check.h"

static char *plot(int columns, bool unicode, const struct picture_series *series) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  text_plot_spectrum(out, columns, unicode, "m", "kg/m", "F(m)", &(struct pooled_form){0}, series);
  fclose(out);
  return text;
}

static void rows_and_columns(void **state) {
  (void)state;
  struct pooled_bin bins[5];
  for (int i = 0; i < 5; i++) { /* a slope of -2: densities 1e8, 1e6 ... */
    double edge = pow(10, i - 4);
    bins[i] = (struct pooled_bin){.bin = 10 * (i - 4),
                                  .lower = edge,
                                  .upper = edge * 1.2589,
                                  .count = 1000 >> (2 * i),
                                  .value = pow(10, 8 - 2 * i),
                                  .half_width = 0.3 * pow(10, 8 - 2 * i)};
  }
  bins[4].half_width = bins[4].value; /* reaches down to zero */
  struct picture_fit fit = {"\xce\xb2 2.00 \xc2\xb1 0.01", 2, 1e-4, HUGE_VAL, 1e4, 0, NULL};
  struct picture_series series = {.label = "all", .count = 5, .bins = bins, .fits = 1, .fit = &fit};
  char *text = plot(100, false, &series), *line = strtok(text, "\n");
  int last = 1000, rows = 0;
  assert_non_null(strstr(line, "m [kg/m]"));
  assert_non_null(strstr(line, "10^8"));
  assert_true(strlen(line) <= 100);
  long column_of_8 = strstr(line, "10^8") - line;
  while ((line = strtok(NULL, "\n")) && line[0] != ':') {
    assert_true(strlen(line) <= 100);
    int at = (int)(strchr(line, '*') - line);
    assert_true(at < last); /* falling */
    if (rows == 0)
      assert_in_range(at, column_of_8, column_of_8 + 3); /* the last power ends with the lines */
    if (rows < 4)
      assert_true(strchr(line, '[') < strchr(line, '*') && strchr(line, '*') <= strchr(line, ']'));
    last = at;
    rows++;
  }
  assert_int_equal(rows, 5);
  assert_string_equal(line, ": beta 2.00 +- 0.01");
  free(text);
  text = plot(10, true, &series);
  assert_non_null(strstr(text, "\xe2\x97\x8f"));
  assert_null(strstr(text, "\xe2\x97\x8b"));
  free(text);
  series.complete_mass = 2e-3; /* the first two bins begin below */
  text = plot(100, false, &series);
  assert_non_null(strstr(text, "o below 0.002 kg/m fragments are missing"));
  assert_true(strchr(text, 'o') != NULL && strchr(text, '*') != NULL);
  free(text);
  series.count = 0;
  text = plot(80, true, &series);
  assert_string_equal(text, "");
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rows_and_columns)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
