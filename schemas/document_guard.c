/* Bytes that must not reach libfyaml or a terminal. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* YAML 1.2.2, 5.1: what is not printable there is refused here too, and so are the line ends of YAML 1.1 (U+0085,
 * U+2028, U+2029) and byte order marks in the middle, which tools disagree about. */
static bool is_control(const unsigned char *text, size_t length) {
  if (length == 1) {
    const bool allowed = text[0] == '\t' || text[0] == '\n' || text[0] == '\r';
    return (text[0] < 0x20 && !allowed) || text[0] == 0x7F;
  }
  if (length == 2)
    return text[0] == 0xC2 && text[1] < 0xA0; /* U+0080 to U+009F */
  if (length == 3) {
    const bool separator = text[0] == 0xE2 && text[1] == 0x80 && (text[2] == 0xA8 || text[2] == 0xA9);
    const bool byte_order_mark = text[0] == 0xEF && text[1] == 0xBB && text[2] == 0xBF;
    const bool no_character = text[0] == 0xEF && text[1] == 0xBF && text[2] >= 0xBE; /* U+FFFE, U+FFFF */
    return separator || byte_order_mark || no_character;
  }
  return false;
}

size_t document_guard_text(const char *text, size_t size) {
  const unsigned char *bytes = (const unsigned char *)text;
  size_t i = 0;
  while (i < size) {
    size_t length = text_utf8_length(text + i, size - i);
    if (length == 0 || is_control(bytes + i, length))
      return i;
    i += length;
  }
  return size;
}

static void report_byte(struct document *document, size_t at) {
  const char *text = document->text + at;
  const unsigned char byte = (unsigned char)*text;
  if (byte == 0)
    document_report_at(document, at, at + 1, NULL, "a NUL byte: this is not text; save the file as UTF-8");
  else if (text_utf8_length(text, document->size - at) == 0)
    document_report_at(document, at, at + 1, NULL, "invalid UTF-8 (byte 0x%02x); save the file as UTF-8", byte);
  else
    document_report_at(document, at, at + 1, NULL, "a control character (first byte 0x%02x); remove it", byte);
}

bool document_guard(struct document *document) {
  const char *text = document->text;
  const size_t size = document->size, bad = document_guard_text(text, size);
  if (bad < size) {
    report_byte(document, bad);
    return false;
  }
  bool good = true, margin = true; /* between a line's start and its first character that is no space */
  for (size_t i = 0; i < size; i++) {
    if (margin && text[i] == '\t') {
      document_report_at(document, i, i + 1, NULL, "a tab as indentation; YAML wants spaces");
      good = false;
      margin = false;
    }
    margin = text[i] == '\n' || (margin && text[i] == ' ');
  }
  return good;
}
