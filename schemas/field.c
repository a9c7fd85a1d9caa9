/* Names, values, conditions and bytes of field tables. */
#include "schemas/field.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { QUOTE = 60 };

bool field_is_off(double value) {
  return isnan(value);
}

/* ---- names ---- */

/* True when `suffix` is the last word of `path`, or its last words. */
static bool ends_with(const char *path, const char *suffix) {
  size_t path_length = strlen(path), length = strlen(suffix);
  if (length == 0 || length > path_length || strcmp(path + path_length - length, suffix) != 0)
    return false;
  return length == path_length || path[path_length - length - 1] == '.';
}

void field_guess(const struct field_table *table, struct text_guess *guess) {
  for (size_t i = 0; i < table->count; i++) {
    const char *path = table->rows[i].path;
    text_guess_offer(guess, path);
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
      text_guess_offer_part(guess, dot + 1, path);
  }
}

const char *field_nearest(const struct field_table *table, const char *path) {
  struct text_guess guess = text_guess(path);
  field_guess(table, &guess);
  return guess.nearest;
}

void field_column_name(const char *path, char *name, size_t size) {
  snprintf(name, size, "%s", path);
  for (char *at = name; (at = strchr(at, '.'));)
    *at = '_';
}

/* The paths that end in a suffix, as "'a.x', 'b.x'". */
static void list_paths(const struct field_table *table, const char *suffix, char *names, size_t size) {
  size_t used = 0;
  *names = 0;
  for (size_t i = 0; i < table->count && used < size; i++) {
    if (!ends_with(table->rows[i].path, suffix))
      continue;
    int n = snprintf(names + used, size - used, "%s'%s'", used ? ", " : "", table->rows[i].path);
    used += n > 0 ? (size_t)n : 0;
  }
}

static void fail_unknown(const struct field_table *table, const char *path, struct error *error) {
  const size_t length = strlen(path);
  for (size_t i = 0; i < table->count; i++) {
    const char *known = table->rows[i].path;
    if (strncmp(known, path, length) != 0 || known[length] != '.')
      continue;
    status_fail(error, STATUS_CONTENT, "'%.*s' is a section of the %s; name what is in it, such as '%s'", QUOTE, path,
                table->name, known);
    return;
  }
  const char *near = field_nearest(table, path);
  if (near)
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
    if (!ends_with(table->rows[i].path, path))
      continue;
    found = &table->rows[i];
    candidates++;
  }
  if (candidates == 1)
    return found;
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
  char names[600];
  list_paths(table, path, names, sizeof names);
  status_fail(error, STATUS_CONTENT, "'%.*s' is ambiguous in the %s: it may be %s", QUOTE, path, table->name, names);
  return NULL;
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

void field_copy_text(char to[FIELD_TEXT_SIZE], const char *from) {
  memset(to, 0, FIELD_TEXT_SIZE); /* all of it: some callers compare or hash whole structs */
  if (from)
    memcpy(to, from, strnlen(from, FIELD_TEXT_SIZE - 1));
}

void field_get(const struct field *row, const void *object, struct field_value *value) {
  const void *from = seat(row, object);
  memset(value, 0, sizeof *value);
  value->kind = row->kind;
  switch (row->kind) {
  case FIELD_REAL: memcpy(&value->number, from, sizeof value->number); break;
  case FIELD_INTEGER: memcpy(&value->integer, from, sizeof value->integer); break;
  case FIELD_BOOLEAN: {
    bool truth;
    memcpy(&truth, from, sizeof truth);
    value->number = truth;
    break;
  }
  case FIELD_CHOICE: {
    int index;
    memcpy(&index, from, sizeof index);
    value->number = index;
    if (index >= 0 && (size_t)index < field_choice_count(row))
      field_copy_text(value->text, row->choices[index]);
    break;
  }
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
  char shown[FIELD_TEXT_SIZE] = "";
  if (row->kind == FIELD_BOOLEAN)
    strcpy(shown, value.number != 0 ? "true" : "false");
  else if (row->kind == FIELD_INTEGER)
    snprintf(shown, sizeof shown, "%" PRId64, value.integer);
  else if (row->kind == FIELD_REAL)
    field_print_number(value.number, shown);
  else
    memcpy(shown, value.text, sizeof shown);
  return strlen(shown) == length && memcmp(shown, text, length) == 0;
}

/* The first row, from this one up through the rows that control it, whose condition is not met; NULL when the row is
 * active. A circular chain ends after as many links as the table has rows: inactive. */
static const struct field *unmet(const struct field_table *table, const struct field *row, const void *object,
                                 const struct field **other) {
  for (size_t links = 0; row->when; links++) {
    const char *equals = strchr(row->when, '=');
    *other = equals ? field_controller(table, row) : NULL;
    if (!*other || links > table->count)
      return row;
    bool met = false;
    for (const char *at = equals + 1; !met;) {
      size_t length = strcspn(at, "|");
      met = value_is(*other, object, at, length);
      if (!at[length])
        break;
      at += length + 1;
    }
    if (!met)
      return row;
    row = *other;
  }
  return NULL;
}

bool field_is_active(const struct field_table *table, const struct field *row, const void *object) {
  const struct field *other;
  return unmet(table, row, object, &other) == NULL;
}

void field_describe_inactive(const struct field_table *table, const struct field *row, const void *object, char *text,
                             size_t size) {
  const struct field *other, *link = unmet(table, row, object, &other);
  *text = 0;
  if (!link || !other)
    return;
  char *wanted = NULL, came[FIELD_TEXT_SIZE];
  size_t length = 0;
  FILE *words = open_memstream(&wanted, &length);
  if (!words)
    return;
  field_describe_condition(link, words);
  fclose(words);

  struct field_value value;
  field_get(other, object, &value);
  field_print(other, &value, came, sizeof came);
  snprintf(text, size, "used only when %s is %s; here it is %s", other->path, wanted ? wanted : "", came);
  free(wanted);
}

void field_describe_condition(const struct field *row, FILE *out) {
  const char *equals = strchr(row->when, '=');
  for (const char *at = equals ? equals + 1 : ""; *at; at++) {
    if (*at == '|')
      fputs(" or ", out);
    else
      fputc(*at, out);
  }
}

void field_describe_choices(const struct field *row, char *text, size_t size) {
  size_t used = 0;
  *text = 0;
  for (size_t i = 0; row->choices[i] && used < size; i++) {
    const char *between = row->choices[i + 1] ? ", " : " or ";
    int n = snprintf(text + used, size - used, "%s%s", i ? between : "", row->choices[i]);
    used += n > 0 ? (size_t)n : 0;
  }
}

bool field_needs_unit(const struct field *row) {
  const bool number = row->kind == FIELD_REAL || row->kind == FIELD_INTEGER;
  return number && (row->flags & FIELD_PERCENT || (row->unit && strcmp(row->unit, "1") != 0));
}

/* A bound as a user would write it: "0", "1e-7" of a row in percent. */
static void print_bound(const struct field *row, double bound, char text[64]) {
  struct field bare = *row;
  bare.kind = FIELD_REAL;
  bare.unit = "1";
  const struct field_value value = {.kind = FIELD_REAL, .number = bound};
  field_print(&bare, &value, text, 64);
  text[strcspn(text, " ")] = 0;
}

void field_describe_range(const struct field *row, char *text, size_t size) {
  char low[64], high[64];
  const char *unit = row->flags & FIELD_PERCENT ? "%" : row->unit && strcmp(row->unit, "1") ? row->unit : "";
  const char *space = *unit ? " " : "";
  print_bound(row, row->minimum, low);
  print_bound(row, row->maximum, high);
  bool has_low = row->minimum > -HUGE_VAL, has_high = row->maximum < HUGE_VAL;
  const char *from = row->flags & FIELD_ABOVE_MINIMUM ? "above" : "at least";
  const char *to = row->flags & FIELD_BELOW_MAXIMUM ? "below" : "at most";
  if (has_low && has_high)
    snprintf(text, size, "%s %s and %s %s%s%s", from, low, to, high, space, unit);
  else if (has_low)
    snprintf(text, size, "%s %s%s%s", from, low, space, unit);
  else if (has_high)
    snprintf(text, size, "%s %s%s%s", to, high, space, unit);
  else
    snprintf(text, size, "a number%s%s", *unit ? " in " : "", unit);
}

/* ---- bytes ---- */

static uint64_t mix(uint64_t hash, const char *text) {
  static const uint8_t end = 0xff; /* never a byte of our names, so "ab","c" differs from "a","bc" */
  return text_hash(text_hash(hash, text, strlen(text)), &end, 1);
}

/* A hash of names, kinds and choices, which decide how bytes are read. Ranges and texts may change freely. */
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

size_t field_encode(const struct field_table *table, const void *object, uint8_t *bytes) {
  size_t size = put(bytes, table_hash(table), 8);
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    const char *from = (const char *)object + row->offset;
    uint8_t *to = bytes ? bytes + size : NULL;
    uint64_t bits = 0;
    switch (row->kind) {
    case FIELD_REAL:
    case FIELD_INTEGER:
      memcpy(&bits, from, 8);
      size += put(to, bits, 8);
      break;
    case FIELD_BOOLEAN: {
      bool truth;
      memcpy(&truth, from, sizeof truth);
      size += put(to, truth, 1);
      break;
    }
    case FIELD_CHOICE: {
      int index;
      memcpy(&index, from, sizeof index);
      size += put(to, (uint64_t)(uint16_t)index, 2);
      break;
    }
    case FIELD_TEXT: {
      size_t length = strnlen(from, FIELD_TEXT_SIZE - 1);
      size += put(to, length, 1);
      if (to)
        memcpy(to + 1, from, length);
      size += length;
      break;
    }
    }
  }
  return size;
}

size_t field_encoded_size(const struct field_table *table, const void *object) {
  return field_encode(table, object, NULL);
}

size_t field_decode(const struct field_table *table, const uint8_t *bytes, size_t size, void *object) {
  size_t used = 8;
  if (size < used || take(bytes, 8) != table_hash(table))
    return 0;
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    char *to = (char *)object + row->offset;
    static const size_t widths[] = {8, 8, 1, 2, 1};
    size_t width = widths[row->kind];
    if (size - used < width)
      return 0;
    uint64_t bits = take(bytes + used, width);
    used += width;
    switch (row->kind) {
    case FIELD_REAL:
    case FIELD_INTEGER: memcpy(to, &bits, 8); break;
    case FIELD_BOOLEAN: {
      bool truth = bits == 1;
      if (bits > 1)
        return 0;
      memcpy(to, &truth, sizeof truth);
      break;
    }
    case FIELD_CHOICE: {
      int index = (int)bits;
      if (bits >= field_choice_count(row))
        return 0;
      memcpy(to, &index, sizeof index);
      break;
    }
    case FIELD_TEXT:
      if (size - used < bits)
        return 0;
      memset(to, 0, FIELD_TEXT_SIZE);
      memcpy(to, bytes + used, bits);
      used += bits;
      break;
    }
  }
  return used;
}
