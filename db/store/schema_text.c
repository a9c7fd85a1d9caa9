/* Splits a CREATE statement into words and lines. */
#include "db/store/schema_text.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/text.h"

static bool in_word(char c) {
  return isalnum((unsigned char)c) || c == '_' || c == '.' || (unsigned char)c >= 0x80;
}

bool schema_text_is_plain(const char *name, size_t length) {
  for (size_t i = 0; i < length; i++)
    if (!isalnum((unsigned char)name[i]) && name[i] != '_')
      return false;
  return length > 0;
}

static const char *skip_blanks(const char *at) {
  for (;;) {
    at += strspn(at, " \t\r\n\f");
    if (strncmp(at, "--", 2) == 0) {
      at += strcspn(at, "\n");
    } else if (strncmp(at, "/*", 2) == 0) {
      const char *end = strstr(at + 2, "*/");
      at = end ? end + 2 : at + strlen(at);
    } else {
      return at;
    }
  }
}

/* Length of the word, quoted text or single character at `at`. */
static size_t word_length(const char *at) {
  size_t length = 0;
  if (*at == '\'' || *at == '"' || *at == '`') {
    for (length = 1; at[length]; length++)
      if (at[length] == *at && at[++length] != *at)
        return length;
    return length;
  }
  while (in_word(at[length]))
    length++;
  return length ? length : 1;
}

static void write_word(const char *at, size_t length, FILE *out) {
  if (*at == '"' && length > 2 && schema_text_is_plain(at + 1, length - 2)) {
    at++;
    length -= 2;
  }
  for (size_t i = 0; i < length; i++)
    fputc(at[i] == '\n' ? ' ' : at[i], out); /* a line break within quotes does not end a line */
}

/* Writes words with blanks between them. At depth 1, a parenthesis and a comma end a line. */
static void write_lines(const char *at, FILE *out) {
  int depth = 0;
  bool begins = true;
  for (at = skip_blanks(at); *at; at = skip_blanks(at)) {
    const size_t length = word_length(at);
    const bool opens = *at == '(' && depth == 0, closes = *at == ')' && depth == 1, parts = *at == ',' && depth == 1;
    depth += (*at == '(') - (*at == ')');
    if (opens || closes || parts) {
      fputc('\n', out);
      begins = true;
    } else {
      if (!begins)
        fputc(' ', out);
      write_word(at, length, out);
      begins = false;
    }
    at += length;
  }
}

bool schema_text_read(const char *sql, struct schema_text *out) {
  size_t size = 0;
  *out = (struct schema_text){.count = 0};
  FILE *stream = text_open(&out->text, &size);
  if (!stream)
    return false;
  write_lines(sql, stream);
  out->text = text_close(stream, &out->text);
  for (char *line = out->text; line && out->count < SCHEMA_TEXT_LINES;) {
    out->lines[out->count++] = line;
    line = strchr(line, '\n');
    if (!line)
      return true;
    *line++ = '\0';
  }
  return false;
}

void schema_text_clear(struct schema_text *text) {
  free(text->text);
  *text = (struct schema_text){.count = 0};
}

const char *schema_text_after(const char *line, const char *word) {
  const size_t length = strlen(word);
  return strncmp(line, word, length) == 0 && line[length] == ' ' ? line + length + 1 : NULL;
}
