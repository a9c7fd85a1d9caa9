/* Common parts of tests of the store: bytes of a file, one number of a query. */
#pragma once

#include "db/store/internal.h"
#include "tests/support/check.h"
#include "tests/support/store_fixture.h"

/* The store's bits as text, malloc'd. */
__attribute__((unused)) static char *dump(const char *path) {
  struct store *store = NULL;
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  OK(store_open_reader(path, &store, &error));
  OK(store_export_digests(store, out, &error));
  fclose(out);
  OK(store_close(store, &error));
  return text;
}

/* Gives a run the digest of its rows as they are now. */
__attribute__((unused)) static void fill_digest(sqlite3 *db, int64_t run_id) {
  STATEMENT update = NULL;
  DIGEST_ROWS rows = digest_rows(db, DIGEST_RUNS, run_id, false, &error);
  OK(sql_prepare(db, "UPDATE main.run SET digest = ?2 WHERE run_id = ?1", &update, "test", &error));
  assert_true(digest_rows_next(&rows));
  SQL_BIND(update, sql_of_integer(run_id), sql_of_bytes(rows.digest, sizeof rows.digest));
  OK(sql_run(update, "test", &error));
}

/* The bytes of a store that no program has open. They are malloc'd. */
struct store_file {
  uint8_t *bytes;
  size_t size;
};

static inline struct store_file store_file_read(const char *path) {
  FILE *in = fopen(path, "rb");
  assert_non_null(in);
  fseek(in, 0, SEEK_END);
  struct store_file file = {.size = (size_t)ftell(in)};
  file.bytes = malloc(file.size);
  rewind(in);
  assert_int_equal(fread(file.bytes, 1, file.size, in), file.size);
  fclose(in);
  return file;
}

static inline void store_file_write(const char *path, const struct store_file *file) {
  FILE *out = fopen(path, "wb");
  assert_non_null(out);
  assert_int_equal(fwrite(file->bytes, 1, file->size, out), file->size);
  assert_int_equal(fclose(out), 0);
}

static inline double number(struct store *store, const char *sql) {
  double value = 0;
  OK(answer_number(store, &value, &error, "%s", sql));
  return value;
}
