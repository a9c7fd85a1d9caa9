/* Units: known conversions (exact doubles: a decimal shift must not round), every error message to the letter, and the
 * agreement of spellings that mean the same. */

#include "schemas/field.h"
#include "schemas/unit.h"
#include "tests/support/check.h"

TEST(values_are_exact) {
  int wrong = 0;
  /* The doubles on the right are the compiler's own reading of the decimal number: equality, no tolerance. */
  static const struct {
    const char *text, *unit;
    double si;
  } cases[] = {
      {"5 km/s", "m/s", 5000},
      {"5km/s", "m/s", 5000},
      {"36 km/h", "m/s", 10},
      {"3 dm", "m", 0.3},
      {"7 cm", "m", 0.07},
      {"1.069 cm", "m", 0.01069},
      {"0.1 um", "m", 1e-7},
      {"0.1 \xC2\xB5m", "m", 1e-7}, /* micro sign */
      {"0.1 \xCE\xBCm", "m", 1e-7}, /* Greek mu */
      {"12 nm", "m", 12e-9},
      {"2.7 g/cm^3", "kg/m^3", 2700},
      {"2.7 g cm^-3", "kg/m^3", 2700},
      {"2.7 g/cm**3", "kg/m^3", 2700},
      {"5e9 erg/cm", "J/m", 5e4},
      {"1e10 dyn/cm^2", "Pa", 1e9},
      {"1.5 GPa", "Pa", 1.5e9},
      {"250 MPa", "Pa", 250e6},
      {"2 kbar", "Pa", 2e8},
      {"1 atm", "Pa", 101325},
      {"4e12 cm^-3", "1/m^3", 4e18},
      {"4e18 1/m^3", "m^-3", 4e18},
      {"10 min", "s", 600},
      {"1.5 h", "s", 5400},
      {"2 d", "s", 172800},
      {"3 us", "s", 3e-6},
      {"250 ns", "s", 250e-9},
      {"2 GiB", "B", 2147483648.0},
      {"2 GB", "B", 2e9},
      {"1.5 MiB", "B", 1572864},
      {"3 %", "1", 0.03},
      {"3%", "1", 0.03},
      {"180 deg", "rad", M_PI},
      {"2 mrad", "rad", 0.002},
      {"3 J/(kg K)", "J/(K kg)", 3},
      {"3 J/kg/K", "J/(K kg)", 3},
      {"3 kg.m/s^2", "N", 3},
      {"3 kg*m/s^2", "N", 3},
      {"3 N m", "J", 3},
      {"7 kHz", "1/s", 7000},
      {"5e34 /m^3", "1/m^3", 5e34},
      {"60/s", "1/s", 60},
      {"2.7 g/cm\u00B3", "kg/m^3", 2700},
      {"2.7 g\u00B7cm\u207B\u00B3", "kg/m^3", 2700},
      {"45\u00B0", "rad", M_PI / 4},
      {"45 \u00BA", "rad", M_PI / 4},
      {"45\u02DA", "rad", M_PI / 4},
      {"90 \u00B0/s", "rad/s", M_PI / 2},
      {"5 \u2030", "1", 0.005},
      {"5\u00A0%", "1", 0.05},
      {"5\u202F\u2030", "1", 0.005},
      {"3 kg\u22C5m/s\u00B2", "N", 3},
      {"3 N\u00D7m", "J", 3},
      {"  5  ", "m", 5},
      {"+.5e+1", "m", 5},
      {"5.", "m", 5},
      {"1e30", "1/m^3", 1e30},
      {"1E-300", "m", 1e-300},
      {"4.9406564584124654e-324", "m", 4.9406564584124654e-324},
      {"-0", "m", 0},
      {"0e999999999999", "m", 0},
      {"5", "cm", 0.05}, /* a number without unit is in the expected unit */
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    double si = -1;
    status code = unit_read(cases[i].text, cases[i].unit, &si, &error);
    if (code || si != cases[i].si)
      wrong++, print_error("'%s' in %s: %.17g, expected %.17g; %s\n", cases[i].text, cases[i].unit, si, cases[i].si,
                           error.message);
  }
  assert_int_equal(wrong, 0);
}

TEST(the_unit_of_a_text) {
  assert_string_equal(unit_of("5 km/s"), "km/s");
  assert_string_equal(unit_of(" 3%"), "%");
  assert_string_equal(unit_of("-2.5e3"), "");
  assert_string_equal(unit_of("off"), "");
}

TEST(degrees_are_near) {
  double si;
  assert_int_equal(unit_read("4 deg", "rad", &si, NULL), STATUS_OK);
  assert_true(fabs(si - 4 * M_PI / 180) < 2e-17); /* two roundings of a value near 0.07 */
}

TEST(messages_are_these) {
  int wrong = 0;
  static const struct {
    const char *text, *unit, *message;
  } cases[] = {
      {"3 m", "m/s", "expected a speed such as m/s, got a length (m)"},
      {"3 km", "kg/m^3", "expected a density such as kg/m^3, got a length (km)"},
      {"4 deg", "1", "expected a plain number, got an angle (deg)"},
      {"4 deg", "m", "expected a length such as m, got an angle (deg)"},
      {"4 %", "rad", "expected an angle such as rad, got a plain number (%)"},
      {"10 s", "B", "expected an amount of memory such as B, got a time (s)"},
      {"3 m^5", "m", "expected a length such as m, got a quantity (m^5)"},
      {"3 m", "kg m^5", "expected a quantity in kg m^5, got a length (m)"},
      {"5 kph", "m/s", "unknown unit 'kph'; did you mean 'km/h'?"},
      {"5 sec", "s", "unknown unit 'sec'; did you mean 's'?"},
      {"5 KM", "m", "unknown unit 'KM'; did you mean 'km'?"},
      {"5 mpa", "Pa", "unknown unit 'mpa'; did you mean 'MPa'?"},
      {"5 gpa", "Pa", "unknown unit 'gpa'; did you mean 'GPa'?"},
      {"5 degs", "rad", "unknown unit 'degs'; did you mean 'deg'?"},
      {"5 furlong", "m", "unknown unit 'furlong'; known are SI units with prefixes, %, deg, min, h, bar, dyn, erg, B"},
      {"5 kmin", "s", "unknown unit 'kmin'; did you mean 'min'?"},
      {"5 %%", "1", "unit '%%' has two percent signs; write one"},
      {"5 % %", "1", "unit '% %' has two percent signs; write one"},
      {"5 m-3", "1/m^3", "in unit 'm-3' write powers with '^', such as m^2"},
      {"5 \u2030 %", "1", "unit '\u2030 %' has two percent signs; write one"},
      {"20 \u00B0C", "K", "unknown unit 'degC'; did you mean 'K'?"},
      {"5 m%", "m", "unexpected '%' in a unit; put a space or '*' between two units"},
      {"5 m^2s", "m", "unexpected 's' in a unit; put a space or '*' between two units"},
      {"5 /", "1/s", "unit '/' ends too early"},
      {"5 //s", "1/s", "unexpected '/s'; expected a unit such as m/s"},
      {"5 /m s", "1/m", "unit '/m s' is ambiguous: put the factors below the '/' in parentheses, such as J/(kg K)"},
      {"5 m2", "m^2", "in unit 'm2' write powers with '^', such as m^2"},
      {"5 m^", "m^2", "in unit 'm^' expected a whole power from 1 to 9 after '^'"},
      {"5 m^0", "m^2", "in unit 'm^0' expected a whole power from 1 to 9 after '^'"},
      {"5 m^12", "m^2", "in unit 'm^12' expected a whole power from 1 to 9 after '^'"},
      {"5 J/kg K", "J/(kg K)",
       "unit 'J/kg K' is ambiguous: put the factors below the '/' in parentheses, such as J/(kg K)"},
      {"5 (m", "m", "unit '(m' lacks a ')'"},
      {"5 m)", "m", "unexpected ')' in a unit"},
      {"5 m/", "m", "unit 'm/' ends too early"},
      {"5 m/;", "m", "unexpected ';'; expected a unit such as m/s"},
      {"5 ((((((((((m))))))))))", "m", "too many parentheses in a unit"},
      {"", "m", "expected a number in m, got nothing"},
      {"", "1", "expected a number, got nothing"},
      {"fast", "m/s", "expected a number in m/s, such as '5 m/s', got 'fast'"},
      {"fast", "1", "expected a number, got 'fast'"},
      {"nan", "m", "expected a finite number in m, such as '5 m', got 'nan'"},
      {".inf", "m", "expected a finite number in m, such as '5 m', got '.inf'"},
      {"-Infinity", "1", "expected a finite number, got '-Infinity'"},
      {"0x10", "m", "expected a decimal number, got '0x10'"},
      {"0o17", "m", "expected a decimal number, got '0o17'"},
      {"1,5 m", "m", "unexpected ',5 m' after the number; a decimal mark is a point"},
      {"1_000", "m", "unexpected '_000' after the number; write digits without separators"},
      {"1.2.3", "m", "unexpected '.3' after the number"},
      {"1 2", "m", "unexpected '2' after the number"},
      {"5 -m", "m", "unexpected '-m' after the number"},
      {"1e999", "m", "1e999 is too large for a double"},
      {"1e308 km", "m", "1e308 km is too large for a double"},
      {"1e-999", "m", "1e-999 is too small for a double"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    double si = 42;
    status code = unit_read(cases[i].text, cases[i].unit, &si, &error);
    if (code != STATUS_CONTENT || strcmp(error.message, cases[i].message) != 0)
      wrong++,
          print_error("'%s': status %d, '%s'\n expected '%s'\n", cases[i].text, code, error.message, cases[i].message);
    assert_true(si == 42); /* untouched on failure */
  }
  assert_int_equal(wrong, 0);
}

TEST(limits_hold) {
  char text[2000];
  double si;
  memset(text, '1', sizeof text);
  text[1999] = 0;
  assert_int_equal(unit_read(text, "m", &si, NULL), STATUS_CONTENT);
  memset(text, '(', sizeof text - 1);
  memcpy(text, "1 ", 2);
  assert_int_equal(unit_read(text, "m", &si, NULL), STATUS_CONTENT);
  for (size_t i = 0; i + 4 < sizeof text; i += 4)
    memcpy(text + i, "m^9 ", 4);
  text[1995] = 0;
  struct unit unit;
  assert_int_equal(unit_parse(text, &unit, NULL), STATUS_CONTENT);
  for (size_t i = 0; i + 2 < sizeof text; i += 2)
    memcpy(text + i, "h ", 2);
  assert_int_equal(unit_parse(text, &unit, NULL), STATUS_CONTENT);
}

TEST(factors_are_si) {
  struct unit a, b;
  assert_int_equal(unit_parse("km/h", &a, NULL), STATUS_OK);
  assert_true(fabs(a.factor - 1 / 3.6) < 1e-16); /* one rounding each side */
  assert_int_equal(unit_parse("cm/s", &b, NULL), STATUS_OK);
  assert_true(unit_same_dimension(&a, &b));
  assert_int_equal(unit_parse("1/s", &b, NULL), STATUS_OK);
  assert_false(unit_same_dimension(&a, &b));
  assert_int_equal(unit_parse("Hz", &a, NULL), STATUS_OK);
  assert_true(unit_same_dimension(&a, &b));
}

/* Any double printed comes back as the same double, also through a unit of a power of ten. */
TEST(numbers_round_trip) {
  uint64_t word = 88172645463325252u; /* xorshift64, Marsaglia 2003 */
  for (int i = 0; i < 20000; i++) {
    word ^= word << 13;
    word ^= word >> 7;
    word ^= word << 17;
    double value, back;
    memcpy(&value, &word, sizeof value);
    if (!(value - value == 0))
      continue; /* NaN and infinity are not numbers here */
    char text[32];
    field_print_number(value, text);
    assert_true(strlen(text) < sizeof text);
    assert_int_equal(unit_read(text, "m", &back, NULL), STATUS_OK);
    if (memcmp(&back, &value, sizeof value) != 0)
      fail_msg("%a printed as %s came back as %a", value, text, back);
  }
  static const char *const shown[] = {"0",   "5",    "5000", "0.05",    "0.00012", "1.2e-6",
                                      "5e8", "1e30", "1e6",  "1234567", "12.5",    "-3"};
  for (size_t i = 0; i < sizeof shown / sizeof shown[0]; i++) {
    char text[32];
    field_print_number(strtod(shown[i], NULL), text);
    assert_string_equal(text, shown[i]);
  }
}
