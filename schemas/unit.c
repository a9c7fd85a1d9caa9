/* Units of measure: tables, a recursive descent over their grammar, and numbers with units. */
#include "schemas/unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "schemas/text.h"

/* Exact definitions: BIPM, The International System of Units, 9th ed. (2019), tables 3, 4, 7 and 8; CGS: dyn, erg. */
static const struct base {
  const char *name;
  signed char kg, m, s, K, rad, byte;
  signed char ten;
  bool prefixes; /* takes SI prefixes */
  double times, per;
} bases[] = {
    {"1", 0, 0, 0, 0, 0, 0, 0, false, 1, 1},
    {"%", 0, 0, 0, 0, 0, 0, -2, false, 1, 1},
    {"m", 0, 1, 0, 0, 0, 0, 0, true, 1, 1},
    {"g", 1, 0, 0, 0, 0, 0, -3, true, 1, 1},
    {"t", 1, 0, 0, 0, 0, 0, 3, false, 1, 1},
    {"s", 0, 0, 1, 0, 0, 0, 0, true, 1, 1},
    {"min", 0, 0, 1, 0, 0, 0, 0, false, 60, 1},
    {"h", 0, 0, 1, 0, 0, 0, 0, false, 3600, 1},
    {"d", 0, 0, 1, 0, 0, 0, 0, false, 86400, 1},
    {"K", 0, 0, 0, 1, 0, 0, 0, true, 1, 1},
    {"rad", 0, 0, 0, 0, 1, 0, 0, true, 1, 1},
    {"deg", 0, 0, 0, 0, 1, 0, 0, false, M_PI, 180},
    {"Hz", 0, 0, -1, 0, 0, 0, 0, true, 1, 1},
    {"N", 1, 1, -2, 0, 0, 0, 0, true, 1, 1},
    {"Pa", 1, -1, -2, 0, 0, 0, 0, true, 1, 1},
    {"J", 1, 2, -2, 0, 0, 0, 0, true, 1, 1},
    {"W", 1, 2, -3, 0, 0, 0, 0, true, 1, 1},
    {"bar", 1, -1, -2, 0, 0, 0, 5, true, 1, 1},
    {"atm", 1, -1, -2, 0, 0, 0, 0, false, 101325, 1},
    {"dyn", 1, 1, -2, 0, 0, 0, -5, true, 1, 1},
    {"erg", 1, 2, -2, 0, 0, 0, -7, true, 1, 1},
    {"B", 0, 0, 0, 0, 0, 1, 0, true, 1, 1},
    {"KiB", 0, 0, 0, 0, 0, 1, 0, false, 1024, 1},
    {"MiB", 0, 0, 0, 0, 0, 1, 0, false, 1048576, 1},
    {"GiB", 0, 0, 0, 0, 0, 1, 0, false, 1073741824, 1},
    {"TiB", 0, 0, 0, 0, 0, 1, 0, false, 1099511627776, 1},
};
enum { BASES = sizeof bases / sizeof bases[0] };

static const struct prefix {
  const char *name;
  int ten;
} prefixes[] = {
    {"da", 1},  {"d", -1},  {"c", -2}, {"m", -3}, {"u", -6}, {"\xC2\xB5", -6}, {"\xCE\xBC", -6}, {"n", -9}, {"p", -12},
    {"f", -15}, {"a", -18}, {"h", 2},  {"k", 3},  {"M", 6},  {"G", 9},         {"T", 12},        {"P", 15}, {"E", 18},
};
enum { PREFIXES = sizeof prefixes / sizeof prefixes[0] };

/* Spellings that people use, and the unit meant. */
static const char *const habits[][2] = {
    {"kph", "km/h"},    {"kmh", "km/h"},    {"kmph", "km/h"},    {"mph", "km/h"},    {"sec", "s"},
    {"secs", "s"},      {"second", "s"},    {"seconds", "s"},    {"msec", "ms"},     {"usec", "us"},
    {"mins", "min"},    {"minute", "min"},  {"minutes", "min"},  {"hr", "h"},        {"hrs", "h"},
    {"hour", "h"},      {"hours", "h"},     {"day", "d"},        {"days", "d"},      {"meter", "m"},
    {"meters", "m"},    {"metre", "m"},     {"metres", "m"},     {"micron", "um"},   {"microns", "um"},
    {"ft", "m"},        {"inch", "cm"},     {"in", "cm"},        {"gram", "g"},      {"grams", "g"},
    {"gm", "g"},        {"kilogram", "kg"}, {"kilograms", "kg"}, {"kgs", "kg"},      {"cc", "cm^3"},
    {"gcc", "g/cm^3"},  {"mps", "m/s"},     {"kps", "km/s"},     {"fps", "m/s"},     {"degree", "deg"},
    {"degrees", "deg"}, {"degs", "deg"},    {"radian", "rad"},   {"radians", "rad"}, {"percent", "%"},
    {"newton", "N"},    {"newtons", "N"},   {"pascal", "Pa"},    {"pascals", "Pa"},  {"psi", "kPa"},
    {"mpa", "MPa"},     {"joule", "J"},     {"joules", "J"},     {"watt", "W"},      {"watts", "W"},
    {"kelvin", "K"},    {"C", "K"},         {"byte", "B"},       {"bytes", "B"},     {"M", "MiB"},
    {"G", "GiB"},       {"gig", "GiB"},     {"meg", "MiB"},      {"dyne", "dyn"},    {"dynes", "dyn"},
    {"ergs", "erg"},    {"tonne", "t"},     {"ton", "t"},        {"tons", "t"},      {"tonnes", "t"},
};

/* Names of dimensions, for messages. */
static const char *const quantities[][2] = {
    {"a length", "m"},
    {"a time", "s"},
    {"a mass", "kg"},
    {"a temperature", "K"},
    {"an angle", "rad"},
    {"a speed", "m/s"},
    {"an acceleration", "m/s^2"},
    {"a density", "kg/m^3"},
    {"a pressure", "Pa"},
    {"a force", "N"},
    {"an energy", "J"},
    {"a power", "W"},
    {"an area", "m^2"},
    {"a volume", "m^3"},
    {"a rate", "1/s"},
    {"an angular speed", "rad/s"},
    {"a specific energy", "J/kg"},
    {"a mass per length", "kg/m"},
    {"a mass per area", "kg/m^2"},
    {"a number density", "1/m^3"},
    {"a stiffness", "N/m"},
    {"a moment of inertia", "kg m^2"},
    {"a viscosity", "Pa s"},
    {"a momentum", "kg m/s"},
    {"an amount of memory", "B"},
    {"a plain number", "1"},
};

enum { QUOTE = 40, DEEPEST = 8, LARGEST_POWER = 9 };

struct parser {
  const char *whole, *at;
  int depth;
  struct error *error;
};

static const struct unit one = {.factor = 1, .times = 1, .per = 1};

/* Case does not count, except in a single letter: "m" and "M" differ. */
static bool same_but_case(const char *name, size_t length, const char *known) {
  return strlen(known) == length && strncasecmp(known, name, length) == 0 && (length > 1 || known[0] == name[0]);
}

/* The known unit nearest to an unknown name, into `out`; false when none is near. Not text_guess: units are so short
 * that only one edit is a guess, and a wrong case is nearer than that ("KM", "gpa"). */
static bool nearest(const char *name, size_t length, char out[16]) {
  for (size_t i = 0; i < sizeof habits / sizeof habits[0]; i++)
    if (same_but_case(name, length, habits[i][0])) {
      strcpy(out, habits[i][1]);
      return true;
    }

  static const char *const usual[] = {"", "c", "m", "u", "n", "k", "M", "G"};
  size_t best = length > 2 ? 3 : 2; /* twice the distance */
  bool found = false;
  for (size_t b = 1; b < BASES; b++)
    for (size_t p = 0; p < (bases[b].prefixes ? 8u : 1u); p++) {
      char candidate[16];
      snprintf(candidate, sizeof candidate, "%s%s", usual[p], bases[b].name);
      const bool same = strlen(candidate) == length && strncasecmp(candidate, name, length) == 0;
      const size_t distance = same ? 1 : 2 * text_distance(name, length, candidate);
      if (distance >= best)
        continue;
      best = distance;
      strcpy(out, candidate);
      found = true;
    }
  return found;
}

static status unknown(struct parser *p, const char *name, size_t length) {
  char near[16];
  if (nearest(name, length, near))
    return status_fail(p->error, STATUS_CONTENT, "unknown unit '%.*s'; did you mean '%s'?",
                       (int)(length < QUOTE ? length : QUOTE), name, near);
  return status_fail(p->error, STATUS_CONTENT,
                     "unknown unit '%.*s'; known are SI units with prefixes, %%, deg, min, h, bar, dyn, erg, B",
                     (int)(length < QUOTE ? length : QUOTE), name);
}

static void from_base(const struct base *base, int ten, struct unit *unit) {
  *unit = (struct unit){.ten = base->ten + ten,
                        .times = base->times,
                        .per = base->per,
                        .kg = base->kg,
                        .m = base->m,
                        .s = base->s,
                        .K = base->K,
                        .rad = base->rad,
                        .byte = base->byte};
}

static bool known(const char *name, size_t length, struct unit *unit) {
  for (size_t b = 0; b < BASES; b++)
    if (strlen(bases[b].name) == length && memcmp(bases[b].name, name, length) == 0) {
      from_base(&bases[b], 0, unit);
      return true;
    }
  for (size_t p = 0; p < PREFIXES; p++) {
    size_t cut = strlen(prefixes[p].name);
    if (length <= cut || memcmp(prefixes[p].name, name, cut) != 0)
      continue;
    for (size_t b = 0; b < BASES; b++)
      if (bases[b].prefixes && strlen(bases[b].name) == length - cut &&
          memcmp(bases[b].name, name + cut, length - cut) == 0) {
        from_base(&bases[b], prefixes[p].ten, unit);
        return true;
      }
  }
  return false;
}

/* unit *= factor^power. Small integers throughout: the ranges below cannot overflow. */
static status multiply(struct parser *p, struct unit *unit, const struct unit *factor, int power) {
  const int sums[] = {unit->kg + power * factor->kg,   unit->m + power * factor->m,
                      unit->s + power * factor->s,     unit->K + power * factor->K,
                      unit->rad + power * factor->rad, unit->byte + power * factor->byte};
  for (size_t i = 0; i < 6; i++)
    if (abs(sums[i]) > 60)
      return status_fail(p->error, STATUS_CONTENT, "the powers in unit '%.*s' are too large", QUOTE, p->whole);
  unit->kg = (signed char)sums[0];
  unit->m = (signed char)sums[1];
  unit->s = (signed char)sums[2];
  unit->K = (signed char)sums[3];
  unit->rad = (signed char)sums[4];
  unit->byte = (signed char)sums[5];
  unit->ten += power * factor->ten;
  for (int i = 0; i < abs(power); i++) {
    unit->times *= power > 0 ? factor->times : factor->per;
    unit->per *= power > 0 ? factor->per : factor->times;
  }
  if (abs(unit->ten) > 200 || !(unit->times < 1e60) || !(unit->per < 1e60))
    return status_fail(p->error, STATUS_CONTENT, "the powers in unit '%.*s' are too large", QUOTE, p->whole);
  return STATUS_OK;
}

static status product(struct parser *p, struct unit *unit);

static status power(struct parser *p, int *value) {
  *value = 1;
  if (*p->at == '^')
    p->at++;
  else if (p->at[0] == '*' && p->at[1] == '*')
    p->at += 2;
  else if (isdigit((unsigned char)*p->at))
    return status_fail(p->error, STATUS_CONTENT, "in unit '%.*s' write powers with '^', such as m^2", QUOTE, p->whole);
  else
    return STATUS_OK;
  bool negative = *p->at == '-';
  if (*p->at == '-' || *p->at == '+')
    p->at++;
  if (!isdigit((unsigned char)p->at[0]) || isdigit((unsigned char)p->at[1]) || p->at[0] == '0')
    return status_fail(p->error, STATUS_CONTENT, "in unit '%.*s' expected a whole power from 1 to %d after '^'", QUOTE,
                       p->whole, LARGEST_POWER);
  *value = negative ? -(*p->at - '0') : *p->at - '0';
  p->at++;
  return STATUS_OK;
}

static status factor(struct parser *p, struct unit *unit) {
  if (*p->at == '(') {
    if (++p->depth > DEEPEST)
      return status_fail(p->error, STATUS_CONTENT, "too many parentheses in a unit");
    p->at++;
    status code = product(p, unit);
    if (code)
      return code;
    if (*p->at != ')')
      return status_fail(p->error, STATUS_CONTENT, "unit '%.*s' lacks a ')'", QUOTE, p->whole);
    p->at++;
    p->depth--;
    return STATUS_OK;
  }
  const char *name = p->at;
  if (*p->at == '1' || *p->at == '%')
    p->at++;
  else
    while (isalpha((unsigned char)*p->at) || (unsigned char)*p->at >= 0x80)
      p->at++;
  size_t length = (size_t)(p->at - name);
  if (length == 0 && *name == 0)
    return status_fail(p->error, STATUS_CONTENT, "unit '%.*s' ends too early", QUOTE, p->whole);
  if (length == 0)
    return status_fail(p->error, STATUS_CONTENT, "unexpected '%.*s'; expected a unit such as m/s", QUOTE, name);
  return known(name, length, unit) ? STATUS_OK : unknown(p, name, length);
}

static void skip_spaces(struct parser *p) {
  while (*p->at == ' ')
    p->at++;
}

/* A name or parenthesis with its power, multiplied or divided into *unit. */
static status term(struct parser *p, struct unit *unit, bool divide) {
  struct unit next;
  int exponent = 1;
  status code = factor(p, &next);
  if (!code)
    code = power(p, &exponent);
  return code ? code : multiply(p, unit, &next, divide ? -exponent : exponent);
}

static status product(struct parser *p, struct unit *unit) {
  *unit = one;
  bool divided = false, divide = false;
  for (;;) {
    skip_spaces(p);
    status code = term(p, unit, divide);
    if (code)
      return code;
    skip_spaces(p);
    if (*p->at == 0 || *p->at == ')')
      return STATUS_OK;

    divide = *p->at == '/';
    if (divide || *p->at == '*' || *p->at == '.')
      p->at++;
    if (divided && !divide)
      return status_fail(p->error, STATUS_CONTENT,
                         "unit '%.*s' is ambiguous: put the factors below the '/' in parentheses, such as J/(kg K)",
                         QUOTE, p->whole);
    divided = divided || divide;
  }
}

status unit_parse(const char *text, struct unit *unit, struct error *error) {
  struct parser p = {.whole = text, .at = text, .error = error};
  *unit = one;
  status code = product(&p, unit);
  if (code)
    return code;
  if (*p.at)
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' in a unit", QUOTE, p.at);
  unit->factor = unit->times / unit->per * pow(10, unit->ten);
  return STATUS_OK;
}

bool unit_same_dimension(const struct unit *a, const struct unit *b) {
  return a->kg == b->kg && a->m == b->m && a->s == b->s && a->K == b->K && a->rad == b->rad && a->byte == b->byte;
}

static const char *quantity(const struct unit *unit) {
  for (size_t i = 0; i < sizeof quantities / sizeof quantities[0]; i++) {
    struct unit known_one;
    if (unit_parse(quantities[i][1], &known_one, NULL) == STATUS_OK && unit_same_dimension(unit, &known_one))
      return quantities[i][0];
  }
  return NULL;
}

static status wrong_dimension(const struct unit *want, const char *want_text, const struct unit *got,
                              const char *got_text, struct error *error) {
  const char *want_name = quantity(want), *got_name = quantity(got);
  if (!got_name)
    got_name = "a quantity";
  if (want_name && strcmp(want_text, "1") == 0)
    return status_fail(error, STATUS_CONTENT, "expected %s, got %s (%.*s)", want_name, got_name, QUOTE, got_text);
  return status_fail(error, STATUS_CONTENT, "expected %s %s %s, got %s (%.*s)", want_name ? want_name : "a quantity",
                     want_name ? "such as" : "in", want_text, got_name, QUOTE, got_text);
}

/* A decimal number as text: [+-] digits [. digits] [e [+-] digits]. */
struct decimal {
  size_t length, mantissa; /* of the whole, 0 when there is none; of what precedes the exponent */
  long exponent;
  bool zero;
};

static struct decimal scan(const char *text) {
  struct decimal number = {.zero = true};
  size_t i = text[0] == '+' || text[0] == '-', digits = 0;
  for (bool point = false; isdigit((unsigned char)text[i]) || (text[i] == '.' && !point); i++) {
    point = point || text[i] == '.';
    digits += text[i] != '.';
    number.zero = number.zero && (text[i] == '0' || text[i] == '.');
  }
  if (!digits)
    return number;
  number.length = number.mantissa = i;
  if (text[i] != 'e' && text[i] != 'E')
    return number;

  const bool negative = text[i + 1] == '-';
  size_t j = i + 1 + (negative || text[i + 1] == '+');
  if (!isdigit((unsigned char)text[j]))
    return number;
  for (; isdigit((unsigned char)text[j]); j++)
    if (number.exponent < 100000)
      number.exponent = 10 * number.exponent + (text[j] - '0');
  if (negative)
    number.exponent = -number.exponent;
  number.length = j;
  return number;
}

static bool is_word(const char *text, const char *word) {
  text += *text == '+' || *text == '-';
  text += *text == '.';
  size_t length = strlen(word);
  return strncasecmp(text, word, length) == 0;
}

static status no_number(const char *text, const char *expected, struct error *error) {
  const bool unitless = strcmp(expected, "1") == 0;
  if (*text == 0)
    return status_fail(error, STATUS_CONTENT, "expected a number%s%s, got nothing", unitless ? "" : " in ",
                       unitless ? "" : expected);
  const char *what = is_word(text, "nan") || is_word(text, "inf") ? "a finite number" : "a number";
  if (unitless)
    return status_fail(error, STATUS_CONTENT, "expected %s, got '%.*s'", what, QUOTE, text);
  return status_fail(error, STATUS_CONTENT, "expected %s in %s, such as '5 %s', got '%.*s'", what, expected, expected,
                     QUOTE, text);
}

/* What comes right behind a number and looks like a part of it. */
static status check_end(const char *text, size_t length, struct error *error) {
  const char *rest = text + length;
  if (length == 1 && text[0] == '0' && (*rest == 'x' || *rest == 'X' || *rest == 'o'))
    return status_fail(error, STATUS_CONTENT, "expected a decimal number, got '%.*s'", QUOTE, text);
  if (*rest == ',')
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' after the number; a decimal mark is a point", QUOTE,
                       rest);
  if (*rest == '_')
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' after the number; write digits without separators",
                       QUOTE, rest);
  return STATUS_OK;
}

/* The unit behind a number, of the dimension of `want`; nothing there means `want` itself. */
static status read_unit(const char *rest, const struct unit *want, const char *want_text, struct unit *got,
                        struct error *error) {
  const bool spaced = *rest == ' ';
  while (*rest == ' ')
    rest++;
  *got = *want;
  if (*rest == 0)
    return STATUS_OK;
  const bool per = spaced && rest[0] == '1' && rest[1] == '/'; /* "5 1/s" */
  if ((isdigit((unsigned char)*rest) && !per) || *rest == '.' || *rest == '+' || *rest == '-')
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' after the number", QUOTE, rest);
  status code = unit_parse(rest, got, error);
  if (code)
    return code;
  return unit_same_dimension(want, got) ? STATUS_OK : wrong_dimension(want, want_text, got, rest, error);
}

bool unit_is_bare(const char *text) {
  text += strspn(text, " ");
  const size_t length = scan(text).length;
  return length && text[length + strspn(text + length, " ")] == 0;
}

const char *unit_usual(const char *unit) {
  static const char *const usual[][2] = {{"rad", "deg"},    {"1", "%"},           {"m", "cm"},         {"s", "us"},
                                         {"m/s", "km/s"},   {"Pa", "GPa"},        {"kg", "g"},         {"J/m", "kJ/m"},
                                         {"J/kg", "kJ/kg"}, {"kg/m^3", "g/cm^3"}, {"1/m^3", "1/cm^3"}, {"B", "MiB"}};
  for (size_t i = 0; i < sizeof usual / sizeof usual[0]; i++)
    if (strcmp(usual[i][0], unit) == 0)
      return usual[i][1];
  return NULL;
}

status unit_read(const char *text, const char *expected_unit, double *si, struct error *error) {
  struct unit want, got;
  status code = unit_parse(expected_unit, &want, error);
  if (code)
    return code;
  while (*text == ' ')
    text++;

  const struct decimal number = scan(text);
  if (number.length == 0)
    return no_number(text, expected_unit, error);
  code = check_end(text, number.length, error);
  if (!code)
    code = read_unit(text + number.length, &want, expected_unit, &got, error);
  if (code)
    return code;

  char shifted[512]; /* the powers of ten of number and unit together: one rounding */
  if (number.mantissa > sizeof shifted - 32)
    return status_fail(error, STATUS_CONTENT, "a number of more than 480 digits is refused");
  snprintf(shifted, sizeof shifted, "%.*se%ld", (int)number.mantissa, text, number.exponent + got.ten);
  const double value = strtod(shifted, NULL) * got.times / got.per;
  if (!isfinite(value))
    return status_fail(error, STATUS_CONTENT, "%.*s is too large for a double", QUOTE, text);
  if (value == 0 && !number.zero)
    return status_fail(error, STATUS_CONTENT, "%.*s is too small for a double", QUOTE, text);
  *si = value;
  return STATUS_OK;
}

const char *unit_of(const char *text) {
  while (*text == ' ')
    text++;
  const struct decimal number = scan(text);
  if (number.length == 0)
    return "";
  text += number.length;
  while (*text == ' ')
    text++;
  return text;
}
