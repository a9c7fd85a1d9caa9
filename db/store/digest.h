/* Digests: 16 bytes that change when any bit of a run's results or of a point's inputs changes. `check`, `merge` and
 * `replay` compare them with the rows.
 *
 * A value is a chain of 64-bit words that begins with the name of its table and column. The digest is the sum over all
 * values, so it does not depend on the order of columns. With all other words fixed, the digest is a one-to-one
 * function of each word. A change within one word is always found; any other change is missed with probability 2^-128.
 * NULL adds nothing: a column that comes later leaves the digests of older rows as they are. Digests detect damage, not
 * forgery: a person who can change a row can change its digest. (BLAKE2s over the same words costs 9 % of the time to
 * add a run.) */
#ifndef CLAST_DB_STORE_DIGEST_H
#define CLAST_DB_STORE_DIGEST_H

#include "db/sql.h"

struct digest { /* all zero: the digest of no values */
  uint64_t a, b;
};

/* The start of the chain for values of this column. */
struct digest digest_name(const char *table, const char *column);
/* The chains of the names of a field table's columns. All zero: not made yet. */
struct digest_names {
  struct digest *of;
};
/* Makes the names, unless they exist. STATUS_MEMORY. */
status digest_names_make(struct digest_names *names, const char *table, const struct field_table *fields,
                         struct error *error);
void digest_names_clear(struct digest_names *names);

/* Adds to a digest what sql_bind_field() stores of *object. `row`: number that distinguishes several rows of one
 * run. */
void digest_add_fields(struct digest *sum, const struct digest_names *names, const struct field_table *fields,
                       uint64_t row, const void *object);
/* One field. `name`: the digest of its column's name. off is the text 'off' or NULL, as in sql_bind_field(). */
void digest_add_field(struct digest *sum, struct digest name, uint64_t row, const struct field *field,
                      const void *object, bool off_as_text);
void digest_add_integer(struct digest *sum, struct digest name, int64_t value);
void digest_add_text(struct digest *sum, struct digest name, const char *text);
void digest_add_bytes(struct digest *sum, struct digest name, const void *bytes, size_t size);
/* Adds a column of a stored row. */
void digest_add_stored(struct digest *sum, struct digest name, uint64_t row, sqlite3_stmt *statement, int column);
/* The row number for a row whose key is a text. */
uint64_t digest_row(const char *text);
void digest_write(struct digest sum, uint8_t bytes[16]);

/* Digests of stored rows. */
enum digest_kind { DIGEST_RUNS, DIGEST_POINTS };
/* Gives the numbers (run_id, point_id) of rows whose digest does not match their contents. only: one number; 0: all. A
 * store of version 1 has no digests and gives no numbers. */
status digest_rows_compare(sqlite3 *db, enum digest_kind kind, int64_t only,
                           void (*each)(void *context, int64_t number), void *context, struct error *error);
/* Prints a line for each point, or each run that is not surplus, in the order of identities: "run", its identity, and
 * the digest of its contents as they are now. STATUS_IO: `out` failed. */
status digest_rows_print(sqlite3 *db, enum digest_kind kind, FILE *out, struct error *error);
/* Writes the digest of one row. Within the caller's transaction. */
status digest_rows_fill(sqlite3 *db, enum digest_kind kind, int64_t number, struct error *error);
/* The same for all rows from number `first` on that have none. */
status digest_rows_fill_missing(sqlite3 *db, enum digest_kind kind, int64_t first, struct error *error);

#endif
