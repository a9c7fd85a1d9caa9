/* Lists the canned queries. */
#include "campaign/print/canned_table.h"

#include "db/ask/canned.h"

status canned_table_print(enum table_format format, struct error *error) {
  struct table *table = table_new(format, stdout);
  table_columns(table, (const char *const[]){"name", "with", "answers", NULL});
  if (format != TABLE_TEXT)
    table_column(table, "sql", NULL);
  for (size_t i = 0; i < ask_canned_count(); i++) {
    const struct query_canned *canned = ask_canned_at(i);
    table_text(table, canned->name);
    table_text(table, canned->parameters);
    table_text(table, canned->doc);
    if (format != TABLE_TEXT)
      table_text(table, canned->sql);
  }
  return table_end(table, error);
}
