/* Bytes that must not reach libfyaml or a terminal. */

#include "schemas/document_tree.h"
#include "schemas/text.h"

/* YAML 1.2.2, 5.1: characters that are not printable there are refused. Also refused are the line ends of YAML 1.1 and
 * byte order marks inside the text, which tools treat differently. */
static const struct {
  uint32_t first, last;
} refused[] = {
    {0x00, 0x08},     {0x0B, 0x0C},     {0x0E, 0x1F}, /* all but tab, line feed and carriage return */
    {0x7F, 0x9F},     {0x2028, 0x2029},               /* U+0085, U+2028, U+2029: line ends of YAML 1.1 */
    {0xFEFF, 0xFEFF}, {0xFFFE, 0xFFFF},               /* byte order mark; noncharacters */
};

static bool is_refused(uint32_t character) {
  for (size_t k = 0; k < sizeof refused / sizeof refused[0]; k++)
    if (character >= refused[k].first && character <= refused[k].last)
      return true;
  return false;
}

size_t document_guard_text(const char *text, size_t size) {
  size_t i = 0;
  while (i < size) {
    size_t length = text_utf8_length(text + i, size - i);
    if (length == 0 || is_refused(text_utf8_character(text + i, length)))
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
  bool good = true, margin = true; /* margin: only spaces since the start of the line */
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
