/* Bytes that must not reach libfyaml or a terminal. */
#include <string.h>

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* YAML 1.2.2, 5.1: what is not printable there is refused here too, and so are the line ends of YAML 1.1 (U+0085,
 * U+2028, U+2029) and byte order marks in the middle, which tools disagree about. */
static bool control(const unsigned char *text, size_t length) {
  if (length == 1)
    return (text[0] < 0x20 && text[0] != '\t' && text[0] != '\n' && text[0] != '\r') || text[0] == 0x7F;
  if (length == 2)
    return text[0] == 0xC2 && text[1] < 0xA0;
  if (length == 3)
    return (text[0] == 0xE2 && text[1] == 0x80 && (text[2] == 0xA8 || text[2] == 0xA9)) ||
           (text[0] == 0xEF && text[1] == 0xBB && text[2] == 0xBF) ||
           (text[0] == 0xEF && text[1] == 0xBF && text[2] >= 0xBE);
  return false;
}

size_t document_guard_text(const char *text, size_t size) {
  const unsigned char *bytes = (const unsigned char *)text;
  size_t i = 0;
  while (i < size) {
    size_t length = text_utf8_length(text + i, size - i);
    if (length == 0 || control(bytes + i, length))
      return i;
    i += length;
  }
  return size;
}

bool document_guard(struct document *document) {
  const char *text = document->text;
  size_t size = document->size, bad = document_guard_text(text, size);
  if (bad < size) {
    unsigned char byte = (unsigned char)text[bad];
    if (byte == 0)
      document_report_at(document, bad, bad + 1, NULL, "a NUL byte: this is not text; save the file as UTF-8");
    else if (text_utf8_length(text + bad, size - bad) == 0)
      document_report_at(document, bad, bad + 1, NULL, "invalid UTF-8 (byte 0x%02x); save the file as UTF-8", byte);
    else
      document_report_at(document, bad, bad + 1, NULL, "a control character (first byte 0x%02x); remove it", byte);
    return false;
  }
  bool good = true, margin = true;
  for (size_t i = 0; i < size; i++) {
    if (margin && text[i] == '\t') {
      document_report_at(document, i, i + 1, NULL, "a tab as indentation; YAML wants spaces");
      good = margin = false;
    }
    margin = text[i] == '\n' || (margin && text[i] == ' ');
  }
  return good;
}
