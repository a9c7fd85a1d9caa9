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

/* A text of the table. It lives as long as the process, as all of the table does. */
static const char *text(const char *format, ...) __attribute__((format(printf, 1, 2)));
static const char *text(const char *format, ...) {
  char *to = NULL;
  va_list arguments;
  va_start(arguments, format);
  if (vasprintf(&to, format, arguments) < 0)
    memory_refused();
  va_end(arguments);
  return to;
}

/* A condition written in the table at `prefix`, from the root. NULL: it is about something around the whole table. */
static const char *condition(const char *when, const char *prefix) {
  size_t length = strlen(prefix);
  if (*when == '/')
    return when + 1;
  for (; strncmp(when, "../", 3) == 0; when += 3) {
    if (length == 0)
      return NULL;
    while (length > 0 && prefix[length - 1] != '.')
      length--;
    length -= length > 0;
  }
  return text("%.*s%s%s", (int)length, prefix, length ? "." : "", when);
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

static void add_row(struct field_table *table, const struct field *row, const char *path, const struct level *level) {
  const struct words words = words_for(row, path, level);
  const struct field *own = words.own;
  struct field *rows = realloc((void *)table->rows, (table->count + 1) * sizeof *rows);
  if (!rows)
    memory_refused();
  struct field *copy = &rows[table->count++];
  table->rows = rows;
  *copy = *row;
  copy->offset += level->offset;
  copy->flags |= level->flags;
  if (level->flags & FIELD_DERIVED)
    copy->flags &= ~(unsigned)FIELD_REQUIRED;
  copy->path = text("%s", path);
  copy->number = own ? own->number : row->number;
  copy->text = own && own->text ? own->text : row->text;
  if (own && own->when)
    copy->when = condition(own->when, words.own_prefix);
  else if (row->when)
    copy->when = condition(row->when, level->prefix);
  else
    copy->when = words.when ? condition(words.when, words.when_prefix) : NULL;
  copy->doc = own && own->doc ? own->doc : row->doc;
  if (words.doc)
    copy->doc = text("%s %s", copy->doc ? copy->doc : "", words.doc);
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

static void add_table(struct field_table *to, const struct field_table *table, const struct level *level) {
  for (size_t i = 0; i < table->count; i++) {
    const struct field *row = &table->rows[i];
    char path[FIELD_TEXT_SIZE];
    const char *own = row->path ? row->path : "";
    const int length = snprintf(path, sizeof path, "%s%s%s", level->prefix, *level->prefix && *own ? "." : "", own);
    assert(length >= 0 && (size_t)length < sizeof path);
    (void)length;
    if (row->nest) {
      const struct level inner = {level, row, path, level->offset + row->offset, level->flags | row->flags};
      add_table(to, row->nest, &inner);
    } else if (is_taken(path, level)) {
      add_row(to, row, path, level);
    }
  }
}

void field_table_start(const struct field_table *source, struct field_table *table) {
  const struct level top = {.prefix = ""};
  *table = (struct field_table){.size = source->size, .name = source->name, .doc = source->doc};
  add_table(table, source, &top);
}
