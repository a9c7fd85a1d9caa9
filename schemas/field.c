/* Names, values, conditions and bytes of field tables, and the canonical text of an object. */
#include "schemas/field.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

enum { QUOTE = 60 };

bool field_is_off(double value) {
  return isnan(value);
}

bool field_is_share(const struct field *row) {
  return row->kind == FIELD_REAL && row->minimum >= 0 && row->minimum <= 0 && row->maximum >= 1 && row->maximum <= 1;
}

/* ---- names ---- */

void field_guess_path(const char *path, struct text_guess *guess) {
  text_guess_offer(guess, path);
  for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
    text_guess_offer_part(guess, dot + 1, path);
}

void field_guess(const struct field_table *table, struct text_guess *guess) {
  for (size_t i = 0; i < table->count; i++)
    field_guess_path(table->rows[i].path, guess);
}

bool field_nearest(const struct field_table *table, const char *path, char near[FIELD_NEAR_SIZE]) {
  struct text_guess guess = text_guess(path);
  const char *dot = strrchr(path, '.'), *word = dot ? dot + 1 : path;
  field_guess(table, &guess);
  *near = 0;
  const bool sure = dot && guess.nearest && text_ends_in_words(guess.nearest, word, ".");
  const struct field *row = sure ? NULL : field_ending(table, word, NULL);
  while (row) {
    const struct field *const next = field_ending(table, word, row);
    text_append(near, FIELD_NEAR_SIZE, "%s%s", !*near ? "" : next ? "', '" : "' or '", row->path);
    row = next;
  }
  if (!*near && guess.nearest)
    text_append(near, FIELD_NEAR_SIZE, "%s", guess.nearest);
  return *near;
}

bool field_is_number(const struct field *row) {
  return row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
}

double field_number(const struct field_value *value) {
  return value->kind == FIELD_INTEGER ? (double)value->integer : value->number;
}

void field_column_name(const char *path, char *name, size_t size) {
  snprintf(name, size, "%s", path);
  for (char *at = name; (at = strchr(at, '.'));)
    *at = '_';
}

const struct field *field_of_column(const struct field_table *table, const char *column) {
  char name[FIELD_TEXT_SIZE];
  for (size_t i = 0; i < table->count; i++) {
    field_column_name(table->rows[i].path, name, sizeof name);
    if (strcmp(name, column) == 0)
      return &table->rows[i];
  }
  return NULL;
}

size_t field_first_word(const struct field_table *table, size_t i, const char *prefix, size_t length) {
  const char *path = table->rows[i].path;
  if (strncmp(path, prefix, length) != 0)
    return 0;
  const size_t word = strcspn(path + length, "."), whole = length + word;
  for (size_t j = 0; j < i; j++)
    if (strncmp(table->rows[j].path, path, whole) == 0 && strchr(".", table->rows[j].path[whole]))
      return 0;
  return word;
}

void field_members(const struct field_table *table, const char *section, const char *quote, char *text, size_t size) {
  char prefix[FIELD_TEXT_SIZE + 2] = "";
  text_append(prefix, sizeof prefix, "%.*s.", FIELD_TEXT_SIZE, section);
  const size_t length = strlen(prefix);
  *text = 0;
  for (size_t i = 0; i < table->count; i++) {
    const size_t word = field_first_word(table, i, prefix, length);
    if (word)
      text_append(text, size, "%s%s%.*s%s", *text ? ", " : "", quote, (int)word, table->rows[i].path + length, quote);
  }
}

/* Is one of a section's words near `word`? */
static bool is_near_in(const struct field_table *table, const char *section, const char *word) {
  char prefix[FIELD_TEXT_SIZE + 2] = "", part[FIELD_TEXT_SIZE];
  struct text_guess guess = text_guess(word);
  text_append(prefix, sizeof prefix, "%s.", section);
  const size_t length = strlen(prefix);
  for (size_t i = 0; i < table->count; i++) {
    const size_t known = field_first_word(table, i, prefix, length);
    snprintf(part, sizeof part, "%.*s", (int)known, table->rows[i].path + (known ? length : 0));
    if (known)
      text_guess_offer(&guess, part);
  }
  return guess.nearest;
}

static void fail_unknown(const struct field_table *table, const char *path, struct error *error) {
  if (table->lacking && strstr(path, table->lacking)) {
    status_fail(error, STATUS_CONTENT, "the %s has no '%.*s': %s", table->name, QUOTE, path, table->instead);
    return;
  }
  char members[512];
  field_members(table, path, "'", members, sizeof members);
  if (*members) {
    status_fail(error, STATUS_CONTENT, "'%.*s' is a section of the %s; name what is in it, behind a dot: %s", QUOTE,
                path, table->name, members);
    return;
  }
  char near[FIELD_NEAR_SIZE], section[FIELD_TEXT_SIZE] = "";
  const char *const dot = strrchr(path, '.');
  if (dot)
    snprintf(section, sizeof section, "%.*s", (int)(dot - path), path);
  field_members(table, section, "", members, sizeof members);
  const bool found = field_nearest(table, path, near), same_word = dot && text_ends_in_words(near, dot + 1, ".");
  if (*section && *members && !same_word && !is_near_in(table, section, dot + 1))
    status_fail(error, STATUS_CONTENT, "the %s has no '%.*s'; known in '%s' are %s", table->name, QUOTE, path, section,
                members);
  else if (found)
    status_fail(error, STATUS_CONTENT, "the %s has no '%.*s'; did you mean '%s'?", table->name, QUOTE, path, near);
  else
    status_fail(error, STATUS_CONTENT, "the %s has no '%.*s'; 'clast explain' lists what it has", table->name, QUOTE,
                path);
}

const struct field *field_find(const struct field_table *table, const char *path, struct error *error) {
  const struct field *found = NULL;
  size_t candidates = 0;
  for (size_t i = 0; i < table->count; i++) {
    if (strcmp(table->rows[i].path, path) == 0)
      return &table->rows[i];
    if (!text_ends_in_words(table->rows[i].path, path, "."))
      continue;
    found = &table->rows[i];
    candidates++;
  }
  if (candidates == 1)
    return found;
  char name[FIELD_TEXT_SIZE + 8]; /* target.material is target.material.name */
  snprintf(name, sizeof name, "%.*s.name", FIELD_TEXT_SIZE, path);
  if (candidates == 0 && (found = field_ending(table, name, NULL)) && found->kind == FIELD_TEXT && found->choices)
    return field_find(table, name, error);
  for (size_t i = 0; candidates == 0 && i < table->count; i++) { /* as the name of a column */
    char column[FIELD_TEXT_SIZE];
    field_column_name(table->rows[i].path, column, sizeof column);
    if (strcmp(column, path) == 0)
      return &table->rows[i];
  }
  if (candidates == 0) {
    fail_unknown(table, path, error);
    return NULL;
  }
  char names[600] = "";
  for (const struct field *row = NULL; (row = field_ending(table, path, row));)
    text_append(names, sizeof names, "%s'%s'", *names ? ", " : "", row->path);
  status_fail(error, STATUS_CONTENT, "'%.*s' is ambiguous in the %s: it may be %s", QUOTE, path, table->name, names);
  return NULL;
}

const struct field *field_ending(const struct field_table *table, const char *suffix, const struct field *after) {
  for (size_t i = after ? (size_t)(after - table->rows) + 1 : 0; i < table->count; i++)
    if (text_ends_in_words(table->rows[i].path, suffix, "."))
      return &table->rows[i];
  return NULL;
}

const struct field *field_find_in(const struct field_table *table, const char *path, const void *object,
                                  struct error *error) {
  const struct field *found = field_find(table, path, error);
  if (found)
    return found;
  size_t candidates = 0;
  for (const struct field *row = NULL; (row = field_ending(table, path, row));) {
    struct field_value value;
    field_get(row, object, &value);
    if (!field_is_active(table, row, object) || (row->kind == FIELD_REAL && field_is_off(value.number)))
      continue;
    found = row;
    candidates++;
  }
  return candidates == 1 ? found : NULL;
}

/* ---- values ---- */
static const void *seat(const struct field *row, const void *object) {
  return (const char *)object + row->offset;
}

size_t field_choice_count(const struct field *row) {
  size_t count = 0;
  while (row->choices[count])
    count++;
  return count;
}

bool field_is_choice(const struct field *row, const char *text) {
  return text_is_one_of(text, row->choices);
}

void field_copy_text(char to[FIELD_TEXT_SIZE], const char *from) {
  memset(to, 0, FIELD_TEXT_SIZE); /* fill all bytes: some callers compare or hash whole structs */
  if (from)
    memcpy(to, from, strnlen(from, FIELD_TEXT_SIZE - 1));
}

void field_get(const struct field *row, const void *object, struct field_value *value) {
  const void *from = seat(row, object);
  bool truth;
  int index;
  memset(value, 0, sizeof *value);
  value->kind = row->kind;
  switch (row->kind) {
  case FIELD_REAL: memcpy(&value->number, from, sizeof value->number); break;
  case FIELD_INTEGER: memcpy(&value->integer, from, sizeof value->integer); break;
  case FIELD_BOOLEAN:
    memcpy(&truth, from, sizeof truth);
    value->number = truth;
    break;
  case FIELD_CHOICE:
    memcpy(&index, from, sizeof index);
    value->number = index;
    if (index >= 0 && (size_t)index < field_choice_count(row))
      field_copy_text(value->text, row->choices[index]);
    break;
  case FIELD_TEXT: field_copy_text(value->text, from); break;
  }
}

bool field_same_value(const struct field *row, const struct field_value *a, const struct field_value *b) {
  if (row->kind == FIELD_TEXT || row->kind == FIELD_CHOICE)
    return strcmp(a->text, b->text) == 0;
  if (row->kind == FIELD_INTEGER)
    return a->integer == b->integer;
  return a->number == b->number || (isnan(a->number) && isnan(b->number));
}

void field_default(const struct field *row, struct field_value *value) {
  *value = (struct field_value){.kind = row->kind};
  if (row->flags & FIELD_REQUIRED) {
    value->number = row->kind == FIELD_REAL ? (double)NAN : 0;
    return;
  }
  value->number = row->number;
  if (row->kind == FIELD_INTEGER)
    value->integer = (int64_t)row->number;
  if (row->kind == FIELD_TEXT)
    field_copy_text(value->text, row->text);
  if (row->kind == FIELD_CHOICE)
    field_copy_text(value->text, row->choices[(size_t)row->number]);
}

void field_defaults(const struct field_table *table, void *object) {
  for (size_t i = 0; i < table->count; i++) {
    struct field_value value;
    field_default(&table->rows[i], &value);
    field_set_unchecked(&table->rows[i], object, &value);
  }
}

const struct field *field_controller(const struct field_table *table, const struct field *row) {
  const size_t length = row->when ? strcspn(row->when, "=") : 0;
  for (size_t i = 0; length && i < table->count; i++)
    if (strncmp(table->rows[i].path, row->when, length) == 0 && !table->rows[i].path[length])
      return &table->rows[i];
  return NULL;
}

static bool value_is(const struct field *row, const void *object, const char *text, size_t length) {
  struct field_value value;
  field_get(row, object, &value);
  char shown[FIELD_TEXT_SIZE];
  if (row->kind == FIELD_BOOLEAN)
    snprintf(shown, sizeof shown, "%s", value.number != 0 ? "true" : "false");
  else if (row->kind == FIELD_INTEGER)
    snprintf(shown, sizeof shown, "%" PRId64, value.integer);
  else if (row->kind == FIELD_REAL)
    field_print_number(value.number, shown);
  else
    memcpy(shown, value.text, sizeof shown);
  return strlen(shown) == length && memcmp(shown, text, length) == 0;
}

/* Does the row have one of the values after `=`, which are separated by `|`? */
static bool is_one_of(const struct field *row, const void *object, const char *values) {
  for (const char *at = values;; at++) {
    const size_t length = strcspn(at, "|");
    if (value_is(row, object, at, length))
      return true;
    at += length;
    if (!*at)
      return false;
  }
}

const struct field *field_unmet(const struct field_table *table, const struct field *row, const void *object,
                                const struct field **other) {
  for (size_t links = 0; row->when; links++) { /* a circular chain would have more links than the table has rows */
    const char *equals = strchr(row->when, '=');
    *other = equals ? field_controller(table, row) : NULL;
    if (!*other || links > table->count || !is_one_of(*other, object, equals + 1))
      return row;
    row = *other;
  }
  return NULL;
}

bool field_is_active(const struct field_table *table, const struct field *row, const void *object) {
  const struct field *other;
  return field_unmet(table, row, object, &other) == NULL;
}

const char *field_shown_unit(const struct field *row) {
  if (row->flags & FIELD_PERCENT)
    return "%";
  return row->unit && strcmp(row->unit, "1") != 0 ? row->unit : "";
}

bool field_needs_unit(const struct field *row) {
  const bool number = row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
  return number && *field_shown_unit(row);
}

/* ---- bytes ---- */

static uint64_t mix(uint64_t hash, const char *text) {
  static const uint8_t end = 0xff; /* never a byte of our names, so "ab","c" and "a","bc" differ */
  return text_hash(text_hash(hash, text, strlen(text)), &end, 1);
}

/* A hash of names, kinds and choices, which define the encoding. Ranges and texts may change freely. */
static uint64_t table_hash(const struct field_table *table) {
  static const char *const kinds[] = {"real", "integer", "boolean", "choice", "text"};
  uint64_t hash = TEXT_HASH_START;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    hash = mix(mix(hash, row->path), kinds[row->kind]);
    for (size_t c = 0; row->kind == FIELD_CHOICE && row->choices[c]; c++)
      hash = mix(hash, row->choices[c]);
  }
  return hash;
}

static size_t put(uint8_t *bytes, uint64_t value, size_t count) {
  for (size_t i = 0; bytes && i < count; i++)
    bytes[i] = (uint8_t)(value >> (8 * i));
  return count;
}

static uint64_t take(const uint8_t *bytes, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; i++)
    value |= (uint64_t)bytes[i] << (8 * i);
  return value;
}

/* Bytes of a number, boolean or choice; for a text its length. */
static size_t width_of(const struct field *row) {
  switch (row->kind) {
  case FIELD_REAL:
  case FIELD_INTEGER: return 8;
  case FIELD_CHOICE: return 2;
  case FIELD_BOOLEAN:
  case FIELD_TEXT: break;
  }
  return 1;
}

/* The bits of a number, boolean or choice. */
static uint64_t bits_of(const struct field *row, const void *from) {
  uint64_t bits = 0;
  bool truth;
  int index;
  switch (row->kind) {
  case FIELD_REAL:
  case FIELD_INTEGER: memcpy(&bits, from, 8); return bits;
  case FIELD_BOOLEAN: memcpy(&truth, from, sizeof truth); return truth;
  case FIELD_CHOICE: memcpy(&index, from, sizeof index); return (uint16_t)index;
  case FIELD_TEXT: return strnlen(from, FIELD_TEXT_SIZE - 1);
  }
  return 0;
}

size_t field_encode(const struct field_table *table, const void *object, uint8_t *bytes) {
  size_t size = put(bytes, table_hash(table), 8);
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    const void *from = seat(row, object);
    const uint64_t bits = bits_of(row, from);
    size += put(bytes ? bytes + size : NULL, bits, width_of(row));
    if (row->kind != FIELD_TEXT)
      continue;
    if (bytes)
      memcpy(bytes + size, from, bits);
    size += bits;
  }
  return size;
}

size_t field_encoded_size(const struct field_table *table, const void *object) {
  return field_encode(table, object, NULL);
}

/* Stores the bits of a number, boolean or choice. False: no such value. */
static bool store_bits(const struct field *row, uint64_t bits, void *to) {
  const bool truth = bits == 1;
  const int index = (int)bits;
  if (row->kind == FIELD_BOOLEAN && bits > 1)
    return false;
  if (row->kind == FIELD_CHOICE && bits >= field_choice_count(row))
    return false;
  switch (row->kind) {
  case FIELD_REAL:
  case FIELD_INTEGER: memcpy(to, &bits, 8); break;
  case FIELD_BOOLEAN: memcpy(to, &truth, sizeof truth); break;
  case FIELD_CHOICE: memcpy(to, &index, sizeof index); break;
  case FIELD_TEXT: break;
  }
  return true;
}

size_t field_decode(const struct field_table *table, const uint8_t *bytes, size_t size, void *object) {
  size_t used = 8;
  if (size < used || take(bytes, 8) != table_hash(table))
    return 0;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    char *to = (char *)object + row->offset;
    const size_t width = width_of(row);
    if (size - used < width)
      return 0;
    const uint64_t bits = take(bytes + used, width);
    used += width;
    if (row->kind != FIELD_TEXT) {
      if (!store_bits(row, bits, to))
        return 0;
      continue;
    }
    if (size - used < bits)
      return 0;
    memset(to, 0, FIELD_TEXT_SIZE);
    memcpy(to, bytes + used, bits);
    used += bits;
  }
  return used;
}

/* ---- the canonical text of an object, from which a run's identity is made ---- */

static int by_path(const void *a, const void *b) {
  const struct field *const *left = a, *const *right = b;
  return strcmp((*left)->path, (*right)->path);
}

/* Writes text with line breaks and backslashes escaped, so that no value can look like another line. */
static void write_text(const char *text, FILE *out) {
  for (; *text; text++) {
    if (*text == '\n')
      fputs("\\n", out);
    else if (*text == '\\')
      fputs("\\\\", out);
    else
      fputc(*text, out);
  }
}

static void write_value(const struct field *row, const struct field_value *value, FILE *out) {
  switch (row->kind) {
  case FIELD_REAL:
    if (isnan(value->number))
      fputs("off", out);
    else
      fprintf(out, "%a", value->number + 0.0);
    break;
  case FIELD_INTEGER: fprintf(out, "%" PRId64, value->integer); break;
  case FIELD_BOOLEAN: fputs(value->number != 0 ? "true" : "false", out); break;
  case FIELD_CHOICE:
  case FIELD_TEXT:
    write_text(row->choices && !field_is_choice(row, value->text) ? row->choices[field_choice_count(row) - 1]
                                                                  : value->text,
               out);
    break;
  }
}

/* Has a row that came later the value of the runs before it? */
static bool is_absent(const struct field *row, const void *object) {
  struct field_value value, absent;
  if (!row->absent || field_parse_si(row, row->absent, &absent, NULL))
    return false;
  field_get(row, object, &value);
  return field_same_value(row, &value, &absent);
}

char *field_identity(const struct field_table *table, const void *object) {
  char *text = NULL;
  size_t count = 0;
  OWNED const struct field **rows = memory_small(table->count + 1, sizeof *rows);
  FILE *out = text_open(&text);
  for (size_t i = 0; i < table->count; i++)
    if (field_is_active(table, &table->rows[i], object) && !is_absent(&table->rows[i], object))
      rows[count++] = &table->rows[i];
  qsort(rows, count, sizeof *rows, by_path);

  for (size_t i = 0; i < count; i++) {
    struct field_value value;
    field_get(rows[i], object, &value);
    fprintf(out, "%s=", rows[i]->path);
    write_value(rows[i], &value, out);
    fputc('\n', out);
  }
  return text_close_small(out, &text);
}
