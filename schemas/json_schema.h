/* JSON Schema (draft-07) of a field table, for editors (yaml-language-server) and for the test that compares an
 * independent validator with our reader on the same documents. `clast schema` prints it. The committed copies in
 * schemas/ are written by the build target schemas, and a test compares them. */
#pragma once

#include <stdio.h>

#include "schemas/field.h"

/* The members of a table's `properties` object (nested; no braces around them, so that a caller may add its own), with
 * type, range, unit pattern, enum, default and description. */
void json_schema_properties(const struct field_table *table, int indent, FILE *out);
/* The required words of the top level, as a JSON array's items; returns how many. */
int json_schema_required(const struct field_table *table, FILE *out);
/* A whole schema document of one table. `extra` (may be NULL) is text with further members of `properties`, such as
 * "\"name\": {\"type\": \"string\"}"; `extra_required` (may be NULL) one of them that is required. */
void json_schema_write(const struct field_table *table, const char *title, const char *extra,
                       const char *extra_required, FILE *out);
