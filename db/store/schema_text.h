/* The text of a CREATE statement in a form that can be compared: without comments and blanks, a line per column. */
#ifndef CLAST_DB_STORE_SCHEMA_TEXT_H
#define CLAST_DB_STORE_SCHEMA_TEXT_H

#include <stdbool.h>
#include <stddef.h>

enum { SCHEMA_TEXT_LINES = 2100 }; /* SQLite has at most 2000 columns in a table */

/* Lines of a statement `CREATE ... (a, b) rest`: line 0 is the text before the parenthesis, the last line the text
 * after it, the others are the parts between commas. Words are separated by one blank. A quoted name that needs no
 * quotes (schema_text_is_plain) is written without them. */
struct schema_text {
  char *text;
  size_t count;
  const char *lines[SCHEMA_TEXT_LINES];
};

/* False: memory ran out, or there are too many lines. Clear it in any case. */
bool schema_text_read(const char *sql, struct schema_text *out);
void schema_text_clear(struct schema_text *text);

/* Letters, digits and underscores: a name that needs no quotes. */
bool schema_text_is_plain(const char *name, size_t length);
/* Does the line begin with this word? Returns the text after the word and its blank, or NULL. */
const char *schema_text_after(const char *line, const char *word);

#endif
