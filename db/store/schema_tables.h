/* The tables that db/store/schema.h serves; engines' result tables come on top of these. */
#ifndef CLAST_DB_STORE_SCHEMA_TABLES_H
#define CLAST_DB_STORE_SCHEMA_TABLES_H

#include "db/store/schema.h"

extern const struct schema_table schema_tables[];
extern const size_t schema_tables_count;
extern const struct schema_index schema_tables_indexes[];
extern const size_t schema_tables_indexes_count;

#endif
