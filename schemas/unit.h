/* Units: text such as "km/s", "kg/m^3", "dyn/cm^2", "deg", "%" converted to a factor to SI and a dimension, once, when
 * a document is read. All later values are doubles in SI. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "schemas/status.h"

/* The dimensions kg, m, s, K, rad, byte. The last two are separate dimensions so that "4 deg" is refused for a length
 * or a plain number. */
enum { UNIT_BASES = 6 };

struct unit {
  double factor; /* 1 of this unit in SI: times / per * 10^ten */
  int ten;       /* separate so that "5 cm", "50 mm" and "0.05 m" become the same double: decimal shifts are exact */
  double times, per;
  signed char power[UNIT_BASES];
};

/* Grammar: names joined by space, '*', '.', '/' with integer powers '^n' or '**n'; parentheses; SI prefixes, and
 * Ki Mi Gi Ti for bytes (B). "1" and "%" are dimensionless. A '/' may come first ("/m^3"); typeset dots, minus signs
 * and powers ("m⁻³") are known. A product behind a '/' needs parentheses: "J/(kg K)". STATUS_CONTENT with the
 * nearest known unit on a bad name. */
status unit_parse(const char *text, struct unit *unit, struct error *error);
bool unit_same_dimension(const struct unit *a, const struct unit *b);

/* Is the text a number without a unit? */
bool unit_is_bare(const char *text);
/* Another unit that people often use where `unit` is expected ("deg" for "rad"); NULL when there is none. */
const char *unit_usual(const char *unit);

/* "5 km/s" with expected "m/s" -> 5000. A number without a unit is in the expected unit. Refuses NaN, inf, hex floats,
 * trailing text, wrong dimension; messages name the expected unit and quote the text. The result is the double nearest
 * to the exact decimal value whenever the unit is a power of ten of SI. */
status unit_read(const char *text, const char *expected_unit, double *si, struct error *error);

/* The same of an option. A number other than 0 without its unit is refused, unless it has none. */
status unit_read_whole(const char *text, const char *expected_unit, double *si, struct error *error);

/* The part of such a text that is its unit: "km/s" in "5 km/s"; "" without a unit or a number. */
const char *unit_of(const char *text);
