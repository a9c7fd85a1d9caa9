/* Small tools for text that every folder needs: UTF-8, JSON strings, wrapped paragraphs, a hash, and the guess for
 * every "did you mean". */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Length in bytes of the well-formed UTF-8 sequence at `text`, of which `left` bytes may be read. 0 when there is none:
 * overlong, surrogate, cut off or above U+10FFFF (RFC 3629, section 4). */
size_t text_utf8_length(const char *text, size_t left);

/* The character that a well-formed sequence of this length encodes. */
uint32_t text_utf8_character(const char *text, size_t length);

/* Writes `text` as a JSON string with its quotes. Bytes that are not UTF-8 become U+FFFD. */
void text_json_string(const char *text, FILE *out);

/* Is `text` well-formed UTF-8 without control characters: U+0000 to U+001F, U+007F to U+009F, and those that change the
 * direction of the text after them (U+202A to U+202E, U+2066 to U+2069)? */
bool text_is_plain(const char *text);

/* Makes `text` harmless for a terminal: control characters other than those in `kept`, and bytes that are not UTF-8,
 * become spaces. It does not grow. */
void text_make_plain(char *text, const char *kept);

/* Does `text` end in these bytes, and is it longer? */
bool text_ends_in(const char *text, const char *ending);
/* Is `words` all of the text, or its end behind one of these separators? No text ends in "". */
bool text_ends_in_words(const char *text, const char *words, const char *separators);
/* Characters in the first `bytes` bytes, or up to the text's end: continuation bytes of UTF-8 do not count. */
size_t text_characters(const char *text, size_t bytes);

/* "s", and "" for one. */
const char *text_plural(int64_t count);

/* Is `text` one of the words of a NULL-terminated list? An absent list has no words. */
bool text_is_one_of(const char *text, const char *const *words);

/* Appends to the text in `text`, an array of `size` bytes. Text that does not fit is cut behind a whole character.
 * Returns whether all of it fitted. Every text that is made of parts is made with it: an offset computed from what
 * snprintf returns is beyond the array once a text was cut. */
bool text_append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* The same with a blank and a word of a command line, as a shell reads it back: " demo.db", " 'a b'". */
bool text_append_word(char *text, size_t size, const char *word);
/* Such a word for a command within a sentence. Returns it, in `shown`. */
enum { TEXT_WORD = 4200 };
const char *text_word(const char *word, char shown[TEXT_WORD]);

/* Prints a time that a person waits: "2.2 s", "3.6 minutes", "5 hours". */
void text_duration(double seconds, FILE *out);

/* A share in percent, with two digits or all before the point: "0.012 %", "9.5 %", "100 %", "250 %". Returns it, in
 * `shown`. */
enum { TEXT_PERCENT = 32 };
const char *text_percent(double share, char shown[TEXT_PERCENT]);

/* Appends a number with so many decimals, or with five digits and an exponent ("1e+308") from a million on, where
 * people do not count digits. */
void text_append_fixed(char *text, size_t size, double number, int decimals);

/* Turns numbers such as 2.5e+33 and 1e-05 within a text, and a unit 1/m^3 behind a number, into what people write:
 * 2.5×10^33 m^-3, 10^-5. What does not fit is cut.
 */
void text_powers(char *text, size_t size);
/* The same of a long text, and in words of a million or less all digits: 3.8e+06 becomes 3 800 000, 1e+03 1000.
 * malloc'd; NULL: no memory. */
char *text_people(const char *text);

/* Raises the powers in a text: 10^33 and m^-3 become 10³³ and m⁻³. What does not fit is cut. */
void text_raise(const char *text, char *raised, size_t size);

/* A unit as people write it: "m^-3" for "1/m^3"; "" for a pure number. */
void text_unit(const char *unit, char *text, size_t size);

/* Writes 2 * `size` hexadecimal digits and a NUL. */
void text_hex(const void *bytes, size_t size, char *text);

/* SHA-256 (FIPS 180-4) of `size` bytes as 64 hexadecimal digits and a NUL: what `sha256sum FILE` gives. */
void text_sha256(const void *bytes, size_t size, char text[65]);

/* The first sentence of `doc` without its full stop. */
void text_sentence(const char *doc, char *text, size_t size);

/* Is `word` one of the words in `words`, which single spaces separate? */
bool text_has_word(const char *words, const char *word);

/* Copies the next item of a comma-separated list, without blanks around it. Returns the rest of the list. */
const char *text_next_item(const char *list, char *item, size_t size);

/* A stream that makes *text, which the caller frees: open_memstream() that does not cut the text where memory runs out.
 * *text (and its *size) are right after fflush() or the end; *text is NULL after the end when memory ran out, and
 * fclose() tells so. ftell() gives the length so far. Never NULL: the stream itself is small memory (schemas/memory.h).
 */
FILE *text_open(char **text) __attribute__((returns_nonnull));
FILE *text_open_sized(char **text, size_t *size) __attribute__((returns_nonnull));
/* Closes the stream that text_open made for *text. Returns the text, which the caller frees; NULL (and *text is NULL)
 * when memory ran out. */
char *text_close(FILE *out, char **text);
/* The same for a text whose length does not grow with a file or a store: without memory the process ends. */
char *text_close_small(FILE *out, char **text) __attribute__((returns_nonnull));

/* Writes the words of `text` in lines of at most `width` columns, each line indented, and ends the last line. The
 * cursor is at column `at`, which is at most `indent`. A command in `...` is one word, which may be longer than a line.
 */
void text_wrap(const char *text, size_t at, size_t indent, size_t width, FILE *out);

/* Wraps each line of a text by itself; a line that begins with blanks keeps them. */
void text_wrap_lines(const char *text, size_t width, FILE *out);

/* FNV-1a, 64 bits (http://www.isthe.com/chongo/tech/comp/fnv/): the hash of `size` bytes that follow those of `hash`;
 * TEXT_HASH_START before the first byte. "a" gives af63dc4c8601ec8c. */
#define TEXT_HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t text_hash(uint64_t hash, const void *bytes, size_t size);

enum { TEXT_DISTANCE_LENGTH = 128 };

/* Edit distance (optimal string alignment): insertions, deletions, changed letters and swapped neighbours each cost 1.
 * `a` has `length` bytes. SIZE_MAX when a name is longer than TEXT_DISTANCE_LENGTH. */
size_t text_distance(const char *a, size_t length, const char *b);

/* The largest distance at which a name of this length is worth a guess: about a third of it; 0 for one letter. */
size_t text_distance_limit(size_t length);

/* The known name nearest to a mistyped one. Start with text_guess(typed), then offer every known name; `nearest` is the
 * result, NULL when none is near. Names are borrowed. */
struct text_guess {
  const char *typed, *nearest;
  size_t length, least; /* of `typed`; twice the distance that the next name must stay below */
};
struct text_guess text_guess(const char *typed);
void text_guess_offer(struct text_guess *guess, const char *name);
/* Offers `name`, compared by the part of it that begins at `part`. A part costs half an edit, so that a whole name is
 * preferred to an equally near part. */
void text_guess_offer_part(struct text_guess *guess, const char *part, const char *name);
