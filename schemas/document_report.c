#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/document_tree.h"

enum { SHOWN = 120, BEFORE = 70 }; /* bytes of a long line that are shown, and of these before the error */

static void add(struct document *document, size_t start, size_t end, const char *path, const char *format,
                va_list arguments) {
  size_t order = document->error_count++;
  if (order >= DOCUMENT_MOST_ERRORS)
    return;
  char message[1024];
  int used = path && *path ? snprintf(message, sizeof message, "%.200s: ", path) : 0;
  vsnprintf(message + used, sizeof message - (size_t)used, format, arguments);
  /* A quotation cut inside a character, or a control character from an escape, must not reach a terminal. */
  for (size_t bad; (bad = document_guard_text(message, strlen(message))) < strlen(message);)
    message[bad] = '?';
  for (char *at = message; *at; at++)
    if (*at == '\n' || *at == '\r')
      *at = ' ';
  document->errors[order] = (struct document_error){start, end, order, strdup(message)};
}

void document_report_at(struct document *document, size_t start, size_t end, const char *path, const char *format,
                        ...) {
  va_list arguments;
  va_start(arguments, format);
  add(document, start, end, path, format, arguments);
  va_end(arguments);
}

void document_report(document_node *node, const char *path, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  if (!node->faulty)
    add(node->document, node->start, node->end, path, format, arguments);
  va_end(arguments);
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

/* One error as text. Columns count characters from 1, as editors do. */
static void write_error(const struct document *document, const struct document_error *error, FILE *out) {
  const char *text = document->text;
  size_t start = error->start < document->size ? error->start : document->size;
  size_t begin = start, finish = start, column = 1;
  while (begin && text[begin - 1] != '\n')
    begin--;
  while (finish < document->size && text[finish] != '\n' && text[finish] != '\r')
    finish++;
  for (size_t i = begin; i < start; i++)
    column += !continues(text[i]);
  fprintf(out, "%s:%zu:%zu: error: %s\n", document->name, document_report_line(document, start), column,
          error->message ? error->message : "(no memory for the message)");
  size_t from = begin, to = finish;
  if (finish - begin > SHOWN) {
    if (start - begin > BEFORE)
      from = start - BEFORE;
    if (to - from > SHOWN)
      to = from + SHOWN;
    while (from < start && continues(text[from]))
      from++;
    while (to > start && to < finish && continues(text[to]))
      to--;
  }
  if (from == to)
    return;
  /* A line that is no UTF-8 may hold anything: its bytes beyond ASCII are shown as '?', one column each. */
  bool readable = document_guard_text(text + from, to - from) == to - from;
  fprintf(out, "  %s", from > begin ? "..." : "");
  for (size_t i = from; i < to; i++) { /* the guard reports a byte before anything is known of the rest */
    unsigned char byte = (unsigned char)text[i];
    fputc((byte < 0x20 && byte != '\t') || byte == 0x7F || (byte >= 0x80 && !readable) ? '?' : byte, out);
  }
  fprintf(out, "%s\n  %s", to < finish ? "..." : "", from > begin ? "   " : "");
  for (size_t i = from; i < start; i++)
    if (!readable || !continues(text[i]))
      fputc(text[i] == '\t' ? '\t' : ' ', out);
  fputc('^', out);
  size_t end = error->end < to ? error->end : to;
  for (size_t i = start + 1; i < end; i++)
    if (!readable || !continues(text[i]))
      fputc('~', out);
  fputc('\n', out);
}

static int by_place(const void *a, const void *b) {
  const struct document_error *left = a, *right = b;
  if (left->start != right->start)
    return left->start < right->start ? -1 : 1;
  return left->order < right->order ? -1 : left->order > right->order;
}

char *document_report_text(struct document *document) {
  /* The whole must fit into struct error, with room for the closing line. */
  enum { ROOM = sizeof((struct error *)0)->message - 128 };
  size_t kept = document->error_count < DOCUMENT_MOST_ERRORS ? document->error_count : DOCUMENT_MOST_ERRORS;
  qsort(document->errors, kept, sizeof *document->errors, by_place);
  char *text = NULL;
  size_t size = 0, shown = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  for (; shown < kept; shown++) {
    char *one = NULL;
    size_t one_size = 0;
    FILE *line = open_memstream(&one, &one_size);
    if (!line)
      break;
    write_error(document, &document->errors[shown], line);
    bool whole = fclose(line) == 0;
    fflush(out);
    bool fits = whole && size + one_size <= ROOM;
    if (fits)
      fwrite(one, 1, one_size, out);
    free(one);
    if (!fits)
      break;
  }
  if (shown < document->error_count)
    fprintf(out, "%.60s: error: and %zu more; correct the ones above first\n", document->name,
            document->error_count - shown);
  fflush(out);
  if (fclose(out) != 0) {
    free(text);
    return NULL;
  }
  if (size && text[size - 1] == '\n')
    text[size - 1] = 0; /* messages end without a line end */
  return text;
}
