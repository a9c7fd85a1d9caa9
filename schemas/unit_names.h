/* Names of units, for unit.c only. */
#ifndef CLAST_SCHEMAS_UNIT_NAMES_H
#define CLAST_SCHEMAS_UNIT_NAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "schemas/unit.h"

enum { UNIT_NAMES_LENGTH = 16 };

/* Finds the unit of this name, which may have a prefix ("km"); does not fill its `factor`. `name` has `length`
 * bytes. */
bool unit_names_find(const char *name, size_t length, struct unit *unit);

/* Writes the known unit nearest to an unknown name into `out`; false when none is near. */
bool unit_names_near(const char *name, size_t length, char out[UNIT_NAMES_LENGTH]);

#endif
