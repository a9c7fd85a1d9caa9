/* Errors about places in a document, as file:line:col with the line and a marker below it. */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/memory.h"

enum { SHOWN = 92, BEFORE = 54 }; /* shown bytes of a long line, and how many of them precede the error */

static void add(struct document *document, size_t start, size_t end, bool put, const char *path, const char *format,
                va_list arguments) {
  size_t order = document->error_count++;
  document->elsewhere += put;
  if (document->owner)
    document->owner->foreign_errors++;
  if (order >= DOCUMENT_MOST_ERRORS)
    return;
  char message[1024] = "", told[1024];
  vsnprintf(told, sizeof told, format, arguments);
  text_append(message, sizeof message, path && *path ? "%.200s: " : "", path);
  text_append(message, sizeof message, "%s", told);
  /* A quotation that was cut inside a character, or a control character from an escape, must not reach a terminal. */
  for (size_t bad; (bad = document_guard_text(message, strlen(message))) < strlen(message);)
    message[bad] = '?';
  for (char *at = message; *at; at++)
    if (*at == '\n' || *at == '\r')
      *at = ' ';
  document->errors[order] = (struct document_error){start, end, order, put, memory_small_text(message)};
}

void document_report_at(struct document *document, size_t start, size_t end, const char *path, const char *format,
                        ...) {
  va_list arguments;
  va_start(arguments, format);
  add(document, start, end, false, path, format, arguments);
  va_end(arguments);
}

void document_report(document_node *node, const char *path, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  if (!node->faulty)
    add(node->document, node->start, node->end, node->put, path, format, arguments);
  va_end(arguments);
}

void document_report_error(document_node *node, const char *path, const struct error *error) {
  if (error->status == STATUS_MEMORY)
    node->document->no_memory = true;
  /* Of the report on another document only its first line: excerpts have no place within a line. */
  document_report(node, path, "%.*s", (int)strcspn(error->message, "\n"), error->message);
}

void document_report_memory(document_node *node, const char *path) {
  node->document->no_memory = true;
  document_report(node, path, "no memory to read it");
}

size_t document_report_line(const struct document *document, size_t offset) {
  size_t line = 1;
  for (size_t i = 0; i < offset && i < document->size; i++)
    line += document->text[i] == '\n';
  return line;
}

static bool continues(char byte) {
  return ((unsigned char)byte & 0xC0) == 0x80;
}

/* The part of a line that is shown around an error, in bytes of the text: [from, to) of the line [begin, finish). */
struct excerpt {
  size_t begin, finish, from, to;
  bool readable; /* the line is UTF-8. Otherwise each byte beyond ASCII is shown as '?', in one column */
};

static struct excerpt excerpt_around(const struct document *document, size_t start) {
  const char *text = document->text;
  struct excerpt e = {.begin = start, .finish = start};
  while (e.begin && text[e.begin - 1] != '\n')
    e.begin--;
  while (e.finish < document->size && text[e.finish] != '\n' && text[e.finish] != '\r')
    e.finish++;
  e.from = e.begin;
  e.to = e.finish;
  if (e.finish - e.begin > SHOWN) { /* the shown part begins and ends between characters */
    if (start - e.begin > BEFORE)
      e.from = start - BEFORE;
    if (e.to - e.from > SHOWN)
      e.to = e.from + SHOWN;
    while (e.from < start && continues(text[e.from]))
      e.from++;
    while (e.to > start && e.to < e.finish && continues(text[e.to]))
      e.to--;
  }
  e.readable = document_guard_text(text + e.from, e.to - e.from) == e.to - e.from;
  return e;
}

/* The guard reports a byte before it has checked the rest of the line, so control characters may follow. */
static void write_line(const char *text, const struct excerpt *e, FILE *out) {
  fprintf(out, "  %s", e->from > e->begin ? "..." : "");
  for (size_t i = e->from; i < e->to; i++) {
    const unsigned char byte = (unsigned char)text[i];
    const bool control = (byte < 0x20 && byte != '\t') || byte == 0x7F;
    fputc(control || (byte >= 0x80 && !e->readable) ? '?' : byte, out);
  }
  fputs(e->to < e->finish ? "...\n" : "\n", out);
}

/* Writes ^~~~ below bytes [start, end). */
static void write_marker(const char *text, const struct excerpt *e, size_t start, size_t end, FILE *out) {
  fputs(e->from > e->begin ? "     " : "  ", out);
  for (size_t i = e->from; i < start; i++)
    if (!e->readable || !continues(text[i]))
      fputc(text[i] == '\t' ? '\t' : ' ', out);
  fputc('^', out);
  for (size_t i = start + 1; i < end && i < e->to; i++)
    if (!e->readable || !continues(text[i]))
      fputc('~', out);
  fputc('\n', out);
}

/* Writes one error as text. Columns count characters from 1, as editors do. */
static void write_error(const struct document *document, const struct document_error *error, FILE *out) {
  const char *text = document->text, *message = error->message;
  if (error->put) {
    fprintf(out, "%s: error: %s\n", document->origin, message);
    return;
  }
  const size_t start = error->start < document->size ? error->start : document->size;
  const struct excerpt e = excerpt_around(document, start);
  size_t column = 1;
  for (size_t i = e.begin; i < start; i++)
    column += !continues(text[i]);
  fprintf(out, "%s:%zu:%zu: error: %s\n", document->name, document_report_line(document, start), column, message);
  if (e.from == e.to)
    return;
  write_line(text, &e, out);
  write_marker(text, &e, start, error->end, out);
}

static int by_place(const void *a, const void *b) {
  const struct document_error *left = a, *right = b;
  if (left->start != right->start)
    return left->start < right->start ? -1 : 1;
  return (left->order > right->order) - (left->order < right->order);
}

/* Appends one error to the report `out`, whose length is *size, unless the report would grow beyond `limit`. */
static bool append_error(const struct document *document, const struct document_error *error, FILE *out,
                         const size_t *size, size_t limit) {
  OWNED char *text = NULL;
  size_t length = 0;
  FILE *one = text_open_sized(&text, &length);
  write_error(document, error, one);
  text_close_small(one, &text);
  fflush(out); /* updates *size */
  const bool fits = *size + length <= limit;
  if (fits)
    fwrite(text, 1, length, out);
  return fits;
}

char *document_report_text(struct document *document) {
  enum {
    LIMIT = sizeof((struct error *)0)->message - 128
  }; /* the report with its last line must fit into struct error */
  const size_t kept = document->error_count < DOCUMENT_MOST_ERRORS ? document->error_count : DOCUMENT_MOST_ERRORS;
  qsort(document->errors, kept, sizeof *document->errors, by_place);

  char *text = NULL;
  size_t size = 0, shown = 0;
  FILE *out = text_open_sized(&text, &size);
  while (shown < kept && append_error(document, &document->errors[shown], out, &size, LIMIT))
    shown++;
  if (shown < document->error_count)
    fprintf(out, "%.60s: error: and %zu more; correct the ones above first\n", document->name,
            document->error_count - shown);
  text_close_small(out, &text);
  if (size && text[size - 1] == '\n')
    text[size - 1] = 0; /* remove the line end: messages have none */
  return text;
}
