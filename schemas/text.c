/* Small tools for text: UTF-8, JSON strings, paragraphs, a hash, guesses of names. */
#include "schemas/text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t utf8_claimed_length(unsigned char first) {
  if (first < 0x80)
    return 1;
  if (first >= 0xC2 && first < 0xE0)
    return 2;
  if (first >= 0xE0 && first < 0xF0)
    return 3;
  if (first >= 0xF0 && first < 0xF5)
    return 4;
  return 0;
}

size_t text_utf8_length(const char *text, size_t left) {
  const unsigned char *byte = (const unsigned char *)text;
  const size_t length = left ? utf8_claimed_length(byte[0]) : 0;
  if (length == 0 || length > left)
    return 0;

  for (size_t i = 1; i < length; i++)
    if ((byte[i] & 0xC0) != 0x80)
      return 0;

  const bool overlong = (byte[0] == 0xE0 && byte[1] < 0xA0) || (byte[0] == 0xF0 && byte[1] < 0x90);
  const bool surrogate = byte[0] == 0xED && byte[1] > 0x9F;
  const bool too_large = byte[0] == 0xF4 && byte[1] > 0x8F;
  return overlong || surrogate || too_large ? 0 : length;
}

void text_json_string(const char *text, FILE *out) {
  size_t left = strlen(text);
  fputc('"', out);
  while (left > 0) {
    const unsigned char byte = (unsigned char)*text;
    size_t length = text_utf8_length(text, left);
    if (length == 0) {
      fputs("\\ufffd", out);
      length = 1;
    } else if (byte == '"' || byte == '\\') {
      fprintf(out, "\\%c", byte);
    } else if (byte == '\n') {
      fputs("\\n", out);
    } else if (byte == '\t') {
      fputs("\\t", out);
    } else if (byte < 0x20 || byte == 0x7F) {
      fprintf(out, "\\u%04x", (unsigned)byte);
    } else {
      fwrite(text, 1, length, out);
    }
    text += length;
    left -= length;
  }
  fputc('"', out);
}

char *text_close(FILE *out, char **text) {
  if (fclose(out) != 0) {
    free(*text);
    *text = NULL;
  }
  return *text;
}

void text_wrap(const char *text, size_t at, size_t indent, size_t width, FILE *out) {
  fprintf(out, "%*s", (int)(indent - at), "");
  size_t column = indent;
  for (size_t word; *text; text += word) {
    text += strspn(text, " \n");
    word = strcspn(text, " \n");
    if (column > indent && column + 1 + word > width) {
      fprintf(out, "\n%*s", (int)indent, "");
      column = indent;
    } else if (column > indent && word) {
      fputc(' ', out);
      column++;
    }
    fwrite(text, 1, word, out);
    column += word;
  }
  fputc('\n', out);
}

void text_sentence(const char *doc, char *text, size_t size) {
  size_t length = 0;
  while (doc[length] && !(doc[length] == '.' && (doc[length + 1] == ' ' || doc[length + 1] == '\0')))
    length++;
  snprintf(text, size, "%.*s", (int)length, doc);
}

uint64_t text_hash(uint64_t hash, const void *bytes, size_t size) {
  const uint8_t *at = bytes;
  for (size_t k = 0; k < size; k++)
    hash = (hash ^ at[k]) * UINT64_C(0x100000001b3);
  return hash;
}

size_t text_distance(const char *a, size_t length, const char *b) {
  size_t m = strlen(b), rows[3][TEXT_DISTANCE_LENGTH + 1];
  if (length > TEXT_DISTANCE_LENGTH || m > TEXT_DISTANCE_LENGTH)
    return SIZE_MAX;
  for (size_t j = 0; j <= m; j++)
    rows[0][j] = j;
  for (size_t i = 1; i <= length; i++) {
    size_t *row = rows[i % 3], *above = rows[(i + 2) % 3], *second = rows[(i + 1) % 3];
    row[0] = i;
    for (size_t j = 1; j <= m; j++) {
      size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
      if (above[j] + 1 < best)
        best = above[j] + 1;
      if (row[j - 1] + 1 < best)
        best = row[j - 1] + 1;
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && second[j - 2] + 1 < best)
        best = second[j - 2] + 1;
      row[j] = best;
    }
  }
  return rows[length % 3][m];
}

size_t text_distance_limit(size_t length) {
  if (length < 2)
    return 0;
  if (length < 4)
    return 1;
  return length / 3 > 2 ? length / 3 : 2;
}

struct text_guess text_guess(const char *typed) {
  const size_t length = strlen(typed);
  return (struct text_guess){.typed = typed, .length = length, .least = 2 * text_distance_limit(length) + 2};
}

void text_guess_offer_part(struct text_guess *guess, const char *part, const char *name) {
  const size_t edits = text_distance(guess->typed, guess->length, part);
  if (edits >= strlen(part)) /* nothing of it would be left */
    return;
  const size_t distance = 2 * edits + (part != name);
  if (distance >= guess->least)
    return;
  guess->least = distance;
  guess->nearest = name;
}

void text_guess_offer(struct text_guess *guess, const char *name) {
  text_guess_offer_part(guess, name, name);
}
