/* What the files of db/store and db/ask share: digests, identities and running sums, the checks of foreign files, and
 * the state of an open store. For db/ only. */
#pragma once

#include "db/sql.h"
#include "db/store/store.h"

/* ---- digests ---- */

/* Digests: 16 bytes that change when any bit of a run's results or of a point's inputs changes. `check`, `merge` and
 * `replay` compare them with the rows.
 *
 * A value is a chain of 64-bit words that begins with the name of its table and column. The digest is the sum over all
 * values, so it does not depend on the order of columns. With all other words fixed, the digest is a one-to-one
 * function of each word. A change within one word is always found; any other change is missed with probability 2^-128.
 * NULL adds nothing: a column that comes later leaves the digests of older rows as they are. Digests detect damage, not
 * forgery: a person who can change a row can change its digest. (BLAKE2s over the same words costs 9 % of the time to
 * add a run.) */
struct digest { /* all zero: the digest of no values */
  uint64_t a, b;
};

/* The start of the chain for values of this column. */
struct digest digest_name(const char *table, const char *column);
/* *names: the chains of the names of a field table's columns, which the caller frees. Made unless they exist. */
void digest_names_make(struct digest **names, const char *table, const struct field_table *fields);

/* Adds a value to a digest; NULL adds nothing. `name`: the digest of its column's name. `row`: number that
 * distinguishes several rows of one run. */
void digest_add(struct digest *sum, struct digest name, uint64_t row, struct sql_value value);
/* Adds what sql_bind_fields() stores of *object. */
void digest_add_fields(struct digest *sum, const struct digest *names, const struct field_table *fields, uint64_t row,
                       const void *object);
/* The row number for a row whose key is a text. */
uint64_t digest_row(const char *text, size_t size);
void digest_write(struct digest sum, uint8_t bytes[16]);

/* Digests of tables. Table table_digest has the number and the digest of the rows of each table that is marked in the
 * schema: a row that is changed, removed or added by another program shows. Temporary triggers of the writer's
 * connection tell of each row; the sums wait in memory, and are stored in the transaction of the change. */
enum { DIGEST_TABLES = 64 };
struct digest_tables {
  struct digest_of_table {
    int64_t rows;
    struct digest sum;
  } now[DIGEST_TABLES], stored[DIGEST_TABLES]; /* in the order of schema_tables */
};
/* Makes the SQL function that computes them known to the connection. The file itself cannot call it. */
void digest_function(sqlite3 *db);
/* *sql: SELECT table_name, row_count, digest of a table as it is now. The caller frees it with sqlite3_free(). */
status digest_of_rows(sqlite3 *db, const char *table, char **sql, struct error *error);
/* Fills table_digest from all rows. Within the caller's transaction. */
status digest_tables_fill(sqlite3 *db, struct error *error);
/* From now on *tables follows every change that this connection makes; it outlives the connection. */
status digest_tables_follow(sqlite3 *db, struct digest_tables *tables, struct error *error);
/* Call before a transaction is committed, and digest_tables_end() after it was, or was rolled back. */
status digest_tables_write(sqlite3 *db, const struct digest_tables *tables, struct error *error);
void digest_tables_end(struct digest_tables *tables, bool committed);

/* Runs or points as they are stored, with the digest of what they contain now. A variable of type DIGEST_ROWS closes
 * itself where its block is left. */
enum digest_kind { DIGEST_RUNS, DIGEST_POINTS };
struct digest_rows {
  sqlite3 *db;
  struct error *error;
  status code;
  const char *table, *key;
  int64_t number;     /* run_id or point_id of the current row */
  uint8_t digest[16]; /* of its contents */
  bool whole;         /* the stored digest is the same */
  sqlite3_stmt *numbers;
  struct digest_table {
    sqlite3_stmt *rows; /* parameter ?1: the number; first the column that distinguishes the rows, then the others */
    struct digest *names;
  } tables[DIGEST_TABLES];
  size_t count;
};
#define DIGEST_ROWS __attribute__((cleanup(digest_rows_end))) struct digest_rows
/* only: the number of one row; 0: all. to_print: in the order of identities, without runs that are surplus. */
struct digest_rows digest_rows(sqlite3 *db, enum digest_kind kind, int64_t only, bool to_print, struct error *error);
/* False at the end and after an error. */
bool digest_rows_next(struct digest_rows *rows);
status digest_rows_end(struct digest_rows *rows);

/* Prints a line for each point, or each run that is not surplus, in the order of identities: "run", its identity, and
 * the digest of its contents as they are now. STATUS_IO: `out` failed. */
status digest_rows_print(sqlite3 *db, enum digest_kind kind, FILE *out, struct error *error);
/* Writes the path and digest (a text, or NULL) of a run's fields file. The digest of the run changes by this value
 * alone, so that damage elsewhere still shows. Within the caller's transaction. */
status digest_set_fields(sqlite3 *db, int64_t run_id, const char *path, struct sql_value digest, struct error *error);

/* ---- identities ---- */

/* The identities in a store, held in memory: a resumed campaign looks up every run, and adding a run looks it up
 * again. */
struct identities { /* all zero: empty */
  struct identities_entry *table;
};

/* The stored facts about an identity. */
struct identities_state {
  uint32_t attempts; /* failed attempts */
  bool stored;
};

/* The state of an identity, added when absent. NULL when memory ran out. Valid until identities_clear(). */
struct identities_state *identities_add(struct identities *set, const uint8_t identity[16]);
/* NULL when absent. */
struct identities_state *identities_find(const struct identities *set, const uint8_t identity[16]);
void identities_clear(struct identities *set);

/* ---- running sums ---- */

/* Running sums of points: tables point_total and point_spectrum. A point whose sums change loses its pooled estimates.
 * A batch gathers the sums in memory and writes each changed row once, in the transaction that adds the runs.
 * Rebuilding them from the rows gives the same. */
enum { SUMS_BINS_LIMIT = 4000 }; /* ten bins per decade: no float64 lies further out */

struct sums_key { /* no padding: the hash table compares its bytes */
  int64_t point_id;
  int results_version, bin; /* SPECTRUM_NO_BIN: the point's totals */
};

struct sums_row {
  struct sums_key key;
  int64_t runs, count, count_squared; /* totals: count = fragments */
  int64_t censored, failed, surplus;  /* totals only */
  double mass;
};

struct sums { /* all zero: empty */
  struct sums_entry *table;
  bool sorted;
  sqlite3_stmt *total, *bin; /* upserts, prepared at first use */
  sqlite3_stmt *stale;       /* deletes the pooled estimates of a point with new runs */
};

/* What the sums count of a run. */
struct sums_run {
  int64_t point_id;
  int results_version;
  bool counts, at_end_time;
  int surplus; /* as in table run */
};
/* Adds a run and its spectrum. False: memory ran out. */
bool sums_add(struct sums *sums, const struct sums_run *run, size_t count, const struct spectrum_bin_row *bins);
/* Writes everything gathered, in ascending order of its key, and sets it to zero. */
status sums_write(struct sums *sums, sqlite3 *db, struct error *error);
void sums_forget(struct sums *sums); /* what was gathered, after a rollback */
void sums_clear(struct sums *sums);  /* everything, statements too */

/* Rebuilds the sums of one point from the rows of run and spectrum. Within the caller's transaction. */
status sums_rebuild(sqlite3 *db, int64_t point_id, struct error *error);
/* Makes the temporary tables chosen_point_total and chosen_point_spectrum from the rows that `run` has, and an empty
 * chosen_point_estimate. */
status sums_choose(sqlite3 *db, struct error *error);
/* *count: rows whose running sums differ from the sums of their rows (doubles: by more than rounding). */
status sums_mismatches(sqlite3 *db, int64_t *count, struct error *error);

/* Adds to table bin the edges of the bins lowest..highest that it lacks, so that spectra can be read without the
 * program. Within the caller's transaction. STATUS_CONTENT: no mass lies in such bins. */
status sums_cover_bins(sqlite3 *db, int64_t lowest, int64_t highest, struct error *error);

/* ---- foreign files (db/store/guard.c says what a store may contain) ---- */

/* Call on every new connection, before the first read. It turns off the file's views and triggers. Expressions in the
 * file may call harmless functions only. No statement can change the schema's text, attach a file or load an
 * extension. */
void guard_connection(sqlite3 *db);

/* Attaches another store as `other`, for reading only. */
status guard_attach(sqlite3 *db, const char *source, const char *doing, struct error *error);
/* Writes a compact copy of a store whose schema guard_schema() has passed. */
status guard_vacuum_into(sqlite3 *db, const char *path, const char *doing, struct error *error);

/* Compares the schema with ours. STATUS_CONTENT: the message names every object that no version of clast creates. */
status guard_schema(sqlite3 *db, const char *path, struct error *error);

/* ---- fields files ---- */

/* Locations of fields files. Table run keeps their paths relative to the store's folder, so that both can move
 * together. This is the path of one as this process can open it; the caller frees it. Never NULL. */
char *paths_of_fields(const char *store_path, const char *fields_path);

/* Can this file be read? */
bool paths_readable(const char *store_path, const char *fields_path);

/* Has the file the digest of store_digest_fields() that was stored (NULL: none, and true)? Reads the whole file.
 * `path`: as this process can open it. */
bool paths_whole(const char *path, const char *digest);
/* The file that a symbolic link leads to, else the path itself. The caller frees it. Never NULL. */
char *paths_followed(const char *path);

/* The prefix that turns a path relative to the folder of the store `source` into one relative to the folder of
 * `target`: "" when the folders are the same, else "../" and names, with a slash at the end. The caller frees it. NULL:
 * a folder does not exist. */
char *paths_between(const char *target, const char *source);

/* ---- the open store ---- */

enum { STORE_BATCH_ROWS = 500 };
#define STORE_BATCH_SECONDS 1.0

struct store_kind { /* fills result_<engine> */
  const struct engine_kind *kind;
  bool first;      /* no run of this engine is stored yet: the views have no columns for its results */
  int64_t pointed; /* 0: no point of this engine is stored yet, so that column_doc has not its unit of masses */
  sqlite3_stmt *insert;
  struct digest *names; /* digest_names_make() */
};

/* SQL: have the points with runs several scenes? Then the scene is an axis, in the column `scene` of the views. */
#define STORE_HAS_SCENES "(SELECT count(DISTINCT scene_name) FROM point JOIN point_total USING (point_id)) > 1"

struct store {
  sqlite3 *db;
  bool writer, functions;
  char *path;      /* of the file itself, where a link led to it: its fields files lie beside it */
  int lock;        /* descriptor, -1 for readers */
  double deadline; /* s, monotonic: end of the time limit of a user's query (db/ask/answer.c) */
  bool lacks_wal;  /* in WAL mode without its -wal file when it was opened (db/store/store.c) */

  struct identities identities; /* a writer reads them when it opens, a reader at first use */
  bool identities_loaded;
  struct sums sums;
  struct digest_tables tables;
  int64_t lowest_bin, highest_bin; /* range covered by table bin; lowest > highest: none */

  char chosen[512];    /* what questions see: ask_choose(); "": all */
  int64_t left_out;    /* points: ask_choice_left_out() */
  int64_t excluded[2]; /* of the last merge: store_merge_excluded() */

  double waits_since, waited_at, wait_until; /* s, monotonic: for another program that holds the file */
  bool in_batch, broken;
  int batch_rows;
  double batch_started; /* s, monotonic */
  uint8_t batch_identities[STORE_BATCH_ROWS][16];
  size_t batch_identity_count;

  struct digest *outcome_names, *estimate_names; /* digest_names_make() */
  sqlite3_stmt *run, *attempt, *estimate;
  size_t estimate_rows; /* that `estimate` inserts */
  sqlite3_stmt *mass_row, *spectrum, *spectrum_together, *ejecta;
  sqlite3_stmt *point_find, *point, *point_input, *campaign_point, *axis_find;
  struct store_kind kinds[LIMITS_ENGINES];
  size_t kind_count;

  double *masses; /* scratch: of one run */
  size_t mass_capacity;
  struct spectrum_bin_row *bins; /* scratch: spectrum of these masses */
  size_t bin_capacity;
};

/* Call before the first row of a batch: begins the transaction. Refuses readers and stores after a failed write. */
status store_begin(struct store *store, struct error *error);
/* Call after `rows` more rows: commits when the batch is large or old enough. When `result` is not OK, the whole batch
 * is rolled back and the store refuses further writing. Returns `result`, or the status of the commit. */
status store_end(struct store *store, status result, int rows, struct error *error);

/* Is the run part of the statistics? schema_write_counts() writes the same condition in SQL. */
static inline bool store_run_counts(const struct store_run *run) {
  return !run->surplus && outcome_counts(run->outcome);
}

/* Inserts the estimates of a point into a table like point_estimate. */
status store_insert_estimates(sqlite3 *db, const char *table, int64_t point_id, int64_t results_version, size_t count,
                              const struct estimate *rows, struct error *error);

/* Fills store->masses with a column of fragment_mass. STATUS_MEMORY. */
status store_take_masses(struct store *store, sqlite3_stmt *row, int column, size_t *count, struct error *error);
/* Fills store->bins with the spectrum of the first n of store->masses: `count` bins. STATUS_MEMORY. */
status store_make_bins(struct store *store, size_t n, size_t *count, struct error *error);
/* Is the spectrum that is stored for a run the one in store->bins, bit by bit? `rows` selects bin, count and mass of
 * run ?1, ordered by bin. */
status store_compare_bins(const struct store *store, sqlite3_stmt *rows, int64_t run_id, size_t count, bool *same,
                          const char *doing, struct error *error);
/* Adds the rows of the spectrum in store->bins for a run, and its part of the point's running sums. Covers its bins in
 * table bin. Within the open transaction. STATUS_CONTENT: no mass lies in such bins. */
status store_add_spectrum(struct store *store, int64_t run_id, const struct sums_run *run, size_t count,
                          struct error *error);
/* STATUS_IO: the store was opened by a second name in another folder (a hard link). Its fields files lie beside the
 * other one: they would be called missing, and computed again. */
status store_check_folder(const struct store *store, struct error *error);
/* The hash that identifies a point. */
void store_point_hash(const struct scene *scene, uint8_t hash[16]);
/* Reads the identities of the store, and its range of bins. error may be NULL. */
status identities_load(struct store *store, struct error *error);
/* Inserts the estimates of a run that has none yet, within the open batch. */
status store_set_estimates_rows(struct store *store, int64_t run_id, size_t count, const struct estimate *rows,
                                struct error *error);
/* Makes the shape files of a run's scene known (engine/mesh/mesh.h), so that its scene can be read; run_id 0: all
 * files of the store. STATUS_CONTENT: a file is damaged. */
status store_point_shapes(struct store *store, int64_t run_id, struct error *error);
