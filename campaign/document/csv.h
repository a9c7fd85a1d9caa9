/* Reads CSV (RFC 4180): cells with commas between them, in double quotes where a cell holds a comma, a quote ("") or a
 * line break; lines end with LF or CRLF. Empty lines, and lines that begin with #, are skipped. */
#ifndef CLAST_CAMPAIGN_DOCUMENT_CSV_H
#define CLAST_CAMPAIGN_DOCUMENT_CSV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CSV_CELL = 256 };

struct csv { /* set text and end; line to 1 */
  const char *text, *end;
  int64_t line;      /* line of the next character */
  const char *wrong; /* why the last cell cannot be read; NULL: it could */
};

/* True when there is another record; csv->line is the number of its line. */
bool csv_record(struct csv *csv);
/* The next cell of the record, without spaces around it. *last: it ends the record. False: csv->wrong has the reason.
 */
bool csv_cell(struct csv *csv, char cell[CSV_CELL], bool *last);

#endif
