/* Small tools for text: UTF-8, JSON strings, paragraphs, a hash, guesses of names. */
#include "schemas/text.h"

#include <ctype.h>
#include <math.h>
#include <nettle/sha2.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "schemas/memory.h"

/* UTF-8 sequences by length: the pattern of the first byte, and the first character that needs this length. */
static const struct {
  unsigned char mask, first;
  uint32_t least;
} utf8[] = {{0x80, 0x00, 0}, {0xE0, 0xC0, 0x80}, {0xF0, 0xE0, 0x800}, {0xF8, 0xF0, 0x10000}};
enum { UTF8_LONGEST = sizeof utf8 / sizeof utf8[0] };

/* The length that the first byte announces; 0: it begins no sequence. */
static size_t utf8_claimed_length(unsigned char first) {
  for (size_t length = 1; length <= UTF8_LONGEST; length++)
    if ((first & utf8[length - 1].mask) == utf8[length - 1].first)
      return length;
  return 0;
}

uint32_t text_utf8_character(const char *text, size_t length) {
  uint32_t character = (unsigned char)text[0] & (unsigned char)~utf8[length - 1].mask;
  for (size_t i = 1; i < length; i++)
    character = character << 6 | ((unsigned char)text[i] & 0x3F);
  return character;
}

size_t text_utf8_length(const char *text, size_t left) {
  const size_t length = left ? utf8_claimed_length((unsigned char)text[0]) : 0;
  if (length == 0 || length > left)
    return 0;

  for (size_t i = 1; i < length; i++)
    if (((unsigned char)text[i] & 0xC0) != 0x80)
      return 0;

  const uint32_t character = text_utf8_character(text, length);
  const bool overlong = character < utf8[length - 1].least;
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  return overlong || surrogate || character > 0x10FFFF ? 0 : length;
}

/* Length of the plain character at `text`; 0: there is none. */
static size_t plain_length(const char *text, size_t left) {
  const size_t length = text_utf8_length(text, left);
  const uint32_t character = length ? text_utf8_character(text, length) : 0;
  const bool control = character < 0x20 || (character >= 0x7F && character < 0xA0);
  const bool reverses = (character >= 0x202A && character <= 0x202E) || (character >= 0x2066 && character <= 0x2069);
  return control || reverses ? 0 : length;
}

bool text_is_plain(const char *text) {
  size_t length;
  for (size_t left = strlen(text); left > 0; text += length, left -= length)
    if ((length = plain_length(text, left)) == 0)
      return false;
  return true;
}

void text_make_plain(char *text, const char *kept) {
  char *to = text;
  for (size_t left = strlen(text); left > 0;) {
    size_t length = strchr(kept, *text) ? 1 : plain_length(text, left);
    if (length > 0) {
      memmove(to, text, length);
      to += length;
    } else {
      *to++ = ' ';
      length = text_utf8_length(text, left);
      length += length == 0;
    }
    text += length;
    left -= length;
  }
  *to = '\0';
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
    } else if (plain_length(text, left) == 0) {
      fprintf(out, "\\u%04x", (unsigned)text_utf8_character(text, length));
    } else {
      fwrite(text, 1, length, out);
    }
    text += length;
    left -= length;
  }
  fputc('"', out);
}

struct growing { /* the text of a stream */
  char **text;
  size_t *size, own_size, room;
  bool failed;
};

static ssize_t grow_text(void *context, const char *bytes, size_t count) {
  struct growing *g = context;
  if (*g->size + count >= g->room) {
    const size_t room = 2 * (*g->size + count) + 1;
    char *larger = g->failed ? NULL : realloc(*g->text, room);
    g->failed = !larger;
    if (g->failed)
      return 0;
    *g->text = larger;
    g->room = room;
  }
  memcpy(*g->text + *g->size, bytes, count);
  *g->size += count;
  (*g->text)[*g->size] = '\0';
  return (ssize_t)count;
}

/* For ftell(); the stream only appends. */
static int place_in_text(void *context, off64_t *offset, int whence) {
  const struct growing *g = context;
  if (*offset != 0 || whence == SEEK_SET)
    return -1;
  *offset = (off64_t)*g->size;
  return 0;
}

static int end_text(void *context) {
  struct growing *g = context;
  const bool failed = g->failed;
  if (failed) {
    free(*g->text);
    *g->text = NULL;
  }
  free(g);
  return failed ? -1 : 0;
}

FILE *text_open(char **text) {
  return text_open_sized(text, NULL);
}

FILE *text_open_sized(char **text, size_t *size) {
  struct growing *g = memory_small(1, sizeof *g);
  *text = memory_small(1, 1);
  *g = (struct growing){.text = text, .size = size ? size : &g->own_size, .room = 1};
  *g->size = 0;
  FILE *out = fopencookie(g, "w",
                          (cookie_io_functions_t){.write = grow_text, .seek = place_in_text, .close = end_text});
  /* The stream's buffer is made here: where the first write makes it and memory is refused, that text is lost. */
  if (!out || setvbuf(out, NULL, _IOFBF, 0) != 0)
    memory_refused();
  return out;
}

char *text_close(FILE *out, char **text) {
  (void)fclose(out);
  return *text;
}

char *text_close_small(FILE *out, char **text) {
  if (!text_close(out, text))
    memory_refused();
  return *text;
}

/* A command in `...` is one word, so that it can be copied: half of a command may be another valid one. */
static size_t through_quotation(const char *text, size_t word) {
  bool open = false;
  for (size_t i = 0; i < word; i++)
    open ^= text[i] == '`';
  const char *end = open ? strchr(text + word, '`') : NULL;
  return end ? (size_t)(end - text) + strcspn(end, " \n") : word;
}

void text_wrap(const char *text, size_t at, size_t indent, size_t width, FILE *out) {
  fprintf(out, "%*s", (int)(indent - at), "");
  size_t column = indent;
  for (size_t word; *text; text += word) {
    text += strspn(text, " \n");
    word = strcspn(text, " \n");
    while (word && isdigit((unsigned char)text[word - 1]) && text[word] == ' ' &&
           strspn(text + word + 1, "0123456789") == 3)
      word += 1 + strcspn(text + word + 1, " \n"); /* 4 660 000 is one number */
    word = through_quotation(text, word);
    if (column > indent && column + 1 + word > width) {
      fprintf(out, "\n%*s", (int)indent, "");
      column = indent;
    } else if (column > indent && word) {
      fputc(' ', out);
      column++;
    }
    for (size_t i = 0; i < word; column++)
      if (text[i] == '\n') { /* within a quotation */
        fputc(' ', out);
        i += strspn(text + i, " \n");
      } else {
        fputc(text[i++], out);
      }
  }
  fputc('\n', out);
}

void text_wrap_lines(const char *text, size_t width, FILE *out) {
  char line[4096];
  for (; *text; text += *text == '\n') {
    const size_t length = strcspn(text, "\n");
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    text_wrap(line, 0, strspn(line, " "), width, out);
    text += length;
  }
}

bool text_has_word(const char *words, const char *word) {
  const size_t length = strlen(word);
  for (const char *at = words; *at; at += strcspn(at, " "), at += *at == ' ')
    if (strcspn(at, " ") == length && strncmp(at, word, length) == 0)
      return true;
  return false;
}

const char *text_next_item(const char *list, char *item, size_t size) {
  const size_t length = strcspn(list, ",");
  const char *begin = list + strspn(list, " "), *end = list + length;
  while (end > begin && end[-1] == ' ')
    end--;
  snprintf(item, size, "%.*s", begin < end ? (int)(end - begin) : 0, begin);
  return list + length + (list[length] == ',');
}

bool text_ends_in(const char *text, const char *ending) {
  const size_t length = strlen(text), tail = strlen(ending);
  return length > tail && strcmp(text + length - tail, ending) == 0;
}

bool text_ends_in_words(const char *text, const char *words, const char *separators) {
  return *words && (strcmp(text, words) == 0 ||
                    (text_ends_in(text, words) && strchr(separators, text[strlen(text) - strlen(words) - 1])));
}

void text_duration(double seconds, FILE *out) {
  if (seconds < 100)
    fprintf(out, "%.2g s", seconds);
  else if (seconds < 6000)
    fprintf(out, "%.2g minutes", seconds / 60);
  else
    fprintf(out, "%.2g hours", seconds / 3600);
}

size_t text_characters(const char *text, size_t bytes) {
  size_t count = 0;
  for (size_t i = 0; i < bytes && text[i]; i++)
    count += (text[i] & 0xC0) != 0x80;
  return count;
}

const char *text_plural(int64_t count) {
  return count == 1 ? "" : "s";
}

bool text_is_one_of(const char *text, const char *const *words) {
  for (; words && *words; words++)
    if (strcmp(text, *words) == 0)
      return true;
  return false;
}

/* Removes a character of UTF-8 at the end of the text whose last bytes are missing. */
static void drop_cut_character(char *text, size_t length) {
  size_t from = length;
  while (from > 0 && length - from < UTF8_LONGEST && ((unsigned char)text[from - 1] & 0xC0) == 0x80)
    from--;
  if (from > 0 && utf8_claimed_length((unsigned char)text[from - 1]) > length - from + 1)
    text[from - 1] = '\0';
}

bool text_append(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text), room = size - used;
  va_list arguments;
  va_start(arguments, format);
  const int length = vsnprintf(text + used, room, format, arguments);
  va_end(arguments);
  if (length >= 0 && (size_t)length < room)
    return true;
  drop_cut_character(text, strlen(text));
  return false;
}

bool text_append_word(char *text, size_t size, const char *word) {
  static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./=,:%+@";
  bool fits = text_append(text, size, " ");
  if (*word && word[strspn(word, plain)] == '\0')
    return fits && text_append(text, size, "%s", word);
  fits = fits && text_append(text, size, "'");
  for (; *word && fits; word++)
    fits = *word == '\'' ? text_append(text, size, "'\\''") : text_append(text, size, "%c", *word);
  return fits && text_append(text, size, "'");
}

const char *text_word(const char *word, char shown[TEXT_WORD]) {
  shown[0] = '\0';
  text_append_word(shown, TEXT_WORD, word);
  return shown + 1;
}

const char *text_percent(double share, char shown[TEXT_PERCENT]) {
  snprintf(shown, TEXT_PERCENT, 100 * share < 99.5 ? "%.2g %%" : "%.0f %%", 100 * share);
  return shown;
}

void text_append_fixed(char *text, size_t size, double number, int decimals) {
  if (fabs(number) > 1e6)
    text_append(text, size, "%.5g", number);
  else
    text_append(text, size, "%.*f", decimals, number);
}

/* A whole number with a space before each three of its digits, from 10 000 on. */
static void write_whole(double number, FILE *out) {
  char digits[32];
  const int count = snprintf(digits, sizeof digits, "%.0f", number);
  for (int i = 0; i < count; i++) {
    if (i > 0 && count > 4 && (count - i) % 3 == 0)
      fputc(' ', out);
    fputc(digits[i], out);
  }
}

/* Numbers with a positive exponent of up to `digits` become whole numbers; a unit behind a number is as in text_unit().
 */
static void write_powers(const char *text, long digits, FILE *out) {
  for (const char *at = text; *at;) {
    if (at > text && at[-1] >= '0' && at[-1] <= '9' && strncmp(at, " 1/", 3) == 0) {
      char unit[64] = "", shown[64];
      text_append(unit, sizeof unit, "%.*s", (int)strcspn(at + 1, " ,;)"), at + 1);
      text_unit(unit, shown, sizeof shown);
      fprintf(out, " %s", shown);
      at += 1 + strlen(unit);
      continue;
    }
    const size_t mantissa = strspn(at, "0123456789.");
    const char *power = at + mantissa;
    char *end = NULL;
    const bool has = mantissa > 0 && *power == 'e' && (power[1] == '+' || power[1] == '-') && power[2] >= '0' &&
                     power[2] <= '9';
    const long exponent = has ? strtol(power + 1, &end, 10) : 0;
    if (has && exponent > 0 && exponent <= digits) {
      write_whole(strtod(at, NULL), out);
    } else if (has) {
      if (mantissa > 1 || *at != '1')
        fprintf(out, "%.*s\xc3\x97", (int)mantissa, at);
      fprintf(out, "10^%ld", exponent);
    } else {
      const size_t plain = mantissa > 0 ? mantissa : 1;
      fwrite(at, 1, plain, out);
      at += plain;
      continue;
    }
    at = end;
  }
}

char *text_people(const char *text) {
  char *made = NULL;
  FILE *out = text_open(&made);
  write_powers(text, 6, out);
  return text_close(out, &made);
}

void text_powers(char *text, size_t size) {
  OWNED char *made = NULL;
  FILE *out = text_open(&made);
  write_powers(text, 0, out);
  text_close_small(out, &made);
  text[0] = '\0';
  text_append(text, size, "%s", made);
}

void text_unit(const char *unit, char *text, size_t size) {
  const size_t name = unit && strncmp(unit, "1/", 2) == 0 ? strcspn(unit + 2, "^ /()*") : 0;
  const char *power = name ? unit + 2 + name : "";
  text[0] = '\0';
  if (name && (!*power || (power[0] == '^' && power[1] && !power[2])))
    text_append(text, size, "%.*s^-%s", (int)name, unit + 2, *power ? power + 1 : "1");
  else if (unit && strcmp(unit, "1") != 0)
    text_append(text, size, "%s", unit);
}

void text_raise(const char *text, char *raised, size_t size) {
  static const char *const digits[] = {"\xe2\x81\xb0", "\xc2\xb9",     "\xc2\xb2",     "\xc2\xb3",     "\xe2\x81\xb4",
                                       "\xe2\x81\xb5", "\xe2\x81\xb6", "\xe2\x81\xb7", "\xe2\x81\xb8", "\xe2\x81\xb9"};
  raised[0] = '\0';
  for (bool high = false; *text; text++) {
    const size_t sign = text[0] == '^' && text[1] == '-';
    const bool digit = *text >= '0' && *text <= '9';
    if (text[0] == '^' && text[1 + sign] >= '0' && text[1 + sign] <= '9') {
      text_append(raised, size, "%s", sign ? "\xe2\x81\xbb" : "");
      text += sign;
      high = true;
      continue;
    }
    high = high && digit;
    if (high)
      text_append(raised, size, "%s", digits[*text - '0']);
    else
      text_append(raised, size, "%c", *text);
  }
}

void text_hex(const void *bytes, size_t size, char *text) {
  static const char digits[] = "0123456789abcdef";
  const unsigned char *at = bytes;
  for (size_t k = 0; k < size; k++) {
    *text++ = digits[at[k] >> 4];
    *text++ = digits[at[k] & 15];
  }
  *text = '\0';
}

void text_sha256(const void *bytes, size_t size, char text[65]) {
  struct sha256_ctx hash;
  uint8_t digest[SHA256_DIGEST_SIZE];
  sha256_init(&hash);
  sha256_update(&hash, size, bytes);
  sha256_digest(&hash, sizeof digest, digest);
  text_hex(digest, sizeof digest, text);
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

static size_t smaller(size_t a, size_t b) {
  return a < b ? a : b;
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
      const size_t changed = above[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = smaller(changed, smaller(above[j], row[j - 1]) + 1);
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped)
        row[j] = smaller(row[j], second[j - 2] + 1);
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
  /* "young" of "young_modulus" */
  const bool begins = guess->length > 2 && strncmp(part, guess->typed, guess->length) == 0 &&
                      part[guess->length] == '_';
  const size_t edits = begins ? 0 : text_distance(guess->typed, guess->length, part);
  if (edits >= strlen(part)) /* all letters would be edited */
    return;
  const size_t distance = 2 * edits + (part != name) + begins;
  if (distance >= guess->least)
    return;
  guess->least = distance;
  guess->nearest = name;
}

void text_guess_offer(struct text_guess *guess, const char *name) {
  text_guess_offer_part(guess, name, name);
}
