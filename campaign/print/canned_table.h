/* The canned queries of `clast query --list`: name, parameters and meaning; for programs also the SQL. */
#ifndef CLAST_CAMPAIGN_PRINT_CANNED_TABLE_H
#define CLAST_CAMPAIGN_PRINT_CANNED_TABLE_H

#include "campaign/terminal/table.h"

status canned_table_print(enum table_format format, struct error *error);

#endif
