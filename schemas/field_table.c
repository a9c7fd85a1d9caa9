/* Builds tables: each nest becomes the rows of its table. */
#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/field.h"
#include "schemas/memory.h"

/* A nest that the builder is in, and those around it. */
struct level {
  const struct level *outer; /* NULL: the top, which is no nest */
  const struct field *nest;
  const char *prefix; /* whole path of the nest */
  size_t offset;
  unsigned flags; /* of all nests */
};

/* The memory of a table. The builder goes over the source twice: first it counts, and all pointers are NULL. */
struct builder {
  struct field *rows;
  const char **choices;
  char *text;
  size_t row_count, choice_count, text_size, text_room; /* text_room: bytes at `text` */
};

static const char *put(struct builder *b, const char *format, ...) __attribute__((format(printf, 2, 3)));
static const char *put(struct builder *b, const char *format, ...) {
  char *to = b->text ? b->text + b->text_size : NULL;
  va_list arguments;
  va_start(arguments, format);
  const size_t room = b->text_room - b->text_size;
  const int length = vsnprintf(to, to ? room : 0, format, arguments);
  va_end(arguments);
  assert(!to || (size_t)length < room); /* counted before */
  b->text_size += (size_t)length + 1;
  return to;
}

static const char *put_text(struct builder *b, const char *text) {
  return text ? put(b, "%s", text) : NULL;
}

static const char *const *put_choices(struct builder *b, const char *const *choices) {
  if (!choices)
    return NULL;
  const char **to = b->choices ? b->choices + b->choice_count : NULL;
  for (size_t i = 0;; i++) {
    const char *word = put_text(b, choices[i]);
    if (to)
      to[i] = word;
    b->choice_count++;
    if (!choices[i])
      return to;
  }
}

/* A condition written in the table at `prefix`, from the root. NULL: it is about something around the whole table. */
static const char *put_condition(struct builder *b, const char *when, const char *prefix) {
  size_t length = strlen(prefix);
  if (*when == '/')
    return put(b, "%s", when + 1);
  for (; strncmp(when, "../", 3) == 0; when += 3) {
    if (length == 0)
      return NULL;
    while (length > 0 && prefix[length - 1] != '.')
      length--;
    length -= length > 0;
  }
  return put(b, "%.*s%s%s", (int)length, prefix, length ? "." : "", when);
}

/* The part of a path after a prefix; NULL when the path is not under it. */
static const char *path_under(const char *path, const char *prefix) {
  const size_t length = strlen(prefix);
  if (length == 0)
    return path;
  return strncmp(path, prefix, length) == 0 && path[length] == '.' ? path + length + 1 : NULL;
}

/* What the nests around a row say of it: the row with its path in `own`, and the nearest condition and text. */
struct words {
  const struct field *own;
  const char *own_prefix, *when, *when_prefix, *doc;
};

static struct words words_for(const struct field *row, const char *path, const struct level *level) {
  struct words words = {0};
  for (; level->outer; level = level->outer) {
    const struct field *nest = level->nest;
    for (const struct field *own = nest->own; own && own->path && !words.own; own++)
      if (strcmp(own->path, path_under(path, level->prefix)) == 0) {
        words.own = own;
        words.own_prefix = level->outer->prefix;
      }
    if (nest->when && !words.when) {
      words.when = nest->when;
      words.when_prefix = level->outer->prefix;
    }
    if (!words.doc)
      words.doc = row->kind == FIELD_CHOICE && nest->choice_docs ? nest->choice_docs : nest->doc;
  }
  return words;
}

static void add_row(struct builder *b, const struct field *row, const char *path, const struct level *level) {
  const struct words words = words_for(row, path, level);
  const struct field *own = words.own;
  struct field copy = *row;
  copy.offset += level->offset;
  copy.flags |= level->flags;
  if (level->flags & FIELD_DERIVED)
    copy.flags &= ~(unsigned)FIELD_REQUIRED;
  copy.path = put_text(b, path);
  copy.unit = put_text(b, row->unit);
  copy.number = own ? own->number : row->number;
  copy.text = put_text(b, own && own->text ? own->text : row->text);
  copy.choices = put_choices(b, row->choices);
  copy.choice_docs = put_text(b, row->choice_docs);
  if (own && own->when)
    copy.when = put_condition(b, own->when, words.own_prefix);
  else if (row->when)
    copy.when = put_condition(b, row->when, level->prefix);
  else
    copy.when = words.when ? put_condition(b, words.when, words.when_prefix) : NULL;
  copy.absent = put_text(b, row->absent);
  const char *doc = own && own->doc ? own->doc : row->doc;
  copy.doc = words.doc ? put(b, "%s %s", doc ? doc : "", words.doc) : put_text(b, doc);
  copy.source = put_text(b, row->source);
  copy.label = put_text(b, row->label);
  if (b->rows)
    b->rows[b->row_count] = copy;
  b->row_count++;
}

/* Does a nest take a path in, by the nests' `only`? */
static bool is_taken(const char *path, const struct level *level) {
  for (; level->outer; level = level->outer) {
    const char *only = level->nest->only, *own = path_under(path, level->prefix);
    if (!only)
      continue;
    const bool except = *only == '!';
    if ((path_under(own, only + except) != NULL) == except)
      return false;
  }
  return true;
}

static status add_table(struct builder *b, const struct field_table *table, const struct level *level,
                        struct error *error) {
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    char path[FIELD_TEXT_SIZE];
    const char *own = row->path ? row->path : "";
    const int length = snprintf(path, sizeof path, "%s%s%s", level->prefix, *level->prefix && *own ? "." : "", own);
    if (length < 0 || (size_t)length >= sizeof path)
      return status_fail(error, STATUS_CONTENT, "the path '%.60s...' is longer than %zu bytes", path, sizeof path - 1);
    if (row->nest) {
      const struct level inner = {level, row, path, level->offset + row->offset, level->flags | row->flags};
      TRY(add_table(b, row->nest, &inner, error));
    } else if (is_taken(path, level)) {
      add_row(b, row, path, level);
    }
  }
  return STATUS_OK;
}

/* Everything that a table owns, or its size while `b` only counts. */
static status add_all(struct builder *b, const struct field_table *source, struct field_table *out,
                      struct error *error) {
  const struct level top = {.prefix = ""};
  out->name = put_text(b, source->name);
  out->doc = put_text(b, source->doc);
  return add_table(b, source, &top, error);
}

status field_table_build(const struct field_table *source, struct field_table *out, struct error *error) {
  struct builder count = {0};
  *out = (struct field_table){.size = source->size};
  TRY(add_all(&count, source, out, error));
  const size_t rows = count.row_count * sizeof *count.rows, choices = count.choice_count * sizeof *count.choices;
  char *memory = malloc(rows + choices + count.text_size);
  if (!memory)
    return status_fail(error, STATUS_MEMORY, "no memory for the rows of the %s", source->name);
  struct builder b = {(void *)memory, (void *)(memory + rows), memory + rows + choices, 0, 0, 0, count.text_size};
  (void)add_all(&b, source, out, NULL); /* the count has found all errors */
  out->rows = b.rows;
  out->count = b.row_count;
  return STATUS_OK;
}

void field_table_free(struct field_table *table) {
  free((void *)table->rows);
  *table = (struct field_table){0};
}

void field_table_start(const struct field_table *source, struct field_table *table) {
  const status code = field_table_build(source, table, NULL);
  assert(!code || code == STATUS_MEMORY);
  if (code)
    memory_refused();
}
