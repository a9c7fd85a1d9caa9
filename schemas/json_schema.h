/* JSON Schema (draft-07) of a field table, for editors (yaml-language-server) and for the test that lets an independent
 * validator judge the same documents as our reader. `clast schema scene|campaign` prints it; the committed copies in
 * schemas/ are compared by a test. */
#ifndef CLAST_SCHEMAS_JSON_SCHEMA_H
#define CLAST_SCHEMAS_JSON_SCHEMA_H

#include <stdio.h>

#include "schemas/field.h"

/* The properties object of a table (nested), with type, range, unit pattern, enum, default and description. */
void json_schema_properties(const struct field_table *table, int indent, FILE *out);
/* if/then clauses for `when` conditions, as an allOf array's items (comma-separated); returns how many. */
int json_schema_conditions(const struct field_table *table, int indent, FILE *out);
/* A whole schema document of one table. */
void json_schema_write(const struct field_table *table, const char *title, FILE *out);

#endif
