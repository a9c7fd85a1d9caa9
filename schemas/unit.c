/* Units of measure: the units that clast knows, a recursive-descent parser, and numbers with units. */
#include "schemas/unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "schemas/text.h"

/* ---- names, with SI prefixes, and the spellings that people use instead ---- */

enum { NAME = 16 };

/* Exact definitions: BIPM, The International System of Units, 9th ed. (2019), tables 3, 4, 7 and 8; CGS: dyn, erg. */
static const struct base {
  const char *name;
  signed char power[UNIT_BASES]; /* of kg, m, s, K, rad, byte */
  signed char ten;
  bool prefixes; /* takes SI prefixes */
  double times, per;
} bases[] = {
    {"1", {0, 0, 0, 0, 0, 0}, 0, false, 1, 1},
    {"%", {0, 0, 0, 0, 0, 0}, -2, false, 1, 1},
    {"\u2030", {0, 0, 0, 0, 0, 0}, -3, false, 1, 1}, /* per mille */
    {"m", {0, 1, 0, 0, 0, 0}, 0, true, 1, 1},
    {"g", {1, 0, 0, 0, 0, 0}, -3, true, 1, 1},
    {"t", {1, 0, 0, 0, 0, 0}, 3, false, 1, 1},
    {"s", {0, 0, 1, 0, 0, 0}, 0, true, 1, 1},
    {"min", {0, 0, 1, 0, 0, 0}, 0, false, 60, 1},
    {"h", {0, 0, 1, 0, 0, 0}, 0, false, 3600, 1},
    {"d", {0, 0, 1, 0, 0, 0}, 0, false, 86400, 1},
    {"K", {0, 0, 0, 1, 0, 0}, 0, true, 1, 1},
    {"rad", {0, 0, 0, 0, 1, 0}, 0, true, 1, 1},
    {"deg", {0, 0, 0, 0, 1, 0}, 0, false, M_PI, 180},
    {"Hz", {0, 0, -1, 0, 0, 0}, 0, true, 1, 1},
    {"N", {1, 1, -2, 0, 0, 0}, 0, true, 1, 1},
    {"Pa", {1, -1, -2, 0, 0, 0}, 0, true, 1, 1},
    {"J", {1, 2, -2, 0, 0, 0}, 0, true, 1, 1},
    {"W", {1, 2, -3, 0, 0, 0}, 0, true, 1, 1},
    {"bar", {1, -1, -2, 0, 0, 0}, 5, true, 1, 1},
    {"atm", {1, -1, -2, 0, 0, 0}, 0, false, 101325, 1},
    {"dyn", {1, 1, -2, 0, 0, 0}, -5, true, 1, 1},
    {"erg", {1, 2, -2, 0, 0, 0}, -7, true, 1, 1},
    {"B", {0, 0, 0, 0, 0, 1}, 0, true, 1, 1},
    {"KiB", {0, 0, 0, 0, 0, 1}, 0, false, 1024, 1},
    {"MiB", {0, 0, 0, 0, 0, 1}, 0, false, 1048576, 1},
    {"GiB", {0, 0, 0, 0, 0, 1}, 0, false, 1073741824, 1},
    {"TiB", {0, 0, 0, 0, 0, 1}, 0, false, 1099511627776, 1},
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

/* Spellings that users write, and the unit that they mean. */
static const char *const habits[][2] = {
    {"kph", "km/h"},    {"kmh", "km/h"},    {"kmph", "km/h"},    {"mph", "km/h"},   {"sec", "s"},
    {"secs", "s"},      {"second", "s"},    {"seconds", "s"},    {"msec", "ms"},    {"usec", "us"},
    {"mins", "min"},    {"minute", "min"},  {"minutes", "min"},  {"hr", "h"},       {"hrs", "h"},
    {"hour", "h"},      {"hours", "h"},     {"day", "d"},        {"days", "d"},     {"meter", "m"},
    {"meters", "m"},    {"metre", "m"},     {"metres", "m"},     {"micron", "um"},  {"microns", "um"},
    {"ft", "m"},        {"inch", "cm"},     {"in", "cm"},        {"gram", "g"},     {"grams", "g"},
    {"gm", "g"},        {"kilogram", "kg"}, {"kilograms", "kg"}, {"kgs", "kg"},     {"cc", "cm^3"},
    {"gcc", "g/cm^3"},  {"mps", "m/s"},     {"kps", "km/s"},     {"fps", "m/s"},    {"degree", "deg"},
    {"degrees", "deg"}, {"degs", "deg"},    {"degC", "K"},       {"radian", "rad"}, {"radians", "rad"},
    {"percent", "%"},   {"newton", "N"},    {"newtons", "N"},    {"pascal", "Pa"},  {"pascals", "Pa"},
    {"psi", "kPa"},     {"mpa", "MPa"},     {"joule", "J"},      {"joules", "J"},   {"watt", "W"},
    {"watts", "W"},     {"kelvin", "K"},    {"C", "K"},          {"byte", "B"},     {"bytes", "B"},
    {"M", "MiB"},       {"G", "GiB"},       {"gig", "GiB"},      {"meg", "MiB"},    {"dyne", "dyn"},
    {"dynes", "dyn"},   {"ergs", "erg"},    {"tonne", "t"},      {"ton", "t"},      {"tons", "t"},
    {"tonnes", "t"},
};

/* Compares without regard to case, except for a single letter: "m" and "M" differ. */
static bool same_but_case(const char *name, size_t length, const char *known) {
  return strlen(known) == length && strncasecmp(known, name, length) == 0 && (length > 1 || known[0] == name[0]);
}

/* Writes the known unit nearest to an unknown name; false when none is near. text_guess is not used: units are so short
 * that only one edit is a guess, and a wrong case is nearer than one edit
 * ("KM", "gpa"). */
static bool find_near(const char *name, size_t length, char out[NAME]) {
  for (size_t i = 0; i < sizeof habits / sizeof habits[0]; i++)
    if (same_but_case(name, length, habits[i][0])) {
      snprintf(out, NAME, "%s", habits[i][1]);
      return true;
    }

  static const char *const usual[] = {"", "c", "m", "u", "n", "k", "M", "G"};
  size_t best = length > 2 ? 3 : 2; /* twice the distance */
  bool found = false;
  for (size_t b = 1; b < BASES; b++)
    for (size_t p = 0; p < (bases[b].prefixes ? 8u : 1u); p++) {
      char candidate[NAME];
      snprintf(candidate, sizeof candidate, "%s%s", usual[p], bases[b].name);
      const bool wrong_case = strlen(candidate) == length && strncasecmp(candidate, name, length) == 0;
      const size_t distance = wrong_case ? 1 : 2 * text_distance(name, length, candidate);
      if (distance >= best)
        continue;
      best = distance;
      memcpy(out, candidate, sizeof candidate);
      found = true;
    }
  return found;
}

static const struct base *find_base(const char *name, size_t length) {
  for (size_t b = 0; b < BASES; b++)
    if (strlen(bases[b].name) == length && memcmp(bases[b].name, name, length) == 0)
      return &bases[b];
  return NULL;
}

/* The base unit of a name with a prefix; *ten is the prefix's power of ten. */
static const struct base *find_prefixed(const char *name, size_t length, int *ten) {
  for (size_t p = 0; p < PREFIXES; p++) {
    const size_t cut = strlen(prefixes[p].name);
    if (length <= cut || memcmp(prefixes[p].name, name, cut) != 0)
      continue;
    const struct base *base = find_base(name + cut, length - cut);
    if (!base || !base->prefixes)
      continue;
    *ten = prefixes[p].ten;
    return base;
  }
  return NULL;
}

/* Finds the unit of this name, which may have a prefix ("km"); does not fill its `factor`. */
static bool find_name(const char *name, size_t length, struct unit *unit) {
  int ten = 0;
  const struct base *base = find_base(name, length);
  if (!base)
    base = find_prefixed(name, length, &ten);
  if (!base)
    return false;
  *unit = (struct unit){.ten = base->ten + ten, .times = base->times, .per = base->per};
  memcpy(unit->power, base->power, sizeof unit->power);
  return true;
}

/* ---- the parser ---- */

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

static status unknown(struct parser *p, const char *name, size_t length) {
  char near[NAME];
  if (find_near(name, length, near))
    return status_fail(p->error, STATUS_CONTENT, "unknown unit '%.*s'; did you mean '%s'?",
                       (int)(length < QUOTE ? length : QUOTE), name, near);
  return status_fail(p->error, STATUS_CONTENT,
                     "unknown unit '%.*s'; known are SI units with prefixes, %%, deg, min, h, bar, dyn, erg, B",
                     (int)(length < QUOTE ? length : QUOTE), name);
}

/* unit *= factor^power. Small integers throughout: the ranges below cannot overflow. */
static status multiply(struct parser *p, struct unit *unit, const struct unit *factor, int power) {
  bool large = false;
  for (size_t k = 0; k < UNIT_BASES; k++) {
    const int sum = unit->power[k] + power * factor->power[k];
    large = large || abs(sum) > 60;
    unit->power[k] = (signed char)sum;
  }
  unit->ten += power * factor->ten;
  for (int i = 0; i < abs(power); i++) {
    unit->times *= power > 0 ? factor->times : factor->per;
    unit->per *= power > 0 ? factor->per : factor->times;
  }
  if (large || abs(unit->ten) > 200 || !(unit->times < 1e60) || !(unit->per < 1e60))
    return status_fail(p->error, STATUS_CONTENT, "the powers in unit '%.*s' are too large", QUOTE, p->whole);
  return STATUS_OK;
}

static status product(struct parser *p, struct unit *unit);

static bool is_digit(char byte) {
  return isdigit((unsigned char)byte);
}

/* The power behind a name or parenthesis; 1 when there is none. */
static status power(struct parser *p, int *value) {
  *value = 1;
  if (is_digit(p->at[*p->at == '-']))
    return status_fail(p->error, STATUS_CONTENT, "in unit '%.*s' write powers with '^', such as m^2", QUOTE, p->whole);
  const size_t length = strncmp(p->at, "**", 2) == 0 ? 2 : *p->at == '^'; /* of the sign of a power */
  if (length == 0)
    return STATUS_OK;

  p->at += length;
  const int sign = *p->at == '-' ? -1 : 1;
  if (*p->at == '-' || *p->at == '+')
    p->at++;
  if (!is_digit(p->at[0]) || is_digit(p->at[1]) || p->at[0] == '0')
    return status_fail(p->error, STATUS_CONTENT, "in unit '%.*s' expected a whole power from 1 to %d after '^'", QUOTE,
                       p->whole, LARGEST_POWER);
  *value = sign * (*p->at++ - '0');
  return STATUS_OK;
}

static status parenthesis(struct parser *p, struct unit *unit) {
  if (++p->depth > DEEPEST)
    return status_fail(p->error, STATUS_CONTENT, "too many parentheses in a unit");
  p->at++;
  TRY(product(p, unit));
  if (*p->at != ')')
    return status_fail(p->error, STATUS_CONTENT, "unit '%.*s' lacks a ')'", QUOTE, p->whole);
  p->at++;
  p->depth--;
  return STATUS_OK;
}

/* Length of the name at `at`: "1", "%", or letters, in UTF-8. */
static size_t name_length(const char *at) {
  if (*at == '1' || *at == '%')
    return 1;
  size_t length = 0;
  while (isalpha((unsigned char)at[length]) || (unsigned char)at[length] >= 0x80)
    length++;
  return length;
}

static status factor(struct parser *p, struct unit *unit) {
  if (*p->at == '(')
    return parenthesis(p, unit);
  const char *name = p->at;
  const size_t length = name_length(name);
  p->at += length;
  if (length == 0 && *name == 0)
    return status_fail(p->error, STATUS_CONTENT, "unit '%.*s' ends too early", QUOTE, p->whole);
  if (length == 0)
    return status_fail(p->error, STATUS_CONTENT, "unexpected '%.*s'; expected a unit such as m/s", QUOTE, name);
  return find_name(name, length, unit) ? STATUS_OK : unknown(p, name, length);
}

static void skip_spaces(struct parser *p) {
  p->at += strspn(p->at, " ");
}

/* A name or parenthesis with its power, multiplied or divided into *unit. */
static status term(struct parser *p, struct unit *unit, bool divide) {
  struct unit next;
  int exponent = 1;
  TRY(factor(p, &next));
  TRY(power(p, &exponent));
  return multiply(p, unit, &next, divide ? -exponent : exponent);
}

static status product(struct parser *p, struct unit *unit) {
  *unit = one;
  bool divide = *p->at == '/' && p->at == p->whole, divided = divide; /* "/m^3", as in "5e34 /m^3" */
  p->at += divide;
  for (;;) {
    skip_spaces(p);
    TRY(term(p, unit, divide));
    const char *const end = p->at;
    skip_spaces(p);
    if (*p->at == 0 || *p->at == ')')
      return STATUS_OK;

    divide = *p->at == '/';
    if (divide || *p->at == '*' || *p->at == '.')
      p->at++;
    else if (p->at == end && *end != '(' && end[-1] != ')')
      return status_fail(p->error, STATUS_CONTENT, "unexpected '%.*s' in a unit; put a space or '*' between two units",
                         QUOTE, end);
    if (divided && !divide)
      return status_fail(p->error, STATUS_CONTENT,
                         "unit '%.*s' is ambiguous: put the factors below the '/' in parentheses, such as J/(kg K)",
                         QUOTE, p->whole);
    divided = divided || divide;
  }
}

enum { UNIT_LENGTH = 200 };

/* Writes typeset signs as the grammar has them: "kg·m⁻³" becomes "kg*m^-3". False: the unit is too long. */
static bool plain_form(const char *text, char plain[UNIT_LENGTH]) {
  static const char *const signs[][2] = {
      {"\u00B7", "*"},   {"\u22C5", "*"},   {"\u00D7", "*"},   {"\u2212", "-"}, /* dots, cross, minus */
      {"\u00B0", "deg"}, {"\u00BA", "deg"}, {"\u02DA", "deg"}, /* degree, and what looks like it: ordinal, ring */
      {"\u00A0", " "},   {"\u202F", " "},                      /* spaces that do not break */
      {"\u207B", "-"},   {"\u2070", "0"},   {"\u00B9", "1"},   {"\u00B2", "2"}, {"\u00B3", "3"}, {"\u2074", "4"},
      {"\u2075", "5"},   {"\u2076", "6"},   {"\u2077", "7"},   {"\u2078", "8"}, {"\u2079", "9"}, /* superscripts */
  };
  enum { SIGNS = sizeof signs / sizeof signs[0], RAISED = 9 };
  bool raised = false, whole = true;
  plain[0] = '\0';
  while (*text && whole) {
    size_t k = 0;
    while (k < SIGNS && strncmp(text, signs[k][0], strlen(signs[k][0])) != 0)
      k++;
    const bool raise = k < SIGNS && k >= RAISED;
    if (k < SIGNS)
      whole = text_append(plain, UNIT_LENGTH, "%s%s", raise && !raised ? "^" : "", signs[k][1]);
    else
      whole = text_append(plain, UNIT_LENGTH, "%c", *text);
    text += k < SIGNS ? strlen(signs[k][0]) : 1;
    raised = raise;
  }
  return whole;
}

status unit_parse(const char *text, struct unit *unit, struct error *error) {
  char plain[UNIT_LENGTH];
  struct parser p = {.whole = plain, .at = plain, .error = error};
  *unit = one;
  if (!plain_form(text, plain))
    return status_fail(error, STATUS_CONTENT, "unit '%.*s' is too long", QUOTE, text);
  size_t shares = 0; /* percent and per mille */
  for (const char *c = plain; *c; c++)
    shares += *c == '%' || strncmp(c, "\u2030", strlen("\u2030")) == 0;
  if (shares > 1)
    return status_fail(error, STATUS_CONTENT, "unit '%.*s' has two percent signs; write one", QUOTE, text);
  TRY(product(&p, unit));
  if (*p.at)
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' in a unit", QUOTE, p.at);
  unit->factor = unit->times / unit->per * pow(10, unit->ten);
  return STATUS_OK;
}

bool unit_same_dimension(const struct unit *a, const struct unit *b) {
  return memcmp(a->power, b->power, sizeof a->power) == 0;
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
  if (!want_name)
    return status_fail(error, STATUS_CONTENT, "expected a quantity in %s, got %s (%.*s)", want_text, got_name, QUOTE,
                       got_text);
  if (strcmp(want_text, "1") == 0)
    return status_fail(error, STATUS_CONTENT, "expected %s, got %s (%.*s)", want_name, got_name, QUOTE, got_text);
  return status_fail(error, STATUS_CONTENT, "expected %s such as %s, got %s (%.*s)", want_name, want_text, got_name,
                     QUOTE, got_text);
}

/* A decimal number as text: [+-] digits [. digits] [e [+-] digits]. */
struct decimal {
  size_t length, mantissa; /* of the whole number (0: none); of the part before the exponent */
  long exponent;
  bool zero;
};

static size_t skip_sign(const char *text, size_t i) {
  return i + (text[i] == '+' || text[i] == '-');
}

static size_t skip_digits(const char *text, size_t i) {
  while (is_digit(text[i]))
    i++;
  return i;
}

/* The end of the mantissa; 0 when it has no digit. */
static size_t mantissa_end(const char *text) {
  const size_t begin = skip_sign(text, 0), point = skip_digits(text, begin);
  if (text[point] != '.')
    return point > begin ? point : 0;
  const size_t end = skip_digits(text, point + 1);
  return end > begin + 1 ? end : 0; /* "." alone is no number */
}

/* The exponent after the mantissa; 0 if there is none. *end moves behind it. Values beyond 1e5 are truncated. */
static long read_exponent(const char *text, size_t *end) {
  if (text[*end] != 'e' && text[*end] != 'E')
    return 0;
  const size_t sign = *end + 1, first = skip_sign(text, sign);
  if (!is_digit(text[first]))
    return 0;
  long exponent = 0;
  *end = skip_digits(text, first);
  for (size_t i = first; i < *end && exponent < 100000; i++)
    exponent = 10 * exponent + (text[i] - '0');
  return text[sign] == '-' ? -exponent : exponent;
}

static struct decimal scan(const char *text) {
  struct decimal number = {.mantissa = mantissa_end(text)};
  if (number.mantissa == 0)
    return number;
  number.length = number.mantissa;
  number.exponent = read_exponent(text, &number.length);
  number.zero = strspn(text, "+-0.") >= number.mantissa;
  return number;
}

static bool is_word(const char *text, const char *word) {
  text += skip_sign(text, 0);
  text += *text == '.';
  return strncasecmp(text, word, strlen(word)) == 0;
}

static status no_number(const char *text, const char *expected, struct error *error) {
  const bool unitless = strcmp(expected, "1") == 0;
  if (*text == 0 && unitless)
    return status_fail(error, STATUS_CONTENT, "expected a number, got nothing");
  if (*text == 0)
    return status_fail(error, STATUS_CONTENT, "expected a number in %s, got nothing", expected);
  const char *what = is_word(text, "nan") || is_word(text, "inf") ? "a finite number" : "a number";
  if (unitless)
    return status_fail(error, STATUS_CONTENT, "expected %s, got '%.*s'", what, QUOTE, text);
  return status_fail(error, STATUS_CONTENT, "expected %s in %s, such as '5 %s', got '%.*s'", what, expected, expected,
                     QUOTE, text);
}

/* Refuses text directly after a number that looks like a part of it. */
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

/* The unit after a number, with the dimension of `want`; without a unit it is `want` itself. */
static status read_unit(const char *rest, const struct unit *want, const char *want_text, struct unit *got,
                        struct error *error) {
  const bool spaced = *rest == ' ';
  rest += strspn(rest, " ");
  *got = *want;
  if (*rest == 0)
    return STATUS_OK;
  const bool per = spaced && strncmp(rest, "1/", 2) == 0; /* "5 1/s" */
  if (!per && strchr("0123456789.+-", *rest))
    return status_fail(error, STATUS_CONTENT, "unexpected '%.*s' after the number", QUOTE, rest);
  TRY(unit_parse(rest, got, error));
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
  TRY(unit_parse(expected_unit, &want, error));
  text += strspn(text, " ");

  const struct decimal number = scan(text);
  if (number.length == 0)
    return no_number(text, expected_unit, error);
  TRY(check_end(text, number.length, error));
  TRY(read_unit(text + number.length, &want, expected_unit, &got, error));

  char shifted[512]; /* add the powers of ten of number and unit: only one rounding */
  if (number.mantissa > sizeof shifted - 32)
    return status_fail(error, STATUS_CONTENT, "a number of more than 480 digits; write fewer");
  snprintf(shifted, sizeof shifted, "%.*se%ld", (int)number.mantissa, text, number.exponent + got.ten);
  const double value = strtod(shifted, NULL) * got.times / got.per;
  if (!isfinite(value))
    return status_fail(error, STATUS_CONTENT, "%.*s is too large for a double", QUOTE, text);
  if (value == 0 && !number.zero)
    return status_fail(error, STATUS_CONTENT, "%.*s is too small for a double", QUOTE, text);
  *si = value;
  return STATUS_OK;
}

status unit_read_whole(const char *text, const char *expected_unit, double *si, struct error *error) {
  const char *usual = unit_usual(expected_unit);
  if (!unit_is_bare(text) || strtod(text, NULL) == 0 || strcmp(expected_unit, "1") == 0)
    return unit_read(text, expected_unit, si, error);
  return status_fail(error, STATUS_CONTENT, "%.*s has no unit; write '%.*s %s'%s%.*s%s%s%s", QUOTE, text, QUOTE, text,
                     expected_unit, usual ? " or '" : "", usual ? QUOTE : 0, text, usual ? " " : "", usual ? usual : "",
                     usual ? "'" : "");
}

const char *unit_of(const char *text) {
  text += strspn(text, " ");
  const struct decimal number = scan(text);
  if (number.length == 0)
    return "";
  text += number.length;
  text += strspn(text, " ");
  return text;
}
