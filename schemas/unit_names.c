/* The units that clast knows, with SI prefixes, and the spellings that people use instead. */
#include "schemas/unit_names.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "schemas/text.h"

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

/* Compares without regard to case, except for a single letter: "m" and "M" differ. */
static bool same_but_case(const char *name, size_t length, const char *known) {
  return strlen(known) == length && strncasecmp(known, name, length) == 0 && (length > 1 || known[0] == name[0]);
}

/* Twice the edit distance; a wrong case alone counts as half an edit. */
static size_t half_edits(const char *name, size_t length, const char *known) {
  if (strlen(known) == length && strncasecmp(known, name, length) == 0)
    return 1;
  return 2 * text_distance(name, length, known);
}

/* text_guess is not used: units are so short that only one edit is a guess, and a wrong case is nearer than one edit
 * ("KM", "gpa"). */
bool unit_names_near(const char *name, size_t length, char out[UNIT_NAMES_LENGTH]) {
  for (size_t i = 0; i < sizeof habits / sizeof habits[0]; i++)
    if (same_but_case(name, length, habits[i][0])) {
      snprintf(out, UNIT_NAMES_LENGTH, "%s", habits[i][1]);
      return true;
    }

  static const char *const usual[] = {"", "c", "m", "u", "n", "k", "M", "G"};
  size_t best = length > 2 ? 3 : 2; /* twice the distance */
  bool found = false;
  for (size_t b = 1; b < BASES; b++)
    for (size_t p = 0; p < (bases[b].prefixes ? 8u : 1u); p++) {
      char candidate[UNIT_NAMES_LENGTH];
      snprintf(candidate, sizeof candidate, "%s%s", usual[p], bases[b].name);
      const size_t distance = half_edits(name, length, candidate);
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

bool unit_names_find(const char *name, size_t length, struct unit *unit) {
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
