/* Chains of words, and the digests of values before they are stored. */
#include "db/store/digest.h"

#include <endian.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum kind { INTEGER = 1, REAL, TEXT, BYTES };

/* Both lanes are one to one in the word and in the state: an odd factor has an inverse, and so has x ^= x >> k. The
 * factors are those of splitmix64. */
static struct digest step(struct digest state, uint64_t word) {
  state.a = (state.a ^ word) * 0xbf58476d1ce4e5b9u;
  state.a ^= state.a >> 31;
  state.b = (state.b + word) * 0x94d049bb133111ebu;
  state.b ^= state.b >> 29;
  return state;
}

/* Up to 8 bytes, little-endian; missing bytes are 0. */
static uint64_t word_at(const uint8_t *bytes, size_t size) {
  uint64_t word = 0;
  memcpy(&word, bytes, size);
  return le64toh(word);
}

static struct digest step_bytes(struct digest state, const void *bytes, size_t size) {
  const uint8_t *at = bytes;
  state = step(state, size);
  for (; size >= 8; size -= 8, at += 8)
    state = step(state, word_at(at, 8));
  return size ? step(state, word_at(at, size)) : state;
}

static void add(struct digest *sum, struct digest value) {
  sum->a += value.a;
  sum->b += value.b;
}

static struct digest begin(struct digest name, enum kind kind, uint64_t row) {
  return step(name, row << 8 | kind);
}

static void add_real(struct digest *sum, struct digest name, uint64_t row, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  add(sum, step(begin(name, REAL, row), bits));
}

static void add_text(struct digest *sum, struct digest name, uint64_t row, const char *text) {
  add(sum, step_bytes(begin(name, TEXT, row), text, strlen(text)));
}

struct digest digest_name(const char *table, const char *column) {
  const struct digest start = {0x9e3779b97f4a7c15u, 0x6a09e667f3bcc909u};
  return step_bytes(step_bytes(start, table, strlen(table)), column, strlen(column));
}

uint64_t digest_row(const char *text) {
  return digest_name("", text).a;
}

status digest_names_make(struct digest_names *names, const char *table, const struct field_table *fields,
                         struct error *error) {
  if (names->of)
    return STATUS_OK;
  names->of = calloc(fields->count + 1, sizeof *names->of);
  if (!names->of)
    return status_fail(error, STATUS_MEMORY, "memory ran out for digests");
  for (size_t i = 0; i < fields->count; i++) {
    char column[FIELD_TEXT_SIZE];
    field_column_name(fields->rows[i].path, column, sizeof column);
    names->of[i] = digest_name(table, column);
  }
  return STATUS_OK;
}

void digest_names_clear(struct digest_names *names) {
  free(names->of);
  names->of = NULL;
}

void digest_add_field(struct digest *sum, struct digest name, uint64_t row, const struct field *field,
                      const void *object, bool off_as_text) {
  const char *place = (const char *)object + field->offset;
  switch (field->kind) {
  case FIELD_REAL: {
    double value;
    memcpy(&value, place, sizeof value);
    if (!isnan(value))
      add_real(sum, name, row, value == 0 ? 0 : value); /* SQLite does not keep the sign of -0 */
    else if (off_as_text)
      add_text(sum, name, row, "off");
    break;
  }
  case FIELD_INTEGER: {
    uint64_t value;
    memcpy(&value, place, sizeof value);
    add(sum, step(begin(name, INTEGER, row), value));
    break;
  }
  case FIELD_BOOLEAN: add(sum, step(begin(name, INTEGER, row), *(const bool *)place)); break;
  case FIELD_CHOICE: {
    int value;
    memcpy(&value, place, sizeof value);
    add_text(sum, name, row, field->choices[value]);
    break;
  }
  case FIELD_TEXT: add_text(sum, name, row, place); break;
  }
}

void digest_add_fields(struct digest *sum, const struct digest_names *names, const struct field_table *fields,
                       uint64_t row, const void *object) {
  for (size_t i = 0; i < fields->count; i++)
    if (!fields->rows[i].when || field_is_active(fields, &fields->rows[i], object))
      digest_add_field(sum, names->of[i], row, &fields->rows[i], object, false);
}

void digest_add_integer(struct digest *sum, struct digest name, int64_t value) {
  add(sum, step(begin(name, INTEGER, 0), (uint64_t)value));
}

void digest_add_text(struct digest *sum, struct digest name, const char *text) {
  add_text(sum, name, 0, text);
}

void digest_add_bytes(struct digest *sum, struct digest name, const void *bytes, size_t size) {
  add(sum, step_bytes(begin(name, BYTES, 0), bytes, size));
}

void digest_add_stored(struct digest *sum, struct digest name, uint64_t row, sqlite3_stmt *statement, int column) {
  switch (sqlite3_column_type(statement, column)) {
  case SQLITE_INTEGER:
    add(sum, step(begin(name, INTEGER, row), (uint64_t)sqlite3_column_int64(statement, column)));
    break;
  case SQLITE_FLOAT: add_real(sum, name, row, sqlite3_column_double(statement, column)); break;
  case SQLITE_TEXT: {
    const void *text = sqlite3_column_text(statement, column);
    add(sum, step_bytes(begin(name, TEXT, row), text, (size_t)sqlite3_column_bytes(statement, column)));
    break;
  }
  case SQLITE_BLOB: {
    const void *bytes = sqlite3_column_blob(statement, column);
    add(sum, step_bytes(begin(name, BYTES, row), bytes, (size_t)sqlite3_column_bytes(statement, column)));
    break;
  }
  default: break;
  }
}

void digest_write(struct digest sum, uint8_t bytes[16]) {
  for (int i = 0; i < 8; i++) {
    bytes[i] = (uint8_t)(sum.a >> 8 * i);
    bytes[8 + i] = (uint8_t)(sum.b >> 8 * i);
  }
}
